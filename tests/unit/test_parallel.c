/* Threads: every index runs once, thread numbers can select scratch memory, and calls can be nested. */
#include "lib_test.h"
#include <cmocka.h>

#include <stdatomic.h>
#include <string.h>

enum { COUNT = 5000 };

typedef struct Tally {
    int nthreads;
    unsigned char done[COUNT];
    atomic_int busy[256]; /* 1 while a job runs with that thread number */
    atomic_int wrong;
} Tally;

static void count_job(void *context, int index, int thread)
{
    Tally *tally = context;
    if (thread < 0 || thread >= tally->nthreads || atomic_exchange(&tally->busy[thread], 1))
        atomic_fetch_add(&tally->wrong, 1);
    tally->done[index]++;
    atomic_store(&tally->busy[thread], 0);
}

static void test_every_index_once(void **state)
{
    (void)state;
    static const int threads[] = {0, 1, 2, 7, 64, 1000};
    static Tally tally;
    for (size_t t = 0; t < sizeof threads / sizeof threads[0]; t++) {
        memset(&tally, 0, sizeof tally);
        tally.nthreads = retex_threads(threads[t]);
        retex_parallel(threads[t], COUNT, count_job, &tally);
        assert_int_equal(atomic_load(&tally.wrong), 0);
        for (int i = 0; i < COUNT; i++)
            assert_int_equal(tally.done[i], 1);
    }
}

static void test_nothing_to_do(void **state)
{
    (void)state;
    static Tally tally;
    retex_parallel(4, 0, count_job, &tally);
    retex_parallel(4, -3, count_job, &tally);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(tally.done[i], 0);
}

typedef struct Sums {
    double part[100];
} Sums;

static void sum_inner(void *context, int index, int thread)
{
    double *out = context;
    (void)thread;
    out[index] = index * 0.1;
}

static void sum_job(void *context, int index, int thread)
{
    Sums *sums = context;
    double terms[50];
    (void)thread;
    retex_parallel(2, 50, sum_inner, terms);
    for (int i = 0; i < 50; i++)
        sums->part[index] += terms[i] / (index + 1);
}

static void test_nested_and_equal_for_every_thread_count(void **state)
{
    (void)state;
    Sums reference = {{0}};
    retex_parallel(1, 100, sum_job, &reference);
    for (int threads = 2; threads < 9; threads += 3) {
        Sums sums = {{0}};
        retex_parallel(threads, 100, sum_job, &sums);
        assert_memory_equal(&sums, &reference, sizeof sums);
    }
}

static void test_threads_are_bounded(void **state)
{
    (void)state;
    assert_true(retex_threads(0) >= 1 && retex_threads(-5) == retex_threads(0));
    assert_int_equal(retex_threads(1), 1);
    assert_int_equal(retex_threads(100000), 256);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_index_once),
        cmocka_unit_test(test_nothing_to_do),
        cmocka_unit_test(test_nested_and_equal_for_every_thread_count),
        cmocka_unit_test(test_threads_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
