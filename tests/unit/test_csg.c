/* CSG, compared with all crossings of all leaves. Scenes are texts: random trees of intersections, differences, merges
 * and unions, of all shapes that have an inside and of open ones, with clips and with inverse, up to six deep.
 *
 * The reference finds the crossings of most leaves from closed forms and from polynomials, between whose extrema it
 * bisects. Of shapes with more than numbers it follows the ray through the shape alone; membership at many points of
 * the ray tells that none is missed. Membership is tested midway between consecutive crossings, by plain recursion. A
 * crossing is on the result if its siblings, whose membership is the same on both sides of it, let it be; trees of
 * closed shapes without unions are also held against this: the result's surface is where the tree's own membership
 * changes. Where two crossings lie within NEAR of each other, or a ray nearly touches a surface or meets an edge, the
 * order is open to rounding: rays that depend on such a place are counted apart. So are those where a Julia set is met
 * or missed, which is found by steps.
 *
 * RETEX_ORACLE_SECONDS=N tests further scenes for N seconds. RETEX_ORACLE_SEED=N begins with scene N. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "lib_csg_tree.h"
#include "lib_random_scene.h"
#include "lib_scene_text.h"
#include <cmocka.h>
#include "accel/accel.h"
#include "shape/csg.h"
#include "shape/shape.h"

#define NEAR 1e-8
#define ROUNDING 1e-10 /* of a distance, where that is far more than the tree's size */

enum { SCENES = 300, RAYS = 60, CROSSINGS_MOST = 16384, CROSSINGS_EACH = 60 };

/* ---- crossings ---- */

typedef struct Crossing {
    double t;
    const TreeNode *leaf; /* NULL: one that may be there or not */
    int hidden;           /* membership changes, but no surface is there */
} Crossing;

static Crossing crossings[CROSSINGS_MOST];
static int ncrossings;
static long missing; /* crossings that a shape alone does not find, but for Julia sets, found by steps */

static void add(const TreeNode *leaf, double t)
{
    assert_true(ncrossings < CROSSINGS_MOST);
    crossings[ncrossings++] = (Crossing){t, leaf, 0};
}

static void add_hidden(const TreeNode *leaf, double t)
{
    add(leaf, t);
    crossings[ncrossings - 1].hidden = 1;
}

static double value(const double *c, int degree, double x, double *magnitude)
{
    double sum = 0, size_of_terms = 0;

    for (int i = degree; i >= 0; i--)
        sum = sum * x + c[i], size_of_terms = size_of_terms * fabs(x) + fabs(c[i]);
    if (magnitude)
        *magnitude = size_of_terms;
    return sum;
}

/* All roots in low..high, ascending: between two extrema there is one at most. Extrema close to 0 go to near. */
static int roots_of(const double *c, int degree, double low, double high, double *roots, double *near, int *nnear)
{
    double slope[5], extrema[6], unused[8];
    int count = 0, n = 0, nunused = 0;

    extrema[n++] = low;
    if (degree > 1) {
        for (int i = 1; i <= degree; i++)
            slope[i - 1] = i * c[i];
        n += roots_of(slope, degree - 1, low, high, extrema + 1, unused, &nunused);
    }
    extrema[n++] = high;
    for (int i = 1; i < n; i++) {
        double a = extrema[i - 1], b = extrema[i], terms, fa = value(c, degree, a, NULL),
               fb = value(c, degree, b, &terms);
        if (i < n - 1 && fabs(fb) < NEAR * terms && *nnear < 8)
            near[(*nnear)++] = b;
        if ((fa < 0) == (fb < 0))
            continue;
        for (int k = 0; k < 100; k++) {
            double m = 0.5 * (a + b);
            *((value(c, degree, m, NULL) < 0) == (fa < 0) ? &a : &b) = m;
        }
        roots[count++] = 0.5 * (a + b);
    }
    return count;
}

/* With a plane of the canonical space; within: how far within the edges the crossing is, below 0 beyond them. */
static void add_flat(const TreeNode *leaf, double t, double within)
{
    if (within > 0)
        add(leaf, t);
    if (fabs(within) < NEAR)
        add(NULL, t);
}

