/* A light for rooms without any: dark ones get a rectangle below the ceiling. */
#include <math.h>
#include <stdlib.h>

#include "import/base/look_text.h"
#include "import/base/tell.h"
#include "import/scene/scene.h"
#include "import/sense/sense.h"
#include "import/space/room.h"
#include "import/space/space.h"

/* Least share of all directions from which a sky lights a room: a window of a square metre in a room of 60. */
#define OPEN 0.003

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
    double walls;          /* the area of all that is around, as far as it is free */
} Rectangle;

/* How far it is free from a place to both sides along x, z and between, where it is open, `open`; the least of it. */
static double free_around(const Space *space, const double at[3], double open, double distances[8])
{
    double least = INFINITY;
    for (int i = 0; i < 8; i++) {
        const double a = i * PI / 4, direction[3] = {cos(a), 0, sin(a)};
        SpaceHit hit;
        distances[i] = space_ray(space, at, direction, 0, open, &hit) ? hit.t : open;
        least = fmin(least, distances[i]);
    }
    return least;
}

/* A place below a ceiling, if it is better than the best so far. Returns how far it is free around it, or 0. */
static double try_place(const Space *space, const double at[3], double height, double best, Rectangle *to)
{
    const double up[3] = {0, 1, 0};
    double around[8];
    SpaceHit hit;
    const double least = free_around(space, at, 2 * height, around);
    if (least <= best || !space_ray(space, at, up, 0, INFINITY, &hit))
        return 0;
    to->half[0] = 0.4 * fmin(around[0], around[4]), to->half[1] = 0.4 * fmin(around[2], around[6]);
    const double x = around[0] + around[4], z = around[2] + around[6];
    to->walls = 2 * x * z + 2 * (x + z) * height;
    for (int k = 0; k < 3; k++)
        to->at[k] = at[k];
    return least;
}

static int sees(const Space *space, const double eye[3], const double at[3])
{
    double way[3];
    SpaceHit hit;
    for (int k = 0; k < 3; k++)
        way[k] = at[k] - eye[k];
    return !space_ray(space, eye, way, 0, 1, &hit);
}

/* Below the ceiling, where most is free around, of places that the eye sees: what is in the picture may be one room of
 * several. Where it sees none, or there is no room as a whole, above the eye. Returns 0 where there is no such place.
 */
static int find_rectangle(const Room *room, int is_room, const double eye[3], Rectangle *to)
{
    const double up[3] = {0, 1, 0}, down[3] = {0, -1, 0};
    double best = 0, at[3] = {eye[0], eye[1], eye[2]};
    SpaceHit above, below;
    for (int i = 0; i < room->nx * room->nz && is_room; i++) {
        double place[3];
        if (!room->cells[i].is_inside || !room->cells[i].is_covered)
            continue;
        room_point(room, i, 0.88 * room->height, place);
        if (sees(room->space, eye, place))
            best = fmax(best, try_place(room->space, place, room->height, best, to));
    }
    if (!(best > 0)) {
        if (!space_ray(room->space, eye, up, 0, INFINITY, &above) ||
            !space_ray(room->space, eye, down, 0, INFINITY, &below))
            return 0;
        at[1] += 0.8 * above.t;
        if (!(try_place(room->space, at, above.t + below.t, 0, to) > 0))
            return 0;
    }
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

int ceiling_write(Import *import, FILE *out, double strength, int *is_written, RetexError *err)
{
    Rectangle r = {.walls = 0};
    char name[NAME_SIZE];
    *is_written = 0;
    const Sense *sense = import->sense;
    if (!sense || !sense->space || import->cutaway)
        return RETEX_OK;
    const double s = sense->scale, eye[3] = {import->eye[0] / s, import->eye[1] / s, import->eye[2] / s};
    *is_written = find_rectangle(&sense->room, is_room(import), eye, &r);
    if (!*is_written)
        return RETEX_OK;
    if (!names_make(&import->names, "Ceiling_light", "Ceiling_light", name))
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    fprintf(out,
            LOOK_DECLARE(LOOK_ADDED_LAMP) LOOK_ADDED_FORMAT
            "; // below the ceiling\n#if (" LOOK_ADDED_LAMP " > 0)\n"
            "// It can be changed after rendering: retex-render --lamp %s\n"
            "#declare %s = texture { pigment { rgb 1 } finish { diffuse 0 emission rgb %.4g*" LOOK_ADDED_LAMP " } }\n",
            strength, name, name, radiance_of(&r));
    fprintf(out,
            "polygon { 5, <-1, -1>, <1, -1>, <1, 1>, <-1, 1>, <-1, -1> texture { %s }\n"
            "  interior_texture { pigment { rgbt 1 } finish { diffuse 0 } } no_image no_reflection no_shadow\n"
            "  scale <%.5g, %.5g, 1> rotate 90*x translate <%.6g, %.6g, %.6g> }\n#end\n",
            name, r.half[0] * s, r.half[1] * s, r.at[0] * s, r.at[1] * s, r.at[2] * s);
    return RETEX_OK;
}
