/* See shown.h. */
#include "faces/shown.h"
#include "faces/faces.h"

int shown_selector(char text[SELECTOR_MAX], const ShownSurface *shown, SelectorScope scope, const Materials *materials,
                   const int *flat)
{
    ObjectPart first;
    const int count = faces_count(shown->primitive);
    int face = count > 1 || shown->primitive->shape.mesh ? shown->face : 0;
    if (scope == SCOPE_OBJECT || (scope == SCOPE_MATERIAL && !materials_first(materials, &shown->part, &first)))
        return selector_of_object(text, &shown->part);
    if (scope == SCOPE_MATERIAL)
        return selector_of_scope(text, &first, scope, 0);
    if (scope == SCOPE_FLAT && flat && count && flat[face] >= 0)
        face = flat[face];
    return selector_of_scope(text, &shown->part, scope, count ? face + 1 : 1);
}
