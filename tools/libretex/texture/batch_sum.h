/* A part of batch_body.h: the sums of texels times weights, when the weights of a strip are known. */

/* Transposes a block's weights, so that those of each footprint are together. */
RETEX_CPU_INLINE void NAME(turn_weights)(const Strip *strip, int block, float out[LANES][MAX_BLOCKS][16])
{
    const Lanes *w[4];
    for (int j = 0; j < 4; j++)
        w[j] = &strip->weights[j][4 * block];
#if LANES == 16
    __m512 a[16], b[16];
    for (int i = 0; i < 16; i += 4) {
        const __m512 *r = (const __m512 *)w[i / 4];
        a[i] = _mm512_unpacklo_ps(r[0], r[1]);
        a[i + 1] = _mm512_unpackhi_ps(r[0], r[1]);
        a[i + 2] = _mm512_unpacklo_ps(r[2], r[3]);
        a[i + 3] = _mm512_unpackhi_ps(r[2], r[3]);
    }
    for (int i = 0; i < 16; i += 4) { /* b[i + k]: columns of line i / 4, of lanes k, k + 4, k + 8, k + 12 */
        b[i] = (__m512)_mm512_unpacklo_pd((__m512d)a[i], (__m512d)a[i + 2]);
        b[i + 1] = (__m512)_mm512_unpackhi_pd((__m512d)a[i], (__m512d)a[i + 2]);
        b[i + 2] = (__m512)_mm512_unpacklo_pd((__m512d)a[i + 1], (__m512d)a[i + 3]);
        b[i + 3] = (__m512)_mm512_unpackhi_pd((__m512d)a[i + 1], (__m512d)a[i + 3]);
    }
    for (int k = 0; k < 4; k++) {
        __m512 p = _mm512_shuffle_f32x4(b[k], b[k + 4], 0x88), q = _mm512_shuffle_f32x4(b[k], b[k + 4], 0xdd);
        __m512 r = _mm512_shuffle_f32x4(b[k + 8], b[k + 12], 0x88), s = _mm512_shuffle_f32x4(b[k + 8], b[k + 12], 0xdd);
        _mm512_storeu_ps(out[k][block], _mm512_shuffle_f32x4(p, r, 0x88));
        _mm512_storeu_ps(out[k + 8][block], _mm512_shuffle_f32x4(p, r, 0xdd));
        _mm512_storeu_ps(out[k + 4][block], _mm512_shuffle_f32x4(q, s, 0x88));
        _mm512_storeu_ps(out[k + 12][block], _mm512_shuffle_f32x4(q, s, 0xdd));
    }
#elif LANES == 8
    for (int j = 0; j < 4; j++) {
        const __m256 *r = (const __m256 *)w[j];
        __m256 a = _mm256_unpacklo_ps(r[0], r[1]), b = _mm256_unpackhi_ps(r[0], r[1]);
        __m256 c = _mm256_unpacklo_ps(r[2], r[3]), d = _mm256_unpackhi_ps(r[2], r[3]);
        __m256 lanes[4] = {
            (__m256)_mm256_unpacklo_pd((__m256d)a, (__m256d)c), (__m256)_mm256_unpackhi_pd((__m256d)a, (__m256d)c),
            (__m256)_mm256_unpacklo_pd((__m256d)b, (__m256d)d), (__m256)_mm256_unpackhi_pd((__m256d)b, (__m256d)d)};
        for (int k = 0; k < 4; k++) {
            _mm_storeu_ps(out[k][block] + 4 * j, _mm256_castps256_ps128(lanes[k]));
            _mm_storeu_ps(out[k + 4][block] + 4 * j, _mm256_extractf128_ps(lanes[k], 1));
        }
    }
#else
    for (int lane = 0; lane < LANES; lane++)
        for (int j = 0; j < 4; j++)
            for (int c = 0; c < 4; c++)
                out[lane][block][4 * j + c] = w[j][c][lane];
#endif
}

/* Adds a strip's texels to four sums, one for every fourth column. Weights are by lines, which may be columns. Blocks
 * are `step` texels apart. */
RETEX_CPU_INLINE void NAME(sum_texels)(float sums[16], const float weights[][16], int blocks, int turned, int narrow,
                                       const char *texels, size_t stride, size_t step)
{
    size_t size = narrow ? 4 * sizeof(uint16_t) : 4 * sizeof(float);
#if LANES == 16
    const __m512i *rows = (const __m512i *)batch_rows[turned];
    __m512 sum = _mm512_loadu_ps(sums);
    for (int k = 0; k < blocks; k++) {
        __m512 w = _mm512_loadu_ps(weights[k]);
        const char *from = texels + (size_t)k * step * size;
        for (int r = 0; r < 4; r++, from += stride * size) {
            __m512 t = narrow ? _mm512_cvtepi32_ps(_mm512_cvtepu16_epi32(_mm256_loadu_si256((const __m256i *)from)))
                              : _mm512_loadu_ps((const float *)(const void *)from);
            sum = _mm512_add_ps(sum, _mm512_mul_ps(t, _mm512_permutexvar_ps(_mm512_loadu_si512(rows + r), w)));
        }
    }
    _mm512_storeu_ps(sums, sum);
#elif LANES == 8
    int row = turned ? 1 : 4, column = turned ? 4 : 1;
    __m256 low = _mm256_loadu_ps(sums), high = _mm256_loadu_ps(sums + 8);
    for (int k = 0; k < blocks; k++) {
        const char *from = texels + (size_t)k * step * size;
        const float *w = weights[k];
        for (int r = 0; r < 4; r++, from += stride * size, w += row) {
            __m256 a, b;
            if (narrow) {
                __m128i c = _mm_loadu_si128((const __m128i *)from), d = _mm_loadu_si128((const __m128i *)from + 1);
                a = _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(c));
                b = _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(d));
            } else {
                a = _mm256_loadu_ps((const float *)(const void *)from);
                b = _mm256_loadu_ps((const float *)(const void *)from + 8);
            }
            __m256 first = _mm256_insertf128_ps(_mm256_broadcast_ss(w), _mm_broadcast_ss(w + column), 1);
            __m256 second =
                _mm256_insertf128_ps(_mm256_broadcast_ss(w + 2 * column), _mm_broadcast_ss(w + 3 * column), 1);
            low = _mm256_add_ps(low, _mm256_mul_ps(a, first));
            high = _mm256_add_ps(high, _mm256_mul_ps(b, second));
        }
    }
    _mm256_storeu_ps(sums, low);
    _mm256_storeu_ps(sums + 8, high);
