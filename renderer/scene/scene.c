/* The scene as a whole: naming its targets, and closing it. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <retex/nearest.h>
#include "scene/scene.h"

/* ---- finding an identifier ---- */

static int lower_equal(const char *a, const char *b)
{
    for (; *a && *b; a++, b++)
        if (tolower((unsigned char)*a) != tolower((unsigned char)*b))
            return 0;
    return *a == *b;
}

static int contains(const char *text, const char *part)
{
    size_t n = strlen(part);
    for (; n > 0 && *text; text++) {
        size_t i = 0;
        while (i < n && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i]))
            i++;
        if (i == n)
            return 1;
    }
    return 0;
}

static int near(const char *name, const char *wanted)
{
    return retex_word_distance(name, wanted) <= retex_word_tolerance(wanted) || contains(name, wanted) ||
           (strlen(name) > 2 && contains(wanted, name));
}

static void append(char *text, size_t size, const char *part)
{
    size_t used = strlen(text);
    if (used + strlen(part) + 1 < size)
        memcpy(text + used, part, strlen(part) + 1);
}

static int fail_unknown(const Scene *scene, const char *wanted, RetexError *err)
{
    char list[512] = "";
    int shown = 0, close = 0;
    for (int i = 0; i < scene->nidents; i++)
        close += near(scene->idents[i], wanted);
    for (int i = 0; i < scene->nidents && shown < 12; i++) {
        if (close > 0 && !near(scene->idents[i], wanted))
            continue;
        append(list, sizeof list, shown++ ? ", " : "");
        append(list, sizeof list, scene->idents[i]);
    }
    if (scene->nidents == 0)
        return retex_fail(err, RETEX_ENOTFOUND, "no target `%s`: the scene uses no declared texture or object", wanted);
    return retex_fail(err, RETEX_ENOTFOUND, "no texture, pigment, material or object `%s` in the scene; %s: %s%s",
                      wanted, close > 0 ? "similar" : "there are", list,
                      close == 0 && scene->nidents > shown ? ", …" : "");
}

/* Exact, else the only one that differs in case alone. */
static int find_ident(const Scene *scene, const char *wanted, const char **found, RetexError *err)
{
    const char *any_case = NULL, *second = NULL;
    for (int i = 0; i < scene->nidents; i++) {
        if (strcmp(scene->idents[i], wanted) == 0) {
            *found = scene->idents[i];
            return 0;
        }
        if (lower_equal(scene->idents[i], wanted)) {
            second = any_case;
            any_case = scene->idents[i];
        }
    }
    if (second)
        return retex_fail(err, RETEX_ENOTFOUND, "`%s` could be `%s` or `%s`: write it as the scene does", wanted,
                          second, any_case);
    if (!any_case)
        return fail_unknown(scene, wanted, err);
    *found = any_case;
    return 0;
}

/* ---- reading NAME=IDENT,IDENT ---- */

static int read_name(Target *target, const char *spec, size_t length, RetexError *err)
{
    if (length == 0 || length >= sizeof target->name)
        return retex_fail(err, RETEX_EINVAL, "target `%s`: a name has 1 to %d characters", spec, RETEX_NAME_MAX - 1);
    for (size_t i = 0; i < length; i++)
        if (!isalnum((unsigned char)spec[i]) && spec[i] != '_' && spec[i] != '-')
            return retex_fail(err, RETEX_EINVAL, "target `%s`: a name has letters, digits, `_` and `-` only", spec);
    memcpy(target->name, spec, length);
    target->name[length] = 0;
    return 0;
}

static int add_ident(const Scene *scene, Target *target, const char *wanted, size_t length, RetexError *err)
{
    char word[sizeof target->idents];
    const char *found = NULL;
    if (length == 0 || length >= sizeof word)
        return retex_fail(err, RETEX_EINVAL, "target `%s`: an identifier is missing or too long", target->name);
    memcpy(word, wanted, length);
    word[length] = 0;
    int code = find_ident(scene, word, &found, err);
    if (code)
        return code;
    size_t used = strlen(target->idents);
    if (used + strlen(found) + 2 > sizeof target->idents)
        return retex_fail(err, RETEX_ELIMIT, "target `%s`: its identifiers are more than %zu bytes", target->name,
                          sizeof target->idents);
    snprintf(target->idents + used, sizeof target->idents - used, "%s%s", used ? "," : "", found);
    return 0;
}

static int read_spec(const Scene *scene, Target *target, const char *spec, RetexError *err)
{
    const char *equals = strchr(spec, '=');
    const char *list = equals ? equals + 1 : spec;
    int code = read_name(target, spec, equals ? (size_t)(equals - spec) : strlen(spec), err);
    while (code == 0) {
        size_t length = strcspn(list, ",");
        code = add_ident(scene, target, list, length, err);
        if (list[length] == 0)
            break;
        list += length + 1;
    }
    return code;
}

/* ---- which surfaces a target is ---- */

static int names_any(const Target *target, const IdentList *idents)
{
    for (; idents; idents = idents->next) {
        size_t n = strlen(idents->name);
        for (const char *at = target->idents; *at; at += strcspn(at, ","), at += *at == ',')
            if (strncmp(at, idents->name, n) == 0 && (at[n] == ',' || at[n] == 0))
                return 1;
    }
    return 0;
}

