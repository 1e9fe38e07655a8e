/* Tilings of the plane y = 0 by polygons. */
#ifndef RENDERER_PATTERN_TILING_H
#define RENDERER_PATTERN_TILING_H

#include "base/vec.h"

enum { TILING_SIDES = 12 };

/* POV-Ray numbers them from 1. Numbers in the table are halves of a + b times a root, in pairs. */
typedef struct Tiling {
    int types;                 /* colours: tiles of type k have values from k / types to (k + 1) / types */
    double root, slope;        /* slope: by how much the value falls from a tile's edge inwards, of 1 / types */
    double straight;           /* POV-Ray's factor of the distance from some edges of its dodecagons; or 0 */
    signed char lattice[2][4]; /* after which all repeats: x, z */
    int ntiles;
    const signed char *tiles; /* of each: its type, how many corners it has, and these, x and z */
} Tiling;

enum { TILINGS = 24 };
extern const Tiling tilings[TILINGS];

/* Penrose's tilings 25 to 27, in which nothing repeats: of pentagons (types 0 to 2), stars (3), boats (4) and rhombs
 * (5); of darts (1) and kites; of thin (1) and thick rhombs. They return how far a point is from the edges of its
 * tile. */
enum { TILING_PENTAGONS = 25, TILING_KITES, TILING_RHOMBS };
double penrose_pentagons(Vec2 p, int *type);
double penrose_kites(Vec2 p, int *type);
double penrose_rhombs(Vec2 p, int *type);

#endif
