/* Light groups of a picture as lamps of a set without targets; see <retex/denoise_picture.h>. Cycles writes a layer
 * Combined_NAME for each group; Combined itself has all light, also that of no group. The set has these numbers as they
 * are, and what denoising needs. */
#include <retex/denoise_picture.h>

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <retex/host/denoise_data.h>
#include <retex/host/set_build.h>
#include <retex/target_name.h>

#include "base/params.h"
#include "files/picture_input.h"
#include "set/set.h"

#define WHOLE "Combined"
#define NOISY "Noisy Image" /* the same before Blender has denoised it: the groups are as noisy */
#define REST "rest"
#define MUCH_BELOW_0 0.01 /* of the picture's light, to be told */

enum { LIGHTS_MAX = 16 };

typedef struct LightGroups {
    RetexPictureInput in;
    int whole; /* layer */
    int count;
    int layers[LIGHTS_MAX];
    char names[LIGHTS_MAX][RETEX_NAME_MAX]; /* of lamps */
    RetexImage rest;                        /* the picture without the groups */
    RetexImage rest_noise;
} LightGroups;

/* ---- which layers ---- */

/* What sets allow in names; underscores for all else. */
static void lamp_name(char name[RETEX_NAME_MAX], const char *given)
{
    snprintf(name, RETEX_NAME_MAX, "%s", given);
    for (char *c = name; *c; c++)
        if (!(*c & 0x80) && !isalnum((unsigned char)*c) && !strchr(" _-.+()", *c))
            *c = '_';
    if (strchr(" .", name[0]))
        name[0] = '_';
    if (name[strlen(name) - 1] == ' ')
        name[strlen(name) - 1] = '_';
}

static int add_name(LightGroups *of, int layer, const char *given, RetexError *err)
{
    const char *file = retex_input_name(of->in.file.input);
    char *name = of->names[of->count];
    if (of->count == LIGHTS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "%s has more than %d light groups, as many as a set may have lamps", file,
                          LIGHTS_MAX);
    lamp_name(name, given);
    if (!retex_target_name_is_valid(name))
        return retex_fail(err, RETEX_EUNSUPPORTED, "%s: the light group of layer %s has a name that no lamp can have",
                          file, retex_picture_input_text(&of->in, layer));
    if (strcasecmp(name, REST) == 0)
        return retex_fail(err, RETEX_EUNSUPPORTED,
                          "%s: a light group is called %s, as lamps call all other light: rename it", file, given);
    for (int k = 0; k < of->count; k++)
        if (strcasecmp(of->names[k], name) == 0)
            return retex_fail(err, RETEX_EUNSUPPORTED, "%s: two light groups would be the lamp %s: rename one", file,
                              name);
    of->layers[of->count++] = layer;
    return RETEX_OK;
}

/* The name of a group, if a layer is of one of the view layer; stem: length of that and its dot. */
static const char *name_of(const RetexPictureLayer *layer, const char *whole, size_t stem)
{
    static const char prefix[] = WHOLE "_";
    const char *own = layer->name + stem;
    const int is_light = layer->count == 3 && strncmp(layer->name, whole, stem) == 0 &&
                         strncmp(own, prefix, strlen(prefix)) == 0 && own[strlen(prefix)];
    return is_light ? own + strlen(prefix) : NULL;
}

/* The picture before it was denoised, of the same view layer. */
static int find_noisy(const RetexPictureLayers *layers, const char *whole, size_t stem)
{
    for (int k = 0; k < layers->count; k++)
        if (layers->of[k].count == 3 && strncmp(layers->of[k].name, whole, stem) == 0 &&
            strcmp(layers->of[k].name + stem, NOISY) == 0)
            return k;
    return -1;
}

