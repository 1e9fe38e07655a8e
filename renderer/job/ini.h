/* Options in POV-Ray's form: .ini files, and switches such as `+KFF12`. They say which scene is rendered, how large,
 * with what declared, and which frames. What else POV-Ray knows has no meaning here and is passed over. */
#ifndef RENDERER_JOB_INI_H
#define RENDERER_JOB_INI_H

#include "job/ini_settings.h"

/* Whether a command line's word is a name of such a file, FILE.ini or FILE.ini[SECTION]. */
int ini_is_file(const char *word);

/* Read FILE.ini or FILE.ini[SECTION]: all up to the first section, and that section. Files that it names are in its
 * folder. A keyword that POV-Ray does not have, a wrong value, a section that is not there, or a file that includes
 * itself is an error with file and line. */
int ini_read(IniOptions *options, const char *name, RetexError *err);

/* A switch, `+W320`. */
int ini_switch(IniOptions *options, const char *word, RetexError *err);

#endif
