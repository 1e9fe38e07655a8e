/* The row of statements about how the picture is developed. Private to libretex. */
#ifndef RETEX_EDIT_PICTURE_H
#define RETEX_EDIT_PICTURE_H

#include "edit/keyed.h"

extern const RetexKeyedKind retex_keyed_picture;

#endif
