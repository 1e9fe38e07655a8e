/* Variants of a glTF file, before Assimp reads it, which knows nothing of them. See gltf.h. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "import/base/tell.h"
#include "import/gltf/gltf.h"
#include "import/gltf/json.h"

enum { MOST_VARIANTS = 1024, MOST_SURFACES = 1024 };

static const char extension[] = "KHR_materials_variants";

static const json_t *variants_of(const json_t *json)
{
    return json_object_get(gltf_extension(json, extension), "variants");
}

static const char *name_of(const json_t *variants, size_t index, char plain[NAME_SIZE])
{
    const char *name = json_string_value(json_object_get(json_array_get(variants, index), "name"));
    char number[32];
    snprintf(number, sizeof number, "variants[%zu]", index);
    return import_plain(name && *name ? name : number, plain);
}

void gltf_variants_list(const Import *import, const json_t *json)
{
    const json_t *variants = variants_of(json);
    char plain[NAME_SIZE];
    for (size_t i = 0; i < json_array_size(variants); i++)
        import_tell(import, IMPORT_ANSWER, "%s", name_of(variants, i, plain));
}

static int find_variant(const json_t *variants, const char *name)
{
    char plain[NAME_SIZE];
    int found = -1;
    for (size_t i = 0; i < json_array_size(variants); i++) {
        name_of(variants, i, plain);
        if (strcmp(plain, name) == 0)
            return (int)i;
        found = found < 0 && strcasecmp(plain, name) == 0 ? (int)i : found;
    }
    return found;
}

static void refuse_name(const json_t *variants, const char *name, char refused[GLTF_REFUSED_SIZE])
{
    char plain[NAME_SIZE], all[160] = "";
    const size_t count = json_array_size(variants);
    for (size_t i = 0; i < count && strlen(all) < 90; i++)
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s`%s`", i ? ", " : "", name_of(variants, i, plain));
    snprintf(refused, GLTF_REFUSED_SIZE, count ? "it has no variant `%.40s`; there are %s" : "it has no variants", name,
             all);
}

/* ---- primitives ---- */

/* A call for each primitive with variants; returns the material that it gets, or -1: as it is. */
typedef int Choose(void *context, const json_t *mappings, int material);

static int integer_of(const json_t *number, size_t count)
{
    const json_int_t value = json_is_integer(number) ? json_integer_value(number) : -1;
    return value >= 0 && value < (json_int_t)count ? (int)value : -1;
}

static int visit_primitives(json_t *json, Choose *choose, void *context)
{
    const json_t *meshes = json_object_get(json, "meshes");
    const size_t nmaterials = json_array_size(json_object_get(json, "materials"));
    int any = 0;
    for (size_t i = 0; i < json_array_size(meshes); i++) {
        const json_t *primitives = json_object_get(json_array_get(meshes, i), "primitives");
        for (size_t k = 0; k < json_array_size(primitives); k++) {
            json_t *primitive = json_array_get(primitives, k);
            const json_t *mappings = json_object_get(gltf_extension(primitive, extension), "mappings");
            const int own = integer_of(json_object_get(primitive, "material"), nmaterials);
            const int chosen = json_array_size(mappings) ? choose(context, mappings, own) : -1;
            if (chosen >= 0 && chosen != own)
                any |= json_object_set_new(primitive, "material", json_integer(chosen)) == 0;
        }
    }
    return any;
}

/* What a variant makes of a primitive, or -1: nothing. The last mapping counts. */
static int mapped(const json_t *mappings, int variant, size_t nmaterials)
{
    int material = -1;
    for (size_t m = 0; m < json_array_size(mappings); m++) {
        const json_t *mapping = json_array_get(mappings, m), *of = json_object_get(mapping, "variants");
        for (size_t k = 0; k < json_array_size(of); k++)
            if (json_is_integer(json_array_get(of, k)) && json_integer_value(json_array_get(of, k)) == variant)
                material = integer_of(json_object_get(mapping, "material"), nmaterials);
    }
    return material;
}

