/* Light paths made by hand, through a film into a set of layout footprints. */
#ifndef LIB_FILM_H
#define LIB_FILM_H

#include "film/film.h"
#include "shade/bsdf.h"
#include "lib_test.h"

#define SHARP 1
#define BROAD 0

static const double FINEST = 1.0 / (1 << 19); /* half of the finest step of mean UVs */

/* A film of two pixels side by side. Most tests fill the left one. */
typedef struct Fixture {
    Scene scene;
    FilmParams params;
    Film *film;
    FilmPixel *pixel;
    RetexSet *set;
    TargetTree hits; /* of the current path: a chain */
    TargetNode room[TARGET_NODES_MAX];
    Split split; /* of its last hit */
    Rgb value;   /* throughput of the path with the original albedos */
    Rgb light;   /* contributed so far */
} Fixture;

void begin_film(Fixture *f, int ntargets, int spp, int orders, int sharp, int broad);
void create_film(Fixture *f);
void begin_path(Fixture *f);
void end_path(Fixture *f);
void split_hit(Fixture *f, int target, double u, double v, Rgb albedo, int sharp, Split split);

/* One more hit. The albedo multiplies all of its light. */
void hit(Fixture *f, int target, double u, double v, Rgb albedo, int sharp);

/* Light that the path receives after its hits so far. */
void connect_light(Fixture *f, Rgb light);

/* A path of one hit with one contribution. */
void one_hit(Fixture *f, double u, double v, Rgb albedo, int sharp, Rgb light);
void make_set(Fixture *f);
void finish_film(Fixture *f);
void end_film(Fixture *f);

/* Values of a part in the left pixel. */
const float *part(const Fixture *f, const char *name);
const RetexFootprint *footprint(const Fixture *f, const char *uv);
void expect_rgb(const float *got, float r, float g, float b, double tolerance);

/* Parts that are 0 in all pixels are not in the set. */
void assert_absent(const Fixture *f, const char *name);

/* The polynomial without corrections: with the original albedos of the footprints, and with white textures. The latter
 * is the largest channel, which sets the rounding step of coefficients. Every coefficient may have an error of half a
 * step. */
double expect_beauty(const Fixture *f, size_t pixel);

/* A pixel may have all its clusters of one kind. params.clusters is the number of both kinds together. */
void begin_shared(Fixture *f, int ntargets, int spp, int orders, int clusters);

/* The number of clusters of a kind in the left pixel. They must use the first slots, and no slot after these. */
int count_clusters(const Fixture *f, const char *kind);
void expect_place(const Fixture *f, const char *name, double u, double sd);

#endif
