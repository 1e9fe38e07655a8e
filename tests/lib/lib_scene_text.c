/* See lib_scene_text.h. */
#include "lib_scene_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "shade/pigment.h"

char messages[8192];

static void collect(void *context, int level, const char *text)
{
    (void)context;
    (void)level;
    size_t used = strlen(messages);
    snprintf(messages + used, sizeof messages - used, "%s\n", text);
}

int parse_with(Scene **scene, const char *text, SdlOptions *options, RetexError *err)
{
    char path[] = "/tmp/test_scene_XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    size_t length = strlen(text);
    assert_int_equal(write(file, text, length), (ssize_t)length);
    close(file);
    messages[0] = 0;
    options->message = collect;
    int code = sdl_read(scene, path, options, &scene_builder, err);
    unlink(path);
    return code;
}

Scene *parse(const char *text)
{
    Scene *scene;
    RetexError err = {0};
    SdlOptions options = SDL_OPTIONS_INIT;
    if (parse_with(&scene, text, &options, &err))
        fail_msg("line %d column %d: %s", err.line, err.column, err.message);
    return scene;
}

void expect_error(const char *text, const char *part)
{
    Scene *scene;
    RetexError err = {0};
    SdlOptions options = SDL_OPTIONS_INIT;
    int code = parse_with(&scene, text, &options, &err);
    assert_int_not_equal(code, 0);
    assert_null(scene);
    assert_int_equal(err.code, code);
    if (!strstr(err.message, part))
        fail_msg("`%s` is not in the message `%s`", part, err.message);
}

void assert_near(double a, double b)
{
    if (!(fabs(a - b) <= 1e-6 * (1 + fabs(b))))
        fail_msg("%.9g is not %.9g", a, b);
}

void assert_vec(Vec3 a, double x, double y, double z)
{
    assert_near(a.x, x);
    assert_near(a.y, y);
    assert_near(a.z, z);
}

void assert_color(Rgbft c, double r, double g, double b)
{
    assert_near(c.r, r);
    assert_near(c.g, g);
    assert_near(c.b, b);
}

const Primitive *only(const Scene *scene)
{
    assert_int_equal(scene->nprimitives, 1);
    return &scene->primitives[0];
}

Rgbft color_at(const Primitive *p, double x, double y, double z)
{
    return pigment_eval(p->texture->pigment, vec3(x, y, z), (Vec2){x, y});
}
