/* What Assimp leaves out of glTF files: strengths of emission and the like, and extras for this tool. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/json_text.h"
#include "import/base/tell.h"
#include "import/gltf/gltf.h"
#include "import/gltf/json.h"
#include "import/gltf/parts.h"

/* Factor of the reflectance; the mean of a colour. */
static double specular_of(const json_t *specular)
{
    const json_t *color = json_object_get(specular, "specularColorFactor");
    double mean = 1;
    if (json_array_size(color) == 3)
        mean = (json_number_value(json_array_get(color, 0)) + json_number_value(json_array_get(color, 1)) +
                json_number_value(json_array_get(color, 2))) /
               3;
    mean *= gltf_number(specular, "specularFactor", 1);
    return isfinite(mean) ? fmin(fmax(mean, 0), 20) : 1;
}

static void take_bump(const json_t *bump, GltfBump *to)
{
    to->is_there = json_is_object(bump);
    to->is_color = !gltf_flag(bump, "numbers");
    to->distance = (float)fmin(fmax(gltf_number(bump, "distance", 1), -1e9), 1e9);
    to->strength = (float)fmin(fmax(gltf_number(bump, "strength", 1), 0), 1);
}

static void take_materials(const json_t *json, Gltf *gltf)
{
    const json_t *materials = json_object_get(json, "materials");
    const size_t count = json_array_size(materials);
    gltf->strengths = calloc(count + 1, sizeof *gltf->strengths);
    gltf->speculars = calloc(count + 1, sizeof *gltf->speculars);
    gltf->dispersions = calloc(count + 1, sizeof *gltf->dispersions);
    gltf->bumps = calloc(count + 1, sizeof *gltf->bumps);
    for (size_t i = 0; gltf->strengths && gltf->speculars && gltf->dispersions && gltf->bumps && i < count; i++) {
        const json_t *material = json_array_get(materials, i);
        const json_t *emissive = gltf_extension(material, "KHR_materials_emissive_strength");
        gltf->strengths[i] = (float)gltf_number(emissive, "emissiveStrength", 1);
        gltf->speculars[i] = (float)specular_of(gltf_extension(material, "KHR_materials_specular"));
        gltf->dispersions[i] = (float)fmin(
            fmax(gltf_number(gltf_extension(material, "KHR_materials_dispersion"), "dispersion", 0), 0), 20);
        take_bump(json_object_get(gltf_extras(material), "bump"), &gltf->bumps[i]);
        gltf->nmaterials = (int)i + 1;
    }
}

/* Images of the reflectance, which Assimp does not know of. */
static void note_specular_images(Import *import, const json_t *json)
{
    const json_t *materials = json_object_get(json, "materials");
    for (size_t i = 0; i < json_array_size(materials); i++) {
        const json_t *specular = gltf_extension(json_array_get(materials, i), "KHR_materials_specular");
        if (json_object_get(specular, "specularTexture") || json_object_get(specular, "specularColorTexture"))
            import_leave_out(import, LEFT_SPECULAR_MAP);
    }
}

/* Assimp drops them without a word. */
static void note_lines(Import *import, const json_t *json)
{
    enum { TRIANGLES = 4 };
    const json_t *meshes = json_object_get(json, "meshes"), *mesh, *primitive;
    size_t i, k;
    json_array_foreach(meshes, i, mesh)
    {
        const json_t *primitives = json_object_get(mesh, "primitives");
        json_array_foreach(primitives, k, primitive)
        {
            if (gltf_number(primitive, "mode", TRIANGLES) < TRIANGLES)
                import_leave_out(import, LEFT_LINES);
        }
    }
}

/* Extensions of materials that change nothing where a factor is 0, as it is unless the material says so. */
typedef struct MaterialExtension {
    const char *extension, *what, *factor;
} MaterialExtension;
static const MaterialExtension of_materials[] = {
    {"KHR_materials_anisotropy", "anisotropy", "anisotropyStrength"},
    {"KHR_materials_iridescence", "iridescence", "iridescenceFactor"},
    {"KHR_materials_diffuse_transmission", "diffuse transmission", "diffuseTransmissionFactor"},
};
enum { OF_MATERIALS = sizeof of_materials / sizeof *of_materials };

static int is_taken(const char *name)
{
    static const char *const taken[] = {
        "EXT_mesh_gpu_instancing",
        "EXT_meshopt_compression",
        "EXT_texture_avif",
        "EXT_texture_webp",
        "KHR_draco_mesh_compression",
        "KHR_lights_punctual",
        "KHR_materials_clearcoat",
        "KHR_materials_dispersion",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_materials_volume",
        "KHR_mesh_quantization",
        "KHR_node_visibility",
        "KHR_texture_basisu",
        "KHR_texture_transform",
        "KHR_xmp",
        "KHR_xmp_json_ld",
        "MSFT_texture_dds",
    };
    for (size_t k = 0; k < sizeof taken / sizeof *taken; k++)
        if (strcmp(name, taken[k]) == 0)
            return 1;
    return 0;
}

