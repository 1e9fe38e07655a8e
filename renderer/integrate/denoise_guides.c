/* See denoise_guides.h. */
#include <stdio.h>
#include "integrate/camera.h"
#include "integrate/denoise_guides.h"
#include "integrate/path.h"

/* A pixel is looked at in few places, and where these do not all see the same again in many. Of few, place k is in
 * column k and row few_rows[k]: no correlation, no third moments, and far apart. Many form a lattice of such a step, in
 * rows between neighbouring columns, that their correlation is 0.015 and they are far apart. */
#define PLACES_FEW 8
static const int few_rows[PLACES_FEW] = {1, 7, 3, 5, 2, 4, 0, 6};
#define PLACES_MANY 64
#define STEP_MANY 9
#define ONE_NORMAL 0.999 /* length of the mean of normals that count as one */
#define ONE_ALBEDO 1e-4  /* variance of the luminance of albedos that count as one */
#define FOLLOWED_MAX 16  /* mirrors and glasses on the way */

static const struct {
    const char *name, *letters;
    RetexPixelType type;
} guide_table[GUIDE_COUNT] = {
    [GUIDE_NORMAL] = {"guide_normal", "RGB", RETEX_HALF},
    [GUIDE_POSITION] = {"guide_position", "RGB", RETEX_FLOAT},
    [GUIDE_SPECULAR] = {"guide_specular", "R", RETEX_HALF},
    [GUIDE_SEEN_NORMAL] = {"guide_seen_normal", "RGB", RETEX_HALF},
    [GUIDE_SEEN_POSITION] = {"guide_seen_position", "RGB", RETEX_FLOAT},
    [GUIDE_SEEN_ALBEDO] = {"guide_seen_albedo", "RGB", RETEX_HALF},
    [GUIDE_SEEN_MATERIAL] = {"guide_seen_material", "RGB", RETEX_HALF},
};

/* Sums over the places of a pixel. */
typedef struct Sight {
    int places; /* that see anything */
    Vec3 normal, position;
} Sight;

typedef struct GuideSums {
    int places;
    Sight first, seen;
    int specular;
    double luminance, luminance_squared; /* of the albedos */
    int primitive, differ;               /* the first place's and what it sees; whether others differ */
    Rgb albedo;
    double roughness, metallic;
    double cover[RETEX_MAX_TARGETS];
} GuideSums;

static void add_sight(Sight *sight, const Shading *s)
{
    sight->places++;
    sight->normal = vec_add(sight->normal, s->bsdf.normal);
    sight->position = vec_add(sight->position, s->surface.position);
}

/* What a texture on the surface may be is not known where it is a target. */
static Rgb known_albedo(const DenoiseGuides *job, const Shading *s)
{
    return job->split && s->surface.target >= 0 ? rgb_grey(1) : shading_albedo(s, 0);
}

/* A lamp, whose colour is no pigment that light falls on. */
static int is_emitter(const Shading *s)
{
    return rgb_luminance(s->surface.texture->finish->emission) > s->bsdf.diffuse;
}

static void add_albedo(GuideSums *sums, Rgb albedo)
{
    double l = rgb_luminance(albedo);
    sums->albedo = rgb_add(sums->albedo, albedo);
    sums->luminance += l, sums->luminance_squared += l * l;
}

static void add_seen(const DenoiseGuides *job, GuideSums *sums, const Shading *s)
{
    add_sight(&sums->seen, s);
    add_albedo(sums, is_emitter(s) ? rgb_grey(1) : known_albedo(job, s));
    sums->roughness += shading_roughness(s);
    sums->metallic += shading_metallic(s);
}

/* Where a mirror or clear glass, unless it is more of something else, sends the ray on, and what it leaves of the
 * light. Returns 0 where the surface is itself what is seen. */
static int follow(const DenoiseGuides *job, const Shading *s, const Hit *hit, Ray *ray, RayKind *kind,
                  float *throughput)
{
    const Bsdf *b = &s->bsdf;
    int mirror = b->p_mirror > b->p_passing;
    float likely = mirror ? b->p_mirror : b->p_passing;
    BsdfSample next;
    if (!(likely > fmaxf(b->p_diffuse, fmaxf(b->p_back, b->p_glossy))))
        return 0;
    if (!bsdf_sample(b, mirror ? likely / 2 : b->p_mirror + likely / 2, 0, 0, &next))
        return 0;
    *throughput *= fminf(1, rgb_luminance(split_apply(mirror ? b->mirror : b->passing, known_albedo(job, s))));
    if (next.straight) {
        ray->tmin = hit->t;
        return 1;
    }
    *kind = path_next_kind(*kind, b, next.transmitted);
    *ray = (Ray){accel_offset(s->surface.position, s->surface.geometric_normal, next.wi), next.wi, 0, INFINITY};
    return 1;
}

/* A target counts where it is met first, be it a mirror itself. */
static void add_cover(double cover[RETEX_MAX_TARGETS], unsigned *met, const Shading *s, float throughput)
{
    if (s->surface.target >= 0 && !(*met >> s->surface.target & 1)) {
        cover[s->surface.target] += throughput;
        *met |= 1u << s->surface.target;
    }
}

/* What is seen at a place, by number. */
static void note_primitive(GuideSums *sums, int primitive)
{
    if (sums->places++ == 0)
        sums->primitive = primitive;
    sums->differ |= primitive != sums->primitive;
}

