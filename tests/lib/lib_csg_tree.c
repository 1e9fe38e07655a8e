/* See lib_csg_tree.h. */
#include "lib_csg_tree.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib_random_scene.h"
#include "lib_scene_text.h"
#include <cmocka.h>

enum { DEEPEST = 6, TEXT = 4 << 20 };

/* ---- shapes with more than numbers ---- */

static const char *const texts[] = {
    "superellipsoid{<0.3,0.6>",
    "superellipsoid{<2.5,0.5>",
    "ovus{0.6,0.4",
    "lathe{cubic_spline 8, <0,-1.1>, <0,-1>, <0.3,-0.8>, <1,-0.3>, <0.4,0.2>, <0.7,0.9>, <0,1.2>, <0,1.3>",
    "prism{conic_sweep 0.2, 1, 5, <-1,-1>, <1,-0.8>, <0.2,0>, <0.5,1>, <-1,-1>",
    "prism{linear_sweep quadratic_spline -.5, .5, 6, <0,-.5>, <-1,-1>, <1,-0.8>, <0.2,0>, <0.5,1>, <-1,-1>",
    "sor{5, <0.1,-1.3>, <0.8,-1>, <0.3,-0.2>, <0.9,0.5>, <0.2,1>",
    "sphere_sweep{b_spline 5, <-2,0,0>, 0.3, <-1,1,0>, 0.2, <0,-1,1>, 0.3, <1,1,0>, 0.1, <2,0,1>, 0.3",
    "blob{threshold .6 sphere{<-.5,0,0>,1,1} sphere{<.5,.2,0>,.8,1} cylinder{<0,-1,0>,<0,1,.3>,.5,1} "
    "sphere{<0,0,-.5>,.5,-1}",
    "text{ttf \"timrom.ttf\" \"B\" .4,0",
    "height_field{function 20,20{.5+.3*sin(9*x)*cos(7*y)} water_level .2",
    "julia_fractal{<-.083,0,-.83,-.025> max_iteration 5 precision 60",
    "isosurface{function{x*x+y*y*1.5+z*z*z*z-.5+.1*sin(9*x)} contained_by{box{-1,1}} max_gradient 8 accuracy 1e-9 "
    "all_intersections",
    "quadric{<1,1,1>, <0,0.2,0>, <0,0,0.3>, -0.6",
    "poly{4, <1,0,0,0,0,0,0,0,0,-1,0,0,0,0,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,1,0,0,0,-.1>",
};
enum { TEXTS = sizeof texts / sizeof *texts };
static Scene *written; /* all of them */

static void parse_texts(void)
{
    static char all[8192] = V37;

    for (int i = 0; i < TEXTS; i++)
        strcat(strcat(all, texts[i]), "}\n");
    written = parse(all);
    assert_int_equal(written->nprimitives, TEXTS);
}

/* ---- trees ---- */

CsgTree tree;
static char *text, *end; /* the scene, as it is written */

static void write_text(const char *format, ...) RETEX_PRINTF(1, 2);
static void write_text(const char *format, ...)
{
    va_list args;

    va_start(args, format);
    end += vsnprintf(end, (size_t)(text + TEXT - end), format, args);
    va_end(args);
    assert_true(end < text + TEXT - 1000);
}

static Transform random_place(void)
{
    Transform t = transform_scale(vec3(1, 1, 1));
    double scale = tree.size * random_between(0.2, 1);

    if (random_chance(0.5))
        t = transform_scale(vec3(random_between(0.3, 1.5), -random_between(0.3, 1.5), random_between(0.3, 1.5)));
    t = transform_then(t, transform_scale(vec3(scale, scale, scale)));
    if (random_chance(0.8))
        t = transform_then(t, transform_rotate(vec_scale(random_direction(), 180)));
    return transform_then(
        t, transform_translate(vec_mad(tree.centre, random_direction(), tree.size * random_between(0, 1))));
}