static void cross_polynomial(const TreeNode *n, Vec3 o, Vec3 d, double shift)
{
    double dd = vec_dot(d, d), oo = vec_dot(o, o), reach = 4 / sqrt(dd), roots[8], near[8];
    double slope = n->r1 - n->r0, radius = n->r0 + slope * o.z, k = oo + n->r0 * n->r0 - n->r1 * n->r1,
           four = 4 * n->r0 * n->r0;
    double sphere[3] = {oo - 1, 0, dd};
    double cone[3] = {o.x * o.x + o.y * o.y - radius * radius, 2 * (o.x * d.x + o.y * d.y - slope * radius * d.z),
                      d.x * d.x + d.y * d.y - slope * slope * d.z * d.z};
    double torus[5] = {k * k - four * (o.x * o.x + o.z * o.z), -2 * four * (o.x * d.x + o.z * d.z),
                       2 * k * dd - four * (d.x * d.x + d.z * d.z), 0, dd * dd};
    const double *c = n->form == FORM_SPHERE ? sphere : n->form == FORM_CONE ? cone : torus;
    int nnear = 0, count = roots_of(c, n->form == FORM_TORUS ? 4 : 2, -reach, reach, roots, near, &nnear);

    for (int i = 0; i < count; i++) {
        double z = o.z + roots[i] * d.z;
        add_flat(n, shift + roots[i], n->form == FORM_CONE ? fmin(z, 1 - z) : 1);
    }
    for (int i = 0; i < nnear; i++)
        add(NULL, shift + near[i]);
}

static void cross_caps(const TreeNode *n, Vec3 o, Vec3 d, double shift)
{
    for (int cap = 0; cap < 2 && d.z != 0; cap++) {
        double s = (cap - o.z) / d.z;
        if (n->open)
            add_hidden(n, shift + s);
        else
            add_flat(n, shift + s, (cap ? n->r1 : n->r0) - hypot(o.x + s * d.x, o.y + s * d.y));
    }
}

static void cross_planes(const TreeNode *n, Vec3 o, Vec3 d, double shift)
{
    static const struct {
        Vec3 normal;
        double offset;
    } faces[7] = {{{1, 0, 0}, 0}, {{0, 1, 0}, 0}, {{0, 0, 1}, 0}, {{1, 0, 0}, 1},
                  {{0, 1, 0}, 1}, {{0, 0, 1}, 1}, {{1, 1, 1}, 1}};

    for (int f = 0; f < 7; f++) {
        double s = (faces[f].offset - vec_dot(o, faces[f].normal)) / vec_dot(d, faces[f].normal), within = 1;
        Vec3 q = vec_mad(o, d, s);
        const double at[3] = {q.x, q.y, q.z};
        if (n->form == FORM_BOX ? f == 6 : f >= 3 && f < 6)
            continue;
        for (int k = 0; k < 3; k++)
            if (f == 6 || k != f % 3)
                within = fmin(within, n->form == FORM_BOX ? fmin(at[k], 1 - at[k]) : at[k]);
        if (n->form == FORM_TETRAHEDRON && f != 6)
            within = fmin(within, 1 - q.x - q.y - q.z);
        if (isfinite(s))
            add_flat(n, shift + s, within);
    }
}

/* Changes of membership between two crossings: of Julia sets, which are found by steps, now and then. */
static void cross_unfound(const TreeNode *n, const Ray *ray, double from, double to, double shift)
{
    const double middle = vec_dot(vec_sub(tree.centre, ray->origin), ray->direction);
    const int steps = 64;

    from = fmax(from, middle - 6 * tree.size), to = fmin(to, middle + 6 * tree.size); /* no shape is larger */
    if (!(from < to))
        return;
    int before = tree_written_contains(n, vec_mad(ray->origin, ray->direction, from + 0.01 * (to - from)));

    for (int i = 1; i < steps; i++) {
        double a = from + (i == 1 ? 0.01 : (i - 1.0) / steps) * (to - from), b = from + (to - from) * i / steps;
        const int now = tree_written_contains(n, vec_mad(ray->origin, ray->direction, b));
        for (int k = 0; before != now && k < 60; k++) {
            const double m = 0.5 * (a + b);
            *(tree_written_contains(n, vec_mad(ray->origin, ray->direction, m)) == before ? &a : &b) = m;
        }
        if (before != now)
            add_hidden(n, a - shift), missing += !tree_is_by_steps(n);
        before = now;
    }
}

/* All crossings of the shape alone, from far behind the ray's origin to far beyond the tree. Where membership is the
 * same on both sides of one, rounding may have decided. Where it changes without one, one is missing. */
