/* retex-render: from a scene file to a set, a plain picture, or a picture with replaced textures. */
#include <retex/retex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <ctype.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <jansson.h>
#include "cli.h"
#include "texture_args.h"
#include "texture_table.h"
#include "film/film.h"
#include "integrate/guides.h"
#include "integrate/render.h"
#include "sdl/sdl.h"

enum {
    OPT_TARGET,
    OPT_LIST,
    OPT_REPLACE,
    OPT_VARIANTS,
    OPT_CONTROL,
    OPT_CONTROL_MODE,
    OPT_CONTROL_DATA,
    OPT_PLAIN,
    OPT_LAYOUT,
    OPT_CLUSTERS,
    OPT_ORDERS,
    OPT_STRICT_PAPER,
    OPT_SPP,
    OPT_SIZE,
    OPT_SEED,
    OPT_DEPTH,
    OPT_CROP,
    OPT_FILTER,
    OPT_AOV,
    OPT_AOV_DIR,
    OPT_INCLUDE,
    OPT_DECLARE,
    OPT_AMBIENT,
    OPT_STRICT,
    OPT_STATS,
    OPT_TRACE
};

static const CliOption options[] = {
    [OPT_TARGET] = {"target", 't', "NAME[=IDENT,…]",
                    "make what was #declared as IDENT (or NAME) target NAME; repeatable", 0},
    [OPT_LIST] = {"list-targets", 0, NULL, "print the identifiers that can be targets, with their share of the picture",
                  0},
    [OPT_REPLACE] = {"replace", 0, "NAME=IMAGE",
                     "put IMAGE on a target and render that: the truth of a retexture (opts as retex-sample --texture)",
                     1},
    [OPT_VARIANTS] = {"variants", 0, "FILE.csv",
                      "one --replace picture a row, as retex-combine --batch, up to 16 at once along the same paths",
                      0},
    [OPT_CONTROL] = {"control", 0, "SET", "with --replace: take the noise off that SET's picture tells of", 0},
    [OPT_CONTROL_MODE] = {"control-mode", 0, "MODE", "of --control: unbiased, halves or biased (unbiased)", 0},
    [OPT_CONTROL_DATA] = {"control-data", 0, "MODE", "add the parts that --control reads: biased or unbiased", 0},
    [OPT_PLAIN] = {"plain", 0, NULL, "the picture only, no set", 0},
    [OPT_LAYOUT] = {"layout", 0, "NAME", "statistics of the set: footprints or paper (footprints)", 0},
    [OPT_CLUSTERS] = {"clusters", 0, "K|S+B",
                      "clusters of footprints a pixel and target, in all, or sharp + broad ones (4, which is 3+1)", 0},
    [OPT_ORDERS] = {"orders", 0, "N", "highest number of target hits kept, 1 to 6 (6)", 0},
    [OPT_STRICT_PAPER] = {"strict-paper", 0, NULL, "drop the mixed terms of four and more hits, as the paper does", 0},
    [OPT_SPP] = {"spp", 0, "N", "samples a pixel (64)", 0},
    [OPT_SIZE] = {"size", 0, "WxH", "size of the picture (the scene's own shape, 640 wide)", 0},
    [OPT_SEED] = {"seed", 0, "N", "another number gives other noise (0)", 0},
    [OPT_DEPTH] = {"max-depth", 0, "N", "most segments of a path (16)", 0},
    [OPT_CROP] = {"crop", 0, "X,Y,W,H", "render this part of the picture only", 0},
    [OPT_FILTER] = {"filter", 0, "NAME", "pixel filter: box or gaussian (box)", 0},
    [OPT_AOV] = {"aov", 0, "LIST",
                 "add parts, of: beauty, depth, albedo, normal, position, uv, object, roughness, metallic, irradiance",
                 0},
    [OPT_AOV_DIR] = {"aov-dir", 0, "DIR", "write the beauty and those of --aov, or all, as DIR/NAME.exr and .png too",
                     0},
    [OPT_INCLUDE] = {"include", 'I', "DIR", "look for included files and images here too; repeatable", 0},
    [OPT_DECLARE] = {"declare", 'D', "NAME=VALUE",
                     "declare a number or a quoted string, or set clock, frame_number, initial_frame, final_frame, "
                     "before the scene is read; repeatable",
                     0},
    [OPT_AMBIENT] = {"ambient", 0, NULL, "let `ambient` give light", 0},
    [OPT_STRICT] = {"strict", 0, NULL, "what is not supported is an error", 0},
    [OPT_STATS] = {"stats", 0, "FILE.json", "write times, rays, paths and memory; - is standard output", 0},
    [OPT_TRACE] = {"trace-pixel", 0, "X,Y,S", "print the path of sample S of a pixel, step by step, and stop", 0},
    {0},
};

