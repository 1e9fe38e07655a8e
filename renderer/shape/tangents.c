/* Tangents: the directions in which u and v grow on a surface, for normal maps in tangent space.
 *
 * The corners of a mesh that has normals and UV have tangents of their own, as in MikkTSpace, the convention of glTF:
 * those of the faces around, perpendicular to the corner's normal, weighted by the angles at the corner. Faces count
 * together whose corners have the same vertex, normal and UV, and whose UV are mirrored alike. Other faces have one
 * tangent each, and other shapes the one that differences of their UV tell. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "shape/shape.h"
#include "shape/surface.h"

/* ---- corners of meshes ---- */

/* u and v grow along these, of any length. 0 where UV do not span the face. */
static int face_directions(const Mesh *mesh, const MeshFace *f, Vec3 *along_u, Vec3 *along_v)
{
    const Vec3 p = mesh->vertices[f->vertex[0]], e1 = vec_sub(mesh->vertices[f->vertex[1]], p),
               e2 = vec_sub(mesh->vertices[f->vertex[2]], p);
    const Vec2 *a = &mesh->uvs[f->uv[0]], *b = &mesh->uvs[f->uv[1]], *c = &mesh->uvs[f->uv[2]];
    const double u1 = b->u - a->u, v1 = b->v - a->v, u2 = c->u - a->u, v2 = c->v - a->v, det = u1 * v2 - v1 * u2;
    if (!(fabs(det) > 0) || !isfinite(det))
        return 0;
    const double sign = det < 0 ? -1 : 1;
    *along_u = vec_scale(vec_mad(vec_scale(e1, v2), e2, -v1), sign);
    *along_v = vec_scale(vec_mad(vec_scale(e2, u1), e1, -u2), sign);
    return vec_length(*along_u) > 0 && vec_length(*along_v) > 0;
}

static Vec3 perpendicular(Vec3 v, Vec3 unit_normal)
{
    return vec_normalize(vec_mad(v, unit_normal, -vec_dot(v, unit_normal)));
}

static double corner_angle(const Mesh *mesh, const MeshFace *f, int k)
{
    const Vec3 p = mesh->vertices[f->vertex[k]];
    const Vec3 a = vec_normalize(vec_sub(mesh->vertices[f->vertex[(k + 1) % 3]], p)),
               b = vec_normalize(vec_sub(mesh->vertices[f->vertex[(k + 2) % 3]], p));
    return acos(fmin(fmax(vec_dot(a, b), -1), 1));
}

/* What corners have in common whose tangents are one. */
typedef struct CornerKey {
    int vertex, normal, uv, mirrored;
} CornerKey;

typedef struct CornerTable { /* open addressing, a power of two */
    struct CornerEntry {
        CornerKey key;
        int tangent; /* index + 1; 0 = free */
    } * entries;
    size_t size;
} CornerTable;

static int *find_corner(CornerTable *table, CornerKey key)
{
    size_t i = ((size_t)key.vertex * 0x9e3779b97f4a7c15u ^ (size_t)key.normal * 0xc2b2ae3d27d4eb4fu ^
                (size_t)key.uv * 0x165667b19e3779f9u ^ (size_t)key.mirrored) >>
               7;
    for (i &= table->size - 1; table->entries[i].tangent; i = (i + 1) & (table->size - 1)) {
        const CornerKey *other = &table->entries[i].key;
        if (other->vertex == key.vertex && other->normal == key.normal && other->uv == key.uv &&
            other->mirrored == key.mirrored)
            break;
    }
    table->entries[i].key = key;
    return &table->entries[i].tangent;
}

static void add_face(const Mesh *mesh, int face, CornerTable *table, MeshTangents *tangents)
{
    const MeshFace *f = &mesh->faces[face];
    Vec3 along_u, along_v;
    int *corners = tangents->corners[face];
    corners[0] = corners[1] = corners[2] = -1;
    if (!mesh_face_has_normals(f) || !mesh_face_has_uvs(f) || !face_directions(mesh, f, &along_u, &along_v))
        return;
    for (int k = 0; k < 3; k++) {
        const Vec3 n = vec_normalize(mesh->normals[f->normal[k]]);
        const CornerKey key = {f->vertex[k], f->normal[k], f->uv[k], vec_dot(vec_cross(along_u, along_v), n) < 0};
        int *found = find_corner(table, key);
        if (!*found)
            *found = ++tangents->count;
        corners[k] = *found - 1;
        Vec3 *sum = &tangents->vectors[corners[k]];
        *sum = vec_mad(*sum, perpendicular(along_u, n), corner_angle(mesh, f, k));
    }
}

