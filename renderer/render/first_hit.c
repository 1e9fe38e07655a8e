/* AOVs of the first hit, by rays through the pixel centres. See first_hit.h. */
#include <stdlib.h>
#include <string.h>
#include <retex/host/set_build.h>
#include <retex/parallel.h>
#include "camera/camera.h"
#include "render/first_hit.h"
#include "path/projection.h"
#include "shape/shape.h"

/* The value of an AOV at a first hit, of one leaf of its texture: up to three channels. */
typedef void AovValue(float value[3], const Hit *hit, const SeenLeaf *leaf);

static void depth_at(float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    (void)leaf;
    value[0] = (float)hit->t;
}

static void albedo_at(float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    (void)hit;
    const Rgb albedo = leaf->albedo;
    value[0] = albedo.r, value[1] = albedo.g, value[2] = albedo.b;
}

static void normal_at(float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    (void)hit;
    const Vec3 n = bsdf_surface_normal(&leaf->s.bsdf);
    value[0] = (float)n.x, value[1] = (float)n.y, value[2] = (float)n.z;
}

static void position_at(float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    (void)hit;
    const Vec3 p = leaf->s.surface.position;
    value[0] = (float)p.x, value[1] = (float)p.y, value[2] = (float)p.z;
}

static void uv_at(float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    (void)hit;
    const Vec2 uv = surface_target_uv(&leaf->s.surface);
    value[0] = (float)uv.u, value[1] = (float)uv.v, value[2] = 1;
}

static void object_at(float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    (void)leaf;
    value[0] = (float)(hit->primitive + 1);
}

static void roughness_at(float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    (void)hit;
    value[0] = shading_roughness(&leaf->s);
}

static void metallic_at(float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    (void)hit;
    value[0] = shading_metallic(&leaf->s);
}

static void reflectance_at(float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    const Rgb reflectance = leaf->reflectance;
    (void)hit;
    value[0] = reflectance.r, value[1] = reflectance.g, value[2] = reflectance.b;
}

/* NULL: the AOV does not depend on first hits alone; render.c adds it. */
static AovValue *const aov_values[RETEX_AOV_COUNT] = {
    [RETEX_AOV_DEPTH] = depth_at,
    [RETEX_AOV_ALBEDO] = albedo_at,
    [RETEX_AOV_NORMAL] = normal_at,
    [RETEX_AOV_POSITION] = position_at,
    [RETEX_AOV_UV] = uv_at,
    [RETEX_AOV_OBJECT] = object_at,
    [RETEX_AOV_ROUGHNESS] = roughness_at,
    [RETEX_AOV_METALLIC] = metallic_at,
    [RETEX_AOV_REFLECTANCE] = reflectance_at,
    [RETEX_AOV_ALBEDO_MEAN] = albedo_at,
    [RETEX_AOV_NORMAL_MEAN] = normal_at,
};

void first_hit_value(RetexAov aov, float value[3], const Hit *hit, const SeenLeaf *leaf)
{
    aov_values[aov](value, hit, leaf);
}

/* AOVs that are the mean of a texture's leaves; of the others the leaf that is seen most counts. */
static const unsigned aov_means = RETEX_AOV_BIT(ALBEDO) | RETEX_AOV_BIT(ROUGHNESS) | RETEX_AOV_BIT(METALLIC) |
                                  RETEX_AOV_BIT(REFLECTANCE);

typedef struct AovJob {
    const FirstHitWindow *window;
    RetexImage *images[RETEX_AOV_COUNT]; /* NULL for an AOV that was not asked for */
} AovJob;

/* Of one pixel; it begins with zeros. */
typedef struct AovPixel {
    const AovJob *job;
    const Hit *hit;
    float values[RETEX_AOV_COUNT][3];
    float most; /* share of the leaf seen most so far */
} AovPixel;

int first_hit_ray(const FirstHitWindow *w, int x, int y, Ray *ray, Hit *hit)
{
    *ray = camera_ray(&w->scene->camera, w->width, w->height, w->x0 + x + 0.5, w->y0 + y + 0.5, NULL);
    return accel_intersect(w->accel, ray, RAY_CAMERA, hit);
}

static void add_leaf(void *context, const SeenLeaf *leaf)
{
    AovPixel *pixel = context;
    for (int k = 0; k < RETEX_AOV_COUNT; k++) {
        float value[3] = {0};
        if (!pixel->job->images[k])
            continue;
        aov_values[k](value, pixel->hit, leaf);
        if (aov_means >> k & 1)
            for (int c = 0; c < 3; c++)
                pixel->values[k][c] += leaf->share * value[c];
        else if (leaf->share > pixel->most)
            memcpy(pixel->values[k], value, sizeof value);
    }
    if (leaf->share > pixel->most)
        pixel->most = leaf->share;
}

