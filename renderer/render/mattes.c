/* See mattes.h. Rows are made when the file asks for them, so that no image of the mattes is ever in memory. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/output_file.h>
#include <retex/host/flat_exr.h>
#include <retex/parallel.h>
#include <retex/set_file.h>
#include <retex/target_name.h>
#include "render/cryptomatte.h"
#include "render/internal.h"
#include "render/mattes.h"
#include "render/seen_through.h"

/* So many camera rays suffice for masks, and no fewer do, however few samples the picture has. */
#define SAMPLES_LEAST 16
#define SAMPLES_MOST 256

/* What Cryptomatte has a matte of: names of objects and of materials, seen directly, or seen through glass and in
 * mirrors too. No name is the beginning of another one: Blender takes all layers that begin so as one. */
enum { CRYPTO_OBJECT, CRYPTO_MATERIAL, CRYPTO_THROUGH_OBJECT, CRYPTO_THROUGH_MATERIAL, CRYPTO_KINDS };
static const char *const crypto_kinds[CRYPTO_KINDS] = {"CryptoObject", "CryptoMaterial", "CryptoThroughObject",
                                                       "CryptoThroughMaterial"};
enum { TEXTS_EACH = 4, TEXT_NAME = 40 };

/* Masks of a target, by SeenHow. */
static const char *const how_names[3] = {"", "_transmitted", "_reflected"};

typedef struct MatteChannel {
    RetexFlatChannel flat;
    int value; /* index of Mattes.nvalues; -1 - c: channel c of the picture */
} MatteChannel;

typedef struct MatteThread {
    float *rows; /* values by row, value and column */
    CryptoNames names[CRYPTO_KINDS];
    int first; /* row that `rows` begins with */
} MatteThread;

typedef struct Mattes {
    const Render *render;
    FirstHitWindow window;
    const RetexImage *picture;
    int samples, ranks, ntargets, nvalues;
    MatteThread *threads;
    int nthreads;
    MatteChannel *channels;
    int nchannels;
    CryptoNames names[CRYPTO_KINDS]; /* of all threads */
    RetexFlatText texts[CRYPTO_KINDS * TEXTS_EACH];
    char text_names[CRYPTO_KINDS * TEXTS_EACH][TEXT_NAME];
    char *manifests[CRYPTO_KINDS];
    int ntexts;
} Mattes;

/* Of one pixel. */
typedef struct MattePixel {
    const Mattes *mattes;
    MatteThread *thread;
    double masks[RETEX_MAX_TARGETS][3];
    CryptoPixel crypto[CRYPTO_KINDS];
} MattePixel;

/* ---- names ---- */

enum { NUMBER_TEXT = 32 };

/* The innermost name that the object has; without one its number, as -t takes it. */
static const char *object_name(const Scene *scene, const SeenSurface *seen, char number[NUMBER_TEXT])
{
    const Surface *surface = &seen->leaf->s.surface;
    const IdentList *idents = surface->primitive->idents;
    if (!idents && surface->instance)
        idents = surface->instance->idents;
    if (idents)
        return scene_name_of(scene, idents->name);
    snprintf(number, NUMBER_TEXT, "#%d", seen->hit->primitive + 1);
    return number;
}

/* The name that a texture was given last. Those of its pigment stand at the list's end, and turn the order of those
 * before them round. */
static const IdentList *material_ident(const Texture *texture)
{
    const IdentList *of_pigment = texture->pigment->idents, *last = texture->idents;
    if (!of_pigment || texture->idents == of_pigment)
        return last ? last : of_pigment;
    while (last && last->next != of_pigment)
        last = last->next;
    return last ? last : texture->idents ? texture->idents : of_pigment;
}

/* A material without a name has that of its object. */
static const char *material_name(const Scene *scene, const SeenSurface *seen, const char *object)
{
    const IdentList *ident = material_ident(seen->leaf->s.surface.texture);
    return ident ? scene_name_of(scene, ident->name) : object;
}

/* ---- pixels ---- */

static void add_name(MattePixel *pixel, int kind, const char *name, float share)
{
    if (share > 0)
        crypto_pixel_add(&pixel->crypto[kind], crypto_names_add(&pixel->thread->names[kind], name), (double)share);
}

static void add_seen(void *context, const SeenSurface *seen)
{
    MattePixel *pixel = context;
    const Scene *scene = pixel->mattes->window.scene;
    const int target = seen->leaf->s.surface.target;
    char number[NUMBER_TEXT];
    const char *object = object_name(scene, seen, number), *material = material_name(scene, seen, object);
    if (target >= 0 && !(seen->met >> target & 1))
        pixel->masks[target][seen->how] += (double)seen->covers;
    if (seen->how == SEEN_DIRECTLY) {
        add_name(pixel, CRYPTO_OBJECT, object, seen->covers);
        add_name(pixel, CRYPTO_MATERIAL, material, seen->covers);
    }
    add_name(pixel, CRYPTO_THROUGH_OBJECT, object, seen->ends);
    add_name(pixel, CRYPTO_THROUGH_MATERIAL, material, seen->ends);
}

