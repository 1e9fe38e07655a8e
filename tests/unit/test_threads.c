/* nthreads: no operation runs on more threads than it is told, and each uses them where there is enough work. */
#include "lib_pack_read.h"
#include "lib_denoise.h"
#include "lib_folder.h"
#include "lib_scene_text.h"
#include <cmocka.h>

#include "compact/compact.h"
#include "texture/pyramid.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 24, HEIGHT = 200, ALLOWED = 3 };

/* ---- threads of this process, counted ---- */

static atomic_int alive, most; /* threads begun and not ended yet; the most of them at any time */

typedef struct Start {
    void *(*main)(void *argument);
    void *argument;
} Start;

static void *counted_main(void *argument)
{
    const Start start = *(Start *)argument;
    free(argument);
    void *result = start.main(start.argument);
    atomic_fetch_sub(&alive, 1);
    return result;
}

/* Stands before the C library's. A thread counts from here to its end, so that its creator counts it in any case. */
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*main)(void *), void *argument)
{
    int (*next)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    *(void **)&next = dlsym(RTLD_NEXT, "pthread_create");
    Start *start = malloc(sizeof *start);
    if (!start)
        return 1;
    *start = (Start){main, argument};
    const int now = atomic_fetch_add(&alive, 1) + 1;
    for (int seen = atomic_load(&most); now > seen && !atomic_compare_exchange_weak(&most, &seen, now);)
        continue;
    const int failed = next(thread, attributes, counted_main, start);
    if (failed) {
        atomic_fetch_sub(&alive, 1);
        free(start);
    }
    return failed;
}

/* ---- operations ---- */

/* What operations work on, made on all cores before anything is counted. */
typedef struct Room {
    RetexSet *set, *noisy, *laid;
    RetexTexture *texture, *textures[RETEX_MAX_TARGETS];
    RetexTextureSpec spec;
    RetexImage picture;
    unsigned char *pack;
    size_t pack_bytes;
} Room;

typedef int Operation(Room *room, int nthreads, RetexError *err);

static int write_image(Room *room, int nthreads, RetexError *err)
{
    return retex_image_write(&room->picture, test_in_folder("out.png"), NULL, nthreads, err);
}

static int read_image(Room *room, int nthreads, RetexError *err)
{
    RetexImage image = {0};
    int code = retex_image_read(&image, room->spec.image, NULL, nthreads, err);
    retex_image_free(&image);
    return code;
}

static int compare_images(Room *room, int nthreads, RetexError *err)
{
    RetexMetrics metrics;
    return retex_metrics(&metrics, &room->picture, &room->picture, nthreads, err);
}

static int compare_files(Room *room, int nthreads, RetexError *err)
{
    RetexDiff *diff = NULL;
    int code = retex_diff(&diff, room->spec.image, room->spec.image, NULL, nthreads, err);
    retex_diff_close(&diff);
    return code;
}

static int load_texture(Room *room, int nthreads, RetexError *err)
{
    RetexTexture *texture = NULL;
    int code = retex_texture_load(&texture, &room->spec, nthreads, err);
    retex_texture_close(&texture);
    return code;
}

static int create_texture(Room *room, int nthreads, RetexError *err)
{
    RetexTexture *texture = NULL;
    int code = retex_texture_create(&texture, &room->picture, NULL, nthreads, err);
    retex_texture_close(&texture);
    return code;
}

static int square_texture(Room *room, int nthreads, RetexError *err)
{
    RetexTexture *texture = NULL;
    int code = retex_texture_square(&texture, room->texture, nthreads, err);
    retex_texture_close(&texture);
    return code;
}

static int load_textures(Room *room, int nthreads, RetexError *err)
{
    RetexTexture *textures[RETEX_MAX_TARGETS];
    int code = retex_textures_load(textures, room->set, &room->spec, 1, nthreads, err);
    retex_textures_close(textures);
    return code;
}

static int write_set(Room *room, int nthreads, RetexError *err)
{
    return retex_set_write(room->set, test_in_folder("out.exr"), NULL, nthreads, err);
}

static int read_set(Room *room, int nthreads, RetexError *err)
{
    RetexSet *set = NULL;
    (void)room;
    int code = retex_set_read(test_in_folder("set.exr"), &set, nthreads, err);
    retex_set_close(&set);
    return code;
}

