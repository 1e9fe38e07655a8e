/* Finishes. */
#ifndef RENDERER_SDL_TEXTURE_FINISH_H
#define RENDERER_SDL_TEXTURE_FINISH_H

#include "sdl/state/builder.h"

typedef struct ParsedFinish {
    Finish finish;
    double ior;    /* written in the finish, as old scenes do; 0 = not */
    int shines;    /* its ambient is emission, or what is left of it */
    const char *name; /* that it was declared by, or NULL */
    Gaps gaps;
    struct ParsedFinish *next;
} ParsedFinish;

static inline const ParsedFinish *parsed_finish(const Finish *finish)
{
    return PARSED(ParsedFinish, finish, finish);
}

/* finish.c */
ParsedFinish *finish_new(Sdl *sdl, const ParsedFinish *from /* or NULL: the built-in one */);
ParsedFinish *parse_finish(Sdl *sdl, const ParsedFinish *from);

#endif
