/* CSG, compared with all crossings of all leaves. Scenes are texts: random
 * trees of intersections, differences, merges and unions, of all shapes that
 * have an inside and of open ones, with clips and with inverse, up to six deep.
 *
 * The reference finds the crossings of most leaves from closed forms and from
 * polynomials, between whose extrema it bisects. Of shapes with more than
 * numbers it follows the ray through the shape alone; membership at many points
 * of the ray tells that none is missed. Membership is tested midway between
 * consecutive crossings, by plain recursion. A crossing is on the result if its
 * siblings, whose membership is the same on both sides of it, let it be; trees
 * of closed shapes without unions are also held against this: the result's
 * surface is where the tree's own membership changes. Where two crossings lie
 * within NEAR of each other, or a ray nearly touches a surface or meets an
 * edge, the order is open to rounding: rays that depend on such a place are
 * counted apart. So are those where a Julia set is met or missed, which is
 * found by steps.
 *
 * RETEX_ORACLE_SECONDS=N tests further scenes for N seconds.
 * RETEX_ORACLE_SEED=N begins with scene N. */
#include "accel/accel.h"
#include "lib_scene_text.h"
#include "shape/csg.h"
#include "shape/shape.h"
#include <cmocka.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define NEAR 1e-8

enum {
    SCENES = 300,
    RAYS = 60,
    DEEPEST = 6,
    LEAVES_MOST = 4096,
    CROSSINGS_MOST = 16384,
    CROSSINGS_EACH = 60,
    TEXT = 4 << 20
};

/* ---- random numbers ---- */

static uint32_t state;

static double between(double low, double high)
{
    return low + (high - low) * test_random(&state);
}
static int below(int count)
{
    return (int)(test_random(&state) * count);
}
static int chance(double share)
{
    return test_random(&state) < share;
}
static Vec3 direction(void)
{
    double z = between(-1, 1), angle = between(0, 2 * PI), rho = sqrt(1 - z * z);

    return vec3(rho * cos(angle), rho * sin(angle), z);
}

/* ---- shapes with more than numbers ---- */

static const char *const texts[] = {
    "superellipsoid{<0.3,0.6>",
    "superellipsoid{<2.5,0.5>",
    "ovus{0.6,0.4",
    "lathe{cubic_spline 8, <0,-1.1>, <0,-1>, <0.3,-0.8>, <1,-0.3>, <0.4,0.2>, "
    "<0.7,0.9>, <0,1.2>, <0,1.3>",
    "prism{conic_sweep 0.2, 1, 5, <-1,-1>, <1,-0.8>, <0.2,0>, <0.5,1>, <-1,-1>",
    "prism{linear_sweep quadratic_spline -.5, .5, 6, <0,-.5>, <-1,-1>, "
    "<1,-0.8>, <0.2,0>, <0.5,1>, <-1,-1>",
    "sor{5, <0.1,-1.3>, <0.8,-1>, <0.3,-0.2>, <0.9,0.5>, <0.2,1>",
    "sphere_sweep{b_spline 5, <-2,0,0>, 0.3, <-1,1,0>, 0.2, <0,-1,1>, 0.3, "
    "<1,1,0>, 0.1, <2,0,1>, 0.3",
    "blob{threshold .6 sphere{<-.5,0,0>,1,1} sphere{<.5,.2,0>,.8,1} "
    "cylinder{<0,-1,0>,<0,1,.3>,.5,1} "
    "sphere{<0,0,-.5>,.5,-1}",
    "text{ttf \"timrom.ttf\" \"B\" .4,0",
    "height_field{function 20,20{.5+.3*sin(9*x)*cos(7*y)} water_level .2",
    "julia_fractal{<-.083,0,-.83,-.025> max_iteration 5 precision 60",
    "isosurface{function{x*x+y*y*1.5+z*z*z*z-.5+.1*sin(9*x)} "
    "contained_by{box{-1,1}} max_gradient 8 accuracy 1e-9 "
    "all_intersections",
    "quadric{<1,1,1>, <0,0.2,0>, <0,0,0.3>, -0.6",
    "poly{4, "
    "<1,0,0,0,0,0,0,0,0,-1,0,0,0,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,1,0,0,0,-."
    "1>",
};
enum { TEXTS = sizeof texts / sizeof *texts };
static Scene *written; /* all of them */

