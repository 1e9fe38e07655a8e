/* Finds and loads libretex-oiio.so, once per process, when the first picture needs it. */
#include "picture/bridge_load.h"
#include "exr/color_tag.h"
#include "io/pending_files.h"
#include "picture/beside.h"
#include "picture/jpeg_read.h"
#include "picture/png_read.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

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
    RetexBridgePrepare *prepare;
    char message[512]; /* why it could not be loaded; "" = it is loaded */
    int is_left_out, was_missed;
    char missed_space[256]; /* of the file for which it was missed */
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

/* One that is found but cannot be loaded is not replaced by another, whose version nobody knows. */
static void *find_library(void)
{
    RetexBesidePath path;
    return open_library(retex_beside_find(path, BRIDGE_NAME) ? path : BRIDGE_NAME);
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
    *(void **)&bridge.prepare = dlsym(library, "retex_oiio_prepare");
    if (!abi || !bridge.read || !bridge.read_narrow || !bridge.plan || !bridge.plan_free || !bridge.convert ||
        !bridge.write || !bridge.check || !bridge.remove || !bridge.prepare || abi() != RETEX_BRIDGE_ABI)
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

static const RetexBridgeHost host = {
    retex_image_alloc,     retex_image_free,    malloc, free, retex_color_tag_to_rec709,
    retex_jpeg_is_damaged, retex_png_is_damaged};

/* Ready to read a file, unless the bridge is left out. */
static int ready_to_read(const RetexBridgeFile *file, RetexError *err)
{
    if (!bridge.is_left_out)
        return bridge_ready(file->path, err);
    bridge.was_missed = 1;
    snprintf(bridge.missed_space, sizeof bridge.missed_space, "%s", file->colorspace ? file->colorspace : "");
    return retex_fail_at(err, RETEX_EUNSUPPORTED, file->path, 0, 0, "this needs OpenImageIO");
}

void retex_bridge_leave_out(void)
{
    bridge.is_left_out = 1;
}

const char *retex_bridge_missed(void)
{
    return bridge.was_missed ? bridge.missed_space : NULL;
}

int retex_bridge_prepare(const RetexBridgeFile *file, RetexError *err)
{
    int code = bridge_ready(file->path, err);
    return code ? code : bridge.prepare(file, err);
}

int retex_bridge_read(RetexImage *dst, const RetexBridgeFile *file, RetexError *err)
{
    int code = ready_to_read(file, err);
    return code ? code : bridge.read(&host, dst, file, err);
}

int retex_bridge_read_narrow(RetexNarrowImage *dst, const RetexBridgeFile *file, RetexError *err)
{
    int code = ready_to_read(file, err);
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
