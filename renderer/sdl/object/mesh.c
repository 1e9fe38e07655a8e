/* mesh and mesh2: triangles in arrays, with normals, UVs and textures of their own. */
#include <stddef.h>
#include <string.h>
#include "sdl/object/shape.h"
#include "shape/surface.h"

#define MAX_ELEMENTS 100000000

/* ---- mesh2 ---- */

/* `{ COUNT, …`: the count of a list. */
static int list_count(Sdl *sdl, const char *what)
{
    sdl_expect(sdl, "{");
    double count = sdl_float(sdl);
    if (!(count >= 0 && count <= MAX_ELEMENTS))
        sdl_error(sdl, "%s: %g is not a number of elements", what, count);
    sdl_optional_comma(sdl);
    return (int)count;
}

static void list_end(Sdl *sdl, const char *what, int count)
{
    sdl_optional_comma(sdl);
    if (!sdl_is(sdl, "}"))
        sdl_error(sdl, "%s: more than the %d elements it announces, or no }", what, count);
    sdl_next(sdl);
}

static Vec3 *vectors(Sdl *sdl, const char *what, int *count)
{
    *count = list_count(sdl, what);
    Vec3 *list = sdl_alloc(sdl, (size_t)(*count + 1) * sizeof *list);
    for (int i = 0; i < *count; i++) {
        if (sdl_is(sdl, "}"))
            sdl_error(sdl, "%s: %d elements announced, but only %d are there", what, *count, i);
        list[i] = sdl_vector(sdl);
        sdl_optional_comma(sdl);
    }
    list_end(sdl, what, *count);
    return list;
}

static Vec2 *vectors2(Sdl *sdl, const char *what, int *count)
{
    *count = list_count(sdl, what);
    Vec2 *list = sdl_alloc(sdl, (size_t)(*count + 1) * sizeof *list);
    for (int i = 0; i < *count; i++) {
        if (sdl_is(sdl, "}"))
            sdl_error(sdl, "%s: %d elements announced, but only %d are there", what, *count, i);
        list[i] = sdl_vector2(sdl);
        sdl_optional_comma(sdl);
    }
    list_end(sdl, what, *count);
    return list;
}

static void triple(Sdl *sdl, const char *what, int index, int limit, const char *of, int out[3])
{
    Vec3 v = sdl_vector(sdl);
    const double values[3] = {v.x, v.y, v.z};
    for (int i = 0; i < 3; i++) {
        if (!(values[i] >= 0 && values[i] < limit))
            sdl_error(sdl, "%s: element %d refers to %s %g, of which there are %d", what, index, of, values[i], limit);
        out[i] = (int)values[i];
    }
}

static int texture_index(Sdl *sdl, int ntextures)
{
    double index = sdl_float(sdl);
    if (!(index >= 0 && index < ntextures))
        sdl_error(sdl, "face_indices: texture %g is used, of which texture_list has %d", index, ntextures);
    return (int)index;
}

static const FaceTextures *texture_list(Sdl *sdl)
{
    FaceTextures *textures = sdl_alloc(sdl, sizeof *textures);
    textures->count = list_count(sdl, "texture_list");
    textures->list = sdl_alloc(sdl, (size_t)(textures->count + 1) * sizeof *textures->list);
    for (int i = 0; i < textures->count; i++) {
        if (sdl_accept(sdl, "material")) {
            const ParsedMaterial *material = parse_material(sdl);
            textures->list[i] =
                &texture_named(sdl, material->texture ? material->texture : textures_of(sdl)->default_texture,
                               material->idents)
                     ->texture;
        } else {
            const ParsedTexture *known = accept_ident(sdl, VALUE_TEXTURE);
            if (!known)
                sdl_expect(sdl, "texture");
            textures->list[i] = &(known ? known : parse_texture(sdl))->texture;
        }
        sdl_optional_comma(sdl);
    }
    list_end(sdl, "texture_list", textures->count);
    return textures->count > 0 ? textures : NULL;
}

