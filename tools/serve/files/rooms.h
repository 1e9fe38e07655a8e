/* Rooms: the sets and packs of a folder, by name. A set is opened once, and read for its digest. What recombination
 * reads of it is decoded when a picture first needs it, and stays in memory as long as all rooms together keep within a
 * limit, see kept.h. Any thread may call. */
#ifndef RETEX_SERVE_ROOMS_H
#define RETEX_SERVE_ROOMS_H

#include <limits.h>
#include <retex/set_file.h>

#include "serve/files/content.h"

typedef struct Rooms Rooms;

typedef struct Room {
    const RetexSet *set;
    Content content; /* of its file */
} Room;

typedef struct RoomsParams {
    const char *folder;
    uint64_t memory; /* bytes of decoded parts that are kept */
    long pixels;     /* of a room, at most */
    int threads;     /* that decode a set */
} RoomsParams;

int rooms_open(Rooms **rooms, const RoomsParams *params, RetexError *err);
void rooms_close(Rooms *rooms); /* when no room is in use */

/* The file of a room, and its identity: 0, or -1 if there is no such room. */
int rooms_find(const Rooms *rooms, const char *name, char path[PATH_MAX], FileId *id);
/* Open a room, or wait until another thread has: its size and targets are then known. To be returned by
 * rooms_return. */
int rooms_take(Rooms *rooms, const char *name, const Room **room, RetexError *err);
/* A level of a room that is open, by its number, which is returned likewise. */
int rooms_take_level(Rooms *rooms, const Room *whole, int level, const Room **room, RetexError *err);
/* The room if its file, of this identity, is open; or NULL. Never waits. */
const Room *rooms_peek(Rooms *rooms, const char *name, const FileId *id);
void rooms_return(Rooms *rooms, const Room *room); /* NULL is fine */

/* Before and after the parts of a room are read: decode what a picture needs that is not decoded yet, as far as there
 * is memory for it; what is beyond is read from the file. Corrections, which only pictures need that change some of the
 * targets, are decoded when they are first wanted: corrected[t] is 1 where those of target t are read. */
int rooms_begin_picture(Rooms *rooms, const Room *room, const int corrected[RETEX_MAX_TARGETS], RetexError *err);
void rooms_end_picture(Rooms *rooms, const Room *room);

/* Call for each room of the folder, sorted by name; not 0: the folder cannot be read. */
int rooms_list(const Rooms *rooms, void (*tell)(void *context, const char *name), void *context);

typedef struct RoomsCount {
    int open;
    uint64_t bytes;  /* decoded in memory */
    uint64_t opened; /* since the start */
    uint64_t failed; /* that could not be opened */
} RoomsCount;
RoomsCount rooms_count(Rooms *rooms);

#endif
