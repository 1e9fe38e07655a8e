/* The signals of a set, which are denoised each with weights of its own: see <retex/denoise.h>. */
#ifndef RETEX_SET_SIGNALS_H
#define RETEX_SET_SIGNALS_H

#include <retex/set.h>

/* An image of a signal: the radiance of one of its terms. */
typedef struct SignalMember {
    int part;
    float weight; /* in the signal's total */
    int term;     /* -1: the beauty of a set without terms */
} SignalMember;

typedef struct Signal {
    int target;   /* -1: light that no target's texture multiplies */
    RetexFootprintKind kind; /* of the first factor's footprint */
    int noise;    /* part noise_… */
    int cover;    /* part guide_cover_… of the target, or -1 */
    int nmembers;
    SignalMember *members;
} Signal;

typedef struct Signals {
    int count;
    Signal *of;
    SignalMember *members; /* of all */
    int covers[RETEX_MAX_TARGETS]; /* parts guide_cover_… by target; -1 where no signal is of the target */
} Signals;

/* Find a set's signals, and their parts: RETEX_ENOTFOUND where one is missing. */
int signals_open(Signals *signals, const RetexSet *set, RetexError *err);
void signals_close(Signals *signals);

/* A part of the set's size with so many channels: its index, or RETEX_ENOTFOUND or RETEX_EFORMAT. */
int signals_find_part(const RetexSet *set, const char *name, int channels, RetexError *err);

/* The footprint whose light alone a member is, a cluster's: its term has that one factor. Else -1, as always in
 * layout paper. */
int signal_cluster(const RetexSet *set, const SignalMember *member);

/* The name of the part that says how noisy the signal of a term is; term NULL: the beauty of a set without terms. */
void signal_noise_name(const RetexSet *set, const RetexTerm *term, char name[RETEX_NAME_MAX]);

/* Kind and target of what a term's factor lies on. */
void factor_place(const RetexSet *set, int factor, int *target, RetexFootprintKind *kind);

#endif
