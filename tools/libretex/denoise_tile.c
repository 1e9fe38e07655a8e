/* See denoise_tile.h. */
#include "denoise_tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STRENGTH 0.45f      /* of params.strength 1, in standard deviations: k of Rousselle et al. 2012 */
#define FEATURE_STRENGTH 0.6f /* k_f of Rousselle et al. 2013 */
#define LEAST_COVER 0.02f   /* of a target: less is not told from none */
#define SPECULAR_SHARE 0.04f /* of a target's light that its texture does not multiply, roughly */
#define LEAST_MODULATION 0.02f
#define PLANE_SLOPE 0.3f    /* how far from the tangent plane, per distance, surfaces count as one */

/* What a tile holds of one signal. */
typedef struct SignalRoom {
    float *half[2][3], *variance[3], *kind, *modulation[3];
    int nplanes;
    float **planes, **sums; /* channel by channel: all clusters together where there are several, then other members */
    float *sum[2][3], *norm[2][3];
} SignalRoom;

struct TileRoom {
    float *memory;
    float *valid, *features[DENOISE_FEATURES_MAX], *scales[DENOISE_GROUPS_MAX];
    float *alike; /* weight by features */
    float *spare; /* a plane */
    float *scratch;
    SignalRoom *signals;
    float **pointers;
};

/* ---- room ---- */

/* Members that are clusters: light of one footprint among several of its kind. */
static int is_cluster(const RetexSet *set, const SignalMember *member)
{
    return member->term >= 0 && set->terms[member->term].nfactors == 1 && set->terms[member->term].factors[0] >= 0 &&
           set->footprints[set->terms[member->term].factors[0]].kind != RETEX_FOOTPRINT_HIT;
}

static int count_clusters(const RetexSet *set, const Signal *signal)
{
    int count = 0;
    for (int k = 0; k < signal->nmembers; k++)
        count += is_cluster(set, &signal->members[k]);
    return count;
}

/* Images of a signal that are filtered: one for all clusters, one for each other member. */
static int count_images(const RetexSet *set, const Signal *signal)
{
    int clusters = count_clusters(set, signal);
    return signal->nmembers - clusters + (clusters > 0);
}

static float *take(float **memory, size_t floats)
{
    float *p = *memory;
    *memory += floats;
    return p;
}

static void lay_out(TileRoom *room, const Denoiser *d)
{
    float *at = room->memory, **pointer = room->pointers;
    room->valid = take(&at, DENOISE_PLANE), room->spare = take(&at, DENOISE_PLANE);
    for (int k = 0; k < DENOISE_FEATURES_MAX; k++)
        room->features[k] = take(&at, DENOISE_PLANE);
    for (int k = 0; k < DENOISE_GROUPS_MAX; k++)
        room->scales[k] = take(&at, DENOISE_PLANE);
    room->alike = take(&at, DENOISE_PIXELS);
    room->scratch = take(&at, DENOISE_SCRATCH);
    for (int s = 0; s < d->signals.count; s++) {
        SignalRoom *r = &room->signals[s];
        r->nplanes = 3 * count_images(d->set, &d->signals.of[s]);
        r->planes = pointer, pointer += r->nplanes;
        r->sums = pointer, pointer += r->nplanes;
        r->kind = take(&at, DENOISE_PLANE);
        for (int c = 0; c < 3; c++) {
            r->variance[c] = take(&at, DENOISE_PLANE), r->modulation[c] = take(&at, DENOISE_PLANE);
            for (int h = 0; h < 2; h++) {
                r->half[h][c] = take(&at, DENOISE_PLANE);
                r->sum[h][c] = take(&at, DENOISE_PIXELS), r->norm[h][c] = take(&at, DENOISE_PIXELS);
            }
        }
        for (int k = 0; k < r->nplanes; k++)
            r->planes[k] = take(&at, DENOISE_PLANE), r->sums[k] = take(&at, DENOISE_PIXELS);
    }
}

