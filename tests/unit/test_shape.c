/* Shapes: intersections are compared with marching along the implicit equation, points and UVs with values measured in
 * POV-Ray, and densities with areas. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <string.h>
#include <cmocka.h>
#include "shape/shape.h"
#include "shape/surface.h"

static uint64_t seed = 1;

static double uniform(void)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11) * 0x1p-53;
}

static double between(double low, double high)
{
    return low + (high - low) * uniform();
}

static Vec3 direction(void)
{
    double z = between(-1, 1), angle = between(0, 2 * PI), rho = sqrt(1 - z * z);

    return vec3(rho * cos(angle), rho * sin(angle), z);
}

static Transform random_transform(double scale, double shift, int even)
{
    double s = scale * between(0.5, 2);
    Vec3 factor =
        even ? vec3(s, s, s) : vec3(scale * between(0.3, 3), -scale * between(0.3, 3), scale * between(0.3, 3));
    Transform t = transform_then(transform_scale(factor), transform_rotate(vec_scale(direction(), 180)));

    return transform_then(t, transform_translate(vec_scale(direction(), shift)));
}

static Primitive shape(const ShapeOps *ops, double r0, double r1, Transform transform)
{
    static Texture texture;
    Primitive p = {.shape = {.ops = ops, .r0 = r0, .r1 = r1}, .transform = transform, .texture = &texture, .target = 3};

    return p;
}

static Surface surface_of(const Primitive *p, const Ray *ray, double t, int face)
{
    Scene scene = {.primitives = (Primitive *)p, .nprimitives = 1};
    Hit hit = {.t = t, .face = face};
    Surface s;

    if (p->shape.ops->face_normal)
        hit.normal = p->shape.ops->face_normal(p, face, NULL);
    surface_at(&s, &scene, ray, &hit);
    return s;
}

/* ---- intersections ---- */

/* Negative inside, positive outside, near a distance, in canonical space. */
static double implicit(const Primitive *p, Vec3 q)
{
    double rho, side, slope = p->shape.r1 - p->shape.r0;

    if (p->shape.ops == &shape_sphere)
        return vec_length(q) - 1;
    if (p->shape.ops == &shape_cone) {
        side = (hypot(q.x, q.y) - p->shape.r0 - slope * q.z) / sqrt(1 + slope * slope);
        return fmax(side, fmax(-q.z, q.z - 1));
    }
    if (p->shape.ops == &shape_torus) {
        rho = hypot(q.x, q.z);
        return hypot(rho - p->shape.r0, q.y) - p->shape.r1;
    }
    return q.y;
}

/* The first crossing of the surface by marching; -1 for none. *doubtful: the ray came too near to tell. */
static double march(const Primitive *p, const Ray *ray, double end, int *doubtful)
{
    Vec3 o = transform_inverse_point(&p->transform, ray->origin);
    Vec3 d = transform_inverse_vector(&p->transform, ray->direction);
    const int steps = 4000;
    double reach = vec_length(d) * end / steps, before = implicit(p, o);

    *doubtful = 0;
    for (int i = 1; i <= steps; i++) {
        double now = implicit(p, vec_mad(o, d, end * i / steps));
        if ((before > 0) != (now > 0))
            return end * (i - 0.5) / steps;
        if (fabs(now) < reach)
            *doubtful = 1;
        before = now;
    }
    return -1;
}

