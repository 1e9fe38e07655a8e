/* Where a model's surfaces are: rays against all of its triangles, in the space of the scene that is written but for
 * its scale: y up, z away from the viewer. Knows nothing of Assimp. */
#ifndef RETEX_IMPORT_SPACE_H
#define RETEX_IMPORT_SPACE_H

#include <stddef.h>
#include <stdint.h>

#include <retex/error.h>

/* Triangles as they are collected. Fronts are where corners go clockwise, as POV-Ray's left-handed space has it. */
typedef struct SpaceTriangles {
    float (*vertices)[3];
    uint32_t (*corners)[3];
    uint32_t *tags; /* of each triangle: what the caller knows it by */
    size_t nvertices, ntriangles;
} SpaceTriangles;

typedef struct SpaceHit {
    double t;                   /* distance in lengths of the direction */
    double point[3], normal[3]; /* of unit length, towards the front */
    uint32_t triangle, tag;
    int is_front;
} SpaceHit;

typedef struct Space Space;

/* Takes the arrays, which malloc has made, whether it succeeds or not. Fails with RETEX_ELIMIT where space_load is more
 * than SPACE_MOST_LOAD. */
int space_create(Space **space, SpaceTriangles *triangles, RetexError *err);
void space_free(Space *space);
/* How many triangles a ray through a box has to be tried with, in the mean: the sum of the surfaces of their bounds, as
 * far as they are within the box, by that of the box. So many bounds does a random line through a convex body meet; it
 * grows with all that lies at one place, whatever its corners are. Models of rooms and things have less than 50. Beyond
 * the most, some million rays would take minutes, and nothing is asked of a model. */
#define SPACE_MOST_LOAD 500.0
double space_load(const SpaceTriangles *triangles, const double low[3], const double high[3]);
void space_bounds(const Space *space, double low[3], double high[3]);
/* The bounds of what is looked at from outside: without the ground around what stands on it, if that is several times
 * as wide. */
void space_standing_bounds(const Space *space, double low[3], double high[3]);
const SpaceTriangles *space_triangles(const Space *space);
/* The nearest hit with tmin < t < tmax. Returns 0 if there is none. */
int space_ray(const Space *space, const double from[3], const double direction[3], double tmin, double tmax,
              SpaceHit *hit);
/* The nearest hit whose tag is not to be passed through: passes[tag], or NULL. */
int space_ray_through(const Space *space, const double from[3], const double direction[3], const unsigned char *passes,
                      SpaceHit *hit);

#endif
