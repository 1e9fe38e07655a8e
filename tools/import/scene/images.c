/* Images of a model: copied as they are where that will do, else made anew as PNG. */
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include <retex/color.h>
#include <retex/image_file.h>
#include <retex/output_file.h>

#include "common/picture_kind.h"
#include "import/base/files.h"
#include "import/base/look_text.h"
#include "import/base/tell.h"
#include "import/scene/images.h"
#include "import/scene/surface.h"

typedef struct ImageFile {
    char *key; /* what was asked for */
    char file[NAME_SIZE + 32];
    ChannelStats stats;
    int missing;
} ImageFile;

/* Formats that POV-Ray reads, by the endings of names, and what it calls them. */
static const struct {
    const char *ending, *keyword;
} formats[] = {{"png", "png"}, {"jpg", "jpeg"}, {"gif", "gif"}, {"tif", "tiff"}, {"exr", "exr"}, {"hdr", "hdr"}};
enum { FORMATS = sizeof formats / sizeof *formats };

const char *images_keyword(const char *file)
{
    const char *dot = strrchr(file, '.');
    for (int i = 0; dot && i < FORMATS; i++)
        if (strcmp(dot + 1, formats[i].ending) == 0)
            return formats[i].keyword;
    return "png";
}

void images_free(Import *import)
{
    for (int i = 0; i < import->nimages; i++)
        free(import->images[i].key);
    free(import->images);
}

static ImageFile *look_up(Import *import, const char *key, int *is_new, RetexError *err)
{
    for (int i = 0; i < import->nimages; i++)
        if (strcmp(import->images[i].key, key) == 0) {
            *is_new = 0;
            return &import->images[i];
        }
    *is_new = 1;
    if (import->nimages == import->image_capacity) {
        const int capacity = import->image_capacity ? 2 * import->image_capacity : 16;
        ImageFile *more = realloc(import->images, (size_t)capacity * sizeof *more);
        if (!more) {
            retex_fail(err, RETEX_ENOMEM, "out of memory");
            return NULL;
        }
        import->images = more;
        import->image_capacity = capacity;
    }
    ImageFile *image = &import->images[import->nimages];
    *image = (ImageFile){.key = strdup(key)};
    if (!image->key) {
        retex_fail(err, RETEX_ENOMEM, "out of memory");
        return NULL;
    }
    import->nimages++;
    return image;
}

/* ---- the bytes of a source ---- */

typedef struct Bytes {
    unsigned char *data; /* owned where is_owned */
    size_t size;
    int is_owned;
    char path[PATH_MAX];            /* of the file; "" = inside of the model */
    const struct aiTexture *texels; /* not compressed: data is NULL */
} Bytes;

static const struct aiTexture *embedded(const Import *import, const char *source)
{
    const struct aiScene *scene = import->scene;
    if (source[0] == '*') {
        const long index = strtol(source + 1, NULL, 10);
        return index >= 0 && index < (long)scene->mNumTextures ? scene->mTextures[index] : NULL;
    }
    for (unsigned i = 0; i < scene->mNumTextures; i++)
        if (scene->mTextures[i]->mFilename.length && strcmp(scene->mTextures[i]->mFilename.data, source) == 0)
            return scene->mTextures[i];
    return NULL;
}

static int read_bytes(const Import *import, Bytes *bytes, RetexError *err)
{
    int descriptor;
    int code = retex_access_open(&import->access, bytes->path, &descriptor, err);
    if (code)
        return code;
    FILE *in = fdopen(descriptor, "rb");
    size_t capacity = 1 << 16;
    bytes->is_owned = 1;
    bytes->data = malloc(capacity);
    for (size_t n = 1; in && bytes->data && n; bytes->size += n) {
        if (bytes->size == capacity) {
            unsigned char *more = realloc(bytes->data, capacity *= 2);
            if (!more)
                break;
            bytes->data = more;
        }
        n = fread(bytes->data + bytes->size, 1, capacity - bytes->size, in);
    }
    const int failed = !in || !bytes->data || ferror(in);
    if (in)
        fclose(in);
    if (failed)
        return retex_fail(err, RETEX_EIO, "cannot read %s", bytes->path);
    return RETEX_OK;
}

