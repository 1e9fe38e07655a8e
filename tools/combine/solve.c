/* --solve: which parameters come nearest to a picture. See job.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "combine/job.h"

#define CLIPPED 0.98 /* from where values of a picture that has none above 1 may have been clipped */
#define PSNR_MAX 120.0
#define MEMORY ((uint64_t)8192 << 20) /* of the set, unless --memory says otherwise: it is read some twenty times */

/* From where other beginnings are tried. */
#define FAR 2.5e-5       /* mean square of encoded colours: a PSNR of 46 dB */
#define FAR_COLOR 0.0025 /* square of CIEDE2000 */
#define NEARER 0.9       /* of the distance */

int job_solve_is_color(const Job *job)
{
    float color[3];
    return retex_color_parse(color, job->solve, NULL) != RETEX_ENOTFOUND;
}

/* ---- the picture ---- */

static int fill_color(RetexImage *picture, const Job *job, RetexError *err)
{
    const RetexSetInfo info = retex_set_info(job->set);
    float color[3];
    int code = retex_color_parse(color, job->solve, err);
    if (!code)
        code = retex_image_alloc(picture, info.width, info.height, 3, err);
    for (size_t i = 0; !code && i < retex_image_index(picture, 0, picture->height); i++)
        picture->pixels[i] = color[i % 3];
    return code;
}

/* Removes pixels that may be clipped or are transparent: they do not count. A picture with values above 1 is
 * scene-linear. */
static long mask(RetexImage *picture)
{
    const size_t count = retex_image_index(picture, 0, picture->height);
    float highest = 0;
    long masked = 0;
    for (size_t i = 0; i < count; i++)
        if (i % 4 < 3)
            highest = fmaxf(highest, picture->pixels[i]);
    for (size_t i = 0; i < count; i += 4) {
        float *p = picture->pixels + i;
        if (p[3] < 1 || (highest <= 1 && fmaxf(p[0], fmaxf(p[1], p[2])) >= (float)CLIPPED)) {
            p[0] = p[1] = p[2] = NAN;
            masked++;
        }
    }
    return masked;
}

static int read_picture(const Cli *cli, RetexImage *picture, const Job *job, RetexError *err)
{
    const RetexSetInfo info = retex_set_info(job->set);
    RetexReadParams read = RETEX_READ_INIT;
    if (job_solve_is_color(job))
        return fill_color(picture, job, err);
    read.access = &cli->access;
    read.budget = cli->budget;
    read.warn = cli_warn_text;
    read.warn_context = (void *)cli;
    int code = retex_image_read(picture, job->solve, &read, cli->threads, err);
    if (!code && (picture->width != info.width || picture->height != info.height))
        return retex_fail(err, RETEX_EINVAL, "%s has %d x %d pixels, the set %d x %d", job->solve, picture->width,
                          picture->height, info.width, info.height);
    const long masked = code ? 0 : mask(picture);
    if (masked)
        cli_info(cli, "%ld pixels of %s are clipped or transparent and do not count", masked, job->solve);
    return code;
}

/* ---- what is found ---- */

static void print_quoted(const char *text)
{
    putchar('\'');
    for (; *text; text++)
        if (*text == '\'')
            fputs("'\\''", stdout);
        else
            putchar(*text);
    putchar('\'');
}

/* A statement of an edit as an option: `light:` and `finish:` are options of their own. */
static void print_option(const char *statement)
{
    static const char *const kinds[2][2] = {{"light:", "--light "}, {"finish:", "--finish "}};
    for (int k = 0; k < 2; k++)
        if (strncmp(statement, kinds[k][0], strlen(kinds[k][0])) == 0) {
            fputs(kinds[k][1], stdout);
            print_quoted(statement + strlen(kinds[k][0]));
            return;
        }
    fputs("--texture ", stdout);
    print_quoted(statement);
}

static void print_unknown(const RetexUnknown *u)
{
    static const char *const prefixes[] = {"", "light:", "color:", "finish:"};
    const double *v = u->value, *e = u->error;
    printf("%s%s: ", prefixes[u->kind], u->name);
    if (u->kind == RETEX_UNKNOWN_FINISH)
        printf("%s%s; with %s %.4g times the difference\n", u->seen ? "" : "not seen, perhaps ", u->finish, u->next,
               u->next_ratio);
    else if (!u->seen)
        puts("not seen");
    else if (u->kind == RETEX_UNKNOWN_LAMP)
        printf("%.4g +- %.2g%s\n", v[0], e[0], u->limited ? ", at the end of its range" : "");
    else
        printf("%.4g %.4g %.4g +- %.2g %.2g %.2g%s\n", v[0], v[1], v[2], e[0], e[1], e[2],
               u->limited ? ", at the end of its range" : "");
}

