/* Ray queries. They are compared with a loop over all triangles. No ray leaks through closed meshes, no ray intersects
 * the surface that it leaves, visibility depends on the kind of ray, and bad input is handled. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "lib_plain.h"
#include "shape/shape.h"

static uint64_t seed = 1;

static double uniform(void)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11) * 0x1p-53;
}

static Vec3 direction(void)
{
    double z = 2 * uniform() - 1, angle = 2 * PI * uniform(), rho = sqrt(1 - z * z);

    return vec3(rho * cos(angle), rho * sin(angle), z);
}

static const Pigment grey = {.kind = PIGMENT_COLOR, .color = {0.5f, 0.5f, 0.5f, 0, 0}};
static const Pigment glass = {.kind = PIGMENT_COLOR, .color = {1, 1, 1, 0.9f, 0}};
static const Texture solid = {.pigment = &grey}, clear = {.pigment = &glass};

static Primitive shape(const ShapeOps *ops, Transform transform)
{
    return (Primitive){
        .shape = {.ops = ops, .r0 = 1, .r1 = 0.3}, .transform = transform, .texture = &solid, .target = -1, .line = 7};
}

/* A ball of triangles: latitude rows, without poles' degenerate ones; bumpy so that edges turn both ways. */
static Mesh ball(int rows, int columns, double bumps)
{
    Mesh mesh = {0};
    int n = 0;

    mesh.nvertices = (rows - 1) * columns + 2;
    mesh.vertices = malloc((size_t)mesh.nvertices * sizeof(Vec3));
    mesh.faces = malloc((size_t)(2 * rows * columns) * sizeof(MeshFace));
    for (int i = 1; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            double a = PI * i / rows, b = 2 * PI * j / columns, r = 1 + bumps * sin(7 * a) * sin(5 * b);
            mesh.vertices[(i - 1) * columns + j] = vec3(r * sin(a) * cos(b), r * cos(a), r * sin(a) * sin(b));
        }
    mesh.vertices[mesh.nvertices - 2] = vec3(0, 1, 0);
    mesh.vertices[mesh.nvertices - 1] = vec3(0, -1, 0);
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            int k = (j + 1) % columns, a = (i - 1) * columns + j, b = (i - 1) * columns + k;
            int top = i == 0 ? mesh.nvertices - 2 : a, low = i == rows - 1 ? mesh.nvertices - 1 : a + columns;
            MeshFace face = {{0, 0, 0}, {-1, -1, -1}, {-1, -1, -1}, -1};
            if (i > 0) {
                memcpy(face.vertex, (int[3]){a, b, low}, sizeof(face.vertex));
                mesh.faces[n++] = face;
            }
            if (i < rows - 1) {
                memcpy(face.vertex, (int[3]){i ? b : top, b + columns, a + columns}, sizeof(face.vertex));
                mesh.faces[n++] = face;
            }
        }
    mesh.nfaces = n;
    return mesh;
}

static void free_mesh(Mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->faces);
}

static Accel *create(Scene *scene, Primitive *primitives, int count)
{
    Accel *accel;
    RetexError err = {0};

    memset(scene, 0, sizeof(*scene));
    scene->primitives = primitives;
    scene->nprimitives = count;
    if (accel_create(&accel, scene, 1, &err) < 0)
        fail_msg("%s", err.message);
    return accel;
}

