/* The list of all lights and the choice among them. */
#include <stdlib.h>
#include <string.h>
#include "light/lights.h"
#include "shade/bsdf.h"

#define LOCAL_CHOICE_MAX 48 /* up to here a light is chosen by what it may give at the point; beyond, by power alone */
#define CHOICE_FLOOR 0.02f  /* every light keeps at least this share of an equal choice: estimates may be wrong */

typedef enum EntryKind { ENTRY_SOURCE, ENTRY_EMITTER, ENTRY_SKY } EntryKind;

typedef struct Entry {
    EntryKind kind;
    int index;   /* of the source or primitive */
    Vec3 center; /* emitter: of its bounds */
    double radius;
    double area;
    float strength;    /* emitter: radiance * area; sky: irradiance; source: luminance of its colour times pi */
    double *face_sums; /* mesh emitters: running sums of face areas, nfaces + 1 */
    int sphere;        /* sampled by the cone it is seen in */
} Entry;

struct Lights {
    const Scene *scene;
    Environment *environment;
    int count, sky; /* sky: index of its entry, or -1 */
    Entry *entries;
    int *of_primitive; /* entry of each primitive, or -1 */
    float *power_sums; /* count + 1, for many lights */
};

static int primitive_emits(const Primitive *p)
{
    return !rgb_is_black(p->texture->finish->emission);
}

static int mesh_emits(const Primitive *p, int face)
{
    int t = p->mesh->faces[face].texture;
    const Texture *texture = t < 0 ? p->texture : p->mesh->textures[t];
    return !rgb_is_black(texture->finish->emission);
}

/* Running sums of the areas of the faces that emit; returns their total. */
static double mesh_sums(Entry *entry, const Primitive *p)
{
    double total = 0;
    entry->face_sums = calloc((size_t)p->mesh->nfaces + 1, sizeof(double));
    if (!entry->face_sums)
        return -1;
    for (int k = 0; k < p->mesh->nfaces; k++) {
        if (mesh_emits(p, k))
            total += mesh_face_area(p, k);
        entry->face_sums[k + 1] = total;
    }
    return total;
}

/* A sphere under rotation, translation and equal scaling. */
static int is_round_sphere(const Primitive *p, double *radius)
{
    if (p->kind != SHAPE_SPHERE)
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
    Rgb emission = p->texture->finish->emission;
    if (p->kind == SHAPE_MESH) {
        e.area = mesh_sums(&e, p);
        if (e.area < 0)
            return retex_fail(err, RETEX_ENOMEM, "out of memory for an emitter's faces");
        for (int k = 0; k < p->mesh->nfaces && rgb_is_black(emission); k++)
            if (mesh_emits(p, k))
                emission = p->mesh->textures[p->mesh->faces[k].texture]->finish->emission;
    } else if (primitive_emits(p)) {
        e.area = shape_area(p);
    }
    Vec3 low, high;
    if (!(e.area > 0) || !shape_bounds(p, &low, &high)) {
        free(e.face_sums);
        return RETEX_OK;
    }
    e.center = vec_scale(vec_add(low, high), 0.5);
    e.radius = vec_length(vec_sub(high, low)) / 2;
    double r;
    e.sphere = is_round_sphere(p, &r);
    if (e.sphere)
        e.radius = r;
    e.strength = rgb_luminance(emission) * NEUTRAL_ALBEDO * (float)e.area;
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
    /* A sky of one colour is found as well by the BSDF alone, without noise where nothing is in the way. */
    if (!lights->environment || !lights->scene->sky)
        return;
    lights->sky = lights->count;
    lights->entries[lights->count++] =
        (Entry){.kind = ENTRY_SKY, .strength = environment_mean(lights->environment) * (float)PI};
}

static void sum_powers(Lights *lights)
{
    float total = 0;
    lights->power_sums[0] = 0;
    for (int k = 0; k < lights->count; k++)
        lights->power_sums[k + 1] = total += lights->entries[k].strength;
    float floor_share = total * CHOICE_FLOOR / (float)(lights->count ? lights->count : 1), sum = 0;
    for (int k = 0; k < lights->count; k++)
        lights->power_sums[k + 1] = sum += lights->entries[k].strength + floor_share;
    for (int k = 1; k <= lights->count; k++)
        lights->power_sums[k] /= sum > 0 ? sum : 1;
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
    lights->power_sums = calloc(most + 1, sizeof *lights->power_sums);
    int code = RETEX_OK;
    if (!lights->entries || !lights->of_primitive || !lights->power_sums)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory for %d lights", (int)most);
    if (!code)
        code = environment_create(&lights->environment, scene, err);
    for (int k = 0; k < scene->nprimitives && !code; k++) {
        lights->of_primitive[k] = -1;
        code = add_emitter(lights, k, err);
    }
    if (code) {
        lights_close(out);
        return code;
    }
    add_others(lights);
    sum_powers(lights);
    return RETEX_OK;
}

void lights_close(Lights **lights)
{
    if (!*lights)
        return;
    for (int k = 0; k < (*lights)->count; k++)
        free((*lights)->entries[k].face_sums);
    environment_close(&(*lights)->environment);
    free((*lights)->entries);
    free((*lights)->of_primitive);
    free((*lights)->power_sums);
    free(*lights);
    *lights = NULL;
}

int lights_count(const Lights *lights)
{
    return lights->count;
}

/* Rough irradiance an entry may give at a point that faces it. */
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