/* hit: the first along the ray. */
static void look(const DenoiseGuides *job, GuideSums *sums, Ray ray, Hit hit)
{
    const FirstHitWindow *w = &job->window;
    RayKind kind = RAY_CAMERA;
    float throughput = 1;
    unsigned met = 0;
    Shading s;
    for (int followed = 0;; followed++) {
        if (followed ? !accel_intersect(w->accel, &ray, kind, &hit) : hit.primitive < 0) {
            add_albedo(sums, rgb_grey(1));
            note_primitive(sums, -1);
            return;
        }
        shading_at(&s, w->scene, w->variants, 1, &ray, &hit);
        if (followed == 0)
            add_sight(&sums->first, &s);
        add_cover(sums->cover, &met, &s, throughput);
        if (followed == FOLLOWED_MAX || !follow(job, &s, &hit, &ray, &kind, &throughput))
            break;
        sums->specular += followed == 0;
    }
    add_seen(job, sums, &s);
    note_primitive(sums, hit.primitive);
}

/* Where the guides of a pixel go. */
typedef struct GuidePlace {
    FilmPixel *pixel;
    int x, y;
} GuidePlace;

static void store(const GuidePlace *at, int image, double scale, double a, double b, double c)
{
    float *p = film_image_pixel(at->pixel, image, at->x, at->y);
    p[0] = (float)(a * scale), p[1] = (float)(b * scale), p[2] = (float)(c * scale);
}

/* Of one channel; memory that is never touched is never taken. */
static void store_one(const GuidePlace *at, int image, double value)
{
    if (value != 0)
        *film_image_pixel(at->pixel, image, at->x, at->y) = (float)value;
}

static void store_sight(const GuidePlace *at, int normal, int position, const Sight *sight)
{
    if (!sight->places)
        return;
    store(at, normal, 1.0 / sight->places, sight->normal.x, sight->normal.y, sight->normal.z);
    store(at, position, 1.0 / sight->places, sight->position.x, sight->position.y, sight->position.z);
}

static void look_at(const DenoiseGuides *job, GuideSums *sums, int x, int y, int places)
{
    const FirstHitWindow *w = &job->window;
    *sums = (GuideSums){.places = 0};
    Ray rays[ACCEL_PACKET];
    Hit hits[ACCEL_PACKET];
    for (int first = 0; first < places; first += ACCEL_PACKET) {
        int count = places - first < ACCEL_PACKET ? places - first : ACCEL_PACKET;
        for (int i = 0, k = first; i < count; i++, k++) {
            int row = places == PLACES_FEW ? few_rows[k] : k * STEP_MANY % places;
            rays[i] = camera_ray(&w->scene->camera, w->width, w->height, w->x0 + x + (k + 0.5) / places,
                                 w->y0 + y + (row + 0.5) / places);
        }
        accel_intersect_packet(w->accel, rays, count, RAY_CAMERA, hits);
        for (int i = 0; i < count; i++)
            look(job, sums, rays[i], hits[i]);
    }
}

static int is_one_normal(const Sight *sight)
{
    return sight->places == 0 || vec_length(sight->normal) > ONE_NORMAL * sight->places;
}

/* Did all places see the same? */
static int is_even(const GuideSums *s)
{
    double mean = s->luminance / s->places;
    return !s->differ && (s->first.places == 0 || s->first.places == s->places) &&
           (s->specular == 0 || s->specular == s->places) && is_one_normal(&s->first) && is_one_normal(&s->seen) &&
           s->luminance_squared / s->places - mean * mean < ONE_ALBEDO;
}

void denoise_guides_pixel(const DenoiseGuides *job, FilmPixel *pixel, int x, int y)
{
    const int *to = job->guides;
    const GuidePlace at = {pixel, x, y};
    GuideSums sums;
    look_at(job, &sums, x, y, PLACES_FEW);
    if (!is_even(&sums))
        look_at(job, &sums, x, y, PLACES_MANY);
    const double share = 1.0 / sums.places;
    store_sight(&at, to[GUIDE_NORMAL], to[GUIDE_POSITION], &sums.first);
    store_one(&at, to[GUIDE_SPECULAR], share * sums.specular);
    store_sight(&at, to[GUIDE_SEEN_NORMAL], to[GUIDE_SEEN_POSITION], &sums.seen);
    store(&at, to[GUIDE_SEEN_ALBEDO], share, sums.albedo.r, sums.albedo.g, sums.albedo.b);
    double each = sums.seen.places ? 1.0 / sums.seen.places : 0;
    store(&at, to[GUIDE_SEEN_MATERIAL], 1, sums.roughness * each, sums.metallic * each, 1 - sums.seen.places * share);
    for (int t = 0; t < job->window.scene->ntargets && job->split; t++)
        store_one(&at, job->covers[t], share * sums.cover[t]);
}

int denoise_guides_create(DenoiseGuides *g, Film *film, const FirstHitWindow *window, int split, RetexError *err)
{
    int code = RETEX_OK;
    *g = (DenoiseGuides){.window = *window, .split = split};
    for (int k = 0; k < GUIDE_COUNT && !code; k++)
        code =
            film_add_image(film, guide_table[k].name, guide_table[k].letters, guide_table[k].type, &g->guides[k], err);
    for (int t = 0; t < window->scene->ntargets && split && !code; t++) {
        char name[RETEX_NAME_MAX];
        snprintf(name, sizeof name, "guide_cover_%.90s", window->scene->targets[t].name);
        code = film_add_image(film, name, "R", RETEX_HALF, &g->covers[t], err);
    }
    return code;
}

int denoise_guides_finish(const DenoiseGuides *g, Film *film, RetexSet *set, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < GUIDE_COUNT && !code; k++)
        code = film_move_image(film, g->guides[k], set, err);
    for (int t = 0; t < g->window.scene->ntargets && g->split && !code; t++)
        code = film_move_image(film, g->covers[t], set, err);
    return code;
}