static int print_solution(const RetexSolution *solution, RetexError *err)
{
    const RetexUnknown *unknown;
    RetexEdit *edit = NULL;
    char *text = NULL;
    int code = retex_edit_create(&edit, err);
    if (!code)
        code = retex_solution_edit(solution, edit, err);
    if (!code)
        code = retex_edit_text(edit, ';', &text, err);
    if (!code && *text)
        puts(text);
    for (char *at = text, *next; !code && at && *at; at = next) {
        if ((next = strchr(at, ';')))
            *next++ = '\0';
        print_option(at);
        putchar(next ? ' ' : '\n');
    }
    for (int i = 0; !code && (unknown = retex_solution_unknown(solution, i)); i++)
        print_unknown(unknown);
    free(text);
    retex_edit_close(&edit);
    return code;
}

/* ---- how near it is ---- */

static double encoded(float value)
{
    return retex_srgb_encode(fmin(fmax((double)value, 0), 1));
}

/* How near a picture is in the region. */
typedef struct Difference {
    double square, encoded_square; /* means */
    double means[3];               /* of the picture that was made */
    double count;                  /* of pixels that count */
} Difference;

static Difference measure(const Job *job, const RetexImage *made, const RetexImage *picture)
{
    const int *r = job->region, x1 = r[2] ? r[0] + r[2] : made->width, y1 = r[2] ? r[1] + r[3] : made->height;
    Difference d = {0, 0, {0, 0, 0}, 0};
    for (int y = r[1]; y < y1; y++)
        for (int x = r[0]; x < x1; x++) {
            const float *a = made->pixels + retex_image_index(made, x, y);
            const float *b = picture->pixels + retex_image_index(picture, x, y);
            if (!isfinite(b[0]) || !isfinite(b[1]) || !isfinite(b[2]))
                continue;
            d.count++;
            for (int c = 0; c < 3; c++) {
                const double linear = (double)a[c] - (double)b[c], shown = encoded(a[c]) - encoded(b[c]);
                d.square += linear * linear;
                d.encoded_square += shown * shown;
                d.means[c] += (double)a[c];
            }
        }
    d.square /= 3 * d.count;
    d.encoded_square /= 3 * d.count;
    for (int c = 0; c < 3; c++)
        d.means[c] /= d.count;
    return d;
}

static double color_difference(const Difference *d, const float *color)
{
    double lab[3], wanted[3], linear[3];
    for (int c = 0; c < 3; c++)
        linear[c] = (double)color[c];
    retex_lab(lab, d->means);
    retex_lab(wanted, linear);
    return retex_delta_e(lab, wanted);
}

static void print_difference(const Difference *d, const float *color /* or NULL */)
{
    printf("difference: %.4g rms, PSNR %.2f dB, %.0f pixels\n", sqrt(d->square),
           fmin(-10 * log10(fmax(d->encoded_square, 1e-13)), PSNR_MAX), d->count);
    if (!color)
        return;
    printf("mean: srgb(%.4f,%.4f,%.4f), CIEDE2000 %.2f\n", encoded((float)d->means[0]), encoded((float)d->means[1]),
           encoded((float)d->means[2]), color_difference(d, color));
}

/* ---- all of it ---- */

/* The picture with what was found. */
static int make_picture(const Cli *cli, Job *job, const RetexSolution *solution, KeptTextures *kept, RetexImage *made,
                        RetexError *err)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    RetexEdit *edit = NULL;
    int count = job->textures.count, code = retex_edit_create(&edit, err);
    memcpy(specs, job->textures.specs, sizeof specs);
    if (!code)
        code = retex_solution_edit(solution, edit, err);
    for (int i = 0; !code && i < retex_edit_count(edit) && count < RETEX_MAX_TARGETS; i++) {
        specs[count] = *retex_edit_texture(edit, i);
        texture_args_read_by(cli, &specs[count++]);
    }
    if (!code)
        code = retex_edit_complete_lights(edit, job->lights, err);
    if (!code)
        code = job_light(job, edit, err);
    if (!code)
        code = kept_textures_load(kept, job->set, specs, count, cli->threads, err);
    if (!code)
        code = retex_retexture(job->set, kept->textures, &job->combine, retex_image_keep_rows, made, cli->threads, err);
    retex_edit_close(&edit);
    return code;
}

/* What is solved, and what was found. */
typedef struct Solving {
    const RetexImage *picture;
    const KeptTextures *given; /* textures that are not sought */
    KeptTextures kept;
    RetexSolution *solution;
    RetexImage made;
    Difference difference;
    double far; /* how far it is: a mean square of encoded colours, or that of CIEDE2000 of the mean from a colour */
} Solving;

static double distance(const Job *job, const Difference *d, const RetexImage *picture)
{
    const double far = job_solve_is_color(job) ? color_difference(d, picture->pixels) : 0;
    return job_solve_is_color(job) ? far * far : d->encoded_square;
}

