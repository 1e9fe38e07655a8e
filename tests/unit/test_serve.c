/* Parts of retex-serve that need no connection: the cache of pictures, the queue, headers, smaller pictures, images and
 * rooms within their limits. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/clock.h>

#include "serve/http/body.h"
#include "serve/answer/cache.h"
#include "http/headers.h"
#include "serve/files/images.h"
#include "serve/files/kept.h"
#include "serve/files/rooms.h"
#include "serve/files/uploads.h"
#include "serve/site/work.h"

/* ---- answers ---- */

/* A message that is too long ends between two characters. */
static void test_long_message(void **state)
{
    char text[2 * 150 + 1] = "";
    (void)state;
    for (int i = 0; i < 150; i++)
        strcat(text, "\xc3\xa4");
    Answer *answer = answer_error(404, "%s", text);
    assert_int_equal(answer->bytes, 199);
    assert_memory_equal(answer->data, text, 198);
    assert_int_equal(((char *)answer->data)[198], '\n');
    answer_release(answer);
}

/* ---- cache ---- */

static Answer *some_bytes(size_t bytes, char fill)
{
    char *data = malloc(bytes);
    memset(data, fill, bytes);
    return answer_new(200, "image/png", data, bytes);
}

static void add(Cache *cache, int key, size_t bytes)
{
    char text[16];
    Answer *answer = some_bytes(bytes, (char)key);
    snprintf(text, sizeof text, "%d", key);
    cache_add(cache, text, answer);
    answer_release(answer);
}

static int has(Cache *cache, int key)
{
    char text[16];
    snprintf(text, sizeof text, "%d", key);
    Answer *answer = cache_find(cache, text);
    const int is_there = answer != NULL;
    if (answer)
        assert_int_equal(*(char *)answer->data, (char)key);
    answer_release(answer);
    return is_there;
}

static void test_cache(void **state)
{
    size_t entries, bytes;
    Cache *cache = cache_open(20000);
    (void)state;
    for (int key = 0; key < 8; key++)
        add(cache, key, 2000);
    assert_true(has(cache, 0)); /* used now: 1 is the oldest */
    add(cache, 8, 2000);
    add(cache, 9, 2000);
    cache_count(cache, &entries, &bytes);
    assert_true(bytes <= 20000 && bytes > 16000);
    assert_true(has(cache, 0) && has(cache, 9) && !has(cache, 1));
    add(cache, 9, 1000); /* in place of the other */
    cache_count(cache, &entries, &bytes);
    assert_true(has(cache, 9));
    add(cache, 10, 3000); /* more than an eighth */
    assert_false(has(cache, 10));
    Answer *kept = cache_find(cache, "9");
    for (int key = 20; key < 5000; key++)
        add(cache, key, 500);
    cache_count(cache, &entries, &bytes);
    assert_true(bytes <= 20000 && entries < 40 && !has(cache, 9));
    assert_int_equal(kept->bytes, 1000); /* still there for who has it */
    answer_release(kept);
    cache_close(cache);
}

/* ---- queue ---- */

typedef struct Client {
    Waiter waiter; /* first member */
    int status;
    int *order; /* number of answers so far */
    int place;
} Client;

static pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER, count_lock = PTHREAD_MUTEX_INITIALIZER;
static int made;

static Answer *make(void *context, const WorkItem *item, int nthreads)
{
    (void)context;
    assert_int_equal(nthreads, 1);
    pthread_mutex_lock(&gate);
    made++;
    pthread_mutex_unlock(&gate);
    return answer_error(400 + item->request.quality, "%s", item->key);
}

static void done(Waiter *waiter, Answer *answer)
{
    Client *client = (Client *)(void *)waiter;
    pthread_mutex_lock(&count_lock);
    client->status = answer->status;
    client->place = (*client->order)++;
    pthread_mutex_unlock(&count_lock);
    answer_release(answer);
}

