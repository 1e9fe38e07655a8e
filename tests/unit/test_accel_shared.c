/* Copies of a mesh that share its triangles, compared with each copy in double: nearest hits with their normals, and
 * what lets light through. Embree decides in float whether a ray meets a triangle near its edges: where the two differ,
 * one of the hits is there. */
#include <stdlib.h>
#include "lib_test.h"
#include <cmocka.h>
#include "accel/accel.h"
#include "shape/shape.h"

enum { FACES = 6000, COPIES = 50, RAYS = 20000 };
#define EDGE 3e-5

static uint32_t state = 5;

static double between(double low, double high)
{
    return low + (high - low) * test_random(&state);
}
static Vec3 within(double size)
{
    double x = between(-size, size), y = between(-size, size), z = between(-size, size);

    return vec3(x, y, z);
}

static const Pigment grey = {.kind = PIGMENT_COLOR, .color = {0.5f, 0.5f, 0.5f, 0, 0}};
static const Pigment glass = {.kind = PIGMENT_COLOR, .color = {1, 1, 1, 0.9f, 0}};
static const Texture solid = {.pigment = &grey}, clear = {.pigment = &glass};

static Vec3 vertices[3 * FACES];
static MeshFace faces[FACES];
static Mesh mesh = {.nvertices = 3 * FACES, .nfaces = FACES, .vertices = vertices, .faces = faces};
static Mesh heads[COPIES];
static Primitive copies[COPIES];
static Scene scene = {.primitives = copies, .nprimitives = COPIES};

static void make_scene(Arena *arena)
{
    for (int i = 0; i < FACES; i++) {
        Vec3 p = within(1);
        for (int k = 0; k < 3; k++)
            vertices[3 * i + k] = vec_add(p, within(0.06));
        faces[i] = (MeshFace){{3 * i, 3 * i + 1, 3 * i + 2}, {-1, -1, -1}, {-1, -1, -1}, -1};
    }
    assert_true(mesh_index(arena, &mesh));
    for (int i = 0; i < COPIES; i++) {
        Transform t = transform_scale(vec3(between(0.2, 2), between(0.2, 2) * (i % 3 ? 1 : -1), between(0.2, 2)));
        t = transform_then(transform_then(t, transform_rotate(within(180))), transform_translate(within(8)));
        heads[i] = mesh;
        copies[i] = (Primitive){.shape = {.ops = &shape_mesh, .mesh = &heads[i]}, .transform = t, .target = -1};
        copies[i].texture = i % 5 == 1 ? &clear : &solid;
        copies[i].no_image = i % 7 == 2;
        copies[i].no_shadow = i % 7 == 3;
        copies[i].inverse = i % 4 == 1;
    }
    scene.camera.location = vec3(9, 9, 9);
}

/* The nearest of all copies, in double; those that let light through only where asked. */
static int nearest(const Ray *ray, RayKind kind, int opaque_only, Hit *hit)
{
    Ray rest = *ray;

    rest.tmin *= 1 + 1e-11; /* a hit from which the ray goes on is known to another rounding here */
    hit->primitive = -1;
    for (int i = 0; i < COPIES; i++) {
        double t;
        int face;
        if ((kind == RAY_CAMERA && copies[i].no_image) || (kind == RAY_SHADOW && copies[i].no_shadow) ||
            (opaque_only && copies[i].texture == &clear) || !shape_intersect(&copies[i], &rest, &t, &face))
            continue;
        rest.tmax = t;
        *hit = (Hit){.t = t, .primitive = i, .face = face};
    }
    if (hit->primitive >= 0)
        shape_complete_hit(&copies[hit->primitive], ray, hit);
    return hit->primitive >= 0;
}

/* Edges 01 and 02 of the hit's face, in object space. */
static void edges_of(const Hit *hit, Vec3 *e1, Vec3 *e2)
{
    const int *v = faces[hit->face].vertex;

    *e1 = vec_sub(vertices[v[1]], vertices[v[0]]);
    *e2 = vec_sub(vertices[v[2]], vertices[v[0]]);
}

/* How far off float may be on the face, in object space: more where the ray grazes it. */
static double doubt(const Ray *ray, const Hit *hit)
{
    return EDGE / fmax(fabs(vec_dot(ray->direction, hit->normal)), 1e-4);
}

