/* What Assimp knows of a material, as a surface in the terms of glTF. */
#include <math.h>
#include <string.h>

#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>

#include "import/base/tell.h"
#include "import/scene/images.h"
#include "import/scene/surface.h"

static int get_float(const struct aiMaterial *m, const char *key, unsigned type, unsigned index, float *value)
{
    ai_real x;
    unsigned n = 1;
    if (aiGetMaterialFloatArray(m, key, type, index, &x, &n) != aiReturn_SUCCESS || n < 1 || !isfinite(x))
        return 0;
    *value = x;
    return 1;
}

static int get_color(const struct aiMaterial *m, const char *key, unsigned type, unsigned index, float color[4])
{
    struct aiColor4D c = {0, 0, 0, 1};
    if (aiGetMaterialColor(m, key, type, index, &c) != aiReturn_SUCCESS || !isfinite(c.r + c.g + c.b + c.a))
        return 0;
    const float rgba[4] = {c.r, c.g, c.b, c.a};
    for (int k = 0; k < 4; k++)
        color[k] = fmaxf(rgba[k], 0);
    return 1;
}

/* Scaled, turned counter-clockwise, moved. */
static Affine uv_placed(double sx, double sy, double angle, double x, double y)
{
    const double c = cos(angle), s = sin(angle);
    return (Affine){{{c * sx, -s * sy, 0, x}, {s * sx, c * sy, 0, y}, {0, 0, 1, 0}}};
}

Affine uv_inverse(const Affine *a)
{
    const double(*m)[4] = a->m;
    const double det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    Affine back = affine_identity;
    if (!isfinite(det) || fabs(det) < 1e-12)
        return back;
    back.m[0][0] = m[1][1] / det, back.m[0][1] = -m[0][1] / det;
    back.m[1][0] = -m[1][0] / det, back.m[1][1] = m[0][0] / det;
    for (int i = 0; i < 2; i++)
        back.m[i][3] = -(back.m[i][0] * m[0][3] + back.m[i][1] * m[1][3]);
    return back;
}

/* uv' of uv, v up, for a transform as Assimp has it. FBX transforms the image, not the UV. From glTF, Assimp
 * computes a translation that suits a rotation about the image's middle; glTF's own offset is got back from it. */
static Affine uv_place(const Import *import, const struct aiUVTransform *t)
{
    const double sx = (double)t->mScaling.x, sy = (double)t->mScaling.y, angle = (double)t->mRotation;
    const double c = cos(angle), s = sin(angle), x = (double)t->mTranslation.x, y = (double)t->mTranslation.y;
    if (import->is_fbx) {
        const Affine image = uv_placed(sx, sy, angle, x, y);
        return uv_inverse(&image);
    }
    if (import->is_gltf) { /* which turns the other way, for its v is down; about the corner at the top */
        const double u = x - 0.5 * sx * (-c - s + 1), down = 0.5 * sy * (c - s - 1) + 1 - sy - y;
        return uv_placed(sx, sy, -angle, u - s * sy, 1 - down - c * sy);
    }
    /* moved, turned, then scaled */
    const Affine place = {
        {{sx * c, -sx * s, 0, sx * (c * x - s * y)}, {sy * s, sy * c, 0, sy * (s * x + c * y)}, {0, 0, 1, 0}}};
    return place;
}

static int get_map(const Import *import, const struct aiMaterial *m, enum aiTextureType type, unsigned index, Map *map)
{
    struct aiString path;
    unsigned uv = 0;
    struct aiUVTransform transform;
    map->source[0] = '\0';
    map->uv_set = 0;
    map->place = affine_identity;
    if (aiGetMaterialTexture(m, type, index, &path, NULL, &uv, NULL, NULL, NULL, NULL) != aiReturn_SUCCESS ||
        !path.length || path.length >= sizeof map->source)
        return 0;
    memcpy(map->source, path.data, path.length);
    map->source[path.length] = '\0';
    map->uv_set = uv < AI_MAX_NUMBER_OF_TEXTURECOORDS ? (int)uv : AI_MAX_NUMBER_OF_TEXTURECOORDS; /* none has it */
    if (aiGetMaterialUVTransform(m, AI_MATKEY_UVTRANSFORM(type, index), &transform) == aiReturn_SUCCESS)
        map->place = uv_place(import, &transform);
    return 1;
}

