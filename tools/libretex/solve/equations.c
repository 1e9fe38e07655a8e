/* See equations.h.
 *
 * The derivative of a product of factors by a target's colour follows the product, factor by factor. That of a factor
 * is the difference between its row and that with a colour a little higher, of a second edit: but for further
 * hits, a factor is linear in the colour, and that is exact. */
#include "solve/equations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>

#include "retexture/edited.h"
#include "retexture/strips.h"
#include "set/set.h"
#include "solve/derivative_kernel.h"

#define HIGHER 0.00390625f /* by how much colours are higher */
#define BAND_ROWS 16       /* that a file compresses together */

typedef struct Evaluation {
    const RetexSolveModel *model;
    const double *values;
    RetexSolveRows rows;
    int ntargets; /* columns of targets, which come first */
    RetexEdited here;
    RetexEdited ahead[RETEX_MAX_TARGETS];                    /* by column, with a higher colour of its target */
    RetexTexture *textures[RETEX_MAX_TARGETS];                   /* by target, of those that are sought */
    RetexTexture *higher[RETEX_MAX_TARGETS];                     /* the same */
    RetexTexture *all[1 + RETEX_MAX_TARGETS][RETEX_MAX_TARGETS]; /* of each edit; borrowed */
    signed char *term_column; /* by term, the column of its lamp; -1: none is sought */
    float common[3];          /* what lamps that are sought have in common with those that are given, */
    int least[3];             /* and the parameter that has no more; see retex_edited_common */
    float values_of[RETEX_PARAMETERS_MAX][3]; /* parameters, with lamps as they are sought here */
    RetexEquations *strips;   /* by strip */
} Evaluation;

/* Memory of one strip. */
typedef struct StripRows {
    RetexViewReader ahead[RETEX_MAX_TARGETS];
    float **slopes;     /* by column and image of the view, of the row in slope_rows; allocated when needed */
    int *slope_rows;    /* the same: 1 + the row that is made; 0: none */
    float *value;       /* of a term */
    float *derivatives; /* of it, by column of targets */
    float *columns;     /* of the row, by column */
    double *blocks;     /* sums over blocks, three numbers each: see add_row */
} StripRows;

/* ---- opening ---- */

static int load_color(RetexTexture *textures[RETEX_MAX_TARGETS], const Evaluation *e, int column, float more,
                      RetexError *err)
{
    const RetexSolveColumn *c = &e->model->columns[column];
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *loaded[RETEX_MAX_TARGETS];
    spec.constant = 1;
    strcpy(spec.target, e->model->set->targets[c->target].name);
    for (int k = 0; k < 3; k++)
        spec.color[k] = (float)e->values[c->number[k]] + more;
    const int code = retex_textures_load(loaded, e->model->set, &spec, 1, 1, err);
    textures[c->target] = loaded[c->target];
    return code;
}

static int open_textures(Evaluation *e, RetexError *err)
{
    int code = RETEX_OK;
    for (int j = 0; j < e->ntargets && !code; j++) {
        code = load_color(e->textures, e, j, 0, err);
        if (!code)
            code = load_color(e->higher, e, j, HIGHER, err);
    }
    for (int p = 0; p <= e->ntargets; p++)
        for (int t = 0; t < RETEX_MAX_TARGETS; t++)
            e->all[p][t] = e->textures[t] ? e->textures[t] : e->model->textures[t];
    for (int j = 0; j < e->ntargets; j++)
        e->all[1 + j][e->model->columns[j].target] = e->higher[e->model->columns[j].target];
    return code;
}

static int open_edited(RetexEdited *edited, const Evaluation *e, int number, int nthreads, RetexError *err)
{
    const RetexSolveModel *m = e->model;
    const int code = retex_edited_open(edited, m->set, e->all[number], &m->combine,
                                       m->ncolumns > e->ntargets ? EDITED_LAMPS : EDITED_CORRECTED, nthreads, err);
    if (!code)
        edited->view.columns = (RetexRowSpan){m->combine.x0, m->combine.x1};
    RETEX_ASSERT(code || !number || edited->view.nimages == e->here.view.nimages); /* they differ in colours alone */
    return code;
}

