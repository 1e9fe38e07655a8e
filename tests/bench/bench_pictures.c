/* What a set costs beside a plain render, and what it saves. */
#include <retex/combine.h>
#include <retex/pack.h>
#include <retex/laid.h>
#include <retex/set_file.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "bench.h"
#include "render/render.h"
#include "lib_test.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

enum { SPP = 16, REFERENCE_SPP = 16 };

/* A scene parsed twice, without and with targets; and what was made of it. */
typedef struct Room {
    Scene *plain, *targets;
    RenderParams params;
    RetexTextureSpec texture;
    char files[3][512]; /* the set: EXR as it is written, EXR without compression, pack */
    int fast, slow;     /* of files: what is compared */
} Room;

static Scene *parse(const char *path, const char *const *targets, int ntargets)
{
    Scene *scene;
    RetexError err = {0};
    test_must(sdl_read(&scene, path, NULL, &scene_builder, &err), &err);
    if (ntargets)
        test_must(scene_resolve_targets(scene, targets, ntargets, &err), &err);
    return scene;
}

static RetexSet *render(const Scene *scene, const RenderParams *params, int plain, int spp)
{
    RenderParams p = *params;
    RenderStats stats;
    RetexSet *set;
    RetexError err = {0};
    p.plain = plain;
    p.spp = spp;
    test_must(render_scene(&set, scene, &p, &stats, &err), &err);
    return set;
}

static void render_plain(void *context)
{
    Room *room = context;
    RetexSet *set = render(room->plain, &room->params, 1, SPP);
    retex_set_close(&set);
}

static void render_set(void *context)
{
    Room *room = context;
    RetexSet *set = render(room->targets, &room->params, 0, SPP);
    retex_set_close(&set);
}

static void render_again(void *context)
{
    Room *room = context;
    RetexSet *set = render(room->plain, &room->params, 1, REFERENCE_SPP);
    retex_set_close(&set);
}

/* From the set's file and a texture's to a picture. */
static void retexture(void *context)
{
    Room *room = context;
    RetexSet *set;
    RetexImage picture = {0};
    RetexError err = {0};
    test_must(retex_set_read(room->files[room->fast], &set, 1, &err), &err);
    test_must(retex_sample(set, &room->texture, 1, 1, &err), &err);
    test_must(retex_combine(&picture, set, NULL, NULL, 1, &err), &err);
    bench_sink = picture.pixels[0];
    retex_image_free(&picture);
    retex_set_close(&set);
}

static void read_file(const char *path)
{
    RetexSet *set;
    RetexError err = {0};
    test_must(retex_set_read(path, &set, 1, &err), &err);
    bench_sink = set->parts[0].image.pixels[0];
    retex_set_close(&set);
}

static void read_fast(void *context)
{
    Room *room = context;
    read_file(room->files[room->fast]);
}

static void read_slow(void *context)
{
    Room *room = context;
    read_file(room->files[room->slow]);
}

static void bench_overhead(const char *scenes, const char *name, const char *const *targets, int ntargets, int width,
                           int height)
{
    Room room = {.params = RENDER_PARAMS_INIT};
    char text[96], path[512];
    snprintf(path, sizeof path, "%s/%s/%s.pov", scenes, name, name);
    room.plain = parse(path, NULL, 0);
    room.targets = parse(path, targets, ntargets);
    room.params.width = width;
    room.params.height = height;
    room.params.nthreads = 1;
    snprintf(text, sizeof text, "%s, %dx%d, %d samples a pixel, %d target%s", name, width, height, SPP, ntargets,
             ntargets == 1 ? "" : "s");
    bench_pair(text, render_plain, render_set, &room);
    scene_close(&room.plain);
    scene_close(&room.targets);
}

static double file_bytes(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 ? (double)info.st_size : 0;
}

/* The living room's set, rendered with few samples: noise makes it harder to store, not easier. */
static void make_files(Room *room, const char *folder)
{
    RetexStoreParams store = RETEX_STORE_INIT;
    RetexError err = {0};
    RetexSet *set = render(room->targets, &room->params, 0, 4);
    snprintf(room->files[0], sizeof room->files[0], "%s/set.exr", folder);
    snprintf(room->files[1], sizeof room->files[1], "%s/plain.exr", folder);
    snprintf(room->files[2], sizeof room->files[2], "%s/set.retex", folder);
    test_must(retex_set_write(set, room->files[0], NULL, 0, &err), &err);
    store.compress = 0;
    test_must(retex_set_write(set, room->files[1], &store, 0, &err), &err);
    test_must(retex_pack_write(set, room->files[2], NULL, NULL, 0, &err), &err);
    retex_set_close(&set);
}

static void bench_files(const char *scenes, const char *folder)
{
    static const char *const targets[] = {"Floor", "Wall"};
    Room room = {.params = RENDER_PARAMS_INIT, .texture = RETEX_TEXTURE_SPEC_INIT};
    RetexError err = {0};
    char path[512], argument[600], name[96];
    snprintf(path, sizeof path, "%s/living-room/living-room.pov", scenes);
    snprintf(argument, sizeof argument, "Floor=%s/textures/terrazzo.jpg", scenes);
    test_must(test_texture_spec(&room.texture, "", argument, &err), &err);
    room.plain = parse(path, NULL, 0);
    room.targets = parse(path, targets, 2);
    room.params.width = 192;
    room.params.height = 108;
    room.params.nthreads = 1;
    make_files(&room, folder);

    bench_section("Retexturing a set: times as fast as rendering anew");
    snprintf(name, sizeof name, "living-room, 192x108, an image on the floor, against %d samples a pixel",
             REFERENCE_SPP);
    bench_pair(name, retexture, render_again, &room);
    test_must(test_texture_spec(&room.texture, "", "Floor=rgb(0.4,0.3,0.2)", &err), &err);
    snprintf(name, sizeof name, "the same with a colour");
    bench_pair(name, retexture, render_again, &room);

    bench_section("Reading a set: times as fast as its compressed EXR");
    room.slow = 0;
    room.fast = 1;
    bench_pair("EXR without compression, living-room, 192x108, two targets", read_fast, read_slow, &room);
    room.fast = 2;
    bench_pair("pack", read_fast, read_slow, &room);
    bench_section("Size of a set: times as large as its pack");
    bench_ratio("compressed EXR", file_bytes(room.files[0]) / file_bytes(room.files[2]));
    bench_ratio("EXR without compression", file_bytes(room.files[1]) / file_bytes(room.files[2]));
    scene_close(&room.plain);
    scene_close(&room.targets);
}

void bench_pictures(const char *scenes, const char *folder)
{
    static const char *const targets[] = {"Floor", "Wall"};
    bench_section("Rendering a set (layout paper): times as long as --plain");
    bench_overhead(scenes, "cornell-box", targets, 1, 128, 128);
    bench_overhead(scenes, "glass-caustics", targets, 1, 160, 120);
    bench_overhead(scenes, "living-room", targets, 1, 160, 90);
    bench_overhead(scenes, "living-room", targets, 2, 160, 90);
    bench_files(scenes, folder);
}