/* Of spheres, and of cones, at the same place the first in the scene is hit, whatever order the tree has them in. */
static void the_first_of_equals_wins(void **state)
{
    enum { COPIES = 5 };
    const ShapeOps *const ops[] = {&shape_sphere, &shape_cone};
    Primitive primitives[2 * COPIES];
    Scene scene;

    (void)state;
    for (int kind = 0; kind < 2; kind++)
        for (int far_first = 0; far_first < 2; far_first++) {
            /* copies that lie apart come between, so that the equal ones are not neighbours in the tree */
            for (int k = 0; k < 2 * COPIES; k++)
                primitives[k] =
                    shape(ops[kind], k % 2 == far_first ? transform_identity()
                                                        : transform_translate(vec3(0, 0, far_first ? -9 - k : 9 + k)));
            Accel *accel = create(&scene, primitives, 2 * COPIES);
            for (int i = 0; i < 50; i++) {
                Ray ray = {vec3(0.8 + 0.1 * uniform(), 0.1 * uniform(), -5), {0, 0, 1}, 0, INFINITY};
                Hit hit;
                assert_true(accel_intersect(accel, &ray, RAY_CAMERA, &hit));
                assert_int_equal(hit.primitive, far_first);
            }
            accel_close(&accel);
        }
}

/* A disc lies between two triangles, nearer to both than float tells apart. The nearest of the three is hit, whichever
 * of the triangles Embree reports. */
static void layers_closer_than_float_keep_their_order(void **state)
{
    const double gap = 1e-9;
    MeshFace face = {{0, 1, 2}, {-1, -1, -1}, {-1, -1, -1}, -1};
    Vec3 corners[2][3];
    Mesh layers[2];
    Primitive primitives[3];
    Scene scene;

    (void)state;
    for (int near = 0; near < 2; near++) {
        for (int k = 0; k < 2; k++) {
            double z = 1 + (k == near ? 0 : 2 * gap);
            corners[k][0] = vec3(-4, -3, z), corners[k][1] = vec3(4, -3, z), corners[k][2] = vec3(0, 5, z);
            layers[k] = (Mesh){.vertices = corners[k], .nvertices = 3, .faces = &face, .nfaces = 1};
            primitives[k] = shape(&shape_mesh, transform_identity());
            primitives[k].shape.mesh = &layers[k];
        }
        primitives[2] = shape(&shape_disc, transform_translate(vec3(0, 0, 1 + gap)));
        primitives[2].shape.r0 = 4, primitives[2].shape.r1 = 0;
        Accel *accel = create(&scene, primitives, 3);
        for (int i = 0; i < 200; i++) {
            Ray ray = {vec3(uniform() - 0.5, uniform() - 0.5, 0.2 * uniform()), {0, 0, 1}, 0, INFINITY};
            Hit hit;
            ray.direction = vec_normalize(vec3(0.2 * uniform(), 0.2 * uniform(), 1));
            assert_true(accel_intersect(accel, &ray, RAY_CAMERA, &hit));
            assert_int_equal(hit.primitive, near);
        }
        accel_close(&accel);
    }
}

/* ---- against every triangle ---- */

/* Distance, or infinity; *edge: how near the ray passes to the triangle's edge, in barycentrics. */
static double meet(Vec3 a, Vec3 b, Vec3 c, const Ray *ray, double *edge)
{
    Vec3 e = vec_sub(b, a), f = vec_sub(c, a), p = vec_cross(ray->direction, f), o = vec_sub(ray->origin, a), q;
    double det = vec_dot(e, p), u, v, t;

    if (det == 0)
        return INFINITY;
    q = vec_cross(o, e);
    u = vec_dot(o, p) / det;
    v = vec_dot(ray->direction, q) / det;
    t = vec_dot(f, q) / det;
    *edge = fmin(u, fmin(v, 1 - u - v));
    return *edge >= 0 && t > ray->tmin && t < ray->tmax ? t : INFINITY;
}

static double meet_mesh(const Primitive *p, const Ray *ray, int *face, int *doubtful)
{
    double best = INFINITY;

    for (int i = 0; i < p->shape.mesh->nfaces; i++) {
        const int *v = p->shape.mesh->faces[i].vertex;
        Vec3 corner[3];
        double edge = -1, t;
        for (int k = 0; k < 3; k++)
            corner[k] = transform_point(&p->transform, p->shape.mesh->vertices[v[k]]);
        t = meet(corner[0], corner[1], corner[2], ray, &edge);
        if (fabs(edge) < 1e-4)
            *doubtful = 1;
        if (t < best) {
            best = t;
            *face = i;
        }
    }
    return best;
}

