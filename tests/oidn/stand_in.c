/* Stands in for Open Image Denoise 2 in tests: its filter is the mean of the 3x3 pixels around each pixel. It has the
 * functions that retex calls, and no others. OIDN_STAND_IN, in the environment, says what goes wrong: the words are
 * those that wrong() is called with. It is built a second time without oidnSetFilterInt, as an older library is. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "stand_in.h"

#define API __attribute__((visibility("default")))

enum { TYPE_CPU = 1, FLOAT3 = 3 };
enum { NONE, UNKNOWN, INVALID_ARGUMENT, INVALID_OPERATION, OUT_OF_MEMORY, UNSUPPORTED_HARDWARE, CANCELLED };

typedef bool Progress(void *context, double done);
typedef struct Device {
    int is_committed;
} Device;
typedef struct Filter {
    float *color, *albedo, *normal, *output;
    size_t width, height;
    bool hdr;
    int is_committed;
    Progress *progress;
    void *context;
} Filter;

API extern OidnStandIn oidn_stand_in;
OidnStandIn oidn_stand_in;
static int error;
static const char *error_text;

static int wrong(const char *what)
{
    const char *wanted = getenv("OIDN_STAND_IN");
    return wanted && strcmp(wanted, what) == 0;
}

static void fail(int code, const char *text)
{
    if (error == NONE)
        error = code, error_text = text;
}

static void misuse(int is_wrong)
{
    oidn_stand_in.misused += is_wrong != 0;
}

static void *make(size_t bytes)
{
    void *made = calloc(1, bytes);
    if (!made)
        fail(OUT_OF_MEMORY, "out of memory");
    return made;
}

/* ---- devices ---- */

API void *oidnNewDevice(int type)
{
    oidn_stand_in.type = type;
    if (wrong("no-device")) {
        fail(UNSUPPORTED_HARDWARE, "unsupported hardware");
        return NULL;
    }
    if (wrong("nothing"))
        return NULL;
    misuse(type != TYPE_CPU);
    Device *device = make(sizeof *device);
    oidn_stand_in.devices += device != NULL, oidn_stand_in.made_devices++;
    return device;
}

API void oidnReleaseDevice(void *device)
{
    misuse(!device || oidn_stand_in.filters);
    oidn_stand_in.devices--;
    free(device);
}

API void oidnSetDeviceBool(void *device, const char *name, bool value)
{
    misuse(!device || strcmp(name, "setAffinity") != 0);
    oidn_stand_in.affinity = value;
}

API void oidnSetDeviceInt(void *device, const char *name, int value)
{
    misuse(!device || strcmp(name, "numThreads") != 0);
    oidn_stand_in.threads = value;
}

API int oidnGetDeviceInt(void *device, const char *name)
{
    misuse(!device || strcmp(name, "versionMajor") != 0);
    return wrong("version-1") ? 1 : 2;
}

API int oidnGetDeviceError(void *device, const char **message)
{
    const int code = error;
    (void)device;
    *message = code ? error_text : NULL;
    error = NONE;
    return code;
}

API void oidnCommitDevice(void *device)
{
    ((Device *)device)->is_committed = 1;
    if (wrong("device"))
        fail(UNKNOWN, "the device is broken");
}

/* ---- filters ---- */

API void *oidnNewFilter(void *device, const char *type)
{
    misuse(!device || !((Device *)device)->is_committed || strcmp(type, "RT") != 0);
    if (wrong("no-filter")) {
        fail(INVALID_ARGUMENT, "unknown filter type");
        return NULL;
    }
    Filter *filter = make(sizeof *filter);
    oidn_stand_in.filters += filter != NULL, oidn_stand_in.made_filters++;
    return filter;
}

API void oidnReleaseFilter(void *filter)
{
    misuse(!filter);
    oidn_stand_in.filters--;
    free(filter);
}

