/* Layers and maps of textures as a whole: moved, named, counted, and made into the scene's trees. */
#include <string.h>
#include "sdl/texture/texture.h"
#include "shade/pigment.h"

enum {
    LEAVES_SEEN = 64, /* LEAVES_MAX of path/leaves.h */
    LEAVES_ALL = 4096,
    DEPTH = 64
};

static const ParsedPigment *pigment_of(const ParsedTexture *t)
{
    return parsed_pigment(t->texture.pigment);
}

ParsedTexture *texture_copy(Sdl *sdl, const ParsedTexture *from)
{
    ParsedTexture *texture = sdl_alloc(sdl, sizeof *texture);
    *texture = *from;
    return texture;
}

static ParsedTextureMap *map_copy(Sdl *sdl, const ParsedTextureMap *from)
{
    ParsedTextureMap *map = sdl_alloc(sdl, sizeof *map);
    *map = *from;
    map->entries = sdl_alloc(sdl, (size_t)from->count * sizeof *map->entries);
    memcpy(map->entries, from->entries, (size_t)from->count * sizeof *map->entries);
    sdl_step(sdl, from->count);
    return map;
}

/* ---- moves ---- */

/* Where pigments lie. One with uv_mapping lies in the surface's own space: what moves the surface does not move it. */
typedef struct Move {
    Transform by;
    int uv_mapping; /* they get it */
} Move;

static const ParsedPigment *moved_pigment(Sdl *sdl, const ParsedPigment *from, const Move *move)
{
    if (from->pigment.uv_mapping)
        return from;
    ParsedPigment *pigment = pigment_new(sdl, from);
    pigment->pigment.transform = transform_then(pigment->pigment.transform, move->by);
    pigment->pigment.uv_mapping = move->uv_mapping;
    return pigment;
}

static const Normal *moved_normal(Sdl *sdl, const Normal *from, const Move *move)
{
    const ParsedNormal *normal = parsed_normal(from);
    if (!normal || normal->normal.uv_mapping)
        return from;
    return &normal_changed(sdl, normal_moved(sdl, normal, &move->by), move->uv_mapping, 0)->normal;
}

static const ParsedTexture *moved(Sdl *sdl, const ParsedTexture *from, const Move *move)
{
    if (!from)
        return NULL;
    ParsedTexture *texture = texture_copy(sdl, from);
    texture->below = moved(sdl, from->below, move);
    texture->texture.uv_mapping |= move->uv_mapping;
    if (!from->map) {
        texture->texture.pigment = &moved_pigment(sdl, pigment_of(from), move)->pigment;
        texture->texture.normal = moved_normal(sdl, from->texture.normal, move);
        return texture;
    }
    ParsedTextureMap *map = map_copy(sdl, from->map);
    map->selector = moved_pigment(sdl, map->selector, move);
    for (int i = 0; i < map->count; i++)
        map->entries[i].texture = moved(sdl, map->entries[i].texture, move);
    texture->map = map;
    texture->texture.pigment = map->entries[0].texture->texture.pigment;
    return texture;
}

const ParsedTexture *texture_moved(Sdl *sdl, const ParsedTexture *texture, const Transform *by)
{
    return !texture || transform_is_identity(by) ? texture : moved(sdl, texture, &(Move){*by, 0});
}

const ParsedTexture *texture_nested(Sdl *sdl, const ParsedTexture *texture, const Pigment *in)
{
    if (!in->uv_mapping && transform_is_identity(&in->transform))
        return texture;
    return moved(sdl, texture, &(Move){in->transform, in->uv_mapping});
}

const ParsedTexture *texture_uv_mapped(Sdl *sdl, const ParsedTexture *texture)
{
    if (!texture ||
        (texture->texture.uv_mapping && texture->texture.pigment->uv_mapping && !texture->below && !texture->map))
        return texture;
    return moved(sdl, texture, &(Move){transform_identity(), 1});
}

/* ---- names ---- */

const ParsedTexture *texture_named(Sdl *sdl, const ParsedTexture *texture, const IdentList *more)
{
    if (!texture || !more)
        return texture;
    ParsedTexture *named = texture_copy(sdl, texture);
    named->below = texture_named(sdl, texture->below, more);
    if (!texture->map) {
        named->texture.idents = sdl_ident_join(sdl, texture->texture.idents, more);
        return named;
    }
    ParsedTextureMap *map = map_copy(sdl, texture->map);
    for (int i = 0; i < map->count; i++)
        map->entries[i].texture = texture_named(sdl, map->entries[i].texture, more);
    named->map = map;
    return named;
}

/* ---- layers ---- */

void texture_check_counts(Sdl *sdl, const TextureCounts *counts)
{
    if (counts->leaves > LEAVES_ALL)
        sdl_error(sdl, "a texture of more than %d textures", LEAVES_ALL);
    if (counts->seen > LEAVES_SEEN)
        sdl_error(sdl, "more than %d textures at one point", LEAVES_SEEN);
    if (counts->depth > DEPTH)
        sdl_error(sdl, "textures nested more than %d deep", DEPTH);
}

