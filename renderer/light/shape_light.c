/* Emitting shapes and meshes as entries of the list of lights. */
#include "light/entry.h"
#include "light/lights.h"
#include "shade/bsdf.h"
#include "shade/texture.h"
#include "shape/csg.h"
#include "shape/shape.h"

#define FACES_WHOLE 8 /* a mesh of up to so many emitting faces is one light; of a larger one each face is a light */
#define BACK_OF_CLOSED 0.1 /* weight of the inside of a closed mesh, which may be a room */

/* ---- which shapes emit ---- */

/* A dome of `ambient` around the camera, for a sky: like a sky of one colour, it is sampled by the BSDF alone. */
static int is_dome(const Primitive *p, Vec3 camera)
{
    return p->texture->finish->emission_of_ambient && !p->csg && p->shape.ops->inside &&
           p->shape.ops->inside(&p->shape, transform_inverse_point(&p->transform, camera));
}

int lights_differ(const Scene *scene, Vec3 a, Vec3 b)
{
    int differ = 0;
    for (int k = 0; k < scene->nprimitives && !differ; k++) {
        const Primitive *p = &scene->primitives[k];
        differ = p->texture && texture_is_sampled(p->texture) && is_dome(p, a) != is_dome(p, b);
    }
    return differ;
}

/* A sphere under rotation, translation and equal scaling. */
static int is_round_sphere(const Primitive *p, double *radius)
{
    if (p->shape.ops != &shape_sphere)
        return 0;
    Vec3 a[3];
    for (int k = 0; k < 3; k++)
        a[k] = vec3(p->transform.m[0][k], p->transform.m[1][k], p->transform.m[2][k]);
    double r = vec_length(a[0]), tolerance = 1e-6 * r * r;
    *radius = r;
    return fabs(vec_dot(a[1], a[1]) - r * r) < tolerance && fabs(vec_dot(a[2], a[2]) - r * r) < tolerance &&
           fabs(vec_dot(a[0], a[1])) < tolerance && fabs(vec_dot(a[0], a[2])) < tolerance &&
           fabs(vec_dot(a[1], a[2])) < tolerance;
}

static void close_mesh(LightEntry *e)
{
    MeshLight *mesh = e->data;
    mesh_light_close(&mesh);
}

/* What it emits, all in all: *power is 0 where that is no light. */
static int find_area(const Scene *scene, const Primitive *p, LightEntry *e, double *power, RetexError *err)
{
    *power = 0;
    if (p->shape.mesh) {
        MeshLight *mesh;
        const int code = mesh_light_create(&mesh, p, err);
        e->ops = &entry_mesh, e->data = mesh;
        if (mesh)
            e->area = mesh->area, e->nfaces = mesh->count > FACES_WHOLE ? mesh->count : 0, *power = mesh->power;
        return code;
    }
    if (texture_is_sampled(p->texture) && !is_dome(p, scene->camera.location)) {
        e->area = shape_area(p);
        *power = rgb_luminance(texture_emission(p->texture)) * e->area;
    }
    return RETEX_OK;
}

static int add_shape(LightEntries *list, int index, RetexError *err)
{
    const Primitive *p = &list->scene->primitives[index];
    LightEntry e = {.ops = &entry_shape, .index = index, .lamp = p->lamp};
    double power, r;
    Vec3 low, high;
    int code = find_area(list->scene, p, &e, &power, err);
    if (code)
        return code;
    if (!(e.area > 0) || !shape_bounds(p, &low, &high)) {
        close_mesh(&e);
        return RETEX_OK;
    }
    e.center = vec_scale(vec_add(low, high), 0.5);
    e.radius = vec_length(vec_sub(high, low)) / 2;
    e.is_sphere = !p->csg && is_round_sphere(p, &r); /* what is cut off of an operand opens up its far side */
    if (e.is_sphere)
        e.radius = r;
    e.strength = NEUTRAL_ALBEDO * (float)power;
    code = light_entries_add(list, &e, err);
    if (code)
        close_mesh(&e);
    return code;
}

static int add_shapes(LightEntries *list, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < list->scene->nprimitives && !code; k++)
        if (!list->scene->primitives[k].prototype)
            code = add_shape(list, k, err);
    return code;
}