static void add_hit(void *context, const Ray *ray, const Hit *hit)
{
    MattePixel *pixel = context;
    seen_through(&pixel->mattes->window, ray, hit, add_seen, pixel);
}

static float *value_at(const Mattes *m, const MatteThread *thread, int line, int value)
{
    return thread->rows + ((size_t)line * (size_t)m->nvalues + (size_t)value) * (size_t)m->render->w;
}

static void store_pixel(MattePixel *pixel, int line, int x)
{
    const Mattes *m = pixel->mattes;
    float ranks[2 * (MATTE_RANKS_MAX + 1)] = {0};
    double rest = 1;
    int v = 0;
    for (int t = 0; t < m->ntargets; t++)
        for (int how = 0; how < 3; how++) {
            const double mask = pixel->masks[t][how] / m->samples;
            rest -= how == SEEN_DIRECTLY ? mask : 0;
            value_at(m, pixel->thread, line, v++)[x] = (float)mask;
        }
    value_at(m, pixel->thread, line, v++)[x] = (float)fmax(rest, 0);
    for (int kind = 0; kind < CRYPTO_KINDS; kind++) {
        for (int k = 0; k < pixel->crypto[kind].count; k++)
            pixel->crypto[kind].shares[k].share /= m->samples;
        crypto_pixel_ranks(&pixel->crypto[kind], m->ranks, ranks);
        for (int k = 0; k < (m->ranks + 1) / 2 * 4; k++)
            value_at(m, pixel->thread, line, v++)[x] = ranks[k];
    }
}

/* ---- rows, as the file asks for them ---- */

static int begin_rows(void *context, int y, int lines, int thread)
{
    const Mattes *m = context;
    MatteThread *own = &m->threads[thread];
    if (!own->rows &&
        !(own->rows = malloc((size_t)BAND_LINES * (size_t)m->nvalues * (size_t)m->render->w * sizeof(float))))
        return RETEX_ENOMEM;
    own->first = y;
    for (int line = 0; line < lines; line++)
        for (int x = 0; x < m->render->w; x++) {
            MattePixel pixel;
            if (render_is_stopped(m->render))
                return RETEX_ELIMIT;
            pixel.mattes = m, pixel.thread = own;
            memset(pixel.masks, 0, sizeof pixel.masks);
            for (int kind = 0; kind < CRYPTO_KINDS; kind++)
                pixel.crypto[kind].count = 0;
            render_camera_hits(m->render, m->render->x0 + x, m->render->y0 + y + line, m->samples, add_hit, &pixel);
            store_pixel(&pixel, line, x);
        }
    return RETEX_OK;
}

static void fill_row(void *context, int channel, int y, int thread, float *values)
{
    const Mattes *m = context;
    const MatteThread *own = &m->threads[thread];
    const int value = m->channels[channel].value;
    const size_t width = (size_t)m->render->w, step = (size_t)m->picture->channels;
    if (value >= 0) {
        memcpy(values, value_at(m, own, y - own->first, value), width * sizeof *values);
        return;
    }
    const float *row = m->picture->pixels + retex_image_index(m->picture, 0, y) + (-1 - value);
    for (size_t x = 0; x < width; x++)
        values[x] = row[x * step];
}

static void add_text(Mattes *m, const char *key, const char *name, const char *value)
{
    char *full = m->text_names[m->ntexts];
    snprintf(full, TEXT_NAME, "cryptomatte/%s/%s", key, name);
    m->texts[m->ntexts++] = (RetexFlatText){full, value};
}

static const RetexFlatText *metadata(void *context, int *count)
{
    Mattes *m = context;
    int is_whole = 1;
    for (int kind = 0; kind < CRYPTO_KINDS; kind++) {
        char key[8];
        for (int t = 0; t < m->nthreads; t++)
            crypto_names_join(&m->names[kind], &m->threads[t].names[kind]);
        m->manifests[kind] = crypto_names_manifest(&m->names[kind]);
        cryptomatte_key(key, crypto_kinds[kind]);
        add_text(m, key, "name", crypto_kinds[kind]);
        add_text(m, key, "hash", "MurmurHash3_32");
        add_text(m, key, "conversion", "uint32_to_float32");
        add_text(m, key, "manifest", m->manifests[kind]);
        is_whole &= m->manifests[kind] && !m->names[kind].failed;
    }
    *count = m->ntexts;
    return is_whole ? m->texts : NULL;
}

/* ---- channels ---- */

static void add_channel(Mattes *m, const char *layer, char letter, RetexPixelType type, int value)
{
    MatteChannel *channel = &m->channels[m->nchannels++];
    *channel = (MatteChannel){.flat.type = type, .value = value};
    snprintf(channel->flat.name, sizeof channel->flat.name, "%s%s%c", layer, *layer ? "." : "", letter);
}

static int compare_channels(const void *a, const void *b)
{
    return strcmp(((const MatteChannel *)a)->flat.name, ((const MatteChannel *)b)->flat.name);
}

