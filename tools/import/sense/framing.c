/* Views of a scene that are none of the model's cameras: from inside of a room, from outside, from where one says. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/sense/sense.h"
#include "import/space/room.h"
#include "import/space/space.h"

typedef struct Framing {
    double at[3], to[3], angle;
} Framing;

/* ---- a place that is given ---- */

static int take_point(const char **text, double point[3])
{
    for (int k = 0; k < 3; k++) {
        char *end;
        point[k] = strtod(*text, &end);
        if (end == *text || !(fabs(point[k]) < 1e15) || (k < 2 && *end != ','))
            return 0;
        *text = end + (k < 2);
    }
    return 1;
}

/* X,Y,Z:X,Y,Z[:ANGLE]. Returns 0 where it is not that. */
static int take_place(const char *text, Framing *framing)
{
    char *end;
    framing->angle = 70;
    if (!take_point(&text, framing->at) || *text++ != ':' || !take_point(&text, framing->to))
        return 0;
    if (!*text)
        return 1;
    if (*text++ != ':')
        return 0;
    framing->angle = strtod(text, &end);
    return end != text && !*end;
}

int framing_is_asked(const Import *import, int *is_asked, RetexError *err)
{
    const char *asked = import->options->camera;
    Framing framing;
    *is_asked = 0;
    if (!asked)
        return RETEX_OK;
    *is_asked = sense_camera_is(import, "inside") || sense_camera_is(import, "outside") ||
                sense_camera_is(import, "cutaway");
    if (*is_asked || !strchr(asked, ':') || !take_place(asked, &framing))
        return RETEX_OK;
    *is_asked = 1;
    if (!(framing.angle >= 1 && framing.angle <= 170))
        return retex_fail(err, RETEX_EINVAL, "--camera %s: expected an angle from 1 to 170 degrees", asked);
    if (memcmp(framing.at, framing.to, sizeof framing.at) == 0)
        return retex_fail(err, RETEX_EINVAL, "--camera %s: the camera is where it looks at", asked);
    return RETEX_OK;
}

/* ---- from outside ---- */

/* How far a ray goes through the bounds, in and out. Returns 0 where it misses them. */
static int cross_bounds(const double low[3], const double high[3], const double from[3], const double direction[3],
                        double range[2])
{
    range[0] = 0, range[1] = INFINITY;
    for (int k = 0; k < 3; k++) {
        if (fabs(direction[k]) < 1e-9) {
            if (from[k] < low[k] || from[k] > high[k])
                return 0;
            continue;
        }
        const double a = (low[k] - from[k]) / direction[k], b = (high[k] - from[k]) / direction[k];
        range[0] = fmax(range[0], fmin(a, b)), range[1] = fmin(range[1], fmax(a, b));
    }
    return range[1] > range[0];
}

/* How deep one sees into the model from a side, as a share of its bounds. */
static double depth_from(const Space *space, const double side[3])
{
    enum { RAYS = 28 };
    double low[3], high[3], middle[3], radius = 0, right[3] = {-side[2], 0, side[0]}, up[3], sum = 0;
    int count = 0;
    space_bounds(space, low, high);
    for (int k = 0; k < 3; k++) {
        middle[k] = (low[k] + high[k]) / 2;
        radius += pow((high[k] - low[k]) / 2, 2);
    }
    radius = sqrt(radius);
    const double wide = hypot(right[0], right[2]);
    right[0] /= wide, right[2] /= wide;
    for (int k = 0; k < 3; k++)
        up[k] = side[(k + 1) % 3] * right[(k + 2) % 3] - side[(k + 2) % 3] * right[(k + 1) % 3];
    for (int i = 0; i < RAYS * RAYS; i++) {
        const double u = (2 * (i % RAYS + 0.5) / RAYS - 1) * radius, v = (2 * (i / RAYS + 0.5) / RAYS - 1) * radius;
        const double direction[3] = {-side[0], -side[1], -side[2]};
        double from[3], range[2];
        SpaceHit hit;
        for (int k = 0; k < 3; k++)
            from[k] = middle[k] + u * right[k] + v * up[k] + 2 * radius * side[k];
        if (!cross_bounds(low, high, from, direction, range) || !space_ray(space, from, direction, 0, INFINITY, &hit))
            continue;
        sum += fmin(fmax((hit.t - range[0]) / (range[1] - range[0]), 0), 1), count++;
    }
    return count ? sum / count : 0;
}

/* From the right in front and above; from another side where one sees much more: into a room with an open side. */
static int choose_side(const Import *import, double side[3])
{
    enum { SIDES = 12 };
    const double usual[3] = {0.45, 0.35, -0.82}, level = hypot(usual[0], usual[2]);
    memcpy(side, usual, sizeof usual);
    if (!import->sense || !import->sense->space)
        return 0;
    const double first = depth_from(import->sense->space, usual);
    const int has_walls = import->sense->room.is_found && import->sense->room.enclosed > 0.6;
    double best = first * (has_walls ? 1.08 : 1.3) + 0.02;
    int is_other = 0;
    for (int i = 1; i < SIDES; i++) {
        const double a = atan2(usual[2], usual[0]) + 2 * PI * i / SIDES;
        const double other[3] = {level * cos(a), usual[1], level * sin(a)};
        const double depth = depth_from(import->sense->space, other);
        if (depth <= best)
            continue;
        best = depth, is_other = 1;
        memcpy(side, other, sizeof other);
    }
    return is_other;
}