int tile_room_create(TileRoom **out, const Denoiser *d, RetexError *err)
{
    TileRoom *room = *out = calloc(1, sizeof *room);
    size_t planes = 2 + DENOISE_FEATURES_MAX + DENOISE_GROUPS_MAX, images = 1, pointers = 1;
    for (int s = 0; s < d->signals.count; s++) {
        size_t n = 3 * (size_t)count_images(d->set, &d->signals.of[s]);
        planes += 13 + n, images += 12 + n, pointers += 2 * n;
    }
    if (room) {
        room->memory = calloc(planes * DENOISE_PLANE + images * DENOISE_PIXELS + DENOISE_SCRATCH, sizeof(float));
        room->signals = calloc((size_t)d->signals.count + 1, sizeof *room->signals);
        room->pointers = calloc(pointers, sizeof *room->pointers);
    }
    if (!room || !room->memory || !room->signals || !room->pointers) {
        tile_room_close(out);
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise a tile");
    }
    lay_out(room, d);
    return RETEX_OK;
}

void tile_room_close(TileRoom **out)
{
    TileRoom *room = *out;
    if (!room)
        return;
    free(room->memory);
    free(room->signals);
    free(room->pointers);
    free(room);
    *out = NULL;
}

/* ---- gathering ---- */

static int clamp(int x, int size)
{
    return x < 0 ? 0 : x < size ? x : size - 1;
}

/* A channel of a part around the tile; what lies outside the picture is as its border. */
static void gather(float *restrict plane, const RetexSet *set, int part, int channel, int x0, int y0)
{
    const RetexImage *im = &set->parts[part].image;
    for (int y = -DENOISE_HALO; y < DENOISE_TILE + DENOISE_HALO; y++) {
        const float *row = im->pixels + retex_image_index(im, 0, clamp(y0 + y, im->height)) + channel;
        float *restrict to = plane + denoise_at(-DENOISE_HALO, y);
        for (int x = 0; x < DENOISE_PITCH; x++) {
            float v = row[(size_t)clamp(x0 + x - DENOISE_HALO, im->width) * (size_t)im->channels];
            to[x] = fabsf(v) < 1e30f ? v : 0; /* not what is not finite */
        }
    }
}

static void add_gathered(float *restrict plane, float *restrict spare, const RetexSet *set, int part, int channel,
                         int x0, int y0, float weight)
{
    gather(spare, set, part, channel, x0, y0);
    for (int i = 0; i < DENOISE_PLANE; i++)
        plane[i] += weight * spare[i];
}

/* ---- features ---- */

/* Squared change of features from pixel to pixel: the lesser of both sides, so that edges are no slopes. */
static void add_gradient(float *restrict squares, const float *restrict f)
{
    for (int y = 1; y < DENOISE_ROWS - 1; y++)
        for (int x = 1; x < DENOISE_PITCH - 1; x++) {
            size_t i = (size_t)y * DENOISE_PITCH + (size_t)x;
            float l = f[i] - f[i - 1], r = f[i + 1] - f[i], u = f[i] - f[i - DENOISE_PITCH],
                  d = f[i + DENOISE_PITCH] - f[i];
            squares[i] += fminf(l * l, r * r) + fminf(u * u, d * d);
        }
}

static void add_group(DenoiseFeatures *f, TileRoom *room, int first, int count, float least)
{
    DenoiseGroup *g = &f->groups[f->ngroups];
    float *scale = room->scales[f->ngroups++];
    memset(scale, 0, sizeof *scale * DENOISE_PLANE);
    for (int k = 0; k < count; k++)
        add_gradient(scale, room->features[first + k]);
    for (int i = 0; i < DENOISE_PLANE; i++)
        scale[i] = 1 / (FEATURE_STRENGTH * FEATURE_STRENGTH * fmaxf(least, scale[i]));
    *g = (DenoiseGroup){.first = first, .count = count, .scale = scale};
}

