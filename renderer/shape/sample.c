/* Points on emitters, by area. Each shape is sampled in its canonical space; the density is divided by how much the
 * transform stretches area there, which for curved shapes under anything but a similarity depends on the point. */
#include <float.h>
#include <string.h>
#include "shape/shapes.h"

static Vec3 column(const Transform *t, int i)
{
    return vec3(t->m[0][i], t->m[1][i], t->m[2][i]);
}

/* Area in the world of a unit square in canonical space with edges e and f. */
static double stretch(const Transform *t, Vec3 e, Vec3 f)
{
    return vec_length(vec_cross(transform_vector(t, e), transform_vector(t, f)));
}

/* The scale, if the transform keeps shapes, else 0. */
static double similarity(const Transform *t)
{
    Vec3 x = column(t, 0), y = column(t, 1), z = column(t, 2);
    double xx = vec_dot(x, x), bound = 1e-12 * xx;

    if (fabs(vec_dot(x, y)) > bound || fabs(vec_dot(y, z)) > bound || fabs(vec_dot(z, x)) > bound)
        return 0;
    return fabs(vec_dot(y, y) - xx) <= bound && fabs(vec_dot(z, z) - xx) <= bound ? sqrt(xx) : 0;
}

/* ---- sphere ---- */

/* World area of a unit of the unit sphere's area at p. */
static double sphere_stretch(const Transform *t, Vec3 p)
{
    double scale = similarity(t);
    Vec3 e, f;

    if (scale > 0)
        return scale * scale;
    vec_frame(p, &e, &f);
    return stretch(t, e, f);
}

static double sphere_area(const Transform *t)
{
    double scale = similarity(t), sum = 0;
    const int rows = 64, turns = 64;

    if (scale > 0)
        return 4 * PI * scale * scale;
    /* Equal areas of the unit sphere; good to about 1e-4 for axes up to 10 : 1. */
    for (int i = 0; i < rows; i++) {
        double z = 2 * (i + 0.5) / rows - 1, rho = sqrt(1 - z * z);
        for (int j = 0; j < turns; j++) {
            double angle = 2 * PI * (j + 0.5) / turns;
            sum += sphere_stretch(t, vec3(rho * cos(angle), rho * sin(angle), z));
        }
    }
    return 4 * PI * sum / (rows * turns);
}

/* ---- box ---- */

static double box_areas(const Transform *t, double area[3])
{
    for (int k = 0; k < 3; k++)
        area[k] = vec_length(vec_cross(column(t, (k + 1) % 3), column(t, (k + 2) % 3)));
    return 2 * (area[0] + area[1] + area[2]);
}

static int box_sample(const Transform *t, double u1, double u2, Vec3 *p)
{
    double area[3], pick = u1 * box_areas(t, area), c[3];
    int face = 0;

    while (face < 5 && pick >= area[face / 2])
        pick -= area[face++ / 2];
    c[face / 2] = face & 1;
    c[(face / 2 + 1) % 3] = fmin(pick / area[face / 2], 1);
    c[(face / 2 + 2) % 3] = u2;
    *p = vec3(c[0], c[1], c[2]);
    return face;
}

/* ---- cone ---- */

/* World area of d angle d z at angle, for radius 1. */
static double side_stretch(const Primitive *primitive, double c, double s)
{
    double slope = primitive->r1 - primitive->r0;

    return stretch(&primitive->transform, vec3(-s, c, 0), vec3(slope * c, slope * s, 1));
}

/* The same all round: a circle about an axis that stands on it, of any height. */
static int is_round(const Transform *t)
{
    Vec3 x = column(t, 0), y = column(t, 1), z = column(t, 2);
    double xx = vec_dot(x, x), bound = 1e-12 * xx, upright = 1e-12 * sqrt(xx * vec_dot(z, z));

    return fabs(vec_dot(x, y)) <= bound && fabs(vec_dot(y, y) - xx) <= bound && fabs(vec_dot(x, z)) <= upright &&
           fabs(vec_dot(y, z)) <= upright;
}

