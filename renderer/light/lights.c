/* The list of all lights and the choice among them. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include "light/light_tree.h"
#include "light/lights.h"
#include "light/mesh_light.h"
#include "shade/bsdf.h"
#include "shade/texture.h"
#include "shape/csg.h"
#include "shape/shape.h"

#define EXACT_MAX 4   /* up to so many lights are chosen by an estimate of each; more by the tree */
#define EXACT_MOST 32 /* the same where there are light groups, of which the tree knows nothing */
#define FACES_WHOLE 8 /* a mesh of up to so many emitting faces is one light; of a larger one each face is a light */
#define CHOICE_FLOOR 0.02f /* least probability of every light, over that of a uniform choice: estimates may be wrong */
#define INFINITE_MIN 0.05f /* the same for all of the tree, and for all infinite lights */
#define BACK_OF_CLOSED 0.1 /* weight of the inside of a closed mesh, which may be a room */

typedef enum EntryKind { ENTRY_SOURCE, ENTRY_EMITTER, ENTRY_SKY } EntryKind;

typedef struct Entry {
    EntryKind kind;
    int index;   /* of the source or primitive */
    Vec3 center; /* emitter: of its bounds */
    double radius;
    double area;
    float strength;  /* emitter: radiance * area; sky: irradiance; source: luminance of its colour times pi */
    MeshLight *mesh; /* emitting meshes */
    int sphere;      /* sampled by the cone it is seen in */
    int leaf;        /* its first leaf of the tree: it has one, or one for each emitting face; -1: an infinite light */
    int infinite;    /* index among the infinite lights */
} Entry;

/* What a leaf of the tree is. */
typedef struct Leaf {
    int entry, face; /* face: of the mesh light, or -1: the whole entry */
} Leaf;

struct Lights {
    const Scene *scene;
    Environment *environment;
    int count, sky; /* sky: index of its entry, or -1 */
    Entry *entries;
    int *of_primitive;    /* entry of each primitive, or -1 */
    int nemitters;        /* the first entries are the emitting shapes */
    double *emitter_sums; /* running sums of their power, nemitters + 1 */
    /* many lights; tree is NULL for few */
    LightTree *tree;
    Leaf *leaves;
    int ninfinite;        /* lights that are infinitely far: sky and beams */
    int *infinite;        /* their entries */
    float *infinite_sums; /* running sums of their irradiance, ninfinite + 1 */
};

static int primitive_emits(const Primitive *p)
{
    return texture_is_sampled(p->texture);
}

/* A dome of `ambient` around the camera, for a sky: like a sky of one colour, it is sampled by the BSDF alone. */
static int is_dome(const Primitive *p, Vec3 camera)
{
    return p->texture->finish->emission_of_ambient && !p->csg && p->shape.ops->inside &&
           p->shape.ops->inside(&p->shape, transform_inverse_point(&p->transform, camera));
}

/* A sphere under rotation, translation and equal scaling. */
static int is_round_sphere(const Primitive *p, double *radius)
{
    if (p->shape.ops != &shape_sphere)
        return 0;
    Vec3 a[3];
    for (int k = 0; k < 3; k++)
        a[k] = vec3(p->transform.m[0][k], p->transform.m[1][k], p->transform.m[2][k]);
    double r = vec_length(a[0]), tolerance = 1e-6 * r * r;
    *radius = r;
    return fabs(vec_dot(a[1], a[1]) - r * r) < tolerance && fabs(vec_dot(a[2], a[2]) - r * r) < tolerance &&
           fabs(vec_dot(a[0], a[1])) < tolerance && fabs(vec_dot(a[0], a[2])) < tolerance &&
           fabs(vec_dot(a[1], a[2])) < tolerance;
}

