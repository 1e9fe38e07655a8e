/* How many rays a second Embree alone traces in a scene: embree_rays SCENE.pov
 *
 * The scene's triangles, in a plain Embree scene without callbacks, are walked through as a path tracer of diffuse
 * surfaces does. The rays of these walks are kept, in the order in which they were made, and then traced again by two
 * threads: only that is timed, once with RTC_SCENE_FLAG_ROBUST and once without, for rays from the camera, from
 * surfaces, and to the lamps apart. Prints JSON: of each kind how many rays, and the wall and processor seconds that
 * they took. Shapes other than meshes are refused. */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#if defined(RETEX_EMBREE4)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include "lib_test.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

enum { SIDE = 200, SAMPLES = 4, BOUNCES = 9, THREADS = 2, BLOCK = 1024, SCENES = 2 };
#define KIND_SECONDS 0.5 /* each kind of rays is traced at least so long */
#define OFF_SURFACE 1e-5 /* how far from a surface rays start, of the largest coordinate */

typedef struct Record {
    float origin[3], direction[3], end;
} Record;

typedef enum Kind { CAMERA, BOUNCE, SHADOW, KINDS } Kind;

typedef struct Rays {
    Record *list;
    size_t count, room;
} Rays;

typedef struct World {
    RTCDevice device;
    RTCScene scenes[SCENES]; /* the second is ROBUST */
    float (*vertices)[3];
    unsigned (*faces)[3];
    unsigned *lamps; /* faces */
    size_t nvertices, nfaces, nlamps;
    double reach; /* largest coordinate */
    Rays rays[KINDS];
    uint32_t seed;
} World;

static void *must(void *memory)
{
    if (!memory) {
        fprintf(stderr, "embree_rays: out of memory\n");
        exit(2);
    }
    return memory;
}

/* ---- the scene ---- */

static void count_mesh(World *w, const Primitive *p)
{
    if (!p->shape.mesh) {
        fprintf(stderr, "embree_rays: line %d: not a mesh\n", p->line);
        exit(2);
    }
    w->nvertices += (size_t)p->shape.mesh->nvertices;
    w->nfaces += (size_t)p->shape.mesh->nfaces;
}

static void add_mesh(World *w, const Primitive *p)
{
    int lamp = !rgb_is_black(p->texture->finish->emission);
    unsigned base = (unsigned)w->nvertices;
    for (int i = 0; i < p->shape.mesh->nvertices; i++) {
        Vec3 v = transform_point(&p->transform, p->shape.mesh->vertices[i]);
        float *out = w->vertices[w->nvertices++];
        out[0] = (float)v.x, out[1] = (float)v.y, out[2] = (float)v.z;
        w->reach = fmax(w->reach, fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z))));
    }
    for (int i = 0; i < p->shape.mesh->nfaces; i++) {
        if (lamp)
            w->lamps[w->nlamps++] = (unsigned)w->nfaces;
        for (int k = 0; k < 3; k++)
            w->faces[w->nfaces][k] = base + (unsigned)p->shape.mesh->faces[i].vertex[k];
        w->nfaces++;
    }
}

static void collect(World *w, const Scene *scene)
{
    for (int i = 0; i < scene->nprimitives; i++)
        count_mesh(w, &scene->primitives[i]);
    w->vertices = must(malloc((w->nvertices + 1) * sizeof *w->vertices)); /* Embree reads 16 bytes at a time */
    w->faces = must(malloc((w->nfaces + 1) * sizeof *w->faces));
    w->lamps = must(malloc((w->nfaces + 1) * sizeof *w->lamps));
    w->nvertices = w->nfaces = 0;
    for (int i = 0; i < scene->nprimitives; i++)
        add_mesh(w, &scene->primitives[i]);
}

static RTCScene build(const World *w, enum RTCSceneFlags flags)
{
    RTCScene scene = rtcNewScene(w->device);
    RTCGeometry geometry = rtcNewGeometry(w->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, w->vertices, 0,
                               sizeof *w->vertices, w->nvertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, w->faces, 0, sizeof *w->faces,
                               w->nfaces);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene, flags);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene);
    return scene;
}

/* ---- one ray ---- */

static struct RTCRay start(const Record *r)
{
    return (struct RTCRay){.org_x = r->origin[0],
                           .org_y = r->origin[1],
                           .org_z = r->origin[2],
                           .dir_x = r->direction[0],
                           .dir_y = r->direction[1],
                           .dir_z = r->direction[2],
                           .tfar = r->end,
                           .mask = 0xffffffffu};
}

static struct RTCRayHit meet(RTCScene scene, const Record *r, Kind kind)
{
    struct RTCRayHit hit = {.ray = start(r)};
    hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if defined(RETEX_EMBREE4)
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.flags = kind == CAMERA ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcIntersect1(scene, &hit, &args);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = kind == CAMERA ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect1(scene, &context, &hit);
#endif
    return hit;
}

static int blocked(RTCScene scene, const Record *r)
{
    struct RTCRay ray = start(r);
#if defined(RETEX_EMBREE4)
    struct RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcOccluded1(scene, &ray, &args);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcOccluded1(scene, &context, &ray);
#endif
    return ray.tfar < 0;
}

/* ---- walks ---- */

static const Record *keep(Rays *rays, Vec3 from, Vec3 to, double end)
{
    if (rays->count == rays->room) {
        rays->room = 2 * rays->room + 1024;
        rays->list = must(realloc(rays->list, rays->room * sizeof *rays->list));
    }
    Record *r = &rays->list[rays->count++];
    *r = (Record){{(float)from.x, (float)from.y, (float)from.z}, {(float)to.x, (float)to.y, (float)to.z}, (float)end};
    return r;
}

