/* See pools.h. */
#include "denoise/pools.h"

#include <stdlib.h>
#include <string.h>

#include "set/set.h"

static int is_part(const RetexSet *set, int part)
{
    return part >= 0 && part < set->nparts;
}

static RetexFootprintImage find_image(const RetexSet *set, int part, int least, int most)
{
    if (is_part(set, part)) {
        const RetexImage *im = &set->parts[part].image;
        if (im->pixels && im->width == set->width && im->height == set->height && im->channels >= least &&
            im->channels <= most)
            return (RetexFootprintImage){im->pixels, (size_t)im->channels, part};
    }
    return (RetexFootprintImage){.part = -1};
}

/* Light of a cluster that is its weight in a mixture, too, moves with the cluster. */
static int is_light(const RetexSet *set, int part)
{
    for (int t = 0; t < set->nterms; t++)
        if (set->terms[t].radiance == part)
            return 1;
    return 0;
}

/* The part that holds a footprint's weight in mixtures, or -1. Further such parts are counted as used by others. */
static int find_share(const RetexSet *set, int footprint, int *uses)
{
    int found = -1;
    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++) {
            int weight = set->mixtures[m].shares[k].weight;
            if (set->mixtures[m].shares[k].footprint != footprint || !is_part(set, weight) || is_light(set, weight))
                continue;
            if (uses && (found < 0 || found != weight))
                uses[weight] += 1 + (found >= 0);
            if (uses && found >= 0 && found != weight)
                uses[found]++;
            found = found < 0 ? weight : found;
        }
    return found;
}

static void count_uses(int *uses, const RetexSet *set)
{
    for (int k = 0; k < set->ntargets; k++)
        if (is_part(set, set->targets[k].original))
            uses[set->targets[k].original]++;
    for (int k = 0; k < set->nterms; k++)
        if (is_part(set, set->terms[k].radiance))
            uses[set->terms[k].radiance]++;
    for (int k = 0; k < set->nfootprints; k++) {
        const int parts[] = {set->footprints[k].uv, set->footprints[k].spread, set->footprints[k].albedo};
        for (int i = 0; i < 3; i++)
            if (is_part(set, parts[i]))
                uses[parts[i]]++;
        find_share(set, k, uses);
    }
}

/* Adds a footprint to a class; light -1 = none. */
static void add_place(RetexDenoiseFootprints *f, const RetexSet *set, RetexFootprintClass *g, int footprint, int light)
{
    const RetexFootprint *from = &set->footprints[footprint];
    RetexFootprintImages *place = &g->of[g->count++];
    *place = (RetexFootprintImages){.uv = find_image(set, from->uv, 3, 3),
                                    .spread = find_image(set, from->spread, 2, RETEX_AXES),
                                    .albedo = find_image(set, from->albedo, 3, 3),
                                    .light = find_image(set, light, 3, 3),
                                    .share = find_image(set, find_share(set, footprint, NULL), 1, 3)};
    f->nplaces++;
    g->nlit += light >= 0;
    int whole =
        place->uv.pixels && place->spread.pixels && place->albedo.pixels && !(light >= 0 && !place->light.pixels);
    g->movable &= whole;
}

/* The number of images of the class that are this part. */
static int count_in_class(const RetexFootprintClass *g, int part)
{
    int count = 0;
    for (int k = 0; k < g->count; k++) {
        const RetexFootprintImages *place = &g->of[k];
        count += (place->uv.part == part) + (place->spread.part == part) + (place->albedo.part == part) +
                 (place->light.part == part) + (place->share.part == part);
    }
    return count;
}

/* 1 if nothing but the class uses a part of it. Sharp clusters are copied, all from one pixel, so that several may
 * share a part, as quadrants do; others are pooled, each into parts of its own. */
static int is_own(const RetexDenoiseFootprints *f, const RetexFootprintClass *g, int part)
{
    return part < 0 || f->uses[part] == (g->kind == RETEX_FOOTPRINT_SHARP ? count_in_class(g, part) : 1);
}

