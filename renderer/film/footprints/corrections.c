/* The corrections of layout `footprints`: see film/corrections.h. None are needed of light that meets no target but the
 * edited one. They are exact for a texture of one colour, but for more hits than CORRECTION_POWERS, which count as so
 * many. */
#include "film/footprints/pixel.h"

void corrections_add(FootprintPixel *p, const FirstHit *hit)
{
    const HitLight *light = hit->light;
    for (int t = 0; t < corrected_targets(p->film->scene); t++) {
        EditedLight *sum = &p->targets[t].edited;
        const Float4 *edited = light->edited[t];
        if (t == hit->target) {
            Float4 *with = sum->with[hit->sharp ? 0 : 1];
            for (int n = 0; n <= CORRECTION_POWERS; n++)
                with[correction_power(n + 1) - 1] += edited[n];
        } else {
            sum->without += (light->c[0] + edited[0]) * hit->albedo;
            for (int n = 1; n <= CORRECTION_POWERS; n++)
                sum->with[2][n - 1] += edited[n] * hit->albedo;
        }
    }
}

/* ---- the same light from the stored images ---- */

/* Where a pixel is stored. */
typedef struct Place {
    BandRows *rows;
    int x, y;
} Place;

static Float4 stored(const Place *at, int image)
{
    return correction_stored(at->rows, image, at->x, at->y);
}

/* The mean albedos of the mixtures of a pixel. */
typedef struct MeanAlbedos {
    Float4 kinds[RETEX_MAX_TARGETS][2], interreflections[RETEX_MAX_TARGETS];
    float shares[RETEX_MAX_TARGETS]; /* of the targets' interreflections in the mixture of all */
} MeanAlbedos;

/* The mean of footprints' albedos by their shares. Returns the sum of the shares. */
static float mean_albedo(Float4 *mean, const FootprintImages *images, int count, const Place *at)
{
    float shares = 0;
    *mean = splat(0);
    for (int k = 0; k < count; k++) {
        const float share = *bands_pixel(at->rows, images[k].share, at->x, at->y);
        *mean += splat(share) * stored(at, images[k].albedo);
        shares += share;
    }
    if (shares > 0)
        *mean *= splat(1 / shares);
    return shares;
}

/* The number of interreflection footprints that the pixel has on a target. */
static int interreflections_count(const TargetClusters *target)
{
    int count = 0;
    while (count < INTERREFLECTION_CLUSTERS && target->interreflections[count].uv.weight > 0)
        count++;
    return count;
}

static void find_means(MeanAlbedos *means, const FootprintPixel *p, const Place *at)
{
    const FootprintFilm *film = p->film;
    float all = 0;
    for (int t = 0; t < film->scene->ntargets; t++) {
        const TargetImages *images = &film->targets[t];
        for (int kind = 0; kind < 2; kind++) {
            const Clusters *clusters = kind ? &p->targets[t].broad : &p->targets[t].sharp;
            mean_albedo(&means->kinds[t][kind], images->kinds[kind].of, clusters->used ? clusters->count : 0, at);
        }
        means->shares[t] = mean_albedo(&means->interreflections[t], images->interreflections,
                                       interreflections_count(&p->targets[t]), at);
        all += means->shares[t];
    }
    for (int t = 0; t < film->scene->ntargets && all > 0; t++)
        means->shares[t] /= all;
}

/* A polynomial in the texture of the target that is edited: of all its hits. */
typedef Float4 Polynomial[RETEX_MAX_HITS + 1];

/* Multiply by one more hit: on the target with this share, else of this albedo. */
static void multiply(Polynomial polynomial, int *degree, float share, Float4 other)
{
    polynomial[*degree + 1] = splat(0);
    for (int n = ++*degree; n >= 0; n--)
        polynomial[n] = polynomial[n] * other + (n ? polynomial[n - 1] * splat(share) : splat(0));
}

/* The further hits of a coefficient, where target t is edited. */
static int expand(Polynomial polynomial, const FootprintFilm *film, const PlanCoefficient *c, int t,
                  const MeanAlbedos *means)
{
    Float4 others = splat(0);
    int degree = 0;
    for (int j = 0; j < film->scene->ntargets; j++) {
        if (j != t)
            others += splat(means->shares[j]) * means->interreflections[j];
        for (int n = 0; n < c->powers[j]; n++)
            multiply(polynomial, &degree, j == t, j == t ? splat(0) : means->interreflections[j]);
    }
    for (int n = 0; n < c->mixed; n++)
        multiply(polynomial, &degree, means->shares[t], others);
    return degree;
}

/* Subtract the light of a coefficient of the clusters of target j. */
static void subtract_coefficient(EditedLight *sum, const FootprintFilm *film, int i, Float4 light, int t, int j,
                                 int kind, const MeanAlbedos *means)
{
    Polynomial polynomial = {j == t ? light : light * means->kinds[j][kind]};
    const int degree = expand(polynomial, film, &film->plan.coefficients[i], t, means);
    if (j == t) {
        for (int n = 0; n <= degree; n++)
            sum->with[kind][correction_power(n + 1) - 1] -= polynomial[n];
        return;
    }
    sum->without -= polynomial[0];
    for (int n = 1; n <= degree; n++)
        sum->with[2][correction_power(n) - 1] -= polynomial[n];
}

static void subtract_clusters(EditedLight *sum, const FootprintPixel *p, int t, int j, int kind,
                              const MeanAlbedos *means, const Place *at)
{
    const FootprintFilm *film = p->film;
    const Clusters *clusters = kind ? &p->targets[j].broad : &p->targets[j].sharp;
    const KindImages *images = &film->targets[j].kinds[kind];
    for (int k = 0; j != t && k < clusters->count; k++)
        sum->without -= stored(at, images->of[k].light) * stored(at, images->of[k].albedo);
    for (unsigned left = clusters->used; left; left &= left - 1) {
        const int i = __builtin_ctz(left);
        subtract_coefficient(sum, film, i, stored(at, images->interreflected[i]), t, j, kind, means);
    }
}

/* ---- the difference ---- */

void corrections_store(FootprintPixel *p, BandRows *rows, double unit, int x, int y)
{
    const FootprintFilm *film = p->film;
    const Place at = {rows, x, y};
    const Float4 scale = splat(1 / (float)p->spp);
    MeanAlbedos means;
    if (!corrected_targets(film->scene))
        return;
    find_means(&means, p, &at);
    for (int t = 0; t < corrected_targets(film->scene); t++) {
        EditedLight *edited = &p->targets[t].edited;
        const CorrectionImages *images = &film->targets[t].corrections;
        edited->without *= scale;
        for (int kind = 0; kind < CORRECTION_KINDS; kind++)
            for (int n = 0; n < CORRECTION_POWERS; n++)
                edited->with[kind][n] *= scale;
        for (int j = 0; j < film->scene->ntargets; j++)
            for (int kind = 0; kind < 2; kind++)
                subtract_clusters(edited, p, t, j, kind, &means, &at);
        correction_store(rows, images->without, edited->without, unit, x, y);
        for (int kind = 0; kind < CORRECTION_KINDS; kind++)
            for (int n = 0; n < CORRECTION_POWERS; n++)
                correction_store(rows, images->with[kind][n], edited->with[kind][n], unit, x, y);
        *edited = (EditedLight){.without = splat(0)};
    }
}
