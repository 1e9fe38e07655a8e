/* See sample_row.h. */
#include "retexture/sample_row.h"

#include <math.h>
#include <string.h>
#include <retex/host/assert.h>

#include "set/set.h"
#include "texture/pyramid.h"

#define SPAN_PIXELS 1024 /* pixels filtered in one call */

RetexTextureFilter retex_footprint_filter(const RetexSet *set, const RetexFootprint *footprint)
{
    RETEX_ASSERT(footprint->quadrant >= 0 && footprint->quadrant <= RETEX_QUADRANTS);
    if (retex_footprint_has_axes(set, footprint))
        return (RetexTextureFilter)(RETEX_TEXTURE_PARALLELOGRAM + footprint->quadrant);
    if (footprint->kind == RETEX_FOOTPRINT_BROAD || footprint->kind == RETEX_FOOTPRINT_INTERREFLECTION)
        return RETEX_TEXTURE_BROAD;
    int even = footprint->kind == RETEX_FOOTPRINT_SHARP && strcmp(set->filter, "box") == 0;
    return even ? RETEX_TEXTURE_DISC : RETEX_TEXTURE_GAUSSIAN;
}

static const float zeros[RETEX_AXES * RETEX_MAX_SIZE];

int retex_footprint_row_read(RetexFootprintRow *row, RetexRowReader *reader, const RetexSet *set,
                             const RetexFootprint *footprint, int y, int with_albedo, RetexError *err)
{
    const RetexImage *uv = &set->parts[footprint->uv].image, *spread = &set->parts[footprint->spread].image;
    RETEX_ASSERT(uv->channels == 3 && spread->width == uv->width && spread->height == uv->height);
    *row = (RetexFootprintRow){.spreads = spread->channels, .width = uv->width};
    int code = retex_row_reader_get_span(reader, footprint->uv, y, &row->uv, &row->span, err);
    if (code || !row->uv)
        return code;
    code = retex_row_reader_get(reader, footprint->spread, y, &row->spread, err);
    row->spread = row->spread ? row->spread : zeros;
    if (!code && with_albedo) {
        code = retex_row_reader_get(reader, footprint->albedo, y, &row->albedo, err);
        row->albedo = row->albedo ? row->albedo : zeros;
    }
    return code;
}

RetexFootprintRow retex_footprint_row_cut(const RetexFootprintRow *row, RetexRowSpan span)
{
    const size_t begin = (size_t)span.begin;
    RETEX_ASSERT(row->uv && span.begin >= 0 && span.begin <= span.end && span.end <= row->width);
    return (RetexFootprintRow){.uv = row->uv + 3 * begin,
                               .spread = row->spread + (size_t)row->spreads * begin,
                               .albedo = row->albedo ? row->albedo + 3 * begin : NULL,
                               .spreads = row->spreads,
                               .width = span.end - span.begin,
                               .span = {0, span.end - span.begin}};
}

/* Filters the texture at some footprints of a row. */
static void filter_span(const RetexTexture *texture, RetexTextureFilter filter, const RetexFootprintRow *row, int from,
                        int count, float *restrict rgba)
{
    retex_texture_filter(texture, filter, row->uv + 3 * (size_t)from, row->spread + (size_t)row->spreads * (size_t)from,
                         row->spreads, (size_t)count, rgba, 4);
}

void retex_sample_row(const RetexTexture *texture, RetexTextureFilter filter, const RetexFootprintRow *row,
                      float *restrict rgb)
{
    float rgba[4 * SPAN_PIXELS];
    RETEX_ASSERT(row->albedo || retex_texture_is_opaque(texture)); /* it shows where the texture does not */
    if (!row->albedo) {
        retex_texture_filter(texture, filter, row->uv, row->spread, row->spreads, (size_t)row->width, rgb, 3);
        return;
    }
    for (int from = 0; from < row->width; from += SPAN_PIXELS) {
        int count = row->width - from < SPAN_PIXELS ? row->width - from : SPAN_PIXELS;
        filter_span(texture, filter, row, from, count, rgba);
        for (int x = 0; x < count; x++, rgb += 3) {
            size_t at = 3 * (size_t)(from + x);
            const float *color = rgba + 4 * x;
            int covered = row->uv[at + 2] > 0;
            for (int c = 0; c < 3; c++)
                rgb[c] = covered ? color[c] * color[3] + (1 - color[3]) * row->albedo[at + (size_t)c] : 0;
        }
    }
}

void retex_variance_row(const RetexTexture *texture, const RetexTexture *square, RetexTextureFilter filter,
                        const RetexFootprintRow *row, float *restrict rgb)
{
    float means[4 * SPAN_PIXELS], squares[4 * SPAN_PIXELS];
    for (int from = 0; from < row->width; from += SPAN_PIXELS) {
        int count = row->width - from < SPAN_PIXELS ? row->width - from : SPAN_PIXELS;
        filter_span(texture, filter, row, from, count, means);
        filter_span(square, filter, row, from, count, squares);
        for (int x = 0; x < count; x++, rgb += 3) { /* without coverage all colours are 0 */
            const float *mean = means + 4 * x;
            for (int c = 0; c < 3; c++)
                rgb[c] = fmaxf(squares[4 * x + c] - mean[c] * mean[c], 0) * mean[3] * mean[3];
        }
    }
}
