/* What is there twice. */
#ifndef RETEX_IMPORT_DOUBLES_H
#define RETEX_IMPORT_DOUBLES_H

#include "import/base/model.h"

/* Of faces that lie on one another, one stays; once materials are known. */
int doubles_drop(Import *import, RetexError *err);
int doubles_find_objects(Import *import, RetexError *err);

#endif