/* One texture for the face, or one for each corner. */
static void face_textures(Sdl *sdl, Mesh *mesh, int index, int ntextures)
{
    int of_corner[3], count = 0;
    for (; ntextures > 0 && count < 3 && is_float_start(sdl); count++) {
        of_corner[count] = texture_index(sdl, ntextures);
        sdl_optional_comma(sdl);
    }
    mesh->faces[index].texture = count > 0 ? of_corner[0] : -1;
    if (count < 3 && !mesh->corner_textures)
        return;
    if (!mesh->corner_textures) {
        mesh->corner_textures = sdl_alloc(sdl, (size_t)mesh->nfaces * sizeof *mesh->corner_textures);
        for (int i = 0; i < index; i++)
            mesh->corner_textures[i][0] = mesh->corner_textures[i][1] = mesh->faces[i].texture;
    }
    for (int j = 0; j < 2; j++)
        mesh->corner_textures[index][j] = count == 3 ? of_corner[j + 1] : mesh->faces[index].texture;
}

static void face_indices(Sdl *sdl, Mesh *mesh, const FaceTextures *textures)
{
    mesh->nfaces = list_count(sdl, "face_indices");
    mesh->faces = sdl_alloc(sdl, (size_t)(mesh->nfaces + 1) * sizeof *mesh->faces);
    for (int i = 0; i < mesh->nfaces; i++) {
        MeshFace *face = &mesh->faces[i];
        if (sdl_is(sdl, "}"))
            sdl_error(sdl, "face_indices: %d elements announced, but only %d are there", mesh->nfaces, i);
        triple(sdl, "face_indices", i, mesh->nvertices, "vertex", face->vertex);
        sdl_optional_comma(sdl);
        for (int j = 0; j < 3; j++)
            face->normal[j] = face->uv[j] = -1;
        face_textures(sdl, mesh, i, textures ? textures->count : 0);
    }
    list_end(sdl, "face_indices", mesh->nfaces);
}

static int indices(Sdl *sdl, Mesh *mesh, const char *what, int limit, const char *of, size_t offset)
{
    int count = list_count(sdl, what);
    if (count > mesh->nfaces)
        sdl_error(sdl, "%s: %d elements for %d faces; face_indices must come first", what, count, mesh->nfaces);
    for (int i = 0; i < count; i++) {
        if (sdl_is(sdl, "}"))
            sdl_error(sdl, "%s: %d elements announced, but only %d are there", what, count, i);
        triple(sdl, what, i, limit, of, (int *)((char *)&mesh->faces[i] + offset));
        sdl_optional_comma(sdl);
    }
    list_end(sdl, what, count);
    return count;
}

/* Normals or UVs without indices of their own go by the vertices' indices. */
static void by_vertex(Mesh *mesh, int limit, size_t offset)
{
    for (int i = 0; i < mesh->nfaces; i++) {
        const int *vertex = mesh->faces[i].vertex;
        if (vertex[0] < limit && vertex[1] < limit && vertex[2] < limit)
            memcpy((char *)&mesh->faces[i] + offset, vertex, 3 * sizeof *vertex);
    }
}

/* Our extension: a second set of UV, which goes by the same indices. */
static void add_second(Sdl *sdl, Mesh *mesh, Vec2 *uvs, int count)
{
    if (count != mesh->nuvs)
        sdl_error(sdl, "retex_second_uv_vectors: %d elements, but uv_vectors has %d", count, mesh->nuvs);
    Mesh *other = sdl_alloc(sdl, sizeof *other);
    *other = *mesh;
    other->uvs = uvs;
    mesh->second = other;
}

