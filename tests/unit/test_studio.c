/* Parts of retex-studio without a server: who may ask, command lines of jobs, files that are sent and served. */
#include "lib_test.h"
#include "lib_folder.h"
#include <cmocka.h>

#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/beneath.h"

#include "studio/gate.h"
#include "studio/job_line.h"
#include "studio/media.h"
#include "studio/project.h"

static char folder[PATH_MAX]; /* the current one, by its real name */

static int enter_folder(void **state)
{
    return test_make_folder(state) || !realpath(test_folder, folder) || chdir(folder);
}

static int leave_folder(void **state)
{
    return chdir("/") || test_remove_folder(state);
}

static void expect_file(const char *name, const char *text)
{
    char got[64] = "";
    FILE *file = fopen(name, "r");
    if (!file)
        fail_msg("%s is not there", name);
    got[fread(got, 1, sizeof got - 1, file)] = 0;
    fclose(file);
    assert_string_equal(got, text);
}

/* ---- the gate ---- */

static void test_tokens(void **state)
{
    Gate gates[2] = {{.port = 1}, {.port = 1}};
    (void)state;
    for (int k = 0; k < 2; k++) {
        assert_int_equal(gate_open(&gates[k], NULL), 0);
        assert_int_equal(strspn(gates[k].token, "0123456789abcdef"), GATE_TOKEN);
        assert_int_equal(strlen(gates[k].token), GATE_TOKEN);
    }
    assert_string_not_equal(gates[0].token, gates[1].token);
}

#define TOKEN "0123456789abcdef0123456789abcdef"
#define HERE "127.0.0.1:4711"

static void test_who_may_ask(void **state)
{
    static const Gate gate = {4711, TOKEN};
    static const struct {
        const char *url, *host, *origin, *rest;
    } requests[] = {
        {"/" TOKEN "/", HERE, NULL, ""},
        {"/" TOKEN "/api/state", "localhost:4711", "http://127.0.0.1:4711", "api/state"},
        {"/" TOKEN "//x", HERE, "http://localhost:4711", "/x"},
        {"/" TOKEN "/", NULL, NULL, NULL},
        {"/" TOKEN "/", "127.0.0.1", NULL, NULL},
        {"/" TOKEN "/", "127.0.0.1:47110", NULL, NULL},
        {"/" TOKEN "/", "127.0.0.1.evil.example:4711", NULL, NULL},
        {"/" TOKEN "/", "LOCALHOST:4711 ", NULL, NULL},
        {"/" TOKEN "/", HERE, "", NULL},
        {"/" TOKEN "/", HERE, "null", NULL},
        {"/" TOKEN "/", HERE, "https://127.0.0.1:4711", NULL},
        {"/" TOKEN "/", HERE, "http://127.0.0.1:4711/", NULL},
        {"/" TOKEN, HERE, NULL, NULL},
        {"/" TOKEN "0/", HERE, NULL, NULL},
        {TOKEN "/", HERE, NULL, NULL},
        {"/0123456789abcdef0123456789abcdee/", HERE, NULL, NULL},
        {"/0123456789ABCDEF0123456789abcdef/", HERE, NULL, NULL},
        {"/0123456789abcdef/", HERE, NULL, NULL},
        {"/", HERE, NULL, NULL},
        {"", HERE, NULL, NULL},
    };
    (void)state;
    for (size_t k = 0; k < sizeof requests / sizeof *requests; k++) {
        const char *why = NULL;
        const char *rest = gate_enter(&gate, requests[k].url, requests[k].host, requests[k].origin, &why);
        if (!rest != !requests[k].rest || !why != !!rest || (rest && strcmp(rest, requests[k].rest) != 0))
            fail_msg("%s at %s: %s, %s", requests[k].url, requests[k].host, rest, why);
    }
}

/* ---- command lines ---- */

static Model model;