static int add_emitter(Lights *lights, int index, RetexError *err)
{
    const Primitive *p = &lights->scene->primitives[index];
    Entry e = {.kind = ENTRY_EMITTER, .index = index};
    double power = 0, r;
    if (p->prototype)
        return RETEX_OK;
    if (p->shape.mesh) {
        int code = mesh_light_create(&e.mesh, p, err);
        if (code)
            return code;
        if (e.mesh)
            e.area = e.mesh->area, power = e.mesh->power;
    } else if (primitive_emits(p) && !is_dome(p, lights->scene->camera.location)) {
        e.area = shape_area(p);
        power = rgb_luminance(texture_emission(p->texture)) * e.area;
    }
    Vec3 low, high;
    if (!(e.area > 0) || !shape_bounds(p, &low, &high)) {
        mesh_light_close(&e.mesh);
        return RETEX_OK;
    }
    e.center = vec_scale(vec_add(low, high), 0.5);
    e.radius = vec_length(vec_sub(high, low)) / 2;
    e.sphere = !p->csg && is_round_sphere(p, &r); /* what is cut off of an operand opens up its far side */
    if (e.sphere)
        e.radius = r;
    e.strength = NEUTRAL_ALBEDO * (float)power;
    lights->of_primitive[index] = lights->count;
    lights->entries[lights->count++] = e;
    return RETEX_OK;
}

static void add_others(Lights *lights)
{
    for (int k = 0; k < lights->scene->nlights; k++) {
        float strength = rgb_luminance(lights->scene->lights[k].color) * (float)PI;
        if (strength > 0)
            lights->entries[lights->count++] = (Entry){.kind = ENTRY_SOURCE, .index = k, .strength = strength};
    }
    /* A uniform sky is sampled as well by the BSDF alone, without noise where nothing occludes it. */
    if (!lights->environment || !lights->scene->sky)
        return;
    lights->sky = lights->count;
    lights->entries[lights->count++] =
        (Entry){.kind = ENTRY_SKY, .strength = environment_mean(lights->environment) * (float)PI};
}

/* ---- many lights ---- */

static int is_infinite(const Lights *lights, const Entry *e)
{
    return e->kind == ENTRY_SKY || (e->kind == ENTRY_SOURCE && source_is_beam(&lights->scene->lights[e->index]));
}

/* Whether each face of its mesh is a light of its own. */
static int is_by_face(const Entry *e)
{
    return e->mesh && e->mesh->count > FACES_WHOLE;
}

/* The number of leaves of an entry in the tree. */
static int leaf_count(const Lights *lights, const Entry *e)
{
    if (is_infinite(lights, e))
        return 0;
    return is_by_face(e) ? e->mesh->count : 1;
}

static LightBounds face_bounds(const MeshLight *mesh, int face)
{
    const MeshLightFace *f = &mesh->faces[face];
    double a[3], b[3], c[3], low[3], high[3], intensity = NEUTRAL_ALBEDO * fmaxf(0, f->radiance) / f->inverse_area;
    a[0] = f->corner.x, a[1] = f->corner.y, a[2] = f->corner.z;
    b[0] = f->edge1.x, b[1] = f->edge1.y, b[2] = f->edge1.z;
    c[0] = f->edge2.x, c[1] = f->edge2.y, c[2] = f->edge2.z;
    for (int k = 0; k < 3; k++) {
        low[k] = a[k] + fmin(0, fmin(b[k], c[k]));
        high[k] = a[k] + fmax(0, fmax(b[k], c[k]));
    }
    return (LightBounds){.low = vec3(low[0], low[1], low[2]),
                         .high = vec3(high[0], high[1], high[2]),
                         .axis = f->normal,
                         .theta_e = PI / 2,
                         .back_share = mesh->closed ? BACK_OF_CLOSED : 1,
                         .intensity = intensity,
                         .peak = NEUTRAL_ALBEDO * PI * fmaxf(0, f->radiance)};
}