/* Without roughness: of Phong's exponent. */
static void roughness_of_phong(const struct aiMaterial *m, Surface *s)
{
    float exponent, specular[4], strength = 1;
    if (get_float(m, AI_MATKEY_SHININESS, &exponent) && exponent > 0)
        s->roughness = sqrtf(sqrtf(2 / (exponent + 2)));
    if (get_color(m, AI_MATKEY_COLOR_SPECULAR, specular)) {
        get_float(m, AI_MATKEY_SHININESS_STRENGTH, &strength);
        s->tint = unit(2 * strength * largest(specular));
    } else
        s->tint = 0;
}

/* glTF's old model of specular colour and glossiness. */
static void metal_of_specular(const struct aiMaterial *m, Surface *s)
{
    float specular[4] = {1, 1, 1, 1}, glossiness = 1;
    get_float(m, AI_MATKEY_GLOSSINESS_FACTOR, &glossiness);
    s->roughness = 1 - unit(glossiness);
    s->metallic = 0;
    if (get_color(m, AI_MATKEY_COLOR_SPECULAR, specular) && largest(specular) > largest(s->base) &&
        largest(specular) > 0.2f) {
        s->metallic = 1;
        memcpy(s->base, specular, sizeof s->base);
    }
}

static int has_any(const Import *import, const struct aiMaterial *m, enum aiTextureType type, unsigned index)
{
    Map map;
    return get_map(import, m, type, index, &map);
}

/* A number of the finish from an image: a map where it varies, else its mean. */
static int take_finish_map(Import *import, Map *map, int channel, float *number, RetexError *err)
{
    enum { LEAST_STEPS = 4 }; /* of 255 */
    ChannelStats stats;
    int found;
    if (!map->source[0] || *number == 0) {
        map->source[0] = '\0';
        return RETEX_OK;
    }
    const int code = images_stats(import, map->source, &stats, &found, err);
    if (code)
        return code;
    if (found && stats.high[channel] - stats.low[channel] >= LEAST_STEPS / 255.0f)
        return RETEX_OK;
    map->source[0] = '\0';
    *number *= found ? stats.mean[channel] : 1;
    return RETEX_OK;
}

/* In glTF, one image has roughness as green and metallic as blue. */
static int take_finish_maps(Import *import, const struct aiMaterial *m, Surface *s, RetexError *err)
{
    if (!get_map(import, m, aiTextureType_METALNESS, 0, &s->metallic_map) && import->is_gltf)
        get_map(import, m, aiTextureType_UNKNOWN, 0, &s->metallic_map);
    if (!get_map(import, m, aiTextureType_DIFFUSE_ROUGHNESS, 0, &s->roughness_map) && import->is_gltf)
        get_map(import, m, aiTextureType_UNKNOWN, 0, &s->roughness_map);
    s->metallic_channel = import->is_gltf ? 2 : 0;
    s->roughness_channel = import->is_gltf ? 1 : 0;
    int code = take_finish_map(import, &s->metallic_map, s->metallic_channel, &s->metallic, err);
    if (!code)
        code = take_finish_map(import, &s->roughness_map, s->roughness_channel, &s->roughness, err);
    if (!code && get_map(import, m, AI_MATKEY_TRANSMISSION_TEXTURE, &s->transmission_map))
        code = take_finish_map(import, &s->transmission_map, 0, &s->transmission, err);
    return code;
}

/* Formats other than glTF do not say whether bumps are normals, which are blue, or heights, which are grey. */
static int take_normal_map(Import *import, const struct aiMaterial *m, Surface *s, RetexError *err)
{
    static const enum aiTextureType types[] = {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA,
                                               aiTextureType_HEIGHT};
    const size_t count = sizeof types / sizeof *types;
    ChannelStats stats;
    size_t i = 0;
    int found;
    s->normal_scale = 1;
    while (i < count && !get_map(import, m, types[i], 0, &s->normal_map))
        i++;
    if (i == count)
        return RETEX_OK;
    if (!get_float(m, AI_MATKEY_GLTF_TEXTURE_SCALE(types[i], 0), &s->normal_scale) &&
        !get_float(m, AI_MATKEY_OBJ_BUMPMULT(types[i], 0), &s->normal_scale))
        get_float(m, AI_MATKEY_BUMPSCALING, &s->normal_scale);
    if (import->is_gltf)
        return RETEX_OK;
    const int code = images_stats(import, s->normal_map.source, &stats, &found, err);
    if (!code && !found)
        s->normal_map.source[0] = '\0';
    s->has_heights = !code && found && stats.mean[2] < fmaxf(stats.mean[0], stats.mean[1]) + 0.15f;
    return code;
}

