/* Baking: the way back from a pigment to an image. */
#include <retex/parallel.h>
#include "shade/pigment.h"
#include "shade/pigment_image.h"

/* Where target_uv's UV came from, in pattern space. */
static Vec3 from_uv(const Pigment *pigment, int axis, double u, double v)
{
    if (pigment->uv_mapping || axis == 2)
        return vec3(u, v, 0);
    return axis == 0 ? vec3(0, v, u) : vec3(u, 0, v);
}

/* How a pigment is baked. */
typedef struct Baking {
    RetexImage *dst;
    const Pigment *pigment;
    int axis;
    const double *low, *high;
} Baking;

static void bake_row(void *context, int y, int thread)
{
    const Baking *b = context;
    const Pigment *pigment = b->pigment;
    float *pixel = b->dst->pixels + retex_image_index(b->dst, 0, y);
    double v = b->high[1] - (b->high[1] - b->low[1]) * (y + 0.5) / b->dst->height;
    (void)thread;
    for (int x = 0; x < b->dst->width; x++, pixel += 3) {
        double u = b->low[0] + (b->high[0] - b->low[0]) * (x + 0.5) / b->dst->width;
        Rgbft c = pigment->kind == PIGMENT_IMAGE && !pigment->uv_mapping
                      ? image_lookup(pigment, (Vec2){u, v})
                      : pigment_pattern(pigment, &(PatternPoint){.p = from_uv(pigment, b->axis, u, v)}, (Vec2){u, v});
        pixel[0] = c.r, pixel[1] = c.g, pixel[2] = c.b;
    }
}

int pigment_bake(RetexImage *dst, const Pigment *pigment, int axis, const double low[2], const double high[2],
                 int width, int height, int nthreads, RetexError *err)
{
    if (axis < 0 || axis > 2 || !(low[0] < high[0]) || !(low[1] < high[1]))
        return retex_fail(err, RETEX_EINVAL, "cannot bake a pigment over an empty UV rectangle");
    int code = retex_image_alloc(dst, width, height, 3, err);
    if (!code)
        retex_parallel(nthreads, height, bake_row, &(Baking){dst, pigment, axis, low, high});
    return code;
}
