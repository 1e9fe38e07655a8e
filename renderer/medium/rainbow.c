/* Rainbows, by POV-Ray 3.7's manual; how they mix was measured in its pictures. */
#include "medium/rainbow.h"
#include "shade/pigment.h"

/* How much of the bow there is at a direction, by the angle round the bow's middle: its ends fade smoothly. */
static double arc_share(const Rainbow *bow, Vec3 direction)
{
    const double x = vec_dot(direction, bow->right), y = vec_dot(direction, bow->up);
    const double angle = fabs(atan2(x, y));
    if (angle > bow->arc)
        return 0;
    if (angle <= bow->falloff || bow->falloff >= bow->arc)
        return 1;
    const double t = (bow->arc - angle) / (bow->arc - bow->falloff);
    return t * t * (3 - 2 * t);
}

/* The colour at a direction. Returns 0 where the bow is not. */
static int bow_color(const Rainbow *bow, Vec3 direction, double u, Rgbft *color)
{
    const double cosine = vec_dot(direction, bow->direction);
    if (cosine < 0)
        return 0;
    const double angle = acos(fmin(1, cosine));
    const double index = (angle - bow->angle) / bow->width + 0.5 + bow->jitter * (2 * u - 1);
    if (!(index >= 0 && index < 1 - 1e-9))
        return 0;
    *color = pigment_eval(bow->colors, vec3(index, 0, 0), (Vec2){0, 0});
    return 1;
}

/* The mean of all bows that are there. */
int rainbow_transmittance(const Scene *scene, const Ray *ray, double distance, double u, Rgb *passing, Rgb *own)
{
    int count = 0;
    Rgbft c;
    *passing = *own = rgb_grey(0);
    for (const Rainbow *bow = scene->rainbows; bow; bow = bow->next) {
        const double share = arc_share(bow, ray->direction);
        if (!(share > 0) || !bow_color(bow, ray->direction, u, &c))
            continue;
        const float hidden = (float)(share * (1 - fmax(exp(-distance / bow->distance), (double)c.transmit)));
        const Rgb color = rgb(c.r, c.g, c.b);
        *own = rgb_add(*own, rgb_scale(color, hidden));
        *passing = rgb_add(*passing, rgb_scale(rgb_lerp(rgb_grey(1), color, c.filter * hidden), 1 - hidden));
        count++;
    }
    if (count == 0)
        return 0;
    *own = rgb_scale(*own, 1 / (float)count), *passing = rgb_scale(*passing, 1 / (float)count);
    return 1;
}
