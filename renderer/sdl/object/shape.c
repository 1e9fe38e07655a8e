/* Parsers of simple shapes: the shape in its canonical form (shape/NAME.c), and the transform from there to what is
 * written. A shape without extent is left out with a warning, for no ray hits it in POV-Ray; what is an error in
 * POV-Ray is an error here. */
#include "sdl/object/shape.h"

static double length_of(Sdl *sdl)
{
    sdl_optional_comma(sdl);
    return fabs(sdl_float(sdl));
}

static void empty(Sdl *sdl, Object *object, const char *what)
{
    sdl_warn(sdl, "%s: it is left out", what);
    object->kind = OBJECT_EMPTY;
}

static void frame(Sdl *sdl, Object *object, Vec3 x, Vec3 y, Vec3 z, Vec3 origin)
{
    if (!transform_from_axes(x, y, z, origin, &object->transform))
        sdl_error(sdl, "this shape is flat or too large to be placed");
}

void parse_sphere(Sdl *sdl, Object *object)
{
    Vec3 centre = sdl_vector(sdl);
    double radius = length_of(sdl);
    object->shape.ops = &shape_sphere;
    if (radius == 0)
        empty(sdl, object, "a sphere of radius 0");
    else
        frame(sdl, object, vec3(radius, 0, 0), vec3(0, radius, 0), vec3(0, 0, radius), centre);
}

/* Corners in any order. A side of no length becomes a very thin one: such boxes serve as cards. */
void parse_box(Sdl *sdl, Object *object)
{
    Vec3 a = sdl_vector(sdl);
    sdl_optional_comma(sdl);
    Vec3 b = sdl_vector(sdl);
    Vec3 low = vec3(fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z));
    Vec3 size = vec_sub(vec3(fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z)), low);
    double thin = 1e-6 * fmax(size.x, fmax(size.y, size.z));
    object->shape.ops = &shape_box;
    if (thin == 0)
        empty(sdl, object, "a box of one point");
    else
        frame(sdl, object, vec3(fmax(size.x, thin), 0, 0), vec3(0, fmax(size.y, thin), 0),
              vec3(0, 0, fmax(size.z, thin)), low);
}

/* The distance counts along the unit normal, however long the one written is. */
void parse_plane(Sdl *sdl, Object *object)
{
    Vec3 normal = sdl_vector(sdl), s, t;
    sdl_optional_comma(sdl);
    double distance = sdl_float(sdl);
    if (vec_length(normal) == 0)
        sdl_error(sdl, "a plane needs a normal that is not zero");
    normal = vec_normalize(normal);
    vec_frame(normal, &s, &t);
    object->shape.ops = &shape_plane;
    frame(sdl, object, s, normal, vec_neg(t), vec_scale(normal, distance));
}

static void about_axis(Sdl *sdl, Object *object, Vec3 from, Vec3 to, double r0, double r1)
{
    Vec3 axis = vec_sub(to, from), s, t;
    object->shape.ops = &shape_cone;
    object->shape.r0 = r0;
    object->shape.r1 = r1;
    if (vec_length(axis) < 1e-12 || (r0 == 0 && r1 == 0)) {
        empty(sdl, object, "a cylinder or cone without length or radius");
        return;
    }
    vec_frame(vec_normalize(axis), &s, &t);
    frame(sdl, object, s, t, axis, from);
}

void parse_cylinder(Sdl *sdl, Object *object)
{
    Vec3 from = sdl_vector(sdl);
    sdl_optional_comma(sdl);
    Vec3 to = sdl_vector(sdl);
    double radius = length_of(sdl);
    object->shape.open = sdl_accept(sdl, "open");
    about_axis(sdl, object, from, to, radius, radius);
}

void parse_cone(Sdl *sdl, Object *object)
{
    Vec3 from = sdl_vector(sdl);
    double r0 = length_of(sdl);
    sdl_optional_comma(sdl);
    Vec3 to = sdl_vector(sdl);
    double r1 = length_of(sdl);
    object->shape.open = sdl_accept(sdl, "open");
    about_axis(sdl, object, from, to, r0, r1);
}

void parse_torus(Sdl *sdl, Object *object)
{
    object->shape.r0 = fabs(sdl_float(sdl));
    object->shape.r1 = length_of(sdl);
    object->shape.ops = &shape_torus;
    if (object->shape.r1 == 0)
        empty(sdl, object, "a torus of minor radius 0");
}

