/* Rays against a model's triangles, through Embree, whose errors are translated here. Builds with Embree 3 and 4. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#if defined(RETEX_EMBREE4)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "import/space/space.h"

#define GROUND 0.05 /* of the height of all: as high is no more than ground */
#define WIDER 3     /* as often as what stands on it the ground is as large, and more: that is around it */
#define MARGIN 0.1  /* of it that is seen on each side, in widths of what stands */

struct Space {
    RTCDevice device;
    RTCScene scene;
    SpaceTriangles triangles;
    double low[3], high[3], standing_low[3], standing_high[3];
    RetexError error; /* Embree's first */
};

static void record_error(void *context, enum RTCError code, const char *text)
{
    Space *space = context;
    if (space->error.code == 0)
        retex_fail(&space->error, code == RTC_ERROR_OUT_OF_MEMORY ? RETEX_ENOMEM : RETEX_EINTERNAL, "Embree: %s",
                   text ? text : "unknown error");
}

/* Of the triangles that rise above a height. */
static void find_bounds(const SpaceTriangles *t, double above, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++)
        low[k] = INFINITY, high[k] = -INFINITY;
    for (size_t i = 0; i < t->ntriangles; i++) {
        const uint32_t *corners = t->corners[i];
        const float *v[] = {t->vertices[corners[0]], t->vertices[corners[1]], t->vertices[corners[2]]};
        if ((double)fmaxf(v[0][1], fmaxf(v[1][1], v[2][1])) <= above)
            continue;
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], (double)fminf(v[0][k], fminf(v[1][k], v[2][k])));
            high[k] = fmax(high[k], (double)fmaxf(v[0][k], fmaxf(v[1][k], v[2][k])));
        }
    }
}

static void find_standing(Space *space)
{
    double low[3], high[3], *to_low = space->standing_low, *to_high = space->standing_high;
    find_bounds(&space->triangles, space->low[1] + GROUND * (space->high[1] - space->low[1]), low, high);
    memcpy(to_low, space->low, sizeof space->low);
    memcpy(to_high, space->high, sizeof space->high);
    if (!(low[0] <= high[0]) ||
        WIDER * (high[0] - low[0]) * (high[2] - low[2]) > (to_high[0] - to_low[0]) * (to_high[2] - to_low[2]))
        return;
    for (int k = 0; k < 3; k += 2) {
        const double margin = MARGIN * (high[k] - low[k]);
        to_low[k] = fmax(to_low[k], low[k] - margin), to_high[k] = fmin(to_high[k], high[k] + margin);
    }
}

