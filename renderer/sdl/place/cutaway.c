/* cutaway_textures: operands without a texture show those of what they cut.
 *
 * While a tree of CSG with it is placed, its operands are sorted: those to be filled in, and those whose textures are
 * seen inside. POV-Ray's rules: an operand of an intersection or difference without a texture is filled in, one of a
 * union or merge has the default texture as elsewhere; of a difference the first operand alone is cut. At a point,
 * each operand with a texture counts once if the point is inside it and all compounds around it. */
#include "sdl/place/place.h"

void cutaway_add(Sdl *sdl, const Inherited *in, const ParsedTexture *texture)
{
    Cutaway *cutaway = in->cutaway;
    if (!cutaway)
        return;
    if (!in->texture && in->csg->parent && in->csg->parent->kind == CSG_INTERSECTION) {
        cutaway->bare =
            sdl_grow(sdl, cutaway->bare, cutaway->nbare, &cutaway->bare_capacity, sizeof *cutaway->bare);
        cutaway->bare[cutaway->nbare++] = sdl_scene(sdl)->nprimitives - 1;
    } else if (!in->is_taken_off) {
        cutaway->cut = sdl_grow(sdl, cutaway->cut, cutaway->ncut, &cutaway->cut_capacity, sizeof *cutaway->cut);
        cutaway->cut[cutaway->ncut++] = (CutOperand){texture, in->idents, in->csg};
    }
}

static int same_texture(const CutOperand *a, const CutOperand *b)
{
    return a->texture == b->texture && a->idents == b->idents;
}

/* Textures with their operands: those of one texture are one entry, in the order of the first ones. */
static ParsedTextureMap *map_of_operands(Sdl *sdl, const Cutaway *cutaway)
{
    ParsedTextureMap *map = sdl_alloc(sdl, sizeof *map);
    TextureOperands *operands = sdl_alloc(sdl, (size_t)cutaway->ncut * sizeof *operands);
    const CutOperand **first = sdl_alloc(sdl, (size_t)cutaway->ncut * sizeof *first);
    int *capacity = sdl_alloc(sdl, (size_t)cutaway->ncut * sizeof *capacity);
    map->kind = TEXTURE_OPERANDS;
    map->operands = operands;
    map->entries = sdl_alloc(sdl, (size_t)cutaway->ncut * sizeof *map->entries);
    for (int i = 0; i < cutaway->ncut; i++) {
        const CutOperand *operand = &cutaway->cut[i];
        int k = map->count - 1;
        while (k >= 0 && !same_texture(first[k], operand))
            k--;
        sdl_step(sdl, map->count);
        if (k < 0) {
            texture_check_counts(sdl, &(TextureCounts){.leaves = k = map->count++});
            first[k] = operand;
            map->entries[k].texture = texture_named(sdl, operand->texture, operand->idents);
        }
        operands[k].nodes =
            sdl_grow(sdl, operands[k].nodes, operands[k].count, &capacity[k], sizeof *operands[k].nodes);
        operands[k].nodes[operands[k].count++] = operand->node;
    }
    return map;
}

void cutaway_complete(Sdl *sdl, const Cutaway *cutaway)
{
    if (!cutaway->nbare || !cutaway->ncut)
        return;
    const ParsedTextureMap *map = map_of_operands(sdl, cutaway);
    const ParsedTexture *texture =
        map->count == 1 ? map->entries[0].texture : texture_of_map(sdl, map, pigment_new(sdl, NULL), TEXTURE_OPERANDS);
    for (int i = 0; i < cutaway->nbare; i++)
        sdl_scene(sdl)->primitives[cutaway->bare[i]].texture = &texture->texture;
}
