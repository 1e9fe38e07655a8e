/* Original textures of targets, sampled to images. See originals.h. */
#include <stdio.h>
#include <string.h>
#include <retex/parallel.h>
#include "render/originals.h"
#include "shade/pigment.h"
#include "shape/shapes.h"

static void original_size(const Pigment *pigment, int *width, int *height)
{
    *width = *height = pigment_is_constant(pigment) ? 1 : ORIGINAL_SIZE;
    if (pigment->kind != PIGMENT_IMAGE)
        return;
    int w = pigment->image->width, h = pigment->image->height, longest = w > h ? w : h;
    *width = w, *height = h;
    if (longest <= ORIGINAL_SIZE)
        return;
    *width = (int)((double)w * ORIGINAL_SIZE / longest), *height = (int)((double)h * ORIGINAL_SIZE / longest);
    if (*width < 1)
        *width = 1;
    if (*height < 1)
        *height = 1;
}

typedef struct Copy {
    RetexImage *dst;
    const ImageMap *image;
} Copy;

/* A row of texels. If the texture is smaller than the image, each texel is the image's mean over the texel's area. */
static void copy_row(void *context, int y, int thread)
{
    const Copy *copy = context;
    const RetexImage *dst = copy->dst;
    const RetexTexture *texture = copy->image->texture;
    float *p = dst->pixels + retex_image_index(dst, 0, y), rgba[4];
    const double v = 1 - (y + 0.5) / dst->height, sigma_u = 0.3 / dst->width, sigma_v = 0.3 / dst->height,
                 covariance[3] = {sigma_u * sigma_u, 0, sigma_v * sigma_v};
    (void)thread;
    if (dst->width == copy->image->width && dst->height == copy->image->height) {
        retex_texture_row(texture, y, p);
        return;
    }
    for (int x = 0; x < dst->width; x++, p += 3) {
        retex_texture_gaussian(texture, (x + 0.5) / dst->width, v, covariance, rgba);
        memcpy(p, rgba, 3 * sizeof *p);
    }
}

/* Each texel is a texel of the image, or the pigment at the texel's centre. */
static int fill_original(RetexImage *dst, const Pigment *pigment, int axis, const RetexTarget *target, int nthreads,
                         RetexError *err)
{
    if (pigment->kind == PIGMENT_IMAGE) {
        retex_parallel(nthreads, dst->height, copy_row, &(Copy){dst, pigment->image});
        return RETEX_OK;
    }
    int width = dst->width, height = dst->height;
    retex_image_free(dst);
    return pigment_bake(dst, pigment, axis, target->original_min, target->original_max, width, height, nthreads, err);
}

/* The projection axis of the planar UV of a plane or box: the axis of its smallest extent. */
static int dominant_axis(const Primitive *p)
{
    if (p->shape.ops != &shape_plane)
        return 1;
    Vec3 n = transform_normal(&p->transform, vec3(0, 1, 0));
    n = transform_inverse_vector(&p->texture->pigment->transform, n);
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    return x > y && x > z ? 0 : y >= z ? 1 : 2;
}

/* The primitive that is the target and its pigment; NULL where textures of a tree that are the target have different
 * ones: they are no one picture. */
static const Pigment *target_pigment(const Scene *scene, int target, const Primitive **of)
{
    const Texture *texture = NULL, *other;
    int whole;
    for (int k = 0; k < scene->nprimitives && !texture; k++)
        *of = &scene->primitives[k], texture = primitive_target_texture(*of, target);
    for (int k = 0; k < scene->ninstances && !texture; k++)
        texture = instance_target_texture(scene, &scene->instances[k], target, of);
    for (int k = 0; texture && (other = primitive_texture(*of, k, &whole)); k++)
        for (int j = 0; other->tree && j < other->tree->nleaves; j++) {
            const Texture *leaf = other->tree->leaves[j];
            if (leaf->pigment != texture->pigment && texture_leaf_target(leaf, whole) == target)
                return NULL;
        }
    return texture ? texture->pigment : NULL;
}

static int add_original(RetexSet *set, const Scene *scene, int t, int nthreads, RetexError *err)
{
    const Primitive *p = NULL;
    const Pigment *pigment = target_pigment(scene, t, &p);
    if (!pigment)
        return RETEX_OK;
    RetexTarget *target = &set->targets[t];
    for (int k = 0; k < 2; k++) {
        int whole = pigment->kind == PIGMENT_IMAGE || !(target->uv_max[k] > target->uv_min[k]);
        target->original_min[k] = whole ? 0 : target->uv_min[k];
        target->original_max[k] = whole ? 1 : target->uv_max[k];
    }
    int width, height, part;
    char name[RETEX_NAME_MAX];
    original_size(pigment, &width, &height);
    snprintf(name, sizeof name, "original_%.100s", target->name);
    int code = retex_set_add_part(set, name, "RGB", RETEX_HALF, width, height, &part, err);
    if (code)
        return code;
    target->original = part;
    return fill_original(&set->parts[part].image, pigment, dominant_axis(p), target, nthreads, err);
}

int originals_add(RetexSet *set, const Scene *scene, int nthreads, RetexError *err)
{
    for (int t = 0; t < scene->ntargets; t++) {
        int code = add_original(set, scene, t, nthreads, err);
        if (code)
            return code;
    }
    return RETEX_OK;
}
