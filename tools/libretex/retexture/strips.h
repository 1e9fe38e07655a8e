/* Computes a picture from a view in strips of RETEX_PICTURE_STRIP rows, on all threads. The picture is never
 * complete in memory. Private to libretex. */
#ifndef RETEX_RETEXTURE_STRIPS_H
#define RETEX_RETEXTURE_STRIPS_H

#include "retexture/view.h"

/* Computes rows y0 <= y < y1 of the picture, RGB interleaved. `reader` belongs to this call alone. */
typedef int RetexStripMake(const void *context, RetexViewReader *reader, int y0, int y1, float *rgb, RetexError *err);

/* Compute rows y0 <= y < y1 and give them to the sink. */
int retex_view_strips(const RetexView *view, int y0, int y1, RetexStripMake *make, const void *context,
                      RetexRowSink *sink, void *sink_context, int nthreads, RetexError *err);

#endif
