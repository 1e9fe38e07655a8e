/* A render's parts as separate pictures, as programs that edit or denoise pictures take them. */
#ifndef RENDERER_RENDER_GUIDES_H
#define RENDERER_RENDER_GUIDES_H

#include <retex/set.h>

/* Make the folder, if there is none, and see whether it takes files. */
int guides_check(const char *folder, RetexError *err);
/* The k-th file that guides_write may write; 0 behind the last one. */
int guides_path(char *path, size_t size, const char *folder, int k);
/* Write the beauty and each AOV of the set as NAME.exr, with its values as halves, and as NAME.png, to look at: the
 * beauty through the display transform; albedo and irradiance sRGB-encoded, irradiance over its 99th percentile; normal
 * as n / 2 + 1/2; depth and position from their least to their largest values (nothing there: 1); uv without its whole
 * part; object in a colour of its own, nothing black; roughness and metallic as they are. */
int guides_write(const RetexSet *set, const char *folder, RetexError *err);

#endif
