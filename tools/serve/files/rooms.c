/* See rooms.h. */
#include "serve/files/rooms.h"

#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "serve/files/kept.h"
#include "serve/files/names.h"
#include "serve/request/name.h"

enum { MOST_OPEN = 256 }; /* rooms that nobody uses are closed from this number on */

/* A pack is served before a set of the same name. */
static const char *const endings[] = {"retex", "exr", NULL};

typedef struct OpenRoom {
    Kept kept;
    Room room;
    char name[SERVE_NAME_MAX + 8]; /* of a level with its number, behind a line end */
    RetexSet *set;
    /* of the parts in memory; protected by the lock of the list */
    int is_decoded, decoded[RETEX_MAX_TARGETS]; /* as far as there was memory; the corrections of a target too */
    int is_decoding;                            /* 1: no picture may begin */
    int pictures;                               /* that are being made */
} OpenRoom;

struct Rooms {
    RoomsParams params;
    Contents *contents;
    KeptList list;
};

static int is_of(const Kept *kept, const void *name)
{
    return strcmp(((const OpenRoom *)(const void *)kept)->name, name) == 0;
}

static Kept *create(const void *name, const void *unused)
{
    OpenRoom *room = calloc(1, sizeof *room);
    (void)unused;
    if (!room)
        return NULL;
    snprintf(room->name, sizeof room->name, "%s", (const char *)name);
    return &room->kept;
}

static void close_room(Kept *kept)
{
    retex_set_close(&((OpenRoom *)(void *)kept)->set);
}

static OpenRoom *open_room_of(const Room *room)
{
    return (OpenRoom *)(void *)((char *)(uintptr_t)room - offsetof(OpenRoom, room));
}

