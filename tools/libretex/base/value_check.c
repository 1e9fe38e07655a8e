/* See value_check.h. */
#include "base/value_check.h"

#include <math.h>
#include <string.h>

#include <retex/host/aov.h>

#include "base/half.h"

RetexAllowedValues retex_allowed_values(const char *name)
{
    const int aov = retex_aov_find(name);

    return aov >= 0 && isinf(retex_aov_info(aov)->nothing) ? RETEX_ALLOW_INFINITE : RETEX_ALLOW_FINITE;
}

static float sample_at(const void *samples, RetexPixelType type, size_t i)
{
    uint16_t half;
    float value;

    if (type == RETEX_FLOAT) {
        memcpy(&value, (const unsigned char *)samples + 4 * i, sizeof value);
        return value;
    }
    memcpy(&half, (const unsigned char *)samples + 2 * i, sizeof half);
    retex_half_to_float_scalar(&value, &half, 1);
    return value;
}

size_t retex_find_disallowed(const void *samples, RetexPixelType type, size_t count, RetexAllowedValues allowed)
{
    if (allowed == RETEX_ALLOW_ANY || !(type == RETEX_FLOAT ? retex_floats_have_nonfinite(samples, count)
                                                            : retex_halves_have_nonfinite(samples, count)))
        return count;
    for (size_t i = 0; i < count; i++) {
        const float value = sample_at(samples, type, i);
        if (isnan(value) || (allowed == RETEX_ALLOW_FINITE && !isfinite(value)))
            return i;
    }
    return count;
}

int retex_fail_disallowed(RetexError *err, const char *file, const char *part, const char *channel, int x, int y,
                          float value)
{
    return retex_fail(err, RETEX_EFORMAT, "%s%spart %s holds %s at %d,%d in channel %s: such values are refused",
                      file ? file : "", file ? ": " : "", part,
                      isnan(value) ? "NaN"
                      : value < 0  ? "-infinity"
                                   : "infinity",
                      x, y, channel);
}

int retex_check_row_values(const RetexPart *part, const float *row, int x0, int x1, int y, RetexError *err)
{
    const size_t channels = strlen(part->letters), first = (size_t)x0 * channels;
    const size_t count = x1 > x0 ? (size_t)(x1 - x0) * channels : 0;
    const size_t found = retex_find_disallowed(row + first, RETEX_FLOAT, count, retex_allowed_values(part->name));

    if (found == count)
        return 0;
    const size_t at = first + found;
    const char channel[2] = {part->letters[at % channels], 0};
    return retex_fail_disallowed(err, NULL, part->name, channel, (int)(at / channels), y, row[at]);
}
