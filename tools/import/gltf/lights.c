/* Lights of a glTF file: of its nodes, and what extras say of their size. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/gltf/gltf.h"
#include "import/gltf/json.h"
#include "import/gltf/parts.h"

/* glTF counts in candela and lux. Blender writes 683 lumens for a watt; of other programs the numbers are taken as
 * they are. */
static double photometric(const json_t *json)
{
    const char *generator = json_string_value(json_object_get(json_object_get(json, "asset"), "generator"));
    return generator && strstr(generator, "Blender I/O") ? 1 / 683.0 : 1;
}

/* ---- reading ---- */

static void take_color(const json_t *color, double factor, double to[3])
{
    for (size_t k = 0; k < 3; k++) {
        const json_t *value = json_array_get(color, k);
        to[k] = fmax(json_is_number(value) ? json_number_value(value) : 1, 0) * factor;
        if (!isfinite(to[k]))
            to[k] = 0;
    }
}

static const json_t *punctual_of(const json_t *json, const json_t *node)
{
    const json_t *index = json_object_get(gltf_extension(node, "KHR_lights_punctual"), "light");
    const json_t *lights = json_object_get(gltf_extension(json, "KHR_lights_punctual"), "lights");
    return json_is_integer(index) ? json_array_get(lights, (size_t)json_integer_value(index)) : NULL;
}

static int take_punctual(const json_t *json, const json_t *node, const json_t *light, GltfLight *to)
{
    const char *type = json_string_value(json_object_get(light, "type"));
    const json_t *spot = json_object_get(light, "spot"), *extras = gltf_extras(node);
    if (!type)
        return 0;
    to->type = strcmp(type, "directional") == 0 ? aiLightSource_DIRECTIONAL
               : strcmp(type, "spot") == 0      ? aiLightSource_SPOT
                                                : aiLightSource_POINT;
    if (json_array_size(json_object_get(extras, "intensity")) == 3)
        take_color(json_object_get(extras, "intensity"), 1, to->color);
    else
        take_color(json_object_get(light, "color"), gltf_number(light, "intensity", 1) * photometric(json), to->color);
    to->outer = gltf_number(spot, "outerConeAngle", PI / 4);
    to->inner = gltf_number(extras, "inner", gltf_number(spot, "innerConeAngle", 0));
    to->tightness = fmin(fmax(gltf_number(extras, "tightness", 0), 0), 100);
    to->radius = fmax(gltf_number(extras, "radius", 0), 0);
    to->angle = fmin(fmax(gltf_number(extras, "angle", 0), 0), PI / 2);
    to->is_seen = gltf_flag(extras, "visible");
    return 1;
}

static int take_area(const json_t *node, GltfLight *to)
{
    const json_t *extras = gltf_extras(node), *size = json_object_get(extras, "size");
    const char *shape = json_string_value(json_object_get(extras, "shape"));
    if (json_array_size(size) != 2 || json_array_size(json_object_get(extras, "radiance")) != 3)
        return 0;
    to->type = aiLightSource_AREA;
    to->width = json_number_value(json_array_get(size, 0));
    to->height = json_number_value(json_array_get(size, 1));
    to->is_ellipse = shape && strcmp(shape, "ellipse") == 0;
    to->is_seen = gltf_flag(extras, "visible");
    take_color(json_object_get(extras, "radiance"), 1, to->color);
    return to->width > 0 && to->height > 0 && isfinite(to->width + to->height);
}

static int take_light(Import *import, const json_t *json, const GltfNode *at, void *context)
{
    const json_t *node = at->json;
    Gltf *gltf = &import->gltf;
    size_t *capacity = context;
    const json_t *punctual = punctual_of(json, node);
    GltfLight light = {.place = at->place};
    if (!at->is_shown || (!take_punctual(json, node, punctual, &light) && !take_area(node, &light)))
        return 1;
    if ((size_t)gltf->nlights == *capacity) {
        GltfLight *more = realloc(gltf->lights, (2 * *capacity + 4) * sizeof *more);
        if (!more)
            return 0;
        gltf->lights = more;
        *capacity = 2 * *capacity + 4;
    }
    gltf_node_name(json, node, punctual, light.name);
    gltf->lights[gltf->nlights++] = light;
    return 1;
}

int gltf_take_lights(Import *import, const json_t *json)
{
    size_t capacity = 0;
    return gltf_visit_nodes(import, json, take_light, &capacity);
}

/* ---- writing ---- */

static void print_color(FILE *out, const double c[3], double factor)
{
    fprintf(out, "rgb <%.6g, %.6g, %.6g>", c[0] * factor, c[1] * factor, c[2] * factor);
}

/* What shines itself; seen by the camera if it says so. An area light is in no light's way, as in Cycles: light from
 * other surfaces passes it too, and so mirrors do not show it. */
