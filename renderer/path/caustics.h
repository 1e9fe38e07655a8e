/* A guide to caustics: where lights shine on surfaces through glass or by mirrors, and from which directions. Photons
 * are traced before the picture; a path that scatters widely may then sample the directions that photons came from.
 * The guide only samples directions, so that the picture's mean does not depend on it (as in Vorba et al., 'On-line
 * Learning of Parametric Mixture Models for Light Transport Simulation', 2014, with photons from emitters alone).
 *
 * Cells are the leaves of a kd-tree over the points where photons landed. Each has lobes round points of the
 * refracting or mirroring surface that photons came from. Lobes are kept as points, not as directions, so that they
 * have parallax; and the points move with the vertex, as the spot of light moves on a lens or mirror. The closer
 * a vertex is to where a lobe's photons landed, the more the lobe weighs. Its density is
 * (1 + 2 k) / (4 pi (1 + k (1 - cos))^2): the tails are long, and it is drawn from in closed form. */
#ifndef RENDERER_PATH_CAUSTICS_H
#define RENDERER_PATH_CAUSTICS_H

#include <stdint.h>
#include "accel/accel.h"
#include "light/lights.h"

#define CAUSTICS_LOBES 16

typedef struct Caustics Caustics;

typedef enum CausticsOf { CAUSTICS_OF_SOURCES, CAUSTICS_OF_EMITTERS, CAUSTICS_OF_SMALL_EMITTERS } CausticsOf;

typedef struct CausticsCell {
    float x[CAUSTICS_LOBES], y[CAUSTICS_LOBES], z[CAUSTICS_LOBES]; /* where photons came from, in world space */
    float move[9][CAUSTICS_LOBES];       /* how that point moves with the vertex, row by row */
    float concentration[CAUSTICS_LOBES]; /* k */
    float at_x[CAUSTICS_LOBES], at_y[CAUSTICS_LOBES], at_z[CAUSTICS_LOBES]; /* where they landed */
    float narrow[CAUSTICS_LOBES]; /* 1 / squared distance over which its weight fades */
    float weight[CAUSTICS_LOBES]; /* its weight there; 0 for unused lobes */
    int nlobes;
    float share; /* probability of sampling by the guide, 0..0.5 */
} CausticsCell;

/* Photons start from light sources that have caustics and, unless `of` is CAUSTICS_OF_SOURCES, from shapes that emit;
 * with CAUSTICS_OF_SMALL_EMITTERS the guide is given up where it is not worth its time. paths: the number of paths of
 * the picture, of whose time photons take a small share. *caustics is NULL where there are no caustics, and after a
 * failure, such as that the budget (NULL = none) stops it. The result is the same for every nthreads. */
int caustics_create(Caustics **caustics, const Scene *scene, const Accel *accel, const Lights *lights, CausticsOf of,
                    long paths, int nthreads, const RetexBudget *budget, RetexError *err);
void caustics_close(Caustics **caustics);
/* The cell of a point, or NULL where no photons landed. */
const CausticsCell *caustics_find(const Caustics *caustics, Vec3 position);

/* caustics_kernel.c: a direction by u_lobe (which lobe), u1 and u2, unit length; and the density with which it is
 * found, per solid angle. */
Vec3 caustics_sample(const CausticsCell *cell, Vec3 position, float u_lobe, float u1, float u2);
float caustics_density(const CausticsCell *cell, Vec3 position, Vec3 direction);

#endif
