/* Materials: a texture or material of POV-Ray for each surface that is used. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/target_name.h>

#include "import/base/mesh.h"
#include "import/base/tell.h"
#include "import/gltf/json.h"
#include "import/scene/images.h"
#include "import/scene/scene.h"
#include "import/scene/surface.h"

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

typedef char File[NAME_SIZE + 32]; /* "" = none */

typedef struct MapFiles {
    File metallic, roughness, transmission, clearcoat, clearcoat_roughness, sheen, emission, normal, clearcoat_normal;
    float mean_metallic, mean_roughness, mean_transmission, mean_clearcoat, mean_clearcoat_roughness;
} MapFiles;

/* An image that varies a finish, after its word. options: of the image. */
static void print_map(FILE *out, const char *word, const char *file, const char *options, const Map *map, int uv_set)
{
    fprintf(out, "%s%s { image_map { %s \"%s\" %sinterpolate 2 }", word, map->uv_set != uv_set ? " second_uv" : "",
            images_keyword(file), file, options);
    print_place(out, &map->place);
    fprintf(out, " }");
}

/* On a line of its own, if there is one. */
static void print_finish_map(FILE *out, const char *word, const char *file, const char *options, const Map *map,
                             int uv_set)
{
    if (!file[0])
        return;
    fprintf(out, "\n      ");
    print_map(out, word, file, options, map, uv_set);
}

static void print_normal(const Import *import, FILE *out, const Surface *s, const MapFiles *files, int uv_set)
{
    if (!files->normal[0])
        return;
    fprintf(out, "  #ifdef (Retex) normal { ");
    if (s->bump.is_there) {
        print_map(out, "retex_height_map", files->normal, s->bump.is_color ? "" : "gamma 1 ", &s->normal_map, uv_set);
        fprintf(out, " %.6g strength %.4g } #end\n", (double)s->bump.distance * import->options->scale,
                (double)s->bump.strength);
        return;
    }
    print_map(out, "retex_normal_map", files->normal, "gamma 1 ", &s->normal_map, uv_set);
    if (s->normal_scale != 1)
        fprintf(out, " %.4g", (double)s->normal_scale);
    fprintf(out, " } #end\n");
}

static void print_coating(FILE *out, const Surface *s, const MapFiles *files, int uv_set)
{
    if (s->clearcoat > 0)
        fprintf(out, "\n      clearcoat %.4g clearcoat_roughness %.4g", (double)s->clearcoat,
                (double)s->clearcoat_roughness);
    print_finish_map(out, "clearcoat_map", files->clearcoat, "gamma 1 ", &s->clearcoat_map, uv_set);
    print_finish_map(out, "clearcoat_roughness_map", files->clearcoat_roughness, "gamma 1 ",
                     &s->clearcoat_roughness_map, uv_set);
    print_finish_map(out, "clearcoat_normal_map", files->clearcoat_normal, "gamma 1 ", &s->clearcoat_normal_map,
                     uv_set);
    if (files->clearcoat_normal[0] && s->clearcoat_normal_scale != 1)
        fprintf(out, " %.4g", (double)s->clearcoat_normal_scale);
    if (largest(s->sheen) > 0) {
        fprintf(out, "\n      sheen ");
        print_color(out, s->sheen);
        fprintf(out, " sheen_roughness %.4g", (double)s->sheen_roughness);
    }
    print_finish_map(out, "sheen_map", files->sheen, "", &s->sheen_map, uv_set);
}

/* The block of our extension. */
static void print_block(FILE *out, const Surface *s, const MapFiles *files, int uv_set)
{
    fprintf(out, "\n    #ifdef (Retex) retex { metallic %.4g roughness %.4g ior %.4g", (double)s->metallic,
            (double)s->roughness, (double)s->ior);
    if (s->tint != 1)
        fprintf(out, " specular_tint %.4g", (double)s->tint);
    if (s->transmission > 0)
        fprintf(out, " transmission %.4g", (double)s->transmission);
    print_finish_map(out, "metallic_map", files->metallic, "gamma 1 ", &s->metallic_map, uv_set);
    print_finish_map(out, "roughness_map", files->roughness, "gamma 1 ", &s->roughness_map, uv_set);
    print_finish_map(out, "transmission_map", files->transmission, "gamma 1 ", &s->transmission_map, uv_set);
    print_finish_map(out, "emission_map", files->emission, "", &s->emission_map, uv_set);
    print_coating(out, s, files, uv_set);
    fprintf(out, " } #end");
}

