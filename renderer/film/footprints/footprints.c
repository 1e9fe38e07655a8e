/* From the paths of a pixel to clusters; see footprints.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>
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
    free(p->combined);
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
        if (film->scene->ncombinations)
            p->combined = aligned_alloc(sizeof(Float4), TARGET_NODES_MAX * sizeof *p->combined);
        p->quadrants.target = QUADRANTS_NONE;
    }
    const int has_memory = p && p->targets && (p->combined || !film->scene->ncombinations);
    const int code = has_memory ? lamps_pixel_create(&p->lamps, film, err)
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
    RETEX_ASSERT(k > 0); /* there is a way on: the limits of hits are those of the plan */
    sum->c[k] = sum->used >> k & 1 ? sum->c[k] + value : value;
    sum->used |= 1u << k;
}

/* Before the first light with further hits is added. */
static inline void open_edited(const FootprintFilm *film, HitLight *sum)
{
    if (sum->used)
        return;
    for (int t = 0; t < corrected_targets(film->scene); t++)
        for (int n = 0; n <= CORRECTION_POWERS; n++)
            sum->edited[t][n] = splat(0);
}

/* Add light times the factor of a hit, without its texture. */
static inline void add_times(const FootprintFilm *film, HitLight *sum, const HitLight *light, Float4 by)
{
    sum->c[0] += light->c[0] * by;
    if (!light->used)
        return;
    open_edited(film, sum);
    for (int t = 0; t < corrected_targets(film->scene); t++)
        for (int n = 0; n <= CORRECTION_POWERS; n++)
            sum->edited[t][n] += light->edited[t][n] * by;
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
    open_edited(film, sum);
    for (int t = 0; t < corrected_targets(film->scene); t++)
        for (int n = 0; n <= (light->used ? CORRECTION_POWERS : 0); n++) {
            const Float4 all = (light->used ? light->edited[t][n] : splat(0)) + (n ? splat(0) : light->c[0]);
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

static inline void start_light(HitLight *light, Float4 value)
{
    light->c[0] = value;
    light->original = light->half = splat(0);
    light->used = 0;
}

/* Set the light of a hit, D and I, and what the hits before it, towards the camera, do to light that comes from it. */
static inline void start_node(Node *node, FinishFactor light, FinishFactor by,
                              const Node *before)
{
    start_light(&node->dependent, light.d);
    start_light(&node->independent, light.i);
    node->white = target_factor_white(light.d, light.i);
    if (!before) {
        node->none = node->original = node->half = splat(1);
        return;
    }
    node->none = before->none * by.i;
    node->original = before->original * (by.i + by.d * before->albedo);
    node->half = before->half * (by.i + by.d * splat(0.5f));
}

/* The light of a hit that is an interreflection, in the monomials that have a factor of a hit before it. */
static inline Interreflection find_interreflection(const TargetNode *hit, const Node *node)
{
    const HitLight *light = &node->dependent;
    return (Interreflection){.target = hit->at.target,
                             .uv = {hit->at.uv.u, hit->at.uv.v},
                             .weight = luminance4((node->half - node->none) * (light->c[0] + light->half)),
                             .light = (node->original - node->none) * (light->c[0] + light->original),
                             .albedo = color4(hit->at.albedo)};
}

static int add_interreflection(FootprintPixel *p, const Interreflection *further)
{
    if (!(further->weight > 0))
        return 0;
    clusters_add_interreflection(&p->targets[further->target], further, p->film->params.periodic[further->target]);
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
    light->c[0] *= by;
    if (!light->used)
        return;
    for (int t = 0; t < corrected_targets(film->scene); t++)
        for (int n = 0; n <= CORRECTION_POWERS; n++)
            light->edited[t][n] *= by;
    light->original *= by, light->half *= by;
    for (unsigned left = light->used; left; left &= left - 1)
        light->c[__builtin_ctz(left)] *= by;
}

/* Add a hit's light to the hit before it, once it has the light of all further hits itself. */
static void gather_node(FootprintPixel *p, const TargetNode *hit, Node *node, FinishFactor by, Node *before)
{
    add_textured(p->film, &node->independent, &node->dependent, &hit->at, node->albedo);
    add_times(p->film, &before->dependent, &node->independent, by.d);
    if (!is_black4(by.i))
        add_times(p->film, &before->independent, &node->independent, by.i);
    before->white += node->white * target_factor_white(by.d, by.i);
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
        const Interreflection further = find_interreflection(hit, node);
        was_met = add_interreflection(p, &further);
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
    start_light(&light, hit->dependent);
    *indep += hit->independent;
    *white += target_factor_white(hit->dependent, hit->independent);
    if (add_first(p, &path->seen, hit, &light))
        add_range(p, hit);
}

/* Gather the light of all hits in a combination of finishes, 0 where there are none. light: D and I by hit; NULL: those
 * of the hits. */
static void gather_path(FootprintPixel *p, const TargetTree *path, const TargetNode *const *hits, int combination,
                        const FinishFactor *light)
{
    const Scene *scene = p->film->scene;
    for (int k = 0; k < path->count; k++) {
        const TargetNode *before = hits[k]->before;
        RETEX_ASSERT(hits[k]->number == k && (!before || before->number < k)); /* those nearer to the camera are made */
        p->nodes[k].albedo = weighing_albedo(hits[k]->at.albedo);
        start_node(&p->nodes[k], light ? light[k] : (FinishFactor){hits[k]->dependent, hits[k]->independent},
                   target_node_before(hits[k], scene, combination), before ? &p->nodes[before->number] : NULL);
    }
    for (int k = path->count - 1; k >= 0; k--)
        if (hits[k]->before)
            gather_node(p, hits[k], &p->nodes[k], target_node_before(hits[k], scene, combination),
                        &p->nodes[hits[k]->before->number]);
}

static void end_several(FootprintPixel *p, const TargetTree *path, const TargetNode *const *hits, Float4 *indep,
                        Float4 *white)
{
    gather_path(p, path, hits, 0, NULL);
    for (int k = 0; k < path->count; k++) {
        if (!hits[k]->before)
            *indep += p->nodes[k].independent.c[0], *white += p->nodes[k].white;
        finish_node(p, &path->seen, hits[k], &p->nodes[k]);
    }
}

/* Light of the hits of a path in a combination; that which met no target with several finishes is in each of them. */
static void find_combined_light(const Scene *scene, const TargetTree *path, int combination, FinishFactor *light)
{
    memset(light, 0, (size_t)path->count * sizeof *light);
    for (const LampLight *l = path->lamp_light; l; l = l->earlier) {
        const int own = scene->kept[l->kept].combination;
        if (!l->hit || (own >= 0 && own != combination))
            continue;
        const Float4 share = splat(own < 0 ? 1 / (float)scene->ncombinations : 1);
        light[l->hit->number].d += l->dependent * share;
        light[l->hit->number].i += l->independent * share;
    }
}

static void add_light(const FootprintFilm *film, HitLight *sum, const HitLight *light)
{
    const unsigned used = sum->used | light->used;
    for (unsigned left = used & ~sum->used; left; left &= left - 1)
        sum->c[__builtin_ctz(left)] = splat(0);
    sum->used = used;
    add_times(film, sum, light, splat(1));
}

/* As end_several, where finishes of hits differ: a path's light is gathered in each combination, and its hits get their
 * sum. */
static __attribute__((noinline)) void end_combined(FootprintPixel *p, const TargetTree *path,
                                                   const TargetNode *const *hits, Float4 *indep, Float4 *white)
{
    const Scene *scene = p->film->scene;
    CombinedHit *sums = p->combined;
    FinishFactor light[TARGET_NODES_MAX];
    for (int c = 0; c < scene->ncombinations; c++) {
        find_combined_light(scene, path, c, light);
        gather_path(p, path, hits, c, light);
        lamps_end_path(p->lamps, path, hits, p->nodes, c);
        for (int k = 0; k < path->count; k++) {
            Node *node = &p->nodes[k];
            if (c == 0)
                start_light(&sums[k].first, splat(0));
            if (!hits[k]->before) {
                *indep += node->independent.c[0], *white += node->white;
            } else {
                const Interreflection further = find_interreflection(hits[k], node);
                if (c == 0)
                    sums[k].further = further;
                else
                    sums[k].further.weight += further.weight, sums[k].further.light += further.light;
                scale_light(p->film, &node->dependent, node->none);
            }
            add_light(p->film, &sums[k].first, &node->dependent);
        }
    }
    for (int k = 0; k < path->count; k++) {
        int was_met = hits[k]->before && add_interreflection(p, &sums[k].further);
        was_met |= add_first(p, &path->seen, hits[k], &sums[k].first);
        if (was_met)
            add_range(p, hits[k]);
    }
}

static void end_path(void *pixel, const TargetTree *path)
{
    FootprintPixel *p = pixel;
    const TargetNode *hits[TARGET_NODES_MAX];
    Float4 indep = path->without_hit, white = path->without_hit;
    if (p->film->quadrants)
        quadrants_start_path(&p->quadrants, &path->seen, p->film->params.periodic);
    RETEX_ASSERT(path->count <= TARGET_NODES_MAX && !path->last == !path->count);
    for (const TargetNode *hit = path->last; hit; hit = hit->earlier)
        hits[hit->number] = hit;
    if (path->count == 1)
        end_single(p, path, &indep, &white);
    else if (path->count && path->met)
        end_combined(p, path, hits, &indep, &white);
    else if (path->count)
        end_several(p, path, hits, &indep, &white);
    if (p->lamps && !(path->count > 1 && path->met))
        lamps_end_path(p->lamps, path, hits, p->nodes, -1);
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