static void aov_row(void *context, int y, int thread)
{
    const AovJob *job = context;
    const FirstHitWindow *w = job->window;
    (void)thread;
    for (int x = 0; x < w->w; x++) {
        AovPixel pixel = {.job = job};
        Ray ray;
        Hit hit;
        const int is_hit = first_hit_ray(w, x, y, &ray, &hit);
        pixel.hit = &hit;
        if (is_hit)
            shading_each_leaf(w->scene, w->variants, &ray, &hit, add_leaf, &pixel);
        for (int k = 0; k < RETEX_AOV_COUNT; k++) {
            RetexImage *image = job->images[k];
            const float empty = retex_aov_info(k)->nothing, nothing[3] = {empty, empty, empty};
            if (image)
                memcpy(image->pixels + retex_image_index(image, x, y), is_hit ? pixel.values[k] : nothing,
                       (size_t)image->channels * sizeof *nothing);
        }
    }
}

int first_hit_add_aov(RetexSet *set, RetexAov aov, int *part, RetexError *err)
{
    const RetexAovInfo *info = retex_aov_info(aov);
    return retex_set_add_part(set, info->name, info->letters, info->type, 0, 0, part, err);
}

int first_hit_aovs(RetexSet *set, const FirstHitWindow *window, unsigned aovs, RetexError *err)
{
    AovJob job = {.window = window};
    int parts[RETEX_AOV_COUNT], wanted = 0;
    for (int k = 0; k < RETEX_AOV_COUNT; k++) {
        parts[k] = -1;
        const int is_wanted = (aovs & ~AOVS_AVERAGED) >> k & 1 && aov_values[k];
        int code = is_wanted ? first_hit_add_aov(set, (RetexAov)k, &parts[k], err) : RETEX_OK;
        if (code)
            return code;
    }
    for (int k = 0; k < RETEX_AOV_COUNT; k++)
        if (parts[k] >= 0)
            job.images[k] = retex_set_mutable_image(set, parts[k]), wanted = 1;
    if (wanted)
        retex_parallel(window->nthreads, window->h, aov_row, &job);
    return RETEX_OK;
}

typedef struct CountJob {
    const FirstHitWindow *window;
    double *counts;    /* pixels by row and item */
    int items, idents; /* idents: 1 to count identifiers, 0 to count targets */
} CountJob;

/* Of one pixel: what is seen of each item. */
typedef struct CountPixel {
    const CountJob *job;
    double *counts;
    unsigned char *marked;
} CountPixel;

static void mark(const Scene *scene, const IdentList *list, unsigned char *marked)
{
    for (; list; list = list->next)
        for (int k = 0; k < scene->nidents; k++)
            if (!strcmp(scene->idents[k], list->name))
                marked[k] = 1;
}

static void count_leaf(void *context, const SeenLeaf *leaf)
{
    const CountPixel *pixel = context;
    const CountJob *job = pixel->job;
    const Scene *scene = job->window->scene;
    const Surface *surface = &leaf->s.surface;
    if (job->idents) {
        memset(pixel->marked, 0, (size_t)job->items);
        mark(scene, surface->primitive->idents, pixel->marked);
        if (surface->instance)
            mark(scene, surface->instance->idents, pixel->marked);
        mark(scene, surface->texture->idents, pixel->marked);
        mark(scene, surface->texture->pigment->idents, pixel->marked);
    }
    for (int k = 0; k < job->items; k++)
        if (job->idents ? pixel->marked[k] : leaf->targets >> k & 1)
            pixel->counts[k] += (double)leaf->share;
}

static void count_row(void *context, int y, int thread)
{
    const CountJob *job = context;
    CountPixel pixel = {job, job->counts + (size_t)y * (size_t)job->items, NULL};
    (void)thread;
    if (job->idents && !(pixel.marked = calloc((size_t)job->items, 1)))
        return;
    for (int x = 0; x < job->window->w; x++) {
        Ray ray;
        Hit hit;
        if (first_hit_ray(job->window, x, y, &ray, &hit))
            shading_each_leaf(job->window->scene, job->window->variants, &ray, &hit, count_leaf, &pixel);
    }
    free(pixel.marked);
}

