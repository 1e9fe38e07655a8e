/* What a solution seeks, as text, as numbers and as edits. Private to libretex. */
#ifndef RETEX_SOLVE_UNKNOWNS_H
#define RETEX_SOLVE_UNKNOWNS_H

#include "solve/equations.h"

enum { RETEX_SOLVE_LIST_MAX = RETEX_UNKNOWNS_MAX + RETEX_MAX_TARGETS };

struct RetexSolution {
    int count;
    RetexUnknown unknowns[RETEX_SOLVE_LIST_MAX];
    int index[RETEX_SOLVE_LIST_MAX];  /* of the target, or of a lamp the parameter */
    int column[RETEX_SOLVE_LIST_MAX]; /* its column in the model; -1: a finish */
    int combinations;                 /* of finishes */
};

/* Make the list of what params seek, and the columns of the model, those of targets first. Sets numbers to how many
 * there are. */
int retex_unknowns_open(RetexSolution *solution, RetexSolveModel *model, const RetexSolveParams *params, int *numbers,
                        RetexError *err);
/* The number of the finish that an unknown has in a combination of finishes. */
int retex_unknowns_finish(const RetexSolution *solution, const RetexSet *set, int unknown, int combination);
/* The values of the set's parameters for a combination of finishes, with lamps that are sought at
 * RETEX_SOLVE_LAMP_UNIT. */
int retex_unknowns_parameters(const RetexSolution *solution, const RetexSet *set, const RetexEdit *lights,
                              int combination, float *parameters, RetexError *err);

#endif
