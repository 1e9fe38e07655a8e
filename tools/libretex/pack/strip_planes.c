/* Strips of planes: their numbers, channel by channel, and rows of samples from these. See scratch.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>

#include "pack/restore.h"
#include "pack/scratch.h"
#include "set/steps.h"

_Static_assert(RETEX_STEPS_ROWS == RETEX_PACK_STRIP_ROWS, "steps are taken within strips");

void retex_pack_plane_strip_init(RetexPackPlaneStrip *planes)
{
    for (int c = 0; c < RETEX_PACK_CHANNELS_MAX; c++)
        planes->strip[c] = -1;
    planes->line = planes->runs_strip = -1;
}

void retex_pack_plane_strip_free(RetexPackPlaneStrip *planes)
{
    for (int c = 0; c < RETEX_PACK_CHANNELS_MAX; c++)
        free(planes->numbers[c]);
    free(planes->present);
    free(planes->runs.run);
}

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
}

/* ---- numbers ---- */

static int reserve_numbers(int part, int strip, int c, RetexPackScratch *s, RetexError *err);

/* Know where the numbers matter of the parts that this one says it of. */
static int reserve_runs(int part, int strip, RetexPackScratch *s, RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    RetexPackPlaneStrip *own = &s->cached[part].planes;
    const size_t pixels = (size_t)p->width * RETEX_PACK_STRIP_ROWS;
    RETEX_ASSERT(p->channels >= 3 && p->present == part); /* a part of means tells it of itself, by its coverage */
    if (own->runs_strip == strip)
        return 0;
    own->runs_strip = -1;
    if (!own->present)
        own->present = malloc(pixels);
    if (!own->runs.run)
        own->runs.run = malloc(retex_pack_runs_bound(p->width, RETEX_PACK_STRIP_ROWS) * sizeof *own->runs.run);
    if (!own->present || !own->runs.run)
        return no_memory(err);
    int code = reserve_numbers(part, strip, 2, s, err);
    const int rows = retex_pack_strip_rows(p, strip);
    if (code)
        return code;
    retex_pack_find_present(own->present, own->numbers[2], (size_t)p->width * (size_t)rows);
    retex_pack_find_runs(&own->runs, own->present, p->width, rows);
    own->runs_strip = strip;
    return 0;
}

/* What multiples the means of channel c are, into s->shift. */
static int reserve_shift(int part, int strip, int c, const RetexPackRuns *runs, RetexPackScratch *s, RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    const int per_octave = s->pack->parts[p->sigma].maps[c].per_octave;
    unsigned char shift[RETEX_PACK_CODES];
    for (int i = 0; i < RETEX_PACK_CODES; i++)
        shift[i] = (unsigned char)retex_pack_lattice_shift(p, i, per_octave);
    int code = reserve_numbers(p->sigma, strip, c, s, err);
    const unsigned char *codes = s->cached[p->sigma].planes.numbers[c];
    for (int y = 0; !code && y < retex_pack_strip_rows(p, strip); y++)
        for (int k = runs->first[y]; k < runs->first[y + 1]; k++) {
            const size_t row = (size_t)y * (size_t)p->width;
            for (size_t i = row + (size_t)runs->run[k].begin; i < row + (size_t)runs->run[k].end; i++)
                s->shift[i] = shift[codes[i]];
        }
    return code;
}

