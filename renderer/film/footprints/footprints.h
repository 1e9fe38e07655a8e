/* Layout `footprints`: light is kept apart by where it met a target first.
 *
 * A monomial of a light path, c_S times the textures at its hits S, goes by the first hit of S: into one of few
 * clusters of UV that a pixel has for each target, those seen sharply apart from the rest. A cluster holds the radiance
 * that its texture multiplies: once, and again for each combination of further hits that the plan keeps; these take the
 * target's pooled interreflection footprints. I = C0 + sum over clusters k of A_k (c_k0 + sum over i of c_ki B^i). */
#ifndef RENDERER_FILM_FOOTPRINTS_FOOTPRINTS_H
#define RENDERER_FILM_FOOTPRINTS_FOOTPRINTS_H

#include "film/layout.h"

/* Signals of noise: sharp and broad clusters with the light that goes on to targets, each further hit as albedo 1/2. */
extern const FilmLayout footprints_layout;

#endif
