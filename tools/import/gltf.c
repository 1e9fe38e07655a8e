/* What Assimp leaves out of glTF files: strengths of emission, angles of view as they are written, all lights, and
 * extras for this tool. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/internal.h"

uint32_t gltf_little(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

json_t *gltf_load(FILE *in, int *is_binary)
{
    unsigned char head[20];
    if (fread(head, 1, sizeof head, in) != sizeof head)
        return NULL;
    *is_binary = gltf_little(head) == GLTF_MAGIC;
    if (!*is_binary) {
        rewind(in);
        return json_loadf(in, 0, NULL);
    }
    const size_t length = gltf_little(head + 12);
    char *text = gltf_little(head + 16) == GLTF_JSON_CHUNK ? malloc(length + 1) : NULL;
    json_t *json = text && fread(text, 1, length, in) == length ? json_loadb(text, length, 0, NULL) : NULL;
    free(text);
    return json;
}

double gltf_number(const json_t *object, const char *key, double otherwise)
{
    const json_t *value = json_object_get(object, key);
    const double x = json_is_number(value) ? json_number_value(value) : otherwise;
    return isfinite(x) ? x : otherwise;
}

const json_t *gltf_extension(const json_t *of, const char *name)
{
    return json_object_get(json_object_get(of, "extensions"), name);
}

const json_t *gltf_extras(const json_t *node)
{
    return json_object_get(json_object_get(node, "extras"), "retex");
}

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

static void take_materials(const json_t *json, Gltf *gltf)
{
    const json_t *materials = json_object_get(json, "materials");
    const size_t count = json_array_size(materials);
    gltf->strengths = calloc(count + 1, sizeof *gltf->strengths);
    gltf->speculars = calloc(count + 1, sizeof *gltf->speculars);
    gltf->dispersions = calloc(count + 1, sizeof *gltf->dispersions);
    for (size_t i = 0; gltf->strengths && gltf->speculars && gltf->dispersions && i < count; i++) {
        const json_t *material = json_array_get(materials, i);
        const json_t *emissive = gltf_extension(material, "KHR_materials_emissive_strength");
        gltf->strengths[i] = (float)gltf_number(emissive, "emissiveStrength", 1);
        gltf->speculars[i] = (float)specular_of(gltf_extension(material, "KHR_materials_specular"));
        gltf->dispersions[i] = (float)fmin(
            fmax(gltf_number(gltf_extension(material, "KHR_materials_dispersion"), "dispersion", 0), 0), 20);
        gltf->nmaterials = (int)i + 1;
    }
}

static void take_cameras(const json_t *json, Gltf *gltf)
{
    const json_t *cameras = json_object_get(json, "cameras");
    const size_t count = json_array_size(cameras);
    gltf->cameras = calloc(count + 1, sizeof *gltf->cameras);
    for (size_t i = 0; gltf->cameras && i < count; i++) {
        const json_t *camera = json_array_get(cameras, i), *perspective = json_object_get(camera, "perspective");
        const json_t *orthographic = json_object_get(camera, "orthographic");
        GltfCamera *to = &gltf->cameras[i];
        to->angle = gltf_number(perspective, "yfov", 0);
        to->aspect = gltf_number(perspective, "aspectRatio", 0);
        to->width = 2 * gltf_number(orthographic, "xmag", 0);
        to->height = 2 * gltf_number(orthographic, "ymag", 0);
        gltf->ncameras = (int)i + 1;
    }
}

/* The lens, of the nodes of cameras. */
static void take_lenses(const json_t *json, Gltf *gltf)
{
    const json_t *nodes = json_object_get(json, "nodes");
    for (size_t i = 0; i < json_array_size(nodes); i++) {
        const json_t *node = json_array_get(nodes, i), *camera = json_object_get(node, "camera");
        const json_t *extras = gltf_extras(node), *shift = json_object_get(extras, "shift");
        const json_int_t index = json_is_integer(camera) ? json_integer_value(camera) : -1;
        if (!extras || index < 0 || index >= gltf->ncameras)
            continue;
        GltfCamera *to = &gltf->cameras[index];
        for (size_t k = 0; k < 2; k++)
            to->shift[k] = fmin(fmax(json_number_value(json_array_get(shift, k)), -100), 100);
        to->lens_radius = fmax(gltf_number(extras, "lens_radius", 0), 0);
        to->focus_distance = fmax(gltf_number(extras, "focus_distance", 0), 0);
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

/* A line for each that changes what a picture shows and is not taken. */
static void note_extensions(Import *import, const json_t *json)
{
    static const char *const taken[] = {
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
        "KHR_materials_volume",
        "KHR_mesh_quantization",
        "KHR_texture_transform",
        "KHR_xmp",
        "KHR_xmp_json_ld",
    };
    enum { TAKEN = sizeof taken / sizeof *taken, MOST = 16 };
    const json_t *used = json_object_get(json, "extensionsUsed");
    for (size_t i = 0; i < json_array_size(used) && i < MOST; i++) {
        const char *name = json_string_value(json_array_get(used, i));
        char plain[NAME_SIZE];
        int k = 0;
        while (name && k < TAKEN && strcmp(name, taken[k]) != 0)
            k++;
        if (name && k == TAKEN)
            import_tell(import, IMPORT_WARNING, "the extension %s is left out", import_plain(name, plain));
    }
}

static json_t *load_model(const Import *import)
{
    int descriptor, is_binary;
    RetexAccess access = RETEX_ACCESS_INIT;
    access.safe = import->options->safe;
    if (retex_access_open(&access, import->options->model, &descriptor, NULL))
        return NULL;
    FILE *in = fdopen(descriptor, "rb");
    json_t *json = in ? gltf_load(in, &is_binary) : NULL;
    if (in)
        fclose(in);
    return json;
}

int gltf_is_compressed(const Import *import, char plain[NAME_SIZE])
{
    json_t *json = load_model(import);
    const json_t *required = json_object_get(json, "extensionsRequired");
    int is_compressed = 0;
    for (size_t i = 0; i < json_array_size(required) && !is_compressed; i++) {
        const char *name = json_string_value(json_array_get(required, i));
        is_compressed = name && (strstr(name, "draco_mesh") || strstr(name, "meshopt"));
        if (is_compressed)
            import_plain(name, plain);
    }
    json_decref(json);
    return is_compressed;
}

void gltf_read(Import *import)
{
    json_t *json = load_model(import);
    take_materials(json, &import->gltf);
    note_specular_images(import, json);
    note_extensions(import, json);
    take_cameras(json, &import->gltf);
    take_lenses(json, &import->gltf);
    gltf_take_lights(json, &import->gltf);
    json_decref(json);
}

void gltf_free(Gltf *gltf)
{
    free(gltf->strengths);
    free(gltf->speculars);
    free(gltf->dispersions);
    free(gltf->cameras);
    free(gltf->lights);
}
