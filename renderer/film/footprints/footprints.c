/* From the paths of a pixel to clusters; see footprints.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "film/footprints/footprints.h"
#include "film/footprints/lamps.h"

#define LEAST_ALBEDO 1e-3f /* of other hits, as weights of a hit's albedo */

/* ---- life ---- */

static void close_pixel(void **pixel)
{
    FootprintPixel *p = *pixel;
    if (!p)
        return;
    lamps_pixel_close(&p->lamps);
    free(p->targets);
    free(p);
    *pixel = NULL;
}

static int create_pixel(void **out, void *layout, LightSums *light, UvRange *range, RetexError *err)
{
    FootprintFilm *film = layout;
    FootprintPixel *p = *out = calloc(1, sizeof *p);
    if (p) {
        p->film = film;
        p->targets = calloc((size_t)film->scene->ntargets + 1, sizeof *p->targets);
        p->light = light, p->range = range;
        p->quadrants.target = QUADRANTS_NONE;
    }
    const int code = p && p->targets ? lamps_pixel_create(&p->lamps, film, err)
                                     : retex_fail(err, RETEX_ENOMEM, "out of memory for a thread's pixel");
    if (code)
        close_pixel(out);
    return code;
}

/* ---- light ---- */

/* The albedo of another hit, as a weight of this hit's own albedo. It is never quite black: a target whose original is
 * black may be the one that is retextured, and then the other albedos matter. */
static Float4 weighing_albedo(Rgb a)
{
    return (Float4){a.r > LEAST_ALBEDO ? a.r : LEAST_ALBEDO, a.g > LEAST_ALBEDO ? a.g : LEAST_ALBEDO,
                    a.b > LEAST_ALBEDO ? a.b : LEAST_ALBEDO, 1};
}

static inline void add_coefficient(HitLight *sum, int k, Float4 value)
{
    sum->c[k] = sum->used >> k & 1 ? sum->c[k] + value : value;
    sum->used |= 1u << k;
}

/* Add light times the factor of a hit, without its texture. */
static inline void add_times(const FootprintFilm *film, HitLight *sum, const HitLight *light, Float4 by)
{
    for (int t = 0; t < corrected_targets(film->scene); t++)
        for (int n = 0; n <= CORRECTION_POWERS; n++)
            sum->edited[t][n] += light->edited[t][n] * by;
    sum->c[0] += light->c[0] * by;
    sum->original += light->original * by;
    sum->half += light->half * by;
    for (unsigned left = light->used; left; left &= left - 1) {
        int k = __builtin_ctz(left);
        add_coefficient(sum, k, light->c[k] * by);
    }
}

/* Add light times the texture of one more hit. */
static inline void add_textured(const FootprintFilm *film, HitLight *sum, const HitLight *light,
                                const TargetVertex *hit, Float4 albedo)
{
    const Plan *plan = &film->plan;
    const int target = hit->target;
    const Float4 original = color4(hit->albedo);
    for (int t = 0; t < corrected_targets(film->scene); t++)
        for (int n = 0; n <= CORRECTION_POWERS; n++) {
            const Float4 all = light->edited[t][n] + (n ? splat(0) : light->c[0]);
            if (t == target)
                sum->edited[t][correction_power(n + 1)] += all;
            else
                sum->edited[t][n] += all * original;
        }
    sum->original += (light->c[0] + light->original) * albedo;
    sum->half += (light->c[0] + light->half) * splat(0.5f);
    add_coefficient(sum, plan->coefficients[0].next[target], light->c[0]);
    for (unsigned left = light->used; left; left &= left - 1) {
        int k = __builtin_ctz(left);
        add_coefficient(sum, plan->coefficients[k].next[target], light->c[k]);
    }
}

static inline void start_light(const FootprintFilm *film, HitLight *light, Float4 value)
{
    light->c[0] = value;
    memset(light->edited, 0, (size_t)corrected_targets(film->scene) * sizeof *light->edited);
    light->original = light->half = splat(0);
    light->used = 0;
}

