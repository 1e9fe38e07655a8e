/* What an edit is in memory. Private to libretex. */
#ifndef RETEX_EDIT_EDIT_H
#define RETEX_EDIT_EDIT_H

#include <retex/lamp.h>
#include <retex/set.h>
#include <retex/texture.h>

enum { RETEX_EDIT_LIGHTS_MAX = 32 };

/* A lamp's new value. */
typedef struct RetexEditLight {
    char lamp[RETEX_NAME_MAX]; /* `*`: all lamps that the edit does not name */
    RetexLampValue value;
} RetexEditLight;

/* A target's finish. */
typedef struct RetexEditFinish {
    char target[RETEX_NAME_MAX], finish[RETEX_NAME_MAX];
} RetexEditFinish;

struct RetexEdit {
    int count;
    RetexTextureSpec specs[RETEX_MAX_TARGETS]; /* sorted by target */
    unsigned said[RETEX_MAX_TARGETS]; /* bit k: a statement of kind k; of textures of options and cells only bit 0 */
    int nlights;
    RetexEditLight lights[RETEX_EDIT_LIGHTS_MAX]; /* sorted by lamp */
    int nfinishes;
    RetexEditFinish finishes[RETEX_MAX_TARGETS]; /* sorted by target */
};

#endif
