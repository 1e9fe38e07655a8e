/* What of a picture can be a target without an identifier: the objects, materials, flat faces, levels, colours and
 * images that its pixels show, each with the text that selects it (scene/selector.h). */
#ifndef RENDERER_RENDER_CANDIDATES_H
#define RENDERER_RENDER_CANDIDATES_H

#include "render/render.h"

typedef struct Candidate {
    char *text;             /* selects it */
    const char *kind;       /* the shape's name, "material", "flat", "level", "colour" or "image" */
    const char *name;       /* of a material: what it is declared as; or NULL */
    const PlaceList *place; /* of the first object that shows it */
    double share;           /* of the picture */
    int directions;         /* above 1: one image is on faces that look in so many directions, as an atlas is */
    int is_unlit;           /* 1: it shows an image as its own light alone */
} Candidate;

typedef struct Candidates {
    int count;
    Candidate *list; /* by share, the largest first */
} Candidates;

/* By the first hits of rays through the pixels' centres. Materials are listed that several objects have; flat faces
 * that cover at least a hundredth of the picture and are not all that is seen of an object; levels that have more than
 * one of these. sheet: NULL, or unallocated: gets a picture in which each material has a hue of its own, its flat faces
 * and objects are lighter and darker, and objects have their number where there is room. */
int render_candidates(Candidates *candidates, RetexImage *sheet, const Scene *scene, const RenderParams *params,
                      RetexError *err);
void candidates_close(Candidates *candidates);

#endif
