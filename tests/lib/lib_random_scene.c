/* See lib_random_scene.h. */
#include "lib_random_scene.h"
#include "lib_scene_text.h"
#include <cmocka.h>

enum { SOUP = 12 };

/* ---- random numbers ---- */

uint32_t random_state;

double random_between(double low, double high)
{
    return low + (high - low) * test_random(&random_state);
}
int random_below(int count)
{
    return (int)(test_random(&random_state) * count);
}
int random_chance(double share)
{
    return test_random(&random_state) < share;
}
double random_magnitude(double low, double high)
{
    return low * pow(high / low, test_random(&random_state));
}
Vec3 random_direction(void)
{
    double z = random_between(-1, 1), angle = random_between(0, 2 * PI), rho = sqrt(1 - z * z);

    return vec3(rho * cos(angle), rho * sin(angle), z);
}

/* ---- scenes ---- */

/* What lets light through, and which primitives that makes passable: to any light, to one that is not bent. */
static const Pigment grey = {.kind = PIGMENT_COLOR, .color = {0.5f, 0.5f, 0.5f, 0, 0}};
static const Pigment glass = {.kind = PIGMENT_COLOR, .color = {1, 1, 1, 0.9f, 0}};
static const Texture solid = {.pigment = &grey}, clear = {.pigment = &glass};
static const Interior bending = {.ior = 1.5};
static const RandomMaterial materials[] = {{&solid, NULL, NULL, 0, 0},
                                           {&solid, NULL, &bending, 0, 0},
                                           {&clear, NULL, NULL, 1, 1},
                                           {&clear, NULL, &bending, 1, 0},
                                           {&solid, &clear, &bending, 1, 1}};

static Vec3 soup_vertices[3 * SOUP], tent_vertices[5] = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, 1.5, 0}};
static MeshFace soup_faces[SOUP], tent_faces[6];
static Mesh soup = {.nvertices = 3 * SOUP, .nfaces = SOUP, .vertices = soup_vertices, .faces = soup_faces};
static Mesh tent = {.nvertices = 5, .nfaces = 6, .vertices = tent_vertices, .faces = tent_faces};

static MeshFace face_of(int a, int b, int c)
{
    return (MeshFace){{a, b, c}, {-1, -1, -1}, {-1, -1, -1}, -1};
}

static void make_meshes(void)
{
    const int corners[6][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 2, 1}, {0, 3, 2}};

    for (int i = 0; i < 6; i++)
        tent_faces[i] = face_of(corners[i][0], corners[i][1], corners[i][2]);
    for (int i = 0; i < 3 * SOUP; i++)
        soup_vertices[i] = vec_scale(random_direction(), random_between(0.2, 1.2));
    for (int i = 0; i < SOUP; i++)
        soup_faces[i] = face_of(3 * i, 3 * i + 1, 3 * i + 2);
}

/* Of about this size: even or not, sheared or not, turned, with its middle there. */
Transform random_transform(double size, Vec3 at)
{
    Transform t = transform_scale(vec3(size, size, size));

    if (random_chance(0.6))
        t = transform_scale(
            vec3(size * random_magnitude(0.1, 2), -size * random_magnitude(0.1, 2), size * random_magnitude(0.1, 2)));
    if (random_chance(0.8))
        t = transform_then(t, transform_rotate(vec_scale(random_direction(), 180)));
    if (random_chance(0.3)) {
        double shear[12] = {1,
                            random_between(-1, 1),
                            0,
                            random_between(-1, 1),
                            1,
                            0,
                            random_between(-1, 1),
                            random_between(-1, 1),
                            1,
                            0,
                            0,
                            0};
        Transform sheared;
        if (transform_matrix(shear, &sheared))
            t = transform_then(t, sheared);
    }
    return transform_then(t, transform_translate(at));
}

void random_form(Primitive *p)
{
    p->shape.r0 = p->shape.r1 = 0;
    if (p->shape.ops == &shape_cone) {
        p->shape.r0 = random_chance(0.2) ? 0 : random_between(0.1, 1.5);
        p->shape.r1 = random_chance(0.3) ? p->shape.r0 : random_chance(0.2) ? 0 : random_between(0.1, 1.5);
        p->shape.r0 = p->shape.r0 + p->shape.r1 > 0 ? p->shape.r0 : 1;
        p->shape.open = random_chance(0.4);
    } else if (p->shape.ops == &shape_torus) {
        p->shape.r0 = random_between(0.2, 1);
        p->shape.r1 =
            random_chance(0.2) ? p->shape.r0 * random_between(1, 1.5) : p->shape.r0 * random_magnitude(0.02, 1);
    } else if (p->shape.ops == &shape_disc) {
        p->shape.r0 = random_between(0.3, 1.5);
        p->shape.r1 = random_chance(0.5) ? 0 : random_between(0, p->shape.r0);
    } else if (p->shape.ops == &shape_mesh) {
        p->shape.mesh = random_chance(0.5) ? &soup : &tent;
    }
}

/* Shapes with more than numbers, as scenes write them. */
static Scene *written;

