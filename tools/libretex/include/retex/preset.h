/* Presets: an edit in a file, to be put on other pictures later. It is JSON:
 *
 *     {"retex-preset": 1, "edit": "Floor=../textures/oak.jpg;Floor.scale=2,2;light:Desk=3000K;picture:view=Filmic"}
 *
 * `edit` is the text of the edit, retex/edit.h. Names of files in it that do not begin with a slash are meant from the
 * folder of the preset, so that it may be moved together with its textures. Other members are left for later versions
 * and are not read. */
#ifndef RETEX_PRESET_H
#define RETEX_PRESET_H

#include <retex/edit.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_PRESET_BYTES_MAX 1048576 /* of a preset's file */

/* Add the statements of a preset to an edit; "-" is standard input. Names of files are then meant from the current
 * folder. RETEX_EFORMAT: the file is no preset; RETEX_EUNSUPPORTED: one of a later version; RETEX_EPARSE, RETEX_EINVAL:
 * its edit is wrong, or says something of what the edit has already. The edit stays as it is then. */
int retex_preset_read(RetexEdit *edit, const char *path, RetexError *err);
/* The same of a file in memory, whose name is for messages; names of files stay as they are. */
int retex_preset_parse(RetexEdit *edit, const void *data, size_t bytes, const char *name, RetexError *err);
/* Write an edit as a preset, as all outputs are written; "-" is standard output, from whose folder, the current one,
 * names are meant. RETEX_EINVAL: a name of a file cannot be written as text. */
int retex_preset_write(const RetexEdit *edit, const char *path, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
