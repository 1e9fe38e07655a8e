/* The forms of selectors: a row each. See selector.h. */
#include <ctype.h>
#include <fnmatch.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/color_text.h>
#include <retex/nearest.h>
#include <retex/target_name.h>
#include "scene/selector.h"

struct SelectorForm {
    const char *what; /* as messages name it */
    int points;       /* see selector_points */
    int (*begins)(const char *text);
    int (*read)(Selector *selector, const Scene *scene, RetexError *err);
    /* Whether it selects a texture, or an object; NULL: never. */
    int (*texture)(const Selector *selector, const Texture *texture);
    int (*object)(const Selector *selector, const ObjectPart *object);
    /* How far a surface is from being selected, and the text that would select it; INFINITY: nothing of this form does.
     * NULL: read tells of mistakes itself. */
    double (*near)(const Selector *selector, const Texture *texture, const ObjectPart *object, char text[SELECTOR_MAX]);
};

size_t selector_length(const char *list)
{
    int depth = 0;
    size_t n = 0;
    for (; list[n] && (list[n] != ',' || depth > 0); n++)
        depth += (list[n] == '(') - (list[n] == ')');
    return n;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static int malformed(const Selector *selector, const char *expected, RetexError *err)
{
    return retex_fail(err, RETEX_EINVAL, "target `%s`: expected %s", selector->text, expected);
}

const char *scene_name_of(const Scene *scene, const char *ident)
{
    for (int k = 0; k < scene->nnames; k++)
        if (strcmp(scene->names[k].ident, ident) == 0 && retex_target_name_is_valid(scene->names[k].name))
            return scene->names[k].name;
    return ident;
}

/* ---- IDENT ---- */

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

/* Of all that -t takes by a name: what the scene offers, then what people call its identifiers. */
static const char *known_name(const Scene *scene, int k)
{
    return k < scene->noffered ? scene->offered[k].name : scene_name_of(scene, scene->idents[k - scene->noffered]);
}

static int is_near(const Scene *scene, int k, const char *wanted)
{
    return near(known_name(scene, k), wanted) ||
           (k >= scene->noffered && near(scene->idents[k - scene->noffered], wanted));
}

static int fail_unknown(const Scene *scene, const char *wanted, RetexError *err)
{
    char list[512] = "";
    const int count = scene->noffered + scene->nidents;
    int shown = 0, close = 0;
    for (int i = 0; i < count; i++)
        close += is_near(scene, i, wanted);
    for (int i = 0; i < count && shown < 12; i++) {
        const char *name = known_name(scene, i);
        if (close > 0 && !is_near(scene, i, wanted))
            continue;
        append(list, sizeof list, shown++ ? ", " : "");
        append(list, sizeof list, name);
    }
    if (count == 0)
        return retex_fail(err, RETEX_ENOTFOUND, "no target `%s`: the scene uses no declared texture or object", wanted);
    return retex_fail(err, RETEX_ENOTFOUND, "no texture, pigment, material or object `%s` in the scene; %s: %s%s",
                      wanted, close > 0 ? "similar" : "there are", list,
                      close == 0 && count > shown ? ", …" : "");
}

/* The identifier that people call so, exactly. */
static const char *find_named(const Scene *scene, const char *wanted)
{
    for (int k = 0; k < scene->nnames; k++)
        for (int i = 0; i < scene->nidents && strcmp(scene->names[k].name, wanted) == 0; i++)
            if (strcmp(scene->idents[i], scene->names[k].ident) == 0)
                return scene->idents[i];
    return NULL;
}

/* Exact, else by its name, else the only one that differs in case alone, of identifiers and names. */
static int find_ident(const Scene *scene, const char *wanted, const char **found, RetexError *err)
{
    const char *any_case = NULL, *second = NULL;
    for (int i = 0; i < scene->nidents; i++) {
        if (strcmp(scene->idents[i], wanted) == 0) {
            *found = scene->idents[i];
            return 0;
        }
        if (lower_equal(scene->idents[i], wanted) || lower_equal(scene_name_of(scene, scene->idents[i]), wanted)) {
            second = any_case;
            any_case = scene->idents[i];
        }
    }
    if ((*found = find_named(scene, wanted)))
        return 0;
    if (second)
        return retex_fail(err, RETEX_ENOTFOUND, "`%s` could be `%s` or `%s`: write it as the scene does", wanted,
                          second, any_case);
    if (!any_case)
        return fail_unknown(scene, wanted, err);
    *found = any_case;
    return 0;
}

static int is_ident(const Scene *scene, const char *wanted)
{
    for (int i = 0; i < scene->nidents; i++)
        if (strcmp(scene->idents[i], wanted) == 0)
            return 1;
    return find_named(scene, wanted) != NULL;
}

const SceneTarget *scene_offers(const Scene *scene, const char *name)
{
    const SceneTarget *any_case = NULL;
    for (int k = 0; k < scene->noffered; k++) {
        if (strcmp(scene->offered[k].name, name) == 0)
            return &scene->offered[k];
        if (!any_case && lower_equal(scene->offered[k].name, name))
            any_case = &scene->offered[k];
    }
    return any_case && !is_ident(scene, name) ? any_case : NULL;
}

static int begins_any(const char *text)
{
    (void)text;
    return 1;
}

static int read_ident(Selector *selector, const Scene *scene, RetexError *err)
{
    int code = find_ident(scene, selector->text, &selector->name, err);
    selector->text = selector->name;
    return code;
}

static int named(const IdentList *idents, const char *name)
{
    for (; idents; idents = idents->next)
        if (strcmp(idents->name, name) == 0)
            return 1;
    return 0;
}

static int texture_named(const Selector *selector, const Texture *texture)
{
    return named(texture->idents, selector->name);
}

static int object_named(const Selector *selector, const ObjectPart *object)
{
    return named(object->idents, selector->name);
}

/* ---- #N, #N.K, and after it /material, /flat:F or /level:F ---- */

static const char *const scope_words[] = {"object", "material", "flat", "level"};

int selector_scope(SelectorScope *scope, const char *word)
{
    for (int k = 0; k < (int)(sizeof scope_words / sizeof *scope_words); k++)
        if (strcmp(word, scope_words[k]) == 0) {
            *scope = (SelectorScope)k;
            return 1;
        }
    return 0;
}

static int begins_number(const char *text)
{
    return *text == '#';
}

/* A whole number from 1; returns what follows, or NULL. */
static const char *read_count(const char *at, int *number)
{
    char *end;
    const long value = isdigit((unsigned char)*at) ? strtol(at, &end, 10) : -1;
    *number = value > 0 && value <= INT_MAX ? (int)value : 0;
    return value < 0 ? NULL : end;
}

/* What follows the number: 0 where it is no scope. */
static int read_scope(Selector *selector, const char *at)
{
    char word[16];
    const size_t length = strcspn(at, ":");
    if (length >= sizeof word)
        return 0;
    memcpy(word, at, length);
    word[length] = 0;
    if (!selector_scope(&selector->scope, word))
        return 0;
    if (!selector_selects_faces(selector))
        return !at[length];
    const char *end = at[length] ? read_count(at + length + 1, &selector->face) : NULL;
    return end && !*end && selector->face > 0 && !selector->part;
}

static int read_material(Selector *selector, const Scene *scene, const Texture *texture, RetexError *err)
{
    Materials materials;
    if (!materials_open(&materials, scene))
        return retex_fail(err, RETEX_ENOMEM, "no memory for the materials of the scene");
    selector->texture = texture;
    selector->name = texture ? materials_name(&materials, texture) : NULL;
    materials_close(&materials);
    return RETEX_OK;
}

static int check_number(Selector *selector, const Scene *scene, RetexError *err)
{
    if (selector->number < 1 || selector->number > scene->nprimitives)
        return retex_fail(err, RETEX_ENOTFOUND,
                          "no object `%s`: the scene has %d, from #1 on; --list-targets -v lists "
                          "those that are seen",
                          selector->text, scene->nprimitives);
    const Primitive *p = &scene->primitives[selector->number - 1];
    const int parts = p->shape.textures ? p->shape.textures->count : 0;
    if (selector->part > parts)
        return retex_fail(err, RETEX_ENOTFOUND, "no texture `%s`: the parts of object #%d have %d of their own",
                          selector->text, selector->number, parts);
    if (selector->scope == SCOPE_MATERIAL)
        return read_material(selector, scene, object_part(scene, p, selector->part).texture, err);
    return RETEX_OK;
}

static int read_number(Selector *selector, const Scene *scene, RetexError *err)
{
    const char *end = read_count(selector->text + 1, &selector->number);
    if (end && *end == '.' && isdigit((unsigned char)end[1]))
        end = read_count(end + 1, &selector->part);
    if (end && *end == '/')
        end = read_scope(selector, end + 1) ? "" : NULL;
    if (!end || *end)
        return malformed(selector,
                         "#N, an object's number, or #N.K, one of its textures; or #N/material, #N/flat:FACE, "
                         "#N/level:FACE",
                         err);
    return check_number(selector, scene, err);
}

static int texture_of_material(const Selector *selector, const Texture *texture)
{
    return selector->name && named(texture->idents, selector->name);
}

static int object_numbered(const Selector *selector, const ObjectPart *object)
{
    if (selector_selects_faces(selector))
        return 0;
    if (selector->texture && selector->texture == object->texture)
        return 1;
    return selector->number == object->number && (!selector->part || selector->part == object->part);
}

int selector_of_scope(char text[SELECTOR_MAX], const ObjectPart *object, SelectorScope scope, int face)
{
    if (!object->number)
        return 0;
    int n = snprintf(text, SELECTOR_MAX, "#%d", object->number);
    if (object->part && scope <= SCOPE_MATERIAL)
        n += snprintf(text + n, SELECTOR_MAX - (size_t)n, ".%d", object->part);
    if (scope != SCOPE_OBJECT)
        n += snprintf(text + n, SELECTOR_MAX - (size_t)n, "/%s", scope_words[scope]);
    if (scope > SCOPE_MATERIAL)
        snprintf(text + n, SELECTOR_MAX - (size_t)n, ":%d", face);
    return 1;
}

int selector_of_object(char text[SELECTOR_MAX], const ObjectPart *object)
{
    return selector_of_scope(text, object, SCOPE_OBJECT, 0);
}

/* ---- ~COLOUR ---- */

static int begins_color(const char *text)
{
    return *text == '~';
}

static int read_color(Selector *selector, const Scene *scene, RetexError *err)
{
    float rgb[3];
    (void)scene;
    if (retex_color_parse(rgb, selector->text + 1, NULL))
        return malformed(selector, "a colour, as ~rgb(.6,.4,.2), which is scene-linear, ~#cbaa7c or ~tan", err);
    selector->color = (Rgb){rgb[0], rgb[1], rgb[2]};
    return RETEX_OK;
}

static int color_of(const Texture *texture, Rgb *color)
{
    if (!texture || texture->tree || texture->pigment->kind != PIGMENT_COLOR)
        return 0;
    *color = (Rgb){texture->pigment->color.r, texture->pigment->color.g, texture->pigment->color.b};
    return 1;
}

/* Texts have three digits. */
static int same_number(float a, float b)
{
    return fabsf(a - b) <= 5e-4f + 6e-3f * fmaxf(fabsf(a), fabsf(b));
}

static int texture_colored(const Selector *selector, const Texture *texture)
{
    Rgb color;
    const Rgb *wanted = &selector->color;
    return color_of(texture, &color) && same_number(color.r, wanted->r) && same_number(color.g, wanted->g) &&
           same_number(color.b, wanted->b);
}

int selector_of_color(char text[SELECTOR_MAX], const Texture *texture)
{
    Rgb color;
    if (!color_of(texture, &color))
        return 0;
    snprintf(text, SELECTOR_MAX, "~rgb(%.3g,%.3g,%.3g)", color.r, color.g, color.b);
    return 1;
}

static double near_color(const Selector *selector, const Texture *texture, const ObjectPart *object,
                         char text[SELECTOR_MAX])
{
    Rgb color;
    (void)object;
    if (!selector_of_color(text, texture) || !color_of(texture, &color))
        return INFINITY;
    return fabs(color.r - selector->color.r) + fabs(color.g - selector->color.g) + fabs(color.b - selector->color.b);
}

/* ---- FILE:LINE ---- */

static int begins_place(const char *text)
{
    const char *colon = strrchr(text, ':');
    return colon && colon > text && isdigit((unsigned char)colon[1]) && !colon[1 + strspn(colon + 1, "0123456789")];
}

static int read_place(Selector *selector, const Scene *scene, RetexError *err)
{
    const char *colon = strrchr(selector->text, ':');
    selector->name = arena_string(scene->arena, selector->text, (size_t)(colon - selector->text));
    selector->number = (int)fmin(strtod(colon + 1, NULL), 1e9);
    return selector->name ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "no memory for the targets");
}

