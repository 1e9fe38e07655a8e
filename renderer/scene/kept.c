/* Light that sets keep apart, by lamp and by combination of finishes, and its parameters. */
#include <stdio.h>
#include "scene/scene.h"

void scene_number_kept(Scene *scene)
{
    const int lamps = scene->nlamps ? scene->nlamps : scene->ncombinations > 0;
    scene->nkept = 0;
    for (int l = 0; l < lamps; l++)
        for (int c = -1; c < scene->ncombinations; c++) {
            KeptLight *kept = &scene->kept[scene->nkept++];
            const char *lamp = scene->nlamps ? scene->lamps[l].name : "";
            *kept = (KeptLight){.lamp = l, .combination = c};
            if (scene->ncombinations)
                snprintf(kept->name, sizeof kept->name, "%.100s%sfinish%d", lamp, *lamp ? " " : "", c + 1);
            else
                snprintf(kept->name, sizeof kept->name, "%s", lamp);
        }
}

RetexParameter lamp_parameter(const Lamp *lamp)
{
    RetexParameter parameter = {.kind = RETEX_PARAMETER_COLOR,
                                .target = -1,
                                .value = {lamp->value.r, lamp->value.g, lamp->value.b},
                                .kept = {lamp->kept.r, lamp->kept.g, lamp->kept.b},
                                .several = lamp->several};
    snprintf(parameter.name, sizeof parameter.name, "%s", lamp->name);
    return parameter;
}

Rgb kept_color(const Scene *scene, int kept)
{
    const KeptLight *k = &scene->kept[kept];
    const Rgb color = scene->nlamps ? scene->lamps[k->lamp].kept : rgb_grey(1);
    return k->combination < 0 ? color : rgb_scale(color, 1 / (float)scene->ncombinations);
}

RetexParameter kept_parameter(const Scene *scene, int kept)
{
    const KeptLight *k = &scene->kept[kept];
    const Lamp all = {.several = 1, .value = {1, 1, 1}, .kept = {1, 1, 1}};
    const int is_shown = k->combination < 0 || k->combination == scene->shown;
    const Rgb color = kept_color(scene, kept);
    RetexParameter p = lamp_parameter(scene->nlamps ? &scene->lamps[k->lamp] : &all);
    snprintf(p.lamp, sizeof p.lamp, "%s", scene->ncombinations ? p.name : "");
    snprintf(p.name, sizeof p.name, "%s", k->name);
    p.kept[0] = color.r, p.kept[1] = color.g, p.kept[2] = color.b;
    for (int c = 0; c < 3 && !is_shown; c++)
        p.value[c] = 0;
    for (int t = 0; t < scene->ntargets && k->combination >= 0; t++)
        p.finishes[t] = (signed char)(scene->targets[t].nfinishes > 1 ? scene->finish_of[k->combination][t] + 1 : 0);
    return p;
}
