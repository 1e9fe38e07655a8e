/* What a model means: its unit by the height of its room, its axis that is up. Both change nothing silently. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/base/world.h"
#include "import/sense/sense.h"
#include "import/space/room.h"
#include "import/space/space.h"

typedef struct Unit {
    const char *name, *option;
    double metres, low, high; /* free heights of rooms in it which are in no other unit */
} Unit;

/* A room is 2 to 6 metres high. Feet overlap halls in metres, and are only said to be possible. */
static const Unit units[] = {
    {"metres", "m", 1, 1.8, 6.5},
    {"inches", "in", 0.0254, 75, 190},
    {"centimetres", "cm", 0.01, 190, 650},
    {"millimetres", "mm", 0.001, 1800, 6500},
};

static const Unit *unit_of(double height)
{
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (height >= units[i].low && height <= units[i].high)
            return &units[i];
    return NULL;
}

static void free_space(Sense *sense)
{
    space_free(sense->space);
    room_free(&sense->room);
    free(sense->materials);
    *sense = (Sense){.scale = 1};
}

void sense_free(Import *import)
{
    if (import->sense)
        free_space(import->sense);
    free(import->sense);
    import->sense = NULL;
}

int sense_camera_is(const Import *import, const char *word)
{
    return import->options->camera && strcmp(import->options->camera, word) == 0;
}

/* z is up: the world turns. Lights and cameras are placed after this, but for glTF, whose axes are known. */
static int find_up(Import *import, Sense *sense, RetexError *err)
{
    if (import->options->up || !import->axes_are_unknown || !sense_is_z_up(sense->space))
        return RETEX_OK;
    import_set_world(import, 'z');
    import_tell(import, IMPORT_INFO, "the model stands on its xy plane: z is taken as up; --up y overrides");
    free_space(sense);
    return placed_collect(import, sense, err);
}

static int find_room(Sense *sense, double metre, int is_sure, RetexError *err)
{
    room_free(&sense->room);
    return room_find(&sense->room, sense->space, metre, is_sure, err);
}

/* Find the unit by the room's height, where nothing says it or what is said is beyond sense. */
static int find_unit(Import *import, Sense *sense, int is_said, RetexError *err)
{
    Room *room = &sense->room;
    const double height = room->height;
    const Unit *unit = unit_of(height);
    const int may_be_feet = height > 6.5 && height < 14;
    if (import->options->unit || import->options->is_scaled)
        return RETEX_OK;
    /* Cupboards have compartments too, and the hulls of sofas are furnished with cushions. */
    room->is_furniture = !unit && !is_said && !(may_be_feet && room->enclosed > 0.9 && room->is_furnished);
    room->is_closed &= !room->is_furniture;
    if (!room->is_closed)
        return RETEX_OK;
    if (is_said && height <= 20 && height >= 0.5) {
        if (room->is_doubtful)
            import_tell(import, IMPORT_INFO,
                        "the room is %.3g m high and so is its furniture: lengths stay, --scale %.2g makes it 2.6 m",
                        height, 2.6 / height);
        return RETEX_OK;
    }
    if (!unit) {
        import_tell(import, IMPORT_INFO,
                    "the room is %.3g units high: its unit is unknown, and lengths stay; --unit %s", height,
                    may_be_feet ? "ft, if it is feet, makes metres" : "or --scale makes metres");
        return RETEX_OK;
    }
    if (unit->metres != 1) {
        import_tell(import, IMPORT_INFO,
                    "the room is %.4g units high: they are taken as %s, and become metres; --unit overrides", height,
                    unit->name);
        import_set_scale(import, unit->metres);
        sense->scale = unit->metres;
    }
    return find_room(sense, 1 / unit->metres, 1, err);
}

int sense_find(Import *import, RetexError *err)
{
    RetexError why = {0};
    const ImportOptions *options = import->options;
    Sense *sense = import->sense = calloc(1, sizeof *sense);
    if (!sense)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    sense->scale = 1;
    int code = placed_collect(import, sense, &why);
    if (!code && sense->space)
        code = find_up(import, sense, &why);
    const int is_said = import->has_metres;
    const double known = options->unit || options->is_scaled || is_said ? 1 : 0;
    if (!code && sense->space)
        code = find_room(sense, known, options->unit || options->is_scaled, &why);
    if (!code && sense->space)
        code = find_unit(import, sense, is_said, &why);
    return code ? retex_fail(err, code, "%s", why.message) : RETEX_OK;
}
