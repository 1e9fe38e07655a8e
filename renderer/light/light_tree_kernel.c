/* Going down the light tree. */
#include <string.h>
#include <retex/host/assert.h>
#include "base/color4.h"
#include "light/light_tree_nodes.h"

#define WIDTH LIGHT_TREE_WIDTH
#define SLACK .01f /* of cosines: for the rounding of bounds; no weight is lowered by less than this */

typedef int Int4 __attribute__((vector_size(16)));

/* A LightSampleContext in floats. */
typedef struct Lit {
    float x, y, z, normal_x, normal_y, normal_z;
    float any_side; /* 1: there is no normal */
} Lit;

static Lit light_sample_context(const LightSampleContext *p)
{
    return (Lit){(float)p->position.x,
                 (float)p->position.y,
                 (float)p->position.z,
                 (float)p->normal.x,
                 (float)p->normal.y,
                 (float)p->normal.z,
                 vec_dot(p->normal, p->normal) > 0 ? 0.0f : 1.0f};
}

static inline Float4 choose(Int4 which, Float4 yes, Float4 no)
{
    return (Float4)(((Int4)yes & which) | ((Int4)no & ~which));
}

static inline Float4 larger(Float4 a, Float4 b)
{
    return choose(a > b, a, b);
}

/* Estimate the irradiance of four children: with bounds of directions, and distances from their centres. */
static inline Float4 weigh_four(const LightTreeNode *n, const Lit *p, int k)
{
    const Float4 zero = splat(0), one = splat(1), slack = splat(SLACK);
    Float4 x = load(n->x + k) - splat(p->x), y = load(n->y + k) - splat(p->y), z = load(n->z + k) - splat(p->z);
    Float4 d2 = x * x + y * y + z * z, inverse = one / root(larger(d2, splat(1e-30f)));
    /* half-angle that the cluster is seen in; from inside it is everywhere */
    Float4 sine = load(n->radius + k) * inverse;
    Int4 outside = sine < one;
    Float4 sin_bound = choose(outside, sine, zero);
    Float4 cos_bound = choose(outside, root(one - sin_bound * sin_bound), splat(-1));
    /* least angle between a light's normal and the direction from it to the point */
    Float4 c = -(x * load(n->axis_x + k) + y * load(n->axis_y + k) + z * load(n->axis_z + k)) * inverse;
    c = choose((load(n->both_sides + k) > zero) & (c < zero), -c, c);
    Float4 cos_theta_o = load(n->cos_theta_o + k), sin_theta_o = load(n->sin_theta_o + k);
    Float4 s = root(larger(one - c * c, zero));
    Int4 within = c >= cos_theta_o;
    Float4 c2 = choose(within, one, c * cos_theta_o + s * sin_theta_o);
    Float4 s2 = choose(within, zero, s * cos_theta_o - c * sin_theta_o);
    Float4 facing = choose(c2 >= cos_bound, one, c2 * cos_bound + s2 * sin_bound);
    Float4 shines = choose(facing > load(n->cos_theta_e + k) - slack, larger(facing, slack), zero);
    shines = larger(shines, load(n->least + k));
    /* least angle to the point's own normal */
    Float4 h = (x * splat(p->normal_x) + y * splat(p->normal_y) + z * splat(p->normal_z)) * inverse;
    Float4 above = choose(h >= cos_bound, one, h * cos_bound + root(larger(one - h * h, zero)) * sin_bound);
    Float4 lit = choose(above > -slack, larger(above, slack), zero);
    lit = larger(lit, splat(p->any_side));
    return shines * lit * (load(n->constant + k) + load(n->intensity + k) / (d2 + load(n->soft2 + k)));
}

/* Weights of the choice; returns their sum. */
static float choice_weights(const LightTreeNode *n, const Lit *p, float *weights)
{
    float sum = 0;
    for (int k = 0; k < WIDTH; k += 4) {
        Float4 four = weigh_four(n, p, k);
        memcpy(weights + k, &four, sizeof four);
        sum += four[0] + four[1] + four[2] + four[3];
    }
    if (sum > 0)
        return sum;
    /* no child can light the point, as the bounds of their parents were too wide; but one must be chosen */
    for (int k = 0; k < n->count; k++)
        sum += weights[k] = n->power[k];
    for (int k = 0; k < n->count && !(sum > 0); k++)
        weights[k] = 1;
    return sum > 0 ? sum : (float)n->count;
}

int light_tree_pick(const LightTree *tree, const LightSampleContext *point, double *u, float *probability)
{
    Lit p = light_sample_context(point);
    int index = tree->nodes[0].child[0];
    *probability = 1;
    while (index >= 0) {
        const LightTreeNode *n = &tree->nodes[index];
        float weights[WIDTH], sum = choice_weights(n, &p, weights);
        double at = *u * sum;
        int k = 0, last = n->count - 1;
        while (last > 0 && !(weights[last] > 0))
            last--;
        while (k < last && at >= weights[k])
            at -= weights[k++];
        RETEX_ASSERT(k < n->count); /* the others are not there */
        *u = fmin(at / weights[k], 1 - 0x1p-53);
        *probability *= weights[k] / sum;
        index = n->child[k];
    }
    return -1 - index;
}

float light_tree_probability(const LightTree *tree, const LightSampleContext *point, int light)
{
    Lit p = light_sample_context(point);
    float probability = 1;
    for (int place = tree->places[light]; place >= WIDTH; place = tree->nodes[place / WIDTH].parent) {
        float weights[WIDTH], sum = choice_weights(&tree->nodes[place / WIDTH], &p, weights);
        RETEX_ASSERT(place % WIDTH < tree->nodes[place / WIDTH].count);
        probability *= weights[place % WIDTH] / sum;
    }
    return probability;
}

float light_tree_estimate(const LightTree *tree, const LightSampleContext *point)
{
    Lit p = light_sample_context(point);
    return weigh_four(&tree->nodes[0], &p, 0)[0];
}