/* ---- estimates ---- */

static float estimate_shape(const LightEntry *e, Vec3 position)
{
    Vec3 d = vec_sub(e->center, position);
    return e->strength / (float)fmax(vec_dot(d, d), e->radius * e->radius / 4);
}

static LightBounds face_bounds(const MeshLight *mesh, int face)
{
    const MeshLightFace *f = &mesh->faces[face];
    double a[3], b[3], c[3], low[3], high[3], intensity = NEUTRAL_ALBEDO * fmaxf(0, f->radiance) / f->inverse_area;
    a[0] = f->corner.x, a[1] = f->corner.y, a[2] = f->corner.z;
    b[0] = f->edge1.x, b[1] = f->edge1.y, b[2] = f->edge1.z;
    c[0] = f->edge2.x, c[1] = f->edge2.y, c[2] = f->edge2.z;
    for (int k = 0; k < 3; k++) {
        low[k] = a[k] + fmin(0, fmin(b[k], c[k]));
        high[k] = a[k] + fmax(0, fmax(b[k], c[k]));
    }
    return (LightBounds){.low = vec3(low[0], low[1], low[2]),
                         .high = vec3(high[0], high[1], high[2]),
                         .axis = f->normal,
                         .theta_e = PI / 2,
                         .back_share = mesh->closed ? BACK_OF_CLOSED : 1,
                         .intensity = intensity,
                         .peak = NEUTRAL_ALBEDO * PI * fmaxf(0, f->radiance)};
}

/* An emitting shape as a whole: a flat one, or one of which any side shows a quarter of the surface. */
static LightBounds bound_shape(const LightEntry *e, int face)
{
    const Primitive *p = &e->scene->primitives[e->index];
    (void)face;
    LightBounds b = {
        .axis = {0, 0, 1}, .theta_o = PI, .theta_e = PI / 2, .back_share = 1, .intensity = e->strength / 4};
    shape_bounds(p, &b.low, &b.high);
    b.peak = e->area > 0 ? PI * e->strength / e->area : 0;
    if (p->shape.ops->properties & SHAPE_FLAT) {
        ShapePoint point;
        p->shape.ops->point(p, vec3(0, 0, 0), 0, &point);
        b.axis = vec_normalize(transform_normal(&p->transform, point.normal));
        b.theta_o = 0;
        b.intensity = e->strength;
    }
    return b;
}

static LightBounds bound_mesh(const LightEntry *e, int face)
{
    return face < 0 ? bound_shape(e, face) : face_bounds(e->data, face);
}

/* ---- points, by area ---- */

static double left_of_operand(const Primitive *p, Vec3 position, double density)
{
    return p->csg && !csg_on_surface(p->csg, position) ? 0 : density;
}

static double shape_point(const LightEntry *e, const LightPick *pick, float u1, float u2, Surface *surface)
{
    const Primitive *p = &e->scene->primitives[e->index];
    double density;
    (void)pick;
    shape_sample(p, -1, u1, u2, surface, &density);
    return left_of_operand(p, surface->position, density);
}

static double shape_density(const LightEntry *e, const Surface *surface, int *face)
{
    (void)e, (void)face;
    return shape_pdf_area(surface->primitive, surface);
}

static double mesh_point(const LightEntry *e, const LightPick *pick, float u1, float u2, Surface *surface)
{
    const Primitive *p = &e->scene->primitives[e->index];
    const MeshLightPoint point = mesh_light_point(e->data, pick->face, u1, u2);
    mesh_light_surface(&point, p, surface);
    return left_of_operand(p, surface->position, point.density);
}

static double mesh_density(const LightEntry *e, const Surface *surface, int *face)
{
    const MeshLight *mesh = e->data;
    *face = mesh->of_face[surface->face];
    if (*face < 0)
        return 0;
    const MeshLightFace *f = &mesh->faces[*face];
    return (e->nfaces > 0 ? 1 : f->share) * f->inverse_area;
}

static int uniform_point(const LightEntry *e, const LightPick *pick, float u1, float u2, MeshLightPoint *point)
{
    const Primitive *p = &e->scene->primitives[e->index];
    if (p->no_reflection || p->csg)
        return 0;
    *point = mesh_light_point(e->data, pick->face, u1, u2);
    return point->face->uniform;
}

