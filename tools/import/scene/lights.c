/* Light sources and the sky. A light_source of colour c gives an irradiance of pi c. */
#include <math.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/gltf/gltf.h"
#include "import/base/look_text.h"
#include "import/scene/images.h"
#include "import/scene/scene.h"
#include "import/scene/surface.h"

typedef struct Falloff {
    double factor, distance, power; /* of the colour; power 0 = none */
} Falloff;

/* POV-Ray's is 2 / (1 + (d / distance)^power). */
static Falloff falloff_of(const Import *import, const struct aiLight *light)
{
    const double scale = import->options->scale;
    const double c = fmax((double)light->mAttenuationConstant, 0), l = fmax((double)light->mAttenuationLinear, 0);
    const double q = fmax((double)light->mAttenuationQuadratic, 0), near = 0.02;
    if (q > 1e-12 && c > 1e-6)
        return (Falloff){0.5 / c, sqrt(c / q) * scale, 2};
    if (q > 1e-12)
        return (Falloff){0.5 * scale * scale / (q * near * near), near, 2};
    if (l > 1e-12 && c > 1e-6)
        return (Falloff){0.5 / c, c / l * scale, 1};
    return (Falloff){c > 1e-6 ? 1 / c : 1, 0, 0};
}

static void print_color(FILE *out, const struct aiLight *light, double factor)
{
    const struct aiColor3D *c = &light->mColorDiffuse;
    const double rgb[3] = {(double)c->r, (double)c->g, (double)c->b};
    fprintf(out, ", rgb <");
    for (int k = 0; k < 3; k++)
        fprintf(out, "%s%.6g", k ? ", " : "", isfinite(rgb[k]) && rgb[k] > 0 ? rgb[k] * factor : 0);
    fprintf(out, ">");
}

/* Degrees from the axis; formats have the whole cone. */
static double half_angle(float angle)
{
    const double degrees = (double)angle * 90 / PI;
    return isfinite(degrees) ? fmin(fmax(degrees, 0), 90) : 45;
}

static void print_spot(const struct aiLight *light, FILE *out)
{
    const double outer = half_angle(light->mAngleOuterCone);
    const double inner = fmin(half_angle(light->mAngleInnerCone), outer);
    fprintf(out, " spotlight radius %.5g falloff %.5g", fmin(inner, outer - 0.01), outer);
}

static int is_left_out(const struct aiLight *light)
{
    return light->mType == aiLightSource_AMBIENT || light->mType == aiLightSource_UNDEFINED;
}

/* Formats but glTF have no unit of light, and programs write watts, per cents or factors. Where the lights would
 * leave the middle of the scene black or white, they are scaled together. */
static double exposure(const Import *import)
{
    double sum = 0;
    for (unsigned i = 0; i < import->scene->mNumLights; i++) {
        const struct aiLight *light = import->scene->mLights[i];
        const struct aiVector3D *p = &light->mPosition;
        const struct aiColor3D *c = &light->mColorDiffuse;
        const Affine node = import->light_places[i].world;
        double at[3], squared = 0, color = fmax((double)c->r, fmax((double)c->g, (double)c->b));
        affine_point(&node, (double[3]){(double)p->x, (double)p->y, (double)p->z}, at);
        at[2] = -at[2];
        for (int k = 0; k < 3; k++)
            squared += pow(at[k] - (import->low[k] + import->high[k]) / 2, 2);
        if (light->mType != aiLightSource_DIRECTIONAL) {
            const Falloff f = falloff_of(import, light);
            color *= f.factor * (f.power > 0 ? 2 / (1 + pow(sqrt(squared) / f.distance, f.power)) : 1);
        }
        if (!is_left_out(light) && import->light_places[i].is_known && isfinite(color))
            sum += color;
    }
    return sum > 0 && (sum > 4 || sum < 0.1) ? 1 / sum : 1;
}