static void parse_texts(void)
{
    static char all[8192] = V37;

    for (int i = 0; i < TEXTS; i++)
        strcat(strcat(all, texts[i]), "}\n");
    written = parse(all);
    assert_int_equal(written->nprimitives, TEXTS);
}

/* ---- trees ---- */

typedef enum Form { SPHERE, BOX, PLANE, CONE, TORUS, DISC, TETRAHEDRON, WRITTEN, FORMS } Form;
typedef enum Operation { LEAF, UNION, INTERSECTION, DIFFERENCE, MERGE } Operation;

typedef struct Node {
    Operation operation;
    int inverse;
    struct Node *parent, *children[4], *clip;
    int nchildren;
    /* of a leaf */
    Form form;
    double r0, r1;
    int open, number; /* number: as the scene counts primitives; -1 in a clip */
    Transform place;
    Primitive solid; /* of what is written: the shape where it is */
} Node;

static Node nodes[LEAVES_MOST];
static Node *leaves[LEAVES_MOST];
static int nnodes, nleaves, plain; /* plain: closed shapes and no unions only */
static double size;
static Vec3 centre;
static char *text, *end;

static void write_text(const char *format, ...) RETEX_PRINTF(1, 2);
static void write_text(const char *format, ...)
{
    va_list args;

    va_start(args, format);
    end += vsnprintf(end, (size_t)(text + TEXT - end), format, args);
    va_end(args);
    assert_true(end < text + TEXT - 1000);
}

static Transform random_place(void)
{
    Transform t = transform_scale(vec3(1, 1, 1));
    double scale = size * between(0.2, 1);

    if (chance(0.5))
        t = transform_scale(vec3(between(0.3, 1.5), -between(0.3, 1.5), between(0.3, 1.5)));
    t = transform_then(t, transform_scale(vec3(scale, scale, scale)));
    if (chance(0.8))
        t = transform_then(t, transform_rotate(vec_scale(direction(), 180)));
    return transform_then(t, transform_translate(vec_mad(centre, direction(), size * between(0, 1))));
}

static void write_leaf(Node *n)
{
    const double(*m)[4] = n->place.m;

    if (n->form == WRITTEN)
        write_text("%s ", texts[n->solid.line]);
    else if (n->form == SPHERE)
        write_text("sphere{0,1 ");
    else if (n->form == BOX)
        write_text("box{0,1 ");
    else if (n->form == PLANE)
        write_text("plane{y,0 ");
    else if (n->form == CONE)
        write_text("cone{0,%.17g,z,%.17g %s ", n->r0, n->r1, n->open ? "open" : "");
    else if (n->form == TORUS)
        write_text("torus{%.17g,%.17g ", n->r0, n->r1);
    else if (n->form == DISC)
        write_text("disc{0,z,%.17g,%.17g ", n->r0, n->r1);
    else
        write_text("mesh{triangle{0,y,x} triangle{0,z,y} triangle{0,x,z} "
                   "triangle{x,y,z} %s ",
                   n->open ? "" : "inside_vector y");
    write_text("matrix<");
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++)
            write_text("%s%.17g", k + i ? "," : "", m[i][k]);
    write_text(">");
}

static void make_leaf(Node *n, int clipping)
{
    n->form = (Form)below(FORMS);
    n->place = random_place();
    n->r0 = between(0.3, 1), n->r1 = between(0.1, 1);
    n->open = chance(0.4);
    if (n->form == CONE && chance(0.3)) /* about z: frames of other axes are the parser's own */
        n->r1 = n->r0;
    if (n->form == DISC)
        n->r1 = chance(0.5) ? 0 : n->r0 * between(0.1, 0.8);
    if (n->form == TORUS)
        n->r1 = n->r0 * between(0.1, 0.9);
    if (n->form == WRITTEN) {
        const int which = below(TEXTS);
        n->solid = written->primitives[which];
        n->solid.transform = transform_then(n->solid.transform, n->place);
        n->solid.line = which;
        n->open = n->solid.shape.ops == &shape_height_field;
    }
    n->number = clipping ? -1 : nleaves;
    if (!clipping)
        leaves[nleaves++] = n;
    plain &= n->form != DISC && !((n->form == CONE || n->form == TETRAHEDRON || n->form == WRITTEN) && n->open);
    write_leaf(n);
}

