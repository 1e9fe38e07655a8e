/* The signals of a set, each of which is denoised with weights of its own: see <retex/host/denoise_data.h>. */
#ifndef RETEX_SET_SIGNALS_H
#define RETEX_SET_SIGNALS_H

#include <retex/set.h>

/* A member of a signal: the radiance of one of its terms. */
typedef struct RetexSignalMember {
    int part;
    float weight; /* its factor in the signal's total, of which there is noise: 0 of corrections */
    float bright; /* its factor in the total that is filtered: further hits on bright targets are taken as so bright */
    int term;     /* -1: the beauty of a set without terms */
    int hits;     /* of the term */
    int corrects; /* 1: a correction. These are members of the signal that no target's texture multiplies */
    int cluster;  /* the footprint whose light alone it is, that is the term has that one hit; else -1, as always in
                     layout paper */
} RetexSignalMember;

typedef struct RetexSignal {
    int lamp;                /* the parameter of the lamp whose light it is, for its value 1; -1: all light */
    int target;              /* -1: light that no target's texture multiplies */
    RetexFootprintKind kind; /* of its first hit's footprint */
    int noise;               /* part noise_… */
    int cover;               /* part guide_cover_… of the target, or -1 */
    int nmembers;
    RetexSignalMember *members;
} RetexSignal;

typedef struct RetexSignals {
    int count;
    RetexSignal *of; /* those of all light first, then those of each lamp */
    RetexSignalMember *members;    /* of all signals */
    int covers[RETEX_MAX_TARGETS]; /* parts guide_cover_… by target; -1 where no signal is of the target */
} RetexSignals;

/* Sort a set's terms by signal. Parts noise_… are found where there are any, else they are -1, as covers are. */
int retex_signals_sort(RetexSignals *signals, const RetexSet *set, RetexError *err);
/* Find a set's signals, and their parts: RETEX_ENOTFOUND where one is missing. */
int retex_signals_open(RetexSignals *signals, const RetexSet *set, RetexError *err);
void retex_signals_close(RetexSignals *signals);
/* Set marks[part] to `mark` for the parts of all members. */
void retex_signals_mark_members(const RetexSignals *signals, unsigned char *marks, unsigned char mark);
/* 1 where retex_signals_open finds all parts; needs no memory. */
int retex_signals_are_there(const RetexSet *set);

/* A part of the set's size with so many channels: its index, or RETEX_ENOTFOUND or RETEX_EFORMAT. */
int retex_signals_find_part(const RetexSet *set, const char *name, int channels, RetexError *err);

/* The name of the noise part of a term's signal; term NULL: of the beauty of a set without terms. */
void retex_signal_noise_name(const RetexSet *set, const RetexTerm *term, char name[RETEX_NAME_MAX]);

/* The target and kind of the footprint or mixture that is a term's factor. */
void retex_factor_target(const RetexSet *set, RetexFactor factor, int *target, RetexFootprintKind *kind);

#endif
