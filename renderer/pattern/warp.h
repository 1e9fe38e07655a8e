/* Warps and turbulence: what moves a point before a pattern is evaluated there. */
#ifndef RENDERER_PATTERN_WARP_H
#define RENDERER_PATTERN_WARP_H

#include "scene/scene.h"

/* One of the functions below. Points and vectors are of the space in which the warp is written. */
typedef Vec3 WarpFunction(const Warp *warp, Vec3 p);

struct Warp {
    WarpFunction *apply;
    const Warp *next; /* written before this one */
    int is_moved;
    Transform moved; /* where is_moved: the transforms written before it, from pattern space to the warp's */
    Turbulence turbulence;
    struct BlackHole {
        Vec3 center, repeat; /* 0: not repeated along that axis */
        Vec3 displacement;   /* of each copy, at random */
        double radius, strength, falloff;
        int is_inverse;
    } hole;
    struct Repeat {
        int axis;          /* 0 to 2 */
        float width;       /* POV-Ray computes with floats here */
        Vec3 flip, offset; /* flip: 1 or -1 */
    } repeat;
    struct Mapping {
        Vec3 orientation; /* unit length */
        double distance_exponent, major_radius, offset;
    } mapping;
};

/* The point of pattern space where the pattern is evaluated instead of at p. */
Vec3 warp_point(const Warp *warp, Vec3 p);
Vec3 turbulence_point(const Turbulence *turbulence, Vec3 p);

WarpFunction warp_turbulence, warp_black_hole, warp_repeat;
/* To UV, and a distance as third coordinate. */
WarpFunction warp_planar, warp_cylindrical, warp_spherical, warp_toroidal, warp_cubic;

#endif
