/* What a view shows: each sample of a small picture is a ray, of which one knows how far it goes, which object it meets
 * and what that is in a room. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "import/space/picture.h"
#include "import/space/space.h"

#define PI 3.14159265358979323846

double picture_metre(const Room *room)
{
    double low[3], high[3], size = 0;
    space_bounds(room->space, low, high);
    for (int k = 0; k < 3; k++)
        size = hypot(size, high[k] - low[k]);
    return room->metre > 0 ? fmin(room->metre, size / 4) : size / 4;
}

/* Things that are lower than the ceiling and stand under free space are furniture, whatever meshes they are of. */
static PictureKind kind_of(const Room *room, const SpaceHit *hit)
{
    const double above = (hit->point[1] - room->floor) / room->height, into = hit->is_front ? -0.6 : 0.6;
    const int is_level = fabs(hit->normal[1]) > 0.7;
    if (!room->is_found)
        return PICTURE_FURNITURE;
    if (above < 0.03 && is_level)
        return PICTURE_FLOOR;
    const int cell = room_cell_at(room, hit->point[0] + into * hit->normal[0] * room->cell,
                                  hit->point[2] + into * hit->normal[2] * room->cell);
    if (cell >= 0) {
        const double top = ((double)room->cells[cell].top - room->floor) / room->height;
        if (top > 0.06 && top < 0.8 && above < top + 0.03)
            return PICTURE_FURNITURE;
    }
    return is_level && above > 0.7 ? PICTURE_CEILING : PICTURE_WALL;
}

static unsigned char side_of(const double normal[3])
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        axis = fabs(normal[k]) > fabs(normal[axis]) ? k : axis;
    return (unsigned char)(2 * axis + (normal[axis] > 0));
}

PictureSample picture_sample(const Room *room, const double from[3], const double direction[3])
{
    PictureSample sample;
    SpaceHit hit;
    memset(&sample, 0, sizeof sample);
    if (!space_ray(room->space, from, direction, 0, INFINITY, &hit))
        return sample;
    sample.distance = (float)(hit.t / picture_metre(room));
    sample.tag = hit.tag;
    sample.at[0] = (float)hit.point[0], sample.at[1] = (float)hit.point[2];
    sample.kind = (unsigned char)kind_of(room, &hit), sample.is_front = (unsigned char)hit.is_front;
    sample.side = side_of(hit.normal);
    return sample;
}

void picture_ray(const View *view, double u, double v, double from[3], double direction[3])
{
    const double across = view->width > 0 ? view->width / 2 : tan(view->angle * PI / 360);
    double length = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double right = view->up[i] * view->ahead[j] - view->up[j] * view->ahead[i];
        const double off = across * (u * right + v / view->aspect * view->up[k]);
        from[k] = view->eye[k] + (view->width > 0 ? off : 0);
        direction[k] = view->ahead[k] + (view->width > 0 ? 0 : off);
        length += direction[k] * direction[k];
    }
    for (int k = 0; k < 3; k++)
        direction[k] /= sqrt(length);
}

double picture_size(const Room *room)
{
    return hypot(room->high[0] - room->low[0], room->high[2] - room->low[2]);
}

double picture_tilt(const View *view)
{
    const double level = sqrt(fmax(1 - view->ahead[1] * view->ahead[1], 1e-6));
    return fmin(1, fabs(view->ahead[1]) + fmax(0, 1 - view->up[1] / level));
}

void picture_take(const Room *room, const View *view, int width, int height, Picture *picture)
{
    picture->width = width, picture->height = height;
    picture->tilt = picture_tilt(view);
    picture->size = picture_size(room);
    for (int j = 0; j < picture->height; j++)
        for (int i = 0; i < picture->width; i++) {
            double from[3], direction[3];
            picture_ray(view, 2 * (i + 0.5) / picture->width - 1, 1 - 2 * (j + 0.5) / picture->height, from, direction);
            picture->samples[j * picture->width + i] = picture_sample(room, from, direction);
        }
}