/* The column of the lamp whose light, or the correction of that, a term is; -1: none is sought. */
static int find_lamp(const RetexSolveModel *m, const RetexTerm *term)
{
    for (int k = 0; k < term->nfactors; k++) {
        const RetexFactor factor = term->factors[k];
        const RetexParameter *of = factor.kind == RETEX_FACTOR_PARAMETER ? &m->set->parameters[factor.index] : NULL;
        if (!of || of->kind != RETEX_PARAMETER_COLOR)
            continue;
        for (int j = 0; j < m->ncolumns; j++)
            if (m->columns[j].target < 0 &&
                strcmp(m->columns[j].lamp, retex_set_has_finishes(m->set) ? of->lamp : of->name) == 0)
                return j;
    }
    return -1;
}

/* The column of a lamp that is sought, by its parameter; -1: it is none. */
static int find_parameter(const RetexSolveModel *m, int parameter)
{
    const RetexTerm term = {.nfactors = 1, .factors = {retex_factor(RETEX_FACTOR_PARAMETER, parameter)}};
    return find_lamp(m, &term);
}

/* What lamps have in common where they have the values of the columns. */
static void find_common(Evaluation *e)
{
    memcpy(e->values_of, e->here.parameters, sizeof e->values_of);
    for (int i = 0; i < e->model->set->nparameters; i++) {
        const int column = find_parameter(e->model, i);
        for (int c = 0; c < 3 && column >= 0; c++)
            e->values_of[i][c] *=
                (float)e->values[e->model->columns[column].number[c]] / (float)RETEX_SOLVE_LAMP_UNIT;
    }
    retex_edited_common(&e->here, e->values_of[0], e->common, e->least);
}

static int open_evaluation(Evaluation *e, int strips, int nthreads, RetexError *err)
{
    while (e->ntargets < e->model->ncolumns && e->model->columns[e->ntargets].target >= 0)
        e->ntargets++;
    e->term_column = malloc((size_t)e->model->set->nterms + 1);
    e->strips = calloc((size_t)strips, sizeof *e->strips);
    int code = e->term_column && e->strips ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to solve");
    if (!code)
        code = open_textures(e, err);
    if (!code)
        code = open_edited(&e->here, e, 0, nthreads, err);
    for (int j = 0; j < e->ntargets && !code; j++)
        code = open_edited(&e->ahead[j], e, 1 + j, nthreads, err);
    for (int t = 0; t < e->model->set->nterms && !code; t++)
        e->term_column[t] = (signed char)find_lamp(e->model, &e->model->set->terms[t]);
    if (!code)
        find_common(e);
    return code;
}

static void close_evaluation(Evaluation *e)
{
    retex_edited_close(&e->here);
    for (int j = 0; j < e->ntargets; j++)
        retex_edited_close(&e->ahead[j]);
    retex_textures_close(e->textures);
    retex_textures_close(e->higher);
    free(e->term_column);
    free(e->strips);
}

/* ---- a row ---- */

static void close_strip(StripRows *s, const Evaluation *e)
{
    const int count = e->here.view.nimages * e->ntargets;
    for (int j = 0; j < e->ntargets; j++)
        if (s->ahead[j].view)
            retex_view_reader_close(&s->ahead[j]);
    for (int i = 0; s->slopes && i < count; i++)
        free(s->slopes[i]);
    free(s->slopes);
    free(s->slope_rows);
    free(s->value);
    free(s->derivatives);
    free(s->columns);
    free(s->blocks);
}

