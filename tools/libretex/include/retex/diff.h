/* Comparing two files part by part and channel by channel: what retex-diff does. */
#ifndef RETEX_DIFF_H
#define RETEX_DIFF_H

#include <retex/metrics.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* What to compare and what is close enough. Begin with RETEX_DIFF_INIT. With no limit at all, the files must be
 * identical. psnr, relmse and flip look at R,G,B (or Y) only: every other channel must keep abs and rel where they are
 * given, or else be identical. */
typedef struct RetexDiffParams {
    size_t size;
    const char *part;  /* name of the part to compare; NULL = the first of each file */
    int all_parts;     /* 1: all of them, matched by name; both files must have the same */
    int allow_inf;     /* 1: infinities of the same sign in the same place are equal; 0: no infinity is accepted */
    double fail_psnr;  /* differs when psnr is below; < 0 = no limit, as for all that follow */
    double fail_relmse, fail_flip, fail_abs, fail_rel; /* when relmse, flip_mean, max_abs, max_rel is above */
    const RetexAccess *access; /* which files may be read; sets and packs are, as pictures go; NULL = any */
    const RetexBudget *budget; /* what pictures may take; NULL = what there is */
    RetexWarn *warn;           /* told, in the calling thread, of damaged pictures that access accepts; NULL = nobody */
    void *warn_context;        /* handed to it */
} RetexDiffParams;
#define RETEX_DIFF_INIT { sizeof(RetexDiffParams), NULL, 0, 0, -1, -1, -1, -1, -1, NULL, NULL, NULL, NULL }

typedef struct RetexDiffPart {
    char name[192];          /* "" where the file's part has none */
    int width, height, channels; /* of the first file */
    int compared;            /* 0: sizes or channels differ, so there are no figures */
    int has_color;           /* 0: no R,G,B: psnr, relmse and flip are not defined (0) */
    RetexMetrics metrics;    /* mae of R,G,B, or of all channels without them; the others of all */
    char worst_channel[192]; /* the whole name where metrics.worst has one letter */
    char reason[512];        /* why the parts differ; "" where they do not */
} RetexDiffPart;

typedef struct RetexDiff {
    int differs;       /* 1: some part does, or a part is missing */
    char reason[512];  /* the first one; "" */
    int nparts;
    RetexDiffPart *parts;
} RetexDiff;

/* Compare two files: EXR (sets and samples too), packs, or any picture OpenImageIO reads, as R,G,B,A. b is the
 * reference. That they differ is not an error: see (*diff)->differs. */
int retex_diff(RetexDiff **diff, const char *a, const char *b, const RetexDiffParams *params /* NULL = defaults */,
               int nthreads /* 0 = all cores */, RetexError *err);
void retex_diff_close(RetexDiff **diff); /* NULL and pointers to NULL are fine */

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
