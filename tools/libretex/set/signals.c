/* See signals.h. */
#include "set/signals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>
#include <retex/host/denoise_data.h>

#include "set/set.h"

/* Of all light, and of each lamp. */
#define SIGNALS_OF_LIGHT_MAX (1 + 2 * RETEX_MAX_TARGETS)
#define LAMPS_MAX 17
#define SIGNALS_MAX (SIGNALS_OF_LIGHT_MAX * (1 + LAMPS_MAX))

void retex_factor_target(const RetexSet *set, RetexFactor factor, int *target, RetexFootprintKind *kind)
{
    int footprint =
        factor.kind == RETEX_FACTOR_MIXTURE ? set->mixtures[factor.index].shares[0].footprint : factor.index;
    *target = set->footprints[footprint].target;
    *kind = set->footprints[footprint].kind;
}

/* The footprint of a term that is the light of one cluster alone, or -1. */
static int cluster_of(const RetexTerm *term)
{
    const int clustered =
        term->role == RETEX_ROLE_SHARP || term->role == RETEX_ROLE_BROAD || term->role == RETEX_ROLE_INTERREFLECTION;
    for (int k = 0; k < term->nfactors && clustered && retex_term_hits(term) == 1; k++)
        if (term->factors[k].kind == RETEX_FACTOR_FOOTPRINT)
            return term->factors[k].index;
    return -1;
}

static void noise_name(const RetexSet *set, const RetexSignal *signal, char name[RETEX_NAME_MAX])
{
    const char *target = signal->target < 0 ? NULL : set->targets[signal->target].name;
    const char *light = target        ? retex_footprint_kind_name(signal->kind)
                        : set->nterms ? RETEX_SIGNAL_INDEP
                                      : RETEX_SIGNAL_BEAUTY;
    if (signal->lamp < 0)
        retex_noise_part_name(name, target, light);
    else
        retex_lamp_noise_part_name(name, set->parameters[signal->lamp].name, target, light);
}

/* The kind of the footprint or mixture that a lamp's light meets first. */
static RetexFootprintKind first_kind(const RetexSet *set, const RetexTerm *term)
{
    RetexFootprintKind kind = RETEX_FOOTPRINT_HIT;
    for (int k = 0, target; k < term->nfactors; k++)
        if (retex_factor_is_hit(term->factors[k])) {
            retex_factor_target(set, term->factors[k], &target, &kind);
            break;
        }
    return kind;
}

/* A signal without members for the light of a term: the target that it meets first, -1 where it meets none, and of
 * corrections. */
static RetexSignal signal_for(const RetexSet *set, const RetexTerm *term)
{
    RetexSignal signal = {.target = -1, .lamp = term ? retex_set_term_lamp(set, term) : -1, .noise = -1, .cover = -1};
    if (term && (retex_term_is_light(term) || term->role == RETEX_ROLE_LAMP))
        signal.target = term->target;
    signal.kind = signal.target < 0                          ? RETEX_FOOTPRINT_HIT
                  : term->role == RETEX_ROLE_LAMP            ? first_kind(set, term)
                  : term->role == RETEX_ROLE_SHARP           ? RETEX_FOOTPRINT_SHARP
                  : term->role == RETEX_ROLE_BROAD           ? RETEX_FOOTPRINT_BROAD
                  : term->role == RETEX_ROLE_INTERREFLECTION ? RETEX_FOOTPRINT_INTERREFLECTION
                                                             : RETEX_FOOTPRINT_HIT;
    return signal;
}

void retex_signal_noise_name(const RetexSet *set, const RetexTerm *term, char name[RETEX_NAME_MAX])
{
    const RetexSignal signal = signal_for(set, term);
    noise_name(set, &signal, name);
}

