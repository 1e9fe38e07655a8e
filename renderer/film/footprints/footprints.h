/* Layout `footprints`: light is kept apart by where it met a target first.
 *
 * A monomial of a light path, c_S times the textures at its hits S, goes by the first hit of S: into one of few
 * clusters of UV that a pixel has for each target, those seen sharply apart from the rest. A cluster holds the radiance
 * that its texture multiplies: once, and again for each combination of further hits that the plan keeps; these take the
 * target's pooled interreflection footprints. I = C0 + sum over clusters k of A_k (c_k0 + sum over i of c_ki B^i). */
#ifndef RENDERER_FILM_FOOTPRINTS_FOOTPRINTS_H
#define RENDERER_FILM_FOOTPRINTS_FOOTPRINTS_H

#include "film/layout.h"

/* Its signals are, by target, sharp and broad clusters, with their light that meets further hits. */
extern const FilmLayout footprints_layout;

#endif
