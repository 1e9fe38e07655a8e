/* Checkpoints: band stores with the finished bands of a render that was stopped. */
#ifndef RENDERER_RENDER_CHECKPOINTS_H
#define RENDERER_RENDER_CHECKPOINTS_H

#include "film/film.h"
#include "render/params.h"

/* Open the band store for the picture's finished bands: a checkpoint or a temporary file, as the parameters say. *store
 * is NULL if bands are kept in memory only. Fails if the checkpoint is not of this render. */
int checkpoint_open(RetexBandStore **store, const RenderParams *params, int width, int height, RetexError *err);
/* Save the finished bands of a render that was stopped. Always fails; the error says how to continue the render. */
int checkpoint_save(Film *film, const RenderParams *params, RetexError *err);

#endif
