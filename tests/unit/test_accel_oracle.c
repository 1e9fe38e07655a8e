/* Ray queries, compared with a simple loop over all shapes of a random scene in double precision.
 *
 * Some results of Embree, which computes in float, are not checked: whether a ray intersects a triangle within EDGE of
 * its rim; whether a triangle within START of the ray's start lies before or behind it; and which of two triangles
 * comes first if their distance is within HEIGHT. All three are shares of the coordinates involved. If a curved shape
 * or a plane is one of the two, the order must be right to EXACT.
 *
 * RETEX_ORACLE_SECONDS=N tests further scenes for N seconds. RETEX_ORACLE_SEED=N begins with scene N. A failure names
 * the seed of its scene. */
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "lib_test.h"
#include <cmocka.h>
#include "lib_random_scene.h"

#define EDGE 2e-6
#define START 4e-7
#define HEIGHT 2e-6
#define EXACT 1e-11

enum { SCENES = 250, BATCHES = 10, CANDIDATES_MOST = 512, TRIES = 20 };

/* ---- the plain loop ---- */

/* Something that the ray meets, or may meet. */
typedef struct Candidate {
    double t, slack; /* slack: how far off the distance may be */
    double fall;     /* cosine of a triangle's normal; 0 for other shapes */
    int primitive, face, sure;
} Candidate;

typedef struct Met {
    Candidate list[CANDIDATES_MOST];
    int count;
} Met;

static int visible(const Primitive *p, RayKind kind)
{
    return (!p->no_image && (kind & RAY_CAMERA)) || (!p->no_shadow && (kind & RAY_SHADOW)) ||
           (!p->no_reflection && (kind & RAY_BOUNCE));
}

static void add(Met *met, const Ray *ray, Candidate c)
{
    if (!(c.t + c.slack > ray->tmin && c.t - c.slack < ray->tmax))
        return;
    c.sure = c.sure && c.t - c.slack > ray->tmin && c.t + c.slack < ray->tmax;
    assert_true(met->count < CANDIDATES_MOST);
    met->list[met->count++] = c;
}

/* Distance of a point to the line through a and b, on its plane; positive on the inner side. */
static double inside_edge(Vec3 a, Vec3 b, Vec3 normal, Vec3 p)
{
    Vec3 along = vec_normalize(vec_sub(b, a));

    return vec_dot(vec_cross(normal, along), vec_sub(p, a));
}

static void meet_triangle(const RandomScene *w, const Ray *ray, int index, int k, Met *met)
{
    const Primitive *p = &w->shapes[index];
    const int *corners = test_corners_of(p, k);
    Vec3 a = test_corner_at(p, corners[0]), b = test_corner_at(p, corners[1]), c = test_corner_at(p, corners[2]);
    Vec3 n = vec_normalize(vec_cross(vec_sub(b, a), vec_sub(c, a))), at;
    double height = vec_dot(n, vec_sub(a, ray->origin)), fall = vec_dot(n, ray->direction), t = height / fall;
    double sizes = w->reach + test_size_of(ray->origin), within, doubt;

    if (fabs(fall) < 1e-9)
        return;
    at = vec_mad(ray->origin, ray->direction, t);
    within = fmin(inside_edge(a, b, n, at), fmin(inside_edge(b, c, n, at), inside_edge(c, a, n, at)));
    doubt = EDGE * sizes / fabs(fall);
    if (!(within > -doubt))
        return;
    add(met, ray,
        (Candidate){t, 1e-14 * sizes / fabs(fall), fabs(fall), index, k / test_triangles_of(p).per_face,
                    within > doubt && fabs(fall) > 2e-3 && fabs(height) > START * sizes});
}

static void meet_all(const RandomScene *w, const Ray *ray, RayKind kind, Met *met)
{
    met->count = 0;
    for (int i = 0; i < w->scene.nprimitives; i++) {
        const Primitive *p = &w->shapes[i];
        double t;
        int face;
        if (!visible(p, kind))
            continue;
        for (int k = 0; k < test_triangles_of(p).ntriangles; k++)
            meet_triangle(w, ray, i, k, met);
        if (!p->shape.ops->triangles && shape_intersect(p, ray, &t, &face))
            add(met, ray, (Candidate){t, 0, 0, i, face, 1});
    }
}

/* ---- judging ---- */

