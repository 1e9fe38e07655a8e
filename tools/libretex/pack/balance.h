/* Means of light that is decoded. Private to libretex. */
#ifndef RETEX_PACK_BALANCE_H
#define RETEX_PACK_BALANCE_H

#include <retex/set.h>

#include "pack/jpeg.h"

/* The part of light that a part of a set is, or that it is a gain of; -1: neither. */
int retex_pack_light_of(const RetexSet *set, int part);

/* Multiply a curve's whites, and what was decoded by it, by what gives that the mean of the image by channel; of a
 * gain, decoded light times the decoded gain, enlarged, gets the mean of light times the image. light, decoded_light:
 * NULL = the image is light itself. *change: the most that a mean was multiplied or divided by; INFINITY = nothing was
 * left of it, and steps have to be finer. */
int retex_pack_restore_mean(RetexPackCurve *curve, RetexImage *decoded, const RetexImage *image,
                            const RetexImage *light, const RetexImage *decoded_light, double *change, RetexError *err);

#endif
