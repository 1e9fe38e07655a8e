/* Folders of textures, as they are downloaded: which file of one is its base colour. Private to libretex. */
#ifndef RETEX_TEXTURE_FOLDER_H
#define RETEX_TEXTURE_FOLDER_H

#include <retex/access.h>

/* The file that an image is: the image itself, or if that is a folder, the file of its base colour. *file is to be
 * freed. *unused: what else the folder has and nobody uses, one line, to be freed; NULL where there is nothing. */
int retex_texture_folder_find(char **file, char **unused, const char *image, const RetexAccess *access,
                              RetexError *err);

#endif