/* Shares of the choice at a point, adding up to 1. */
static void local_shares(const Lights *lights, Vec3 position, float *shares)
{
    float total = 0;
    for (int k = 0; k < lights->count; k++)
        total += shares[k] = entry_estimate(lights, &lights->entries[k], position);
    float least = total > 0 ? total * CHOICE_FLOOR / (float)lights->count : 1, sum = 0;
    for (int k = 0; k < lights->count; k++)
        sum += shares[k] += least;
    for (int k = 0; k < lights->count; k++)
        shares[k] /= sum;
}

static float pick_probability(const Lights *lights, Vec3 position, int entry)
{
    if (lights->count == 1)
        return 1;
    if (lights->count > LOCAL_CHOICE_MAX)
        return lights->power_sums[entry + 1] - lights->power_sums[entry];
    float shares[LOCAL_CHOICE_MAX];
    local_shares(lights, position, shares);
    return shares[entry];
}

static int pick(const Lights *lights, Vec3 position, float u, float *probability)
{
    *probability = 1;
    if (lights->count == 1)
        return 0;
    if (lights->count > LOCAL_CHOICE_MAX) {
        int low = 0, high = lights->count;
        while (high - low > 1) {
            int middle = (low + high) / 2;
            if (lights->power_sums[middle] <= u)
                low = middle;
            else
                high = middle;
        }
        *probability = lights->power_sums[low + 1] - lights->power_sums[low];
        return low;
    }
    float shares[LOCAL_CHOICE_MAX], sum = 0;
    local_shares(lights, position, shares);
    int k = 0;
    while (k < lights->count - 1 && u >= sum + shares[k])
        sum += shares[k++];
    *probability = shares[k];
    return k;
}

/* Uniform in the cone in which a sphere is seen from outside. The sample's surface lies where that direction meets
 * it. */
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

static int find_face(const Entry *e, int count, float u)
{
    double wanted = u * e->face_sums[count];
    int low = 0, high = count;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (e->face_sums[middle] <= wanted)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static int sample_emitter(const Lights *lights, const Entry *e, Vec3 position, float u_part, float u1, float u2,
                          LightSample *sample)
{
    const Primitive *p = &lights->scene->primitives[e->index];
    sample->kind = LIGHT_SAMPLE_EMITTER;
    if (outside_sphere(e, position))
        return sample_sphere_cone(e, lights->scene, position, u1, u2, sample);
    double pdf_area;
    int face = e->face_sums ? find_face(e, p->mesh->nfaces, u_part) : (int)(u_part * 6);
    shape_sample(p, lights->scene, face, u1, u2, &sample->surface, &pdf_area);
    if (e->face_sums)
        pdf_area = 1 / e->area;
    Vec3 d = vec_sub(sample->surface.position, position);
    sample->distance = vec_length(d);
    if (!(sample->distance > 0))
        return 0;
    sample->direction = vec_scale(d, 1 / sample->distance);
    double cosine = fabs(vec_dot(sample->direction, sample->surface.geometric_normal));
    if (!(cosine > 1e-9))
        return 0;
    surface_turn(&sample->surface, vec_dot(sample->direction, sample->surface.geometric_normal) > 0);
    sample->pdf = (float)(pdf_area * sample->distance * sample->distance / cosine);
    return 1;
}

int lights_sample(const Lights *lights, Vec3 position, float u_pick, float u_part, float u1, float u2,
                  LightSample *sample)
{
    if (lights->count == 0)
        return 0;
    float probability;
    const Entry *e = &lights->entries[pick(lights, position, u_pick, &probability)];
    sample->pick_probability = probability;
    sample->shadowless = 0;
    if (e->kind == ENTRY_EMITTER)
        return sample_emitter(lights, e, position, u_part, u1, u2, sample);
    if (e->kind == ENTRY_SKY) {
        sample->kind = LIGHT_SAMPLE_SKY;
        sample->direction = environment_sample(lights->environment, u1, u2, &sample->pdf);
        sample->distance = INFINITY;
        sample->radiance = sky_radiance(lights->scene, sample->direction);
        return sample->pdf > 0;
    }
    const Light *light = &lights->scene->lights[e->index];
    sample->kind = LIGHT_SAMPLE_SOURCE;
    sample->pdf = 0;
    sample->shadowless = light->shadowless;
    sample->radiance = source_irradiance(light, position, source_point(light, position, u1, u2), &sample->direction,
                                         &sample->distance);
    return !rgb_is_black(sample->radiance);
}

float lights_emitter_pdf(const Lights *lights, Vec3 from, int primitive, const Surface *surface)
{
    int k = lights->of_primitive[primitive];
    if (k < 0)
        return 0;
    const Entry *e = &lights->entries[k];
    Vec3 d = vec_sub(surface->position, from);
    double distance2 = vec_dot(d, d), pdf;
    if (outside_sphere(e, from)) {
        Vec3 axis = vec_sub(e->center, from);
        double sin2 = e->radius * e->radius / vec_dot(axis, axis);
        /* the far side of the sphere is never sampled from here */
        if (vec_dot(d, vec_sub(surface->position, e->center)) > 0)
            return 0;
        pdf = (1 + sqrt(1 - sin2)) / (2 * PI * sin2);
    } else {
        double cosine = fabs(vec_dot(d, surface->geometric_normal)) / sqrt(distance2);
        double area = e->face_sums ? 1 / e->area : shape_pdf_area(surface->primitive, surface);
        pdf = cosine > 1e-9 ? area * distance2 / cosine : 0;
    }
    return (float)pdf * pick_probability(lights, from, k);
}

float lights_sky_pdf(const Lights *lights, Vec3 from, Vec3 direction)
{
    if (lights->sky < 0)
        return 0;
    return environment_pdf(lights->environment, direction) * pick_probability(lights, from, lights->sky);
}
