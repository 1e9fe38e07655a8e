/* The cells of the guide, made of where photons landed, and their lobes. */
#include <stdlib.h>
#include <string.h>
#include "base/bvh.h"
#include "path/caustics.h"

#define CELL_PHOTONS 64 /* cells of more are cut */
#define CELL_LEAST 16   /* but not into less */
#define LOBE_PHOTONS 8  /* the fewest that make a lobe */
#define LESS_LEAST 1e-6 /* 1 - cos: lobes are no narrower */
#define MOVE_LEAST 1e-3 /* of the spread of landings: what moves less tells nothing of how origins move with them */
#define FADE 2.0        /* a lobe fades over so many mean squared distances of its photons */
#define WIDEN 1.0       /* half a lobe is within so much of its photons' mean 1 - cos */
#define QUANTILE_SAMPLES 64
#define SHARE_LEAST 0.2f
#define SHARE_MOST 0.5f
/* Mean, by power, of the squared share of caustics in the light, times what the guide takes off their second moment.
 * Below, the guide costs more than it gains: .1 in a scene with a large lamp over glass, .5 in a furnished room; from
 * 2.6 on it gains. */
#define WORTH_LEAST 2.0
#define SHARE_WORTH 0.03f  /* below, a cell is not worth looking at */
#define SPREAD_OF_CELL 0.5 /* how far beyond its photons a cell reaches, of their extent */

typedef struct Node {
    float split;
    int axis;  /* 0..2, or -1: a leaf */
    int child; /* of the first of two nodes; of a leaf: its cell */
} Node;

struct Caustics {
    Node *nodes;
    CausticsCell *cells;
    Bounds *bounds; /* of cells: where they are used */
    int nnodes, ncells;
};

/* State of building it. */
typedef struct Builder {
    const Lights *lights;
    Photons photons;
    Caustics *caustics;
    double power, worth; /* of all photons; what the guide is worth at each, times its power */
} Builder;

/* ---- lobes ---- */

/* Some of a cell's photons, and the lobe that is fitted to it. */
typedef struct Lobe {
    int first, end;
    Vec3 center, at; /* means of where they came from, and of where they landed */
    double power;
    double move[3][3]; /* how the origin moves with the landing: a linear fit about the means */
    double less;       /* mean 1 - cos between the directions to there and to the centre, as it moves */
    double distance2;  /* mean squared distance of the landings from `at` */
} Lobe;

