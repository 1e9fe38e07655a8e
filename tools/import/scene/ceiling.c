/* A light for rooms without any: dark ones get a rectangle below the ceiling. */
#include <math.h>
#include <stdlib.h>

#include "import/base/tell.h"
#include "import/scene/scene.h"
#include "import/sense/sense.h"
#include "import/space/room.h"
#include "import/space/space.h"

/* Least share of all directions from which a sky lights a room: a window of a square metre in a room of 60. */
#define OPEN 0.003
#define LEAST_GLOW 0.02 /* less is dark beside a lamp */

static const ImportMaterial *material_of(const Import *import, uint32_t object)
{
    const uint32_t index = import->sense->materials[object];
    return index < import->scene->mNumMaterials ? &import->materials[index] : NULL;
}

/* Whether it is a room that light does not leave, so that a light below its ceiling would light it. */
static int is_room(const Import *import)
{
    const Sense *sense = import->sense;
    return sense && sense->space && !import->cutaway && sense->room.is_closed && sense->room.covered > 0.5;
}

/* How many sides of a triangle shine into free space: what is inside of a device lights nothing. */
static int free_sides(const Space *space, const double middle[3], const double normal[3], double least)
{
    int count = 0;
    for (int sign = -1; sign <= 1; sign += 2) {
        const double direction[3] = {sign * normal[0], sign * normal[1], sign * normal[2]};
        SpaceHit hit;
        count += !space_ray(space, middle, direction, 0.02 * least, least, &hit);
    }
    return count;
}

/* Area and normal of a triangle, and its middle. */
static double measure(const SpaceTriangles *t, size_t i, double middle[3], double normal[3])
{
    const float *v[3];
    double squared = 0;
    for (int k = 0; k < 3; k++)
        v[k] = t->vertices[t->corners[i][k]];
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        middle[k] = ((double)v[0][k] + (double)v[1][k] + (double)v[2][k]) / 3;
        normal[k] = ((double)v[1][a] - (double)v[0][a]) * ((double)v[2][b] - (double)v[0][b]) -
                    ((double)v[1][b] - (double)v[0][b]) * ((double)v[2][a] - (double)v[0][a]);
        squared += normal[k] * normal[k];
    }
    for (int k = 0; k < 3; k++)
        normal[k] /= squared > 0 ? sqrt(squared) : 1;
    return sqrt(squared) / 2;
}

/* About the radiance of surfaces by those that shine, if half of the light is absorbed at each. all: their area; near:
 * how far it is free before what is not within a device. */
static double glow_of(const Import *import, double all, double near)
{
    const SpaceTriangles *t = space_triangles(import->sense->space);
    double power = 0;
    for (size_t i = 0; i < t->ntriangles; i++) {
        const ImportMaterial *material = material_of(import, t->tags[i]);
        double middle[3], normal[3];
        if (!material || !(material->radiance > 0))
            continue;
        const double area = measure(t, i, middle, normal);
        power += (double)material->radiance * area / 2 * free_sides(import->sense->space, middle, normal, near);
    }
    return all > 0 ? 2 * power / all : 0;
}

double ceiling_glow(const Import *import)
{
    double low[3], high[3];
    if (!import->sense || !import->sense->space || is_room(import))
        return INFINITY;
    space_bounds(import->sense->space, low, high);
    const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return glow_of(import, 2 * (x * y + y * z + z * x), 0.01 * sqrt(x * x + y * y + z * z)) /
           2; /* once, then it is gone */
}

int ceiling_emits(const Import *import)
{
    if (!import->emits || !is_room(import))
        return import->emits;
    const Room *room = &import->sense->room;
    const double floor = room->ninside * room->cell * room->cell, all = 2 * floor + 4 * sqrt(floor) * room->height;
    const double glow = glow_of(import, all, 0.04 * room->height);
    import_tell(import, IMPORT_DETAIL, "by its lamps, the room's surfaces have a radiance of about %.2g", glow);
    return glow >= LEAST_GLOW;
}

