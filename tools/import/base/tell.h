/* Messages to the process that waits. */
#ifndef RETEX_IMPORT_TELL_H
#define RETEX_IMPORT_TELL_H

#include "import/base/model.h"

void import_tell(const Import *import, char kind, const char *fmt, ...) RETEX_PRINTF(3, 4);

/* Text for a comment, without control characters. */
const char *import_plain(const char *text, char plain[NAME_SIZE]);

#endif
