/* The look that a page begins with: look.json, a preset of retex-edit(5), and the pictures that it names. */
#ifndef RETEX_PAGE_LOOK_H
#define RETEX_PAGE_LOOK_H

#include <retex/edit.h>

#include "common/cli.h"
#include "page/added.h"

#define LOOK_FILE "look.json"

/* Read a preset, and check that the set, and a page of it, can look so. Warns of what a page does not show, and takes
 * it away. */
int look_read(RetexEdit *edit, const Cli *cli, const char *preset, const RetexSet *set, RetexError *err);
/* Copy its pictures to FOLDER/textures, those that browsers do not read as PNG, and write FOLDER/look.json with their
 * new names, which the edit then has. */
int look_write(RetexEdit *edit, const Cli *cli, const char *folder, Added *added, RetexError *err);

/* The pictures of targets that look_write has copied, as the attribute `textures` of a page has them: divided by
 * blanks, as many as there is room for. */
void look_offer(char *text, size_t size, RetexEdit *edit);

/* The look that a folder has already. 0: it has none that can be read. */
int look_old(RetexEdit *old, const char *folder);
/* Remove what the new look of the folder, NULL where it has none, has not of an older one. */
void look_remove_old(RetexEdit *old, RetexEdit *edit, const char *folder);

#endif
