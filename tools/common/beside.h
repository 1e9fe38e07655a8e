/* Programs that stand beside the one that runs. */
#ifndef RETEX_BESIDE_H
#define RETEX_BESIDE_H

#include <limits.h>

/* The folder of the program that runs; "" where that is not known. */
void beside_folder(char folder[PATH_MAX]);
/* The path of a program. 0: there is none that can be run. */
int beside_program(char path[PATH_MAX], const char *name);

#endif
