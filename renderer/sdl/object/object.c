/* Objects: their statements, compounds, identifiers, and the modifiers they share. */
#include <string.h>
#include "sdl/object/shape.h"
#include "shape/shape.h"

/* Through identifiers too: a compound that holds itself twice, forty times over, is a short text. */
#define MAX_COMPOUND_DEPTH 400
#define MAX_PARTS 5e7

Object *object_new(Sdl *sdl, ObjectKind kind)
{
    ObjectState *objects = objects_of(sdl);
    Object *object = objects->spare;
    objects->spare = NULL;
    if (object)
        memset(object, 0, sizeof *object);
    else
        object = sdl_alloc(sdl, sizeof *object);
    object->kind = kind;
    object->transform = transform_identity();
    object->line = sdl_peek(sdl)->line;
    object->parts = 1;
    return object;
}

/* Programs write long lists of shapes: each of them uses the memory of the one before. */
void object_done(Sdl *sdl, const Object *object)
{
    if (object->kind == OBJECT_SHAPE && !object->clips && !object->bounds)
        objects_of(sdl)->spare = (Object *)object;
}

/* ---- places ---- */

enum { MAX_PLACES = 16 }; /* of a statement and those around it; others are left out */

const PlaceList *places_join(Sdl *sdl, const PlaceList *within, const PlaceList *around)
{
    PlaceList *first = NULL, **end = &first;
    int count = 0;
    if (!within || !around)
        return within ? within : around;
    for (; within && count < MAX_PLACES; within = within->next, count++) {
        if (!within->next && within->line == around->line && strcmp(within->file, around->file) == 0)
            break;
        *end = sdl_alloc(sdl, sizeof **end);
        **end = *within;
        end = (PlaceList **)&(*end)->next;
    }
    *end = (PlaceList *)around;
    return first;
}

void object_report(Sdl *sdl, const Object *object)
{
    gaps_report(sdl, &object->gaps);
}

void object_count_child(Sdl *sdl, Object *object, const Object *child)
{
    if (child->depth + 1 > object->depth)
        object->depth = child->depth + 1;
    object->parts += child->parts;
    if (object->depth > MAX_COMPOUND_DEPTH)
        sdl_error(sdl, "objects are nested more than %d deep", MAX_COMPOUND_DEPTH);
    if (object->parts > MAX_PARTS)
        sdl_error(sdl, "an object of more than %.0f parts", MAX_PARTS);
}

/* A private copy: the modifiers that follow must not reach the identifier. */
static Object *copy_of(Sdl *sdl, const Object *known)
{
    Object *object = sdl_alloc(sdl, sizeof *object);
    *object = *known;
    return object;
}

static void moved_texture_move(MovedTexture *moved, const Transform *by)
{
    if (!moved->texture)
        return;
    moved->transform = moved->is_moved ? transform_then(moved->transform, *by) : *by;
    moved->is_moved = 1;
}

void object_move(Object *object, const Transform *by)
{
    object->transform = transform_then(object->transform, *by);
    if (interior_varies(object->interior))
        object->interior_transform = transform_then(object->interior_transform, *by);
    /* Under uv_mapping what moves an object does not move its texture. */
    if (!object->uv_mapping) {
        moved_texture_move(&object->texture, by);
        moved_texture_move(&object->interior_texture, by);
    }
}

/* The texture so far, in the object's present space, so that a layer can be laid over it. */
static const ParsedTexture *texture_so_far(Sdl *sdl, const MovedTexture *moved)
{
    return moved->is_moved ? texture_moved(sdl, moved->texture, &moved->transform) : moved->texture;
}

static void set_texture(MovedTexture *moved, const ParsedTexture *texture)
{
    moved->texture = texture;
    moved->is_moved = 0;
}

static void set_interior(Object *object, const ParsedInterior *interior)
{
    object->interior = interior;
    object->interior_transform = transform_identity();
}

/* ---- modifiers ---- */

static int accept_flag(Sdl *sdl, Object *object)
{
    static const struct {
        const char *word;
        unsigned flag;
    } flags[] = {
        {"no_shadow", OBJECT_NO_SHADOW},
        {"no_image", OBJECT_NO_IMAGE},
        {"no_reflection", OBJECT_NO_REFLECTION},
        {"hollow", OBJECT_HOLLOW},
        {"double_illuminate", OBJECT_DOUBLE_ILLUMINATE},
        {"cutaway_textures", OBJECT_CUTAWAY_TEXTURES},
        {"global_lights", OBJECT_GLOBAL_LIGHTS},
    };
    static const char *const ignored[] = {"sturm", "hierarchy", "no_radiosity", "split_union", "no_bump_scale", NULL};
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++)
        if (sdl_accept(sdl, flags[i].word)) {
            if (sdl_optional_bool(sdl, 1))
                object->flags |= flags[i].flag;
            else
                object->flags &= ~flags[i].flag;
            return 1;
        }
    for (int i = 0; ignored[i]; i++)
        if (sdl_accept(sdl, ignored[i])) {
            sdl_optional_bool(sdl, 1);
            return 1;
        }
    if (!sdl_accept(sdl, "inverse"))
        return 0;
    object->flags ^= OBJECT_INVERSE;
    return 1;
}