static void check_against_march(Primitive p, double size)
{
    Vec3 low, high;
    int hits = 0;

    assert_true(shape_bounds(&p, &low, &high) || p.shape.ops == &shape_plane);
    for (int i = 0; i < 300; i++) {
        Vec3 centre = transform_point(&p.transform, vec3(0, 0, 0)),
             aim = vec_mad(centre, direction(), size * uniform());
        Ray ray = {vec_mad(centre, direction(), size * between(0.1, 4)), {0, 0, 0}, 0, 12 * size};
        double t, expected;
        int face, found, doubtful;
        ray.direction = vec_normalize(vec_sub(aim, ray.origin));
        expected = march(&p, &ray, 12 * size, &doubtful);
        found = shape_intersect(&p, &ray, &t, &face);
        if (found) {
            Surface s = surface_of(&p, &ray, t, face);
            Vec3 at = vec_mad(ray.origin, ray.direction, t);
            assert_true(fabs(implicit(&p, transform_inverse_point(&p.transform, at))) < 1e-11);
            assert_true(vec_length(vec_sub(s.position, at)) < 1e-10 * size);
            if (p.shape.ops != &shape_plane)
                assert_true(at.x > low.x - 1e-9 * size && at.y > low.y - 1e-9 * size && at.z > low.z - 1e-9 * size &&
                            at.x < high.x + 1e-9 * size && at.y < high.y + 1e-9 * size && at.z < high.z + 1e-9 * size);
            /* the normal looks where the implicit function grows */
            assert_true(implicit(&p, transform_inverse_point(
                                         &p.transform, vec_mad(s.position, s.geometric_normal, 1e-6 * size))) > 0);
            assert_int_equal(s.backside, vec_dot(ray.direction, s.geometric_normal) > 0);
            hits++;
        }
        if (doubtful)
            continue;
        assert_int_equal(found, expected >= 0);
        if (found)
            assert_true(fabs(t - expected) < 12 * size / 4000);
    }
    assert_true(hits > 15);
}

static void intersections_match_marching(void **state)
{
    const double tubes[] = {0.05, 0.4, 0.9};

    (void)state;
    for (int i = 0; i < 4; i++) {
        double size = i < 2 ? 1 : 1e-3;
        Transform t = random_transform(size / 3, size, 0);
        check_against_march(shape(&shape_sphere, 0, 0, t), size);
        check_against_march(shape(&shape_cone, 0.7, 0.7, t), size);
        check_against_march(shape(&shape_cone, 0.9, 0.2, t), size);
        check_against_march(shape(&shape_cone, 0, 1, t), size);
        check_against_march(shape(&shape_plane, 0, 0, t), size);
        for (int k = 0; k < 3; k++)
            check_against_march(shape(&shape_torus, 1, tubes[k], t), size);
    }
}

/* Rays that leave a closed shape outward, also along the surface, must not meet a convex one; into it they must meet it
 * on the other side. At all scales, far from the origin and near it. */
static void no_self_intersection(void **state)
{
    const ShapeOps *const kinds[] = {&shape_sphere, &shape_cone, &shape_cone, &shape_torus};
    const double low[] = {0, 0.8, 1, 1}, high[] = {0, 0.8, 0, 0.3};
    const double scales[] = {1e-4, 1e-2, 1, 1e2, 1e4};

    (void)state;
    for (int i = 0; i < 20000; i++) {
        int kind = i % 4;
        double scale = scales[i / 4 % 5];
        Primitive p =
            shape(kinds[kind], low[kind], high[kind], random_transform(scale, fmin(100 * scale, 1e4), i % 3 > 0));
        Vec3 centre = transform_point(&p.transform, vec3(kind == 3 ? 1 : 0, 0, kind == 1 || kind == 2 ? 0.3 : 0));
        Ray ray = {centre, direction(), 0, INFINITY};
        double t, tangent, slope = pow(10, -7 * uniform());
        int face;
        Surface s;
        Vec3 e, f;
        assert_true(shape_intersect(&p, &ray, &t, &face));
        s = surface_of(&p, &ray, t, face);
        vec_frame(s.geometric_normal, &e, &f);
        tangent = between(0, 2 * PI);
        ray.direction = vec_add(vec_scale(e, cos(tangent)), vec_scale(f, sin(tangent)));
        ray.direction = vec_normalize(vec_mad(ray.direction, s.geometric_normal, slope));
        ray.origin = s.position;
        if (kind < 3) {
            assert_false(shape_intersect(&p, &ray, &t, &face));
        } else if (shape_intersect(&p, &ray, &t, &face)) {
            assert_true(t > 0.02 * slope * scale); /* across the hole, or along its hollow side */
        }
        ray.direction = vec_normalize(vec_sub(vec_scale(direction(), 0.9), s.geometric_normal));
        if (shape_intersect(&p, &ray, &t, &face))
            assert_true(t > 1e-4 * scale);
        else
            assert_true(kind == 2); /* at the rim of the cone */
    }
}

