/* What is asked again and again about the faces of primitives (faces/faces.h), found once for each. */
#ifndef RENDERER_FACES_SCENE_FACES_H
#define RENDERER_FACES_SCENE_FACES_H

#include "faces/faces.h"

typedef struct SceneFaces {
    const Scene *scene;
    double size; /* as of faces_scene_size */
    struct KnownFaces {
        int is_known;
        int *flat; /* as of faces_flat; NULL where there are no faces */
        FaceOwner owner;
    } *of; /* by primitive */
} SceneFaces;

/* 0: no memory. */
int scene_faces_open(SceneFaces *faces, const Scene *scene);
void scene_faces_close(SceneFaces *faces);
/* What is known of a primitive; NULL: no memory. */
const struct KnownFaces *scene_faces_of(SceneFaces *faces, const Primitive *primitive);

#endif
