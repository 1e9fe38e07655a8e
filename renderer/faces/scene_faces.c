/* See scene_faces.h. */
#include <stdlib.h>
#include "faces/scene_faces.h"

int scene_faces_open(SceneFaces *faces, const Scene *scene)
{
    *faces = (SceneFaces){scene, faces_scene_size(scene), calloc((size_t)scene->nprimitives + 1, sizeof *faces->of)};
    return faces->of != NULL;
}

void scene_faces_close(SceneFaces *faces)
{
    for (int k = 0; faces->of && k < faces->scene->nprimitives; k++)
        free(faces->of[k].flat);
    free(faces->of);
    faces->of = NULL;
}

const struct KnownFaces *scene_faces_of(SceneFaces *faces, const Primitive *primitive)
{
    struct KnownFaces *known = &faces->of[primitive - faces->scene->primitives];
    if (known->is_known)
        return known;
    known->owner = faces_owner(faces->scene, primitive, faces->size);
    if (faces_count(primitive) && !(known->flat = faces_flat(primitive)))
        return NULL;
    known->is_known = 1;
    return known;
}