static int is_file(const Selector *selector, const char *path)
{
    return strcmp(path, selector->name) == 0 || strcmp(base_name(path), selector->name) == 0;
}

static int object_placed(const Selector *selector, const ObjectPart *object)
{
    for (const PlaceList *at = object->places; at; at = at->next)
        if (at->line == selector->number && is_file(selector, at->file))
            return 1;
    return 0;
}

int selector_of_place(char text[SELECTOR_MAX], const PlaceList *place)
{
    return place && snprintf(text, SELECTOR_MAX, "%s:%d", base_name(place->file), place->line) < SELECTOR_MAX;
}

static double near_place(const Selector *selector, const Texture *texture, const ObjectPart *object,
                         char text[SELECTOR_MAX])
{
    double best = INFINITY;
    const PlaceList *nearest = NULL;
    (void)texture;
    for (const PlaceList *at = object->places; at; at = at->next) {
        const double distance = fabs((double)at->line - selector->number) + (is_file(selector, at->file) ? 0 : 1e9);
        if (distance < best)
            best = distance, nearest = at;
    }
    return selector_of_place(text, nearest) ? best : INFINITY;
}

/* ---- *IMAGE ---- */

static int begins_image(const char *text)
{
    return strpbrk(text, "*?[.") != NULL;
}

