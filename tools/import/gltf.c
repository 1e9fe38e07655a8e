/* What Assimp leaves out of glTF files: strengths of emission, and angles of view as they are written. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "import/internal.h"

enum { MAGIC = 0x46546c67, JSON_CHUNK = 0x4e4f534a };

static uint32_t little(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* The JSON text of a .gltf or .glb file. */
static json_t *read_json(FILE *in)
{
    unsigned char head[20];
    if (fread(head, 1, sizeof head, in) != sizeof head)
        return NULL;
    if (little(head) != MAGIC) {
        rewind(in);
        return json_loadf(in, 0, NULL);
    }
    const size_t length = little(head + 12);
    char *text = little(head + 16) == JSON_CHUNK ? malloc(length + 1) : NULL;
    json_t *json = text && fread(text, 1, length, in) == length ? json_loadb(text, length, 0, NULL) : NULL;
    free(text);
    return json;
}

static double number_of(const json_t *object, const char *key, double otherwise)
{
    const json_t *value = json_object_get(object, key);
    const double x = json_is_number(value) ? json_number_value(value) : otherwise;
    return isfinite(x) ? x : otherwise;
}

static const json_t *extension(const json_t *material, const char *name)
{
    return json_object_get(json_object_get(material, "extensions"), name);
}

static void take_materials(const json_t *json, Gltf *gltf)
{
    const json_t *materials = json_object_get(json, "materials");
    const size_t count = json_array_size(materials);
    gltf->strengths = calloc(count + 1, sizeof *gltf->strengths);
    for (size_t i = 0; gltf->strengths && i < count; i++) {
        const json_t *one = extension(json_array_get(materials, i), "KHR_materials_emissive_strength");
        gltf->strengths[i] = (float)number_of(one, "emissiveStrength", 1);
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
        to->angle = number_of(perspective, "yfov", 0);
        to->aspect = number_of(perspective, "aspectRatio", 0);
        to->width = 2 * number_of(orthographic, "xmag", 0);
        to->height = 2 * number_of(orthographic, "ymag", 0);
        gltf->ncameras = (int)i + 1;
    }
}

void gltf_read(Import *import)
{
    int descriptor;
    RetexAccess access = RETEX_ACCESS_INIT;
    access.safe = import->options->safe;
    if (retex_access_open(&access, import->options->model, &descriptor, NULL))
        return;
    FILE *in = fdopen(descriptor, "rb");
    json_t *json = in ? read_json(in) : NULL;
    if (in)
        fclose(in);
    take_materials(json, &import->gltf);
    take_cameras(json, &import->gltf);
    json_decref(json);
}

void gltf_free(Gltf *gltf)
{
    free(gltf->strengths);
    free(gltf->cameras);
}
