/* See lamps.h. The error of each gain at each scale is measured alone, in the picture by its lamp; all begin with the
 * coarsest scale, and that which saves most error for a number becomes finer, until the sum of errors is within the
 * bound. As in search.c, noise that averaging removes is no error. */
#include "compact/lamps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "compact/gains.h"
#include "retexture/enlarge.h"
#include "set/set.h"

#define STEPS RETEX_COMPACT_STEPS
#define BRIGHTER_MOST 20 /* as often as rendered a lamp is looked at */
#define NOISE_IGNORED 0.5 /* of the noise of a lamp's light: of denoised light it is uneven, and more hid blotches */
#define NOISE_ALLOWED 0.025 /* error allowed, as a share of the noise of the lamp's picture */

/* ---- one gain of one lamp ---- */

typedef struct LampGain {
    int kind, place;  /* kind -1: the share of light that meets no target */
    float albedo;     /* what its textures multiply it by */
    RetexImage light; /* the lamp's */
    unsigned char *scale;
    int step;
    double squares[STEPS], noise;
} LampGain;

typedef struct LampChoice {
    const RetexCompactReference *reference;
    const RetexCompactLight *light;
    const RetexCompactScales *scales;
    int nthreads;
    LampGain *gains;
    int count;
    RetexImage all; /* the light of all lamps that gains of the kind `all_of` are a part of; empty: not made yet */
    int all_of;
    RetexImage picture; /* by the lamp, with a value of 1 */
    float exposure;
    double whole; /* mean of the picture by all lamps, with the same textures */
} LampChoice;

/* Gains of one kind follow each other. */
static int make_all(LampChoice *work, int kind, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    const RetexSet *set = light->set;
    if (work->all.pixels && work->all_of == kind)
        return RETEX_OK;
    retex_image_free(&work->all);
    work->all_of = kind;
    if (kind >= 0)
        return retex_compact_sum_light(&work->all, light, &light->kinds[kind], light->all, work->nthreads, err);
    const int without = set->terms[retex_compact_light_without_hits(set)].radiance;
    return retex_image_copy(&work->all, &set->parts[without].image, err);
}

static float encoded(float x)
{
    return !(x > 0) ? 0 : x >= 1 ? 1 : retex_srgb_encodef(x);
}

typedef struct ErrorWork {
    const LampChoice *choice;
    const LampGain *gain;
    const RetexImage *coarse; /* the gain */
    int scale;
    double *rows;
} ErrorWork;

static void error_row(void *context, int y, int thread)
{
    const ErrorWork *work = context;
    const LampChoice *choice = work->choice;
    const RetexImage *all = &choice->all;
    const int margin = retex_compact_margin(choice->reference);
    const float albedo = work->gain->albedo, exposure = choice->exposure;
    float *row = malloc(sizeof *row * 3 * (size_t)all->width);
    (void)thread;
    work->rows[y] = row ? 0 : NAN;
    if (!row || !(retex_compact_row_weight(choice->reference, y) > 0)) {
        free(row);
        return;
    }
    retex_enlarge_rows(work->coarse, work->scale, all->width, y, y + 1, row);
    const size_t first = retex_image_index(all, 0, y);
    for (int i = 3 * margin; i < 3 * (all->width - margin); i++) {
        const size_t at = first + (size_t)i;
        const float light = choice->picture.pixels[at];
        const float off = albedo * (all->pixels[at] * row[i] - work->gain->light.pixels[at]);
        const double d = (double)encoded(exposure * (light + off)) - (double)encoded(exposure * light);
        work->rows[y] += d * d;
    }
    free(row);
}

static int measure_step(LampChoice *choice, LampGain *gain, int step, double *rows, RetexError *err)
{
    RetexImage coarse = {0};
    ErrorWork work = {choice, gain, &coarse, 1 << step, rows};
    const RetexImage *all = &choice->all;
    const int columns = all->width - 2 * retex_compact_margin(choice->reference);
    double weights = 0;
    int code = retex_compact_share(&coarse, &gain->light, all, 1 << step, choice->nthreads, err);
    if (!code)
        retex_parallel(choice->nthreads, all->height, error_row, &work);
    gain->squares[step] = 0;
    for (int y = 0; y < all->height && !code; y++) {
        gain->squares[step] += retex_compact_row_weight(choice->reference, y) * rows[y];
        weights += retex_compact_row_weight(choice->reference, y);
    }
    gain->squares[step] /= weights * 3 * columns;
    retex_image_free(&coarse);
    return code || isfinite(gain->squares[step]) ? code : retex_fail(err, RETEX_ENOMEM, "not enough memory for lamps");
}

