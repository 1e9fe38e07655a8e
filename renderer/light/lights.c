/* The list of all lights and the choice among them. */
#include <limits.h>
#include <stdlib.h>
#include "light/lights.h"
#include "shade/bsdf.h"
#include "shade/texture.h"

#define EXACT_MAX 4        /* up to so many lights are chosen by an estimate of each; more by the tree */
#define EXACT_MOST 32      /* the same where there are light groups, of which the tree knows nothing */
#define CHOICE_FLOOR 0.02f /* least probability of every light, over that of a uniform choice: estimates may be wrong */
#define INFINITE_MIN 0.05f /* the same for all of the tree, and for all infinite lights */

/* What a leaf of the tree is. */
typedef struct Leaf {
    int entry, face; /* face: of the entry's nfaces, or -1: the whole entry */
} Leaf;

struct Lights {
    LightEntries list;
    int sky;              /* index of its entry, or -1 */
    int *of_primitive;    /* entry of each primitive, or -1 */
    int nemitters;        /* the first entries are the emitting shapes */
    double *emitter_sums; /* running sums of their power, nemitters + 1 */
    /* many lights; tree is NULL for few */
    LightTree *tree;
    Leaf *leaves;
    int ninfinite;        /* lights that are infinitely far: sky and beams */
    int *infinite;        /* their entries */
    float *infinite_sums; /* running sums of their irradiance, ninfinite + 1 */
};

static const LightEntryOps *const ROWS[] = {
#define X(name) &entry_##name,
    LIGHT_ENTRY_TABLE(X)
#undef X
};

/* ---- many lights ---- */

/* The number of leaves of an entry in the tree. */
static int leaf_count(const LightEntry *e)
{
    return e->is_infinite ? 0 : e->nfaces > 0 ? e->nfaces : 1;
}

/* List the infinite lights, with running sums of their estimated irradiance. */
static void sum_infinite(Lights *lights)
{
    float sum = 0;
    for (int k = 0; k < lights->list.count; k++) {
        if (!lights->list.entries[k].is_infinite)
            continue;
        lights->list.entries[k].infinite = lights->ninfinite;
        lights->infinite[lights->ninfinite++] = k;
        lights->infinite_sums[lights->ninfinite] = sum += fmaxf(lights->list.entries[k].strength, 1e-20f);
    }
}

static int has_light_groups(const Scene *scene)
{
    for (int k = 0; k < scene->nprimitives; k++)
        if (scene->primitives[k].light_group)
            return 1;
    for (int k = 0; k < scene->nlights; k++)
        if (scene->lights[k].light_group)
            return 1;
    return 0;
}

/* A tree, where there are many finite lights. */
static int grow_tree(Lights *lights, RetexError *err)
{
    long leaves = 0;
    int finite = 0, n = 0;
    for (int k = 0; k < lights->list.count; k++) {
        int of_entry = leaf_count(&lights->list.entries[k]);
        lights->list.entries[k].leaf = -1;
        leaves += of_entry, finite += of_entry > 0;
    }
    if (finite == leaves && lights->list.count <= (has_light_groups(lights->list.scene) ? EXACT_MOST : EXACT_MAX))
        return RETEX_OK;
    LightBounds *bounds = malloc((size_t)leaves * sizeof *bounds + 1);
    lights->leaves = malloc((size_t)leaves * sizeof *lights->leaves + 1);
    lights->infinite = malloc(((size_t)lights->list.count + 1) * sizeof *lights->infinite);
    lights->infinite_sums = calloc((size_t)lights->list.count + 1, sizeof *lights->infinite_sums);
    int code = RETEX_OK;
    if (!bounds || !lights->leaves || !lights->infinite || !lights->infinite_sums || leaves > INT_MAX / 2)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory for %ld lights", leaves);
    for (int k = 0; k < lights->list.count && !code; k++) {
        LightEntry *e = &lights->list.entries[k];
        int of_entry = leaf_count(e);
        if (of_entry > 0)
            e->leaf = n;
        for (int f = 0; f < of_entry; f++) {
            lights->leaves[n] = (Leaf){k, e->nfaces > 0 ? f : -1};
            bounds[n] = e->ops->bounds(e, lights->leaves[n].face), n++;
        }
    }
    if (!code)
        sum_infinite(lights);
    if (!code && n > 0)
        code = light_tree_create(&lights->tree, bounds, n, err);
    free(bounds);
    return code;
}

/* ---- the list ---- */

/* Find the emitting shapes and the sky again, by what a ray met. */
static int index_entries(Lights *lights, RetexError *err)
{
    const LightEntries *list = &lights->list;
    const size_t most = (size_t)list->scene->nprimitives + (size_t)list->count + 1;
    lights->of_primitive = malloc(most * sizeof *lights->of_primitive);
    lights->emitter_sums = calloc(most, sizeof *lights->emitter_sums);
    if (!lights->of_primitive || !lights->emitter_sums)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for %d lights", list->count);
    for (int k = 0; k < list->scene->nprimitives; k++)
        lights->of_primitive[k] = -1;
    for (int k = 0; k < list->count; k++)
        if (list->entries[k].ops == &entry_sky)
            lights->sky = k;
    for (int k = 0; k < list->count && list->entries[k].ops->point; k++) {
        lights->of_primitive[list->entries[k].index] = k;
        lights->emitter_sums[++lights->nemitters] = lights->emitter_sums[k] + list->entries[k].strength;
    }
    return RETEX_OK;
}