/* The first target that was asked for wins. */
static int target_of(const Scene *scene, const IdentList *texture, const IdentList *object)
{
    for (int t = 0; t < scene->ntargets; t++)
        if (names_any(&scene->targets[t], texture) || names_any(&scene->targets[t], object))
            return t;
    return -1;
}

static void mark_leaves(const Scene *scene, const Texture *texture)
{
    const TextureTree *tree = texture->tree;
    for (int k = 0; tree && k < tree->nleaves; k++)
        tree->leaves[k]->target = target_of(scene, tree->leaves[k]->idents, NULL);
}

static int mark(Scene *scene, Primitive *p, RetexError *err)
{
    p->target = target_of(scene, p->inherits ? NULL : p->texture->idents, p->idents);
    p->interior_target = p->interior_texture ? target_of(scene, p->interior_texture->idents, p->idents) : -1;
    p->face_targets = NULL;
    mark_leaves(scene, p->texture);
    if (p->interior_texture)
        mark_leaves(scene, p->interior_texture);
    if (!p->shape.textures)
        return 0;
    int8_t *targets = arena_alloc(scene->arena, (size_t)p->shape.textures->count);
    if (!targets)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the targets of a mesh");
    for (int i = 0; i < p->shape.textures->count; i++) {
        targets[i] = (int8_t)target_of(scene, p->shape.textures->list[i]->idents, p->idents);
        mark_leaves(scene, p->shape.textures->list[i]);
    }
    p->face_targets = targets;
    return 0;
}

const Texture *primitive_texture(const Primitive *p, int k, int *target)
{
    const int interior = p->interior_texture != NULL, part = k - 1 - interior;
    if (k == 0) {
        *target = p->target;
        return p->texture;
    }
    if (k == 1 && interior) {
        *target = p->interior_target;
        return p->interior_texture;
    }
    if (!p->shape.textures || part >= p->shape.textures->count)
        return NULL;
    *target = p->face_targets ? p->face_targets[part] : p->target;
    return p->shape.textures->list[part];
}

const Texture *primitive_target_texture(const Primitive *p, int target)
{
    const Texture *texture;
    int whole;
    for (int k = 0; (texture = primitive_texture(p, k, &whole)); k++)
        for (int j = 0; j < texture_leaf_count(texture); j++)
            if ((texture->tree ? texture_leaf_target(texture_leaf(texture, j), whole) : whole) == target)
                return texture_leaf(texture, j);
    return NULL;
}

const Texture *instance_target_texture(const Scene *scene, const Instance *instance, int target, const Primitive **of)
{
    const Primitive *p = scene->primitives + instance->prototype->first, *end = p + instance->prototype->count;
    const Texture *texture = instance->texture;
    if (instance->target == target && p < end) {
        if (of)
            *of = p;
        return texture_leaf(p->inherits ? texture : p->texture, 0);
    }
    while (p < end && !p->inherits)
        p++;
    for (int j = 0; p < end && j < texture_leaf_count(texture); j++) {
        const Texture *leaf = texture_leaf(texture, j);
        const int whole = instance->texture_target;
        if ((texture->tree ? texture_leaf_target(leaf, whole) : whole) != target)
            continue;
        if (of)
            *of = p;
        return leaf;
    }
    return NULL;
}

int scene_resolve_targets(Scene *scene, const char *const *specs, int nspecs, RetexError *err)
{
    if (nspecs < 0 || nspecs > RETEX_MAX_TARGETS)
        return retex_fail(err, RETEX_EINVAL, "%d targets, where there may be %d", nspecs, RETEX_MAX_TARGETS);
    scene->ntargets = 0;
    for (int i = 0; i < nspecs; i++) {
        Target *target = &scene->targets[i];
        memset(target, 0, sizeof *target);
        int code = read_spec(scene, target, specs[i], err);
        if (code)
            return code;
        for (int j = 0; j < i; j++)
            if (strcmp(scene->targets[j].name, target->name) == 0)
                return retex_fail(err, RETEX_EINVAL, "target `%s` is named twice", target->name);
    }
    scene->ntargets = nspecs;
    for (int i = 0; i < scene->nprimitives; i++) {
        int code = mark(scene, &scene->primitives[i], err);
        if (code)
            return code;
    }
    for (int i = 0; i < scene->ninstances; i++) {
        Instance *instance = &scene->instances[i];
        instance->target = target_of(scene, NULL, instance->idents);
        instance->texture_target = instance->texture ? target_of(scene, instance->texture->idents, NULL) : -1;
        if (instance->texture)
            mark_leaves(scene, instance->texture);
    }
    return 0;
}

/* ---- closing ---- */

int scene_caustic_sources(const Scene *scene)
{
    int count = 0;
    for (int k = 0; k < scene->nlights; k++)
        count += scene->lights[k].caustics != 0;
    return count;
}

void scene_close(Scene **scene)
{
    if (!scene || !*scene)
        return;
    Scene *s = *scene;
    /* Image maps of one file share its texture. */
    for (int i = 0; i < s->nimages; i++) {
        RetexTexture *texture = s->images[i]->texture;
        for (int j = i; texture && j < s->nimages; j++)
            if (s->images[j]->texture == texture)
                s->images[j]->texture = NULL;
        retex_texture_close(&texture);
    }
    Arena *arena = s->arena; /* the scene itself lives in it */
    arena_close(&arena);
    *scene = NULL;
}
