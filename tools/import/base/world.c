/* See world.h. */
#include "import/base/world.h"

#include <stdlib.h>

void import_set_world(Import *import, char up)
{
    const double s = import->options->scale;
    const Affine y_up = {{{s, 0, 0, 0}, {0, s, 0, 0}, {0, 0, s, 0}}};
    const Affine z_up = {{{s, 0, 0, 0}, {0, 0, s, 0}, {0, -s, 0, 0}}};
    import->world = up == 'z' ? z_up : y_up;
}

void import_set_scale(Import *import, double scale)
{
    const Affine larger = {{{scale, 0, 0, 0}, {0, scale, 0, 0}, {0, 0, scale, 0}}};
    import->own_options->scale *= scale;
    import->world = affine_multiply(&larger, &import->world);
    for (int i = 0; i < import->gltf.ncameras; i++)
        import->gltf.cameras[i].place = affine_multiply(&larger, &import->gltf.cameras[i].place);
    for (int i = 0; i < import->gltf.nlights; i++)
        import->gltf.lights[i].place = affine_multiply(&larger, &import->gltf.lights[i].place);
}

typedef struct Place {
    const struct aiNode *node;
    Affine world;
} Place;

/* Without recursion, for files may nest deeply. */
int import_visit_nodes(Import *import, ImportVisit *visit, void *context)
{
    size_t count = 1, capacity = 256;
    Place *places = malloc(capacity * sizeof *places);
    if (!places)
        return 0;
    places[0] = (Place){import->scene->mRootNode, import->world};
    while (count) {
        const Place place = places[--count];
        const Affine own = affine_from(&place.node->mTransformation), world = affine_multiply(&place.world, &own);
        visit(import, place.node, &world, context);
        if (count + place.node->mNumChildren > capacity) {
            capacity = 2 * (count + place.node->mNumChildren);
            Place *more = realloc(places, capacity * sizeof *places);
            if (!more) {
                free(places);
                return 0;
            }
            places = more;
        }
        for (unsigned i = place.node->mNumChildren; i-- > 0;)
            places[count++] = (Place){place.node->mChildren[i], world};
    }
    free(places);
    return 1;
}