/* ---- one variant ---- */

typedef struct Chosen {
    int variant;
    size_t nmaterials;
} Chosen;

static int choose_variant(void *context, const json_t *mappings, int material)
{
    const Chosen *chosen = context;
    (void)material;
    return mapped(mappings, chosen->variant, chosen->nmaterials);
}

/* ---- all of them ---- */

typedef struct Noting {
    json_t *json;
    Variants *variants;
    size_t nmaterials; /* of the file */
    int *others;       /* of the primitive */
    int *own;          /* by surfaces: the material that they have in the file; the others are as in the file */
    int failed;        /* too many, or no memory */
} Noting;

/* Surfaces with a copy of their material, for others may have it too. */
static int add_surfaces(Noting *n, int material)
{
    Variants *v = n->variants;
    json_t *materials = json_object_get(n->json, "materials");
    const size_t bytes = (size_t)v->count * sizeof *n->others;
    VariantSurfaces *added = &v->surfaces[v->nsurfaces];
    json_t *copy = material < 0 ? json_object() : json_copy(json_array_get(materials, (size_t)material));
    if (!copy || v->nsurfaces == MOST_SURFACES || !(added->others = malloc(bytes)) ||
        json_array_append(materials, copy) != 0) {
        json_decref(copy);
        return -1;
    }
    json_decref(copy);
    memcpy(added->others, n->others, bytes);
    n->own[v->nsurfaces] = material;
    added->material = (int)json_array_size(materials) - 1;
    return v->nsurfaces++;
}

static int note_primitive(void *context, const json_t *mappings, int material)
{
    Noting *n = context;
    Variants *v = n->variants;
    int changes = 0, k = 0;
    for (int i = 0; i < v->count; i++) {
        const int other = mapped(mappings, i, n->nmaterials);
        n->others[i] = other < 0 ? material : other;
        changes |= n->others[i] != material;
    }
    if (!changes || n->failed)
        return -1;
    while (k < v->nsurfaces && (n->own[k] != material ||
                                memcmp(v->surfaces[k].others, n->others, (size_t)v->count * sizeof *n->others) != 0))
        k++;
    if (k == v->nsurfaces && (k = add_surfaces(n, material)) < 0) {
        n->failed = 1;
        return -1;
    }
    return v->surfaces[k].material;
}

/* A primitive that kept its material keeps the material of its own. */
static void finish_surfaces(Noting *n)
{
    Variants *v = n->variants;
    for (int k = 0; k < v->nsurfaces; k++)
        for (int i = 0; i < v->count; i++)
            if (v->surfaces[k].others[i] == n->own[k])
                v->surfaces[k].others[i] = v->surfaces[k].material;
}

/* ---- materials that no mesh has ---- */

static json_t *array_of(json_t *json, const char *key)
{
    json_t *array = json_object_get(json, key);
    if (json_is_array(array))
        return array;
    array = json_array();
    return json_object_set_new(json, key, array) == 0 ? array : NULL;
}

static int append(json_t *json, const char *key, json_t *element)
{
    json_t *array = array_of(json, key);
    const int at = (int)json_array_size(array);
    return array && json_array_append_new(array, element) == 0 ? at : -1;
}

/* An accessor of three points in one place. */
static int add_points(json_t *json)
{
    static const char zeros[] = "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"; /* 36 bytes */
    const int buffer =
        append(json, "buffers",
               json_pack("{s:i, s:s+}", "byteLength", 36, "uri", "data:application/octet-stream;base64,", zeros));
    const int view = append(json, "bufferViews", json_pack("{s:i, s:i}", "buffer", buffer, "byteLength", 36));
    return append(json, "accessors",
                  json_pack("{s:i, s:i, s:i, s:s, s:[i,i,i], s:[i,i,i]}", "bufferView", view, "componentType", 5126,
                            "count", 3, "type", "VEC3", "min", 0, 0, 0, "max", 0, 0, 0));
}