/* An emitting shape as a whole: a flat one, or one of which any side shows a quarter of the surface. */
static LightBounds shape_light_bounds(const Primitive *p, const Entry *e)
{
    LightBounds b = {
        .axis = {0, 0, 1}, .theta_o = PI, .theta_e = PI / 2, .back_share = 1, .intensity = e->strength / 4};
    shape_bounds(p, &b.low, &b.high);
    b.peak = e->area > 0 ? PI * e->strength / e->area : 0;
    if (p->shape.ops->properties & SHAPE_FLAT) {
        ShapePoint point;
        p->shape.ops->point(p, vec3(0, 0, 0), 0, &point);
        b.axis = vec_normalize(transform_normal(&p->transform, point.normal));
        b.theta_o = 0;
        b.intensity = e->strength;
    }
    return b;
}

static LightBounds entry_bounds(const Lights *lights, const Entry *e)
{
    if (e->kind == ENTRY_SOURCE)
        return source_bounds(&lights->scene->lights[e->index]);
    return shape_light_bounds(&lights->scene->primitives[e->index], e);
}

/* List the infinite lights, with running sums of their estimated irradiance. */
static void sum_infinite(Lights *lights)
{
    float sum = 0;
    for (int k = 0; k < lights->count; k++) {
        if (!is_infinite(lights, &lights->entries[k]))
            continue;
        lights->entries[k].infinite = lights->ninfinite;
        lights->infinite[lights->ninfinite++] = k;
        lights->infinite_sums[lights->ninfinite] = sum += fmaxf(lights->entries[k].strength, 1e-20f);
    }
}

static int has_groups(const Scene *scene)
{
    for (int k = 0; k < scene->nprimitives; k++)
        if (scene->primitives[k].light_group)
            return 1;
    for (int k = 0; k < scene->nlights; k++)
        if (scene->lights[k].group)
            return 1;
    return 0;
}

/* A tree, where there are many finite lights. */
static int grow_tree(Lights *lights, RetexError *err)
{
    long leaves = 0;
    int finite = 0, n = 0;
    for (int k = 0; k < lights->count; k++) {
        int of_entry = leaf_count(lights, &lights->entries[k]);
        lights->entries[k].leaf = -1;
        leaves += of_entry, finite += of_entry > 0;
    }
    if (finite == leaves && lights->count <= (has_groups(lights->scene) ? EXACT_MOST : EXACT_MAX))
        return RETEX_OK;
    LightBounds *bounds = malloc((size_t)leaves * sizeof *bounds + 1);
    lights->leaves = malloc((size_t)leaves * sizeof *lights->leaves + 1);
    lights->infinite = malloc(((size_t)lights->count + 1) * sizeof *lights->infinite);
    lights->infinite_sums = calloc((size_t)lights->count + 1, sizeof *lights->infinite_sums);
    int code = RETEX_OK;
    if (!bounds || !lights->leaves || !lights->infinite || !lights->infinite_sums || leaves > INT_MAX / 2)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory for %ld lights", leaves);
    for (int k = 0; k < lights->count && !code; k++) {
        Entry *e = &lights->entries[k];
        int of_entry = leaf_count(lights, e);
        if (of_entry > 0)
            e->leaf = n;
        for (int f = 0; f < of_entry; f++) {
            lights->leaves[n] = (Leaf){k, is_by_face(e) ? f : -1};
            bounds[n++] = is_by_face(e) ? face_bounds(e->mesh, f) : entry_bounds(lights, e);
        }
    }
    if (!code)
        sum_infinite(lights);
    if (!code && n > 0)
        code = light_tree_create(&lights->tree, bounds, n, err);
    free(bounds);
    return code;
}

static void sum_emitters(Lights *lights)
{
    lights->nemitters = lights->count;
    for (int k = 0; k < lights->count; k++)
        lights->emitter_sums[k + 1] = lights->emitter_sums[k] + lights->entries[k].strength;
}

