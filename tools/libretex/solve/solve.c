/* Damped Gauss-Newton steps, and the finishes that are tried: see retex/solve.h. */
#include <retex/solve.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/metrics.h>

#include "base/delta_e.h"
#include "base/params.h"
#include "set/set.h"
#include "solve/unknowns.h"

enum {
    NUMBERS_MAX = 3 * RETEX_UNKNOWNS_MAX,
    STEPS_MAX = 40,
    SIDE = 15,     /* of a grid of colours */
    STRENGTHS = 24 /* of lamps, four a decade: 10^-2.75 to 10^3 */
};

#define BLOCK_MAX 32       /* pixels */
#define BLOCKS 64          /* that are enough */
#define DARK_SHARE 0.05    /* of the picture's mean, which is added to that of a block */
#define COARSE_NUMBERS 2e4 /* pixels of the first rows, about */
#define SAME 1e-7          /* a step that lowers the sum by no more of it is the last */
#define NO_EFFECT 1e-10    /* mean square of the weighted derivative of what is not seen */
#define VAGUE 0.25         /* standard error of what is not seen; of lamps times their strength if that is above 1 */
#define NOISE_MAX 0.2      /* relative; if more is left, it is no noise, and makes nothing unseen */
#define TINY 1e-6          /* what is less counts as 0 */
#define NUDGE 1e-4         /* of a mean, for derivatives of differences of colours */
#define LESSENS 0.1        /* a step that is to change a mean leaves so much of a number: black has no hue; unless it */
#define MET 0.0025         /* square of CIEDE2000 of a mean that is met */
#define DARK 1e-3          /* is as small as that */
#define SURE 20.0          /* logarithm of the odds, twice, from which a finish is seen */

/* A point of the search, and the equations there. */
typedef struct Point {
    double values[NUMBERS_MAX];
    RetexEquations sums;
} Point;

/* The symmetric matrix and the gradient of all numbers. */
typedef struct Normal {
    int n;
    double square, count;
    double gradient[NUMBERS_MAX];
    double matrix[NUMBERS_MAX][NUMBERS_MAX];
} Normal;

typedef struct Search {
    RetexSolution *solution;
    RetexSolveModel model;
    const RetexSolveParams *params;
    int numbers, nthreads;
    double first[NUMBERS_MAX], most[NUMBERS_MAX]; /* where values begin, and the largest ones; the least are 0 */
    float parameters[3 * RETEX_PARAMETERS_MAX];
    Normal normal;
    double lower[NUMBERS_MAX][NUMBERS_MAX]; /* its Cholesky factor */
    Point here, next, kept;
    const double *aim; /* a mean in place of the picture's, or NULL */
    double squares[RETEX_SOLVE_FINISHES_MAX], counted;
} Search;

/* ---- the picture ---- */

/* How dark places weigh, and the size of blocks: as large as leaves enough of them. */
static int measure(RetexSolveModel *m, const RetexImage *picture, RetexError *err)
{
    const RetexCombineParams *in = &m->combine;
    double sum = 0, count = 0;
    for (int y = in->y0; y < in->y1; y++)
        for (int x = in->x0; x < in->x1; x++) {
            const float *p = picture->pixels + retex_image_index(picture, x, y);
            const double pixel = fabs((double)p[0]) + fabs((double)p[1]) + fabs((double)p[2]);
            count += isfinite(pixel);
            sum += isfinite(pixel) ? pixel / 3 : 0;
        }
    for (m->block = BLOCK_MAX; m->block > 1 && m->block * m->block * BLOCKS > count;)
        m->block /= 2;
    m->dark = fmax(DARK_SHARE * sum / fmax(count, 1), 1e-4);
    m->picture = picture;
    return count > 0 ? RETEX_OK : retex_fail(err, RETEX_EINVAL, "no pixel of the picture counts");
}

/* ---- equations of all numbers ---- */