void parse_mesh2(Sdl *sdl, Object *object)
{
    Mesh *mesh = sdl_alloc(sdl, sizeof *mesh);
    int normal_indices = 0, uv_indices = 0, nsecond = 0;
    Vec2 *second = NULL;
    object->shape.ops = &shape_mesh;
    for (;;) {
        if (sdl_accept(sdl, "vertex_vectors"))
            mesh->vertices = vectors(sdl, "vertex_vectors", &mesh->nvertices);
        else if (sdl_accept(sdl, "normal_vectors"))
            mesh->normals = vectors(sdl, "normal_vectors", &mesh->nnormals);
        else if (sdl_accept(sdl, "uv_vectors"))
            mesh->uvs = vectors2(sdl, "uv_vectors", &mesh->nuvs);
        else if (sdl_accept(sdl, "retex_second_uv_vectors"))
            second = vectors2(sdl, "retex_second_uv_vectors", &nsecond);
        else if (sdl_accept(sdl, "texture_list"))
            object->shape.textures = texture_list(sdl);
        else if (sdl_accept(sdl, "face_indices"))
            face_indices(sdl, mesh, object->shape.textures);
        else if (sdl_accept(sdl, "normal_indices"))
            normal_indices +=
                indices(sdl, mesh, "normal_indices", mesh->nnormals, "normal", offsetof(MeshFace, normal));
        else if (sdl_accept(sdl, "uv_indices"))
            uv_indices += indices(sdl, mesh, "uv_indices", mesh->nuvs, "UV", offsetof(MeshFace, uv));
        else if (sdl_accept(sdl, "inside_vector"))
            mesh->closed_inside = vec_length(sdl_vector(sdl)) > 0;
        else
            break;
    }
    if (!mesh->vertices)
        sdl_expected(sdl, "vertex_vectors");
    if (!mesh->faces)
        sdl_expected(sdl, "face_indices");
    if (normal_indices == 0)
        by_vertex(mesh, mesh->nnormals, offsetof(MeshFace, normal));
    if (uv_indices == 0)
        by_vertex(mesh, mesh->nuvs, offsetof(MeshFace, uv));
    object->shape.mesh = mesh;
    mesh->inward = mesh_winds_inward(mesh);
    if (second)
        add_second(sdl, mesh, second, nsecond);
    if (mesh->nfaces == 0)
        object->kind = OBJECT_EMPTY;
}

/* ---- mesh ---- */

typedef struct MeshLists {
    Mesh *mesh;
    FaceTextures *textures;
    int (*corner_textures)[2];
    int blends; /* some face has three textures */
    int vertex_capacity, normal_capacity, uv_capacity, face_capacity, texture_capacity, corner_capacity;
} MeshLists;

static int mesh_texture(Sdl *sdl, MeshLists *b, const ParsedTexture *texture)
{
    FaceTextures *all = b->textures;
    for (int i = all->count; i-- > 0 && i >= all->count - 64;)
        if (all->list[i] == &texture->texture)
            return i;
    all->list = sdl_grow(sdl, all->list, all->count, &b->texture_capacity, sizeof *all->list);
    all->list[all->count] = &texture->texture;
    return all->count++;
}

static void mesh_uvs(Sdl *sdl, MeshLists *b, MeshFace *face)
{
    Mesh *mesh = b->mesh;
    for (int i = 0; i < 3; i++) {
        mesh->uvs = sdl_grow(sdl, mesh->uvs, mesh->nuvs, &b->uv_capacity, sizeof *mesh->uvs);
        mesh->uvs[mesh->nuvs] = sdl_vector2(sdl);
        face->uv[i] = mesh->nuvs++;
        sdl_optional_comma(sdl);
    }
}

static void mesh_corners(Sdl *sdl, MeshLists *b, MeshFace *face, int smooth)
{
    Mesh *mesh = b->mesh;
    for (int i = 0; i < 3; i++) {
        mesh->vertices =
            sdl_grow(sdl, mesh->vertices, mesh->nvertices, &b->vertex_capacity, sizeof *mesh->vertices);
        mesh->vertices[mesh->nvertices] = sdl_vector(sdl);
        face->vertex[i] = mesh->nvertices++;
        sdl_optional_comma(sdl);
        face->normal[i] = face->uv[i] = -1;
        if (smooth) {
            mesh->normals =
                sdl_grow(sdl, mesh->normals, mesh->nnormals, &b->normal_capacity, sizeof *mesh->normals);
            mesh->normals[mesh->nnormals] = sdl_vector(sdl);
            face->normal[i] = mesh->nnormals++;
            sdl_optional_comma(sdl);
        }
    }
}