static void print_emission(FILE *out, const GltfLight *light, double factor)
{
    fprintf(out, " texture { pigment { rgb 1 } finish { diffuse 0 emission ");
    print_color(out, light->color, factor);
    fprintf(out, " } }");
    if (light->type == aiLightSource_AREA)
        fprintf(out, " interior_texture { pigment { rgbt 1 } finish { diffuse 0 } } no_reflection");
    fprintf(out, "%s no_shadow", light->is_seen ? "" : " no_image");
}

static void write_area(const Affine *node, const GltfLight *light, double user, FILE *out)
{
    const Affine sized = {{{light->width, 0, 0, 0}, {0, light->height, 0, 0}, {0, 0, 1, 0}}};
    const Affine place = affine_multiply(node, &sized), mirrored = affine_mirror_z(&place);
    fprintf(out, light->is_ellipse ? "disc { 0, z, 0.5"
                                   : "polygon { 5, <-0.5, -0.5>, <0.5, -0.5>, <0.5, 0.5>, <-0.5, 0.5>, <-0.5, -0.5>");
    print_emission(out, light, user);
    affine_print(out, &mirrored);
    fprintf(out, " }\n");
}

/* A disc of lights that faces what it shines on. With jitter, a grid of 5 covers 5/4 of its axes. */
static void print_disc(FILE *out, double radius)
{
    if (radius > 0)
        fprintf(out, " area_light x*%.6g, y*%.6g, 5, 5 circular orient jitter area_illumination", 1.6 * radius,
                1.6 * radius);
}

static void write_sun(const Import *import, const double to[3], const GltfLight *light, double user, FILE *out)
{
    double middle[3], at[3], radius = 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = (import->low[k] + import->high[k]) / 2;
        radius += pow((import->high[k] - import->low[k]) / 2, 2);
    }
    const double distance = 2 * (sqrt(radius) + 1);
    for (int k = 0; k < 3; k++)
        at[k] = middle[k] - to[k] * distance;
    vector_print(out, "light_source { ", at, ", ");
    print_color(out, light->color, user / PI);
    vector_print(out, " parallel point_at ", middle, "");
    print_disc(out, distance * tan(light->angle / 2));
    fprintf(out, " }\n");
}

/* POV-Ray's falloff is 2 / (1 + (d / distance)^2); intensity / d^2 is the irradiance. */
static void write_lamp(const Import *import, const double at[3], const double to[3], const GltfLight *light,
                       double user, FILE *out)
{
    const double scale = import->options->scale, near = 0.02;
    vector_print(out, "light_source { ", at, ", ");
    print_color(out, light->color, user * scale * scale / (2 * PI * near * near));
    if (light->type == aiLightSource_SPOT) {
        const double outer = fmin(fmax(light->outer * 180 / PI, 0), 90), inner = fmax(light->inner * 180 / PI, 0);
        const double point[3] = {at[0] + to[0], at[1] + to[1], at[2] + to[2]};
        fprintf(out, " spotlight radius %.5g falloff %.5g", fmin(inner, outer - 0.01), outer);
        if (light->tightness > 0)
            fprintf(out, " tightness %.4g", light->tightness);
        print_disc(out, light->radius * scale);
        vector_print(out, " point_at ", point, "");
    }
    fprintf(out, " fade_distance %.6g fade_power 2 }\n", near);
}

static void write_light(Import *import, const GltfLight *light, double user, FILE *out)
{
    const Affine node = light->place;
    const double origin[3] = {0, 0, 0}, ahead[3] = {0, 0, -1};
    double at[3], to[3];
    char plain[NAME_SIZE];
    affine_point(&node, origin, at);
    affine_vector(&node, ahead, to);
    at[2] = 0 - at[2], to[2] = 0 - to[2];
    const double length = sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    if (!affine_is_finite(&node) || !(length > 0)) {
        import_leave_out(import, LEFT_NOWHERE);
        return;
    }
    for (int k = 0; k < 3; k++)
        to[k] /= length;
    fprintf(out, "// %s\n", import_plain(light->name, plain));
    if (light->type == aiLightSource_AREA)
        write_area(&node, light, user, out);
    else if (light->type == aiLightSource_DIRECTIONAL)
        write_sun(import, to, light, user, out);
    else if (light->type == aiLightSource_POINT && light->radius > 0) {
        fprintf(out, "sphere { 0, %.6g", light->radius * import->options->scale);
        print_emission(out, light, user / (PI * light->radius * light->radius));
        vector_print(out, " translate ", at, " }\n");
    } else
        write_lamp(import, at, to, light, user, out);
}

int gltf_lights_write(Import *import, double user, FILE *out)
{
    for (int i = 0; i < import->gltf.nlights; i++)
        write_light(import, &import->gltf.lights[i], user, out);
    return import->gltf.nlights > 0;
}
