/* See nearest.h. */
#include "faces/nearest.h"
#include "faces/faces.h"
#include "shape/shape.h"

/* Along a segment from a to b. */
static double distance_to_edge(Vec3 p, Vec3 a, Vec3 b)
{
    const Vec3 along = vec_sub(b, a), to = vec_sub(p, a);
    const double share = vec_dot(to, along) / vec_dot(along, along);
    return vec_length(vec_mad(to, along, -fmin(fmax(share, 0), 1)));
}

/* Of a triangle with an area, or of a parallelogram: convex. */
static double distance_to_corners(Vec3 p, const Vec3 *corners, int count)
{
    const Vec3 n = vec_normalize(vec_cross(vec_sub(corners[1], corners[0]), vec_sub(corners[2], corners[0])));
    double nearest = INFINITY;
    int is_above = 1;
    for (int k = 0; k < count; k++) {
        const Vec3 a = corners[k], b = corners[(k + 1) % count];
        is_above &= vec_dot(vec_cross(n, vec_sub(b, a)), vec_sub(p, a)) >= 0;
        nearest = fmin(nearest, distance_to_edge(p, a, b));
    }
    return is_above ? fabs(vec_dot(vec_sub(p, corners[0]), n)) : nearest;
}

/* Planes and discs have one point, their middle; a hole in a disc is not seen. */
static double distance_to_face(Vec3 p, const Face *face)
{
    if (face->ncorners > 2)
        return distance_to_corners(p, face->corners, face->ncorners);
    const Vec3 from = vec_sub(p, face->corners[0]);
    const double above = vec_dot(from, face->normal), beside = vec_length(vec_mad(from, face->normal, -above));
    return hypot(above, fmax(beside - sqrt(face->area / PI), 0));
}

static double distance_to_bounds(const Primitive *p, const Instance *instance, Vec3 point)
{
    Vec3 low, high, from = vec3(INFINITY, INFINITY, INFINITY), to = vec_neg(from);
    if (!shape_bounds(p, &low, &high))
        return 0;
    for (int k = 0; k < 8; k++) {
        const Vec3 corner = vec3(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
        shape_bound_point(&from, &to, instance ? transform_point(&instance->transform, corner) : corner);
    }
    const double x = fmax(fmax(from.x - point.x, point.x - to.x), 0),
                 y = fmax(fmax(from.y - point.y, point.y - to.y), 0),
                 z = fmax(fmax(from.z - point.z, point.z - to.z), 0);
    return sqrt(x * x + y * y + z * z);
}

typedef struct Nearest {
    Vec3 point;
    double same; /* distances that differ by less are equal */
    double distance, area;
    const Primitive *primitive;
    int face;
} Nearest;

static void look_at(Nearest *nearest, const Primitive *p, const Instance *instance)
{
    Face face;
    const int count = faces_count(p);
    if (!count || !(distance_to_bounds(p, instance, nearest->point) <= nearest->distance + nearest->same))
        return;
    for (int k = 0; k < count; k++) {
        if (!faces_placed(p, instance, k, &face))
            continue;
        const double distance = distance_to_face(nearest->point, &face);
        if (distance < nearest->distance - nearest->same ||
            (distance <= nearest->distance + nearest->same && face.area > nearest->area))
            *nearest = (Nearest){nearest->point, nearest->same, distance, face.area, p, k};
    }
}

/* As first_hit_of: of textures that are blended from corner to corner none is seen alone. */
static ShownSurface shown_at(const Scene *scene, const Primitive *p, int face)
{
    const FaceTextures *textures = p->shape.textures;
    const Mesh *mesh = p->shape.mesh;
    const int own = mesh && textures && !mesh->corner_textures ? mesh->faces[face].texture : -1;
    int part = 0;
    for (int k = 0; own >= 0 && k < textures->count && !part; k++)
        if (textures->list[k] == textures->list[own])
            part = k + 1;
    ShownSurface shown = {object_part(scene, p, part), p, face};
    if (mesh && mesh->corner_textures)
        shown.part.texture = NULL;
    return shown;
}

int faces_nearest(ShownSurface *shown, const Scene *scene, Vec3 point, RetexError *err)
{
    const double size = faces_scene_size(scene);
    Nearest nearest = {.point = point, .same = isfinite(size) ? 1e-6 * size : 1e-9, .distance = INFINITY};
    for (int k = 0; k < scene->nprimitives; k++)
        if (!scene->primitives[k].prototype)
            look_at(&nearest, &scene->primitives[k], NULL);
    for (int k = 0; k < scene->ninstances; k++) {
        const Prototype *prototype = scene->instances[k].prototype;
        for (int i = 0; i < prototype->count; i++)
            look_at(&nearest, &scene->primitives[prototype->first + i], &scene->instances[k]);
    }
    if (!nearest.primitive)
        return retex_fail(err, RETEX_ENOTFOUND,
                          "no flat face is in the scene: @X:Y:Z finds those of meshes, boxes, planes and discs");
    *shown = shown_at(scene, nearest.primitive, nearest.face);
    return RETEX_OK;
}
