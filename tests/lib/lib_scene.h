/* Scenes that a test writes itself. */
#ifndef LIB_SCENE_H
#define LIB_SCENE_H

#include "lib_test.h"

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "sdl/lang/parser.h"
#include "sdl/statements.h"

/* Parsed, or the test fails. */
static inline Scene *test_scene(const char *text)
{
    char path[] = "/tmp/retex-scene-XXXXXX";
    int file = mkstemp(path);
    RetexError err = {0};
    Scene *scene;
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (long)strlen(text));
    close(file);
    if (sdl_read(&scene, path, NULL, &scene_builder, &err))
        fail_msg("%d:%d: %s", err.line, err.column, err.message);
    unlink(path);
    return scene;
}

#endif