int lights_create(Lights **out, const Scene *scene, RetexError *err)
{
    size_t most = (size_t)scene->nlights + (size_t)scene->nprimitives + 1;
    Lights *lights = calloc(1, sizeof *lights);
    *out = lights;
    if (!lights)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the lights");
    lights->scene = scene;
    lights->sky = -1;
    lights->entries = calloc(most, sizeof *lights->entries);
    lights->of_primitive = malloc(most * sizeof *lights->of_primitive);
    lights->emitter_sums = calloc(most + 1, sizeof *lights->emitter_sums);
    int code = RETEX_OK;
    if (!lights->entries || !lights->of_primitive || !lights->emitter_sums)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory for %d lights", (int)most);
    if (!code)
        code = environment_create(&lights->environment, scene, err);
    for (int k = 0; k < scene->nprimitives && !code; k++) {
        lights->of_primitive[k] = -1;
        code = add_emitter(lights, k, err);
    }
    if (!code) {
        sum_emitters(lights);
        add_others(lights);
        code = grow_tree(lights, err);
    }
    if (code)
        lights_close(out);
    return code;
}

void lights_close(Lights **lights)
{
    if (!*lights)
        return;
    for (int k = 0; k < (*lights)->count; k++)
        mesh_light_close(&(*lights)->entries[k].mesh);
    light_tree_close(&(*lights)->tree);
    environment_close(&(*lights)->environment);
    free((*lights)->entries);
    free((*lights)->of_primitive);
    free((*lights)->emitter_sums);
    free((*lights)->leaves);
    free((*lights)->infinite);
    free((*lights)->infinite_sums);
    free(*lights);
    *lights = NULL;
}

int lights_count(const Lights *lights)
{
    return lights->count;
}

/* ---- the choice ---- */

/* Estimate the irradiance of an entry on a surface that faces it. */
static float entry_estimate(const Lights *lights, const Entry *e, Vec3 position)
{
    if (e->kind == ENTRY_SKY)
        return e->strength;
    if (e->kind == ENTRY_SOURCE) {
        const Light *light = &lights->scene->lights[e->index];
        Vec3 direction;
        double distance;
        return rgb_luminance(source_irradiance(light, position, light->location, &direction, &distance));
    }
    Vec3 d = vec_sub(e->center, position);
    return e->strength / (float)fmax(vec_dot(d, d), e->radius * e->radius / 4);
}

/* Whether an entry shines on what is in the point's light group. */
static int entry_reaches(const Lights *lights, const Entry *e, const LightSampleContext *point)
{
    return e->kind != ENTRY_SOURCE || light_reaches_group(&lights->scene->lights[e->index], point->group);
}

/* Probabilities of the entries at a point; their sum is 1, or 0 where none shines on the point's group. */
static void local_shares(const Lights *lights, const LightSampleContext *point, float *shares)
{
    float total = 0, sum = 0;
    for (int k = 0; k < lights->count; k++) {
        shares[k] = -1;
        if (entry_reaches(lights, &lights->entries[k], point))
            total += shares[k] = entry_estimate(lights, &lights->entries[k], point->position);
    }
    const float least = total > 0 ? total * CHOICE_FLOOR / (float)lights->count : 1;
    for (int k = 0; k < lights->count; k++)
        sum += shares[k] = shares[k] >= 0 ? shares[k] + least : 0;
    for (int k = 0; k < lights->count && sum > 0; k++)
        shares[k] /= sum;
}

/* Probability of the tree as a whole; the rest is that of the infinite lights. */
static float tree_share(const Lights *lights, const LightSampleContext *point)
{
    if (lights->ninfinite == 0)
        return 1;
    if (!lights->tree)
        return 0;
    float tree = light_tree_estimate(lights->tree, point), infinite = lights->infinite_sums[lights->ninfinite];
    return fminf(1 - INFINITE_MIN, fmaxf(INFINITE_MIN, tree / (tree + infinite)));
}

static float infinite_share(const Lights *lights, int k)
{
    return (lights->infinite_sums[k + 1] - lights->infinite_sums[k]) / lights->infinite_sums[lights->ninfinite];
}

/* Whether lights are chosen by an estimate of each. */
static int is_exact(const Lights *lights)
{
    return !lights->tree && lights->ninfinite == 0;
}

