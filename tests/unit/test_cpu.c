/* RETEX_CPU lowers the level of vector instructions, and never raises it. */
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lib_test.h"
#include <cmocka.h>

#include <retex/host/cpu.h>

/* The level in a process of its own, for it is asked once. */
static int level_with(const char *name)
{
    int status = -1;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        if (name)
            setenv("RETEX_CPU", name, 1);
        else
            unsetenv("RETEX_CPU");
        _exit((int)retex_cpu_level());
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void test_levels(void **state)
{
    (void)state;
    const int highest = level_with(NULL);
    assert_in_range(highest, RETEX_CPU_BASELINE, RETEX_CPU_LEVELS - 1);
#if RETEX_CPU_X86
    assert_int_equal(highest >= RETEX_CPU_AVX2, __builtin_cpu_supports("avx2") != 0);
    assert_int_equal(level_with("avx2"), highest < RETEX_CPU_AVX2 ? highest : RETEX_CPU_AVX2);
#endif
    assert_int_equal(level_with("baseline"), RETEX_CPU_BASELINE);
    assert_int_equal(level_with("avx512"), highest);
    assert_int_equal(level_with("sse9"), highest);
    assert_int_equal(level_with(""), highest);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_levels)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
