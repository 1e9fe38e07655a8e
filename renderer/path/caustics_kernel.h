/* A cell of the guide to caustics (caustics.h), and the directions that it has. */
#ifndef RENDERER_PATH_CAUSTICS_KERNEL_H
#define RENDERER_PATH_CAUSTICS_KERNEL_H

#include "base/vec.h"

#define CAUSTICS_LOBES 16

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

/* A direction by u_lobe (which lobe), u1 and u2, unit length; and the density with which it is
 * found, per solid angle. */
Vec3 caustics_sample(const CausticsCell *cell, Vec3 position, float u_lobe, float u1, float u2);
float caustics_density(const CausticsCell *cell, Vec3 position, Vec3 direction);

#endif
