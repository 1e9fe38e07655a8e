/* Lamps: NAME=SELECTOR,… of the command line is read, and the emitters that they select are marked. Selectors are
 * those of targets (scene/selector.h), of which only what emits counts; identifiers may be those of light sources.
 * Besides there are light_source#N, the N-th light source, and sky, which is the background as well. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <retex/nearest.h>
#include <retex/target_name.h>
#include "scene/selector.h"

#define SAME_COLOR 1e-4f   /* difference of channels, at luminance 1, of colours that are one */
#define LEAST_WEIGHT 1e-6f /* of a lamp that is off, where lights are chosen */
#define SKY "sky"
#define SOURCE "light_source#"
#define REST "rest"

/* ---- names of what emits ---- */

typedef int VisitName(void *context, const char *name); /* 1: look no further */

static int visit_names(const IdentList *idents, VisitName *visit, void *context)
{
    int done = 0;
    for (; idents && !done; idents = idents->next)
        done = visit(context, idents->name);
    return done;
}

static int leaf_emits(const Texture *leaf)
{
    return !rgb_is_black(leaf->finish->emission);
}

static int visit_texture_names(const Texture *texture, VisitName *visit, void *context)
{
    int done = 0;
    for (int k = 0; k < texture_leaf_count(texture) && !done; k++)
        if (leaf_emits(texture_leaf(texture, k)))
            done = visit_names(texture_leaf(texture, k)->idents, visit, context);
    return done;
}

static int visit_all_names(const Scene *scene, VisitName *visit, void *context)
{
    const Texture *texture;
    int done = 0, target;
    for (int k = 0; k < scene->nlights && !done; k++)
        done = visit_names(scene->lights[k].idents, visit, context);
    for (int k = 0; k < scene->nprimitives && !done; k++) {
        const Primitive *p = &scene->primitives[k];
        if (!primitive_emits(p))
            continue;
        done = visit_names(p->idents, visit, context);
        for (int i = 0; !done && (texture = primitive_texture(p, i, &target)); i++)
            done = visit_texture_names(texture, visit, context);
    }
    for (int k = 0; k < scene->ninstances && !done; k++) {
        const Instance *instance = &scene->instances[k];
        done = instance_emits(scene, instance) && visit_names(instance->idents, visit, context);
        if (!done && instance->texture)
            done = visit_texture_names(instance->texture, visit, context);
    }
    return done;
}

/* A name that is looked for. */
typedef struct Wanted {
    const char *name;
    const char *exact, *other_case, *nearest;
    int distance;
} Wanted;

static int compare_name(void *context, const char *name)
{
    Wanted *wanted = context;
    const int distance = retex_word_distance(name, wanted->name);
    if (strcmp(name, wanted->name) == 0)
        wanted->exact = name;
    else if (strcasecmp(name, wanted->name) == 0)
        wanted->other_case = name;
    if (!wanted->nearest || distance < wanted->distance)
        wanted->nearest = name, wanted->distance = distance;
    return wanted->exact != NULL;
}

/* ---- reading NAME=SELECTOR,SELECTOR ---- */

typedef struct LampSelector {
    int is_sky, source; /* source: the number of a light source, from 1 */
    Selector selector;  /* else */
} LampSelector;

typedef struct LampSelectors {
    int nlamps;
    int counts[LAMPS_MAX];
    LampSelector *lists[LAMPS_MAX];
} LampSelectors;

static int is_word(const char *text)
{
    return !strpbrk(text, "#~:*?[.@");
}

static int read_source(LampSelector *selector, const Scene *scene, const char *text, RetexError *err)
{
    char *end = "";
    const char *digits = text + strlen(SOURCE);
    const long number = isdigit((unsigned char)*digits) ? strtol(digits, &end, 10) : 0;
    if (number < 1 || *end)
        return retex_fail(err, RETEX_EINVAL, "lamp `%s`: expected " SOURCE "N, the number of a light source", text);
    if (number > scene->nlights)
        return retex_fail(err, RETEX_ENOTFOUND, "no lamp `%s`: the scene has %d light sources", text, scene->nlights);
    selector->source = (int)number;
    return RETEX_OK;
}