static void take_opacity(const Import *import, const struct aiMaterial *m, const float base[4], Surface *s)
{
    struct aiString mode;
    int illumination = 0;
    s->alpha = ALPHA_BLEND;
    s->cutoff = 0.5f;
    s->opacity = 1;
    if (import->is_gltf) {
        s->alpha = ALPHA_IGNORE;
        if (aiGetMaterialString(m, AI_MATKEY_GLTF_ALPHAMODE, &mode) == aiReturn_SUCCESS)
            s->alpha = strcmp(mode.data, "MASK") == 0    ? ALPHA_MASK
                       : strcmp(mode.data, "BLEND") == 0 ? ALPHA_BLEND
                                                         : ALPHA_IGNORE;
        get_float(m, AI_MATKEY_GLTF_ALPHACUTOFF, &s->cutoff);
        s->opacity = s->alpha == ALPHA_IGNORE ? 1 : unit(base[3]);
        return;
    }
    get_float(m, AI_MATKEY_OPACITY, &s->opacity);
    s->opacity = unit(s->opacity);
    if (s->opacity == 0) /* files say so of what is not meant to be invisible */
        s->opacity = 1;
    get_map(import, m, aiTextureType_OPACITY, 0, &s->opacity_map);
    /* OBJ: glass by its illumination model */
    if (aiGetMaterialIntegerArray(m, AI_MATKEY_OBJ_ILLUM, &illumination, NULL) == aiReturn_SUCCESS &&
        (illumination == 4 || illumination == 6 || illumination == 7 || illumination == 9) && s->opacity < 1) {
        s->transmission = 1 - s->opacity;
        s->opacity = 1;
    }
}

static void take_emission(const Import *import, const struct aiMaterial *m, int place, Surface *s)
{
    float color[4], strength = place >= 0 ? import->gltf.strengths[place] : 1;
    int mode = 0;
    if (get_color(m, AI_MATKEY_COLOR_EMISSIVE, color)) {
        for (int k = 0; k < 3; k++)
            s->emission[k] = color[k] * fmaxf(strength, 0);
    }
    if (get_map(import, m, aiTextureType_EMISSIVE, 0, &s->emission_map) && !import->is_gltf &&
        largest(s->emission) == 0)
        s->emission[0] = s->emission[1] = s->emission[2] = 1;
    if (largest(s->emission) == 0)
        s->emission_map.source[0] = '\0';
    s->unlit = import->is_gltf &&
               aiGetMaterialIntegerArray(m, AI_MATKEY_SHADING_MODEL, &mode, NULL) == aiReturn_SUCCESS &&
               mode == aiShadingMode_NoShading;
}

static void take_volume(const struct aiMaterial *m, Surface *s)
{
    float color[4], distance = 0;
    if (get_float(m, AI_MATKEY_VOLUME_ATTENUATION_DISTANCE, &distance) && distance > 0 && distance < 1e9f &&
        get_color(m, AI_MATKEY_VOLUME_ATTENUATION_COLOR, color) && fminf(color[0], fminf(color[1], color[2])) < 1) {
        s->fade_distance = distance;
        memcpy(s->fade_color, color, sizeof s->fade_color);
    }
}

/* The alpha of an image in glTF: its mean. */
static int take_sheen_roughness(Import *import, const struct aiMaterial *m, Surface *s, RetexError *err)
{
    const int alpha = 3;
    Map map;
    ChannelStats stats;
    int found;
    if (!get_map(import, m, AI_MATKEY_SHEEN_ROUGHNESS_TEXTURE, &map))
        return RETEX_OK;
    const int code = images_stats(import, map.source, &stats, &found, err);
    if (code || !found)
        return code;
    if (stats.high[alpha] > stats.low[alpha])
        import_leave_out(import, LEFT_SHEEN_ROUGHNESS_MAP);
    s->sheen_roughness *= stats.mean[alpha];
    return RETEX_OK;
}

