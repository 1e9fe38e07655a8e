/* Copies a set in EXR from standard input to standard output, without the checksums of bands: make_bandless <IN >OUT */
#include <stdio.h>
#include <stdlib.h>

#include "lib_damage.h"

int main(void)
{
    enum { MOST = 1 << 24 };
    unsigned char *bytes = malloc(MOST);
    const size_t size = bytes ? fread(bytes, 1, MOST, stdin) : 0;

    if (size == 0 || size == MOST)
        return 2;
    damage_drop_bands(bytes, size);
    const int is_written = fwrite(bytes, 1, size, stdout) == size && fflush(stdout) == 0;
    free(bytes);
    return is_written ? 0 : 2;
}
