/* Folders of textures, as they are downloaded: which files of one are used. Private to libretex. */
#ifndef RETEX_TEXTURE_FOLDER_H
#define RETEX_TEXTURE_FOLDER_H

#include <retex/access.h>

/* The files that an image is. */
typedef struct RetexFolderFiles {
    char *color;     /* the image itself, or if that is a folder, the file of its base colour */
    char *roughness; /* the file of its roughness, if that is wanted and there is one; else NULL. Its value is in */
    int channel;     /* this channel, 0 = red; */
    int is_gloss;    /* 1: it is 1 minus the roughness */
    int has_roughness; /* 1: a folder that has it, wanted or not */
    char *unused;      /* what else the folder has and nobody uses, one line; NULL where there is nothing */
} RetexFolderFiles;

#define RETEX_NO_FINISH_MAP "none" /* as RetexTextureSpec.finish */

int retex_texture_folder_find(RetexFolderFiles *files, const char *image, const RetexAccess *access,
                              int wants_roughness, RetexError *err);
void retex_texture_folder_files_free(RetexFolderFiles *files);

#endif
