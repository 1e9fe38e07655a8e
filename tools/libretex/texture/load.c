/* Loads textures: files are read, texels that cannot be colours are repaired, and maps of finishes are made. A
 * texture's pixels become premultiplied RGBA: 16-bit integers where the file has integers, else floats. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color_text.h>
#include <retex/parallel.h>

#include "base/params.h"
#include "picture/image_read.h"
#include "texture/adjust.h"
#include "texture/finish_map.h"
#include "texture/folder.h"
#include "texture/lay.h"
#include "texture/layer.h"

#define TOLD_DELTA_E 0.5 /* less is not seen */
#define MAX_TEXTURE_PIXELS (1L << 28) /* 16384 x 16384: 4 GiB of floats */

typedef struct RepairWork {
    const RetexImage *image;
    RetexTexelDefects *defects; /* by row */
} RepairWork;

/* Repairs and premultiplies a row: one texel that is not finite would make all coarser levels so. */
static void premultiply_job(void *context, int index, int thread)
{
    const RepairWork *work = context;
    const int width = work->image->width;
    (void)thread;
    float *p = work->image->pixels + (size_t)index * (size_t)width * 4;
    retex_texel_defects_repair(p, width, index, &work->defects[index]);
    for (int x = 0; x < width; x++, p += 4) {
        float alpha = p[3] < 0 ? 0 : p[3] > 1 ? 1 : p[3];
        for (int c = 0; c < 3; c++)
            p[c] *= alpha;
        p[3] = alpha;
    }
}

static int premultiply(RetexTexture *texture, const RetexImage *pixels, int nthreads, RetexError *err)
{
    RepairWork work = {pixels, calloc((size_t)pixels->height, sizeof *work.defects)};
    if (!work.defects)
        return retex_fail_at(err, RETEX_ENOMEM, texture->spec.image, 0, 0,
                             "not enough memory for a texture of %d x %d texels", pixels->width, pixels->height);
    retex_parallel(nthreads, pixels->height, premultiply_job, &work);
    for (int y = 0; y < pixels->height; y++)
        retex_texel_defects_merge(&texture->defects, &work.defects[y]);
    free(work.defects);
    return RETEX_OK;
}

/* Makes RGBA pixels premultiplied texels. */
static int take_pixels(RetexTexture *texture, RetexImage *pixels, RetexTexels *texels, int nthreads, RetexError *err)
{
    const int code = premultiply(texture, pixels, nthreads, err);
    if (code)
        return code;
    *texels = (RetexTexels){pixels->width, pixels->height, 0, pixels->pixels};
    *pixels = (RetexImage){0};
    return RETEX_OK;
}

void retex_texture_report_colors(const RetexTexture *texture, const RetexTextureSpec *spec)
{
    int width, height;
    char *lines = texture->color_warning && spec->warn ? strdup(texture->color_warning) : NULL;
    retex_texture_size(texture, &width, &height);
    for (char *rest = lines, *line; (line = strsep(&rest, "\n"));)
        spec->warn(spec->warn_context, line);
    free(lines);
    retex_texel_defects_report(&texture->defects, spec, (long)width * height);
    const RetexTexture *over = texture->over;
    for (int k = 0; k < spec->nlayers && over; k++, over = over->over) {
        RetexTextureSpec layer = RETEX_TEXTURE_SPEC_INIT;
        retex_texture_layer_get(&layer, spec, k);
        retex_texture_report_colors(over, &layer);
    }
}

/* Returns the texture without pointers to the caller's data, which may not live as long. */
static void return_texture(RetexTexture **out, RetexTexture *texture, const float color[3])
{
    RetexTextureSpec described = texture->spec;
    memcpy(described.color, color, sizeof described.color); /* the colour as it was given */
    retex_texture_report_colors(texture, &described);
    texture->spec.access = NULL;
    texture->spec.warn = NULL;
    *out = texture;
}

/* Keeps a warning of the file for the report. */
static void keep_warning(void *context, const char *text)
{
    RetexTexture *texture = context;

    char *both = NULL;

    if (texture->color_warning && asprintf(&both, "%s\n%s", texture->color_warning, text) < 0)
        return;
    free(texture->color_warning);
    texture->color_warning = both ? both : strdup(text);
}