static Node *make_node(int depth, int clipping, Node *parent)
{
    static const char *const words[] = {"", "union", "intersection", "difference", "merge"};
    Node *n = &nodes[nnodes++];

    assert_true(nnodes < LEAVES_MOST);
    *n = (Node){.parent = parent, .operation = LEAF};
    if (depth > 0 && (!parent || chance(0.75))) {
        n->operation = (Operation)(parent ? 1 + below(4) : 2 + below(3));
        plain &= n->operation != UNION;
        write_text("%s{", words[n->operation]);
        n->nchildren = 2 + below(2);
        for (int i = 0; i < n->nchildren; i++)
            n->children[i] = make_node(depth - 1, clipping, n);
    } else {
        make_leaf(n, clipping);
    }
    n->inverse = parent && chance(0.15);
    write_text(n->inverse ? " inverse" : "");
    if (chance(0.1) && !clipping) {
        plain = 0;
        write_text(" clipped_by{");
        n->clip = make_node(below(2), 1, NULL);
        write_text("}");
    }
    write_text("}\n");
    return n;
}

/* ---- membership ---- */

/* The solution of m x = v, by Cramer's rule. */
static Vec3 solve(const Transform *t, Vec3 v)
{
    Vec3 a = {t->m[0][0], t->m[1][0], t->m[2][0]}, b = {t->m[0][1], t->m[1][1], t->m[2][1]},
         c = {t->m[0][2], t->m[1][2], t->m[2][2]}, bc = vec_cross(b, c);
    double d = vec_dot(a, bc);

    return vec3(vec_dot(v, bc) / d, vec_dot(vec_cross(c, a), v) / d, vec_dot(vec_cross(a, b), v) / d);
}

static Vec3 canonical(const Node *n, Vec3 p)
{
    return solve(&n->place, vec_sub(p, vec3(n->place.m[0][3], n->place.m[1][3], n->place.m[2][3])));
}

/* Unlike the shapes of numbers, by the shape's own operation. */
static int written_contains(const Node *n, Vec3 p)
{
    const Transform *t = &n->solid.transform;
    Vec3 q = solve(t, vec_sub(p, vec3(t->m[0][3], t->m[1][3], t->m[2][3])));

    return n->solid.shape.ops->inside(&n->solid.shape, q);
}

static int leaf_contains(const Node *n, Vec3 p)
{
    Vec3 q = canonical(n, p);

    if (n->form == WRITTEN)
        return written_contains(n, p);
    switch (n->form) {
    case SPHERE:
        return vec_length(q) < 1;
    case BOX:
        return q.x > 0 && q.x < 1 && q.y > 0 && q.y < 1 && q.z > 0 && q.z < 1;
    case PLANE:
        return q.y < 0;
    case CONE:
        return q.z > 0 && q.z < 1 && hypot(q.x, q.y) < n->r0 + (n->r1 - n->r0) * q.z;
    case TORUS:
        return hypot(hypot(q.x, q.z) - n->r0, q.y) < n->r1;
    case DISC:
        return q.z < 0;
    default:
        return !n->open && q.x > 0 && q.y > 0 && q.z > 0 && q.x + q.y + q.z < 1;
    }
}

/* inverse: of what is around it. */
static int contains(const Node *n, int inverse, Vec3 p)
{
    int all = 1, any = 0;

    inverse ^= n->inverse;
    if (n->clip && !contains(n->clip, 0, p))
        return 0;
    if (n->operation == LEAF)
        return leaf_contains(n, p) ^ inverse;
    for (int i = 0; i < n->nchildren; i++) {
        int in = contains(n->children[i], inverse ^ (n->operation == DIFFERENCE && i > 0), p);
        all &= in, any |= in;
    }
    return (n->operation == INTERSECTION || n->operation == DIFFERENCE) != inverse ? all : any;
}

/* What is around a node turns its children inside out. */
static int inverse_within(const Node *n)
{
    int inverse = n->inverse;

    if (n->parent)
        inverse ^= inverse_within(n->parent) ^ (n->parent->operation == DIFFERENCE && n != n->parent->children[0]);
    return inverse;
}

