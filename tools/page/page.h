/* What retex-pack --web writes: a folder with a page, the player, the set as it reads it, and the look that the page
 * begins with. */
#ifndef RETEX_PAGE_H
#define RETEX_PAGE_H

#include <retex/web.h>

#include "common/cli.h"

typedef struct Page {
    const char *folder;
    const char *preset; /* --preset, or NULL: it begins as rendered */
    RetexWebParams params;
} Page;

/* Announce its files, and exit if they cannot be. */
void page_announce(Cli *cli, const Page *page);
/* Write the page of an open set, and print what it takes. The manifest comes last, so an older room stays whole, at
 * most with a newer player and look, until the new one is. If it fails, what was not there before is removed. */
int page_write(Cli *cli, const Page *page, const char *set_path, const RetexSet *set, RetexError *err);

#endif
