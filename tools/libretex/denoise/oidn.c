/* Open Image Denoise 2, where the user has it: nothing of it is needed to build, it is opened when it is asked for.
 *
 * What its functions take and return, and what its constants are, comes from the documentation of its C interface. */
#include "denoise/picture_denoiser.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stdlib.h>

#include <retex/parallel.h>

enum { DEVICE_CPU = 1, FORMAT_FLOAT3 = 3, MAJOR_VERSION = 2 };
enum { ERROR_NONE = 0, ERROR_OUT_OF_MEMORY = 4 };

/* Most memory of the network, in MB: larger pictures are filtered in tiles that overlap. The same on every machine,
 * because tiles may change the last bits. */
enum { MEMORY_MOST = 3000, MEMORY_LEAST = 64 };

typedef bool OidnProgress(void *context, double done);

/* X(result, name, parameters). Devices and filters are opaque. */
#define OIDN_FUNCTIONS(X)                                                                                              \
    X(void *, oidnNewDevice, (int type))                                                                               \
    X(void, oidnReleaseDevice, (void *device))                                                                         \
    X(void, oidnSetDeviceBool, (void *device, const char *name, bool value))                                           \
    X(void, oidnSetDeviceInt, (void *device, const char *name, int value))                                             \
    X(int, oidnGetDeviceInt, (void *device, const char *name))                                                         \
    X(int, oidnGetDeviceError, (void *device, const char **message))                                                   \
    X(void, oidnCommitDevice, (void *device))                                                                          \
    X(void *, oidnNewFilter, (void *device, const char *type))                                                         \
    X(void, oidnReleaseFilter, (void *filter))                                                                         \
    X(void, oidnSetSharedFilterImage,                                                                                  \
      (void *filter, const char *name, void *pixels, int format, size_t width, size_t height, size_t offset,           \
       size_t pixel_stride, size_t row_stride))                                                                        \
    X(void, oidnSetFilterBool, (void *filter, const char *name, bool value))                                           \
    X(void, oidnSetFilterInt, (void *filter, const char *name, int value))                                             \
    X(void, oidnSetFilterProgressMonitorFunction, (void *filter, OidnProgress *progress, void *context))               \
    X(void, oidnCommitFilter, (void *filter))                                                                          \
    X(void, oidnExecuteFilter, (void *filter))

#define OIDN_MEMBER(result, name, parameters) result(*name) parameters;
typedef struct OidnLibrary {
    OIDN_FUNCTIONS(OIDN_MEMBER)
} OidnLibrary;

typedef struct Oidn {
    OidnLibrary library;
    void *device;
    const RetexBudget *budget;
} Oidn;

/* ---- the library ---- */

static const char *const usual_names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so"};

/* A library that the user names is not replaced by another. */
static void *open_library(const char **name, RetexError *err)
{
    const char *named = getenv("RETEX_OIDN");
    const int count = named && *named ? 1 : 2;
    for (int k = 0; k < count; k++) {
        *name = named && *named ? named : usual_names[k];
        void *library = dlopen(*name, RTLD_NOW | RTLD_LOCAL);
        if (library)
            return library;
        const char *why = dlerror();
        if (k == 0)
            retex_fail(err, RETEX_EUNSUPPORTED, "Open Image Denoise 2 cannot be loaded: %s",
                       why ? why : "unknown reason");
    }
    return NULL;
}

