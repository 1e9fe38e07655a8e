/* What a blob is made of, as sdl/object/blob.c leaves it in Shape.data. */
#ifndef RENDERER_SHAPE_BLOB_H
#define RENDERER_SHAPE_BLOB_H

#include "base/vec.h"

/* In the component's own space it is a line from the origin to z = length, with all that is nearer to it than 1. At
 * distance d its density is strength (1 - d^2)^2. Length 0 is a sphere. */
typedef struct BlobComponent {
    Transform transform; /* to the blob's space */
    double length, strength;
    int texture; /* index into the shape's textures, or -1: the blob's own */
} BlobComponent;

typedef struct Blob {
    double threshold; /* > 0 */
    int ncomponents;
    const BlobComponent *components;
    Vec3 low, high; /* bounds of the components of positive strength */
} Blob;

#endif
