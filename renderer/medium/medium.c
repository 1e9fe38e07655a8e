#include "medium/medium.h"
#include "shade/pigment.h"

static Rgb most_of(Rgb a, Rgb b)
{
    return rgb(fmaxf(a.r, b.r), fmaxf(a.g, b.g), fmaxf(a.b, b.b));
}

/* A map is between its entries; black to white where it has none. */
Rgb density_bound(const Pigment *density)
{
    Rgb most = rgb_grey(0);
    if (density->kind == PIGMENT_COLOR)
        return rgb(density->color.r, density->color.g, density->color.b);
    if (density->kind == PIGMENT_IMAGE || density->map.count == 0)
        return rgb_grey(1);
    for (int i = 0; i < density->map.count; i++) {
        const ColorMapEntry *e = &density->map.entries[i];
        most = most_of(most, e->pigment ? density_bound(e->pigment) : rgb(e->color.r, e->color.g, e->color.b));
    }
    return most;
}

static Float4 not_below_0(Float4 v)
{
    return (Float4){not_negative(v[0]), not_negative(v[1]), not_negative(v[2]), 0};
}

static Float4 density_at(const Medium *medium, Vec3 p)
{
    Float4 product = splat(1);
    for (int k = 0; k < medium->ndensities; k++) {
        const Rgbft c = pigment_as_written(medium->densities[k], &(PatternPoint){.p = p});
        product *= not_below_0((Float4){c.r, c.g, c.b, 0});
    }
    return product;
}

static void add(MediumSums *sums, const Medium *m, Float4 density)
{
    const Float4 scattering = color4(m->scattering) * density;
    sums->extinction += color4(m->absorption) * density + scattering * splat((float)m->extinction);
    sums->emission += color4(m->emission) * density;
    sums->scattering += medium_scattering(m, density);
}

void medium_set_add(MediumSet *set, const Medium *media)
{
    for (; media && set->count < MEDIA_AT_ONCE; media = media->next)
        set->media[set->count++] = media;
}

void medium_set_complete(MediumSet *set)
{
    set->varies = set->scatters = 0;
    set->sums = (MediumSums){.extinction = splat(0)};
    for (int k = 0; k < set->count; k++) {
        const Medium *m = set->media[k];
        set->varies |= m->ndensities > 0;
        set->scatters |= !rgb_is_black(m->scattering);
        set->sums.density[k] = m->ndensities > 0 ? color4(m->most) : splat(1);
        add(&set->sums, m, set->sums.density[k]);
    }
    const Float4 e = set->sums.extinction;
    set->majorant = fmaxf(e[0], fmaxf(e[1], e[2]));
    set->emits = !is_black4(set->sums.emission);
}

void medium_at(const MediumSet *set, Vec3 p, float most, MediumSums *sums)
{
    if (!set->varies) {
        *sums = set->sums;
        return;
    }
    sums->extinction = sums->emission = sums->scattering = splat(0);
    for (int k = 0; k < set->count; k++) {
        sums->density[k] = density_at(set->media[k], p);
        add(sums, set->media[k], sums->density[k]);
    }
    const float largest = fmaxf(sums->extinction[0], fmaxf(sums->extinction[1], sums->extinction[2]));
    if (!(most > 0 && largest > most))
        return;
    const Float4 scale = splat(most / largest);
    sums->extinction *= scale, sums->emission *= scale, sums->scattering *= scale;
    for (int k = 0; k < set->count; k++)
        sums->density[k] *= scale;
}
