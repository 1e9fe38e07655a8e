/* A synthetic set: see test_set in lib_test.h. */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "set/signals.h"

/* Add a part of the set's size; returns its index. */
static int add_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type)
{
    RetexError err = {0};
    int part;
    test_must(retex_set_add_part(set, name, letters, type, 0, 0, &part, &err), &err);
    return part;
}

/* Light that decreases over five decades, with noise. It is black in a disc. */
static void fill_radiance(RetexImage *im, double level, uint32_t *seed)
{
    for (int y = 0; y < im->height; y++)
        for (int x = 0; x < im->width; x++) {
            double dx = (x + 0.5) / im->width - 0.6, dy = (y + 0.5) / im->height - 0.4;
            double light = level * pow(10, -4 * hypot(dx, dy)) * (0.7 + 0.6 * test_random(seed));
            for (int c = 0; c < 3; c++)
                im->pixels[retex_image_index(im, x, y) + (size_t)c] =
                    hypot(dx, dy) < 0.1 ? 0 : (float)(light * (1 - 0.2 * c));
        }
}

static int add_radiance(RetexSet *set, const char *name, double level, uint32_t *seed)
{
    int part = add_part(set, name, "RGB", RETEX_HALF);
    fill_radiance(&set->parts[part].image, level, seed);
    return part;
}

/* The footprint of the hit-th hit on a target: a tilted gradient of UV with noise. */
static int add_footprint(RetexSet *set, int target, int hit, uint32_t *seed)
{
    char name[64];
    RetexFootprint footprint = {.target = target, .hit = hit};
    snprintf(name, sizeof name, "t%d_uv%d", target, hit);
    footprint.uv = add_part(set, name, "RGA", RETEX_FLOAT);
    snprintf(name, sizeof name, "t%d_spread%d", target, hit);
    footprint.spread = add_part(set, name, "RG", RETEX_HALF);
    snprintf(name, sizeof name, "t%d_albedo%d", target, hit);
    footprint.albedo = add_part(set, name, "RGB", RETEX_HALF);
    for (int y = 0; y < set->height; y++)
        for (int x = 0; x < set->width; x++) {
            size_t i = (size_t)y * (size_t)set->width + (size_t)x;
            float *uv = set->parts[footprint.uv].image.pixels + 3 * i;
            float *spread = set->parts[footprint.spread].image.pixels + 2 * i;
            float *albedo = set->parts[footprint.albedo].image.pixels + 3 * i;
            double jitter = test_random(seed);
            if (x < set->width / 8)
                continue;
            uv[0] = (float)(x * 1.7 / set->width + 0.002 * jitter);
            uv[1] = (float)(y * 0.9 / set->height - 0.1 * hit * jitter);
            uv[2] = 1.0f / (float)hit;
            spread[0] = ldexpf(1, -9 + hit);
            spread[1] = ldexpf(1, -8 + hit);
            for (int c = 0; c < 3; c++)
                albedo[c] = (float)(0.2 + 0.15 * (c + target) + 0.1 * jitter);
        }
    RetexError err = {0};
    int index;
    test_must(retex_set_add_footprint(set, &footprint, &index, &err), &err);
    return index;
}

RetexFactor test_factor(int number)
{
    return number < 0 ? retex_factor(RETEX_FACTOR_MIXTURE, MIXTURE(number))
                      : retex_factor(RETEX_FACTOR_FOOTPRINT, number);
}

int test_factor_number(RetexFactor factor)
{
    return factor.kind == RETEX_FACTOR_MIXTURE ? MIXTURE(factor.index) : factor.index;
}

RetexTerm test_term(const RetexSet *set, int radiance, int nhits, const int *numbers)
{
    static const RetexRole roles[] = {RETEX_ROLE_DEP, RETEX_ROLE_SHARP, RETEX_ROLE_BROAD, RETEX_ROLE_INTERREFLECTION};
    RetexTerm term = {.role = RETEX_ROLE_INDEP, .target = -1, .radiance = radiance, .nfactors = nhits};
    for (int k = nhits - 1; k >= 0; k--) {
        const int number = numbers[k];
        const RetexFootprint *f =
            &set->footprints[number < 0 ? set->mixtures[MIXTURE(number)].shares[0].footprint : number];
        term.factors[k] = test_factor(number);
        term.role = roles[f->kind], term.target = f->target;
    }
    return term;
}

