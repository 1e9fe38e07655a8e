/* Any picture file as a list of layers: images with named channels. Private to libretex. */
#ifndef RETEX_FILES_LAYERS_H
#define RETEX_FILES_LAYERS_H

#include <retex/image.h>

typedef struct RetexLayers RetexLayers;

/* One layer's pixels, all channels of them. */
typedef struct RetexLayer {
    char (*channels)[192]; /* names, without the layer's own in front; image.channels of them */
    RetexImage image;
} RetexLayer;

/* Open an EXR (its parts are the layers), a pack (likewise), or another picture (one layer R,G,B,A). */
int retex_layers_open(RetexLayers **layers, const char *path, const RetexAccess *access, const RetexBudget *budget,
                      int nthreads, RetexError *err);
void retex_layers_close(RetexLayers **layers);
int retex_layers_count(const RetexLayers *layers);
const char *retex_layers_name(const RetexLayers *layers, int index); /* "" where it has none */
int retex_layers_find(const RetexLayers *layers, const char *name);  /* index or -1 */
int retex_layers_is_exact(const RetexLayers *layers); /* 0: channels are what the reader made, not what the file has */

int retex_layers_read(RetexLayer *layer, RetexLayers *layers, int index, RetexError *err);
void retex_layer_free(RetexLayer *layer);
int retex_layer_find(const RetexLayer *layer, const char *channel); /* index or -1 */

#endif