static void complain(const RandomScene *w, const Ray *ray, RayKind kind, const Met *met, const char *what,
                     const Hit *hit)
{
    const Candidate *nearest = NULL;

    for (int i = 0; i < met->count; i++)
        if (met->list[i].sure && (!nearest || met->list[i].t < nearest->t))
            nearest = &met->list[i];
    print_message("# kind %d, range %g to %g, origin %.17g %.17g %.17g, direction %.17g %.17g %.17g\n", kind, ray->tmin,
                  ray->tmax, ray->origin.x, ray->origin.y, ray->origin.z, ray->direction.x, ray->direction.y,
                  ray->direction.z);
    if (hit && hit->primitive >= 0)
        print_message("# met: %d (%s) face %d at %.17g\n", hit->primitive, w->shapes[hit->primitive].shape.ops->name,
                      hit->face, hit->t);
    if (nearest)
        print_message("# is there: %d (%s) face %d at %.17g, cosine %g\n", nearest->primitive,
                      w->shapes[nearest->primitive].shape.ops->name, nearest->face, nearest->t, nearest->fall);
    fail_msg("%s; RETEX_ORACLE_SEED=%u, size %g, %d shapes", what, (unsigned)w->seed, w->size, w->scene.nprimitives);
}

/* How much farther away b may be and still be taken for the nearer one. */
static double open_to_float(const RandomScene *w, const Ray *ray, const Candidate *a, const Candidate *b)
{
    double sizes = w->reach + test_size_of(ray->origin), exact = EXACT * (a->t + test_size_of(ray->origin));

    if (a->fall == 0 || b->fall == 0)
        return exact + a->slack + b->slack;
    return exact + HEIGHT * sizes / fmin(a->fall, b->fall);
}

static int judge(const RandomScene *w, const Ray *ray, RayKind kind, const Met *met, int found, const Hit *hit)
{
    const Candidate *taken = NULL;
    int sure = 0;

    if (found != (hit->primitive >= 0))
        complain(w, ray, kind, met, "what is returned and the hit differ", hit);
    for (int i = 0; found && i < met->count; i++) {
        const Candidate *c = &met->list[i];
        if (c->primitive == hit->primitive && c->face == hit->face &&
            fabs(c->t - hit->t) <= EXACT * (c->t + test_size_of(ray->origin)) + 2 * c->slack)
            taken = c;
    }
    if (found && !taken)
        complain(w, ray, kind, met, "this is not on the ray", hit);
    for (int i = 0; i < met->count; i++) {
        const Candidate *c = &met->list[i];
        if (!c->sure)
            continue;
        sure = 1;
        if (!found)
            complain(w, ray, kind, met, "nothing is found", hit);
        if (c->t + open_to_float(w, ray, c, taken) < hit->t)
            complain(w, ray, kind, met, "something is nearer", hit);
    }
    return sure;
}

/* passes: 0 none, 1 what is transparent, 2 what lets light through unbent. */
static int passed(const RandomScene *w, int primitive, int passes)
{
    return (passes == 1 && w->of[primitive]->transparent) || (passes == 2 && w->of[primitive]->straight);
}

static void judge_way(const RandomScene *w, const Ray *ray, RayKind kind, const Met *met, int passes, Visibility way)
{
    int blocked[2] = {0, 0}, passable[2] = {0, 0}; /* perhaps, surely */

    for (int i = 0; i < met->count; i++) {
        const Candidate *c = &met->list[i];
        int *list = passed(w, c->primitive, passes) ? passable : blocked;
        list[0] = 1;
        list[1] |= c->sure;
    }
    if (way == VISIBILITY_BLOCKED ? !blocked[0] : blocked[1])
        complain(w, ray, kind, met, way == VISIBILITY_BLOCKED ? "nothing blocks the way" : "the way is blocked", NULL);
    if (way != VISIBILITY_BLOCKED && (way == VISIBILITY_TRANSPARENT ? !passable[0] : passable[1]))
        complain(w, ray, kind, met, "what may let light through is not told", NULL);
}

/* ---- rays ---- */

static RayKind random_kind(void)
{
    const RayKind kinds[] = {RAY_CAMERA, RAY_BOUNCE, RAY_SHADOW, (RayKind)(RAY_CAMERA | RAY_BOUNCE)};

    return kinds[random_below(4)];
}