static int find_layers(LightGroups *of, RetexError *err)
{
    RetexPictureInput *in = &of->in;
    const RetexPictureLayers *layers = &in->file.layers;
    const char *file = retex_input_name(in->file.input);
    of->whole = in->params.nlayers ? retex_picture_layer_named(layers, in->params.layers[0], file, err)
                                   : retex_picture_layer_beauty(layers, file, err);
    if (of->whole < 0)
        return of->whole;
    const char *whole = layers->of[of->whole].name, *dot = strrchr(whole, '.');
    const size_t stem = dot ? (size_t)(dot + 1 - whole) : 0;
    const int noisy = in->params.nlayers ? -1 : find_noisy(layers, whole, stem);
    int code = RETEX_OK;
    for (int k = 0; k < layers->count && !code; k++) {
        const char *given = name_of(&layers->of[k], whole, stem);
        if (given)
            code = add_name(of, k, given, err);
    }
    if (!code && !of->count)
        code = retex_fail(err, RETEX_ENOTFOUND, "%s has no light groups: no layer %.*s" WHOLE "_NAME", file, (int)stem,
                          whole);
    if (noisy >= 0)
        of->whole = noisy;
    in->beauty = of->whole;
    return code;
}

static int check_layers(LightGroups *of, const RetexBudget *budget, RetexError *err)
{
    RetexPictureInput *in = &of->in;
    const long most = retex_budget_pixels(budget);
    retex_exr_part_size(in->file.exr, in->file.layers.of[of->whole].part, &in->width, &in->height);
    if (most > 0 && (int64_t)in->width * in->height > most)
        return retex_fail(err, RETEX_ELIMIT, "%s is too large: %d x %d pixels, more than the %ld of --max-pixels",
                          retex_input_name(in->file.input), in->width, in->height, most);
    int code = retex_picture_check_layer(in, of->whole, err);
    for (int k = 0; k < of->count && !code; k++)
        code = retex_picture_check_layer(in, of->layers[k], err);
    return code;
}

/* ---- the set ---- */

/* Adds the light of all lamps, or of one, with its noise. */
static int add_light(RetexSet *set, const RetexImage *light, const RetexImage *noise, const char *lamp, RetexError *err)
{
    RetexTerm term = {.role = RETEX_ROLE_INDEP, .target = -1, .radiance = set->nparts};
    char name[RETEX_NAME_MAX] = "indep", word[RETEX_NAME_MAX], noise_name[RETEX_NAME_MAX];
    int code = RETEX_OK, parameter;
    retex_noise_part_name(noise_name, NULL, RETEX_SIGNAL_INDEP);
    if (lamp) {
        RetexParameter value = {
            .kind = RETEX_PARAMETER_COLOR, .target = -1, .value = {1, 1, 1}, .kept = {1, 1, 1}, .several = 1};
        snprintf(value.name, sizeof value.name, "%s", lamp);
        retex_lamp_word(word, lamp, NULL);
        snprintf(name, sizeof name, "%.90s_indep", word);
        retex_lamp_noise_part_name(noise_name, lamp, NULL, RETEX_SIGNAL_INDEP);
        term.role = RETEX_ROLE_LAMP;
        code = retex_set_add_parameter(set, &value, &parameter, err);
        if (!code)
            code = retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_PARAMETER, parameter), err);
    }
    if (!code)
        code = retex_picture_add_part(set, name, "RGB", RETEX_FLOAT, light, 0, err);
    if (!code)
        code = retex_picture_add_part(set, noise_name, "RGB", RETEX_FLOAT, noise, 0, err);
    return code ? code : retex_set_add_term(set, &term, NULL, err);
}

static void subtract(RetexImage *from, const RetexImage *image)
{
    for (size_t i = 0; i < retex_image_index(from, 0, from->height); i++)
        from->pixels[i] -= image->pixels[i];
}

/* Reads a layer and its noise, and adds it. */
static int add_layer(RetexSet *set, LightGroups *of, int layer, const char *lamp, RetexError *err)
{
    RetexImage light = {0}, noise = {0};
    RetexPictureInput *in = &of->in;
    int code = retex_picture_read_checked(&light, in, &in->file, layer, err);
    if (!code)
        code = retex_picture_find_noise(&light, &noise, in, layer, 1, err);
    if (!code && !lamp)
        code = retex_picture_add_part(set, "beauty", "RGB", RETEX_FLOAT, &light, 0, err);
    if (!code)
        code = add_light(set, &light, &noise, lamp, err);
    if (!code && lamp) {
        subtract(&of->rest, &light);
        subtract(&of->rest_noise, &noise);
    } else if (!code) {
        of->rest = light, of->rest_noise = noise;
        return code;
    }
    retex_image_free(&light);
    retex_image_free(&noise);
    return code;
}

