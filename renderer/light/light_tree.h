/* A tree over lights: one of many is chosen by what it may give at a point, in time that grows with the logarithm of
 * their number (Conty Estevez and Kulla, 'Importance Sampling of Many Lights with Adaptive Tree Splitting', 2018).
 * Clusters are bounded by a sphere, the cone of the directions they face, and their power; one random number goes down
 * from the root. Nodes have up to eight children: they are weighed side by side, and fewer rough choices are made on
 * the way than by twos. */
#ifndef RENDERER_LIGHT_LIGHT_TREE_H
#define RENDERER_LIGHT_LIGHT_TREE_H

#include <retex/error.h>
#include "base/vec.h"

/* What choosing a light may look at: pbrt's LightSampleContext. */
typedef struct LightSampleContext {
    Vec3 position;
    Vec3 normal; /* unit length, on the side that light must come from; 0 where it may come from both */
    const struct LightGroup *light_group; /* of the surface, or NULL: which light sources shine on it */
} LightSampleContext;

/* What bounds a light, in world space. Its irradiance at distance d on a surface that faces it is about
 * constant + intensity / (d^2 + intensity / peak). */
typedef struct LightBounds {
    Vec3 low, high;
    Vec3 axis;     /* of its cone, unit length */
    double theta_o;    /* half-angle of the cone that its surface normals lie in, 0..pi */
    double theta_e;    /* largest angle to a normal at which it emits, 0..pi/2 */
    double back_share; /* share that it emits on the back of its surface, 0..1; above 0 the back is never left out */
    double constant, intensity, peak;
} LightBounds;

typedef struct LightTree LightTree;

/* count >= 1. */
int light_tree_create(LightTree **tree, const LightBounds *lights, int count, RetexError *err);
void light_tree_close(LightTree **tree);
/* Choose a light by *u in [0,1), which is stretched to [0,1) again. */
int light_tree_pick(const LightTree *tree, const LightSampleContext *point, double *u, float *probability);
/* With which light_tree_pick chooses that light. They add up to 1; one that can light the point has some. */
float light_tree_probability(const LightTree *tree, const LightSampleContext *point, int light);
/* Rough irradiance of all of them on a surface that faces them. */
float light_tree_estimate(const LightTree *tree, const LightSampleContext *point);

#endif