/* Areas of side, low cap, high cap; returns their sum. */
static double cone_areas(const Primitive *primitive, double area[3])
{
    double r0 = primitive->r0, r1 = primitive->r1, cap, sum = 0;
    int turns = is_round(&primitive->transform) ? 1 : 64;

    for (int i = 0; i < turns; i++)
        sum += side_stretch(primitive, cos(2 * PI * i / turns), sin(2 * PI * i / turns));
    area[0] = PI * (r0 + r1) * sum / turns;
    cap = primitive->open ? 0 : PI * stretch(&primitive->transform, vec3(1, 0, 0), vec3(0, 1, 0));
    area[1] = cap * r0 * r0;
    area[2] = cap * r1 * r1;
    return area[0] + area[1] + area[2];
}

static int cone_sample(const Primitive *primitive, double u1, double u2, Vec3 *p)
{
    double r0 = primitive->r0, r1 = primitive->r1, area[3], radius;
    double pick = u1 * cone_areas(primitive, area), angle = 2 * PI * u2;
    int face = 0;

    while (face < 2 && pick >= area[face])
        pick -= area[face++];
    u1 = area[face] > 0 ? fmin(pick / area[face], 1) : 0;
    if (face) {
        radius = (face == 1 ? r0 : r1) * sqrt(u1);
        *p = vec3(radius * cos(angle), radius * sin(angle), face - 1);
    } else {
        radius = sqrt(r0 * r0 + u1 * (r1 * r1 - r0 * r0));
        *p = vec3(radius * cos(angle), radius * sin(angle), radius + r0 > 0 ? u1 * (r0 + r1) / (radius + r0) : u1);
    }
    return face;
}

static double cone_pdf(const Primitive *primitive, Vec3 p, int face)
{
    double area[3], total = cone_areas(primitive, area), rho = hypot(p.x, p.y), here;

    if (face || rho == 0)
        return 1 / total;
    /* The side is chosen by its area, then a ring by its radius, then the angle evenly. */
    here = side_stretch(primitive, p.x / rho, p.y / rho) * PI * (primitive->r0 + primitive->r1);
    return here > 0 ? area[0] / (total * here) : 0;
}

/* ---- torus ---- */

/* A point by its angles around the axis and around the tube, and the world area of a unit of both there. */
static double torus_at(const Primitive *primitive, double around, double tube, Vec3 *p)
{
    double r = fabs(primitive->r1), ring = primitive->r0 + r * cos(tube);
    Vec3 e = vec3(-ring * sin(around), 0, ring * cos(around));
    Vec3 f = vec3(-r * sin(tube) * cos(around), r * cos(tube), -r * sin(tube) * sin(around));

    *p = vec3(ring * cos(around), r * sin(tube), ring * sin(around));
    return stretch(&primitive->transform, e, f);
}

/* 0 where the tube is wider than the ring and meets itself. */
static double torus_area(const Primitive *primitive)
{
    double r0 = primitive->r0, r1 = fabs(primitive->r1), scale = similarity(&primitive->transform), sum = 0;
    const int turns = 64;
    Vec3 p;

    if (r1 > r0)
        return 0;
    if (scale > 0)
        return 4 * PI * PI * r0 * r1 * scale * scale;
    for (int i = 0; i < turns * turns; i++)
        sum += torus_at(primitive, 2 * PI * (i % turns) / turns, 2 * PI * (i / turns) / turns, &p);
    return 4 * PI * PI * sum / (turns * turns);
}

/* Both angles are chosen evenly. */
static double torus_pdf(const Primitive *primitive, Vec3 p)
{
    double tube = atan2(p.y, hypot(p.x, p.z) - primitive->r0), area;

    if (fabs(primitive->r1) > primitive->r0)
        return 0;
    area = 4 * PI * PI * torus_at(primitive, atan2(p.z, p.x), tube, &p);
    return area > 0 ? 1 / area : 0;
}

/* ---- all ---- */

static double disc_area(const Primitive *primitive)
{
    double r0 = primitive->r0, r1 = fmin(primitive->r1, r0);

    return PI * (r0 * r0 - r1 * r1) * stretch(&primitive->transform, vec3(1, 0, 0), vec3(0, 1, 0));
}

