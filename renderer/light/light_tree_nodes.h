/* The light tree in memory; private to light_tree.c and light_tree_kernel.c. */
#ifndef RENDERER_LIGHT_LIGHT_TREE_NODES_H
#define RENDERER_LIGHT_LIGHT_TREE_NODES_H

#include "light/light_tree.h"

#define LIGHT_TREE_WIDTH 8 /* children of a node */

/* Clusters side by side; those that are not there have no power. */
typedef struct LightTreeNode {
    float x[LIGHT_TREE_WIDTH], y[LIGHT_TREE_WIDTH], z[LIGHT_TREE_WIDTH]; /* centres */
    float radius[LIGHT_TREE_WIDTH];
    float axis_x[LIGHT_TREE_WIDTH], axis_y[LIGHT_TREE_WIDTH], axis_z[LIGHT_TREE_WIDTH];
    float cos_theta_o[LIGHT_TREE_WIDTH], sin_theta_o[LIGHT_TREE_WIDTH], cos_theta_e[LIGHT_TREE_WIDTH];
    float both_sides[LIGHT_TREE_WIDTH]; /* 1: it emits as much on the back as on the front; else 0 */
    float least[LIGHT_TREE_WIDTH];      /* least factor that directions may lower its weight to */
    float constant[LIGHT_TREE_WIDTH], intensity[LIGHT_TREE_WIDTH];
    float soft2[LIGHT_TREE_WIDTH];      /* added to the squared distance: radius^2 + intensity / peak */
    float power[LIGHT_TREE_WIDTH];      /* the weight where all others are 0 */
    int child[LIGHT_TREE_WIDTH];        /* index of a node, or -1 - light */
    int count;
    int parent;                         /* a place: node * LIGHT_TREE_WIDTH + child */
} LightTreeNode;

struct LightTree {
    LightTreeNode *nodes; /* the first has one child, the whole */
    int *places;          /* by light: its place, as LightTreeNode.parent */
};

#endif
