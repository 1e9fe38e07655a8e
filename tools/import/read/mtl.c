/* Materials of OBJ files, as Assimp can read them. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "import/read/read.h"

/* Assimp takes all words that begin with a for `aniso`, reads a number from their second letter on, and refuses the
 * file where that is none. Nothing here uses anisotropy, so that the lines can be left out. */
FILE *mtl_prepare(FILE *in)
{
    const int descriptor = memfd_create("materials", MFD_CLOEXEC);
    FILE *out = descriptor < 0 ? NULL : fdopen(descriptor, "w+b");
    char *line = NULL;
    size_t size = 0;
    if (!out) {
        if (descriptor >= 0)
            close(descriptor);
        return in;
    }
    for (ssize_t length; (length = getline(&line, &size, in)) > 0;) {
        const char *word = line;
        while (isspace((unsigned char)*word))
            word++;
        if (*word == 'a')
            fputc('\n', out); /* messages count lines */
        else
            fwrite(line, 1, (size_t)length, out);
    }
    free(line);
    if (ferror(in) || fflush(out) != 0) {
        fclose(out);
        rewind(in);
        return in;
    }
    fclose(in);
    rewind(out);
    return out;
}