/* found = 0: there is no such image. */
static int get_bytes(Import *import, const char *source, Bytes *bytes, int *found, RetexError *err)
{
    const struct aiTexture *texture = embedded(import, source);
    memset(bytes, 0, sizeof *bytes);
    *found = 1;
    if (texture && texture->mHeight) {
        bytes->texels = texture;
        return RETEX_OK;
    }
    if (texture) {
        bytes->data = (unsigned char *)texture->pcData;
        bytes->size = texture->mWidth;
        return RETEX_OK;
    }
    if (source[0] == '*') {
        *found = 0;
        return RETEX_OK;
    }
    const int code = files_find(import, source, bytes->path, found, err);
    return code || !*found ? code : read_bytes(import, bytes, err);
}

static void release(Bytes *bytes)
{
    if (bytes->is_owned)
        free(bytes->data);
    bytes->data = NULL;
}

/* The ending of a format that POV-Ray reads, by the first bytes of a file; or NULL. */
static const char *ending_of(const Bytes *bytes)
{
    const PictureKind *kind = picture_kind_of_bytes(bytes->data, bytes->size);
    for (int i = 0; kind && i < FORMATS; i++)
        if (strcmp(kind->ending, formats[i].ending) == 0)
            return kind->ending;
    return NULL;
}

/* Whether a picture may have alpha: PNG says so in its header or a chunk tRNS. */
static int may_have_alpha(const Bytes *bytes, const char *ending)
{
    if (!ending || strcmp(ending, "jpg") == 0 || strcmp(ending, "hdr") == 0)
        return !ending;
    if (strcmp(ending, "png") != 0 || bytes->size < 33)
        return 1;
    if (bytes->data[25] & 4)
        return 1;
    for (size_t at = 8; at + 12 <= bytes->size;) {
        const unsigned char *p = bytes->data + at;
        const size_t length = (size_t)p[0] << 24 | (size_t)p[1] << 16 | (size_t)p[2] << 8 | p[3];
        if (memcmp(p + 4, "tRNS", 4) == 0)
            return 1;
        if (memcmp(p + 4, "IDAT", 4) == 0 || length > bytes->size - at - 12)
            break;
        at += length + 12;
    }
    return 0;
}

/* An image that cannot be read is told, and the scene does without if it may. */
static void tell_missing(Import *import, const char *source, const RetexError *why)
{
    char plain[NAME_SIZE];
    const struct aiTexture *texture = embedded(import, source);
    if (!losses_of_image(import, source))
        return;
    import_plain(texture && texture->mFilename.length ? texture->mFilename.data : source, plain);
    if (why)
        import_tell(import, IMPORT_WARNING, "the image `%s` cannot be read: %s", plain, why->message);
    else
        import_tell(import, IMPORT_WARNING, "there is no image `%s`", plain);
}

static int is_missing(Import *import, ImageFile *image, const char *source, const RetexError *why)
{
    image->missing = 1;
    image->file[0] = '\0';
    tell_missing(import, source, why);
    return RETEX_OK;
}

static int is_fatal(int code)
{
    return code == RETEX_ENOMEM || code == RETEX_ELIMIT || code == RETEX_ESTOPPED || code == RETEX_EACCESS ||
           code == RETEX_EIO;
}

/* ---- pixels ---- */

static int texels_to_image(const struct aiTexture *texture, int is_data, RetexImage *image, RetexError *err)
{
    if (texture->mWidth > RETEX_MAX_SIZE || texture->mHeight > RETEX_MAX_SIZE)
        return retex_fail(err, RETEX_ELIMIT, "an image of %u x %u pixels is too large", texture->mWidth,
                          texture->mHeight);
    const int code = retex_image_alloc(image, (int)texture->mWidth, (int)texture->mHeight, 4, err);
    for (size_t i = 0; !code && i < (size_t)texture->mWidth * texture->mHeight; i++) {
        const struct aiTexel t = texture->pcData[i];
        const unsigned char c[4] = {t.r, t.g, t.b, t.a};
        for (int k = 0; k < 4; k++) {
            const double x = c[k] / 255.0;
            image->pixels[4 * i + (size_t)k] = (float)(k == 3 || is_data ? x : retex_srgb_decode(x));
        }
    }
    return code;
}

static void warn_of_image(void *context, const char *text)
{
    import_tell(context, IMPORT_WARNING, "%s", text);
}

