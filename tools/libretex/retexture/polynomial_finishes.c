/* See polynomial_finishes.h. */
#include "retexture/polynomial_finishes.h"

#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>
#include <retex/parallel.h>

#include "base/jobs.h"
#include "retexture/enlarge.h"
#include "retexture/polynomial_factors.h"
#include "retexture/sample_row.h"
#include "set/parts.h"
#include "set/samples.h"
#include "set/set.h"
#include "texture/pyramid.h"

#define ROWS_A_JOB 64    /* a pack's strip */
#define SPAN_PIXELS 1024 /* filtered in one call */

/* ---- which targets have maps ---- */

int retex_polynomial_find_maps(RetexPolynomial *p, RetexError *err)
{
    const RetexSet *set = p->set;
    for (int t = 0; t < set->ntargets; t++) {
        const RetexTexture *texture = p->textures ? p->textures[t] : NULL;
        p->mapped[t] = texture ? retex_texture_has_finishes(texture)
                       : p->samples && retex_samples_find(p->samples, t, -1, -1) >= 0 ? set->targets[t].nfinishes
                                                                                      : 0;
        p->shown[t] = set->targets[t].finish - 1;
        if (p->mapped[t] && p->mapped[t] != set->targets[t].nfinishes)
            return retex_fail(err, RETEX_EINVAL, "a map of %d finishes for %s, which has %d", p->mapped[t],
                              set->targets[t].name, set->targets[t].nfinishes);
        p->has_normals |= p->mapped[t] && set->targets[t].normal_tilt > 0;
        for (int i = 0; i < set->nparameters; i++) {
            const float *value = p->parameters[i];
            if (set->parameters[i].finishes[t] && (value[0] != 0 || value[1] != 0 || value[2] != 0))
                p->shown[t] = set->parameters[i].finishes[t] - 1;
        }
    }
    return RETEX_OK;
}

/* Whether two parameters are of the same light but for the finishes of targets with maps. */
static int differ_by_maps(const RetexPolynomial *p, const RetexParameter *a, const RetexParameter *b)
{
    int same = a->kind == b->kind && strcmp(a->lamp, b->lamp) == 0;
    for (int t = 0; t < p->set->ntargets && same; t++)
        same = p->mapped[t] && a->finishes[t] ? b->finishes[t] != 0 : a->finishes[t] == b->finishes[t];
    return same;
}

/* The value of a parameter whose finishes a map chooses: that which it has with the finish that is shown. */
static void add_parameter(const RetexPolynomial *p, int number, RetexPolynomialTerm *made)
{
    const RetexParameter *parameter = &p->set->parameters[number];
    int is_mapped = 0;
    float sum[3] = {0, 0, 0};
    for (int t = 0; t < p->set->ntargets; t++)
        is_mapped |= p->mapped[t] && parameter->finishes[t];
    for (int i = 0; i < p->set->nparameters; i++)
        for (int c = 0; c < 3 && (is_mapped ? differ_by_maps(p, parameter, &p->set->parameters[i]) : i == number); c++)
            sum[c] += p->parameters[i][c];
    for (int c = 0; c < 3; c++)
        made->weight[c] *= sum[c];
    made->weighted = 1;
}

/* ---- where the finish is chosen ---- */

static int is_first_hit(const RetexSet *set, int footprint, int target)
{
    const RetexFootprint *f = &set->footprints[footprint];
    return f->target == target && f->kind != RETEX_FOOTPRINT_INTERREFLECTION && f->kind != RETEX_FOOTPRINT_HIT;
}

/* The factor that is the term's first hit, if that is on the target; else -1. */
static int first_hit(const RetexPolynomial *p, const RetexTerm *term, const RetexPolynomialTerm *made, int target)
{
    int k = 0;
    while (k < made->nfactors && !retex_factor_is_hit(made->factors[k]))
        k++;
    if (k == made->nfactors || term->target != target || term->role == RETEX_ROLE_CORRECTION)
        return -1;
    const RetexFactor hit = made->factors[k];
    if (hit.kind == RETEX_FACTOR_FOOTPRINT)
        return is_first_hit(p->set, hit.index, target) ? k : -1;
    const RetexMixture *mixture = &p->set->mixtures[hit.index];
    for (int i = 0; i < mixture->nshares; i++)
        if (!is_first_hit(p->set, mixture->shares[i].footprint, target))
            return -1;
    return k;
}