TextureCounts texture_counts(Sdl *sdl, const ParsedTexture *texture)
{
    if (texture->map)
        return texture->map->counts;
    TextureCounts counts = {0, 0, 0};
    for (; texture; texture = texture->below)
        counts.leaves++, counts.seen++;
    texture_check_counts(sdl, &counts);
    return counts;
}

const ParsedTexture *texture_over(Sdl *sdl, const ParsedTexture *top, const ParsedTexture *bottom)
{
    if (!bottom)
        return top;
    if (top->map || bottom->map)
        sdl_error(sdl, "a pattern of textures is no layer");
    ParsedTexture *texture = texture_copy(sdl, top);
    texture->below = top->below ? texture_over(sdl, top->below, bottom) : bottom;
    texture_counts(sdl, texture);
    return texture;
}

/* ---- visits ---- */

void texture_visit(Sdl *sdl, const ParsedTexture *texture, TextureVisitor *visit, SelectorVisitor *selector,
                   void *context)
{
    for (; texture; texture = texture->below) {
        if (!texture->map) {
            visit(sdl, texture, context);
            continue;
        }
        if (selector)
            selector(sdl, texture->map, context);
        for (int i = 0; i < texture->map->count; i++)
            texture_visit(sdl, texture->map->entries[i].texture, visit, selector, context);
    }
}

/* ---- the scene's trees ---- */

static void join_names(Sdl *sdl, ParsedTexture *leaf)
{
    leaf->texture.target = -1;
    leaf->texture.idents = sdl_ident_join(sdl, leaf->texture.pigment->idents, leaf->texture.idents);
}

/* A layer by itself. */
static const Texture *leaf_of(Sdl *sdl, const ParsedTexture *layer)
{
    ParsedTexture *leaf = texture_copy(sdl, layer);
    leaf->below = NULL;
    leaf->is_complete = 1;
    join_names(sdl, leaf);
    return &leaf->texture;
}

static void collect_leaves(TextureTree *tree)
{
    for (int k = 0; k < tree->count; k++)
        for (int j = 0; j < texture_leaf_count(tree->parts[k]); j++)
            tree->leaves[tree->nleaves++] = (Texture *)texture_leaf(tree->parts[k], j);
}

static TextureTree *tree_new(Sdl *sdl, TextureTreeKind kind, int count, int leaves)
{
    TextureTree *tree = sdl_alloc(sdl, sizeof *tree);
    tree->kind = kind;
    tree->count = count;
    tree->parts = sdl_alloc(sdl, (size_t)count * sizeof *tree->parts);
    tree->leaves = sdl_alloc(sdl, (size_t)leaves * sizeof *tree->leaves);
    return tree;
}

/* Down to the first one that hides what is below it. */
static const TextureTree *tree_of_layers(Sdl *sdl, const ParsedTexture *texture, int count)
{
    TextureTree *tree = tree_new(sdl, TEXTURE_LAYERS, count, count);
    tree->is_untinted = sdl_version(sdl) < 3.5;
    for (int k = 0; k < count; k++, texture = texture->below)
        tree->parts[k] = leaf_of(sdl, texture);
    collect_leaves(tree);
    return tree;
}

static int count_layers(const ParsedTexture *texture)
{
    int count = 1;
    for (; texture->below && !pigment_is_opaque(texture->texture.pigment); texture = texture->below)
        count++;
    return count;
}

/* Weights of an average: POV-Ray's are divided by their sum. */
static void set_weights(double *values, int count)
{
    double sum = 0;
    for (int k = 0; k < count; k++)
        sum += values[k] = fmax(values[k], 0);
    for (int k = 0; k < count; k++)
        values[k] = sum > 0 ? values[k] / sum : 1.0 / count;
}

static const TextureTree *tree_of_map(Sdl *sdl, const ParsedTextureMap *map)
{
    TextureTree *tree = tree_new(sdl, map->kind, map->count, map->counts.leaves);
    double *values = sdl_alloc(sdl, (size_t)map->count * sizeof *values);
    tree->selector = &map->selector->pigment;
    tree->operands = map->operands;
    tree->values = values;
    for (int k = 0; k < map->count; k++) {
        values[k] = map->entries[k].value;
        tree->parts[k] = texture_complete(sdl, map->entries[k].texture);
    }
    if (map->kind == TEXTURE_AVERAGE)
        set_weights(values, map->count);
    collect_leaves(tree);
    return tree;
}

/* Every texture is this scene's own copy by now. */
const Texture *texture_complete(Sdl *sdl, const ParsedTexture *from)
{
    ParsedTexture *texture = (ParsedTexture *)from;
    if (texture->is_complete)
        return &texture->texture;
    texture->is_complete = 1;
    const int layers = texture->map ? 0 : count_layers(texture);
    if (texture->map)
        texture->texture.tree = tree_of_map(sdl, texture->map);
    else if (layers > 1)
        texture->texture.tree = tree_of_layers(sdl, texture, layers);
    if (texture->texture.tree)
        texture->texture.idents = NULL; /* they are with the leaves */
    else
        join_names(sdl, texture);
    return &texture->texture;
}
