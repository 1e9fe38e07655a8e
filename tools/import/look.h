/* A look at the scene that was written: a small picture by retex-render, by which the exposure is chosen, and whether
 * the model needs light that it does not have. */
#ifndef RETEX_IMPORT_LOOK_H
#define RETEX_IMPORT_LOOK_H

#include <stdatomic.h>
#include <sys/types.h>

#include <retex/budget.h>
#include <retex/error.h>

typedef struct LookParams {
    int folder;       /* of the scene, open */
    const char *name; /* of the scene: NAME.pov in it */
    int is_framed;    /* the view is none of the model's cameras: it is not to be of things before black */
    double seconds;          /* 0: no limit */
    uint64_t memory;         /* bytes; 0: no limit */
    long max_pixels;         /* of its pictures; 0: no other limit than that of --safe */
    _Atomic pid_t *renderer; /* its process while it runs, else 0 */
} LookParams;

typedef struct Look {
    double exposure; /* stops, in the scene now */
    const char *added; /* what is declared for the light that was added last, or NULL */
    double lit;      /* share of what is seen, after exposure, that is brighter than 5 % of the range, by own light */
    int is_seen;     /* any surface is */
    int is_balanced; /* the lamp was added for windows that were white */
    int is_bare;     /* things are seen before black */
    int is_black;    /* so little light that no exposure helps */
    int is_noisy;    /* most light is of few paths: the lamps shine through gaps */
} Look;

/* Choose both and write them into the scene. RETEX_ENOTFOUND: there is no retex-render beside this program. */
int look_at(Look *look, const LookParams *params, RetexError *err);
/* Write an exposure, in stops. */
int look_expose(const LookParams *params, double stops, RetexError *err);

#endif
