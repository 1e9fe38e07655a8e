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
        if (!light->used) { /* it meets no target but this one */
            if (t != hit->target)
                sum->without += light->c[0] * hit->albedo;
        } else if (t == hit->target) {
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

/* Footprints' albedos by their shares, and the sum of the shares. */
typedef struct AlbedoMean {
    Float4 sum;
    float shares;
} AlbedoMean;

static void add_albedo(AlbedoMean *mean, int share_image, int albedo_image, const Place *at)
{
    const float share = *bands_pixel(at->rows, share_image, at->x, at->y);
    mean->sum += splat(share) * stored(at, albedo_image);
    mean->shares += share;
}

static void add_albedos(AlbedoMean *mean, const FootprintImages *images, int count, const Place *at)
{
    for (int k = 0; k < count; k++)
        add_albedo(mean, images[k].share, images[k].albedo, at);
}

static Float4 mean_of(const AlbedoMean *mean)
{
    return mean->shares > 0 ? mean->sum * splat(1 / mean->shares) : splat(0);
}

/* Whether quadrants are footprints of a kind of clusters in this pixel. */
static int has_quadrants(const FootprintPixel *p, int t, int kind)
{
    return kind == 0 && p->quadrants.target == t;
}

/* The number of interreflection footprints that the pixel has on a target. */
static int interreflections_count(const TargetClusters *target)
{
    int count = 0;
    while (count < INTERREFLECTION_MOST && target->interreflections[count].uv.weight > 0)
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
            AlbedoMean mean = {splat(0), 0};
            add_albedos(&mean, images->kinds[kind].of, clusters->used ? clusters->count : 0, at);
            for (int k = 0; k < RETEX_QUADRANTS && clusters->used && has_quadrants(p, t, kind); k++)
                add_albedo(&mean, images->quadrants.share[k], images->quadrants.albedo, at);
            means->kinds[t][kind] = mean_of(&mean);
        }
        AlbedoMean further = {splat(0), 0};
        add_albedos(&further, images->interreflections, interreflections_count(&p->targets[t]), at);
        means->interreflections[t] = mean_of(&further);
        means->shares[t] = further.shares;
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
    const QuadrantImages *quadrants = &film->targets[j].quadrants;
    for (int k = 0; j != t && k < clusters->count; k++)
        sum->without -= stored(at, images->of[k].light) * stored(at, images->of[k].albedo);
    for (int k = 0; j != t && k < RETEX_QUADRANTS && has_quadrants(p, j, kind); k++)
        sum->without -= stored(at, quadrants->light[k]) * stored(at, quadrants->albedo);
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
