/* Random scenes of all shapes: inside and through each other, sheared and stretched, with sizes from a thousandth of a
 * unit to a thousand units, near the origin and far from it. */
#ifndef LIB_RANDOM_SCENE_H
#define LIB_RANDOM_SCENE_H

#include "accel/accel.h"
#include "shape/shape.h"

enum { RANDOM_SHAPES = 24 };

extern uint32_t random_state;

double random_between(double low, double high);
double random_magnitude(double low, double high); /* uniform in its logarithm */
int random_below(int count);
int random_chance(double share);
Vec3 random_direction(void);

/* What lets light through, and which lights: any; one that is not bent. */
typedef struct RandomMaterial {
    const Texture *texture, *inside;
    const Interior *interior;
    int transparent, straight;
} RandomMaterial;

typedef struct RandomScene {
    uint32_t seed;
    Scene scene;
    Primitive shapes[RANDOM_SHAPES];
    const RandomMaterial *of[RANDOM_SHAPES];
    Accel *accel;
    Vec3 centre;
    double size;  /* half of what the shapes fill, about centre */
    double far;   /* where rays start at the farthest: as many sizes from the centre */
    double reach; /* largest coordinate of a triangle */
} RandomScene;

/* Fails the test where the scene cannot be traced. */
void random_scene(RandomScene *w, uint32_t seed);
/* Of about this size: even or not, sheared or not, turned, with its middle there. */
Transform random_transform(double size, Vec3 at);
void random_form(Primitive *p); /* radii, or a mesh */

ShapeTriangles test_triangles_of(const Primitive *p);
const int *test_corners_of(const Primitive *p, int triangle);
Vec3 test_corner_at(const Primitive *p, int index); /* in the world */
double test_size_of(Vec3 p);                        /* the largest coordinate */

#endif