/* Whether a crossing of the leaf at p is on the result. */
static int siblings_allow(const Node *leaf, Vec3 p)
{
    for (const Node *n = leaf; n; n = n->parent) {
        const Node *parent = n->parent;
        if (n->clip && !contains(n->clip, 0, p))
            return 0;
        if (!parent)
            return 1;
        int inverse = inverse_within(parent),
            of_all = parent->operation == INTERSECTION || parent->operation == DIFFERENCE;
        if (parent->operation == UNION && !inverse)
            continue;
        for (int i = 0; i < parent->nchildren; i++) {
            const Node *sibling = parent->children[i];
            int turned = inverse ^ (parent->operation == DIFFERENCE && i > 0);
            if (sibling != n && contains(sibling, turned, p) != (of_all != inverse))
                return 0;
        }
    }
    return 1;
}

/* ---- crossings ---- */

typedef struct Crossing {
    double t;
    const Node *leaf; /* NULL: one that may be there or not */
    int hidden;       /* membership changes, but no surface is there */
} Crossing;

static Crossing crossings[CROSSINGS_MOST];
static int ncrossings;
static long missing; /* crossings that a shape alone does not find; but of Julia
                        sets, which are found by steps */

static void add(const Node *leaf, double t)
{
    assert_true(ncrossings < CROSSINGS_MOST);
    crossings[ncrossings++] = (Crossing){t, leaf, 0};
}

static void add_hidden(const Node *leaf, double t)
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

/* All roots in low..high, ascending: between two extrema there is one at most.
 * Extrema close to 0 go to near. */
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

/* With a plane of the canonical space; within: how far within the edges the
 * crossing is, below 0 beyond them. */
static void add_flat(const Node *leaf, double t, double within)
{
    if (within > 0)
        add(leaf, t);
    if (fabs(within) < NEAR)
        add(NULL, t);
}

static void cross_polynomial(const Node *n, Vec3 o, Vec3 d, double shift)
{
    double dd = vec_dot(d, d), oo = vec_dot(o, o), reach = 4 / sqrt(dd), roots[8], near[8];
    double slope = n->r1 - n->r0, radius = n->r0 + slope * o.z, k = oo + n->r0 * n->r0 - n->r1 * n->r1,
           four = 4 * n->r0 * n->r0;
    double sphere[3] = {oo - 1, 0, dd};
    double cone[3] = {o.x * o.x + o.y * o.y - radius * radius, 2 * (o.x * d.x + o.y * d.y - slope * radius * d.z),
                      d.x * d.x + d.y * d.y - slope * slope * d.z * d.z};
    double torus[5] = {k * k - four * (o.x * o.x + o.z * o.z), -2 * four * (o.x * d.x + o.z * d.z),
                       2 * k * dd - four * (d.x * d.x + d.z * d.z), 0, dd * dd};
    const double *c = n->form == SPHERE ? sphere : n->form == CONE ? cone : torus;
    int nnear = 0, count = roots_of(c, n->form == TORUS ? 4 : 2, -reach, reach, roots, near, &nnear);

    for (int i = 0; i < count; i++) {
        double z = o.z + roots[i] * d.z;
        add_flat(n, shift + roots[i], n->form == CONE ? fmin(z, 1 - z) : 1);
    }
    for (int i = 0; i < nnear; i++)
        add(NULL, shift + near[i]);
}

static void cross_caps(const Node *n, Vec3 o, Vec3 d, double shift)
{
    for (int cap = 0; cap < 2 && d.z != 0; cap++) {
        double s = (cap - o.z) / d.z;
        if (n->open)
            add_hidden(n, shift + s);
        else
            add_flat(n, shift + s, (cap ? n->r1 : n->r0) - hypot(o.x + s * d.x, o.y + s * d.y));
    }
}

static void cross_planes(const Node *n, Vec3 o, Vec3 d, double shift)
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
        if (n->form == BOX ? f == 6 : f >= 3 && f < 6)
            continue;
        for (int k = 0; k < 3; k++)
            if (f == 6 || k != f % 3)
                within = fmin(within, n->form == BOX ? fmin(at[k], 1 - at[k]) : at[k]);
        if (n->form == TETRAHEDRON && f != 6)
            within = fmin(within, 1 - q.x - q.y - q.z);
        if (isfinite(s))
            add_flat(n, shift + s, within);
    }
}

