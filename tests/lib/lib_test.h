/* Functions for all unit tests: cmocka and its headers, repeatable random numbers, random pictures and sets. */
#ifndef LIB_TEST_H
#define LIB_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <retex/host/aov.h>
#include <retex/host/band_stats.h>
#include <retex/host/band_store.h>
#include <retex/host/cpu.h>
#include <retex/host/denoise_data.h>
#include <retex/nearest.h>
#include <retex/host/rounding.h>
#include <retex/host/set_build.h>
#include <retex/target_name.h>
#include <retex/host/texture_lookup.h>
#include <retex/host/uv_stats.h>
#include <retex/retex.h>

#include "set/laid.h" /* tests look into sets */

/* The next number of a repeatable sequence, uniform in [0,1). *state is its seed. */
double test_random(uint32_t *state);

/* Allocate a picture of values uniform in [low, high). */
void test_random_image(RetexImage *im, int width, int height, int channels, uint32_t seed, double low, double high);

/* Covariance {uu, uv, vv} of a footprint with these standard deviations, rotated by angle (radians). */
void test_turned_covariance(double covariance[3], double longer, double shorter, double angle);

/* Tests name factors by numbers: a footprint by its index, a mixture by MIXTURE(index). */
#define MIXTURE(m) (-1 - (m)) /* and back */
RetexFactor test_factor(int number);
int test_factor_number(RetexFactor factor);
/* A term of that many hits. Its role and target are those of its first hit; INDEP without hits. */
RetexTerm test_term(const RetexSet *set, int radiance, int nhits, const int *numbers);
/* A parameter of that name: every second term of light has it as a factor. Its value as rendered is 1, 0.5, 2. */
void test_add_lamp(RetexSet *set, const char *name);
/* Divide all light among two lamps, 'Lamp', whose value as rendered is 1, 0.5, 2, and 'Window', of 1, 1, 1, and what
 * has no parameter: by where its first hit is on the target or, of mixtures, by the place in the picture. The picture
 * as rendered stays the same. */
void test_divide_light(RetexSet *set);
/* Add the light of each lamp, 'Lamp', 'Window' and 'rest', as terms of role LAMP. The second is off where `off` is 1:
 * its value is 0, and it is kept as 1. The first has light of several colours where `several` is 1. */
void test_add_lamp_terms(RetexSet *set, int off, int several);
/* Give terms with hits the roles that follow from their footprints' kinds. */
void test_renew_roles(RetexSet *set);

/* A small set of layout paper, like that of a render. It has everything: two targets ('Floor', and a periodic 'Wall'),
 * three hits each, all kinds of terms, and an AOV. Radiance covers five decades and is black in places. UVs are
 * gradients. One side has no coverage. The same seed gives the same set. */
RetexSet *test_set(int width, int height, uint32_t seed);

/* Add what only layout footprints has: all kinds of footprints, a correlation in the spread of three of four, sizes of
 * a unit of UV, and mixtures. */
void test_make_footprints(RetexSet *set);

/* Add denoising data, as <retex/host/denoise_data.h> lists it: noise, and guides of two surfaces side by side. */
void test_add_denoise_data(RetexSet *set);

/* Loads the textures of specs and lays them on a set, in a band store near a path: see retex_sample_textures. */
int test_sample_to_store(RetexSet *set, const RetexTextureSpec *specs, int nspecs, const char *near, int nthreads,
                         RetexError *err);
/* retex_combine of a set with textures laid on it, which is afterwards as it was without any. */
void test_combine(RetexImage *picture, const RetexSet *set, const RetexTextureSpec *specs, int nspecs,
                  const RetexCombineParams *params);
/* What the texture that is laid on a set shows at a footprint; NULL: there is none. */
const RetexImage *test_laid(const RetexSet *set, int footprint);

/* Ends the process with a message. For functions that run outside of a test. */
void test_must(int code, const RetexError *err);

/* The texture of --texture:opts arg. */
int test_texture_spec(RetexTextureSpec *spec, const char *opts, const char *arg, RetexError *err);

#endif
