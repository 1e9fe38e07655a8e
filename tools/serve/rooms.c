/* See rooms.h. */
#include "rooms.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "names.h"
#include "request.h"

enum { MOST_OPEN = 256 }; /* rooms that nobody uses are closed beyond this number */

/* A pack is served before a set of the same name. */
static const char *const endings[] = {"retex", "exr", NULL};

typedef struct OpenRoom {
    Room room; /* first member: callers have pointers to it */
    struct OpenRoom *next;
    char name[SERVE_NAME_MAX + 1];
    FileId id;
    RetexSet *set;
    uint64_t bytes; /* decoded, or reserved for decoding */
    uint64_t used;  /* number of the use */
    int users;
    int is_ready; /* 0 while it is being opened */
    int is_stale; /* its file was replaced: closed when nobody uses it */
} OpenRoom;

struct Rooms {
    RoomsParams params;
    pthread_mutex_t lock; /* protects all below, and rooms that are not ready */
    pthread_cond_t ready; /* a room was opened, or could not be */
    OpenRoom *first;
    uint64_t bytes, uses, opened, failed;
    int count;
};

int rooms_open(Rooms **rooms, const RoomsParams *params, RetexError *err)
{
    struct stat info;
    *rooms = NULL;
    if (stat(params->folder, &info) != 0)
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", params->folder, strerror(errno));
    if (!S_ISDIR(info.st_mode))
        return retex_fail(err, RETEX_EIO, "%s is no folder", params->folder);
    if (!(*rooms = calloc(1, sizeof **rooms)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for rooms");
    (*rooms)->params = *params;
    pthread_mutex_init(&(*rooms)->lock, NULL);
    pthread_cond_init(&(*rooms)->ready, NULL);
    return RETEX_OK;
}

static void remove_room(Rooms *rooms, OpenRoom *room)
{
    OpenRoom **place = &rooms->first;
    while (*place != room)
        place = &(*place)->next;
    *place = room->next;
    rooms->bytes -= room->bytes;
    rooms->count--;
    retex_set_close(&room->set);
    free(room);
}

void rooms_close(Rooms *rooms)
{
    if (!rooms)
        return;
    while (rooms->first)
        remove_room(rooms, rooms->first);
    pthread_cond_destroy(&rooms->ready);
    pthread_mutex_destroy(&rooms->lock);
    free(rooms);
}

int rooms_find(const Rooms *rooms, const char *name, char path[PATH_MAX], FileId *id)
{
    for (int i = 0; endings[i]; i++)
        if (snprintf(path, PATH_MAX, "%s/%s.%s", rooms->params.folder, name, endings[i]) < PATH_MAX &&
            file_id_of(id, path) == 0)
            return 0;
    return -1;
}

int rooms_list(const Rooms *rooms, void (*tell)(void *context, const char *name), void *context)
{
    return names_list(rooms->params.folder, endings, 0, tell, context);
}

/* ---- those that are open ---- */

static OpenRoom *find_open(Rooms *rooms, const char *name)
{
    for (OpenRoom *room = rooms->first; room; room = room->next)
        if (!room->is_stale && strcmp(room->name, name) == 0)
            return room;
    return NULL;
}

/* Close rooms that nobody uses, those used least recently first, until there are so many bytes left and one may be
 * opened. */
static void make_space(Rooms *rooms, uint64_t bytes)
{
    while (rooms->bytes + bytes > rooms->params.memory || rooms->count >= MOST_OPEN) {
        OpenRoom *oldest = NULL;
        for (OpenRoom *room = rooms->first; room; room = room->next)
            if (!room->users && (!oldest || room->used < oldest->used))
                oldest = room;
        if (!oldest)
            return;
        remove_room(rooms, oldest);
    }
}

static const Room *use(Rooms *rooms, OpenRoom *room)
{
    room->users++;
    room->used = ++rooms->uses;
    return &room->room;
}

static uint64_t bytes_in_memory(const RetexSet *set)
{
    uint64_t bytes = 0;
    for (int i = 0; i < set->nparts; i++)
        if (set->parts[i].image.pixels)
            bytes += sizeof(float) * retex_image_index(&set->parts[i].image, 0, set->parts[i].image.height);
    return bytes;
}

static int identify(OpenRoom *room, RetexError *err)
{
    const Hash128 begin = HASH128_BEGIN;
    const FileId *id = &room->id;
    char *manifest = NULL, file[64];
    int code = retex_set_manifest(room->set, NULL, &manifest, err);
    snprintf(file, sizeof file, "%llx %llx.%llx", id->size, (unsigned long long)id->seconds,
             (unsigned long long)id->nanoseconds);
    if (!code)
        room->room.content = hash128_text(hash128_text(begin, manifest), file);
    free(manifest);
    return code;
}

/* Decode what recombination reads, if there is memory for it. The lock is not held. */
static int decode(Rooms *rooms, OpenRoom *room, RetexError *err)
{
    const uint64_t most = retex_set_bytes(room->set);
    pthread_mutex_lock(&rooms->lock);
    make_space(rooms, most);
    const uint64_t left = rooms->params.memory > rooms->bytes ? rooms->params.memory - rooms->bytes : 0;
    const uint64_t reserved = room->bytes = most < left ? most : left;
    rooms->bytes += reserved;
    pthread_mutex_unlock(&rooms->lock);
    int code = retex_set_preload(room->set, NULL, NULL, reserved, rooms->params.threads, err);
    const uint64_t bytes = code ? 0 : bytes_in_memory(room->set);
    pthread_mutex_lock(&rooms->lock);
    rooms->bytes = rooms->bytes - reserved + bytes;
    room->bytes = bytes;
    pthread_mutex_unlock(&rooms->lock);
    return code;
}

static int open_file(Rooms *rooms, OpenRoom *room, const char *path, RetexError *err)
{
    int code = retex_set_open(path, &room->set, NULL, rooms->params.threads, err);
    if (!code && !room->set)
        code = retex_fail(err, RETEX_EFORMAT, "%s holds no set", path);
    if (!code && (long)room->set->width * room->set->height > rooms->params.pixels)
        code = retex_fail(err, RETEX_EFORMAT, "room %s is too large: %d x %d pixels", room->name, room->set->width,
                          room->set->height);
    room->room.set = room->set;
    if (!code)
        code = identify(room, err);
    return code ? code : decode(rooms, room, err);
}

/* Begin a room that is not ready. */
static OpenRoom *add_room(Rooms *rooms, const char *name, const FileId *id)
{
    make_space(rooms, 0);
    OpenRoom *room = calloc(1, sizeof *room);
    if (!room)
        return NULL;
    snprintf(room->name, sizeof room->name, "%s", name);
    room->id = *id;
    room->next = rooms->first;
    rooms->first = room;
    rooms->count++;
    return room;
}

/* Forget a room whose file was replaced, when its users are done. */
static void drop_stale(Rooms *rooms, OpenRoom *room)
{
    room->is_stale = 1;
    if (!room->users)
        remove_room(rooms, room);
}

int rooms_take(Rooms *rooms, const char *name, const Room **result, RetexError *err)
{
    char path[PATH_MAX];
    FileId id;
    *result = NULL;
    if (rooms_find(rooms, name, path, &id))
        return retex_fail(err, RETEX_ENOTFOUND, "there is no room '%s'", name);
    pthread_mutex_lock(&rooms->lock);
    OpenRoom *room = find_open(rooms, name);
    while (room && !room->is_ready) {
        pthread_cond_wait(&rooms->ready, &rooms->lock);
        room = find_open(rooms, name);
    }
    if (room && !file_id_is_same(&room->id, &id)) {
        drop_stale(rooms, room);
        room = NULL;
    }
    if (room) {
        *result = use(rooms, room);
        pthread_mutex_unlock(&rooms->lock);
        return RETEX_OK;
    }
    room = add_room(rooms, name, &id);
    if (room)
        use(rooms, room);
    pthread_mutex_unlock(&rooms->lock);
    int code = room ? open_file(rooms, room, path, err) : retex_fail(err, RETEX_ENOMEM, "not enough memory for a room");
    pthread_mutex_lock(&rooms->lock);
    *(code ? &rooms->failed : &rooms->opened) += 1;
    if (room && code)
        remove_room(rooms, room);
    else if (room)
        room->is_ready = 1;
    pthread_cond_broadcast(&rooms->ready);
    pthread_mutex_unlock(&rooms->lock);
    if (!code)
        *result = &room->room;
    return code;
}

const Room *rooms_peek(Rooms *rooms, const char *name, const FileId *id)
{
    const Room *result = NULL;
    pthread_mutex_lock(&rooms->lock);
    OpenRoom *room = find_open(rooms, name);
    if (room && room->is_ready && file_id_is_same(&room->id, id))
        result = use(rooms, room);
    pthread_mutex_unlock(&rooms->lock);
    return result;
}

void rooms_return(Rooms *rooms, const Room *taken)
{
    OpenRoom *room = (OpenRoom *)(void *)taken;
    if (!room)
        return;
    pthread_mutex_lock(&rooms->lock);
    if (--room->users == 0 && room->is_stale)
        remove_room(rooms, room);
    pthread_mutex_unlock(&rooms->lock);
}

RoomsCount rooms_count(Rooms *rooms)
{
    pthread_mutex_lock(&rooms->lock);
    const RoomsCount count = {rooms->count, rooms->bytes, rooms->opened, rooms->failed};
    pthread_mutex_unlock(&rooms->lock);
    return count;
}
