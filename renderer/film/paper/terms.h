/* The terms of layout `paper`: which radiance image a monomial of a path belongs to. */
#ifndef RENDERER_FILM_PAPER_TERMS_H
#define RENDERER_FILM_PAPER_TERMS_H

#include <pthread.h>
#include "film/bands.h"
#include "film/paper/expansion.h"

#define TERMS_MAX 1280 /* with footprints, originals and AOVs below what a set may have of parts */

/* A term's role and factors in one number: role << 56 | hit mask (or, for RETEX_ROLE_INDEP, the hit count). */
typedef uint64_t TermKey;
#define TERM_DROPPED (~(TermKey)0)

/* The term of a monomial of a path with nhits recorded hits. Mixed monomials of four and more hits join the dependent
 * radiance of as many factors of each target, or are dropped (strict: the supplement's way). */
TermKey term_key(int nhits, HitMask hits, int strict);

typedef struct TermTable {
    Bands *bands; /* borrowed */
    int ntargets, orders;
    int count;
    TermKey keys[TERMS_MAX];
    int images[TERMS_MAX]; /* of the bands, made as terms come */
    pthread_mutex_t lock;
    int ready; /* the lock exists */
} TermTable;

/* One thread's memory of where terms are, so that it takes the lock once a term. */
typedef struct TermCache {
    TermKey keys[256];
    int terms[256]; /* number + 1, 0 = empty */
} TermCache;

int terms_create(TermTable *table, Bands *bands, int ntargets, int orders, RetexError *err);
void terms_close(TermTable *table);
/* Number of the term, made on first use; -1 where memory or TERMS_MAX is exhausted. */
int terms_find(TermTable *table, TermCache *cache, TermKey key);
/* Make the term whose image has this name, if it is one of several targets' terms and not there yet. */
int terms_resume(TermTable *table, const char *name, RetexError *err);
/* The hits whose textures multiply a term. */
HitMask terms_hits(const TermTable *table, int term);
/* How many hits of a mask are on a target. */
int hits_on_target(HitMask hits, int target);
/* The target of a term's first factor, or -1. */
int terms_first_target(const TermTable *table, int term);
/* What a term weighs in sums of which there is noise: its hits after the first as their targets are bright. */
double terms_weight(const TermTable *table, int term, const float *brightness);
/* Make all terms the set's, in an order that does not depend on when they came; footprints must be there already.
 * brightness: of targets, where the set keeps noise, else NULL. */
int terms_finish(TermTable *table, RetexSet *set, const float *brightness, RetexError *err);

#endif