API void oidnSetSharedFilterImage(void *filter, const char *name, void *pixels, int format, size_t width, size_t height,
                                  size_t offset, size_t pixel_stride, size_t row_stride)
{
    Filter *f = filter;
    float **of = strcmp(name, "color") == 0    ? &f->color
                 : strcmp(name, "albedo") == 0 ? &f->albedo
                 : strcmp(name, "normal") == 0 ? &f->normal
                 : strcmp(name, "output") == 0 ? &f->output
                                               : NULL;
    misuse(!of || format != FLOAT3 || offset || (pixel_stride && pixel_stride != 12) ||
           (row_stride && row_stride != 12 * width) || (f->width && (f->width != width || f->height != height)));
    if (of)
        *of = pixels;
    f->width = width, f->height = height, f->is_committed = 0;
}

API void oidnSetFilterBool(void *filter, const char *name, bool value)
{
    Filter *f = filter;
    misuse(strcmp(name, "hdr") != 0);
    f->hdr = value, f->is_committed = 0;
}

#ifndef OLDER
API void oidnSetFilterInt(void *filter, const char *name, int value)
{
    misuse(strcmp(name, "maxMemoryMB") != 0);
    oidn_stand_in.megabytes = value;
    ((Filter *)filter)->is_committed = 0;
}
#endif

API void oidnSetFilterProgressMonitorFunction(void *filter, Progress *progress, void *context)
{
    ((Filter *)filter)->progress = progress, ((Filter *)filter)->context = context;
}

API void oidnCommitFilter(void *filter)
{
    Filter *f = filter;
    f->is_committed = 1;
    if (!f->color || !f->albedo || !f->normal || !f->output || !f->hdr)
        fail(INVALID_OPERATION, "something is missing");
    if (wrong("commit"))
        fail(UNSUPPORTED_HARDWARE, "the filter is broken");
}

static void keep(const Filter *f)
{
    OidnStandIn *s = &oidn_stand_in;
    const size_t count = 3 * f->width * f->height;
    s->executed++, s->width = (int)f->width, s->height = (int)f->height;
    if (s->npictures == OIDN_PICTURES || count > 3 * OIDN_PIXELS)
        return;
    memcpy(s->color[s->npictures], f->color, count * sizeof(float));
    memcpy(s->albedo[s->npictures], f->albedo, count * sizeof(float));
    memcpy(s->normal[s->npictures++], f->normal, count * sizeof(float));
}

static float mean_around(const Filter *f, long x, long y, int c)
{
    const long width = (long)f->width, height = (long)f->height;
    float sum = 0;
    int count = 0;
    for (long v = y > 0 ? y - 1 : 0; v <= y + 1 && v < height; v++)
        for (long u = x > 0 ? x - 1 : 0; u <= x + 1 && u < width; u++, count++)
            sum += f->color[3 * (v * width + u) + c];
    return sum / (float)count;
}

/* 1 if it was told to stop within ten seconds. */
static int is_cancelled(const Filter *f)
{
    const struct timespec pause = {0, 10000000};
    for (int k = 0; k < 1000; k++) {
        if (!f->progress(f->context, k / 1000.0)) {
            oidn_stand_in.cancelled++;
            return 1;
        }
        nanosleep(&pause, NULL);
    }
    return 0;
}

API void oidnExecuteFilter(void *filter)
{
    Filter *f = filter;
    misuse(!f->is_committed);
    keep(f);
    if (wrong("slow") && is_cancelled(f)) {
        fail(CANCELLED, "execution was cancelled");
        return;
    }
    if (wrong("filter"))
        fail(UNKNOWN, "the network is broken");
    if (wrong("silent"))
        fail(UNKNOWN, "");
    if (wrong("memory"))
        fail(OUT_OF_MEMORY, "out of memory");
    for (long y = 0; y < (long)f->height; y++)
        for (long x = 0; x < (long)f->width; x++)
            for (int c = 0; c < 3; c++)
                f->output[3 * (y * (long)f->width + x) + c] = mean_around(f, x, y, c);
    if (wrong("nan"))
        f->output[3 * f->width * f->height - 1] = NAN;
    if (wrong("infinite"))
        f->output[0] = INFINITY;
    if (wrong("negative"))
        f->output[4] = -1;
}