static void gather(Normal *normal, const RetexEquations *sums, const RetexSolveModel *m, int numbers)
{
    memset(normal, 0, sizeof *normal);
    normal->n = numbers;
    for (int c = 0; c < 3; c++) {
        normal->square += sums->square[c];
        normal->count += sums->count[c];
        for (int i = 0; i < m->ncolumns; i++) {
            const int a = m->columns[i].number[c];
            normal->gradient[a] += sums->gradient[c][i];
            for (int j = 0; j <= i; j++) {
                const int b = m->columns[j].number[c];
                normal->matrix[a][b] += sums->matrix[c][i][j];
                if (a != b)
                    normal->matrix[b][a] = normal->matrix[a][b];
            }
        }
    }
}

static double mean_of(const RetexEquations *sums, int channel)
{
    return (sums->wanted[channel] + sums->difference[channel]) / fmax(sums->pixels[channel], 1);
}

/* The difference of a colour from the picture's mean, or from what is aimed at, as CIEDE2000 has it: three parts, and
 * the sum of their squares. */
static double compare_colors(double parts[3], const RetexEquations *sums, const double *aim, const double color[3])
{
    double wanted[3], lab[3];
    for (int c = 0; c < 3; c++)
        wanted[c] = aim ? aim[c] : sums->wanted[c] / fmax(sums->pixels[c], 1);
    retex_lab(wanted, wanted);
    retex_lab(lab, color);
    retex_delta_e_parts(parts, wanted, lab);
    return parts[0] * parts[0] + parts[1] * parts[1] + parts[2] * parts[2];
}

/* The equations of the mean in place of those of blocks. */
static void gather_mean(Normal *normal, const RetexEquations *sums, const RetexSolveModel *m, int numbers,
                        const double *aim)
{
    double parts[3], ahead[3], rows[3][NUMBERS_MAX] = {{0}}, mean[3];
    for (int c = 0; c < 3; c++)
        mean[c] = mean_of(sums, c);
    *normal = (Normal){.n = numbers, .count = 3, .square = compare_colors(parts, sums, aim, mean)};
    for (int c = 0; c < 3; c++) {
        double moved[3] = {mean[0], mean[1], mean[2]};
        moved[c] += NUDGE;
        compare_colors(ahead, sums, aim, moved);
        for (int i = 0; i < m->ncolumns; i++)
            for (int k = 0; k < 3; k++)
                rows[k][m->columns[i].number[c]] +=
                    (ahead[k] - parts[k]) / NUDGE * sums->slope[c][i] / fmax(sums->pixels[c], 1);
    }
    for (int i = 0; i < numbers; i++)
        for (int k = 0; k < 3; k++) {
            normal->gradient[i] += parts[k] * rows[k][i];
            for (int j = 0; j < numbers; j++)
                normal->matrix[i][j] += rows[k][i] * rows[k][j];
        }
}

/* Whether a number changes the picture. */
static int has_effect(const Normal *normal, int i)
{
    return normal->matrix[i][i] > NO_EFFECT * normal->count;
}

/* The Cholesky factor of the matrix of the numbers that move, scaled to a diagonal of 1, to which `damping` is
 * added. */
static void factorize(double lower[NUMBERS_MAX][NUMBERS_MAX], const Normal *normal, const int *moves, double damping)
{
    for (int i = 0; i < normal->n; i++)
        for (int j = 0; j <= i; j++) {
            const double scale = sqrt(normal->matrix[i][i]) * sqrt(normal->matrix[j][j]);
            double sum = !moves[i] || !moves[j] ? i == j : normal->matrix[i][j] / scale + (i == j ? damping : 0);
            for (int k = 0; k < j; k++)
                sum -= lower[i][k] * lower[j][k];
            lower[i][j] = i == j ? sqrt(fmax(sum, 1e-300)) : sum / lower[j][j];
        }
}

/* x = the solution of the scaled equations with the right side x. */
static void substitute(double *x, double lower[NUMBERS_MAX][NUMBERS_MAX], int n)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            x[i] -= lower[i][k] * x[k];
        x[i] /= lower[i][i];
    }
    for (int i = n; i-- > 0;) {
        for (int k = i + 1; k < n; k++)
            x[i] -= lower[k][i] * x[k];
        x[i] /= lower[i][i];
    }
}

