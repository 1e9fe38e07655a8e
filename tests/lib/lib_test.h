/* What the unit tests share: cmocka with what it needs, repeatable random numbers, random pictures and sets. */
#ifndef LIB_TEST_H
#define LIB_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <retex/retex.h>

/* The next of a repeatable sequence; *state is its seed. Uniform in [0,1). */
double test_random(uint32_t *state);

/* Allocate a picture of values uniform in [low, high). */
void test_random_image(RetexImage *im, int width, int height, int channels, uint32_t seed, double low, double high);

/* Covariance {uu, uv, vv} of a footprint with those standard deviations, its longer axis turned by angle (radians). */
void test_turned_covariance(double covariance[3], double longer, double shorter, double angle);

/* A set of layout paper as a render would leave it, small but with everything in it: two targets ('Floor', a periodic
 * 'Wall'), three hits each, all kinds of terms, an AOV; radiance of five decades with black parts, UV gradients, no
 * coverage along one side. The same seed gives the same set. */
RetexSet *test_set(int width, int height, uint32_t seed);

/* Give it what layout footprints has and paper has not: all kinds of footprints, three of four with a spread that has a
 * correlation, sizes of a unit of UV, and mixtures. */
void test_make_footprints(RetexSet *set);

/* Give it what denoising reads, as <retex/denoise.h> lists it: noise, and guides of two surfaces side by side. */
void test_add_denoise_data(RetexSet *set);

/* Fails the process with a message, for helpers outside of a test. */
void test_must(int code, const RetexError *err);

#endif