/* Positions are alike where they lie in one plane. */
static void add_position(DenoiseFeatures *f, TileRoom *room, int first, int normal)
{
    DenoiseGroup *g = &f->groups[f->ngroups];
    float *scale = room->scales[f->ngroups++];
    memset(scale, 0, sizeof *scale * DENOISE_PLANE);
    for (int k = 0; k < 3; k++)
        add_gradient(scale, room->features[first + k]);
    for (int i = 0; i < DENOISE_PLANE; i++)
        scale[i] = 1 / (PLANE_SLOPE * PLANE_SLOPE * 0.5f * fmaxf(1e-20f, scale[i]));
    *g = (DenoiseGroup){.first = first, .count = 3, .scale = scale};
    for (int k = 0; k < 3; k++)
        g->normal[k] = room->features[normal + k];
}

static int is_constant(const float *plane, float value)
{
    for (int i = 0; i < DENOISE_PLANE; i++)
        if (plane[i] != value)
            return 0;
    return 1;
}

static void gather_features(DenoiseFeatures *f, TileRoom *room, const Denoiser *d, int x0, int y0)
{
    const Guides *g = &d->guides;
    const int parts[] = {g->seen_normal, g->seen_position, g->seen_albedo, g->seen_material,
                         g->normal,      g->position,      g->specular};
    const int counts[] = {3, 3, 3, 3, 3, 3, 1};
    int n = 0;
    *f = (DenoiseFeatures){.valid = room->valid};
    for (int k = 0; k < 7; k++)
        for (int c = 0; c < counts[k]; c++)
            gather(room->features[n++], d->set, parts[k], c, x0, y0);
    for (int s = 0; s < d->signals.count; s++)
        if (d->signals.of[s].cover >= 0 && d->signals.of[s].kind != RETEX_FOOTPRINT_BROAD)
            gather(room->features[n++], d->set, d->signals.of[s].cover, 0, x0, y0);
    for (int k = 0; k < n; k++)
        f->planes[k] = room->features[k];
    add_group(f, room, 0, 3, 4e-3f);
    add_position(f, room, 3, 0);
    add_group(f, room, 6, 3, 2e-3f);
    add_group(f, room, 9, 3, 4e-3f);
    if (!is_constant(room->features[18], 0)) { /* else it is what is seen */
        add_group(f, room, 12, 3, 4e-3f);
        add_position(f, room, 15, 12);
        add_group(f, room, 18, 1, 4e-3f);
    }
    for (int k = 19; k < n; k++)
        add_group(f, room, k, 1, 4e-3f);
    for (int y = -DENOISE_HALO; y < DENOISE_TILE + DENOISE_HALO; y++)
        for (int x = -DENOISE_HALO; x < DENOISE_PITCH - DENOISE_HALO; x++)
            room->valid[denoise_at(x, y)] =
                x0 + x >= 0 && x0 + x < d->set->width && y0 + y >= 0 && y0 + y < d->set->height;
}

/* ---- signals ---- */

/* What the light is multiplied by at the pixel, as far as guides know: it is taken out before pixels are compared. */
static void find_modulation(SignalRoom *r, TileRoom *room, const Denoiser *d, const Signal *signal, int x0, int y0)
{
    for (int i = 0; i < DENOISE_PLANE; i++)
        r->kind[i] = 1;
    if (signal->target >= 0 && signal->kind != RETEX_FOOTPRINT_BROAD) {
        int sharp = signal->kind == RETEX_FOOTPRINT_SHARP;
        gather(room->spare, d->set, signal->cover, 0, x0, y0);
        for (int i = 0; i < DENOISE_PLANE; i++) {
            int covered = sharp && room->spare[i] > LEAST_COVER;
            for (int c = 0; c < 3; c++)
                r->modulation[c][i] = covered ? room->spare[i] : 1;
            r->kind[i] = covered ? 1 : sharp ? -1 : 1;
        }
        return;
    }
    for (int c = 0; c < 3; c++)
        gather(r->modulation[c], d->set, d->guides.seen_albedo, c, x0, y0);
    for (int s = 0; s < d->signals.count; s++) {
        const Signal *other = &d->signals.of[s];
        if (other->cover < 0 || other->kind == RETEX_FOOTPRINT_BROAD)
            continue;
        for (int c = 0; c < 3; c++)
            add_gathered(r->modulation[c], room->spare, d->set, other->cover, 0, x0, y0, SPECULAR_SHARE - 1);
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < DENOISE_PLANE; i++)
            r->modulation[c][i] = fmaxf(r->modulation[c][i], LEAST_MODULATION);
}

