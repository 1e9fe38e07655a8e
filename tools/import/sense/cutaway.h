/* A view into rooms from above, without what stands before them. */
#ifndef RETEX_IMPORT_CUTAWAY_H
#define RETEX_IMPORT_CUTAWAY_H

#include "import/base/model.h"

/* Place the camera, into import->cutaway, and drop what stands before the rooms, where it is asked for. */
int cutaway_find(Import *import, RetexError *err);

#endif
