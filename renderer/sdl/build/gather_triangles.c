/* Single triangles become meshes: a scene that writes thousands of them would otherwise have as many primitives. Only
 * neighbours that share texture, interior, flags and names are gathered, so that no result changes. */
#include <string.h>
#include "sdl/build/builder.h"

static int same_surface(const Primitive *a, const Primitive *b)
{
    return a->texture == b->texture && a->interior_texture == b->interior_texture && a->interior == b->interior &&
           a->idents == b->idents && a->no_shadow == b->no_shadow && a->no_image == b->no_image &&
           a->no_reflection == b->no_reflection && a->inverse == b->inverse && a->hollow == b->hollow;
}

static void add_face(Mesh *mesh, const Primitive *p)
{
    const Mesh *one = p->shape.mesh;
    MeshFace *face = &mesh->faces[mesh->nfaces++];
    *face = one->faces[0];
    for (int i = 0; i < 3; i++) {
        mesh->vertices[mesh->nvertices] = transform_point(&p->transform, one->vertices[i]);
        face->vertex[i] = mesh->nvertices++;
        if (one->nnormals == 0)
            continue;
        mesh->normals[mesh->nnormals] = transform_normal(&p->transform, one->normals[i]);
        face->normal[i] = mesh->nnormals++;
    }
}

static const Mesh *gather(Sdl *sdl, const Primitive *first, int n)
{
    Mesh *mesh = sdl_alloc(sdl, sizeof *mesh);
    mesh->vertices = sdl_alloc(sdl, 3 * (size_t)n * sizeof *mesh->vertices);
    mesh->normals = sdl_alloc(sdl, 3 * (size_t)n * sizeof *mesh->normals);
    mesh->faces = sdl_alloc(sdl, (size_t)n * sizeof *mesh->faces);
    for (int i = 0; i < n; i++)
        add_face(mesh, &first[i]);
    return mesh;
}

void gather_triangles(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    const unsigned char *single_triangle = builder_of(sdl)->single_triangle;
    int kept = 0;
    for (int i = 0, end; i < scene->nprimitives; i = end) {
        end = i + 1;
        while (single_triangle[i] && end < scene->nprimitives && single_triangle[end] &&
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
