/* See lamps.h. Each path is looked at once more for each lamp that it found light of, which few are: light is gathered
 * from hit to hit as in footprints.c, without what clusters and corrections need. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/target_name.h>
#include "film/footprints/lamps.h"

/* Light as a polynomial in the textures of further hits; coefficients that are not used are not set. */
typedef struct PlanLight {
    unsigned used; /* bits */
    Coefficients c;
} PlanLight;

typedef struct LampSums {
    Float4 picture, indep;
    PlanLight *kinds; /* [2 target + kind] */
} LampSums;

struct LampPixel {
    const FootprintFilm *film;
    LampSums *lamps;
    PlanLight dependent[TARGET_NODES_MAX], independent[TARGET_NODES_MAX]; /* of the path's hits */
};

/* ---- life ---- */

int lamps_images_needed(const FootprintFilm *film)
{
    return film->scene->nkept ? 2 + 2 * film->scene->ntargets * film->lamp_plan.count : 0;
}

static int add_images(FootprintFilm *film, int l, RetexError *err)
{
    const Scene *scene = film->scene;
    LampImages *images = &film->lamps[l];
    char name[RETEX_NAME_MAX], word[RETEX_NAME_MAX];
    retex_lamp_word(word, scene->kept[l].name, NULL);
    int code = bands_add(film->bands, word, "RGB", RETEX_HALF, &images->picture, err);
    snprintf(name, sizeof name, "%.90s_indep", word);
    if (!code)
        code = bands_add(film->bands, name, "RGB", RETEX_HALF, &images->indep, err);
    const int count = film->lamp_plan.count;
    for (int n = 0; n < 2 * scene->ntargets * count && !code; n++) {
        const int i = n % count, kind = n / count % 2, t = n / count / 2;
        retex_lamp_word(word, scene->kept[l].name, scene->targets[t].name);
        plan_light_name(name, &film->lamp_plan, word, kind, i);
        code = bands_add(film->bands, name, "RGB", RETEX_HALF, &images->kinds[t][kind][i], err);
    }
    return code;
}

int lamps_create(FootprintFilm *film, RetexError *err)
{
    const Scene *scene = film->scene;
    int code = RETEX_OK;
    if (!scene->nkept)
        return RETEX_OK;
    film->lamps = calloc((size_t)scene->nkept, sizeof *film->lamps);
    for (int l = 0; l < scene->nkept && film->lamps && !code; l++) {
        LampImages *images = &film->lamps[l];
        images->kinds = calloc((size_t)scene->ntargets + 1, sizeof *images->kinds);
        code = images->kinds ? add_images(film, l, err) : RETEX_ENOMEM;
    }
    return film->lamps && code != RETEX_ENOMEM ? code : retex_fail(err, RETEX_ENOMEM, "out of memory for the lamps");
}

void lamps_close(FootprintFilm *film)
{
    for (int l = 0; film->lamps && l < film->scene->nkept; l++)
        free(film->lamps[l].kinds);
    free(film->lamps);
}

int lamps_pixel_create(LampPixel **out, const FootprintFilm *film, RetexError *err)
{
    const Scene *scene = film->scene;
    const size_t kinds = 2 * (size_t)scene->ntargets + 1;
    *out = NULL;
    if (!scene->nkept)
        return RETEX_OK;
    LampPixel *p = *out = aligned_alloc(64, (sizeof *p + 63) / 64 * 64);
    if (!p)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the lamps of a thread");
    p->film = film;
    p->lamps = calloc((size_t)scene->nkept, sizeof *p->lamps);
    for (int l = 0; p->lamps && l < scene->nkept; l++)
        if (!(p->lamps[l].kinds = calloc(kinds, sizeof *p->lamps[l].kinds)))
            break;
    if (p->lamps && p->lamps[scene->nkept - 1].kinds)
        return RETEX_OK;
    lamps_pixel_close(out);
    return retex_fail(err, RETEX_ENOMEM, "out of memory for the lamps of a thread");
}

void lamps_pixel_close(LampPixel **pixel)
{
    LampPixel *p = *pixel;
    for (int l = 0; p && p->lamps && l < p->film->scene->nkept; l++)
        free(p->lamps[l].kinds);
    if (p)
        free(p->lamps);
    free(p);
    *pixel = NULL;
}

/* ---- paths ---- */

static inline void add_coefficient(PlanLight *sum, int k, Float4 value)
{
    sum->c[k] = sum->used >> k & 1 ? sum->c[k] + value : value;
    sum->used |= 1u << k;
}

/* Add light times the factor of a hit, without its texture. */
static inline void add_times(PlanLight *sum, const PlanLight *light, Float4 by)
{
    for (unsigned left = light->used; left; left &= left - 1) {
        const int k = __builtin_ctz(left);
        add_coefficient(sum, k, light->c[k] * by);
    }
}

/* Add light times the texture of one more hit; times its original albedo, where the plan has no light of so many. */
static inline void add_textured(PlanLight *sum, const PlanLight *light, const Plan *plan, const TargetVertex *hit)
{
    for (unsigned left = light->used; left; left &= left - 1) {
        const int k = __builtin_ctz(left), next = plan->coefficients[k].next[hit->target];
        if (next >= 0)
            add_coefficient(sum, next, light->c[k]);
        else
            add_coefficient(sum, k, light->c[k] * color4(hit->albedo));
    }
}

