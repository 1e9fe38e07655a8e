/* Pavements: the plane y = 0 covered with copies of one tile of triangles, squares or hexagons. */
#ifndef RENDERER_PATTERN_PAVEMENT_H
#define RENDERER_PATTERN_PAVEMENT_H

enum { PAVEMENT_POLYGONS = 6 };

/* POV-Ray's keywords. Looks: 0 a corner, 1 one that is cut off, 2 a round one. */
typedef struct Pavement {
    int sides;    /* of the polygons that tiles are made of: 3, 4 or 6, each 1 long */
    int tiles;    /* number_of_tiles: of polygons in a tile, from 1 to PAVEMENT_POLYGONS, of hexagons one less */
    int pattern;  /* which of these tiles, from 1 to pavement_count */
    int exterior; /* look of a tile's ends; hexagons have none */
    int interior; /* look of its concave corners */
    int form;     /* look of its bends; 3: they have those of ends and of concave corners */
} Pavement;

/* How many tiles there are of so many polygons; 0: of so many there are none. */
int pavement_count(int sides, int tiles);

/* The edges of a cell, as bits. Squares: 1 that of least x, 2 that of least z. Else a cell is a corner of triangles of
 * side 1, with the edges that leave it to the right (1) and, against the clock, 60 (2) and 120 degrees (4) from there;
 * hexagons are six triangles each. Corner i, j is at x = i + j/2, z = j √3/2. */
int pavement_edges(const Pavement *pavement, double i, double j);

#endif