static void cross_written(const TreeNode *n, const Ray *ray)
{
    const double far = 60 * tree.size + 2 * vec_length(vec_sub(tree.centre, ray->origin));
    Ray along = {vec_mad(ray->origin, ray->direction, -far), ray->direction, 0, INFINITY};
    double t[CROSSINGS_EACH + 2] = {0};
    int face, count = 1;

    while (count <= CROSSINGS_EACH && shape_intersect(&n->solid, &along, &t[count], &face) && t[count] < 2 * far) {
        assert_true(t[count] > along.tmin);
        along.tmin = t[count++];
    }
    t[count] = 2 * far;
    for (int i = 0; i < count; i++) {
        const Vec3 before = vec_mad(along.origin, along.direction, 0.5 * (t[i] + t[i > 0 ? i - 1 : 0])),
                   after = vec_mad(along.origin, along.direction, 0.5 * (t[i] + t[i + 1]));
        if (i > 0)
            add(n, t[i] - far);
        if (i > 0 && tree_written_contains(n, before) == tree_written_contains(n, after))
            add(NULL, t[i] - far);
        if (!n->open)
            cross_unfound(n, &along, t[i], t[i + 1], far);
    }
}

/* A height field has no surface at its sides and where the water is. */
static void cross_openings(const TreeNode *n, Vec3 o, Vec3 d, double shift)
{
    static const double planes[][3] = {{0, 0, 0}, {1, 1, 1}, {0, 0.2, 0}};

    for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
        add_hidden(n, shift + (planes[i][0] - o.x) / d.x);
        add_hidden(n, shift + (planes[i][1] - o.y) / d.y);
        add_hidden(n, shift + (planes[i][2] - o.z) / d.z);
    }
}

static void cross_leaf(const TreeNode *n, const Ray *ray)
{
    Vec3 o = tree_canonical(n, ray->origin), d = tree_solve(&n->place, ray->direction);
    double shift = -vec_dot(o, d) / vec_dot(d, d), s, rho;

    o = vec_mad(o, d, shift);
    switch (n->form) {
    case FORM_WRITTEN:
        cross_written(n, ray);
        if (n->open)
            cross_openings(n, o, d, shift);
        break;
    case FORM_PLANE:
        if (d.y != 0)
            add(n, shift - o.y / d.y);
        break;
    case FORM_DISC:
        s = -o.z / d.z, rho = hypot(o.x + s * d.x, o.y + s * d.y);
        if (isfinite(s) && (rho > n->r0 || rho < n->r1))
            add_hidden(n, shift + s);
        if (isfinite(s))
            add_flat(n, shift + s, fmin(n->r0 - rho, n->r1 > 0 ? rho - n->r1 : 1));
        break;
    case FORM_BOX:
    case FORM_TETRAHEDRON:
        cross_planes(n, o, d, shift);
        break;
    default:
        cross_polynomial(n, o, d, shift);
        if (n->form == FORM_CONE)
            cross_caps(n, o, d, shift);
    }
}

static int by_t(const void *a, const void *b)
{
    const Crossing *x = a, *y = b;

    return (x->t > y->t) - (x->t < y->t);
}

/* Clips' tree.leaves have crossings too: membership is constant between crossings of all. */
static void cross_all(const Ray *ray)
{
    ncrossings = 0;
    for (int i = 0; i < tree.nnodes; i++)
        if (tree.nodes[i].operation == TREE_LEAF)
            cross_leaf(&tree.nodes[i], ray);
    qsort(crossings, (size_t)ncrossings, sizeof *crossings, by_t);
}

/* ---- judging ---- */

static uint32_t seed;
static long rays, hits, ties;

static int is_doubtful(int i, double doubt)
{
    return !crossings[i].leaf || (i > 0 && crossings[i].t - crossings[i - 1].t < doubt) ||
           (i + 1 < ncrossings && crossings[i + 1].t - crossings[i].t < doubt);
}

static Vec3 midway(const Ray *ray, int i) /* between crossing i and the one before */
{
    double low = i > 0 ? crossings[i - 1].t : crossings[i].t - tree.size,
           high = i < ncrossings ? crossings[i].t : low + tree.size;

    return vec_mad(ray->origin, ray->direction, 0.5 * (low + high));
}

/* The reference's hit: an index of crossings, or ncrossings. *doubtful: a place before it that it depends on is a
 * near tie. */
static int reference(const Ray *ray, double doubt, int *doubtful)
{
    *doubtful = 0;
    for (int i = 0; i < ncrossings; i++) {
        const Crossing *c = &crossings[i];
        if (c->t <= ray->tmin - doubt)
            continue;
        if (c->t >= ray->tmax + doubt)
            return ncrossings;
        if (is_doubtful(i, doubt) || fabs(c->t - ray->tmin) < doubt || fabs(c->t - ray->tmax) < doubt) {
            *doubtful = 1;
            continue;
        }
        if (c->leaf->number < 0 || c->hidden)
            continue;
        int on = tree_siblings_allow(c->leaf, midway(ray, i + 1));
        assert_int_equal(on, tree_siblings_allow(c->leaf, midway(ray, i)));
        if (tree.plain)
            assert_int_equal(on, tree_contains(&tree.nodes[0], 0, midway(ray, i)) !=
                                     tree_contains(&tree.nodes[0], 0, midway(ray, i + 1)));
        if (on)
            return i;
    }
    return ncrossings;
}