#define LIST_MAX 64

typedef struct Arguments {
    Cli *cli;
    RenderParams render;
    SdlOptions sdl;
    const char *scene, *stats, *variants, *control, *aov_dir;
    ControlMode control_mode;
    int seeded;
    TextureTable table;
    const char *targets[LIST_MAX], *includes[LIST_MAX], *declares[LIST_MAX];
    int ntargets, nincludes, ndeclares, nreplacements, list, trace[3], tracing;
    RetexTextureSpec replacements[RETEX_MAX_TARGETS];
    RenderVariant replaced;
    double uv_scales[RETEX_MAX_TARGETS][2]; /* once measured */
    int measured;
    RetexSet *control_set;
    char set_targets[RETEX_MAX_TARGETS][RETEX_NAME_MAX + 512]; /* its targets, as of -t */
    int named;                                                 /* -t was given */
} Arguments;

static void push(Cli *cli, const char **list, int *count, const char *what)
{
    if (*count == LIST_MAX)
        cli_die(cli, "more than %d of --%s", LIST_MAX, what);
    list[(*count)++] = cli->value;
}

/* N whole numbers with one separator; anything behind them is an error. */
static void numbers(Cli *cli, const CliOption *option, char separator, int count, int *out)
{
    const char *p = cli->value;
    for (int k = 0; k < count; k++) {
        char *end;
        long v = strtol(p, &end, 10);
        if (!isdigit((unsigned char)*p) || v < 0 || v > 1 << 24 || *end != (k + 1 < count ? separator : 0))
            cli_die(cli, "--%s wants %s, not `%s`", option->name, option->argument, cli->value);
        out[k] = (int)v;
        p = end + 1;
    }
}

static unsigned parse_aovs(Cli *cli)
{
    static const char *const names[] = {"depth",  "albedo",    "normal",   "position",   "uv",
                                        "object", "roughness", "metallic", "irradiance", "beauty"};
    enum { COUNT = sizeof names / sizeof *names };
    unsigned bits = 0;
    for (const char *name = cli->value;; name++) {
        size_t length = strcspn(name, ",");
        int k = 0;
        while (k < COUNT && (strlen(names[k]) != length || strncmp(names[k], name, length)))
            k++;
        if (k == COUNT)
            cli_die(
                cli,
                "--aov knows beauty,depth,albedo,normal,position,uv,object,roughness,metallic,irradiance, not `%.*s`",
                (int)length, name);
        if (k < COUNT - 1)
            bits |= 1u << k;
        name += length;
        if (!*name)
            return bits;
    }
}

static void parse_replace(Arguments *a)
{
    RetexError err;
    if (a->nreplacements == RETEX_MAX_TARGETS)
        cli_die(a->cli, "more than %d of --replace", RETEX_MAX_TARGETS);
    if (retex_texture_spec_parse(&a->replacements[a->nreplacements++], a->cli->modifiers, a->cli->value, &err))
        cli_die(a->cli, "--replace: %s", err.message);
}

/* 4 or 3+1: of K clusters a quarter, but at least one, is broad. */
static void parse_clusters(Arguments *a)
{
    int sharp, broad, used = 0;
    const char *text = a->cli->value;
    if (isdigit((unsigned char)text[0]) && sscanf(text, "%2d%n", &sharp, &used) == 1 && !text[used]) {
        broad = sharp < 8 ? 1 : sharp / 4;
        sharp -= broad;
    } else if (!isdigit((unsigned char)text[0]) || sscanf(text, "%2d+%2d%n", &sharp, &broad, &used) != 2 ||
               text[used]) {
        cli_die(a->cli, "--clusters wants a number, or two as in 3+1, not `%s`", text);
    }
    if (sharp < 1 || sharp > FILM_SHARP_MAX || broad < 1 || broad > FILM_BROAD_MAX)
        cli_die(a->cli, "--clusters wants 1 to %d sharp and 1 to %d broad ones, not `%s`", FILM_SHARP_MAX,
                FILM_BROAD_MAX, text);
    a->render.sharp = sharp, a->render.broad = broad;
}

