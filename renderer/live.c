/* --live: a scene that stays open, and requests for pictures of it. Requests are lines on standard input; each answer
 * on standard output is a line of JSON, whose last member, "bytes", tells how much data follow it.
 *
 * One loop does all: it reads a line, or gives the view that is shown some more samples. Threads that trace paths look
 * at standard input themselves, so that a line does not wait. */
#include <errno.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <retex/clock.h>
#include <retex/host/half.h>
#include "common/json_text.h"
#include "render/live.h"
#include "render/surfaces.h"
#include "render/uv_scale.h"
#include "retex-render.h"

enum { LINE_SIZE = 1024, WORDS_MAX = 8 };

typedef struct Live {
    Arguments *arguments;
    Scene *scene;
    LiveRender *render;
    char line[LINE_SIZE]; /* what has been read of the next one */
    size_t used;
    int is_too_long;      /* the rest of it is skipped */
    int has_ended;        /* standard input */
    atomic_int is_called; /* there is something to read */
    int is_viewing;       /* the view has not got all of its samples */
    double began;         /* by the clock */
    SceneSurfaces known;  /* once surfaces were asked for */
    float *rgb;           /* of a picture */
    uint16_t *halves;
} Live;

/* ---- answers ---- */

/* Ends the line that the caller has begun, `{…`. */
static void end_answer(const Live *l, const void *data, size_t bytes)
{
    printf(",\"bytes\":%zu}\n", bytes);
    if (bytes)
        fwrite(data, 1, bytes, stdout);
    fflush(stdout);
    cli_check_text(l->arguments->cli);
}

static void answer_error(const Live *l, const char *message)
{
    printf("{\"error\":");
    json_text(stdout, message);
    end_answer(l, NULL, 0);
}

static void print_point(const char *name, Vec3 p)
{
    printf("\"%s\":[%.9g,%.9g,%.9g]", name, p.x, p.y, p.z);
}

static void print_bounds(const Live *l)
{
    Vec3 low, high;
    live_bounds(l->render, &low, &high);
    printf(",\"bounds\":[[%.9g,%.9g,%.9g],[%.9g,%.9g,%.9g]]", low.x, low.y, low.z, high.x, high.y, high.z);
}

static void print_cameras(const Scene *scene)
{
    printf(",\"cameras\":[");
    for (int k = 0; k < scene->ncameras; k++) {
        const Camera *camera = &scene->cameras[k].camera;
        printf("%s{\"name\":", k ? "," : "");
        json_text(stdout, scene->cameras[k].name);
        putchar(',');
        print_point("eye", camera->location);
        putchar(',');
        print_point("at", vec_add(camera->location, vec_normalize(camera->direction)));
        printf(",\"angle\":%.9g}", camera_angle(camera));
    }
    printf("]");
}

static void greet(const Live *l)
{
    const Scene *scene = l->scene;
    const RenderParams *r = &l->arguments->render;
    printf("{\"live\":1,\"camera\":{");
    print_point("eye", scene->camera.location);
    putchar(',');
    print_point("at", live_middle(l->render));
    printf(",\"angle\":%.9g,", camera_angle(&scene->camera));
    print_point("up", vec_normalize(scene->camera.sky));
    putchar(',');
    print_point("right", vec_normalize(scene->camera.right));
    print_bounds(l);
    printf("}");
    print_cameras(scene);
    printf(",\"width\":%d,\"height\":%d", r->width > 0 ? r->width : scene->width,
           r->height > 0 ? r->height : scene->height);
    end_answer(l, NULL, 0);
}

/* ---- pictures ---- */

static int make_room(Live *l, int width, int height, RetexError *err)
{
    const size_t pixels = (size_t)width * (size_t)height;
    free(l->rgb);
    free(l->halves);
    l->rgb = malloc(pixels * 3 * sizeof *l->rgb);
    l->halves = malloc(pixels * 4 * sizeof *l->halves);
    return l->rgb && l->halves ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory for the picture");
}

static void show(const Live *l, const float *rgb, int is_denoised)
{
    const FirstHitWindow window = live_window(l->render);
    const size_t pixels = (size_t)window.w * (size_t)window.h;
    for (size_t k = 0; k < pixels; k++) {
        const float rgba[4] = {rgb[3 * k], rgb[3 * k + 1], rgb[3 * k + 2], 1};
        retex_half_from_float(l->halves + 4 * k, rgba, 4);
    }
    printf("{\"picture\":%d%s,\"width\":%d,\"height\":%d,\"seconds\":%.3f", live_samples(l->render),
           is_denoised ? ",\"denoised\":1" : "", window.w, window.h, retex_clock_seconds() - l->began);
    end_answer(l, l->halves, pixels * 4 * sizeof *l->halves);
}

/* ---- requests ---- */

static int has_input(int milliseconds)
{
    struct pollfd input = {STDIN_FILENO, POLLIN, 0};
    return poll(&input, 1, milliseconds) > 0;
}

/* A StopAsked. */
static int is_called(void *context)
{
    Live *l = context;
    if (!atomic_load(&l->is_called) && has_input(0))
        atomic_store(&l->is_called, 1);
    return atomic_load(&l->is_called);
}