static int decode(Import *import, const Bytes *bytes, int is_data, RetexImage *image, RetexError *err)
{
    RetexReadParams params = RETEX_READ_INIT;
    RetexAccess access = RETEX_ACCESS_INIT;
    char path[PATH_MAX];
    if (bytes->texels)
        return texels_to_image(bytes->texels, is_data, image, err);
    access.safe = import->options->safe;
    access.accept_damaged = import->options->accept_damaged;
    if (access.accept_damaged) { /* otherwise warnings are of colours, which the renderer tells */
        params.warn = warn_of_image;
        params.warn_context = import;
    }
    params.colorspace = is_data ? "linear" : NULL; /* either is read without OpenImageIO */
    params.access = &access;
    params.budget = import->options->budget;
    params.max_pixels = import->options->max_pixels;
    if (bytes->path[0])
        return retex_image_read(image, bytes->path, &params, 1, err);
    /* inside of the model: the reader needs a file */
    if (snprintf(path, sizeof path, "%s/image.tmp", import->options->folder) >= (int)sizeof path)
        return retex_fail(err, RETEX_EIO, "the folder's name is too long");
    int code = retex_file_write(path, bytes->data, bytes->size, err);
    if (code)
        return code;
    code = retex_image_read(image, path, &params, 1, err);
    unlink(path);
    return code;
}

/* Opacity from another image: its alpha, where it has some, times its grey. Taken at the nearest pixel. */
static int take_opacity(Import *import, const char *source, RetexImage *image, RetexError *err)
{
    Bytes bytes;
    RetexImage mask = {0};
    RetexError why = {0};
    int found, has_alpha = 0;
    int code = get_bytes(import, source, &bytes, &found, err);
    if (!code && !found)
        tell_missing(import, source, NULL);
    if (code || !found)
        return code;
    code = decode(import, &bytes, 1, &mask, &why);
    release(&bytes);
    if (code && is_fatal(code)) {
        *err = why;
        return code;
    }
    if (code) {
        tell_missing(import, source, &why);
        return RETEX_OK;
    }
    for (size_t i = 0; i < (size_t)mask.width * (size_t)mask.height; i++)
        has_alpha |= mask.pixels[4 * i + 3] < 1;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            const float *m = mask.pixels + retex_image_index(&mask, (int)((long)x * mask.width / image->width),
                                                             (int)((long)y * mask.height / image->height));
            image->pixels[retex_image_index(image, x, y) + 3] = has_alpha ? m[3] : (m[0] + m[1] + m[2]) / 3;
        }
    retex_image_free(&mask);
    return RETEX_OK;
}

static int bake(Import *import, const ImageUse *use, RetexImage *image, RetexError *err)
{
    if (use->opacity) {
        const int code = take_opacity(import, use->opacity, image, err);
        if (code)
            return code;
    }
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
        float *p = image->pixels + 4 * i;
        for (int k = 0; k < 3; k++)
            p[k] = fminf(p[k] * use->factor[k], 1);
        p[3] *= use->opacity_factor;
        p[3] = use->alpha == ALPHA_IGNORE ? 1 : use->alpha == ALPHA_MASK ? (float)(p[3] >= use->cutoff) : p[3];
    }
    return RETEX_OK;
}

static int write_png(const Import *import, const RetexImage *image, int has_alpha, const char *file, RetexError *err)
{
    RetexImage opaque = {0};
    char path[PATH_MAX];
    int code = snprintf(path, sizeof path, "%s/%s", import->options->folder, file) >= (int)sizeof path
                   ? retex_fail(err, RETEX_EIO, "the folder's name is too long")
                   : RETEX_OK;
    if (!code && !has_alpha) {
        code = retex_image_alloc(&opaque, image->width, image->height, 3, err);
        for (size_t i = 0; !code && i < (size_t)image->width * (size_t)image->height; i++)
            memcpy(opaque.pixels + 3 * i, image->pixels + 4 * i, 3 * sizeof(float));
    }
    if (!code)
        code = retex_image_write(has_alpha ? image : &opaque, path, NULL, 1, err);
    retex_image_free(&opaque);
    return code;
}

