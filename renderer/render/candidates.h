/* What of a picture can be a target without an identifier: the objects, colours and images that its pixels show, each
 * with the text that selects it (scene/selector.h). */
#ifndef RENDERER_RENDER_CANDIDATES_H
#define RENDERER_RENDER_CANDIDATES_H

#include "render/render.h"

typedef struct Candidate {
    char *text;             /* selects it */
    const char *kind;       /* the shape's name, "colour" or "image" */
    const PlaceList *place; /* of the first object that shows it */
    double share;           /* of the picture */
} Candidate;

typedef struct Candidates {
    int count;
    Candidate *list; /* by share, the largest first */
} Candidates;

/* By the first hits of rays through the pixels' centres. sheet: NULL, or unallocated: gets a picture in which each
 * object has a colour of its own, and its number where there is room. */
int render_candidates(Candidates *candidates, RetexImage *sheet, const Scene *scene, const RenderParams *params,
                      RetexError *err);
void candidates_close(Candidates *candidates);

#endif