static WorkResult submit(Work *work, Client *client, int number, double deadline)
{
    WorkItem *item = calloc(1, sizeof *item);
    char key[16];
    snprintf(key, sizeof key, "%d", number);
    item->request.quality = number;
    item->deadline = deadline;
    item->key = key;
    client->waiter.done = done;
    const WorkResult result = work_add(work, item, &client->waiter);
    free(item);
    return result;
}

static void test_work(void **state)
{
    const WorkParams params = {make, NULL, 1, 3};
    const double later = retex_clock_seconds() + 1000;
    int order = 0;
    Client clients[8] = {0};
    Work *work;
    RetexError err = {0};
    (void)state;
    made = 0;
    for (int i = 0; i < 8; i++)
        clients[i].order = &order;
    test_must(work_open(&work, &params, &err), &err);
    pthread_mutex_lock(&gate);
    assert_int_equal(submit(work, &clients[0], 1, later), WORK_ACCEPTED);
    while (!work_count(work).running)
        usleep(100);
    assert_int_equal(submit(work, &clients[1], 2, later), WORK_ACCEPTED);
    assert_int_equal(submit(work, &clients[2], 3, 0), WORK_ACCEPTED); /* too late when its turn comes */
    assert_int_equal(submit(work, &clients[3], 4, later), WORK_ACCEPTED);
    assert_int_equal(submit(work, &clients[4], 5, later), WORK_REFUSED);
    assert_int_equal(submit(work, &clients[5], 2, later), WORK_ACCEPTED); /* joins one that waits */
    assert_int_equal(submit(work, &clients[6], 1, later), WORK_ACCEPTED); /* and one that is being done */
    assert_true(clients[5].waiter.has_joined && clients[6].waiter.has_joined && !clients[3].waiter.has_joined);
    assert_int_equal(work_count(work).waiting, 3);
    work_refuse(work);
    assert_int_equal(submit(work, &clients[7], 6, later), WORK_REFUSED);
    pthread_mutex_unlock(&gate);
    work_close(work); /* finishes what was accepted */
    assert_int_equal(made, 3);
    const int statuses[] = {401, 402, 503, 404, 0, 402, 401, 0};
    for (int i = 0; i < 8; i++)
        assert_int_equal(clients[i].status, statuses[i]);
    assert_true(clients[0].place < clients[1].place && clients[1].place < clients[2].place &&
                clients[2].place < clients[3].place && order == 6);
}

/* ---- headers ---- */

static void test_etags(void **state)
{
    (void)state;
    assert_true(header_has_etag("\"ab\"", "\"ab\""));
    assert_true(header_has_etag("W/\"ab\"", "\"ab\""));
    assert_true(header_has_etag(" \"x\" ,\t\"a,b\",\"ab\"", "\"ab\""));
    assert_true(header_has_etag("*", "\"ab\""));
    const char *const others[] = {"", "ab", "\"ab", "\"abc\"", "\"a\"", "W/ \"ab\"", "\"x\" junk \"ab\"", ",,,"};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        assert_false(header_has_etag(others[i], "\"ab\""));
    assert_false(header_has_etag(NULL, "\"ab\""));
    assert_false(header_has_etag("*", "")); /* of what has no tag */
}