/* Numbers that may move: which change the picture, and do not press against the end of their range. */
static void find_moves(int *moves, const Search *s, const double *values)
{
    for (int i = 0; i < s->numbers; i++)
        moves[i] = has_effect(&s->normal, i) && !(values[i] <= 0 && s->normal.gradient[i] > 0) &&
                   !(values[i] >= s->most[i] && s->normal.gradient[i] < 0);
}

/* Three numbers of a mean leave many solutions: the one is taken for which values change least. */
static void prefer_near(Normal *normal, const int *moves, double damping)
{
    double most = 0;
    for (int i = 0; i < normal->n; i++)
        most = moves[i] ? fmax(most, normal->matrix[i][i]) : most;
    for (int i = 0; i < normal->n; i++)
        normal->matrix[i][i] += damping * most;
}

/* Values after a step; returns the largest change. */
static double take_step(double *next, Search *s, const double *values, double damping)
{
    double step[NUMBERS_MAX], most = 0;
    int moves[NUMBERS_MAX] = {0};
    find_moves(moves, s, values);
    if (s->params->mean)
        prefer_near(&s->normal, moves, damping);
    factorize(s->lower, &s->normal, moves, s->params->mean ? 0 : damping);
    for (int i = 0; i < s->numbers; i++)
        step[i] = moves[i] ? -s->normal.gradient[i] / sqrt(s->normal.matrix[i][i]) : 0;
    substitute(step, s->lower, s->numbers);
    for (int i = 0; i < s->numbers; i++) {
        const double change = moves[i] ? step[i] / sqrt(s->normal.matrix[i][i]) : 0;
        const double least = s->params->mean && values[i] > DARK ? values[i] * LESSENS : 0;
        next[i] = fmin(fmax(values[i] + change, least), s->most[i]);
        most = fmax(most, fabs(next[i] - values[i]));
    }
    return most;
}

static int evaluate(Search *s, Point *point, RetexSolveRows rows, RetexError *err)
{
    return retex_equations_make(&point->sums, &s->model, point->values, rows, s->nthreads, err);
}

/* What is minimised. */
static double square_of(const Search *s, const RetexEquations *sums)
{
    double parts[3], mean[3] = {mean_of(sums, 0), mean_of(sums, 1), mean_of(sums, 2)};
    return s->params->mean ? compare_colors(parts, sums, s->aim, mean)
                           : sums->square[0] + sums->square[1] + sums->square[2];
}

static double first_color(double value)
{
    return fmin(fmax(value, 0.05), 0.95);
}

/* Goes from s->here to the nearest minimum. */
static int descend(Search *s, RetexSolveRows rows, RetexError *err)
{
    double damping = 1e-3;
    int code = evaluate(s, &s->here, rows, err);
    for (int step = 0; step < STEPS_MAX && !code && damping < 1e8; step++) {
        if (s->params->mean)
            gather_mean(&s->normal, &s->here.sums, &s->model, s->numbers, s->aim);
        else
            gather(&s->normal, &s->here.sums, &s->model, s->numbers);
        const double square = s->normal.square;
        if (take_step(s->next.values, s, s->here.values, damping) < 1e-6)
            break;
        code = evaluate(s, &s->next, rows, err);
        const double reached = square_of(s, &s->next.sums);
        if (!code && reached < square) {
            s->here = s->next;
            damping = fmax(damping / 30, 1e-9);
            if (square - reached <= SAME * square)
                break;
        } else {
            damping *= 10;
        }
    }
    if (!code)
        gather(&s->normal, &s->here.sums, &s->model, s->numbers);
    return code;
}

/* ---- means ---- */

/* The colour between low and high that is nearest to what is wanted: on a grid of cube roots, and on finer ones about
 * the best. Returns the square of the difference. */