void test_renew_roles(RetexSet *set)
{
    for (int t = 0; t < set->nterms; t++) {
        RetexTerm *term = &set->terms[t];
        int numbers[RETEX_MAX_HITS];
        for (int k = 0; k < term->nfactors; k++)
            numbers[k] = test_factor_number(term->factors[k]);
        if (term->nfactors)
            *term = test_term(set, term->radiance, term->nfactors, numbers);
    }
}

void test_add_lamp(RetexSet *set, const char *name)
{
    RetexParameter lamp = {.kind = RETEX_PARAMETER_COLOR, .target = -1, .value = {1, 0.5f, 2}};
    RetexError err = {0};
    int number, light = 0;
    snprintf(lamp.name, sizeof lamp.name, "%s", name);
    test_must(retex_set_add_parameter(set, &lamp, &number, &err), &err);
    for (int t = 0; t < set->nterms; t++)
        if (retex_term_is_light(&set->terms[t]) && light++ % 2)
            test_must(retex_term_add_factor(&set->terms[t], retex_factor(RETEX_FACTOR_PARAMETER, number), &err), &err);
}

/* The share of a lamp in a term's light at a pixel; the third one is what is left. */
static double share_of_lamp(const RetexSet *set, const RetexTerm *term, int lamp, int x, int y)
{
    double u = 2.0 * x / set->width, v = 1.0 * y / set->height;
    if (term->nfactors && term->factors[0].kind == RETEX_FACTOR_FOOTPRINT) {
        const RetexImage *uv = &set->parts[set->footprints[term->factors[0].index].uv].image;
        u = (double)uv->pixels[retex_image_index(uv, x, y)];
        v = (double)uv->pixels[retex_image_index(uv, x, y) + 1];
    }
    const double first = 0.5 + 0.45 * sin(3 * u), second = (1 - first) * (0.5 + 0.45 * cos(4 * v));
    return lamp == 0 ? first : lamp == 1 ? second : 1 - first - second;
}

void test_divide_light(RetexSet *set)
{
    const RetexParameter lamps[2] = {
        {.name = "Lamp", .target = -1, .value = {1, 0.5f, 2}, .kept = {1, 0.5f, 2}},
        {.name = "Window", .target = -1, .value = {1, 1, 1}, .kept = {1, 1, 1}},
    };
    RetexError err = {0};
    const int nterms = set->nterms;
    int numbers[2];
    for (int k = 0; k < 2; k++)
        test_must(retex_set_add_parameter(set, &lamps[k], &numbers[k], &err), &err);
    for (int t = 0; t < nterms; t++)
        for (int k = 0; k < 3 && retex_term_is_light(&set->terms[t]); k++) {
            RetexTerm term = set->terms[t];
            char name[64];
            snprintf(name, sizeof name, "lit%d_%d", t, k);
            const int part = k < 2 ? add_part(set, name, "RGB", RETEX_HALF) : term.radiance;
            const RetexImage *from = &set->parts[term.radiance].image, *to = &set->parts[part].image;
            for (int y = 0; y < set->height; y++)
                for (int x = 0; x < set->width; x++)
                    for (size_t c = 0, i = retex_image_index(from, x, y); c < 3; c++)
                        to->pixels[i + c] = (float)(share_of_lamp(set, &term, k, x, y) * (double)from->pixels[i + c] /
                                                    (k < 2 ? (double)lamps[k].value[c] : 1));
            term.radiance = part;
            if (k < 2) {
                test_must(retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_PARAMETER, numbers[k]), &err), &err);
                test_must(retex_set_add_term(set, &term, NULL, &err), &err);
            }
        }
}

