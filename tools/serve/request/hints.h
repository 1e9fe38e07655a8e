/* Client hints: which size of a picture an <img> needs, by headers that a browser sends where the page lets it. For the
 * size `auto` of a URL; https://wicg.github.io/responsive-image-client-hints/ */
#ifndef RETEX_SERVE_HINTS_H
#define RETEX_SERVE_HINTS_H

#include "serve/request/request.h"

/* Headers, each by its new name or its old one; NULL where it is absent. */
typedef struct Hints {
    const char *width;          /* Sec-CH-Width, Width: the image's, in pixels of the screen */
    const char *viewport_width; /* Sec-CH-Viewport-Width, Viewport-Width: the page's, in pixels of CSS */
    const char *dpr;            /* Sec-CH-DPR, DPR: pixels of the screen in one of CSS */
} Hints;

/* Names for the answer: what browsers are asked to send, and by what the answer differs. */
#define HINTS_ACCEPT "Sec-CH-Width, Sec-CH-Viewport-Width, Sec-CH-DPR, Width, Viewport-Width, DPR"

/* The width of the picture: that of the image, else of the page, rounded up to one of few, so that a cache has few. 0:
 * the hints do not say. */
int hints_width(const Hints *hints);

/* The size of a request for `auto` becomes that; without hints it is that of the room. */
void hints_apply(ServeRequest *request, const Hints *hints);

#endif