/* Which of some names the value is. */
static int choose(const Cli *cli, const CliOption *o, int count, const char *const *names)
{
    char known[128] = "";
    for (int k = 0; k < count; k++) {
        if (!strcmp(cli->value, names[k]))
            return k;
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", k ? (k + 1 < count ? ", " : " and ") : "", names[k]);
    }
    cli_die(cli, "--%s knows %s, not `%s`", o->name, known, cli->value);
}

static void parse_choice(Arguments *a, const CliOption *o)
{
    Cli *cli = a->cli;
    if (o == &options[OPT_FILTER]) {
        a->render.gaussian = !strcmp(cli->value, "gaussian");
        if (!a->render.gaussian && strcmp(cli->value, "box"))
            cli_die(cli, "--filter knows box and gaussian, not `%s`", cli->value);
    } else {
        a->render.paper = !strcmp(cli->value, "paper");
        if (!a->render.paper && strcmp(cli->value, "footprints"))
            cli_die(cli, "--layout knows footprints and paper, not `%s`", cli->value);
    }
}

/* What begins like a number must be one: `A=1/3` would be a string that nobody meant. The built-ins are numbers. */
static void check_declare(const Cli *cli)
{
    static const char *const built_in[] = {"clock=", "frame_number=", "initial_frame=", "final_frame="};
    const char *value = strchr(cli->value, '=');
    int number = value && value[1] && strchr("0123456789.+-", value[1]);
    char *end;
    for (int k = 0; k < 4; k++)
        number |= !strncmp(cli->value, built_in[k], strlen(built_in[k]));
    if (!number)
        return;
    strtod(value + 1, &end);
    if (*end || end == value + 1)
        cli_die(cli, "--declare: expected NAME=NUMBER or NAME=\"TEXT\", not `%s`", cli->value);
}

static void parse_option(Arguments *a, const CliOption *o)
{
    Cli *cli = a->cli;
    RenderParams *r = &a->render;
    int size[2];
    switch (o - options) {
    case OPT_TARGET:
        push(cli, a->targets, &a->ntargets, o->name);
        a->named = 1;
        break;
    case OPT_LIST:
        a->list = 1;
        break;
    case OPT_REPLACE:
        parse_replace(a);
        break;
    case OPT_CONTROL:
        a->control = cli->value;
        break;
    case OPT_CONTROL_MODE:
        a->control_mode = (ControlMode)choose(cli, o, 3, (const char *const[]){"unbiased", "halves", "biased"});
        break;
    case OPT_CONTROL_DATA:
        r->control_data = 1 + choose(cli, o, 2, (const char *const[]){"biased", "unbiased"});
        break;
    case OPT_VARIANTS:
        a->variants = cli->value;
        break;
    case OPT_PLAIN:
        r->plain = 1;
        break;
    case OPT_LAYOUT:
    case OPT_FILTER:
        parse_choice(a, o);
        break;
    case OPT_CLUSTERS:
        parse_clusters(a);
        break;
    case OPT_ORDERS:
        r->orders = (int)cli_integer(cli, o, 1, RETEX_MAX_ORDERS);
        break;
    case OPT_STRICT_PAPER:
        r->strict_paper = 1;
        break;
    case OPT_SPP:
        r->spp = (int)cli_integer(cli, o, 1, 1 << 20);
        break;
    case OPT_SIZE:
        numbers(cli, o, 'x', 2, size);
        r->width = size[0], r->height = size[1];
        if (r->width < 1 || r->height < 1)
            cli_die(cli, "--size wants WxH, not `%s`", cli->value);
        break;
    case OPT_SEED:
        r->seed = (uint32_t)cli_integer(cli, o, 0, 0xffffffffL);
        a->seeded = 1;
        break;
    case OPT_DEPTH:
        r->max_depth = (int)cli_integer(cli, o, 1, 256);
        break;
    case OPT_CROP:
        numbers(cli, o, ',', 4, r->crop);
        if (r->crop[2] < 1 || r->crop[3] < 1)
            cli_die(cli, "--crop wants X,Y,W,H, not `%s`", cli->value);
        break;
    case OPT_AOV:
        r->aovs |= parse_aovs(cli);
        break;
    case OPT_AOV_DIR:
        a->aov_dir = cli->value;
        break;
    case OPT_INCLUDE:
        push(cli, a->includes, &a->nincludes, o->name);
        break;
    case OPT_DECLARE:
        check_declare(cli);
        push(cli, a->declares, &a->ndeclares, o->name);
        break;
    case OPT_AMBIENT:
        a->sdl.ambient = 1;
        break;
    case OPT_STRICT:
        a->sdl.strict = 1;
        break;
    case OPT_STATS:
        a->stats = cli->value;
        break;
    case OPT_TRACE:
        numbers(cli, o, ',', 3, a->trace);
        a->tracing = 1;
        break;
    default:
        break;
    }
}

