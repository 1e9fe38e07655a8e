/* Small scenes that are built without the scene language, and renders of them. */
#ifndef LIB_STAGE_H
#define LIB_STAGE_H

#include "render/render.h"
#include "shape/shapes.h"

typedef struct Stage {
    Scene *scene;
    Pigment pigments[4];
    Finish finishes[4];
    Texture textures[4];
    Interior interiors[4];
    Primitive primitives[4];
    Light lights[2];
    int max_depth;                /* 0 = the renderer's own */
    int paper;                    /* the layout */
    const RenderVariant *variant; /* or NULL */
} Stage;

Camera stage_orthographic(Vec3 location, Vec3 direction, Vec3 right, Vec3 up);

/* 16x12 pixels, seen from z = -5, without anything in it. */
void stage_open(Stage *s);

/* One more primitive with a colour and POV-Ray's plain diffuse finish of 1. */
Primitive *stage_add(Stage *s, const ShapeOps *ops, Transform transform, float r, float g, float b);

/* Must succeed. */
RetexSet *stage_render(Stage *s, int spp, int plain, int threads);
void stage_close(Stage *s);

/* A diffuse floor and sphere, both targets, under a sky and an emitter: light goes back and forth. */
void stage_open_targets(Stage *s);

/* A pixel of the picture, or of a part. */
const float *stage_pixel(const RetexSet *set, int x, int y);
const float *stage_part(const RetexSet *set, const char *name, int x, int y);

/* Fails if a value is not near the wanted one. */
void stage_expect(double value, double wanted, double tolerance, const char *what);

/* Scaled, then moved. */
Transform stage_at(double x, double y, double z, double scale);

#endif