/* The objects of clipped_by or bounded_by, with the transforms that follow them. */
static const ClipList *parse_clips(Sdl *sdl, Object *object, const ClipList *list)
{
    const ClipList *before = list;
    const Object *one;
    Transform by;
    while ((one = accept_object(sdl))) {
        ClipList *clip = sdl_alloc(sdl, sizeof *clip);
        object_count_child(sdl, object, one);
        *clip = (ClipList){copy_of(sdl, one), object->transform, list};
        list = clip;
        sdl_optional_comma(sdl);
    }
    while (accept_transform(sdl, &by))
        for (const ClipList *clip = list; clip != before; clip = clip->next)
            object_move((Object *)clip->object, &by);
    sdl_expect(sdl, "}");
    return list;
}

static int accept_clips(Sdl *sdl, Object *object)
{
    const int clips = sdl_accept(sdl, "clipped_by");
    if (!clips && !sdl_accept(sdl, "bounded_by"))
        return 0;
    const ClipList **list = clips ? &object->clips : &object->bounds, *other = clips ? object->bounds : object->clips;
    sdl_expect(sdl, "{");
    if (sdl_accept(sdl, clips ? "bounded_by" : "clipped_by")) {
        *list = other;
        sdl_expect(sdl, "}");
    } else
        *list = parse_clips(sdl, object, *list);
    return 1;
}

static int accept_skipped(Sdl *sdl)
{
    if (!sdl_is(sdl, "radiosity"))
        return 0;
    skip_statement(sdl);
    return 1;
}

static void material(Sdl *sdl, Object *object)
{
    const ParsedMaterial *material = parse_material(sdl);
    const ParsedTexture *texture = texture_named(sdl, material->texture, material->idents);
    const ParsedTexture *inside = texture_named(sdl, material->interior_texture, material->idents);
    if (texture)
        set_texture(&object->texture, texture_over(sdl, texture, texture_so_far(sdl, &object->texture)));
    if (inside)
        set_texture(&object->interior_texture,
                    texture_over(sdl, inside, texture_so_far(sdl, &object->interior_texture)));
    if (material->interior)
        set_interior(object, material->interior);
}

static int accept_surface(Sdl *sdl, Object *object)
{
    if (sdl_accept(sdl, "texture"))
        set_texture(&object->texture, texture_over(sdl, parse_texture(sdl), texture_so_far(sdl, &object->texture)));
    else if (sdl_accept(sdl, "interior_texture"))
        set_texture(&object->interior_texture,
                    texture_over(sdl, parse_texture(sdl), texture_so_far(sdl, &object->interior_texture)));
    else if (sdl_accept(sdl, "material"))
        material(sdl, object);
    else if (sdl_accept(sdl, "interior"))
        set_interior(object, parse_interior(sdl, interior_moved(sdl, object->interior, &object->interior_transform)));
    else if (sdl_accept(sdl, "uv_mapping"))
        object->uv_mapping = sdl_optional_bool(sdl, 1);
    else if (sdl_is(sdl, "pigment") || sdl_is(sdl, "finish") || sdl_is(sdl, "normal")) {
        const ParsedTexture *texture = texture_so_far(sdl, &object->texture);
        accept_texture_part(sdl, &texture);
        set_texture(&object->texture, texture);
    } else
        return 0;
    return 1;
}

static int accept_object_modifier(Sdl *sdl, Object *object)
{
    Transform by;
    if (accept_transform(sdl, &by)) {
        object_move(object, &by);
        return 1;
    }
    if (accept_surface(sdl, object) || accept_flag(sdl, object) || accept_clips(sdl, object) || accept_skipped(sdl))
        return 1;
    if (sdl_accept(sdl, "photons")) {
        parse_photons(sdl, &object->flags);
        return 1;
    }
    /* The colour of previews, and of very old scenes: `sphere{0,1 color Red}`. */
    if (sdl_is(sdl, "color") || sdl_is(sdl, "colour")) {
        sdl_color(sdl);
        return 1;
    }
    return 0;
}

void parse_object_modifiers(Sdl *sdl, Object *object)
{
    while (!sdl_accept(sdl, "}"))
        if (!accept_object_modifier(sdl, object))
            sdl_expected(sdl, "an object modifier or }");
}

/* ---- compounds ---- */

static const struct {
    const char *word;
    CsgKind csg;
    int difference;
    unsigned flags;
} compounds[] = {
    {"union", CSG_UNION, 0, 0},
    {"merge", CSG_MERGE, 0, 0},
    {"light_group", CSG_UNION, 0, OBJECT_LIGHT_GROUP},
    {"difference", CSG_INTERSECTION, 1, 0},
    {"intersection", CSG_INTERSECTION, 0, 0},
};

