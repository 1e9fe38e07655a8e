/* --list-lamps: the lamps that a scene has, or those that were asked for, with their share of the picture's light. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <retex/color.h>
#include "light/environment.h"
#include "retex-render.h"

#define LIST_WIDTH 160 /* of the picture that shares are found by */
#define LIST_SPP 16

static void print_color(const char *before, Rgb c)
{
    printf("%srgb(%.3g,%.3g,%.3g)", before, c.r, c.g, c.b);
}

static void print_lamp(const Scene *scene, Lamp *lamp, double share)
{
    printf("%6.2f%%  %s", 100 * share, cli_plain(lamp->name));
    if (lamp == &scene->lamps[scene_rest_lamp(scene)]) {
        printf("  all other light\n");
        return;
    }
    if (strcmp(lamp->name, lamp->idents) != 0)
        printf("=%s", cli_plain(lamp->idents));
    if (lamp->several)
        printf("  several colours");
    else if (rgb_is_black(lamp->value))
        print_color("  off, if on ", lamp->kept);
    else
        print_color("  ", lamp->value);
    putchar('\n');
}

static double mean_luminance(const RetexImage *image, Rgb scale)
{
    double sum = 0;
    for (size_t i = 0; i < retex_image_index(image, 0, image->height); i += 3)
        sum += (double)retex_luminance(image->pixels[i] * scale.r, image->pixels[i + 1] * scale.g,
                                       image->pixels[i + 2] * scale.b);
    return sum;
}

/* The shares of the scene's lamps, without targets, in a small and noisy render. */
static int find_shares(const Arguments *a, const Scene *scene, double shares[LAMPS_MAX + 1], RetexError *err)
{
    RenderParams params = RENDER_PARAMS_INIT;
    RenderStats stats;
    RetexSet *set = NULL;
    const RetexTerm *term;
    const double width = a->render.width ? a->render.width : scene->width;
    const double height = a->render.height ? a->render.height : scene->height;
    params.width = (int)(width < LIST_WIDTH ? width : LIST_WIDTH);
    params.height = (int)fmax(1, params.width * height / width);
    params.spp = LIST_SPP, params.nthreads = a->render.nthreads, params.budget = a->render.budget;
    int code = render_scene(&set, scene, &params, &stats, err);
    if (code)
        return code;
    const double all = mean_luminance(&retex_set_part(set, 0)->image, rgb_grey(1));
    for (int t = 0; (term = retex_set_term(set, t)); t++)
        if (term->role == RETEX_ROLE_LAMP) {
            const char *name = retex_set_parameter(set, term->factors[0].index)->name;
            for (int l = 0; l < scene->nlamps && all > 0; l++)
                if (strcmp(scene->lamps[l].name, name) == 0)
                    shares[l] =
                        mean_luminance(&retex_set_part(set, term->radiance)->image, scene->lamps[l].value) / all;
        }
    retex_set_close(&set);
    return RETEX_OK;
}

/* rest: also what else there is, if it shines. */
static int list_resolved(Arguments *a, Scene *scene, int rest, RetexError *err)
{
    double shares[LAMPS_MAX + 1] = {0};
    scene->ntargets = 0;
    const int code = find_shares(a, scene, shares, err);
    for (int l = 0; l < scene->nlamps && !code; l++)
        if (l != scene_rest_lamp(scene) || (rest && shares[l] > 0))
            print_lamp(scene, &scene->lamps[l], shares[l]);
    return code;
}

/* All that there are, so many at a time as a set can have. */
static int list_each(Arguments *a, Scene *scene, RetexError *err)
{
    const char *const *specs;
    const int has_sky = sky_shines(scene) || !rgb_is_black(scene->background);
    int count, code = scene_each_lamp(scene, has_sky, 1, &specs, &count, err);
    const int too_many = code == RETEX_ELIMIT;
    code = too_many ? RETEX_OK : code;
    for (int first = 0; first < count && !code; first += LAMPS_MAX) {
        code = scene_resolve_lamps(scene, specs + first, count - first < LAMPS_MAX ? count - first : LAMPS_MAX, err);
        if (!code)
            code = list_resolved(a, scene, !too_many, err);
    }
    if (!count)
        cli_info(a->cli, "no light source, nothing that shines, and no sky");
    return code;
}

void list_lamps(Arguments *a, Scene *scene)
{
    RetexError err;
    if (scene->nlamps ? list_resolved(a, scene, 1, &err) : list_each(a, scene, &err))
        cli_fail(a->cli, &err);
}
