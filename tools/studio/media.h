/* Files as they are, with their types and parts. */
#ifndef RETEX_STUDIO_MEDIA_H
#define RETEX_STUDIO_MEDIA_H

#include "request.h"

/* The media type of a file by its name: that of a picture, or of JSON, or only bytes. is_page: it is of the program's
 * own page, which alone has documents and scripts. */
const char *media_type(const char *name, int is_page);
/* An open file, which is closed: whole, a part of it as the header Range says, or nothing where the window has it. */
Reply media_file(const Request *request, int descriptor, const char *type);

#endif