/* Errors by step, without noise that averaging removes. */
static int measure_gain(LampChoice *choice, LampGain *gain, RetexError *err)
{
    double *rows = malloc(sizeof *rows * (size_t)choice->picture.height);
    int code = rows ? make_all(choice, gain->kind, err) : retex_fail(err, RETEX_ENOMEM, "no memory for lamps");
    for (int step = 1; step < STEPS && !code; step++)
        code = measure_step(choice, gain, step, rows, err);
    const double noise = (2 * gain->squares[1] - gain->squares[2]) / (2 * (1 - 1.0 / 4) - (1 - 1.0 / 16));
    gain->noise = choice->light->noise * fmax(noise, 0);
    for (int step = 1; step < STEPS; step++)
        gain->squares[step] =
            fmax(gain->squares[step] - NOISE_IGNORED * gain->noise * (1 - 1.0 / (1 << (2 * step))), 0);
    free(rows);
    return code;
}

/* ---- one lamp ---- */

static LampGain *add_gain(LampChoice *work, int kind, int place, int hits, unsigned char *scale)
{
    LampGain *gain = &work->gains[work->count++];
    *gain = (LampGain){.kind = kind, .place = place, .albedo = powf(RETEX_COMPACT_GREY, (float)hits), .scale = scale};
    return gain;
}

/* List the gains of a parameter's lamp that have a kind's hits. */
static int list_of_kind(LampChoice *work, int number, int parameter, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    const RetexCompactKind *kind = &light->kinds[number];
    const RetexCompactMixed mixed = work->scales->mixed[number];
    int code = RETEX_OK;
    for (int place = 0; place < light->nlamps + kind->ngains[mixed] && !code; place++) {
        const int lamps = retex_compact_term_lamps(light, kind, mixed, place);
        const int gain = place - light->nlamps, hits = gain < 0 ? 1 : retex_term_hits(&kind->gains[mixed][gain].term);
        if (!light->lamps[lamps].alone || light->lamps[lamps].factors[0].index != parameter ||
            (gain < 0 && !retex_compact_has_single(kind, lamps)) || !retex_compact_has_light(light, kind, light->all))
            continue;
        LampGain *own =
            add_gain(work, number, place, hits, retex_compact_lamp_scale(work->scales, light, number, place));
        code = retex_compact_term_light(&own->light, light, kind, mixed, place, err);
    }
    return code;
}

static int list_gains(LampChoice *work, int parameter, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    const RetexSet *set = light->set;
    int code = RETEX_OK;
    for (int k = 0; k < light->nkinds && !code; k++)
        if (light->kinds[k].kind != RETEX_FOOTPRINT_INTERREFLECTION)
            code = list_of_kind(work, k, parameter, err);
    for (int t = 0; t < set->nterms && retex_compact_light_without_hits(set) >= 0 && !code; t++)
        if (retex_compact_is_lamp_share(&set->terms[t]) && retex_set_term_lamp(set, &set->terms[t]) == parameter)
            code = retex_image_copy(
                &add_gain(work, -1, 0, 0, retex_compact_share_scale(work->scales, light, parameter))->light,
                &set->parts[set->terms[t].radiance].image, err);
    return code;
}

static double mean_of(const LampChoice *work, const RetexImage *image)
{
    double sum = 0, weights = 0;
    for (int y = 0; y < image->height; y++) {
        const double weight = retex_compact_row_weight(work->reference, y);
        const float *row = image->pixels + retex_image_index(image, 0, y);
        for (int i = 0; i < 3 * image->width; i++)
            sum += weight * fmax((double)row[i], 0);
        weights += weight * 3 * image->width;
    }
    return sum / weights;
}

