/* Single triangles become meshes: a scene that writes thousands of them would otherwise have as many primitives. Only
 * neighbours that share texture, interior, flags and names are gathered, so that no result changes. In a union they are
 * gathered when it is read, so that all its copies share the mesh; others when the scene is complete. */
#include <string.h>
#include "sdl/object/object.h"

static int same_surface(const Primitive *a, const Primitive *b)
{
    return a->texture == b->texture && a->interior_texture == b->interior_texture && a->interior == b->interior &&
           a->idents == b->idents && a->no_shadow == b->no_shadow && a->no_image == b->no_image &&
           a->no_reflection == b->no_reflection && a->inverse == b->inverse && a->hollow == b->hollow &&
           a->double_illuminate == b->double_illuminate && a->prototype == b->prototype && a->inherits == b->inherits;
}

static void add_face(Mesh *mesh, const Mesh *one, const Transform *by)
{
    MeshFace *face = &mesh->faces[mesh->nfaces++];
    *face = one->faces[0];
    for (int i = 0; i < 3; i++) {
        mesh->vertices[mesh->nvertices] = transform_point(by, one->vertices[i]);
        face->vertex[i] = mesh->nvertices++;
        if (one->nnormals == 0)
            continue;
        mesh->normals[mesh->nnormals] = transform_normal(by, one->normals[i]);
        face->normal[i] = mesh->nnormals++;
    }
}

static Mesh *mesh_for(Sdl *sdl, int n)
{
    Mesh *mesh = sdl_alloc(sdl, sizeof *mesh);
    mesh->vertices = sdl_alloc(sdl, 3 * (size_t)n * sizeof *mesh->vertices);
    mesh->normals = sdl_alloc(sdl, 3 * (size_t)n * sizeof *mesh->normals);
    mesh->faces = sdl_alloc(sdl, (size_t)n * sizeof *mesh->faces);
    return mesh;
}

/* ---- children of a union ---- */

static int same_texture(const MovedTexture *a, const MovedTexture *b)
{
    return a->texture == b->texture && a->is_moved == b->is_moved &&
           (!a->is_moved || memcmp(&a->transform, &b->transform, sizeof a->transform) == 0);
}

static int is_single(const Object *object)
{
    return object->kind == OBJECT_SHAPE && object->single_triangle == TRIANGLE_SINGLE && !object->clips &&
           !object->bounds && !object->gaps.bits && !object->gaps.patterns;
}

static int can_join(const Object *a, const Object *b)
{
    return is_single(b) && same_texture(&a->texture, &b->texture) &&
           same_texture(&a->interior_texture, &b->interior_texture) && a->interior == b->interior &&
           a->flags == b->flags && a->uv_mapping == b->uv_mapping && a->idents == b->idents;
}

static const Object *joined(Sdl *sdl, const ObjectList *first, const ObjectList *end, int n)
{
    Object *object = sdl_alloc(sdl, sizeof *object);
    Mesh *mesh = mesh_for(sdl, n);
    *object = *first->object;
    for (const ObjectList *list = first; list != end; list = list->next)
        add_face(mesh, list->object->shape.mesh, &list->object->transform);
    object->shape.mesh = mesh;
    object->transform = transform_identity();
    object->single_triangle = TRIANGLES_GATHERED;
    return object;
}

void gather_children(Sdl *sdl, Object *compound)
{
    for (ObjectList *list = (ObjectList *)compound->children; list; list = list->next) {
        ObjectList *end = list->next;
        int n = 1;
        if (!is_single(list->object))
            continue;
        for (; end && can_join(list->object, end->object); end = end->next)
            n++;
        if (n == 1)
            continue;
        list->object = joined(sdl, list, end, n);
        list->next = end;
    }
}

/* ---- primitives ---- */

static const Mesh *gather(Sdl *sdl, const Primitive *first, int n)
{
    Mesh *mesh = mesh_for(sdl, n);
    for (int i = 0; i < n; i++)
        add_face(mesh, first[i].shape.mesh, &first[i].transform);
    return mesh;
}

void gather_triangles(Sdl *sdl, const unsigned char *single)
{
    Scene *scene = sdl_scene(sdl);
    int kept = 0;
    for (int i = 0, end; i < scene->nprimitives; i = end) {
        end = i + 1;
        while (single[i] && end < scene->nprimitives && single[end] &&
               same_surface(&scene->primitives[i], &scene->primitives[end]))
            end++;
        Primitive p = scene->primitives[i];
        if (end - i > 1) {
            p.shape.mesh = gather(sdl, &scene->primitives[i], end - i);
            p.transform = transform_identity();
        }
        scene->primitives[kept++] = p;
    }
    scene->nprimitives = kept;
}
