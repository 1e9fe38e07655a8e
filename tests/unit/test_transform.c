/* Transforms, compared with POV-Ray's conventions, and the arena. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <string.h>
#include <cmocka.h>
#include "base/arena.h"
#include "base/vec.h"

static void assert_vec(Vec3 a, Vec3 b)
{
    assert_true(fabs(a.x - b.x) < 1e-12 && fabs(a.y - b.y) < 1e-12 && fabs(a.z - b.z) < 1e-12);
}

static void rotations_are_povray(void **state)
{
    Transform x = transform_rotate(vec3(90, 0, 0)), y = transform_rotate(vec3(0, 90, 0)),
              z = transform_rotate(vec3(0, 0, 90));
    Transform all = transform_rotate(vec3(10, 20, 30)), axis;

    (void)state;
    assert_vec(transform_point(&x, vec3(0, 1, 0)), vec3(0, 0, 1));
    assert_vec(transform_point(&y, vec3(0, 0, 1)), vec3(1, 0, 0));
    assert_vec(transform_point(&z, vec3(1, 0, 0)), vec3(0, 1, 0));
    x = transform_rotate(vec3(10, 0, 0));
    y = transform_rotate(vec3(0, 20, 0));
    z = transform_rotate(vec3(0, 0, 30));
    assert_vec(transform_point(&all, vec3(1, 2, 3)),
               transform_point(&z, transform_point(&y, transform_point(&x, vec3(1, 2, 3)))));
    axis = transform_axis_rotate(vec3(0, 5, 0), 20);
    assert_vec(transform_point(&axis, vec3(1, 2, 3)), transform_point(&y, vec3(1, 2, 3)));
    axis = transform_axis_rotate(vec3(1, 1, 1), 120);
    assert_vec(transform_point(&axis, vec3(1, 2, 3)), vec3(3, 1, 2));
}

static void matrix_acts_on_rows(void **state)
{
    const double shear[12] = {1, 1, 0, 0, 1, 0, 0, 0, 1, 5, 6, 7}, flat[12] = {1, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0};
    Transform t;

    (void)state;
    assert_true(transform_matrix(shear, &t));
    assert_vec(transform_point(&t, vec3(2, 3, 4)), vec3(7, 11, 11));
    assert_vec(transform_inverse_point(&t, vec3(7, 11, 11)), vec3(2, 3, 4));
    assert_false(transform_matrix(flat, &t));
    t = transform_scale(vec3(0, 2, 1e-9));
    assert_vec(transform_point(&t, vec3(3, 4, 5)), vec3(3, 8, 5e-9));
}

static void inverses_and_normals(void **state)
{
    Transform t = transform_then(transform_scale(vec3(1, 2, 3)), transform_rotate(vec3(12, 34, 56)));
    Vec3 a = vec3(1, 2, -1), b = vec3(0, 1, 4), n = vec_cross(a, b), mapped, back;

    (void)state;
    t = transform_then(t, transform_translate(vec3(-7, 8, 9)));
    assert_vec(transform_inverse_point(&t, transform_point(&t, a)), a);
    assert_vec(transform_inverse_vector(&t, transform_vector(&t, a)), a);
    mapped = transform_normal(&t, n);
    assert_true(fabs(vec_dot(mapped, transform_vector(&t, a))) < 1e-10);
    assert_true(fabs(vec_dot(mapped, transform_vector(&t, b))) < 1e-10);
    back = transform_inverse_normal(&t, mapped);
    assert_true(vec_length(vec_sub(back, n)) < 1e-10);
    t = transform_then(t, transform_inverse(t));
    assert_vec(transform_point(&t, a), a);
}

static void arena_keeps_its_limit(void **state)
{
    Arena *arena = arena_create(1 << 20, NULL);
    char *text;

    (void)state;
    text = arena_string(arena, "texture", 4);
    assert_string_equal(text, "text");
    for (int i = 0; i < 1000; i++) {
        unsigned char *p = arena_alloc(arena, (size_t)(i % 67) + 1);
        assert_non_null(p);
        assert_int_equal((uintptr_t)p % 16, 0);
        for (int k = 0; k <= i % 67; k++)
            assert_int_equal(p[k], 0);
        memset(p, 255, (size_t)(i % 67) + 1);
    }
    assert_non_null(arena_alloc(arena, 500000));
    assert_null(arena_alloc(arena, 600000));
    assert_null(arena_alloc(arena, SIZE_MAX - 3));
    assert_memory_equal(arena_copy(arena, text, 5), "text", 5);
    arena_close(&arena);
    assert_null(arena);
    arena_close(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotations_are_povray),
        cmocka_unit_test(matrix_acts_on_rows),
        cmocka_unit_test(inverses_and_normals),
        cmocka_unit_test(arena_keeps_its_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