/* The light of a lamp at the path's hits, without further hits. Returns 0 where it has only light without a hit. */
static int start_nodes(LampPixel *p, const TargetTree *path, int kept)
{
    int found = 0;
    for (int k = 0; k < path->count; k++)
        p->dependent[k].used = p->independent[k].used = 0;
    for (const LampLight *light = path->lamp_light; light; light = light->earlier) {
        if (light->kept != kept)
            continue;
        p->lamps[kept].picture += light->light;
        if (!light->hit) {
            p->lamps[kept].indep += light->independent;
            continue;
        }
        add_coefficient(&p->dependent[light->hit->number], 0, light->dependent);
        add_coefficient(&p->independent[light->hit->number], 0, light->independent);
        found = 1;
    }
    return found;
}

/* From the last hit to the first, as gather_node and finish_node of footprints.c. */
static void gather_nodes(LampPixel *p, const TargetTree *path, const TargetNode *const *hits, const Node *nodes,
                         int combination, LampSums *sums)
{
    const Scene *scene = p->film->scene;
    for (int k = path->count - 1; k >= 0; k--) {
        const TargetNode *hit = hits[k];
        PlanLight *dependent = &p->dependent[k], *independent = &p->independent[k];
        PlanLight *kind = &sums->kinds[2 * hit->at.target + !hit->at.sharp];
        if (!(dependent->used | independent->used))
            continue;
        if (!hit->before) {
            if (independent->used & 1)
                sums->indep += independent->c[0];
            add_times(kind, dependent, splat(1));
            continue;
        }
        const int before = hit->before->number;
        add_textured(independent, dependent, &p->film->lamp_plan, &hit->at);
        const FinishFactor by = target_node_before(hit, scene, combination);
        add_times(&p->dependent[before], independent, by.d);
        if (!is_black4(by.i))
            add_times(&p->independent[before], independent, by.i);
        add_times(kind, dependent, nodes[k].none);
    }
}

void lamps_end_path(LampPixel *p, const TargetTree *path, const TargetNode *const *hits, const Node *nodes,
                    int combination)
{
    const Scene *scene = p->film->scene;
    unsigned present = 0;
    for (const LampLight *light = path->lamp_light; light; light = light->earlier) {
        const int own = scene->kept[light->kept].combination;
        if (combination < 0 || own == combination || (own < 0 && combination == 0))
            present |= 1u << light->kept;
    }
    for (; present; present &= present - 1) {
        const int kept = __builtin_ctz(present);
        if (start_nodes(p, path, kept))
            gather_nodes(p, path, hits, nodes, combination < 0 ? 0 : combination, &p->lamps[kept]);
    }
}

/* ---- the pixel ---- */

/* From light of the colour that a lamp has in paths to light of the value 1. */
static Float4 to_white(const Scene *scene, int l)
{
    const Rgb kept = kept_color(scene, l);
    return color4(rgb(1 / kept.r, 1 / kept.g, 1 / kept.b));
}

void lamps_totals(const LampPixel *p, SignalTotals *totals, int first)
{
    const Scene *scene = p->film->scene;
    for (int l = 0; l < scene->nkept; l++) {
        const Float4 white = to_white(scene, l);
        for (int c = 0; c < 3; c++)
            totals->of[first][c] = (double)(p->lamps[l].indep[c] * white[c]);
        first++;
        for (int kind = 0; kind < 2 * scene->ntargets; kind++, first++) {
            const PlanLight *light = &p->lamps[l].kinds[kind];
            double *total = totals->of[first];
            total[0] = total[1] = total[2] = 0;
            for (unsigned left = light->used; left; left &= left - 1) {
                const int i = __builtin_ctz(left);
                for (int c = 0; c < 3; c++)
                    total[c] += p->film->lamp_plan.coefficients[i].weight * (double)(light->c[i][c] * white[c]);
            }
        }
    }
}

static void store(BandRows *rows, int image, Float4 light, int x, int y)
{
    if (light[0] == 0 && light[1] == 0 && light[2] == 0)
        return; /* memory that is never touched is never taken */
    float *to = bands_pixel(rows, image, x, y);
    for (int c = 0; c < 3; c++)
        to[c] = light[c];
}

void lamps_store(LampPixel *p, BandRows *rows, int spp, int x, int y)
{
    const Scene *scene = p->film->scene;
    for (int l = 0; l < scene->nkept; l++) {
        const LampImages *images = &p->film->lamps[l];
        const Float4 scale = to_white(scene, l) * splat(1 / (float)spp);
        store(rows, images->indep, p->lamps[l].indep * scale, x, y);
        store(rows, images->picture, p->lamps[l].picture * scale, x, y);
        p->lamps[l].picture = p->lamps[l].indep = splat(0);
        for (int kind = 0; kind < 2 * scene->ntargets; kind++) {
            PlanLight *light = &p->lamps[l].kinds[kind];
            for (unsigned left = light->used; left; left &= left - 1) {
                const int i = __builtin_ctz(left);
                store(rows, images->kinds[kind / 2][kind % 2][i], light->c[i] * scale, x, y);
            }
            light->used = 0;
        }
    }
}
