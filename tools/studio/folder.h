/* Lists of folders, for the dialog to open and the tray of textures. */
#ifndef RETEX_STUDIO_FOLDER_H
#define RETEX_STUDIO_FOLDER_H

#include <jansson.h>

#include <retex/access.h>

enum { FOLDER_ENTRIES = 5000 };

/* [{"name", "path", "kind", "bytes", "mtime"}…], sorted by name; hidden files and what is no file or folder are left
 * out. kind: folder, page (a folder of retex-pack --web), model, scene, set, picture, project, file. `shown`: the path
 * as the request has it, by which those of the entries begin. *is_cut: there are more. */
int folder_list(const char *path, const char *shown, const RetexAccess *access, json_t **list, int *is_cut,
                RetexError *err);

#endif
