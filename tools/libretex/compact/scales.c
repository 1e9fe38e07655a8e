/* See scales.h. */
#include "compact/scales.h"

int retex_compact_most_places(const RetexCompactLight *light)
{
    int most = 0;
    for (int i = 0; i < RETEX_COMPACT_CHOICES * light->nkinds; i++) {
        const int count = light->kinds[i / RETEX_COMPACT_CHOICES].ngains[i % RETEX_COMPACT_CHOICES];
        most = count > most ? count : most;
    }
    return light->nlamps + most;
}

unsigned char *retex_compact_lamp_scale(const RetexCompactScales *scales, const RetexCompactLight *light, int kind,
                                        int place)
{
    return &scales->lamps[kind * retex_compact_most_places(light) + place];
}

unsigned char *retex_compact_share_scale(const RetexCompactScales *scales, const RetexCompactLight *light,
                                         int parameter)
{
    return &scales->lamps[light->nkinds * retex_compact_most_places(light) + parameter];
}
