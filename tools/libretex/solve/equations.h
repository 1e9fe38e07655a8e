/* The normal equations of a solution: sums over the picture of products of derivatives. Private to libretex. */
#ifndef RETEX_SOLVE_EQUATIONS_H
#define RETEX_SOLVE_EQUATIONS_H

#include <retex/solve.h>

/* Lamps are opened with so many times their light, as those of a set that have their own do not count one by one. */
#define RETEX_SOLVE_LAMP_UNIT 2

/* A colour or lamp that is sought: in each channel one number. */
typedef struct RetexSolveColumn {
    int target;                /* its index; -1: a lamp */
    char lamp[RETEX_NAME_MAX]; /* the name of a lamp */
    int number[3];             /* of its value in each channel among all numbers; a strength has one for all three */
} RetexSolveColumn;

/* What is evaluated. All is borrowed. */
typedef struct RetexSolveModel {
    const RetexSet *set;
    RetexTexture *const *textures; /* by target, of those that are not sought */
    RetexCombineParams combine;    /* parameters: of the finishes that are tried, and RETEX_SOLVE_LAMP_UNIT of lamps */
    const RetexImage *picture;     /* pixels with a number that is not finite do not count */
    double dark;                   /* added to the mean of a block, by which it weighs */
    int block;                     /* pixels to a side of a block: a power of two, at most RETEX_PICTURE_STRIP */
    int ncolumns;
    RetexSolveColumn columns[RETEX_UNKNOWNS_MAX];
    const RetexBudget *budget;
} RetexSolveModel;

/* Which rows: of every `band`th 16 rows every `step`th. */
typedef struct RetexSolveRows {
    int band, step;
} RetexSolveRows;

/* Sums by channel over the means of blocks: of weights times squared differences, and its derivatives. Single pixels
 * are not compared, as noise of the set in the derivatives makes what is found too small. */
typedef struct RetexEquations {
    double count[3], square[3];
    double gradient[3][RETEX_UNKNOWNS_MAX];
    double matrix[3][RETEX_UNKNOWNS_MAX][RETEX_UNKNOWNS_MAX]; /* [i][j], j <= i */
    double pixels[3], wanted[3], difference[3]; /* sums over pixels: their number, the picture, what exceeds it, */
    double slope[3][RETEX_UNKNOWNS_MAX];        /* and its derivatives */
} RetexEquations;

/* Evaluate them for these values of all numbers. */
int retex_equations_make(RetexEquations *equations, const RetexSolveModel *model, const double *values,
                         RetexSolveRows rows, int nthreads, RetexError *err);

#endif