/* Embree reads whole vectors: the last vertex needs a float more behind it. */
static int add_geometry(Space *space, RetexError *err)
{
    SpaceTriangles *t = &space->triangles;
    float(*padded)[3] = realloc(t->vertices, (t->nvertices + 2) * sizeof *padded);
    if (!padded)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    t->vertices = padded;
    memset(padded[t->nvertices], 0, 2 * sizeof *padded);
    RTCGeometry geometry = rtcNewGeometry(space->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, t->vertices, 0,
                               sizeof *t->vertices, t->nvertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, t->corners, 0, sizeof *t->corners,
                               t->ntriangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(space->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(space->scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    rtcCommitScene(space->scene);
    if (space->error.code)
        return retex_fail(err, space->error.code, "%s", space->error.message);
    return RETEX_OK;
}

int space_create(Space **out, SpaceTriangles *triangles, RetexError *err)
{
    Space *space = calloc(1, sizeof *space);
    *out = NULL;
    if (!space) {
        free(triangles->vertices);
        free(triangles->corners);
        free(triangles->tags);
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    }
    space->triangles = *triangles;
    memset(triangles, 0, sizeof *triangles);
    space->device = rtcNewDevice("threads=1,set_affinity=0");
    int code = space->device ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "Embree does not start");
    if (!code) {
        rtcSetDeviceErrorFunction(space->device, record_error, space);
        space->scene = rtcNewScene(space->device);
        if (!space->scene)
            code = retex_fail(err, RETEX_ENOMEM, "out of memory");
    }
    if (!code) {
        find_bounds(&space->triangles, -INFINITY, space->low, space->high);
        find_standing(space);
        code = space_load(&space->triangles, space->low, space->high) > SPACE_MOST_LOAD
                   ? retex_fail(err, RETEX_ELIMIT, "too many triangles lie at one place")
                   : add_geometry(space, err);
    }
    if (code)
        space_free(space);
    else
        *out = space;
    return code;
}

void space_free(Space *space)
{
    if (!space)
        return;
    if (space->scene)
        rtcReleaseScene(space->scene);
    if (space->device)
        rtcReleaseDevice(space->device);
    free(space->triangles.vertices);
    free(space->triangles.corners);
    free(space->triangles.tags);
    free(space);
}

/* Half of its surface. */
static double half_surface(const double low[3], const double high[3])
{
    const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x * y + y * z + z * x;
}

double space_load(const SpaceTriangles *triangles, const double low[3], const double high[3])
{
    const double whole = half_surface(low, high);
    double sum = 0;
    for (size_t i = 0; i < triangles->ntriangles; i++) {
        const uint32_t *corner = triangles->corners[i];
        double from[3], to[3];
        int is_within = 1;
        for (int k = 0; k < 3; k++) {
            const float *a = triangles->vertices[corner[0]], *b = triangles->vertices[corner[1]],
                        *c = triangles->vertices[corner[2]];
            from[k] = fmax(low[k], (double)fminf(a[k], fminf(b[k], c[k])));
            to[k] = fmin(high[k], (double)fmaxf(a[k], fmaxf(b[k], c[k])));
            is_within &= from[k] <= to[k];
        }
        sum += is_within ? half_surface(from, to) : 0;
    }
    return whole > 0 ? sum / whole : 0;
}

void space_bounds(const Space *space, double low[3], double high[3])
{
    memcpy(low, space->low, sizeof space->low);
    memcpy(high, space->high, sizeof space->high);
}

void space_standing_bounds(const Space *space, double low[3], double high[3])
{
    memcpy(low, space->standing_low, sizeof space->standing_low);
    memcpy(high, space->standing_high, sizeof space->standing_high);
}

const SpaceTriangles *space_triangles(const Space *space)
{
    return &space->triangles;
}

int space_ray(const Space *space, const double from[3], const double direction[3], double tmin, double tmax,
              SpaceHit *hit)
{
    struct RTCRayHit ray = {0};
    double length = 0;
    ray.ray.org_x = (float)from[0], ray.ray.org_y = (float)from[1], ray.ray.org_z = (float)from[2];
    ray.ray.dir_x = (float)direction[0], ray.ray.dir_y = (float)direction[1], ray.ray.dir_z = (float)direction[2];
    ray.ray.tnear = (float)tmin, ray.ray.tfar = (float)tmax;
    ray.ray.mask = ~0u;
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if defined(RETEX_EMBREE4)
    rtcIntersect1(space->scene, &ray, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(space->scene, &context, &ray);
#endif
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return 0;
    hit->t = (double)ray.ray.tfar;
    hit->triangle = ray.hit.primID;
    hit->tag = space->triangles.tags[hit->triangle];
    const uint32_t *corner = space->triangles.corners[hit->triangle];
    const float *a = space->triangles.vertices[corner[0]], *b = space->triangles.vertices[corner[1]],
                *c = space->triangles.vertices[corner[2]];
    double towards = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        hit->point[k] = from[k] + hit->t * direction[k];
        hit->normal[k] = ((double)b[i] - (double)a[i]) * ((double)c[j] - (double)a[j]) -
                         ((double)b[j] - (double)a[j]) * ((double)c[i] - (double)a[i]);
        length += hit->normal[k] * hit->normal[k];
    }
    for (int k = 0; k < 3; k++) {
        hit->normal[k] /= length > 0 ? sqrt(length) : 1;
        towards += hit->normal[k] * direction[k];
    }
    hit->is_front = towards < 0;
    return 1;
}

int space_ray_through(const Space *space, const double from[3], const double direction[3], const unsigned char *passes,
                      SpaceHit *hit)
{
    enum { MOST_PASSED = 64 };
    const double size = fmax(fmax(fabs(from[0]), fabs(from[1])), fabs(from[2]));
    double tmin = 0;
    for (int passed = 0; passed < MOST_PASSED; passed++) {
        if (!space_ray(space, from, direction, tmin, INFINITY, hit))
            return 0;
        if (!passes || !passes[hit->tag])
            return 1;
        tmin = hit->t + 1e-6 * (hit->t + size);
    }
    return 1;
}