/* Parameters of reading. While an image is decoded, an image of 16-bit integers, or for other files the floats of the
 * file, exists beside the texture's own texels. */
static RetexReadParams read_params(RetexTexture *texture)
{
    const RetexTextureSpec *spec = &texture->spec;
    enum { PEAK_BYTES = 24 };
    RetexReadParams params = RETEX_READ_INIT;
    params.colorspace = spec->colorspace[0] ? spec->colorspace : NULL;
    params.max_pixels = retex_budget_pixels(spec->budget) ? 0 : MAX_TEXTURE_PIXELS;
    params.access = spec->access;
    params.budget = spec->budget;
    params.warn = keep_warning;
    params.warn_context = texture;
    params.pixel_bytes = PEAK_BYTES;
    return params;
}

/* Adjusts colours, and keeps for the report how far they are from one that was asked for. */
static int adjust(RetexTexture *texture, RetexTexels *texels, int nthreads, RetexError *err)
{
    char text[160];
    double delta_e;
    const int code = retex_adjust_texels(&texture->spec, texels, &delta_e, nthreads, err);
    if (!code && delta_e > TOLD_DELTA_E) {
        snprintf(text, sizeof text, "the mean colour differs from that of colorize= by a delta E of %.1f (CIEDE2000)",
                 delta_e);
        keep_warning(texture, text);
    }
    return code;
}

static int read_file(RetexTexture *texture, const char *file, const char *colorspace, RetexDecoded *decoded,
                     int nthreads, RetexError *err)
{
    RetexReadParams params = read_params(texture);
    params.colorspace = colorspace ? colorspace : params.colorspace;
    return retex_image_read_any(decoded, file, &params, nthreads, err);
}

/* A map is numbers, which are read as they are, and are floats by that. */
static int make_map(RetexTexture *texture, const RetexTexels *color, const char *file, RetexFinishScale scale,
                    int channel, int nthreads, RetexError *err)
{
    RetexDecoded map = {0};
    int code = read_file(texture, file, "linear", &map, nthreads, err);
    if (!code)
        code = retex_finish_map_make(texture, color, &map.image, scale, channel, nthreads, err);
    retex_image_free(&map.image);
    return code;
}

static RetexFinishScale normal_scale(RetexNormalMap normal, const char *file)
{
    const int is_dx = normal == RETEX_NORMAL_DX || (normal == RETEX_NORMAL_BY_NAME && retex_texture_name_is_dx(file));
    return is_dx ? RETEX_FINISH_BY_NORMAL_DX : RETEX_FINISH_BY_NORMAL;
}

/* Makes the map of finishes, where there is one. color: NULL = a constant. */
static int make_finishes(RetexTexture *texture, const RetexFolderFiles *files, const RetexTexels *color, int nthreads,
                         RetexError *err)
{
    const RetexTextureSpec *own = &texture->spec;
    const int turns = own->vary || own->grout > 0 || own->tiles[0][0] || own->repeat >= RETEX_REPEAT_HERRINGBONE;
    texture->may_have_finishes = own->finish[0] || (files && files->has_maps);
    if (own->finish[0] && strcmp(own->finish, RETEX_NO_FINISH_MAP) != 0 && (own->tiles[0][0] || (own->normal && turns)))
        return retex_fail(err, RETEX_EINVAL,
                          own->normal ? "%s: normal= cannot be used with repeats that turn or have joints or tiles"
                                      : "%s: finish= cannot be used with tiles=, which have no map of their own",
                          own->target);
    if (files && files->map && !own->tiles[0][0] && !own->nlayers && !(own->normal_tilt > 0 && turns))
        return make_map(texture, color, files->map,
                        own->normal_tilt > 0 ? normal_scale(RETEX_NORMAL_BY_NAME, files->map)
                        : files->is_gloss    ? RETEX_FINISH_BY_GLOSS
                                             : RETEX_FINISH_BY_ROUGHNESS,
                        files->channel, nthreads, err);
    if (!own->finish[0] || strcmp(own->finish, RETEX_NO_FINISH_MAP) == 0)
        return RETEX_OK;
    if (own->normal && !(own->normal_tilt > 0))
        return retex_fail(err, RETEX_EINVAL, "%s takes no normal maps: normal= cannot be used on it",
                          own->target[0] ? own->target : "the target");
    if (own->normal)
        return make_map(texture, color, own->finish, normal_scale(own->normal, own->finish), 0, nthreads, err);
    if (own->nfinishes < 2 || own->normal_tilt > 0)
        return retex_fail(err, RETEX_EINVAL, "%s has no finishes to choose from: finish= cannot be used on it",
                          own->target[0] ? own->target : "the target");
    return make_map(texture, color, own->finish, RETEX_FINISH_BY_LIST, 0, nthreads, err);
}

