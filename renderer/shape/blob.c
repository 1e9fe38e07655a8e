/* The blob: where the densities of its components add up to its threshold or more. Natural parametrisation: longitude
 * and latitude about the middle of its bounds, as a sphere has them. There is no uv_mapping. Textures of components are
 * blended: a point has each with its share of the positive density as the probability.
 *
 * Along a ray each component is one or three pieces, on each of which the square of the distance is quadratic in t and
 * the density quartic. Between the ends of pieces that follow each other the sum is one polynomial. Its changes of sign
 * there are found with certainty; where two polynomials disagree by rounding about the sign at the end that they share,
 * the crossing is there. So crossings take turns: in, out, in, out. */
#include <string.h>
#include "base/polynomial.h"
#include "shape/blob.h"
#include "shape/shape.h"

#define MAX_PIECES 96 /* that are worked on at once */
#define MAX_HALVINGS 40

/* Density strength (1 - h2 - c (t - middle)^2)^2 from `from` to `to`. */
typedef struct Piece {
    double from, to, middle, h2, c, strength;
} Piece;

typedef struct Pieces {
    double low, high; /* range of t that is of interest */
    int count, overflow;
    Piece list[MAX_PIECES];
} Pieces;

static void add_piece(Pieces *out, double from, double to, double middle, double h2, double c, double strength)
{
    const double reach = 1 - h2;

    if (!(reach > 0))
        return;
    if (c > 0) {
        const double half = sqrt(reach / c);
        from = fmax(from, middle - half);
        to = fmin(to, middle + half);
    }
    if (!(from < to && from < out->high && to > out->low))
        return;
    if (out->count == MAX_PIECES) {
        out->overflow = 1;
        return;
    }
    out->list[out->count++] = (Piece){from, to, middle, h2, c, strength};
}

/* About a centre on the axis at height z, between two times. */
static void add_ball(Pieces *out, Vec3 o, Vec3 d, double z, double from, double to, double strength)
{
    const double c = vec_dot(d, d);
    o.z -= z;
    const double middle = -vec_dot(o, d) / c;
    const Vec3 closest = vec_mad(o, d, middle);

    add_piece(out, from, to, middle, vec_dot(closest, closest), c, strength);
}

static void add_component(Pieces *out, const BlobComponent *component, Vec3 origin, Vec3 direction)
{
    const Vec3 o = transform_inverse_point(&component->transform, origin);
    const Vec3 d = transform_inverse_vector(&component->transform, direction);
    const double length = component->length, s = component->strength;

    if (length == 0) {
        add_ball(out, o, d, 0, -INFINITY, INFINITY, s);
        return;
    }
    if (d.z == 0 && (o.z < 0 || o.z > length)) {
        add_ball(out, o, d, o.z < 0 ? 0 : length, -INFINITY, INFINITY, s);
        return;
    }
    /* The times at both ends of the axis, and what comes first. */
    const double bottom = d.z == 0 ? -INFINITY : -o.z / d.z, top = d.z == 0 ? INFINITY : (length - o.z) / d.z;
    const double c = d.x * d.x + d.y * d.y, middle = c > 0 ? -(o.x * d.x + o.y * d.y) / c : 0;
    const double x = o.x + middle * d.x, y = o.y + middle * d.y;
    const int up = !(d.z < 0);
    add_piece(out, fmin(bottom, top), fmax(bottom, top), middle, x * x + y * y, c, s);
    if (d.z != 0) {
        add_ball(out, o, d, up ? 0 : length, -INFINITY, fmin(bottom, top), s);
        add_ball(out, o, d, up ? length : 0, fmax(bottom, top), INFINITY, s);
    }
}

/* The ends of pieces that lie in the range, and its own, in ascending order. */
static int breakpoints(const Pieces *pieces, double ends[2 * MAX_PIECES + 2])
{
    int count = 2;

    ends[0] = pieces->low;
    ends[1] = pieces->high;
    for (int i = 0; i < 2 * pieces->count; i++) {
        const double t = i & 1 ? pieces->list[i / 2].to : pieces->list[i / 2].from;
        int k = count;
        if (!(t > pieces->low && t < pieces->high))
            continue;
        for (; ends[k - 1] > t; k--)
            ends[k] = ends[k - 1];
        if (ends[k - 1] == t) { /* there is one already: close up again */
            for (; k < count; k++)
                ends[k] = ends[k + 1];
            continue;
        }
        ends[k] = t;
        count++;
    }
    return count;
}

/* The sum of densities less the threshold as a polynomial about a time between from and to. Returns 0 where it cannot
 * reach the threshold. */