static double find_nearest(double nearest[3], const double low[3], const double high[3], const RetexEquations *sums)
{
    double begin[3], end[3], least = HUGE_VAL;
    for (int c = 0; c < 3; c++)
        begin[c] = cbrt(low[c]), end[c] = cbrt(high[c]);
    for (int round = 0; round < 5; round++) {
        double best[3] = {0};
        for (int k = 0; k < SIDE * SIDE * SIDE; k++) {
            const int at[3] = {k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE};
            double root[3], color[3], parts[3];
            for (int c = 0; c < 3; c++) {
                root[c] = begin[c] + (end[c] - begin[c]) * at[c] / (SIDE - 1);
                color[c] = root[c] * root[c] * root[c];
            }
            const double square = compare_colors(parts, sums, NULL, color);
            if (square >= least)
                continue;
            least = square;
            memcpy(best, root, sizeof best);
            memcpy(nearest, color, sizeof color);
        }
        for (int c = 0; c < 3 && best[0] + best[1] + best[2] > 0; c++) {
            const double step = (end[c] - begin[c]) * 2 / (SIDE - 1);
            begin[c] = fmax(best[c] - step, cbrt(low[c]));
            end[c] = fmin(best[c] + step, cbrt(high[c]));
        }
    }
    return least;
}

/* What of the means that colours can make where lamps have these values is nearest: colours make all between what the
 * darkest and the brightest make, by channel. */
static int find_mean(Search *s, const double *values, RetexSolveRows rows, double nearest[3], double *square,
                     RetexError *err)
{
    double ends[2][3];
    int code = RETEX_OK;
    for (int end = 0; end < 2 && !code; end++) {
        memcpy(s->next.values, values, sizeof s->next.values);
        for (int j = 0; j < s->model.ncolumns; j++)
            for (int c = 0; c < 3 && s->model.columns[j].target >= 0; c++)
                s->next.values[s->model.columns[j].number[c]] = end;
        code = evaluate(s, &s->next, rows, err);
        for (int c = 0; c < 3 && !code; c++)
            ends[end][c] = fmax(mean_of(&s->next.sums, c), 0);
    }
    if (!code)
        *square = find_nearest(nearest, ends[0], ends[1], &s->next.sums);
    return code;
}

/* CIEDE2000 has several minima, for hue turns either way. Where the mean is not met, it is looked for among all that
 * can be made, with lamps of many strengths, one after the other. */
static int begin_elsewhere(Search *s, RetexSolveRows rows, RetexError *err)
{
    double values[NUMBERS_MAX], aim[3], least = HUGE_VAL;
    const double reached = s->params->mean ? square_of(s, &s->here.sums) : 0;
    int code = RETEX_OK;
    if (reached <= MET)
        return RETEX_OK;
    memcpy(values, s->first, sizeof values);
    for (int j = 0; j < 2 * s->model.ncolumns && !code; j++) {
        const RetexSolveColumn *column = &s->model.columns[j % s->model.ncolumns];
        for (int c = 0; c < 3 && column->target < 0 && !code && (!c || column->number[c] != column->number[0]); c++) {
            double *value = &values[column->number[c]], best = *value, square = HUGE_VAL;
            least = HUGE_VAL;
            for (int k = 0; k <= STRENGTHS && !code; k++) {
                *value = k ? pow(10, (k - STRENGTHS / 2) / 4.) : 0;
                code = find_mean(s, values, rows, aim, &square, err);
                best = square < least ? *value : best;
                least = fmin(square, least);
            }
            *value = best;
        }
    }
    if (!code)
        code = find_mean(s, values, rows, aim, &least, err);
    s->kept = s->here;
    memcpy(s->here.values, values, sizeof values);
    s->aim = aim;
    if (!code)
        code = descend(s, rows, err);
    s->aim = NULL;
    if (!code)
        code = descend(s, (RetexSolveRows){1, 1}, err);
    if (!code && square_of(s, &s->here.sums) >= reached)
        s->here = s->kept;
    gather(&s->normal, &s->here.sums, &s->model, s->numbers);
    return code;
}

/* ---- finishes ---- */

static int set_combination(Search *s, int combination, RetexError *err)
{
    s->model.combine.parameters = s->parameters;
    return retex_unknowns_parameters(s->solution, s->model.set, s->params->lights, combination, s->parameters, err);
}

