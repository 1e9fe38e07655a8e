/* A view as the source of parts: their rows are computed when they are asked for. Private to libretex. */
#ifndef RETEX_RETEXTURE_VIEW_SOURCE_H
#define RETEX_RETEXTURE_VIEW_SOURCE_H

#include "retexture/view.h"
#include "set/source.h"

/* Make a source whose parts are the images of a view, which is borrowed until no part has the source any more. It may
 * be the view of a set of which these are parts, unless a row is made of itself. */
int retex_view_source_open(RetexSetSource **source, const RetexView *view, RetexError *err);

#endif