/* WIDTH HEIGHT CAMERA: turn to that view. */
static int look(Live *l, char **words, RetexError *err)
{
    RenderParams params = l->arguments->render;
    CameraView view;
    const int is_own = strcmp(words[2], "-") == 0;
    if (!job_numbers(words[0], 0, 1, &params.width) || !job_numbers(words[1], 0, 1, &params.height) ||
        params.width < 1 || params.height < 1)
        return retex_fail(err, RETEX_EPARSE, "expected WIDTH HEIGHT, not `%s %s`", words[0], words[1]);
    memset(params.crop, 0, sizeof params.crop);
    int code = is_own ? RETEX_OK : camera_view_read(&view, words[2], err);
    if (!code)
        code = job_check_size(l->scene, &params, err);
    if (code)
        return code;
    l->is_viewing = 0;
    code = live_look(l->render, params.width, params.height, is_own ? NULL : &view, err);
    return code ? code : make_room(l, params.width, params.height, err);
}

static int request_view(Live *l, char **words, RetexError *err)
{
    int spp;
    if (!job_numbers(words[3], 0, 1, &spp) || spp < 1 || spp > 1 << 20)
        return retex_fail(err, RETEX_EPARSE, "expected 1 to %d samples, not `%s`", 1 << 20, words[3]);
    l->began = retex_clock_seconds();
    int code = look(l, words, err);
    if (!code)
        code = live_begin(l->render, spp, err);
    l->is_viewing = !code;
    return code;
}

static int request_stop(Live *l, char **words, RetexError *err)
{
    (void)words, (void)err;
    l->is_viewing = 0;
    return RETEX_OK;
}

/* Of the view as it is, which goes on. A line ends it, without an answer. */
static int request_denoise(Live *l, char **words, RetexError *err)
{
    const StopAsked stop = {is_called, l};
    (void)words;
    atomic_store(&l->is_called, memchr(l->line, '\n', l->used) != NULL);
    const int code = live_denoise(l->render, &stop, l->rgb, err);
    if (!code)
        show(l, l->rgb, 1);
    return code == RETEX_ESTOPPED ? RETEX_OK : code;
}

static void print_surfaces(const Surfaces *all)
{
    static const char *const scopes[] = {
        [SCOPE_OBJECT] = "object", [SCOPE_MATERIAL] = "material", [SCOPE_FLAT] = "flat", [SCOPE_LEVEL] = "level"};
    printf("{\"surfaces\":[");
    for (int k = 0; k < all->count; k++) {
        const SeenSurface *one = &all->list[k];
        printf("%s{\"kind\":\"%s\",\"text\":", k ? "," : "", scopes[one->scope]);
        json_text(stdout, one->text);
        printf(",\"name\":");
        json_text(stdout, one->name ? one->name : "");
        printf(",\"share\":%.6g}", one->share);
    }
    printf("]");
}

static int request_surfaces(Live *l, char **words, RetexError *err)
{
    RetexBudget *budget = l->arguments->cli->budget;
    Surfaces all;
    int code = look(l, words, err);
    if (!code && !l->known.scene)
        code = scene_surfaces_open(&l->known, l->scene, err);
    const FirstHitWindow window = live_window(l->render);
    if (!code)
        code = surfaces_find(&all, &l->known, &window, budget, err);
    if (code)
        return code;
    print_surfaces(&all);
    printf(",\"width\":%d,\"height\":%d", window.w, window.h);
    end_answer(l, all.planes, SURFACE_SCOPES * (size_t)window.w * (size_t)window.h * sizeof *all.planes);
    surfaces_close(&all, budget);
    return RETEX_OK;
}

/* u and v in metres, where a unit of them has a length. */
static void measure(const FirstHitWindow *w, const double units[][2], const uint16_t *targets, float *u, float *v)
{
    for (size_t k = 0; k < (size_t)w->w * (size_t)w->h; k++) {
        const double *unit = targets[k] ? units[targets[k] - 1] : NULL;
        if (unit && unit[0] > 0 && unit[1] > 0)
            u[k] = (float)((double)u[k] * unit[0]), v[k] = (float)((double)v[k] * unit[1]);
    }
}

static void print_units(const Scene *scene, const double units[][2])
{
    printf("{\"uv\":[");
    for (int t = 0; t < scene->ntargets; t++) {
        printf("%s{\"target\":", t ? "," : "");
        json_text(stdout, scene->targets[t].name);
        printf(",\"unit\":[%.9g,%.9g]}", units[t][0], units[t][1]);
    }
    printf("]");
}