static int is_on_target(const RetexPolynomial *p, RetexFactor factor, int target)
{
    const RetexSet *set = p->set;
    if (factor.kind == RETEX_FACTOR_FOOTPRINT)
        return set->footprints[factor.index].target == target;
    int any = 0;
    for (int i = 0; factor.kind == RETEX_FACTOR_MIXTURE && i < set->mixtures[factor.index].nshares; i++)
        any |= set->footprints[set->mixtures[factor.index].shares[i].footprint].target == target;
    return any;
}

/* Whether light of the term met the colour of the target. If not, no diffuse lobe reflected it there: normals do not
 * matter, and light with all of them is the same but for noise. */
static int has_hit(const RetexPolynomial *p, const RetexPolynomialTerm *made, int target)
{
    int any = 0;
    for (int k = 0; k < made->nfactors; k++)
        any |= retex_factor_is_hit(made->factors[k]) && is_on_target(p, made->factors[k], target);
    return any;
}

/* Sorts the factors of a term: parameters into its weight, all others to where they stay. finishes: by target with a
 * map the number of the finish that the term's light met it with, from 1. */
static void sort_factors(const RetexPolynomial *p, const RetexTerm *term, RetexPolynomialTerm *made,
                         int finishes[RETEX_MAX_TARGETS])
{
    for (int k = 0; k < term->nfactors; k++) {
        const RetexFactor factor = term->factors[k];
        if (factor.kind != RETEX_FACTOR_PARAMETER) {
            made->factors[made->nfactors++] = factor;
            continue;
        }
        const signed char *of_parameter = p->set->parameters[factor.index].finishes;
        add_parameter(p, factor.index, made);
        for (int t = 0; t < p->set->ntargets; t++)
            if (p->mapped[t] && of_parameter[t])
                finishes[t] = of_parameter[t];
    }
}

/* Lets the map of a target say how much of a term counts, whose light met the target with this finish, from 1. */
static void weigh_by_map(const RetexPolynomial *p, const RetexTerm *term, RetexPolynomialTerm *made, int target,
                         int finish)
{
    const RetexQuantity by_map = POLYNOMIAL_FINISHED(finish - 1);
    const int hit = first_hit(p, term, made, target);
    if (hit >= 0) {
        made->factors[hit].quantity = by_map;
    } else if (p->set->targets[target].normal_tilt > 0 && !has_hit(p, made, target)) {
        for (int c = 0; c < 3; c++) /* it is the same with all three normals, and counts once */
            made->weight[c] *= finish == 1;
    } else if (made->nfactors < RETEX_MAX_FACTORS) {
        RetexFactor gate = retex_factor(POLYNOMIAL_GATE, target);
        gate.quantity = by_map;
        made->factors[made->nfactors++] = gate;
    }
}

void retex_polynomial_factor_finishes(const RetexPolynomial *p, const RetexTerm *term, RetexPolynomialTerm *made)
{
    int finishes[RETEX_MAX_TARGETS] = {0};
    *made = (RetexPolynomialTerm){.weight = {1, 1, 1}};
    sort_factors(p, term, made, finishes);
    for (int c = 0; c < 3 && p->lamps && retex_set_term_lamp(p->set, term) < 0; c++) {
        made->weight[c] *= p->common[c];
        made->weighted |= p->common[c] != 1;
    }
    for (int t = 0; t < p->set->ntargets; t++)
        if (finishes[t])
            weigh_by_map(p, term, made, t, finishes[t]);
}

/* ---- gates ----
 *
 * A gate is the mean weight of a finish over the target's footprints in a pixel. What is seen sharply counts far more
 * than what scattered light met, and that more than later hits: these only decide where there is nothing else. Sums are
 * of the weights of the second finish and later ones, and of what they are divided by. */

