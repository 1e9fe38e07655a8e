/* The files of the page, which make puts into the program. */
#ifndef RETEX_STUDIO_PAGE_H
#define RETEX_STUDIO_PAGE_H

#include <stddef.h>

typedef struct PageFile {
    const char *name;
    const unsigned char *data;
    size_t bytes;
} PageFile;
extern const PageFile studio_page[]; /* end with name NULL */

#endif