/* How bright the picture by all lamps is, with textures of RETEX_COMPACT_GREY. */
static int measure_whole(LampChoice *work, RetexError *err)
{
    const RetexCompactLight *light = work->light;
    const RetexSet *set = light->set;
    const int without = retex_compact_light_without_hits(set);
    RetexImage sum = {0};
    int code = RETEX_OK;
    work->whole = without >= 0 ? mean_of(work, &set->parts[set->terms[without].radiance].image) : 0;
    for (int k = 0; k < light->nkinds && !code; k++) {
        const RetexCompactKind *kind = &light->kinds[k];
        if (kind->kind == RETEX_FOOTPRINT_INTERREFLECTION || !retex_compact_has_light(light, kind, light->all))
            continue;
        code = retex_compact_sum_light(&sum, light, kind, light->all, work->nthreads, err);
        work->whole += code ? 0 : (double)RETEX_COMPACT_GREY * mean_of(work, &sum);
        retex_image_free(&sum);
    }
    return code;
}

/* The picture by the lamp alone, and how bright it is looked at. */
static int make_picture(LampChoice *work, int parameter, RetexError *err)
{
    const RetexSet *set = work->light->set;
    const float *kept = set->parameters[parameter].kept;
    const size_t count = 3 * (size_t)set->width * (size_t)set->height;
    int code = retex_image_alloc(&work->picture, set->width, set->height, 3, err);
    if (code)
        return code;
    for (int i = 0; i < work->count; i++)
        for (size_t k = 0; k < count; k++)
            work->picture.pixels[k] += work->gains[i].albedo * work->gains[i].light.pixels[k];
    const double own = mean_of(work, &work->picture);
    const double most = BRIGHTER_MOST * (double)retex_luminance(kept[0], kept[1], kept[2]);
    work->exposure = own > 0 ? (float)fmin(work->whole / own, most > 0 ? most : BRIGHTER_MOST) : 1;
    return RETEX_OK;
}

/* The gain whose next finer step saves most error for a number; NULL: all are at their finest. */
static LampGain *next_finer(const LampChoice *work)
{
    LampGain *best = NULL;
    double most = -1;
    for (int i = 0; i < work->count; i++) {
        LampGain *gain = &work->gains[i];
        for (int step = 0; step < gain->step; step++) {
            const double numbers = pow(4, -step) - pow(4, -gain->step);
            const double saved = (gain->squares[gain->step] - gain->squares[step]) / numbers;
            if (saved > most)
                best = gain, most = saved;
        }
    }
    return best;
}

static int choose_of_lamp(LampChoice *work, int parameter, double bound, RetexError *err)
{
    double sum = 0, noise = 0;
    work->count = 0;
    int code = list_gains(work, parameter, err);
    if (!code)
        code = make_picture(work, parameter, err);
    for (int i = 0; i < work->count && !code; i++) {
        code = measure_gain(work, &work->gains[i], err);
        work->gains[i].step = STEPS - 1;
        sum += work->gains[i].squares[STEPS - 1];
        noise += work->gains[i].noise;
    }
    bound = fmax(bound, NOISE_ALLOWED * noise);
    for (LampGain *gain = NULL; !code && sum > bound && (gain = next_finer(work));) {
        sum += gain->squares[gain->step - 1] - gain->squares[gain->step];
        gain->step--;
    }
    for (int i = 0; i < work->count && !code; i++)
        *work->gains[i].scale = (unsigned char)(1 << work->gains[i].step);
    for (int i = 0; i < work->count; i++)
        retex_image_free(&work->gains[i].light);
    retex_image_free(&work->picture);
    return code;
}

int retex_compact_lamps_choose(RetexCompactScales *scales, const RetexCompactReference *reference,
                               const RetexCompactLight *light, double bound, int nthreads, RetexError *err)
{
    LampChoice work = {.reference = reference, .light = light, .scales = scales, .nthreads = nthreads};
    int code = retex_compact_lamps_fixed(scales, light, 1, err);
    if (code || !scales->lamps)
        return code;
    work.gains =
        calloc((size_t)light->nkinds * (size_t)retex_compact_most_places(light) + (size_t)light->set->nterms + 1,
               sizeof *work.gains);
    if (!work.gains)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for lamps");
    else
        code = measure_whole(&work, err);
    for (int i = 0; i < light->set->nparameters && !code; i++)
        if (light->set->parameters[i].kind == RETEX_PARAMETER_COLOR)
            code = choose_of_lamp(&work, i, bound, err);
    retex_image_free(&work.all);
    free(work.gains);
    return code;
}
