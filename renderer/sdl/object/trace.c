/* Functions of the language that ask where an object is: trace() and inside().
 *
 * An object is made into a tree of CSG once (csg.c), in its own space. The tree is kept for the next call, by the
 * address of the object: objects never change, and live as long as the scene. */
#include "sdl/object/csg.h"
#include "shape/shape.h"
#include "shape/surface.h"

#define NEAREST 1e-4 /* nothing is hit closer than that, as in POV-Ray */

/* ---- what is kept ---- */

typedef struct Solid {
    const Object *object;
    const Csg *csg;
    struct Solid *next;
} Solid;

enum { BUCKETS = 1024 };
struct Tracer {
    Solid *buckets[BUCKETS];
};

const Csg *object_solid(Sdl *sdl, const Object *object)
{
    ObjectState *objects = objects_of(sdl);
    if (!objects->tracer)
        objects->tracer = sdl_alloc(sdl, sizeof *objects->tracer);
    Solid **bucket = &objects->tracer->buckets[((uintptr_t)object >> 4) * 2654435761u % BUCKETS], *solid;
    for (solid = *bucket; solid; solid = solid->next)
        if (solid->object == object)
            return solid->csg;
    solid = sdl_alloc(sdl, sizeof *solid);
    *solid = (Solid){object, csg_of_object(sdl, object), *bucket};
    *bucket = solid;
    return solid->csg;
}

static const Object *object_of(const Value *value)
{
    return value->kind == VALUE_OBJECT || value->kind == VALUE_LIGHT ? value->data : NULL;
}

/* ---- inside() ---- */

/* As POV-Ray has it: a plane and a disc have all that lies below them, open cones and cylinders what they would have
 * with their caps, meshes something only with inside_vector. */
int object_inside(Sdl *sdl, const Value *value, Vec3 p)
{
    const Object *object = object_of(value);
    if (!object)
        return -1;
    const Csg *csg = object_solid(sdl, object);
    sdl_step(sdl, csg->root->nwide);
    return isfinite(p.x + p.y + p.z) && csg_inside(csg->root, p);
}

/* ---- trace() ---- */

/* Normals as POV-Ray has them: of smooth triangles what is written, of others by the order of the corners, which turn
 * the other way round in polygons. (POV-Ray reorders a single triangle's corners when it is transformed, so that its
 * normal may come out turned round there.) */
static Vec3 mesh_normal(const Object *object, const Transform *t, const Hit *hit)
{
    const Mesh *mesh = object->shape.mesh;
    const MeshFace *f = &mesh->faces[hit->face];
    if (f->normal[0] >= 0 && f->normal[1] >= 0 && f->normal[2] >= 0) {
        const double weights[3] = {1 - hit->b1 - hit->b2, hit->b1, hit->b2};
        Vec3 sum = {0, 0, 0};
        for (int i = 0; i < 3; i++) {
            Vec3 n = transform_normal(t, vec_normalize(mesh->normals[f->normal[i]]));
            sum = vec_mad(sum, object->single_triangle ? vec_normalize(n) : n, weights[i]);
        }
        return sum;
    }
    Vec3 p0 = mesh->vertices[f->vertex[0]];
    Vec3 n = vec_cross(vec_sub(mesh->vertices[f->vertex[1]], p0), vec_sub(mesh->vertices[f->vertex[2]], p0));
    n = transform_normal(t, n);
    return object->polygon ? n : vec_neg(n);
}

static Vec3 normal_at(const CsgQuery *found)
{
    const Primitive *p = found->leaf->primitive;
    const Object *object = solid_leaf(p)->object;
    Hit hit = {.t = found->t, .primitive = 0, .face = found->face};
    shape_complete_hit(p, &found->ray, &hit);
    if (p->shape.mesh) {
        Vec3 n = vec_normalize(mesh_normal(object, &p->transform, &hit));
        return p->inverse && !object->single_triangle ? vec_neg(n) : n;
    }
    const Scene scene = {.primitives = (Primitive *)p, .nprimitives = 1};
    Surface surface;
    surface_at(&surface, &scene, &found->ray, &hit);
    return surface.shading_normal;
}

int object_trace(Sdl *sdl, const Value *value, Vec3 from, Vec3 direction, Vec3 *point, Vec3 *normal)
{
    const Object *object = object_of(value);
    *point = *normal = vec3(0, 0, 0);
    if (!object)
        return 0;
    CsgQuery query = {.ray = {from, vec_normalize(direction), NEAREST, INFINITY}};
    const Vec3 all = vec_add(from, query.ray.direction);
    if (!isfinite(all.x + all.y + all.z) || vec_length(query.ray.direction) == 0)
        return 1;
    const Csg *csg = object_solid(sdl, object);
    sdl_step(sdl, csg->nunbounded);
    if (!csg_intersect(csg, &query))
        return 1;
    *point = vec_mad(from, query.ray.direction, query.t);
    *normal = normal_at(&query);
    return 1;
}
