/* Targets: NAME=SELECTOR,… of the command line is read, and the surfaces that they select are marked. */
#include <stdio.h>
#include <string.h>
#include <retex/target_name.h>
#include "scene/selector.h"

/* ---- reading NAME=SELECTOR,SELECTOR ---- */

/* The selectors of all targets, while surfaces are marked. */
typedef struct Selectors {
    int ntargets;
    int counts[RETEX_MAX_TARGETS];
    Selector *lists[RETEX_MAX_TARGETS];
} Selectors;

static int add_selector(const Scene *scene, Target *target, Selector *selector, const char *text, size_t length,
                        RetexError *err)
{
    char word[SELECTOR_MAX];
    if (length == 0 || length >= sizeof word)
        return retex_fail(err, RETEX_EINVAL, "target `%s`: an identifier is missing or too long", target->name);
    memcpy(word, text, length);
    word[length] = 0;
    int code = selector_read(selector, scene, word, err);
    if (code)
        return code;
    target->is_pointed_at |= selector_points(selector);
    if (selector_selects_faces(selector))
        target->selections[target->nselections++] = (FaceSelection){
            selector->number, selector->face, selector->scope == SCOPE_LEVEL, selector->text};
    size_t used = strlen(target->idents);
    if (used + strlen(selector->text) + 2 > sizeof target->idents)
        return retex_fail(err, RETEX_ELIMIT, "target `%s`: its identifiers are more than %zu bytes", target->name,
                          sizeof target->idents);
    snprintf(target->idents + used, sizeof target->idents - used, "%s%s", used ? "," : "", selector->text);
    return 0;
}

/* ---- options ---- */

static const char *const uv_words[] = {[UV_MODEL] = "model", "planar", "box", "cylinder"};
#define UV_OPTION ":uv="

const char *target_spec_options(const char *spec)
{
    const char *options = NULL;
    for (const char *at = spec; (at = strstr(at, UV_OPTION)); at++)
        options = at;
    return options && !strchr(options, ',') ? options : spec + strlen(spec);
}

/* Keeps what was asked for among the selectors, so that they name the same target again. */
static int read_options(Target *target, const char *options, RetexError *err)
{
    const size_t used = strlen(target->idents);
    if (!*options)
        return RETEX_OK;
    for (int k = UV_MODEL; k <= UV_CYLINDER; k++)
        if (strcmp(options + strlen(UV_OPTION), uv_words[k]) == 0)
            target->uv = (UvProjection)k;
    if (!target->uv)
        return retex_fail(err, RETEX_EINVAL, "target `%s`: uv=%s is none of planar, box, cylinder and model",
                          target->name, options + strlen(UV_OPTION));
    if (used + strlen(options) + 1 > sizeof target->idents)
        return retex_fail(err, RETEX_ELIMIT, "target `%s`: its identifiers are more than %zu bytes", target->name,
                          sizeof target->idents);
    memcpy(target->idents + used, options, strlen(options) + 1);
    return RETEX_OK;
}

static int read_selectors(Scene *scene, Selectors *selectors, int t, const char *list, RetexError *err)
{
    Target *target = &scene->targets[t];
    int code = RETEX_OK, count = 1;
    for (const char *at = list; *(at += selector_length(at)); at++)
        count++;
    Selector *all = arena_alloc(scene->arena, (size_t)count * sizeof *all);
    target->selections = arena_alloc(scene->arena, (size_t)count * sizeof *target->selections);
    if (!all || !target->selections)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the targets");
    selectors->lists[t] = all;
    selectors->counts[t] = count;
    for (int i = 0; i < count && !code; i++) {
        const size_t length = selector_length(list);
        code = add_selector(scene, target, &all[i], list, length, err);
        list += length + 1;
    }
    return code;
}

