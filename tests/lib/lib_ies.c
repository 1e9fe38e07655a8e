/* See lib_ies.h. */
#include "lib_ies.h"
#include "lib_folder.h"
#include "lib_test.h"

#include <stdio.h>

#include <cmocka.h>

static double angle(TestAngles angles, int k)
{
    return angles.count < 2 ? angles.first : angles.first + (angles.last - angles.first) * k / (angles.count - 1);
}

static void write_angles(FILE *file, TestAngles angles)
{
    for (int k = 0; k < angles.count; k++)
        fprintf(file, "%.9g%s", angle(angles, k), k % 10 == 9 ? "\n" : " ");
    fputc('\n', file);
}

const char *test_ies(const char *name, TestAngles vertical, TestAngles horizontal, TestIntensity *intensity)
{
    const char *path = test_in_folder(name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "IESNA:LM-63-2002\n[TEST] written by a test\nTILT=NONE\n1 1000 1 %d %d 1 2 0 0 0\n1 1 10\n",
            vertical.count, horizontal.count);
    write_angles(file, vertical);
    write_angles(file, horizontal);
    for (int i = 0; i < horizontal.count; i++)
        for (int k = 0; k < vertical.count; k++)
            fprintf(file, "%.9g%s", intensity(angle(vertical, k), angle(horizontal, i)),
                    k % 10 == 9 || k == vertical.count - 1 ? "\n" : " ");
    assert_int_equal(fclose(file), 0);
    return path;
}

const char *test_ies_text(const char *name, const char *text)
{
    const char *path = test_in_folder(name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
    return path;
}
