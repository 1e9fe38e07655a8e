/* Reads any picture file as a list of layers. A layer is an image with named channels. Private to libretex. */
#ifndef RETEX_FILES_LAYERS_H
#define RETEX_FILES_LAYERS_H

#include <retex/image_file.h>

typedef struct RetexLayers RetexLayers;

/* All channels of one layer. */
typedef struct RetexLayer {
    char (*channels)[192]; /* image.channels names, without the layer's name as prefix */
    RetexImage image;
} RetexLayer;

/* Open a file: an EXR or a pack, whose parts are the layers, or another picture, which is one layer R,G,B,A. */
int retex_layers_open(RetexLayers **layers, const char *path, const RetexReadParams *params, int nthreads,
                      RetexError *err);
void retex_layers_close(RetexLayers **layers);
int retex_layers_count(const RetexLayers *layers);
const char *retex_layers_name(const RetexLayers *layers, int index); /* "" if it has no name */
int retex_layers_find(const RetexLayers *layers, const char *name);  /* index or -1 */
int retex_layers_is_exact(const RetexLayers *layers); /* 0: the reader may have added or converted channels */

int retex_layers_read(RetexLayer *layer, RetexLayers *layers, int index, RetexError *err);
void retex_layer_free(RetexLayer *layer);
int retex_layer_find(const RetexLayer *layer, const char *channel); /* index or -1 */

#endif