static int read_image(Selector *selector, const Scene *scene, RetexError *err)
{
    (void)scene, (void)err;
    selector->name = selector->text;
    return RETEX_OK;
}

/* The first image of a pigment or of its map's pigments that the selector matches; any where it is NULL. */
static const char *image_of(const Pigment *pigment, const Selector *selector)
{
    if (pigment->kind == PIGMENT_IMAGE && pigment->image && pigment->image->path) {
        const char *path = pigment->image->path;
        if (!selector || fnmatch(selector->name, path, 0) == 0 || fnmatch(selector->name, base_name(path), 0) == 0)
            return path;
    }
    for (int k = 0; k < pigment->map.count; k++) {
        const Pigment *part = pigment->map.entries[k].pigment;
        const char *found = part ? image_of(part, selector) : NULL;
        if (found)
            return found;
    }
    return NULL;
}

static int texture_shows_image(const Selector *selector, const Texture *texture)
{
    return image_of(texture->pigment, selector) != NULL;
}

int selector_of_image(char text[SELECTOR_MAX], const Texture *texture)
{
    const char *path = texture && !texture->tree ? image_of(texture->pigment, NULL) : NULL;
    if (!path || snprintf(text, SELECTOR_MAX, "*%s", base_name(path)) >= SELECTOR_MAX)
        return 0;
    for (char *at = text + 1; *at; at++) /* what would mean something else in a pattern or a list */
        if (strchr(",*?[]()\\", *at))
            *at = '?';
    return 1;
}