/* In the order of store_pixel. */
static int list_channels(Mattes *m, RetexError *err)
{
    const int layers = (m->ranks + 1) / 2;
    char layer[RETEX_NAME_MAX], word[RETEX_NAME_MAX];
    m->channels = calloc((size_t)(3 + 3 * m->ntargets + 1 + CRYPTO_KINDS * layers * 4), sizeof *m->channels);
    if (!m->channels)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for mattes");
    for (int c = 0; c < 3; c++)
        add_channel(m, "", "RGB"[c], RETEX_HALF, -1 - c);
    for (int t = 0; t < m->ntargets; t++)
        for (int how = 0; how < 3; how++) {
            retex_target_word(word, m->window.scene->targets[t].name);
            snprintf(layer, sizeof layer, "mask_%.100s%s", word, how_names[how]);
            add_channel(m, layer, 'R', RETEX_FLOAT, m->nvalues++);
        }
    add_channel(m, "mask_rest", 'R', RETEX_FLOAT, m->nvalues++);
    for (int kind = 0; kind < CRYPTO_KINDS; kind++)
        for (int k = 0; k < layers; k++)
            for (int c = 0; c < 4; c++) {
                snprintf(layer, sizeof layer, "%s%02d", crypto_kinds[kind], k);
                add_channel(m, layer, "RGBA"[c], RETEX_FLOAT, m->nvalues++);
            }
    qsort(m->channels, (size_t)m->nchannels, sizeof *m->channels, compare_channels);
    for (int c = 1; c < m->nchannels; c++)
        if (strcmp(m->channels[c - 1].flat.name, m->channels[c].flat.name) == 0)
            return retex_fail(err, RETEX_EINVAL, "two masks would be the channel %s: give one target another name",
                              m->channels[c].flat.name);
    return RETEX_OK;
}

static int write_rows(Mattes *m, const char *path, RetexError *err)
{
    const RetexFlatRows rows = {m, begin_rows, fill_row, metadata};
    RetexFlatChannel *flat = calloc((size_t)m->nchannels, sizeof *flat);
    if (!flat)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for mattes");
    for (int c = 0; c < m->nchannels; c++)
        flat[c] = m->channels[c].flat;
    int code = retex_flat_exr_write(path, m->render->w, m->render->h, flat, m->nchannels, &rows,
                                    m->render->params.nthreads, err);
    if (code && render_is_stopped(m->render))
        code = retex_budget_check(m->render->params.budget, err);
    free(flat);
    return code;
}

static void close_mattes(Mattes *m)
{
    for (int kind = 0; kind < CRYPTO_KINDS; kind++) {
        for (int t = 0; t < m->nthreads && m->threads; t++)
            crypto_names_close(&m->threads[t].names[kind]);
        crypto_names_close(&m->names[kind]);
        free(m->manifests[kind]);
    }
    for (int t = 0; t < m->nthreads && m->threads; t++)
        free(m->threads[t].rows);
    free(m->threads);
    free(m->channels);
}

static int write_mattes(const Render *r, const RetexImage *picture, int ranks, const char *path, RetexError *err)
{
    Mattes m = {.render = r,
                .window = render_window(r),
                .picture = picture,
                .samples = r->params.spp,
                .ranks = ranks,
                .ntargets = r->scene->ntargets,
                .nthreads = retex_threads(r->params.nthreads)};
    m.samples = m.samples < SAMPLES_LEAST ? SAMPLES_LEAST : m.samples > SAMPLES_MOST ? SAMPLES_MOST : m.samples;
    m.threads = calloc((size_t)m.nthreads, sizeof *m.threads);
    int code = m.threads ? list_channels(&m, err) : retex_fail(err, RETEX_ENOMEM, "out of memory for mattes");
    const uint64_t bytes = (uint64_t)m.nthreads * BAND_LINES * (uint64_t)m.nvalues * (uint64_t)r->w * sizeof(float);
    if (!code)
        code = retex_budget_charge(r->params.budget, bytes, "mattes", err);
    if (!code) {
        code = write_rows(&m, path, err);
        retex_budget_release(r->params.budget, bytes);
    }
    close_mattes(&m);
    return code;
}

int mattes_check(const Scene *scene, const char *path, RetexError *err)
{
    Mattes m = {.window.scene = scene, .ranks = 1, .ntargets = scene->ntargets};
    int code = list_channels(&m, err);
    if (!code)
        code = retex_output_check(path, err);
    close_mattes(&m);
    return code;
}

int mattes_write(const Scene *scene, const RenderParams *params, const RetexImage *picture, int ranks, const char *path,
                 RetexError *err)
{
    RenderParams own = *params;
    Render r;
    render_drop_files(&own);
    own.progress = NULL;
    int code = render_open(&r, scene, &own, err);
    r.context.halves = own.control_data == 2 ? 2 : 1;
    if (!code)
        code = write_mattes(&r, picture, ranks, path, err);
    render_close(&r);
    return code;
}