int retex_signals_find_part(const RetexSet *set, const char *name, int channels, RetexError *err)
{
    int part = retex_set_find_part(set, name);
    if (part < 0)
        return retex_fail(err, RETEX_ENOTFOUND, "the set lacks the part %s: it was rendered or packed without %s", name,
                          "what denoising needs, or is denoised already");
    const RetexImage *image = &set->parts[part].image;
    if (image->width != set->width || image->height != set->height || image->channels != channels)
        return retex_fail(err, RETEX_EFORMAT, "the part %s of the set is not %dx%d of %d channels", name, set->width,
                          set->height, channels);
    return part;
}

/* The signal of a term; created for its first term. */
static RetexSignal *signal_of(RetexSignals *signals, const RetexSet *set, const RetexTerm *term)
{
    const RetexSignal wanted = signal_for(set, term);
    int of_light = 0;
    for (int k = 0; k < signals->count; k++) {
        const RetexSignal *signal = &signals->of[k];
        if (signal->target == wanted.target && signal->kind == wanted.kind && signal->lamp == wanted.lamp)
            return &signals->of[k];
        of_light += signal->lamp == wanted.lamp;
    }
    if (of_light == SIGNALS_OF_LIGHT_MAX || signals->count == SIGNALS_MAX)
        return NULL;
    signals->of[signals->count] = wanted;
    return &signals->of[signals->count++];
}

/* The parts of a signal. */
static int find_parts_of(RetexSignal *signal, const RetexSet *set, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    noise_name(set, signal, name);
    if ((signal->noise = retex_signals_find_part(set, name, 3, err)) < 0)
        return signal->noise;
    if (signal->target < 0)
        return RETEX_OK;
    retex_cover_part_name(name, set->targets[signal->target].name);
    signal->cover = retex_signals_find_part(set, name, 1, err);
    return signal->cover < 0 ? signal->cover : RETEX_OK;
}

static int find_parts(RetexSignals *signals, const RetexSet *set, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < signals->count && !code; k++) {
        RetexSignal *signal = &signals->of[k];
        code = find_parts_of(signal, set, err);
        if (!code && signal->target >= 0)
            signals->covers[signal->target] = signal->cover;
    }
    return code;
}

/* The light of all terms is in signals, and their corrections. */
static int is_member(const RetexTerm *term)
{
    return !retex_term_is_picture(term);
}

/* The luminance of a target's mean albedo, at least 1/2: in total light, hits of what is darker count as much. For sets
 * that do not say what their terms weigh. */
static float brightness(const RetexTarget *t)
{
    const float albedo = retex_luminance(t->mean_albedo[0], t->mean_albedo[1], t->mean_albedo[2]);
    return albedo > 0.5f ? fminf(albedo, 1) : 0.5f;
}

/* The brightest target that a factor is of. */
static float factor_brightness(const RetexSet *set, const RetexFactor *f)
{
    float most = 0.5f;
    if (f->kind == RETEX_FACTOR_FOOTPRINT)
        return brightness(&set->targets[set->footprints[f->index].target]);
    for (int k = 0; f->kind == RETEX_FACTOR_MIXTURE && k < set->mixtures[f->index].nshares; k++)
        most =
            fmaxf(most, brightness(&set->targets[set->footprints[set->mixtures[f->index].shares[k].footprint].target]));
    return most;
}

/* Parameters are taken as rendered, but those of lamps as 1; corrections, of either sign, do not count. */
static float first_weight(const RetexSet *set, const RetexTerm *term)
{
    float weight = term->role == RETEX_ROLE_CORRECTION ? 0 : 1;
    for (int k = 0; k < term->nfactors && term->role != RETEX_ROLE_LAMP; k++)
        if (term->factors[k].kind == RETEX_FACTOR_PARAMETER && weight > 0)
            weight *= retex_luminance(set->parameters[term->factors[k].index].value[0],
                                      set->parameters[term->factors[k].index].value[1],
                                      set->parameters[term->factors[k].index].value[2]);
    return weight;
}

