/* --stats of retex-render, and warnings of numbers. */
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <jansson.h>
#include <retex/output_file.h>
#include "retex-render.h"

void check_stats(const Arguments *a)
{
    RetexError err;
    if (!a->stats)
        return;
    if (strcmp(a->stats, "-") && retex_output_check(a->stats, &err))
        cli_die(a->cli, "--stats: %s", err.message);
}

void warn_numbers(const Cli *cli, const RenderStats *s)
{
    if (s->dropped)
        cli_warn(cli, "%ld contributions were not finite and were left out", s->dropped);
    if (s->limited)
        cli_warn(cli, "%ld numbers were not finite, or beyond 1e18, and were stored as 0 or as that", s->limited);
}

int write_stats(Arguments *a, const RenderStats *s, const RetexSet *set, double parse_seconds, RetexError *err)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    json_t *j =
        json_pack("{s:f, s:f, s:f, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:f}", "parse_seconds", parse_seconds,
                  "build_seconds", s->build_seconds, "render_seconds", s->render_seconds, "paths", (json_int_t)s->paths,
                  "segments", (json_int_t)s->segments, "shadow_rays", (json_int_t)s->shadow_rays, "dropped_samples",
                  (json_int_t)s->dropped, "limited_numbers", (json_int_t)s->limited, "lights", (json_int_t)s->lights,
                  "primitives", (json_int_t)s->primitives, "triangles", (json_int_t)s->triangles, "peak_memory_bytes",
                  (json_int_t)usage.ru_maxrss * 1024, "folded", retex_set_info(set).folded);
    char *text = j ? json_dumps(j, JSON_INDENT(2)) : NULL;
    RetexError why;
    json_decref(j);
    if (!text)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the statistics");
    size_t length = strlen(text);
    text[length++] = '\n'; /* replaces the terminating zero */
    const int failed = retex_file_write(a->stats, text, length, &why);
    free(text);
    return failed ? retex_fail(err, failed, "--stats: %s", why.message) : RETEX_OK;
}