/* Reads the file of an image's colours, and adjusts them. */
static int read_colors(RetexTexture *texture, const char *file, RetexTexels *texels, int nthreads, RetexError *err)
{
    RetexDecoded decoded = {0};
    int code = read_file(texture, file, NULL, &decoded, nthreads, err);
    if (!code && decoded.narrow.pixels)
        *texels = (RetexTexels){decoded.narrow.width, decoded.narrow.height, 1, decoded.narrow.pixels};
    else if (!code)
        code = take_pixels(texture, &decoded.image, texels, nthreads, err);
    if (!code)
        code = adjust(texture, texels, nthreads, err);
    retex_image_free(&decoded.image);
    return code;
}

/* Reads the images of tiles. Returns how many there are, or an error. */
static int read_tiles(RetexTexture *texture, RetexTexels tiles[RETEX_TILES_MAX], int nthreads, RetexError *err)
{
    const RetexTextureSpec *own = &texture->spec;
    int count = 0, code = RETEX_OK;
    for (; !code && count < retex_lay_tiles(own); count++) {
        RetexFolderFiles files;
        code = retex_texture_folder_find(&files, own->tiles[count], own->access, RETEX_FOLDER_COLOR, err);
        if (!code)
            code = read_colors(texture, files.color, &tiles[count], nthreads, err);
        retex_texture_folder_files_free(&files);
    }
    return code ? code : count;
}

/* Makes texels the texture's, with those of tiles and the map of finishes. They are used up. files: NULL = none. */
static int make_texture(RetexTexture *texture, const RetexFolderFiles *files, RetexTexels *texels, int nthreads,
                        RetexError *err)
{
    RetexTexels tiles[RETEX_TILES_MAX] = {{0}};
    const int ntiles = read_tiles(texture, tiles, nthreads, err);
    int code = ntiles < 0 ? ntiles : RETEX_OK;
    if (!code)
        code = make_finishes(texture, files, texels, nthreads, err);
    if (!code)
        code = retex_texture_set_texels(texture, texels, tiles, ntiles, nthreads, err);
    for (int k = 0; k < RETEX_TILES_MAX; k++)
        free(tiles[k].texels);
    free(texels->texels);
    return code;
}

/* Reads the files that the image is. */
static int read_image(RetexTexture *texture, int nthreads, RetexError *err)
{
    const RetexTextureSpec *own = &texture->spec;
    const RetexFolderWant want = own->finish[0]                    ? RETEX_FOLDER_COLOR
                                 : own->normal_tilt > 0            ? RETEX_FOLDER_NORMAL
                                 : retex_finish_map_has_scale(own) ? RETEX_FOLDER_ROUGHNESS
                                                                   : RETEX_FOLDER_COLOR;
    RetexFolderFiles files;
    RetexTexels texels = {0};
    int code = retex_texture_folder_find(&files, own->image, own->access, want, err);
    if (!code && files.unused)
        keep_warning(texture, files.unused);
    if (!code)
        code = read_colors(texture, files.color, &texels, nthreads, err);
    if (!code)
        code = make_texture(texture, &files, &texels, nthreads, err);
    retex_texture_folder_files_free(&files);
    return code;
}

/* An image of one texel through which the original shows. */
static int make_clear(RetexTexture *texture, int nthreads, RetexError *err)
{
    RetexTexels texels = {1, 1, 1, NULL};
    if (retex_texels_alloc(&texels))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a texture");
    retex_texture_store_texel(&texels, 0, (const float[4]){0, 0, 0, 0});
    const int code = retex_texture_set_texels(texture, &texels, NULL, 0, nthreads, err);
    free(texels.texels);
    return code;
}

