/* What a model means: its unit, its axis that is up, whether it is a room. */
#ifndef RETEX_IMPORT_SENSE_H
#define RETEX_IMPORT_SENSE_H

#include "import/base/model.h"
#include "import/space/views.h"

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

/* Of faces that lie on one another, one stays; once materials are known. */
int doubles_drop(Import *import, RetexError *err);
int doubles_find_objects(Import *import, RetexError *err);

/* Whether --camera asks for a view that is none of the model's: a place, or the words inside and outside. */
int framing_is_asked(const Import *import, int *is_asked, RetexError *err);
/* A view of the scene: what is asked for, else from inside of a room and from outside of what is none. */
int framing_write(Import *import, FILE *out, RetexError *err);
/* The model's camera of that name, unless it sees nothing; and views to choose from. view: where it is, or NULL. */
int framing_write_own(Import *import, const char *name, const View *view, FILE *out, RetexError *err);

/* The surfaces that a person means by floor and wall, as targets that the scene offers; once it has a camera. */
int targets_write(Import *import, FILE *out, RetexError *err);

/* Place the camera, into import->cutaway, and drop what stands before the rooms, where it is asked for. */
int cutaway_find(Import *import, RetexError *err);

#endif