/* Tries all combinations of finishes on some rows; s->here is that of the best one. */
static int choose(Search *s, RetexSolveRows rows, int *best, RetexError *err)
{
    double values[NUMBERS_MAX];
    int code = RETEX_OK;
    *best = 0;
    memcpy(values, s->first, sizeof values);
    for (int k = 0; k < s->solution->combinations && !code; k++) {
        code = set_combination(s, k, err);
        memcpy(s->here.values, s->first, sizeof s->first);
        if (!code)
            code = descend(s, rows, err);
        if (!code && s->normal.count == 0 && (rows.band > 1 || rows.step > 1))
            return choose(s, (RetexSolveRows){1, 1}, best, err); /* no pixel of these rows counts */
        s->counted = s->normal.count;
        s->squares[k] = s->normal.square + (s->params->mean ? s->counted * square_of(s, &s->here.sums) : 0);
        if (!k || s->squares[k] < s->squares[*best]) {
            *best = k;
            memcpy(values, s->here.values, sizeof values);
        }
    }
    memcpy(s->here.values, values, sizeof values);
    return code ? code : set_combination(s, *best, err);
}

/* What is known of a finish: the nearest combination that has another one. */
static void describe_finish(Search *s, int i, int best)
{
    const RetexTarget *target = &s->model.set->targets[s->solution->index[i]];
    RetexUnknown *u = &s->solution->unknowns[i];
    const int finish = retex_unknowns_finish(s->solution, s->model.set, i, best);
    int next = -1;
    for (int k = 0; k < s->solution->combinations; k++)
        if (retex_unknowns_finish(s->solution, s->model.set, i, k) != finish &&
            (next < 0 || s->squares[k] < s->squares[next]))
            next = k;
    strcpy(u->finish, target->finishes[finish]);
    strcpy(u->next, target->finishes[retex_unknowns_finish(s->solution, s->model.set, i, next)]);
    const double ratio = s->squares[next] / fmax(s->squares[best], 1e-30);
    u->next_ratio = sqrt(fmax(ratio, 1));
    u->seen = s->counted * log(fmax(ratio, 1)) > SURE;
}

/* ---- errors ---- */

/* Standard errors of all numbers, of those that the ends of their ranges hold too, where what is left has a root mean
 * square of 1; infinite where there is no effect. */
static void find_errors(Search *s, double errors[NUMBERS_MAX])
{
    const Normal *normal = &s->normal;
    int moves[NUMBERS_MAX] = {0};
    for (int i = 0; i < normal->n; i++)
        moves[i] = has_effect(normal, i);
    factorize(s->lower, normal, moves, 1e-12);
    for (int i = 0; i < normal->n; i++) {
        double column[NUMBERS_MAX] = {0};
        column[i] = 1;
        substitute(column, s->lower, normal->n);
        errors[i] = moves[i] ? sqrt(fmax(column[i], 0) / normal->matrix[i][i]) : HUGE_VAL;
    }
}

static void describe(Search *s, int best)
{
    double errors[NUMBERS_MAX];
    const double rms = sqrt(s->normal.square / fmax(s->normal.count - s->numbers, 1));
    find_errors(s, errors);
    for (int i = 0; i < s->solution->count; i++) {
        RetexUnknown *u = &s->solution->unknowns[i];
        const RetexSolveColumn *column = &s->model.columns[s->solution->column[i] < 0 ? 0 : s->solution->column[i]];
        if (u->kind == RETEX_UNKNOWN_FINISH) {
            describe_finish(s, i, best);
            continue;
        }
        u->seen = 1;
        for (int c = 0; c < 3; c++) {
            const int k = column->number[c];
            u->value[c] = s->here.values[k] < TINY ? 0 : s->here.values[k];
            u->error[c] = errors[k] * rms;
            u->limited |= u->value[c] <= 0 || u->value[c] >= s->most[k];
            u->seen &= s->params->mean
                           ? errors[k] < HUGE_VAL
                           : errors[k] * fmin(rms, NOISE_MAX * s->model.block) <= VAGUE * fmax(u->value[c], 1);
        }
    }
}

/* ---- all of it ---- */