/* ISO C has no conversion from object to function pointers; POSIX guarantees this one. */
#define OIDN_FIND(result, function, parameters)                                                                        \
    *(void **)&library->function = dlsym(handle, #function);                                                           \
    if (!library->function)                                                                                            \
        return retex_fail(err, RETEX_EUNSUPPORTED, "%s has no %s: Open Image Denoise 2 is needed", name, #function);

/* The library stays open until the process ends, because its threads may outlive a device. */
static int load(OidnLibrary *library, RetexError *err)
{
    const char *name = NULL;
    void *handle = open_library(&name, err);
    if (!handle)
        return RETEX_EUNSUPPORTED;
    OIDN_FUNCTIONS(OIDN_FIND)
    return RETEX_OK;
}

/* ---- the device ---- */

/* The first error since the last call. A device that could not be made is NULL, and has one, too. */
static int check(const Oidn *o, RetexError *err)
{
    const char *message = NULL;
    const int error = o->library.oidnGetDeviceError(o->device, &message);
    const int code = retex_budget_check(o->budget, err); /* which is why a filter is cancelled */
    if (code || error == ERROR_NONE)
        return code;
    return retex_fail(err, error == ERROR_OUT_OF_MEMORY ? RETEX_ENOMEM : RETEX_EUNSUPPORTED,
                      "Open Image Denoise failed: %s", message && *message ? message : "it does not say why");
}

/* What it made, or why it made nothing. */
static int check_made(const Oidn *o, const void *made, const char *what, RetexError *err)
{
    const int code = check(o, err);
    return code || made ? code : retex_fail(err, RETEX_EUNSUPPORTED, "Open Image Denoise makes no %s", what);
}

/* The CPU's device, because only there every library reads the program's own memory. */
static int open_device(Oidn *o, int nthreads, RetexError *err)
{
    o->device = o->library.oidnNewDevice(DEVICE_CPU);
    int code = check_made(o, o->device, "device", err);
    if (code)
        return code;
    const int version = o->library.oidnGetDeviceInt(o->device, "versionMajor");
    if (version != MAJOR_VERSION)
        return retex_fail(err, RETEX_EUNSUPPORTED, "Open Image Denoise is of version %d: version %d is needed", version,
                          MAJOR_VERSION);
    o->library.oidnSetDeviceInt(o->device, "numThreads", retex_threads(nthreads));
    o->library.oidnSetDeviceBool(o->device, "setAffinity", false); /* other programs use these cores, too */
    o->library.oidnCommitDevice(o->device);
    return check(o, err);
}

static void close_oidn(void **state)
{
    Oidn *o = state ? *state : NULL;
    if (!o)
        return;
    if (o->device)
        o->library.oidnReleaseDevice(o->device);
    free(o);
    *state = NULL;
}

static int open_oidn(void **state, int nthreads, const RetexBudget *budget, RetexError *err)
{
    Oidn *o = *state = calloc(1, sizeof *o);
    if (!o)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    o->budget = budget;
    int code = load(&o->library, err);
    if (!code)
        code = open_device(o, nthreads, err);
    if (code)
        close_oidn(state);
    return code;
}

/* ---- the filter ---- */

static bool may_go_on(void *context, double done)
{
    const Oidn *o = context;
    (void)done;
    return !retex_budget_is_stopped(o->budget);
}

static void set_image(const Oidn *o, void *filter, const char *name, const float *pixels,
                      const RetexDenoiserImages *images)
{
    o->library.oidnSetSharedFilterImage(filter, name, (void *)pixels, FORMAT_FLOAT3, (size_t)images->width,
                                        (size_t)images->height, 0, 0, 0);
}

/* Half of what is left, because it counts only the largest part of what it takes. */
static int memory_megabytes(const RetexBudget *budget)
{
    const uint64_t half = retex_budget_left(budget) >> 21;
    return half < MEMORY_LEAST ? MEMORY_LEAST : half < MEMORY_MOST ? (int)half : MEMORY_MOST;
}

static int filter_picture(void *state, const RetexDenoiserImages *images, RetexError *err)
{
    Oidn *o = state;
    void *filter = o->library.oidnNewFilter(o->device, "RT");
    int code = check_made(o, filter, "filter", err);
    if (!code) {
        set_image(o, filter, "color", images->color, images);
        set_image(o, filter, "albedo", images->albedo, images);
        set_image(o, filter, "normal", images->normal, images);
        set_image(o, filter, "output", images->result, images);
        o->library.oidnSetFilterBool(filter, "hdr", true);
        o->library.oidnSetFilterInt(filter, "maxMemoryMB", memory_megabytes(o->budget));
        o->library.oidnSetFilterProgressMonitorFunction(filter, may_go_on, o);
        o->library.oidnCommitFilter(filter);
        code = check(o, err);
    }
    if (!code) {
        o->library.oidnExecuteFilter(filter);
        code = check(o, err);
    }
    if (filter)
        o->library.oidnReleaseFilter(filter);
    return code;
}

const RetexPictureDenoiser retex_oidn = {"Open Image Denoise", open_oidn, filter_picture, close_oidn};
