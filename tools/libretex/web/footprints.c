/* See footprints.h. */
#include "web/footprints.h"

#include <stdlib.h>
#include <string.h>

#include "io/deflate.h"
#include "set/set.h"

typedef struct Stream {
    const RetexSet *set;
    const RetexPackPart *packed;
    size_t pixels, bytes;
    unsigned char *data; /* all planes */
    unsigned char *present, *shift, *residuals;
    int32_t *numbers, *codes;
} Stream;

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "no memory to write footprints");
}

/* Planes of a footprint, besides those of weights: three of its spread, two of its mean. */
enum { PLANES = 5, PLANE_HEAD = 1 };

static void stream_close(Stream *s)
{
    free(s->data);
    free(s->present);
    free(s->shift);
    free(s->residuals);
    free(s->numbers);
    free(s->codes);
}

static int stream_open(Stream *s, const RetexWebClass *c)
{
    const RetexImage *uv = &s->set->parts[s->set->footprints[c->footprints[0]].uv].image;
    s->pixels = (size_t)uv->width * (size_t)uv->height;
    const size_t mask = ((size_t)uv->width + 7) / 8 * (size_t)uv->height;
    const size_t planes = (size_t)(PLANES + c->nweightings) * (PLANE_HEAD + s->pixels * sizeof(int32_t));
    s->data = malloc((size_t)c->nfootprints * (mask + planes));
    s->present = malloc(s->pixels);
    s->shift = malloc(s->pixels);
    s->residuals = malloc(s->pixels * sizeof(int32_t));
    s->numbers = malloc(s->pixels * sizeof *s->numbers);
    s->codes = malloc(s->pixels * sizeof *s->codes);
    return s->data && s->present && s->shift && s->residuals && s->numbers && s->codes;
}

static void numbers_of(int32_t *numbers, const Stream *s, int part, int channel)
{
    const RetexPart *p = &s->set->parts[part];
    retex_pack_map_numbers(numbers, p->image.pixels + channel, (size_t)p->image.channels, s->pixels,
                           &s->packed[part].maps[channel], p->type);
}

/* Append the mask of pixels that have the footprint: a bit each, the lowest first, rows of whole bytes. */
static void put_mask(Stream *s, const RetexImage *uv)
{
    for (int y = 0; y < uv->height; y++)
        for (int x = 0; x < uv->width; x += 8) {
            int bits = 0;
            for (int k = 0; k < 8 && x + k < uv->width; k++)
                bits |= s->present[y * uv->width + x + k] << k;
            s->data[s->bytes++] = (unsigned char)bits;
        }
}

/* Append a plane of the numbers: a byte with predictor and bytes of a residual, then all lowest bytes, all second
 * ones and so on. */
static void put_plane(Stream *s, const RetexImage *shape, int bits, int shifted)
{
    const RetexPackPlane plane = {.width = shape->width,
                                  .rows = shape->height,
                                  .bits = bits,
                                  .present = s->present,
                                  .shift = shifted ? s->shift : NULL,
                                  .numbers = s->numbers};
    int predictor, bytes;
    const size_t size = retex_pack_plane_residuals(s->residuals, &plane, &predictor, &bytes);
    s->data[s->bytes++] = (unsigned char)(bytes << 4 | predictor);
    for (int k = 0; k < bytes; k++)
        for (size_t i = (size_t)k; i < size; i += (size_t)bytes)
            s->data[s->bytes++] = s->residuals[i];
}

static int can_encode(const Stream *s, const RetexFootprint *f)
{
    const RetexPackPart *uv = &s->packed[f->uv], *spread = &s->packed[f->spread];
    const int is_axes = spread->channels == RETEX_AXES;
    int can = uv->maps[0].kind == RETEX_PACK_MAP_LATTICE && uv->sigma == f->spread;
    for (int c = 0; c < (is_axes ? RETEX_AXES : 2); c++)
        can = can && spread->maps[c].kind == (is_axes ? RETEX_PACK_MAP_STEP : RETEX_PACK_MAP_LOG);
    return can && (spread->channels != 3 || spread->maps[2].kind == RETEX_PACK_MAP_ANGLE);
}

