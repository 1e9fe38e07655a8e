/* See view.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "camera/view.h"

static int take_point(const char **text, Vec3 *point)
{
    double at[3];
    for (int k = 0; k < 3; k++) {
        char *end;
        at[k] = strtod(*text, &end);
        if (end == *text || !(fabs(at[k]) < 1e15) || (k < 2 && *end != ','))
            return 0;
        *text = end + (k < 2);
    }
    *point = vec3(at[0], at[1], at[2]);
    return 1;
}

static int take_view(CameraView *view, const char *text)
{
    char *end;
    view->angle = 0;
    if (!take_point(&text, &view->eye) || *text++ != ':' || !take_point(&text, &view->at))
        return 0;
    if (!*text)
        return 1;
    if (*text++ != ':')
        return 0;
    view->angle = strtod(text, &end);
    return end != text && !*end && view->angle >= 1 && view->angle <= 170;
}

int camera_view_read(CameraView *view, const char *text, RetexError *err)
{
    if (!strchr(text, ':'))
        return retex_fail(err, RETEX_ENOTFOUND, "camera `%.100s`: expected X,Y,Z:X,Y,Z[:ANGLE]", text);
    if (!take_view(view, text))
        return retex_fail(err, RETEX_EINVAL,
                          "camera `%.100s`: expected X,Y,Z:X,Y,Z[:ANGLE], where it is, what it looks at, and an angle "
                          "from 1 to 170 degrees",
                          text);
    if (vec_length(vec_sub(view->at, view->eye)) == 0)
        return retex_fail(err, RETEX_EINVAL, "camera `%.100s`: it is where it looks at", text);
    return RETEX_OK;
}

double camera_angle(const Camera *camera)
{
    const double right = camera->ops == &camera_perspective ? vec_length(camera->right) : 1.33,
                 direction = camera->ops == &camera_perspective ? vec_length(camera->direction) : 1;
    return 360 / PI * atan2(right / 2, direction);
}

Camera camera_look(const Camera *from, const CameraView *view, double aspect)
{
    const Vec3 towards = vec_normalize(vec_sub(view->at, view->eye));
    const int is_right = vec_dot(vec_cross(from->up, from->direction), from->right) > 0;
    const double angle = view->angle > 0 ? view->angle : camera_angle(from);
    Vec3 side = vec_cross(from->sky, towards);
    if (vec_length(side) < 1e-10) { /* along the sky */
        const Vec3 kept = vec_scale(from->right, is_right ? 1 : -1);
        side = vec_sub(kept, vec_scale(towards, vec_dot(kept, towards)));
    }
    if (vec_length(side) < 1e-10) {
        Vec3 unused;
        vec_frame(towards, &side, &unused);
    }
    side = vec_normalize(side);
    return (Camera){.ops = &camera_perspective,
                    .location = view->eye,
                    .direction = vec_scale(towards, aspect / 2 / tan(angle * PI / 360)),
                    .right = vec_scale(side, is_right ? aspect : -aspect),
                    .up = vec_cross(towards, side),
                    .sky = from->sky,
                    .angle = angle,
                    .lens.focal_distance = 1};
}