void test_add_lamp_terms(RetexSet *set, int off, int several)
{
    enum { LAMPS = 3 };
    const RetexParameter lamps[LAMPS] = {
        {.name = "Lamp", .target = -1, .value = {1, 0.5f, 2}, .kept = {1, 0.5f, 2}, .several = several},
        {.name = "Window", .target = -1, .value = {(float)!off, (float)!off, (float)!off}, .kept = {1, 1, 1}},
        {.name = "rest", .target = -1, .value = {1, 1, 1}, .kept = {1, 1, 1}},
    };
    RetexError err = {0};
    const int nterms = set->nterms;
    for (int k = 0; k < LAMPS; k++) {
        int number;
        test_must(retex_set_add_parameter(set, &lamps[k], &number, &err), &err);
        for (int t = 0; t < nterms; t++) {
            RetexTerm term = set->terms[t];
            char name[64];
            if (!retex_term_is_light(&term))
                continue;
            snprintf(name, sizeof name, "lamp%d_%d", k, t);
            term.role = RETEX_ROLE_LAMP, term.radiance = add_part(set, name, "RGB", RETEX_HALF);
            const RetexImage *from = &set->parts[set->terms[t].radiance].image;
            const RetexImage *to = &set->parts[term.radiance].image;
            for (int y = 0; y < set->height; y++)
                for (int x = 0; x < set->width; x++)
                    for (size_t c = 0, i = retex_image_index(from, x, y); c < 3; c++)
                        to->pixels[i + c] = (float)(share_of_lamp(set, &term, k, x, y) * (double)from->pixels[i + c] /
                                                    (double)lamps[k].kept[c]);
            test_must(retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_PARAMETER, number), &err), &err);
            test_must(retex_set_add_term(set, &term, NULL, &err), &err);
        }
    }
}

static void add_term(RetexSet *set, RetexRole role, int radiance, const int *factors, int nfactors)
{
    RetexTerm term = test_term(set, radiance, nfactors, factors);
    RetexError err = {0};
    term.role = role;
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
}

static void add_target(RetexSet *set, const char *name, int periodic, uint32_t *seed)
{
    char part[64];
    RetexError err = {0};
    RetexTarget *target = &set->targets[set->ntargets++];
    memset(target, 0, sizeof *target);
    snprintf(target->name, sizeof target->name, "%s", name);
    snprintf(target->idents, sizeof target->idents, "%s", name);
    target->periodic[0] = periodic;
    target->uv_min[0] = 0.2, target->uv_max[0] = 1.7;
    target->uv_min[1] = -0.3, target->uv_max[1] = 0.9;
    target->original_max[0] = target->original_max[1] = 1;
    target->share = 0.4;
    for (int c = 0; c < 3; c++)
        target->mean_albedo[c] = 0.5f - 0.125f * (float)c;
    snprintf(part, sizeof part, "original_%s", name);
    test_must(retex_set_add_part(set, part, "RGB", RETEX_HALF, 16, 12, &target->original, &err), &err);
    RetexImage *im = &set->parts[target->original].image;
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height * 3; i++)
        im->pixels[i] = (float)test_random(seed);
}

/* Round values that are stored as halves, so that files keep every bit of the set. */
static void round_to_stored(RetexSet *set)
{
    for (int i = 0; i < set->nparts; i++) {
        RetexImage *im = &set->parts[i].image;
        size_t n = (size_t)im->width * (size_t)im->height * (size_t)im->channels;
        if (set->parts[i].type != RETEX_HALF)
            continue;
        uint16_t *halves = malloc(n * sizeof *halves);
        retex_half_from_float(halves, im->pixels, n);
        retex_half_to_float(im->pixels, halves, n);
        free(halves);
    }
}

