/* Files as they are, with their types and parts. */
#ifndef RETEX_STUDIO_MEDIA_H
#define RETEX_STUDIO_MEDIA_H

#include "request.h"

/* The media type of a file by its name; is_own: below the folder that the tools write to, where scripts are those of
 * retex-pack --web. */
const char *media_type(const char *name, int is_own);
/* The part that a header Range asks for: `bytes=FIRST-LAST`, `FIRST-` or `-COUNT`. 1: a part; 0: the whole, also where
 * several are asked for, or header is NULL; below 0: there is no such part. */
int media_range(const char *header, off_t size, off_t *first, off_t *count);
/* An open file, which is closed: whole, a part of it as the header Range says, or nothing where the window has it. */
Reply media_file(const Request *request, int descriptor, const char *type);

#endif
