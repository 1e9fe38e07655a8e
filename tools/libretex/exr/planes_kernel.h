/* Planes of a line, one after another, and the interleaved samples of an image. Private to libretex. */
#ifndef RETEX_EXR_PLANES_KERNEL_H
#define RETEX_EXR_PLANES_KERNEL_H

#include <stddef.h>

/* Interleave `channels` planes of `count` floats each. Planes need not be aligned; where one is NULL, its samples in
 * out stay as they are. */
void retex_planes_interleave(float *restrict out, const void *const *planes, int channels, size_t count);

#endif
