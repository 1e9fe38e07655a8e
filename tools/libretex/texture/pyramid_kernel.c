/* The MIP pyramid. Each level has half the size of the one before, rounded down; with an odd number of texels, too,
 * each new texel is the exact average of its share. */
#include <stdlib.h>

#include "texture/texture_kernel.h"

#include <retex/parallel.h>

#define ROWS_A_JOB 16
#define PADDING 56               /* texels: about half of the longest window */
#define MOST_PADDED (640 * 640L) /* texels of a padded level */

int retex_texels_alloc(RetexTexels *texels)
{
    texels->texels = malloc(texel_size(texels->narrow) * (size_t)texels->width * (size_t)texels->height);
    return texels->texels ? 0 : -1;
}

void retex_texture_read_texel(const void *texels, size_t index, int narrow, float rgba[4])
{
    RetexFloat4 texel = raw_texel((const char *)texels + index * texel_size(narrow), narrow) * texel_unit(narrow);
    memcpy(rgba, &texel, sizeof texel);
}

void retex_texture_store_texel(const RetexTexels *to, size_t index, const float rgba[4])
{
    if (!to->narrow) {
        memcpy((float *)to->texels + 4 * index, rgba, 4 * sizeof *rgba);
        return;
    }
    uint16_t *texel = (uint16_t *)to->texels + 4 * index;
    for (int c = 0; c < 4; c++) { /* what is no number becomes 0 */
        const float limited = rgba[c] > 0 ? rgba[c] < 1 ? rgba[c] : 1 : 0;
        texel[c] = (uint16_t)(limited * NARROW_ONE + 0.5f);
    }
}

/* ---- halving ---- */

/* The texels, of n, that form texel i of the next coarser level, and their weights. Returns their number: 1, 2 or 3. */
static int halving_weights(int n, int i, float weight[3], int *first)
{
    int half = n / 2;
    *first = 2 * i;
    if (n == 1) {
        *first = 0;
        weight[0] = 1;
        return 1;
    }
    if (n % 2 == 0) {
        weight[0] = weight[1] = 0.5f;
        return 2;
    }
    weight[0] = (float)(half - i) / (float)n;
    weight[1] = (float)half / (float)n;
    weight[2] = (float)(i + 1) / (float)n;
    return 3;
}

/* The variance that halving n texels adds, in texels of the finer level, at relative position p: blur[0] + blur[1] p (1
 * - p). It is the variance of the weights above. */
static void halving_blur(int n, double blur[2])
{
    double half = n / 2, share = half / n;
    blur[0] = blur[1] = 0;
    if (n > 1 && n % 2 == 0) {
        blur[0] = 0.25;
    } else if (n > 1) {
        blur[0] = (half + 1) / n - share * share;
        blur[1] = 4 * share * share;
    }
}

static inline void store_texel(char *to, int narrow, RetexFloat4 texel)
{
    if (!narrow) {
        memcpy(to, &texel, sizeof texel);
        return;
    }
    uint16_t t[4];
    for (int c = 0; c < 4; c++)
        t[c] = (uint16_t)(texel[c] + 0.5f);
    memcpy(to, t, sizeof t);
}

/* Halves a row of texels, or several rows with weights `down`. */
static inline void halve_texels(char *restrict out, const char *const in[3], const float *down, int rows, int n,
                                int narrow)
{
    size_t size = texel_size(narrow);
    int half = n > 1 ? n / 2 : 1;
    for (int x = 0; x < half; x++, out += size) {
        float across[3];
        int left, columns = halving_weights(n, x, across, &left);
        RetexFloat4 sum = {0, 0, 0, 0};
        for (int j = 0; j < rows; j++)
            for (int i = 0; i < columns; i++)
                sum += down[j] * across[i] * raw_texel(in[j] + (size_t)(left + i) * size, narrow);
        store_texel(out, narrow, sum);
    }
}