static int open_and_load(Room *room, int nthreads, RetexError *err)
{
    RetexSet *set = NULL;
    (void)room;
    int code = retex_set_open(test_in_folder("set.exr"), &set, nthreads, err);
    code = code ? code : retex_set_load(set, nthreads, err);
    retex_set_close(&set);
    return code;
}

static int preload(Room *room, int nthreads, RetexError *err)
{
    RetexSet *set = NULL;
    (void)room;
    int code = retex_set_open(test_in_folder("set.exr"), &set, nthreads, err);
    code = code ? code : retex_set_preload(set, NULL, 1u << 30, nthreads, err);
    retex_set_close(&set);
    return code;
}

static int check_set(Room *room, int nthreads, RetexError *err)
{
    (void)room;
    return retex_set_check(test_in_folder("set.exr"), nthreads, err);
}

static int sum_set(Room *room, int nthreads, RetexError *err)
{
    return retex_set_checksum(room->set, nthreads, err);
}

static int compact_set(Room *room, int nthreads, RetexError *err)
{
    RetexSet *compact = NULL;
    int code = retex_set_compact(&compact, room->noisy, NULL, nthreads, err);
    retex_set_close(&compact);
    return code;
}

static int write_pack(Room *room, int nthreads, RetexError *err)
{
    return retex_pack_write(room->set, test_in_folder("out.retex"), NULL, NULL, nthreads, err);
}

static int read_pack(Room *room, int nthreads, RetexError *err)
{
    RetexSet *set = NULL;
    int code = pack_read(room->pack, room->pack_bytes, &set, nthreads, err);
    retex_set_close(&set);
    return code;
}

static int check_pack(Room *room, int nthreads, RetexError *err)
{
    return pack_check(room->pack, room->pack_bytes, nthreads, err);
}

static int compare_pack(Room *room, int nthreads, RetexError *err)
{
    double psnr[RETEX_PACK_LOSSES];
    return retex_pack_loss(psnr, RETEX_PACK_LOSSES, room->set, room->set, nthreads, err);
}

static int sample(Room *room, int nthreads, RetexError *err)
{
    const int code = retex_sample(room->set, &room->spec, 1, nthreads, err);
    retex_set_lift(room->set, -1);
    return code;
}

static int sample_textures(Room *room, int nthreads, RetexError *err)
{
    int code = test_sample_to_store(room->set, &room->spec, 1, test_in_folder("out.exr"), nthreads, err);
    code = code ? code : retex_set_load(room->set, nthreads, err);
    retex_set_lift(room->set, -1);
    return code;
}

static int combine(Room *room, int nthreads, RetexError *err)
{
    RetexImage picture = {0};
    int code = retex_combine(&picture, room->laid, NULL, NULL, nthreads, err);
    retex_image_free(&picture);
    return code;
}

static int ignore_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    (void)context, (void)y0, (void)y1, (void)rows, (void)err;
    return 0;
}

static int retexture(Room *room, int nthreads, RetexError *err)
{
    return retex_retexture(room->set, room->textures, NULL, ignore_rows, NULL, nthreads, err);
}

static int estimate_error(Room *room, int nthreads, RetexError *err)
{
    return retex_estimate_error(room->set, room->textures, NULL, ignore_rows, NULL, nthreads, err);
}

static int denoise(Room *room, int nthreads, RetexError *err)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    RetexSet *set = NULL;
    (void)room;
    params.radius = 2;
    int code = retex_set_read(test_in_folder("noisy.exr"), &set, nthreads, err);
    code = code ? code : retex_denoise(set, &params, NULL, nthreads, err);
    retex_set_close(&set);
    return code;
}

static int denoise_open(Room *room, int nthreads, RetexError *err)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    RetexSet *set = NULL;
    (void)room;
    params.radius = 2;
    int code = retex_set_open(test_in_folder("noisy.exr"), &set, nthreads, err);
    code = code ? code : retex_denoise(set, &params, NULL, nthreads, err);
    retex_set_close(&set);
    return code;
}