int mesh_add_tangents(Arena *arena, Mesh *mesh)
{
    const size_t n = (size_t)mesh->nfaces;
    CornerTable table = {.size = 64};
    if (mesh->tangents || !mesh->normals || !mesh->uvs)
        return 1;
    while (table.size < 6 * n)
        table.size *= 2;
    MeshTangents sums = {0}, *tangents = arena_alloc(arena, sizeof *tangents);
    table.entries = calloc(table.size, sizeof *table.entries);
    sums.vectors = calloc(3 * n, sizeof *sums.vectors);
    sums.corners = arena_alloc(arena, n * sizeof *sums.corners);
    if (!tangents || !table.entries || !sums.vectors || !sums.corners) {
        free(table.entries), free(sums.vectors);
        return 0;
    }
    for (int i = 0; i < mesh->nfaces; i++)
        add_face(mesh, i, &table, &sums);
    free(table.entries);
    *tangents = sums;
    tangents->vectors = arena_alloc(arena, ((size_t)sums.count + 1) * sizeof *sums.vectors);
    for (int i = 0; tangents->vectors && i < sums.count; i++)
        tangents->vectors[i] = vec_normalize(sums.vectors[i]);
    free(sums.vectors);
    if (!tangents->vectors)
        return 0;
    mesh->tangents = tangents;
    return 1;
}

/* ---- at a point ---- */

/* Directions in canonical space. */
static int mesh_directions(const Mesh *mesh, const Surface *surface, Vec3 *along_u, Vec3 *along_v)
{
    const MeshFace *f = &mesh->faces[surface->face];
    if (!mesh_face_has_uvs(f) || !face_directions(mesh, f, along_u, along_v))
        return 0;
    const MeshTangents *tangents = mesh->tangents;
    if (!tangents || tangents->corners[surface->face][0] < 0)
        return 1;
    const int *corners = tangents->corners[surface->face];
    const Vec3 smooth = vec_mad(vec_mad(vec_scale(tangents->vectors[corners[0]], 1 - surface->b1 - surface->b2),
                                        tangents->vectors[corners[1]], surface->b1),
                                tangents->vectors[corners[2]], surface->b2);
    if (vec_length(smooth) > 0.01) /* those of a fold may cancel out */
        *along_u = smooth;
    return 1;
}

static Vec2 uv_near(const Surface *surface, Vec3 p, Vec3 step)
{
    Surface near = *surface;
    near.instance = NULL; /* p is in the primitive's world */
    near.position = vec_add(p, step);
    return surface_uv(&near).uv;
}

/* By differences over the plane that touches the shape. */
static int shape_directions(const Surface *surface, Vec3 normal, Vec3 *along_u, Vec3 *along_v)
{
    const Transform *t = &surface->primitive->transform;
    const Vec3 p = surface_texture_point(surface);
    Vec3 s, r;
    vec_frame(normal, &s, &r);
    const double step = 1e-4 * vec_length(transform_vector(t, vec_normalize(transform_inverse_vector(t, s))));
    const Vec2 s0 = uv_near(surface, p, vec_scale(s, -step)), s1 = uv_near(surface, p, vec_scale(s, step)),
               r0 = uv_near(surface, p, vec_scale(r, -step)), r1 = uv_near(surface, p, vec_scale(r, step));
    const double us = uv_difference(s1.u, s0.u), vs = uv_difference(s1.v, s0.v), ur = uv_difference(r1.u, r0.u),
                 vr = uv_difference(r1.v, r0.v), det = us * vr - vs * ur;
    if (!(fabs(det) > 1e-12 * (us * us + vs * vs + ur * ur + vr * vr)))
        return 0;
    const double sign = det < 0 ? -1 : 1;
    *along_u = vec_scale(vec_mad(vec_scale(s, vr), r, -vs), sign);
    *along_v = vec_scale(vec_mad(vec_scale(r, us), s, -ur), sign);
    return 1;
}

/* Winding makes no front, nor does being closed: rooms are seen from inside. */
static int has_front(const Surface *surface)
{
    const Mesh *mesh = surface->primitive->shape.mesh;
    return mesh && mesh_face_has_normals(&mesh->faces[surface->face]);
}

