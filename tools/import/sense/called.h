/* What things are called in models: whether that means a floor or a wall, in several languages. */
#ifndef RETEX_IMPORT_CALLED_H
#define RETEX_IMPORT_CALLED_H

/* Of the names of a material, a node and a mesh: 1 if they say so, -1 if they say something else, 0 if nothing. A
 * material goes before the others: it is the floor of a house, where a node has all of it. */
int called_floor(const char *const names[3]);
int called_wall(const char *const names[3]);

#endif