/* Means of what each pixel of the smaller image covers. */
static void shrink(const RetexImage *from, RetexImage *to)
{
    const size_t channels = (size_t)from->channels;
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            const int x0 = x * from->width / to->width, x1 = (x + 1) * from->width / to->width;
            const int y0 = y * from->height / to->height, y1 = (y + 1) * from->height / to->height;
            float *mean = to->pixels + retex_image_index(to, x, y);
            for (int j = y0; j < y1; j++)
                for (int i = x0; i < x1; i++)
                    for (size_t k = 0; k < channels; k++)
                        mean[k] += from->pixels[retex_image_index(from, i, j) + k] / (float)((x1 - x0) * (y1 - y0));
        }
}

/* A copy for the first look at the scene, which has some thousand pixels: to read pictures of 2K would take longer than
 * all else of it. Where it cannot be made, the look is at the picture as it is. */
static void write_small(const Import *import, const RetexImage *image, const char *file, const char *colorspace)
{
    enum { SIDE = 128 };
    RetexImage small = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    char path[PATH_MAX], made[PATH_MAX + 4];
    params.colorspace = colorspace;
    const char *keyword = images_keyword(file);
    const int is_kept = strcmp(keyword, "png") != 0 && strcmp(keyword, "jpeg") != 0; /* it may be brighter than white */
    if (!import->options->looks || is_kept || image->width < 2 * SIDE || image->height < 2 * SIDE ||
        snprintf(path, sizeof path, "%s/" LOOK_FOLDER "/%s", import->options->folder, file) >= (int)sizeof path ||
        retex_image_alloc(&small, SIDE, SIDE, image->channels, NULL))
        return;
    shrink(image, &small);
    snprintf(made, sizeof made, "%s.png", path);
    if (retex_image_write(&small, made, &params, 1, NULL) == RETEX_OK)
        rename(made, path);
    retex_image_free(&small);
}

/* ---- files of the scene ---- */

/* A name for the copy, of the source's last part. */
static int name_file(Import *import, const char *source, const char *ending, char file[NAME_SIZE + 32], RetexError *err)
{
    const struct aiTexture *texture = embedded(import, source);
    char clean[PATH_MAX], name[NAME_SIZE];
    snprintf(clean, sizeof clean, "%s", texture ? texture->mFilename.data : source);
    char *last = clean;
    for (char *c = clean; *c; c++)
        if (*c == '/' || *c == '\\')
            last = c + 1;
    char *dot = strrchr(last, '.');
    if (dot)
        *dot = '\0';
    if (!names_make(&import->files, *last == '*' ? "" : last, "Image", name))
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    snprintf(file, NAME_SIZE + 32, "textures/%s%s%s", name, strchr(ending, '.') ? "_" : ".", ending);
    return RETEX_OK;
}

static int make_image(Import *import, const ImageUse *use, ImageFile *image, Bytes *bytes, RetexError *err)
{
    const char *ending = ending_of(bytes);
    const int alpha = may_have_alpha(bytes, ending);
    const int changes = use->factor[0] != 1 || use->factor[1] != 1 || use->factor[2] != 1 || use->opacity ||
                        (use->opacity_factor != 1 && use->alpha != ALPHA_IGNORE) ||
                        (alpha && use->alpha != ALPHA_BLEND);
    RetexImage pixels = {0};
    char path[PATH_MAX];
    int code = name_file(import, use->source, ending && !changes ? ending : "png", image->file, err);
    if (code)
        return code;
    /* What is copied is decoded as well: a damaged image would stop the renderer. */
    RetexError why = {0};
    code = decode(import, bytes, 0, &pixels, &why);
    if (code) {
        if (is_fatal(code))
            *err = why;
        return is_fatal(code) ? code : is_missing(import, image, use->source, &why);
    }
    if (ending && !changes) {
        write_small(import, &pixels, image->file, NULL);
        retex_image_free(&pixels);
        if (snprintf(path, sizeof path, "%s/%s", import->options->folder, image->file) >= (int)sizeof path)
            return retex_fail(err, RETEX_EIO, "the folder's name is too long");
        return retex_file_write(path, bytes->data, bytes->size, err);
    }
    code = bake(import, use, &pixels, err);
    if (!code)
        code = write_png(import, &pixels,
                         (alpha || use->opacity || use->opacity_factor != 1) && use->alpha != ALPHA_IGNORE, image->file,
                         err);
    if (!code)
        write_small(import, &pixels, image->file, NULL);
    retex_image_free(&pixels);
    return code;
}

