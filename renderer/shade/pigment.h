/* Pigments: the colour of a surface at a point. */
#ifndef RENDERER_SHADE_PIGMENT_H
#define RENDERER_SHADE_PIGMENT_H

#include "pattern/pattern.h"
#include "shape/surface.h"

/* World point p; uv is the shape's UV (used with uv_mapping). Thread-safe. */
Rgbft pigment_eval(const Pigment *pigment, Vec3 p, Vec2 uv);
/* Of a map of the extension `retex`, which is on the shape's UV. */
Rgbft pigment_eval_on(const Pigment *map, const Surface *surface);
/* The same of a surface whose normal patterns may ask for; at->p is in the world. */
Rgbft pigment_eval_at(const Pigment *pigment, const PatternPoint *at, Vec2 uv);
/* The same as numbers of the scene's working space; a plain colour as it is kept in the pigment. */
Rgbft pigment_as_written(const Pigment *pigment, const PatternPoint *at);
/* A world point in pattern space. */
Vec3 pigment_point(const Pigment *pigment, Vec3 p, Vec2 uv);
/* The colour of an image's pigment at a point of pattern space, and target_uv's UV there. */
Rgbft pigment_eval_image(const Pigment *pigment, Vec3 pattern_point, Vec2 *target);
/* Of a pigment that chooses among textures: its pattern's value, or which colour the pattern chooses; and the index of
 * a material_map's image. */
double pigment_value(const Pigment *pigment, const PatternPoint *at, Vec2 uv);
int pigment_index(const Pigment *pigment, Vec3 p, Vec2 uv);
/* Moves a world point to where the textures that it chooses among are evaluated, as its pattern's warps do. Returns 0
 * where they move nothing. */
int pigment_warp(const Pigment *pigment, Vec3 *p);
/* Prefetch the texels of a planar image at that point. */
void pigment_prefetch_image(const Pigment *pigment, Vec3 pattern_point);
/* How much the pigment hides where it has that colour, from 0 to 1: 1 - filter - transmit. In scenes before version 3.7
 * the brightest component of the colour, as written, multiplies filter: then it may be more than what does not pass. */
float pigment_opacity(const Pigment *pigment, Rgbft color);
/* 1 where the pigment has the same colour and opacity everywhere. */
int pigment_is_constant(const Pigment *pigment);
/* 1 where the pigment is opaque everywhere: no filter, no transmit, no alpha of an image, no image with `once`. This is
 * the only place that decides it. */
int pigment_is_opaque(const Pigment *pigment);
/* The pigment's colour at a point of its pattern space, scene-linear. */
Rgbft pigment_pattern(const Pigment *pigment, const PatternPoint *at, Vec2 uv);
/* Bake the pigment's colour over the UV rectangle low..high (through target_uv's inverse this is exact for uv_mapping
 * and image maps; other pigments are baked on the plane through 0 of their pattern space that the dominant-axis rule
 * gives for axis 0..2). dst: RGB, unallocated, width x height. nthreads: as of retex_parallel. */
int pigment_bake(RetexImage *dst, const Pigment *pigment, int axis, const double low[2], const double high[2],
                 int width, int height, int nthreads, RetexError *err);

/* The UV a replacement texture is looked up at, for a surface that is a target. The rule (retex-scene(5)), after the
 * texture's own transforms: with uv_mapping, the shape's UV taken through the pigment's transform; else an image_map's
 * own projection; else the shape's natural parametrisation (natural != NULL), as it is; else planar: the point in
 * pattern space seen along the dominant axis of the normal there (x: (z,y), y: (x,z), z: (x,y)). */
Vec2 target_uv(const Pigment *pigment, Vec3 p, Vec3 normal, const Vec2 *mapped_uv, const Vec2 *natural);

#endif