static Vec3 vertex(const World *w, unsigned index)
{
    return vec3(w->vertices[index][0], w->vertices[index][1], w->vertices[index][2]);
}

static Vec3 lamp_point(World *w)
{
    const unsigned *face = w->faces[w->lamps[(size_t)(test_random(&w->seed) * (double)w->nlamps)]];
    double s = sqrt(test_random(&w->seed)), t = test_random(&w->seed);
    Vec3 p = vec_scale(vertex(w, face[0]), 1 - s);
    return vec_mad(vec_mad(p, vertex(w, face[1]), s * (1 - t)), vertex(w, face[2]), s * t);
}

static Vec3 diffuse_direction(World *w, Vec3 n)
{
    double u = test_random(&w->seed), a = 2 * PI * test_random(&w->seed), r = sqrt(u);
    Vec3 s, t;
    vec_frame(n, &s, &t);
    return vec_mad(vec_mad(vec_scale(n, sqrt(1 - u)), s, r * cos(a)), t, r * sin(a));
}

static void walk(World *w, Vec3 from, Vec3 direction)
{
    Kind kind = CAMERA;
    for (int bounce = 0; bounce <= BOUNCES; bounce++, kind = BOUNCE) {
        struct RTCRayHit hit = meet(w->scenes[1], keep(&w->rays[kind], from, direction, INFINITY), kind);
        if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            return;
        Vec3 n = vec_normalize(vec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z));
        if (vec_dot(n, direction) > 0)
            n = vec_neg(n);
        from = vec_mad(vec_mad(from, direction, hit.ray.tfar), n, OFF_SURFACE * w->reach);
        Vec3 to = vec_sub(lamp_point(w), from);
        if (vec_dot(n, to) > 0)
            keep(&w->rays[SHADOW], from, to, 0.999);
        direction = diffuse_direction(w, n);
    }
}

static void walk_all(World *w, const Camera *c)
{
    for (int i = 0; i < SIDE * SIDE * SAMPLES; i++) {
        double x = (i / SAMPLES % SIDE + test_random(&w->seed)) / SIDE - 0.5;
        double y = 0.5 - (i / SAMPLES / SIDE + test_random(&w->seed)) / SIDE;
        walk(w, c->location, vec_normalize(vec_mad(vec_mad(c->direction, c->right, x), c->up, y)));
    }
}

/* ---- timing ---- */

typedef struct Work {
    RTCScene scene;
    const Rays *rays;
    Kind kind;
    int part;
    size_t met; /* so that the queries are not left out */
} Work;

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Blocks in turn, so that all threads get rays of all parts of the picture. */
static void *trace(void *context)
{
    Work *w = context;
    for (size_t i = 0; i < w->rays->count; i++)
        if ((int)(i / BLOCK % THREADS) != w->part)
            i += BLOCK - 1;
        else if (w->kind == SHADOW)
            w->met += (size_t)blocked(w->scene, &w->rays->list[i]);
        else
            w->met += meet(w->scene, &w->rays->list[i], w->kind).hit.geomID != RTC_INVALID_GEOMETRY_ID;
    return NULL;
}

static void trace_all(RTCScene scene, const Rays *rays, Kind kind)
{
    pthread_t threads[THREADS];
    Work work[THREADS];
    for (int i = 0; i < THREADS; i++) {
        work[i] = (Work){scene, rays, kind, i, 0};
        if (pthread_create(&threads[i], NULL, trace, &work[i])) {
            fprintf(stderr, "embree_rays: no thread\n");
            exit(2);
        }
    }
    for (int i = 0; i < THREADS; i++)
        pthread_join(threads[i], NULL);
}

static void report(const World *w, int robust, Kind kind)
{
    static const char *const names[] = {"camera", "bounce", "shadow"};
    double turns = 0, wall = seconds(CLOCK_MONOTONIC), cpu = seconds(CLOCK_PROCESS_CPUTIME_ID), taken;
    do {
        trace_all(w->scenes[robust], &w->rays[kind], kind);
        turns++;
        taken = seconds(CLOCK_MONOTONIC) - wall;
    } while (taken < KIND_SECONDS);
    printf("%s\"%s%s\": {\"rays\": %.0f, \"wall\": %.6f, \"cpu\": %.6f}", robust || kind ? ", " : "{",
           robust ? "robust_" : "", names[kind], turns * (double)w->rays[kind].count, taken,
           seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu);
}

int main(int argc, char **argv)
{
    World w = {.seed = 1};
    Scene *scene;
    RetexError err = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: embree_rays SCENE.pov\n");
        return 2;
    }
    test_must(sdl_read(&scene, argv[1], NULL, &scene_builder, &err), &err);
    collect(&w, scene);
    w.device = rtcNewDevice("threads=2");
    if (!w.device || !w.nlamps) {
        fprintf(stderr, "embree_rays: %s\n", w.device ? "the scene has no lamp" : "Embree does not start");
        return 2;
    }
    w.scenes[0] = build(&w, RTC_SCENE_FLAG_NONE);
    w.scenes[1] = build(&w, RTC_SCENE_FLAG_ROBUST);
    walk_all(&w, &scene->camera);
    for (int robust = 0; robust < SCENES; robust++)
        for (Kind kind = CAMERA; kind < KINDS; kind++)
            report(&w, robust, kind);
    puts("}");
    for (Kind kind = CAMERA; kind < KINDS; kind++)
        free(w.rays[kind].list);
    for (int i = 0; i < SCENES; i++)
        rtcReleaseScene(w.scenes[i]);
    rtcReleaseDevice(w.device);
    free(w.vertices), free(w.faces), free(w.lamps);
    scene_close(&scene);
    return 0;
}