/* Just within the side of a sphere's bounds. */
static Ray skimming_ray(const RandomScene *w, const Primitive *sphere)
{
    int axis = random_below(3);
    const double *row = sphere->transform.m[axis];
    Vec3 out = {axis == 0, axis == 1, axis == 2}, radius = {row[0], row[1], row[2]};
    Vec3 at = transform_point(&sphere->transform, vec_normalize(radius));
    Ray ray = {{0, 0, 0}, vec_normalize(vec_cross(out, random_direction())), 0, INFINITY};

    at = vec_mad(at, out, -vec_length(radius) * random_magnitude(1e-7, 1e-2));
    ray.origin = vec_mad(at, ray.direction, -w->size * random_magnitude(1, 0.5 * w->far));
    return ray;
}

static Ray random_ray(const RandomScene *w)
{
    const Primitive *aim = &w->shapes[random_below(w->scene.nprimitives)];
    Vec3 inside = transform_point(&aim->transform, vec_scale(random_direction(), random_between(0, 1)));
    Ray ray = {vec_mad(w->centre, random_direction(), w->size * (random_chance(0.1) ? w->far : random_between(0, 2))),
               random_direction(), 0, INFINITY};

    if (aim->shape.ops == &shape_sphere && random_chance(0.3))
        return skimming_ray(w, aim);
    if (random_chance(0.1)) {
        int axis = random_below(3);
        ray.direction = vec3(axis == 0, axis == 1, axis == 2);
        ray.origin = vec_mad(inside, ray.direction, -w->size * random_between(0, 2));
    } else if (random_chance(0.7)) {
        ray.direction = vec_normalize(vec_sub(inside, ray.origin));
    }
    if (random_chance(0.2))
        ray.tmax = w->size * random_between(0, 3);
    if (random_chance(0.1))
        ray.tmin = w->size * random_between(0, 1);
    return ray;
}

/* On from where a ray has met something: off its surface, or along the same ray, or up to there and no farther. */
static Ray next_ray(const RandomScene *w, const Ray *ray, const Hit *hit)
{
    Ray next = *ray;
    Surface s;

    if (hit->primitive < 0)
        return random_ray(w);
    if (random_chance(0.2)) {
        next.tmin = hit->t, next.tmax = INFINITY;
    } else if (random_chance(0.2)) {
        next.tmax = hit->t * (1 + (random_chance(0.5) ? 1e-9 : -1e-9));
    } else if (random_chance(0.2)) {
        next.tmin = hit->t * (1 - 1e-9);
    } else {
        surface_at(&s, &w->scene, ray, hit);
        next = random_ray(w);
        next.tmin = 0;
        next.origin = accel_offset(s.position, s.geometric_normal, next.direction);
    }
    return next;
}

/* One ray alone, all ways. Returns 1 where something is met for sure. */
static int check_ray(const RandomScene *w, const Ray *ray, RayKind kind, Hit *hit)
{
    Met met;
    int found;

    meet_all(w, ray, kind, &met);
    *hit = (Hit){.t = -1, .primitive = 77, .face = 77};
    found = accel_intersect(w->accel, ray, kind, hit);
    judge_way(w, ray, kind, &met, 0, accel_occluded(w->accel, ray, kind, 0) ? VISIBILITY_BLOCKED : VISIBILITY_CLEAR);
    return judge(w, ray, kind, &met, found, hit);
}

static void check_ways(const RandomScene *w, const Ray *ray, Visibility packet, int source)
{
    Met met;
    int occluded = accel_occluded(w->accel, ray, RAY_SHADOW, 1);

    meet_all(w, ray, RAY_SHADOW, &met);
    judge_way(w, ray, RAY_SHADOW, &met, source ? 1 : 2, packet);
    judge_way(w, ray, RAY_SHADOW, &met, source ? 1 : 2, accel_visibility(w->accel, ray, source));
    if (occluded != (accel_visibility(w->accel, ray, 1) == VISIBILITY_BLOCKED))
        complain(w, ray, RAY_SHADOW, &met, "accel_occluded and accel_visibility differ", NULL);
}

/* A packet of any number of rays. Returns how many met something for sure. */
static int check_packet(const RandomScene *w, Ray rays[ACCEL_PACKET], Hit hits[ACCEL_PACKET], int count)
{
    RayKind kinds[ACCEL_PACKET];
    Hit of_packet[ACCEL_PACKET];
    Visibility ways[ACCEL_PACKET];
    int sources[ACCEL_PACKET], sure = 0;

    for (int i = 0; i < count; i++)
        kinds[i] = random_kind(), sources[i] = random_chance(0.5);
    accel_intersect_packet(w->accel, rays, kinds, count, random_chance(0.5), of_packet);
    accel_visibility_packet(w->accel, rays, sources, count, ways);
    for (int i = 0; i < count; i++) {
        Met met;
        meet_all(w, &rays[i], kinds[i], &met);
        judge(w, &rays[i], kinds[i], &met, of_packet[i].primitive >= 0, &of_packet[i]);
        sure += check_ray(w, &rays[i], kinds[i], &hits[i]);
        check_ways(w, &rays[i], ways[i], sources[i]);
    }
    return sure;
}

