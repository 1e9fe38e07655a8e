/* The layers of a picture of any renderer, and which of them are what. Private to libretex. */
#ifndef RETEX_FILES_PICTURE_LAYERS_H
#define RETEX_FILES_PICTURE_LAYERS_H

#include "exr/io.h"

/* One channel, under its whole name, or three, R,G,B or X,Y,Z, under what their names have in common. */
typedef struct RetexPictureLayer {
    char name[2 * RETEX_EXR_NAME_MAX]; /* "" for R,G,B */
    int part, count;
    int channels[3]; /* numbers in the part */
} RetexPictureLayer;

typedef struct RetexPictureLayers {
    int count;
    RetexPictureLayer *of;
} RetexPictureLayers;

int retex_picture_layers_open(RetexPictureLayers *layers, const RetexExr *exr, RetexError *err);
void retex_picture_layers_close(RetexPictureLayers *layers);

/* The layer that a user names: by its whole name, or by the end of it after a dot, or by the name of its only channel
 * without the letter. RETEX_ENOTFOUND where there is none, or where there are several; file: for the message. */
int retex_picture_layer_named(const RetexPictureLayers *layers, const char *name, const char *file, RetexError *err);
/* The picture itself: the same errors. */
int retex_picture_layer_beauty(const RetexPictureLayers *layers, const char *file, RetexError *err);

/* What renderers write, by well known names. */
typedef enum RetexPictureGuide {
    RETEX_PICTURE_NORMAL,      /* of the first hit */
    RETEX_PICTURE_SEEN_NORMAL, /* made for denoising: some renderers take it behind mirrors and glass */
    RETEX_PICTURE_ALBEDO,
    RETEX_PICTURE_POSITION,
    RETEX_PICTURE_DEPTH,
    RETEX_PICTURE_GUIDES
} RetexPictureGuide;
/* The first that is there, before all one of the same view layer as `beauty`; -1 where none is. */
int retex_picture_layer_known(const RetexPictureLayers *layers, RetexPictureGuide guide, int beauty);

/* The layer of colours that a layer of light is multiplied by, such as DiffCol of DiffDir and DiffInd; or -1. */
int retex_picture_layer_color(const RetexPictureLayers *layers, int light);
/* How messages call a layer. */
const char *retex_picture_layer_text(const RetexPictureLayers *layers, int layer);

#endif