/* Whether thin parts may be passed over, as the precision of a Julia set says.
 */
static int is_by_steps(const Node *n)
{
    return n->form == WRITTEN && n->solid.shape.ops == &shape_julia_fractal;
}

/* Changes of membership between two crossings: of Julia sets, which are found
 * by steps, now and then. */
static void cross_unfound(const Node *n, const Ray *ray, double from, double to, double shift)
{
    const double middle = vec_dot(vec_sub(centre, ray->origin), ray->direction);
    const int steps = 64;

    from = fmax(from, middle - 6 * size), to = fmin(to, middle + 6 * size); /* no shape is larger */
    if (!(from < to))
        return;
    int before = written_contains(n, vec_mad(ray->origin, ray->direction, from + 0.01 * (to - from)));

    for (int i = 1; i < steps; i++) {
        double a = from + (i == 1 ? 0.01 : (i - 1.0) / steps) * (to - from), b = from + (to - from) * i / steps;
        const int now = written_contains(n, vec_mad(ray->origin, ray->direction, b));
        for (int k = 0; before != now && k < 60; k++) {
            const double m = 0.5 * (a + b);
            *(written_contains(n, vec_mad(ray->origin, ray->direction, m)) == before ? &a : &b) = m;
        }
        if (before != now)
            add_hidden(n, a - shift), missing += !is_by_steps(n);
        before = now;
    }
}

/* All crossings of the shape alone, from far behind the ray's origin to far
 * beyond the tree. Where membership is the same on both sides of one, rounding
 * may have decided. Where it changes without one, one is missing. */
static void cross_written(const Node *n, const Ray *ray)
{
    const double far = 60 * size + 2 * vec_length(vec_sub(centre, ray->origin));
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
        if (i > 0 && written_contains(n, before) == written_contains(n, after))
            add(NULL, t[i] - far);
        if (!n->open)
            cross_unfound(n, &along, t[i], t[i + 1], far);
    }
}

/* A height field has no surface at its sides and where the water is. */
static void cross_openings(const Node *n, Vec3 o, Vec3 d, double shift)
{
    static const double planes[][3] = {{0, 0, 0}, {1, 1, 1}, {0, 0.2, 0}};

    for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
        add_hidden(n, shift + (planes[i][0] - o.x) / d.x);
        add_hidden(n, shift + (planes[i][1] - o.y) / d.y);
        add_hidden(n, shift + (planes[i][2] - o.z) / d.z);
    }
}

static void cross_leaf(const Node *n, const Ray *ray)
{
    Vec3 o = canonical(n, ray->origin), d = solve(&n->place, ray->direction);
    double shift = -vec_dot(o, d) / vec_dot(d, d), s, rho;

    o = vec_mad(o, d, shift);
    switch (n->form) {
    case WRITTEN:
        cross_written(n, ray);
        if (n->open)
            cross_openings(n, o, d, shift);
        break;
    case PLANE:
        if (d.y != 0)
            add(n, shift - o.y / d.y);
        break;
    case DISC:
        s = -o.z / d.z, rho = hypot(o.x + s * d.x, o.y + s * d.y);
        if (isfinite(s) && (rho > n->r0 || rho < n->r1))
            add_hidden(n, shift + s);
        if (isfinite(s))
            add_flat(n, shift + s, fmin(n->r0 - rho, n->r1 > 0 ? rho - n->r1 : 1));
        break;
    case BOX:
    case TETRAHEDRON:
        cross_planes(n, o, d, shift);
        break;
    default:
        cross_polynomial(n, o, d, shift);
        if (n->form == CONE)
            cross_caps(n, o, d, shift);
    }
}

static int by_t(const void *a, const void *b)
{
    const Crossing *x = a, *y = b;

    return (x->t > y->t) - (x->t < y->t);
}

/* Clips' leaves have crossings too: membership is constant between crossings of
 * all. */
static void cross_all(const Ray *ray)
{
    ncrossings = 0;
    for (int i = 0; i < nnodes; i++)
        if (nodes[i].operation == LEAF)
            cross_leaf(&nodes[i], ray);
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
    double low = i > 0 ? crossings[i - 1].t : crossings[i].t - size,
           high = i < ncrossings ? crossings[i].t : low + size;

    return vec_mad(ray->origin, ray->direction, 0.5 * (low + high));
}