#else
    int row = turned ? 1 : 4, column = turned ? 4 : 1;
    RetexFloat4 sum[4];
    memcpy(sum, sums, sizeof sum);
    for (int k = 0; k < blocks; k++) {
        const char *from = texels + (size_t)k * step * size;
        for (int r = 0; r < 4; r++, from += stride * size)
            for (int c = 0; c < 4; c++)
                sum[c] += raw_texel(from + (size_t)c * size, narrow) * weights[k][row * r + column * c];
    }
    memcpy(sums, sum, sizeof sum);
#endif
}

/* The blocks of a strip: weights and places, by lane. */
#define Blocks NAME(Blocks)
typedef struct Blocks {
    float weights[LANES][MAX_BLOCKS][16];
    int first[LANES]; /* offset in the texels of the level, or of the padded copy; -1: a block is partly outside */
    int columns[LANES], rows[LANES], levels[LANES];
} Blocks;

RETEX_CPU_INLINE void NAME(find_blocks)(const Footprints *f, int number, const Strip *strip, int turned, Blocks *blocks)
{
    const RetexBatchTexture *t = f->texture;
    Mask lines = (Mask)f->line + 4 * number, texels = (Mask)f->texel + strip->column;
    Mask x = turned ? lines : texels, y = turned ? texels : lines;
    Mask padding = __builtin_convertvector(OF_LEVEL(t->padding, f->level), Mask);
    Mask width = __builtin_convertvector(OF_LEVEL(t->texels[0], f->level), Mask) + 2 * padding;
    Mask height = __builtin_convertvector(OF_LEVEL(t->texels[1], f->level), Mask) + 2 * padding;
    int across = 4 * f->blocks;
    Mask column = x + padding, row = y + padding;
    Mask inside = (column >= 0) & (row >= 0) & (column <= width - (turned ? 4 : across)) &
                  (row <= height - (turned ? across : 4));
    STORE(blocks->first, ((row & inside) * width + (column & inside)) | ~inside); /* far outside would overflow */
    STORE(blocks->columns, x);
    STORE(blocks->rows, y);
    STORE(blocks->levels, f->level);
    for (int k = 0; k < f->blocks; k++)
        NAME(turn_weights)(strip, k, blocks->weights);
}

RETEX_CPU_INLINE const char *NAME(block_texels)(const RetexTextureLevel *level, int first, int narrow)
{
    return (const char *)(level->padded ? level->padded : level->texels) + (size_t)first * (narrow ? 8 : 16);
}

RETEX_CPU_INLINE void NAME(sum_lanes)(Footprints *f, const Blocks *blocks, int turned, int narrow)
{
    for (int lane = 0; lane < f->count; lane++) {
        const RetexTextureLevel *level = &f->texture->texture->levels[blocks->levels[lane]];
        size_t stride = (size_t)(level->width + 2 * level->padding);
        const float(*own)[16] = blocks->weights[lane];
        if (blocks->first[lane] >= 0) {
            const char *texels = NAME(block_texels)(level, blocks->first[lane], narrow);
            NAME(sum_texels)(f->sums[lane], own, f->blocks, turned, narrow, texels, stride, turned ? 4 * stride : 4);
        } else {
            for (int k = 0; k < f->blocks; k++) {
                char around[16 * 4 * sizeof(float)];
                retex_texture_copy_block(f->texture->texture, level, blocks->columns[lane] + (turned ? 0 : 4 * k),
                                         blocks->rows[lane] + (turned ? 4 * k : 0), around);
                NAME(sum_texels)(f->sums[lane], own + k, 1, turned, narrow, around, 4, 0);
            }
        }
    }
}

RETEX_CPU_INLINE void NAME(sum_blocks)(Footprints *f, int number, const Strip *strip)
{
    Blocks blocks;
    int narrow = f->texture->texture->narrow;
    NAME(find_blocks)(f, number, strip, f->turned, &blocks);
    if (f->turned && narrow)
        NAME(sum_lanes)(f, &blocks, 1, 1);
    else if (f->turned)
        NAME(sum_lanes)(f, &blocks, 1, 0);
    else if (narrow)
        NAME(sum_lanes)(f, &blocks, 0, 1);
    else
        NAME(sum_lanes)(f, &blocks, 0, 0);
}

/* Starts loading blocks that are summed later. */
RETEX_CPU_INLINE void NAME(prefetch)(const Footprints *f, const Blocks *blocks, int narrow)
{
    for (int lane = 0; lane < f->count; lane++) {
        const RetexTextureLevel *level = &f->texture->texture->levels[blocks->levels[lane]];
        const size_t stride = (size_t)(level->width + 2 * level->padding) * (narrow ? 8 : 16);
        const char *texels = NAME(block_texels)(level, blocks->first[lane] < 0 ? 0 : blocks->first[lane], narrow);
        for (int row = 0; row < 4; row++)
            __builtin_prefetch(texels + (size_t)row * stride);
    }
}
