/* Meshes: a mesh2 for each of the model's, declared once and placed by the objects of the scene. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>

#include "import/base/mesh.h"
#include "import/base/tell.h"
#include "import/scene/scene.h"

enum { MOST_COLORS = 4096 };

static long count_surfaces(const struct aiMesh *mesh)
{
    long n = 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        n += mesh_is_surface(mesh, &mesh->mFaces[i]);
    return n;
}

static void write_vectors(FILE *out, const char *what, const struct aiVector3D *v, unsigned count, int is_normal)
{
    fprintf(out, "  %s { %u", what, count);
    for (unsigned i = 0; i < count; i++) {
        if (mesh_is_finite(&v[i]) && (!is_normal || v[i].x != 0 || v[i].y != 0 || v[i].z != 0))
            fprintf(out, ",\n<%.8g,%.8g,%.8g>", (double)v[i].x, (double)v[i].y, v[i].z == 0 ? 0 : -(double)v[i].z);
        else
            fprintf(out, is_normal ? ",\n<0,1,0>" : ",\n<0,0,0>");
    }
    fprintf(out, "\n  }\n");
}

static void write_uvs(FILE *out, const char *what, const struct aiVector3D *v, unsigned count)
{
    fprintf(out, "  %s { %u", what, count);
    for (unsigned i = 0; i < count; i++) {
        const int good = isfinite(v[i].x) && isfinite(v[i].y);
        fprintf(out, ",\n<%.7g,%.7g>", good ? (double)v[i].x : 0, good ? (double)v[i].y : 0);
    }
    fprintf(out, "\n  }");
}

/* ---- colours of vertices: a texture for each, of so few that POV-Ray can hold them ---- */

typedef struct Colors {
    int *of_vertex;   /* index of the texture */
    int (*levels)[3]; /* of each texture */
    int count, bits;
} Colors;

static int level_of(float c, int bits, int is_linear)
{
    const double x = fmin(fmax(isfinite(c) ? (double)c : 0, 0), 1), encoded = is_linear ? retex_srgb_encode(x) : x;
    return (int)lrint(encoded * ((1 << bits) - 1));
}

/* Returns 0 if there are more than MOST_COLORS. */
static int index_colors(const struct aiMesh *mesh, int is_linear, int *known, Colors *colors)
{
    const struct aiColor4D *c = mesh->mColors[0];
    memset(known, 0, sizeof *known << 3 * colors->bits);
    colors->count = 0;
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        const int level[3] = {level_of(c[i].r, colors->bits, is_linear), level_of(c[i].g, colors->bits, is_linear),
                              level_of(c[i].b, colors->bits, is_linear)};
        int *slot = &known[((level[0] << colors->bits) + level[1]) * (1 << colors->bits) + level[2]];
        if (!*slot) {
            if (colors->count == MOST_COLORS)
                return 0;
            memcpy(colors->levels[colors->count], level, sizeof level);
            *slot = ++colors->count;
        }
        colors->of_vertex[i] = *slot - 1;
    }
    return 1;
}

static int find_colors(const Import *import, const struct aiMesh *mesh, Colors *colors, RetexError *err)
{
    enum { MOST_BITS = 7 };
    int *known = malloc(sizeof *known << 3 * MOST_BITS);
    colors->of_vertex = malloc(sizeof *colors->of_vertex * mesh->mNumVertices);
    colors->levels = malloc(sizeof *colors->levels * MOST_COLORS);
    if (known && colors->of_vertex && colors->levels)
        for (colors->bits = MOST_BITS; !index_colors(mesh, import->is_gltf, known, colors);)
            colors->bits--;
    else
        retex_fail(err, RETEX_ENOMEM, "out of memory");
    const int code = known && colors->of_vertex && colors->levels ? RETEX_OK : RETEX_ENOMEM;
    free(known);
    return code;
}

/* They multiply an image, which POV-Ray cannot do. */
static void write_colors(FILE *out, const Colors *colors, const ImportMaterial *material)
{
    const char *before = material->has_image ? "#ifdef (Retex) retex_tint " : "";
    const char *after = material->has_image ? " #end" : "";
    const float one[3] = {1, 1, 1}, *factor = material->has_image ? one : material->vertex_factor;
    const double most = (1 << colors->bits) - 1;
    fprintf(out, "  texture_list { %d", colors->count);
    for (int i = 0; i < colors->count; i++) {
        const int *level = colors->levels[i];
        double c[3];
        for (int k = 0; k < 3; k++)
            c[k] = retex_srgb_decode(level[k] / most) * (double)factor[k];
        fprintf(out, ",\ntexture { %s pigment { %srgb <%.4g,%.4g,%.4g>%s } }", material->name, before, c[0], c[1], c[2],
                after);
    }
    fprintf(out, "\n  }\n");
}

