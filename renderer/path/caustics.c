/* Photons through glass and off mirrors, and the cells made of where they landed. */
#include <stdlib.h>
#include <string.h>
#include <retex/parallel.h>
#include "path/caustics.h"
#include "path/sampler.h"
#include "path/shading.h"
#include "shade/material.h"

#define PATHS_PER_PHOTON 20 /* of the picture, for each photon that is tried */
#define PHOTONS_MIN (1 << 14)
#define PHOTONS_MAX (1 << 20) /* tried */
#define BATCH (1 << 12)       /* photons of one job */
#define BOUNCES_MAX 12
#define CELL_PHOTONS 64 /* cells of more are cut */
#define CELL_LEAST 16   /* but not into less */
#define LOBE_PHOTONS 4  /* the fewest that make a lobe */
#define LESS_LEAST 1e-5 /* 1 - cos: lobes are no narrower */
#define FADE 2.0        /* a lobe fades over so many mean squared distances of its photons */
#define WIDEN 0.7       /* half a lobe is within so much of its photons' mean 1 - cos */
#define QUANTILE_SAMPLES 64
#define STRONG_MIRROR 0.25f /* reflectance from which on a mirror is worth photons */
#define SHARE_LEAST 0.2f
#define SHARE_MOST 0.5f
#define SHARE_WORTH 0.03f  /* below, a cell is not worth looking at */
#define SPREAD_OF_CELL 0.5 /* how far beyond its photons a cell reaches, of their extent */

/* A photon that landed on a surface that scatters widely. */
typedef struct Landing {
    Vec3 position, from; /* from: on the last surface that refracted or mirrored it */
    float power;
} Landing;

/* The bounding sphere of a primitive that may refract or mirror light. */
typedef struct Caster {
    int primitive;
    Vec3 center;
    double radius;
} Caster;

typedef struct Node {
    float split;
    int axis;  /* 0..2, or -1: a leaf */
    int child; /* of the first of two nodes; of a leaf: its cell */
} Node;

typedef struct Bounds {
    Vec3 low, high;
} Bounds;

struct Caustics {
    Node *nodes;
    CausticsCell *cells;
    Bounds *bounds; /* of cells: where they are used */
    int nnodes, ncells;
};

/* State of building it. */
typedef struct Builder {
    const Scene *scene;
    const Accel *accel;
    const Lights *lights;
    const RetexBudget *budget; /* may stop it, or NULL */
    Caster *casters;
    double *caster_sums;
    int ncasters, nphotons;
    Landing *landings; /* BATCH for each batch */
    int *counts;       /* by batch: how many of them */
    Caustics *caustics;
} Builder;

/* ---- casters ---- */

static int finish_casts(const Finish *f, const Primitive *p, const Texture *texture)
{
    int bends = p->interior && p->interior->ior != 1 && p->interior->ior > 0;
    if (f->retex.present)
        return f->retex.roughness < 0.02 && ((bends && finish_transmits(f)) || f->retex.metallic > 0.5);
    if (rgb_luminance(f->reflection_max) >= STRONG_MIRROR && !f->reflection_fresnel)
        return 1;
    const Pigment *pigment = texture->pigment;
    return bends && (pigment->kind != PIGMENT_COLOR || pigment->color.filter + pigment->color.transmit > 0.1f);
}

static int texture_casts(const Primitive *p, const Texture *texture)
{
    for (int k = 0; k < texture_leaf_count(texture); k++)
        if (finish_casts(texture_leaf(texture, k)->finish, p, texture_leaf(texture, k)))
            return 1;
    return 0;
}

static int primitive_casts(const Primitive *p)
{
    const FaceTextures *textures = p->shape.textures;
    if (texture_casts(p, p->texture))
        return 1;
    for (int k = 0; textures && k < textures->count; k++)
        if (texture_casts(p, textures->list[k]))
            return 1;
    return 0;
}

