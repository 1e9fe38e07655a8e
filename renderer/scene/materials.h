/* Which objects have one material: textures that came through the same name, or else the same texture statement. */
#ifndef RENDERER_SCENE_MATERIALS_H
#define RENDERER_SCENE_MATERIALS_H

#include "scene/scene.h"

/* An object, or one of its textures, where the shape has several. */
typedef struct ObjectPart {
    const IdentList *idents;
    const PlaceList *places;
    const Texture *texture; /* that it has; NULL: the instance's */
    int number; /* of the primitive, from 1, as in AOV `object`; 0: an instance */
    int part;   /* of the shape's textures, from 1; 0: what has the object's own texture */
} ObjectPart;

ObjectPart object_part(const Scene *scene, const Primitive *primitive, int part);

typedef struct Materials {
    const Scene *scene;
    int count;
    struct MaterialUse {
        const void *key; /* a name, which is kept once, or a texture */
        int number, part;
    } *uses; /* by key, then by number and part */
} Materials;

/* 0: no memory. */
int materials_open(Materials *materials, const Scene *scene);
void materials_close(Materials *materials);
/* The name of a texture or material that all of this texture came through: of several the one that the fewest objects
 * have. A pigment's name is none. NULL: there is none. */
const char *materials_name(const Materials *materials, const Texture *texture);
/* The first object whose material is that of this one, which may be itself. 0: no other object has it. */
int materials_first(const Materials *materials, const ObjectPart *object, ObjectPart *first);

#endif
