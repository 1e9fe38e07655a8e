/* Participating media: what absorbs, emits and scatters light, at a point. */
#ifndef RENDERER_MEDIUM_MEDIUM_H
#define RENDERER_MEDIUM_MEDIUM_H

#include "base/color4.h"
#include "scene/scene.h"

#define MEDIA_AT_ONCE 16 /* more are not looked at */

/* All media that fill the same space, per unit of length and by channel. */
typedef struct MediumSums {
    Float4 extinction, emission;
    Float4 scattering;           /* of all light but that of light sources */
    Float4 density[MEDIA_AT_ONCE];
} MediumSums;

typedef struct MediumSet {
    int count;
    const Medium *media[MEDIA_AT_ONCE];
    int varies;      /* some density does */
    int scatters;    /* something scatters light */
    int emits;
    float majorant;  /* bound of the extinction, of any channel */
    MediumSums sums; /* bounds; exact where nothing varies */
} MediumSet;

void medium_set_add(MediumSet *set, const Medium *media); /* all of a list */
void medium_set_complete(MediumSet *set);
/* At a point of the world. most: where extinction is larger, all is scaled down to it; 0: it is not looked at. */
void medium_at(const MediumSet *set, Vec3 p, float most, MediumSums *sums);
/* What one of them scatters, at that point: of light sources as POV-Ray does, and of all other light, of which the
 * share counts that dims light. */
static inline Float4 medium_scattering_of_sources(const Medium *medium, Float4 density)
{
    return color4(medium->scattering) * density;
}
static inline Float4 medium_scattering(const Medium *medium, Float4 density)
{
    return color4(medium->scattering) * density * splat(at_most((float)medium->extinction, 1));
}
/* Bound of a density's values. */
Rgb density_bound(const Pigment *density);

#endif
