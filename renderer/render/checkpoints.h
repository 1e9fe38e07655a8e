/* Checkpoints: band stores with the finished bands of a render that was stopped, or of a shard. */
#ifndef RENDERER_RENDER_CHECKPOINTS_H
#define RENDERER_RENDER_CHECKPOINTS_H

#include "film/film.h"
#include "render/params.h"

/* Open the band store for the picture's finished bands: a checkpoint or a temporary file, as the parameters say. *store
 * is NULL if bands are kept in memory only. Fails if files of a shard or of --merge are not of this render. */
int checkpoint_open(RetexBandStore **store, const RenderParams *params, int width, int height, RetexError *err);
/* Whether this render is to leave the band: always, unless it is of another shard. */
int checkpoint_is_in_shard(const RenderParams *params, int band);
/* Copy the bands of all files of --merge, if there are any. Every band must be in one of them. */
int checkpoint_merge(RetexBandStore *store, const RenderParams *params, int width, int height, RetexError *err);
/* Save the finished bands of a render that was stopped. Always fails; the error says how to continue the render. */
int checkpoint_save(Film *film, const RenderParams *params, RetexError *err);

#endif
