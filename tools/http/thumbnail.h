/* Small pictures of textures, in the colours that their files show. */
#ifndef RETEX_HTTP_THUMBNAIL_H
#define RETEX_HTTP_THUMBNAIL_H

#include <retex/shrink.h>

/* The file in memory, which the caller frees, of an image R,G,B,A as retex_image_read gives it. Each pixel is the mean
 * of the light of those that it covers; what is transparent is shown over white, as on a page. extension: of the
 * format, as for retex_picture_open_memory. */
int thumbnail_make(const RetexImage *image, const RetexCut *place, const char *extension, int quality, int nthreads,
                   void **data, size_t *bytes, RetexError *err);

#endif