static void agrees_with_every_triangle(void **state)
{
    Mesh mesh = ball(12, 16, 0.3);
    Transform t = transform_then(transform_scale(vec3(1, 2, -0.5)), transform_rotate(vec3(20, 40, 60)));
    Primitive p = shape(&shape_mesh, transform_then(t, transform_translate(vec3(3, -2, 1))));
    Scene scene;
    Accel *accel;
    int checked = 0;

    (void)state;
    p.shape.mesh = &mesh;
    accel = create(&scene, &p, 1);
    for (int i = 0; i < 5000; i++) {
        Ray ray = {vec_mad(vec3(3, -2, 1), direction(), 3 * uniform()), direction(), 0, INFINITY};
        int face = -1, doubtful = 0, found;
        double expected = meet_mesh(&p, &ray, &face, &doubtful);
        Hit hit;
        Surface s;
        if (doubtful)
            continue;
        found = accel_intersect(accel, &ray, RAY_CAMERA, &hit);
        assert_int_equal(found, isfinite(expected));
        assert_int_equal(accel_occluded(accel, &ray, RAY_SHADOW, 0), found);
        if (!found)
            continue;
        checked++;
        assert_int_equal(hit.primitive, 0);
        assert_int_equal(hit.face, face);
        assert_true(fabs(hit.t - expected) < 1e-12 * (1 + expected));
        surface_at(&s, &scene, &ray, &hit);
        assert_true(vec_length(vec_sub(s.position, vec_mad(ray.origin, ray.direction, expected))) < 1e-6);
        ray.tmax = hit.t;
        assert_false(accel_occluded(accel, &ray, RAY_SHADOW, 0));
        ray.tmax = hit.t * (1 + 1e-12);
        assert_true(accel_occluded(accel, &ray, RAY_SHADOW, 0));
        ray.tmin = hit.t;
        ray.tmax = INFINITY;
        assert_true(!accel_intersect(accel, &ray, RAY_CAMERA, &hit) || hit.t > ray.tmin);
    }
    assert_true(checked > 1000);
    accel_close(&accel);
    free_mesh(&mesh);
}

/* ---- leaks ---- */

/* From inside a closed mesh no ray gets out, not even one aimed at an edge. */
static void closed_meshes_are_tight(void **state)
{
    const double shifts[] = {0, 10, 1000};
    Mesh mesh = ball(200, 300, 0.1);

    (void)state;
    for (int k = 0; k < 3; k++) {
        Vec3 shift = vec_scale(vec3(0.3, -0.5, 0.8), shifts[k]);
        Primitive p = shape(&shape_mesh, transform_translate(shift));
        Scene scene;
        Accel *accel;
        long leaks = 0;
        p.shape.mesh = &mesh;
        accel = create(&scene, &p, 1);
        for (int i = 0; i < 300000; i++) {
            /* Rays at single vertices may still slip through (Embree: 7 in 1000); no random ray ever is one. */
            double at = i % 3 == 0 ? 0.5 : 0.01 + 0.98 * uniform();
            Ray ray = {vec_mad(shift, direction(), 0.5 * uniform()), direction(), 0, INFINITY};
            const int *v = mesh.faces[(int)(uniform() * mesh.nfaces)].vertex;
            Hit hit;
            if (i % 3 < 2) {
                Vec3 aim = vec_add(vec_scale(mesh.vertices[v[0]], 1 - at), vec_scale(mesh.vertices[v[1]], at));
                ray.direction = vec_normalize(vec_sub(vec_add(aim, shift), ray.origin));
            }
            leaks += !accel_intersect(accel, &ray, RAY_BOUNCE, &hit);
            leaks += !accel_occluded(accel, &ray, RAY_SHADOW, 0);
        }
        assert_int_equal(leaks, 0);
        accel_close(&accel);
    }
    free_mesh(&mesh);
}