static void discs_and_open_cones(void **state)
{
    Primitive disc = shape(&shape_disc, 2, 1, transform_identity()),
              tube = shape(&shape_cone, 1, 1, transform_identity());
    Ray ray = {{1.5, 0, -3}, {0, 0, 1}, 0, INFINITY}, along = {{0.2, 0, -3}, {0, 0, 1}, 0, INFINITY};
    double t;
    int face;

    (void)state;
    assert_true(shape_intersect(&disc, &ray, &t, &face) && t == 3);
    assert_false(shape_intersect(&disc, &along, &t, &face));
    assert_true(shape_intersect(&tube, &along, &t, &face) && t == 3 && face == 1);
    along.tmin = 3;
    assert_true(shape_intersect(&tube, &along, &t, &face) && t == 4 && face == 2);
    tube.shape.open = 1;
    assert_false(shape_intersect(&tube, &along, &t, &face));
    ray = (Ray){{0, 0, 0.5}, {1, 0, 0}, 0, INFINITY};
    assert_true(shape_intersect(&tube, &ray, &t, &face) && t == 1 && face == 0);
    ray.tmax = 1;
    assert_false(shape_intersect(&tube, &ray, &t, &face));
}

/* ---- points ---- */

static void assert_uv(Vec2 uv, double u, double v)
{
    assert_true(fabs(uv.u - u) < 1e-3);
    assert_true(fabs(uv.v - v) < 1e-3);
}

static SurfaceUv uv_of(Surface s)
{
    return surface_uv(&s);
}

static Surface box_surface(int face, Vec3 at)
{
    static Primitive box; /* surfaces point to it */
    Vec3 out = {face / 2 == 0, face / 2 == 1, face / 2 == 2};
    Ray ray;

    box =
        shape(&shape_box, 0, 0, transform_then(transform_scale(vec3(2, 2, 2)), transform_translate(vec3(-1, -1, -1))));
    out = vec_scale(out, face & 1 ? 1 : -1);
    ray = (Ray){vec_mad(at, out, 5), vec_neg(out), 0, INFINITY};
    return surface_of(&box, &ray, 5, face);
}

/* The UVs are POV-Ray's own pixels at these points. */
static void uv_is_povray(void **state)
{
    Primitive sphere = shape(&shape_sphere, 0, 0, transform_identity()),
              torus = shape(&shape_torus, 1, 0.4, transform_rotate(vec3(-60, 0, 0)));
    Primitive disc = shape(&shape_disc, 1, 0, transform_translate(vec3(0.25, 0, 0)));
    Ray ray = {{-0.0375, -0.0375, -5}, {0, 0, 1}, 0, INFINITY};
    double t;
    int face;

    (void)state;
    assert_uv(uv_of(box_surface(0, vec3(-1, 0.85, 0.85))).uv, 0.231, 0.642);
    assert_uv(uv_of(box_surface(1, vec3(1, 0.85, -0.85))).uv, 0.731, 0.642);
    assert_uv(uv_of(box_surface(2, vec3(-0.85, -1, -0.85))).uv, 0.269, 0.025);
    assert_uv(uv_of(box_surface(3, vec3(-0.85, 1, 0.85))).uv, 0.269, 0.692);
    assert_uv(uv_of(box_surface(4, vec3(-0.85, 0.85, -1))).uv, 0.981, 0.642);
    assert_uv(uv_of(box_surface(5, vec3(0.85, 0.85, 1))).uv, 0.481, 0.642);
    assert_uv(uv_of(box_surface(4, vec3(-0.5, 0.5, -1))).natural, 0.25, 0.75);
    assert_true(shape_intersect(&sphere, &ray, &t, &face));
    assert_uv(uv_of(surface_of(&sphere, &ray, t, face)).uv, 0.744, 0.488);
    ray.origin = vec3(-0.8625, 0.8625, -5);
    assert_true(shape_intersect(&torus, &ray, &t, &face));
    assert_uv(uv_of(surface_of(&torus, &ray, t, face)).uv, 0.118, 0.681);
    ray.origin = vec3(0.9375, -0.9375, -5);
    assert_true(shape_intersect(&torus, &ray, &t, &face));
    assert_uv(uv_of(surface_of(&torus, &ray, t, face)).uv, 0.632, 0.455);
    ray.origin = vec3(0.5, 0.1, -5);
    assert_true(shape_intersect(&disc, &ray, &t, &face));
    assert_uv(uv_of(surface_of(&disc, &ray, t, face)).uv, 0.5, 0.1);
    assert_uv(uv_of(surface_of(&disc, &ray, t, face)).natural, 0.625, 0.55);
}

