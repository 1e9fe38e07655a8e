/* The images of a view, as they are added: each once. Private to libretex. */
#ifndef RETEX_RETEXTURE_VIEW_IMAGES_H
#define RETEX_RETEXTURE_VIEW_IMAGES_H

#include "retexture/view.h"

/* Find or add an image, which owns `wanted.products` then, or frees them. Returns its number, or RETEX_ENOMEM. */
int retex_view_add(RetexView *view, RetexViewImage wanted);
/* Find or add an image that is so many times smaller than the picture: `image` itself, or it enlarged. Returns its
 * number, or RETEX_ENOMEM. */
int retex_view_enlarge(RetexView *view, int image, int scale);
/* Find or add images of a set's footprint with a finish, or -1; of all footprints of a mixture; and of what changes by
 * further hits. shape: an image of their size. Return their numbers, or RETEX_ENOMEM. */
int retex_view_footprint(RetexView *view, int footprint, int finish, const RetexImage *shape);
int retex_view_mixture(RetexView *view, int mixture, int finish, const RetexImage *shape);
int retex_view_further(RetexView *view, int colors, const RetexImage *shape, RetexError *err);
/* Find or add the image of a part with so many channels, 1 or 3. */
int retex_view_part(RetexView *view, int part, int channels);
/* Find or add the gates of a target, and the gate of one of its finishes. */
int retex_view_gates(RetexView *view, int target);
int retex_view_gate(RetexView *view, int target, int finish);

#endif
