/* What an edit is in memory. Private to libretex. */
#ifndef RETEX_EDIT_EDIT_H
#define RETEX_EDIT_EDIT_H

#include <retex/set.h>
#include <retex/texture.h>

#include "edit/keyed.h"

/* Its lists of keyed statements, in the order of the canonical text. */
enum { RETEX_EDIT_LIGHTS, RETEX_EDIT_FINISHES, RETEX_EDIT_PICTURE, RETEX_EDIT_KEYED };
extern const RetexKeyedKind *const retex_edit_keyed[RETEX_EDIT_KEYED];

struct RetexEdit {
    int count;
    RetexTextureSpec specs[RETEX_MAX_TARGETS]; /* sorted by target */
    unsigned said_of_layers[RETEX_MAX_TARGETS][RETEX_LAYERS_MAX]; /* the same of these */
    unsigned said[RETEX_MAX_TARGETS]; /* bit k: a statement of kind k; of textures of options and cells only bit 0 */
    RetexKeyedList keyed[RETEX_EDIT_KEYED];
};

#endif