static int density_polynomial(const Pieces *pieces, double threshold, double from, double to, double about, double c[5])
{
    double most = 0;

    c[0] = -threshold;
    c[1] = c[2] = c[3] = c[4] = 0;
    for (int i = 0; i < pieces->count; i++) {
        const Piece *p = &pieces->list[i];
        if (p->from > from || p->to < to)
            continue;
        const double away = about - p->middle, r0 = 1 - p->h2 - p->c * away * away, r1 = -2 * p->c * away, r2 = -p->c;
        const double near = fmin(fmax(p->middle, from), to) - p->middle, highest = 1 - p->h2 - p->c * near * near;
        c[0] += p->strength * r0 * r0;
        c[1] += p->strength * 2 * r0 * r1;
        c[2] += p->strength * (2 * r0 * r2 + r1 * r1);
        c[3] += p->strength * 2 * r1 * r2;
        c[4] += p->strength * r2 * r2;
        most += fmax(p->strength, 0) * highest * highest;
    }
    return most >= threshold;
}

/* A search along the ray: what it found, in what state it is. */
typedef struct Search {
    const Blob *blob;
    Vec3 origin, direction;
    const ShapeRay *ray;
    double shift; /* from t of the search to the ray's */
    double start; /* well before the ray's tmin: what ends before does not count */
    int inside;   /* at the point reached */
    double *t;
} Search;

/* 1: it is the answer. */
static int cross(Search *search, double t)
{
    search->inside = !search->inside;
    return shape_accept(search->ray, t + search->shift, search->t);
}