static int read_selector(LampSelector *selector, const Scene *scene, const char *text, RetexError *err)
{
    Wanted wanted = {.name = text};
    visit_all_names(scene, compare_name, &wanted);
    const char *name = wanted.exact ? wanted.exact : wanted.other_case;
    *selector = (LampSelector){.source = 0};
    selector->is_sky = !name && strcasecmp(text, SKY) == 0;
    if (name)
        selector->selector = selector_named(name);
    if (name || selector->is_sky)
        return RETEX_OK;
    if (strncmp(text, SOURCE, strlen(SOURCE)) == 0)
        return read_source(selector, scene, text, err);
    if (!is_word(text)) {
        int code = selector_parse(&selector->selector, scene, text, err);
        if (!code && selector_selects_faces(&selector->selector))
            code = retex_fail(err, RETEX_EUNSUPPORTED,
                              "lamp `%s`: a lamp is a whole object or material, not some of its faces", text);
        return code;
    }
    if (!wanted.nearest)
        return retex_fail(err, RETEX_ENOTFOUND,
                          "no lamp `%s`: nothing that shines has a name in the scene, but there "
                          "may be " SOURCE "1 and " SKY "; --list-lamps lists what there is",
                          text);
    return retex_fail(err, RETEX_ENOTFOUND,
                      "no lamp `%s`: nothing that shines has that name; nearest: %s; "
                      "--list-lamps lists what there is",
                      text, wanted.nearest);
}

static int read_name(Lamp *lamp, const char *spec, size_t length, RetexError *err)
{
    int code = selector_read_name(lamp->name, "lamp", spec, length, err);
    if (!code && strcasecmp(lamp->name, REST) == 0)
        return retex_fail(err, RETEX_EINVAL, "lamp `%s`: that is what all other light is called", spec);
    return code;
}

static int add_selector(const Scene *scene, Lamp *lamp, LampSelector *selector, const char *text, size_t length,
                        RetexError *err)
{
    char word[SELECTOR_MAX];
    const size_t used = strlen(lamp->idents);
    if (length == 0 || length >= sizeof word)
        return retex_fail(err, RETEX_EINVAL, "lamp `%s`: an identifier is missing or too long", lamp->name);
    memcpy(word, text, length);
    word[length] = 0;
    if (used + length + 2 > sizeof lamp->idents)
        return retex_fail(err, RETEX_ELIMIT, "lamp `%s`: its identifiers are more than %zu bytes", lamp->name,
                          sizeof lamp->idents);
    if (used)
        strcat(lamp->idents, ",");
    strcat(lamp->idents, word);
    return read_selector(selector, scene, word, err);
}

static int read_spec(Scene *scene, LampSelectors *selectors, int l, const char *spec, RetexError *err)
{
    Lamp *lamp = &scene->lamps[l];
    const char *equals = strchr(spec, '='), *list = equals ? equals + 1 : spec;
    *lamp = (Lamp){.several = 0};
    int code = read_name(lamp, spec, equals ? (size_t)(equals - spec) : strlen(spec), err), count = 1;
    for (const char *at = list; *(at += selector_length(at)); at++)
        count++;
    LampSelector *all = arena_alloc(scene->arena, (size_t)count * sizeof *all);
    if (!all)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the lamps");
    selectors->lists[l] = all, selectors->counts[l] = count;
    for (int i = 0; i < count && !code; i++) {
        const size_t length = selector_length(list);
        code = add_selector(scene, lamp, &all[i], list, length, err);
        list += length + 1;
    }
    for (int j = 0; j < l && !code; j++)
        if (strcasecmp(scene->lamps[j].name, lamp->name) == 0)
            code = retex_fail(err, RETEX_EINVAL, "lamp `%s` is named twice", lamp->name);
    return code;
}

