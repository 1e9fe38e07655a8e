/* Triangle meshes, in object space. A triangle's outward side is the one its vertex normals lie on; without them, the
 * one its winding gives, turned round for closed meshes that wind inward. They are traced as triangles only.
 * Natural parametrisation: uv_vectors. */
#include "shape/shape.h"

static void triangles(const Shape *shape, ShapeTriangles *out)
{
    const Mesh *mesh = shape->mesh;

    *out = (ShapeTriangles){.nvertices = mesh->nvertices,
                            .ntriangles = mesh->nfaces,
                            .vertices = mesh->vertices,
                            .corners = mesh->nfaces > 0 ? mesh->faces[0].vertex : NULL,
                            .stride = sizeof(MeshFace) / sizeof(int),
                            .per_face = 1};
}

static void bounds(const Primitive *primitive, Vec3 *low, Vec3 *high)
{
    const Mesh *mesh = primitive->shape.mesh;

    for (int i = 0; i < mesh->nvertices; i++)
        shape_bound_point(low, high, transform_point(&primitive->transform, mesh->vertices[i]));
}

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

/* Point and normal of a face; the normal of any length. */
static void point_of_face(const Mesh *mesh, int face, double b1, double b2, ShapePoint *out)
{
    const MeshFace *f = &mesh->faces[face];
    Vec3 n = winding_normal(mesh, f->vertex);
    double third = 1.0 / 3;
    int turn = mesh->inward;

    if (mesh_face_has_normals(f))
        turn = vec_dot(interpolate(mesh->normals, f->normal, third, third, third), n) < 0;
    out->p = interpolate(mesh->vertices, f->vertex, 1 - b1 - b2, b1, b2);
    out->normal = turn ? vec_neg(n) : n;
    out->b1 = b1, out->b2 = b2;
}

static Vec3 face_normal(const Primitive *primitive, int face, const Vec3 corner[3])
{
    Vec3 n = vec_normalize(vec_cross(vec_sub(corner[1], corner[0]), vec_sub(corner[2], corner[0])));
    ShapePoint at;

    point_of_face(primitive->shape.mesh, face, 0, 0, &at);
    return vec_dot(n, shape_world_normal(primitive, at.normal)) < 0 ? vec_neg(n) : n;
}

Vec3 mesh_shading_normal(const Mesh *mesh, int face, double b1, double b2)
{
    const MeshFace *f = &mesh->faces[face];

    return mesh_face_has_normals(f) ? interpolate(mesh->normals, f->normal, 1 - b1 - b2, b1, b2) : vec3(0, 0, 0);
}

static void uv(const Surface *surface, ShapeUv *out)
{
    const Mesh *mesh = surface->primitive->shape.mesh;
    const MeshFace *f = &mesh->faces[surface->face];
    double b1 = surface->b1, b2 = surface->b2, b0 = 1 - b1 - b2;

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

/* ---- sampling: of a face that the caller chooses ---- */

double mesh_face_area(const Primitive *primitive, int face)
{
    const Vec3 *v = primitive->shape.mesh->vertices;
    const int *index = primitive->shape.mesh->faces[face].vertex;

    return shape_stretch(&primitive->transform, vec_sub(v[index[1]], v[index[0]]), vec_sub(v[index[2]], v[index[0]])) /
           2;
}

static double area(const Primitive *primitive)
{
    double sum = 0;

    for (int i = 0; i < primitive->shape.mesh->nfaces; i++)
        sum += mesh_face_area(primitive, i);
    return sum;
}

static double density(const Primitive *primitive, Vec3 p, int face)
{
    (void)p;
    return shape_inverse(mesh_face_area(primitive, face));
}

static double sample(const Primitive *primitive, double u1, double u2, int *face, ShapePoint *out)
{
    double root = sqrt(u1);

    point_of_face(primitive->shape.mesh, *face, root * (1 - u2), root * u2, out);
    return density(primitive, out->p, *face);
}

const ShapeOps shape_mesh = {
    .name = "mesh",
    .properties = SHAPE_UV_NATURAL,
    .bounds = bounds,
    .uv = uv,
    .area = area,
    .sample = sample,
    .density = density,
    .triangles = triangles,
    .face_normal = face_normal,
};