int lights_create(Lights **out, const Scene *scene, RetexError *err)
{
    Lights *lights = calloc(1, sizeof *lights);
    *out = lights;
    if (!lights)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the lights");
    lights->list.scene = scene;
    lights->sky = -1;
    int code = RETEX_OK;
    for (size_t k = 0; k < sizeof ROWS / sizeof *ROWS && !code; k++)
        code = ROWS[k]->add ? ROWS[k]->add(&lights->list, err) : RETEX_OK;
    if (!code)
        code = index_entries(lights, err);
    if (!code)
        code = grow_tree(lights, err);
    if (code)
        lights_close(out);
    return code;
}

void lights_close(Lights **lights)
{
    if (!*lights)
        return;
    for (int k = 0; k < (*lights)->list.count; k++) {
        LightEntry *e = &(*lights)->list.entries[k];
        if (e->ops->close)
            e->ops->close(e);
    }
    light_tree_close(&(*lights)->tree);
    free((*lights)->list.entries);
    free((*lights)->of_primitive);
    free((*lights)->emitter_sums);
    free((*lights)->leaves);
    free((*lights)->infinite);
    free((*lights)->infinite_sums);
    free(*lights);
    *lights = NULL;
}

int lights_count(const Lights *lights)
{
    return lights->list.count;
}

/* ---- the choice ---- */

static inline float entry_estimate(const LightEntry *e, Vec3 position)
{
    return e->ops->estimate ? e->ops->estimate(e, position) : e->strength;
}

/* Probabilities of the entries at a point; their sum is 1, or 0 where none shines on the point's light group. */
static void local_shares(const Lights *lights, const LightSampleContext *point, float *shares)
{
    const LightEntries *list = &lights->list;
    float total = 0, sum = 0;
    for (int k = 0; k < list->count; k++) {
        const LightEntry *e = &list->entries[k];
        shares[k] = -1;
        if (!e->ops->reaches || e->ops->reaches(e, point->light_group))
            total += shares[k] = entry_estimate(e, point->position);
    }
    const float least = total > 0 ? total * CHOICE_FLOOR / (float)list->count : 1;
    for (int k = 0; k < list->count; k++)
        sum += shares[k] = shares[k] >= 0 ? shares[k] + least : 0;
    for (int k = 0; k < list->count && sum > 0; k++)
        shares[k] /= sum;
}

/* Probability of the tree as a whole; the rest is that of the infinite lights. */
static float tree_share(const Lights *lights, const LightSampleContext *point)
{
    if (lights->ninfinite == 0)
        return 1;
    if (!lights->tree)
        return 0;
    float tree = light_tree_estimate(lights->tree, point), infinite = lights->infinite_sums[lights->ninfinite];
    return fminf(1 - INFINITE_MIN, fmaxf(INFINITE_MIN, tree / (tree + infinite)));
}

static float infinite_share(const Lights *lights, int k)
{
    return (lights->infinite_sums[k + 1] - lights->infinite_sums[k]) / lights->infinite_sums[lights->ninfinite];
}

/* Whether lights are chosen by an estimate of each. */
static int is_exact(const Lights *lights)
{
    return !lights->tree && lights->ninfinite == 0;
}

static float exact_probability(const Lights *lights, const LightSampleContext *point, int entry)
{
    if (lights->list.count == 1)
        return 1;
    float shares[EXACT_MOST];
    local_shares(lights, point, shares);
    return shares[entry];
}

/* Probability of an entry, or of a face of its mesh where faces are lights of their own. */
static float pick_probability(const Lights *lights, const LightSampleContext *point, int entry, int face)
{
    if (is_exact(lights))
        return exact_probability(lights, point, entry);
    const LightEntry *e = &lights->list.entries[entry];
    float share = tree_share(lights, point);
    if (e->leaf < 0)
        return (1 - share) * infinite_share(lights, e->infinite);
    return share * light_tree_probability(lights->tree, point, e->leaf + (e->nfaces > 0 ? face : 0));
}

static LightPick exact_pick(const Lights *lights, const LightSampleContext *point, float u, float u_part)
{
    if (lights->list.count == 1)
        return (LightPick){0, -1, 1, u_part};
    float shares[EXACT_MOST], sum = 0;
    local_shares(lights, point, shares);
    int k = 0;
    while (k < lights->list.count - 1 && u >= sum + shares[k])
        sum += shares[k++];
    while (k > 0 && shares[k] == 0)
        k--; /* u is just below 1: the last one that shines on the point */
    if (shares[k] == 0)
        return (LightPick){-1, -1, 1, u_part};
    return (LightPick){k, -1, shares[k], u_part};
}

