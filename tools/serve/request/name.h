/* Names of rooms and textures, which are files of a folder. */
#ifndef RETEX_SERVE_NAME_H
#define RETEX_SERVE_NAME_H

enum { SERVE_NAME_MAX = 127 }; /* bytes */

/* Whether text is the name of a room or texture: letters, digits, spaces, `_-.,+()` and characters beyond ASCII, at
 * most SERVE_NAME_MAX bytes of UTF-8, not beginning with a dot. Files with other names cannot be asked for. */
int serve_name_is_valid(const char *text);

#endif