static double near_image(const Selector *selector, const Texture *texture, const ObjectPart *object,
                         char text[SELECTOR_MAX])
{
    (void)object;
    return selector_of_image(text, texture) ? retex_word_distance(selector->name, text) : INFINITY;
}

/* ---- the table ---- */

static const SelectorForm forms[] = {
    {"object", 1, begins_number, read_number, texture_of_material, object_numbered, NULL},
    {"surface of the colour", 1, begins_color, read_color, texture_colored, NULL, near_color},
    {"object that begins in", 1, begins_place, read_place, NULL, object_placed, near_place},
    {"image", 0, begins_image, read_image, texture_shows_image, NULL, near_image},
    {"identifier", 0, begins_any, read_ident, texture_named, object_named, NULL},
};

int selector_matches(const Selector *selector, const Texture *texture, const ObjectPart *object)
{
    const SelectorForm *form = selector->form;
    return (texture && !texture->tree && form->texture && form->texture(selector, texture)) ||
           (object && form->object && form->object(selector, object));
}

int selector_points(const Selector *selector)
{
    return selector->form->points;
}

/* ---- whether there is what it selects ---- */

enum { NEAREST = 5 };
typedef struct Search {
    const Selector *selector;
    int found, count;
    double distances[NEAREST]; /* ascending */
    char texts[NEAREST][SELECTOR_MAX];
} Search;