static void scene_message(void *context, int level, const char *text)
{
    const Cli *cli = context;
    if (level > 0 || cli->verbose)
        cli_info(cli, "%s", text);
}

static void progress(void *context, double done)
{
    cli_progress(context, "render", done);
}

/* One more target, unless it is there. */
static void add_target(Arguments *a, const char *name)
{
    for (int k = 0; k < a->ntargets; k++)
        if (!strcasecmp(a->targets[k], name))
            return;
    a->targets[a->ntargets++] = name;
}

static void parse_arguments(Arguments *a)
{
    Cli *cli = a->cli;
    const CliOption *o;
    a->render = (RenderParams)RENDER_PARAMS_INIT;
    a->sdl = (SdlOptions)SDL_OPTIONS_INIT;
    while ((o = cli_next(cli))) {
        if (o != &cli_positional)
            parse_option(a, o);
        else if (a->scene)
            cli_die(cli, "one scene at a time: `%s` and `%s`", a->scene, cli->value);
        else
            a->scene = cli->value;
    }
    if (!a->scene)
        cli_die(cli, "which scene? (try --help)");
    if (a->variants)
        texture_table_open(&a->table, cli, a->variants);
    if ((a->nreplacements || a->variants) && !a->ntargets) { /* replacing names the targets */
        for (int k = 0; k < a->nreplacements; k++)
            a->targets[a->ntargets++] = a->replacements[k].target;
        for (int k = 0; k < a->table.ncolumns; k++)
            add_target(a, a->table.columns[k]);
    }
    if (a->nreplacements || a->variants)
        a->render.plain = 1;
    if (a->variants && cli->output)
        cli_die(cli, "--variants names its outputs itself: no -o");
    if (a->variants && (a->list || a->tracing || a->render.aovs || a->stats))
        cli_die(cli, "--variants makes pictures only: no --list-targets, --trace-pixel, --aov or --stats");
    if (a->control && (!a->nreplacements || a->variants))
        cli_die(cli, "--control goes with --replace: what is new in the picture?");
    if (a->control && (a->render.aovs || a->render.control_data))
        cli_die(cli, "--control makes a picture only: no --aov or --control-data");
    if (a->control && cli->output)
        texture_args_check_output(cli, a->control, cli->output);
    if (a->aov_dir && (a->list || a->tracing || a->variants || a->control))
        cli_die(cli,
                "--aov-dir goes with a render of its own: no --list-targets, --trace-pixel, --variants or --control");
    if (a->aov_dir && !a->render.aovs)
        a->render.aovs = AOV_ALL;
    const char *answer = a->list ? "list-targets" : a->tracing ? "trace-pixel" : NULL;
    if (answer && cli->output)
        cli_die(cli, "--%s goes to standard output: no -o", answer);
    if (answer && a->stats)
        cli_die(cli, "--%s makes no picture, so there are no --stats", answer);
    a->sdl.include_paths = a->includes, a->sdl.ninclude_paths = a->nincludes;
    a->sdl.declares = a->declares, a->sdl.ndeclares = a->ndeclares;
    a->sdl.message = scene_message, a->sdl.message_context = cli;
    a->sdl.width = a->render.width, a->sdl.height = a->render.height;
    a->render.nthreads = cli->threads;
    a->render.progress = progress, a->render.progress_context = cli;
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The set of --control. Its targets are those of the render, unless some are named: then it tells the most. */
static void read_control(Arguments *a)
{
    RetexError err;
    RetexSet *set = NULL;
    cli_input(a->cli, a->control, "a set, as from retex-render");
    if (retex_set_read(a->control, &set, NULL, a->cli->threads, &err))
        cli_fail(a->cli, &err);
    if (!set)
        cli_die(a->cli, "%s holds samples but no set", a->control);
    a->control_set = set;
    for (int k = 0; k < a->nreplacements; k++)
        if (set->ntargets && !a->named && retex_set_find_target(set, a->replacements[k].target) < 0)
            cli_die(a->cli, "--control %s: the set has no target `%s`", a->control, a->replacements[k].target);
    for (int t = 0; t < set->ntargets && !a->named; t++) {
        snprintf(a->set_targets[t], sizeof a->set_targets[t], "%s=%s", set->targets[t].name, set->targets[t].idents);
        a->targets[t] = a->set_targets[t];
        a->ntargets = t + 1;
    }
}

static int find_target(const Scene *scene, const char *name)
{
    int found = -1, count = 0;
    for (int k = 0; k < scene->ntargets; k++) {
        if (!strcmp(scene->targets[k].name, name))
            return k;
        if (!strcasecmp(scene->targets[k].name, name))
            found = k, count++;
    }
    return count == 1 ? found : -1;
}

/* Load a texture for target t; one that is asked for by its width needs the scale of the target's UV. */
static int load_texture(Arguments *a, const Scene *scene, int t, RetexTextureSpec *spec, RetexTexture **texture,
                        RetexError *err)
{
    if (retex_texture_spec_needs_scale(spec)) {
        if (!a->measured && render_uv_scales(scene, a->cli->threads, a->uv_scales, err))
            return err->code;
        a->measured = 1;
        memcpy(spec->uv_scale, a->uv_scales[t], sizeof spec->uv_scale);
    }
    return retex_texture_load(texture, spec, a->cli->threads, err);
}

/* Load replacement textures onto their targets. */
static void replace_textures(Arguments *a, Scene *scene, RetexTexture **loaded)
{
    RetexError err;
    for (int k = 0; k < a->nreplacements; k++) {
        int t = find_target(scene, a->replacements[k].target);
        if (t < 0)
            cli_die(a->cli, "--replace: `%s` is no target: name it with -t", a->replacements[k].target);
        if (a->replaced.textures[t])
            cli_die(a->cli, "--replace: `%s` is replaced twice", a->replacements[k].target);
        if (load_texture(a, scene, t, &a->replacements[k], &loaded[k], &err))
            cli_fail(a->cli, &err);
        a->replaced.textures[t] = loaded[k];
        a->render.variants = &a->replaced, a->render.nvariants = 1;
    }
}

/* The pictures of one traversal. */
typedef struct VariantRows {
    int count, lines[VARIANTS_MAX];
    const char *outputs[VARIANTS_MAX];
    RetexTextureSpec specs[VARIANTS_MAX][RETEX_MAX_TARGETS];
    int nspecs[VARIANTS_MAX];
} VariantRows;

/* Up to VARIANTS_MAX more rows, with their outputs looked at. */
static void read_rows(Arguments *a, VariantRows *rows)
{
    RetexError err;
    rows->count = 0;
    for (int k; (k = rows->count) < VARIANTS_MAX; rows->count++) {
        if (!texture_table_row(&a->table, a->cli, &rows->outputs[k], rows->specs[k], &rows->nspecs[k]))
            return;
        rows->lines[k] = a->table.row_line;
        texture_args_check_output(a->cli, a->scene, rows->outputs[k]);
        texture_args_check_output(a->cli, a->variants, rows->outputs[k]);
        for (int j = 0; j < rows->nspecs[k]; j++)
            if (!rows->specs[k][j].constant)
                texture_args_check_output(a->cli, rows->specs[k][j].image, rows->outputs[k]);
        if (retex_image_write_check(rows->outputs[k], NULL, &err))
            texture_table_fail_picture(&a->table, a->cli, &err);
    }
}

static void render_rows(Arguments *a, const Scene *scene, VariantRows *rows)
{
    RenderVariant variants[VARIANTS_MAX];
    RetexTexture *loaded[VARIANTS_MAX][RETEX_MAX_TARGETS] = {{NULL}};
    RetexImage pictures[VARIANTS_MAX] = {{0}};
    RenderStats stats;
    RetexError err;
    for (int k = 0; k < rows->count; k++) {
        variants[k] = a->replaced;
        a->table.row_line = rows->lines[k];
        for (int j = 0; j < rows->nspecs[k]; j++) {
            int t = find_target(scene, rows->specs[k][j].target);
            if (load_texture(a, scene, t, &rows->specs[k][j], &loaded[k][j], &err))
                texture_table_fail_picture(&a->table, a->cli, &err);
            variants[k].textures[t] = loaded[k][j];
        }
    }
    a->render.variants = variants, a->render.nvariants = rows->count;
    if (render_variants(pictures, scene, &a->render, &stats, &err))
        cli_fail(a->cli, &err);
    for (int k = 0; k < rows->count; k++) {
        a->table.row_line = rows->lines[k];
        if (retex_image_write(&pictures[k], rows->outputs[k], NULL, &err))
            texture_table_fail_picture(&a->table, a->cli, &err);
        retex_image_free(&pictures[k]);
        for (int j = 0; j < rows->nspecs[k]; j++)
            retex_texture_close(&loaded[k][j]);
    }
    cli_info(a->cli, "%d picture%s, %d samples: %.2f s", rows->count, rows->count == 1 ? "" : "s", a->render.spp,
             stats.render_seconds);
    if (stats.dropped)
        cli_warn(a->cli, "%ld contributions were not finite and left out", stats.dropped);
}

/* --variants: all rows of the table, so many at a time. The first lot is read before the scene is. */
static void render_table(Arguments *a, const Scene *scene, VariantRows *rows)
{
    for (; rows->count > 0; read_rows(a, rows))
        render_rows(a, scene, rows);
    texture_table_close(&a->table);
}

/* Every column is a target, and no two are the same. */
static void check_columns(Arguments *a, const Scene *scene)
{
    int taken[RETEX_MAX_TARGETS] = {0};
    for (int k = 0; k < a->table.ncolumns; k++) {
        int t = find_target(scene, a->table.columns[k]);
        if (t < 0)
            cli_die(a->cli, "--variants: `%s` is no target: name it with -t", a->table.columns[k]);
        if (taken[t]++)
            cli_die(a->cli, "--variants: target `%s` has two columns", a->table.columns[k]);
    }
}

typedef struct IdentShare {
    const char *name;
    double share;
} IdentShare;

static int compare_shares(const void *a, const void *b)
{
    const IdentShare *x = a, *y = b;
    return x->share < y->share ? 1 : x->share > y->share ? -1 : strcmp(x->name, y->name);
}

static void list_targets(Arguments *a, const Scene *scene)
{
    RetexError err;
    double *shares = calloc((size_t)scene->nidents + 1, sizeof *shares);
    IdentShare *list = calloc((size_t)scene->nidents + 1, sizeof *list);
    if (!shares || !list)
        cli_die(a->cli, "out of memory");
    if (render_ident_shares(scene, &a->render, shares, &err))
        cli_fail(a->cli, &err);
    for (int k = 0; k < scene->nidents; k++)
        list[k] = (IdentShare){scene->idents[k], shares[k]};
    qsort(list, (size_t)scene->nidents, sizeof *list, compare_shares);
    for (int k = 0; k < scene->nidents; k++)
        printf("%6.2f%%  %s\n", 100 * list[k].share, list[k].name);
    free(shares);
    free(list);
}

/* Before the work: whether the statistics have a place that is not the set's. */
static void check_stats(const Arguments *a, const char *output)
{
    RetexError err;
    if (!a->stats)
        return;
    if (!strcmp(a->stats, "-") && !strcmp(output, "-"))
        cli_die(a->cli, "the set and the --stats cannot both go to standard output");
    if (strcmp(a->stats, "-") && !strcmp(a->stats, output))
        cli_die(a->cli, "the set and the --stats cannot both be %s", output);
    if (strcmp(a->stats, "-") && retex_set_write_check(a->stats, &err))
        cli_die(a->cli, "--stats: %s", err.message);
}

static void write_stats(Arguments *a, const RenderStats *s, const RetexSet *set, double parse_seconds)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    json_t *j = json_pack(
        "{s:f, s:f, s:f, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:f}", "parse_seconds", parse_seconds, "build_seconds",
        s->build_seconds, "render_seconds", s->render_seconds, "paths", (json_int_t)s->paths, "segments",
        (json_int_t)s->segments, "shadow_rays", (json_int_t)s->shadow_rays, "dropped_samples", (json_int_t)s->dropped,
        "lights", (json_int_t)s->lights, "primitives", (json_int_t)s->primitives, "triangles", (json_int_t)s->triangles,
        "peak_memory_bytes", (json_int_t)usage.ru_maxrss * 1024, "folded", set->folded);
    char *text = j ? json_dumps(j, JSON_INDENT(2)) : NULL;
    RetexError err;
    json_decref(j);
    if (!text)
        cli_die(a->cli, "out of memory for the statistics");
    size_t length = strlen(text);
    text[length++] = '\n'; /* in place of the closing zero */
    int failed = retex_file_write(a->stats, text, length, &err);
    free(text);
    if (failed)
        cli_die(a->cli, "--stats: %s", err.message);
}