/* ---- the colour of a lamp ---- */

/* Of the emitters of a lamp, while they are marked. */
typedef struct LampColor {
    int count, surfaces; /* of emitters; of those that are no light sources */
    int several;
    Rgb color; /* the brightest */
} LampColor;

static int same_color(Rgb a, Rgb b)
{
    const float x = rgb_luminance(a), y = rgb_luminance(b);
    return fabsf(a.r / x - b.r / y) < SAME_COLOR && fabsf(a.g / x - b.g / y) < SAME_COLOR &&
           fabsf(a.b / x - b.b / y) < SAME_COLOR;
}

static void add_color(LampColor *lamp, Rgb color)
{
    const float bright = rgb_luminance(lamp->color), luminance = rgb_luminance(color);
    lamp->count++;
    if (color.r < 0 || color.g < 0 || color.b < 0)
        lamp->several = 1;
    if (!(luminance > 0))
        return;
    if (bright > 0 && !same_color(lamp->color, color))
        lamp->several = 1;
    if (luminance > bright)
        lamp->color = color;
}

static void add_texture_color(LampColor *lamp, const Texture *leaf)
{
    const Finish *finish = leaf->finish;
    lamp->surfaces = 1;
    if (leaf->pigment->kind != PIGMENT_COLOR || finish->retex.emission_map) {
        lamp->several = 1, lamp->count++;
        return;
    }
    const Rgbft c = leaf->pigment->color;
    add_color(lamp, rgb_mul(finish->emission, rgb(c.r, c.g, c.b)));
}

static int has_zero(Rgb c)
{
    return !(c.r > 0 && c.g > 0 && c.b > 0);
}

/* Light sources of a colour with a channel of 0 shine white while paths are traced. */
static void whiten_sources(Scene *scene, int l, float bright, Rgb kept)
{
    for (int k = 0; k < scene->nlights; k++) {
        Light *light = &scene->lights[k];
        const float luminance = rgb_luminance(light->color);
        if (light->lamp == l && (luminance > 0 || bright == 0))
            light->color = bright > 0 ? rgb_scale(kept, luminance / bright) : kept;
    }
}

static void settle_color(Scene *scene, int l, const LampColor *color)
{
    Lamp *lamp = &scene->lamps[l];
    const float bright = rgb_luminance(color->color);
    lamp->several = color->several || (color->surfaces && has_zero(color->color));
    lamp->has_one_color = !color->several, lamp->color = color->color;
    lamp->value = lamp->kept = lamp->several ? rgb_grey(1) : color->color;
    if (!lamp->several && has_zero(color->color)) {
        lamp->kept = rgb_grey(bright > 0 ? bright : 1);
        whiten_sources(scene, l, bright, lamp->kept);
    }
}

/* ---- which emitters a lamp is ---- */

static int selects(const LampSelector *selector, const Texture *texture, const ObjectPart *object)
{
    return selector->selector.form && selector_matches(&selector->selector, texture, object);
}

enum { OF_NO_SOURCE = 0, OF_SKY = -1 };

/* The first lamp that was asked for wins. source: the number of a light source, or of these. */
static int lamp_of(const LampSelectors *selectors, const Texture *texture, const ObjectPart *object, int source)
{
    for (int l = 0; l < selectors->nlamps; l++)
        for (int i = 0; i < selectors->counts[l]; i++) {
            const LampSelector *one = &selectors->lists[l][i];
            if (source == OF_SKY ? one->is_sky : (source && one->source == source) || selects(one, texture, object))
                return l;
        }
    return -1;
}

static int lamp_of_source(const LampSelectors *selectors, const Scene *scene, int k)
{
    const ObjectPart part = {.idents = scene->lights[k].idents, .places = scene->lights[k].places};
    return lamp_of(selectors, NULL, &part, k + 1);
}