static int read_scene(Room *room, int nthreads, RetexError *err)
{
    SdlOptions options = SDL_OPTIONS_INIT;
    Scene *scene = NULL;
    char text[1200];
    options.nthreads = nthreads;
    snprintf(text, sizeof text, "sphere { 0, 1 pigment { image_map { exr \"%s\" } } }\n", room->spec.image);
    int code = parse_with(&scene, text, &options, err);
    scene_close(&scene);
    return code;
}

static const struct {
    const char *name;
    Operation *run;
} operations[] = {
    {"retex_image_write", write_image},
    {"retex_image_read", read_image},
    {"retex_metrics", compare_images},
    {"retex_diff", compare_files},
    {"retex_texture_load", load_texture},
    {"retex_texture_create", create_texture},
    {"retex_texture_square", square_texture},
    {"retex_textures_load", load_textures},
    {"retex_set_write", write_set},
    {"retex_set_read", read_set},
    {"retex_set_load", open_and_load},
    {"retex_set_preload", preload},
    {"retex_set_check", check_set},
    {"retex_set_checksum", sum_set},
    {"retex_set_compact", compact_set},
    {"retex_pack_write", write_pack},
    {"retex_set_load of a pack", read_pack},
    {"retex_set_check of a pack", check_pack},
    {"retex_pack_loss", compare_pack},
    {"retex_sample", sample},
    {"retex_sample_textures", sample_textures},
    {"retex_combine", combine},
    {"retex_retexture", retexture},
    {"retex_estimate_error", estimate_error},
    {"retex_denoise", denoise},
    {"retex_denoise of an open set", denoise_open},
    {"images of a scene", read_scene},
};

/* ---- the test ---- */

static void make_room(Room *room)
{
    RetexError err = {0};
    memset(room, 0, sizeof *room);
    room->spec = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
    room->set = test_set(WIDTH, HEIGHT, 5);
    test_make_footprints(room->set);
    test_must(retex_set_write(room->set, test_in_folder("set.exr"), NULL, 0, &err), &err);
    test_must(retex_pack_write(room->set, test_in_folder("set.retex"), NULL, NULL, 0, &err), &err);
    room->pack = test_read_file(test_in_folder("set.retex"), &room->pack_bytes);
    room->noisy = denoise_set("footprints", WIDTH, HEIGHT);
    denoise_add_noise(room->noisy, 7);
    test_must(retex_set_write(room->noisy, test_in_folder("noisy.exr"), NULL, 0, &err), &err);
    test_random_image(&room->picture, 80, HEIGHT, 3, 3, 0, 1);
    snprintf(room->spec.image, sizeof room->spec.image, "%s", test_in_folder("picture.exr"));
    snprintf(room->spec.target, sizeof room->spec.target, "%s", room->set->targets[0].name);
    test_must(retex_image_write(&room->picture, room->spec.image, NULL, 0, &err), &err);
    test_must(retex_texture_create(&room->texture, &room->picture, NULL, 0, &err), &err);
    test_must(retex_textures_load(room->textures, room->set, &room->spec, 1, 0, &err), &err);
    test_must(retex_set_read(test_in_folder("set.exr"), &room->laid, 0, &err), &err);
    test_must(retex_sample(room->laid, &room->spec, 1, 0, &err), &err);
}

static void close_room(Room *room)
{
    retex_set_close(&room->set);
    retex_set_close(&room->noisy);
    retex_set_close(&room->laid);
    retex_texture_close(&room->texture);
    retex_textures_close(room->textures);
    retex_image_free(&room->picture);
    free(room->pack);
}

/* The most threads at any time besides the calling one. */
static int threads_of(Operation *run, Room *room, int nthreads)
{
    RetexError err = {0};
    assert_int_equal(atomic_load(&alive), 0);
    atomic_store(&most, 0);
    test_must(run(room, nthreads, &err), &err);
    return atomic_load(&most);
}

static void test_as_many_as_said(void **state)
{
    (void)state;
    Room room;
    make_room(&room);
    int wrong = 0;
    for (size_t k = 0; k < sizeof operations / sizeof operations[0]; k++) {
        const int one = threads_of(operations[k].run, &room, 1), more = threads_of(operations[k].run, &room, ALLOWED);
        if (one != 0 || more < 1 || more > ALLOWED - 1) {
            print_message("%s: %d threads more for 1, %d for %d\n", operations[k].name, one, more, ALLOWED);
            wrong++;
        }
    }
    close_room(&room);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_as_many_as_said),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
