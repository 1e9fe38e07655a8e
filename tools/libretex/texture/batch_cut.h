/* A part of batch_body.h: Gaussians are cut off where the surface ends. A texel on the limit keeps the share of its
 * weight that is inside. */

/* The distance from a mean to the limits of the surface along an axis of the image, in texels of the level. */
typedef struct Ends {
    Lanes low, high;
} Ends;

RETEX_CPU_INLINE Ends NAME(find_ends)(const RetexBatchTexture *t, int axis, Lanes u, Lanes v, Mask level)
{
    const RetexBatchLimit *limit = &t->limits[axis];
    if (limit->along < 0)
        return (Ends){NAME(all)(-INFINITY), NAME(all)(INFINITY)};
    Lanes at = limit->along ? v : u, scale = limit->scale * OF_LEVEL(t->texels[axis], level);
    Lanes a = (limit->low - at) * scale, b = (limit->high - at) * scale;
    return (Ends){MIN(a, b), MAX(a, b)};
}

/* Converts the limits to lines and texels of a line; length and width are the half sizes of the window. Returns which
 * footprints are cut: none where all is beyond a limit, for then the limits are ignored. */
RETEX_CPU_INLINE Mask NAME(place_ends)(const Ends *ends, Mask turned, Lanes length, Lanes width, Places *p, int i)
{
    Lanes low[2] = {SELECT(turned, ends[0].low, ends[1].low), SELECT(turned, ends[1].low, ends[0].low)};
    Lanes high[2] = {SELECT(turned, ends[0].high, ends[1].high), SELECT(turned, ends[1].high, ends[0].high)};
    const Lanes half = NAME(all)(0.5f); /* of the outermost texels */
    Mask inside =
        (low[0] < -length - half) & (high[0] > length + half) & (low[1] < -width - half) & (high[1] > width + half);
    Mask outside = (low[0] > length + 1) | (high[0] < -1 - length) | (low[1] > width + 1) | (high[1] < -1 - width);
    for (int k = 0; k < 2; k++) {
        STORE(p->low[k] + i, SELECT(outside, NAME(all)(-INFINITY), low[k]));
        STORE(p->high[k] + i, SELECT(outside, NAME(all)(INFINITY), high[k]));
    }
    return ~(inside | outside);
}

/* The share of a texel, or of a line of texels, that is on the surface; exactly 1 far from the limits. */
RETEX_CPU_INLINE Lanes NAME(share_within)(Lanes at, Lanes low, Lanes high)
{
    const Lanes none = NAME(all)(0), one = NAME(all)(1);
    Lanes above = MAX(MIN(at - low + 0.5f, one), none), below = MAX(MIN(high - at + 0.5f, one), none);
    return MAX(above + below - 1, none);
}
