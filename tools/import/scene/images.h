/* Images of a model, which become files of the scene. */
#ifndef RETEX_IMPORT_IMAGES_H
#define RETEX_IMPORT_IMAGES_H

#include "import/base/model.h"

typedef enum AlphaMode { ALPHA_IGNORE, ALPHA_BLEND, ALPHA_MASK } AlphaMode;

/* An image as a pigment uses it. Where the file as it is will not do, a new one is made. */
typedef struct ImageUse {
    const char *source;  /* as the model names it; "*3" is the fourth one inside of it */
    const char *opacity; /* an image whose alpha or grey is the opacity, or NULL */
    float factor[3];     /* multiplies the colours, linear */
    float opacity_factor;
    AlphaMode alpha;
    float cutoff; /* of ALPHA_MASK */
} ImageUse;

/* Put the image into the scene's folder. file: its name there, or "" where it is missing, which is told. */
int images_use(Import *import, const ImageUse *use, char file[NAME_SIZE + 32], RetexError *err);
/* What an image's channels are as numbers. */
typedef struct ChannelStats {
    float mean[4], low[4], high[4];
} ChannelStats;
/* found = 0: the image is missing. */
int images_stats(Import *import, const char *source, ChannelStats *stats, int *found, RetexError *err);
/* Put one channel of an image, as numbers, into the scene's folder: a grey picture whose name ends in `what`. */
int images_channel(Import *import, const char *source, int channel, const char *what, char file[NAME_SIZE + 32],
                   RetexError *err);
/* Make a normal map of an image of heights, which are as high as a hundredth of the image is wide, times scale. */
int images_normals(Import *import, const char *source, float scale, char file[NAME_SIZE + 32], RetexError *err);
int images_add_sky(Import *import, char file[NAME_SIZE + 32], RetexError *err);
/* POV-Ray's keyword for a file's format. */
const char *images_keyword(const char *file);
void images_free(Import *import);

#endif