int images_use(Import *import, const ImageUse *use, char file[NAME_SIZE + 32], RetexError *err)
{
    char key[2 * PATH_MAX];
    Bytes bytes;
    int is_new, found;
    snprintf(key, sizeof key, "%d %g %g %g %g %g %s|%s", (int)use->alpha, use->alpha == ALPHA_MASK ? use->cutoff : 0.0,
             (double)use->factor[0], (double)use->factor[1], (double)use->factor[2], (double)use->opacity_factor,
             use->source, use->opacity ? use->opacity : "");
    ImageFile *image = look_up(import, key, &is_new, err);
    if (!image)
        return RETEX_ENOMEM;
    int code = RETEX_OK;
    if (is_new) {
        code = get_bytes(import, use->source, &bytes, &found, err);
        if (!code && !found)
            is_missing(import, image, use->source, NULL);
        else if (!code)
            code = make_image(import, use, image, &bytes, err);
        release(&bytes);
    }
    snprintf(file, NAME_SIZE + 32, "%s", image->file);
    return code;
}

static ChannelStats stats_of(const RetexImage *image)
{
    ChannelStats stats = {.low = {INFINITY, INFINITY, INFINITY, INFINITY}};
    double sum[4] = {0};
    const size_t n = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < 4 * n; i++) {
        const float x = image->pixels[i];
        sum[i % 4] += (double)x;
        stats.low[i % 4] = fminf(stats.low[i % 4], x);
        stats.high[i % 4] = fmaxf(stats.high[i % 4], x);
    }
    for (int k = 0; k < 4 && n; k++)
        stats.mean[k] = (float)(sum[k] / (double)n);
    return stats;
}

/* The image as numbers; missing = 1, which is told, where it cannot be read. */
static int decode_data(Import *import, const char *source, RetexImage *pixels, ImageFile *image, RetexError *err)
{
    Bytes bytes;
    RetexError why = {0};
    int found, code = get_bytes(import, source, &bytes, &found, err);
    if (code)
        return code;
    if (!found)
        return is_missing(import, image, source, NULL);
    code = decode(import, &bytes, 1, pixels, &why);
    release(&bytes);
    if (code && is_fatal(code)) {
        *err = why;
        return code;
    }
    return code ? is_missing(import, image, source, &why) : RETEX_OK;
}

int images_stats(Import *import, const char *source, ChannelStats *stats, int *found, RetexError *err)
{
    char key[PATH_MAX + 8];
    int is_new;
    snprintf(key, sizeof key, "stats %s", source);
    ImageFile *image = look_up(import, key, &is_new, err);
    if (!image)
        return RETEX_ENOMEM;
    if (is_new) {
        RetexImage pixels = {0};
        const int code = decode_data(import, source, &pixels, image, err);
        if (code)
            return code;
        image->stats = stats_of(&pixels);
        retex_image_free(&pixels);
    }
    *stats = image->stats;
    *found = !image->missing;
    return RETEX_OK;
}

/* What becomes of an image of numbers: one channel of it, or normals of its heights. */
typedef struct Remake {
    const char *name; /* of the file begins with the source's and ends with this */
    int channel;      /* or -1: normals */
    float scale;      /* of heights */
} Remake;

static void take_channel(const RetexImage *from, RetexImage *to, const Remake *remake)
{
    for (size_t i = 0; i < (size_t)from->width * (size_t)from->height; i++)
        to->pixels[i] = from->pixels[4 * i + (size_t)remake->channel];
}

static float height_at(const RetexImage *image, int x, int y)
{
    const float *p = image->pixels +
                     retex_image_index(image, (x + image->width) % image->width, (y + image->height) % image->height);
    return (p[0] + p[1] + p[2]) / 3;
}

/* By the heights of the neighbours, for images that repeat. */
static void normals_of_heights(const RetexImage *from, RetexImage *to, const Remake *remake)
{
    const float steps = 0.01f * remake->scale * (float)from->width / 2;
    for (int y = 0; y < from->height; y++)
        for (int x = 0; x < from->width; x++) {
            const float right = steps * (height_at(from, x + 1, y) - height_at(from, x - 1, y)),
                        up = steps * (height_at(from, x, y - 1) - height_at(from, x, y + 1)),
                        scale = 0.5f / sqrtf(right * right + up * up + 1);
            float *n = to->pixels + retex_image_index(to, x, y);
            n[0] = 0.5f - scale * right, n[1] = 0.5f - scale * up, n[2] = 0.5f + scale;
        }
}