void parse_superellipsoid(Sdl *sdl, Object *object)
{
    Vec2 exponents = sdl_vector2(sdl);
    object->shape.ops = &shape_superellipsoid;
    /* 2/e beyond what powers can take is a box. */
    object->shape.r0 = fmax(exponents.u, 1e-3);
    object->shape.r1 = fmax(exponents.v, 1e-3);
    if (!(exponents.u > 0 && exponents.v > 0))
        sdl_error(sdl, "the exponents of a superellipsoid are greater than 0");
}

/* One whose upper sphere holds the lower one is that sphere. */
void parse_ovus(Sdl *sdl, Object *object)
{
    double bottom = length_of(sdl), top = length_of(sdl);
    object->shape.ops = &shape_ovus;
    object->shape.r0 = bottom;
    object->shape.r1 = top;
    if (bottom == 0 && top == 0)
        empty(sdl, object, "an ovus without radius");
    else if (top >= 2 * bottom) {
        object->shape.ops = &shape_sphere;
        frame(sdl, object, vec3(top, 0, 0), vec3(0, top, 0), vec3(0, 0, top), vec3(0, bottom, 0));
    }
}

void parse_disc(Sdl *sdl, Object *object)
{
    Vec3 centre = sdl_vector(sdl), s, t;
    sdl_optional_comma(sdl);
    Vec3 normal = sdl_vector(sdl);
    object->shape.r0 = length_of(sdl);
    sdl_optional_comma(sdl);
    object->shape.r1 = fabs(optional_float(sdl, 0));
    object->shape.ops = &shape_disc;
    if (vec_length(normal) == 0)
        empty(sdl, object, "a disc without a normal");
    else if (object->shape.r0 <= object->shape.r1)
        empty(sdl, object, "a disc that is all hole");
    else {
        normal = vec_normalize(normal);
        vec_frame(normal, &s, &t);
        frame(sdl, object, s, t, normal, centre);
    }
}

/* ---- single triangles ---- */

static Mesh *one_face(Sdl *sdl, const Vec3 points[3], const Vec3 *normals /* or NULL */)
{
    Mesh *mesh = sdl_alloc(sdl, sizeof *mesh);
    mesh->nvertices = 3;
    mesh->vertices = sdl_alloc(sdl, 3 * sizeof *mesh->vertices);
    mesh->nnormals = normals ? 3 : 0;
    mesh->normals = normals ? sdl_alloc(sdl, 3 * sizeof *mesh->normals) : NULL;
    mesh->nfaces = 1;
    mesh->faces = sdl_alloc(sdl, sizeof *mesh->faces);
    mesh->faces[0].texture = -1;
    for (int i = 0; i < 3; i++) {
        mesh->vertices[i] = points[i];
        if (normals)
            mesh->normals[i] = normals[i];
        mesh->faces[0].vertex[i] = i;
        mesh->faces[0].normal[i] = normals ? i : -1;
        mesh->faces[0].uv[i] = -1;
    }
    return mesh;
}

static void triangle(Sdl *sdl, Object *object, const Vec3 points[3], const Vec3 *normals)
{
    object->shape.ops = &shape_mesh;
    object->single_triangle = TRIANGLE_SINGLE;
    if (vec_length(vec_cross(vec_sub(points[1], points[0]), vec_sub(points[2], points[0]))) == 0)
        empty(sdl, object, "a triangle without area");
    else
        object->shape.mesh = one_face(sdl, points, normals);
}

void parse_triangle(Sdl *sdl, Object *object)
{
    Vec3 points[3];
    for (int i = 0; i < 3; i++) {
        points[i] = sdl_vector(sdl);
        sdl_optional_comma(sdl);
    }
    triangle(sdl, object, points, NULL);
}

void parse_smooth_triangle(Sdl *sdl, Object *object)
{
    Vec3 points[3], normals[3];
    for (int i = 0; i < 3; i++) {
        points[i] = sdl_vector(sdl);
        sdl_optional_comma(sdl);
        normals[i] = sdl_vector(sdl);
        sdl_optional_comma(sdl);
    }
    triangle(sdl, object, points, normals);
}
