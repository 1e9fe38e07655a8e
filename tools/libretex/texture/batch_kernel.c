/* The kernels of batch_body.h, one for each vector width. */
#include "texture/batch.h"
#include <stdint.h>
#include <string.h>

#include "texture/texture_kernel.h"

void retex_texture_copy_block(const RetexTexture *texture, const RetexTextureLevel *level, int x, int y, char *texels)
{
    for (int j = 0; j < 4; j++)
        copy_texels(texture, level, x, y + j, 4, texels + (size_t)(4 * j) * texel_size(texture->narrow));
}

/* The widest vectors that every processor has. */
#define LANES 4
#define NAME(name) name##_plain
#include "texture/batch_body.h"
#undef LANES
#undef NAME

#if RETEX_CPU_X86
#include <immintrin.h>

RETEX_CPU_BEGIN_AVX2
#define LANES 8
#define NAME(name) name##_avx2
#include "texture/batch_body.h"
#undef LANES
#undef NAME
RETEX_CPU_END

RETEX_CPU_BEGIN_AVX512
#define LANES 16
#define NAME(name) name##_avx512
#include "texture/batch_body.h"
#undef LANES
#undef NAME
RETEX_CPU_END

#endif

RetexTextureBatchKernel *const retex_texture_batch_kernels[RETEX_CPU_LEVELS] = {
    filter_batch_plain,
#if RETEX_CPU_X86
    filter_batch_avx2,
    filter_batch_avx512,
#endif
};