/* ---- directions ---- */

/* Sample a direction uniformly in the cone in which a sphere is seen from outside. The sample's surface is where that
 * direction meets the sphere. */
static int sample_sphere_cone(const LightEntry *e, Vec3 position, float u1, float u2, LightSample *sample)
{
    Vec3 axis = vec_sub(e->center, position), s, t;
    double distance2 = vec_dot(axis, axis), sin2 = e->radius * e->radius / distance2;
    axis = vec_scale(axis, 1 / sqrt(distance2));
    vec_frame(axis, &s, &t);
    double one_minus = sin2 / (1 + sqrt(1 - sin2)), c = 1 - u1 * one_minus, sine = sqrt(fmax(0, 1 - c * c)),
           phi = 2 * PI * u2;
    Vec3 d = vec_add(vec_scale(axis, c), vec_add(vec_scale(s, sine * cos(phi)), vec_scale(t, sine * sin(phi))));
    double along = c * sqrt(distance2), off2 = distance2 * sine * sine;
    sample->direction = vec_normalize(d);
    sample->distance = along - sqrt(fmax(0, e->radius * e->radius - off2));
    sample->pdf = (float)(1 / (2 * PI * one_minus));
    Ray ray = {position, sample->direction, 0, INFINITY};
    Hit hit = {.t = sample->distance, .primitive = e->index};
    surface_at(&sample->surface, e->scene, &ray, &hit);
    return 1;
}

static int outside_sphere(const LightEntry *e, Vec3 position)
{
    Vec3 d = vec_sub(position, e->center);
    return e->is_sphere && vec_dot(d, d) > e->radius * e->radius * 1.0001;
}

static int sample_shape(const LightEntry *e, const LightPick *pick, Vec3 position, float u1, float u2,
                        LightSample *sample)
{
    sample->source = NULL, sample->shadowless = 0;
    if (outside_sphere(e, position))
        return sample_sphere_cone(e, position, u1, u2, sample);
    double pdf_area = e->ops->point(e, pick, u1, u2, &sample->surface);
    Vec3 d = vec_sub(sample->surface.position, position);
    sample->distance = vec_length(d);
    if (!(sample->distance > 0 && pdf_area > 0))
        return 0;
    sample->direction = vec_scale(d, 1 / sample->distance);
    double cosine = fabs(vec_dot(sample->direction, sample->surface.geometric_normal));
    if (!(cosine > 1e-9))
        return 0;
    surface_turn(&sample->surface, vec_dot(sample->direction, sample->surface.geometric_normal) > 0);
    sample->pdf = (float)(pdf_area * sample->distance * sample->distance / cosine);
    return 1;
}

static double shape_pdf(const LightEntry *e, Vec3 from, Vec3 direction, const Surface *surface, int *face)
{
    const Vec3 d = vec_sub(surface->position, from);
    (void)direction;
    if (outside_sphere(e, from)) {
        const Vec3 axis = vec_sub(e->center, from);
        const double sin2 = e->radius * e->radius / vec_dot(axis, axis);
        /* points on the far side of the sphere are never sampled from here */
        return vec_dot(d, vec_sub(surface->position, e->center)) > 0 ? 0 : (1 + sqrt(1 - sin2)) / (2 * PI * sin2);
    }
    const double distance2 = vec_dot(d, d), cosine = fabs(vec_dot(d, surface->geometric_normal)) / sqrt(distance2);
    const double density = e->ops->point_density(e, surface, face);
    return cosine > 1e-9 ? density * distance2 / cosine : 0;
}

const LightEntryOps entry_shape = {.add = add_shapes,
                                   .estimate = estimate_shape,
                                   .bounds = bound_shape,
                                   .sample = sample_shape,
                                   .pdf = shape_pdf,
                                   .point = shape_point,
                                   .point_density = shape_density};

const LightEntryOps entry_mesh = {.close = close_mesh,
                                  .estimate = estimate_shape,
                                  .bounds = bound_mesh,
                                  .sample = sample_shape,
                                  .pdf = shape_pdf,
                                  .point = mesh_point,
                                  .point_density = mesh_density,
                                  .uniform_point = uniform_point};
