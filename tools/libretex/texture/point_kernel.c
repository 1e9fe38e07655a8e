/* Texture look-ups of single points: bilinear, or the nearest texel; and rows of texels. */
#include <retex/host/texture_lookup.h>

#include "texture/texture_kernel.h"

/* An axis with transparent outside ends sharply: a point within half a texel of the border has the border's texel. */
static RetexWrap wrap_of_points(const RetexTexture *texture, int axis)
{
    return texture->spec.wrap[axis] == RETEX_WRAP_BLACK ? RETEX_WRAP_CLAMP : texture->spec.wrap[axis];
}

void retex_texture_point_kernel(const RetexTexture *texture, double x, double y, float rgba[4])
{
    const RetexTextureLevel *image = &texture->levels[0];
    x = first_period(x, image->width, texture->spec.wrap[0]) - 0.5;
    y = first_period(y, image->height, texture->spec.wrap[1]) - 0.5;
    int x0 = whole_below(x), y0 = whole_below(y);
    float tx = (float)(x - x0), ty = (float)(y - y0);
    RetexWrap wrap_x = wrap_of_points(texture, 0), wrap_y = wrap_of_points(texture, 1);
    RetexFloat4 lines[2];
    size_t size = texel_size(texture->narrow);
    int columns[2];
    for (int i = 0; i < 2; i++)
        columns[i] = clamp_index(wrap_index(x0 + i, image->width, wrap_x), image->width);
    for (int j = 0; j < 2; j++) {
        int line = clamp_index(wrap_index(y0 + j, image->height, wrap_y), image->height);
        const char *row = (const char *)image->texels + (size_t)line * (size_t)image->width * size;
        lines[j] = raw_texel(row + (size_t)columns[0] * size, texture->narrow) * (1 - tx) +
                   raw_texel(row + (size_t)columns[1] * size, texture->narrow) * tx;
    }
    RetexFloat4 sum = (lines[0] * (1 - ty) + lines[1] * ty) * texel_unit(texture->narrow);
    memcpy(rgba, &sum, sizeof sum);
}

void retex_texture_nearest_kernel(const RetexTexture *texture, double x, double y, float rgba[4])
{
    const RetexTextureLevel *image = &texture->levels[0];
    int column = whole_below(first_period(x, image->width, texture->spec.wrap[0]));
    int line = whole_below(first_period(y, image->height, texture->spec.wrap[1]));
    column = clamp_index(wrap_index(column, image->width, wrap_of_points(texture, 0)), image->width);
    line = clamp_index(wrap_index(line, image->height, wrap_of_points(texture, 1)), image->height);
    size_t texel = (size_t)line * (size_t)image->width + (size_t)column;
    RetexFloat4 value = raw_texel((const char *)image->texels + texel * texel_size(texture->narrow), texture->narrow) *
                        texel_unit(texture->narrow);
    memcpy(rgba, &value, sizeof value);
}

void retex_texture_row(const RetexTexture *texture, int y, float *rgb)
{
    const RetexTextureLevel *image = &texture->levels[0];
    const size_t size = texel_size(texture->narrow);
    const char *texel = (const char *)image->texels + (size_t)y * (size_t)image->width * size;
    for (int x = 0; x < image->width; x++, texel += size, rgb += 3) {
        RetexFloat4 value = raw_texel(texel, texture->narrow) * texel_unit(texture->narrow);
        memcpy(rgb, &value, 3 * sizeof *rgb);
    }
}