static int open_model(void **state)
{
    static char path[PATH_MAX + 32], written[PATH_MAX + 32];
    if (enter_folder(state))
        return 1;
    snprintf(path, sizeof path, "%s/room.pov", folder);
    snprintf(written, sizeof written, "%s/room.pov.studio", folder);
    model = (Model){.path = path, .name = (char *)"room.pov", .folder = folder, .written = written};
    model.top = beneath_open_top(written, 1);
    return model.top < 0;
}

static int close_model(void **state)
{
    close(model.top);
    return leave_folder(state);
}

static int make_line(Line *line, const char *tool, json_t *args, const ProgramLimits *limits, RetexError *err)
{
    const int code = line_make(line, tool, args, limits, &model, err);
    json_decref(args);
    return code;
}

static void test_lines(void **state)
{
    static const ProgramLimits limits[] = {{0, 512 << 20}, {0, 0}, {1, 512 << 20}};
    static const char *const words[] = {"--safe", "--max-time", "10000000", "--max-memory", "512M",
                                        "-q",     "--size",     "-oc",      "--",           "-o c"};
    static const int first[] = {0, 0, 5}, left_out[] = {0, 2, 0};
    Line line;
    (void)state;
    for (int k = 0; k < 3; k++) {
        int count = 0;
        assert_int_equal(make_line(&line, "retex-combine",
                                   json_pack("[s, s, s, s, s]", "-q", "--size", "-oc", "--", "-o c"), &limits[k], NULL),
                         0);
        assert_string_equal(strrchr(line.words[0], '/'), "/retex-combine");
        assert_int_equal(line.words[0][0], '/');
        for (int at = first[k]; at < 10; at++)
            if (!(left_out[k] && (at == 3 || at == 4)))
                assert_string_equal(line.words[++count], words[at]);
        assert_int_equal(line.count, count + 1);
        assert_null(line.words[line.count]);
        line_free(&line);
    }
    assert_int_equal(line_make_live(&line, "-o x.pov", NULL, &limits[0], &model, NULL), 0);
    assert_string_equal(line.words[line.count - 3], "--live");
    assert_string_equal(line.words[line.count - 2], "--");
    assert_string_equal(line.words[line.count - 1], "-o x.pov");
    line_free(&line);
    json_t *names = json_pack("[s, s]", "--", "x.pov");
    assert_int_equal(line_make_live(&line, "x.pov", names, &limits[0], &model, NULL), RETEX_EINVAL);
    assert_int_equal(line_make_live(&line, "../x.pov", NULL, &limits[0], &model, NULL), RETEX_EINVAL);
    json_decref(names);
    json_t *list = json_pack("[s, s, s]", "--list-lamps", "--", "room.pov"),
           *render = json_pack("[s, s, s]", "-q", "--", "room.pov");
    assert_true(line_is_long("retex-render", render));
    assert_false(line_is_long("retex-pack", render) || line_is_long("sh", render));
    assert_false(line_is_long("retex-render", list));
    json_decref(list);
    json_decref(render);
}

