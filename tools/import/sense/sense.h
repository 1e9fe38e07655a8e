/* What a model means: its unit, its axis that is up, whether it is a room. */
#ifndef RETEX_IMPORT_SENSE_H
#define RETEX_IMPORT_SENSE_H

#include "import/base/model.h"
#include "import/space/room.h"

/* All that is placed, and the room that it makes. */
struct Sense {
    double scale; /* of the scene's lengths, by those of the Space */
    Space *space; /* NULL: nobody asked, or there are too many triangles */
    Room room;
    uint32_t *materials; /* of each object, by which the space tags its triangles */
    uint32_t nobjects;
};

/* Find out what the model means: whether it is a room, and its unit. */
int sense_find(Import *import, RetexError *err);
void sense_free(Import *import);
/* Whether --camera is that word. */
int sense_camera_is(const Import *import, const char *word);

/* Put all that is placed into a Space, as import->world has it now. */
int placed_collect(Import *import, Sense *sense, RetexError *err);
/* Whether z is up in a model whose format does not say. */
int sense_is_z_up(const Space *space);

#endif
