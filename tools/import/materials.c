/* Materials: a texture or material of POV-Ray for each surface that is used. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/surface.h"

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

typedef struct MapFiles {
    char metallic[NAME_SIZE + 32], roughness[NAME_SIZE + 32], transmission[NAME_SIZE + 32]; /* "" = none */
    char emission[NAME_SIZE + 32], normal[NAME_SIZE + 32];
    float mean_metallic, mean_roughness, mean_transmission;
} MapFiles;

/* An image of numbers. */
static void print_numbers(FILE *out, const char *what, const char *file, const Map *map)
{
    fprintf(out, "%s { image_map { %s \"%s\" gamma 1 interpolate 2 }", what, images_keyword(file), file);
    print_place(out, &map->place);
    fprintf(out, " }");
}

static void print_finish_map(FILE *out, const char *what, const char *file, const Map *map)
{
    if (!file[0])
        return;
    fprintf(out, "\n      ");
    print_numbers(out, what, file, map);
}

static void print_normal(FILE *out, const Surface *s, const MapFiles *files)
{
    if (!files->normal[0])
        return;
    fprintf(out, "  #ifdef (Retex) normal { ");
    print_numbers(out, "retex_normal_map", files->normal, &s->normal_map);
    if (s->normal_scale != 1)
        fprintf(out, " %.4g", (double)s->normal_scale);
    fprintf(out, " } #end\n");
}

/* For POV-Ray the nearest finish; for this renderer the surface itself. */
static void print_finish(FILE *out, const Surface *s, const float emission[3], int has_diffuse, const MapFiles *files)
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
    fprintf(out, " diffuse %.4g", (1 - f0) * (1 - m + 0.5 * m * (1 - mirror)) * (1 - (double)files->mean_transmission));
    if (m >= 0.5)
        fprintf(out, " specular %.4g roughness %.4g metallic reflection { %.4g metallic }", 0.5 * m, 1 / power,
                0.9 * m * mirror);
    else if (f0 > 0)
        fprintf(out, " specular albedo %.4g roughness %.4g", f0, fmax(1 / power, 0.0005));
    if (m < 0.5 && f0 > 0 && mirror > 0.1)
        fprintf(out, " reflection { %.4g, %.4g falloff 5 }", f0 * mirror, mirror);
    if (largest(emission) > 0) {
        fprintf(out, "\n    %semission ", files->emission[0] ? "#ifdef (Retex) " : "");
        print_color(out, emission);
        if (files->emission[0])
            fprintf(out, " #end");
    }
    fprintf(out, "\n    #ifdef (Retex) retex { metallic %.4g roughness %.4g ior %.4g", (double)s->metallic,
            (double)s->roughness, ior);
    if (s->tint != 1)
        fprintf(out, " specular_tint %.4g", (double)s->tint);
    if (s->transmission > 0)
        fprintf(out, " transmission %.4g", (double)s->transmission);
    print_finish_map(out, "metallic_map", files->metallic, &s->metallic_map);
    print_finish_map(out, "roughness_map", files->roughness, &s->roughness_map);
    print_finish_map(out, "transmission_map", files->transmission, &s->transmission_map);
    if (files->emission[0]) {
        fprintf(out, "\n      emission_map { image_map { %s \"%s\" interpolate 2 }", images_keyword(files->emission),
                files->emission);
        print_place(out, &s->emission_map.place);
        fprintf(out, " }");
    }
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

/* Emission is a factor of the pigment, or of an image of its own. Give the pigment a colour where it has none, and find
 * the factor. Returns 0 where the surface only shines. */
