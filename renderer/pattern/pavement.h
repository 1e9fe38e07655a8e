/* Pavements: the plane y = 0 covered with copies of one tile of squares. */
#ifndef RENDERER_PATTERN_PAVEMENT_H
#define RENDERER_PATTERN_PAVEMENT_H

enum { PAVEMENT_SQUARES = 6 };

/* POV-Ray's keywords. Looks: 0 a corner, 1 one that is cut off, 2 a round one. */
typedef struct Pavement {
    int sides;    /* of the polygons that tiles are made of: 4 is supported */
    int tiles;    /* number_of_tiles: of polygons in a tile, from 1 to PAVEMENT_SQUARES */
    int pattern;  /* which of these tiles, from 1 to pavement_count */
    int exterior; /* look of a tile's ends */
    int interior; /* look of its concave corners */
    int form;     /* look of its bends; 3: they have those of ends and of concave corners */
} Pavement;

/* How many tiles there are of so many squares. */
int pavement_count(int tiles);

#endif
