/* normal: bumps of a surface, by patterns, and by maps and lists of other normals. */
#include <string.h>
#include "pattern/pattern.h"
#include "sdl/texture/texture.h"
#include "shade/normal.h"

/* A normal while it is read. Patterns, their modifiers and transforms are read as a pigment's. */
typedef struct Reader {
    ParsedNormal *normal;
    ParsedPigment *pattern;
} Reader;

/* ---- maps ---- */

static void add_slope(Sdl *sdl, ParsedSlopeMap *map, int *capacity, SlopeMapEntry entry)
{
    map->entries = sdl_grow(sdl, map->entries, map->count, capacity, sizeof *map->entries);
    int i = map->count++;
    for (; i > 0 && map->entries[i - 1].value > entry.value; i--)
        map->entries[i] = map->entries[i - 1];
    map->entries[i] = entry;
}

static void add_normal(Sdl *sdl, ParsedNormalMap *map, int *capacity, NormalMapEntry entry, int sorted)
{
    map->entries = sdl_grow(sdl, map->entries, map->count, capacity, sizeof *map->entries);
    int i = map->count++;
    for (; sorted && i > 0 && map->entries[i - 1].value > entry.value; i--)
        map->entries[i] = map->entries[i - 1];
    map->entries[i] = entry;
    gaps_join(&map->gaps, &parsed_normal(entry.normal)->gaps);
}

/* The value of an identifier that was declared as such a map. */
static const void *known_map(Sdl *sdl, const char *word)
{
    const Value *value = peek_ident(sdl, VALUE_OTHER);
    if (!value || !value->word || strcmp(value->word, word) != 0)
        return NULL;
    const void *known = value->data;
    sdl_next(sdl);
    sdl_expect(sdl, "}");
    return known;
}

const ParsedSlopeMap *parse_slope_map(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    const ParsedSlopeMap *known = known_map(sdl, "slope_map");
    if (known)
        return known;
    ParsedSlopeMap *map = sdl_alloc(sdl, sizeof *map);
    int capacity = 0;
    while (sdl_accept(sdl, "[")) {
        const double value = sdl_float(sdl);
        sdl_optional_comma(sdl);
        const Vec2 curve = sdl_vector2(sdl);
        add_slope(sdl, map, &capacity, (SlopeMapEntry){value, curve.u, curve.v});
        sdl_expect(sdl, "]");
        sdl_optional_comma(sdl);
    }
    if (map->count == 0)
        sdl_expected(sdl, "`[` and an entry of the slope_map");
    sdl_expect(sdl, "}");
    return map;
}

static const ParsedNormal *parse_normal_body(Sdl *sdl, const ParsedNormal *from, char end);

const ParsedNormalMap *parse_normal_map(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    const ParsedNormalMap *known = known_map(sdl, "normal_map");
    if (known)
        return known;
    ParsedNormalMap *map = sdl_alloc(sdl, sizeof *map);
    int capacity = 0;
    statement_begin(sdl);
    while (sdl_accept(sdl, "[")) {
        const double value = optional_float(sdl, 1); /* of `average` it may be left out */
        sdl_optional_comma(sdl);
        const ParsedNormal *normal = parse_normal_body(sdl, default_normal(sdl), ']');
        add_normal(sdl, map, &capacity, (NormalMapEntry){value, &normal->normal}, 1);
        sdl_optional_comma(sdl);
    }
    statement_end(sdl);
    if (map->count == 0)
        sdl_expected(sdl, "`[` and an entry of the normal_map");
    sdl_expect(sdl, "}");
    return map;
}

static void use_normal_map(Reader *r, const ParsedNormalMap *map)
{
    Normal *n = &r->normal->normal;
    n->nentries = map->count, n->entries = map->entries;
    gaps_join(&r->normal->gaps, &map->gaps);
}

/* `checker normal{A} normal{B}`. Without a list, and in places that it does not have, the steps between the fields are
 * slopes. */
