/* What Assimp leaves out of 3DS files: where cameras look, their roll and lens; and the cone of spot lights, to whose
 * outer angle it adds the inner one. It also moves cameras and lights twice, by their node and by themselves; see
 * places.c. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/read/read.h"

enum { MAIN = 0x4d4d, EDITOR = 0x3d3d, OBJECT = 0x4000, LIGHT = 0x4600, SPOT = 0x4610, CAMERA = 0x4700 };

/* Which of Assimp's cameras and lights were told of. Names may be the same: then the first that was not. */
typedef struct Told {
    const struct aiScene *scene;
    unsigned char *cameras, *lights;
} Told;

/* The rest of a file, or of a chunk. */
typedef struct Bytes {
    const unsigned char *at;
    size_t left;
} Bytes;

static unsigned long take(Bytes *bytes, size_t count)
{
    unsigned long value = 0;
    for (size_t k = 0; k < count; k++)
        value |= (unsigned long)bytes->at[k] << 8 * k;
    bytes->at += count, bytes->left -= count;
    return value;
}

static double take_float(Bytes *bytes)
{
    const uint32_t bits = (uint32_t)take(bytes, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

/* Returns 0 at the end, or where a chunk is longer than what it is in. */
static int next_chunk(Bytes *bytes, unsigned long *kind, Bytes *chunk)
{
    if (bytes->left < 6)
        return 0;
    *kind = take(bytes, 2);
    const unsigned long size = take(bytes, 4);
    if (size < 6 || size - 6 > bytes->left)
        return 0;
    *chunk = (Bytes){bytes->at, size - 6};
    bytes->at += size - 6, bytes->left -= size - 6;
    return 1;
}

/* z, which is up, turned about the direction of view. */
static struct aiVector3D up_of(const double ahead[3], double roll)
{
    const double c = cos(roll), s = sin(roll), k = ahead[2] * (1 - c);
    return (struct aiVector3D){(ai_real)(ahead[1] * s + ahead[0] * k), (ai_real)(-ahead[0] * s + ahead[1] * k),
                               (ai_real)(c + ahead[2] * k)};
}

/* Position, target, roll in degrees, and the lens, which is 2400 by its angle in degrees. */
static void take_camera(Told *told, const char *name, Bytes chunk)
{
    double v[8], ahead[3], length = 0;
    if (chunk.left < sizeof(float) * 8)
        return;
    for (int k = 0; k < 8; k++)
        v[k] = take_float(&chunk);
    for (int k = 0; k < 3; k++) {
        ahead[k] = v[3 + k] - v[k];
        length += ahead[k] * ahead[k];
    }
    for (unsigned i = 0; i < told->scene->mNumCameras; i++) {
        struct aiCamera *camera = told->scene->mCameras[i];
        if (told->cameras[i] || strcmp(camera->mName.data, name) != 0)
            continue;
        told->cameras[i] = 1;
        if (!(length > 0) || !isfinite(length + v[6] + v[7]))
            return;
        for (int k = 0; k < 3; k++)
            ahead[k] /= sqrt(length);
        camera->mPosition = (struct aiVector3D){(ai_real)v[0], (ai_real)v[1], (ai_real)v[2]};
        camera->mLookAt = (struct aiVector3D){(ai_real)ahead[0], (ai_real)ahead[1], (ai_real)ahead[2]};
        camera->mUp = up_of(ahead, v[6] * PI / 180);
        if (v[7] > 0)
            camera->mHorizontalFOV = (float)(2400 / v[7] * PI / 180);
        return;
    }
}

/* Of a light: its position, then chunks. A spot has its target and the angles of both cones, in degrees. */
static void take_light(Told *told, const char *name, Bytes light)
{
    const struct aiScene *scene = told->scene;
    unsigned long kind;
    unsigned number = 0;
    Bytes chunk;
    while (number < scene->mNumLights &&
           (told->lights[number] || strcmp(scene->mLights[number]->mName.data, name) != 0))
        number++;
    if (number == scene->mNumLights || light.left < sizeof(float) * 3)
        return;
    told->lights[number] = 1;
    light.at += sizeof(float) * 3, light.left -= sizeof(float) * 3;
    while (next_chunk(&light, &kind, &chunk)) {
        if (kind != SPOT || chunk.left < sizeof(float) * 5)
            continue;
        chunk.at += sizeof(float) * 4, chunk.left -= sizeof(float) * 4;
        const double outer = take_float(&chunk) * PI / 180;
        if (isfinite(outer))
            scene->mLights[number]->mAngleOuterCone = (float)outer;
    }
}

static void take_object(Told *told, Bytes object)
{
    const char *name = (const char *)object.at;
    const size_t length = strnlen(name, object.left);
    unsigned long kind;
    Bytes chunk;
    if (length == object.left)
        return;
    object.at += length + 1, object.left -= length + 1;
    while (next_chunk(&object, &kind, &chunk))
        if (kind == CAMERA)
            take_camera(told, name, chunk);
        else if (kind == LIGHT)
            take_light(told, name, chunk);
}

/* Chunks of the editor, which are in the main one. */
static void take_file(Told *told, Bytes file)
{
    unsigned long kind;
    Bytes main, editor, object;
    if (!next_chunk(&file, &kind, &main) || kind != MAIN)
        return;
    while (next_chunk(&main, &kind, &editor))
        while (kind == EDITOR && next_chunk(&editor, &kind, &object)) {
            if (kind == OBJECT)
                take_object(told, object);
            kind = EDITOR;
        }
}

void tds_read(Import *import)
{
    int descriptor;
    RetexAccess access = RETEX_ACCESS_INIT;
    access.safe = import->options->safe;
    if (!(import->scene->mNumCameras || import->scene->mNumLights) ||
        retex_access_open(&access, import->options->model, &descriptor, NULL))
        return;
    FILE *in = fdopen(descriptor, "rb");
    const long size = in && fseek(in, 0, SEEK_END) == 0 ? ftell(in) : -1;
    unsigned char *data = size > 0 ? malloc((size_t)size) : NULL;
    Told told = {import->scene, calloc(import->scene->mNumCameras + 1, 1), calloc(import->scene->mNumLights + 1, 1)};
    if (data && told.cameras && told.lights && fseek(in, 0, SEEK_SET) == 0 &&
        fread(data, 1, (size_t)size, in) == (size_t)size)
        take_file(&told, (Bytes){data, (size_t)size});
    free(told.cameras);
    free(told.lights);
    free(data);
    if (in)
        fclose(in);
}
