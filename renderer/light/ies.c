/* Light distributions: the share of a direction, and how the luminaire hangs. */
#include "light/ies.h"

/* The lower one of the two rising numbers that x lies between, and how far it is to the upper one, 0 to 1. */
static int interval(const double *numbers, int n, double x, double *part)
{
    int low = 0, high = n - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (numbers[middle] <= x)
            low = middle;
        else
            high = middle;
    }
    *part = (x - numbers[low]) / (numbers[high] - numbers[low]);
    return low;
}

/* The horizontal angle of the file that has the same light. */
static double folded(IesSymmetry symmetry, double angle)
{
    switch (symmetry) {
    case IES_QUARTERS:
        angle = angle > 180 ? 360 - angle : angle;
        return angle > 90 ? 180 - angle : angle;
    case IES_HALVES:
        return angle > 180 ? 360 - angle : angle;
    case IES_ACROSS:
        return angle < 90 ? 180 - angle : angle > 270 ? 540 - angle : angle;
    default:
        return angle;
    }
}

static double share_of_column(const Ies *ies, int column, int k, double part)
{
    const float *shares = ies->shares + (size_t)(column % ies->ncolumns) * (size_t)ies->nvertical + k;
    return (1 - part) * (double)shares[0] + part * (double)shares[1];
}

double ies_share(const Ies *ies, double vertical, double horizontal)
{
    double up, round;
    if (!(vertical >= ies->vertical[0] && vertical <= ies->vertical[ies->nvertical - 1]))
        return 0;
    const int k = interval(ies->vertical, ies->nvertical, vertical, &up);
    if (ies->symmetry == IES_AXIAL)
        return share_of_column(ies, 0, k, up);
    const int column = interval(ies->horizontal, ies->nhorizontal, folded(ies->symmetry, horizontal), &round);
    return (1 - round) * share_of_column(ies, column, k, up) + round * share_of_column(ies, column + 1, k, up);
}

/* ---- how it hangs ---- */

/* A direction of a luminaire that hangs, where its axis, straight down, is tilted to another one the shortest way. */
static Vec3 tilted(Vec3 d, Vec3 axis)
{
    const Vec3 about = vec_cross(vec3(0, -1, 0), axis);
    if (1 - axis.y < 1e-9)
        return vec3(d.x, -d.y, -d.z); /* straight up: about x */
    return vec_add(vec_mad(vec_scale(d, -axis.y), about, vec_dot(about, d) / (1 - axis.y)), vec_cross(about, d));
}

void ies_place(Light *light, Vec3 axis, const Transform *to_world)
{
    const double turn = light->ies_turn * PI / 180, c = cos(turn), s = sin(turn);
    const Vec3 along = transform_vector(to_world, tilted(vec3(c, 0, s), axis));
    const Vec3 across = transform_vector(to_world, tilted(vec3(-s, 0, c), axis));
    Vec3 *axes = light->ies_axes;
    axes[2] = vec_normalize(transform_vector(to_world, axis));
    axes[0] = vec_normalize(vec_mad(along, axes[2], -vec_dot(along, axes[2])));
    axes[1] = vec_cross(axes[2], axes[0]);
    if (vec_dot(axes[1], across) < 0) /* the light source is mirrored */
        axes[1] = vec_neg(axes[1]);
}

double ies_light_share(const Light *light, Vec3 direction)
{
    const Vec3 *axes = light->ies_axes;
    const double x = vec_dot(direction, axes[0]), y = vec_dot(direction, axes[1]), z = vec_dot(direction, axes[2]);
    const double vertical = atan2(sqrt(x * x + y * y), z) * 180 / PI;
    if (light->ies->symmetry == IES_AXIAL)
        return ies_share(light->ies, vertical, 0);
    const double horizontal = atan2(y, x) * 180 / PI;
    return ies_share(light->ies, vertical, horizontal < 0 ? horizontal + 360 : horizontal);
}

double ies_light_cone(const Light *light, Vec3 *axis)
{
    const Ies *ies = light->ies;
    const int is_up = ies->first_lit > 180 - ies->last_lit;
    *axis = is_up ? vec_neg(light->ies_axes[2]) : light->ies_axes[2];
    return (is_up ? 180 - ies->first_lit : ies->last_lit) * PI / 180;
}