/* Mean over 5x5 pixels of a plane, through spare. */
static void smooth(float *restrict plane, float *restrict spare)
{
    for (int i = 2; i < DENOISE_PLANE - 2; i++)
        spare[i] = 0.2f * (plane[i - 2] + plane[i - 1] + plane[i] + plane[i + 1] + plane[i + 2]);
    for (int i = 2 * DENOISE_PITCH + 2; i < DENOISE_PLANE - 2 * DENOISE_PITCH - 2; i++)
        plane[i] = 0.2f * (spare[i - 2 * DENOISE_PITCH] + spare[i - DENOISE_PITCH] + spare[i] +
                           spare[i + DENOISE_PITCH] + spare[i + 2 * DENOISE_PITCH]);
}

/* Planes of a signal: images to filter, halves of the total, the variance of these. */
static void gather_signal(SignalRoom *r, TileRoom *room, const Denoiser *d, const Signal *signal, int x0, int y0)
{
    const RetexSet *set = d->set;
    int clusters = count_clusters(set, signal), image = clusters > 0;
    for (int k = 0; k < r->nplanes; k++)
        memset(r->planes[k], 0, sizeof(float) * DENOISE_PLANE);
    for (int c = 0; c < 3; c++)
        memset(r->half[0][c], 0, sizeof(float) * DENOISE_PLANE);
    for (int k = 0; k < signal->nmembers; k++) {
        const SignalMember *m = &signal->members[k];
        int to = is_cluster(set, m) ? 0 : image++;
        for (int c = 0; c < 3; c++) {
            gather(room->spare, set, m->part, c, x0, y0);
            float *restrict plane = r->planes[3 * to + c], *restrict total = r->half[0][c];
            for (int i = 0; i < DENOISE_PLANE; i++)
                plane[i] += room->spare[i], total[i] += m->weight * room->spare[i];
        }
    }
    float first = 2 * (float)(set->spp - set->spp / 2) / (float)set->spp, second = 2 - first;
    for (int c = 0; c < 3; c++) {
        float *restrict a = r->half[0][c], *restrict b = r->half[1][c], *restrict v = r->variance[c];
        const float *restrict m = r->modulation[c];
        gather(room->spare, set, signal->noise, c, x0, y0);
        for (int i = 0; i < DENOISE_PLANE; i++) {
            float total = a[i], noise = room->spare[i] / m[i];
            a[i] = total / m[i] + first * noise;
            b[i] = total / m[i] - second * noise;
            v[i] = 2 * noise * noise;
        }
        smooth(v, room->spare);
    }
}

static DenoiseSignal start_signal(SignalRoom *r, TileRoom *room, const Denoiser *d)
{
    DenoiseSignal s = {.kind = r->kind,
                       .strength = STRENGTH * STRENGTH * d->params.strength * d->params.strength,
                       .nplanes = r->nplanes,
                       .planes = (const float *const *)r->planes,
                       .sums = r->sums,
                       .scratch = room->scratch};
    double level = 0;
    for (int c = 0; c < 3; c++) {
        s.variance[c] = r->variance[c], s.modulation[c] = r->modulation[c];
        for (int h = 0; h < 2; h++) {
            s.half[h][c] = r->half[h][c], s.sum[h][c] = r->sum[h][c], s.norm[h][c] = r->norm[h][c];
            memset(r->sum[h][c], 0, sizeof(float) * DENOISE_PIXELS);
            memset(r->norm[h][c], 0, sizeof(float) * DENOISE_PIXELS);
        }
        for (int i = 0; i < DENOISE_PLANE; i++)
            level += fabsf(r->half[0][c][i]);
    }
    for (int k = 0; k < r->nplanes; k++)
        memset(r->sums[k], 0, sizeof(float) * DENOISE_PIXELS);
    level /= 3 * DENOISE_PLANE;
    s.epsilon = fmaxf(1e-20f, 1e-6f * (float)(level * level));
    return s;
}

