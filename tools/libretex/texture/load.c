/* Loads textures: files are read, texels that cannot be colours are repaired, and maps of finishes are made. A
 * texture's pixels become premultiplied RGBA: 16-bit integers where the file has integers, else floats. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color_text.h>
#include <retex/parallel.h>

#include "base/params.h"
#include "picture/image_read.h"
#include "texture/finish_map.h"
#include "texture/folder.h"

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
    params.pixel_bytes = retex_texture_has_two_repeats(spec) ? 2 * PEAK_BYTES : PEAK_BYTES;
    return params;
}

static int read_file(RetexTexture *texture, const char *file, const char *colorspace, RetexDecoded *decoded,
                            int nthreads, RetexError *err)
{
    RetexReadParams params = read_params(texture);
    params.colorspace = colorspace ? colorspace : params.colorspace;
    return retex_image_read_any(decoded, file, &params, nthreads, err);
}

/* A map is numbers, which are read as they are. */
static int make_map(RetexTexture *texture, const RetexTexels *color, const char *file, RetexFinishScale scale,
                    int channel, int nthreads, RetexError *err)
{
    RetexDecoded map = {0};
    int code = read_file(texture, file, "linear", &map, nthreads, err);
    if (!code)
        code = retex_finish_map_make(texture, color, &map, scale, channel, nthreads, err);
    free(map.narrow.pixels);
    retex_image_free(&map.image);
    return code;
}

/* Makes the map of finishes, where there is one. color: NULL = a constant. */
static int make_finishes(RetexTexture *texture, const RetexFolderFiles *files, const RetexTexels *color, int nthreads,
                         RetexError *err)
{
    const RetexTextureSpec *own = &texture->spec;
    texture->may_have_finishes = own->finish[0] || (files && files->has_roughness);
    if (files && files->roughness)
        return make_map(texture, color, files->roughness,
                        files->is_gloss ? RETEX_FINISH_BY_GLOSS : RETEX_FINISH_BY_ROUGHNESS, files->channel, nthreads,
                        err);
    if (!own->finish[0] || strcmp(own->finish, RETEX_NO_FINISH_MAP) == 0)
        return RETEX_OK;
    if (own->nfinishes < 2)
        return retex_fail(err, RETEX_EINVAL, "%s has no finishes to choose from: finish= cannot be used on it",
                          own->target[0] ? own->target : "the target");
    return make_map(texture, color, own->finish, RETEX_FINISH_BY_LIST, 0, nthreads, err);
}

/* Reads the files that the image is. */
static int read_image(RetexTexture *texture, int nthreads, RetexError *err)
{
    const RetexTextureSpec *own = &texture->spec;
    const int wants_roughness = !own->finish[0] && retex_finish_map_has_scale(own);
    RetexDecoded decoded = {0};
    RetexFolderFiles files;
    RetexTexels texels = {0};
    int code = retex_texture_folder_find(&files, own->image, own->access, wants_roughness, err);
    if (!code && files.unused)
        keep_warning(texture, files.unused);
    if (!code)
        code = read_file(texture, files.color, NULL, &decoded, nthreads, err);
    if (!code && decoded.narrow.pixels)
        texels = (RetexTexels){decoded.narrow.width, decoded.narrow.height, 1, decoded.narrow.pixels};
    else if (!code)
        code = take_pixels(texture, &decoded.image, &texels, nthreads, err);
    if (!code)
        code = make_finishes(texture, &files, &texels, nthreads, err);
    if (!code)
        code = retex_texture_set_texels(texture, &texels, nthreads, err);
    free(texels.texels);
    retex_image_free(&decoded.image);
    retex_texture_folder_files_free(&files);
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
    RetexTexture *texture = retex_texture_new(&spec, spec.constant, &why);
    int code = why.code;
    if (texture && !spec.constant)
        code = read_image(texture, nthreads, &why);
    if (texture && spec.constant)
        code = make_finishes(texture, NULL, NULL, nthreads, &why);
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
    RetexTexture *texture = retex_texture_new(&spec, 0, &why);
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
            code = retex_texture_set_texels(texture, &texels, nthreads, &why);
        free(texels.texels);
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