static void write_light(Import *import, unsigned index, double user, FILE *out)
{
    const struct aiLight *light = import->scene->mLights[index];
    const Affine node = import->light_places[index].world;
    const double p[3] = {(double)light->mPosition.x, (double)light->mPosition.y, (double)light->mPosition.z};
    const double d[3] = {(double)light->mDirection.x, (double)light->mDirection.y, (double)light->mDirection.z};
    double at[3], to[3], middle[3], radius = 0;
    char plain[NAME_SIZE];
    affine_point(&node, p, at);
    affine_vector(&node, d, to);
    at[2] = 0 - at[2], to[2] = 0 - to[2];
    double length = sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    if (!(length > 0) || !isfinite(length))
        to[0] = to[2] = 0, to[1] = -1, length = 1;
    for (int k = 0; k < 3; k++) {
        to[k] /= length;
        middle[k] = (import->low[k] + import->high[k]) / 2;
        radius += pow((import->high[k] - import->low[k]) / 2, 2);
    }
    if (!isfinite(at[0] + at[1] + at[2] + to[0] + to[1] + to[2])) {
        import_leave_out(import, LEFT_NOWHERE);
        return;
    }
    fprintf(out, "// %s\nlight_source {", import_plain(light->mName.data, plain));
    if (light->mType == aiLightSource_DIRECTIONAL) {
        for (int k = 0; k < 3; k++)
            at[k] = middle[k] - to[k] * 2 * (sqrt(radius) + 1);
        vector_print(out, " ", at, "");
        print_color(out, light, user);
        vector_print(out, " parallel point_at ", middle, "");
    } else {
        const Falloff falloff = falloff_of(import, light);
        vector_print(out, " ", at, "");
        print_color(out, light, user * falloff.factor);
        if (light->mType == aiLightSource_SPOT)
            print_spot(light, out);
        if (light->mType == aiLightSource_AREA && light->mSize.x > 0 && light->mSize.y > 0)
            fprintf(out, " area_light x*%.6g, z*%.6g, 5, 5 area_illumination jitter",
                    (double)light->mSize.x * import->options->scale, (double)light->mSize.y * import->options->scale);
        if (light->mType == aiLightSource_SPOT) {
            for (int k = 0; k < 3; k++)
                to[k] += at[k];
            vector_print(out, " point_at ", to, "");
        }
        if (falloff.power > 0)
            fprintf(out, " fade_distance %.6g fade_power %g", falloff.distance, falloff.power);
    }
    fprintf(out, " }\n");
}

static int write_sky(Import *import, FILE *out, RetexError *err)
{
    char file[NAME_SIZE + 32];
    const int code = images_add_sky(import, file, err);
    if (!code) /* seen from inside */
        fprintf(out, "sky_sphere { pigment { image_map { %s \"%s\" map_type 1 interpolate 2 } scale <-1, 1, 1> } }\n\n",
                images_keyword(file), file);
    return code;
}

/* Light for models that have none, or too little of it: a soft sky; in a room that it does not reach, a lamp below the
 * ceiling. Those that have some get it switched off, and tools/import/look.h finds out whether it is needed. */
static int write_added(Import *import, FILE *out, int has_light, RetexError *err)
{
    int is_dark = 0, has_lamp = 0;
    int code = ceiling_is_needed(import, &is_dark, err);
    if (code)
        return code;
    fprintf(out, "// Light that the model lacks: how bright it is, 0 where there is enough without.\n");
    code = ceiling_write(import, out, is_dark && !has_light, &has_lamp, err);
    if (!is_dark || !has_lamp)
        fprintf(out,
                LOOK_DECLARE(LOOK_ADDED_SKY) LOOK_ADDED_FORMAT ";\n#if (" LOOK_ADDED_SKY " > 0)\n"
                "sky_sphere { pigment { gradient y color_map { [0 rgb 0.3*" LOOK_ADDED_SKY "] [1 rgb " LOOK_ADDED_SKY
                "] } scale 2 translate -y } }\n#end\n",
                has_light ? 0.0 : 1.0);
    fprintf(out, "\n");
    if (!code && !has_light)
        import_tell(import, IMPORT_INFO, is_dark && has_lamp
                                             ? "no light in the model, and no opening in the room: a light below the "
                                               "ceiling, Ceiling_light, lights it"
                                             : "no light in the model: a soft sky lights it");
    return code;
}

/* Programs write ambient lights that are black. */
static int is_bright(const struct aiColor3D *color)
{
    return color->r > 0 || color->g > 0 || color->b > 0;
}

static int write_lights(Import *import, FILE *out)
{
    const struct aiScene *scene = import->scene;
    const double scaled = exposure(import);
    int any = 0;
    if (scaled != 1)
        import_tell(import, IMPORT_INFO, "the lights of this format have no unit: they are scaled by %.3g", scaled);
    for (unsigned i = 0; i < scene->mNumLights; i++) {
        const struct aiLight *light = scene->mLights[i];
        if (is_left_out(light)) {
            if (is_bright(&light->mColorAmbient) || is_bright(&light->mColorDiffuse))
                import_leave_out(import, LEFT_AMBIENT_LIGHT);
            continue;
        }
        if (!import->light_places[i].is_known)
            continue;
        write_light(import, i, scaled * import->options->lights, out);
        any = 1;
    }
    return any;
}

int lights_write(Import *import, FILE *out, RetexError *err)
{
    fprintf(out, "// ---- light ----\n\n");
    const int any =
        import->is_gltf ? gltf_lights_write(import, import->options->lights, out) : write_lights(import, out);
    if (any)
        fprintf(out, "\n");
    return import->options->sky ? write_sky(import, out, err) : write_added(import, out, any || import->emits, err);
}