int surface_tangents(const Surface *surface, int second, Vec3 normal, Vec3 *tangent, Vec3 *bitangent)
{
    const Primitive *primitive = surface->primitive;
    const Mesh *mesh = primitive->shape.mesh;
    Vec3 along_u, along_v;
    if (mesh) {
        if (!mesh_directions(second && mesh->second ? mesh->second : mesh, surface, &along_u, &along_v))
            return 0;
        along_u = transform_vector(&primitive->transform, along_u);
        along_v = transform_vector(&primitive->transform, along_v);
    } else if (!shape_directions(surface, surface_texture_normal(surface), &along_u, &along_v))
        return 0;
    if (surface->backside && !has_front(surface))
        along_u = vec_neg(along_u), along_v = vec_neg(along_v);
    *tangent = perpendicular(vec_normalize(along_u), normal);
    *bitangent = vec_cross(normal, *tangent);
    if (vec_dot(*bitangent, along_v) < 0)
        *bitangent = vec_neg(*bitangent);
    return vec_length(*tangent) > 0;
}

/* ---- gradients ---- */

/* Of what changes by d1 and d2 along the edges of a triangle. */
static Vec3 gradient(Vec3 e1, Vec3 e2, double d1, double d2)
{
    const Vec3 n = vec_cross(e1, e2);
    return vec_scale(vec_add(vec_scale(vec_cross(e2, n), d1), vec_scale(vec_cross(n, e1), d2)), 1 / vec_dot(n, n));
}

static Vec3 to_world(const Surface *surface, Vec3 v)
{
    return surface->instance ? transform_vector(&surface->instance->transform, v) : v;
}

static int mesh_gradients(const Mesh *mesh, const Surface *surface, Vec3 *of_u, Vec3 *of_v)
{
    const Transform *t = &surface->primitive->transform;
    const MeshFace *f = &mesh->faces[surface->face];
    if (!mesh_face_has_uvs(f))
        return 0;
    const Vec3 p = mesh->vertices[f->vertex[0]];
    const Vec3 e1 = to_world(surface, transform_vector(t, vec_sub(mesh->vertices[f->vertex[1]], p))),
               e2 = to_world(surface, transform_vector(t, vec_sub(mesh->vertices[f->vertex[2]], p)));
    const Vec2 *a = &mesh->uvs[f->uv[0]], *b = &mesh->uvs[f->uv[1]], *c = &mesh->uvs[f->uv[2]];
    *of_u = gradient(e1, e2, b->u - a->u, c->u - a->u);
    *of_v = gradient(e1, e2, b->v - a->v, c->v - a->v);
    return 1;
}

/* By differences over the plane that touches the shape, as of tangents. */
static int shape_gradients(const Surface *surface, Vec3 *of_u, Vec3 *of_v)
{
    const Vec3 p = surface_texture_point(surface);
    Vec3 s, r;
    double step[2], du[2], dv[2];
    vec_frame(surface_texture_normal(surface), &s, &r);
    for (int k = 0; k < 2; k++) {
        const Vec3 along = k ? r : s;
        const Transform *t = &surface->primitive->transform;
        step[k] = 1e-4 * vec_length(transform_vector(t, vec_normalize(transform_inverse_vector(t, along))));
        const Vec2 before = uv_near(surface, p, vec_scale(along, -step[k])),
                   after = uv_near(surface, p, vec_scale(along, step[k]));
        du[k] = uv_difference(after.u, before.u), dv[k] = uv_difference(after.v, before.v);
    }
    const Vec3 e1 = to_world(surface, vec_scale(s, 2 * step[0])), e2 = to_world(surface, vec_scale(r, 2 * step[1]));
    *of_u = gradient(e1, e2, du[0], du[1]);
    *of_v = gradient(e1, e2, dv[0], dv[1]);
    return 1;
}

int surface_uv_gradients(const Surface *surface, int second, Vec3 *of_u, Vec3 *of_v)
{
    const Mesh *mesh = surface->primitive->shape.mesh;
    const int any = mesh ? mesh_gradients(second && mesh->second ? mesh->second : mesh, surface, of_u, of_v)
                         : shape_gradients(surface, of_u, of_v);
    const double size = any ? vec_length(*of_u) + vec_length(*of_v) : 0;
    return size > 0 && isfinite(size);
}
