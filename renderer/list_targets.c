/* --list-targets: what of a scene can be a target. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "retex-render.h"
#include "render/candidates.h"

typedef struct IdentShare {
    const char *name;
    double share;
} IdentShare;

static int compare_shares(const void *a, const void *b)
{
    const IdentShare *x = a, *y = b;
    return x->share < y->share ? 1 : x->share > y->share ? -1 : strcmp(x->name, y->name);
}

/* Where the scene offers a target by its name, -t NAME takes that one. */
static void print_ident(const Scene *scene, const IdentShare *ident)
{
    const SceneTarget *offered = scene_offers(scene, ident->name);
    const int is_hidden = offered && strcmp(offered->name, ident->name) == 0;
    printf("%6.2f%%  %s%s%s\n", 100 * ident->share, ident->name, is_hidden ? "=" : "", is_hidden ? ident->name : "");
}

/* Those that the scene offers, each as if it were the only one. */
static void list_offered(Arguments *a, Scene *scene)
{
    double shares[RETEX_MAX_TARGETS];
    char text[SELECTOR_MAX];
    RetexError err;
    for (int k = 0; k < scene->noffered; k++) {
        const SceneTarget *one = &scene->offered[k];
        if (job_resolve_targets(scene, &a->render, &one->name, 1, &err)) {
            cli_warn(a->cli, "%s", err.message);
            continue;
        }
        if (render_target_shares(scene, &a->render, shares, &err))
            cli_fail(a->cli, &err);
        snprintf(text, sizeof text, "%s", one->selectors);
        printf("%6.2f%%  %s\toffered by the scene: %s\n", 100 * shares[0], one->name, cli_plain(text));
    }
    if (scene->noffered && job_resolve_targets(scene, &a->render, a->targets, a->ntargets, &err))
        cli_fail(a->cli, &err);
}

static void list_idents(Arguments *a, const Scene *scene)
{
    RetexError err;
    double *shares = calloc((size_t)scene->nidents + 1, sizeof *shares);
    IdentShare *list = calloc((size_t)scene->nidents + 1, sizeof *list);
    if (!shares || !list)
        cli_die(a->cli, "out of memory");
    if (render_ident_shares(scene, &a->render, shares, &err))
        cli_fail(a->cli, &err);
    for (int k = 0; k < scene->nidents; k++)
        list[k] = (IdentShare){scene_name_of(scene, scene->idents[k]), shares[k]};
    qsort(list, (size_t)scene->nidents, sizeof *list, compare_shares);
    for (int k = 0; k < scene->nidents; k++)
        print_ident(scene, &list[k]);
    free(shares);
    free(list);
}

/* The innermost and the outermost statement that it is from. */
static void print_place(const PlaceList *place)
{
    char text[SELECTOR_MAX], outer[SELECTOR_MAX];
    const PlaceList *last = place;
    while (last && last->next)
        last = last->next;
    if (!selector_of_place(text, place) || !selector_of_place(outer, last))
        return;
    printf("  %s", cli_plain(text));
    if (strcmp(text, outer) != 0)
        printf(" in %s", cli_plain(outer));
}

/* Where a texture would cover more than a person means. */
static void print_advice(const Candidate *one)
{
    if (one->directions > 1)
        printf("; one image serves faces of %d directions: @X:Y/flat or /level takes fewer", one->directions);
    if (one->is_unlit)
        printf("; it only shines, light is baked into its image: so would a new texture");
}

static void print_candidates(const Scene *scene, const Candidates *all)
{
    int widest = 0;
    for (int k = 0; k < all->count; k++) {
        const int width = (int)strlen(cli_plain(all->list[k].text));
        widest = width > widest && width <= 40 ? width : widest;
    }
    for (int k = 0; k < all->count; k++) {
        const Candidate *one = &all->list[k];
        printf("%6.2f%%  %-*s  %-9s", 100 * one->share, widest, one->text, one->kind);
        if (one->name)
            printf("  %s", scene_name_of(scene, one->name));
        else
            print_place(one->place);
        print_advice(one);
        putchar('\n');
    }
}

void check_sheet(const Arguments *a)
{
    RetexError err;
    if (!*a->sheet)
        cli_die(a->cli, "--list-targets: the name is empty");
    if (!strcmp(a->sheet, "-"))
        cli_die(a->cli, "--list-targets prints its list: its picture needs a file");
    if (retex_image_write_check(a->sheet, NULL, &err))
        cli_fail(a->cli, &err);
}

void list_targets(Arguments *a, Scene *scene)
{
    Candidates all;
    RetexImage sheet = {0};
    RetexError err;
    list_offered(a, scene);
    list_idents(a, scene);
    if (!lists_pixels(a))
        return;
    if (render_candidates(&all, a->sheet ? &sheet : NULL, scene, &a->render, &err))
        cli_fail(a->cli, &err);
    if (a->cli->verbose)
        print_candidates(scene, &all);
    if (a->sheet && retex_image_write(&sheet, a->sheet, NULL, a->cli->threads, &err))
        cli_fail(a->cli, &err);
    retex_image_free(&sheet);
    candidates_close(&all);
}
