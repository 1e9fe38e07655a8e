/* What operations on images have in common. Private to libretex. */
#ifndef RETEX_BASE_IMAGE_H
#define RETEX_BASE_IMAGE_H

#include <retex/image.h>

/* Common checks of an image operation: allocate dst as width x height x channels if it is unallocated, else check that
 * it has that shape; clip *roi (NULL = all) to it into *out. */
int retex_image_prepare(RetexImage *dst, int width, int height, int channels, const RetexRoi *roi, RetexRoi *out,
                        RetexError *err);

#endif