static int lamp_of_texture(const LampSelectors *selectors, const Texture *texture, const ObjectPart *object)
{
    int lamp = -1;
    for (int k = 0; k < texture_leaf_count(texture) && lamp < 0; k++)
        if (leaf_emits(texture_leaf(texture, k)))
            lamp = lamp_of(selectors, texture_leaf(texture, k), object, OF_NO_SOURCE);
    return lamp;
}

static void add_texture_colors(LampColor *color, const Texture *texture)
{
    for (int k = 0; k < texture_leaf_count(texture); k++)
        if (leaf_emits(texture_leaf(texture, k)))
            add_texture_color(color, texture_leaf(texture, k));
}

static void mark_primitive(Scene *scene, const LampSelectors *selectors, Primitive *p, LampColor *colors)
{
    const Texture *texture;
    int target, lamp = -1;
    p->lamp = scene_rest_lamp(scene);
    if (!primitive_emits(p))
        return;
    const int own = 1 + (p->interior_texture != NULL);
    for (int k = 0; lamp < 0 && (texture = primitive_texture(p, k, &target)); k++) {
        const ObjectPart object = object_part(scene, p, k < own ? 0 : k - own + 1);
        lamp = lamp_of_texture(selectors, texture, &object);
    }
    if (lamp < 0)
        return;
    p->lamp = lamp;
    for (int k = 0; (texture = primitive_texture(p, k, &target)); k++)
        add_texture_colors(&colors[lamp], texture);
}

static void mark_instance(Scene *scene, const LampSelectors *selectors, Instance *instance, LampColor *colors)
{
    const ObjectPart object = {.idents = instance->idents, .places = instance->places};
    const Prototype *prototype = instance->prototype;
    const Texture *texture;
    int target;
    instance->lamp = -1;
    if (!instance_emits(scene, instance))
        return;
    instance->lamp = lamp_of(selectors, NULL, &object, OF_NO_SOURCE);
    if (instance->lamp < 0 && instance->texture)
        instance->lamp = lamp_of_texture(selectors, instance->texture, &object);
    if (instance->lamp < 0)
        return;
    if (instance->texture)
        add_texture_colors(&colors[instance->lamp], instance->texture);
    for (int i = 0; i < prototype->count; i++)
        for (int k = 0; (texture = primitive_texture(&scene->primitives[prototype->first + i], k, &target)); k++)
            add_texture_colors(&colors[instance->lamp], texture);
}

static void mark_sky(Scene *scene, const LampSelectors *selectors, LampColor *colors)
{
    const int lamp = lamp_of(selectors, NULL, NULL, OF_SKY);
    scene->sky_lamp = lamp < 0 ? scene_rest_lamp(scene) : lamp;
    if (lamp < 0)
        return;
    colors[lamp].count++, colors[lamp].surfaces = 1;
    if (scene->sky && !scene->sky->has_one_color)
        colors[lamp].several = 1;
    else
        add_color(&colors[lamp], scene->sky ? scene->sky->color : scene->background);
}

static void mark_all(Scene *scene, const LampSelectors *selectors, LampColor *colors)
{
    for (int k = 0; k < scene->nlights; k++) {
        const int lamp = lamp_of_source(selectors, scene, k);
        scene->lights[k].lamp = lamp < 0 ? scene_rest_lamp(scene) : lamp;
        if (lamp >= 0)
            add_color(&colors[lamp], scene->lights[k].color);
    }
    for (int k = 0; k < scene->nprimitives; k++)
        mark_primitive(scene, selectors, &scene->primitives[k], colors);
    for (int k = 0; k < scene->ninstances; k++)
        mark_instance(scene, selectors, &scene->instances[k], colors);
    mark_sky(scene, selectors, colors);
}

