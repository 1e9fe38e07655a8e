/* Checkpoints: finished bands of a render that was stopped, or of shards. */
#ifndef RENDERER_RENDER_CHECKPOINTS_H
#define RENDERER_RENDER_CHECKPOINTS_H

#include "film/film.h"
#include "render/render.h"

/* Where finished bands of a picture go, by the parameters: a checkpoint, a temporary file, or nowhere: NULL. */
int checkpoint_open(RetexBandStore **store, const RenderParams *params, int width, int height, RetexError *err);
/* Copy the bands of all files to be merged, where there are any: every band must be in one of them. */
int checkpoint_merge(RetexBandStore *store, const RenderParams *params, int width, int height, RetexError *err);
/* Keep the finished bands of a render that was stopped. Always fails; the error says how to continue. */
int checkpoint_keep(Film *film, const RenderParams *params, RetexError *err);

#endif
