/* Finds what is installed with the library and opened or started by its path: the bridge, and the decoder. */
#ifndef RETEX_PICTURE_BESIDE_H
#define RETEX_PICTURE_BESIDE_H

#include <limits.h>

typedef char RetexBesidePath[PATH_MAX + 64];

/* The path of a file of that name, by where this code is: 1, or 0 where there is none. */
int retex_beside_find(RetexBesidePath path, const char *name);

#endif