RetexSet *test_set(int width, int height, uint32_t seed)
{
    enum { HITS = 3 };
    RetexSet *set = NULL;
    RetexError err = {0};
    test_must(retex_set_create(&set, width, height, &err), &err);
    snprintf(set->layout, sizeof set->layout, "paper");
    snprintf(set->filter, sizeof set->filter, "box");
    snprintf(set->scene, sizeof set->scene, "test.pov");
    snprintf(set->generator, sizeof set->generator, "lib_test");
    set->orders = HITS, set->spp = 16, set->max_depth = 8, set->seed = seed;

    int beauty = retex_set_find_part(set, "beauty");
    if (beauty < 0)
        beauty = add_part(set, "beauty", "RGB", RETEX_HALF);
    fill_radiance(&set->parts[beauty].image, 1, &seed);
    add_term(set, RETEX_ROLE_FULL, add_radiance(set, "full0", 0.3, &seed), NULL, 0);
    for (int t = 0; t < 2; t++) {
        int factors[HITS], reversed[HITS];
        char name[64];
        add_target(set, t == 0 ? "Floor" : "Wall", t, &seed);
        for (int h = 1; h <= HITS; h++)
            factors[h - 1] = add_footprint(set, t, h, &seed);
        for (int h = 1; h <= HITS; h++) {
            snprintf(name, sizeof name, "t%d_dep%d", t, h);
            add_term(set, RETEX_ROLE_DEP, add_radiance(set, name, pow(0.3, h), &seed), factors, h);
            snprintf(name, sizeof name, "t%d_indep%d", t, h);
            add_term(set, RETEX_ROLE_INDEP, add_radiance(set, name, 0.1 * pow(0.3, h), &seed), NULL, 0);
        }
        snprintf(name, sizeof name, "t%d_cross2", t);
        add_term(set, RETEX_ROLE_CROSS2, add_radiance(set, name, 0.02, &seed), &factors[1], 1);
        reversed[0] = factors[2], reversed[1] = factors[0];
        snprintf(name, sizeof name, "t%d_cross3", t);
        add_term(set, RETEX_ROLE_CROSS3, add_radiance(set, name, 0.01, &seed), reversed, 2);
    }
    int depth = add_part(set, "depth", "R", RETEX_FLOAT);
    for (int i = 0; i < width * height; i++)
        set->parts[depth].image.pixels[i] = i % 7 == 0 ? INFINITY : (float)(1 + test_random(&seed));
    round_to_stored(set);
    return set;
}

/* The weights of one share: 0 along one side. */
static struct RetexShare add_share(RetexSet *set, int footprint, const char *name, const char *letters, uint32_t *seed)
{
    struct RetexShare share = {footprint, add_part(set, name, letters, RETEX_HALF)};
    RetexImage *image = &set->parts[share.weight].image;
    int row = set->width * image->channels;
    for (int i = 0; i < row * set->height; i++)
        if (i % row >= row / 8)
            image->pixels[i] = (float)(4 * test_random(seed));
    return share;
}

/* A mixture of one footprint of each target, and one of three with a weight for each colour. Two terms use them: one
 * once, one as often as a term may. */
static void add_mixtures(RetexSet *set, uint32_t *seed)
{
    RetexMixture of_two = {.nshares = 2}, of_three = {.nshares = 3};
    RetexTerm *once = &set->terms[1], *often = &set->terms[set->nterms - 1];
    RetexError err = {0};
    of_two.shares[0] = add_share(set, 2, "share-0", "R", seed);
    of_two.shares[1] = add_share(set, 3, "share-1", "R", seed);
    of_three.shares[0] = add_share(set, 0, "share-2", "RGB", seed);
    of_three.shares[1] = add_share(set, 4, "share-3", "R", seed);
    of_three.shares[2] = add_share(set, 5, "share-4", "RGB", seed);
    test_must(retex_set_add_mixture(set, &of_two, NULL, &err), &err);
    test_must(retex_set_add_mixture(set, &of_three, NULL, &err), &err);
    once->factors[once->nfactors++] = test_factor(MIXTURE(0));
    while (often->nfactors < RETEX_MAX_HITS)
        often->factors[often->nfactors] = test_factor(MIXTURE(often->nfactors % 2)), often->nfactors++;
}