/* How far from its middle the corners of a box are all in the picture, with a margin. back: of unit length. */
static double distance_to_fit(const double low[3], const double high[3], const double back[3], double angle)
{
    const double across = tan(angle / 2 * PI / 180) * 0.9, along = across * 3 / 4, level = hypot(back[0], back[2]);
    const double right[3] = {-back[2] / level, 0, back[0] / level};
    const double up[3] = {-back[1] * right[2], back[0] * right[2] - back[2] * right[0], back[1] * right[0]};
    double distance = 0;
    for (int corner = 0; corner < 8; corner++) {
        double x = 0, y = 0, z = 0;
        for (int k = 0; k < 3; k++) {
            const double half = (high[k] - low[k]) / 2, c = corner >> k & 1 ? half : -half;
            x += c * right[k], y += c * up[k], z += c * back[k];
        }
        distance = fmax(distance, z + fmax(fabs(x) / across, fabs(y) / along));
    }
    return distance;
}

void framing_fit(const double low[3], const double high[3], const double side[3], double angle, double eye[3],
                 double target[3])
{
    const double length = sqrt(side[0] * side[0] + side[1] * side[1] + side[2] * side[2]);
    const double back[3] = {side[0] / length, side[1] / length, side[2] / length};
    const double distance = distance_to_fit(low, high, back, angle);
    for (int k = 0; k < 3; k++) {
        target[k] = low[k] + (high[k] - low[k]) / 2;
        eye[k] = target[k] + back[k] * distance;
    }
}

/* So that the scene fills the picture. Returns 1 if it is not the usual side. */
static int frame_outside(const Import *import, Framing *framing)
{
    double side[3];
    const int is_other = choose_side(import, side);
    framing->angle = 40;
    framing_fit(import->low, import->high, side, framing->angle, framing->at, framing->to);
    return is_other;
}

static void frame_cutaway(const Cutaway *cutaway, Framing *framing)
{
    memcpy(framing->at, cutaway->eye, sizeof framing->at);
    memcpy(framing->to, cutaway->target, sizeof framing->to);
    framing->angle = cutaway->angle;
}

/* ---- from inside ---- */

/* Returns 0 where there is no place for it. */
static int frame_inside(const Import *import, Framing *framing, RoomView *view, RetexError *err)
{
    const Sense *sense = import->sense;
    if (!sense || !sense->space || sense->room.is_solid || !room_view(&sense->room, view, err))
        return 0;
    for (int k = 0; k < 3; k++) {
        framing->at[k] = view->eye[k] * sense->scale;
        framing->to[k] = view->target[k] * sense->scale;
    }
    framing->angle = view->angle;
    return 1;
}

/* What was chosen, and why. */
static void tell(const Import *import, const Framing *f, const char *where, const char *more)
{
    const char *asked = import->options->camera;
    const int is_asked = asked && strcmp(asked, "auto") != 0;
    import_tell(import, IMPORT_INFO, "%s%s, from %.4g,%.4g,%.4g to %.4g,%.4g,%.4g, %g degrees%s",
                is_asked ? "" : "no camera in the model: ", where, f->at[0], f->at[1], f->at[2], f->to[0], f->to[1],
                f->to[2], f->angle, more);
}

static void tell_inside(const Import *import, const Framing *f, const RoomView *view)
{
    const Room *room = &import->sense->room;
    char where[120], more[120];
    if (room->is_closed)
        snprintf(where, sizeof where, "walls are on %.0f %% of all sides: the view is from inside",
                 100 * room->enclosed);
    else
        snprintf(where, sizeof where, "the view is from inside");
    snprintf(more, sizeof more, "; %.3g above the floor; %.0f %% of it is furniture, %.0f %% floor",
             room->eye * import->sense->scale, 100 * view->furniture, 100 * view->floor);
    tell(import, f, where, more);
}

static void tell_cutaway(const Import *import, const Framing *f)
{
    char more[120];
    snprintf(more, sizeof more, "; %ld triangle%s before the rooms %s left out", import->cutaway->count,
             import->cutaway->count == 1 ? "" : "s", import->cutaway->count == 1 ? "is" : "are");
    tell(import, f, "the view is into the rooms from above", more);
}

static void tell_outside(const Import *import, const Framing *f, int is_other)
{
    tell(import, f, is_other ? "the view is from outside, on the side that is open" : "the view is from outside", "");
}

/* ---- */

static int frame(const Import *import, Framing *framing, RetexError *err)
{
    const Room *room = import->sense ? &import->sense->room : NULL;
    const char *asked = import->options->camera;
    const int is_asked = sense_camera_is(import, "inside");
    RetexError why = {0};
    RoomView view;
    if (asked && strchr(asked, ':') && take_place(asked, framing))
        return RETEX_OK;
    if (import->cutaway) {
        frame_cutaway(import->cutaway, framing);
        tell_cutaway(import, framing);
        return RETEX_OK;
    }
    if (room && (is_asked || (room->is_closed && !sense_camera_is(import, "outside"))) &&
        frame_inside(import, framing, &view, &why)) {
        tell_inside(import, framing, &view);
        return RETEX_OK;
    }
    if (why.code)
        return retex_fail(err, why.code, "%s", why.message);
    if (is_asked)
        return retex_fail(err, RETEX_ENOTFOUND, "--camera inside: %s: no place above a floor is free",
                          import->options->model);
    const int is_other = frame_outside(import, framing);
    tell_outside(import, framing, is_other);
    return RETEX_OK;
}

int framing_write(Import *import, FILE *out, RetexError *err)
{
    Framing framing;
    const int code = frame(import, &framing, err);
    if (code)
        return code;
    memcpy(import->eye, framing.at, sizeof import->eye);
    import_tell(import, IMPORT_FRAMED, "%s", "");
    fprintf(out, "camera {\n");
    vector_print(out, "  location ", framing.at, "\n");
    fprintf(out, "  right x * 4/3\n  up y\n  angle %g\n", framing.angle);
    vector_print(out, "  look_at ", framing.to, "\n");
    fprintf(out, "}\n\n");
    return RETEX_OK;
}
