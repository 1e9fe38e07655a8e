/* What a picture of a batch is made from, as text: the beginning of its line in a journal. */
#ifndef RETEX_BATCH_SOURCES_H
#define RETEX_BATCH_SOURCES_H

#include <retex/texture.h>

/* The checksums of files that were read before. Zero-initialized. */
typedef struct SourceSums {
    struct SourceSum {
        char *path;
        char text[32]; /* "CRC32 BYTES" */
    } * buckets;         /* a hash table; its size is a power of two */
    size_t count, capacity;
} SourceSums;

/* The files that all pictures of a batch are made from, besides textures. */
typedef struct BatchSources {
    const char *set, *samples; /* samples: or NULL */
    const char *options;       /* all options that change pictures, in words */
    SourceSums sums;
} BatchSources;

/* Make the text, to be freed, of a picture with these textures and lamps: the text of an edit, or "". Textures are
 * sorted by target. */
int batch_sources_text(char **text, BatchSources *sources, const char *output, RetexTextureSpec *specs, int count,
                       const char *lights, RetexError *err);
void batch_sources_close(BatchSources *sources);

#endif