/* Have those of one channel. */
static int reserve_numbers(int part, int strip, int c, RetexPackScratch *s, RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    RetexPackPlaneStrip *own = &s->cached[part].planes;
    const RetexPackMap *map = &p->maps[c];
    const int is_coded = retex_pack_map_is_coded(map), k = strip * p->channels + c;
    const size_t pixels = (size_t)p->width * RETEX_PACK_STRIP_ROWS;
    RetexPackPlane plane = {.width = p->width, .rows = retex_pack_strip_rows(p, strip)};
    plane.bits = is_coded ? 8 : map->kind == RETEX_PACK_MAP_BITS && p->type == RETEX_HALF ? 16 : 32;
    if (own->strip[c] == strip)
        return 0;
    own->strip[c] = -1;
    if (!own->numbers[c] && !(own->numbers[c] = calloc(pixels, is_coded ? 1 : sizeof *plane.numbers)))
        return no_memory(err);
    plane.codes = is_coded ? own->numbers[c] : NULL;
    plane.numbers = is_coded ? NULL : own->numbers[c];
    int code = retex_pack_scratch_reserve(s, p, err);
    if (!code && p->present >= 0 && (p->present != part || c != 2)) {
        code = reserve_runs(p->present, strip, s, err);
        plane.present = s->cached[p->present].planes.present;
        plane.runs = &s->cached[p->present].planes.runs;
    }
    RETEX_ASSERT(map->kind != RETEX_PACK_MAP_LATTICE || (p->sigma >= 0 && p->present >= 0)); /* its runs are read */
    if (!code && map->kind == RETEX_PACK_MAP_LATTICE) {
        code = reserve_shift(part, strip, c, plane.runs, s, err);
        plane.shift = s->shift;
    }
    if (!code)
        code = retex_pack_read_slice(part, k, 0, s, err);
    if (!code && !retex_pack_plane_decode(&plane, s->slice, p->bytes[k], s->residuals))
        code = retex_pack_damaged(err, "planes cannot be decoded of part", s->pack->set->parts[part].name);
    own->strip[c] = code ? -1 : strip;
    return code;
}

/* The rows of a channel, all of which matters, that are not all 0. */
static uint64_t find_nonzero(const RetexPackPart *p, int strip, int c, const void *numbers)
{
    const size_t row = (size_t)p->width * (retex_pack_map_is_coded(&p->maps[c]) ? 1 : sizeof(int32_t));
    const int32_t none = 0;
    float of_none;
    retex_pack_map_samples(&of_none, 1, &none, 1, &p->maps[c], p->type);
    uint64_t lit = 0;
    for (int y = 0; y < retex_pack_strip_rows(p, strip); y++)
        if (retex_pack_any_nonzero(&of_none, sizeof of_none) ||
            retex_pack_any_nonzero((const char *)numbers + (size_t)y * row, row))
            lit |= (uint64_t)1 << y;
    return lit;
}

int retex_pack_plane_strip_decode(int part, int strip, uint64_t *lit, RetexPackScratch *s, RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    RetexPackPlaneStrip *own = &s->cached[part].planes;
    int code = p->present >= 0 ? reserve_runs(p->present, strip, s, err) : 0;
    const RetexPackRuns *runs = p->present >= 0 ? &s->cached[p->present].planes.runs : NULL;
    own->line = -1;
    *lit = 0;
    for (int y = 0; !code && runs && y < retex_pack_strip_rows(p, strip); y++)
        *lit |= (uint64_t)(runs->first[y] < runs->first[y + 1]) << y;
    for (int c = 0; !code && (*lit || !runs) && c < p->channels; c++) {
        code = reserve_numbers(part, strip, c, s, err);
        if (!code && !runs)
            *lit |= find_nonzero(p, strip, c, own->numbers[c]);
    }
    return code;
}

/* ---- rows ---- */

/* Where a row of a channel, all of which matters, is not 0. */
static RetexRowSpan find_span(const RetexPackPart *p, int c, const void *numbers, int line)
{
    const int width = p->width;
    const int32_t none = 0;
    float of_none;
    int begin = 0, end = width;
    retex_pack_map_samples(&of_none, 1, &none, 1, &p->maps[c], p->type);
    if (retex_pack_any_nonzero(&of_none, sizeof of_none))
        return (RetexRowSpan){0, width};
    enum { STEP = 64 };
    const size_t size = retex_pack_map_is_coded(&p->maps[c]) ? 1 : sizeof none;
    const char *row = (const char *)numbers + (size_t)line * (size_t)width * size;
    while (begin + STEP <= end && !retex_pack_any_nonzero(row + (size_t)begin * size, STEP * size))
        begin += STEP;
    while (end - STEP >= begin && !retex_pack_any_nonzero(row + (size_t)(end - STEP) * size, STEP * size))
        end -= STEP;
    return (RetexRowSpan){begin, end};
}