/* The reference's hit: an index of crossings, or ncrossings. *doubtful: a place
 * before it that it depends on is a near tie. */
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
        int on = siblings_allow(c->leaf, midway(ray, i + 1));
        assert_int_equal(on, siblings_allow(c->leaf, midway(ray, i)));
        if (plain)
            assert_int_equal(on, contains(&nodes[0], 0, midway(ray, i)) != contains(&nodes[0], 0, midway(ray, i + 1)));
        if (on)
            return i;
    }
    return ncrossings;
}

static void complain(const Ray *ray, const char *what, double expected, double found)
{
    fail_msg("%s: %.17g, %.17g; origin %.17g %.17g %.17g, direction %.17g %.17g "
             "%.17g, range %g %g; "
             "RETEX_ORACLE_SEED=%u",
             what, expected, found, ray->origin.x, ray->origin.y, ray->origin.z, ray->direction.x, ray->direction.y,
             ray->direction.z, ray->tmin, ray->tmax, (unsigned)seed);
}

static int check_ray(const Scene *scene, const Accel *accel, const Ray *ray, Hit *hit)
{
    double doubt = NEAR * (size + vec_length(centre) + vec_length(ray->origin));
    int found = accel_intersect(accel, ray, RAY_CAMERA, hit), doubtful, at;

    rays++;
    cross_all(ray);
    at = reference(ray, doubt, &doubtful);
    if (found != accel_occluded(accel, ray, RAY_SHADOW, 0))
        complain(ray, "accel_intersect and accel_occluded differ", found, !found);
    if (found && at < ncrossings && fabs(crossings[at].t - hit->t) < doubt &&
        crossings[at].leaf->number == hit->primitive) {
        Surface s;
        hits++;
        surface_at(&s, scene, ray, hit);
        if (plain && s.backside != contains(&nodes[0], 0, midway(ray, at)))
            complain(ray, "the normal points into the result", s.backside, hit->t);
        return 1;
    }
    if (!found && at == ncrossings)
        return 1;
    if (doubtful || (found && is_by_steps(leaves[hit->primitive])) ||
        (at < ncrossings && is_by_steps(crossings[at].leaf)))
        ties++;
    else
        complain(ray, "another hit than the reference", at < ncrossings ? crossings[at].t : -1, found ? hit->t : -1);
    return 0;
}

static Ray random_ray(void)
{
    Ray ray = {vec_mad(centre, direction(), size * between(0, 4)), direction(), 0, INFINITY};

    if (chance(0.8))
        ray.direction = vec_normalize(vec_sub(vec_mad(centre, direction(), size * between(0, 1)), ray.origin));
    if (chance(0.2))
        ray.tmax = size * between(0, 4);
    return ray;
}

static Ray next_ray(const Scene *scene, const Ray *ray, const Hit *hit)
{
    Ray next = random_ray();
    Surface s;

    if (chance(0.3)) {
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
        Vec3 p = vec_mad(centre, direction(), size * between(0, 2));
        if (csg_inside(csg->root, p) != contains(&nodes[0], 0, p))
            fail_msg("inside is %d; RETEX_ORACLE_SEED=%u", csg_inside(csg->root, p), (unsigned)seed);
    }
}

static void check_scene(void)
{
    Accel *accel;
    RetexError err = {0};

    state = seed;
    nnodes = nleaves = 0, plain = 1;
    size = pow(10, between(-3, 3));
    centre = vec_scale(direction(), chance(0.5) ? 0 : size * between(1, 20));
    end = text;
    write_text(V37 "camera{location <%.17g,%.17g,%.17g>}\n", centre.x, centre.y, centre.z + 3 * size);
    make_node(1 + below(DEEPEST), 0, NULL);
    Scene *scene = parse(text);
    assert_int_equal(scene->ncsgs, 1);
    assert_int_equal(scene->nprimitives, nleaves);
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
    text = malloc(TEXT);
    assert_non_null(text);
    parse_texts();
    seed = first ? (uint32_t)strtoul(first, NULL, 10) : 1;
    for (int i = 0; i < SCENES || seconds() < until; i++, seed++)
        check_scene();
    free(text);
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
