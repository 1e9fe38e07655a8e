/* What a tree of textures comes down to at a point: its leaves that are seen there, and what each counts.
 *
 * Of a map, parts count by the blend of its entries; of operands, those that contain the point. Of layers, each hides
 * what is below by its opacity: a layer of colour c shows c (1 - filter - transmit), and multiplies what is below by
 * filter c + transmit. What a tree shows is the sum of what its leaves show, each multiplied by its weight and by the
 * colours of the layers above it. Weights depend on opacity and place alone, never on the colour of a target.
 *
 * POV-Ray adds and multiplies these colours in the scene's working space. Where that is not linear, the colours of
 * leaves that are no targets, and are not below one, are made darker so that their sum is POV-Ray's. */
#ifndef RENDERER_PATH_LEAVES_H
#define RENDERER_PATH_LEAVES_H

#include "base/vec.h"
#include "shape/surface.h"

#define LEAVES_MAX 64 /* seen at one point; the builder refuses trees that have more */

/* A layer above leaves which is a target: it multiplies their light by d times its albedo, plus i. */
typedef struct LayerAbove {
    const Texture *texture;
    int target;
    Rgbft color;
    float d, i; /* their sum is 1: the leaf's weight has the rest */
    int above;  /* the next target above it, or -1 */
} LayerAbove;

typedef struct Leaf {
    const Texture *texture;
    int target;
    Rgbft color;
    float opacity;    /* see pigment_opacity */
    float weight;     /* that its light is multiplied by */
    float chance;     /* of being chosen, in proportion to the other leaves' */
    Rgb tint;         /* by the layers above that are no targets */
    Rgb working_tint; /* the same of colours of the working space */
    float neutral;    /* what all layers above do to light, with NEUTRAL_ALBEDO */
    int above;        /* index of the lowest target above it, or -1 */
    int is_layer;     /* others lie below: its filter and transmit say how opaque it is, but nothing passes by itself */
} Leaf;

typedef struct Leaves {
    int count, nabove;
    Leaf leaf[LEAVES_MAX];
    LayerAbove above[LEAVES_MAX];
} Leaves;

/* The leaves at a surface with a tree, seen along wo. merge: leaves that scatter alike become one, with the mean of
 * their colours, which is exact and leaves less to chance. There is at least one leaf. */
void leaves_at(Leaves *leaves, const Surface *surface, Vec3 wo, int merge);
/* How opaque all are together. In scenes before version 3.7 it may be more than 1, see pigment_opacity. */
float leaves_opacity(const Leaves *leaves);
/* The share of a leaf in what is seen, opaque or not; over all leaves the sum is 1. */
float leaves_share(const Leaves *leaves, int k);
/* A leaf by its chance, from u in [0, 1); *weight gets what its light is to be multiplied by. */
const Leaf *leaves_choose(const Leaves *leaves, double u, float *weight);
/* The same of the leaves that may let light pass, or NULL: the other ones count, but send nothing on. */
const Leaf *leaves_choose_passing(const Leaves *leaves, double u, float *weight);
/* The surface with the leaf as its only texture. */
Surface leaf_surface(const Surface *surface, const Texture *texture, int target);

#endif
