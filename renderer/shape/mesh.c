/* Triangle meshes, in object space. A triangle's outward side is the one its vertex normals lie on; without them, the
 * one its winding gives, turned round for closed meshes that wind inward. Paths trace them as triangles; operands of
 * CSG, trace() and inside() go by a tree over the faces. Between corners with textures of their own these are blended:
 * a point has each with the corner's barycentric weight as its probability. Natural parametrisation: uv_vectors. */
#include <stdlib.h>
#include "base/bvh.h"
#include "shape/shape.h"
#include "shape/surface.h"

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

int mesh_uv(const Mesh *mesh, const Surface *surface, Vec2 *uv)
{
    const MeshFace *f = &mesh->faces[surface->face];
    double b1 = surface->b1, b2 = surface->b2, b0 = 1 - b1 - b2;

    if (!mesh_face_has_uvs(f))
        return 0;
    const Vec2 *a = &mesh->uvs[f->uv[0]], *b = &mesh->uvs[f->uv[1]], *c = &mesh->uvs[f->uv[2]];
    uv->u = b0 * a->u + b1 * b->u + b2 * c->u;
    uv->v = b0 * a->v + b1 * b->v + b2 * c->v;
    return 1;
}

static void uv(const Surface *surface, ShapeUv *out)
{
    out->has_uv = out->has_natural = mesh_uv(surface->primitive->shape.mesh, surface, &out->uv);
    out->natural = out->uv;
}

static int texture(const Surface *surface)
{
    const Mesh *mesh = surface->primitive->shape.mesh;
    const int own = mesh->faces[surface->face].texture;

    if (!mesh_face_blends(mesh, surface->face))
        return own;
    const double share = shape_share(surface->position);
    if (share < surface->b1)
        return mesh->corner_textures[surface->face][0];
    return share < surface->b1 + surface->b2 ? mesh->corner_textures[surface->face][1] : own;
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

/* ---- in double, through a tree ---- */

int mesh_index(Arena *arena, Mesh *mesh)
{
    Bounds *bounds;
    Bvh *tree;
    int made;

    if (mesh->tree)
        return 1;
    tree = arena_alloc(arena, sizeof *tree);
    bounds = malloc(((size_t)mesh->nfaces + 1) * sizeof *bounds);
    for (int i = 0; bounds && i < mesh->nfaces; i++) {
        bounds[i] = bounds_empty();
        for (int k = 0; k < 3; k++)
            bounds_add(&bounds[i], mesh->vertices[mesh->faces[i].vertex[k]]);
        bounds[i] = bounds_padded(bounds[i]);
    }
    made = tree && bounds && bvh_create(tree, arena, bounds, mesh->nfaces);
    free(bounds);
    if (made)
        mesh->tree = tree;
    return made;
}

/* Where a ray meets a face, up to this far beyond its edges. A ray that starts on the face's plane does not. */
static int meets_face(const Mesh *mesh, int face, const Ray *ray, double slack, double beyond, double *t)
{
    const int *v = mesh->faces[face].vertex;
    Vec3 p0 = mesh->vertices[v[0]], e1 = vec_sub(mesh->vertices[v[1]], p0), e2 = vec_sub(mesh->vertices[v[2]], p0);
    Vec3 across = vec_cross(ray->direction, e2), from = vec_sub(ray->origin, p0), over = vec_cross(from, e1);
    double volume = vec_dot(e1, across), height = vec_dot(e2, over), b1, b2;

    if (volume == 0 || fabs(height) <= slack * vec_length(vec_cross(e1, e2)))
        return 0;
    b1 = vec_dot(from, across) / volume;
    b2 = vec_dot(ray->direction, over) / volume;
    *t = height / volume;
    return b1 >= -beyond && b2 >= -beyond && b1 + b2 <= 1 + beyond && *t > ray->tmin && *t < ray->tmax;
}

typedef struct FaceQuery {
    const Mesh *mesh;
    double slack;
    int face, count;
} FaceQuery;

/* The edges belong to both faces: no crack between them. */
static int nearest_face(void *context, Ray *ray, int face)
{
    FaceQuery *query = context;
    double t;

    if (meets_face(query->mesh, face, ray, query->slack, 1e-12, &t))
        ray->tmax = t, query->face = face;
    return 0;
}

static int count_face(void *context, Ray *ray, int face)
{
    FaceQuery *query = context;
    double t;

    query->count += meets_face(query->mesh, face, ray, 0, 0, &t);
    return 0;
}

static void along_ray(const Mesh *mesh, Ray *ray, BvhRayVisit *visit, FaceQuery *query)
{
    if (mesh->tree)
        bvh_along_ray(mesh->tree, ray, visit, query);
    else
        for (int i = 0; i < mesh->nfaces; i++)
            visit(query, ray, i);
}

static int intersect(const Primitive *primitive, const ShapeRay *ray, double *t, int *face)
{
    FaceQuery query = {primitive->shape.mesh, ray->slack, -1, 0};
    Ray along = {ray->origin, ray->direction, ray->tmin, ray->tmax};

    along_ray(primitive->shape.mesh, &along, nearest_face, &query);
    if (query.face < 0)
        return 0;
    *t = along.tmax;
    *face = query.face;
    return 1;
}

/* An odd number of faces lies between p and far away. */
static int inside(const Shape *shape, Vec3 p)
{
    FaceQuery query = {shape->mesh, 0, -1, 0};
    Ray ray = {p, vec3(0.4472135, 0.8944272, 0.0031415), 0, INFINITY}; /* any that is along no edges */

    if (!shape->mesh->closed_inside)
        return 0;
    along_ray(shape->mesh, &ray, count_face, &query);
    return query.count & 1;
}

void mesh_barycentrics(const Mesh *mesh, int face, Vec3 p, double *b1, double *b2)
{
    const int *v = mesh->faces[face].vertex;
    Vec3 p0 = mesh->vertices[v[0]], e1 = vec_sub(mesh->vertices[v[1]], p0), e2 = vec_sub(mesh->vertices[v[2]], p0);
    Vec3 n = vec_cross(e1, e2), at = vec_sub(p, p0);
    double scale = shape_inverse(vec_dot(n, n));

    *b1 = fmin(fmax(vec_dot(vec_cross(at, e2), n) * scale, 0), 1);
    *b2 = fmin(fmax(vec_dot(vec_cross(e1, at), n) * scale, 0), 1 - *b1);
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
    .intersect = intersect,
    .uv = uv,
    .inside = inside,
    .texture = texture,
    SHAPE_SAMPLED,
    .triangles = triangles,
    .face_normal = face_normal,
};