/* What an output's name asks for: a pack by its ending, a set where EXR can be one, else a picture. */
typedef enum OutputKind { OUTPUT_SET, OUTPUT_PACK, OUTPUT_PICTURE } OutputKind;

static OutputKind output_kind(const Arguments *a, const char *output)
{
    int exr = !strcmp(output, "-") || !strncmp(output, "/dev/", 5) || cli_ends_with(output, ".exr");
    if (cli_ends_with(output, ".retex"))
        return OUTPUT_PACK;
    return exr && (!a->render.plain || a->render.aovs || a->render.control_data) ? OUTPUT_SET : OUTPUT_PICTURE;
}

/* Before the work: whether the result can be written, and what of it would be lost. */
static void check_output(const Arguments *a, const char *output)
{
    RetexError err;
    struct stat scene, old;
    OutputKind kind = output_kind(a, output);
    if (strcmp(output, "-") && !stat(a->scene, &scene) && !stat(output, &old) && S_ISREG(old.st_mode) &&
        scene.st_dev == old.st_dev && scene.st_ino == old.st_ino)
        cli_die(a->cli, "the output %s would replace the scene", output);
    if (kind == OUTPUT_PICTURE ? retex_image_write_check(output, NULL, &err) : retex_set_write_check(output, &err))
        cli_fail(a->cli, &err);
    if (kind == OUTPUT_PICTURE && a->render.aovs && !a->aov_dir)
        cli_warn(a->cli, "%s holds the picture only: --aov needs .exr or .retex", output);
    if (kind == OUTPUT_PICTURE && !a->render.plain && a->ntargets)
        cli_warn(a->cli, "%s holds the picture only: a set needs .exr or .retex", output);
}

