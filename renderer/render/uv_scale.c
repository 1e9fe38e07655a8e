/* The length on the surface of a step in UV, measured for each target. See uv_scale.h. */
#include <math.h>
#include <stdlib.h>
#include "camera/camera.h"
#include "path/path.h"
#include "path/projection.h"
#include "render/uv_scale.h"

enum {
    GRID_WIDTH = 64,
    GRID_HEIGHT = 48,
    SAMPLES_MAX = GRID_WIDTH * GRID_HEIGHT,
    FEW = 64,           /* enough points of a target that the camera does not see */
    RANDOM_RAYS = 32768 /* random rays that search for such points */
};

typedef struct Lengths {
    int count;
    double u[SAMPLES_MAX], v[SAMPLES_MAX];
} Lengths;

/* A point of a target: its position and its UV. */
typedef struct Place {
    Vec3 position;
    Vec2 uv;
} Place;

/* Intersect the same surface next to a hit: the ray starts a step to the side and runs against the normal. Returns 0
 * if it hits another surface. */
static int step(const Scene *scene, const Accel *accel, const Surface *from, Vec3 normal, Vec3 aside, double size,
                RayKind kind, Place *place)
{
    Vec3 start = vec_add(from->position, vec_scale(vec_add(aside, normal), size));
    Ray ray = {start, vec_neg(normal), 0, 2 * size};
    Hit hit;
    Surface s;
    if (!accel_intersect(accel, &ray, kind, &hit) || &scene->primitives[hit.primitive] != from->primitive ||
        hit.instance != from->instance)
        return 0;
    surface_at(&s, scene, &ray, &hit);
    if (s.texture->tree)
        s.texture = from->texture, s.target = from->target;
    if (s.target != from->target || (!from->primitive->shape.mesh && s.face != from->face))
        return 0;
    *place = (Place){s.position, surface_target_uv(&s)};
    return 1;
}

/* Difference of UV for a step along one direction, from steps to both sides. The two differences must agree;
 * otherwise there is a seam or an edge between them. */
static int difference(const Scene *scene, const Accel *accel, const Surface *s, Vec3 normal, Vec3 aside, double size,
                      RayKind kind, Vec3 *dp, Vec2 *duv)
{
    Place a, b;
    Vec2 here = surface_target_uv(s);
    if (!step(scene, accel, s, normal, aside, size, kind, &a) ||
        !step(scene, accel, s, normal, vec_neg(aside), size, kind, &b))
        return 0;
    *dp = vec_sub(a.position, b.position);
    *duv = (Vec2){a.uv.u - b.uv.u, a.uv.v - b.uv.v};
    double lag_u = fabs(a.uv.u + b.uv.u - 2 * here.u), lag_v = fabs(a.uv.v + b.uv.v - 2 * here.v);
    return lag_u + lag_v <= 0.1 * (fabs(duv->u) + fabs(duv->v));
}

/* |dP/du| and |dP/dv| of a surface at a hit. */
static int measure(const Scene *scene, const Accel *accel, const Surface *s, double distance, RayKind kind,
                   double lengths[2])
{
    Vec3 n = s->backside ? vec_neg(s->geometric_normal) : s->geometric_normal, t, b;
    vec_frame(n, &t, &b);
    for (double size = 1e-3 * distance; size > 1e-6 * distance; size /= 4) {
        Vec3 dp[2];
        Vec2 duv[2];
        if (!difference(scene, accel, s, n, t, size, kind, &dp[0], &duv[0]) ||
            !difference(scene, accel, s, n, b, size, kind, &dp[1], &duv[1]))
            continue;
        /* Each step is dP/du · du + dP/dv · dv. The two steps give two equations for dP/du and dP/dv. */
        double det = duv[0].u * duv[1].v - duv[1].u * duv[0].v;
        if (!(fabs(det) > 1e-9 * (fabs(duv[0].u) + fabs(duv[1].u)) * (fabs(duv[0].v) + fabs(duv[1].v))))
            return 0;
        Vec3 du = vec_sub(vec_scale(dp[0], duv[1].v), vec_scale(dp[1], duv[0].v)),
             dv = vec_sub(vec_scale(dp[1], duv[0].u), vec_scale(dp[0], duv[1].u));
        lengths[0] = vec_length(du) / fabs(det), lengths[1] = vec_length(dv) / fabs(det);
        return isfinite(lengths[0]) && isfinite(lengths[1]);
    }
    return 0;
}

static void add(const Scene *scene, const Accel *accel, const Ray *ray, RayKind kind, const int *wanted, Lengths *all)
{
    Hit hit;
    Surface s;
    double lengths[2];
    if (!accel_intersect(accel, ray, kind, &hit))
        return;
    surface_at(&s, scene, ray, &hit);
    if (s.target < 0 || (wanted && !wanted[s.target]) || all[s.target].count == SAMPLES_MAX ||
        !measure(scene, accel, &s, hit.t, kind, lengths))
        return;
    Lengths *list = &all[s.target];
    list->u[list->count] = lengths[0], list->v[list->count++] = lengths[1];
}

/* A ray between two random points within the bounds. */
static Ray random_ray(uint32_t index, Vec3 low, Vec3 high)
{
    Sampler sampler = sampler_start(0, 0, 0, index);
    float u[3], phi, z, unused;
    sampler_pair(&sampler, 0, &u[0], &u[1]);
    sampler_pair(&sampler, 1, &u[2], &unused);
    sampler_pair(&sampler, 2, &phi, &z);
    Vec3 size = vec_sub(high, low);
    double cosine = 2 * z - 1, sine = sqrt(fmax(0, 1 - cosine * cosine));
    return (Ray){vec3(low.x + u[0] * size.x, low.y + u[1] * size.y, low.z + u[2] * size.z),
                 vec3(sine * cos(2 * PI * phi), sine * sin(2 * PI * phi), cosine), 0, INFINITY};
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare);
    return count ? values[count / 2] : 0;
}

int uv_scale_measure(const Scene *scene, const Accel *accel, double scale[][2], RetexError *err)
{
    Lengths *all = calloc((size_t)scene->ntargets + 1, sizeof *all);
    int unseen[RETEX_MAX_TARGETS], any = 0;
    Vec3 low, high;
    if (!all)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the scale of textures");
    for (int y = 0; y < GRID_HEIGHT; y++)
        for (int x = 0; x < GRID_WIDTH; x++) {
            Ray ray = camera_ray(&scene->camera, GRID_WIDTH, GRID_HEIGHT, x + 0.5, y + 0.5, NULL);
            add(scene, accel, &ray, RAY_CAMERA, NULL, all);
        }
    for (int t = 0; t < scene->ntargets; t++) {
        unseen[t] = all[t].count == 0;
        any |= unseen[t];
    }
    accel_bounds(accel, scene->camera.location, &low, &high);
    for (uint32_t k = 0; any && k < RANDOM_RAYS; k++) {
        Ray ray = random_ray(k, low, high);
        add(scene, accel, &ray, RAY_BOUNCE, unseen, all);
        any = 0;
        for (int t = 0; t < scene->ntargets; t++) {
            unseen[t] &= all[t].count < FEW;
            any |= unseen[t];
        }
    }
    for (int t = 0; t < scene->ntargets; t++) {
        scale[t][0] = median(all[t].u, all[t].count);
        scale[t][1] = median(all[t].v, all[t].count);
        if (projection_is_used(&scene->targets[t]))
            scale[t][0] = scale[t][1] = 1 / scene->targets[t].projection.unit;
    }
    free(all);
    return RETEX_OK;
}