/* Noise that was estimated does not add up: that of the rest is estimated as well. */
static int add_rest(RetexSet *set, LightGroups *of, RetexError *err)
{
    int code = RETEX_OK;
    if (!of->in.other.exr) {
        retex_image_free(&of->rest_noise);
        code = retex_picture_estimate_noise(&of->rest_noise, &of->rest, &of->in, of->in.file.layers.count, 1, err);
    }
    return code ? code : add_light(set, &of->rest, &of->rest_noise, REST, err);
}

/* What is of no group may be below 0 where the picture was filtered or clamped and the groups were not. */
static void tell_of_rest(const LightGroups *of, const RetexSet *set)
{
    const RetexImage *whole = &set->parts[0].image;
    double light = 0, rest = 0, below = 0;
    for (size_t i = 0; i < retex_image_index(whole, 0, whole->height); i++) {
        light += fabs((double)whole->pixels[i]);
        rest += fabs((double)of->rest.pixels[i]);
        below -= fmin((double)of->rest.pixels[i], 0);
    }
    retex_picture_note(&of->in, 0, "%d light group%s; %.2f%% of the light is of none, and is the lamp " REST, of->count,
                       of->count == 1 ? "" : "s", light > 0 ? 100 * rest / light : 0);
    if (below > MUCH_BELOW_0 * light)
        retex_picture_note(&of->in, 1,
                           "the light groups are brighter than the picture, by %.1f%%: the lamp " REST
                           " is below 0 there, as after denoising or clamping",
                           100 * below / light);
}

static int build(RetexSet **set, LightGroups *of, RetexError *err)
{
    RetexTerm picture = {.role = RETEX_ROLE_PICTURE, .target = -1, .radiance = 0};
    int code = retex_set_create(set, of->in.width, of->in.height, err);
    if (code)
        return code;
    strcpy((*set)->layout, "footprints");
    (*set)->spp = 2; /* halves of the same size */
    snprintf((*set)->generator, sizeof(*set)->generator, "light groups of a picture");
    code = add_layer(*set, of, of->whole, NULL, err);
    for (int k = 0; k < of->count && !code; k++)
        code = add_layer(*set, of, of->layers[k], of->names[k], err);
    if (!code)
        code = add_rest(*set, of, err);
    if (!code)
        code = retex_set_add_term(*set, &picture, NULL, err);
    if (!code)
        code = retex_picture_add_guides(*set, &of->in.guides, 1, err);
    if (!code)
        code = retex_picture_check_halves(&of->in, err);
    if (!code)
        tell_of_rest(of, *set);
    if (!code)
        retex_set_identify(*set);
    return code;
}

int retex_set_read_light_groups(RetexSet **set, const char *path, const RetexDenoisePictureParams *picture,
                                const RetexBudget *budget, int nthreads, RetexError *err)
{
    LightGroups of = {.in = {.params = RETEX_DENOISE_PICTURE_INIT, .beauty = -1, .nthreads = nthreads}};
    *set = NULL;
    int code = RETEX_PARAMS_COPY(&of.in.params, picture, err);
    if (!code && of.in.params.nlayers > 1)
        code = retex_fail(err, RETEX_EINVAL, "one layer has all light: %d are given", of.in.params.nlayers);
    if (!code && of.in.params.variance)
        code = retex_fail(err, RETEX_EINVAL, "a variance is that of one layer: light groups have noise of their own");
    if (!code)
        code = retex_picture_input_open(&of.in, path, err);
    if (!code)
        code = find_layers(&of, err);
    if (!code)
        code = check_layers(&of, budget, err);
    if (!code)
        code = retex_picture_load_guides(&of.in, err);
    if (!code)
        code = build(set, &of, err);
    if (code)
        retex_set_close(set);
    retex_image_free(&of.rest);
    retex_image_free(&of.rest_noise);
    retex_picture_input_close(&of.in);
    return code;
}