static void test_what_is_no_job(void **state)
{
    static const ProgramLimits safe = {0, 512 << 20};
    static const char *const tools[] = {
        "retex", "retex-serve", "retex-studio", "retex-info", "../bin/retex-pack", "/bin/sh", "", NULL};
    static const struct {
        const char *tool, *words[4];
    } wrong[] = {
        {"retex-combine", {"s.exr"}},                              /* a name before `--` */
        {"retex-combine", {"--save-preset", "room.pov.studio/x"}}, /* options that no window needs */
        {"retex-combine", {"--output", "room.pov.studio/x"}},      /* other spellings */
        {"retex-combine", {"--output=room.pov.studio/x"}},
        {"retex-combine", {"-oroom.pov.studio/x"}},
        {"retex-combine", {"-qo", "room.pov.studio/x"}},
        {"retex-combine", {"--size=1x1"}},
        {"retex-combine", {"--size:x", "1x1"}},
        {"retex-combine", {"--texture2", "Floor=red"}},
        {"retex-combine", {"-o"}},
        {"retex-combine", {"-"}},
        {"retex-combine", {""}},
        {"retex-combine", {"--", "../s.exr"}},
        {"retex-combine", {"--", "/etc/passwd"}},
        {"retex-combine", {"--", "a/./b"}},
        {"retex-combine", {"--", "a//b"}},
        {"retex-combine", {"--", "a\nb"}},
        {"retex-combine", {"--", ""}},
        {"retex-render", {"--ini", "x.ini"}},
        {"retex-render", {"-I", "/"}},
        {"retex-render", {"--aov-dir", "room.pov.studio"}},
        {"retex-render", {"--live"}},
        {"retex-import", {"-I", "/"}},
        {"retex-pack", {"--unpack", "x"}},
    };
    json_t *many = json_pack("[s]", "--"), *long_word;
    char *word = calloc(LINE_BYTES + 2, 1);
    RetexError err;
    Line line;
    (void)state;
    for (int k = 0; k < 8; k++)
        assert_int_equal(make_line(&line, tools[k], NULL, &safe, NULL), RETEX_EINVAL);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        json_t *args = json_array();
        for (int i = 0; i < 4 && wrong[k].words[i]; i++)
            json_array_append_new(args, json_string(wrong[k].words[i]));
        if (make_line(&line, wrong[k].tool, args, &safe, &err) != RETEX_EINVAL)
            fail_msg("%s %s %s", wrong[k].tool, wrong[k].words[0], wrong[k].words[1]);
    }
    assert_int_equal(make_line(&line, "retex-combine",
                               json_pack("[s, s]", "--texture:over:width=0.5m", "Floor=/t/oak.jpg"), &safe, NULL),
                     0);
    line_free(&line);
    assert_int_equal(make_line(&line, "retex-pack", json_string("-q"), &safe, NULL), RETEX_EINVAL);
    assert_int_equal(make_line(&line, "retex-pack", json_pack("[s, i]", "-q", 1), &safe, NULL), RETEX_EINVAL);
    for (int k = 0; k < LINE_WORDS; k++)
        json_array_append_new(many, json_string("x"));
    assert_int_equal(make_line(&line, "retex-pack", many, &safe, NULL), RETEX_EINVAL);
    memset(word, 'x', LINE_BYTES + 1);
    long_word = json_pack("[s, s]", "--", word);
    assert_int_equal(make_line(&line, "retex-pack", long_word, &safe, NULL), RETEX_EINVAL);
    assert_null(line.words);
    assert_int_equal(line_make(&line, "retex-pack", NULL, &safe, NULL, NULL), RETEX_EINVAL);
    free(word);
}