int ceiling_is_needed(const Import *import, int *is_needed, RetexError *err)
{
    const Sense *sense = import->sense;
    *is_needed = 0;
    if (!is_room(import))
        return RETEX_OK;
    unsigned char *passes = calloc((size_t)sense->nobjects + 1, 1);
    if (!passes)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    for (uint32_t i = 0; i < sense->nobjects; i++)
        passes[i] = (unsigned char)(material_of(import, i) && material_of(import, i)->is_clear);
    const double open = room_openness(&sense->room, passes);
    free(passes);
    *is_needed = open < OPEN;
    if (!*is_needed)
        import_tell(import, IMPORT_DETAIL, "from places in the room, %.2g %% of all directions lead out", 100 * open);
    return RETEX_OK;
}

typedef struct Rectangle {
    double at[3], half[2]; /* its middle, and half of its sides in x and z */
    double area, walls;    /* of the ceiling and of all that is around, as far as it is free */
} Rectangle;

/* How far it is free from a place to both sides along x, z and between; the least of it. */
static double free_around(const Space *space, const double at[3], double distances[8])
{
    double least = INFINITY;
    for (int i = 0; i < 8; i++) {
        const double a = i * PI / 4, direction[3] = {cos(a), 0, sin(a)};
        SpaceHit hit;
        distances[i] = space_ray(space, at, direction, 0, INFINITY, &hit) ? hit.t : 0;
        least = fmin(least, distances[i]);
    }
    return least;
}

/* Below the ceiling, where most is free around. Returns 0 where there is no such place. */
static int find_rectangle(const Room *room, Rectangle *to)
{
    const double up[3] = {0, 1, 0}, below = 0.88 * room->height;
    double best = 0, around[8];
    for (int i = 0; i < room->nx * room->nz; i++) {
        double at[3];
        SpaceHit hit;
        if (!room->cells[i].is_inside || !room->cells[i].is_covered)
            continue;
        room_point(room, i, below, at);
        const double least = free_around(room->space, at, around);
        if (least <= best || !space_ray(room->space, at, up, 0, INFINITY, &hit))
            continue;
        best = least;
        to->half[0] = 0.4 * fmin(around[0], around[4]), to->half[1] = 0.4 * fmin(around[2], around[6]);
        const double x = around[0] + around[4], z = around[2] + around[6];
        to->area = x * z, to->walls = 2 * x * z + 2 * (x + z) * room->height;
        for (int k = 0; k < 3; k++)
            to->at[k] = at[k];
    }
    if (!(best > 0))
        return 0;
    double free = INFINITY; /* up to the ceiling, above all of it */
    for (int i = 0; i < 25; i++) {
        const double from[3] = {to->at[0] + to->half[0] * (i % 5 - 2) / 2, to->at[1],
                                to->at[2] + to->half[1] * (i / 5 - 2) / 2};
        SpaceHit hit;
        if (space_ray(room->space, from, up, 0, INFINITY, &hit))
            free = fmin(free, hit.t);
    }
    to->at[1] += fmax(free - 0.012 * room->height, 0.5 * free);
    return 1;
}

/* So bright that what is half white around it is about middle grey. */
static double radiance_of(const Rectangle *r)
{
    return 0.35 * 0.5 * r->walls / (4 * r->half[0] * r->half[1]);
}

int ceiling_write(Import *import, FILE *out, RetexError *err)
{
    const Sense *sense = import->sense;
    const double s = sense->scale;
    Rectangle r = {.area = 0};
    char name[NAME_SIZE];
    if (!find_rectangle(&sense->room, &r))
        return RETEX_OK;
    if (!names_make(&import->names, "Ceiling_light", "Ceiling_light", name))
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    fprintf(out,
            "// The model has no light. This one can be changed after rendering: retex-render --lamp %s\n"
            "#declare %s = texture { pigment { rgb 1 } finish { diffuse 0 emission rgb %.4g } }\n",
            name, name, radiance_of(&r));
    fprintf(out,
            "polygon { 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1> texture { %s }\n"
            "  interior_texture { pigment { rgbt 1 } finish { diffuse 0 } } no_image no_reflection no_shadow\n"
            "  scale <%.5g, %.5g, 1> rotate 90*x translate <%.6g, %.6g, %.6g> }\n\n",
            name, r.half[0] * s, r.half[1] * s, r.at[0] * s, r.at[1] * s, r.at[2] * s);
    import_tell(import, IMPORT_INFO,
                "%s in the model, and no opening in the room: a light below the ceiling, %s, lights it",
                import->emits ? "next to no light" : "no light", name);
    return RETEX_OK;
}
