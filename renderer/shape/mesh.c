/* Points of triangle meshes, in object space. A triangle's outward side is the one its vertex normals lie on; without
 * them, the one its winding gives, turned round for closed meshes that wind inward. */
#include "shape/shapes.h"

static Vec3 interpolate(const Vec3 *values, const int index[3], double b0, double b1, double b2)
{
    Vec3 p = vec_scale(values[index[0]], b0);

    return vec_mad(vec_mad(p, values[index[1]], b1), values[index[2]], b2);
}

static Vec3 winding_normal(const Mesh *mesh, const int vertex[3])
{
    Vec3 v0 = mesh->vertices[vertex[0]];

    return vec_cross(vec_sub(mesh->vertices[vertex[1]], v0), vec_sub(mesh->vertices[vertex[2]], v0));
}

void mesh_point(const Mesh *mesh, int face, double b1, double b2, ShapePoint *out)
{
    const MeshFace *f = &mesh->faces[face];
    Vec3 n = winding_normal(mesh, f->vertex);
    double third = 1.0 / 3;
    int turn = mesh->inward;

    if (mesh_face_has_normals(f))
        turn = vec_dot(interpolate(mesh->normals, f->normal, third, third, third), n) < 0;
    out->p = interpolate(mesh->vertices, f->vertex, 1 - b1 - b2, b1, b2);
    out->normal = turn ? vec_neg(n) : n;
}

Vec3 mesh_shading_normal(const Mesh *mesh, int face, double b1, double b2)
{
    const MeshFace *f = &mesh->faces[face];

    return mesh_face_has_normals(f) ? interpolate(mesh->normals, f->normal, 1 - b1 - b2, b1, b2) : vec3(0, 0, 0);
}

void mesh_uv(const Mesh *mesh, int face, double b1, double b2, ShapeUv *out)
{
    const MeshFace *f = &mesh->faces[face];
    double b0 = 1 - b1 - b2;

    out->has_uv = out->has_natural = mesh_face_has_uvs(f);
    if (out->has_uv) {
        const Vec2 *a = &mesh->uvs[f->uv[0]], *b = &mesh->uvs[f->uv[1]], *c = &mesh->uvs[f->uv[2]];
        out->uv.u = b0 * a->u + b1 * b->u + b2 * c->u;
        out->uv.v = b0 * a->v + b1 * b->v + b2 * c->v;
        out->natural = out->uv;
    }
}

int mesh_winds_inward(const Mesh *mesh)
{
    Vec3 sum = {0, 0, 0}, origin;
    double area = 0, volume = 0;

    if (mesh->nfaces == 0)
        return 0;
    origin = mesh->vertices[mesh->faces[0].vertex[0]];
    for (int i = 0; i < mesh->nfaces; i++) {
        Vec3 n = winding_normal(mesh, mesh->faces[i].vertex);
        sum = vec_add(sum, n);
        area += vec_length(n);
        volume += vec_dot(n, vec_sub(mesh->vertices[mesh->faces[i].vertex[0]], origin));
    }
    /* The areas of a closed surface, as vectors, add up to nothing. An open one has no inside. */
    return volume < 0 && vec_length(sum) < 1e-6 * area;
}
