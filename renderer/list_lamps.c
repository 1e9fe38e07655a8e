/* --list-lamps: the lamps that a scene has, or those that were asked for, with their share of the picture's light. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <retex/color.h>
#include "light/environment.h"
#include "retex-render.h"

#define LIST_WIDTH 160 /* of the picture that shares are found by */
#define LIST_SPP 16
#define REST_LEAST 5e-5 /* less of all light would be told as 0.00 % */

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
    if (lamp->several && !lamp->has_one_color)
        printf("  several colours");
    else if (lamp->several)
        print_color("  ", rgb_mul(lamp->color, lamp->value)), printf(", by which a new one is multiplied");
    else if (rgb_is_black(lamp->value))
        print_color("  off, if on ", lamp->kept);
    else
        print_color("  ", lamp->value);
    putchar('\n');
}

/* Over all pixels, of the image times a colour. */
static double luminance_sum(const RetexImage *image, Rgb scale)
{
    double sum = 0;
    for (size_t i = 0; i < retex_image_index(image, 0, image->height); i += 3)
        sum += (double)retex_luminance(image->pixels[i] * scale.r, image->pixels[i + 1] * scale.g,
                                       image->pixels[i + 2] * scale.b);
    return sum;
}

/* The same view as the picture's, or of its --crop, small. */
static void shrink_view(RenderParams *small, const RenderParams *render, const Scene *scene)
{
    const double width = render->width ? render->width : scene->width;
    const double height = render->height ? render->height : scene->height;
    const double scale = fmin(1, LIST_WIDTH / (render->crop[2] ? render->crop[2] : width));
    small->width = (int)fmax(1, round(width * scale));
    small->height = (int)fmax(1, small->width * height / width);
    for (int k = 0; k < 2 && render->crop[2]; k++) {
        const int size = k ? small->height : small->width;
        small->crop[k] = (int)fmin(render->crop[k] * scale, size - 1);
        small->crop[2 + k] = (int)fmax(1, fmin(render->crop[2 + k] * scale, size - small->crop[k]));
    }
}

/* The shares of the scene's lamps in a small and noisy render. */
static int find_shares(const Arguments *a, const Scene *scene, double shares[LAMPS_MAX + 1], RetexError *err)
{
    RenderParams params = RENDER_PARAMS_INIT;
    RenderStats stats;
    RetexSet *set = NULL;
    const RetexTerm *term;
    shrink_view(&params, &a->render, scene);
    params.spp = LIST_SPP, params.nthreads = a->render.nthreads, params.budget = a->render.budget;
    int code = render_scene(&set, scene, &params, &stats, err);
    if (code)
        return code;
    const double all = luminance_sum(&retex_set_part(set, 0)->image, rgb_grey(1));
    for (int t = 0; (term = retex_set_term(set, t)); t++)
        if (term->role == RETEX_ROLE_LAMP) {
            const char *name = retex_set_parameter(set, term->factors[0].index)->name;
            for (int l = 0; l < scene->nlamps && all > 0; l++)
                if (strcmp(scene->lamps[l].name, name) == 0)
                    shares[l] =
                        luminance_sum(&retex_set_part(set, term->radiance)->image, scene->lamps[l].value) / all;
        }
    retex_set_close(&set);
    return RETEX_OK;
}

/* rest: also what else there is, if it shines. */
static int list_resolved(Arguments *a, Scene *scene, int rest, RetexError *err)
{
    double shares[LAMPS_MAX + 1] = {0};
    const int code = find_shares(a, scene, shares, err);
    for (int l = 0; l < scene->nlamps && !code; l++)
        if (l != scene_rest_lamp(scene) || (rest && shares[l] >= REST_LEAST))
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

/* Shares are of all light, whatever it meets: targets and their finishes, which have been checked by now, would keep it
 * in other parts of the set. */
void list_lamps(Arguments *a, Scene *scene)
{
    RetexError err;
    int code = render_check_window(scene, &a->render, &err);
    if (!code)
        code = scene_resolve_targets(scene, NULL, 0, &err);
    if (!code)
        code = scene_resolve_finishes(scene, NULL, 0, NULL, 0, &err);
    if (!code)
        code = scene->nlamps ? list_resolved(a, scene, 1, &err) : list_each(a, scene, &err);
    if (code)
        cli_fail(a->cli, &err);
}