/* When the class is complete: whether its parts may be written. */
static void finish_class(const RetexDenoiseFootprints *f, RetexFootprintClass *g)
{
    for (int k = 0; k < g->count && g->movable; k++) {
        const RetexFootprintImages *place = &g->of[k];
        g->movable = is_own(f, g, place->uv.part) && is_own(f, g, place->spread.part) &&
                     is_own(f, g, place->albedo.part) && is_own(f, g, place->light.part) &&
                     is_own(f, g, place->share.part);
    }
}

static RetexFootprintClass start_class(const RetexDenoiseFootprints *f, const RetexSet *set, int target,
                                       RetexFootprintKind kind)
{
    RetexFootprintClass g = {.kind = kind, .of = f->places + f->nplaces, .movable = 1};
    if (target >= 0)
        memcpy(g.periodic, set->targets[target].periodic, sizeof g.periodic);
    return g;
}

static int has_cluster(const RetexSignal *signal, int footprint)
{
    int count = 0;
    for (int k = 0; k < signal->nmembers; k++)
        count += signal->members[k].cluster == footprint;
    return count;
}

/* Finds the clusters of a signal; those all of whose light is interreflected come last. */
static void find_clusters(RetexDenoiseFootprints *f, const RetexSet *set, const RetexSignal *signal,
                          RetexFootprintClass *g)
{
    *g = start_class(f, set, signal->target, signal->kind);
    for (int k = 0; k < signal->nmembers; k++) {
        int footprint = signal->members[k].cluster;
        if (footprint < 0)
            continue;
        add_place(f, set, g, footprint, signal->members[k].part);
        g->movable &= has_cluster(signal, footprint) == 1;
    }
    for (int k = 0; k < set->nfootprints && g->count; k++)
        if (set->footprints[k].target == signal->target && set->footprints[k].kind == signal->kind &&
            !has_cluster(signal, k))
            add_place(f, set, g, k, -1);
    g->movable &=
        g->count <= FOOTPRINT_CLASS_MAX && (g->kind == RETEX_FOOTPRINT_SHARP || g->kind == RETEX_FOOTPRINT_BROAD);
    finish_class(f, g);
}

/* Interreflections of all targets share their light: all are pooled, or none. */
static void find_interreflections(RetexDenoiseFootprints *f, const RetexSet *set, const float *interreflected)
{
    int movable = 1;
    for (int t = 0; t < set->ntargets; t++) {
        RetexFootprintClass *g = &f->interreflections[f->ninterreflections];
        *g = start_class(f, set, t, RETEX_FOOTPRINT_INTERREFLECTION);
        g->interreflected = interreflected;
        for (int k = 0; k < set->nfootprints; k++)
            if (set->footprints[k].target == t && set->footprints[k].kind == RETEX_FOOTPRINT_INTERREFLECTION)
                add_place(f, set, g, k, -1);
        finish_class(f, g);
        movable &= g->movable && g->count <= FOOTPRINT_CLASS_MAX;
        f->ninterreflections += g->count > 0;
    }
    f->ninterreflections = movable ? f->ninterreflections : 0;
}

static void find_hits(RetexDenoiseFootprints *f, const RetexSet *set)
{
    for (int k = 0; k < set->nfootprints; k++) {
        if (set->footprints[k].kind != RETEX_FOOTPRINT_HIT || set->footprints[k].hit < 2)
            continue;
        RetexFootprintClass *g = &f->hits[f->nhits];
        *g = start_class(f, set, set->footprints[k].target, RETEX_FOOTPRINT_HIT);
        add_place(f, set, g, k, -1);
        finish_class(f, g);
        f->nhits += g->movable;
    }
}

/* Luminance of a signal's interreflected light, weighted as the film does; NULL where there is none. */
static int find_interreflected_light(float **interreflected, const RetexSet *set, const RetexSignal *signal,
                                     size_t pixels, RetexError *err)
{
    for (int k = 0; k < signal->nmembers; k++) {
        const RetexSignalMember *m = &signal->members[k];
        RetexFootprintImage light = find_image(set, m->part, 3, 3);
        if (signal->target < 0 || m->term < 0 || m->hits < 2 || !light.pixels)
            continue;
        if (!*interreflected && !(*interreflected = calloc(pixels, sizeof **interreflected)))
            return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise footprints");
        for (size_t i = 0; i < pixels; i++) {
            float more = m->weight * footprint_luminance(light.pixels + 3 * i);
            (*interreflected)[i] += more > 0 && more < FOOTPRINT_VALUE_MAX ? more : 0;
        }
    }
    return RETEX_OK;
}