static const float importance[RETEX_FOOTPRINT_KINDS] = {[RETEX_FOOTPRINT_HIT] = 1,
                                                        [RETEX_FOOTPRINT_SHARP] = 1,
                                                        [RETEX_FOOTPRINT_BROAD] = 1e-3f,
                                                        [RETEX_FOOTPRINT_INTERREFLECTION] = 1e-6f};

/* Adds a row of a footprint, at its own size. */
static int add_footprint(const RetexPolynomial *p, RetexRowReader *reader, int footprint, int y, float *sums,
                         RetexError *err)
{
    const RetexFootprint *f = &p->set->footprints[footprint];
    RETEX_ASSERT(p->textures && p->textures[f->target] && p->textures[f->target]->finishes);
    const int shown = p->shown[f->target];
    float rgba[4 * SPAN_PIXELS];
    RetexFootprintRow from;
    const int code = retex_footprint_row_read(&from, reader, p->set, f, y, 0, err);
    if (code || !from.uv)
        return code;
    for (int x0 = from.span.begin; x0 < from.span.end; x0 += SPAN_PIXELS) {
        const int count = from.span.end - x0 < SPAN_PIXELS ? from.span.end - x0 : SPAN_PIXELS;
        const float *uv = from.uv + 3 * (size_t)x0;
        retex_texture_filter(p->textures[f->target]->finishes->weights, retex_footprint_filter(p->set, f), uv,
                             from.spread + (size_t)from.spreads * (size_t)x0, from.spreads, (size_t)count, rgba, 4);
        for (int i = 0; i < count; i++) {
            const float weight = importance[f->kind] * uv[3 * i + 2], alpha = rgba[4 * i + 3];
            float *sum = sums + 4 * (size_t)(x0 + i);
            if (!(weight > 0))
                continue;
            for (int c = 0; c < 3; c++)
                sum[c] += weight * (alpha * rgba[4 * i + c] + (shown == c + 1 ? 1 - alpha : 0));
            sum[3] += weight;
        }
    }
    return RETEX_OK;
}

/* Adds the row of all footprints of a target that have this scale. */
static int add_footprints(const RetexPolynomial *p, RetexRowReader *reader, int target, int scale, int y, float *sums,
                          RetexError *err)
{
    int code = RETEX_OK;
    for (int f = 0; f < p->set->nfootprints && !code; f++)
        if (p->set->footprints[f].target == target && retex_set_footprint_scale(p->set, f) == scale)
            code = add_footprint(p, reader, f, y, sums, err);
    return code;
}

static int scale_index(int scale)
{
    RETEX_ASSERT(scale == 2 || scale == 4 || scale == RETEX_SCALE_MAX);
    return scale == 2 ? 0 : scale == 4 ? 1 : 2;
}

enum { REDUCED_SCALES = 3 };

typedef struct GateWork {
    const RetexPolynomial *polynomial;
    int target, scale;
    RetexImage *sums;
    RetexRowReader **readers; /* by thread */
} GateWork;

static int gate_job(void *context, int index, int thread, RetexError *err)
{
    const GateWork *work = context;
    const RetexPolynomial *p = work->polynomial;
    RetexRowReader **reader = &work->readers[thread];
    int code = *reader ? RETEX_OK : retex_row_reader_open(reader, p->set, p->samples, err);
    for (int y = index * ROWS_A_JOB; !code && y < (index + 1) * ROWS_A_JOB && y < work->sums->height; y++)
        code = add_footprints(p, *reader, work->target, work->scale, y,
                              work->sums->pixels + retex_image_index(work->sums, 0, y), err);
    return code;
}

