/* Layout `paper`: light is kept apart by the number of hits alone, as the paper does, so that results can be compared.
 * There is dependent and independent radiance for each number of hits, cross terms of two and three hits, and for each
 * target and hit index one footprint, unweighted over all connections (supplement 2, 4.2, 4.3). With several targets
 * the dependent radiance is kept by the number of factors of each target. */
#ifndef RENDERER_FILM_PAPER_PAPER_H
#define RENDERER_FILM_PAPER_PAPER_H

#include "film/layout.h"

/* Its signals are the terms by the target of their first factor. */
extern const FilmLayout paper_layout;

#endif