static const Object *turned_inside_out(Sdl *sdl, const Object *object)
{
    Object *turned = copy_of(sdl, object);
    turned->flags ^= OBJECT_INVERSE;
    return turned;
}

static void add_children(Sdl *sdl, Object *compound)
{
    ObjectList **end = (ObjectList **)&compound->children;
    const Object *child;
    int seen = 0;
    while ((child = accept_object(sdl))) {
        sdl_optional_comma(sdl);
        object_count_child(sdl, compound, child);
        *end = sdl_alloc(sdl, sizeof **end);
        if (child->kind != OBJECT_LIGHT && seen++ > 0 && compound->difference)
            child = turned_inside_out(sdl, child);
        (*end)->object = child;
        end = &(*end)->next;
    }
}

static Object *compound(Sdl *sdl, int which)
{
    Object *object = object_new(sdl, OBJECT_COMPOUND);
    object->csg = compounds[which].csg;
    object->difference = compounds[which].difference;
    object->flags = compounds[which].flags;
    add_children(sdl, object);
    if (object->csg == CSG_UNION)
        gather_children(sdl, object);
    return object;
}

/* ---- statements ---- */

static const struct {
    const char *word;
    ShapeParser *parse;
} shapes[] = {
#define X(name) {#name, parse_##name},
    SHAPE_TABLE(X) SHAPE_KEYWORDS(X)
#undef X
};

static const Object *known_object(Sdl *sdl)
{
    const Object *known = accept_ident(sdl, VALUE_OBJECT);
    return known ? known : accept_ident(sdl, VALUE_LIGHT);
}

/* After the keyword of a shape or compound, whose braces may also hold an identifier of such an object. */
static Object *begin_block(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    const Object *known = known_object(sdl);
    return known ? copy_of(sdl, known) : NULL;
}

static Object *shape_statement(Sdl *sdl, ShapeParser *parse)
{
    Object *object = begin_block(sdl);
    if (!object) {
        object = object_new(sdl, OBJECT_SHAPE);
        parse(sdl, object);
    }
    parse_object_modifiers(sdl, object);
    return object;
}

static Object *compound_statement(Sdl *sdl, int which)
{
    Object *object = begin_block(sdl);
    if (!object)
        object = compound(sdl, which);
    parse_object_modifiers(sdl, object);
    return object;
}

static Object *object_statement(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    if (peek_ident(sdl, VALUE_OTHER)) {
        sdl_next(sdl);
        Object *empty = object_new(sdl, OBJECT_EMPTY);
        parse_object_modifiers(sdl, empty);
        return empty;
    }
    const Object *inner = known_object(sdl);
    if (!inner)
        inner = accept_object(sdl);
    if (!inner)
        sdl_expected(sdl, "an object");
    Object *object = copy_of(sdl, inner);
    parse_object_modifiers(sdl, object);
    return object;
}

/* The next token is a word; it is taken if it is this one. */
static int accept_word(Sdl *sdl, const char *next, const char *word)
{
    if (*next != *word || strcmp(next, word) != 0)
        return 0;
    sdl_next(sdl);
    return 1;
}

static const Object *statement(Sdl *sdl)
{
    const char *next = sdl_peek(sdl)->text;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        if (accept_word(sdl, next, shapes[i].word))
            return shape_statement(sdl, shapes[i].parse);
    if (accept_word(sdl, next, "object"))
        return object_statement(sdl);
    for (size_t i = 0; i < sizeof compounds / sizeof *compounds; i++)
        if (accept_word(sdl, next, compounds[i].word))
            return compound_statement(sdl, (int)i);
    if (accept_word(sdl, next, "light_source"))
        return parse_light_source(sdl);
    return NULL;
}

const Object *accept_object(Sdl *sdl)
{
    if (sdl_peek(sdl)->kind == TOKEN_IDENT)
        return known_object(sdl);
    if (sdl_peek(sdl)->kind != TOKEN_WORD)
        return NULL;
    PlaceList here = {.next = NULL}, *place;
    sdl_place(sdl, &here.file, &here.line);
    statement_begin(sdl);
    Object *object = (Object *)statement(sdl); /* its own copy */
    statement_end(sdl);
    if (object) {
        place = sdl_alloc(sdl, sizeof *place);
        *place = here;
        object->places = places_join(sdl, object->places, place);
    }
    return object;
}

static const Csg *accept_solid(Sdl *sdl)
{
    const Object *object = accept_ident(sdl, VALUE_OBJECT);
    if (!object)
        object = accept_object(sdl);
    return object ? object_solid(sdl, object) : NULL;
}

void object_begin(Sdl *sdl)
{
    builder_of(sdl)->object = sdl_alloc(sdl, sizeof *builder_of(sdl)->object);
    builder_of(sdl)->accept_solid = accept_solid;
}