static int find_all_interreflected_light(RetexDenoiseFootprints *f, const RetexDenoiser *d, RetexError *err)
{
    float **all = &f->interreflected[f->nsignals];
    int code = RETEX_OK;
    for (int s = 0; s < f->nsignals && !code; s++) {
        if (d->signals.of[s].kind == RETEX_FOOTPRINT_HIT || d->signals.of[s].lamp >= 0)
            continue;
        code = find_interreflected_light(&f->interreflected[s], d->set, &d->signals.of[s], f->pixels, err);
        if (!f->interreflected[s] || code)
            continue;
        if (!*all && !(*all = calloc(f->pixels, sizeof **all)))
            return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise footprints");
        for (size_t i = 0; i < f->pixels; i++)
            (*all)[i] += f->interreflected[s][i];
    }
    return code;
}

int retex_denoise_footprints_open(RetexDenoiseFootprints **out, const RetexDenoiser *d, RetexError *err)
{
    const RetexSet *set = d->set;
    size_t footprints = (size_t)set->nfootprints, signals = (size_t)d->signals.count;
    RetexDenoiseFootprints *f = *out = calloc(1, sizeof *f);
    int code = RETEX_OK;
    if (f) {
        f->width = (size_t)set->width, f->pixels = f->width * (size_t)set->height, f->nsignals = d->signals.count,
        f->spp = set->spp, f->radius = d->params.radius;
        f->uses = calloc((size_t)set->nparts + 1, sizeof *f->uses);
        f->signals = calloc(signals + 1, sizeof *f->signals);
        f->interreflections = calloc(RETEX_MAX_TARGETS + 1, sizeof *f->interreflections);
        f->hits = calloc(footprints + 1, sizeof *f->hits);
        f->interreflected = calloc(signals + 1, sizeof *f->interreflected);
        f->places = calloc(2 * footprints + (size_t)set->nterms + 1, sizeof *f->places);
    }
    if (!f || !f->uses || !f->signals || !f->interreflections || !f->hits || !f->interreflected || !f->places)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise footprints");
    if (!code)
        code = find_all_interreflected_light(f, d, err);
    if (code) {
        retex_denoise_footprints_close(out);
        return code;
    }
    count_uses(f->uses, set);
    for (int s = 0; s < f->nsignals; s++) {
        find_clusters(f, set, &d->signals.of[s], &f->signals[s]);
        f->signals[s].interreflected = f->interreflected[s];
    }
    find_interreflections(f, set, f->interreflected[f->nsignals]);
    find_hits(f, set);
    return RETEX_OK;
}

void retex_denoise_footprints_close(RetexDenoiseFootprints **out)
{
    RetexDenoiseFootprints *f = *out;
    if (!f)
        return;
    for (int s = 0; f->interreflected && s <= f->nsignals; s++)
        free(f->interreflected[s]);
    free(f->uses);
    free(f->signals);
    free(f->interreflections);
    free(f->hits);
    free(f->interreflected);
    free(f->places);
    free(f);
    *out = NULL;
}

static void mark(const RetexFootprintImage *image, unsigned char *written)
{
    if (image->part >= 0)
        written[image->part] = 1;
}

static void mark_class(const RetexFootprintClass *g, unsigned char *written)
{
    for (int k = 0; k < g->count; k++) {
        mark(&g->of[k].light, written);
        if (!g->movable)
            continue;
        mark(&g->of[k].uv, written);
        mark(&g->of[k].spread, written);
        mark(&g->of[k].albedo, written);
        if (g->of[k].share.channels == 1)
            mark(&g->of[k].share, written);
    }
}

void retex_denoise_mark_written(const RetexDenoiseFootprints *f, const RetexDenoiser *d, unsigned char *written)
{
    for (int s = 0; s < f->nsignals; s++)
        mark_class(&f->signals[s], written);
    for (int k = 0; k < f->ninterreflections && d->params.footprints; k++)
        mark_class(&f->interreflections[k], written);
    for (int k = 0; k < f->nhits && d->params.footprints; k++)
        mark_class(&f->hits[k], written);
}
