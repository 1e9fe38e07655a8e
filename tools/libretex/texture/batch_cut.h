/* A part of batch_body.h: Gaussians end where the surface does. What its texels weigh is cut there, of a texel
 * that lies on the end as much as its share beyond, as in filter_kernel.c. */

/* How far the surface goes below and above a mean along an axis of the image, in the level's texels. */
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

/* Ends by lines and texels of a line; length and width are how far the windows go. */
RETEX_CPU_INLINE void NAME(place_ends)(const Ends *ends, Mask turned, Lanes length, Lanes width, Places *p, int i)
{
    Lanes low[2] = {SELECT(turned, ends[0].low, ends[1].low), SELECT(turned, ends[1].low, ends[0].low)};
    Lanes high[2] = {SELECT(turned, ends[0].high, ends[1].high), SELECT(turned, ends[1].high, ends[0].high)};
    Mask within = (low[0] < -length) & (high[0] > length) & (low[1] < -width) & (high[1] > width);
    for (int k = 0; k < 2; k++) { /* what is not cut must not depend on what lies beside it in a group */
        STORE(p->low[k] + i, SELECT(within, NAME(all)(-INFINITY), low[k]));
        STORE(p->high[k] + i, SELECT(within, NAME(all)(INFINITY), high[k]));
    }
    STORE(p->cut + i, ~within);
}

/* The share of a texel, or of a line of them, that lies on the surface; exactly 1 far from its ends. */
RETEX_CPU_INLINE Lanes NAME(share_within)(Lanes at, Lanes low, Lanes high)
{
    const Lanes none = NAME(all)(0), one = NAME(all)(1);
    Lanes above = MAX(MIN(at - low + 0.5f, one), none), below = MAX(MIN(high - at + 0.5f, one), none);
    return MAX(above + below - 1, none);
}