static void parse_normal_list(Sdl *sdl, Reader *r, int most)
{
    ParsedNormalMap list = {0};
    int capacity = 0;
    for (int i = 0; i < most && sdl_accept(sdl, "normal"); i++) {
        const ParsedNormal *normal = parse_normal(sdl, default_normal(sdl));
        add_normal(sdl, &list, &capacity, (NormalMapEntry){i, &normal->normal}, 0);
        sdl_optional_comma(sdl);
    }
    if (list.count == 0)
        return;
    while (list.count < most)
        add_normal(sdl, &list, &capacity, list.entries[list.count - 1], 0);
    r->normal->normal.kind = NORMAL_MAP;
    use_normal_map(r, &list);
}

/* ---- the body ---- */

/* One for the scene: a render writes it. */
static const PixelSize *scene_pixels(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    if (!scene->pixels)
        scene->pixels = sdl_alloc(sdl, sizeof *scene->pixels);
    return scene->pixels;
}

static double strength_of_heights(Sdl *sdl)
{
    const double strength = sdl_float(sdl);
    if (!(strength >= 0 && strength <= 1))
        sdl_error(sdl, "strength must lie between 0 and 1, not %g", strength);
    return strength;
}

static int accept_normal_pattern(Sdl *sdl, Reader *r)
{
    Normal *n = &r->normal->normal;
    if (sdl_accept(sdl, "bump_map")) {
        n->kind = NORMAL_IMAGE;
        n->bump_map = parse_bump_map(sdl, &n->size);
        return 1;
    }
    if (sdl_accept(sdl, "retex_normal_map")) {
        n->kind = NORMAL_TANGENT;
        n->vectors = parse_uv_pigment(sdl);
        n->size = 1;
        return 1;
    }
    if (sdl_accept(sdl, "retex_height_map")) {
        n->kind = NORMAL_HEIGHTS;
        n->vectors = parse_uv_pigment(sdl);
        n->size = optional_float(sdl, 1);
        n->strength = sdl_accept(sdl, "strength") ? strength_of_heights(sdl) : 1;
        n->pixels = scene_pixels(sdl);
        return 1;
    }
    if (sdl_accept(sdl, "average")) {
        n->kind = NORMAL_AVERAGE;
        return 1;
    }
    if (!accept_pattern_word(sdl, r->pattern))
        return 0;
    const PatternOps *ops = r->pattern->pigment.pattern.ops;
    n->nslopes = n->nentries = 0;
    if (normal_vectors(ops))
        n->kind = NORMAL_VECTORS, r->pattern->gaps.patterns = 0;
    else
        n->kind = NORMAL_SLOPE;
    parse_normal_list(sdl, r, ops->colors);
    if (ops->arguments == ARGUMENTS_OBJECT)
        sdl_expect(sdl, "}");
    return 1;
}

static int accept_normal_map(Sdl *sdl, Reader *r)
{
    Normal *n = &r->normal->normal;
    if (sdl_accept(sdl, "slope_map")) {
        const ParsedSlopeMap *map = parse_slope_map(sdl);
        n->nslopes = map->count, n->slopes = map->entries;
    } else if (sdl_accept(sdl, "normal_map")) {
        use_normal_map(r, parse_normal_map(sdl));
        if (n->kind != NORMAL_AVERAGE)
            n->kind = NORMAL_MAP;
    } else
        return 0;
    return 1;
}

static int accept_named(Sdl *sdl, Reader *r)
{
    const ParsedNormal *known = accept_ident(sdl, VALUE_NORMAL);
    if (!known)
        return 0;
    *r->normal = *known;
    r->pattern->pigment.pattern = known->normal.pattern;
    r->pattern->pigment.transform = known->normal.transform;
    return 1;
}

static int is_facets(const Pigment *pattern)
{
    return pattern->pattern.ops == &pattern_facets;
}

