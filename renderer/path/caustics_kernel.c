/* Lobes of a cell of the guide to caustics: drawing a direction and its density. */
#include <string.h>
#include "base/color4.h"
#include "path/caustics.h"

/* Weights of four lobes at a point. */
static inline Float4 weigh_four(const CausticsCell *c, int k, Float4 px, Float4 py, Float4 pz)
{
    Float4 x = load(c->at_x + k) - px, y = load(c->at_y + k) - py, z = load(c->at_z + k) - pz;
    Float4 fall = splat(1) + load(c->narrow + k) * (x * x + y * y + z * z);
    return load(c->weight + k) / (fall * fall);
}

static inline float sum_four(Float4 v)
{
    return v[0] + v[1] + v[2] + v[3];
}

/* 1 - cos is half the squared distance of the unit vectors: that keeps its digits where the lobe is narrow. */
float caustics_density(const CausticsCell *c, Vec3 position, Vec3 direction)
{
    const Float4 one = splat(1), two = splat(2), half = splat(0.5f);
    Float4 px = splat((float)position.x), py = splat((float)position.y), pz = splat((float)position.z);
    Float4 dx = splat((float)direction.x), dy = splat((float)direction.y), dz = splat((float)direction.z);
    Float4 sum = splat(0), weights = splat(0);
    for (int k = 0; k < c->nlobes; k += 4) {
        Float4 weight = weigh_four(c, k, px, py, pz);
        Float4 x = load(c->x + k) - px, y = load(c->y + k) - py, z = load(c->z + k) - pz;
        Float4 inverse = one / root(x * x + y * y + z * z + splat(1e-30f));
        x = x * inverse - dx, y = y * inverse - dy, z = z * inverse - dz;
        Float4 concentration = load(c->concentration + k);
        Float4 fall = one + concentration * (x * x + y * y + z * z) * half;
        sum += weight * (one + two * concentration) / (fall * fall);
        weights += weight;
    }
    return sum_four(sum) / (sum_four(weights) * 4 * (float)PI);
}

/* Which lobe, by u in [0,1). */
static int pick_lobe(const CausticsCell *c, Vec3 position, float u)
{
    Float4 px = splat((float)position.x), py = splat((float)position.y), pz = splat((float)position.z);
    float weights[CAUSTICS_LOBES], sum = 0;
    for (int k = 0; k < c->nlobes; k += 4) {
        Float4 four = weigh_four(c, k, px, py, pz);
        memcpy(weights + k, &four, sizeof four);
        sum += sum_four(four);
    }
    int k = 0;
    u *= sum;
    while (k < c->nlobes - 1 && u >= weights[k])
        u -= weights[k++];
    return k;
}

Vec3 caustics_sample(const CausticsCell *c, Vec3 position, float u_lobe, float u1, float u2)
{
    int k = pick_lobe(c, position, u_lobe);
    /* the axis as caustics_density computes it: from a position in floats */
    Vec3 axis = vec_normalize(vec3((double)(c->x[k] - (float)position.x), (double)(c->y[k] - (float)position.y),
                                   (double)(c->z[k] - (float)position.z)));
    Vec3 s, t;
    double concentration = c->concentration[k], sine, cosine;
    double less = 2 * u1 / (1 + 2 * concentration * (1 - u1)); /* 1 - cos */
    double across = sqrt(less * (2 - less));
    turn_sincos(u2, &sine, &cosine);
    vec_frame(axis, &s, &t);
    return vec_mad(vec_mad(vec_scale(axis, 1 - less), s, across * cosine), t, across * sine);
}
