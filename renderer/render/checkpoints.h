/* Renders in pieces: bands that are kept when one ends early, and bands that others have rendered. */
#ifndef RENDERER_RENDER_CHECKPOINTS_H
#define RENDERER_RENDER_CHECKPOINTS_H

#include "film/film.h"
#include "render/render.h"

/* Where finished bands of a picture go, by the parameters: a checkpoint, a temporary file, or nowhere: NULL. */
int checkpoint_open(RetexBandStore **store, const RenderParams *params, int width, int height, RetexError *err);
/* Take over the bands of all files to be merged, where there are any: every band must be in one of them. */
int checkpoint_merge(RetexBandStore *store, const RenderParams *params, int width, int height, RetexError *err);
/* The film is not complete, because it was to stop: keep what there is. Always fails, and says how to go on. */
int checkpoint_keep(Film *film, const RenderParams *params, RetexError *err);

#endif