static LightPick pick_infinite(const Lights *lights, float share, double u, float u_part)
{
    const float *sums = lights->infinite_sums;
    int low = 0, high = lights->ninfinite;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (sums[middle] <= u * sums[lights->ninfinite])
            low = middle;
        else
            high = middle;
    }
    return (LightPick){lights->infinite[low], -1, share * infinite_share(lights, low), u_part};
}

LightPick lights_pick(const Lights *lights, const LightSampleContext *point, float u_pick, float u_part)
{
    if (lights->list.count == 0)
        return (LightPick){-1, -1, 1, u_part};
    if (is_exact(lights))
        return exact_pick(lights, point, u_pick, u_part);
    /* both numbers together: a path down a large tree takes more bits than a float has */
    double u = u_pick + u_part * 0x1p-24;
    float share = tree_share(lights, point), probability;
    if (u >= share)
        return pick_infinite(lights, 1 - share, (u - share) / (1 - share), u_part);
    u /= share;
    const Leaf *leaf = &lights->leaves[light_tree_pick(lights->tree, point, &u, &probability)];
    return (LightPick){leaf->entry, leaf->face, share * probability, fminf((float)u, 1 - 0x1p-24f)};
}

int lights_lamp(const Lights *lights, const LightPick *pick)
{
    return lights->list.entries[pick->entry].lamp;
}

const struct MeshLightFace *lights_uniform_face(const Lights *lights, const LightPick *pick, double *density)
{
    const LightEntry *e = pick->entry >= 0 ? &lights->list.entries[pick->entry] : NULL;
    return e && e->ops->uniform_face ? e->ops->uniform_face(e, pick, density) : NULL;
}

int lights_sample(const Lights *lights, const LightSampleContext *point, const LightPick *pick, float u1, float u2,
                  LightSample *sample)
{
    if (pick->entry < 0)
        return 0;
    const LightEntry *e = &lights->list.entries[pick->entry];
    sample->pick_probability = pick->probability;
    sample->lamp = e->lamp;
    return e->ops->sample(e, pick, point->position, u1, u2, sample);
}

/* Of the k-th entry, or 0 where k is below 0. */
static float entry_pdf(const Lights *lights, const LightSampleContext *from, int k, Vec3 direction,
                       const Surface *surface)
{
    int face = -1;
    if (k < 0)
        return 0;
    const LightEntry *e = &lights->list.entries[k];
    const double pdf = e->ops->pdf(e, from->position, direction, surface, &face);
    return pdf > 0 ? (float)pdf * pick_probability(lights, from, k, face) : 0;
}

float lights_emitter_pdf(const Lights *lights, const LightSampleContext *from, int primitive, const Surface *surface)
{
    return entry_pdf(lights, from, lights->of_primitive[primitive], surface->direction, surface);
}

float lights_sky_pdf(const Lights *lights, const LightSampleContext *from, Vec3 direction)
{
    return entry_pdf(lights, from, lights->sky, direction, NULL);
}

/* ---- emission: where photons start ---- */

int lights_emit(const Lights *lights)
{
    return lights->nemitters > 0 && lights->emitter_sums[lights->nemitters] > 0;
}

#define SMALL 6.0 /* so many radii away */
#define MUCH 0.1  /* of all power */

int lights_small_emitter(const Lights *lights, Vec3 from)
{
    double power = 0;
    for (int k = 0; k < lights->nemitters; k++) {
        const LightEntry *e = &lights->list.entries[k];
        power += vec_length(vec_sub(e->center, from)) > SMALL * e->radius ? e->strength : 0;
    }
    return power > 0 && power >= MUCH * lights->emitter_sums[lights->nemitters];
}

int lights_emission(const Lights *lights, float u_pick, float u_part, float u1, float u2, EmissionPoint *point)
{
    if (!lights_emit(lights))
        return 0;
    double wanted = u_pick * lights->emitter_sums[lights->nemitters];
    int low = 0, high = lights->nemitters;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (lights->emitter_sums[middle] <= wanted)
            low = middle;
        else
            high = middle;
    }
    LightPick whole = {low, -1, 1, u_part};
    Surface surface;
    const LightEntry *e = &lights->list.entries[low];
    double density = e->ops->point(e, &whole, u1, u2, &surface);
    double part = e->strength / lights->emitter_sums[lights->nemitters];
    if (!(density > 0 && part > 0))
        return 0;
    float radiance = rgb_luminance(texture_emission(surface.texture)) * NEUTRAL_ALBEDO;
    *point = (EmissionPoint){surface.position, surface.geometric_normal, radiance / (float)(density * part)};
    return 1;
}

float lights_estimate(const Lights *lights, const LightSampleContext *point)
{
    float sum = 0;
    if (is_exact(lights)) {
        for (int k = 0; k < lights->list.count; k++)
            sum += entry_estimate(&lights->list.entries[k], point->position);
        return sum;
    }
    if (lights->tree)
        sum = light_tree_estimate(lights->tree, point);
    return lights->ninfinite > 0 ? sum + lights->infinite_sums[lights->ninfinite] : sum;
}
