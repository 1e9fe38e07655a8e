/* See sources.h. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/edit.h>
#include <retex/file_sum.h>
#include <retex/texture.h>
#include <retex/version.h>

#include "batch/sources.h"
#include "common/json_text.h"

/* ---- checksums of files ---- */

static struct SourceSum *find_bucket(const SourceSums *sums, const char *path)
{
    size_t at = retex_bytes_sum(0, path, strlen(path)) & (sums->capacity - 1);
    while (sums->buckets[at].path && strcmp(sums->buckets[at].path, path) != 0)
        at = (at + 1) & (sums->capacity - 1);
    return &sums->buckets[at];
}

/* Double the table when it is half full. */
static int grow_sums(SourceSums *sums)
{
    SourceSums more = {.count = sums->count, .capacity = sums->capacity ? 2 * sums->capacity : 256};
    if (2 * sums->count < sums->capacity)
        return 1;
    more.buckets = calloc(more.capacity, sizeof *more.buckets);
    if (!more.buckets)
        return 0;
    for (size_t i = 0; i < sums->capacity; i++)
        if (sums->buckets[i].path)
            *find_bucket(&more, sums->buckets[i].path) = sums->buckets[i];
    free(sums->buckets);
    *sums = more;
    return 1;
}

/* The checksum of a file; it is read only once. */
static int sum_file(const char **text, SourceSums *sums, const char *path, const RetexAccess *access, RetexError *err)
{
    RetexFileSum sum;
    if (!grow_sums(sums))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for checksums");
    struct SourceSum *bucket = find_bucket(sums, path);
    *text = bucket->text;
    if (bucket->path)
        return RETEX_OK;
    int code = retex_file_sum(&sum, path, access, err);
    if (code)
        return code;
    bucket->path = strdup(path);
    if (!bucket->path)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for checksums");
    snprintf(bucket->text, sizeof bucket->text, "%08" PRIx32 " %" PRIu64, sum.crc, sum.bytes);
    sums->count++;
    return RETEX_OK;
}

/* ---- the text ---- */

/* Close a text in memory; 0 if a part of it is missing. */
static int close_text(FILE *file)
{
    const int failed = ferror(file);
    return fclose(file) == 0 && !failed;
}

/* A texture as a cell of the table has it, and the checksums of its files. The name may have options:
 * `room.retex?Floor=…`. */
static int print_texture(FILE *out, SourceSums *sums, const RetexTextureSpec *s, RetexError *err)
{
    char *options = NULL, image[sizeof s->image], text[4 * sizeof s->image], all[128] = "";
    int code = RETEX_OK;
    for (int k = 0; k < RETEX_TEXTURE_FILES && !code; k++) {
        const char *sum;
        char *file;
        code = retex_texture_file(&file, s, k, err);
        if (file && strchr(file, '?') && access(file, F_OK) != 0)
            *strchr(file, '?') = '\0';
        if (file)
            code = sum_file(&sum, sums, file, s->access, err);
        if (file && !code)
            snprintf(all + strlen(all), sizeof all - strlen(all), " %s", sum);
        free(file);
    }
    if (!code)
        code = retex_edit_options_text(s, &options, err);
    if (code)
        return code;
    retex_edit_image_text(s, image, sizeof image);
    snprintf(text, sizeof text, "%s%s%s%s%s", *options ? ":" : "", options, *options ? " " : "", image, all);
    json_text(out, text);
    free(options);
    return RETEX_OK;
}

static int compare_targets(const void *a, const void *b)
{
    return strcmp(((const RetexTextureSpec *)a)->target, ((const RetexTextureSpec *)b)->target);
}

/* By hand, as a journal is: parts of its lines are compared as text, with those that earlier runs wrote. */
static int print_sources(FILE *file, BatchSources *sources, const char *output, RetexTextureSpec *specs, int count,
                         const char *lights, RetexError *err)
{
    const char *set = "", *samples = "";
    int code = sum_file(&set, &sources->sums, sources->set, NULL, err);
    char set_text[sizeof((struct SourceSum *)0)->text];
    snprintf(set_text, sizeof set_text, "%s", set); /* the table may move */
    if (!code && sources->samples)
        code = sum_file(&samples, &sources->sums, sources->samples, NULL, err);
    if (code)
        return code;
    fprintf(file, "{\"output\": ");
    json_text(file, output);
    fprintf(file, ", \"version\": \"%s\", \"set\": \"%s\", \"samples\": \"%s\", \"options\": ", RETEX_VERSION, set_text,
            samples);
    json_text(file, sources->options);
    fprintf(file, ", \"textures\": {");
    qsort(specs, (size_t)count, sizeof *specs, compare_targets);
    for (int i = 0; i < count && !code; i++) {
        fprintf(file, i ? ", " : "");
        json_text(file, specs[i].target);
        fprintf(file, ": ");
        code = print_texture(file, &sources->sums, &specs[i], err);
    }
    fprintf(file, "}");
    if (*lights) {
        fprintf(file, ", \"lights\": ");
        json_text(file, lights);
    }
    return code;
}

int batch_sources_text(char **text, BatchSources *sources, const char *output, RetexTextureSpec *specs, int count,
                       const char *lights, RetexError *err)
{
    size_t bytes;
    *text = NULL;
    FILE *file = open_memstream(text, &bytes);
    int code = file ? print_sources(file, sources, output, specs, count, lights, err) : RETEX_ENOMEM;
    if (!file || !close_text(file) || code == RETEX_ENOMEM)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for a line of the manifest");
    if (code) {
        free(*text);
        *text = NULL;
    }
    return code;
}

void batch_sources_close(BatchSources *sources)
{
    for (size_t i = 0; i < sources->sums.capacity; i++)
        free(sources->sums.buckets[i].path);
    free(sources->sums.buckets);
    sources->sums = (SourceSums){0};
}