/* For POV-Ray the nearest finish; for this renderer the surface itself. */
static void print_finish(FILE *out, const Surface *s, const float emission[3], int has_diffuse, const MapFiles *files,
                         int uv_set)
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
    print_block(out, s, files, uv_set);
    fprintf(out, "\n  }\n");
}

/* glTF means indices of refraction of red and blue; POV-Ray's dispersion is the ratio of those at the ends of its
 * spectrum, of which the middles of red and blue are this far apart. */
static float dispersion_of(const Surface *s)
{
    const float apart = 0.525f, half = 0.025f * s->dispersion * (s->ior - 1);
    return s->dispersion > 0 && half < s->ior - 1 ? powf((s->ior + half) / (s->ior - half), 1 / apart) : 1;
}

/* Light that is absorbed: POV-Ray's fade_power 1001 is exp((fade_color - 1) x / fade_distance). */
static void print_interior(const Import *import, FILE *out, const Surface *s)
{
    float optical[3], most = 0;
    fprintf(out, "  interior { ior %.4g", (double)s->ior);
    if (dispersion_of(s) > 1)
        fprintf(out, " dispersion %.5g", (double)dispersion_of(s));
    for (int k = 0; k < 3; k++) {
        optical[k] = -logf(fmaxf(unit(s->fade_color[k]), 1e-4f));
        most = fmaxf(most, optical[k]);
    }
    if (s->fade_distance > 0 && most > 0) {
        const float color[3] = {1 - optical[0] / most, 1 - optical[1] / most, 1 - optical[2] / most};
        fprintf(out, " fade_power 1001 fade_distance %.5g fade_color ",
                (double)(s->fade_distance / most) * import->options->scale);
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

/* What is written of a material. */
typedef struct Writing {
    Import *import;
    ImportMaterial *material;
    Surface surface;
    MapFiles files;
} Writing;

/* Meshes have two sets of UV: that of the colour's image, or else of the first map, and one more. */
static void choose_uv_sets(ImportMaterial *to, const Surface *s)
{
    const Map *const maps[] = {&s->roughness_map,
                               &s->metallic_map,
                               &s->normal_map,
                               &s->emission_map,
                               &s->transmission_map,
                               &s->clearcoat_map,
                               &s->clearcoat_roughness_map,
                               &s->clearcoat_normal_map,
                               &s->sheen_map};
    const size_t count = sizeof maps / sizeof *maps;
    int first = to->has_image ? s->base_map.uv_set : -1;
    to->second_uv = -1;
    for (size_t i = 0; i < count; i++) {
        if (!maps[i]->source[0])
            continue;
        if (first < 0)
            first = maps[i]->uv_set;
        else if (maps[i]->uv_set != first && to->second_uv < 0)
            to->second_uv = maps[i]->uv_set;
    }
    to->uv_set = first < 0 ? 0 : first;
    to->has_maps = first >= 0;
}

static int has_uv_of(const Writing *w, const Map *map)
{
    return map->uv_set == w->material->uv_set || map->uv_set == w->material->second_uv;
}

/* The image of a finish's number, as a file of its own; the mean where the mesh has not its UV. */
static int write_numbers(Writing *w, const Map *map, int channel, const char *what, float *number, float *mean,
                         File file, RetexError *err)
{
    ChannelStats stats;
    int found;
    if (mean)
        *mean = *number;
    if (!map->source[0])
        return RETEX_OK;
    const int code = images_stats(w->import, map->source, &stats, &found, err);
    if (code)
        return code;
    if (mean)
        *mean = *number * stats.mean[channel];
    if (has_uv_of(w, map))
        return images_channel(w->import, map->source, channel, what, file, err);
    import_leave_out(w->import, LEFT_FINISH_MAP);
    *number *= stats.mean[channel];
    return RETEX_OK;
}

static int write_all_numbers(Writing *w, RetexError *err)
{
    Surface *s = &w->surface;
    MapFiles *files = &w->files;
    int code = write_numbers(w, &s->metallic_map, s->metallic_channel, "metallic", &s->metallic, &files->mean_metallic,
                             files->metallic, err);
    if (!code)
        code = write_numbers(w, &s->roughness_map, s->roughness_channel, "roughness", &s->roughness,
                             &files->mean_roughness, files->roughness, err);
    if (!code)
        code = write_numbers(w, &s->transmission_map, 0, "transmission", &s->transmission, &files->mean_transmission,
                             files->transmission, err);
    if (!code)
        code = write_numbers(w, &s->clearcoat_map, 0, "clearcoat", &s->clearcoat, NULL, files->clearcoat, err);
    return code ? code
                : write_numbers(w, &s->clearcoat_roughness_map, 1, "clearcoat_roughness", &s->clearcoat_roughness, NULL,
                                files->clearcoat_roughness, err);
}

/* An image as it is. `left` is told where the mesh has not its UV. */
static int write_image(const Writing *w, const Map *map, LeftOut left, File file, RetexError *err)
{
    const ImageUse use = {.source = map->source, .factor = {1, 1, 1}, .opacity_factor = 1};
    if (!map->source[0])
        return RETEX_OK;
    if (has_uv_of(w, map))
        return images_use(w->import, &use, file, err);
    import_leave_out(w->import, left);
    return RETEX_OK;
}

/* The image of emission, if the pigment is not that already. Where it is not to be had the surface does not shine. */
static int write_emission_map(Writing *w, float emission[3], RetexError *err)
{
    const Map *map = &w->surface.emission_map;
    const int code = write_image(w, map, LEFT_EMISSION_MAP, w->files.emission, err);
    if (map->source[0] && !w->files.emission[0])
        emission[0] = emission[1] = emission[2] = 0;
    return code;
}

/* A normal map, made of heights where it has these. */
static int write_normal_map(Writing *w, RetexError *err)
{
    Surface *s = &w->surface;
    if (s->bump.is_there ? s->bump.distance == 0 || s->bump.strength == 0 : s->normal_scale == 0)
        return RETEX_OK;
    if (!s->normal_map.source[0] || !s->has_heights || !has_uv_of(w, &s->normal_map))
        return write_image(w, &s->normal_map, LEFT_NORMAL_MAP, w->files.normal, err);
    const float scale = s->normal_scale;
    s->normal_scale = 1;
    return images_normals(w->import, s->normal_map.source, scale, w->files.normal, err);
}

static int write_maps(Writing *w, float emission[3], RetexError *err)
{
    const Surface *s = &w->surface;
    int code = write_all_numbers(w, err);
    if (!code)
        code = write_emission_map(w, emission, err);
    if (!code)
        code = write_normal_map(w, err);
    if (!code && s->clearcoat_normal_scale != 0)
        code = write_image(w, &s->clearcoat_normal_map, LEFT_NORMAL_MAP, w->files.clearcoat_normal, err);
    return code ? code : write_image(w, &s->sheen_map, LEFT_FINISH_MAP, w->files.sheen, err);
}

int materials_finish(Import *import, int index, ImportMaterial *to, char **text, RetexError *err)
{
    Writing w = {.import = import, .material = to};
    float emission[3] = {0, 0, 0};
    size_t size = 0;
    *text = NULL;
    int code = surface_read(import, index, &w.surface, err);
    if (!code)
        code = write_maps(&w, emission, err);
    FILE *out = code ? NULL : open_memstream(text, &size);
    if (!code && !out)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory");
    if (out) {
        print_finish(out, &w.surface, emission, 1, &w.files, to->uv_set);
        if (fclose(out) != 0)
            code = retex_fail(err, RETEX_ENOMEM, "out of memory");
    }
    return code;
}

static int write_material(Import *import, int index, ImportMaterial *to, FILE *out, RetexError *err)
{
    Writing w = {.import = import, .material = to};
    Surface *s = &w.surface;
    File file = "";
    float emission[3];
    int code = surface_read(import, index, s, err);
    if (code)
        return code;
    int has_diffuse = place_emission(s, emission);
    if (s->base_map.source[0]) {
        const ImageUse use = {.source = s->base_map.source,
                              .opacity = s->opacity_map.source[0] ? s->opacity_map.source : NULL,
                              .factor = {s->base[0], s->base[1], s->base[2]},
                              .opacity_factor = s->opacity,
                              .alpha = s->alpha,
                              .cutoff = s->cutoff};
        code = images_use(import, &use, file, err);
        if (code)
            return code;
    }
    to->has_image = file[0] != '\0';
    if (!has_diffuse && s->base_map.source[0] && !to->has_image) { /* all of one light, nothing of it would be seen */
        s->unlit = 0, has_diffuse = 1;
        emission[0] = emission[1] = emission[2] = 0;
    }
    for (int k = 0; k < 3; k++) /* glTF multiplies them; other formats have them in place of the material's colour */
        to->vertex_factor[k] = import->is_gltf ? s->base[k] : 1;
    choose_uv_sets(to, s);
    code = write_maps(&w, emission, err);
    if (code)
        return code;
    to->radiance = largest(emission) * (to->has_image ? 0.5f : largest(s->base)); /* images are grey on average */
    import->emits |= !s->unlit && largest(emission) > 1; /* what shines less is a label or a lamp on a panel */
    to->is_solid = s->transmission > 0;
    to->is_opaque = s->transmission <= 0 && s->opacity >= 1 && !s->opacity_map.source[0] &&
                    (s->alpha == ALPHA_IGNORE || !to->has_image);
    to->is_clear = s->transmission > 0.2f || s->opacity < 0.7f;
    fprintf(out, "#declare %s = %s {\n", to->name, to->is_solid ? "material {\n  texture" : "texture");
    print_pigment(out, s, file);
    print_normal(import, out, s, &w.files, to->uv_set);
    print_finish(out, s, emission, has_diffuse, &w.files, to->uv_set);
    if (to->is_solid) {
        fprintf(out, "  }\n");
        print_interior(import, out, s);
    }
    fprintf(out, "}\n");
    return RETEX_OK;
}

/* Assimp's own for a material. */
static void get_name(const struct aiMaterial *material, struct aiString *name)
{
    if (aiGetMaterialString(material, AI_MATKEY_NAME, name) != aiReturn_SUCCESS)
        name->data[0] = '\0';
}

/* Of a material of Assimp's: what the model calls it. */
static void take_name(ImportMaterial *material, const struct aiMaterial *from, int is_gltf, struct aiString *name)
{
    const char *text = name->data;
    get_name(from, name);
    material->place = is_gltf ? gltf_material_place(&text) : -1;
    memmove(name->data, text, strlen(text) + 1);
}

/* What people call materials, where identifiers are not that but for the case of letters. Of several of one name it is
 * the first. */
static int write_names(Import *import, FILE *out)
{
    Names called = {0};
    struct aiString name;
    int any = 0, is_new = 1;
    for (unsigned i = 0; i < import->scene->mNumMaterials && is_new >= 0; i++) {
        ImportMaterial *material = &import->materials[i];
        take_name(material, import->scene->mMaterials[i], import->is_gltf, &name);
        if (!material->is_used || strcasecmp(material->name, name.data) == 0 || names_have(&import->names, name.data) ||
            !retex_target_name_is_valid(name.data) || (is_new = names_add(&called, name.data)) <= 0)
            continue;
        fprintf(out, "%s\n  \"%s\" \"%s\"", any++ ? "" : "#ifdef (Retex) global_settings { retex_names {",
                material->name, name.data);
    }
    if (any)
        fprintf(out, "\n} } #end\n");
    names_free(&called);
    return is_new >= 0;
}

int materials_write(Import *import, FILE *out, RetexError *err)
{
    const struct aiScene *scene = import->scene;
    struct aiString name;
    import->materials = calloc(scene->mNumMaterials + 1, sizeof *import->materials);
    if (!import->materials)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        if (scene->mMeshes[i]->mMaterialIndex < scene->mNumMaterials && mesh_has_surface(scene->mMeshes[i]))
            import->materials[scene->mMeshes[i]->mMaterialIndex].is_used = 1;
    for (unsigned i = 0; i < scene->mNumMaterials; i++)
        take_name(&import->materials[i], scene->mMaterials[i], import->is_gltf, &name);
    fprintf(out, "// ---- materials: each can be a target of retexturing ----\n\n");
    for (unsigned i = 0; i < scene->mNumMaterials; i++) {
        ImportMaterial *to = &import->materials[i];
        take_name(to, scene->mMaterials[i], import->is_gltf, &name);
        if (!to->is_used)
            continue;
        if (!names_make(&import->names, name.data, "Material", to->name))
            return retex_fail(err, RETEX_ENOMEM, "out of memory");
        const int code = write_material(import, (int)i, to, out, err);
        if (code)
            return code;
    }
    return RETEX_OK;
}

int materials_write_names(Import *import, FILE *out, RetexError *err)
{
    const int done = write_names(import, out);
    fprintf(out, "\n");
    return done ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory");
}
