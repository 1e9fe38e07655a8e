/* What can be a target, pixel by pixel: by each scope (scene/selector.h) the text that a click there would take. */
#ifndef RENDERER_RENDER_SURFACES_H
#define RENDERER_RENDER_SURFACES_H

#include "render/first_hit.h"
#include "faces/scene_faces.h"

enum { SURFACE_SCOPES = 4, SURFACES_MAX = 65535 };

typedef struct SeenSurface {
    char *text;         /* selects it */
    SelectorScope scope;
    const char *name;   /* of the material, or of the object; or NULL */
    double share;       /* of the picture */
} SeenSurface;

typedef struct Surfaces {
    int count;
    SeenSurface *list;
    uint16_t *planes; /* of materials, objects, flat faces, levels, by pixel: 1 + the index of what is taken, or 0 */
    uint64_t charged;
} Surfaces;

/* What no view changes: it is found where it is first asked for, and kept for the next view. */
typedef struct SceneSurfaces {
    const Scene *scene; /* NULL: not open */
    Materials materials;
    SceneFaces faces;
} SceneSurfaces;

int scene_surfaces_open(SceneSurfaces *known, const Scene *scene, RetexError *err);
void scene_surfaces_close(SceneSurfaces *known);

/* By the rays through the pixels' centres. A target of a surface's text has the pixels that its plane shows. What has
 * no faces has neither flat ones nor a level; levels are those that have at least a thousandth of the picture, found
 * from the faces that are seen most, and a face belongs to the first one that has it. */
int surfaces_find(Surfaces *surfaces, SceneSurfaces *known, const FirstHitWindow *window, RetexBudget *budget,
                  RetexError *err);
void surfaces_close(Surfaces *surfaces, RetexBudget *budget);

/* Where textures go: by pixel 1 + the target that is seen most at its centre, or 0, and its UV. */
void surfaces_uv(const FirstHitWindow *window, uint16_t *targets, float *u, float *v);

#endif
