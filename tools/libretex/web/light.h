/* Light, albedo and gains as JPEG of 8 bits, as browsers decode them. Private to libretex. */
#ifndef RETEX_WEB_LIGHT_H
#define RETEX_WEB_LIGHT_H

#include "pack/format.h"

enum { RETEX_WEB_ATLAS_SIDE_MAX = 4096 };

/* An image within an atlas. */
typedef struct RetexWebTile {
    int part, x, y;
    RetexPackCurve curve;
} RetexWebTile;

/* Encode a part alone. filled: 1 = pixels that are black are never looked at. *curve: what its levels stand for.
 * decoded: of light what browsers make of it, with the mean that it had; NULL = of albedo. */
int retex_web_light_encode(RetexPackJpeg *jpeg, RetexPackCurve *curve, RetexImage *decoded, const RetexPart *part,
                           const RetexPackPart *packed, int filled, RetexError *err);
/* Place images beside and below each other and encode them together; gains get the means of their light. decoded: by
 * part, of their light. RETEX_EUNSUPPORTED if they are too large. */
int retex_web_atlas_encode(RetexPackJpeg *jpeg, RetexWebTile *tiles, int count, int *width, int *height,
                           const RetexSet *set, const RetexPackPart *packed, const RetexImage *decoded, int nthreads,
                           RetexError *err);

#endif
