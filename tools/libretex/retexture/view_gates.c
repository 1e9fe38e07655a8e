/* Gates: how much of the light that met a target counts with each finish of its map, where the term does not have the
 * first hit on the target as a factor.
 *
 * A gate is the mean weight of a finish over the target's footprints in a pixel. What is seen sharply counts far more
 * than what scattered light met, and that more than later hits: these only decide where there is nothing else. Sums are
 * of the weights of the second finish and later ones, and of what they are divided by. */
#include <string.h>

#include <retex/host/assert.h>

#include "retexture/sample_row.h"
#include "retexture/view_rows.h"
#include "set/parts.h"
#include "set/set.h"
#include "texture/pyramid.h"

#define SPAN_PIXELS 1024 /* filtered in one call */

static const float importance[RETEX_FOOTPRINT_KINDS] = {[RETEX_FOOTPRINT_HIT] = 1,
                                                        [RETEX_FOOTPRINT_SHARP] = 1,
                                                        [RETEX_FOOTPRINT_BROAD] = 1e-3f,
                                                        [RETEX_FOOTPRINT_INTERREFLECTION] = 1e-6f};

/* Adds a row of a footprint, at its own size. */
static int add_footprint(RetexViewReader *reader, int footprint, int y, float *sums, RetexError *err)
{
    const RetexView *view = reader->view;
    const RetexFootprint *f = &view->set->footprints[footprint];
    RETEX_ASSERT(view->textures && view->textures[f->target] && view->textures[f->target]->finishes);
    const int shown = view->shown[f->target];
    float rgba[4 * SPAN_PIXELS];
    RetexFootprintRow from;
    const int code = retex_footprint_row_read(&from, reader->set, view->set, f, y, 0, err);
    if (code || !from.uv)
        return code;
    for (int x0 = from.span.begin; x0 < from.span.end; x0 += SPAN_PIXELS) {
        const int count = from.span.end - x0 < SPAN_PIXELS ? from.span.end - x0 : SPAN_PIXELS;
        const float *uv = from.uv + 3 * (size_t)x0;
        retex_texture_filter(view->textures[f->target]->finishes->weights, retex_footprint_filter(view->set, f), uv,
                             from.spread + (size_t)from.spreads * (size_t)x0, from.spreads, (size_t)count, rgba, 4);
        for (int i = 0; i < count; i++) {
            const float weight = importance[f->kind] * uv[3 * i + 2], alpha = rgba[4 * i + 3];
            float *sum = sums + 4 * (size_t)(x0 + i);
            if (!(weight > 0))
                continue;
            for (int c = 0; c < 3; c++)
                sum[c] += weight * (alpha * rgba[4 * i + c] + (shown == c + 1 ? 1 - alpha : 0));
            sum[3] += weight;
        }
    }
    return RETEX_OK;
}

int retex_view_make_gate_sums(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                              RetexError *err)
{
    const RetexSet *set = reader->view->set;
    int code = RETEX_OK;
    own->row = memset(own->buffer.values, 0, sizeof *own->row * 4 * (size_t)image->width);
    for (int f = 0; f < set->nfootprints && !code; f++)
        if (set->footprints[f].target == image->index && retex_set_footprint_scale(set, f) == image->scale)
            code = add_footprint(reader, f, y, own->buffer.values, err);
    return code;
}

int retex_view_make_gates(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                          RetexError *err)
{
    const RetexView *view = reader->view;
    const int shown = view->shown[image->index];
    float *rgb = own->buffer.values;
    if (!view->textures || !view->textures[image->index])
        return retex_row_reader_get(reader->set, view->set->targets[image->index].gates - 1, y, &own->row, err);
    const float *sums[VIEW_INPUTS_MAX];
    int code = RETEX_OK;
    for (int i = 0; i < image->ninputs && !code; i++)
        code = retex_view_row(reader, image->inputs[i], y, &sums[i], NULL, err);
    for (size_t x = 0; x < (size_t)image->width && !code; x++) {
        float sum[4] = {0};
        for (int i = 0; i < image->ninputs; i++)
            for (size_t c = 0; c < 4 && sums[i]; c++)
                sum[c] += sums[i][4 * x + c];
        for (int c = 0; c < 3; c++)
            rgb[3 * x + (size_t)c] = sum[3] > 0 ? sum[c] / sum[3] : shown == c + 1;
    }
    own->row = rgb;
    return code;
}

int retex_view_make_gate(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                         RetexError *err)
{
    const int is_signed = reader->view->set->targets[image->index].normal_tilt > 0;
    const int count = reader->view->mapped[image->index];
    const float *rgb;
    RETEX_ASSERT(count >= 2 && count <= RETEX_FINISHES_MAX && image->finish < count);
    RETEX_ASSERT(!is_signed || count == 3); /* normals: one, and that tilted along u and along v */
    (void)count;
    const int code = retex_view_row(reader, image->inputs[0], y, &rgb, NULL, err);
    for (size_t x = 0; x < (size_t)image->width && !code; x++) {
        float weights[RETEX_FINISHES_MAX] = {1};
        for (int k = 1; k < RETEX_FINISHES_MAX; k++) {
            weights[k] = rgb ? rgb[3 * x + (size_t)k - 1] : 0;
            weights[0] -= weights[k];
        }
        const float weight = weights[image->finish] > 0 || is_signed ? weights[image->finish] : 0;
        for (size_t c = 0; c < 3; c++)
            own->buffer.values[3 * x + c] = weight;
    }
    own->row = own->buffer.values;
    return code;
}
