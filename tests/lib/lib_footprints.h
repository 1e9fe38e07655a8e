/* Small sets of layout footprints, filled by hand, for tests of denoising their footprints. */
#ifndef LIB_FOOTPRINTS_H
#define LIB_FOOTPRINTS_H

#include "denoise/footprints.h"
#include "lib_test.h"

enum { WIDTH = 8, HEIGHT = 4 };

/* A set, and all its rows denoised. Values that have not been written are -7. */
typedef struct Work {
    RetexDenoiser d;
    RetexDenoiseFootprints *footprints;
    RetexDenoisedRows out;
    unsigned char *written;
} Work;

/* ---- sets ---- */

/* A part of the set's size, named by its kind and a number. */
int add_part(RetexSet *set, const char *letters, const char *what, int number);
int add_footprint(RetexSet *set, int target, RetexFootprintKind kind, int hit, const char *spread);
/* Its factors: `first` once, the second one for all others. */
int add_term(RetexSet *set, int nfactors, int first, int others);
/* A mixture of this number of footprints from `first` on. Their weights are new parts. */
int add_mixture(RetexSet *set, int first, int count, const char *letters);
/* A set with targets, a beauty, and the term without factors. */
RetexSet *start_set(int width, int height, int ntargets);
/* A set of one target with this number of clusters: footprints 0..count-1, terms 1..count. */
RetexSet *cluster_set(RetexFootprintKind kind, int count);
/* The same with light of two further hits on the target: the last term, with two footprints of interreflection. Its
 * mixtures are that of the clusters and that of these two. */
RetexSet *again_set(RetexFootprintKind kind, int count);

/* Places in it. */
float *pixel(const RetexSet *set, int part, int x, int y);
int share_part(const RetexSet *set, int footprint);
void put(RetexSet *set, int footprint, int x, int y, float u, float v, float coverage);
void put_spread(RetexSet *set, int footprint, int x, int y, float su, float sv, float correlation);
void put_rgb(RetexSet *set, int part, int x, int y, float r, float g, float b);
int light_part(const RetexSet *set, int cluster);
void put_light(RetexSet *set, int cluster, int x, int y, float light);
void put_share(RetexSet *set, int footprint, int x, int y, float share);
void put_again(RetexSet *set, int x, int y, float light);

/* ---- calls ---- */

/* Gives the set denoising data, and removes it. */
Work open_work(RetexSet *set, int footprints);
void close_work(Work *w);
const RetexSignal *find_signal(const Work *w, int target, RetexFootprintKind kind);
/* Calls for pixel (1,1), whose neighbours to the right have these weights. */
void share_light(Work *w, RetexFootprintKind kind, const float *weights, int count, const float light[3]);
void share_later(Work *w, const float *weights, int count);
/* Values of that pixel. */
const float *result(const Work *w, int part);
const float *result_uv(const Work *w, int footprint);
const float *result_spread(const Work *w, int footprint);
const float *result_albedo(const Work *w, int footprint);
void expect_values(const float *is, int count, const float *should, float tolerance);
/* Footprint and share of a pixel are those of another pixel of the set. */
void expect_copied(const Work *w, int footprint, int x, int y);
#define EXPECT(tolerance, is, ...)                                                                                     \
    do {                                                                                                               \
        const float should[] = {__VA_ARGS__};                                                                          \
        expect_values(is, sizeof should / sizeof *should, should, tolerance);                                          \
    } while (0)

#endif
