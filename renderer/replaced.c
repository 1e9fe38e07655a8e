/* Renders with new textures: --replace, tables of pictures with --variants, and --control. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "render/first_hit.h"
#include "retex-render.h"

static RetexTargetNames target_names(const Scene *scene)
{
    RetexTargetNames names = {.count = scene->ntargets, .of = "the scene", .advice = "; name it with -t"};
    for (int k = 0; k < scene->ntargets; k++)
        names.names[k] = scene->targets[k].name, names.idents[k] = scene->targets[k].idents;
    return names;
}

/* Load a texture for target t. The option `width` of a texture needs the scale of the target's UV. */
static int load_texture(Arguments *a, const Scene *scene, int t, RetexTextureSpec *spec, RetexTexture **texture,
                        RetexError *err)
{
    const Target *target = &scene->targets[t];
    spec->nfinishes = target->nfinishes;
    for (int k = 0; k < target->nfinishes; k++)
        spec->roughness[k] = target_finish_roughness(target, k);
    spec->normal_tilt = target->has_normals ? NORMAL_TILT : 0;
    spec->unit = a->render.unit;
    if (retex_texture_spec_needs_scale(spec)) {
        if (!a->measured && render_uv_scales(scene, a->cli->threads, a->uv_scales, err))
            return err->code;
        a->measured = 1;
        memcpy(spec->uv_scale, a->uv_scales[t], sizeof spec->uv_scale);
        target_periodic(scene, t, spec->periodic);
    }
    return retex_texture_load(texture, spec, a->cli->threads, err);
}

int replace_textures(Arguments *a, const Scene *scene, RetexTexture **loaded, RetexError *err)
{
    const RetexTargetNames names = target_names(scene);
    for (int k = 0; k < a->nreplacements; k++) {
        RetexError why;
        int t, code = retex_target_find(&t, &names, a->replacements[k].target, &why);
        if (code)
            return retex_fail(err, code, "--replace: %s", why.message);
        if (a->replaced.textures[t])
            return retex_fail(err, RETEX_EINVAL, "--replace: `%s` is replaced twice", a->replacements[k].target);
        code = load_texture(a, scene, t, &a->replacements[k], &loaded[k], err);
        if (code)
            return code;
        a->replaced.textures[t] = loaded[k];
        a->render.variants = &a->replaced, a->render.nvariants = 1;
    }
    return RETEX_OK;
}

/* ---- --variants ---- */

/* The pictures that are rendered along the same paths. */
typedef struct Variants {
    int count;
    int rows[VARIANTS_MAX]; /* rows of the table */
    RetexTexture *loaded[VARIANTS_MAX][RETEX_MAX_TARGETS];
    RenderVariant variants[VARIANTS_MAX];
    RetexImage pictures[VARIANTS_MAX];
} Variants;

static void close_variant(Variants *v, int k)
{
    retex_textures_close(v->loaded[k]);
    retex_image_free(&v->pictures[k]);
}

/* The textures of a row, and those of --replace for targets that the row does not name. */
static int load_variant(Arguments *a, const Scene *scene, Variants *v, int row, RetexError *err)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    const RetexTargetNames names = target_names(scene);
    const int k = v->count, count = texture_table_textures(&a->batch.table, row, specs);
    int code = RETEX_OK;
    v->rows[k] = row;
    v->variants[k] = a->replaced;
    for (int i = 0; i < count && !code; i++) {
        int t = retex_target_index(&names, specs[i].target);
        code = load_texture(a, scene, t, &specs[i], &v->loaded[k][t], err);
        v->variants[k].textures[t] = v->loaded[k][t];
    }
    if (code)
        close_variant(v, k);
    else
        v->count++;
    return code;
}

static int write_variant(Arguments *a, Variants *v, int k, RetexError *err)
{
    char path[PATH_MAX];
    int code = batch_output(&a->batch, v->rows[k], path, err);
    return code ? code : retex_image_write(&v->pictures[k], path, NULL, a->cli->threads, err);
}

/* Render and write the loaded pictures. began: their start, for the times in the report. Return 0 if the batch ends
 * here. */
static int render_loaded(Arguments *a, const Scene *scene, Variants *v, double began)
{
    RenderStats stats;
    RetexError err = {0};
    int go_on = 1;
    a->render.variants = v->variants, a->render.nvariants = v->count;
    const int failed = render_variants(v->pictures, scene, &a->render, &stats, &err);
    const double share = (retex_clock_seconds() - began) / v->count;
    for (int k = 0; k < v->count && go_on; k++) {
        const double wrote = retex_clock_seconds();
        const int unwritten = failed ? failed : write_variant(a, v, k, &err);
        go_on = batch_done(&a->batch, v->rows[k], share + retex_clock_seconds() - wrote, unwritten ? &err : NULL);
        retex_image_free(&v->pictures[k]);
    }
    if (failed)
        return go_on;
    cli_info(a->cli, "%d picture%s, %d samples: %.2f s", v->count, v->count == 1 ? "" : "s", a->render.spp,
             stats.render_seconds);
    warn_numbers(a->cli, &stats);
    return go_on;
}

static void render_table(Arguments *a, const Scene *scene, Variants *v)
{
    int go_on = 1;
    for (int row = 0; row < a->batch.table.nrows && go_on;) {
        const double began = retex_clock_seconds();
        *v = (Variants){.count = 0};
        for (; row < a->batch.table.nrows && v->count < VARIANTS_MAX && go_on; row++) {
            RetexError err = {0};
            if (!batch_is_wanted(&a->batch, row))
                continue;
            if (load_variant(a, scene, v, row, &err))
                go_on = batch_done(&a->batch, row, 0, &err);
        }
        if (v->count && go_on)
            go_on = render_loaded(a, scene, v, began);
        for (int k = 0; k < v->count; k++)
            close_variant(v, k);
    }
}