/* A colour with joints is an image of one texel. */
static int lay_color(RetexTexture *texture, int nthreads, RetexError *err)
{
    const float *color = texture->spec.color;
    RetexTexels texels = {1, 1, 0, NULL};
    if (retex_texels_alloc(&texels))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a texture");
    retex_texture_store_texel(&texels, 0, (const float[4]){color[0], color[1], color[2], 1});
    return make_texture(texture, NULL, &texels, nthreads, err);
}

/* Loads the layers of a texture that is loaded. */
static int load_layers(RetexTexture *texture, const RetexTextureSpec *spec, int nthreads, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < spec->nlayers && !code; k++) {
        RetexTextureSpec layer = RETEX_TEXTURE_SPEC_INIT;
        retex_texture_layer_get(&layer, spec, k);
        layer.warn = NULL; /* warnings are told with those of the whole */
        code = retex_texture_load(&texture->over, &layer, nthreads, err);
        texture = texture->over;
    }
    return code;
}

int retex_texture_load(RetexTexture **out, const RetexTextureSpec *given, int nthreads, RetexError *err)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    char meant[RETEX_MEANT_SIZE];
    RetexError why = {0};
    *out = NULL;
    if (RETEX_PARAMS_COPY(&spec, given, err))
        return RETEX_EINVAL;
    RetexTexture *texture = retex_texture_new(&spec, &why);
    int code = why.code;
    if (texture && retex_texture_is_original(&spec))
        code = make_clear(texture, nthreads, &why);
    else if (texture && !spec.constant)
        code = read_image(texture, nthreads, &why);
    else if (texture && retex_lay_is_image(&spec))
        code = lay_color(texture, nthreads, &why);
    else if (texture)
        code = make_finishes(texture, NULL, NULL, nthreads, &why);
    if (!code)
        code = load_layers(texture, &spec, nthreads, &why);
    if (code) {
        retex_texture_close(&texture);
        if (code == RETEX_EIO) { /* perhaps a misspelt colour */
            const size_t used = strlen(why.message);
            snprintf(why.message + used, sizeof why.message - used, "%s", retex_color_meant(spec.image, meant));
        }
        if (err)
            *err = why;
        return code;
    }
    return_texture(out, texture, spec.color);
    return RETEX_OK;
}

int retex_texture_create(RetexTexture **out, const RetexImage *image, const RetexTextureSpec *given, int nthreads,
                         RetexError *err)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError why = {0};
    *out = NULL;
    if (RETEX_PARAMS_COPY(&spec, given, err))
        return RETEX_EINVAL;
    if (!image || !image->pixels || (image->channels != 1 && image->channels != 3 && image->channels != 4))
        return retex_fail(err, RETEX_EINVAL, "a texture is made of 1, 3 or 4 channels");
    spec.constant = 0;
    RetexTexture *texture = retex_texture_new(&spec, &why);
    RetexImage copy = {0};
    int code = texture ? retex_image_alloc(&copy, image->width, image->height, 4, &why) : why.code;
    if (!code) {
        size_t pixels = (size_t)image->width * (size_t)image->height;
        for (size_t i = 0; i < pixels; i++) {
            const float *from = image->pixels + i * (size_t)image->channels;
            float *to = copy.pixels + i * 4;
            for (int c = 0; c < 4; c++)
                to[c] = c < image->channels ? from[c] : c == 3 ? 1 : from[0];
        }
        RetexTexels texels = {0};
        code = take_pixels(texture, &copy, &texels, nthreads, &why);
        if (!code)
            code = adjust(texture, &texels, nthreads, &why);
        if (!code)
            code = make_texture(texture, NULL, &texels, nthreads, &why);
        if (!code)
            code = load_layers(texture, &spec, nthreads, &why);
        retex_image_free(&copy);
    }
    if (code) {
        retex_texture_close(&texture);
        if (err)
            *err = why;
        return code;
    }
    return_texture(out, texture, texture->spec.color);
    return RETEX_OK;
}

