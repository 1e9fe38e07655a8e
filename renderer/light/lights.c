/* The list of all lights and the choice among them. */
#include <limits.h>
#include <stdlib.h>
#include <retex/host/assert.h>
#include "light/lights.h"
#include "light/sky_table.h"
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

/* What one light is chosen among: all entries, or those of one lamp. */
typedef struct Choice {
    const LightEntries *list;
    int lamp;  /* -1: of all */
    int count; /* of its entries */
    int first; /* of these */
    /* many lights; tree is NULL for few */
    LightTree *tree;
    Leaf *leaves;
    int *leaf_of;         /* of each entry: its first leaf, one for each of nfaces; -1: it has none */
    int ninfinite;        /* lights that are infinitely far: sky and beams */
    int *infinite;        /* their entries */
    int *infinite_of;     /* of each entry: its number among them */
    float *infinite_sums; /* running sums of their irradiance, ninfinite + 1 */
} Choice;

struct Lights {
    LightEntries list;
    int sky;              /* index of its entry, or -1 */
    int *of_primitive;    /* entry of each primitive, or -1 */
    int nemitters;        /* the first entries are the emitting shapes */
    double *emitter_sums; /* running sums of their power, nemitters + 1 */
    Choice all;
    /* of scenes with lamps: with this probability a lamp is chosen first, each alike, and then one of its lights */
    float lamp_share;
    int nchoices;
    Choice lamps[LAMPS_MAX + 1];  /* those that have lights */
    int choice_of[LAMPS_MAX + 1]; /* of each lamp of the scene, or -1 */
};

static const LightEntryOps *const ROWS[] = {
#define X(name) &entry_##name,
    LIGHT_ENTRY_TABLE(X)
#undef X
};

/* ---- many lights ---- */

static int has_entry(const Choice *choice, int k)
{
    return choice->lamp < 0 || choice->list->entries[k].lamp == choice->lamp;
}

/* The number of leaves of an entry in the tree. */
static int leaf_count(const LightEntry *e)
{
    return e->is_infinite ? 0 : e->nfaces > 0 ? e->nfaces : 1;
}

