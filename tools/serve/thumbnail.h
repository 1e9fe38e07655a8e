/* Small pictures of textures, in the colours that their files show. */
#ifndef RETEX_SERVE_THUMBNAIL_H
#define RETEX_SERVE_THUMBNAIL_H

#include <retex/shrink.h>

#include "request.h"

/* The file in memory, which the caller frees, of an image R,G,B,A as retex_image_read gives it. Each pixel is the mean
 * of the light of those that it covers; what is transparent is shown over white, as on a page. */
int thumbnail_make(const RetexImage *image, const RetexCut *place, ServeFormat format, int quality, int nthreads,
                   void **data, size_t *bytes, RetexError *err);

#endif