static int request_uv(Live *l, char **words, RetexError *err)
{
    double units[RETEX_MAX_TARGETS][2];
    int code = look(l, words, err);
    const FirstHitWindow w = live_window(l->render);
    if (!code)
        code = uv_scale_measure(l->scene, w.accel, units, err);
    if (code)
        return code;
    const size_t pixels = (size_t)w.w * (size_t)w.h, bytes = pixels * (sizeof(uint16_t) + 2 * sizeof(float));
    uint16_t *targets = malloc(bytes);
    if (!targets)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for UV");
    float *u = l->rgb, *v = u + pixels; /* there is room for a picture */
    for (int t = 0; t < l->scene->ntargets; t++)
        for (int k = 0; k < 2; k++)
            units[t][k] *= l->arguments->render.unit;
    surfaces_uv(&w, targets, u, v);
    measure(&w, (const double(*)[2])units, targets, u, v);
    memcpy(targets + pixels, u, 2 * pixels * sizeof *u);
    print_units(l->scene, (const double(*)[2])units);
    printf(",\"width\":%d,\"height\":%d", w.w, w.h);
    end_answer(l, targets, bytes);
    free(targets);
    return RETEX_OK;
}

static const struct Request {
    const char *name;
    int nwords; /* after it */
    const char *usage;
    int (*answer)(Live *live, char **words, RetexError *err);
} requests[] = {{"view", 4, "view WIDTH HEIGHT CAMERA SPP", request_view},
                {"denoise", 0, "denoise", request_denoise},
                {"surfaces", 3, "surfaces WIDTH HEIGHT CAMERA", request_surfaces},
                {"uv", 3, "uv WIDTH HEIGHT CAMERA", request_uv},
                {"stop", 0, "stop", request_stop}};

static int answer_line(Live *l, char *line, RetexError *err)
{
    char *words[WORDS_MAX + 1], *rest = NULL;
    int count = 0;
    for (char *word = strtok_r(line, " \t\r", &rest); word && count <= WORDS_MAX; word = strtok_r(NULL, " \t\r", &rest))
        words[count++] = word;
    if (!count)
        return RETEX_OK;
    for (size_t k = 0; k < sizeof requests / sizeof *requests; k++)
        if (strcmp(words[0], requests[k].name) == 0)
            return count - 1 == requests[k].nwords ? requests[k].answer(l, words + 1, err)
                                                   : retex_fail(err, RETEX_EPARSE, "expected %s", requests[k].usage);
    return retex_fail(err, RETEX_EPARSE, "there is no request `%.100s`", words[0]);
}

/* ---- standard input ---- */

static void read_some(Live *l)
{
    const ssize_t got = read(STDIN_FILENO, l->line + l->used, sizeof l->line - l->used);
    if (got > 0)
        l->used += (size_t)got;
    else if (got == 0 || (errno != EINTR && errno != EAGAIN))
        l->has_ended = 1;
}

/* Take the line off that has been read whole. 0: there is none. */
static int take_line(Live *l, char line[LINE_SIZE])
{
    char *end = memchr(l->line, '\n', l->used);
    const int is_too_long = l->is_too_long;
    if (!end) {
        l->is_too_long |= l->used == sizeof l->line;
        l->used = l->is_too_long ? 0 : l->used;
        return 0;
    }
    const size_t length = (size_t)(end - l->line);
    memcpy(line, l->line, length);
    line[length] = 0;
    l->used -= length + 1;
    memmove(l->line, end + 1, l->used);
    l->is_too_long = 0;
    if (is_too_long || strlen(line) != length) {
        answer_error(l, "a line has at most 1023 bytes, and no NUL");
        return take_line(l, line);
    }
    return 1;
}

/* Wait for a line where there is nothing else to do. 0: there is none, or standard input has ended. */
static int next_line(Live *l, char line[LINE_SIZE])
{
    while (!take_line(l, line)) {
        if (l->has_ended || (!has_input(l->is_viewing ? 0 : -1) && l->is_viewing))
            return 0;
        read_some(l);
    }
    return 1;
}

/* ---- */

/* Some more samples for the view. */
static int improve(Live *l, RetexError *err)
{
    const StopAsked stop = {is_called, l};
    const int had = live_samples(l->render);
    atomic_store(&l->is_called, 0);
    const int code = live_improve(l->render, &stop, err);
    if (code || live_samples(l->render) == had)
        return code;
    live_picture(l->render, l->rgb);
    show(l, l->rgb, 0);
    l->is_viewing = live_samples(l->render) < live_samples_wanted(l->render);
    return RETEX_OK;
}

static int serve(Live *l, RetexError *err)
{
    char line[LINE_SIZE];
    while (!l->has_ended) {
        RetexError why = {0};
        int code = RETEX_OK;
        if (next_line(l, line) && answer_line(l, line, &why))
            answer_error(l, why.message);
        else if (!l->has_ended && l->is_viewing)
            code = improve(l, err);
        if (!code)
            code = retex_budget_check(l->arguments->cli->budget, err);
        if (code)
            return code;
    }
    return RETEX_OK;
}

int live(Arguments *a, Scene *scene, RetexError *err)
{
    Live l = {.arguments = a, .scene = scene};
    retex_budget_set_seconds(a->cli->budget, 0); /* the limit is for opening the scene */
    int code = live_open(&l.render, scene, &a->render, err);
    if (!code) {
        greet(&l);
        code = serve(&l, err);
    }
    live_close(&l.render);
    scene_surfaces_close(&l.known);
    free(l.rgb);
    free(l.halves);
    return code;
}
