/* Other textures than the scene's: --replace, tables of pictures with --variants, and --control. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "retex-render.h"

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

static _Noreturn void fail_target(const Arguments *a, const Scene *scene, const char *option, const char *name)
{
    char meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {name, NULL, 0};
    for (int k = 0; k < scene->ntargets; k++)
        retex_nearest_try(&nearest, scene->targets[k].name);
    if (nearest.best)
        cli_die(a->cli, "--%s: `%s` is no target%s", option, name, retex_meant(nearest.best, meant));
    cli_die(a->cli, "--%s: `%s` is no target: name it with -t", option, name);
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

void replace_textures(Arguments *a, const Scene *scene, RetexTexture **loaded)
{
    RetexError err;
    for (int k = 0; k < a->nreplacements; k++) {
        int t = find_target(scene, a->replacements[k].target);
        if (t < 0)
            fail_target(a, scene, "replace", a->replacements[k].target);
        if (a->replaced.textures[t])
            cli_die(a->cli, "--replace: `%s` is replaced twice", a->replacements[k].target);
        if (load_texture(a, scene, t, &a->replacements[k], &loaded[k], &err))
            cli_fail(a->cli, &err);
        a->replaced.textures[t] = loaded[k];
        a->render.variants = &a->replaced, a->render.nvariants = 1;
    }
}

/* ---- --variants ---- */

void read_rows(Arguments *a, VariantRows *rows)
{
    RetexError err;
    rows->count = 0;
    for (int k; (k = rows->count) < VARIANTS_MAX; rows->count++) {
        if (!texture_table_row(&a->table, a->cli, &rows->outputs[k], rows->specs[k], &rows->nspecs[k]))
            return;
        rows->lines[k] = a->table.row_line;
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

void render_table(Arguments *a, const Scene *scene, VariantRows *rows)
{
    for (; rows->count > 0; read_rows(a, rows))
        render_rows(a, scene, rows);
    texture_table_close(&a->table);
}

void check_columns(Arguments *a, const Scene *scene)
{
    int taken[RETEX_MAX_TARGETS] = {0};
    for (int k = 0; k < a->table.ncolumns; k++) {
        int t = find_target(scene, a->table.columns[k]);
        if (t < 0)
            fail_target(a, scene, "variants", a->table.columns[k]);
        if (taken[t]++)
            cli_die(a->cli, "--variants: target `%s` has two columns", a->table.columns[k]);
    }
}

/* ---- --control ---- */

void read_control(Arguments *a)
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

void render_controlled(Arguments *a, const Scene *scene, const char *output)
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
