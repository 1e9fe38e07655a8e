/* Adjustments of a texture's colours in the text of edits. Private to libretex. */
#ifndef RETEX_EDIT_ADJUSTMENT_H
#define RETEX_EDIT_ADJUSTMENT_H

#include <retex/texture.h>

/* The word of an option. */
const char *retex_adjustment_word(RetexAdjust kind);
/* Add an adjustment behind those that the texture has, where the value changes something; one of the same kind before
 * is no more. RETEX_EPARSE where the value is none. */
int retex_adjustment_parse(RetexTextureSpec *spec, RetexAdjust kind, const char *value, RetexError *err);
/* The value as text of `size` bytes; 0: the texture has no such adjustment. */
int retex_adjustment_write(const RetexTextureSpec *spec, RetexAdjust kind, char *text, size_t size);

#endif