static void write_leaf(TreeNode *n)
{
    const double(*m)[4] = n->place.m;

    if (n->form == FORM_WRITTEN)
        write_text("%s ", texts[n->solid.line]);
    else if (n->form == FORM_SPHERE)
        write_text("sphere{0,1 ");
    else if (n->form == FORM_BOX)
        write_text("box{0,1 ");
    else if (n->form == FORM_PLANE)
        write_text("plane{y,0 ");
    else if (n->form == FORM_CONE)
        write_text("cone{0,%.17g,z,%.17g %s ", n->r0, n->r1, n->open ? "open" : "");
    else if (n->form == FORM_TORUS)
        write_text("torus{%.17g,%.17g ", n->r0, n->r1);
    else if (n->form == FORM_DISC)
        write_text("disc{0,z,%.17g,%.17g ", n->r0, n->r1);
    else
        write_text("mesh{triangle{0,y,x} triangle{0,z,y} triangle{0,x,z} triangle{x,y,z} %s ",
                   n->open ? "" : "inside_vector y");
    write_text("matrix<");
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++)
            write_text("%s%.17g", k + i ? "," : "", m[i][k]);
    write_text(">");
}

static void make_leaf(TreeNode *n, int clipping)
{
    n->form = (TreeForm)random_below(TREE_FORMS);
    n->place = random_place();
    n->r0 = random_between(0.3, 1), n->r1 = random_between(0.1, 1);
    n->open = random_chance(0.4);
    if (n->form == FORM_CONE && random_chance(0.3)) /* about z: frames of other axes are the parser's own */
        n->r1 = n->r0;
    if (n->form == FORM_DISC)
        n->r1 = random_chance(0.5) ? 0 : n->r0 * random_between(0.1, 0.8);
    if (n->form == FORM_TORUS)
        n->r1 = n->r0 * random_between(0.1, 0.9);
    if (n->form == FORM_WRITTEN) {
        const int which = random_below(TEXTS);
        n->solid = written->primitives[which];
        n->solid.transform = transform_then(n->solid.transform, n->place);
        n->solid.line = which;
        n->open = n->solid.shape.ops == &shape_height_field;
    }
    n->number = clipping ? -1 : tree.nleaves;
    if (!clipping)
        tree.leaves[tree.nleaves++] = n;
    tree.plain &= n->form != FORM_DISC &&
                  !((n->form == FORM_CONE || n->form == FORM_TETRAHEDRON || n->form == FORM_WRITTEN) && n->open);
    write_leaf(n);
}

static TreeNode *make_node(int depth, int clipping, TreeNode *parent)
{
    static const char *const words[] = {"", "union", "intersection", "difference", "merge"};
    TreeNode *n = &tree.nodes[tree.nnodes++];

    assert_true(tree.nnodes < TREE_NODES_MOST);
    *n = (TreeNode){.parent = parent, .operation = TREE_LEAF};
    if (depth > 0 && (!parent || random_chance(0.75))) {
        n->operation = (TreeOperation)(parent ? 1 + random_below(4) : 2 + random_below(3));
        tree.plain &= n->operation != TREE_UNION;
        write_text("%s{", words[n->operation]);
        n->nchildren = 2 + random_below(2);
        for (int i = 0; i < n->nchildren; i++)
            n->children[i] = make_node(depth - 1, clipping, n);
    } else {
        make_leaf(n, clipping);
    }
    n->inverse = parent && random_chance(0.15);
    write_text(n->inverse ? " inverse" : "");
    if (random_chance(0.1) && !clipping) {
        tree.plain = 0;
        write_text(" clipped_by{");
        n->clip = make_node(random_below(2), 1, NULL);
        write_text("}");
    }
    write_text("}\n");
    return n;
}

/* ---- a scene ---- */

Scene *tree_make(uint32_t seed)
{
    random_state = seed;
    if (!written)
        parse_texts();
    tree.nnodes = tree.nleaves = 0, tree.plain = 1;
    tree.size = pow(10, random_between(-3, 3));
    tree.centre = vec_scale(random_direction(), random_chance(0.5) ? 0 : tree.size * random_between(1, 20));
    end = text = malloc(TEXT);
    assert_non_null(text);
    write_text(V37 "camera{location <%.17g,%.17g,%.17g>}\n", tree.centre.x, tree.centre.y,
               tree.centre.z + 3 * tree.size);
    make_node(1 + random_below(DEEPEST), 0, NULL);
    Scene *scene = parse(text);
    free(text);
    assert_int_equal(scene->ncsgs, 1);
    assert_int_equal(scene->nprimitives, tree.nleaves);
    return scene;
}

