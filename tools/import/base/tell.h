/* Messages to the process that waits, and what a scene would be without that the model has. */
#ifndef RETEX_IMPORT_TELL_H
#define RETEX_IMPORT_TELL_H

#include "import/base/model.h"

void import_tell(const Import *import, char kind, const char *fmt, ...) RETEX_PRINTF(3, 4);

/* Text for a comment, without control characters. */
const char *import_plain(const char *text, char plain[NAME_SIZE]);

/* Features that a scene cannot say yet: told once each. */
typedef enum LeftOut {
    LEFT_NORMAL_MAP,
    LEFT_FINISH_MAP,
    LEFT_EMISSION_MAP,
    LEFT_SPECULAR_MAP,
    LEFT_SHEEN_ROUGHNESS_MAP,
    LEFT_VERTEX_COLORS,
    LEFT_ANIMATION,
    LEFT_SKIN,
    LEFT_MORPHS,
    LEFT_AMBIENT_LIGHT,
    LEFT_OTHER_UV,
    LEFT_NO_UV,
    LEFT_NOWHERE,
    LEFT_LINES,
    LEFT_SAME_NAME
} LeftOut;

void import_leave_out(Import *import, LeftOut what);
/* An image that is lost. Returns 1 if that is to be told: each is once, and not without end. */
int losses_of_image(Import *import, const char *source);
/* At the end: fails where something is lost, unless a scene without it was asked for. */
int losses_check(Import *import, RetexError *err);

#endif