static int open_strip(StripRows *s, const Evaluation *e, RetexError *err)
{
    const size_t numbers = 3 * (size_t)e->model->set->width;
    const size_t slopes = (size_t)(e->here.view.nimages * e->ntargets) + 1;
    int code = RETEX_OK;
    *s = (StripRows){.slopes = calloc(slopes, sizeof *s->slopes), .slope_rows = calloc(slopes, sizeof *s->slope_rows)};
    s->value = malloc(sizeof *s->value * numbers);
    s->derivatives = malloc(sizeof *s->derivatives * numbers * (size_t)(e->ntargets + 1));
    s->columns = malloc(sizeof *s->columns * numbers * (size_t)(e->model->ncolumns + 1));
    s->blocks = calloc(numbers * (size_t)(e->model->ncolumns + 3), sizeof *s->blocks);
    if (!s->slopes || !s->slope_rows || !s->value || !s->derivatives || !s->columns || !s->blocks)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to solve");
    for (int j = 0; j < e->ntargets && !code; j++)
        code = retex_view_reader_open(&s->ahead[j], &e->ahead[j].view, err);
    return code;
}

/* Whether what an image shows changes with the colour of a target. */
static int depends_on(const RetexView *view, int image, int target)
{
    const RetexViewImage *of = &view->images[image];
    int depends = of->kind == VIEW_FOOTPRINT && view->set->footprints[of->index].target == target;
    for (int k = 0; k < of->ninputs && of->kind != VIEW_GATE; k++)
        depends |= depends_on(view, of->inputs[k], target);
    return depends;
}