int rooms_open(Rooms **rooms, const RoomsParams *params, RetexError *err)
{
    *rooms = NULL;
    int code = names_check_folder(params->folder, err);
    if (code)
        return code;
    if (!(*rooms = calloc(1, sizeof **rooms)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for rooms");
    code = contents_open(&(*rooms)->contents, err);
    if (code) {
        free(*rooms);
        *rooms = NULL;
        return code;
    }
    (*rooms)->params = *params;
    (*rooms)->list = (KeptList){
        .most_bytes = params->memory, .most = MOST_OPEN, .is_of = is_of, .create = create, .close = close_room};
    kept_begin(&(*rooms)->list);
    return RETEX_OK;
}

void rooms_close(Rooms *rooms)
{
    if (!rooms)
        return;
    kept_end(&rooms->list);
    contents_close(rooms->contents);
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

/* ---- opening ---- */

/* The set of an open file: by its name, the file might be another one than was read for the digest. */
static int open_set(Rooms *rooms, OpenRoom *room, int file, int level, RetexError *err)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    int code = retex_set_open(path, &room->set, rooms->params.threads, err);
    if (!code && !room->set)
        code = retex_fail(err, RETEX_EFORMAT, "it holds no set");
    const RetexSetInfo info = code ? (RetexSetInfo){.width = 0} : retex_set_info(room->set);
    if ((long)info.width * info.height > rooms->params.pixels)
        code =
            retex_fail(err, RETEX_EFORMAT, "room %s is too large: %d x %d pixels", room->name, info.width, info.height);
    if (!code && level >= 0)
        code = retex_set_take_level(&room->set, level, err);
    room->room.set = room->set;
    return code;
}

static int open_file(Rooms *rooms, OpenRoom *room, const char *path, int level, RetexError *err)
{
    ContentReading reading = {.contents = rooms->contents, .most = 1};
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    int code = file < 0 ? retex_fail(err, RETEX_EIO, "cannot read it: %s", strerror(errno))
                        : content_read(&reading, file, err);
    if (!code)
        code = open_set(rooms, room, file, level, err);
    if (!code)
        code = content_end(&reading, err);
    else
        content_end(&reading, NULL);
    if (file >= 0)
        close(file);
    room->room.content = reading.read[0];
    if (code && err)
        snprintf(err->file, sizeof err->file, "%.*s", (int)sizeof err->file - 1, path);
    return code;
}

/* level: its number, or -1: the whole set. */
static int take(Rooms *rooms, const char *name, int level, const Room **result, RetexError *err)
{
    char path[PATH_MAX], key[SERVE_NAME_MAX + 8];
    FileId id;
    int is_new;
    *result = NULL;
    snprintf(key, sizeof key, level < 0 ? "%s" : "%s\n%d", name, level);
    if (rooms_find(rooms, name, path, &id))
        return retex_fail(err, RETEX_ENOTFOUND, "there is no room '%s'", name);
    OpenRoom *room = (OpenRoom *)(void *)kept_take(&rooms->list, key, &id, &is_new);
    if (!room)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a room");
    int code = is_new ? open_file(rooms, room, path, level, err) : RETEX_OK;
    if (is_new)
        kept_opened(&rooms->list, &room->kept, code, &room->room.content, 0);
    if (!code)
        *result = &room->room;
    return code;
}

int rooms_take(Rooms *rooms, const char *name, const Room **result, RetexError *err)
{
    return take(rooms, name, -1, result, err);
}

int rooms_take_level(Rooms *rooms, const Room *whole, int level, const Room **result, RetexError *err)
{
    return take(rooms, open_room_of(whole)->name, level, result, err);
}

const Room *rooms_peek(Rooms *rooms, const char *name, const FileId *id)
{
    OpenRoom *room = (OpenRoom *)(void *)kept_peek(&rooms->list, name, id);
    return room ? &room->room : NULL;
}

void rooms_return(Rooms *rooms, const Room *room)
{
    if (room)
        kept_return(&rooms->list, &open_room_of(room)->kept);
}

/* ---- decoding ---- */

static uint64_t bytes_in_memory(const RetexSet *set)
{
    uint64_t bytes = 0;
    const RetexPart *part;
    for (int i = 0; (part = retex_set_part(set, i)); i++)
        if (part->image.pixels)
            bytes += sizeof(float) * retex_image_index(&part->image, 0, part->image.height);
    return bytes;
}

static int is_decoded(const OpenRoom *room, const int corrected[RETEX_MAX_TARGETS])
{
    int is = room->is_decoded;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        is = is && (!corrected[t] || room->decoded[t]);
    return is;
}

/* The lock is not held, and no picture is being made. */
static int decode(Rooms *rooms, OpenRoom *room, const int corrected[RETEX_MAX_TARGETS], RetexError *err)
{
    KeptList *list = &rooms->list;
    const uint64_t had = bytes_in_memory(room->set), wanted = retex_set_preload_bytes(room->set, corrected),
                   more = wanted > had ? wanted - had : 0;
    pthread_mutex_lock(&list->lock);
    kept_make_space(list, more);
    const int fits = list->bytes + more <= list->most_bytes;
    room->kept.bytes += fits ? more : 0;
    list->bytes += fits ? more : 0;
    pthread_mutex_unlock(&list->lock);
    if (!fits)
        return RETEX_OK;
    int code = retex_set_preload(room->set, corrected, wanted, rooms->params.threads, err);
    const uint64_t bytes = bytes_in_memory(room->set);
    pthread_mutex_lock(&list->lock);
    list->bytes = list->bytes - room->kept.bytes + bytes;
    room->kept.bytes = bytes;
    list->failed += code != 0;
    pthread_mutex_unlock(&list->lock);
    return code;
}

int rooms_begin_picture(Rooms *rooms, const Room *taken, const int corrected[RETEX_MAX_TARGETS], RetexError *err)
{
    OpenRoom *room = open_room_of(taken);
    KeptList *list = &rooms->list;
    int code = RETEX_OK, all[RETEX_MAX_TARGETS];
    pthread_mutex_lock(&list->lock);
    while (room->is_decoding)
        pthread_cond_wait(&list->changed, &list->lock);
    if (!is_decoded(room, corrected)) {
        room->is_decoding = 1;
        while (room->pictures)
            pthread_cond_wait(&list->changed, &list->lock);
        for (int t = 0; t < RETEX_MAX_TARGETS; t++)
            all[t] = corrected[t] || room->decoded[t];
        pthread_mutex_unlock(&list->lock);
        code = decode(rooms, room, all, err);
        pthread_mutex_lock(&list->lock);
        if (!code) {
            room->is_decoded = 1;
            memcpy(room->decoded, all, sizeof all);
        }
        room->is_decoding = 0;
        pthread_cond_broadcast(&list->changed);
    }
    room->pictures += !code;
    pthread_mutex_unlock(&list->lock);
    return code;
}

void rooms_end_picture(Rooms *rooms, const Room *taken)
{
    OpenRoom *room = open_room_of(taken);
    pthread_mutex_lock(&rooms->list.lock);
    if (--room->pictures == 0 && room->is_decoding)
        pthread_cond_broadcast(&rooms->list.changed);
    pthread_mutex_unlock(&rooms->list.lock);
}

RoomsCount rooms_count(Rooms *rooms)
{
    KeptList *list = &rooms->list;
    pthread_mutex_lock(&list->lock);
    const RoomsCount count = {list->count, list->bytes, list->opened, list->failed};
    pthread_mutex_unlock(&list->lock);
    return count;
}