static void normal_item(Sdl *sdl, Reader *r)
{
    Normal *n = &r->normal->normal;
    Pigment *pattern = &r->pattern->pigment;
    Transform by;
    if (accept_named(sdl, r) || accept_normal_pattern(sdl, r) || accept_normal_map(sdl, r))
        return;
    if (accept_transform(sdl, &by))
        pattern->transform = transform_then(pattern->transform, by);
    else if (sdl_accept(sdl, "uv_mapping"))
        n->uv_mapping = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "no_bump_scale"))
        n->keeps_size = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "bump_size"))
        n->size = sdl_float(sdl);
    else if (sdl_accept(sdl, "accuracy")) {
        const double accuracy = sdl_float(sdl);
        n->accuracy = accuracy != 0 ? accuracy : n->accuracy;
    } else if (is_facets(pattern) && sdl_accept(sdl, "size"))
        n->facets.size = sdl_float(sdl);
    else if (is_facets(pattern) && sdl_accept(sdl, "coords"))
        n->facets.coords = sdl_float(sdl);
    else if (is_facets(pattern) && sdl_accept(sdl, "metric"))
        n->facets.metric = sdl_vector(sdl).x;
    else if (is_float_start(sdl))
        n->size = sdl_float(sdl);
    else if (!accept_pattern_modifier(sdl, r->pattern))
        sdl_expected(sdl, "a pattern, a modifier of patterns, a transform or the end of the normal");
}

static const ParsedNormal *parse_normal_body(Sdl *sdl, const ParsedNormal *from, char end)
{
    const char closing[2] = {end, 0};
    ParsedNormal *normal = sdl_alloc(sdl, sizeof *normal);
    Reader r = {normal, pigment_new(sdl, NULL)};
    normal->normal = (Normal){.size = 0.5, .accuracy = 0.02, .facets = {.size = 0.1, .metric = 2}};
    if (from) {
        *normal = *from;
        r.pattern->pigment.pattern = from->normal.pattern;
        r.pattern->pigment.transform = from->normal.transform;
    }
    statement_begin(sdl);
    while (!sdl_accept(sdl, closing))
        normal_item(sdl, &r), sdl_optional_comma(sdl);
    statement_end(sdl);
    Normal *n = &normal->normal;
    n->pattern = r.pattern->pigment.pattern;
    n->transform = r.pattern->pigment.transform;
    gaps_join(&normal->gaps, &r.pattern->gaps);
    if (n->kind == NORMAL_AVERAGE && n->nentries == 0)
        sdl_error(sdl, "`average` needs a normal_map");
    return normal;
}

const ParsedNormal *parse_normal(Sdl *sdl, const ParsedNormal *from)
{
    sdl_expect(sdl, "{");
    return parse_normal_body(sdl, from, '}');
}

/* ---- as part of a texture ---- */

const ParsedNormal *normal_moved(Sdl *sdl, const ParsedNormal *normal, const Transform *by)
{
    if (!normal || normal->normal.uv_mapping)
        return normal;
    ParsedNormal *moved = sdl_alloc(sdl, sizeof *moved);
    *moved = *normal;
    moved->normal.transform = transform_then(moved->normal.transform, *by);
    return moved;
}

const ParsedNormal *normal_changed(Sdl *sdl, const ParsedNormal *normal, int uv_mapping, int keeps_size)
{
    if (!normal || (normal->normal.uv_mapping >= uv_mapping && normal->normal.keeps_size >= keeps_size))
        return normal;
    ParsedNormal *changed = sdl_alloc(sdl, sizeof *changed);
    *changed = *normal;
    changed->normal.uv_mapping |= uv_mapping;
    changed->normal.keeps_size |= keeps_size;
    return changed;
}

void normal_load(Sdl *sdl, const Normal *normal)
{
    if (!normal)
        return;
    if (normal->kind == NORMAL_IMAGE)
        load_bump_map(sdl, normal->bump_map);
    if (normal->kind == NORMAL_TANGENT || normal->kind == NORMAL_HEIGHTS)
        load_pigment_images(sdl, normal->vectors, 0);
    for (int i = 0; i < normal->nentries; i++)
        normal_load(sdl, normal->entries[i].normal);
}