static void write_result(Arguments *a, RetexSet *set, const char *output)
{
    RetexError err;
    RetexStoreParams store = RETEX_STORE_INIT;
    RetexPackParams pack = RETEX_PACK_INIT;
    int code = 0;
    store.nthreads = pack.nthreads = a->cli->threads;
    switch (output_kind(a, output)) {
    case OUTPUT_PACK:
        code = retex_pack_write(set, output, &pack, NULL, &err);
        break;
    case OUTPUT_SET:
        code = retex_set_write(set, NULL, output, &store, &err);
        break;
    case OUTPUT_PICTURE:
        code = retex_image_write(&set->parts[0].image, output, NULL, &err);
        break;
    }
    if (code)
        cli_fail(a->cli, &err);
}

/* The least that the images of a render take; refused before it begins where the machine has not so much. */
static void check_memory(const Arguments *a, const Scene *scene)
{
    const RenderParams *r = &a->render;
    double width = r->crop[2] ? r->crop[2] : r->width ? r->width : scene->width;
    double height = r->crop[3] ? r->crop[3] : r->height ? r->height : scene->height;
    FilmParams film = {
        .orders = r->orders, .split = !r->plain, .paper = r->paper, .sharp = r->sharp, .broad = r->broad};
    double channels = (double)film_floats(&film, scene->ntargets) + 19 * (r->aovs != 0),
           memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    double bytes = width * height * channels * sizeof(float);
    if (memory > 0 && bytes > memory)
        cli_die(a->cli, "%.0fx%.0f pixels need %.1f GB of memory, this machine has %.1f: render parts with --crop",
                width, height, bytes / 1e9, memory / 1e9);
}

