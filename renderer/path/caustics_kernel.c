/* Lobes of a cell of the guide to caustics: drawing a direction and its density. */
#include <string.h>
#include "base/color4.h"
#include "path/caustics_kernel.h"

/* Weights of four lobes at a point, given relative to where their photons landed. */
static inline Float4 weigh_four(const CausticsCell *c, int k, Float4 x, Float4 y, Float4 z)
{
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
        const float(*m)[CAUSTICS_LOBES] = c->move;
        Float4 ax = px - load(c->at_x + k), ay = py - load(c->at_y + k), az = pz - load(c->at_z + k);
        Float4 weight = weigh_four(c, k, ax, ay, az);
        Float4 x = load(c->x + k) + load(m[0] + k) * ax + load(m[1] + k) * ay + load(m[2] + k) * az - px;
        Float4 y = load(c->y + k) + load(m[3] + k) * ax + load(m[4] + k) * ay + load(m[5] + k) * az - py;
        Float4 z = load(c->z + k) + load(m[6] + k) * ax + load(m[7] + k) * ay + load(m[8] + k) * az - pz;
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
        Float4 four = weigh_four(c, k, px - load(c->at_x + k), py - load(c->at_y + k), pz - load(c->at_z + k));
        memcpy(weights + k, &four, sizeof four);
        sum += sum_four(four);
    }
    int k = 0;
    u *= sum;
    while (k < c->nlobes - 1 && u >= weights[k])
        u -= weights[k++];
    return k;
}

/* As caustics_density computes it: in floats. */
static Vec3 lobe_direction(const CausticsCell *c, int k, Vec3 position)
{
    const float p[3] = {(float)position.x, (float)position.y, (float)position.z};
    const float d[3] = {p[0] - c->at_x[k], p[1] - c->at_y[k], p[2] - c->at_z[k]};
    const float center[3] = {c->x[k], c->y[k], c->z[k]};
    float to[3];
    for (int i = 0; i < 3; i++)
        to[i] =
            center[i] + c->move[3 * i][k] * d[0] + c->move[3 * i + 1][k] * d[1] + c->move[3 * i + 2][k] * d[2] - p[i];
    return vec3((double)to[0], (double)to[1], (double)to[2]);
}

Vec3 caustics_sample(const CausticsCell *c, Vec3 position, float u_lobe, float u1, float u2)
{
    int k = pick_lobe(c, position, u_lobe);
    Vec3 axis = vec_normalize(lobe_direction(c, k, position));
    Vec3 s, t;
    double concentration = c->concentration[k], sine, cosine;
    double less = 2 * u1 / (1 + 2 * concentration * (1 - u1)); /* 1 - cos */
    double across = sqrt(less * (2 - less));
    turn_sincos(u2, &sine, &cosine);
    vec_frame(axis, &s, &t);
    return vec_mad(vec_mad(vec_scale(axis, 1 - less), s, across * cosine), t, across * sine);
}