static int count_shares(const FirstHitWindow *window, int items, int idents, double *shares, RetexError *err)
{
    if (items == 0)
        return RETEX_OK;
    CountJob job = {window, calloc((size_t)window->h * (size_t)items, sizeof(double)), items, idents};
    if (!job.counts)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for shares of the picture");
    retex_parallel(window->nthreads, window->h, count_row, &job);
    for (int k = 0; k < items; k++) {
        double sum = 0;
        for (int y = 0; y < window->h; y++)
            sum += job.counts[(size_t)y * (size_t)items + (size_t)k];
        shares[k] = sum / ((double)window->w * window->h);
    }
    free(job.counts);
    return RETEX_OK;
}

/* Clear *u or *v if that UV coordinate is not periodic. It is periodic only if the shape's own UV is used unchanged
 * and closes around the shape. */
static void closes(const Primitive *p, const Pigment *pigment, int *u, int *v)
{
    const double(*m)[4] = pigment->transform.m;
    int own = pigment->uv_mapping ? m[0][0] == 1 && m[1][1] == 1 && m[0][1] == 0 && m[1][0] == 0
                                  : pigment->kind != PIGMENT_IMAGE;
    const unsigned properties = p->shape.ops->properties;
    own &= !pigment->uv_mapping || (properties & SHAPE_UV_NATURAL) != 0;
    *u &= own && (properties & SHAPE_U_PERIODIC) != 0;
    *v &= own && (properties & SHAPE_V_PERIODIC) != 0;
}

void target_periodic(const Scene *scene, int t, int periodic[2])
{
    int any = 0, u = !scene->targets[t].uv_folds && !projection_is_used(&scene->targets[t]), v = u;
    for (int k = 0; k < scene->nprimitives; k++) {
        const Primitive *p = &scene->primitives[k];
        const Texture *texture;
        int whole;
        for (int j = 0; (texture = primitive_texture(p, j, &whole)); j++)
            for (int leaf = 0; leaf < texture_leaf_count(texture); leaf++) {
                const Texture *of = texture_leaf(texture, leaf);
                if ((texture->tree ? first_target(of->target, whole) : whole) != t)
                    continue;
                closes(p, of->pigment, &u, &v);
                any = 1;
                if (j > (p->interior_texture != NULL)) /* of a part of the shape */
                    u = v = 0;
            }
    }
    /* Of instances, whose primitives may be of many shapes, no UV is taken as periodic. */
    for (int k = 0; k < scene->ninstances && (u || v); k++)
        if (instance_target_texture(scene, &scene->instances[k], t, NULL))
            u = v = 0;
    periodic[0] = any && u, periodic[1] = any && v;
}

/* Of textures that are blended from corner to corner none is seen alone. */
ShownSurface first_hit_of(const Scene *scene, const Surface *surface)
{
    const Shape *shape = &surface->primitive->shape;
    const int blends = shape->mesh && shape->mesh->corner_textures;
    const FaceTextures *textures = blends ? NULL : shape->textures;
    int part = 0;
    for (int k = 0; textures && k < textures->count && !part; k++)
        if (textures->list[k] == surface->texture)
            part = k + 1;
    ShownSurface shown = {object_part(scene, surface->primitive, part), surface->primitive, surface->face};
    if (blends)
        shown.part.texture = NULL;
    return shown;
}

int first_hit_shown(const FirstHitWindow *window, int x, int y, ShownSurface *shown)
{
    Ray ray;
    Hit hit;
    Surface surface;
    if (!first_hit_ray(window, x, y, &ray, &hit))
        return 0;
    surface_at(&surface, window->scene, &ray, &hit);
    *shown = first_hit_of(window->scene, &surface);
    return 1;
}

int first_hit_target_shares(const FirstHitWindow *window, double *shares, RetexError *err)
{
    return count_shares(window, window->scene->ntargets, 0, shares, err);
}

int first_hit_targets(RetexSet *set, const FirstHitWindow *window, RetexError *err)
{
    double shares[RETEX_MAX_TARGETS] = {0};
    int code = first_hit_target_shares(window, shares, err);
    RetexTarget *target;
    for (int t = 0; (target = retex_set_mutable_target(set, t)); t++) {
        target->share = shares[t];
        target_periodic(window->scene, t, target->periodic);
    }
    return code;
}

int first_hit_idents(const FirstHitWindow *window, double *shares, RetexError *err)
{
    return count_shares(window, window->scene->nidents, 1, shares, err);
}
