/* What a reader of scenes may choose. */
#ifndef RENDERER_SDL_LANG_OPTIONS_H
#define RENDERER_SDL_LANG_OPTIONS_H

#include <stddef.h>
#include <retex/budget.h>

/* Begin with SDL_OPTIONS_INIT. */
typedef struct SdlOptions {
    size_t size;
    const char *const *include_paths; /* searched after the current folder and the scene's own, before the system's */
    int ninclude_paths;
    const char *const *declares; /* "NAME=VALUE": floats, or strings where VALUE is quoted */
    int ndeclares;
    int strict;        /* 1: what is not supported is an error */
    int ambient;       /* 1: `ambient` gives light, as radiance ambient * pigment */
    long max_steps;    /* budget of statements and evaluations; default 200 million */
    size_t max_memory; /* bytes of the scene's arena; default 8 GiB */
    /* Every message of #debug, #warning and of the parser itself ("FILE:LINE: warning: …"), without a final newline;
     * NULL = silent. */
    void (*message)(void *context, int level /* 0 debug, 1 warning */, const char *text);
    void *message_context;
    RetexBudget *budget; /* memory is charged to it until the scene is closed, and it may stop the reading;
                                         NULL = neither */
    int width, height;   /* image_width and image_height of the language; 0 = the scene's own size */
    int safe;            /* 1: a stranger's scene: files by safe access (retex/access.h), and not in the
                                         current folder */
} SdlOptions;
#define SDL_OPTIONS_INIT                                                                                               \
    {                                                                                                                  \
        sizeof(SdlOptions), 0, 0, 0, 0, 0, 0, 200000000, (size_t)8 << 30, 0, 0, 0, 0, 0, 0                             \
    }

#endif