static int describe_row(void *context, const RetexTextureSpec *specs, int count,
                        BatchTexture textures[RETEX_MAX_TARGETS])
{
    const Arguments *a = context;
    for (int i = 0; i < count; i++) {
        textures[i].target = specs[i].target;
        retex_edit_image_text(&specs[i], textures[i].texture, sizeof textures[i].texture);
    }
    for (int k = 0; k < a->nreplacements; k++) {
        int i = 0;
        while (i < count && strcasecmp(textures[i].target, a->replacements[k].target) != 0)
            i++;
        if (i < count)
            continue;
        textures[count].target = a->replacements[k].target;
        retex_edit_image_text(&a->replacements[k], textures[count].texture, sizeof textures[count].texture);
        count++;
    }
    return count;
}

void check_table(Arguments *a)
{
    a->batch.tool = (BatchTool){.context = a, .describe = describe_row};
    batch_check(&a->batch, NULL);
}

void refuse_columns(Arguments *a)
{
    TextureTable *table = &a->batch.table;
    SdlOptions sdl = a->sdl;
    Scene *scene = NULL;
    sdl.message = NULL; /* they have been printed */
    const JobNames none = {.ntargets = 0};
    if (job_open_scene(&scene, a->scene, &sdl, &a->render, &none, NULL))
        return;
    for (int k = 0; k < table->ncolumns; k++) {
        RetexError err = {0};
        scene->targets[0] = (Target){0};
        if (job_resolve_targets(scene, &a->render, &table->columns[k], 1, &err))
            texture_table_mistake(table, TABLE_ITSELF, "%s", err.message);
    }
    scene_close(&scene);
    if (table->wrong)
        batch_refuse_mistakes(&a->batch);
}

static void check_columns(Arguments *a, const Scene *scene)
{
    TextureTable *table = &a->batch.table;
    int taken[RETEX_MAX_TARGETS] = {0};
    const RetexTargetNames names = target_names(scene);
    for (int k = 0; k < table->ncolumns; k++) {
        RetexError err = {0};
        int t;
        if (retex_target_find(&t, &names, table->columns[k], &err))
            texture_table_mistake(table, TABLE_ITSELF, "%s", err.message);
        else if (taken[t]++)
            texture_table_mistake(table, TABLE_ITSELF, "target `%s` has two columns", table->columns[k]);
    }
    batch_refuse_mistakes(&a->batch);
}

int make_variants(Arguments *a, const Scene *scene)
{
    RetexError err = {0};
    check_columns(a, scene);
    if (a->batch.dry_run) {
        batch_print(&a->batch);
        return batch_finish(&a->batch, NULL);
    }
    Variants *v = calloc(1, sizeof *v);
    if (!v) {
        retex_fail(&err, RETEX_ENOMEM, "out of memory");
        return batch_finish(&a->batch, &err);
    }
    render_table(a, scene, v);
    free(v);
    return batch_finish(&a->batch, NULL);
}

/* ---- --control ---- */

int read_control(Arguments *a, RetexError *err)
{
    RetexSet *set = NULL;
    cli_input(a->cli, a->control, "a set, as from retex-render");
    const int code = retex_set_read(a->control, &set, a->cli->threads, err);
    if (code)
        return code;
    if (!set)
        return retex_fail(err, RETEX_EINVAL, "%s holds samples but no set", a->control);
    a->control_set = set;
    RetexTargetNames names;
    retex_set_target_names(&names, set);
    for (int k = 0; k < a->nreplacements && names.count && !a->named; k++) {
        RetexError why;
        int t;
        if (retex_target_find(&t, &names, a->replacements[k].target, &why))
            return retex_fail(err, why.code, "--control %s: %s", a->control, why.message);
    }
    for (int t = 0; t < names.count && !a->named; t++) {
        snprintf(a->set_targets[t], sizeof a->set_targets[t], "%s=%s", names.names[t], names.idents[t]);
        a->targets[t] = a->set_targets[t];
        a->ntargets = t + 1;
    }
    return RETEX_OK;
}

int render_controlled(Arguments *a, const Scene *scene, const char *output, RetexError *err)
{
    RetexError why;
    RetexSet *set = a->control_set;
    RetexImage picture = {0};
    RenderStats stats;
    double distance;
    if (!a->seeded)
        a->render.seed = retex_set_info(set).seed + 1;
    if (render_control(&picture, scene, &a->render, set, a->control_mode, &distance, &stats, &why))
        return retex_fail(err, why.code, "--control %s: %s", a->control, why.message);
    if (distance > 8)
        cli_warn(a->cli,
                 "--control %s: its picture does not match this scene with its original textures, %.0f standard "
                 "deviations off",
                 a->control, distance);
    const int code = retex_image_write(&picture, output, NULL, a->cli->threads, err);
    const int width = picture.width, height = picture.height;
    retex_image_free(&picture);
    if (code)
        return code;
    cli_info(a->cli, "%dx%d, %d samples: %.2f s", width, height, a->render.spp, stats.render_seconds);
    warn_numbers(a->cli, &stats);
    return a->stats ? write_stats(a, &stats, set, 0, err) : RETEX_OK;
}