/* List the infinite lights, with running sums of their estimated irradiance. */
static void sum_infinite(Choice *choice)
{
    float sum = 0;
    for (int k = 0; k < choice->list->count; k++) {
        const LightEntry *e = &choice->list->entries[k];
        if (!e->is_infinite || !has_entry(choice, k))
            continue;
        choice->infinite_of[k] = choice->ninfinite;
        choice->infinite[choice->ninfinite++] = k;
        choice->infinite_sums[choice->ninfinite] = sum += fmaxf(e->strength * e->weight, 1e-20f);
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

static LightBounds weighted_bounds(const LightEntry *e, int face)
{
    LightBounds b = e->ops->bounds(e, face);
    b.intensity *= e->weight, b.peak *= e->weight, b.constant *= e->weight;
    return b;
}

static int list_leaves(Choice *choice, LightBounds *bounds)
{
    int n = 0;
    for (int k = 0; k < choice->list->count; k++) {
        const LightEntry *e = &choice->list->entries[k];
        const int of_entry = has_entry(choice, k) ? leaf_count(e) : 0;
        choice->leaf_of[k] = of_entry > 0 ? n : -1;
        for (int f = 0; f < of_entry; f++, n++) {
            choice->leaves[n] = (Leaf){k, e->nfaces > 0 ? f : -1};
            bounds[n] = weighted_bounds(e, choice->leaves[n].face);
        }
    }
    return n;
}

static void close_choice(Choice *choice)
{
    light_tree_close(&choice->tree);
    free(choice->leaves);
    free(choice->leaf_of);
    free(choice->infinite);
    free(choice->infinite_of);
    free(choice->infinite_sums);
}

/* A tree, where there are many finite lights. */
static int open_choice(Choice *choice, const LightEntries *list, int lamp, RetexError *err)
{
    const size_t entries = (size_t)list->count + 1;
    long leaves = 0;
    int finite = 0;
    *choice = (Choice){.list = list, .lamp = lamp, .first = -1};
    for (int k = 0; k < list->count; k++) {
        if (!has_entry(choice, k))
            continue;
        const int of_entry = leaf_count(&list->entries[k]);
        leaves += of_entry, finite += of_entry > 0;
        choice->first = choice->count++ ? choice->first : k;
    }
    if (finite == leaves && choice->count <= (has_light_groups(list->scene) ? EXACT_MOST : EXACT_MAX) &&
        list->count <= EXACT_MOST)
        return RETEX_OK;
    LightBounds *bounds = malloc((size_t)leaves * sizeof *bounds + 1);
    choice->leaves = malloc((size_t)leaves * sizeof *choice->leaves + 1);
    choice->leaf_of = malloc(entries * sizeof *choice->leaf_of);
    choice->infinite = malloc(entries * sizeof *choice->infinite);
    choice->infinite_of = malloc(entries * sizeof *choice->infinite_of);
    choice->infinite_sums = calloc(entries, sizeof *choice->infinite_sums);
    int code = RETEX_OK;
    if (!bounds || !choice->leaves || !choice->leaf_of || !choice->infinite || !choice->infinite_of ||
        !choice->infinite_sums || leaves > INT_MAX / 2)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory for %ld lights", leaves);
    const int n = code ? 0 : list_leaves(choice, bounds);
    if (!code)
        sum_infinite(choice);
    if (!code && n > 0)
        code = light_tree_create(&choice->tree, bounds, n, err);
    RETEX_ASSERT(code || n == leaves);
    free(bounds);
    return code;
}

/* One for each lamp that has lights; of a single one they are not needed. */
static int open_lamps(Lights *lights, RetexError *err)
{
    const Scene *scene = lights->list.scene;
    int code = RETEX_OK, lit = 0;
    for (int l = 0; l < scene->nlamps; l++) {
        lights->choice_of[l] = -1;
        for (int k = 0; k < lights->list.count; k++)
            if (lights->list.entries[k].lamp == l)
                lights->choice_of[l] = lit++, k = lights->list.count;
    }
    for (int l = 0; l < scene->nlamps && lit > 1 && !code; l++)
        if (lights->choice_of[l] >= 0)
            code = open_choice(&lights->lamps[lights->nchoices++], &lights->list, l, err);
    return code;
}

/* ---- the list ---- */

static int find_sky(const LightEntries *list)
{
    int sky = -1;
    for (int k = 0; k < list->count; k++)
        if (list->entries[k].ops == &entry_sky)
            sky = k;
    return sky;
}

/* Find the emitting shapes again by the primitives that a ray met, and sum their power. */
static int index_emitters(Lights *lights, RetexError *err)
{
    const LightEntries *list = &lights->list;
    const int nprimitives = list->scene->nprimitives;
    int *of_primitive = lights->of_primitive = malloc(((size_t)nprimitives + 1) * sizeof *of_primitive);
    double *sums = lights->emitter_sums = calloc((size_t)list->count + 1, sizeof *sums);
    if (!of_primitive || !sums)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for %d lights", list->count);
    for (int k = 0; k < nprimitives; k++)
        of_primitive[k] = -1;
    int k = 0;
    for (; k < list->count && list->entries[k].ops->point; k++) {
        const LightEntry *shape = &list->entries[k];
        RETEX_ASSERT(shape->index < nprimitives);    /* not a light source's, which are lights */
        RETEX_ASSERT(of_primitive[shape->index] < 0); /* a primitive is one entry */
        of_primitive[shape->index] = k;
        sums[k + 1] = sums[k] + shape->strength;
    }
    lights->nemitters = k;
    for (; k < list->count; k++)
        RETEX_ASSERT(!list->entries[k].ops->point); /* shapes stand first */
    return RETEX_OK;
}

int lights_create(Lights **out, const Scene *scene, double lamp_share, RetexError *err)
{
    Lights *lights = calloc(1, sizeof *lights);
    *out = lights;
    if (!lights)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the lights");
    lights->list.scene = scene;
    int code = RETEX_OK;
    for (size_t k = 0; k < sizeof ROWS / sizeof *ROWS && !code; k++)
        code = ROWS[k]->add ? ROWS[k]->add(&lights->list, err) : RETEX_OK;
    if (!code)
        code = index_emitters(lights, err);
    lights->sky = find_sky(&lights->list);
    for (int k = 0; k < lights->list.count; k++)
        lights->list.entries[k].weight = scene->nlamps ? scene->lamps[lights->list.entries[k].lamp].weight : 1;
    if (!code)
        code = open_choice(&lights->all, &lights->list, -1, err);
    if (!code && lamp_share > 0)
        code = open_lamps(lights, err);
    lights->lamp_share = lights->nchoices > 1 ? (float)lamp_share : 0;
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
    close_choice(&(*lights)->all);
    for (int l = 0; l < (*lights)->nchoices; l++)
        close_choice(&(*lights)->lamps[l]);
    free((*lights)->list.entries);
    free((*lights)->of_primitive);
    free((*lights)->emitter_sums);
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
    return e->weight * (e->ops->estimate ? e->ops->estimate(e, position) : e->strength);
}

/* Probabilities of the entries at a point; their sum is 1, or 0 where none shines on the point's light group. */
static void local_shares(const Choice *choice, const LightSampleContext *point, float *shares)
{
    const LightEntries *list = choice->list;
    float total = 0, sum = 0;
    RETEX_ASSERT(list->count <= EXACT_MOST); /* as many as `shares` has */
    for (int k = 0; k < list->count; k++) {
        const LightEntry *e = &list->entries[k];
        shares[k] = -1;
        if (has_entry(choice, k) && (!e->ops->reaches || e->ops->reaches(e, point->light_group)))
            total += shares[k] = entry_estimate(e, point->position);
    }
    const float least = total > 0 ? total * CHOICE_FLOOR / (float)choice->count : 1;
    for (int k = 0; k < list->count; k++)
        sum += shares[k] = shares[k] >= 0 ? shares[k] + least : 0;
    for (int k = 0; k < list->count && sum > 0; k++)
        shares[k] /= sum;
}

/* Probability of the tree as a whole; the rest is that of the infinite lights. */
static float tree_share(const Choice *choice, const LightSampleContext *point)
{
    if (choice->ninfinite == 0)
        return 1;
    if (!choice->tree)
        return 0;
    float tree = light_tree_estimate(choice->tree, point), infinite = choice->infinite_sums[choice->ninfinite];
    return fminf(1 - INFINITE_MIN, fmaxf(INFINITE_MIN, tree / (tree + infinite)));
}

static float infinite_share(const Choice *choice, int k)
{
    return (choice->infinite_sums[k + 1] - choice->infinite_sums[k]) / choice->infinite_sums[choice->ninfinite];
}

/* Whether lights are chosen by an estimate of each. */
static int is_exact(const Choice *choice)
{
    return !choice->tree && choice->ninfinite == 0;
}

static float exact_probability(const Choice *choice, const LightSampleContext *point, int entry)
{
    if (choice->count == 1)
        return choice->first == entry;
    float shares[EXACT_MOST];
    local_shares(choice, point, shares);
    return shares[entry];
}

/* Probability of an entry, or of a face of its mesh where faces are lights of their own. */
static float probability_within(const Choice *choice, const LightSampleContext *point, int entry, int face)
{
    if (is_exact(choice))
        return exact_probability(choice, point, entry);
    const LightEntry *e = &choice->list->entries[entry];
    const float share = tree_share(choice, point);
    const int leaf = choice->leaf_of[entry];
    RETEX_ASSERT(has_entry(choice, entry) && (leaf >= 0) == !e->is_infinite);
    if (leaf < 0)
        return (1 - share) * infinite_share(choice, choice->infinite_of[entry]);
    RETEX_ASSERT(e->nfaces == 0 || (face >= 0 && face < e->nfaces)); /* of the light's faces, not of the mesh's */
    return share * light_tree_probability(choice->tree, point, leaf + (e->nfaces > 0 ? face : 0));
}

static float pick_probability(const Lights *lights, const LightSampleContext *point, int entry, int face)
{
    const float of_all = probability_within(&lights->all, point, entry, face);
    if (lights->lamp_share == 0)
        return of_all;
    RETEX_ASSERT(lights->choice_of[lights->list.entries[entry].lamp] >= 0); /* it has this entry at least */
    const Choice *lamp = &lights->lamps[lights->choice_of[lights->list.entries[entry].lamp]];
    return (1 - lights->lamp_share) * of_all +
           lights->lamp_share / (float)lights->nchoices * probability_within(lamp, point, entry, face);
}

static LightPick exact_pick(const Choice *choice, const LightSampleContext *point, float u)
{
    if (choice->count == 1)
        return (LightPick){choice->first, -1, 1};
    float shares[EXACT_MOST], sum = 0;
    local_shares(choice, point, shares);
    int k = 0;
    while (k < choice->list->count - 1 && u >= sum + shares[k])
        sum += shares[k++];
    while (k > 0 && shares[k] == 0)
        k--; /* u is just below 1: the last one that shines on the point */
    if (shares[k] == 0)
        return (LightPick){-1, -1, 1};
    return (LightPick){k, -1, shares[k]};
}

static LightPick pick_infinite(const Choice *choice, float share, double u)
{
    const float *sums = choice->infinite_sums;
    int low = 0, high = choice->ninfinite;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (sums[middle] <= u * sums[choice->ninfinite])
            low = middle;
        else
            high = middle;
    }
    return (LightPick){choice->infinite[low], -1, share * infinite_share(choice, low)};
}

static LightPick pick_within(const Choice *choice, const LightSampleContext *point, float u_pick, float u_more)
{
    if (choice->count == 0)
        return (LightPick){-1, -1, 1};
    if (is_exact(choice))
        return exact_pick(choice, point, u_pick);
    /* both numbers together: a path down a large tree takes more bits than a float has */
    double u = u_pick + u_more * 0x1p-24;
    float share = tree_share(choice, point), probability;
    if (u >= share)
        return pick_infinite(choice, 1 - share, (u - share) / (1 - share));
    u /= share;
    const Leaf *leaf = &choice->leaves[light_tree_pick(choice->tree, point, &u, &probability)];
    return (LightPick){leaf->entry, leaf->face, share * probability};
}

/* A lamp is chosen by the first part of the random number, which is uniform again in each. */
static LightPick pick_by_lamp(const Lights *lights, const LightSampleContext *point, float u, float u_more)
{
    const float most = 1 - 0x1p-24f, share = lights->lamp_share;
    LightPick pick;
    if (u < share) {
        const float place = u / share * (float)lights->nchoices;
        const int l = place < (float)(lights->nchoices - 1) ? (int)place : lights->nchoices - 1;
        pick = pick_within(&lights->lamps[l], point, fminf(place - (float)l, most), u_more);
    } else {
        pick = pick_within(&lights->all, point, fminf((u - share) / (1 - share), most), u_more);
    }
    if (pick.entry >= 0)
        pick.probability = pick_probability(lights, point, pick.entry, pick.face);
    return pick;
}

LightPick lights_pick(const Lights *lights, const LightSampleContext *point, float u_pick, float u_more)
{
    return lights->lamp_share > 0 ? pick_by_lamp(lights, point, u_pick, u_more)
                                  : pick_within(&lights->all, point, u_pick, u_more);
}

int lights_lamp(const Lights *lights, const LightPick *pick)
{
    return lights->list.entries[pick->entry].lamp;
}

int lights_uniform_point(const Lights *lights, const LightPick *pick, float u1, float u2, MeshLightPoint *point)
{
    const LightEntry *e = pick->entry >= 0 ? &lights->list.entries[pick->entry] : NULL;
    return e && e->ops->uniform_point && e->ops->uniform_point(e, pick, u1, u2, point);
}

int lights_sample(const Lights *lights, const LightSampleContext *point, const LightPick *pick, float u1, float u2,
                  LightSample *sample)
{
    if (pick->entry < 0)
        return 0;
    const LightEntry *e = &lights->list.entries[pick->entry];
    RETEX_ASSERT(pick->face < (e->nfaces > 0 ? e->nfaces : 1)); /* of the light's faces */
    sample->pick_probability = pick->probability;
    sample->lamp = e->lamp, sample->is_sky = 0;
    return e->ops->sample(e, pick, point->position, u1, u2, sample);
}

void lights_prefetch(const Lights *lights, const float *u1, const float *u2, int count)
{
    if (lights->sky >= 0 && is_exact(&lights->all))
        sky_table_prefetch(lights->list.entries[lights->sky].data, u1, u2, count);
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

int lights_emission(const Lights *lights, float u_pick, float u1, float u2, EmissionPoint *point)
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
    LightPick whole = {low, -1, 1};
    Surface surface;
    const LightEntry *e = &lights->list.entries[low];
    RETEX_ASSERT(e->ops->point); /* sums are of shapes, which stand first */
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
    const Choice *all = &lights->all;
    float sum = 0;
    if (is_exact(all)) {
        for (int k = 0; k < lights->list.count; k++)
            sum += entry_estimate(&lights->list.entries[k], point->position);
        return sum;
    }
    if (all->tree)
        sum = light_tree_estimate(all->tree, point);
    return all->ninfinite > 0 ? sum + all->infinite_sums[all->ninfinite] : sum;
}