/* Not where all are white. */
static void write_faces(FILE *out, const struct aiMesh *mesh, long count, const Colors *colors)
{
    fprintf(out, "  face_indices { %ld", count);
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const unsigned *v = mesh->mFaces[i].mIndices;
        if (!mesh_is_surface(mesh, &mesh->mFaces[i]))
            continue;
        /* z is mirrored: the other way round, so that the front stays in front */
        fprintf(out, ",\n<%u,%u,%u>", v[0], v[2], v[1]);
        if (!colors->of_vertex)
            continue;
        const int a = colors->of_vertex[v[0]], b = colors->of_vertex[v[1]], c = colors->of_vertex[v[2]];
        if (a == b && b == c)
            fprintf(out, ",%d", a);
        else
            fprintf(out, ",%d,%d,%d", a, c, b);
    }
    fprintf(out, "\n  }\n");
}

/* The set that images ask for, or NULL. */
static const struct aiVector3D *find_uvs(Import *import, const struct aiMesh *mesh, const ImportMaterial *material,
                                         int set)
{
    const struct aiVector3D *const *sets = (const struct aiVector3D *const *)mesh->mTextureCoords;
    if (set < 0)
        return NULL;
    if (set < AI_MAX_NUMBER_OF_TEXTURECOORDS && sets[set])
        return sets[set];
    if (material->has_maps)
        import_leave_out(import, sets[0] ? LEFT_OTHER_UV : LEFT_NO_UV);
    return sets[0];
}

static void write_both_uvs(Import *import, FILE *out, const struct aiMesh *mesh, const ImportMaterial *material)
{
    const struct aiVector3D *first = find_uvs(import, mesh, material, material->uv_set),
                            *second = find_uvs(import, mesh, material, material->second_uv);
    if (!first)
        return;
    write_uvs(out, "uv_vectors", first, mesh->mNumVertices);
    fprintf(out, "\n");
    if (!second || second == first)
        return;
    fprintf(out, "  #ifdef (Retex)\n");
    write_uvs(out, "retex_second_uv_vectors", second, mesh->mNumVertices);
    fprintf(out, " #end\n");
}

static int write_mesh(Import *import, unsigned index, FILE *out, RetexError *err)
{
    const struct aiMesh *mesh = import->scene->mMeshes[index];
    const ImportMaterial *material = &import->materials[mesh->mMaterialIndex];
    const long count = count_surfaces(mesh);
    Colors colors = {0};
    char plain[NAME_SIZE], name[TEXT_SIZE + 8];
    if (count == 0)
        return RETEX_OK;
    if (mesh->mNumVertices > 100000000 || count > 100000000)
        return retex_fail(err, RETEX_ELIMIT, "%s: a mesh of more than 100 million triangles or vertices",
                          import->options->model);
    snprintf(name, sizeof name, "Mesh_%s", mesh->mName.data);
    if (!names_make(&import->names, name, "Mesh", import->meshes[index]))
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    if (mesh_has_colors(mesh) && material->is_solid)
        import_leave_out(import, LEFT_VERTEX_COLORS);
    else if (mesh_has_colors(mesh)) {
        const int code = find_colors(import, mesh, &colors, err);
        if (code)
            return code;
    }
    fprintf(out, "\n// %s: %ld triangle%s\n#declare %s = mesh2 {\n", import_plain(mesh->mName.data, plain), count,
            count == 1 ? "" : "s", import->meshes[index]);
    write_vectors(out, "vertex_vectors", mesh->mVertices, mesh->mNumVertices, 0);
    if (mesh->mNormals)
        write_vectors(out, "normal_vectors", mesh->mNormals, mesh->mNumVertices, 1);
    write_both_uvs(import, out, mesh, material);
    if (colors.of_vertex)
        write_colors(out, &colors, material);
    write_faces(out, mesh, count, &colors);
    fprintf(out, "}\n");
    import->triangles += count;
    free(colors.of_vertex);
    free(colors.levels);
    return RETEX_OK;
}

int meshes_write(Import *import, FILE *out, RetexError *err)
{
    const struct aiScene *scene = import->scene;
    import->meshes = calloc(scene->mNumMeshes + 1, sizeof *import->meshes);
    if (!import->meshes)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    for (unsigned i = 0; i < scene->mNumMeshes; i++) {
        if (scene->mMeshes[i]->mMaterialIndex >= scene->mNumMaterials)
            return retex_fail(err, RETEX_EFORMAT, "%s: a mesh without a material", import->options->model);
        const int code = write_mesh(import, i, out, err);
        if (code)
            return code;
    }
    return RETEX_OK;
}
