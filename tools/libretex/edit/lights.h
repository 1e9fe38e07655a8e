/* The statements of an edit about lamps. Private to libretex. */
#ifndef RETEX_EDIT_LIGHTS_H
#define RETEX_EDIT_LIGHTS_H

#include <retex/edit.h>

/* The name of the lamp in a key `light:NAME`; NULL in other keys. */
const char *retex_edit_key_lamp(const char *key);
/* Add the value of a lamp: RETEX_EPARSE where it has one. */
int retex_edit_add_light(RetexEdit *edit, const char *lamp, const char *value, RetexError *err);

#endif