/* Set what the hits before this one, towards the camera, do to light that comes from it. */
static inline void start_node(const FootprintFilm *film, Node *node, const TargetNode *hit, const Node *before)
{
    start_light(film, &node->dependent, hit->dependent);
    start_light(film, &node->independent, hit->independent);
    node->white = target_factor_white(hit->dependent, hit->independent);
    if (!before) {
        node->none = node->original = node->half = splat(1);
        return;
    }
    node->none = before->none * hit->before_i;
    node->original = before->original * (hit->before_i + hit->before_d * before->albedo);
    node->half = before->half * (hit->before_i + hit->before_d * splat(0.5f));
}

/* Add a hit that is an interreflection, in the monomials that have a factor of a hit before it. */
static int add_interreflection(FootprintPixel *p, const TargetNode *hit, const Node *node)
{
    const HitLight *light = &node->dependent;
    const double weight = luminance4((node->half - node->none) * (light->c[0] + light->half));
    if (!(weight > 0))
        return 0;
    const Interreflection further = {.target = hit->at.target,
                                     .uv = {hit->at.uv.u, hit->at.uv.v},
                                     .weight = weight,
                                     .light = (node->original - node->none) * (light->c[0] + light->original),
                                     .albedo = color4(hit->at.albedo)};
    clusters_add_interreflection(&p->targets[further.target], &further, p->film->params.periodic[further.target]);
    return 1;
}

/* Whether a hit is where the camera's ray of its path met a target. */
static int is_seen(const SeenTarget *seen, const TargetNode *hit)
{
    return !hit->before && hit->at.target == seen->target && hit->at.uv.u == seen->uv.u && hit->at.uv.v == seen->uv.v;
}

/* Add a hit as the first one, in the monomials that have no factor of a hit before it. */
static int add_first(FootprintPixel *p, const SeenTarget *seen, const TargetNode *hit, HitLight *light)
{
    const double weight = luminance4(light->c[0] + light->half);
    if (!(weight > 0))
        return 0;
    const int may_cover = p->quadrants.target == hit->at.target, is_direct = may_cover && is_seen(seen, hit);
    const FirstHit first = {.target = hit->at.target,
                            .sharp = hit->at.sharp,
                            .direct = hit->at.direct,
                            .is_rest = may_cover && hit->at.sharp && !is_direct,
                            .uv = {hit->at.uv.u, hit->at.uv.v},
                            .weight = weight,
                            .light = light,
                            .albedo = color4(hit->at.albedo)};
    clusters_add(&p->targets[first.target], &first, &p->film->params);
    if (is_direct)
        quadrants_add(&p->quadrants, seen, &first);
    corrections_add(p, &first);
    return 1;
}

static void scale_light(const FootprintFilm *film, HitLight *light, Float4 by)
{
    for (int t = 0; t < corrected_targets(film->scene); t++)
        for (int n = 0; n <= CORRECTION_POWERS; n++)
            light->edited[t][n] *= by;
    light->c[0] *= by, light->original *= by, light->half *= by;
    for (unsigned left = light->used; left; left &= left - 1)
        light->c[__builtin_ctz(left)] *= by;
}

/* Add a hit's light to the hit before it, once it has the light of all further hits itself. */
static void gather_node(FootprintPixel *p, const TargetNode *hit, Node *node, Node *before)
{
    add_textured(p->film, &node->independent, &node->dependent, &hit->at, node->albedo);
    add_times(p->film, &before->dependent, &node->independent, hit->before_d);
    if (!is_black4(hit->before_i))
        add_times(p->film, &before->independent, &node->independent, hit->before_i);
    before->white += node->white * target_factor_white(hit->before_d, hit->before_i);
}

static void add_range(FootprintPixel *p, const TargetNode *hit)
{
    const double uv[2] = {hit->at.uv.u, hit->at.uv.v};
    uv_range_add(p->range, hit->at.target, uv);
}

static void finish_node(FootprintPixel *p, const SeenTarget *seen, const TargetNode *hit, Node *node)
{
    int was_met = 0;
    if (hit->before) {
        was_met = add_interreflection(p, hit, node);
        scale_light(p->film, &node->dependent, node->none);
    }
    was_met |= add_first(p, seen, hit, &node->dependent);
    if (was_met)
        add_range(p, hit);
}