static void test_ranges(void **state)
{
    static const struct {
        const char *text;
        size_t bytes;
        RangeKind kind;
        size_t first, last;
    } rows[] = {
        {"bytes=0-0", 10, RANGE_SOME, 0, 0},
        {"bytes=3-", 10, RANGE_SOME, 3, 9},
        {"bytes=3-99", 10, RANGE_SOME, 3, 9},
        {"bytes=-4", 10, RANGE_SOME, 6, 9},
        {"bytes=-40", 10, RANGE_SOME, 0, 9},
        {"bytes=10-", 10, RANGE_OUTSIDE, 0, 0},
        {"bytes=-0", 10, RANGE_OUTSIDE, 0, 0},
        {"bytes=0-", 0, RANGE_OUTSIDE, 0, 0},
        {"bytes=5-4", 10, RANGE_NONE, 0, 0},
        {"bytes=1-2,4-5", 10, RANGE_NONE, 0, 0},
        {"bytes=-", 10, RANGE_NONE, 0, 0},
        {"items=0-1", 10, RANGE_NONE, 0, 0},
        {"bytes=a-b", 10, RANGE_NONE, 0, 0},
        {"bytes=99999999999999999999999-", 10, RANGE_OUTSIDE, 0, 0},
        {"bytes=1-99999999999999999999999", 10, RANGE_SOME, 1, 9},
        {"bytes=18446744073709551615-", 10, RANGE_OUTSIDE, 0, 0},
        {"bytes=-1", 0, RANGE_OUTSIDE, 0, 0},
        {"bytes=1", 10, RANGE_NONE, 0, 0},
        {"bytes=--1", 10, RANGE_NONE, 0, 0},
        {"bytes=1--1", 10, RANGE_NONE, 0, 0},
        {"bytes= 1-2", 10, RANGE_NONE, 0, 0},
        {"bytes=- 1", 10, RANGE_NONE, 0, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        size_t first = 0, last = 0;
        assert_int_equal(header_range(rows[i].text, rows[i].bytes, &first, &last), rows[i].kind);
        if (rows[i].kind == RANGE_SOME)
            assert_true(first == rows[i].first && last == rows[i].last);
    }
    assert_int_equal(header_range(NULL, 10, &(size_t){0}, &(size_t){0}), RANGE_NONE);
}

static void test_base(void **state)
{
    char text[256];
    (void)state;
    assert_string_equal(header_base(text, sizeof text, "a.example:80", NULL), "http://a.example:80");
    assert_string_equal(header_base(text, sizeof text, "[::1]:80", "https"), "https://[::1]:80");
    assert_string_equal(header_base(text, sizeof text, "a", "gopher"), "http://a");
    assert_string_equal(header_base(text, sizeof text, "a/b", "https"), "");
    assert_string_equal(header_base(text, sizeof text, "a\"b", "https"), "");
    assert_string_equal(header_base(text, sizeof text, NULL, "https"), "");
}

/* ---- rooms and images ---- */

static void write_set(const char *path, int width, uint32_t seed)
{
    RetexError err = {0};
    RetexSet *set = test_set(width, 24, seed);
    RetexTerm last = set->terms[--set->nterms];
    last.target = 1; /* corrects the second target */
    test_must(retex_set_add_correction(set, &last, NULL, &err), &err);
    test_must(retex_set_write(set, path, NULL, 1, &err), &err);
    retex_set_close(&set);
}

/* A room with its parts, but corrections, as for a picture. */
static const Room *take_room(Rooms *rooms, const char *name)
{
    const int none[RETEX_MAX_TARGETS] = {0};
    const Room *room;
    RetexError err = {0};
    test_must(rooms_take(rooms, name, &room, &err), &err);
    test_must(rooms_begin_picture(rooms, room, none, &err), &err);
    rooms_end_picture(rooms, room);
    return room;
}

static void join_names(void *text, const char *name)
{
    strcat(text, name);
    strcat(text, " ");
}

/* Corrections of a target are decoded with the first picture that reads them, while no other picture is made. */
static void *begin_and_end(void *context)
{
    void **rooms_and_room = context;
    const int one[RETEX_MAX_TARGETS] = {0, 1};
    if (!rooms_begin_picture(rooms_and_room[0], rooms_and_room[1], one, NULL))
        rooms_end_picture(rooms_and_room[0], rooms_and_room[1]);
    return NULL;
}

static void test_corrections(Rooms *rooms, const Room *room, const char *room_name)
{
    const uint64_t before = rooms_count(rooms).bytes;
    const int one[RETEX_MAX_TARGETS] = {0, 1}, none[RETEX_MAX_TARGETS] = {0};
    void *rooms_and_room[] = {rooms, (void *)(uintptr_t)room};
    RetexError err = {0};
    pthread_t other;
    assert_int_equal(retex_set_preload_bytes(room->set, none), before);
    const uint64_t after = retex_set_preload_bytes(room->set, one);
    assert_true(after > before);
    test_must(rooms_begin_picture(rooms, room, none, &err), &err);
    assert_int_equal(pthread_create(&other, NULL, begin_and_end, rooms_and_room), 0);
    usleep(50000);
    const Room *again;
    test_must(rooms_take(rooms, room_name, &again, &err), &err); /* who needs no parts does not wait */
    assert_ptr_equal(again, room);
    rooms_return(rooms, again);
    assert_int_equal(rooms_count(rooms).bytes, before); /* the other one does */
    rooms_end_picture(rooms, room);
    pthread_join(other, NULL);
    assert_int_equal(rooms_count(rooms).bytes, after);
    test_must(rooms_begin_picture(rooms, room, one, &err), &err);
    test_must(rooms_begin_picture(rooms, room, none, &err), &err);
    rooms_end_picture(rooms, room);
    rooms_end_picture(rooms, room);
}

static int is_of_any(const Kept *kept, const void *key)
{
    (void)key;
    return kept != NULL;
}

static Kept *create_kept(const void *key, const void *params)
{
    (void)key, (void)params;
    return calloc(1, sizeof(Kept));
}

static void close_kept(Kept *kept)
{
    kept->bytes = 0;
}

/* What was opened is kept if its file had settled and is the one that was asked for; who has it keeps it anyway. */
static void test_kept(void **state)
{
    const FileId id = {.size = 1}, replaced = {.size = 2};
    const struct {
        Content content;
        int is_kept;
    } cases[] = {{{.id = id, .is_settled = 1}, 1}, {{.id = id}, 0}, {{.id = replaced, .is_settled = 1}, 0}};
    (void)state;
    for (int k = 0; k < 3; k++) {
        KeptList list = {.most_bytes = 9, .most = 9, .is_of = is_of_any, .create = create_kept, .close = close_kept};
        int is_new;
        kept_begin(&list);
        Kept *kept = kept_take(&list, "", &id, &is_new);
        assert_true(kept && is_new);
        kept_opened(&list, kept, 0, &cases[k].content, 5);
        assert_int_equal(list.bytes, 5);
        Kept *other = kept_peek(&list, "", &id);
        assert_ptr_equal(other, cases[k].is_kept ? kept : NULL);
        kept_return(&list, other);
        kept_return(&list, kept);
        assert_int_equal(list.count, cases[k].is_kept);
        kept_end(&list);
    }
}

/* Files that were written just now are not kept: they may change without having another time. */
static void let_files_settle(void)
{
    poll(NULL, 0, 150);
}

/* Rooms beyond the limit are closed, the oldest first; those in use, and a replaced one that is in use, stay. */
static void test_rooms(void **state)
{
    const RoomsParams params = {".", 0, 1L << 20, 1};
    RoomsParams some = params;
    RetexError err = {0};
    Rooms *rooms;
    char names[256] = "", path[PATH_MAX];
    FileId id;
    (void)state;
    write_set("a.exr", 32, 1);
    write_set("b.exr", 32, 2);
    write_set("c.exr", 32, 3);
    write_set(".hidden.exr", 32, 3);
    let_files_settle();
    test_must(rooms_open(&rooms, &params, &err), &err);
    assert_int_equal(rooms_list(rooms, join_names, names), 0);
    assert_string_equal(names, "a b c ");
    rooms_return(rooms, take_room(rooms, "a"));
    assert_int_equal(rooms_count(rooms).bytes, 0); /* none is kept in memory */
    rooms_close(rooms);

    const RetexSet *set;
    some.memory = UINT64_MAX / 2;
    test_must(rooms_open(&rooms, &some, &err), &err);
    const Room *a;
    test_must(rooms_take(rooms, "a", &a, &err), &err);
    assert_true(a->set->width == 32 && rooms_count(rooms).bytes == 0); /* nothing is decoded for its size */
    assert_ptr_equal(take_room(rooms, "a"), a);
    const uint64_t bytes = rooms_count(rooms).bytes;
    assert_true(bytes > 32 * 24 * 12);
    test_corrections(rooms, a, "a");
    rooms_return(rooms, a);
    rooms_return(rooms, a);
    rooms_close(rooms);

    some.memory = 2 * bytes + bytes / 2; /* of two */
    test_must(rooms_open(&rooms, &some, &err), &err);
    a = take_room(rooms, "a");
    const Room *b = take_room(rooms, "b");
    rooms_return(rooms, b);
    assert_ptr_equal(take_room(rooms, "a"), a);
    rooms_return(rooms, a);
    rooms_return(rooms, take_room(rooms, "c"));
    assert_true(rooms_count(rooms).bytes <= some.memory && rooms_count(rooms).bytes > 0);
    assert_int_equal(rooms_find(rooms, "b", path, &id), 0);
    assert_null(rooms_peek(rooms, "b", &id)); /* was closed for c; a is in use */
    assert_int_equal(rooms_find(rooms, "a", path, &id), 0);
    assert_ptr_equal(rooms_peek(rooms, "a", &id), a);
    rooms_return(rooms, a);

    set = a->set;
    write_set("new", 40, 1);
    assert_int_equal(rename("new", "a.exr"), 0);
    const Room *other = take_room(rooms, "a");
    assert_true(other->set->width == 40 && set->width == 32 && a->set == set);
    assert_memory_not_equal(other->content.digest, a->content.digest, CONTENT_DIGEST);
    rooms_return(rooms, other);
    rooms_return(rooms, a);
    assert_int_equal(rooms_take(rooms, "none", &other, &err), RETEX_ENOTFOUND);
    FILE *file = fopen("c.exr", "wb");
    fputs("no set", file);
    fclose(file);
    assert_int_equal(rooms_take(rooms, "c", &other, &err), RETEX_EFORMAT);
    assert_null(other);
    assert_int_equal(rooms_count(rooms).failed, 1);
    rooms_close(rooms);
}

#define LATER (retex_clock_seconds() + 60)

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* Reads a file's content; `meanwhile` is what it holds after that, or NULL. */
static int read_content(Contents *contents, const char *path, const char *meanwhile, Content *content)
{
    ContentReading reading = {.contents = contents, .most = 1};
    RetexError err = {0};
    const int file = open(path, O_RDONLY);
    test_must(content_read(&reading, file, &err), &err);
    if (meanwhile)
        write_text(path, meanwhile);
    const int code = content_end(&reading, &err);
    *content = reading.read[0];
    close(file);
    return code;
}

/* Digests are those of the bytes (FIPS 180-2, B.1), whatever size and times say, and are remembered by the identity of
 * files that are older than the ticks of their times. */
static void test_contents(void **state)
{
    static const unsigned char abc[CONTENT_DIGEST] = {0xba, 0x78, 0x16, 0xbf, 0x8f, 0x01, 0xcf, 0xea,
                                                      0x41, 0x41, 0x40, 0xde, 0x5d, 0xae, 0x22, 0x23};
    const struct timespec times[2] = {{1, 0}, {1, 0}};
    RetexError err = {0};
    Contents *contents;
    Content content, other;
    FileId id;
    (void)state;
    test_must(contents_open(&contents, &err), &err);
    write_text("abc", "abc");
    assert_int_equal(read_content(contents, "abc", NULL, &content), RETEX_OK);
    assert_memory_equal(content.digest, abc, CONTENT_DIGEST);
    assert_int_equal(file_id_of(&id, "abc"), 0);
    assert_false(content.is_settled || contents_find(contents, &id, &other));
    let_files_settle();
    assert_int_equal(read_content(contents, "abc", NULL, &content), RETEX_OK);
    assert_true(content.is_settled && contents_find(contents, &id, &other));
    assert_memory_equal(other.digest, abc, CONTENT_DIGEST);
    /* of the same size and time */
    write_text("abd", "abd");
    assert_int_equal(utimensat(AT_FDCWD, "abc", times, 0), 0);
    assert_int_equal(utimensat(AT_FDCWD, "abd", times, 0), 0);
    assert_int_equal(rename("abd", "abc"), 0);
    assert_int_equal(read_content(contents, "abc", NULL, &other), RETEX_OK);
    assert_memory_not_equal(other.digest, abc, CONTENT_DIGEST);
    /* written to while it is read */
    assert_int_equal(read_content(contents, "abc", "abe", &content), RETEX_EIO);
    assert_int_equal(read_content(contents, "abc", "abe", &content), RETEX_OK);
    let_files_settle();
    assert_int_equal(read_content(contents, "abc", "abf", &content), RETEX_EIO);
    contents_close(contents);
    assert_int_equal(remove("abc"), 0);
}

static int find_image(const Images *images, const char *name, RetexTextureSpec *spec, FileId ids[])
{
    strcpy(spec->image, name);
    return images_find(images, spec, ids);
}

static void test_images(void **state)
{
    RetexAccess access = RETEX_ACCESS_INIT;
    const char *roots[1];
    RetexError err = {0};
    RetexImage im = {0};
    RetexSet *set = test_set(16, 16, 1);
    OpenImage *image, *other;
    RetexTexture *texture, *moved;
    Images *images;
    FileId ids[RETEX_TEXTURE_FILES];
    (void)state;
    roots[0] = realpath(".", NULL);
    access.safe = 1;
    access.roots = roots;
    access.nroots = 1;
    test_random_image(&im, 64, 64, 3, 3, 0, 1);
    test_must(retex_image_write(&im, "one.png", NULL, 1, &err), &err);
    test_must(retex_image_write(&im, "two.png", NULL, 1, &err), &err);
    let_files_settle();
    const ImagesParams params = {roots[0], NULL, 60000, &access, NULL, 1, 10}; /* of one */
    test_must(images_open(&images, &params, &err), &err);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    strcpy(spec.target, "Floor");
    assert_int_equal(find_image(images, "three", &spec, ids), 1 + RETEX_TEXTURE_FILE_IMAGE);
    assert_int_equal(find_image(images, "../one.png", &spec, ids), 1 + RETEX_TEXTURE_FILE_IMAGE);
    strcpy(spec.finish, "three");
    assert_int_equal(find_image(images, "one", &spec, ids), 1 + RETEX_TEXTURE_FILE_FINISH);
    strcpy(spec.finish, "two");
    assert_int_equal(find_image(images, "one", &spec, ids), 0);
    assert_true(ids[0].inode && ids[1].inode && strstr(spec.finish, "/two.png"));
    spec.finish[0] = '\0';
    assert_int_equal(find_image(images, "one.png", &spec, ids), 0);
    assert_int_equal(find_image(images, "one", &spec, ids), 0);
    assert_true(ids[0].inode && !ids[1].inode);
    test_must(images_take(images, &spec, LATER, &image, &err), &err);
    test_must(images_place(images, image, set, &spec, &texture, &err), &err);
    spec.scale[0] = 3;
    strcpy(spec.target, "Wall");
    test_must(images_take(images, &spec, LATER, &other, &err), &err);
    test_must(images_place(images, other, set, &spec, &moved, &err), &err);
    assert_ptr_equal(image, other); /* is read once, and placed in two ways */
    assert_int_equal(images_count(images).read, 1);
    float a[4], b[4];
    retex_texture_point(texture, 0.6, 0.3, a);
    retex_texture_point(moved, 0.2, 0.3, b);
    assert_float_equal(a[0], b[0], 1e-5);
    retex_texture_close(&moved);
    images_return(images, other);
    assert_int_equal(find_image(images, "two", &spec, ids), 0);
    test_must(images_take(images, &spec, LATER, &other, &err), &err);
    test_must(images_place(images, other, set, &spec, &moved, &err), &err);
    assert_int_equal(images_count(images).open, 2); /* both are in use */
    retex_texture_close(&moved);
    images_return(images, other);
    assert_int_equal(images_count(images).open, 1);
    retex_texture_close(&texture);
    images_return(images, image);
    assert_true(images_count(images).bytes <= 60000 && images_count(images).open == 1);
    images_close(images);
    retex_set_close(&set);
    retex_image_free(&im);
    free((char *)roots[0]);
}

static int keep(Uploads *uploads, const char *file)
{
    char piece[100], hash[UPLOAD_HASH_TEXT];
    Body body = {0};
    FILE *from = fopen(file, "rb");
    assert_null(body_begin(&body, uploads, NULL));
    for (size_t bytes; (bytes = fread(piece, 1, sizeof piece, from)) > 0;)
        assert_int_equal(body_add(&body, piece, bytes), 0);
    fclose(from);
    assert_null(body_complete(&body, hash));
    Answer *answer = uploads_keep(uploads, hash, body.data, body.bytes, LATER);
    const int status = answer->status;
    answer_release(answer);
    body_free(&body);
    return status;
}

static void remove_files(const char *folder)
{
    DIR *files = opendir(folder);
    for (struct dirent *entry; (entry = readdir(files));)
        unlinkat(dirfd(files), entry->d_name, 0);
    closedir(files);
}

/* Number and bytes of uploads are limited; those that were there count, and what cannot be kept leaves nothing. */
static void test_uploads(void **state)
{
    RetexError err = {0};
    RetexBudget *budget;
    Uploads *uploads;
    (void)state;
    assert_int_equal(mkdir("uploads", 0700), 0);
    for (int i = 0; i < 3; i++) {
        RetexImage im = {0};
        char name[] = "0.png";
        name[0] = (char)('0' + i);
        test_random_image(&im, 8 << i, 8, 3, 3 + (unsigned)i, 0, 1);
        test_must(retex_image_write(&im, name, NULL, 1, &err), &err);
        retex_image_free(&im);
    }
    test_must(retex_budget_create(&budget, &err), &err);
    retex_budget_set_pixels(budget, 16 * 8);
    char *folder = realpath("uploads", NULL);
    UploadsParams params = {folder, 1 << 20, 1 << 20, 1, 0, budget, 10};
    test_must(uploads_open(&uploads, &params, &err), &err);
    assert_int_equal(keep(uploads, "2.png"), 413); /* too many pixels */
    assert_int_equal(uploads_count(uploads).count, 0);
    assert_int_equal(keep(uploads, "0.png"), 201);
    assert_int_equal(keep(uploads, "1.png"), 507);
    assert_int_equal(keep(uploads, "0.png"), 200);
    const uint64_t bytes = uploads_count(uploads).bytes;
    assert_true(bytes > 8 * 8 && uploads_count(uploads).count == 1);
    uploads_close(uploads);
    params.most = 2;
    params.total_bytes = 2 * bytes; /* the second one is larger */
    test_must(uploads_open(&uploads, &params, &err), &err);
    assert_int_equal(uploads_count(uploads).count, 1);
    assert_int_equal(keep(uploads, "1.png"), 507);
    assert_int_equal(uploads_count(uploads).bytes, bytes);
    for (int i = 0; i < 64; i++)
        assert_true(uploads_enter(uploads));
    assert_false(uploads_enter(uploads));
    assert_true(uploads_take_memory(uploads, 8 << 20));
    assert_false(uploads_take_memory(uploads, 1));
    uploads_leave(uploads, 8 << 20);
    assert_true(uploads_enter(uploads) && uploads_take_memory(uploads, 1));
    uploads_close(uploads);
    params.folder = "none";
    assert_int_equal(uploads_open(&uploads, &params, &err), RETEX_EIO);
    retex_budget_close(&budget);
    free(folder);
    remove_files("uploads");
    assert_int_equal(rmdir("uploads"), 0); /* nothing else is in it */
}

static int enter_folder(void **state)
{
    return test_make_folder(state) || chdir(test_folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_long_message), cmocka_unit_test(test_cache),  cmocka_unit_test(test_work),
        cmocka_unit_test(test_etags),        cmocka_unit_test(test_ranges), cmocka_unit_test(test_base),
        cmocka_unit_test(test_kept),   cmocka_unit_test(test_rooms),
        cmocka_unit_test(test_contents),     cmocka_unit_test(test_images), cmocka_unit_test(test_uploads),
    };
    return cmocka_run_group_tests(tests, enter_folder, test_remove_folder);
}
