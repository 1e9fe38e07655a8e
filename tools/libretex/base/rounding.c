/* See <retex/host/rounding.h>. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include <retex/host/rounding.h>

#define COEFFICIENT_STEP (1.0 / 8192)
#define SHARE_STEP (1.0 / 512)
enum { COVERAGE_BITS = 8 }; /* significant ones: what lies below is noise, which does not compress */

/* The largest power of two that is no larger, 0 of what is below all normal numbers. */
static double power_of_two(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits &= (uint64_t)0x7ff << 52;
    memcpy(&value, &bits, sizeof value);
    return value;
}

double retex_round_unit(double step)
{
    const double unit = step > 0 ? power_of_two(step) : 0;
    return unit <= FLT_MAX ? unit : 0;
}

double retex_round_bits(double value, int bits)
{
    return retex_round_by(value, retex_round_unit(fabs(value)) / (double)((uint64_t)1 << (bits - 1)));
}

double retex_coefficient_unit(double white)
{
    /* sums that miss a power of two by their last bits make it */
    return retex_round_unit(COEFFICIENT_STEP * (float)white);
}

float retex_round_share(double share)
{
    return fmaxf((float)retex_round_to(share, SHARE_STEP), RETEX_LEAST_SHARE);
}

float retex_round_coverage(double coverage)
{
    return (float)retex_round_bits(coverage, COVERAGE_BITS);
}