static float exact_probability(const Lights *lights, const LightSampleContext *point, int entry)
{
    if (lights->count == 1)
        return 1;
    float shares[EXACT_MOST];
    local_shares(lights, point, shares);
    return shares[entry];
}

/* Probability of an entry, or of a face of its mesh where faces are lights of their own. */
static float pick_probability(const Lights *lights, const LightSampleContext *point, int entry, int face)
{
    if (is_exact(lights))
        return exact_probability(lights, point, entry);
    const Entry *e = &lights->entries[entry];
    float share = tree_share(lights, point);
    if (e->leaf < 0)
        return (1 - share) * infinite_share(lights, e->infinite);
    return share * light_tree_probability(lights->tree, point, e->leaf + (is_by_face(e) ? face : 0));
}

static LightPick exact_pick(const Lights *lights, const LightSampleContext *point, float u, float u_part)
{
    if (lights->count == 1)
        return (LightPick){0, -1, 1, u_part};
    float shares[EXACT_MOST], sum = 0;
    local_shares(lights, point, shares);
    int k = 0;
    while (k < lights->count - 1 && u >= sum + shares[k])
        sum += shares[k++];
    while (k > 0 && shares[k] == 0)
        k--; /* u is just below 1: the last one that shines on the point */
    if (shares[k] == 0)
        return (LightPick){-1, -1, 1, u_part};
    return (LightPick){k, -1, shares[k], u_part};
}

static LightPick pick_infinite(const Lights *lights, float share, double u, float u_part)
{
    const float *sums = lights->infinite_sums;
    int low = 0, high = lights->ninfinite;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (sums[middle] <= u * sums[lights->ninfinite])
            low = middle;
        else
            high = middle;
    }
    return (LightPick){lights->infinite[low], -1, share * infinite_share(lights, low), u_part};
}

LightPick lights_pick(const Lights *lights, const LightSampleContext *point, float u_pick, float u_part)
{
    if (lights->count == 0)
        return (LightPick){-1, -1, 1, u_part};
    if (is_exact(lights))
        return exact_pick(lights, point, u_pick, u_part);
    /* both numbers together: a path down a large tree takes more bits than a float has */
    double u = u_pick + u_part * 0x1p-24;
    float share = tree_share(lights, point), probability;
    if (u >= share)
        return pick_infinite(lights, 1 - share, (u - share) / (1 - share), u_part);
    u /= share;
    const Leaf *leaf = &lights->leaves[light_tree_pick(lights->tree, point, &u, &probability)];
    return (LightPick){leaf->entry, leaf->face, share * probability, fminf((float)u, 1 - 0x1p-24f)};
}

/* Sample a direction uniformly in the cone in which a sphere is seen from outside. The sample's surface is where that
 * direction meets the sphere. */
static int sample_sphere_cone(const Entry *e, const Scene *scene, Vec3 position, float u1, float u2,
                              LightSample *sample)
{
    Vec3 axis = vec_sub(e->center, position), s, t;
    double distance2 = vec_dot(axis, axis), sin2 = e->radius * e->radius / distance2;
    axis = vec_scale(axis, 1 / sqrt(distance2));
    vec_frame(axis, &s, &t);
    double one_minus = sin2 / (1 + sqrt(1 - sin2)), c = 1 - u1 * one_minus, sine = sqrt(fmax(0, 1 - c * c)),
           phi = 2 * PI * u2;
    Vec3 d = vec_add(vec_scale(axis, c), vec_add(vec_scale(s, sine * cos(phi)), vec_scale(t, sine * sin(phi))));
    double along = c * sqrt(distance2), off2 = distance2 * sine * sine;
    sample->direction = vec_normalize(d);
    sample->distance = along - sqrt(fmax(0, e->radius * e->radius - off2));
    sample->pdf = (float)(1 / (2 * PI * one_minus));
    Ray ray = {position, sample->direction, 0, INFINITY};
    Hit hit = {.t = sample->distance, .primitive = e->index};
    surface_at(&sample->surface, scene, &ray, &hit);
    return 1;
}

