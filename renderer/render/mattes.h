/* A file of mattes for compositors: the picture, masks of targets, and Cryptomatte of objects and materials. */
#ifndef RENDERER_RENDER_MATTES_H
#define RENDERER_RENDER_MATTES_H

#include "render/render.h"

enum { MATTE_RANKS = 6, MATTE_RANKS_MAX = 32 };

/* Whether the targets' masks have names of their own, and the file can be written: before the render. */
int mattes_check(const Scene *scene, const char *path, RetexError *err);

/* Trace the same camera rays as the render, at least 16 and at most 256 a pixel, and write the file. picture: what the
 * render made, of its size. ranks: names of a pixel in Cryptomatte, 1..MATTE_RANKS_MAX. */
int mattes_write(const Scene *scene, const RenderParams *params, const RetexImage *picture, int ranks, const char *path,
                 RetexError *err);

#endif
