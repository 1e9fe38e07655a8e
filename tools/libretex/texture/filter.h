/* Many footprints of one texture at once. Private to libretex. */
#ifndef RETEX_TEXTURE_FILTER_H
#define RETEX_TEXTURE_FILTER_H

#include <retex/texture.h>

typedef enum RetexTextureFilter {
    RETEX_TEXTURE_DISC,
    RETEX_TEXTURE_GAUSSIAN,      /* widened where it is more than eight times as long as wide */
    RETEX_TEXTURE_BROAD,         /* coarser, and widened from twice on: for footprints that few paths determine */
    RETEX_TEXTURE_PARALLELOGRAM, /* of four spreads, which are its axes. It plus 1 to 4: its quadrant of that number,
                                    as of RetexFootprint */
    RETEX_TEXTURE_FILTERS = RETEX_TEXTURE_PARALLELOGRAM + 5
} RetexTextureFilter;

/* A parallelogram: its middle, and its sides as steps in u and v, u of the first one first. */
typedef struct RetexParallelogram {
    float uv[2], sides[4];
} RetexParallelogram;

/* That of a shape from PARALLELOGRAM on, of a pixel's UV and axes. */
static inline RetexParallelogram retex_parallelogram(RetexTextureFilter shape, const float *uv, const float *axes)
{
    const int quadrant = (int)shape - RETEX_TEXTURE_PARALLELOGRAM - 1;
    RetexParallelogram p = {{uv[0], uv[1]}, {axes[0], axes[1], axes[2], axes[3]}};
    const float right = quadrant & 1 ? 0.25f : -0.25f, down = quadrant & 2 ? 0.25f : -0.25f;
    for (int i = 0; i < 2 && quadrant >= 0; i++)
        p.uv[i] += right * axes[i] + down * axes[2 + i];
    for (int i = 0; i < 4 && quadrant >= 0; i++)
        p.sides[i] *= 0.5f;
    return p;
}

/* n footprints as sets hold them: the texture averaged over each. A Gaussian has the mean and the covariance of the
 * footprint; a disc is the ellipse of these whose half axes are two standard deviations. Colours count by alpha. They
 * do not depend on what is filtered beside them, nor on the machine. Where coverage is not above 0 the result is 0 and
 * costs next to nothing. Thread-safe. */
void retex_texture_filter(const RetexTexture *texture, RetexTextureFilter shape,
                          const float *uv /* n x 3: u, v, coverage */,
                          const float *spread /* n x spreads: standard deviations along u and v, their correlation; or
                                                 axes */
                          ,
                          int spreads /* 2: the correlation is 0; 3; 4: axes */, size_t n,
                          float *colors /* n x channels */, int channels /* 4: unassociated alpha; 3: without it */);

#endif