static int outside_sphere(const Entry *e, Vec3 position)
{
    Vec3 d = vec_sub(position, e->center);
    return e->sphere && vec_dot(d, d) > e->radius * e->radius * 1.0001;
}

/* The picked face of an emitting mesh, and the density of points on it. */
static const MeshLightFace *picked_face(const Lights *lights, const LightPick *pick, double *density)
{
    const MeshLight *mesh = lights->entries[pick->entry].mesh;
    const MeshLightFace *f = &mesh->faces[pick->face >= 0 ? pick->face : mesh_light_face(mesh, pick->u_part)];
    *density = (pick->face >= 0 ? 1 : f->share) * f->inverse_area;
    return f;
}

/* Sample a point of an emitter by area; returns its density, or 0 where nothing is left of an operand of CSG. */
static double sample_area(const Lights *lights, const LightPick *pick, float u1, float u2, Surface *surface)
{
    const Entry *e = &lights->entries[pick->entry];
    const Primitive *p = &lights->scene->primitives[e->index];
    double density;
    if (!e->mesh)
        shape_sample(p, -1, u1, u2, surface, &density);
    else
        mesh_light_point(picked_face(lights, pick, &density), p, u1, u2, surface);
    return p->csg && !csg_on_surface(p->csg, surface->position) ? 0 : density;
}

const MeshLightFace *lights_uniform_face(const Lights *lights, const LightPick *pick, double *density)
{
    if (pick->entry < 0)
        return NULL;
    const Entry *e = &lights->entries[pick->entry];
    if (!e->mesh || lights->scene->primitives[e->index].no_reflection || lights->scene->primitives[e->index].csg)
        return NULL;
    const MeshLightFace *f = picked_face(lights, pick, density);
    return f->uniform ? f : NULL;
}

static int sample_emitter(const Lights *lights, const LightPick *pick, Vec3 position, float u1, float u2,
                          LightSample *sample)
{
    sample->kind = LIGHT_SAMPLE_EMITTER;
    const Entry *e = &lights->entries[pick->entry];
    if (outside_sphere(e, position))
        return sample_sphere_cone(e, lights->scene, position, u1, u2, sample);
    double pdf_area = sample_area(lights, pick, u1, u2, &sample->surface);
    Vec3 d = vec_sub(sample->surface.position, position);
    sample->distance = vec_length(d);
    if (!(sample->distance > 0 && pdf_area > 0))
        return 0;
    sample->direction = vec_scale(d, 1 / sample->distance);
    double cosine = fabs(vec_dot(sample->direction, sample->surface.geometric_normal));
    if (!(cosine > 1e-9))
        return 0;
    surface_turn(&sample->surface, vec_dot(sample->direction, sample->surface.geometric_normal) > 0);
    sample->pdf = (float)(pdf_area * sample->distance * sample->distance / cosine);
    return 1;
}

const Light *lights_picked_source(const Lights *lights, const LightPick *pick)
{
    const Entry *e = pick->entry >= 0 ? &lights->entries[pick->entry] : NULL;
    return e && e->kind == ENTRY_SOURCE ? &lights->scene->lights[e->index] : NULL;
}

int lights_sample(const Lights *lights, const LightSampleContext *point, const LightPick *pick, float u1, float u2,
                  LightSample *sample)
{
    if (pick->entry < 0)
        return 0;
    Vec3 position = point->position;
    const Entry *e = &lights->entries[pick->entry];
    sample->pick_probability = pick->probability;
    sample->shadowless = 0;
    if (e->kind == ENTRY_EMITTER)
        return sample_emitter(lights, pick, position, u1, u2, sample);
    if (e->kind == ENTRY_SKY) {
        sample->kind = LIGHT_SAMPLE_SKY;
        sample->direction = environment_sample(lights->environment, u1, u2, &sample->pdf);
        sample->distance = INFINITY;
        sample->radiance = sky_radiance(lights->scene, sample->direction, 0);
        return sample->pdf > 0;
    }
    return source_sample(&lights->scene->lights[e->index], position, u1, u2, sample);
}