/* Each face of the box is upright and unmirrored, seen from outside in left-handed coordinates, with y up; the bottom
 * and the top unfold from the -z face. */
static void box_faces_are_upright(void **state)
{
    (void)state;
    for (int face = 0; face < 6; face++) {
        Vec3 out = vec_scale(vec3(face / 2 == 0, face / 2 == 1, face / 2 == 2), face & 1 ? 1 : -1);
        Vec3 up = face == 2 ? vec3(0, 0, -1) : face == 3 ? vec3(0, 0, 1) : vec3(0, 1, 0);
        Vec3 right = vec_cross(up, vec_neg(out));
        Vec3 at = vec_add(out, vec_add(vec_scale(right, -0.4), vec_scale(up, 0.7)));
        assert_uv(uv_of(box_surface(face, at)).natural, 0.3, 0.85);
    }
}

/* Caps have the unit square round their own circle; the side has its angle and its height. */
static void cone_has_uv_on_all_faces(void **state)
{
    Primitive cone = shape(&shape_cone, 2, 1, transform_identity());
    Ray up = {{0.5, -0.25, -5}, {0, 0, 1}, 0, INFINITY}, down = {{0.5, -0.25, 5}, {0, 0, -1}, 0, INFINITY},
        side = {{0, 5, 0.25}, {0, -1, 0}, 0, INFINITY};
    double t;
    int face;

    (void)state;
    assert_true(shape_intersect(&cone, &up, &t, &face) && face == 1);
    assert_uv(uv_of(surface_of(&cone, &up, t, face)).natural, 0.625, 0.4375);
    assert_true(shape_intersect(&cone, &down, &t, &face) && face == 2);
    assert_uv(uv_of(surface_of(&cone, &down, t, face)).natural, 0.75, 0.375);
    assert_true(shape_intersect(&cone, &side, &t, &face) && face == 0);
    assert_uv(uv_of(surface_of(&cone, &side, t, face)).natural, 0.25, 0.25);
}

/* From behind a surface has its interior texture and the target of that. */
static void interior_has_its_own_target(void **state)
{
    Primitive sphere = shape(&shape_sphere, 0, 0, transform_identity());
    Texture inner = {0};
    Ray in = {{0, 0, -5}, {0, 0, 1}, 0, INFINITY}, out = {{0, 0, 0}, {0, 0, 1}, 0, INFINITY};

    (void)state;
    sphere.interior_texture = &inner;
    sphere.interior_target = 7;
    Surface front = surface_of(&sphere, &in, 4, 0), back = surface_of(&sphere, &out, 1, 0);
    assert_true(!front.backside && front.texture == sphere.texture && front.target == 3);
    assert_true(back.backside && back.texture == &inner && back.target == 7);
}

static void box_points_lie_on_faces(void **state)
{
    Surface s = box_surface(1, vec3(1, 0.4, 0.5));
    ShapeTriangles box;

    (void)state;
    shape_box.triangles(NULL, &box);
    assert_int_equal(box.ntriangles, 12);
    assert_true(s.position.x == 1 && fabs(s.position.y - 0.4) < 1e-15 && s.geometric_normal.x == 1 && s.target == 3);
    for (int i = 0; i < 12; i++) {
        const int *k = box.corners + (size_t)i * box.stride;
        const Vec3 *v = box.vertices;
        Vec3 n = vec_cross(vec_sub(v[k[1]], v[k[0]]), vec_sub(v[k[2]], v[k[0]]));
        Surface face = box_surface(i / box.per_face, vec3(0, 0, 0));
        assert_true(vec_dot(n, face.geometric_normal) == 1);
    }
}

