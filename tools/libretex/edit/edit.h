/* What an edit is in memory. Private to libretex. */
#ifndef RETEX_EDIT_EDIT_H
#define RETEX_EDIT_EDIT_H

#include <retex/set.h>
#include <retex/texture.h>

struct RetexEdit {
    int count;
    RetexTextureSpec specs[RETEX_MAX_TARGETS]; /* sorted by target */
    unsigned said[RETEX_MAX_TARGETS]; /* bit k: a statement of kind k; of textures of options and cells only bit 0 */
};

#endif