double mesh_face_area(const Primitive *primitive, int face)
{
    const Vec3 *v = primitive->mesh->vertices;
    const int *index = primitive->mesh->faces[face].vertex;

    return stretch(&primitive->transform, vec_sub(v[index[1]], v[index[0]]), vec_sub(v[index[2]], v[index[0]])) / 2;
}

double shape_area(const Primitive *primitive)
{
    double area[3], sum = 0;

    switch (primitive->kind) {
    case SHAPE_SPHERE:
        return sphere_area(&primitive->transform);
    case SHAPE_BOX:
        return box_areas(&primitive->transform, area);
    case SHAPE_CONE:
        return cone_areas(primitive, area);
    case SHAPE_DISC:
        return disc_area(primitive);
    case SHAPE_MESH:
        for (int i = 0; i < primitive->mesh->nfaces; i++)
            sum += mesh_face_area(primitive, i);
        return sum;
    case SHAPE_TORUS:
        return torus_area(primitive);
    case SHAPE_PLANE:
        break;
    }
    return 0;
}

static double one_over(double area)
{
    return area > 0 ? 1 / area : 0;
}

static double pdf_at(const Primitive *primitive, Vec3 p, int face)
{
    double area[3];

    switch (primitive->kind) {
    case SHAPE_SPHERE:
        return one_over(4 * PI * sphere_stretch(&primitive->transform, p));
    case SHAPE_BOX:
        return one_over(box_areas(&primitive->transform, area));
    case SHAPE_CONE:
        return cone_pdf(primitive, p, face);
    case SHAPE_DISC:
        return one_over(disc_area(primitive));
    case SHAPE_MESH:
        return one_over(mesh_face_area(primitive, face));
    case SHAPE_TORUS:
        return torus_pdf(primitive, p);
    case SHAPE_PLANE:
        break;
    }
    return 0;
}

double shape_pdf_area(const Primitive *primitive, const Surface *surface)
{
    Vec3 p = transform_inverse_point(&primitive->transform, surface->position);

    return pdf_at(primitive, primitive->kind == SHAPE_SPHERE ? vec_normalize(p) : p, surface->face);
}

void shape_sample(const Primitive *primitive, const Scene *scene, int face, double u1, double u2, Surface *surface,
                  double *pdf_area)
{
    double angle = 2 * PI * u2, root = sqrt(u1), z = 1 - 2 * u1, r0 = primitive->r0, r1 = fmin(primitive->r1, r0);
    ShapePoint point;
    Vec3 p;

    (void)scene;
    memset(&point, 0, sizeof(point));
    switch (primitive->kind) {
    case SHAPE_SPHERE:
        face = 0;
        sphere_point(vec3(sqrt(fmax(0, 1 - z * z)) * cos(angle), sqrt(fmax(0, 1 - z * z)) * sin(angle), z), &point);
        break;
    case SHAPE_BOX:
        face = box_sample(&primitive->transform, u1, u2, &p);
        box_point(p, face, &point);
        break;
    case SHAPE_CONE:
        face = cone_sample(primitive, u1, u2, &p);
        cone_point(primitive, p, face, &point);
        break;
    case SHAPE_DISC:
        face = 0;
        root = sqrt(r1 * r1 + u1 * (r0 * r0 - r1 * r1));
        disc_point(vec3(root * cos(angle), root * sin(angle), 0), &point);
        break;
    case SHAPE_MESH:
        mesh_point(primitive->mesh, face, root * (1 - u2), root * u2, &point);
        break;
    case SHAPE_TORUS:
        face = 0;
        torus_at(primitive, angle, 2 * PI * u1, &p);
        torus_point(primitive, p, &point);
        break;
    case SHAPE_PLANE:
        /* Not sampled; a point of the shape all the same, at density 0. */
        face = 0;
        plane_point(vec3(0, 0, 0), &point);
        break;
    }
    surface_from_point(surface, primitive, face, &point);
    if (primitive->kind == SHAPE_MESH)
        surface->b1 = root * (1 - u2), surface->b2 = root * u2;
    *pdf_area = pdf_at(primitive, point.p, face);
}
