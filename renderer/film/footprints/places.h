/* What a texture would change if pairs of places were one each: see clusters.c. */
#ifndef RENDERER_FILM_FOOTPRINTS_PLACES_H
#define RENDERER_FILM_FOOTPRINTS_PLACES_H

#define PLACE_LANES 8

/* Of several pairs, one member each. */
typedef struct PlaceLanes {
    double weight[PLACE_LANES], mean[2][PLACE_LANES];
    double m2[3][PLACE_LANES], covariance[3][PLACE_LANES]; /* as of RetexUvStats; the same divided by the weight */
    double variance[PLACE_LANES];                          /* of its light, with such a texture */
} PlaceLanes;

typedef struct PlacePairs {
    PlaceLanes a, b;
    double error2[PLACE_LANES]; /* by how much light is expected to change, squared */
} PlacePairs;

/* The determinant of the covariance of places, which are seen as normal distributions, and of a texture with features
 * of size f, squared. What would be below 0, on a line far away, is nothing but rounding. */
static inline double places_determinant(double uu, double uv, double vv, double f)
{
    const double own = uu * vv - uv * uv;
    return f * f + f * (uu + vv) + (own > 0 ? own : 0);
}

/* Find error2 in all lanes, of a texture with features of this size. */
void place_pairs_errors(PlacePairs *pairs, double feature, const int periodic[2]);

#endif