/* As end_several, of a path with one hit, as most are. */
static void end_single(FootprintPixel *p, const TargetTree *path, Float4 *indep, Float4 *white)
{
    const TargetNode *hit = path->last;
    HitLight light;
    start_light(p->film, &light, hit->dependent);
    *indep += hit->independent;
    *white += target_factor_white(hit->dependent, hit->independent);
    if (add_first(p, &path->seen, hit, &light))
        add_range(p, hit);
}

static void end_several(FootprintPixel *p, const TargetTree *path, const TargetNode *const *hits, Float4 *indep,
                        Float4 *white)
{
    for (int k = 0; k < path->count; k++) {
        const TargetNode *before = hits[k]->before;
        p->nodes[k].albedo = weighing_albedo(hits[k]->at.albedo);
        start_node(p->film, &p->nodes[k], hits[k], before ? &p->nodes[before->number] : NULL);
    }
    for (int k = path->count - 1; k >= 0; k--)
        if (hits[k]->before)
            gather_node(p, hits[k], &p->nodes[k], &p->nodes[hits[k]->before->number]);
    for (int k = 0; k < path->count; k++) {
        if (!hits[k]->before)
            *indep += p->nodes[k].independent.c[0], *white += p->nodes[k].white;
        finish_node(p, &path->seen, hits[k], &p->nodes[k]);
    }
}

static void end_path(void *pixel, const TargetTree *path)
{
    FootprintPixel *p = pixel;
    const TargetNode *hits[TARGET_NODES_MAX];
    Float4 indep = path->without_hit, white = path->without_hit;
    if (p->film->quadrants)
        quadrants_start_path(&p->quadrants, &path->seen, p->film->params.periodic);
    for (const TargetNode *hit = path->last; hit; hit = hit->earlier)
        hits[hit->number] = hit;
    if (path->count == 1)
        end_single(p, path, &indep, &white);
    else if (path->count)
        end_several(p, path, hits, &indep, &white);
    if (p->lamps)
        lamps_end_path(p->lamps, path, hits, p->nodes);
    for (int c = 0; c < 3; c++)
        p->indep[c] += (double)indep[c];
    p->light->total_white += luminance4(white);
}

static void signal_total(double total[3], const Clusters *clusters, const Plan *plan)
{
    total[0] = total[1] = total[2] = 0;
    for (int k = 0; k < clusters->count; k++)
        for (int c = 0; c < 3; c++)
            total[c] += (double)clusters->of[k].c[c];
    for (int i = 1; clusters->used >> i; i++)
        for (int c = 0; c < 3 && clusters->used >> i & 1; c++)
            total[c] += plan->coefficients[i].weight * clusters->interreflected[i][c];
}

static void sum_signals(const void *pixel, SignalTotals *totals)
{
    const FootprintPixel *p = pixel;
    memcpy(totals->of[0], p->indep, sizeof p->indep);
    for (int t = 0; t < p->film->scene->ntargets; t++) {
        signal_total(totals->of[1 + 2 * t], &p->targets[t].sharp, &p->film->plan);
        signal_total(totals->of[2 + 2 * t], &p->targets[t].broad, &p->film->plan);
    }
    if (p->lamps)
        lamps_totals(p->lamps, totals, 1 + 2 * p->film->scene->ntargets);
}

static int most_hits(int ntargets)
{
    (void)ntargets;
    return RETEX_MAX_HITS;
}

const FilmLayout footprints_layout = {.name = "footprints",
                                      .nsignals = 2,
                                      .signals = {"sharp", "broad"},
                                      .keeps_white = 1,
                                      .prunes = 1,
                                      .most_hits = most_hits,
                                      .floats = footprints_floats,
                                      .create = footprints_create,
                                      .close = footprints_close,
                                      .pixel_create = create_pixel,
                                      .pixel_close = close_pixel,
                                      .path_end = end_path,
                                      .totals = sum_signals,
                                      .pixel_end = footprints_pixel_end,
                                      .band_stats = footprints_band_stats,
                                      .finish = footprints_finish};