/* ---- membership ---- */

Vec3 tree_solve(const Transform *t, Vec3 v)
{
    Vec3 a = {t->m[0][0], t->m[1][0], t->m[2][0]}, b = {t->m[0][1], t->m[1][1], t->m[2][1]},
         c = {t->m[0][2], t->m[1][2], t->m[2][2]}, bc = vec_cross(b, c);
    double d = vec_dot(a, bc);

    return vec3(vec_dot(v, bc) / d, vec_dot(vec_cross(c, a), v) / d, vec_dot(vec_cross(a, b), v) / d);
}

Vec3 tree_canonical(const TreeNode *n, Vec3 p)
{
    return tree_solve(&n->place, vec_sub(p, vec3(n->place.m[0][3], n->place.m[1][3], n->place.m[2][3])));
}

int tree_written_contains(const TreeNode *n, Vec3 p)
{
    const Transform *t = &n->solid.transform;
    Vec3 q = tree_solve(t, vec_sub(p, vec3(t->m[0][3], t->m[1][3], t->m[2][3])));

    return n->solid.shape.ops->inside(&n->solid.shape, q);
}

static int leaf_contains(const TreeNode *n, Vec3 p)
{
    Vec3 q = tree_canonical(n, p);

    if (n->form == FORM_WRITTEN)
        return tree_written_contains(n, p);
    switch (n->form) {
    case FORM_SPHERE:
        return vec_length(q) < 1;
    case FORM_BOX:
        return q.x > 0 && q.x < 1 && q.y > 0 && q.y < 1 && q.z > 0 && q.z < 1;
    case FORM_PLANE:
        return q.y < 0;
    case FORM_CONE:
        return q.z > 0 && q.z < 1 && hypot(q.x, q.y) < n->r0 + (n->r1 - n->r0) * q.z;
    case FORM_TORUS:
        return hypot(hypot(q.x, q.z) - n->r0, q.y) < n->r1;
    case FORM_DISC:
        return q.z < 0;
    default:
        return !n->open && q.x > 0 && q.y > 0 && q.z > 0 && q.x + q.y + q.z < 1;
    }
}

int tree_contains(const TreeNode *n, int inverse, Vec3 p)
{
    int all = 1, any = 0;

    inverse ^= n->inverse;
    if (n->clip && !tree_contains(n->clip, 0, p))
        return 0;
    if (n->operation == TREE_LEAF)
        return leaf_contains(n, p) ^ inverse;
    for (int i = 0; i < n->nchildren; i++) {
        int in = tree_contains(n->children[i], inverse ^ (n->operation == TREE_DIFFERENCE && i > 0), p);
        all &= in, any |= in;
    }
    return (n->operation == TREE_INTERSECTION || n->operation == TREE_DIFFERENCE) != inverse ? all : any;
}

/* What is around a node turns its children inside out. */
static int inverse_within(const TreeNode *n)
{
    int inverse = n->inverse;

    if (n->parent)
        inverse ^= inverse_within(n->parent) ^ (n->parent->operation == TREE_DIFFERENCE && n != n->parent->children[0]);
    return inverse;
}

int tree_siblings_allow(const TreeNode *leaf, Vec3 p)
{
    for (const TreeNode *n = leaf; n; n = n->parent) {
        const TreeNode *parent = n->parent;
        if (n->clip && !tree_contains(n->clip, 0, p))
            return 0;
        if (!parent)
            return 1;
        int inverse = inverse_within(parent),
            of_all = parent->operation == TREE_INTERSECTION || parent->operation == TREE_DIFFERENCE;
        if (parent->operation == TREE_UNION && !inverse)
            continue;
        for (int i = 0; i < parent->nchildren; i++) {
            const TreeNode *sibling = parent->children[i];
            int turned = inverse ^ (parent->operation == TREE_DIFFERENCE && i > 0);
            if (sibling != n && tree_contains(sibling, turned, p) != (of_all != inverse))
                return 0;
        }
    }
    return 1;
}

int tree_is_by_steps(const TreeNode *n)
{
    return n->form == FORM_WRITTEN && n->solid.shape.ops == &shape_julia_fractal;
}