static void check_world(uint32_t seed, long *rays, long *sure)
{
    static RandomScene w;
    Ray list[ACCEL_PACKET];
    Hit hits[ACCEL_PACKET];

    random_scene(&w, seed);
    for (int batch = 0; batch < BATCHES; batch++) {
        int count = 1 + random_below(ACCEL_PACKET);
        for (int i = 0; i < ACCEL_PACKET; i++)
            list[i] = random_ray(&w);
        for (int step = 0; step < 3; step++) {
            *sure += check_packet(&w, list, hits, count);
            *rays += count;
            for (int i = 0; i < count; i++)
                list[i] = next_ray(&w, &list[i], &hits[i]);
        }
    }
    accel_close(&w.accel);
}

static double seconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* When a test that goes on for a share of the time is to end. */
static double end_after(double share)
{
    const char *limit = getenv("RETEX_ORACLE_SECONDS");

    return seconds() + (limit ? share * atof(limit) : 0);
}

static uint32_t first_seed(void)
{
    const char *first = getenv("RETEX_ORACLE_SEED");

    return first ? (uint32_t)strtoul(first, NULL, 10) : 1;
}

static void queries_are_a_plain_loop(void **unused)
{
    /* What ten million rays have found beside: a triangle and a curved shape as near as the next double, and a ray that
     * starts in the edge where they touch. */
    const uint32_t found_before[] = {43164, 703555};
    double end = end_after(0.8);
    long rays = 0, sure = 0;

    (void)unused;
    for (int n = 0; n < 2; n++)
        check_world(found_before[n], &rays, &sure);
    for (int n = 0; n < SCENES || seconds() < end; n++)
        check_world(first_seed() + (uint32_t)n, &rays, &sure);
    print_message("# %ld rays, %ld met something for sure\n", rays, sure);
    assert_true(sure > rays / 3);
}

/* ---- the loop's own shapes ---- */

/* 0 on the surface, and of another sign on its other side; in canonical space. */
static double equation(const Primitive *p, Vec3 q)
{
    double r0 = p->shape.r0, r1 = p->shape.r1;
    double sum = vec_dot(q, q) + r0 * r0 - r1 * r1, radius = r0 + (r1 - r0) * q.z;

    if (p->shape.ops == &shape_sphere)
        return vec_dot(q, q) - 1;
    if (p->shape.ops == &shape_cone && p->shape.open) /* both nappes: what of them is there is asked of the crossing */
        return q.x * q.x + q.y * q.y - radius * radius;
    if (p->shape.ops == &shape_cone)
        return fmax(hypot(q.x, q.y) - radius, fmax(-q.z, q.z - 1));
    if (p->shape.ops == &shape_torus)
        return sum * sum - 4 * p->shape.r0 * p->shape.r0 * (q.x * q.x + q.z * q.z);
    return p->shape.ops == &shape_disc ? q.z : q.y;
}

/* How far within the edges of a shape that has some a point of its surface is. */
static double within_edges(const Primitive *p, Vec3 q)
{
    double rho = hypot(q.x, q.y);

    if (p->shape.ops == &shape_cone && p->shape.open)
        return fmin(q.z, 1 - q.z);
    return p->shape.ops == &shape_disc ? fmin(p->shape.r0 - rho, p->shape.r1 > 0 ? rho - p->shape.r1 : INFINITY) : 1;
}

/* The solution of m x = v, by Cramer's rule: not by the inverse that the renderer goes by. */
static Vec3 solve(const Transform *t, Vec3 v)
{
    Vec3 a = {t->m[0][0], t->m[1][0], t->m[2][0]}, b = {t->m[0][1], t->m[1][1], t->m[2][1]},
         c = {t->m[0][2], t->m[1][2], t->m[2][2]}, bc = vec_cross(b, c);
    double d = vec_dot(a, bc);

    return vec3(vec_dot(v, bc) / d, vec_dot(vec_cross(c, a), v) / d, vec_dot(vec_cross(a, b), v) / d);
}