/* ---- results ---- */

static float *band_pixel(const Denoiser *d, const Band *band, int part, int x, int y)
{
    size_t channels = (size_t)d->set->parts[part].image.channels;
    return band->parts[part] + ((size_t)(y - band->first) * (size_t)d->set->width + (size_t)x) * channels;
}

static float luminance(const float *c)
{
    return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
}

/* One pixel: p in planes, i in sums. */
static void finish_pixel(const Denoiser *d, const Signal *signal, const SignalRoom *r, size_t p, size_t i, int x, int y,
                         Band *band, SignalSums *sums)
{
    const RetexSet *set = d->set;
    int clusters = count_clusters(set, signal), image = clusters > 0;
    float scale[3], own = 0;
    for (int c = 0; c < 3; c++) {
        float m = r->modulation[c][p], before = 0.5f * (r->half[0][c][p] + r->half[1][c][p]) * m, members = 0;
        float total = 0.5f * m * (r->sum[0][c][i] / r->norm[0][c][i] + r->sum[1][c][i] / r->norm[1][c][i]);
        float norm = 0.5f * (r->norm[0][c][i] + r->norm[1][c][i]);
        int at = clusters > 0;
        for (int k = 0; k < signal->nmembers; k++)
            if (!is_cluster(set, &signal->members[k]))
                members += signal->members[k].weight * r->sums[3 * at++ + c][i];
        if (clusters > 0)
            members += r->sums[c][i];
        scale[c] = members > 0 ? total / members : 0;
        sums->before[c] += before, sums->after[c] += total;
        (void)norm;
    }
    for (int k = 0; k < signal->nmembers; k++) {
        const SignalMember *m = &signal->members[k];
        const RetexImage *im = &set->parts[m->part].image;
        const float *from = im->pixels + retex_image_index(im, x, y);
        if (is_cluster(set, m))
            own += luminance(from);
    }
    for (int k = 0; k < signal->nmembers; k++) {
        const SignalMember *m = &signal->members[k];
        const RetexImage *im = &set->parts[m->part].image;
        const float *from = im->pixels + retex_image_index(im, x, y);
        float *to = band_pixel(d, band, m->part, x, y);
        int cluster = is_cluster(set, m);
        float share = !cluster ? 1 : own > 0 ? luminance(from) / own : 0;
        int at = cluster ? 0 : image++;
        for (int c = 0; c < 3; c++)
            to[c] = share * scale[c] * r->sums[3 * at + c][i];
    }
}

void tile_denoise(const Denoiser *d, TileRoom *room, int x0, int y0, Band *band, SignalSums *sums)
{
    DenoiseFeatures features;
    DenoiseSignal signals[1 + 2 * RETEX_MAX_TARGETS];
    int radius = d->params.radius;
    gather_features(&features, room, d, x0, y0);
    for (int s = 0; s < d->signals.count; s++) {
        find_modulation(&room->signals[s], room, d, &d->signals.of[s], x0, y0);
        gather_signal(&room->signals[s], room, d, &d->signals.of[s], x0, y0);
        signals[s] = start_signal(&room->signals[s], room, d);
    }
    for (int dy = -radius; dy <= radius; dy++)
        for (int dx = -radius; dx <= radius; dx++) {
            denoise_features_kernel(room->alike, &features, dx, dy, d->params.scalar);
            for (int s = 0; s < d->signals.count; s++)
                denoise_signal_kernel(&signals[s], room->alike, dx, dy, d->params.scalar);
        }
    for (int y = y0; y < y0 + DENOISE_TILE && y < d->roi.y1; y++)
        for (int x = x0; x < x0 + DENOISE_TILE && x < d->roi.x1; x++)
            for (int s = 0; s < d->signals.count; s++)
                finish_pixel(d, &d->signals.of[s], &room->signals[s], denoise_at(x - x0, y - y0),
                             (size_t)(y - y0) * DENOISE_TILE + (size_t)(x - x0), x, y, band, &sums[s]);
}