/* A run of a row to samples, in all channels. */
static void map_run(const RetexPackPart *p, const RetexPackPlaneStrip *own, int line, RetexRowSpan run, float *row)
{
    const size_t channels = (size_t)p->channels, count = (size_t)(run.end - run.begin);
    const size_t at = (size_t)line * (size_t)p->width + (size_t)run.begin;
    float *out = row + (size_t)run.begin * channels;
    for (int c = 0; c < p->channels; c++, out++)
        if (retex_pack_map_is_coded(&p->maps[c]))
            retex_pack_map_codes(out, channels, (const unsigned char *)own->numbers[c] + at, count, &p->maps[c]);
        else
            retex_pack_map_samples(out, channels, (const int32_t *)own->numbers[c] + at, count, &p->maps[c], p->type);
}

static int is_steps(const RetexPackPart *p)
{
    return p->maps[0].kind == RETEX_PACK_MAP_STEP;
}

/* The step of means of channel c at a pixel; `at`: its place in a row or column of `count` pixels, `apart` from each
 * other, which begins at `first` in the strip. */
static float step_at(const RetexPackPlaneStrip *of, int c, size_t first, size_t apart, int at, int count, int wraps)
{
    const int32_t *numbers = of->numbers[c];
    RetexStep step = {{0}, {0}};
    for (int i = 0; i < 5; i++) {
        const int place = at + i - 2;
        if (place < 0 || place >= count || !of->present[first + (size_t)place * apart])
            continue;
        step.has[i] = 1;
        step.uv[i] = ldexp((double)numbers[first + (size_t)place * apart], -RETEX_PACK_LATTICE_BITS);
    }
    return (float)retex_step(&step, wraps);
}

/* A run of a row of axes, which are the steps of the means `of`. */
static void step_run(const RetexPackPart *p, const RetexPackPlaneStrip *of, int rows, int line, RetexRowSpan run,
                     float *row)
{
    const size_t width = (size_t)p->width;
    for (int x = run.begin; x < run.end; x++)
        for (int a = 0; a < 2; a++) {
            row[RETEX_AXES * x + a] = step_at(of, a, (size_t)line * width, 1, x, p->width, p->wraps[a]);
            row[RETEX_AXES * x + 2 + a] = step_at(of, a, (size_t)x, width, line, rows, p->wraps[a]);
        }
}

/* What is of the row that was there becomes 0. */
static void clear_row(const RetexPackPart *p, const RetexPackPlaneStrip *own, float *row)
{
    const size_t channels = (size_t)p->channels;
    const RetexRowSpan old = own->line < 0 ? (RetexRowSpan){0, p->width} : own->span;
    if (!retex_span_is_empty(old))
        memset(row + (size_t)old.begin * channels, 0, (size_t)(old.end - old.begin) * channels * sizeof *row);
}

int retex_pack_plane_strip_row(int part, int strip, int line, float *row, RetexRowSpan *span, RetexPackScratch *s,
                               RetexError *err)
{
    const RetexPackPart *p = &s->pack->parts[part];
    RetexPackPlaneStrip *own = &s->cached[part].planes;
    int code = 0;
    *span = own->span;
    if (own->line == line)
        return 0;
    for (int c = 0; !code && c < p->channels; c++) /* for other parts they may have moved on */
        code = reserve_numbers(part, strip, c, s, err);
    if (!code && p->present >= 0)
        code = reserve_runs(p->present, strip, s, err);
    for (int c = 0; !code && is_steps(p) && c < 2; c++)
        code = reserve_numbers(p->present, strip, c, s, err);
    if (code)
        return code;
    clear_row(p, own, row);
    *span = (RetexRowSpan){0, 0};
    if (p->present < 0) {
        for (int c = 0; c < p->channels; c++)
            *span = retex_span_union(*span, find_span(p, c, own->numbers[c], line));
        map_run(p, own, line, *span, row);
    } else {
        const RetexPackRuns *runs = &s->cached[p->present].planes.runs;
        for (int k = runs->first[line]; k < runs->first[line + 1]; k++) {
            const RetexRowSpan run = runs->run[k];
            if (is_steps(p))
                step_run(p, &s->cached[p->present].planes, retex_pack_strip_rows(p, strip), line, run, row);
            else
                map_run(p, own, line, run, row);
            *span = retex_span_union(*span, run);
        }
    }
    own->line = line;
    own->span = *span;
    return 0;
}