static Surface mesh_surface(const Primitive *p, Hit hit, const Ray *ray)
{
    Scene scene = {.primitives = (Primitive *)p, .nprimitives = 1};
    const int *vertex = p->shape.mesh->faces[hit.face].vertex;
    Vec3 corner[3];
    Surface s;

    for (int k = 0; k < 3; k++)
        corner[k] = transform_point(&p->transform, p->shape.mesh->vertices[vertex[k]]);
    hit.normal = p->shape.ops->face_normal(p, hit.face, corner);
    surface_at(&s, &scene, ray, &hit);
    return s;
}

static void mesh_normals(void **state)
{
    Vec3 vertices[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, normals[3] = {{0.1, 0, -1}, {0, 0, -1}, {0, 0, 0}};
    Vec2 uvs[3] = {{0, 0}, {2, 0}, {0, 3}};
    MeshFace faces[4] = {{{0, 1, 2}, {0, 1, 1}, {0, 1, 2}, -1},
                         {{0, 3, 1}, {-1, -1, -1}, {-1, -1, -1}, -1},
                         {{0, 2, 3}, {2, 2, 2}, {-1, -1, -1}, -1},
                         {{1, 3, 2}, {-1, -1, -1}, {-1, -1, -1}, -1}};
    Mesh mesh = {.nvertices = 4,
                 .nnormals = 3,
                 .nuvs = 3,
                 .nfaces = 4,
                 .vertices = vertices,
                 .normals = normals,
                 .uvs = uvs,
                 .faces = faces};
    Primitive p = shape(&shape_mesh, 0, 0, transform_identity());
    Ray ray = {{0.25, 0.25, -1}, {0, 0, 1}, 0, INFINITY};
    Hit hit = {.t = 1, .face = 0, .b1 = 0.25, .b2 = 0.25};
    Surface s;

    (void)state;
    p.shape.mesh = &mesh;
    mesh.inward = mesh_winds_inward(&mesh);
    assert_int_equal(mesh.inward, 1);
    s = mesh_surface(&p, hit, &ray);
    assert_true(s.geometric_normal.z == -1 && s.shading_normal.x > 0.04 && s.backside == 0 && uv_of(s).has_natural);
    assert_uv(uv_of(s).uv, 0.5, 0.75);
    hit.face = 1;
    s = mesh_surface(&p, hit, &ray);
    assert_true(s.geometric_normal.y == -1 && !uv_of(s).has_natural);
    assert_uv(uv_of(s).uv, s.position.x, s.position.y);
    hit.face = 2; /* normals of no length */
    s = mesh_surface(&p, hit, &ray);
    assert_true(fabs(s.geometric_normal.x) == 1 && fabs(s.shading_normal.x) == 1);
    p.inverse = 1;
    hit.face = 0;
    s = mesh_surface(&p, hit, &ray);
    assert_true(s.geometric_normal.z == 1 && s.backside == 1);
    mesh.nfaces = 3;
    assert_int_equal(mesh_winds_inward(&mesh), 0);
}

/* Inside a face, normals and UVs are means of the corners' by barycentric coordinates; a normal that would lie behind
 * the face is turned round. */
static void mesh_corners_are_interpolated(void **state)
{
    Vec3 vertices[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, normals[3] = {{0, 0, 1}, {0.6, 0, 0.8}, {0, 0.6, -0.8}};
    Vec2 uvs[3] = {{0.1, 0.2}, {1.1, 0.7}, {0.4, 3.2}};
    MeshFace face = {.vertex = {0, 1, 2}, .normal = {0, 1, 2}, .uv = {0, 1, 2}, .texture = -1};
    Mesh mesh = {.nvertices = 3, .nnormals = 3, .nuvs = 3, .nfaces = 1};
    Primitive p = shape(&shape_mesh, 0, 0, transform_identity());
    Ray ray = {{0.1, 0.8, 5}, {0, 0, -1}, 0, INFINITY};
    Hit hit = {.t = 5, .face = 0, .b1 = 0.1f, .b2 = 0.8f};

    (void)state;
    mesh.vertices = vertices, mesh.normals = normals, mesh.uvs = uvs, mesh.faces = &face;
    p.shape.mesh = &mesh;
    Surface s = mesh_surface(&p, hit, &ray);
    assert_true(s.geometric_normal.z == 1);
    Vec3 mean = vec_neg(vec_normalize(vec3(0.06, 0.48, 0.1 + 0.08 - 0.64)));
    assert_true(mean.z > 0.5 && vec_length(vec_sub(s.shading_normal, mean)) < 1e-6);
    SurfaceUv uv = uv_of(s);
    assert_uv(uv.uv, 0.1 * 0.1 + 0.1 * 1.1 + 0.8 * 0.4, 0.1 * 0.2 + 0.1 * 0.7 + 0.8 * 3.2);
}

/* A face has the texture and the target of its number, the first one too; without a number those of the mesh. */
static void mesh_faces_have_their_targets(void **state)
{
    static const int8_t targets[2] = {5, -1};
    Texture of_face[2] = {{0}, {0}};
    const Texture *textures[2] = {&of_face[0], &of_face[1]};
    const FaceTextures own = {2, textures};
    Vec3 corners[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    Primitive p = shape(&shape_mesh, 0, 0, transform_identity());
    ShapePoint point = {.normal = {0, 0, 1}};

    (void)state;
    for (int k = -1; k < 2; k++) {
        MeshFace face = {.vertex = {0, 1, 2}, .normal = {-1, -1, -1}, .uv = {-1, -1, -1}, .texture = k};
        Mesh mesh = {.vertices = corners, .nvertices = 3, .faces = &face, .nfaces = 1};
        Surface s;
        p.shape.mesh = &mesh, p.shape.textures = &own, p.face_targets = targets;
        surface_from_point(&s, &p, 0, &point);
        assert_true(s.texture == (k < 0 ? p.texture : &of_face[k]) && s.target == (k < 0 ? 3 : targets[k]));
        p.face_targets = NULL;
        surface_from_point(&s, &p, 0, &point);
        assert_int_equal(s.target, 3);
    }
}

/* ---- sampling ---- */

static void check_sampling(Primitive p, double known_area)
{
    double area = shape_area(&p), sum = 0, squares = 0, error;
    const int n = 40000;
    Vec3 low, high;

    shape_bounds(&p, &low, &high);
    for (int i = 0; i < n; i++) {
        Surface s;
        double pdf;
        shape_sample(&p, -1, uniform(), uniform(), &s, &pdf);
        assert_true(pdf > 0);
        assert_true(fabs(shape_pdf_area(&p, &s) / pdf - 1) < 1e-9);
        assert_true(fabs(vec_length(s.geometric_normal) - 1) < 1e-12 && s.backside == 0);
        assert_true(s.position.x >= low.x - 1e-9 && s.position.y <= high.y + 1e-9 && s.position.z <= high.z + 1e-9);
        sum += 1 / pdf;
        squares += 1 / (pdf * pdf);
    }
    sum /= n;
    error = sqrt(fmax(0, squares / n - sum * sum) / n);
    assert_true(fabs(sum - area) < 5 * error + 2e-3 * area);
    if (known_area > 0)
        assert_true(fabs(area / known_area - 1) < 1e-9);
}

static void sampling_has_its_density(void **state)
{
    Transform twice = transform_then(transform_scale(vec3(-2, 2, 2)), transform_rotate(vec3(10, 20, 30)));

    (void)state;
    check_sampling(shape(&shape_sphere, 0, 0, twice), 16 * PI);
    check_sampling(shape(&shape_box, 0, 0, twice), 24);
    check_sampling(shape(&shape_box, 0, 0, transform_scale(vec3(1, 2, 3))), 22);
    check_sampling(shape(&shape_cone, 1, 1, twice), 4 * (2 * PI + 2 * PI));
    check_sampling(shape(&shape_cone, 2, 0, twice), 4 * (2 * PI * sqrt(5) + 4 * PI));
    check_sampling(shape(&shape_disc, 2, 1, twice), 12 * PI);
    check_sampling(shape(&shape_torus, 2, 0.5, twice), 4 * 4 * PI * PI);
    for (int i = 0; i < 5; i++) {
        check_sampling(shape(&shape_sphere, 0, 0, random_transform(1, 1, 0)), 0);
        check_sampling(shape(&shape_cone, 1, 0.3, random_transform(1, 1, 0)), 0);
        check_sampling(shape(&shape_disc, 1, 0.3, random_transform(1, 1, 0)), 0);
        check_sampling(shape(&shape_torus, 1, 0.4, random_transform(1, 1, 0)), 0);
        check_sampling(shape(&shape_box, 0, 0, random_transform(1, 1, 0)), 0);
    }
    assert_true(shape_area(&(Primitive){.shape.ops = &shape_plane, .transform = twice}) == 0);
    Primitive spindle = shape(&shape_torus, 1, 1.5, twice);
    assert_true(shape_area(&spindle) == 0);
}

/* Means over the surface of a function of a point of the shape, from samples weighed by their density. */
static double surface_mean(const Primitive *p, double (*of)(Vec3 at))
{
    const int n = 40000;
    double sum = 0, weights = 0;

    for (int i = 0; i < n; i++) {
        Surface s;
        double pdf;
        shape_sample(p, p->shape.mesh ? 0 : -1, uniform(), uniform(), &s, &pdf);
        sum += of(transform_inverse_point(&p->transform, s.position)) / pdf;
        weights += 1 / pdf;
    }
    return sum / weights;
}

static double x_squared(Vec3 p)
{
    return p.x * p.x;
}

static double y_squared(Vec3 p)
{
    return p.y * p.y;
}

static double height(Vec3 p)
{
    return p.z;
}

static void assert_mean(const Primitive *p, double (*of)(Vec3 at), double expected)
{
    assert_true(fabs(surface_mean(p, of) - expected) < 0.005 * (1 + expected));
}

/* Samples lie where the area is: means over the surface, by integration. */
static void samples_follow_the_area(void **state)
{
    Transform turned = transform_then(transform_scale(vec3(2, 2, 2)), transform_rotate(vec3(10, 20, 30)));
    Primitive sphere = shape(&shape_sphere, 0, 0, turned), box = shape(&shape_box, 0, 0, turned),
              disc = shape(&shape_disc, 2, 1, turned), torus = shape(&shape_torus, 2, 0.5, turned),
              cone = shape(&shape_cone, 2, 0, turned), cylinder = shape(&shape_cone, 1, 1, turned);

    (void)state;
    assert_mean(&sphere, x_squared, 1.0 / 3);
    assert_mean(&sphere, height, 0);
    assert_mean(&box, x_squared, 7.0 / 18);
    assert_mean(&box, y_squared, 7.0 / 18);
    assert_mean(&box, height, 0.5);
    assert_mean(&disc, x_squared, 1.25);
    assert_mean(&disc, y_squared, 1.25);
    assert_mean(&torus, x_squared, (4 + 1.5 * 0.25) / 2);
    assert_mean(&torus, y_squared, 0.125);
    assert_mean(&cylinder, height, 0.5);
    assert_mean(&cylinder, x_squared, (0.5 * 2 + 0.25 * 2) / 4);
    cone.shape.open = cylinder.shape.open = 1;
    assert_mean(&cone, height, 1.0 / 3);
    assert_mean(&cone, x_squared, 1);
    assert_mean(&cylinder, x_squared, 0.5);
    assert_true(fabs(shape_area(&cone) / (4 * 2 * PI * sqrt(5)) - 1) < 1e-9);
    assert_true(fabs(shape_area(&cylinder) / (4 * 2 * PI) - 1) < 1e-9);

    Vec3 corners[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    MeshFace face = {.vertex = {0, 1, 2}, .normal = {-1, -1, -1}, .uv = {-1, -1, -1}, .texture = -1};
    Mesh mesh = {.vertices = corners, .nvertices = 3, .faces = &face, .nfaces = 1};
    Primitive triangle = shape(&shape_mesh, 0, 0, turned);
    triangle.shape.mesh = &mesh;
    assert_mean(&triangle, x_squared, 1.0 / 6);
    assert_mean(&triangle, y_squared, 1.0 / 6);
}

/* The density over a grid of the surface, its patches measured by differences, adds up to 1. */
static double density_sum(const Primitive *p, int cone, int face)
{
    const int rows = 200, turns = 200;
    double sum = 0;

    for (int i = 0; i < rows; i++)
        for (int j = 0; j < turns; j++) {
            Vec3 corner[4], at;
            for (int k = 0; k < 5; k++) {
                double a = (i + (k == 4 ? 0.5 : k & 1)) / rows, b = 2 * PI * (j + (k == 4 ? 0.5 : k >> 1)) / turns, r,
                       z;
                if (cone) {
                    r = face == 0 ? p->shape.r0 + (p->shape.r1 - p->shape.r0) * a
                                  : a * (face == 1 ? p->shape.r0 : p->shape.r1);
                    z = face == 0 ? a : face - 1;
                } else {
                    r = sin(PI * a);
                    z = cos(PI * a);
                }
                at = transform_point(&p->transform, vec3(r * cos(b), r * sin(b), z));
                if (k < 4)
                    corner[k] = at;
            }
            Surface s = {.primitive = p, .face = face, .position = at};
            double area = vec_length(vec_cross(vec_sub(corner[3], corner[0]), vec_sub(corner[2], corner[1]))) / 2;
            sum += shape_pdf_area(p, &s) * area;
        }
    return sum;
}

static void densities_add_up(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        Primitive sphere = shape(&shape_sphere, 0, 0, random_transform(1, 1, 0));
        Primitive cone = shape(&shape_cone, 1, 0.2, random_transform(1, 1, 0));
        assert_true(fabs(density_sum(&sphere, 0, 0) - 1) < 1e-3);
        assert_true(fabs(density_sum(&cone, 1, 0) + density_sum(&cone, 1, 1) + density_sum(&cone, 1, 2) - 1) < 1e-3);
    }
}

/* ---- the table ---- */

/* What callers take for granted of a row. */
static void rows_are_whole(void **state)
{
    static const ShapeOps *const rows[] = {
#define X(name) &shape_##name,
        SHAPE_TABLE(X)
#undef X
    };

    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const ShapeOps *ops = rows[i];
        assert_true(ops->intersect || ops->triangles);
        assert_true(ops->bounds || (ops->intersect && !ops->triangles));
        assert_true(!ops->triangles == !ops->face_normal);
        assert_true(ops->point || (ops->triangles && ops->sample));
        assert_true(!ops->area == !ops->sample && !ops->area == !ops->density);
        for (size_t k = 0; k < i; k++)
            assert_string_not_equal(ops->name, rows[k]->name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(intersections_match_marching),
        cmocka_unit_test(no_self_intersection),
        cmocka_unit_test(discs_and_open_cones),
        cmocka_unit_test(uv_is_povray),
        cmocka_unit_test(rows_are_whole),
        cmocka_unit_test(box_faces_are_upright),
        cmocka_unit_test(cone_has_uv_on_all_faces),
        cmocka_unit_test(interior_has_its_own_target),
        cmocka_unit_test(box_points_lie_on_faces),
        cmocka_unit_test(mesh_normals),
        cmocka_unit_test(mesh_corners_are_interpolated),
        cmocka_unit_test(mesh_faces_have_their_targets),
        cmocka_unit_test(sampling_has_its_density),
        cmocka_unit_test(samples_follow_the_area),
        cmocka_unit_test(densities_add_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