static int write_numbers(Import *import, const char *source, const Remake *remake, ImageFile *image, RetexError *err)
{
    RetexImage pixels = {0}, made = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    char path[PATH_MAX], ending[32];
    params.colorspace = "raw";
    snprintf(ending, sizeof ending, "%s.png", remake->name);
    int code = name_file(import, source, ending, image->file, err);
    if (!code)
        code = decode_data(import, source, &pixels, image, err);
    if (code || image->missing)
        return code;
    code = retex_image_alloc(&made, pixels.width, pixels.height, remake->channel < 0 ? 3 : 1, err);
    if (!code)
        (remake->channel < 0 ? normals_of_heights : take_channel)(&pixels, &made, remake);
    if (!code && snprintf(path, sizeof path, "%s/%s", import->options->folder, image->file) >= (int)sizeof path)
        code = retex_fail(err, RETEX_EIO, "the folder's name is too long");
    if (!code)
        code = retex_image_write(&made, path, &params, 1, err);
    if (!code)
        write_small(import, &made, image->file, params.colorspace);
    retex_image_free(&pixels);
    retex_image_free(&made);
    return code;
}

static int use_numbers(Import *import, const char *source, const Remake *remake, char file[NAME_SIZE + 32],
                       RetexError *err)
{
    char key[PATH_MAX + 64];
    int is_new;
    snprintf(key, sizeof key, "%s %d %g %s", remake->name, remake->channel, (double)remake->scale, source);
    ImageFile *image = look_up(import, key, &is_new, err);
    if (!image)
        return RETEX_ENOMEM;
    const int code = is_new ? write_numbers(import, source, remake, image, err) : RETEX_OK;
    snprintf(file, NAME_SIZE + 32, "%s", image->file);
    return code;
}

int images_channel(Import *import, const char *source, int channel, const char *what, char file[NAME_SIZE + 32],
                   RetexError *err)
{
    return use_numbers(import, source, &(Remake){what, channel, 1}, file, err);
}

int images_normals(Import *import, const char *source, float scale, char file[NAME_SIZE + 32], RetexError *err)
{
    return use_numbers(import, source, &(Remake){"normals", -1, scale}, file, err);
}

/* Refuse what the renderer would refuse. */
static int check_picture(Import *import, const char *path, RetexError *err)
{
    RetexReadParams params = RETEX_READ_INIT;
    RetexImage image = {0};
    RetexError why = {0};
    import->access.accept_damaged = import->options->accept_damaged;
    params.access = &import->access;
    params.budget = import->options->budget;
    params.max_pixels = import->options->max_pixels;
    if (import->options->accept_damaged) {
        params.warn = warn_of_image;
        params.warn_context = import;
    }
    const int code = retex_image_read(&image, path, &params, 1, &why);
    retex_image_free(&image);
    return code ? retex_fail(err, code, "%s: %s", path, why.message) : RETEX_OK;
}

int images_add_sky(Import *import, char file[NAME_SIZE + 32], RetexError *err)
{
    Bytes bytes = {0};
    RetexAccess access = RETEX_ACCESS_INIT;
    char path[PATH_MAX];
    const RetexAccess ours = import->access;
    if (strlen(import->options->sky) >= sizeof bytes.path)
        return retex_fail(err, RETEX_EIO, "--sky: the name is too long");
    strcpy(bytes.path, import->options->sky);
    import->access = access; /* the user named it */
    import->access.safe = import->options->safe;
    int code = read_bytes(import, &bytes, err);
    const char *ending = code ? NULL : ending_of(&bytes);
    if (!code && !ending)
        code = retex_fail(err, RETEX_EFORMAT, "%s: --sky takes a picture as HDR, EXR, PNG, JPEG or TIFF",
                          import->options->sky);
    if (!code)
        code = check_picture(import, bytes.path, err);
    import->access = ours;
    if (!code) {
        snprintf(file, NAME_SIZE + 32, "textures/sky.%s", ending);
        snprintf(path, sizeof path, "%s/%s", import->options->folder, file);
        code = retex_file_write(path, bytes.data, bytes.size, err);
    }
    release(&bytes);
    return code;
}