/* Halves two rows with an even number of texels, two by two. */
static inline void halve_pairs(char *restrict out, const char *restrict above, const char *restrict below, int half,
                               int narrow)
{
    size_t size = texel_size(narrow);
    if (!narrow) {
        for (int x = 0; x < half; x++, out += size, above += 2 * size, below += 2 * size) {
            RetexFloat4 sum =
                (load4((const float *)(const void *)above) + load4((const float *)(const void *)(above + size))) +
                (load4((const float *)(const void *)below) + load4((const float *)(const void *)(below + size)));
            store_texel(out, 0, sum * 0.25f);
        }
        return;
    }
    const uint16_t *restrict a = (const uint16_t *)(const void *)above, *restrict b =
                                                                            (const uint16_t *)(const void *)below;
    uint16_t *restrict to = (uint16_t *)(void *)out;
    for (int x = 0; x < half; x++)
        for (int c = 0; c < 4; c++)
            to[4 * x + c] = (uint16_t)((2u + a[8 * x + c] + a[8 * x + 4 + c] + b[8 * x + c] + b[8 * x + 4 + c]) >> 2);
}

static void halve_line(void *out, const void *in, int n, int narrow)
{
    static const float whole[1] = {1};
    const char *rows[3] = {in, NULL, NULL};
    if (narrow)
        halve_texels(out, rows, whole, 1, n, 1);
    else
        halve_texels(out, rows, whole, 1, n, 0);
}

typedef struct HalvingWork {
    const RetexTextureLevel *from;
    RetexTextureLevel *to;
    int narrow;
} HalvingWork;

static void halve_row(const RetexTextureLevel *from, RetexTextureLevel *to, int narrow, int y)
{
    float down[3];
    int top, rows = halving_weights(from->height, y, down, &top);
    size_t size = texel_size(narrow), stride = (size_t)from->width * size;
    const char *in[3];
    char *out = (char *)to->texels + (size_t)y * (size_t)to->width * size;
    for (int j = 0; j < 3; j++)
        in[j] = (const char *)from->texels + (size_t)(j < rows ? top + j : top) * stride;
    if (from->width % 2 == 0 && from->height % 2 == 0) {
        if (narrow)
            halve_pairs(out, in[0], in[1], to->width, 1);
        else
            halve_pairs(out, in[0], in[1], to->width, 0);
    } else if (narrow) {
        halve_texels(out, in, down, rows, from->width, 1);
    } else {
        halve_texels(out, in, down, rows, from->width, 0);
    }
}

static void halve_job(void *context, int index, int thread)
{
    const HalvingWork *work = context;
    (void)thread;
    for (int y = index * ROWS_A_JOB; y < (index + 1) * ROWS_A_JOB && y < work->to->height; y++)
        halve_row(work->from, work->to, work->narrow, y);
}

/* ---- the pyramid ---- */

static void *new_texels(int width, int height, int narrow)
{
    RetexTexels texels = {width, height, narrow, NULL};
    retex_texels_alloc(&texels);
    return texels.texels;
}

/* Copies the image's border, for axes that clamp. */
static int take_borders(RetexTexture *texture)
{
    RetexTextureLevel *image = &texture->levels[0];
    int narrow = texture->narrow;
    size_t width = (size_t)image->width, height = (size_t)image->height, size = texel_size(narrow);
    const char *texels = image->texels;
    for (int k = 0; k < 2; k++) {
        size_t column = k ? width - 1 : 0, row = k ? height - 1 : 0;
        if (texture->spec.wrap[0] == RETEX_WRAP_CLAMP) {
            if (!(image->sides[k] = new_texels(1, image->height, narrow)))
                return -1;
            for (size_t y = 0; y < height; y++)
                memcpy((char *)image->sides[k] + size * y, texels + (y * width + column) * size, size);
        }
        if (texture->spec.wrap[1] == RETEX_WRAP_CLAMP) {
            if (!(image->ends[k] = new_texels(image->width, 1, narrow)))
                return -1;
            memcpy(image->ends[k], texels + row * width * size, width * size);
        }
        memcpy(texture->corners[k], texels + column * size, size);
        memcpy(texture->corners[2 + k], texels + ((height - 1) * width + column) * size, size);
    }
    return 0;
}

