/* Random scenes of one CSG tree: intersections, differences, merges and unions of all shapes that have an inside and of
 * open ones, with clips and with inverse, up to six deep; and their membership, by plain recursion. */
#ifndef LIB_CSG_TREE_H
#define LIB_CSG_TREE_H

#include "scene/scene.h"

enum { TREE_NODES_MOST = 4096 };

typedef enum TreeForm {
    FORM_SPHERE,
    FORM_BOX,
    FORM_PLANE,
    FORM_CONE,
    FORM_TORUS,
    FORM_DISC,
    FORM_TETRAHEDRON,
    FORM_WRITTEN, /* with more than numbers: one of a list of texts */
    TREE_FORMS
} TreeForm;
typedef enum TreeOperation { TREE_LEAF, TREE_UNION, TREE_INTERSECTION, TREE_DIFFERENCE, TREE_MERGE } TreeOperation;

typedef struct TreeNode {
    TreeOperation operation;
    int inverse;
    struct TreeNode *parent, *children[4], *clip;
    int nchildren;
    /* of a leaf */
    TreeForm form;
    double r0, r1;
    int open, number; /* number: as the scene counts primitives; -1 in a clip */
    Transform place;
    Primitive solid; /* of what is written: the shape where it is */
} TreeNode;

typedef struct CsgTree {
    TreeNode nodes[TREE_NODES_MOST]; /* the first is the root */
    TreeNode *leaves[TREE_NODES_MOST];
    int nnodes, nleaves, plain; /* plain: closed shapes and no unions only */
    double size;                /* of shapes; they lie within it about centre */
    Vec3 centre;
} CsgTree;

extern CsgTree tree; /* the last that was made */

/* Writes a tree and reads it as a scene, which the caller closes. The same seed makes the same. */
Scene *tree_make(uint32_t seed);

Vec3 tree_solve(const Transform *t, Vec3 v);               /* the solution of m x = v, by Cramer's rule */
Vec3 tree_canonical(const TreeNode *leaf, Vec3 p);         /* p in the space of the leaf's shape */
int tree_contains(const TreeNode *n, int inverse, Vec3 p); /* inverse: of what is around it */
int tree_written_contains(const TreeNode *leaf, Vec3 p);   /* by the shape's own operation */
int tree_siblings_allow(const TreeNode *leaf, Vec3 p);     /* whether a crossing of the leaf at p is on the result */
int tree_is_by_steps(
    const TreeNode *leaf); /* whether thin parts may be passed over, as the precision of a Julia set says */

#endif
