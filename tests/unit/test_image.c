/* Images: memory and regions, round trips of EXR files, and files that cannot be written. */
#include "lib_folder.h"
#include "base/image.h"
#include "lib_test.h"
#include <cmocka.h>

#include <fcntl.h>
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "exr/io.h"
#include "io/output.h"

static void test_errors_quote_themselves(void **state)
{
    (void)state;
    RetexError err = {0};
    assert_int_equal(retex_fail(NULL, RETEX_EIO, "x"), RETEX_EIO);
    assert_int_equal(retex_fail_at(&err, RETEX_EPARSE, "a.pov", 3, 4, "%d", 7), RETEX_EPARSE);
    assert_int_equal(retex_fail_at(&err, RETEX_EPARSE, err.file, 5, 6, "[%s]", err.message), RETEX_EPARSE);
    assert_string_equal(err.message, "[7]");
    assert_string_equal(err.file, "a.pov");
    assert_int_equal(err.line, 5);
}

static void test_sizes_out_of_bounds(void **state)
{
    (void)state;
    static const int shapes[][3] = {{0, 1, 1},     {1, 0, 1},  {1, 1, 0}, {65537, 1, 1},
                                    {1, 65537, 1}, {1, 1, 65}, {-1, 1, 1}};
    for (size_t i = 0; i < sizeof shapes / sizeof shapes[0]; i++) {
        RetexImage im = {0};
        RetexError err = {0};
        assert_int_equal(retex_image_alloc(&im, shapes[i][0], shapes[i][1], shapes[i][2], &err), RETEX_EINVAL);
        assert_null(im.pixels);
    }
    RetexImage im = {0};
    assert_int_equal(retex_image_alloc(&im, 3, 2, 4, NULL), 0);
    assert_int_equal(retex_image_alloc(&im, 3, 2, 4, NULL), RETEX_EINVAL);
    for (int i = 0; i < 24; i++)
        assert_true(im.pixels[i] == 0);
    retex_image_free(&im);
    retex_image_free(&im);
    retex_image_free(NULL);
}

static void test_prepare_clips_and_checks(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexRoi out, asked = {-5, 2, 100, 3, 1, 9}, inverted = {8, 8, 2, 2, 0, 3};
    assert_int_equal(retex_image_prepare(&im, 10, 5, 3, &asked, &out, NULL), 0);
    assert_true(out.x0 == 0 && out.x1 == 10 && out.y0 == 2 && out.y1 == 3 && out.c0 == 1 && out.c1 == 3);
    assert_int_equal(retex_image_prepare(&im, 10, 5, 3, &inverted, &out, NULL), 0);
    assert_true(out.x1 <= out.x0 && out.y1 <= out.y0);
    assert_int_equal(retex_image_prepare(&im, 10, 5, 3, NULL, &out, NULL), 0);
    assert_true(out.x0 == 0 && out.x1 == 10 && out.y1 == 5 && out.c1 == 3);
    assert_int_equal(retex_image_prepare(&im, 10, 5, 4, NULL, &out, NULL), RETEX_EINVAL);
    retex_image_free(&im);
}

/* Within half a unit in the last place of a half. */
static int near_half(float value, float stored)
{
    return fabsf(value - stored) <= fabsf(value) / 2048 + 0x1p-25f;
}

static void test_exr_there_and_back(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 4; channels++) {
        RetexImage im = {0}, back = {0};
        RetexError err = {0};
        if (channels == 2)
            continue;
        test_random_image(&im, 53, 37, channels, (uint32_t)channels, 0.01, 3);
        if (channels == 4)
            for (int i = 0; i < 53 * 37; i++)
                im.pixels[4 * i + 3] = 0.5f;
        test_must(retex_image_write(&im, test_in_folder("a.exr"), NULL, 1, &err), &err);
        test_must(retex_image_read(&back, test_in_folder("a.exr"), NULL, 1, &err), &err);
        assert_true(back.width == 53 && back.height == 37 && back.channels == 4);
        for (int i = 0; i < 53 * 37; i++)
            for (int c = 0; c < 4; c++) {
                const size_t from = i * channels + (channels == 1 ? 0 : c);
                const float want = c == 3 ? (channels == 4 ? 0.5f : 1) : im.pixels[from];
                assert_true(near_half(want, back.pixels[4 * i + c]));
            }
        retex_image_free(&back);
        const RetexReadParams small = {.size = sizeof small, .max_pixels = 53 * 37 - 1, .pixel_bytes = 16};
        assert_int_equal(retex_image_read(&back, test_in_folder("a.exr"), &small, 1, &err), RETEX_ELIMIT);
        assert_null(back.pixels);
        retex_image_free(&im);
    }
    assert_int_equal(test_files_left(), 1);
}

