/* Views of a scene that are none of the model's cameras. */
#ifndef RETEX_IMPORT_FRAMING_H
#define RETEX_IMPORT_FRAMING_H

#include "import/base/model.h"

/* Where a camera sees all of a box, from a side: a vector from its middle, of any length. angle: degrees, from left to
 * right. */
void framing_fit(const double low[3], const double high[3], const double side[3], double angle, double eye[3],
                 double target[3]);
/* Whether --camera asks for a view that is none of the model's: a place, or the words inside and outside. */
int framing_is_asked(const Import *import, int *is_asked, RetexError *err);
/* A view of the scene: what is asked for, else from inside of a room and from outside of what is none. */
int framing_write(Import *import, FILE *out, RetexError *err);

#endif
