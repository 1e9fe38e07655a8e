/* The course of a batch whose tool makes one picture at a time. See batch.h. */
#include <retex/clock.h>

#include "batch/batch.h"

/* Make the picture of a row in memory, and look at its size and time. */
static int try_row(const Batch *batch, int row, double *bytes, double *seconds, RetexError *err)
{
    size_t trial = 0;
    const double began = retex_clock_seconds();
    const int code = batch->tool.make(batch->tool.context, row, &trial, err);
    *seconds += retex_clock_seconds() - began;
    *bytes += (double)trial;
    return code;
}

/* The number of rows that batch_is_wanted, before any is made. */
static int wanted_rows(const Batch *batch)
{
    return batch->end - batch->first - batch->kept - batch->failed;
}

/* --plan: make trial pictures from all over the table. The first one is made twice, because it also takes the time to
 * load libraries. */
static int plan(const Batch *batch, RetexError *err)
{
    enum { TRIALS = 4 };
    double bytes = 0, seconds = 0, ignored = 0;
    const int wanted = wanted_rows(batch), trials = wanted < TRIALS ? wanted : TRIALS;
    int code = RETEX_OK, made = 0, at = 0;
    for (int row = batch->first; row < batch->end && made < trials && !code; row++) {
        if (!batch_is_wanted(batch, row) || at++ < (int)((long)made * wanted / trials))
            continue;
        code = made ? RETEX_OK : try_row(batch, row, &ignored, &ignored, err);
        if (!code)
            code = try_row(batch, row, &bytes, &seconds, err);
        made++;
    }
    if (!code)
        batch_print_plan(batch, made, bytes, seconds);
    return code;
}

static void make_rows(Batch *batch)
{
    for (int row = batch->first; row < batch->end; row++) {
        RetexError err = {0};
        const double began = retex_clock_seconds();
        if (!batch_is_wanted(batch, row))
            continue;
        const int failed = batch->tool.make(batch->tool.context, row, NULL, &err);
        if (!batch_done(batch, row, retex_clock_seconds() - began, failed ? &err : NULL))
            break;
    }
}

int batch_run(Batch *batch, const RetexWriteParams *params)
{
    RetexError err = {0};
    batch_check(batch, params);
    batch_refuse_mistakes(batch);
    if (batch_prepare(batch, &err))
        return batch_finish(batch, &err);
    if (batch_only_verifies(batch)) {
        const int status = batch_print_verdict(batch), failed = batch_finish(batch, NULL);
        return failed ? failed : status;
    }
    if (batch->dry_run) {
        batch_print(batch);
        return batch_finish(batch, NULL);
    }
    int code = wanted_rows(batch) ? batch->tool.begin(batch->tool.context, &err) : RETEX_OK;
    if (!code && batch->plan)
        code = plan(batch, &err);
    else if (!code)
        make_rows(batch);
    return batch_finish(batch, code ? &err : NULL);
}
