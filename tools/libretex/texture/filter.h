/* Many footprints of one texture at once. Private to libretex. */
#ifndef RETEX_TEXTURE_FILTER_H
#define RETEX_TEXTURE_FILTER_H

#include <retex/texture.h>

typedef enum RetexTextureFilter {
    RETEX_TEXTURE_DISC,
    RETEX_TEXTURE_GAUSSIAN, /* widened where it is more than eight times as long as wide */
    RETEX_TEXTURE_BROAD     /* coarser, and widened from twice on: for footprints that few paths determine */
} RetexTextureFilter;

/* n footprints as sets hold them, filtered as retex_texture_disc or retex_texture_gaussian would, some ten times as
 * fast. Colours differ from theirs by no more than can be seen; they do not depend on what is filtered beside them, nor
 * on the machine. Where coverage is not above 0 the result is 0 and costs next to nothing. Thread-safe. */
void retex_texture_filter(const RetexTexture *texture, RetexTextureFilter shape,
                          const float *uv /* n x 3: u, v, coverage */,
                          const float *spread /* n x spreads: standard deviations along u and v, their correlation */,
                          int spreads /* 2: the correlation is 0; 3 */, size_t n,
                          float *colors /* n x channels */, int channels /* 4: unassociated alpha; 3: without it */);

#endif