/* Is there a crossing of the surface that is past doubt between low and high, by steps along the ray? */
static int crosses(const Primitive *p, Vec3 o, Vec3 d, double low, double high, double doubt, double *at)
{
    const int steps = 1500;
    double before = 0, from = low;

    for (int i = 0; i <= steps; i++) {
        double t = low + (high - low) * i / steps, now = equation(p, vec_mad(o, d, t)), a = from, b = t;
        if (fabs(now) < doubt)
            continue;
        if (before != 0 && (before > 0) != (now > 0)) {
            for (int k = 0; k < 60; k++)
                *((equation(p, vec_mad(o, d, 0.5 * (a + b))) > 0) == (now > 0) ? &b : &a) = 0.5 * (a + b);
            if (within_edges(p, vec_mad(o, d, a)) > 1e-6) {
                *at = a;
                return 1;
            }
        }
        before = now, from = t;
    }
    return 0;
}

static uint32_t case_seed;

static void complain_of(const Primitive *p, const char *what, double first, double second)
{
    fail_msg("%s, r0 %g, r1 %g, open %d: %s: %.17g, %.17g; RETEX_ORACLE_SEED=%u", p->shape.ops->name, p->shape.r0,
             p->shape.r1, p->shape.open, what, first, second, (unsigned)case_seed);
}

/* What shape_intersect finds is on the surface, and nothing comes before it; nothing is where it finds nothing. Returns
 * its answer, and where that is. */
static int check_shape(const Primitive *p, const Ray *ray, double *where)
{
    Vec3 o = solve(&p->transform, vec_sub(ray->origin, transform_point(&p->transform, vec3(0, 0, 0))));
    Vec3 d = solve(&p->transform, ray->direction);
    double length = vec_length(d), middle = -vec_dot(o, d) / (length * length), half, at, t = -1;
    double doubt = 1e-8 + 1e-11 * (vec_length(o) + test_size_of(ray->origin) * length);
    double low, high;
    int face = 77, found = shape_intersect(p, ray, &t, &face);

    if (!found)
        assert_true(t == -1 && face == 77);
    else if (fabs(equation(p, vec_mad(o, d, t))) > doubt * 10)
        complain_of(p, "off the surface", ray->tmin, t);
    else if (within_edges(p, vec_mad(o, d, t)) < -1e-6)
        complain_of(p, "beyond the edge", ray->tmin, t);
    half = (p->shape.ops == &shape_plane ? 1e3 * (1 + vec_length(o)) : 3.5) / length; /* all others are within 3.5 */
    low = fmax(ray->tmin, middle - half);
    high = fmin(found ? t : ray->tmax, middle + half);
    /* The end is the hit itself: the last step before it has the sign of this side. */
    if (low < high && crosses(p, o, d, low, low + (high - low) * (found ? 1 - 1e-6 : 1), doubt * 10, &at))
        complain_of(p, found ? "there is a nearer one" : "there is one", t, at);
    /* Going on from a hit does not find it again. */
    if (found && ray->tmin > 0 && (t - ray->tmin) * length < 1e-10)
        complain_of(p, "found again", ray->tmin, t);
    *where = t;
    return found;
}

static void curved_shapes_are_their_equations(void **unused)
{
    const ShapeOps *const kinds[] = {&shape_sphere, &shape_plane, &shape_cone, &shape_torus,
                                     &shape_disc,   &shape_cone,  &shape_torus};
    static RandomScene w;
    double end = end_after(0.2);
    int met[7] = {0};

    (void)unused;
    for (int i = 0; i < 1000 || seconds() < end; i++) {
        random_state = case_seed = first_seed() + (uint32_t)i;
        int row = (int)(case_seed % 7);
        Primitive p = {.shape.ops = kinds[row], .target = -1};
        w.size = random_magnitude(1e-3, 1e3), w.far = 20;
        w.centre = vec_scale(random_direction(), w.size * (random_chance(0.5) ? 0 : random_magnitude(0.1, 30)));
        p.transform = random_transform(w.size * random_magnitude(0.1, 1), w.centre);
        random_form(&p);
        w.shapes[0] = p;
        w.scene = (Scene){.primitives = w.shapes, .nprimitives = 1};
        for (int k = 0; k < TRIES; k++) {
            Ray ray = random_ray(&w);
            for (int n = 0; n < 5 && check_shape(&p, &ray, &ray.tmin); n++)
                met[row]++;
        }
    }
    for (int i = 0; i < 7; i++)
        assert_true(met[i] > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curved_shapes_are_their_equations),
        cmocka_unit_test(queries_are_a_plain_loop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
