/* Original textures of targets, sampled to images. See originals.h. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <retex/host/set_build.h>
#include <retex/target_name.h>
#include <retex/host/texture_lookup.h>
#include <retex/parallel.h>
#include "path/projection.h"
#include "render/originals.h"
#include "shade/pigment.h"
#include "shape/shapes.h"

enum { MEAN_POINTS = 4 }; /* along each axis, at which a pattern is looked at for its mean */

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

/* A row of texels. If the original is smaller than the image, each texel is the image's mean over the texel's area. */
static void copy_row(void *context, int y, int thread)
{
    const Copy *copy = context;
    const RetexImage *dst = copy->dst;
    const RetexTexture *texture = copy->image->texture;
    float *p = dst->pixels + retex_image_index(dst, 0, y);
    (void)thread;
    if (dst->width == copy->image->width && dst->height == copy->image->height)
        retex_texture_row(texture, y, p);
    else
        retex_texture_scaled_row(texture, dst->width, dst->height, y, p);
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

/* The axis of pattern space along which the planar UV of a plane is projected, if the plane goes through 0 at right
 * angles to it: it is what is baked of the pattern. Else -1. */
static int baked_axis(const Primitive *p, const Pigment *pigment)
{
    const double flat = 1e-9;
    const Vec3 at = transform_inverse_point(&pigment->transform, transform_point(&p->transform, vec3(0, 0, 0)));
    const Vec3 normal = transform_normal(&p->transform, vec3(0, 1, 0));
    const Vec3 n = vec_normalize(transform_inverse_normal(&pigment->transform, normal));
    const double along[3] = {fabs(n.x), fabs(n.y), fabs(n.z)}, offset[3] = {at.x, at.y, at.z};
    for (int axis = 0; axis < 3 && p->shape.ops == &shape_plane; axis++)
        if (along[axis] > 1 - flat && fabs(offset[axis]) < flat)
            return axis;
    return -1;
}

/* A pattern in space is no function of UV but on such a plane: of other surfaces, footprints keep its means. Nothing
 * but a constant is one of UV that are projected. */
static int is_function_of_uv(const Target *target, const Primitive *p, const Pigment *pigment)
{
    if (projection_is_used(target))
        return pigment_is_constant(pigment);
    return pigment->kind == PIGMENT_COLOR || pigment->kind == PIGMENT_IMAGE || pigment->uv_mapping ||
           pigment_is_constant(pigment) || baked_axis(p, pigment) >= 0;
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
            if (leaf->pigment != texture->pigment && first_target(leaf->target, whole) == target)
                return NULL;
        }
    return texture ? texture->pigment : NULL;
}

static int add_original(RetexSet *set, const Scene *scene, int t, int nthreads, RetexError *err)
{
    const Primitive *p = NULL;
    const Pigment *pigment = target_pigment(scene, t, &p);
    if (!pigment || !is_function_of_uv(&scene->targets[t], p, pigment))
        return RETEX_OK;
    const int axis = baked_axis(p, pigment);
    RetexTarget *target = retex_set_mutable_target(set, t);
    for (int k = 0; k < 2; k++) {
        int whole = pigment->kind == PIGMENT_IMAGE || !(target->uv_max[k] > target->uv_min[k]);
        target->original_min[k] = whole ? 0 : target->uv_min[k];
        target->original_max[k] = whole ? 1 : target->uv_max[k];
    }
    int width, height, part;
    char name[RETEX_NAME_MAX], word[RETEX_NAME_MAX];
    original_size(pigment, &width, &height);
    retex_target_word(word, target->name);
    snprintf(name, sizeof name, "original_%.100s", word);
    int code = retex_set_add_part(set, name, "RGB", RETEX_HALF, width, height, &part, err);
    if (code)
        return code;
    target->original = part;
    return fill_original(retex_set_mutable_image(set, part), pigment, axis < 0 ? 1 : axis, target, nthreads, err);
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

/* ---- brightness ---- */

static Rgb image_mean(const Pigment *pigment)
{
    float all[3];
    retex_texture_scaled_row(pigment->image->texture, 1, 1, 0, all);
    const Rgb mean = rgb(all[0], all[1], all[2]);
    return pigment->is_tinted ? rgb_mul(mean, rgb(pigment->color.r, pigment->color.g, pigment->color.b)) : mean;
}

/* The mean of a pattern's colours around 0 of its space, where most patterns show all of them; or over UV. */
static Rgb pattern_mean(const Pigment *pigment)
{
    Rgb sum = rgb_grey(0);
    for (int k = 0; k < MEAN_POINTS * MEAN_POINTS * MEAN_POINTS; k++) {
        const int i = k % MEAN_POINTS, j = k / MEAN_POINTS % MEAN_POINTS, l = k / MEAN_POINTS / MEAN_POINTS;
        const Vec2 uv = {(i + 0.5) / MEAN_POINTS, (j + 0.5) / MEAN_POINTS};
        const Vec3 at = vec3(2 * uv.u - 1, 2 * uv.v - 1, 2 * (l + 0.5) / MEAN_POINTS - 1);
        const Rgbft c = pigment_eval(pigment, transform_point(&pigment->transform, at), uv);
        sum = rgb_add(sum, rgb(c.r, c.g, c.b));
    }
    return rgb_scale(sum, 1.0f / (MEAN_POINTS * MEAN_POINTS * MEAN_POINTS));
}

static float mean_luminance(const Pigment *pigment)
{
    if (pigment_is_constant(pigment)) {
        const Rgbft c = pigment_eval(pigment, vec3(0, 0, 0), (Vec2){0, 0});
        return rgb_luminance(rgb(c.r, c.g, c.b));
    }
    return rgb_luminance(pigment->kind == PIGMENT_IMAGE ? image_mean(pigment) : pattern_mean(pigment));
}

/* Of a texture, or of those leaves of its tree that are the target; 0: none is. whole: the target of the texture as a
 * whole. */
static float brightest_leaf(const Texture *texture, int whole, int target)
{
    float most = 0;
    for (int j = 0; j < texture_leaf_count(texture); j++) {
        const Texture *leaf = texture_leaf(texture, j);
        if ((texture->tree ? first_target(leaf->target, whole) : whole) == target && leaf->pigment)
            most = fmaxf(most, mean_luminance(leaf->pigment));
    }
    return most;
}

float original_brightness(const Scene *scene, int target)
{
    float most = 0.5f;
    for (int k = 0; k < scene->nprimitives; k++) {
        const Texture *texture;
        int whole;
        for (int i = 0; (texture = primitive_texture(&scene->primitives[k], i, &whole)); i++)
            most = fmaxf(most, brightest_leaf(texture, whole, target));
    }
    for (int k = 0; k < scene->ninstances; k++) {
        const Texture *texture = instance_target_texture(scene, &scene->instances[k], target, NULL);
        if (texture && texture->pigment)
            most = fmaxf(most, mean_luminance(texture->pigment));
    }
    return fminf(most, 1);
}
