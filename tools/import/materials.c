/* Materials: what Assimp knows of them, and a texture or material of POV-Ray for each that is used. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>

#include "import/internal.h"

/* An image of a material. */
typedef struct Map {
    char source[TEXT_SIZE]; /* "" = none */
    int uv_set;
    Affine place; /* of UV, v up: from the mesh's to the image's */
} Map;

/* A material in the terms of glTF. Colours are linear. */
typedef struct Surface {
    float base[3], opacity;
    float metallic, roughness, ior, tint; /* tint: scales the reflectance of the coat */
    float transmission, emission[3];
    float fade_distance, fade_color[3]; /* 0 = none */
    AlphaMode alpha;
    float cutoff;
    int unlit;
    Map base_map, opacity_map, emission_map, metallic_map, roughness_map;
    int metallic_channel, roughness_channel;
} Surface;

/* ---- what Assimp has ---- */

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

/* The other way; itself where there is none. */
static Affine uv_inverse(const Affine *a)
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
    map->uv_set = uv < AI_MAX_NUMBER_OF_TEXTURECOORDS ? (int)uv : 0;
    if (aiGetMaterialUVTransform(m, AI_MATKEY_UVTRANSFORM(type, index), &transform) == aiReturn_SUCCESS)
        map->place = uv_place(import, &transform);
    return 1;
}

static float largest(const float c[3])
{
    return fmaxf(c[0], fmaxf(c[1], c[2]));
}

