/* The data of the shape isosurface. */
#ifndef RENDERER_SHAPE_ISOSURFACE_H
#define RENDERER_SHAPE_ISOSURFACE_H

#include "base/vec.h"
#include "function/function.h"

/* `contained_by` */
typedef struct Container {
    int spherical;  /* a sphere, else a box */
    Vec3 low, high; /* of the box, or of that around the sphere */
    Vec3 centre;
    double radius; /* of the sphere */
} Container;
#define CONTAINER_INIT                                                                                                 \
    {                                                                                                                  \
        0, {-1, -1, -1}, {1, 1, 1}, {0, 0, 0}, 0                                                                       \
    }

typedef struct Isosurface {
    const FunctionProgram *function; /* of x, y and z */
    double threshold;
    double accuracy;
    double max_gradient; /* with evaluates: to begin with, as learned */
    int evaluates;
    double least, factor, fall; /* of evaluate: where the gradient in use is larger than least it falls, by ray; it is
                                   raised to factor^2 times what is found where that is more than 1/factor of it */
    int open;                   /* the container does not close it */
    Container container;
} Isosurface;

/* Learns max_gradient by fixed rays through the container. Returns how many times the function was evaluated. */
long isosurface_learn(Isosurface *isosurface);

#endif
