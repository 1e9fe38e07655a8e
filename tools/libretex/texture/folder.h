/* Folders of textures, as they are downloaded: which files of one are used. Private to libretex. */
#ifndef RETEX_TEXTURE_FOLDER_H
#define RETEX_TEXTURE_FOLDER_H

#include <retex/access.h>

/* The files that an image is. */
typedef struct RetexFolderFiles {
    char *color;     /* the image itself, or if that is a folder, the file of its base colour */
    char *map;       /* the file of its roughness, or its normal map, if that is wanted and there is one; else NULL. */
    int channel;     /* Roughness is in this channel, 0 = red; */
    int is_gloss;    /* 1: it is 1 minus the roughness */
    int has_maps;    /* 1: a folder that has one of both, wanted or not */
    char *unused;    /* what else the folder has and nobody uses, one line; NULL where there is nothing */
} RetexFolderFiles;

#define RETEX_NO_FINISH_MAP "none" /* as RetexTextureSpec.finish */

/* The map that is wanted beside the base colour. */
typedef enum RetexFolderWant { RETEX_FOLDER_COLOR, RETEX_FOLDER_ROUGHNESS, RETEX_FOLDER_NORMAL } RetexFolderWant;

int retex_texture_folder_find(RetexFolderFiles *files, const char *image, const RetexAccess *access,
                              RetexFolderWant want, RetexError *err);
void retex_texture_folder_files_free(RetexFolderFiles *files);

/* Whether green points down in a normal map, by the name of its file. */
int retex_texture_name_is_dx(const char *file);

#endif