int scene_resolve_lamps(Scene *scene, const char *const *specs, int nspecs, RetexError *err)
{
    LampSelectors selectors = {.nlamps = nspecs};
    LampColor colors[LAMPS_MAX] = {{0}};
    int code = RETEX_OK;
    if (nspecs < 0 || nspecs > LAMPS_MAX)
        return retex_fail(err, RETEX_EINVAL, "%d lamps, where there may be %d", nspecs, LAMPS_MAX);
    for (int l = 0; l < nspecs && !code; l++)
        code = read_spec(scene, &selectors, l, specs[l], err);
    if (code)
        return code;
    scene->nlamps = nspecs ? nspecs + 1 : 0;
    mark_all(scene, &selectors, colors);
    for (int l = 0; l < nspecs && !code; l++) {
        if (!colors[l].count)
            code = retex_fail(err, RETEX_ENOTFOUND,
                              "lamp `%s` has nothing that shines, or what it has is of a lamp "
                              "named before it; --list-lamps lists what there is",
                              scene->lamps[l].name);
        settle_color(scene, l, &colors[l]);
    }
    Lamp *rest = &scene->lamps[scene_rest_lamp(scene)];
    if (nspecs)
        *rest = (Lamp){.name = REST, .several = 1, .value = rgb_grey(1), .kept = rgb_grey(1)};
    for (int l = 0; l < scene->nlamps; l++)
        scene_light_lamp(&scene->lamps[l], scene->lamps[l].value, 1);
    scene_number_kept(scene);
    return code;
}

void scene_light_lamp(Lamp *lamp, Rgb value, int is_kept)
{
    lamp->value = value;
    lamp->shown = rgb(value.r / lamp->kept.r, value.g / lamp->kept.g, value.b / lamp->kept.b);
    lamp->weight = is_kept ? 1 : fmaxf(LEAST_WEIGHT, rgb_luminance(value) / rgb_luminance(lamp->kept));
}

/* ---- each ---- */

#define EACH_MAX 64 /* so many are counted, for the message */

typedef struct EachLamp {
    Scene *scene;
    int count, failed;
    const char *specs[EACH_MAX];
} EachLamp;

static void add_each(EachLamp *each, const char *text)
{
    for (int k = 0; k < each->count; k++)
        if (strcasecmp(each->specs[k], text) == 0)
            return;
    if (each->count == EACH_MAX)
        return;
    char *copy = arena_string(each->scene->arena, text, strlen(text));
    each->failed |= !copy;
    each->specs[each->count++] = copy ? copy : "";
}

/* By the innermost name. */
static void add_each_named(EachLamp *each, const IdentList *idents)
{
    if (idents && retex_target_name_is_valid(idents->name) && strcasecmp(idents->name, REST) != 0)
        add_each(each, idents->name);
}

static int is_same_name(void *name, const char *other)
{
    return strcasecmp(name, other) == 0;
}

/* By a name that is made of a kind and a number, and that nothing in the scene has: LAMP_NAME=SELECTOR. */
static void add_each_unnamed(EachLamp *each, const char *kind, int number, const char *selector)
{
    char name[RETEX_NAME_MAX], text[RETEX_NAME_MAX + SELECTOR_MAX];
    size_t length = (size_t)snprintf(name, sizeof name, "%s%d", kind, number);
    while (length + 1 < sizeof name && visit_all_names(each->scene, is_same_name, name))
        name[length++] = '_', name[length] = 0;
    snprintf(text, sizeof text, "%s=%s", name, selector);
    add_each(each, text);
}

static int is_listed(void *each, const char *name)
{
    const EachLamp *list = each;
    for (int k = 0; k < list->count; k++)
        if (strcmp(list->specs[k], name) == 0)
            return 1;
    return 0;
}

