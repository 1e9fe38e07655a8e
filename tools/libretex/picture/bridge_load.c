/* Finds and loads libretex-oiio.so, once per process, when the first picture needs it. */
#include "picture/bridge_load.h"
#include "exr/color_tag.h"
#include "io/pending_files.h"

#include <dlfcn.h>
#include <limits.h>
#include <link.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#define BRIDGE_NAME "libretex-oiio.so"

static struct {
    pthread_once_t once;
    RetexBridgeRead *read;
    RetexBridgeReadNarrow *read_narrow;
    RetexBridgeMakePlan *plan;
    RetexBridgeFreePlan *plan_free;
    RetexBridgeConvert *convert;
    RetexBridgeWrite *write;
    RetexBridgeCheck *check;
    RetexBridgeRemove *remove;
    char message[512]; /* why it could not be loaded; "" = it is loaded */
} bridge = {.once = PTHREAD_ONCE_INIT};

static void keep_message(const char *text)
{
    snprintf(bridge.message, sizeof bridge.message, "%s", text ? text : "unknown reason");
}

/* RTLD_LOCAL keeps the symbols of the two hundred libraries that OpenImageIO needs away from the host program. */
static void *open_library(const char *path)
{
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        keep_message(dlerror());
    return library;
}

/* The bridge in a folder below the one of `file`, or of one above it, if it is there. */
static void *open_near(const char *file, int levels, const char *below)
{
    char folder[PATH_MAX];
    if (snprintf(folder, sizeof folder, "%s", file) >= (int)sizeof folder)
        return NULL;
    for (; levels > 0; levels--) {
        char *slash = strrchr(folder, '/');
        if (!slash)
            return NULL;
        *slash = '\0';
        char path[PATH_MAX + 32];
        snprintf(path, sizeof path, "%s/%s" BRIDGE_NAME, folder, below);
        if (access(path, R_OK) == 0)
            return open_library(path);
    }
    return NULL;
}

/* Beside the shared library that this code is in: libretex.so.1, whatever program uses it, or a plugin, which is in
 * PREFIX/lib/retex/plugins, or in build/plugins. Its symbolic links are followed only where that finds nothing. */
static void *open_near_library(void)
{
    static const char here;
    Dl_info info;
    struct link_map *map = NULL;
    if (!dladdr1(&here, &info, (void **)&map, RTLD_DL_LINKMAP) || !map || !map->l_name[0])
        return NULL; /* it is in the program itself */
    void *library = open_near(map->l_name, 3, "");
    if (!library && !bridge.message[0])
        library = open_near(map->l_name, 2, "lib/");
    char *resolved = library || bridge.message[0] ? NULL : realpath(map->l_name, NULL);
    if (resolved)
        library = open_near(resolved, 3, "");
    free(resolved);
    return library;
}

/* Beside the program that contains the library: PREFIX/bin/retex-x -> PREFIX/lib, and the same for a program run from
 * build/. A program deeper in the tree (a unit test) is served by the folders above. */
static void *open_near_program(void)
{
    char program[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length <= 0)
        return NULL;
    program[length] = '\0';
    return open_near(program, 3, "lib/");
}

/* One that is found but cannot be loaded is not replaced by another, whose version nobody knows: its message stays. */
static void *find_library(void)
{
    void *library = open_near_library();
    if (!library && !bridge.message[0])
        library = open_near_program();
#ifdef RETEX_BRIDGE_FOLDER
    if (!library && !bridge.message[0] && access(RETEX_BRIDGE_FOLDER "/" BRIDGE_NAME, R_OK) == 0)
        library = open_library(RETEX_BRIDGE_FOLDER "/" BRIDGE_NAME);
#endif
    return library || bridge.message[0] ? library : open_library(BRIDGE_NAME);
}

static void load_bridge(void)
{
    const char *named = getenv("RETEX_BRIDGE");
    /* the user named this one: no other may replace it */
    void *library = named && *named ? open_library(named) : find_library();
    if (!library)
        return;
    /* ISO C has no conversion from object to function pointers; POSIX guarantees this one. */
    RetexBridgeAbi *abi = NULL;
    *(void **)&abi = dlsym(library, "retex_oiio_abi");
    *(void **)&bridge.read = dlsym(library, "retex_oiio_read");
    *(void **)&bridge.read_narrow = dlsym(library, "retex_oiio_read_narrow");
    *(void **)&bridge.plan = dlsym(library, "retex_oiio_plan");
    *(void **)&bridge.plan_free = dlsym(library, "retex_oiio_plan_free");
    *(void **)&bridge.convert = dlsym(library, "retex_oiio_convert");
    *(void **)&bridge.write = dlsym(library, "retex_oiio_write");
    *(void **)&bridge.check = dlsym(library, "retex_oiio_check");
    *(void **)&bridge.remove = dlsym(library, "retex_oiio_remove");
    if (!abi || !bridge.read || !bridge.read_narrow || !bridge.plan || !bridge.plan_free || !bridge.convert ||
        !bridge.write || !bridge.check || !bridge.remove || abi() != RETEX_BRIDGE_ABI)
        keep_message(BRIDGE_NAME " is of another version");
    else {
        bridge.message[0] = '\0';
        retex_pending_files_set_hook(bridge.remove);
    }
}

static int bridge_ready(const char *path, RetexError *err)
{
    pthread_once(&bridge.once, load_bridge);
    if (bridge.message[0])
        return retex_fail_at(err, RETEX_EUNSUPPORTED, path, 0, 0, "this needs OpenImageIO, which cannot be loaded: %s",
                             bridge.message);
    return RETEX_OK;
}

int retex_names_linear(const char *colorspace)
{
    return !colorspace || !colorspace[0] || strcasecmp(colorspace, "linear") == 0 ||
           strcasecmp(colorspace, "scene_linear") == 0;
}

static const RetexBridgeHost host = {retex_image_alloc, retex_image_free, malloc, free, retex_color_tag_to_rec709};

int retex_bridge_read(RetexImage *dst, const RetexBridgeFile *file, RetexError *err)
{
    int code = bridge_ready(file->path, err);
    return code ? code : bridge.read(&host, dst, file, err);
}

int retex_bridge_read_narrow(RetexNarrowImage *dst, const RetexBridgeFile *file, RetexError *err)
{
    int code = bridge_ready(file->path, err);
    return code ? code : bridge.read_narrow(&host, dst, file, err);
}

int retex_bridge_plan(RetexBridgePlan **plan, RetexBridgeStored *stored, const char *path, int width, int height,
                      int channels, const RetexWriteParams *params, RetexError *err)
{
    int code = bridge_ready(path, err);
    *plan = NULL;
    return code ? code : bridge.plan(plan, stored, path, width, height, channels, params, err);
}

/* A plan exists only if the bridge is loaded. */
void retex_bridge_plan_free(RetexBridgePlan **plan)
{
    if (plan && *plan)
        bridge.plan_free(plan);
}

int retex_bridge_convert(const RetexBridgePlan *plan, const float *rows, long pixels, void *samples, RetexError *err)
{
    return bridge.convert(plan, rows, pixels, samples, err);
}

int retex_bridge_write(const RetexBridgePlan *plan, const void *samples, RetexBridgeSink *sink, void *context,
                       RetexError *err)
{
    return bridge.write(plan, samples, sink, context, err);
}

int retex_bridge_check(const char *path, const RetexWriteParams *params, RetexError *err)
{
    int code = bridge_ready(path, err);
    return code ? code : bridge.check(path, params, err);
}