/* What a material does without: its name for people, in `plain`; or NULL where it shows nothing. */
static const char *left_of_material(const char *extension, const json_t *json, char plain[NAME_SIZE])
{
    for (size_t k = 0; k < OF_MATERIALS; k++)
        if (strcmp(extension, of_materials[k].extension) == 0)
            return gltf_number(json, of_materials[k].factor, 0) != 0 ? of_materials[k].what : NULL;
    char name[NAME_SIZE];
    if (is_taken(extension))
        return NULL;
    snprintf(plain, NAME_SIZE, "extension %.40s", import_plain(extension, name));
    return plain;
}

enum { MOST_LINES = 16 }; /* of a kind */

static void tell_rest(const Import *import, int lines)
{
    if (lines > MOST_LINES)
        import_tell(import, IMPORT_WARNING, "the like is left out %d more time%s", lines - MOST_LINES,
                    lines == MOST_LINES + 1 ? "" : "s");
}

/* A line for each material and what it does without. `told` gets the names of the extensions. */
static void note_materials(Import *import, const json_t *json, json_t *told)
{
    const json_t *materials = json_object_get(json, "materials");
    int lines = 0;
    for (size_t i = 0; i < json_array_size(materials); i++) {
        const char *extension;
        json_t *own;
        json_object_foreach(json_object_get(json_array_get(materials, i), "extensions"), extension, own)
        {
            char name[NAME_SIZE], plain[NAME_SIZE];
            const char *what = left_of_material(extension, own, plain);
            json_object_set_new(told, extension, json_true());
            if (what && lines++ < MOST_LINES)
                import_tell(import, IMPORT_WARNING, "the material `%s`: its %s is left out",
                            gltf_material_name(json, i, name), what);
        }
    }
    tell_rest(import, lines);
}

/* A line for each that changes what a picture shows and is not taken. */
static void note_extensions(Import *import, const json_t *json, const json_t *told)
{
    const json_t *used = json_object_get(json, "extensionsUsed");
    int lines = 0;
    for (size_t i = 0; i < json_array_size(used); i++) {
        const char *name = json_string_value(json_array_get(used, i));
        char plain[NAME_SIZE];
        size_t k = 0;
        while (name && k < OF_MATERIALS && strcmp(name, of_materials[k].extension) != 0)
            k++;
        if (name && k == OF_MATERIALS && !is_taken(name) && !json_object_get(told, name) &&
            lines++ < MOST_LINES)
            import_tell(import, IMPORT_WARNING, "the extension %s is left out", import_plain(name, plain));
    }
    tell_rest(import, lines);
}

static GltfText load_model(const Import *import)
{
    int descriptor;
    GltfText text = {NULL, 0, 0, "cannot be read"};
    RetexAccess access = RETEX_ACCESS_INIT;
    access.safe = import->options->safe;
    if (retex_access_open(&access, import->options->model, &descriptor, NULL))
        return text;
    FILE *in = fdopen(descriptor, "rb");
    if (in) {
        text = gltf_load(in);
        fclose(in);
    }
    return text;
}

int gltf_list_variants(const Import *import, RetexError *err)
{
    const GltfText text = load_model(import);
    const int code = text.json ? RETEX_OK : retex_fail(err, RETEX_EFORMAT, "%s: %s", import->options->model,
                                                       text.why[0] ? text.why : "it is no glTF file");
    gltf_variants_list(import, text.json);
    json_decref(text.json);
    return code;
}

int gltf_explain(const Import *import, RetexError *err)
{
    if (import->gltf_refused[0])
        return retex_fail(err, RETEX_EFORMAT, "%s: %s", import->options->model, import->gltf_refused);
    const GltfText text = load_model(import);
    const int code = !text.json && text.why[0]
                         ? retex_fail(err, RETEX_EFORMAT, "%s: its JSON text: %s", import->options->model, text.why)
                         : RETEX_OK;
    json_decref(text.json);
    return code;
}

int gltf_read(Import *import, RetexError *err)
{
    const GltfText text = load_model(import);
    char refused[GLTF_REFUSED_SIZE];
    if (!text.json && text.why[0])
        return gltf_explain(import, err);
    note_specular_images(import, text.json);
    note_lines(import, text.json);
    gltf_note_images(import, text.json);
    json_t *told = json_object();
    note_materials(import, text.json, told);
    note_extensions(import, text.json, told);
    json_decref(told);
    gltf_variants_take(text.json, import->options->variant, NULL, refused); /* as Assimp was given them */
    take_materials(text.json, &import->gltf);
    const int done = gltf_take_cameras(import, text.json) && gltf_take_lights(import, text.json);
    json_decref(text.json);
    return done ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory");
}

void gltf_free(Gltf *gltf)
{
    free(gltf->strengths);
    free(gltf->speculars);
    free(gltf->dispersions);
    free(gltf->bumps);
    free(gltf->cameras);
    free(gltf->lights);
}