static int check_picture(Search *s, const RetexImage *picture, RetexError *err)
{
    const RetexSet *set = s->model.set;
    const RetexSolveParams *p = s->params;
    RetexCombineParams *in = &s->model.combine;
    const int all = !p->x0 && !p->y0 && !p->x1 && !p->y1;
    in->x0 = p->x0, in->y0 = p->y0;
    in->x1 = all ? set->width : p->x1, in->y1 = all ? set->height : p->y1;
    in->cross = p->cross;
    if (picture->width != set->width || picture->height != set->height || picture->channels < 3)
        return retex_fail(err, RETEX_EINVAL, "the picture has %d x %d pixels, the set %d x %d", picture->width,
                          picture->height, set->width, set->height);
    if (in->x0 < 0 || in->y0 < 0 || in->x1 > set->width || in->y1 > set->height || in->x0 >= in->x1 || in->y0 >= in->y1)
        return retex_fail(err, RETEX_EINVAL, "the region %d,%d to %d,%d is not within the picture of %d x %d pixels",
                          in->x0, in->y0, in->x1, in->y1, set->width, set->height);
    return RETEX_OK;
}

/* Begins with what another solution found. */
static void begin_with(Search *s, const RetexSolution *start)
{
    for (int i = 0; i < s->solution->count; i++)
        for (int k = 0; k < start->count && s->solution->column[i] >= 0; k++)
            for (int c = 0; c < 3 && start->index[k] == s->solution->index[i] && start->unknowns[k].seen &&
                            start->unknowns[k].kind == s->solution->unknowns[i].kind;
                 c++)
                s->first[s->model.columns[s->solution->column[i]].number[c]] = start->unknowns[k].value[c];
}

/* Colours begin as the mean original, lamps as rendered. */
static void begin(Search *s)
{
    for (int j = 0; j < s->model.ncolumns; j++) {
        const RetexSolveColumn *column = &s->model.columns[j];
        for (int c = 0; c < 3; c++) {
            const int k = column->number[c];
            const RetexTarget *target = column->target < 0 ? NULL : &s->model.set->targets[column->target];
            s->first[k] = target ? first_color((double)target->mean_albedo[c]) : 1;
            s->most[k] = target ? 1 : RETEX_SOLVE_LAMP_MAX;
        }
    }
}

/* Some rows, of about COARSE_NUMBERS pixels. */
static RetexSolveRows coarse_rows(const Search *s)
{
    const RetexCombineParams *in = &s->model.combine;
    const double ratio = (double)(in->x1 - in->x0) * (in->y1 - in->y0) / COARSE_NUMBERS;
    const int step = ratio >= 4 ? 4 : ratio > 2 ? 2 : 1, bands = (in->y1 - in->y0) / 16;
    const int band = (int)fmin(fmax(ratio / step, 1), fmax(bands / 8, 1)); /* of at least eight bands */
    return (RetexSolveRows){band, step};
}

static int solve(Search *s, const RetexImage *picture, RetexError *err)
{
    const RetexSolveRows all = {1, 1}, coarse = coarse_rows(s);
    int best = 0, code = measure(&s->model, picture, err);
    if (!code)
        code = retex_unknowns_open(s->solution, &s->model, s->params, &s->numbers, err);
    begin(s);
    if (!code && s->params->start)
        begin_with(s, s->params->start);
    if (!code)
        code = choose(s, coarse, &best, err);
    if (!code)
        code = descend(s, all, err);
    if (!code)
        code = begin_elsewhere(s, coarse, err);
    if (!code)
        describe(s, best);
    return code;
}

int retex_solve(RetexSolution **solution, const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                const RetexImage *picture, const RetexSolveParams *params, int nthreads, RetexError *err)
{
    RetexSolveParams own = RETEX_SOLVE_INIT;
    *solution = NULL;
    if (RETEX_PARAMS_COPY(&own, params, err))
        return RETEX_EINVAL;
    Search *s = calloc(1, sizeof *s);
    RetexSolution *made = calloc(1, sizeof *made);
    int code = s && made ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to solve");
    if (!code) {
        *s = (Search){.solution = made, .params = &own, .nthreads = nthreads};
        s->model = (RetexSolveModel){.set = set, .textures = textures, .budget = own.budget};
        s->model.combine = (RetexCombineParams)RETEX_COMBINE_INIT;
        code = check_picture(s, picture, err);
    }
    if (!code)
        code = solve(s, picture, err);
    free(s);
    if (code)
        retex_solution_close(&made);
    *solution = made;
    return code;
}
