/* The textures that a caller wishes for a set's targets. Private to libretex. */
#ifndef RETEX_RETEXTURE_TEXTURES_H
#define RETEX_RETEXTURE_TEXTURES_H

#include <retex/combine.h>

/* Copy an array of specs as base/params.h does, by the caller's size of one. RETEX_EINVAL also where they are more than
 * a set has targets. */
int retex_texture_specs_copy(RetexTextureSpec own[RETEX_MAX_TARGETS], const RetexTextureSpec *specs, int nspecs,
                             RetexError *err);

#endif