/* Assimp reads the materials that meshes have: a mesh without area gets all that variants name. */
static int add_mesh(json_t *json, const Variants *v, size_t nmaterials)
{
    char *is_there = calloc(nmaterials + 1, 1);
    json_t *primitives = json_array();
    const int points = add_points(json);
    for (int k = 0; is_there && k < v->nsurfaces; k++)
        for (int i = 0; i < v->count; i++) {
            const int other = v->surfaces[k].others[i];
            if (other < 0 || other >= (int)nmaterials || is_there[other])
                continue;
            is_there[other] = 1;
            json_array_append_new(primitives,
                                  json_pack("{s:{s:i}, s:i}", "attributes", "POSITION", points, "material", other));
        }
    const int mesh = append(json, "meshes", json_pack("{s:o}", "primitives", primitives));
    const int node = append(json, "nodes", json_pack("{s:i}", "mesh", mesh));
    const int scene = (int)gltf_number(json, "scene", 0);
    json_t *shown = json_array_get(json_object_get(json, "scenes"), scene < 0 ? 0 : (size_t)scene);
    const int done = is_there && mesh >= 0 && shown && append(shown, "nodes", json_integer(node)) >= 0;
    free(is_there);
    return done;
}

static int note_all(json_t *json, const json_t *names, Variants *variants, char refused[GLTF_REFUSED_SIZE])
{
    const size_t count = json_array_size(names);
    Noting n = {.json = json, .nmaterials = json_array_size(json_object_get(json, "materials")), .variants = variants};
    char plain[NAME_SIZE];
    *variants = (Variants){.count = (int)count};
    variants->names = calloc(count, sizeof *variants->names);
    variants->surfaces = calloc(MOST_SURFACES + 1, sizeof *variants->surfaces);
    n.others = calloc(count, sizeof *n.others);
    n.own = calloc(MOST_SURFACES, sizeof *n.own);
    n.failed = !variants->names || !variants->surfaces || !n.others || !n.own;
    for (size_t i = 0; i < count && !n.failed; i++)
        strcpy(variants->names[i], name_of(names, i, plain));
    if (!json_object_get(json, "materials"))
        json_object_set_new(json, "materials", json_array());
    const int any = n.failed ? 0 : visit_primitives(json, note_primitive, &n);
    if (n.failed)
        snprintf(refused, GLTF_REFUSED_SIZE,
                 "its variants need more than %d materials, or more memory; choose one of them "
                 "by --variant",
                 MOST_SURFACES);
    if (any && !n.failed)
        add_mesh(json, variants, n.nmaterials);
    finish_surfaces(&n);
    free(n.others);
    free(n.own);
    return any;
}

int gltf_variants_take(json_t *json, const char *variant, Variants *variants, char refused[GLTF_REFUSED_SIZE])
{
    const json_t *names = variants_of(json);
    Chosen chosen = {.nmaterials = json_array_size(json_object_get(json, "materials"))};
    if (variant) {
        chosen.variant = find_variant(names, variant);
        if (chosen.variant < 0)
            refuse_name(names, variant, refused);
        return chosen.variant < 0 ? 0 : visit_primitives(json, choose_variant, &chosen);
    }
    if (!json_array_size(names))
        return 0;
    if (json_array_size(names) > MOST_VARIANTS) {
        snprintf(refused, GLTF_REFUSED_SIZE, "it has more than %d variants; choose one of them by --variant",
                 MOST_VARIANTS);
        return 0;
    }
    Variants scratch = {0};
    const int any = note_all(json, names, variants ? variants : &scratch, refused);
    gltf_variants_free(&scratch);
    return any;
}

void gltf_variants_free(Variants *variants)
{
    for (int k = 0; k < variants->nsurfaces; k++)
        free(variants->surfaces[k].others);
    free(variants->surfaces);
    free(variants->names);
    free(variants->command);
    free(variants->is_apart);
    *variants = (Variants){0};
}