static int add_level(RetexTexture *texture, int nthreads)
{
    const RetexTextureLevel *from = &texture->levels[texture->nlevels - 1], *image = &texture->levels[0];
    RetexTextureLevel *to = &texture->levels[texture->nlevels++];
    int narrow = texture->narrow;
    to->width = from->width > 1 ? from->width / 2 : 1;
    to->height = from->height > 1 ? from->height / 2 : 1;
    if (!(to->texels = new_texels(to->width, to->height, narrow)))
        return -1;
    HalvingWork work = {from, to, narrow};
    retex_parallel(nthreads, (to->height + ROWS_A_JOB - 1) / ROWS_A_JOB, halve_job, &work);
    for (int k = 0; k < 2; k++) {
        if (from->sides[k]) {
            if (!(to->sides[k] = new_texels(1, to->height, narrow)))
                return -1;
            halve_line(to->sides[k], from->sides[k], from->height, narrow);
        }
        if (from->ends[k]) {
            if (!(to->ends[k] = new_texels(to->width, 1, narrow)))
                return -1;
            halve_line(to->ends[k], from->ends[k], from->width, narrow);
        }
    }
    int sizes[2] = {from->width, from->height};
    to->scale[0] = (double)image->width / to->width;
    to->scale[1] = (double)image->height / to->height;
    for (int axis = 0; axis < 2; axis++) {
        double blur[2];
        halving_blur(sizes[axis], blur);
        for (int i = 0; i < 2; i++)
            to->blur[axis][i] = from->blur[axis][i] + blur[i] * from->scale[axis] * from->scale[axis];
    }
    return 0;
}

/* ---- small levels, padded ---- */

static int pad_level(const RetexTexture *texture, RetexTextureLevel *level)
{
    const int width = level->width + 2 * PADDING, height = level->height + 2 * PADDING;
    if ((long)width * height > MOST_PADDED)
        return 0;
    if (!(level->padded = new_texels(width, height, texture->narrow)))
        return -1;
    level->padding = PADDING;
    for (int y = 0; y < height; y++)
        copy_texels(texture, level, -PADDING, y - PADDING, width,
                    (char *)level->padded + (size_t)y * (size_t)width * texel_size(texture->narrow));
    return 0;
}

static void fill_tail(RetexTexture *texture)
{
    int n = (int)(sizeof texture->tail / sizeof texture->tail[0]);
    for (int i = 0; i < n; i++) {
        double z = i / (double)TEXTURE_TAIL_STEPS;
        texture->tail[i] = (float)(exp(-0.5 * z * z) / sqrt(2 * M_PI) - 0.5 * z * erfc(z / sqrt(2)));
    }
}

int retex_texture_build_pyramid(RetexTexture *texture, RetexTexels *texels, int nthreads)
{
    RetexTextureLevel *image = &texture->levels[0];
    image->width = texels->width;
    image->height = texels->height;
    image->texels = texels->texels;
    image->scale[0] = image->scale[1] = 1;
    texels->texels = NULL;
    texture->narrow = texels->narrow;
    texture->nlevels = 1;
    fill_tail(texture);
    int failed = take_borders(texture);
    while (!failed) {
        const RetexTextureLevel *last = &texture->levels[texture->nlevels - 1];
        if ((last->width == 1 && last->height == 1) || texture->nlevels == TEXTURE_MAX_LEVELS)
            break;
        failed = add_level(texture, nthreads);
    }
    for (int i = 0; i < texture->nlevels && !failed; i++)
        failed = pad_level(texture, &texture->levels[i]);
    return failed;
}
