/* A lamp for rooms that nothing lights. */
#ifndef RETEX_IMPORT_CEILING_H
#define RETEX_IMPORT_CEILING_H

#include "import/base/model.h"

/* Whether surfaces shine enough to be the light of the scene. */
int ceiling_emits(const Import *import);
/* Whether the model is a room that no sky can light. */
int ceiling_is_needed(const Import *import, int *is_needed, RetexError *err);
int ceiling_write(Import *import, FILE *out, RetexError *err);

#endif