/* Textures of the corners, after texture_list: one, or three. */
static int triangle_textures(Sdl *sdl, MeshLists *b, int of_corner[3])
{
    int count = 0;
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        const ParsedTexture *known = accept_ident(sdl, VALUE_TEXTURE);
        if (!known)
            sdl_expect(sdl, "texture");
        const int index = mesh_texture(sdl, b, known ? known : parse_texture(sdl));
        if (count < 3)
            of_corner[count++] = index;
        sdl_optional_comma(sdl);
    }
    return count;
}

static void add_triangle(Sdl *sdl, MeshLists *b, MeshFace face, int ntextures, const int of_corner[3])
{
    Mesh *mesh = b->mesh;
    face.texture = ntextures > 0 ? of_corner[0] : -1;
    mesh->faces = sdl_grow(sdl, mesh->faces, mesh->nfaces, &b->face_capacity, sizeof *mesh->faces);
    b->corner_textures =
        sdl_grow(sdl, b->corner_textures, mesh->nfaces, &b->corner_capacity, sizeof *b->corner_textures);
    for (int j = 0; j < 2; j++)
        b->corner_textures[mesh->nfaces][j] = ntextures == 3 ? of_corner[j + 1] : face.texture;
    if (ntextures == 3)
        b->blends = 1;
    mesh->faces[mesh->nfaces++] = face;
}

static void mesh_triangle(Sdl *sdl, MeshLists *b, int smooth)
{
    MeshFace face = {.texture = -1};
    int of_corner[3], ntextures = 0;
    sdl_expect(sdl, "{");
    mesh_corners(sdl, b, &face, smooth);
    while (!sdl_accept(sdl, "}")) {
        if (sdl_accept(sdl, "uv_vectors"))
            mesh_uvs(sdl, b, &face);
        else if (sdl_accept(sdl, "texture")) {
            of_corner[0] = mesh_texture(sdl, b, parse_texture(sdl));
            ntextures = 1;
        } else if (sdl_accept(sdl, "texture_list"))
            ntextures = triangle_textures(sdl, b, of_corner);
        else
            sdl_expected(sdl, "uv_vectors, texture or } in a mesh's triangle");
    }
    add_triangle(sdl, b, face, ntextures, of_corner);
}

void parse_mesh(Sdl *sdl, Object *object)
{
    MeshLists b = {.mesh = sdl_alloc(sdl, sizeof(Mesh)), .textures = sdl_alloc(sdl, sizeof(FaceTextures))};
    object->shape.ops = &shape_mesh;
    for (;;) {
        if (sdl_accept(sdl, "triangle"))
            mesh_triangle(sdl, &b, 0);
        else if (sdl_accept(sdl, "smooth_triangle"))
            mesh_triangle(sdl, &b, 1);
        else if (sdl_accept(sdl, "inside_vector"))
            b.mesh->closed_inside = vec_length(sdl_vector(sdl)) > 0;
        else if (sdl_accept(sdl, "hierarchy"))
            sdl_optional_bool(sdl, 1);
        else
            break;
        sdl_optional_comma(sdl);
    }
    object->shape.mesh = b.mesh;
    object->shape.textures = b.textures->count > 0 ? b.textures : NULL;
    b.mesh->corner_textures = b.blends ? b.corner_textures : NULL;
    b.mesh->inward = mesh_winds_inward(b.mesh);
    if (b.mesh->nfaces == 0)
        object->kind = OBJECT_EMPTY;
}
