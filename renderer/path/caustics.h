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

#include "path/caustics_kernel.h"
#include "path/photons.h"

typedef struct Caustics Caustics;

typedef enum CausticsOf { CAUSTICS_OF_SOURCES, CAUSTICS_OF_EMITTERS, CAUSTICS_OF_SMALL_EMITTERS } CausticsOf;

/* Photons start from light sources that have caustics and, unless `of` is CAUSTICS_OF_SOURCES, from shapes that emit;
 * with CAUSTICS_OF_SMALL_EMITTERS the guide is given up where it is not worth its time. *caustics is NULL where there
 * are no caustics, and after a failure, such as that the budget stops it. The result is the same for every nthreads. */
int caustics_create(Caustics **caustics, const PhotonSources *sources, CausticsOf of, int nthreads, RetexError *err);
void caustics_close(Caustics **caustics);
/* The cell of a point, or NULL where no photons landed. */
const CausticsCell *caustics_find(const Caustics *caustics, Vec3 position);

#endif