/* ---- leaving surfaces ---- */

/* A ray that grazes away from where another one met the scene: outside a convex shape it meets nothing, a flat face it
 * does not meet again, and a hollow one at the end of a chord at the soonest. */
static void check_leaving(Accel *accel, const Scene *scene, Vec3 from, double size)
{
    Ray ray = {from, direction(), 0, INFINITY};
    Hit hit, again;
    Surface s;
    Vec3 e, f;
    double angle = 2 * PI * uniform(), slope = pow(10, -6 * uniform());

    if (!accel_intersect(accel, &ray, RAY_BOUNCE, &hit))
        return;
    surface_at(&s, scene, &ray, &hit);
    vec_frame(s.geometric_normal, &e, &f);
    ray.direction = vec_add(vec_scale(e, cos(angle)), vec_scale(f, sin(angle)));
    ray.direction = vec_normalize(vec_mad(ray.direction, s.geometric_normal, s.backside ? -slope : slope));
    ray.origin = accel_offset(s.position, s.geometric_normal, ray.direction);
    if (accel_intersect(accel, &ray, RAY_BOUNCE, &again)) {
        /* in float, what leaves a box's face at less than this may meet the next face at the edge */
        assert_true(s.backside || s.primitive->shape.ops == &shape_torus || slope < 1e-4);
        assert_true(again.face != hit.face || s.primitive->shape.ops != &shape_box);
        assert_true(again.face != hit.face || again.t > 0.02 * slope * size);
    } else {
        assert_false(accel_occluded(accel, &ray, RAY_SHADOW, 0));
    }
}

static void no_self_intersection(void **state)
{
    const double scales[] = {1e-4, 1e-2, 1, 100, 1e4};

    (void)state;
    for (int k = 0; k < 5; k++) {
        double size = scales[k];
        Transform t = transform_then(transform_scale(vec3(size, size, size)), transform_rotate(vec3(31, 17, 5)));
        for (int far = 0; far < 2; far++) {
            Vec3 centre = vec_scale(vec3(2, 3, -1), far ? fmin(size * 100, 1e4) : size);
            Transform placed = transform_then(t, transform_translate(centre));
            Primitive p[4] = {shape(&shape_box, placed), shape(&shape_sphere, placed), shape(&shape_cone, placed),
                              shape(&shape_torus, placed)};
            for (int i = 0; i < 4; i++) {
                Scene scene;
                Accel *accel = create(&scene, &p[i], 1);
                for (int n = 0; n < 3000; n++) {
                    Vec3 out = vec_mad(centre, direction(), size * 2.5);
                    check_leaving(accel, &scene, n % 2 ? transform_point(&placed, vec3(0.5, 0.2, 0.5)) : out, size);
                }
                accel_close(&accel);
            }
        }
    }
}

/* The floor of a room of boxes, seen from lamps inside: no ray upwards from it meets the floor, none escapes. */
static void rooms_do_not_leak(void **state)
{
    const double sizes[] = {1e-3, 5, 1e4};

    (void)state;
    for (int k = 0; k < 3; k++) {
        double size = sizes[k];
        Transform whole = transform_then(transform_scale(vec3(size, size, size)), transform_rotate(vec3(3, 20, 0)));
        Primitive p[6];
        Scene scene;
        Accel *accel;
        for (int i = 0; i < 6; i++) {
            Vec3 at = {i / 2 == 0, i / 2 == 1, i / 2 == 2},
                 scale = {i / 2 == 0 ? 0.1 : 1, i / 2 == 1 ? 0.1 : 1, i / 2 == 2 ? 0.1 : 1};
            Transform wall =
                transform_then(transform_scale(scale), transform_translate(vec_scale(at, i % 2 ? 1 : -0.1)));
            p[i] = shape(&shape_box, transform_then(wall, whole));
        }
        accel = create(&scene, p, 6);
        for (int n = 0; n < 100000; n++) {
            Ray ray = {transform_point(&whole, vec3(uniform(), uniform(), uniform())), direction(), 0, INFINITY};
            Hit hit;
            Surface s;
            assert_true(accel_intersect(accel, &ray, RAY_BOUNCE, &hit));
            surface_at(&s, &scene, &ray, &hit);
            ray.direction = direction();
            if (vec_dot(ray.direction, s.geometric_normal) < 0)
                ray.direction = vec_neg(ray.direction);
            ray.origin = accel_offset(s.position, s.geometric_normal, ray.direction);
            assert_true(accel_intersect(accel, &ray, RAY_BOUNCE, &hit));
            assert_ptr_not_equal(&p[hit.primitive], s.primitive);
        }
        accel_close(&accel);
    }
}