static double quartic(const void *data, double x, double *slope)
{
    const double *c = data;

    *slope = ((4 * c[4] * x + 3 * c[3]) * x + 2 * c[2]) * x + c[1];
    return (((c[4] * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0];
}

/* Its roots between low and high, where b are its coefficients in Bernstein's form: where they change their sign but
 * once, or never, so does it; else each half is looked at. Returns the number of roots so far. */
static int bernstein_roots(const double c[5], const double b[5], double low, double high, int halvings, double roots[5],
                           int count)
{
    double left[5], right[5];
    const double middle = 0.5 * (low + high);
    int changes = 0;

    for (int i = 0; i < 4; i++)
        changes += (b[i] > 0) != (b[i + 1] > 0);
    if (changes == 1)
        roots[count++] = root_between(quartic, c, low, high, b[4] > 0);
    else if (changes > 1 && halvings == 0 && (b[0] > 0) != (b[4] > 0))
        roots[count++] = middle;
    if (changes <= 1 || halvings == 0)
        return count;
    memcpy(right, b, sizeof(right));
    for (int k = 0; k < 5; k++) {
        left[k] = right[0];
        for (int i = 0; i + k < 4; i++)
            right[i] = 0.5 * (right[i] + right[i + 1]);
    }
    count = bernstein_roots(c, left, low, middle, halvings - 1, roots, count);
    return bernstein_roots(c, right, middle, high, halvings - 1, roots, count);
}

/* The quartic's roots in -half..half, as changes of sign, and its sign at -half. */
static int quartic_roots(const double c[5], double half, double roots[5], int *begins)
{
    const double h2 = half * half, c1 = c[1] * half, c2 = c[2] * h2, c3 = c[3] * h2 * half, c4 = c[4] * h2 * h2;
    const double b[5] = {c[0] - c1 + c2 - c3 + c4, c[0] - 0.5 * c1 + 0.5 * c3 - c4, c[0] - c2 / 3 + c4,
                         c[0] + 0.5 * c1 - 0.5 * c3 - c4, c[0] + c1 + c2 + c3 + c4};

    *begins = b[0] > 0;
    return bernstein_roots(c, b, -half, half, MAX_HALVINGS, roots, 0);
}

static int search_pieces(Search *search, const Pieces *pieces)
{
    double ends[2 * MAX_PIECES + 2], c[5], roots[5];
    const int count = breakpoints(pieces, ends);

    for (int i = 0; i + 1 < count; i++) {
        const double from = ends[i], to = ends[i + 1], about = 0.5 * (from + to);
        int begins = 0, n = 0;
        if (to < search->start)
            continue;
        if (density_polynomial(pieces, search->blob->threshold, from, to, about, c))
            n = quartic_roots(c, 0.5 * (to - from), roots, &begins);
        if (from < search->start)
            search->inside = begins; /* what was before does not count */
        if (begins != search->inside && cross(search, from))
            return 1;
        for (int k = 0; k < n; k++)
            if (cross(search, roots[k] + about))
                return 1;
    }
    return 0;
}

static int search_range(Search *search, double low, double high, int halvings)
{
    Pieces pieces;

    pieces.low = low, pieces.high = high;
    pieces.count = pieces.overflow = 0;
    for (int i = 0; i < search->blob->ncomponents && !pieces.overflow; i++)
        add_component(&pieces, &search->blob->components[i], search->origin, search->direction);
    if (!pieces.overflow || halvings == MAX_HALVINGS)
        return search_pieces(search, &pieces);
    const double half = 0.5 * (low + high);
    return search_range(search, low, half, halvings + 1) || search_range(search, half, high, halvings + 1);
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    const Blob *blob = primitive->shape.data;
    const Vec3 middle = vec_scale(vec_add(blob->low, blob->high), 0.5), d = ray->direction;
    const double length = vec_length(d), reach = 0.51 * vec_length(vec_sub(blob->high, blob->low)) / length;
    const double shift = vec_dot(vec_sub(middle, ray->origin), d) / (length * length);
    const double start = ray->tmin - shift - 1e-9 * (fabs(shift) + reach);
    Search search = {blob, vec_mad(ray->origin, d, shift), d, ray, shift, start, 0, t};

    (void)face;
    if (shift + reach < ray->tmin || shift - reach > ray->tmax)
        return 0;
    return search_range(&search, -reach, reach, 0) || (search.inside && cross(&search, reach));
}

/* ---- the field ---- */

/* 1 less the square of the distance, in the component's space; its gradient in the blob's space. Not above 0: out of
 * reach. */
static double closeness(const BlobComponent *component, Vec3 p, Vec3 *gradient)
{
    Vec3 q = transform_inverse_point(&component->transform, p);

    q.z -= fmin(fmax(q.z, 0), component->length);
    if (gradient)
        *gradient = vec_scale(transform_normal(&component->transform, q), -2);
    return 1 - vec_dot(q, q);
}

static double density(const Blob *blob, Vec3 p, Vec3 *gradient)
{
    double sum = 0;
    Vec3 slope;

    *gradient = vec3(0, 0, 0);
    for (int i = 0; i < blob->ncomponents; i++) {
        const double near = closeness(&blob->components[i], p, &slope), s = blob->components[i].strength;
        if (!(near > 0))
            continue;
        sum += s * near * near;
        *gradient = vec_mad(*gradient, slope, 2 * s * near);
    }
    return sum;
}

static int inside(const Shape *shape, Vec3 p)
{
    Vec3 gradient;

    return density(shape->data, p, &gradient) >= ((const Blob *)shape->data)->threshold;
}

static void point(const Primitive *primitive, Vec3 p, int face, ShapePoint *out)
{
    const Blob *blob = primitive->shape.data;
    const double size = vec_length(vec_sub(blob->high, blob->low));
    Vec3 gradient;

    (void)face;
    for (int i = 0; i < 2; i++) {
        const double off = blob->threshold - density(blob, p, &gradient), steep = vec_dot(gradient, gradient);
        const Vec3 step = vec_scale(gradient, steep > 0 ? off / steep : 0);
        if (!(vec_length(step) < 1e-6 * size))
            break;
        p = vec_add(p, step);
    }
    out->p = p;
    out->normal = vec_neg(gradient);
    if (vec_dot(gradient, gradient) == 0)
        out->normal = vec3(0, 1, 0);
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Blob *blob = primitive->shape.data;

    for (int i = 0; i < blob->ncomponents; i++) {
        const BlobComponent *c = &blob->components[i];
        const Transform t = transform_then(c->transform, primitive->transform);
        for (int end = 0; c->strength > 0 && end < 2; end++)
            shape_bound_circle(low, high, &t, vec3(0, 0, end ? c->length : 0), 0, 1, 0, 1);
    }
    if (!(low->x <= high->x))
        *low = *high = transform_point(&primitive->transform, vec3(0, 0, 0));
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const Blob *blob = surface->primitive->shape.data;
    const Vec3 middle = vec_scale(vec_add(blob->low, blob->high), 0.5);

    out->natural = shape_angles(vec_sub(shape_local_point(surface), middle));
}

/* Components share a point as their densities do. */
static int texture(const Surface *surface)
{
    const Blob *blob = surface->primitive->shape.data;
    const Vec3 p = shape_local_point(surface);
    double sum = 0, share;
    int chosen = -1;

    for (int pass = 0; pass < 2; pass++) {
        share = pass ? shape_share(surface->position) * sum : INFINITY;
        sum = 0;
        for (int i = 0; i < blob->ncomponents && sum <= share; i++) {
            const double near = closeness(&blob->components[i], p, NULL);
            if (!(near > 0 && blob->components[i].strength > 0))
                continue;
            sum += blob->components[i].strength * near * near;
            chosen = blob->components[i].texture;
        }
    }
    return chosen;
}

const ShapeOps shape_blob = {
    .name = "blob",
    .properties = SHAPE_U_PERIODIC,
    SHAPE_BOUNDED,
    .texture = texture,
};