static int near_edge(const Ray *ray, const Hit *hit)
{
    Vec3 e1, e2;
    double longest, share;

    if (hit->primitive < 0)
        return 0;
    edges_of(hit, &e1, &e2);
    longest = fmax(fmax(vec_length(e1), vec_length(e2)), vec_length(vec_sub(e1, e2)));
    share = fmin(fmin(hit->b1, hit->b2), 1 - hit->b1 - hit->b2);
    return share * vec_length(vec_cross(e1, e2)) / longest < doubt(ray, hit);
}

static int same(const Ray *ray, const Hit *a, const Hit *b)
{
    Vec3 e1, e2;

    if (a->primitive != b->primitive || a->primitive < 0)
        return a->primitive == b->primitive;
    edges_of(a, &e1, &e2);
    return a->face == b->face && fabs(a->t - b->t) < 1e-11 * (10 + a->t) &&
           vec_length(vec_sub(a->normal, b->normal)) < 1e-7 &&
           vec_length(vec_add(vec_scale(e1, a->b1 - b->b1), vec_scale(e2, a->b2 - b->b2))) < doubt(ray, a);
}

static Ray next_ray(const Ray *ray, const Hit *hit)
{
    Ray next = *ray;
    Surface s;

    if (test_random(&state) < 0.5) {
        next.tmin = hit->t;
        return next;
    }
    surface_at(&s, &scene, ray, hit);
    next.direction = vec_normalize(within(1));
    next.origin = accel_offset(s.position, s.geometric_normal, next.direction);
    next.tmin = 0;
    return next;
}

static void copies_are_met_where_they_are(void **unused)
{
    Arena *arena = arena_create(0, NULL);
    Accel *accel;
    RetexError err = {0};
    int hits = 0, doubtful = 0, passed = 0, count = 0;

    (void)unused;
    make_scene(arena);
    assert_int_equal(accel_create(&accel, &scene, 1, &err), 0);
    for (int i = 0; i < RAYS; i++) {
        Vec3 origin = within(10), aim = transform_point(&copies[i % COPIES].transform, within(1));
        Ray ray = {origin, vec_normalize(vec_sub(aim, origin)), 0, i % 3 ? INFINITY : between(0, 20)};
        for (int bounce = 0; bounce < 3; bounce++, count++) {
            Hit hit, packet, reference, opaque;
            const RayKind kind = RAY_CAMERA;
            int found = accel_intersect(accel, &ray, kind, &hit), source = 1;
            Visibility visibility = accel_visibility(accel, &ray, 1), of_packet;
            accel_intersect_packet(accel, &ray, &kind, 1, 0, &packet);
            accel_visibility_packet(accel, &ray, &source, 1, &of_packet);
            assert_int_equal(visibility, of_packet);
            assert_int_equal(found, nearest(&ray, RAY_CAMERA, 0, &reference) || near_edge(&ray, &hit));
            if (!same(&ray, &hit, &reference) || !same(&ray, &packet, &reference)) {
                if (!near_edge(&ray, &hit) && !near_edge(&ray, &reference) && !near_edge(&ray, &packet))
                    fail_msg("ray %d: copy %d face %d at %.17g, not %d %d %.17g", i, hit.primitive, hit.face, hit.t,
                             reference.primitive, reference.face, reference.t);
                doubtful++;
                break;
            }
            int blocked = nearest(&ray, RAY_SHADOW, 1, &opaque), any = nearest(&ray, RAY_SHADOW, 0, &reference);
            if (!near_edge(&ray, &opaque) && !near_edge(&ray, &reference))
                assert_int_equal(visibility, blocked ? VISIBILITY_BLOCKED
                                             : any   ? VISIBILITY_TRANSPARENT
                                                     : VISIBILITY_CLEAR);
            passed += visibility == VISIBILITY_TRANSPARENT;
            hits += found;
            if (!found)
                break;
            ray = next_ray(&ray, &hit);
        }
    }
    print_message("# %d rays, %d hits, %d pass through, %d near edges\n", count, hits, passed, doubtful);
    assert_true(hits > RAYS / 2 && passed > RAYS / 100 && doubtful < count / 100);
    accel_close(&accel);
    arena_close(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_are_met_where_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
