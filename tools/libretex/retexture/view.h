/* A view of a set: images whose rows are computed, when they are asked for, from rows of the set and from one another.
 * What is smaller than the picture and is enlarged is made once, before all else, and kept. Of all other images one row
 * at a time exists, so that none of the picture's size is ever complete in memory.
 *
 * Light of a floor, times a gain that is smaller than the picture:
 *     0 PART radiance    1 FOOTPRINT floor    2 PART gain, kept    3 ENLARGED 2    4 SUM of 0 * 1 * 3
 * Row y of image 4 asks for row y of 0, 1 and 3.
 *
 * Private to libretex. */
#ifndef RETEX_RETEXTURE_VIEW_H
#define RETEX_RETEXTURE_VIEW_H

#include <retex/combine.h>

#include "set/rows.h"

/* How an image is made: what `index`, `finish` and `inputs` of RetexViewImage are. */
typedef enum RetexViewKind {
    VIEW_PART,      /* part `index` of the set, one channel made three where the image has three */
    VIEW_FOOTPRINT, /* what shows at footprint `index`: the texture, or what is laid on the set, or the original albedo;
                       times the weight of `finish` if that is not negative */
    VIEW_MIXTURE,   /* the mean of the inputs by the weights of mixture `index`, share by share */
    VIEW_FURTHER,   /* RETEX_QUANTITY_FURTHER of the colours that input 0 is, and of the originals that input 1 is */
    VIEW_GATE_SUMS, /* of target `index`, at the image's scale: see view_gates.c */
    VIEW_GATES,     /* of it, from the sums that are inputs: weights of the second finish and later ones */
    VIEW_GATE,      /* of it, from the gates that input 0 is: the weight of `finish` */
    VIEW_ENLARGED,  /* input 0, which is smaller */
    VIEW_SUM        /* the sum of products */
} RetexViewKind;
enum { VIEW_KINDS = VIEW_SUM + 1, VIEW_INPUTS_MAX = RETEX_MAX_FACTORS + 2 };
enum { VIEW_ORIGINALS = -2 }; /* the `finish` of a mixture of original albedos, whatever is edited */

/* A product of images, times a weight. */
typedef struct RetexViewProduct {
    float weight[3];
    int ninputs, inputs[VIEW_INPUTS_MAX];
    int term; /* the set's term that it is, or the first of those that it has */
} RetexViewProduct;

typedef struct RetexViewImage RetexViewImage;
typedef struct RetexViewReader RetexViewReader;
typedef struct RetexViewRow RetexViewRow;
/* Make row y of an image into own->row and own->span. own->buffer has memory for a row; own->row begins as NULL and
 * own->span as the whole row. */
typedef int RetexViewMake(RetexViewReader *reader, const RetexViewImage *image, RetexViewRow *own, int y,
                          RetexError *err);

struct RetexViewImage {
    RetexViewKind kind;
    RetexViewMake *make;
    int index, finish; /* finish: -1: none; of a mixture also VIEW_ORIGINALS */
    int scale, width, height, channels;
    int ninputs, inputs[RETEX_SHARES_MAX];
    int nproducts;
    RetexViewProduct *products;
    int is_enlarged;  /* 1: it is an input of VIEW_ENLARGED, so all of it is made before the rows of others are */
    RetexImage kept;  /* then its pixels, */
    int is_made;      /* from when on they are complete */
};

typedef struct RetexView {
    const RetexSet *set;
    RetexTexture *const *textures; /* by target, or NULL; they replace what is laid on the set */
    RetexKeptSamples *const *kept; /* samples of these textures, by target, or NULL */
    RetexRowSpan columns;          /* outside of them rows of the picture's size may be 0 */
    int mapped[RETEX_MAX_TARGETS]; /* by target, the number of finishes that a map tells apart; 0: no map */
    int shown[RETEX_MAX_TARGETS];  /* of these, the finish that shows where the map is transparent */
    RetexViewImage *images;
    int nimages, room; /* room: images that there is memory for */
} RetexView;

/* The image of that kind, index and finish, or -1. */
int retex_view_find(const RetexView *view, RetexViewKind kind, int index, int finish);
/* Make the images that are enlarged. No image may be added then. */
int retex_view_make(RetexView *view, int nthreads, RetexError *err);
void retex_view_close(RetexView *view);

static inline int retex_view_has_weight(const float weight[3])
{
    return weight[0] != 1 || weight[1] != 1 || weight[2] != 1;
}

/* An image of the view, or that of which it is an enlargement. */
static inline const RetexViewImage *retex_view_inner(const RetexView *view, int image)
{
    const RetexViewImage *of = &view->images[image];
    return of->kind == VIEW_ENLARGED ? &view->images[of->inputs[0]] : of;
}

/* A row of colours that is 0 outside of the span that was filled last. */
typedef struct RetexRowBuffer {
    float *values;
    RetexRowSpan filled;
} RetexRowBuffer;

/* The rows of a product's inputs, none of which is black. */
typedef struct RetexViewTerm {
    const RetexViewProduct *product;
    RetexRowSpan span; /* outside of it one of the inputs is 0 */
    const float *rows[VIEW_INPUTS_MAX];
} RetexViewTerm;

/* The row of an image that was made last. */
struct RetexViewRow {
    int y; /* -1: none */
    const float *row;
    RetexRowSpan span;
    RetexRowBuffer buffer;
    RetexViewTerm *terms; /* of a sum */
};

struct RetexViewReader {
    const RetexView *view;
    RetexRowReader *set; /* rows of the set */
    RetexViewRow *rows;  /* by image */
    float *weights;      /* of a mixture */
};

/* Open a reader of rows, one for each thread. */
int retex_view_reader_open(RetexViewReader *reader, const RetexView *view, RetexError *err);
void retex_view_reader_close(RetexViewReader *reader);

/* Make or find row y of an image, at its own size; *row is NULL where all of it is 0. It is 0 outside of *span, which
 * may be NULL, and stays valid until another row of the same image is asked for. */
int retex_view_row(RetexViewReader *reader, int image, int y, const float **row, RetexRowSpan *span, RetexError *err);
/* The products of row y of a sum that are not black. */
int retex_view_terms(RetexViewReader *reader, int image, int y, const RetexViewTerm **terms, int *count,
                     RetexError *err);

#endif
