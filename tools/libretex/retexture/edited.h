/* A set with textures laid on it: which of its terms count, and by how much, as a sum of products of a view's images
 * (view.h). Private to libretex. */
#ifndef RETEX_RETEXTURE_EDITED_H
#define RETEX_RETEXTURE_EDITED_H

#include "retexture/view.h"

/* What the products of the sum are. */
typedef enum RetexEditedSum {
    EDITED_PICTURE,   /* the picture: terms that have factors or radiance in common are added up first */
    EDITED_TERMS,     /* each term, with all its factors; no corrections */
    EDITED_CORRECTED, /* with corrections */
    EDITED_LAMPS      /* and both all light as it is kept and that of each lamp, which nothing is taken from */
} RetexEditedSum;

typedef struct RetexEdited {
    RetexView view;
    int sum; /* the image that is the result, a VIEW_SUM */
    RetexEditedSum of;
    int cross;
    char edited[RETEX_MAX_TARGETS];            /* 1: the target has a texture */
    int picture;                               /* 1: part 0 is the result, and the sum is of nothing */
    int lamps;                                 /* 1: the set has terms of lamps */
    int lamp_pictures;                         /* 1: the lamps' pictures stand for all other terms */
    float common[3];                           /* what terms of all light are multiplied by */
    float parameters[RETEX_PARAMETERS_MAX][3]; /* their values here; of lamps, what these have beyond `common` */
    int has_normals;                           /* 1: a target has a normal map */
} RetexEdited;

/* Open it with the terms that params select (NULL = defaults). Borrows set and textures. */
int retex_edited_open(RetexEdited *edited, const RetexSet *set, RetexTexture *const *textures,
                      const RetexCombineParams *params, RetexEditedSum of, int nthreads, RetexError *err);
void retex_edited_close(RetexEdited *edited);

/* What the lamps with these parameters have in common, in times of what they are kept with: the least. That much of all
 * light counts, with its corrections; of each lamp what it has beyond. least: the parameter that has it, or -1. Returns
 * 1, with nothing in common, where light of single lamps stands for all. */
int retex_edited_common(const RetexEdited *edited, const float *parameters, float common[3], int least[3]);
/* What a lamp has beyond: value - common * kept, exactly 0 of the least. */
float retex_edited_beyond(float value, float kept, float common);

#endif
