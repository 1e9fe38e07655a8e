/* Files as they are, with their types and parts. */
#ifndef RETEX_STUDIO_MEDIA_H
#define RETEX_STUDIO_MEDIA_H

#include "request.h"

/* The media type of a file by its name; is_own: below the folder that the tools write to, where scripts are those of
 * retex-pack --web. */
const char *media_type(const char *name, int is_own);
/* An open file, which is closed: whole, a part of it as the header Range says, or nothing where the window has it. */
Reply media_file(const Request *request, int descriptor, const char *type);

#endif
