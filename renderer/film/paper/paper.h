/* Layout `paper`: per hit count the dependent and independent radiance, cross terms of two and three hits, and per
 * target and hit index the UV statistics, unweighted over all connections (supplement 2, 4.2, 4.3). With several
 * targets the dependent radiance is kept by the number of factors of each target. */
#ifndef RENDERER_FILM_PAPER_PAPER_H
#define RENDERER_FILM_PAPER_PAPER_H

#include "film/layout.h"

/* Signals of noise: terms by the target of their first factor, each further factor as albedo 1/2. */
extern const FilmLayout paper_layout;

#endif