/* The key that photons are sorted by. */
static double key(const Landing *l, int of_from, int axis)
{
    return vec_component(of_from ? l->from : l->position, axis);
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
    Bounds b = bounds_empty();
    for (int k = first; k < end; k++)
        bounds_add(&b, l[k].position);
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

static Vec3 lobe_center(const Lobe *lobe, Vec3 position)
{
    const Vec3 d = vec_sub(position, lobe->at);
    const double(*m)[3] = lobe->move;
    return vec3(lobe->center.x + m[0][0] * d.x + m[0][1] * d.y + m[0][2] * d.z,
                lobe->center.y + m[1][0] * d.x + m[1][1] * d.y + m[1][2] * d.z,
                lobe->center.z + m[2][0] * d.x + m[2][1] * d.y + m[2][2] * d.z);
}

/* The inverse of a symmetric matrix that is positive definite. */
static void invert(double m[3][3], double out[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
            out[k][i] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    const double det = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
    for (int i = 0; i < 9; i++)
        out[i / 3][i % 3] = det > 0 ? out[i / 3][i % 3] / det : 0;
}

/* Least squares: where the light that a lens or mirror bends to a point comes from, as the point moves. */
static void fit_move(const Landing *landings, Lobe *lobe)
{
    double both[3][3] = {{0}}, landed[3][3] = {{0}}, inverse[3][3];
    for (int k = lobe->first; k < lobe->end; k++) {
        const Vec3 a = vec_sub(landings[k].position, lobe->at), f = vec_sub(landings[k].from, lobe->center);
        for (int i = 0; i < 9; i++) {
            const double at = landings[k].power * vec_component(a, i % 3);
            both[i / 3][i % 3] += vec_component(f, i / 3) * at;
            landed[i / 3][i % 3] += vec_component(a, i / 3) * at;
        }
    }
    const double least = MOVE_LEAST * (landed[0][0] + landed[1][1] + landed[2][2]) + 1e-30;
    for (int i = 0; i < 3; i++)
        landed[i][i] += least;
    invert(landed, inverse);
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 3; k++)
            lobe->move[i / 3][i % 3] += both[i / 3][k] * inverse[k][i % 3];
}

static void fit_lobe(const Landing *landings, Lobe *lobe)
{
    memset(lobe->move, 0, sizeof lobe->move);
    Vec3 from = {0, 0, 0}, at = {0, 0, 0};
    lobe->power = lobe->less = lobe->distance2 = 0;
    for (int k = lobe->first; k < lobe->end; k++) {
        from = vec_mad(from, landings[k].from, landings[k].power);
        at = vec_mad(at, landings[k].position, landings[k].power);
        lobe->power += landings[k].power;
    }
    lobe->center = vec_scale(from, 1 / lobe->power);
    lobe->at = vec_scale(at, 1 / lobe->power);
    const int count = lobe->end - lobe->first;
    if (count >= LOBE_PHOTONS)
        fit_move(landings, lobe);
    const double fitted = count >= LOBE_PHOTONS ? count / (count - 3.0) : 1; /* what a fit to so few takes off */
    for (int k = lobe->first; k < lobe->end; k++) {
        const Landing *l = &landings[k];
        Vec3 d = vec_sub(l->position, lobe->at);
        lobe->less +=
            fitted * l->power * one_less_cosine(l->position, l->from, lobe_center(lobe, l->position)) / lobe->power;
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
        for (int i = 0; i < 9; i++)
            cell->move[i][k] = (float)l->move[i / 3][i % 3];
        cell->concentration[k] = (float)(1 / (WIDEN * l->less + LESS_LEAST));
        cell->narrow[k] = (float)narrow;
        cell->weight[k] = (float)(l->power / power * narrow * lobes[0].distance2);
    }
}

/* ---- cells ---- */

/* The share of caustics in the irradiance, by estimates of theirs and of that of all other light. */
static double caustic_share(const Builder *m, const Bounds *b, double power)
{
    Vec3 d = vec_sub(b->high, b->low);
    double area = fmax(d.x * d.y, fmax(d.y * d.z, d.z * d.x)), caustic = power / fmax(area, 1e-12) / m->photons.tried;
    LightSampleContext point = {.position = vec_scale(vec_add(b->low, b->high), 0.5)};
    double other = lights_estimate(m->lights, &point);
    return caustic / (caustic + other);
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
    const double caustic = caustic_share(m, &b, power), gain = cell_gain(cell, landings, first, end);
    m->power += power, m->worth += power * caustic * caustic / fmax(1 - gain, 1e-6);
    cell->share = fminf(SHARE_MOST, fmaxf(SHARE_LEAST, (float)caustic)) * (float)gain;
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
    make_nodes(m, 0, m->photons.landings, 0, count);
    return RETEX_OK;
}

int caustics_create(Caustics **caustics, const PhotonSources *sources, CausticsOf of, int nthreads, RetexError *err)
{
    PhotonSources own = *sources;
    Builder m = {.lights = sources->lights};
    own.of_emitters = of != CAUSTICS_OF_SOURCES;
    int code = photons_trace(&m.photons, &own, nthreads, err);
    *caustics = NULL;
    if (!code && m.photons.count >= CELL_PHOTONS)
        code = make_guide(&m, m.photons.count, err);
    const int is_worth = of != CAUSTICS_OF_SMALL_EMITTERS || m.worth >= WORTH_LEAST * m.power;
    if (code || !is_worth)
        caustics_close(&m.caustics);
    *caustics = m.caustics;
    free(m.photons.landings);
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
        node = &c->nodes[node->child + ((float)vec_component(position, node->axis) >= node->split)];
    const Bounds *b = &c->bounds[node->child];
    int inside = position.x >= b->low.x && position.y >= b->low.y && position.z >= b->low.z &&
                 position.x <= b->high.x && position.y <= b->high.y && position.z <= b->high.z;
    return inside && c->cells[node->child].share > 0 ? &c->cells[node->child] : NULL;
}