static int make_sums(RetexPolynomial *p, int target, int scale, int nthreads, RetexError *err)
{
    const int threads = retex_threads(nthreads), width = (p->set->width + scale - 1) / scale,
              height = (p->set->height + scale - 1) / scale;
    GateWork work = {p, target, scale, &p->gates[target * REDUCED_SCALES + scale_index(scale)], NULL};
    int code = retex_image_alloc(work.sums, width, height, 4, err);
    if (code)
        return code;
    memset(work.sums->pixels, 0, sizeof *work.sums->pixels * 4 * (size_t)width * (size_t)height);
    if (!(work.readers = calloc((size_t)threads, sizeof *work.readers)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    code = retex_jobs_run(threads, (height + ROWS_A_JOB - 1) / ROWS_A_JOB, gate_job, &work, err);
    for (int i = 0; i < threads; i++)
        retex_row_reader_close(&work.readers[i]);
    free(work.readers);
    return code;
}

int retex_polynomial_gates_open(RetexPolynomial *p, int nthreads, RetexError *err)
{
    int code = RETEX_OK;
    if (!(p->gates = calloc(RETEX_MAX_TARGETS * REDUCED_SCALES, sizeof *p->gates)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to combine");
    for (int f = 0; f < p->set->nfootprints && !code; f++) {
        const int target = p->set->footprints[f].target, scale = retex_set_footprint_scale(p->set, f);
        if (p->mapped[target] && p->textures && p->textures[target] && scale > 1 &&
            !p->gates[target * REDUCED_SCALES + scale_index(scale)].pixels)
            code = make_sums(p, target, scale, nthreads, err);
    }
    return code;
}

void retex_polynomial_gates_close(RetexPolynomial *p)
{
    for (int i = 0; p->gates && i < RETEX_MAX_TARGETS * REDUCED_SCALES; i++)
        retex_image_free(&p->gates[i]);
    free(p->gates);
    p->gates = NULL;
}

int retex_polynomial_gate_row(const RetexPolynomial *p, RetexRowReader *reader, int target, int y, float *scratch,
                              float *rgb, RetexError *err)
{
    const size_t width = (size_t)p->set->width;
    float *sums = scratch, *enlarged = scratch + 4 * width;
    memset(sums, 0, sizeof *sums * 4 * width);
    const int code = add_footprints(p, reader, target, 1, y, sums, err);
    for (int scale = 2; scale <= RETEX_SCALE_MAX && !code; scale *= 2) {
        const RetexImage *image = &p->gates[target * REDUCED_SCALES + scale_index(scale)];
        if (!image->pixels)
            continue;
        retex_enlarge_rows(image, scale, p->set->width, y, y + 1, enlarged);
        for (size_t i = 0; i < 4 * width; i++)
            sums[i] += enlarged[i];
    }
    for (size_t x = 0; x < width; x++)
        for (int c = 0; c < 3; c++) {
            const float *sum = sums + 4 * x;
            rgb[3 * x + (size_t)c] = sum[3] > 0 ? sum[c] / sum[3] : p->shown[target] == c + 1;
        }
    return code;
}

int retex_polynomial_gate_rows(const RetexPolynomial *p, RetexRowReader *reader, int target, int y, float *scratch,
                               float *const rows[RETEX_FINISHES_MAX], RetexError *err)
{
    const int width = p->set->width, sampled = p->samples ? retex_samples_find(p->samples, target, -1, -1) : -1;
    const int is_signed = p->set->targets[target].normal_tilt > 0;
    const float *rgb = rows[0];
    RETEX_ASSERT(p->mapped[target] >= 2 && p->mapped[target] <= RETEX_FINISHES_MAX);
    RETEX_ASSERT(!is_signed || p->mapped[target] == 3); /* normals: one, and that tilted along u and along v */
    const int is_sampled = sampled >= 0 && !(p->textures && p->textures[target]);
    const int code = is_sampled ? retex_row_reader_sample(reader, sampled, y, &rgb, err)
                                : retex_polynomial_gate_row(p, reader, target, y, scratch, rows[0], err);
    for (size_t x = 0; x < (size_t)width && !code; x++) {
        float weights[RETEX_FINISHES_MAX] = {1};
        for (int k = 1; k < RETEX_FINISHES_MAX; k++) {
            weights[k] = rgb ? rgb[3 * x + (size_t)k - 1] : 0;
            weights[0] -= weights[k];
        }
        for (int k = 0; k < p->mapped[target]; k++)
            for (int c = 0; c < 3; c++)
                rows[k][3 * x + (size_t)c] = weights[k] > 0 || is_signed ? weights[k] : 0;
    }
    return code;
}
