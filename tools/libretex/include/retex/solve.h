/* Which parameters of a set come nearest to a given picture: constant colours of targets, the strength or the colour of
 * lamps, and finishes. What is not sought stays as textures, samples, lamps and finishes say.
 *
 * The sum of squares of the weighted difference between the retexture and the picture is minimised by damped
 * Gauss-Newton steps (Levenberg-Marquardt), first on some rows, then on all. The derivatives are those of the set's
 * polynomial. Means of blocks of 32 x 32 pixels are compared, of small pictures of smaller ones, because noise of the
 * set would make what is found too small. A difference is divided by the picture's mean in the block plus a twentieth
 * of its mean everywhere, so that dark places count as bright ones do. Finishes are tried one after the other. */
#ifndef RETEX_SOLVE_H
#define RETEX_SOLVE_H

#include <retex/combine.h>
#include <retex/edit.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_UNKNOWNS_MAX 32       /* colours and lamps that are sought */
#define RETEX_SOLVE_FINISHES_MAX 64 /* combinations of finishes that are tried */
#define RETEX_SOLVE_LAMP_MAX 1e6    /* the largest strength of a lamp that is found */

typedef enum RetexUnknownKind {
    RETEX_UNKNOWN_COLOR,      /* the constant colour of a target, each channel from 0 to 1 */
    RETEX_UNKNOWN_LAMP,       /* the strength of a lamp: one number, by which its light as rendered is multiplied */
    RETEX_UNKNOWN_LAMP_COLOR, /* its strength and its colour: three numbers */
    RETEX_UNKNOWN_FINISH      /* one of the finishes of a target */
} RetexUnknownKind;

/* What was found of one of them. A later version may add members at the end. */
typedef struct RetexUnknown {
    RetexUnknownKind kind;
    char name[RETEX_NAME_MAX];   /* of the target or lamp */
    int seen;                    /* 1: the picture determines it; 0: it has its first value, which means nothing */
    int limited;                 /* 1: a number of it is at the end of its range: the picture asks for more, or less */
    double value[3];             /* COLOR: scene-linear Rec. 709. LAMP: the strength, three times. LAMP_COLOR: strength
                                  times a colour of luminance 1 */
    double error[3];             /* standard errors of these, from the variance of what is left and the inverse of the
                                  normal matrix. They do not know of errors of the set, or of a wrong model */
    char finish[RETEX_NAME_MAX]; /* FINISH: which */
    char next[RETEX_NAME_MAX];   /* FINISH: the next best one */
    double next_ratio;           /* FINISH: the weighted root mean square with that, over the one reached; 1 or more */
} RetexUnknown;

typedef struct RetexSolution RetexSolution;

/* Begin with RETEX_SOLVE_INIT. */
typedef struct RetexSolveParams {
    size_t size;
    const char *unknowns; /* what is sought, divided by commas: TARGET, light:LAMP (strength), color:LAMP (strength and
                             colour), finish:TARGET. Default NULL: the colours of all targets that have neither texture
                             nor samples */
    int x0, y0, x1, y1;   /* only pixels x0 <= x < x1, y0 <= y < y1 count; default 0, 0, 0, 0 = all */
    int cross;            /* as in RetexCombineParams; default 3 */
    const RetexEdit *lights;    /* lamps and finishes that are not sought; default NULL: as rendered */
    const RetexBudget *budget;  /* says when to stop; default NULL */
    const RetexSolution *start; /* of the same set: what it found is begun with, where that is sought again; default
                                   NULL: mean originals, and lamps as rendered */
    int mean; /* 1: of the pixels that count only the mean is compared, by CIEDE2000. What is sought changes as little
                 as that asks for; default 0 */
} RetexSolveParams;
#define RETEX_SOLVE_INIT                                                                                               \
    {                                                                                                                  \
        sizeof(RetexSolveParams), NULL, 0, 0, 0, 0, 3, NULL, NULL, NULL, 0                                             \
    }

/* Find them. picture: of the set's size, 3 or more channels, scene-linear Rec. 709; pixels with a number that is not
 * finite do not count. textures: by target, NULL where target t has none. Rows are read many times: a set that was
 * brought into memory by retex_set_preload is faster. RETEX_EINVAL where the picture has another size, no pixel counts,
 * or something is both sought and given; RETEX_ENOTFOUND for names that the set does not have. */
int retex_solve(RetexSolution **solution, const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                const RetexImage *picture, const RetexSolveParams *params /* NULL = defaults */,
                int nthreads /* 0 = all cores */, RetexError *err);
void retex_solution_close(RetexSolution **solution); /* NULL and pointers to NULL are fine */
/* One of what was sought, in its order; NULL where index is not 0..count-1. It belongs to the solution. */
const RetexUnknown *retex_solution_unknown(const RetexSolution *solution, int index);
/* Add what was found and seen to an edit, numbers rounded to four digits. */
int retex_solution_edit(const RetexSolution *solution, RetexEdit *edit, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
