/* AOVs that are averaged over the pixel. See mean_aovs.h.
 *
 * They have no noise but that of the sample points, which are the picture's own: an edge, a texture or a lens blurs
 * both in the same way. */
#include <retex/host/set_build.h>
#include <retex/parallel.h>
#include "render/mean_aovs.h"

/* So many samples suffice for what is seen of a surface, and no fewer do, however few the picture has. */
#define SAMPLES_LEAST 16
#define SAMPLES_MOST 256

typedef struct MeanJob {
    const Render *render;
    RetexImage *images[RETEX_AOV_COUNT]; /* NULL for an AOV that was not asked for */
    int samples;
} MeanJob;

/* Of one pixel; it begins with zeros. */
typedef struct MeanPixel {
    const MeanJob *job;
    const Hit *hit;
    double sums[RETEX_AOV_COUNT][3];
} MeanPixel;

static void add_leaf(void *context, const SeenLeaf *leaf)
{
    MeanPixel *pixel = context;
    for (int k = 0; k < RETEX_AOV_COUNT; k++) {
        float value[3] = {0};
        if (!pixel->job->images[k])
            continue;
        first_hit_value((RetexAov)k, value, pixel->hit, leaf);
        for (int c = 0; c < 3; c++)
            pixel->sums[k][c] += (double)(leaf->share * value[c]);
    }
}

static void add_hit(void *context, const Ray *ray, const Hit *hit)
{
    MeanPixel *pixel = context;
    const Render *r = pixel->job->render;
    pixel->hit = hit;
    if (hit->primitive >= 0)
        shading_each_leaf(r->scene, r->variants, ray, hit, add_leaf, pixel);
}

static void mean_row(void *context, int y, int thread)
{
    const MeanJob *job = context;
    (void)thread;
    for (int x = 0; x < job->render->w && !render_is_stopped(job->render); x++) {
        MeanPixel pixel = {.job = job};
        render_camera_hits(job->render, job->render->x0 + x, job->render->y0 + y, job->samples, add_hit, &pixel);
        for (int k = 0; k < RETEX_AOV_COUNT; k++)
            for (int c = 0; job->images[k] && c < job->images[k]->channels; c++)
                job->images[k]->pixels[retex_image_index(job->images[k], x, y) + (size_t)c] =
                    (float)(pixel.sums[k][c] / job->samples);
    }
}

int mean_aovs_add(RetexSet *set, const Render *r, unsigned aovs, RetexError *err)
{
    MeanJob job = {.render = r, .samples = r->params.spp};
    int parts[RETEX_AOV_COUNT];
    if (!(aovs & AOVS_AVERAGED))
        return RETEX_OK;
    job.samples = job.samples < SAMPLES_LEAST ? SAMPLES_LEAST : job.samples;
    job.samples = job.samples > SAMPLES_MOST ? SAMPLES_MOST : job.samples;
    for (int k = 0; k < RETEX_AOV_COUNT; k++) {
        parts[k] = -1;
        int code = (aovs & AOVS_AVERAGED) >> k & 1 ? first_hit_add_aov(set, (RetexAov)k, &parts[k], err) : RETEX_OK;
        if (code)
            return code;
    }
    for (int k = 0; k < RETEX_AOV_COUNT; k++)
        job.images[k] = parts[k] >= 0 ? retex_set_mutable_image(set, parts[k]) : NULL;
    retex_parallel(r->params.nthreads, r->h, mean_row, &job);
    return render_is_stopped(r) ? retex_budget_check(r->params.budget, err) : RETEX_OK;
}