static void test_exr_through_a_pipe(void **state)
{
    (void)state;
    RetexImage im = {0}, back = {0};
    RetexError err = {0};
    int ends[2];
    test_random_image(&im, 640, 301, 3, 5, 0, 2); /* more than a pipe holds */
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], 1);
        close(ends[0]);
        close(ends[1]);
        _exit(retex_image_write(&im, "-", NULL, 1, &err) != 0);
    }
    const int kept = dup(0);
    dup2(ends[0], 0);
    close(ends[0]);
    close(ends[1]);
    test_must(retex_image_read(&back, "-", NULL, 1, &err), &err);
    dup2(kept, 0);
    close(kept);
    int status = 1;
    waitpid(child, &status, 0);
    assert_int_equal(status, 0);
    for (int i = 0; i < 640 * 301; i++)
        assert_true(near_half(im.pixels[3 * i], back.pixels[4 * i]));
    retex_image_free(&im);
    retex_image_free(&back);
}

static void test_a_full_device_is_an_error(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexError err = {0};
    test_random_image(&im, 8, 8, 3, 1, 0, 1);
    assert_int_equal(retex_image_write(&im, "/dev/full", NULL, 1, &err), RETEX_EIO);
    assert_string_equal(err.message, "cannot write /dev/full: No space left on device");
    assert_int_equal(retex_image_write(&im, "/nowhere/at/all.exr", NULL, 1, &err), RETEX_EIO);
    assert_string_equal(err.message, "cannot write /nowhere/at/all.exr: No such file or directory");
    retex_image_free(&im);
}

static void write_text(RetexOutput *output, const char *text)
{
    RetexError err = {0};
    test_must(retex_output_write(output, text, strlen(text), &err), &err);
}

static void expect_text(const char *path, const char *text)
{
    char found[64] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    found[fread(found, 1, sizeof found - 1, file)] = 0;
    fclose(file);
    assert_string_equal(found, text);
}

static void test_output_is_old_or_new(void **state)
{
    (void)state;
    RetexOutput *output;
    RetexError err = {0};
    const char *path = test_in_folder("old");
    const int before = test_files_left();

    test_must(retex_output_open(&output, path, &err), &err);
    write_text(output, "first");
    assert_int_equal(access(path, F_OK), -1);
    test_must(retex_output_commit(&output, &err), &err);
    assert_null(output);
    expect_text(path, "first");
    chmod(path, 0640);

    test_must(retex_output_open(&output, path, &err), &err);
    write_text(output, "given up");
    retex_output_abandon(&output);
    retex_output_abandon(&output);
    expect_text(path, "first");

    test_must(retex_output_check(path, &err), &err);
    test_must(retex_output_check(test_in_folder("new"), &err), &err);
    test_must(retex_output_check("-", &err), &err);
    assert_int_equal(retex_output_check(test_folder, &err), RETEX_EIO);
    assert_int_equal(retex_output_check(test_in_folder("none/new"), &err), RETEX_EIO);
    test_must(retex_image_write_check(test_in_folder("new.png"), NULL, &err), &err);
    assert_int_equal(retex_image_write_check(test_in_folder("new.xyz"), NULL, &err), RETEX_EINVAL);
    assert_int_equal(test_files_left(), before + 1);

    /* a link is followed, permissions are kept */
    struct stat status;
    assert_int_equal(symlink("old", test_in_folder("link")), 0);
    test_must(retex_output_open(&output, test_in_folder("link"), &err), &err);
    write_text(output, "second");
    test_must(retex_output_commit(&output, &err), &err);
    expect_text(path, "second");
    assert_int_equal(lstat(test_in_folder("link"), &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);

    assert_int_equal(retex_output_open(&output, test_folder, &err), RETEX_EIO);
    assert_null(output);
    assert_int_equal(test_files_left(), before + 2);
}

static void test_the_manifest_part_is_an_image(void **state)
{
    (void)state;
    RetexSet *set = test_set(24, 16, 3);
    RetexImage im = {0};
    RetexError err = {0};
    test_must(retex_set_write(set, test_in_folder("set.exr"), NULL, 0, &err), &err);
    test_must(retex_image_read(&im, test_in_folder("set.exr"), NULL, 1, &err), &err);
    for (int i = 0; i < 24 * 16; i++)
        assert_true(near_half(set->parts[0].image.pixels[3 * i], im.pixels[4 * i]));
    retex_image_free(&im);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors_quote_themselves),  cmocka_unit_test(test_sizes_out_of_bounds),
        cmocka_unit_test(test_prepare_clips_and_checks), cmocka_unit_test(test_exr_there_and_back),
        cmocka_unit_test(test_exr_through_a_pipe),       cmocka_unit_test(test_a_full_device_is_an_error),
        cmocka_unit_test(test_output_is_old_or_new),     cmocka_unit_test(test_the_manifest_part_is_an_image),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
