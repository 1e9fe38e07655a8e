/* See seen_through.h. */
#include "render/seen_through.h"

#define LEAST_SHARE (1 / 256.0f) /* of a ray, of a part that is followed by itself; else it joins the larger one */
#define BRANCHES_MAX 512         /* of one ray that wait: more than 1 / LEAST_SHARE */
#define BOUNCES_MAX 16           /* mirrors, and surfaces that refract, along a ray */
#define STRAIGHT_MAX 128         /* surfaces that let it pass straight */

typedef struct Branch {
    Ray ray;
    RayKind kind;
    SeenHow how;
    float share;
    unsigned met;
    int bounces, straight;
} Branch;

typedef struct Walk {
    const FirstHitWindow *window;
    SeenVisitor *visit;
    void *context;
    const Branch *branch; /* that meets something */
    const Hit *hit;
    Branch waiting[BRANCHES_MAX];
    int count;
} Walk;

/* Of what arrives at a leaf. The sum is 1. */
typedef struct Division {
    float own, mirror, bent, straight;
} Division;

/* What passes without being refracted where the pigment is white: its colour dims what is behind, but hides nothing. */
static float passes_straight(const Bsdf *b)
{
    if (b->lambert || b->refracts || !(b->p_passing > 0))
        return 0;
    return at_most(not_negative(rgb_luminance(rgb_add(b->passing.d, b->passing.i))), 1);
}

/* By the probabilities with which paths choose lobes, which look at no pigment. POV-Ray's highlights show light
 * sources, nothing that could be covered. */
static Division divide(const Bsdf *b)
{
    Division d = {.straight = passes_straight(b)};
    const float rest = 1 - d.straight;
    if (b->lambert)
        return (Division){.own = 1};
    float own = b->p_diffuse + b->p_back + b->p_subsurface + (b->disney ? b->p_glossy : 0);
    if (b->coating.present)
        own += b->coating.coat.p + b->coating.sheen.p;
    const float bent = b->refracts ? b->p_passing : 0, sum = own + b->p_mirror + bent;
    d.mirror = sum > 0 ? rest * b->p_mirror / sum : 0;
    d.bent = sum > 0 ? rest * bent / sum : 0;
    d.own = rest - d.mirror - d.bent;
    return d;
}

/* Small parts join the largest that is left, so that nothing is lost. */
static void join_small(Division *d, float share, int bends, int passes)
{
    if (!passes || share * d->straight < LEAST_SHARE)
        d->own += d->straight, d->straight = 0;
    if (!bends || share * d->mirror < LEAST_SHARE) {
        float *to = bends && d->bent > d->own ? &d->bent : &d->own;
        *to += d->mirror, d->mirror = 0;
    }
    if (!bends || share * d->bent < LEAST_SHARE) {
        float *to = d->mirror > d->own ? &d->mirror : &d->own;
        *to += d->bent, d->bent = 0;
    }
}

static void push(Walk *walk, const Branch *branch)
{
    if (walk->count < BRANCHES_MAX)
        walk->waiting[walk->count++] = *branch;
}

static void pass_straight(Walk *walk, float share)
{
    Branch next = *walk->branch;
    next.ray.tmin = walk->hit->t;
    next.share = share;
    next.straight++;
    push(walk, &next);
}

/* Go on in a mirror or behind glass. Returns 0 where nothing does. */
static int bend(Walk *walk, const Shading *s, int mirror, float share)
{
    const Bsdf *b = &s->bsdf;
    const float lobe = mirror ? b->p_mirror / 2 : b->p_mirror + b->p_passing / 2;
    Branch next = *walk->branch;
    BsdfSample sample;
    if (!bsdf_sample(b, lobe, 0, 0, &sample) || sample.straight)
        return 0;
    next.kind = path_next_kind(next.kind, b, sample.transmitted);
    next.ray = (Ray){accel_offset(s->surface.position, s->surface.geometric_normal, sample.wi), sample.wi, 0, INFINITY};
    next.how = next.how == SEEN_DIRECTLY ? (mirror ? SEEN_REFLECTED : SEEN_TRANSMITTED) : next.how;
    next.share = share;
    next.met |= s->surface.target >= 0 ? 1u << s->surface.target : 0;
    next.bounces++;
    push(walk, &next);
    return 1;
}

static void meet_leaf(void *context, const SeenLeaf *leaf)
{
    Walk *walk = context;
    const Branch *branch = walk->branch;
    const float share = branch->share * leaf->share;
    Division d = divide(&leaf->s.bsdf);
    join_small(&d, share, branch->bounces < BOUNCES_MAX, branch->straight < STRAIGHT_MAX);
    const float covers = share * (1 - d.straight);
    if (d.straight > 0)
        pass_straight(walk, share * d.straight);
    if (d.mirror > 0 && !bend(walk, &leaf->s, 1, share * d.mirror))
        d.own += d.mirror;
    if (d.bent > 0 && !bend(walk, &leaf->s, 0, share * d.bent))
        d.own += d.bent;
    const SeenSurface seen = {leaf, walk->hit, branch->how, covers, share * d.own, branch->met};
    walk->visit(walk->context, &seen);
}

void seen_through(const FirstHitWindow *window, const Ray *ray, const Hit *hit, SeenVisitor *visit, void *context)
{
    Walk walk;
    walk.window = window, walk.visit = visit, walk.context = context;
    walk.count = 0;
    Branch branch = {.ray = *ray, .kind = RAY_CAMERA, .share = 1};
    Hit next = *hit;
    walk.branch = &branch, walk.hit = &next;
    if (hit->primitive < 0)
        return;
    shading_each_leaf(window->scene, window->variants, &branch.ray, &next, meet_leaf, &walk);
    while (walk.count > 0) {
        branch = walk.waiting[--walk.count];
        if (accel_intersect(window->accel, &branch.ray, branch.kind, &next))
            shading_each_leaf(window->scene, window->variants, &branch.ray, &next, meet_leaf, &walk);
    }
}
