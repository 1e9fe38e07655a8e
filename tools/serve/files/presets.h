/* Presets: files NAME.json of a folder, see retex/preset.h. */
#ifndef RETEX_SERVE_PRESETS_H
#define RETEX_SERVE_PRESETS_H

#include <retex/preset.h>

typedef struct Presets {
    const char *folder;        /* NULL: there are none */
    const RetexAccess *access; /* must allow this folder */
} Presets;

/* Add to an edit what a preset says, as its file is now. Images have the names that they have there. RETEX_ENOTFOUND:
 * there is none of that name. */
int presets_read(const Presets *presets, const char *name, RetexEdit *edit, RetexError *err);

/* As names_list. */
int presets_list(const Presets *presets, void (*tell)(void *context, const char *name), void *context);

#endif