static void test_outputs(void **state)
{
    static const ProgramLimits limits[] = {{0, 0}, {1, 0}};
    static const struct {
        const char *tool, *option, *output;
        int is_right;
    } outputs[] = {
        {"retex-render", "-o", "room.pov.studio/x.exr", 1},
        {"retex-render", "-o", "room.pov.studio/a/b/x.exr", 1},
        {"retex-render", "--stats", "-", 1},
        {"retex-pack", "--web", "room.pov.studio/web/1", 1},
        {"retex-combine", "--batch-root", "room.pov.studio/catalogue", 1},
        {"retex-render", "-o", "x.exr", 0},
        {"retex-render", "-o", "../x.exr", 0},
        {"retex-render", "-o", "/tmp/x.exr", 0},
        {"retex-render", "-o", "room.pov.studio", 0},
        {"retex-render", "-o", "room.pov.studio/", 0},
        {"retex-render", "-o", "room.pov.studio/../x.exr", 0},
        {"retex-render", "-o", "room.pov.studio/a/../../x.exr", 0},
        {"retex-render", "-o", "room.pov.studio.exr", 0},
        {"retex-render", "-o", "room.pov.studio/a\nb", 0},
        {"retex-render", "-o", "", 0},
        {"retex-render", "--stats", "stats.json", 0},
        {"retex-pack", "--web", "web", 0},
        {"retex-combine", "--batch-root", ".", 0},
        {"retex-import", "-o", "scene", 0},
    };
    RetexError err;
    Line line;
    (void)state;
    for (size_t k = 0; k < sizeof outputs / sizeof *outputs; k++)
        for (int of = 0; of < 2; of++) {
            json_t *args = json_pack("[s, s]", outputs[k].option, outputs[k].output);
            const int code = make_line(&line, outputs[k].tool, args, &limits[of], NULL);
            if ((code == 0) != outputs[k].is_right)
                fail_msg("%s %s %s: %d", outputs[k].tool, outputs[k].option, outputs[k].output, code);
            line_free(&line);
        }
    assert_int_equal(access("room.pov.studio/a/b", F_OK), 0);
    /* a link anywhere: nothing is run */
    assert_int_equal(mkdir("far", 0777) || symlink("../../far", "room.pov.studio/a/out"), 0);
    assert_int_equal(make_line(&line, "retex-pack", json_pack("[s, s]", "-o", "room.pov.studio/a/out/x"), limits, &err),
                     RETEX_EINVAL);
    assert_int_equal(make_line(&line, "retex-pack", json_pack("[s, s]", "-o", "room.pov.studio/x"), limits, &err),
                     RETEX_EACCESS);
    assert_string_equal(err.message,
                        "room.pov.studio/a/out is a link: nothing is written while there is one; remove it");
    assert_int_equal(access("far/x", F_OK), -1);
    /* the folder is the one that was opened, whatever has its name */
    assert_int_equal(
        unlink("room.pov.studio/a/out") || rename("room.pov.studio", "moved") || symlink("far", "room.pov.studio"), 0);
    assert_int_equal(make_line(&line, "retex-pack", json_pack("[s, s]", "-o", "room.pov.studio/new/x"), limits, NULL),
                     0);
    assert_int_equal(access("far/new", F_OK), -1);
    assert_int_equal(access("moved/new", F_OK), 0);
    line_free(&line);
}

/* ---- projects ---- */

/* A whole project, in which one member, by its place, has another value; NULL: none. */
static json_t *project_with(const char *const place[4], const char *value)
{
    static const char text[] =
        "{\"retex-studio\": 1, \"model\": \"room.pov\", \"later\": [1], \"view\": null,"
        "\"import\": {\"unit\": \"cm\", \"partial\": true, \"done\": true, \"number\": 2, \"lines\": [\"a\\tb\"]},"
        "\"cameras\": [{\"name\": \"1\", \"eye\": [1, 2.5, 3], \"at\": [0, 0, 0], \"angle\": 65,"
        " \"thumb\": \"data:image/jpeg;base64,AA\"}],"
        "\"targets\": [{\"name\": \"-Floor\", \"select\": \"#1/flat\", \"uv\": \"\", \"share\": 0.5}],"
        "\"lamps\": [\"Lamp\"], \"finishes\": {\"Floor\": [\"matt\"]},"
        "\"render\": {\"width\": 640, \"height\": 360, \"samples\": 64, \"noise\": 0.1, \"denoise\": true},"
        "\"renders\": [{\"set\": \"room.pov.studio/renders/1.exr\", \"done\": false, \"part\": 0.5, \"error\": "
        "\"a\\nb\","
        " \"settings\": {\"view\": {\"eye\": [1, 2, 3], \"at\": [0, 0, 0], \"angle\": 65}, \"targets\": [], \"lamps\": "
        "[],"
        "  \"finishes\": {}, \"render\": {\"width\": 640, \"height\": 360, \"samples\": 1, \"noise\": 0}}}],"
        "\"textures\": {\"folders\": [\"/home/u/my oak\", \"tex\"], \"widths\": {\"a.jpg\": 120}},"
        "\"look\": \"Floor=files/a.jpg\", \"presets\": [{\"name\": \"1\", \"look\": \"\"}]}";
    json_t *root = json_loads(text, 0, NULL), *at = root;
    assert_non_null(root);
    for (int k = 0; place && k < 4 && place[k]; k++) {
        const int is_last = k == 3 || !place[k + 1], is_list = json_is_array(at);
        json_t *other = is_last ? json_loads(value, JSON_DECODE_ANY, NULL) : NULL;
        if (is_last)
            assert_int_equal(is_list ? json_array_set_new(at, 0, other) : json_object_set_new(at, place[k], other), 0);
        else
            at = is_list ? json_array_get(at, 0) : json_object_get(at, place[k]);
    }
    return root;
}

