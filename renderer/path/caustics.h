/* A guide to caustics: where light from shapes that emit comes to a surface through glass or by way of mirrors, and
 * from where. Photons are traced before the picture is; a path that scatters widely may then go where they came from.
 * The guide only chooses directions, so that the picture's mean does not depend on it (as in Vorba et al., 'On-line
 * Learning of Parametric Mixture Models for Light Transport Simulation', 2014, with photons from emitters alone).
 *
 * Cells are the leaves of a kd-tree over the places where photons came down. Each has lobes round the points of the
 * bending or mirroring surface that they came from, seen from the place in hand: what is near has parallax. A lobe
 * counts the more the closer the place is to where its photons came down. Its density is
 * (1 + 2 k) / (4 pi (1 + k (1 - cos))^2): the tails are long, and it is drawn from in closed form. */
#ifndef RENDERER_PATH_CAUSTICS_H
#define RENDERER_PATH_CAUSTICS_H

#include <stdint.h>
#include "accel/accel.h"
#include "light/lights.h"

#define CAUSTICS_LOBES 16

typedef struct Caustics Caustics;

typedef struct CausticsCell {
    float x[CAUSTICS_LOBES], y[CAUSTICS_LOBES], z[CAUSTICS_LOBES]; /* where light comes from, in the world */
    float concentration[CAUSTICS_LOBES];  /* k */
    float at_x[CAUSTICS_LOBES], at_y[CAUSTICS_LOBES], at_z[CAUSTICS_LOBES]; /* where it comes to */
    float narrow[CAUSTICS_LOBES];         /* 1 / squared distance over which that fades */
    float weight[CAUSTICS_LOBES];         /* there; 0 for lobes that are not there */
    int nlobes;
    float share;                          /* of the choice of a direction, 0..0.5 */
} CausticsCell;

/* paths: how many the picture will take; photons take a small share of their time. *caustics is NULL where there is
 * nothing to guide to, or the budget (NULL = none) stops it. The same for every nthreads. */
int caustics_create(Caustics **caustics, const Scene *scene, const Accel *accel, const Lights *lights, long paths,
                    int nthreads, const RetexBudget *budget, RetexError *err);
void caustics_close(Caustics **caustics);
/* The cell of a place, or NULL where no photons came down. */
const CausticsCell *caustics_find(const Caustics *caustics, Vec3 position);

/* caustics_kernel.c: a direction by u_lobe (which lobe), u1 and u2, unit length; and the density with which it is
 * found, per solid angle. */
Vec3 caustics_sample(const CausticsCell *cell, Vec3 position, float u_lobe, float u1, float u2);
float caustics_density(const CausticsCell *cell, Vec3 position, Vec3 direction);

#endif