static int find_casters(Builder *m, RetexError *err)
{
    double sum = 0;
    m->casters = malloc(((size_t)m->scene->nprimitives + 1) * sizeof *m->casters);
    m->caster_sums = malloc(((size_t)m->scene->nprimitives + 1) * sizeof *m->caster_sums);
    if (!m->casters || !m->caster_sums)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the guide to caustics");
    for (int k = 0; k < m->scene->nprimitives; k++) {
        const Primitive *p = &m->scene->primitives[k];
        Vec3 low, high;
        if (p->prototype || !primitive_casts(p) || !shape_bounds(p, &low, &high))
            continue;
        double radius = vec_length(vec_sub(high, low)) / 2;
        m->casters[m->ncasters] = (Caster){k, vec_scale(vec_add(low, high), 0.5), radius};
        m->caster_sums[m->ncasters++] = sum += radius * radius;
    }
    return RETEX_OK;
}

/* ---- photons ---- */

static float photon_number(uint32_t photon, uint32_t dimension)
{
    return unit_float(hash_pair(hash_mix(photon ^ 0x43415553u), dimension));
}

static int pick_caster(const Builder *m, double u)
{
    int low = 0, high = m->ncasters - 1;
    u *= m->caster_sums[high];
    while (low < high) {
        int middle = (low + high) / 2;
        if (m->caster_sums[middle] > u)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* Sample a direction in the cone of a caster. Returns the solid angle. */
static double aim(const Caster *c, Vec3 from, float u1, float u2, Vec3 *direction)
{
    Vec3 axis = vec_sub(c->center, from), s, t;
    double distance2 = vec_dot(axis, axis), sin2 = c->radius * c->radius / distance2, less = 2, sine, cosine;
    if (sin2 < 1)
        less = sin2 / (1 + sqrt(1 - sin2));
    axis = vec_normalize(axis);
    vec_frame(axis, &s, &t);
    turn_sincos(u2, &sine, &cosine);
    double down = u1 * less, across = sqrt(down * (2 - down));
    *direction = vec_mad(vec_mad(vec_scale(axis, 1 - down), s, across * cosine), t, across * sine);
    return 2 * PI * less;
}

/* Start a photon. Returns its power, 0 for none. */
static double start_photon(const Builder *m, uint32_t photon, Ray *ray, int *caster)
{
    EmissionPoint point;
    if (!lights_emission(m->lights, photon_number(photon, 0), photon_number(photon, 1), photon_number(photon, 2),
                         photon_number(photon, 3), &point))
        return 0;
    *caster = pick_caster(m, photon_number(photon, 4));
    const Caster *c = &m->casters[*caster];
    double part = c->radius * c->radius / m->caster_sums[m->ncasters - 1];
    double angle = aim(c, point.position, photon_number(photon, 5), photon_number(photon, 6), &ray->direction);
    ray->origin = accel_offset(point.position, point.normal, ray->direction);
    ray->tmin = 0, ray->tmax = INFINITY;
    return point.power * fabs(vec_dot(ray->direction, point.normal)) * angle / part;
}

/* Follow a photon while it is refracted or mirrored. Returns 1 where it lands after that. */
static int trace_photon(const Builder *m, uint32_t photon, Landing *landing)
{
    Ray ray;
    int caster = 0, bent = 0;
    double power = start_photon(m, photon, &ray, &caster);
    for (uint32_t k = 0; k < BOUNCES_MAX && power > 0; k++) {
        Hit hit;
        Shading s;
        BsdfSample next;
        if (!accel_intersect(m->accel, &ray, RAY_BOUNCE, &hit))
            return 0;
        /* a photon that meets another caster first is counted there */
        if (k == 0 && (hit.instance || hit.primitive != m->casters[caster].primitive))
            return 0;
        shading_at(&s, m->scene, NULL, 1, &ray, &hit);
        float straight = s.bsdf.lambert ? 0 : s.bsdf.p_mirror + s.bsdf.p_passing;
        if (bent && straight < 0.99f) {
            landing->position = s.surface.position;
            landing->power = (float)power * (1 - straight);
            return landing->power > 0;
        }
        if (!(straight > 0))
            return 0;
        /* light that is mirrored first is weak but spreads widely: it gets as many photons */
        float mirrored = s.bsdf.p_mirror / straight, u = photon_number(photon, 7 + k);
        float chosen = bent || mirrored <= 0 || mirrored >= 1 ? mirrored : 0.5f;
        int mirrors = u < chosen;
        u = mirrors ? u / chosen * mirrored : mirrored + (u - chosen) / (1 - chosen) * (1 - mirrored);
        if (!bsdf_sample(&s.bsdf, at_most(straight * u, 1 - 0x1p-24f), 0.5f, 0.5f, &next))
            return 0;
        power *= split_neutral(next.weight) * straight;
        power *= mirrors ? mirrored / chosen : (1 - mirrored) / (1 - chosen);
        if (next.straight) {
            ray.tmin = hit.t;
            continue;
        }
        bent = 1;
        landing->from = s.surface.position;
        ray.origin = accel_offset(s.surface.position, s.surface.geometric_normal, next.wi);
        ray.direction = next.wi;
        ray.tmin = 0;
    }
    return 0;
}

static void trace_batch(void *context, int index, int thread)
{
    Builder *m = context;
    Landing *landings = m->landings + (size_t)index * BATCH;
    uint32_t first = (uint32_t)index * BATCH;
    int count = 0;
    (void)thread;
    for (uint32_t k = 0; k < BATCH && !retex_budget_is_stopped(m->budget); k++)
        count += trace_photon(m, first + k, &landings[count]);
    m->counts[index] = count;
}

/* Trace batches; landings are collected in the order of batches. Returns their number. */
static int trace_batches(Builder *m, int batches, int nthreads)
{
    int count = 0;
    retex_parallel(nthreads, batches, trace_batch, m);
    for (int k = 0; k < batches; k++) {
        memmove(m->landings + count, m->landings + (size_t)k * BATCH, (size_t)m->counts[k] * sizeof *m->landings);
        count += m->counts[k];
    }
    return count;
}

/* ---- lobes ---- */

/* A group of a cell's photons, and the lobe that is fitted to it. */
typedef struct Lobe {
    int first, end;
    Vec3 center, at; /* means of where they came from, and of where they landed */
    double power;
    double less;      /* mean 1 - cos between the directions to there and to the centre */
    double distance2; /* mean squared distance of the landings from `at` */
} Lobe;

static double component(Vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* The key that photons are sorted by. */
static double key(const Landing *l, int of_from, int axis)
{
    return component(of_from ? l->from : l->position, axis);
}

/* Partial sort: the nth of a range gets its place, smaller ones before it and larger ones after it. */
static void select_nth(Landing *l, int first, int end, int nth, int of_from, int axis)
{
    while (end - first > 1) {
        double pivot = key(&l[first + (end - first) / 2], of_from, axis);
        int i = first, j = end - 1;
        while (i <= j) {
            while (key(&l[i], of_from, axis) < pivot)
                i++;
            while (key(&l[j], of_from, axis) > pivot)
                j--;
            if (i <= j) {
                Landing swap = l[i];
                l[i++] = l[j];
                l[j--] = swap;
            }
        }
        if (nth <= j)
            end = j + 1;
        else if (nth >= i)
            first = i;
        else
            return;
    }
}

static Bounds range_bounds(const Landing *l, int first, int end)
{
    Bounds b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int k = first; k < end; k++) {
        Vec3 p = l[k].position;
        b.low = vec3(fmin(b.low.x, p.x), fmin(b.low.y, p.y), fmin(b.low.z, p.z));
        b.high = vec3(fmax(b.high.x, p.x), fmax(b.high.y, p.y), fmax(b.high.z, p.z));
    }
    return b;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The axis along which photons spread most, without the outermost few, which may be very far away; and their
 * middle. */
static int widest_axis(const Landing *l, int first, int end, int of_from, double *middle)
{
    double keys[QUANTILE_SAMPLES], widest = -1;
    int best = 0, count = end - first < QUANTILE_SAMPLES ? end - first : QUANTILE_SAMPLES;
    for (int axis = 0; axis < 3; axis++) {
        for (int k = 0; k < count; k++)
            keys[k] = key(&l[first + (int)((long)k * (end - first) / count)], of_from, axis);
        qsort(keys, (size_t)count, sizeof *keys, compare);
        double low = keys[count / 8], high = keys[count - 1 - count / 8];
        if (high - low > widest)
            best = axis, widest = high - low, *middle = (low + high) / 2;
    }
    return best;
}

static double one_less_cosine(Vec3 at, Vec3 a, Vec3 b)
{
    Vec3 d = vec_sub(vec_normalize(vec_sub(a, at)), vec_normalize(vec_sub(b, at)));
    return vec_dot(d, d) / 2;
}

static void fit_lobe(const Landing *landings, Lobe *lobe)
{
    Vec3 from = {0, 0, 0}, at = {0, 0, 0};
    lobe->power = lobe->less = lobe->distance2 = 0;
    for (int k = lobe->first; k < lobe->end; k++) {
        from = vec_mad(from, landings[k].from, landings[k].power);
        at = vec_mad(at, landings[k].position, landings[k].power);
        lobe->power += landings[k].power;
    }
    lobe->center = vec_scale(from, 1 / lobe->power);
    lobe->at = vec_scale(at, 1 / lobe->power);
    for (int k = lobe->first; k < lobe->end; k++) {
        const Landing *l = &landings[k];
        Vec3 d = vec_sub(l->position, lobe->at);
        lobe->less += l->power * one_less_cosine(l->position, l->from, lobe->center) / lobe->power;
        lobe->distance2 += l->power * vec_dot(d, d) / lobe->power;
    }
}

/* Sort a lobe's photons into two halves, and fit a lobe to each. Returns their widths, weighted by power. */
static double halve_lobe(Landing *landings, const Lobe *lobe, int of_from, Lobe halves[2])
{
    int middle = lobe->first + (lobe->end - lobe->first) / 2;
    double ignored = 0;
    int axis = widest_axis(landings, lobe->first, lobe->end, of_from, &ignored);
    select_nth(landings, lobe->first, lobe->end, middle, of_from, axis);
    halves[0] = (Lobe){.first = lobe->first, .end = middle};
    halves[1] = (Lobe){.first = middle, .end = lobe->end};
    fit_lobe(landings, &halves[0]);
    fit_lobe(landings, &halves[1]);
    return halves[0].power * halves[0].less + halves[1].power * halves[1].less;
}

/* Split a lobe by where photons came from or by where they landed. In the second case each half keeps the power of the
 * whole. */
static void split_lobe(Landing *landings, Lobe *lobe, Lobe *other)
{
    Lobe halves[2];
    double by_place = halve_lobe(landings, lobe, 0, halves), by_origin = halve_lobe(landings, lobe, 1, halves);
    if (by_place < 2 * by_origin)
        halve_lobe(landings, lobe, 0, halves);
    *lobe = halves[0];
    *other = halves[1];
}

/* The lobe that gains most by being split, or -1. */
static int worst_lobe(const Lobe *lobes, int count)
{
    int worst = -1;
    for (int k = 0; k < count; k++) {
        if (lobes[k].end - lobes[k].first < 2 * LOBE_PHOTONS || lobes[k].less < LESS_LEAST)
            continue;
        if (worst < 0 || lobes[k].power * lobes[k].less > lobes[worst].power * lobes[worst].less)
            worst = k;
    }
    return worst;
}

static void make_lobes(CausticsCell *cell, Landing *landings, int first, int end)
{
    Lobe lobes[CAUSTICS_LOBES] = {{.first = first, .end = end}};
    int count = 1, worst;
    double power;
    fit_lobe(landings, &lobes[0]);
    power = lobes[0].power;
    while (count < CAUSTICS_LOBES && (worst = worst_lobe(lobes, count)) >= 0) {
        split_lobe(landings, &lobes[worst], &lobes[count++]);
    }
    memset(cell, 0, sizeof *cell);
    cell->nlobes = count;
    for (int k = 0; k < count; k++) {
        const Lobe *l = &lobes[k];
        double narrow = 1 / (FADE * l->distance2 + 1e-20);
        cell->x[k] = (float)l->center.x, cell->y[k] = (float)l->center.y, cell->z[k] = (float)l->center.z;
        cell->at_x[k] = (float)l->at.x, cell->at_y[k] = (float)l->at.y, cell->at_z[k] = (float)l->at.z;
        cell->concentration[k] = (float)(1 / (WIDEN * l->less + LESS_LEAST));
        cell->narrow[k] = (float)narrow;
        cell->weight[k] = (float)(l->power / power * narrow * lobes[0].distance2);
    }
}

/* ---- cells ---- */

/* The probability of sampling by the guide: by estimates of the irradiance of caustics and of all other light. */
static float cell_share(const Builder *m, const Bounds *b, double power)
{
    Vec3 d = vec_sub(b->high, b->low);
    double area = fmax(d.x * d.y, fmax(d.y * d.z, d.z * d.x)), caustic = power / fmax(area, 1e-12) / m->nphotons;
    LightSampleContext point = {vec_scale(vec_add(b->low, b->high), 0.5), {0, 0, 0}};
    double other = lights_estimate(m->lights, &point);
    return fminf(SHARE_MOST, fmaxf(SHARE_LEAST, (float)(caustic / (caustic + other))));
}

/* What the guide gains over a diffuse lobe, 0 to 1: by the second moment, mean 1 / density, that each has for the
 * directions of the photons. */
static double cell_gain(const CausticsCell *cell, const Landing *landings, int first, int end)
{
    double guided = 0, power = 0;
    for (int k = first; k < end; k++) {
        const Landing *l = &landings[k];
        Vec3 direction = vec_normalize(vec_sub(l->from, l->position));
        guided += l->power / fmax(caustics_density(cell, l->position, direction), 1e-6);
        power += l->power;
    }
    return fmax(0, 1 - guided / (power * PI));
}

static void make_cell(Builder *m, Landing *landings, int first, int end, Bounds b)
{
    Caustics *c = m->caustics;
    CausticsCell *cell = &c->cells[c->ncells];
    double power = 0;
    for (int k = first; k < end; k++)
        power += landings[k].power;
    make_lobes(cell, landings, first, end);
    cell->share = cell_share(m, &b, power) * (float)cell_gain(cell, landings, first, end);
    if (cell->share < SHARE_WORTH)
        cell->share = 0;
    Vec3 d = vec_sub(b.high, b.low);
    double least = 0.1 * fmax(d.x, fmax(d.y, d.z));
    Vec3 by =
        vec3(fmax(least, SPREAD_OF_CELL * d.x), fmax(least, SPREAD_OF_CELL * d.y), fmax(least, SPREAD_OF_CELL * d.z));
    c->bounds[c->ncells++] = (Bounds){vec_sub(b.low, by), vec_add(b.high, by)};
}

/* Partition photons by a plane across an axis, those below it first; returns their number. */
static int part_range(Landing *landings, int first, int end, int axis, float at)
{
    int middle = first;
    for (int k = first; k < end; k++)
        if ((float)key(&landings[k], 0, axis) < at) {
            Landing swap = landings[k];
            landings[k] = landings[middle];
            landings[middle++] = swap;
        }
    return middle;
}

static void make_nodes(Builder *m, int node, Landing *landings, int first, int end)
{
    Caustics *c = m->caustics;
    double at = 0;
    int axis = widest_axis(landings, first, end, 0, &at), middle = first;
    if (end - first > CELL_PHOTONS)
        middle = part_range(landings, first, end, axis, (float)at);
    if (middle - first < CELL_LEAST || end - middle < CELL_LEAST) {
        c->nodes[node] = (Node){0, -1, c->ncells};
        make_cell(m, landings, first, end, range_bounds(landings, first, end));
        return;
    }
    int child = c->nnodes;
    c->nodes[node] = (Node){(float)at, axis, child};
    c->nnodes += 2;
    make_nodes(m, child, landings, first, middle);
    make_nodes(m, child + 1, landings, middle, end);
}

static int make_guide(Builder *m, int count, RetexError *err)
{
    Caustics *c = m->caustics = calloc(1, sizeof *c);
    size_t most = (size_t)count / CELL_LEAST + 1;
    if (c) {
        c->cells = malloc(most * sizeof *c->cells);
        c->bounds = malloc(most * sizeof *c->bounds);
        c->nodes = malloc(2 * most * sizeof *c->nodes);
    }
    if (!c || !c->cells || !c->bounds || !c->nodes)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the guide to caustics");
    c->nnodes = 1;
    make_nodes(m, 0, m->landings, 0, count);
    return RETEX_OK;
}

/* Trace photons, in rounds of batches, until there are enough landings or photons. */
static int trace_photons(Builder *m, long paths, int nthreads, int *found, RetexError *err)
{
    long wanted = paths / PATHS_PER_PHOTON;
    wanted = wanted < PHOTONS_MIN ? PHOTONS_MIN : wanted > PHOTONS_MAX ? PHOTONS_MAX : wanted;
    int batches = (int)(wanted / BATCH);
    *found = 0;
    m->landings = malloc((size_t)batches * BATCH * sizeof *m->landings);
    m->counts = malloc((size_t)batches * sizeof *m->counts);
    if (!m->landings || !m->counts)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for photons");
    *found = trace_batches(m, batches, nthreads);
    m->nphotons = batches * BATCH;
    return retex_budget_check(m->budget, err);
}

int caustics_create(Caustics **caustics, const Scene *scene, const Accel *accel, const Lights *lights, long paths,
                    int nthreads, const RetexBudget *budget, RetexError *err)
{
    Builder m = {.scene = scene, .accel = accel, .lights = lights, .budget = budget};
    int found = 0, code = find_casters(&m, err);
    *caustics = NULL;
    if (!code && m.ncasters > 0 && lights_emit(lights))
        code = trace_photons(&m, paths, nthreads, &found, err);
    if (!code && found >= CELL_PHOTONS)
        code = make_guide(&m, found, err);
    if (code)
        caustics_close(&m.caustics);
    *caustics = m.caustics;
    free(m.casters);
    free(m.caster_sums);
    free(m.landings);
    free(m.counts);
    return code;
}

void caustics_close(Caustics **caustics)
{
    if (!*caustics)
        return;
    free((*caustics)->nodes);
    free((*caustics)->cells);
    free((*caustics)->bounds);
    free(*caustics);
    *caustics = NULL;
}

const CausticsCell *caustics_find(const Caustics *c, Vec3 position)
{
    const Node *node = c->nodes;
    while (node->axis >= 0)
        node = &c->nodes[node->child + ((float)component(position, node->axis) >= node->split)];
    const Bounds *b = &c->bounds[node->child];
    int inside = position.x >= b->low.x && position.y >= b->low.y && position.z >= b->low.z &&
                 position.x <= b->high.x && position.y <= b->high.y && position.z <= b->high.z;
    return inside && c->cells[node->child].share > 0 ? &c->cells[node->child] : NULL;
}