/* ---- visibility, planes, bounds ---- */

static void rays_see_what_they_may(void **state)
{
    Transform ahead[4];
    Primitive p[4];
    Scene scene;
    Accel *accel;
    Ray ray = {{0, 0.1, 0}, {0, 0, 1}, 0, INFINITY};
    Hit hit;
    Vec3 low, high;

    (void)state;
    for (int i = 0; i < 4; i++)
        ahead[i] = transform_translate(vec3(i == 0 ? -0.5 : 0, i == 0 ? -0.5 : 0, 2.0 + 3 * i));
    p[0] = shape(&shape_box, ahead[0]);                                                      /* at 2 */
    p[1] = shape(&shape_sphere, ahead[1]);                                                   /* at 4 */
    p[2] = shape(&shape_disc, ahead[2]);                                                     /* at 8 but for its hole */
    p[3] = shape(&shape_plane, transform_then(transform_rotate(vec3(-90, 0, 0)), ahead[3])); /* at 11 */
    p[0].no_image = p[1].no_shadow = p[3].no_reflection = 1;
    p[2].shape.r1 = 0;
    p[2].texture = &clear;
    accel = create(&scene, p, 4);
    assert_true(accel_intersect(accel, &ray, RAY_CAMERA, &hit) && hit.primitive == 1 &&
                fabs(hit.t - 5 + sqrt(0.99)) < 1e-12);
    assert_true(accel_intersect(accel, &ray, RAY_BOUNCE, &hit) && hit.primitive == 0 && hit.face == 4 && hit.t == 2);
    ray.origin.z = 3.5;
    assert_true(accel_intersect(accel, &ray, RAY_SHADOW, &hit) && hit.primitive == 2 && hit.t == 4.5);
    ray.tmax = 5;
    assert_true(accel_occluded(accel, &ray, RAY_SHADOW, 0));
    assert_false(accel_occluded(accel, &ray, RAY_SHADOW, 1));
    assert_int_equal(accel_visibility(accel, &ray, 0), VISIBILITY_TRANSPARENT);
    ray.tmax = INFINITY;
    assert_true(accel_occluded(accel, &ray, RAY_SHADOW, 1));
    assert_int_equal(accel_visibility(accel, &ray, 0), VISIBILITY_BLOCKED);
    ray.origin.z = 9;
    assert_true(accel_intersect(accel, &ray, RAY_CAMERA, &hit) && hit.primitive == 3 && fabs(hit.t - 2) < 1e-15);
    assert_false(accel_intersect(accel, &ray, RAY_BOUNCE, &hit));
    assert_int_equal(hit.primitive, -1);
    accel_bounds(accel, scene.camera.location, &low, &high);
    assert_true(low.x == -1 && high.z == 8 && low.z == 0);
    accel_close(&accel);
    accel_close(&accel);
    accel = create(&scene, p, 0);
    assert_false(accel_intersect(accel, &ray, RAY_CAMERA, &hit));
    accel_close(&accel);
}