void test_make_footprints(RetexSet *set)
{
    uint32_t seed = 1;
    snprintf(set->layout, sizeof set->layout, "footprints");
    set->folded_white = 0.125, set->depth_cut = 0.0625;
    for (int t = 0; t < set->ntargets; t++)
        set->targets[t].uv_scale[0] = 0.1 + t, set->targets[t].uv_scale[1] = 1e6;
    for (int i = 0; i < set->nfootprints; i++) {
        RetexFootprint *f = &set->footprints[i];
        char name[32];
        f->kind = (RetexFootprintKind)(i % 4);
        if (f->kind == RETEX_FOOTPRINT_HIT)
            continue;
        const int deviations = f->spread;
        snprintf(name, sizeof name, "spread-%d", i);
        f->spread = add_part(set, name, "RGB", RETEX_HALF);
        for (size_t k = 0; k < (size_t)set->width * (size_t)set->height; k++) {
            float *to = set->parts[f->spread].image.pixels + 3 * k;
            memcpy(to, set->parts[deviations].image.pixels + 2 * k, 2 * sizeof *to);
            to[2] = (float)(2 * test_random(&seed) - 1);
        }
    }
    add_mixtures(set, &seed);
    test_renew_roles(set);
    round_to_stored(set);
}

/* The name of a term's signal: see <retex/host/denoise_data.h>. */
static void name_signal(const RetexSet *set, const RetexTerm *term, char name[RETEX_NAME_MAX])
{
    static const char *const kinds[RETEX_ROLES] = {
        [RETEX_ROLE_DEP] = "hit",     [RETEX_ROLE_CROSS2] = "hit",  [RETEX_ROLE_CROSS3] = "hit",
        [RETEX_ROLE_SHARP] = "sharp", [RETEX_ROLE_BROAD] = "broad", [RETEX_ROLE_INTERREFLECTION] = "interreflection"};
    if (term->role == RETEX_ROLE_LAMP) {
        const char *lamp = set->parameters[term->factors[term->nfactors - 1].index].name;
        RetexFootprintKind kind;
        int target = term->target;
        if (target >= 0)
            retex_factor_target(set, term->factors[0], &target, &kind);
        retex_lamp_noise_part_name(name, lamp, target < 0 ? NULL : set->targets[target].name,
                                   target < 0 ? RETEX_SIGNAL_INDEP : retex_footprint_kind_name((int)kind));
    } else if (kinds[term->role])
        retex_noise_part_name(name, set->targets[term->target].name, kinds[term->role]);
    else
        retex_noise_part_name(name, NULL, RETEX_SIGNAL_INDEP);
}

static void add_random_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type, double low,
                            double high, uint32_t *seed)
{
    if (retex_set_find_part(set, name) >= 0)
        return;
    const int part = add_part(set, name, letters, type);
    RetexImage *im = &set->parts[part].image;
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height * (size_t)im->channels; i++)
        im->pixels[i] = (float)(low + (high - low) * test_random(seed));
}

/* A guide with one value in the left half and another in the right half. */
static void add_guide(RetexSet *set, const char *name, const char *letters, RetexPixelType type, double low,
                      double high, uint32_t *seed)
{
    add_random_part(set, name, letters, type, low, high, seed);
    RetexImage *im = &set->parts[set->nparts - 1].image;
    const int row = im->width * im->channels;
    for (int i = 0; i < row * im->height; i++) {
        const int right = i % row / im->channels >= im->width / 2;
        im->pixels[i] = im->pixels[(right ? row - im->channels : 0) + i % im->channels];
    }
}

void test_add_denoise_data(RetexSet *set)
{
    uint32_t seed = 3;
    char name[RETEX_NAME_MAX];
    for (int t = 0; t < set->nterms; t++) {
        name_signal(set, &set->terms[t], name);
        add_random_part(set, name, "RGB", RETEX_HALF, -0.02, 0.02, &seed);
    }
    if (set->nterms == 0)
        add_random_part(set, RETEX_NOISE_PREFIX RETEX_SIGNAL_BEAUTY, "RGB", RETEX_HALF, -0.02, 0.02, &seed);
    for (int k = 0; k < RETEX_FEATURE_COUNT; k++) {
        const RetexFeatureInfo *feature = retex_feature_info(k);
        const double low = strstr(feature->name, "position") ? -5 : strstr(feature->name, "normal") ? -1 : 0;
        add_guide(set, feature->name, feature->letters, feature->type, low, low < 0 ? -low : 1, &seed);
    }
    for (int t = 0; t < set->ntargets; t++) {
        retex_cover_part_name(name, set->targets[t].name);
        add_guide(set, name, "R", RETEX_HALF, 0, 1, &seed);
    }
    round_to_stored(set);
}