static void add_near(Search *search, double distance, const char *text)
{
    int k = 0;
    for (int i = 0; i < search->count; i++)
        if (strcmp(search->texts[i], text) == 0)
            return;
    while (k < search->count && search->distances[k] <= distance)
        k++;
    if (k == NEAREST)
        return;
    if (search->count < NEAREST)
        search->count++;
    for (int i = search->count - 1; i > k; i--) {
        search->distances[i] = search->distances[i - 1];
        memcpy(search->texts[i], search->texts[i - 1], SELECTOR_MAX);
    }
    search->distances[k] = distance;
    snprintf(search->texts[k], SELECTOR_MAX, "%s", text);
}

static void look_at(Search *search, const Texture *texture, const ObjectPart *object)
{
    char text[SELECTOR_MAX];
    for (int k = 0; !search->found && k < (texture ? texture_leaf_count(texture) : 1); k++) {
        const Texture *leaf = texture ? texture_leaf(texture, k) : NULL;
        search->found = selector_matches(search->selector, leaf, object);
        const double distance = search->selector->form->near(search->selector, leaf, object, text);
        if (distance < INFINITY)
            add_near(search, distance, text);
    }
}

static int fail_no_match(const Search *search, RetexError *err)
{
    char list[256] = "";
    for (int k = 0; k < search->count; k++) {
        append(list, sizeof list, k ? ", " : "; nearest: ");
        append(list, sizeof list, search->texts[k]);
    }
    return retex_fail(err, RETEX_ENOTFOUND, "no %s `%s` in the scene%s", search->selector->form->what,
                      search->selector->text, list);
}

static int check_match(const Selector *selector, const Scene *scene, RetexError *err)
{
    Search search = {.selector = selector};
    const Texture *texture;
    int target;
    if (!selector->form->near)
        return RETEX_OK;
    for (int i = 0; i < scene->nprimitives && !search.found; i++) {
        const Primitive *p = &scene->primitives[i];
        const int own = 1 + (p->interior_texture != NULL);
        for (int k = 0; !search.found && (texture = primitive_texture(p, k, &target)); k++) {
            const ObjectPart object = object_part(scene, p, k < own ? 0 : k - own + 1);
            look_at(&search, k == 0 && p->inherits ? NULL : texture, &object);
        }
    }
    for (int i = 0; i < scene->ninstances && !search.found; i++) {
        const ObjectPart object = {.idents = scene->instances[i].idents, .places = scene->instances[i].places};
        look_at(&search, scene->instances[i].texture, &object);
    }
    return search.found ? RETEX_OK : fail_no_match(&search, err);
}

Selector selector_named(const char *ident)
{
    return (Selector){.form = &forms[sizeof forms / sizeof *forms - 1], .text = ident, .name = ident};
}

int selector_parse(Selector *selector, const Scene *scene, const char *text, RetexError *err)
{
    const SelectorForm *form = forms;
    while (!form->begins(text))
        form++;
    *selector = (Selector){.form = form, .text = arena_string(scene->arena, text, strlen(text))};
    if (!selector->text)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the targets");
    return form->read(selector, scene, err);
}

int selector_read(Selector *selector, const Scene *scene, const char *text, RetexError *err)
{
    int code = selector_parse(selector, scene, text, err);
    return code ? code : check_match(selector, scene, err);
}

int selector_read_name(char name[RETEX_NAME_MAX], const char *what, const char *spec, size_t length, RetexError *err)
{
    if (length == 0 || length >= RETEX_NAME_MAX)
        return retex_fail(err, RETEX_EINVAL, "%s `%s`: a name has 1 to %d bytes", what, spec, RETEX_NAME_MAX - 1);
    memcpy(name, spec, length);
    name[length] = 0;
    if (!retex_target_name_is_valid(name))
        return retex_fail(err, RETEX_EINVAL, "%s `%s`: a name has letters, digits, spaces and `_-.+()` only", what,
                          spec);
    return RETEX_OK;
}