/* Density per unit area of the shape where a path met it; *face: of the mesh light. 0 where it does not emit. */
static double area_density(const Entry *e, const Surface *surface, int *face)
{
    *face = -1;
    if (!e->mesh)
        return shape_pdf_area(surface->primitive, surface);
    *face = e->mesh->of_face[surface->face];
    if (*face < 0)
        return 0;
    const MeshLightFace *f = &e->mesh->faces[*face];
    return (is_by_face(e) ? 1 : f->share) * f->inverse_area;
}

float lights_emitter_pdf(const Lights *lights, const LightSampleContext *from, int primitive, const Surface *surface)
{
    int k = lights->of_primitive[primitive], face = -1;
    if (k < 0)
        return 0;
    const Entry *e = &lights->entries[k];
    Vec3 d = vec_sub(surface->position, from->position);
    double distance2 = vec_dot(d, d), pdf;
    if (outside_sphere(e, from->position)) {
        Vec3 axis = vec_sub(e->center, from->position);
        double sin2 = e->radius * e->radius / vec_dot(axis, axis);
        /* points on the far side of the sphere are never sampled from here */
        if (vec_dot(d, vec_sub(surface->position, e->center)) > 0)
            return 0;
        pdf = (1 + sqrt(1 - sin2)) / (2 * PI * sin2);
    } else {
        double cosine = fabs(vec_dot(d, surface->geometric_normal)) / sqrt(distance2);
        double area = area_density(e, surface, &face);
        pdf = cosine > 1e-9 ? area * distance2 / cosine : 0;
    }
    return pdf > 0 ? (float)pdf * pick_probability(lights, from, k, face) : 0;
}

float lights_sky_pdf(const Lights *lights, const LightSampleContext *from, Vec3 direction)
{
    if (lights->sky < 0)
        return 0;
    return environment_pdf(lights->environment, direction) * pick_probability(lights, from, lights->sky, -1);
}

/* ---- emission: where photons start ---- */

int lights_emit(const Lights *lights)
{
    return lights->nemitters > 0 && lights->emitter_sums[lights->nemitters] > 0;
}

#define SMALL 6.0 /* so many radii away */
#define MUCH 0.1  /* of all power */

int lights_small_emitter(const Lights *lights, Vec3 from)
{
    double power = 0;
    for (int k = 0; k < lights->nemitters; k++) {
        const Entry *e = &lights->entries[k];
        power += vec_length(vec_sub(e->center, from)) > SMALL * e->radius ? e->strength : 0;
    }
    return power > 0 && power >= MUCH * lights->emitter_sums[lights->nemitters];
}

int lights_emission(const Lights *lights, float u_pick, float u_part, float u1, float u2, EmissionPoint *point)
{
    if (!lights_emit(lights))
        return 0;
    double wanted = u_pick * lights->emitter_sums[lights->nemitters];
    int low = 0, high = lights->nemitters;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (lights->emitter_sums[middle] <= wanted)
            low = middle;
        else
            high = middle;
    }
    LightPick whole = {low, -1, 1, u_part};
    Surface surface;
    double density = sample_area(lights, &whole, u1, u2, &surface);
    double part = lights->entries[low].strength / lights->emitter_sums[lights->nemitters];
    if (!(density > 0 && part > 0))
        return 0;
    float radiance = rgb_luminance(texture_emission(surface.texture)) * NEUTRAL_ALBEDO;
    *point = (EmissionPoint){surface.position, surface.geometric_normal, radiance / (float)(density * part)};
    return 1;
}

float lights_estimate(const Lights *lights, const LightSampleContext *point)
{
    float sum = 0;
    if (is_exact(lights)) {
        for (int k = 0; k < lights->count; k++)
            sum += entry_estimate(lights, &lights->entries[k], point->position);
        return sum;
    }
    if (lights->tree)
        sum = light_tree_estimate(lights->tree, point);
    return lights->ninfinite > 0 ? sum + lights->infinite_sums[lights->ninfinite] : sum;
}