/* Planes of a spread: of standard deviations and their correlation, or of the sizes of axes. */
static int spread_planes(const RetexPackPart *spread)
{
    return spread->channels == RETEX_AXES ? 2 : spread->channels;
}

static int put_footprint(Stream *s, const RetexWebClass *c, int index, RetexError *err)
{
    const RetexFootprint *f = &s->set->footprints[c->footprints[index]];
    const RetexImage *uv = &s->set->parts[f->uv].image;
    const RetexPackPart *spread = &s->packed[f->spread];
    if (!can_encode(s, f))
        return retex_fail(err, RETEX_EUNSUPPORTED, "footprints '%s' are not as browsers need them",
                          s->set->parts[f->uv].name);
    for (size_t i = 0; i < s->pixels; i++)
        s->present[i] = uv->pixels[3 * i + 2] > 0;
    put_mask(s, uv);
    for (int k = 0; k < spread_planes(spread); k++) {
        numbers_of(s->numbers, s, f->spread, k);
        put_plane(s, uv, 8, 0);
    }
    for (int k = 0; k < 2; k++) {
        numbers_of(s->codes, s, f->spread, k);
        for (size_t i = 0; i < s->pixels; i++)
            s->shift[i] =
                (unsigned char)retex_pack_lattice_shift(&s->packed[f->uv], s->codes[i], spread->maps[k].per_octave);
        numbers_of(s->numbers, s, f->uv, k);
        put_plane(s, uv, 32, 1);
    }
    for (int k = 0; k < c->nweightings; k++)
        if (c->weights[k][index] >= 0) {
            const RetexPackPart *weight = &s->packed[c->weights[k][index]];
            if (weight->codec != RETEX_PACK_ZERO && weight->maps[0].kind != RETEX_PACK_MAP_LINEAR)
                return retex_fail(err, RETEX_EUNSUPPORTED, "weights '%s' are not as browsers need them",
                                  s->set->parts[c->weights[k][index]].name);
            numbers_of(s->numbers, s, c->weights[k][index], 0);
            put_plane(s, uv, 8, 0);
        }
    return 0;
}

int retex_web_footprints_encode(unsigned char **data, size_t *bytes, const RetexSet *set, const RetexPackPart *packed,
                                const RetexWebClass *c, RetexError *err)
{
    Stream s = {.set = set, .packed = packed};
    int code = stream_open(&s, c) ? 0 : no_memory(err);
    for (int i = 0; i < c->nfootprints && !code; i++)
        code = put_footprint(&s, c, i, err);
    *data = code ? NULL : retex_zlib_compress_most(s.data, s.bytes, bytes);
    stream_close(&s);
    return code ? code : *data ? 0 : no_memory(err);
}

size_t retex_web_records(const RetexSet *set, const RetexWebClass *c)
{
    size_t count = 0;
    for (int i = 0; i < c->nfootprints; i++) {
        const RetexImage *uv = &set->parts[set->footprints[c->footprints[i]].uv].image;
        for (size_t k = 0; k < (size_t)uv->width * (size_t)uv->height; k++)
            count += uv->pixels[3 * k + 2] > 0;
    }
    return count;
}

json_t *retex_web_footprints_describe(const RetexPackPart *packed, const RetexSet *set, const RetexWebClass *c)
{
    json_t *list = json_array();
    for (int i = 0; i < c->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[c->footprints[i]];
        const RetexPackPart *spread = &packed[f->spread];
        json_t *weights = json_array();
        for (int k = 0; k < c->nweightings; k++) {
            const int part = c->weights[k][i];
            retex_json_add(&weights, part == RETEX_WEB_WEIGHT_ONE    ? json_string("one")
                                     : part == RETEX_WEB_WEIGHT_NONE ? json_null()
                                                                     : json_real(packed[part].maps[0].first));
        }
        retex_json_add(&list,
                       json_pack("{s:f,s:i,s:i,s:i,s:o}", "first", spread->maps[0].first, "per_octave",
                                 spread->maps[0].per_octave, "sigma_first", packed[f->uv].sigma_first, "angle_steps",
                                 spread->channels != 3 ? 0 : spread->maps[2].per_octave, "weights", weights));
    }
    return list;
}
