/* See signals.h. */
#include "set/signals.h"

#include <stdlib.h>
#include <string.h>

#include <retex/denoise_data.h>

#define SIGNALS_MAX (1 + 2 * RETEX_MAX_TARGETS)

void retex_factor_target(const RetexSet *set, int factor, int *target, RetexFootprintKind *kind)
{
    int footprint = factor < 0 ? set->mixtures[RETEX_MIXTURE(factor)].shares[0].footprint : factor;
    *target = set->footprints[footprint].target;
    *kind = set->footprints[footprint].kind;
}

int retex_signal_cluster(const RetexSet *set, const RetexSignalMember *member)
{
    const RetexTerm *term = member->term < 0 ? NULL : &set->terms[member->term];
    return term && term->nfactors == 1 && term->factors[0] >= 0 &&
                   set->footprints[term->factors[0]].kind != RETEX_FOOTPRINT_HIT && !term->edited
               ? term->factors[0]
               : -1;
}

int retex_signal_corrects(const RetexSet *set, const RetexSignalMember *member)
{
    return member->term >= 0 && set->terms[member->term].edited;
}

static void noise_name(const RetexSet *set, int target, RetexFootprintKind kind, char name[RETEX_NAME_MAX])
{
    if (target < 0)
        retex_noise_part_name(name, NULL, set->nterms ? RETEX_SIGNAL_INDEP : RETEX_SIGNAL_BEAUTY);
    else
        retex_noise_part_name(name, set->targets[target].name, retex_footprint_kind_name(kind));
}

/* The target that the light of a term meets first; -1 where it meets none, and of corrections. */
static void find_first_target(const RetexSet *set, const RetexTerm *term, int *target, RetexFootprintKind *kind)
{
    *target = -1, *kind = RETEX_FOOTPRINT_HIT;
    if (term && term->nfactors && !term->edited)
        retex_factor_target(set, term->factors[0], target, kind);
}

void retex_signal_noise_name(const RetexSet *set, const RetexTerm *term, char name[RETEX_NAME_MAX])
{
    int target;
    RetexFootprintKind kind;
    find_first_target(set, term, &target, &kind);
    noise_name(set, target, kind, name);
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
    int target;
    RetexFootprintKind kind;
    find_first_target(set, term, &target, &kind);
    for (int k = 0; k < signals->count; k++)
        if (signals->of[k].target == target && signals->of[k].kind == kind)
            return &signals->of[k];
    if (signals->count == SIGNALS_MAX)
        return NULL;
    RetexSignal *signal = &signals->of[signals->count++];
    *signal = (RetexSignal){.target = target, .kind = kind, .noise = -1, .cover = -1};
    return signal;
}

static int find_parts(RetexSignals *signals, const RetexSet *set, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    for (int k = 0; k < signals->count; k++) {
        RetexSignal *signal = &signals->of[k];
        noise_name(set, signal->target, signal->kind, name);
        if ((signal->noise = retex_signals_find_part(set, name, 3, err)) < 0)
            return signal->noise;
        if (signal->target < 0)
            continue;
        retex_cover_part_name(name, set->targets[signal->target].name);
        if ((signal->cover = retex_signals_find_part(set, name, 1, err)) < 0)
            return signal->cover;
        signals->covers[signal->target] = signal->cover;
    }
    return RETEX_OK;
}

/* Groups the terms by signal. */
static int sort_terms(RetexSignals *signals, const RetexSet *set, RetexError *err)
{
    int used = 0;
    for (int t = 0; t < set->nterms; t++)
        if (!signal_of(signals, set, &set->terms[t]))
            return retex_fail(err, RETEX_EFORMAT, "the set's terms are of too many kinds");
    if (!set->nterms) {
        signals->members[0] = (RetexSignalMember){0, 1, -1};
        *signal_of(signals, set, NULL) =
            (RetexSignal){.target = -1, .noise = -1, .cover = -1, .nmembers = 1, .members = signals->members};
    }
    for (int k = 0; set->nterms && k < signals->count; k++) {
        RetexSignal *signal = &signals->of[k];
        signal->members = signals->members + used;
        for (int t = 0; t < set->nterms; t++) {
            float weight = set->terms[t].edited ? 0 : 1;
            if (signal_of(signals, set, &set->terms[t]) != signal)
                continue;
            for (int n = 1; n < set->terms[t].nfactors; n++)
                weight *= 0.5f;
            signal->members[signal->nmembers++] = (RetexSignalMember){set->terms[t].radiance, weight, t};
            used++;
        }
    }
    return RETEX_OK;
}

int retex_signals_group(RetexSignals *signals, const RetexSet *set, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    *signals = (RetexSignals){.of = calloc(SIGNALS_MAX, sizeof *signals->of),
                              .members = calloc((size_t)set->nterms + 1, sizeof *signals->members)};
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        signals->covers[t] = -1;
    int code = signals->of && signals->members ? sort_terms(signals, set, err)
                                               : retex_fail(err, RETEX_ENOMEM, "no memory for the signals of a set");
    for (int k = 0; k < signals->count && !code; k++) {
        noise_name(set, signals->of[k].target, signals->of[k].kind, name);
        signals->of[k].noise = retex_set_find_part(set, name);
    }
    if (code)
        retex_signals_close(signals);
    return code;
}

int retex_signals_open(RetexSignals *signals, const RetexSet *set, RetexError *err)
{
    int code = retex_signals_group(signals, set, err);
    if (!code)
        code = find_parts(signals, set, err);
    if (code)
        retex_signals_close(signals);
    return code;
}

void retex_signals_close(RetexSignals *signals)
{
    free(signals->of);
    free(signals->members);
    *signals = (RetexSignals){0};
}