static int parse_project(const char *const place[4], const char *value, RetexError *err)
{
    json_t *root = project_with(place, value);
    char *text = json_dumps(root, 0);
    json_t *project = project_parse(text, strlen(text), &model, err);
    const int is_right = project && json_equal(project, root);
    json_decref(project);
    json_decref(root);
    free(text);
    return is_right;
}

static void test_projects(void **state)
{
    static const struct {
        const char *place[4], *value, *named; /* named: the member that the message names; NULL: it is right */
    } cases[] = {
        {{"model"}, "\"other.pov\"", "model"},
        {{"model"}, "\"../room.pov\"", "model"},
        {{"model"}, "\"/tmp/room.pov\"", "model"},
        {{"model"}, "1", "model"},
        {{"import"}, "[]", "import"},
        {{"import", "variant"}, "\"-50 %\"", NULL},
        {{"import", "unit"}, "7", "import.unit"},
        {{"import", "up"}, "\"a\\nb\"", "import.up"},
        {{"import", "number"}, "1.5", "import.number"},
        {{"view"}, "{\"eye\": [0, 0], \"at\": [0, 0, 0], \"angle\": 70}", "view.eye"},
        {{"view"}, "{\"eye\": [0, 0, \"1\"], \"at\": [0, 0, 0], \"angle\": 70}", "view.eye"},
        {{"view"}, "{\"eye\": [0, 0, 1], \"at\": [0, 0, 0], \"angle\": 180}", "view.angle"},
        {{"view"}, "{\"eye\": [0, 0, 1], \"at\": [0, 0, 0], \"angle\": 0}", "view.angle"},
        {{"view"}, "{\"eye\": [0, 0, 1], \"at\": [0, 0, 0], \"angle\": 179}", NULL},
        {{"cameras", "0"}, "{}", "cameras[0].eye"},
        {{"cameras", "0", "thumb"}, "\"\"", NULL},
        {{"cameras", "0", "thumb"}, "\"http://evil.example/\"", "cameras[0].thumb"},
        {{"cameras", "0", "thumb"}, "\"data:image/svg+xml,x\"", "cameras[0].thumb"},
        {{"targets", "0", "select"}, "\"\"", "targets[0].select"},
        {{"targets"}, "[1]", "targets[0]"},
        {{"targets"}, "[{}, {}, {}, {}, {}, {}, {}, {}, {}]", "targets"},
        {{"lamps", "0"}, "\"a\\u0007\"", "lamps[0]"},
        {{"finishes"}, "{\"Floor\": \"matt\"}", "finishes"},
        {{"finishes"}, "{\"Fl\\noor\": [\"matt\"]}", "finishes"},
        {{"render", "width"}, "1000000", "render.width"},
        {{"render", "width"}, "\"640 --live\"", "render.width"},
        {{"render", "samples"}, "0", "render.samples"},
        {{"render"}, "null", "render"},
        {{"renders", "0", "set"}, "\"--help\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"x.exr\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"/tmp/room.pov.studio/x.exr\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"room.pov.studio/../x.exr\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"room.pov.studio/renders/-o.exr\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"room.pov.studio/renders/.x.exr\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"room.pov.studio/renders//x.exr\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"room.pov.studio/renders/1.exr/\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"room.pov.studio/renders/1.html\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"room.pov.studio/renders/\\n.exr\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"room.pov.studio.exr\"", "renders[0].set"},
        {{"renders", "0", "set"}, "\"\"", "renders[0].set"},
        {{"renders", "0", "settings"}, "null", "renders[0].settings"},
        {{"renders", "0", "settings"}, "{\"view\": null}", "renders[0].settings.targets"},
        {{"renders", "0", "args"}, "[\"--help\"]", NULL}, /* is known no more, and means nothing */
        {{"textures", "folders", "0"}, "\"-x\"", "textures.folders[0]"},
        {{"textures", "folders", "0"}, "\"\"", "textures.folders[0]"},
        {{"textures", "widths"}, "{\"a\": \"b\"}", "textures.widths"},
        {{"look"}, "null", "look"},
        {{"look"}, "\"Floor=\\u001b[2J\"", "look"},
        {{"presets", "0", "look"}, "1", "presets[0].look"},
        {{"later"}, "{\"set\": \"--help\"}", NULL},
    };
    char wanted[256];
    RetexError err;
    (void)state;
    assert_true(parse_project(NULL, NULL, &err));
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const int is_right = parse_project(cases[k].place, cases[k].value, &err);
        if (is_right != !cases[k].named)
            fail_msg("%s %s: %s", cases[k].place[0], cases[k].value, is_right ? "right" : err.message);
        snprintf(wanted, sizeof wanted, "the project is damaged: \"%s\" is not as it should be", cases[k].named);
        if (!is_right)
            assert_string_equal(err.message, wanted);
    }
    static const char *const others[] = {"",
                                         "{",
                                         "[1]",
                                         "1",
                                         "{\"a\": 1, \"a\": 2}",
                                         "{\"model\": \"room.pov\"}",
                                         "{\"retex-studio\": \"1\", \"model\": \"room.pov\"}",
                                         "{\"retex-studio\": 2, \"model\": \"room.pov\"}"};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        assert_null(project_parse(others[k], strlen(others[k]), &model, NULL));
    static const char least[] = "{\"retex-studio\": 1, \"model\": \"room.pov\"}";
    json_t *project = project_parse(least, strlen(least), &model, NULL);
    assert_non_null(project);
    json_decref(project);
}

