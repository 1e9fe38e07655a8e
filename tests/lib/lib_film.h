/* Light paths made by hand, through a film into a set of layout footprints. */
#ifndef LIB_FILM_H
#define LIB_FILM_H

#include "film/film.h"
#include "shade/bsdf.h"
#include "lib_test.h"

#define SHARP 1
#define BROAD 0

static const double FINEST = 1.0 / (1 << 19); /* half of the finest step of mean UVs */

/* A film of two pixels side by side, of which most tests fill the left one. */
typedef struct Fixture {
    Scene scene;
    FilmParams params;
    Film *film;
    FilmPixel *pixel;
    RetexSet *set;
    PathHits hits; /* of the path in hand: a chain */
    PathHit room[PATH_HITS_MAX];
    Split split; /* of its last hit */
    Rgb value;   /* that the path carries with the original albedos */
    Rgb light;   /* that was connected */
} Fixture;

void begin_film(Fixture *f, int ntargets, int spp, int orders, int sharp, int broad);
void create_film(Fixture *f);
void begin_path(Fixture *f);
void end_path(Fixture *f);
void split_hit(Fixture *f, int target, double u, double v, Rgb albedo, int sharp, Split split);

/* One more hit, all of whose light the albedo multiplies. */
void hit(Fixture *f, int target, double u, double v, Rgb albedo, int sharp);

/* Light behind the path's hits so far. */
void connect_light(Fixture *f, Rgb light);

/* A path of one hit that connects once. */
void one_hit(Fixture *f, double u, double v, Rgb albedo, int sharp, Rgb light);
void make_set(Fixture *f);
void finish_film(Fixture *f);
void end_film(Fixture *f);

/* Values of a part in the left pixel. */
const float *part(const Fixture *f, const char *name);
const RetexFootprint *footprint(const Fixture *f, const char *uv);
void expect_rgb(const float *got, float r, float g, float b, double tolerance);

/* What no pixel has is left out of the set. */
void assert_absent(const Fixture *f, const char *name);

/* The polynomial with the footprints' own albedos, and with white textures: the largest channel, which is what
 * coefficients are rounded by. Every coefficient may be off by half a step. */
double expect_beauty(const Fixture *f, size_t pixel);

/* Of either kind a pixel may have all clusters; params.clusters is how many of both together. */
void begin_shared(Fixture *f, int ntargets, int spp, int orders, int clusters);

/* How many clusters of a kind the left pixel has: the first slots, and none behind them. */
int count_clusters(const Fixture *f, const char *kind);
void expect_place(const Fixture *f, const char *name, double u, double sd);

#endif