/* Whether a lamp of the list has the primitive already, by any of its names. */
static int has_primitive(EachLamp *each, const Primitive *p)
{
    const Texture *texture;
    int target, listed = visit_names(p->idents, is_listed, each);
    for (int i = 0; !listed && (texture = primitive_texture(p, i, &target)); i++)
        listed = visit_texture_names(texture, is_listed, each);
    return listed;
}

static int has_instance(EachLamp *each, const Instance *instance)
{
    return visit_names(instance->idents, is_listed, each) ||
           (instance->texture && visit_texture_names(instance->texture, is_listed, each));
}

/* What weak `ambient` gives is no lamp that anybody looks for. */
static int texture_shines(const Texture *texture)
{
    int shines = 0;
    for (int k = 0; k < texture_leaf_count(texture) && !shines; k++)
        shines = finish_is_sampled(texture_leaf(texture, k)->finish);
    return shines;
}

static int primitive_shines(const Primitive *p)
{
    const Texture *texture;
    int target, shines = 0;
    for (int i = 0; !shines && (texture = primitive_texture(p, i, &target)); i++)
        shines = texture_shines(texture);
    return shines;
}

static int instance_shines(const Scene *scene, const Instance *instance)
{
    int shines = instance->texture && texture_shines(instance->texture);
    for (int k = 0; k < instance->prototype->count && !shines; k++)
        shines = primitive_shines(&scene->primitives[instance->prototype->first + k]);
    return shines;
}

static const IdentList *texture_names(const Texture *texture)
{
    for (int k = 0; k < texture_leaf_count(texture); k++)
        if (leaf_emits(texture_leaf(texture, k)) && texture_leaf(texture, k)->idents)
            return texture_leaf(texture, k)->idents;
    return NULL;
}

static void add_each_light(EachLamp *each, int number)
{
    const IdentList *names = each->scene->lights[number - 1].idents;
    char selector[64];
    snprintf(selector, sizeof selector, SOURCE "%d", number);
    if (!names)
        add_each_unnamed(each, "light", number, selector);
    else if (!visit_names(names, is_listed, each))
        add_each_named(each, names);
}

static const IdentList *primitive_names(const Primitive *p)
{
    const IdentList *names = p->idents;
    const Texture *texture;
    int target;
    for (int i = 0; !names && (texture = primitive_texture(p, i, &target)); i++)
        names = texture_names(texture);
    return names;
}

int scene_each_lamp(Scene *scene, int sky_shines, int unnamed, const char *const **specs, int *nspecs, RetexError *err)
{
    EachLamp *each = arena_alloc(scene->arena, sizeof *each);
    char selector[SELECTOR_MAX];
    if (!each)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the lamps");
    *each = (EachLamp){.scene = scene};
    for (int k = 0; k < scene->nlights; k++)
        add_each_light(each, k + 1);
    for (int k = 0; k < scene->nprimitives; k++) {
        const Primitive *p = &scene->primitives[k];
        if (!p->prototype && primitive_shines(p) && !has_primitive(each, p))
            add_each_named(each, primitive_names(p));
    }
    for (int k = 0; k < scene->ninstances; k++)
        if (instance_shines(scene, &scene->instances[k]) && !has_instance(each, &scene->instances[k]))
            add_each_named(each, scene->instances[k].idents);
    if (sky_shines)
        add_each(each, SKY);
    for (int k = 0; k < scene->nprimitives && unnamed; k++) {
        const Primitive *p = &scene->primitives[k];
        const ObjectPart object = object_part(scene, p, 0);
        if (!p->prototype && primitive_shines(p) && !primitive_names(p) && selector_of_object(selector, &object))
            add_each_unnamed(each, "object", k + 1, selector);
    }
    *specs = each->specs, *nspecs = each->count;
    if (each->failed)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the lamps");
    if (each->count > LAMPS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "the scene has %d%s lamps, where there may be %d: choose by -l",
                          each->count, each->count == EACH_MAX ? " or more" : "", LAMPS_MAX);
    return RETEX_OK;
}