static int place_emission(Surface *s, float emission[3])
{
    memcpy(emission, s->emission, sizeof s->emission);
    if (s->unlit) {
        emission[0] = emission[1] = emission[2] = 1;
        return 0;
    }
    if (largest(emission) == 0)
        return 1;
    if (s->emission_map.source[0] && strcmp(s->emission_map.source, s->base_map.source) != 0) {
        if (s->base_map.source[0] || largest(s->base) > 0.05f)
            return 1;
        s->base_map = s->emission_map;
        s->base[0] = s->base[1] = s->base[2] = 1;
        s->emission_map.source[0] = '\0';
        return 0;
    }
    s->emission_map.source[0] = '\0';
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

static int write_finish_maps(Import *import, Surface *s, int uv_set, MapFiles *files, RetexError *err)
{
    int code = write_finish_map(import, &s->metallic_map, s->metallic_channel, "metallic", uv_set, &s->metallic,
                                &files->mean_metallic, files->metallic, err);
    if (!code)
        code = write_finish_map(import, &s->roughness_map, s->roughness_channel, "roughness", uv_set, &s->roughness,
                                &files->mean_roughness, files->roughness, err);
    return code ? code
                : write_finish_map(import, &s->transmission_map, 0, "transmission", uv_set, &s->transmission,
                                   &files->mean_transmission, files->transmission, err);
}

/* The image of emission, if the pigment is not that already. Where it is not to be had the surface does not shine. */
static int write_emission_map(Import *import, const Surface *s, int uv_set, float emission[3],
                              char file[NAME_SIZE + 32], RetexError *err)
{
    const ImageUse use = {.source = s->emission_map.source, .factor = {1, 1, 1}, .opacity_factor = 1};
    file[0] = '\0';
    if (!s->emission_map.source[0])
        return RETEX_OK;
    const int is_there = s->emission_map.uv_set == uv_set;
    if (!is_there)
        import_leave_out(import, LEFT_EMISSION_MAP);
    const int code = is_there ? images_use(import, &use, file, err) : RETEX_OK;
    if (!file[0])
        emission[0] = emission[1] = emission[2] = 0;
    return code;
}

/* A normal map, made of heights where it has these. */
static int write_normal_map(Import *import, Surface *s, int uv_set, char file[NAME_SIZE + 32], RetexError *err)
{
    const ImageUse use = {.source = s->normal_map.source, .factor = {1, 1, 1}, .opacity_factor = 1};
    file[0] = '\0';
    if (!s->normal_map.source[0] || s->normal_scale == 0)
        return RETEX_OK;
    if (s->normal_map.uv_set != uv_set) {
        import_leave_out(import, LEFT_NORMAL_MAP);
        return RETEX_OK;
    }
    if (!s->has_heights)
        return images_use(import, &use, file, err);
    const float scale = s->normal_scale;
    s->normal_scale = 1;
    return images_normals(import, use.source, scale, file, err);
}

/* That of the first map there is. */
static int first_uv_set(const Surface *s)
{
    const Map *const maps[] = {&s->roughness_map, &s->metallic_map, &s->normal_map, &s->emission_map,
                               &s->transmission_map};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (maps[i]->source[0])
            return maps[i]->uv_set;
    return 0;
}

static int write_material(Import *import, int index, ImportMaterial *to, FILE *out, RetexError *err)
{
    Surface s;
    char file[NAME_SIZE + 32] = "";
    float emission[3];
    int code = surface_read(import, index, &s, err);
    if (code)
        return code;
    const int has_diffuse = place_emission(&s, emission);
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
    MapFiles files = {0};
    to->has_image = file[0] != '\0';
    to->uv_set = to->has_image ? s.base_map.uv_set : first_uv_set(&s);
    code = write_finish_maps(import, &s, to->uv_set, &files, err);
    if (!code)
        code = write_emission_map(import, &s, to->uv_set, emission, files.emission, err);
    if (!code)
        code = write_normal_map(import, &s, to->uv_set, files.normal, err);
    if (code)
        return code;
    import->emits |= !s.unlit && largest(emission) > 0;
    to->is_solid = s.transmission > 0;
    fprintf(out, "#declare %s = %s {\n", to->name, to->is_solid ? "material {\n  texture" : "texture");
    print_pigment(out, &s, file);
    print_normal(out, &s, &files);
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
