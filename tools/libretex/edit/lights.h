/* The statements of an edit about lamps. Private to this room. */
#ifndef RETEX_EDIT_LIGHTS_H
#define RETEX_EDIT_LIGHTS_H

#include <retex/edit.h>

#include "edit/keyed.h"

extern const RetexKeyedKind retex_keyed_light; /* light:LAMP=VALUE */

/* The value that a lamp has in an edit that is bound; NULL: as rendered. */
const RetexLampValue *retex_edit_light_of(const RetexEdit *edit, const char *lamp);

#endif