/* Where the term does not say it, further hits are taken as grey or, `bright`, as bright as their targets. */
static float member_weight(const RetexSet *set, const RetexTerm *term, int bright)
{
    float weight = first_weight(set, term);
    int hits = 0;
    if (term->noise_weight > 0)
        return weight * term->noise_weight;
    for (int k = 0; k < term->nfactors; k++)
        if (retex_factor_is_hit(term->factors[k]) && hits++)
            weight *= bright ? factor_brightness(set, &term->factors[k]) : 0.5f;
    return weight;
}

/* Those of all light first, then those of each lamp. */
static void order_by_lamp(RetexSignals *signals)
{
    for (int k = 1; k < signals->count; k++) {
        const RetexSignal signal = signals->of[k];
        int to = k;
        for (; to > 0 && signals->of[to - 1].lamp > signal.lamp; to--)
            signals->of[to] = signals->of[to - 1];
        signals->of[to] = signal;
    }
}

/* Sorts the terms by signal. */
static int sort_terms(RetexSignals *signals, const RetexSet *set, RetexError *err)
{
    int used = 0;
    for (int t = 0; t < set->nterms; t++)
        if (is_member(&set->terms[t]) && !signal_of(signals, set, &set->terms[t]))
            return retex_fail(err, RETEX_EFORMAT, "the set's terms are of too many kinds");
    order_by_lamp(signals);
    if (!set->nterms) {
        signals->members[0] = (RetexSignalMember){.weight = 1, .bright = 1, .term = -1, .cluster = -1};
        RetexSignal *beauty = signal_of(signals, set, NULL);
        beauty->nmembers = 1;
        beauty->members = signals->members;
    }
    for (int k = 0; set->nterms && k < signals->count; k++) {
        RetexSignal *signal = &signals->of[k];
        signal->members = signals->members + used;
        for (int t = 0; t < set->nterms; t++) {
            const RetexTerm *term = &set->terms[t];
            if (!is_member(term) || signal_of(signals, set, term) != signal)
                continue;
            signal->members[signal->nmembers++] = (RetexSignalMember){term->radiance,
                                                                      member_weight(set, term, 0),
                                                                      member_weight(set, term, 1),
                                                                      t,
                                                                      retex_term_hits(term),
                                                                      term->role == RETEX_ROLE_CORRECTION,
                                                                      cluster_of(term)};
            used++;
        }
    }
    return RETEX_OK;
}

int retex_signals_sort(RetexSignals *signals, const RetexSet *set, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    *signals = (RetexSignals){.of = calloc(SIGNALS_MAX, sizeof *signals->of),
                              .members = calloc((size_t)set->nterms + 1, sizeof *signals->members)};
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        signals->covers[t] = -1;
    int code = signals->of && signals->members ? sort_terms(signals, set, err)
                                               : retex_fail(err, RETEX_ENOMEM, "no memory for the signals of a set");
    for (int k = 0; k < signals->count && !code; k++) {
        noise_name(set, &signals->of[k], name);
        signals->of[k].noise = retex_set_find_part(set, name);
    }
    if (code)
        retex_signals_close(signals);
    return code;
}

int retex_signals_open(RetexSignals *signals, const RetexSet *set, RetexError *err)
{
    int code = retex_signals_sort(signals, set, err);
    if (!code)
        code = find_parts(signals, set, err);
    if (code)
        retex_signals_close(signals);
    return code;
}

int retex_signals_are_there(const RetexSet *set)
{
    int there = 1;
    for (int t = 0; t < (set->nterms ? set->nterms : 1) && there; t++) {
        const RetexTerm *term = set->nterms ? &set->terms[t] : NULL;
        RetexSignal signal = signal_for(set, term);
        there = (term && !is_member(term)) || !find_parts_of(&signal, set, NULL);
    }
    return there;
}

void retex_signals_mark_members(const RetexSignals *signals, unsigned char *marks, unsigned char mark)
{
    for (int s = 0; s < signals->count; s++)
        for (int k = 0; k < signals->of[s].nmembers; k++)
            marks[signals->of[s].members[k].part] = mark;
}

void retex_signals_close(RetexSignals *signals)
{
    free(signals->of);
    free(signals->members);
    *signals = (RetexSignals){0};
}
