/* See restore.h. Most planes are of codes that nothing predicts: those only have to be spread over the pixels
 * where they matter, run by run. Of the others the prediction is chosen once a plane. */
#include "pack/restore.h"

#include <string.h>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

typedef unsigned char Bytes16 __attribute__((vector_size(16)));

void retex_pack_find_present(unsigned char *restrict present, const unsigned char *restrict codes, size_t count)
{
    size_t i = 0;
    for (Bytes16 some; i + 16 <= count; i += 16) {
        memcpy(&some, codes + i, sizeof some);
        some = (Bytes16)(some != 0) & 1;
        memcpy(present + i, &some, sizeof some);
    }
    for (; i < count; i++)
        present[i] = codes[i] != 0;
}

void retex_pack_find_runs(RetexPackRuns *runs, const unsigned char *present, int width, int rows)
{
    int count = 0;
    runs->pixels = 0;
    runs->first[0] = 0;
    for (int y = 0; y < rows; y++, present += width) {
        for (int end = 0; end < width;) {
            const unsigned char *begin = memchr(present + end, 1, (size_t)(width - end));
            if (!begin)
                break;
            const unsigned char *after = memchr(begin, 0, (size_t)(width - (begin - present)));
            end = after ? (int)(after - present) : width;
            runs->run[count++] = (RetexRowSpan){(int)(begin - present), end};
            runs->pixels += (size_t)(end - runs->run[count - 1].begin);
        }
        runs->first[y + 1] = count;
    }
}

static inline uint32_t load(const unsigned char *from, int bytes)
{
    return bytes == 1   ? from[0]
           : bytes == 2 ? from[0] | (uint32_t)from[1] << 8
                        : from[0] | (uint32_t)from[1] << 8 | (uint32_t)from[2] << 16 | (uint32_t)from[3] << 24;
}

void retex_pack_restore_reference(const RetexPackPlane *plane, RetexPackPredictor predictor, const unsigned char *from,
                                  int bytes)
{
    int32_t last = 0;
    for (int y = 0; y < plane->rows; y++)
        for (int x = 0; x < plane->width; x++) {
            const size_t row = (size_t)y * (size_t)plane->width;
            int32_t *number = &plane->numbers[row + (size_t)x];
            if (plane->present && !plane->present[row + (size_t)x])
                continue;
            const int shift = plane->shift ? plane->shift[row + (size_t)x] : 0;
            const int32_t guess = in_steps(predict_at(plane, predictor, row, x, last), shift);
            const int32_t sum = add(guess, zigzag_decode(load(from, bytes)));
            *number = last = wrap((int32_t)((uint32_t)sum << shift), plane->bits);
            from += bytes;
        }
}

#define NUMBER int32_t
#define NAME(x) x##_wide
#include "pack/restore_body.h"
#undef NUMBER
#undef NAME

#define NUMBER unsigned char
#define NAME(x) x##_codes
#include "pack/restore_body.h"
#undef NUMBER
#undef NAME

/* ---- nothing predicts them ---- */

static inline void spread_wide(int32_t *numbers, size_t count, const unsigned char *from, int bytes, int bits)
{
    size_t i = 0;
#ifdef __SSE2__
    for (; bytes == 1 && i + 8 <= count; i += 8) {
        const __m128i zero = _mm_setzero_si128(), one = _mm_set1_epi16(1);
        const __m128i code = _mm_unpacklo_epi8(_mm_loadl_epi64((const __m128i *)(const void *)(from + i)), zero);
        const __m128i sign = _mm_sub_epi16(zero, _mm_and_si128(code, one));
        const __m128i number = _mm_xor_si128(_mm_srli_epi16(code, 1), sign), high = _mm_srai_epi16(number, 15);
        _mm_storeu_si128((__m128i *)(void *)(numbers + i), _mm_unpacklo_epi16(number, high));
        _mm_storeu_si128((__m128i *)(void *)(numbers + i + 4), _mm_unpackhi_epi16(number, high));
    }
#endif
    for (; i < count; i++)
        numbers[i] = wrap(zigzag_decode(load(from + i * (size_t)bytes, bytes)), bits);
}

static inline void spread_codes(unsigned char *codes, size_t count, const unsigned char *from)
{
    size_t i = 0;
    for (Bytes16 some; i + 16 <= count; i += 16) {
        memcpy(&some, from + i, sizeof some);
        some = some >> 1 ^ -(some & 1);
        memcpy(codes + i, &some, sizeof some);
    }
    for (; i < count; i++)
        codes[i] = (unsigned char)zigzag_decode(from[i]);
}

/* Of all that matters, the one or the other. */
static void spread(const RetexPackPlane *plane, const unsigned char *from, int bytes)
{
    const size_t width = (size_t)plane->width;
    const RetexRowSpan whole = {0, plane->width};
    for (size_t y = 0; y < (size_t)plane->rows; y++) {
        const int first = plane->present ? plane->runs->first[y] : 0;
        const int end = plane->present ? plane->runs->first[y + 1] : 1;
        for (int k = first; k < end; k++) {
            const RetexRowSpan run = plane->present ? plane->runs->run[k] : whole;
            const size_t at = y * width + (size_t)run.begin, count = (size_t)(run.end - run.begin);
            if (plane->bits == 8)
                spread_codes(plane->codes + at, count, from);
            else
                spread_wide(plane->numbers + at, count, from, bytes, plane->bits);
            from += count * (size_t)bytes;
        }
    }
}

/* ---- any plane ---- */

void retex_pack_restore(const RetexPackPlane *plane, RetexPackPredictor predictor, const unsigned char *residuals,
                        int bytes)
{
    const int bits = plane->bits;
    if (predictor == BY_NOTHING && !plane->shift)
        spread(plane, residuals, bytes);
    else if (bits == 8 && plane->present)
        restore_runs_codes(plane, plane->codes, predictor, NULL, residuals, 1, 8);
    else if (bits == 8)
        restore_all_codes(plane, plane->codes, predictor, residuals, 1, 8);
    else if (plane->present && plane->shift && bits == 32 && bytes == 4)
        restore_runs_wide(plane, plane->numbers, predictor, plane->shift, residuals, 4, 32);
    else if (plane->present)
        restore_runs_wide(plane, plane->numbers, predictor, plane->shift, residuals, bytes, bits);
    else if (plane->shift)
        retex_pack_restore_reference(plane, predictor, residuals, bytes);
    else if (bytes == 1)
        restore_all_wide(plane, plane->numbers, predictor, residuals, 1, bits);
    else if (bytes == 2)
        restore_all_wide(plane, plane->numbers, predictor, residuals, 2, bits);
    else
        restore_all_wide(plane, plane->numbers, predictor, residuals, 4, bits);
}