/* In glTF, red of one image is the weight of the coat, and green of one its roughness. */
static int take_coating(Import *import, const struct aiMaterial *m, Surface *s, RetexError *err)
{
    const unsigned normal = 2; /* its index as Assimp counts images of the coat */
    float sheen[4] = {0, 0, 0, 1};
    get_float(m, AI_MATKEY_CLEARCOAT_FACTOR, &s->clearcoat);
    get_float(m, AI_MATKEY_CLEARCOAT_ROUGHNESS_FACTOR, &s->clearcoat_roughness);
    s->clearcoat = unit(s->clearcoat), s->clearcoat_roughness = unit(s->clearcoat_roughness);
    get_map(import, m, AI_MATKEY_CLEARCOAT_TEXTURE, &s->clearcoat_map);
    int code = take_finish_map(import, &s->clearcoat_map, 0, &s->clearcoat, err);
    if (!code && s->clearcoat > 0 &&
        get_map(import, m, AI_MATKEY_CLEARCOAT_ROUGHNESS_TEXTURE, &s->clearcoat_roughness_map))
        code = take_finish_map(import, &s->clearcoat_roughness_map, 1, &s->clearcoat_roughness, err);
    s->clearcoat_normal_scale = 1;
    if (s->clearcoat > 0 && get_map(import, m, aiTextureType_CLEARCOAT, normal, &s->clearcoat_normal_map))
        get_float(m, AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_CLEARCOAT, normal), &s->clearcoat_normal_scale);
    get_color(m, AI_MATKEY_SHEEN_COLOR_FACTOR, sheen);
    for (int k = 0; k < 3; k++)
        s->sheen[k] = unit(sheen[k]);
    if (largest(s->sheen) > 0)
        get_map(import, m, AI_MATKEY_SHEEN_COLOR_TEXTURE, &s->sheen_map);
    get_float(m, AI_MATKEY_SHEEN_ROUGHNESS_FACTOR, &s->sheen_roughness);
    s->sheen_roughness = unit(s->sheen_roughness);
    return code || largest(s->sheen) == 0 ? code : take_sheen_roughness(import, m, s, err);
}

static void note_left_out(Import *import, const struct aiMaterial *m)
{
    if (has_any(import, m, aiTextureType_SPECULAR, 0) || has_any(import, m, aiTextureType_SHININESS, 0))
        import_leave_out(import, LEFT_SPECULAR_MAP);
}

/* Where nothing is refracted, the index stands for the reflectance alone: then it says all of it. */
static void fold_tint(Surface *s)
{
    const float head_on = (s->ior - 1) * (s->ior - 1) / ((s->ior + 1) * (s->ior + 1));
    const float root = sqrtf(fminf(s->tint * head_on, 0.6f));
    if (s->transmission > 0)
        s->tint = unit(s->tint);
    else if (s->tint != 1) {
        s->ior = (1 + root) / (1 - root);
        s->tint = 1;
    }
}

int surface_read(Import *import, int index, Surface *s, RetexError *err)
{
    const struct aiMaterial *m = import->scene->mMaterials[index];
    const int said = import->materials[index].place, place = said < import->gltf.nmaterials ? said : -1;
    float base[4] = {0.8f, 0.8f, 0.8f, 1}, factor;
    const int is_specular = get_float(m, AI_MATKEY_GLOSSINESS_FACTOR, &factor);
    *s = (Surface){.roughness = 0.5f, .ior = 1.5f, .tint = 1};
    const int is_pbr =
        get_float(m, AI_MATKEY_METALLIC_FACTOR, &s->metallic) | get_float(m, AI_MATKEY_ROUGHNESS_FACTOR, &s->roughness);
    s->metallic = unit(s->metallic), s->roughness = unit(s->roughness);
    if (is_specular || !get_color(m, AI_MATKEY_BASE_COLOR, base))
        get_color(m, AI_MATKEY_COLOR_DIFFUSE, base);
    if (is_specular || !get_map(import, m, aiTextureType_BASE_COLOR, 0, &s->base_map))
        get_map(import, m, aiTextureType_DIFFUSE, 0, &s->base_map);
    for (int k = 0; k < 3; k++)
        s->base[k] = unit(base[k]);
    if (is_specular)
        metal_of_specular(m, s);
    else if (!is_pbr)
        roughness_of_phong(m, s);
    if (get_float(m, AI_MATKEY_REFRACTI, &factor) && factor >= 1 && factor <= 10 && (is_pbr || factor > 1))
        s->ior = factor;
    get_float(m, AI_MATKEY_TRANSMISSION_FACTOR, &s->transmission);
    s->transmission = unit(s->transmission);
    if (is_pbr && place >= 0)
        s->tint = import->gltf.speculars[place];
    if (place >= 0) {
        s->dispersion = import->gltf.dispersions[place];
        s->bump = import->gltf.bumps[place];
    }
    take_opacity(import, m, base, s);
    take_emission(import, m, place, s);
    take_volume(m, s);
    fold_tint(s);
    note_left_out(import, m);
    /* The white that Assimp gives what has no material would lose no light. */
    if (!is_pbr && s->base[0] == 1 && s->base[1] == 1 && s->base[2] == 1)
        s->base[0] = s->base[1] = s->base[2] = 0.8f;
    /* In formats without PBR an image stands in place of the colour. */
    if (s->base_map.source[0] && !import->is_gltf)
        s->base[0] = s->base[1] = s->base[2] = 1;
    int code = take_normal_map(import, m, s, err);
    if (!code)
        code = take_coating(import, m, s, err);
    return code || is_specular ? code : take_finish_maps(import, m, s, err);
}