static void parse_shapes(void)
{
    written = parse(
        V37 "quadric{<1,-1,1>, <0,0.2,0>, <0,0,0.3>, -0.1} poly{3, <1,0,0,0,-3,0,0,0,0,0,0,0,0,0,0,0,0,0,-1,0>}"
            "superellipsoid{<0.3,0.6>} superellipsoid{<2.5,0.5>} ovus{0.6,0.4}"
            "lathe{cubic_spline 6, <0,-1>, <0.3,-0.8>, <1,-0.3>, <0.4,0.2>, <0.7,0.9>, <0,1.2>}"
            "prism{conic_sweep 0.2, 1, 5, <-1,-1>, <1,-0.8>, <0.2,0>, <0.5,1>, <-1,-1>}"
            "sor{5, <0.1,-1.3>, <0.8,-1>, <0.3,-0.2>, <0.9,0.5>, <0.2,1>}"
            "sphere_sweep{b_spline 5, <-2,0,0>, 0.3, <-1,1,0>, 0.2, <0,-1,1>, 0.3, <1,1,0>, 0.1, <2,0,1>, 0.3}"
            "text{ttf \"timrom.ttf\" \"B\" 0.4, 0} text{ttf \"crystal.ttf\" \"g\" 0.1, 0}"
            "blob{threshold 0.6 sphere{<-0.5,0,0>,1,1} cylinder{<0,-1,0>,<0,1,0.3>,0.5,1} sphere{<0,0,-0.5>,0.5,-1}}"
            "height_field{function 20,20{0.5+0.3*sin(9*x)*cos(7*y)} water_level 0.2}"
            "height_field{function 9,5{0.5+0.3*sin(9*x)*cos(7*y)} smooth}"
            "bicubic_patch{type 1 flatness 0.01 u_steps 2 v_steps 2 <0,0,2> <1,0,0> <2,0,0> <3,0,-2> <0,1,0> <1,1,0>"
            "<2,1,0> <3,1,0> <0,2,0> <1,2,0> <2,2,0> <3,2,0> <0,3,2> <1,3,0> <2,3,0> <3,3,-2> scale 0.4}"
            "julia_fractal{<-0.083,0,-0.83,-0.025> max_iteration 5 precision 30}"
            "isosurface{function{x*x+y*y*1.5+z*z*z*z-0.5+0.1*sin(9*x)} contained_by{box{-1,1}} max_gradient 8}"
            "parametric{function{u} function{v} function{0.3*u*v} <-1,-1>,<1,1>"
            " contained_by{box{-1.1,1.1}} accuracy 0.2}");
}

/* Anywhere, or as the one before, or round the same middle: nested, or through each other. */
static Primitive random_shape(const RandomScene *w, int index)
{
    static const ShapeOps *const all[7] = {&shape_sphere, &shape_box,  &shape_plane, &shape_cone,
                                           &shape_torus,  &shape_disc, &shape_mesh};
    const int kind = index < 7 ? index : random_below(10);
    Primitive p = {.shape.ops = all[kind < 7 ? kind : 0], .target = -1};
    const Primitive *before = index > 0 ? &w->shapes[random_below(index)] : NULL;
    double size = w->size * random_magnitude(0.05, 1);

    if (before && random_chance(0.35)) {
        double factor = random_chance(0.2)   ? 1
                        : random_chance(0.3) ? 1 + random_magnitude(1e-9, 1e-2)
                                             : random_between(0.4, 1.1);
        p.transform = transform_then(transform_scale(vec3(factor, factor, factor)), before->transform);
        if (random_chance(0.5))
            p.shape.ops = before->shape.ops;
    } else {
        p.transform = random_transform(size, vec_mad(w->centre, random_direction(), w->size * random_between(0, 1)));
    }
    random_form(&p);
    if (kind >= 7)
        p.shape = written->primitives[random_below(written->nprimitives)].shape;
    if (before && p.shape.ops == before->shape.ops)
        p.shape = before->shape;
    p.no_image = random_chance(0.12), p.no_shadow = random_chance(0.12), p.no_reflection = random_chance(0.12);
    return p;
}

ShapeTriangles test_triangles_of(const Primitive *p)
{
    ShapeTriangles triangles = {0, 0, NULL, NULL, 0, 1};

    if (p->shape.ops->triangles)
        p->shape.ops->triangles(&p->shape, &triangles);
    return triangles;
}
const int *test_corners_of(const Primitive *p, int triangle)
{
    const ShapeTriangles of = test_triangles_of(p);

    return of.corners + (size_t)triangle * of.stride;
}
Vec3 test_corner_at(const Primitive *p, int index)
{
    return transform_point(&p->transform, test_triangles_of(p).vertices[index]);
}

double test_size_of(Vec3 p)
{
    return fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
}

void random_scene(RandomScene *w, uint32_t seed)
{
    RetexError err = {0};
    double far;

    random_state = w->seed = seed;
    make_meshes();
    if (!written)
        parse_shapes();
    w->size = random_magnitude(1e-3, 1e3);
    far = random_chance(0.5) ? 0 : random_magnitude(0.1, 30);
    w->centre = vec_scale(random_direction(), w->size * far);
    w->scene = (Scene){.primitives = w->shapes, .nprimitives = 1 + random_below(RANDOM_SHAPES)};
    w->far = random_magnitude(2, 100);
    w->scene.camera.location =
        vec_mad(w->centre, vec3(1, 1, 1), w->far * w->size); /* surfaces and it are where rays start */
    w->reach = 0;
    for (int i = 0; i < w->scene.nprimitives; i++) {
        Primitive *p = &w->shapes[i];
        *p = random_shape(w, i);
        w->of[i] = &materials[random_below(5)];
        p->texture = w->of[i]->texture, p->interior_texture = w->of[i]->inside, p->interior = w->of[i]->interior;
        for (int k = 0; k < test_triangles_of(p).ntriangles; k++)
            for (int c = 0; c < 3; c++)
                w->reach = fmax(w->reach, test_size_of(test_corner_at(p, test_corners_of(p, k)[c])));
    }
    if (accel_create(&w->accel, &w->scene, 1, &err) < 0)
        fail_msg("%s", err.message);
}
