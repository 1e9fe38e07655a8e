/* See texture.h. */
#include "shade/pigment.h"
#include "shade/texture.h"

int texture_is_opaque(const Texture *texture)
{
    const TextureTree *tree = texture->tree;
    int opaque = 0;
    if (!tree)
        return !(texture->finish && finish_transmits(texture->finish)) && pigment_is_opaque(texture->pigment);
    for (int k = 0; k < tree->count; k++)
        opaque += texture_is_opaque(tree->parts[k]);
    return tree->kind == TEXTURE_LAYERS ? opaque > 0 : opaque == tree->count;
}

Rgb texture_emission(const Texture *texture)
{
    const int count = texture_leaf_count(texture);
    Rgb sum = {0, 0, 0};
    if (!texture->tree)
        return texture->finish->emission;
    for (int k = 0; k < count; k++)
        sum = rgb_add(sum, rgb_scale(texture_leaf(texture, k)->finish->emission, 1 / (float)count));
    return sum;
}

int texture_is_sampled(const Texture *texture)
{
    for (int k = 0; k < texture_leaf_count(texture); k++)
        if (finish_is_sampled(texture_leaf(texture, k)->finish))
            return 1;
    return 0;
}
