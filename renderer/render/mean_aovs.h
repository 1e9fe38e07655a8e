/* AOVs that are averaged over the pixel as the picture is, for denoisers of other makers. */
#ifndef RENDERER_RENDER_MEAN_AOVS_H
#define RENDERER_RENDER_MEAN_AOVS_H

#include "render/internal.h"

/* Add and fill a part for each of these AOVs that is one of AOVS_AVERAGED. */
int mean_aovs_add(RetexSet *set, const Render *render, unsigned aovs, RetexError *err);

#endif