static void bad_geometry(void **state)
{
    Vec3 vertices[5] = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {2, 2, 2}, {0, 0, 1}};
    MeshFace faces[3] = {{{0, 1, 1}, {-1, -1, -1}, {-1, -1, -1}, -1},
                         {{0, 1, 2}, {-1, -1, -1}, {-1, -1, -1}, -1},
                         {{0, 4, 2}, {-1, -1, -1}, {-1, -1, -1}, -1}};
    Mesh mesh = {.nvertices = 5, .nfaces = 3, .vertices = vertices, .faces = faces};
    Primitive p = shape(&shape_mesh, transform_identity());
    Scene scene;
    Accel *accel;
    RetexError err = {0};
    Ray ray = {{0.2, 0.2, 0}, {0, 0, 1}, 0, INFINITY};
    Hit hit;

    (void)state;
    p.shape.mesh = &mesh;
    accel = create(&scene, &p, 1);
    assert_true(accel_intersect(accel, &ray, RAY_CAMERA, &hit) && hit.face == 1 && hit.t == 1);
    accel_close(&accel);
    vertices[3].y = NAN;
    assert_int_equal(accel_create(&accel, &scene, 1, &err), RETEX_EINVAL);
    assert_int_equal(err.line, 7);
    assert_null(accel);
    vertices[3].y = 1e30;
    assert_int_equal(accel_create(&accel, &scene, 1, NULL), RETEX_EINVAL);
    mesh.nfaces = 0;
    assert_int_equal(accel_create(&accel, &scene, 1, &err), 0);
    assert_false(accel_intersect(accel, &ray, RAY_CAMERA, &hit));
    accel_close(&accel);
}

/* Embree's own checks may stop the program over these. */
static void bad_rays(void **state)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e30};
    Primitive p = shape(&shape_sphere, transform_identity());
    Scene scene;
    Accel *accel = create(&scene, &p, 1);
    Hit hit;

    (void)state;
    for (int i = 0; i < 4; i++) {
        Ray origin = {{bad[i], 0, 0}, {0, 0, 1}, 0, INFINITY}, direction = {{0, 0, -3}, {0, bad[i], 1}, 0, INFINITY};
        assert_false(accel_intersect(accel, &origin, RAY_CAMERA, &hit));
        assert_int_equal(hit.primitive, -1);
        assert_false(accel_occluded(accel, &origin, RAY_SHADOW, 0));
        assert_false(accel_intersect(accel, &direction, RAY_CAMERA, &hit));
        assert_false(accel_occluded(accel, &direction, RAY_SHADOW, 0));
    }
    accel_close(&accel);
}

/* The kernels over lanes have the same bits at every level of vectors. */
static void lanes_are_the_same_at_every_level(void **state)
{
    static const double odd[] = {0, 1, -1, 1e-300, 1e17, 1e19, -1e300, INFINITY, NAN};
    enum { ODD = sizeof odd / sizeof *odd };
    (void)state;
    for (int n = 0; n < 3000; n++) {
        Ray rays[ACCEL_PACKET];
        LaneRays lanes, lanes_plain;
        LaneTriangles found = {.offset = {0}}, found_plain;
        struct RTCRay16 to, to_plain;
        int valid[ACCEL_PACKET], valid_plain[ACCEL_PACKET];
        for (int i = 0; i < ACCEL_PACKET; i++) {
            rays[i] = (Ray){vec_scale(direction(), 4 * uniform()), direction(), uniform() - 0.5, 3 * uniform()};
            double *number = &rays[i].origin.x + (size_t)(8 * uniform());
            if (uniform() < 0.1)
                *number = odd[(size_t)(ODD * uniform())];
            for (int k = 0; k < 3; k++)
                found.normal[k][i] = uniform() - 0.5;
            found.offset[i] = uniform() < 0.1 ? 0 : 4 * uniform() - 2;
        }
        memset(&lanes, 0, sizeof lanes);
        lanes_take(&lanes, rays, 1 + n % ACCEL_PACKET);
        lanes_plain = lanes;
        lanes_start(&lanes, 3, &to, valid), lanes_start_plain(&lanes_plain, 3, &to_plain, valid_plain);
        assert_memory_equal(&lanes, &lanes_plain, sizeof lanes);
        assert_memory_equal(&to, &to_plain, sizeof to);
        assert_memory_equal(valid, valid_plain, sizeof valid);
        found_plain = found;
        lanes_refine(&lanes, &found);
        for (int i = 0; i < ACCEL_PACKET; i++) /* near what Embree would report */
            found.reported[i] = (float)(found.t[i] * (1 + (uniform() - 0.5) * 4e-6));
        memcpy(found_plain.reported, found.reported, sizeof found.reported);
        lanes_refine(&lanes, &found), lanes_refine_plain(&lanes, &found_plain);
        for (int i = 0; i < ACCEL_PACKET; i++) { /* the sign of a NaN is no bit that counts */
            assert_true(found.t[i] == found_plain.t[i] || (isnan(found.t[i]) && isnan(found_plain.t[i])));
            assert_int_equal(found.sure[i], found_plain.sure[i]);
        }
    }
}