/* Whatever bytes a project has, the sets of one that is taken lie below the model's folder. */
static void test_broken_projects(void **state)
{
    static const char signs[] = "\"{}[]:,.-/\\01e\x7f\xc3\n";
    json_t *root = project_with(NULL, NULL);
    char *text = json_dumps(root, 0), *broken = strdup(text);
    const size_t bytes = strlen(text);
    uint32_t random = 1;
    int taken = 0;
    (void)state;
    for (int k = 0; k < 20000; k++) {
        memcpy(broken, text, bytes);
        for (int n = 0; n <= k % 3; n++)
            broken[(size_t)(test_random(&random) * (double)bytes)] =
                signs[(size_t)(test_random(&random) * (sizeof signs - 1))];
        json_t *project = project_parse(broken, bytes, &model, NULL);
        const char *set =
            json_string_value(json_object_get(json_array_get(json_object_get(project, "renders"), 0), "set"));
        if (set && (strncmp(set, "room.pov.studio/", 16) != 0 || strstr(set, "..") || strstr(set, "/-") ||
                    strpbrk(set, "\n\x7f")))
            fail_msg("%s", set);
        taken += project != NULL;
        json_decref(project);
    }
    assert_true(taken > 1000 && taken < 15000);
    free(broken);
    free(text);
    json_decref(root);
}

/* ---- connections without the token ---- */

/* Whether the other end of a pair of sockets has been ended. */
static int is_ended(int socket)
{
    char byte;
    return recv(socket, &byte, 1, MSG_DONTWAIT) == 0;
}

static void test_strangers(void **state)
{
    enum { ALL = STRANGERS_MOST + 3 };
    Strangers strangers;
    int pairs[ALL][2];
    (void)state;
    strangers_open(&strangers);
    for (int k = 0; k < ALL; k++) {
        assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, pairs[k]), 0);
        strangers_add(&strangers, pairs[k][0]);
        if (k == 1) /* it has shown the token */
            strangers_remove(&strangers, pairs[k][0]);
    }
    for (int k = 0; k < ALL; k++)
        assert_int_equal(is_ended(pairs[k][1]), k == 0 || k == 2);
    for (int k = 0; k < ALL; k++) {
        strangers_remove(&strangers, pairs[k][0]);
        close(pairs[k][0]);
        close(pairs[k][1]);
    }
    assert_int_equal(strangers.count, 0);
    strangers_close(&strangers);
}

