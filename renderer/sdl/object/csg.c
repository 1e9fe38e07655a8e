/* Objects as trees of CSG: what they contain, for clipped_by, bounded_by, inside() and trace(). */
#include "sdl/object/csg.h"
#include "shape/shape.h"
#include "shape/surface.h"

/* Turned inside out, a union or merge is the intersection of its children turned inside out, and the reverse. */
static CsgKind kind_of(const Object *object, int inverse)
{
    CsgKind kind = object->kind == OBJECT_SHAPE ? CSG_LEAF : object->kind == OBJECT_COMPOUND ? object->csg : CSG_UNION;
    if (!inverse || kind == CSG_LEAF)
        return kind;
    return kind == CSG_INTERSECTION ? CSG_MERGE : CSG_INTERSECTION;
}

static CsgNode *checked(Sdl *sdl, CsgNode *node)
{
    if (!node)
        sdl_error(sdl, "out of memory for CSG");
    return node;
}

Csg *csg_complete(Sdl *sdl, CsgNode *root)
{
    Csg *csg = csg_create(sdl_arena(sdl), root);
    if (!csg)
        sdl_error(sdl, "out of memory for CSG");
    return csg;
}

static CsgNode *solid(Sdl *sdl, const Object *object, const Transform *outer, unsigned inverse, CsgNode *parent);

static CsgNode *clip_solid(Sdl *sdl, const Object *object, const ClipList *clip, const Transform *outer)
{
    const Transform moved = transform_then(transform_inverse(clip->written), object->transform);
    const Transform by = transform_then(moved, *outer);
    return solid(sdl, clip->object, &by, 0, NULL);
}

static void add_bounds(Sdl *sdl, CsgNode *node, const Object *object, const Transform *outer)
{
    for (const ClipList *bound = object->bounds; bound; bound = bound->next) {
        Csg *csg = csg_complete(sdl, clip_solid(sdl, object, bound, outer));
        csg->next = node->bounds;
        node->bounds = csg;
    }
}

CsgNode *object_csg_node(Sdl *sdl, const Object *object, const Transform *outer, unsigned inverse, CsgNode *parent)
{
    CsgNode *node = checked(sdl, csg_node(sdl_arena(sdl), kind_of(object, inverse != 0), parent));
    for (const ClipList *clip = object->clips; clip; clip = clip->next) {
        CsgNode *root = clip_solid(sdl, object, clip, outer);
        root->next = node->clips;
        node->clips = root;
    }
    if (object->bounds)
        add_bounds(sdl, node, object, outer);
    return node;
}

static void add_leaf(Sdl *sdl, const Object *object, const Transform *to_world, unsigned inverse, CsgNode *node)
{
    SolidLeaf *leaf = sdl_alloc(sdl, sizeof *leaf);
    if (object->shape.mesh)
        index_mesh(sdl, object->shape.mesh);
    leaf->object = object;
    leaf->primitive = (Primitive){.shape = object->shape,
                                  .transform = *to_world,
                                  .inverse = inverse != 0,
                                  .csg = node,
                                  .target = -1,
                                  .interior_target = -1};
    node->primitive = &leaf->primitive;
}

static CsgNode *solid(Sdl *sdl, const Object *object, const Transform *outer, unsigned inverse, CsgNode *parent)
{
    const Transform to_world = transform_then(object->transform, *outer);
    object_report(sdl, object);
    sdl_step(sdl, 1);
    inverse ^= object->flags & OBJECT_INVERSE;
    CsgNode *node = object_csg_node(sdl, object, outer, inverse, parent);
    if (object->kind == OBJECT_SHAPE) {
        add_leaf(sdl, object, &to_world, inverse, node);
        return node;
    }
    Transform within = to_world;
    if (object->kind == OBJECT_LIGHT) /* what it looks like */
        within = transform_then(transform_translate(object->light->location), to_world);
    for (const ObjectList *list = object->children; list; list = list->next)
        if (list->object->kind != OBJECT_LIGHT || list->object->children)
            solid(sdl, list->object, &within, inverse, node);
    return node;
}

Csg *csg_of_object(Sdl *sdl, const Object *object)
{
    const Transform none = transform_identity();
    return csg_complete(sdl, solid(sdl, object, &none, 0, NULL));
}

void index_mesh(Sdl *sdl, const Mesh *mesh)
{
    sdl_step(sdl, mesh->tree ? 0 : mesh->nfaces);
    if (!mesh_index(sdl_arena(sdl), (Mesh *)mesh))
        sdl_error(sdl, "out of memory for a mesh of %d faces", mesh->nfaces);
}