static int approach(const Cli *cli, Job *job, Solving *s, const RetexSolveParams *params, RetexError *err)
{
    int code = retex_image_alloc(&s->made, s->picture->width, s->picture->height, 3, err);
    if (!code)
        code = retex_solve(&s->solution, job->set, s->given->textures, s->picture, params, cli->threads, err);
    if (!code)
        code = make_picture(cli, job, s->solution, &s->kept, &s->made, err);
    if (!code)
        s->difference = measure(job, &s->made, s->picture);
    s->far = code ? 0 : distance(job, &s->difference, s->picture);
    return code;
}

static void close_solving(Solving *s)
{
    retex_solution_close(&s->solution);
    retex_image_free(&s->made);
    kept_textures_close(&s->kept);
}

/* What is sought, as retex_solve takes it. */
static void name_of(char *name, size_t size, const RetexUnknown *u)
{
    static const char *const prefixes[] = {"", "light:", "color:", "finish:"};
    snprintf(name, size, "%s%s", prefixes[u->kind], u->name);
}

static void take_nearer(Solving *best, Solving *other)
{
    const Solving worse = *best;
    if (!other->solution || !(other->far < NEARER * best->far))
        return;
    *best = *other;
    *other = worse;
}

/* All together may end in a minimum that is none of fewer: each is sought alone, and then all from there. Where one
 * alone still comes nearer, it is what was found, which is told. */
static int begin_again(const Cli *cli, Job *job, Solving *best, const RetexSolveParams *params, RetexError *err)
{
    char names[RETEX_UNKNOWNS_MAX + RETEX_MAX_TARGETS][RETEX_NAME_MAX + 16];
    Solving nearest = {.far = best->far / NEARER};
    int count = 0, number = -1, code = RETEX_OK;
    for (const RetexUnknown *u; (u = retex_solution_unknown(best->solution, count)); count++)
        name_of(names[count], sizeof names[count], u);
    for (int i = 0; i < count && count > 1 && !code; i++) {
        Solving alone = {.picture = best->picture, .given = best->given}, all = alone;
        RetexSolveParams one = *params, again = *params;
        one.unknowns = names[i];
        code = approach(cli, job, &alone, &one, err);
        again.start = alone.solution;
        if (!code && alone.far < best->far)
            code = approach(cli, job, &all, &again, err);
        if (!code)
            take_nearer(best, &all);
        number = !code && alone.far < NEARER * nearest.far ? i : number;
        if (!code)
            take_nearer(&nearest, &alone);
        close_solving(&alone);
        close_solving(&all);
    }
    if (!code && nearest.solution && nearest.far < NEARER * best->far) {
        cli_warn(cli, "--free %s alone comes nearer than all that is sought, and is what was found", names[number]);
        take_nearer(best, &nearest);
    }
    close_solving(&nearest);
    return code;
}

static int solve(const Cli *cli, Job *job, const RetexImage *picture, RetexImage *made, RetexError *err)
{
    const int *r = job->region, is_color = job_solve_is_color(job);
    const uint64_t memory = cli_memory(cli, job->memory == CLI_MEMORY_DEFAULT ? MEMORY : job->memory);
    RetexSolveParams params = RETEX_SOLVE_INIT;
    KeptTextures given = {.nimages = 0};
    Solving best = {.picture = picture, .given = &given};
    params.unknowns = job->unknowns;
    params.x0 = r[0], params.y0 = r[1], params.x1 = r[0] + r[2], params.y1 = r[1] + r[3];
    params.cross = job->combine.cross;
    params.lights = job->lights;
    params.budget = cli->budget;
    params.mean = is_color;
    int code = kept_textures_load(&given, job->set, job->textures.specs, job->textures.count, cli->threads, err);
    if (!code)
        code = retex_set_preload(job->set, NULL, memory, cli->threads, err);
    if (!code)
        code = approach(cli, job, &best, &params, err);
    if (!code && best.far > (is_color ? FAR_COLOR : FAR))
        code = begin_again(cli, job, &best, &params, err);
    if (!code)
        code = print_solution(best.solution, err);
    if (!code)
        print_difference(&best.difference, is_color ? picture->pixels : NULL);
    if (!code) {
        *made = best.made;
        best.made = (RetexImage){0};
    }
    kept_textures_close(&given);
    close_solving(&best);
    return code;
}

int job_solve(const Cli *cli, Job *job, double began)
{
    RetexImage picture = {0}, made = {0};
    RetexError err = {0};
    int code = read_picture(cli, &picture, job, &err);
    if (!code)
        code = solve(cli, job, &picture, &made, &err);
    if (!code && job->output)
        code = retex_image_write(&made, job->output, &job->write, cli->threads, &err);
    if (code)
        cli_fail(cli, &err);
    cli_info(cli, "%s%s%.2f s", job->output ? job->output : "", job->output ? ": " : "", retex_clock_seconds() - began);
    retex_image_free(&picture);
    retex_image_free(&made);
    return CLI_OK;
}