static int read_spec(Scene *scene, Selectors *selectors, int t, const char *spec, RetexError *err)
{
    const char *options = target_spec_options(spec);
    const char *text = arena_string(scene->arena, spec, (size_t)(options - spec));
    if (!text)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the targets");
    const char *equals = strchr(text, '=');
    const size_t length = equals ? (size_t)(equals - text) : strlen(text);
    int code = selector_read_name(scene->targets[t].name, "target", text, length, err);
    if (!code)
        code = read_selectors(scene, selectors, t, equals ? equals + 1 : text, err);
    return code ? code : read_options(&scene->targets[t], options, err);
}

/* ---- which surfaces a target is ---- */

/* The first target that was asked for wins. */
static int target_of(const Selectors *selectors, const Texture *texture, const ObjectPart *object)
{
    for (int t = 0; t < selectors->ntargets; t++)
        for (int i = 0; i < selectors->counts[t]; i++)
            if (selector_matches(&selectors->lists[t][i], texture, object))
                return t;
    return -1;
}

static void mark_leaves(const Selectors *selectors, const Texture *texture)
{
    const TextureTree *tree = texture->tree;
    for (int k = 0; tree && k < tree->nleaves; k++)
        tree->leaves[k]->target = target_of(selectors, tree->leaves[k], NULL);
}

static int mark(Scene *scene, const Selectors *selectors, Primitive *p, RetexError *err)
{
    ObjectPart object = object_part(scene, p, 0);
    p->target = target_of(selectors, p->inherits ? NULL : p->texture, &object);
    p->interior_target = p->interior_texture ? target_of(selectors, p->interior_texture, &object) : -1;
    p->face_targets = NULL;
    p->faces = NULL;
    p->unit_targets = NULL;
    mark_leaves(selectors, p->texture);
    if (p->interior_texture)
        mark_leaves(selectors, p->interior_texture);
    if (!p->shape.textures)
        return 0;
    int8_t *targets = arena_alloc(scene->arena, (size_t)p->shape.textures->count);
    if (!targets)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the targets of a mesh");
    for (int i = 0; i < p->shape.textures->count; i++) {
        object = object_part(scene, p, i + 1);
        targets[i] = (int8_t)target_of(selectors, p->shape.textures->list[i], &object);
        mark_leaves(selectors, p->shape.textures->list[i]);
    }
    p->face_targets = targets;
    return 0;
}

static int read_specs(Scene *scene, Selectors *selectors, const char *const *specs, int nspecs, RetexError *err)
{
    for (int i = 0; i < nspecs; i++) {
        Target *target = &scene->targets[i];
        memset(target, 0, sizeof *target);
        int code = read_spec(scene, selectors, i, specs[i], err);
        if (code)
            return code;
        for (int j = 0; j < i; j++)
            if (strcmp(scene->targets[j].name, target->name) == 0)
                return retex_fail(err, RETEX_EINVAL, "target `%s` is named twice", target->name);
    }
    return 0;
}

int scene_resolve_targets(Scene *scene, const char *const *specs, int nspecs, RetexError *err)
{
    Selectors selectors = {.ntargets = nspecs};
    if (nspecs < 0 || nspecs > RETEX_MAX_TARGETS)
        return retex_fail(err, RETEX_EINVAL, "%d targets, where there may be %d", nspecs, RETEX_MAX_TARGETS);
    scene->ntargets = 0;
    int code = read_specs(scene, &selectors, specs, nspecs, err);
    if (code)
        return code;
    scene->ntargets = nspecs;
    for (int i = 0; i < scene->nprimitives && !code; i++)
        code = mark(scene, &selectors, &scene->primitives[i], err);
    for (int i = 0; i < scene->ninstances && !code; i++) {
        Instance *instance = &scene->instances[i];
        const ObjectPart object = {.idents = instance->idents, .places = instance->places};
        instance->target = target_of(&selectors, NULL, &object);
        instance->texture_target = instance->texture ? target_of(&selectors, instance->texture, NULL) : -1;
        if (instance->texture)
            mark_leaves(&selectors, instance->texture);
    }
    return code;
}