static void report(const Arguments *a, const RetexSet *set, const RenderStats *s)
{
    double seconds = s->render_seconds > 0 ? s->render_seconds : 1e-9;
    cli_info(a->cli, "%dx%d, %d samples: %.2f s, %.2f Mpaths/s, %.2f Mrays/s", set->width, set->height, set->spp,
             s->render_seconds, (double)s->paths / seconds * 1e-6,
             (double)(s->segments + s->shadow_rays) / seconds * 1e-6);
    if (s->dropped)
        cli_warn(a->cli, "%ld contributions were not finite and left out", s->dropped);
    if (set->nterms)
        cli_info(a->cli, "%d target%s, energy beyond order %d: %.4f%%", set->ntargets, set->ntargets == 1 ? "" : "s",
                 set->orders, 100 * set->folded);
}

/* --control: a picture from new samples and a set. */
static void render_controlled(Arguments *a, const Scene *scene, const char *output)
{
    RetexError err;
    RetexSet *set = a->control_set;
    RetexImage picture = {0};
    RenderStats stats;
    double distance;
    if (!a->seeded)
        a->render.seed = set->seed + 1;
    if (render_control(&picture, scene, &a->render, set, a->control_mode, &distance, &stats, &err))
        cli_die(a->cli, "--control %s: %s", a->control, err.message);
    if (distance > 8)
        cli_warn(a->cli, "--control %s: its picture is not this scene's as it was, %.0f standard deviations off",
                 a->control, distance);
    if (retex_image_write(&picture, output, NULL, &err))
        cli_fail(a->cli, &err);
    cli_info(a->cli, "%dx%d, %d samples: %.2f s", picture.width, picture.height, a->render.spp, stats.render_seconds);
    if (stats.dropped)
        cli_warn(a->cli, "%ld contributions were not finite and left out", stats.dropped);
    if (a->stats)
        write_stats(a, &stats, set, 0);
    retex_image_free(&picture);
    retex_set_close(&a->control_set);
}