/* Packets of any number find what single rays find: triangles, curved shapes, planes, nothing, rays that are none. */
static void packets_are_single_rays(void **state)
{
    Mesh mesh = ball(12, 16, 0.3);
    Primitive p[4] = {shape(&shape_mesh, transform_translate(vec3(-1.5, 0, 0))),
                      shape(&shape_sphere, transform_translate(vec3(1.5, 0, 0))),
                      shape(&shape_box, transform_translate(vec3(0, 1, 0))),
                      shape(&shape_plane, transform_translate(vec3(0, -2, 0)))};
    Scene scene;
    Accel *accel;
    int met = 0, passable = 0;

    (void)state;
    p[0].shape.mesh = &mesh;
    p[0].no_image = p[2].no_reflection = 1;
    p[1].texture = &clear;
    accel = create(&scene, p, 4);
    for (int n = 0; n < 2000; n++) {
        Ray rays[ACCEL_PACKET];
        Hit hits[ACCEL_PACKET], hit;
        RayKind kinds[ACCEL_PACKET];
        Visibility ways[ACCEL_PACKET];
        int sources[ACCEL_PACKET], count = 1 + n % ACCEL_PACKET;
        for (int i = 0; i < count; i++)
            rays[i] = (Ray){vec_scale(direction(), 4 * uniform()), direction(), 0, i % 3 ? INFINITY : 3 * uniform()};
        if (n % 7 == 0)
            rays[0].direction.x = NAN;
        for (int i = 0; i < count; i++)
            kinds[i] = i % 2 ? RAY_CAMERA : RAY_BOUNCE, sources[i] = i % 3 == 0;
        accel_intersect_packet(accel, rays, kinds, count, n & 1, hits);
        accel_visibility_packet(accel, rays, sources, count, ways);
        for (int i = 0; i < count; i++) {
            int found = accel_intersect(accel, &rays[i], kinds[i], &hit);
            assert_int_equal(hits[i].primitive, hit.primitive);
            assert_int_equal(ways[i], accel_visibility(accel, &rays[i], sources[i]));
            passable += ways[i] == VISIBILITY_TRANSPARENT;
            assert_true(!found || (hits[i].t == hit.t && hits[i].face == hit.face));
            met += found;
        }
    }
    assert_true(met > 5000 && passable > 500);
    accel_close(&accel);
    free_mesh(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_of_equals_wins),
        cmocka_unit_test(layers_closer_than_float_keep_their_order),
        cmocka_unit_test(agrees_with_every_triangle),
        cmocka_unit_test(closed_meshes_are_tight),
        cmocka_unit_test(no_self_intersection),
        cmocka_unit_test(rooms_do_not_leak),
        cmocka_unit_test(rays_see_what_they_may),
        cmocka_unit_test(bad_geometry),
        cmocka_unit_test(bad_rays),
        cmocka_unit_test(packets_are_single_rays),
        cmocka_unit_test(lanes_are_the_same_at_every_level),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