/* ---- files that are sent ---- */

static void test_names(void **state)
{
    static const struct {
        const char *name, *clean; /* NULL: nothing is left */
    } names[] = {
        {"oak.jpg", "oak.jpg"},
        {"a/b\\c.jpg", "a/b/c.jpg"},
        {"/etc//passwd", "etc/passwd"},
        {"../../.ssh/id", "_ssh/id"},
        {"./a/../b", "a/b"},
        {"...", "_.."},
        {"-o", "_o"},
        {"a:b*c?\"<>|\n\177", "a_b_c_______"},
        {"B\xc3\xb6"
         "den/\xf0\x9f\xaa\xb5.png",
         "B\xc3\xb6"
         "den/\xf0\x9f\xaa\xb5.png"},
        {"1/2/3/4/5/6/7/8", "1/2/3/4/5/6/7/8"},
        {"1/2/3/4/5/6/7/8/9", NULL},
        {"", NULL},
        {"/", NULL},
        {"..", NULL},
        {"./..\\", NULL},
    };
    char clean[1024], name[300];
    (void)state;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        const int is_right = received_clean_name(names[k].name, clean, sizeof clean);
        if (is_right != !!names[k].clean || (is_right && strcmp(clean, names[k].clean) != 0))
            fail_msg("%s: %d, %s", names[k].name, is_right, clean);
    }
    for (int length = 1; length < 299; length++) { /* of whole characters, within what a file system takes */
        memset(name, 0, sizeof name);
        for (int k = 0; k + 1 < length; k += 2)
            memcpy(name + k, "\xc3\xb6", 2);
        if (length % 2)
            memmove(name + 1, name, (size_t)length - 1), name[0] = 'x';
        assert_true(received_clean_name(name, clean, sizeof clean));
        assert_true(strlen(clean) <= 120 && strlen(clean) + 1 >= (size_t)(length < 120 ? length : 120));
        assert_int_equal((strlen(clean) - (clean[0] == 'x')) % 2, 0);
    }
    for (size_t size = 1; size < 12; size++)
        assert_int_equal(received_clean_name("ab/cd/efg", clean, size), size > 9);
}

static int begin_file(Received *received, const char *name, uint64_t length, RetexError *err)
{
    char files[PATH_MAX + 8];
    const int top = beneath_open_top("files", 1);
    snprintf(files, sizeof files, "%s/files", folder);
    return received_begin(received, top, files, name, length, err);
}

static void send_file(const char *name, const char *text, const char *wanted)
{
    char path[PATH_MAX], whole[PATH_MAX + 64];
    Received received;
    assert_int_equal(begin_file(&received, name, strlen(text), NULL), 0);
    for (const char *c = text; *c; c++)
        assert_int_equal(received_bytes(&received, c, 1, NULL), 0);
    assert_int_equal(received_end(&received, path, NULL), 0);
    received_drop(&received); /* does nothing any more */
    snprintf(whole, sizeof whole, "%s/files/%s", folder, wanted);
    assert_string_equal(path, whole);
    expect_file(path, text);
}

static int nfiles;
static int count_file(const char *path, const struct stat *info, int kind, struct FTW *walk)
{
    (void)path, (void)info, (void)walk;
    nfiles += kind == FTW_F;
    return 0;
}

