/* Options for reading a scene. */
#ifndef RENDERER_SDL_LANG_OPTIONS_H
#define RENDERER_SDL_LANG_OPTIONS_H

#include <stddef.h>
#include <retex/budget.h>

/* Initialize with SDL_OPTIONS_INIT. */
typedef struct SdlOptions {
    size_t size;
    const char *const *include_paths; /* searched after the scene's folder, before the system's */
    int ninclude_paths;
    const char *const *declares; /* "NAME=VALUE": VALUE is a float or a quoted string */
    int ndeclares;
    int strict;        /* 1: unsupported features are errors */
    int lenient;       /* 1: unsupported shapes and cameras are not errors; strict has precedence */
    int caustics;      /* of light sources: 0 what the scene asks for, 1 all, -1 none */
    int ambient;       /* which `ambient` is emission: 0 what was made to shine, 1 all, -1 none */
    long max_steps;    /* limit of statements and evaluations; default 200 million */
    size_t max_memory; /* limit of the scene's arena in bytes; default 8 GiB */
    /* Receives each message of #debug, #warning and of the parser itself ("FILE:LINE: warning: …"), without a final
     * newline. NULL = no messages. */
    void (*message)(void *context, int level /* 0 debug, 1 warning */, const char *text);
    void *message_context;
    RetexBudget *budget; /* charged until the scene is closed; may stop parsing; or NULL */
    int width, height;   /* values of image_width and image_height in the scene; 0 = the scene's own size */
    int nthreads;        /* that images are read on; 0 = all cores */
    int safe;            /* 1: untrusted scene: safe access (retex/access.h), current folder excluded */
    int accept_damaged;  /* 1: damaged pictures are read as far as possible, with a warning */
    const char *camera;  /* instead of the scene's: a view as of camera/view.h, or one that is #declared; or NULL */
} SdlOptions;
#define SDL_OPTIONS_INIT                                                                                               \
    {                                                                                                                  \
        sizeof(SdlOptions), 0, 0, 0, 0, 0, 0, 0, 0, 200000000, (size_t)8 << 30, 0, 0, 0, 0, 0, 0, 0, 0, 0              \
    }

#endif
