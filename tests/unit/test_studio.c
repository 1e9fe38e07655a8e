/* Parts of retex-studio without a server: who may ask, command lines of jobs, files that are sent and served. */
#include "lib_test.h"
#include <cmocka.h>

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "studio/gate.h"
#include "studio/job_line.h"
#include "studio/media.h"

static char folder[PATH_MAX]; /* the current one, by its real name */

static int enter_folder(void **state)
{
    char name[] = "/tmp/retex-test-XXXXXX";
    (void)state;
    return !mkdtemp(name) || !realpath(name, folder) || chdir(folder);
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *walk)
{
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

static int leave_folder(void **state)
{
    (void)state;
    return chdir("/") || nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
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
    return 0;
}

static int make_line(Line *line, const char *tool, json_t *args, const ProgramLimits *limits, RetexError *err)
{
    const int code = line_make(line, tool, args, limits, &model, err);
    json_decref(args);
    return code;
}

static void test_lines(void **state)
{
    static const ProgramLimits safe = {0, 512 << 20}, no_memory = {0, 0}, unsafe = {1, 512 << 20};
    static const struct {
        const ProgramLimits *limits;
        const char *words[8];
    } lines[] = {{&safe, {"--safe", "--max-time", "10000000", "--max-memory", "512M", "a b", "--", "-oc"}},
                 {&no_memory, {"--safe", "--max-time", "10000000", "a b", "--", "-oc"}},
                 {&unsafe, {"a b", "--", "-oc"}}};
    Line line;
    (void)state;
    for (int k = 0; k < 3; k++) {
        int count = 0;
        assert_int_equal(
            make_line(&line, "retex-info", json_pack("[s, s, s]", "a b", "--", "-oc"), lines[k].limits, NULL),
            k < 2 ? RETEX_EINVAL : 0); /* of a name that only looks like an output, too */
        if (k < 2)
            assert_int_equal(make_line(&line, "retex-info", json_pack("[s]", "a b"), lines[k].limits, NULL), 0);
        assert_string_equal(strrchr(line.words[0], '/'), "/retex-info");
        assert_int_equal(line.words[0][0], '/');
        for (; count + 1 < line.count; count++)
            assert_string_equal(line.words[count + 1], lines[k].words[count]);
        assert_int_equal(count, k == 0 ? 6 : k == 1 ? 4 : 3);
        assert_null(line.words[line.count]);
        line_free(&line);
    }
    assert_int_equal(line_make_live(&line, "-o x.pov", NULL, &safe, &model, NULL), 0);
    assert_string_equal(line.words[line.count - 3], "--live");
    assert_string_equal(line.words[line.count - 2], "--");
    assert_string_equal(line.words[line.count - 1], "-o x.pov");
    line_free(&line);
    json_t *list = json_pack("[s, s]", "--list-lamps", "room.pov"), *render = json_pack("[s, s]", "-q", "room.pov");
    assert_true(line_is_long("retex-render", render) && line_is_long("retex-denoise", render));
    assert_false(line_is_long("retex-info", render) || line_is_long("sh", render));
    assert_false(line_is_long("retex-render", list));
    json_decref(list);
    json_decref(render);
}

static void test_what_is_no_job(void **state)
{
    static const ProgramLimits safe = {0, 512 << 20};
    static const char *const tools[] = {"retex", "retex-serve", "retex-studio", "../bin/retex-info", "/bin/sh",
                                        "",      NULL};
    json_t *many = json_array(), *long_word;
    char *word = calloc(LINE_BYTES + 2, 1);
    Line line;
    (void)state;
    for (int k = 0; k < 7; k++)
        assert_int_equal(make_line(&line, tools[k], NULL, &safe, NULL), RETEX_EINVAL);
    assert_int_equal(make_line(&line, "retex-info", json_string("-q"), &safe, NULL), RETEX_EINVAL);
    assert_int_equal(make_line(&line, "retex-info", json_pack("[s, i]", "-q", 1), &safe, NULL), RETEX_EINVAL);
    for (int k = 0; k < LINE_WORDS; k++)
        json_array_append_new(many, json_string("x"));
    assert_int_equal(make_line(&line, "retex-info", many, &safe, NULL), RETEX_EINVAL);
    memset(word, 'x', LINE_BYTES + 1);
    long_word = json_pack("[s]", word);
    assert_int_equal(make_line(&line, "retex-info", long_word, &safe, NULL), RETEX_EINVAL);
    assert_null(line.words);
    assert_int_equal(line_make(&line, "retex-info", NULL, &safe, NULL, NULL), RETEX_EINVAL);
    free(word);
}

static void test_outputs(void **state)
{
    static const ProgramLimits safe = {0, 0}, unsafe = {1, 0};
    static const struct {
        const char *first, *second;
        int is_right;
    } outputs[] = {
        {"-o", "room.pov.studio/x.exr", 1},
        {"-oroom.pov.studio/a/b/x.exr", "y", 1},
        {"-qvo", "room.pov.studio/x.exr", 1},
        {"--output=room.pov.studio/x.exr", "y", 1},
        {"--output", "-", 1},
        {"--outputs", "x.exr", 1}, /* no option of any tool */
        {"-o", "x.exr", 0},
        {"-ox.exr", "y", 0},
        {"-qox.exr", "y", 0},
        {"-vqo", "../x.exr", 0},
        {"--output", "/tmp/x.exr", 0},
        {"--output=room.pov.studio/../x.exr", "y", 0},
        {"-o", "room.pov.studio.exr", 0},
        {"-o", "room.pov.studio/out/x.exr", 0}, /* through a link */
        {"-o", "", 0},
    };
    char far[] = "/tmp/retex-test-XXXXXX";
    Line line;
    (void)state;
    assert_non_null(mkdtemp(far));
    assert_int_equal(places_make_written(&model, NULL), 0);
    assert_int_equal(symlink(far, "room.pov.studio/out"), 0);
    for (size_t k = 0; k < sizeof outputs / sizeof *outputs; k++) {
        json_t *args = json_pack("[s, s]", outputs[k].first, outputs[k].second);
        const int code = line_make(&line, "retex-render", args, &safe, &model, NULL);
        if ((code == 0) != outputs[k].is_right)
            fail_msg("%s %s: %d", outputs[k].first, outputs[k].second, code);
        line_free(&line);
        assert_int_equal(line_make(&line, "retex-render", args, &unsafe, &model, NULL), 0);
        line_free(&line);
        json_decref(args);
    }
    assert_int_equal(access("room.pov.studio/a/b", F_OK), 0);
    assert_int_equal(rmdir(far), 0);
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

static void send_file(const char *name, const char *text, const char *wanted)
{
    char path[PATH_MAX], whole[PATH_MAX + 64];
    Received received;
    assert_int_equal(received_begin(&received, "files", name, strlen(text), NULL), 0);
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
    assert_int_equal(received_begin(&received, "files", "half", 0, NULL), 0);
    assert_int_equal(received_bytes(&received, "half", 4, NULL), 0);
    received_drop(&received);
    received_drop(&received);
    assert_int_equal(received_begin(&received, "files", "large", RECEIVED_MOST + 1, &err), RETEX_ELIMIT);
    assert_int_equal(received_begin(&received, "files", "..", 0, NULL), RETEX_EINVAL);
    assert_int_equal(mkdir("far", 0777) || symlink("../far", "files/out"), 0);
    assert_int_equal(received_begin(&received, "files", "out/x", 0, NULL), RETEX_EACCESS);
    assert_int_equal(symlink("../far/x", "files/x"), 0); /* a link is no file of this name */
    send_file("x", "x", "x-2");
    assert_int_equal(nftw("files", count_file, 8, FTW_PHYS) || nfiles != 7, 0);
    assert_int_equal(access("far/x", F_OK), -1);
    assert_int_equal(received_begin(&received, "files", "gone", 0, NULL), 0);
    assert_int_equal(unlink(received.temporary), 0);
    assert_int_equal(received_end(&received, path, &err), RETEX_EIO);
}

/* ---- files that are served ---- */

static void test_types(void **state)
{
    (void)state;
    assert_string_equal(media_type("a.b/room.JSON", 0), "application/json");
    assert_string_equal(media_type("studio.js", 1), "text/javascript; charset=utf-8");
    assert_string_equal(media_type("studio.js", 0), "application/octet-stream");
    assert_string_equal(media_type("x.JPEG", 0), "image/jpeg");
    assert_string_equal(media_type("x.svg", 1), "application/octet-stream");
    assert_string_equal(media_type("html", 1), "application/octet-stream");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tokens),
        cmocka_unit_test(test_who_may_ask),
        cmocka_unit_test_setup_teardown(test_lines, open_model, leave_folder),
        cmocka_unit_test_setup_teardown(test_what_is_no_job, open_model, leave_folder),
        cmocka_unit_test_setup_teardown(test_outputs, open_model, leave_folder),
        cmocka_unit_test(test_names),
        cmocka_unit_test_setup_teardown(test_received, enter_folder, leave_folder),
        cmocka_unit_test(test_types),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
