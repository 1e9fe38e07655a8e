/* The lamps that a page has. Private to libretex. */
#ifndef RETEX_WEB_LAMPS_H
#define RETEX_WEB_LAMPS_H

#include <retex/set.h>

/* The smallest scale of the gains of lamps: a quarter of the memory and bytes of the picture's own size. */
enum { RETEX_WEB_LAMP_SCALE = 2 };

/* Make the lamps of a compact set those of a page: not those that it shows nothing of. Of more than `most`, `rest` not
 * counted, the dimmest join `rest`: their gains are added up, each times its value, and those of each choice of
 * finishes apart. names: of these, divided by commas. Gains of the picture's size become smaller. Without terms of role
 * LAMP nothing changes. RETEX_EUNSUPPORTED where too many lamps are off in the picture: what joins `rest` has to shine
 * as the terms of all light have it. */
int retex_web_lamps_prepare(RetexSet *set, int most, char *names, size_t size, RetexError *err);

/* Whether a parameter has terms of role LAMP, or is the lamp of such ones: of its light with a finish. */
int retex_web_has_light(const RetexSet *set, int parameter);

#endif