static void test_received(void **state)
{
    char path[PATH_MAX];
    RetexError err;
    Received received;
    (void)state;
    send_file("oak.jpg", "oak", "oak.jpg");
    send_file("oak.jpg", "oak", "oak.jpg");
    send_file("oak.jpg", "elm", "oak-2.jpg");
    send_file("oak.jpg", "elm", "oak-2.jpg");
    send_file("oak.jpg", "ash", "oak-3.jpg");
    send_file("room/room.gltf", "", "room/room.gltf");
    send_file("Makefile", "x", "Makefile");
    send_file("Makefile", "y", "Makefile-2");
    assert_int_equal(begin_file(&received, "half", 0, NULL), 0);
    assert_int_equal(received_bytes(&received, "half", 4, NULL), 0);
    received_drop(&received);
    received_drop(&received);
    assert_int_equal(begin_file(&received, "large", RECEIVED_MOST + 1, &err), RETEX_ELIMIT);
    assert_int_equal(begin_file(&received, "..", 0, NULL), RETEX_EINVAL);
    assert_int_equal(mkdir("far", 0777) || symlink("../far", "files/out"), 0);
    assert_int_equal(begin_file(&received, "out/x", 0, NULL), RETEX_EACCESS);
    assert_int_equal(symlink("../far/x", "files/x"), 0); /* a link is no file of this name */
    send_file("x", "x", "x-2");
    assert_int_equal(nftw("files", count_file, 8, FTW_PHYS) || nfiles != 7, 0);
    assert_int_equal(access("far/x", F_OK), -1);
    assert_int_equal(begin_file(&received, "gone", 0, NULL), 0);
    assert_int_equal(unlinkat(received.top, received.temporary, 0), 0);
    assert_int_equal(received_end(&received, path, &err), RETEX_EIO);
}

/* What a dead server has left goes, what is being received stays. */
static void test_tidy(void **state)
{
    char path[PATH_MAX];
    Received received;
    (void)state;
    assert_int_equal(begin_file(&received, "a/oak.jpg", 0, NULL), 0);
    assert_int_equal(received_bytes(&received, "oak", 3, NULL), 0);
    close(open("files/.incoming-1-0", O_CREAT | O_WRONLY, 0666));
    close(open("files/incoming-1-0", O_CREAT | O_WRONLY, 0666));
    assert_int_equal(symlink("incoming-1-0", "files/.incoming-2-0"), 0);
    const int top = beneath_open_top("files", 0);
    received_tidy(top);
    close(top);
    assert_int_equal(access("files/.incoming-1-0", F_OK), -1);
    assert_int_equal(access("files/incoming-1-0", F_OK), 0);
    assert_int_equal(received_end(&received, path, NULL), 0);
    expect_file("files/a/oak.jpg", "oak");
}

/* ---- files that are served ---- */

static void test_types(void **state)
{
    static const struct {
        const char *name, *type;
    } data[] = {
        {"a.b/room.JSON", "application/json"},
        {"x.JPEG", "image/jpeg"},
        {"x.exr", "image/x-exr"},
        {"x.avif", "image/avif"},
        {"x.svg", NULL},
        {"index.html", NULL},
        {"x.HTM", NULL},
        {"x.xhtml", NULL},
        {"x.xml", NULL},
        {"studio.js", NULL},
        {"x.mjs", NULL},
        {"x.css", NULL},
        {"x.txt", NULL},
        {"x.pdf", NULL},
        {"x.gltf", NULL},
        {"html", NULL},
        {"", NULL},
        {"x.json.html", NULL},
    };
    (void)state;
    for (size_t k = 0; k < sizeof data / sizeof *data; k++)
        assert_string_equal(media_type(data[k].name, 0), data[k].type ? data[k].type : "application/octet-stream");
    assert_string_equal(media_type("studio.js", 1), "text/javascript; charset=utf-8");
    assert_string_equal(media_type("index.html", 1), "text/html; charset=utf-8");
    assert_string_equal(media_type("x.svg", 1), "application/octet-stream");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tokens),
        cmocka_unit_test(test_who_may_ask),
        cmocka_unit_test_setup_teardown(test_lines, open_model, close_model),
        cmocka_unit_test_setup_teardown(test_what_is_no_job, open_model, close_model),
        cmocka_unit_test_setup_teardown(test_outputs, open_model, close_model),
        cmocka_unit_test_setup_teardown(test_projects, open_model, close_model),
        cmocka_unit_test_setup_teardown(test_broken_projects, open_model, close_model),
        cmocka_unit_test(test_strangers),
        cmocka_unit_test(test_names),
        cmocka_unit_test_setup_teardown(test_received, enter_folder, leave_folder),
        cmocka_unit_test_setup_teardown(test_tidy, enter_folder, leave_folder),
        cmocka_unit_test(test_types),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
