/* Subsurface scattering: a random walk from where light, counted from the camera, goes in to where it comes out.
 *
 * The surface's colour is a factor where the path enters, as of a diffuse surface: so a hit has one place, and is d
 * times the albedo. Below the surface light is scattered evenly, with one albedo for all surfaces and colours, that of
 * a half-space which gives back NEUTRAL_ALBEDO of its light. A walk that is absorbed starts again: the finish says how
 * much is absorbed, the walk only where the rest comes out. So all that enters comes out, whatever the shape, and an
 * evenly lit surface looks as without subsurface.
 *
 * Mean free paths differ by colour. A walk takes those of one colour, chosen at random, and the others weigh by how
 * likely they are to take the same steps (the balance heuristic). */
#include "path/internal.h"

#define SCATTER_ALBEDO 0.9901 /* by the fit of Chiang et al. 2016, 'Practical and Controllable Subsurface Scattering' */
#define ATTEMPTS_MAX 16
#define STEPS_MAX 1000    /* of one attempt; few have as many */
#define LEAST_LENGTH 0.01 /* a colour's mean free path over the longest one */

typedef struct Walk {
    const PathContext *context;
    uint32_t key, count;  /* of its random numbers */
    double length[3];     /* mean free paths, by colour */
    double log_length[3]; /* of those */
    int color;            /* whose steps are taken */
    double likely[3];     /* logarithms of how likely each colour is to take the steps so far */
} Walk;

static double walk_number(Walk *walk)
{
    return (double)unit_float(hash_pair(walk->key, walk->count++));
}

static void walk_begin(Walk *walk, const PathWorker *w, const Path *path, const Finish *finish)
{
    const Rgb l = finish->mean_free_path;
    const double least = LEAST_LENGTH * (double)rgb_max(l);
    *walk = (Walk){.context = w->context, .length = {fmax(l.r, least), fmax(l.g, least), fmax(l.b, least)}};
    walk->key = hash_pair(hash_pair(path->key ^ 0x53554253u, path->sample),
                          (uint32_t)(path->segments + path->straight));
    walk->color = (int)(3 * walk_number(walk));
    for (int c = 0; c < 3; c++)
        walk->log_length[c] = log(walk->length[c]);
}

/* scatters: at the end of that length, else it is only passed. */
static void walk_step(Walk *walk, double length, int scatters)
{
    for (int c = 0; c < 3; c++)
        walk->likely[c] -= length / walk->length[c] + (scatters ? walk->log_length[c] : 0);
}

/* What light of the three colours is multiplied by; the mean is 1. */
static Rgb walk_weight(const Walk *walk)
{
    const double *l = walk->likely, most = fmax(l[0], fmax(l[1], l[2]));
    const double p[3] = {exp(l[0] - most), exp(l[1] - most), exp(l[2] - most)}, sum = (p[0] + p[1] + p[2]) / 3;
    return rgb((float)(p[0] / sum), (float)(p[1] / sum), (float)(p[2] / sum));
}

static Vec3 any_direction(Walk *walk)
{
    const double z = 1 - 2 * walk_number(walk), r = sqrt(fmax(0, 1 - z * z));
    double sine, cosine;
    turn_sincos(walk_number(walk), &sine, &cosine);
    return vec3(r * cosine, r * sine, z);
}

/* Move on by one free path, through the walls of other such objects that overlap this one; *depth: how many the ray is
 * in. Returns 1 where it scatters, 0 where it comes out, and -1 where something is in its way. */
static int move(Walk *walk, Ray *ray, int *depth)
{
    double left = -walk->length[walk->color] * log(1 - walk_number(walk));
    for (int k = 0; k < STRAIGHT_MAX; k++) {
        Surface surface;
        Hit hit;
        ray->tmax = ray->tmin + left;
        if (!accel_intersect(walk->context->accel, ray, RAY_BOUNCE, &hit)) {
            walk_step(walk, left, 1);
            ray->origin = vec_mad(ray->origin, ray->direction, ray->tmax);
            return 1;
        }
        surface_at(&surface, walk->context->scene, ray, &hit);
        walk_step(walk, hit.t - ray->tmin, 0);
        if (surface.backside && *depth == 0)
            return 0;
        if (!surface.backside && !finish_is_subsurface(surface.texture->finish))
            return -1;
        *depth += surface.backside ? -1 : 1;
        left -= hit.t - ray->tmin;
        ray->tmin = hit.t;
    }
    return -1;
}

/* Returns 1 where it comes out: where the ray ends. */
static int attempt(Walk *walk, Ray *ray)
{
    int depth = 0;
    for (int k = 0; k < STEPS_MAX; k++) {
        const int scatters = move(walk, ray, &depth);
        if (scatters <= 0)
            return scatters == 0;
        if (walk_number(walk) >= SCATTER_ALBEDO)
            return 0;
        ray->tmin = 0;
        ray->direction = any_direction(walk);
    }
    return 0;
}

/* The ray that ends where the walk comes out, from inside; where it never does, as of shapes without an inside, the ray
 * that came. */
void walk_below_surface(PathWorker *w, Path *path, const Vertex *v, Vec3 direction, Ray *ray)
{
    const Surface *surface = &v->s.surface;
    Walk walk;
    int is_out = 0;
    walk_begin(&walk, w, path, surface->texture->finish);
    for (int k = 0; k < ATTEMPTS_MAX && !is_out; k++) {
        Ray try = {accel_offset(surface->position, surface->geometric_normal, direction), direction, 0, INFINITY};
        is_out = attempt(&walk, &try);
        if (is_out) {
            *ray = try;
            path->kind = RAY_BOUNCE;
        }
        direction = bsdf_enter(&v->s.bsdf, (float)walk_number(&walk), (float)walk_number(&walk));
    }
    ray->tmax = INFINITY;
    path->leaving = 1, path->specular = 0;
    path_scale(w, path, walk_weight(&walk));
    path_next_segment(path, 1, 1);
    if (w->context->trace)
        fprintf(w->context->trace, "  %u random numbers below the surface\n", walk.count);
}

/* It scatters once more, evenly, and outwards. */
void leave_surface(Vertex *v)
{
    static const Finish finish = {.diffuse = 1, .brilliance = 1, .roughness = 0.05, .phong_size = 40, .lambert = 1};
    Shading *s = &v->s;
    v->white = (Texture){.finish = &finish};
    s->surface.texture = &v->white;
    s->surface.target = -1;
    s->surface.backside = 0;
    s->albedo = rgb_grey(1);
    s->replaced = s->is_leaf = s->is_layer = 0;
    s->filter = s->transmit = 0, s->opacity = 1;
}