/* The derivative of an image's row by the colour of column j; NULL: it does not depend on that. */
static int slope_row(StripRows *s, const Evaluation *e, int image, const float *here, int j, int y, const float **slope,
                     RetexError *err)
{
    const size_t numbers = 3 * (size_t)e->model->set->width, at = (size_t)(image * e->ntargets + j);
    const float *ahead;
    *slope = NULL;
    if (!depends_on(&e->here.view, image, e->model->columns[j].target))
        return RETEX_OK;
    if (!s->slopes[at] && !(s->slopes[at] = malloc(sizeof **s->slopes * numbers)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to solve");
    if (s->slope_rows[at] != y + 1) {
        const int code = retex_view_row(&s->ahead[j], image, y, &ahead, NULL, err);
        if (code)
            return code;
        if (ahead)
            retex_row_slope(s->slopes[at], ahead, here, 1 / HIGHER, numbers);
        else
            memset(s->slopes[at], 0, sizeof **s->slopes * numbers);
        s->slope_rows[at] = y + 1;
    }
    *slope = s->slopes[at];
    return RETEX_OK;
}

/* What a term counts: all light as much as lamps have in common, a lamp's what it has beyond. slope: its derivative
 * by what they have in common. */
static void weigh(float weight[3], float slope[3], const Evaluation *e, const RetexTerm *term)
{
    const RetexSet *set = e->model->set;
    const int lamp = e->here.of == EDITED_LAMPS ? retex_set_term_lamp(set, term) : -1;
    for (int c = 0; c < 3; c++) {
        const int together = e->here.lamps && e->here.of == EDITED_LAMPS;
        const float kept = lamp < 0 ? 0 : set->parameters[lamp].kept[c];
        const float own = lamp < 0 ? 0 : e->here.parameters[lamp][c];
        weight[c] = !together  ? 1
                    : lamp < 0 ? e->common[c]
                    : own > 0  ? retex_edited_beyond(e->values_of[lamp][c], kept, e->common[c]) / own
                               : 0;
        slope[c] = !together ? 0 : lamp < 0 ? 1 : own > 0 ? -kept / own : 0;
    }
}

/* Adds the derivative by the lamp that lets the lamps have no more in common. */
static void add_common(StripRows *s, const Evaluation *e, const float slope[3], size_t first, size_t n)
{
    const RetexSolveModel *m = e->model;
    for (int c = 0; c < 3; c++) {
        const int column = e->least[c] < 0 ? -1 : find_parameter(m, e->least[c]);
        float weight[3] = {0};
        if (column < 0)
            continue;
        weight[c] = slope[c] * e->here.parameters[e->least[c]][c] /
                    (RETEX_SOLVE_LAMP_UNIT * m->set->parameters[e->least[c]].kept[c]);
        retex_row_add(s->columns + 3 * (size_t)m->set->width * (size_t)column + first, s->value, weight, n);
    }
}

/* Adds a term to the row's value, and its derivatives to those of the row. */
static int add_term(StripRows *s, const Evaluation *e, const RetexViewTerm *term, int y, float *sum, RetexError *err)
{
    const RetexViewProduct *product = term->product;
    const RetexRowSpan span = retex_span_intersection(term->span, e->here.view.columns);
    const size_t width = (size_t)e->model->set->width, first = 3 * (size_t)span.begin;
    const size_t n = retex_span_is_empty(span) ? 0 : 3 * (size_t)(span.end - span.begin);
    const int lamp = e->term_column[product->term];
    float weight[3], slope_of[3], unit[3];
    int moves[RETEX_MAX_TARGETS] = {0}, code = RETEX_OK;
    if (!n)
        return RETEX_OK;
    memcpy(s->value, term->rows[0] + first, sizeof *s->value * n);
    for (int k = 1; k < product->ninputs; k++) {
        for (int j = 0; j < e->ntargets; j++) {
            float *derivative = s->derivatives + 3 * width * (size_t)j;
            const float *slope;
            if ((code = slope_row(s, e, product->inputs[k], term->rows[k], j, y, &slope, err)))
                return code;
            if (slope && !moves[j]++)
                memset(derivative, 0, sizeof *derivative * n);
            if (slope)
                retex_derivative_multiply(derivative, s->value, term->rows[k] + first, slope + first, n);
            else if (moves[j])
                retex_row_multiply(derivative, term->rows[k] + first, n);
        }
        retex_row_multiply(s->value, term->rows[k] + first, n);
    }
    for (int c = 0; c < 3; c++)
        unit[c] = 1.f / RETEX_SOLVE_LAMP_UNIT;
    weigh(weight, slope_of, e, &e->model->set->terms[product->term]);
    retex_row_add(sum + first, s->value, weight, n);
    for (int j = 0; j < e->ntargets; j++)
        if (moves[j])
            retex_row_add(s->columns + 3 * width * (size_t)j + first, s->derivatives + 3 * width * (size_t)j, weight,
                          n);
    if (lamp >= 0)
        retex_row_add(s->columns + 3 * width * (size_t)lamp + first, s->value, unit, n);
    add_common(s, e, slope_of, first, n);
    return RETEX_OK;
}

/* Adds a row to the sums over blocks: of pixels that count, of the picture, of the difference, and of columns. */
static void add_row(StripRows *s, const RetexSolveModel *m, const float *value, int y)
{
    const size_t numbers = 3 * (size_t)m->set->width;
    for (int x = m->combine.x0; x < m->combine.x1; x++) {
        const float *picture = m->picture->pixels + retex_image_index(m->picture, x, y);
        if (!isfinite(picture[0]) || !isfinite(picture[1]) || !isfinite(picture[2]))
            continue;
        for (size_t c = 0; c < 3; c++) {
            const size_t i = 3 * (size_t)x + c;
            double *sums = s->blocks + (size_t)(m->ncolumns + 3) * (3 * (size_t)(x / m->block) + c);
            sums[0]++;
            sums[1] += (double)picture[c];
            sums[2] += (double)value[i] - (double)picture[c];
            for (int j = 0; j < m->ncolumns; j++)
                sums[3 + j] += (double)s->columns[numbers * (size_t)j + i];
        }
    }
}

/* Adds the blocks to the normal equations, and clears them. */
static void add_blocks(RetexEquations *sums, StripRows *s, const RetexSolveModel *m)
{
    for (int i = 0; i < 3 * ((m->set->width - 1) / m->block + 1); i++) {
        double *of = s->blocks + (size_t)(m->ncolumns + 3) * (size_t)i;
        const int c = i % 3;
        if (of[0] > 0) {
            const double scale = fabs(of[1] / of[0]) + m->dark, w = 1 / (of[0] * scale * scale);
            sums->count[c]++;
            sums->square[c] += w * of[2] * of[2];
            sums->pixels[c] += of[0];
            sums->wanted[c] += of[1];
            sums->difference[c] += of[2];
            for (int j = 0; j < m->ncolumns; j++) {
                sums->slope[c][j] += of[3 + j];
                sums->gradient[c][j] += w * of[2] * of[3 + j];
                for (int k = 0; k <= j; k++)
                    sums->matrix[c][j][k] += w * of[3 + j] * of[3 + k];
            }
        }
        memset(of, 0, sizeof *of * (size_t)(m->ncolumns + 3));
    }
}

/* The value of row y, and its derivatives. */
static int make_row(StripRows *s, const Evaluation *e, RetexViewReader *reader, int y, float *value, RetexError *err)
{
    const size_t numbers = 3 * (size_t)e->model->set->width;
    const float *picture = NULL;
    const RetexViewTerm *terms;
    int code = RETEX_OK, count;
    memset(value, 0, sizeof *value * numbers);
    memset(s->columns, 0, sizeof *s->columns * numbers * (size_t)e->model->ncolumns);
    if (e->here.picture) {
        code = retex_row_reader_get(reader->set, 0, y, &picture, err);
        if (!code && picture)
            memcpy(value, picture, sizeof *value * numbers);
        return code;
    }
    code = retex_view_terms(reader, e->here.sum, y, &terms, &count, err);
    for (int t = 0; t < count && !code; t++)
        code = add_term(s, e, &terms[t], y, value, err);
    return code;
}

static int sum_strip(const void *context, RetexViewReader *reader, int y0, int y1, float *rgb, RetexError *err)
{
    const Evaluation *e = context;
    StripRows s;
    int code = open_strip(&s, e, err);
    for (int y = y0; y < y1 && !code; y++) {
        if (y / BAND_ROWS % e->rows.band == 0 && y % e->rows.step == 0) {
            code = retex_budget_check(e->model->budget, err);
            if (!code)
                code = make_row(&s, e, reader, y, rgb, err);
            if (!code)
                add_row(&s, e->model, rgb, y);
        }
        if (!code && ((y + 1) % e->model->block == 0 || y + 1 == y1))
            add_blocks(&e->strips[y0 / RETEX_PICTURE_STRIP], &s, e->model);
    }
    close_strip(&s, e);
    return code;
}

static int no_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    (void)context, (void)y0, (void)y1, (void)rows, (void)err;
    return RETEX_OK;
}

static void add_strip(RetexEquations *sum, const RetexEquations *strip, int ncolumns)
{
    for (int c = 0; c < 3; c++) {
        sum->count[c] += strip->count[c];
        sum->square[c] += strip->square[c];
        sum->pixels[c] += strip->pixels[c];
        sum->wanted[c] += strip->wanted[c];
        sum->difference[c] += strip->difference[c];
        for (int i = 0; i < ncolumns; i++) {
            sum->slope[c][i] += strip->slope[c][i];
            sum->gradient[c][i] += strip->gradient[c][i];
            for (int j = 0; j <= i; j++)
                sum->matrix[c][i][j] += strip->matrix[c][i][j];
        }
    }
}

int retex_equations_make(RetexEquations *equations, const RetexSolveModel *model, const double *values,
                         RetexSolveRows rows, int nthreads, RetexError *err)
{
    Evaluation e = {.model = model, .values = values, .rows = rows};
    const int strips = (model->set->height + RETEX_PICTURE_STRIP - 1) / RETEX_PICTURE_STRIP;
    int code = open_evaluation(&e, strips, nthreads, err);
    if (!code)
        code = retex_view_strips(&e.here.view, model->combine.y0, model->combine.y1, sum_strip, &e, no_rows, NULL,
                                 nthreads, err);
    memset(equations, 0, sizeof *equations);
    for (int i = 0; i < strips && !code; i++)
        add_strip(equations, &e.strips[i], model->ncolumns);
    close_evaluation(&e);
    return code;
}