static void complain(const Ray *ray, const char *what, double expected, double found)
{
    fail_msg(
        "%s: %.17g, %.17g; origin %.17g %.17g %.17g, direction %.17g %.17g %.17g, range %g %g; RETEX_ORACLE_SEED=%u",
        what, expected, found, ray->origin.x, ray->origin.y, ray->origin.z, ray->direction.x, ray->direction.y,
        ray->direction.z, ray->tmin, ray->tmax, (unsigned)seed);
}

static int check_ray(const Scene *scene, const Accel *accel, const Ray *ray, Hit *hit)
{
    double doubt = NEAR * (tree.size + vec_length(tree.centre) + vec_length(ray->origin));
    int found = accel_intersect(accel, ray, RAY_CAMERA, hit), doubtful, at;

    rays++;
    cross_all(ray);
    at = reference(ray, doubt, &doubtful);
    if (found != accel_occluded(accel, ray, RAY_SHADOW, 0))
        complain(ray, "accel_intersect and accel_occluded differ", found, !found);
    if (found && at < ncrossings && fabs(crossings[at].t - hit->t) < fmax(doubt, ROUNDING * crossings[at].t) &&
        crossings[at].leaf->number == hit->primitive) {
        Surface s;
        hits++;
        surface_at(&s, scene, ray, hit);
        if (tree.plain && s.backside != tree_contains(&tree.nodes[0], 0, midway(ray, at)))
            complain(ray, "the normal points into the result", s.backside, hit->t);
        return 1;
    }
    if (!found && at == ncrossings)
        return 1;
    if (doubtful || (found && tree_is_by_steps(tree.leaves[hit->primitive])) ||
        (at < ncrossings && tree_is_by_steps(crossings[at].leaf)))
        ties++;
    else
        complain(ray, "another hit than the reference", at < ncrossings ? crossings[at].t : -1, found ? hit->t : -1);
    return 0;
}

static Ray random_ray(void)
{
    Ray ray = {vec_mad(tree.centre, random_direction(), tree.size * random_between(0, 4)), random_direction(), 0,
               INFINITY};

    if (random_chance(0.8))
        ray.direction = vec_normalize(
            vec_sub(vec_mad(tree.centre, random_direction(), tree.size * random_between(0, 1)), ray.origin));
    if (random_chance(0.2))
        ray.tmax = tree.size * random_between(0, 4);
    return ray;
}

static Ray next_ray(const Scene *scene, const Ray *ray, const Hit *hit)
{
    Ray next = random_ray();
    Surface s;

    if (random_chance(0.3)) {
        next = *ray;
        next.tmin = hit->t;
        return next;
    }
    surface_at(&s, scene, ray, hit);
    next.origin = accel_offset(s.position, s.geometric_normal, next.direction);
    return next;
}

static void check_inside(const Csg *csg)
{
    for (int i = 0; i < 20; i++) {
        Vec3 p = vec_mad(tree.centre, random_direction(), tree.size * random_between(0, 2));
        if (csg_inside(csg->root, p) != tree_contains(&tree.nodes[0], 0, p))
            fail_msg("inside is %d; RETEX_ORACLE_SEED=%u", csg_inside(csg->root, p), (unsigned)seed);
    }
}

static void check_scene(void)
{
    Scene *scene = tree_make(seed);
    Accel *accel;
    RetexError err = {0};

    assert_int_equal(accel_create(&accel, scene, 1, &err), 0);
    check_inside(scene->csgs[0]);
    for (int i = 0; i < RAYS; i++) {
        Ray ray = random_ray();
        Hit hit;
        for (int bounce = 0; bounce < 4 && check_ray(scene, accel, &ray, &hit) && hit.primitive >= 0; bounce++)
            ray = next_ray(scene, &ray, &hit);
    }
    accel_close(&accel);
    scene_close(&scene);
}

static double seconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void hits_are_those_of_all_crossings(void **unused)
{
    const char *limit = getenv("RETEX_ORACLE_SECONDS"), *first = getenv("RETEX_ORACLE_SEED");
    double until = seconds() + (limit ? atof(limit) : 0);

    (void)unused;
    seed = first ? (uint32_t)strtoul(first, NULL, 10) : 1;
    for (int i = 0; i < SCENES || seconds() < until; i++, seed++)
        check_scene();
    print_message("# %ld rays, %ld hits, %ld near ties\n", rays, hits, ties);
    assert_int_equal(missing, 0);
    assert_true(hits > rays / 5 && ties < rays / 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_are_those_of_all_crossings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