static float unit(float x)
{
    return fminf(fmaxf(x, 0), 1);
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
    const int code = take_finish_map(import, &s->metallic_map, s->metallic_channel, &s->metallic, err);
    return code ? code : take_finish_map(import, &s->roughness_map, s->roughness_channel, &s->roughness, err);
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

static void take_emission(const Import *import, const struct aiMaterial *m, int index, Surface *s)
{
    float color[4], strength = index < import->gltf.nmaterials ? import->gltf.strengths[index] : 1;
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

static void note_left_out(Import *import, const struct aiMaterial *m)
{
    float factor;
    if (has_any(import, m, aiTextureType_NORMALS, 0) || has_any(import, m, aiTextureType_HEIGHT, 0) ||
        has_any(import, m, aiTextureType_NORMAL_CAMERA, 0))
        import_leave_out(import, LEFT_NORMAL_MAP);
    if (has_any(import, m, AI_MATKEY_TRANSMISSION_TEXTURE))
        import_leave_out(import, LEFT_TRANSMISSION_MAP);
    if (has_any(import, m, aiTextureType_SPECULAR, 0) || has_any(import, m, aiTextureType_SHININESS, 0))
        import_leave_out(import, LEFT_SPECULAR_MAP);
    if (get_float(m, AI_MATKEY_CLEARCOAT_FACTOR, &factor) && factor > 0)
        import_leave_out(import, LEFT_CLEARCOAT);
    if (has_any(import, m, AI_MATKEY_SHEEN_COLOR_TEXTURE) ||
        (get_float(m, AI_MATKEY_SHEEN_ROUGHNESS_FACTOR, &factor) && factor > 0))
        import_leave_out(import, LEFT_SHEEN);
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

static int read_surface(Import *import, int index, Surface *s, RetexError *err)
{
    const struct aiMaterial *m = import->scene->mMaterials[index];
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
    if (is_pbr && index < import->gltf.nmaterials)
        s->tint = import->gltf.speculars[index];
    take_opacity(import, m, base, s);
    take_emission(import, m, index, s);
    take_volume(m, s);
    fold_tint(s);
    note_left_out(import, m);
    /* The white that Assimp gives what has no material would lose no light. */
    if (!is_pbr && s->base[0] == 1 && s->base[1] == 1 && s->base[2] == 1)
        s->base[0] = s->base[1] = s->base[2] = 0.8f;
    /* In formats without PBR an image stands in place of the colour. */
    if (s->base_map.source[0] && !import->is_gltf)
        s->base[0] = s->base[1] = s->base[2] = 1;
    return is_specular ? RETEX_OK : take_finish_maps(import, m, s, err);
}

/* ---- what is written ---- */

static void print_color(FILE *out, const float c[3])
{
    if (c[0] == c[1] && c[1] == c[2])
        fprintf(out, "rgb %.5g", (double)c[0]);
    else
        fprintf(out, "rgb <%.5g, %.5g, %.5g>", (double)c[0], (double)c[1], (double)c[2]);
}

/* The pigment's transform undoes the map's, for POV-Ray moves the image, not the UV. */
static void print_place(FILE *out, const Affine *place)
{
    const Affine back = uv_inverse(place);
    affine_print(out, &back);
}

static void print_image(FILE *out, const char *file, const Affine *place)
{
    fprintf(out, "  pigment { uv_mapping image_map { %s \"%s\" interpolate 2 }", images_keyword(file), file);
    print_place(out, place);
    fprintf(out, " }\n");
}

/* The colour: `file` is its image, "" = none. */
static void print_pigment(FILE *out, const Surface *s, const char *file)
{
    if (file[0]) {
        print_image(out, file, &s->base_map.place);
        return;
    }
    fprintf(out, "  pigment { ");
    if (s->opacity < 1)
        fprintf(out, "rgbt <%.5g, %.5g, %.5g, %.5g>", (double)s->base[0], (double)s->base[1], (double)s->base[2],
                1 - (double)s->opacity);
    else if (s->transmission > 0)
        fprintf(out, "rgbf <%.5g, %.5g, %.5g, %.5g>", (double)s->base[0], (double)s->base[1], (double)s->base[2],
                (double)s->transmission);
    else
        print_color(out, s->base);
    fprintf(out, " }\n");
}

typedef struct FinishFiles {
    char metallic[NAME_SIZE + 32], roughness[NAME_SIZE + 32]; /* "" = none */
    float mean_metallic, mean_roughness;
} FinishFiles;

static void print_map(FILE *out, const char *what, const char *file, const Map *map)
{
    if (!file[0])
        return;
    fprintf(out, "\n      %s { image_map { %s \"%s\" gamma 1 interpolate 2 }", what, images_keyword(file), file);
    print_place(out, &map->place);
    fprintf(out, " }");
}

/* For POV-Ray the nearest finish; for this renderer the surface itself. */
static void print_finish(FILE *out, const Surface *s, const float emission[3], int has_diffuse,
                         const FinishFiles *files)
{
    const double m = (double)files->mean_metallic, rough = (double)files->mean_roughness, ior = (double)s->ior;
    const double f0 = (double)s->tint * pow((ior - 1) / (ior + 1), 2), alpha = fmax(rough * rough, 0.01);
    const double mirror = pow(1 - rough, 2) * (m + (1 - m) * (rough < 0.5)), power = fmax(2 / (alpha * alpha) - 2, 1);
    fprintf(out, "  finish {\n   ");
    if (!has_diffuse) {
        fprintf(out, " diffuse 0 emission ");
        print_color(out, emission);
        fprintf(out, "\n  }\n");
        return;
    }
    fprintf(out, " diffuse %.4g", (1 - f0) * (1 - m + 0.5 * m * (1 - mirror)) * (1 - (double)s->transmission));
    if (m >= 0.5)
        fprintf(out, " specular %.4g roughness %.4g metallic reflection { %.4g metallic }", 0.5 * m, 1 / power,
                0.9 * m * mirror);
    else if (f0 > 0)
        fprintf(out, " specular albedo %.4g roughness %.4g", f0, fmax(1 / power, 0.0005));
    if (m < 0.5 && f0 > 0 && mirror > 0.1)
        fprintf(out, " reflection { %.4g, %.4g falloff 5 }", f0 * mirror, mirror);
    if (largest(emission) > 0) {
        fprintf(out, "\n    emission ");
        print_color(out, emission);
    }
    fprintf(out, "\n    #ifdef (Retex) retex { metallic %.4g roughness %.4g ior %.4g", (double)s->metallic,
            (double)s->roughness, ior);
    if (s->tint != 1)
        fprintf(out, " specular_tint %.4g", (double)s->tint);
    if (s->transmission > 0)
        fprintf(out, " transmission %.4g", (double)s->transmission);
    print_map(out, "metallic_map", files->metallic, &s->metallic_map);
    print_map(out, "roughness_map", files->roughness, &s->roughness_map);
    fprintf(out, " } #end\n  }\n");
}

/* Light that is absorbed: POV-Ray's fade_power 1001 is exp((fade_color - 1) x / fade_distance). */
static void print_interior(FILE *out, const Surface *s)
{
    float optical[3], most = 0;
    fprintf(out, "  interior { ior %.4g", (double)s->ior);
    for (int k = 0; k < 3; k++) {
        optical[k] = -logf(fmaxf(unit(s->fade_color[k]), 1e-4f));
        most = fmaxf(most, optical[k]);
    }
    if (s->fade_distance > 0 && most > 0) {
        const float color[3] = {1 - optical[0] / most, 1 - optical[1] / most, 1 - optical[2] / most};
        fprintf(out, " fade_power 1001 fade_distance %.5g fade_color ", (double)(s->fade_distance / most));
        print_color(out, color);
    }
    fprintf(out, " }\n");
}

/* Emission is a factor of the pigment. Give the pigment a colour where it has none, and find the factor. Returns 0
 * where the surface only shines. */
static int place_emission(Import *import, Surface *s, float emission[3])
{
    memcpy(emission, s->emission, sizeof s->emission);
    if (s->unlit) {
        emission[0] = emission[1] = emission[2] = 1;
        return 0;
    }
    if (largest(emission) == 0)
        return 1;
    if (s->emission_map.source[0] && strcmp(s->emission_map.source, s->base_map.source) != 0) {
        if (s->base_map.source[0] || largest(s->base) > 0.05f) {
            import_leave_out(import, LEFT_EMISSION_MAP);
            emission[0] = emission[1] = emission[2] = 0;
            return 1;
        }
        s->base_map = s->emission_map;
        s->base[0] = s->base[1] = s->base[2] = 1;
        return 0;
    }
    if (s->base_map.source[0])
        return 1;
    if (largest(s->base) < 0.05f) {
        const float most = largest(emission);
        for (int k = 0; k < 3; k++) {
            s->base[k] = emission[k] / most;
            emission[k] = most;
        }
        return 0;
    }
    for (int k = 0; k < 3; k++) {
        s->base[k] = fmaxf(s->base[k], 0.004f);
        emission[k] /= s->base[k];
    }
    return 1;
}

/* The image of a finish's number, as a file of its own. A mesh has one set of UV: where the colour uses another one,
 * the mean is taken. */
static int write_finish_map(Import *import, const Map *map, int channel, const char *what, int uv_set, float *number,
                            float *mean, char file[NAME_SIZE + 32], RetexError *err)
{
    ChannelStats stats;
    int found;
    *mean = *number;
    file[0] = '\0';
    if (!map->source[0])
        return RETEX_OK;
    int code = images_stats(import, map->source, &stats, &found, err);
    if (code)
        return code;
    *mean = *number * stats.mean[channel];
    if (map->uv_set != uv_set) {
        import_leave_out(import, LEFT_FINISH_MAP);
        *number = *mean;
        return RETEX_OK;
    }
    return images_channel(import, map->source, channel, what, file, err);
}

static int write_finish_maps(Import *import, Surface *s, int uv_set, FinishFiles *files, RetexError *err)
{
    const int code = write_finish_map(import, &s->metallic_map, s->metallic_channel, "metallic", uv_set, &s->metallic,
                                      &files->mean_metallic, files->metallic, err);
    return code ? code
                : write_finish_map(import, &s->roughness_map, s->roughness_channel, "roughness", uv_set, &s->roughness,
                                   &files->mean_roughness, files->roughness, err);
}

static int write_material(Import *import, int index, ImportMaterial *to, FILE *out, RetexError *err)
{
    Surface s;
    char file[NAME_SIZE + 32] = "";
    float emission[3];
    int code = read_surface(import, index, &s, err);
    if (code)
        return code;
    const int has_diffuse = place_emission(import, &s, emission);
    import->emits |= !s.unlit && largest(emission) > 0;
    if (s.base_map.source[0]) {
        const ImageUse use = {.source = s.base_map.source,
                              .opacity = s.opacity_map.source[0] ? s.opacity_map.source : NULL,
                              .factor = {s.base[0], s.base[1], s.base[2]},
                              .opacity_factor = s.opacity,
                              .alpha = s.alpha,
                              .cutoff = s.cutoff};
        code = images_use(import, &use, file, err);
        if (code)
            return code;
    }
    FinishFiles files = {0};
    to->has_image = file[0] != '\0';
    to->uv_set = to->has_image               ? s.base_map.uv_set
                 : s.roughness_map.source[0] ? s.roughness_map.uv_set
                                             : s.metallic_map.uv_set;
    code = write_finish_maps(import, &s, to->uv_set, &files, err);
    if (code)
        return code;
    to->is_solid = s.transmission > 0;
    fprintf(out, "#declare %s = %s {\n", to->name, to->is_solid ? "material {\n  texture" : "texture");
    print_pigment(out, &s, file);
    print_finish(out, &s, emission, has_diffuse, &files);
    if (to->is_solid) {
        fprintf(out, "  }\n");
        print_interior(out, &s);
    }
    fprintf(out, "}\n");
    return RETEX_OK;
}

int materials_write(Import *import, FILE *out, RetexError *err)
{
    const struct aiScene *scene = import->scene;
    struct aiString name;
    import->materials = calloc(scene->mNumMaterials + 1, sizeof *import->materials);
    if (!import->materials)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        if (scene->mMeshes[i]->mMaterialIndex < scene->mNumMaterials)
            import->materials[scene->mMeshes[i]->mMaterialIndex].is_used = 1;
    fprintf(out, "// ---- materials: each can be a target of retexturing ----\n\n");
    for (unsigned i = 0; i < scene->mNumMaterials; i++) {
        ImportMaterial *to = &import->materials[i];
        if (!to->is_used)
            continue;
        if (aiGetMaterialString(scene->mMaterials[i], AI_MATKEY_NAME, &name) != aiReturn_SUCCESS)
            name.data[0] = '\0';
        if (!names_make(&import->names, name.data, "Material", to->name))
            return retex_fail(err, RETEX_ENOMEM, "out of memory");
        const int code = write_material(import, (int)i, to, out, err);
        if (code)
            return code;
    }
    fprintf(out, "\n");
    return RETEX_OK;
}