/* A surface goes to the first target that names it: one that is left without any is a mistake. */
static void check_targets(const Arguments *a, const Scene *scene)
{
    int surfaces[RETEX_MAX_TARGETS] = {0};
    for (int k = 0; k < scene->nprimitives; k++) {
        const Primitive *p = &scene->primitives[k];
        if (p->target >= 0)
            surfaces[p->target]++;
        for (int f = 0; p->face_targets && f < p->mesh->ntextures; f++)
            if (p->face_targets[f] >= 0)
                surfaces[p->face_targets[f]]++;
    }
    for (int t = 0; t < scene->ntargets; t++)
        if (!surfaces[t])
            cli_warn(a->cli, "target `%s` has no surface%s", scene->targets[t].name,
                     t ? ": those it names belong to targets named before it" : "");
}

static int is_empty(const Scene *scene)
{
    const Rgb *background = &scene->background;
    return !scene->nprimitives && !scene->nlights && !scene->sky && !background->r && !background->g && !background->b;
}

int main(int argc, char **argv)
{
    Cli cli = {.tool = "retex-render",
               .usage = "[options] SCENE.pov",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1,
               .about = "Render a POV-Ray-style scene once and keep what retexturing needs: a set."};
    Arguments a = {.cli = &cli};
    RetexError err;
    Scene *scene = NULL;
    RetexSet *set = NULL;
    RetexTexture *loaded[RETEX_MAX_TARGETS] = {0};
    RenderStats stats;
    parse_arguments(&a);
    int needless = a.list || a.tracing || a.variants || (a.aov_dir && !cli.output && isatty(STDOUT_FILENO));
    const char *output = needless ? NULL : cli_output(&cli);
    VariantRows *rows = a.variants ? calloc(1, sizeof *rows) : NULL;
    if (rows)
        read_rows(&a, rows);
    if (output)
        check_output(&a, output), check_stats(&a, output);
    if (a.aov_dir && guides_check(a.aov_dir, &err))
        cli_die(&cli, "--aov-dir: %s", err.message);
    if (a.control)
        read_control(&a);
    double started = seconds();
    if (sdl_parse_file(&scene, a.scene, &a.sdl, &err))
        cli_fail(&cli, &err);
    if (scene_resolve_targets(scene, a.targets, a.ntargets, &err))
        cli_fail(&cli, &err);
    check_targets(&a, scene);
    if (is_empty(scene))
        cli_die(&cli, "%s: there is nothing in the scene: no object, no light, no sky", a.scene);
    if (!a.list)
        check_memory(&a, scene);
    replace_textures(&a, scene, loaded);
    check_columns(&a, scene);
    double parse_seconds = seconds() - started;
    int failed = 0;
    if (a.list)
        list_targets(&a, scene);
    else if (rows)
        render_table(&a, scene, rows);
    else if (a.control)
        render_controlled(&a, scene, output);
    else if (a.tracing)
        failed = render_trace(scene, &a.render, a.trace[0], a.trace[1], a.trace[2], stdout, &err);
    else
        failed = render_scene(&set, scene, &a.render, &stats, &err);
    if (failed)
        cli_fail(&cli, &err);
    if (set) {
        if (a.aov_dir && guides_write(set, a.aov_dir, &err))
            cli_fail(&cli, &err);
        if (output)
            write_result(&a, set, output);
        report(&a, set, &stats);
        if (a.stats)
            write_stats(&a, &stats, set, parse_seconds);
    }
    free(rows);
    retex_set_close(&set);
    scene_close(&scene);
    for (int k = 0; k < a.nreplacements; k++)
        retex_texture_close(&loaded[k]);
    return cli_close(&cli, CLI_OK);
}
