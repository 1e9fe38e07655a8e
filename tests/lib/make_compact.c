/* Writes the compact form of a set: make_compact IN OUT [psnr=DB] [broad=N] [later=N] [gain=N] */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compact/compact.h"
#include "lib_test.h"

static int take(RetexCompactParams *params, const char *word)
{
    double value;
    char name[16];
    if (sscanf(word, "%15[a-z]=%lf", name, &value) != 2)
        return 0;
    if (strcmp(name, "psnr") == 0)
        params->psnr = value;
    else if (strcmp(name, "broad") == 0)
        params->broad = (int)value;
    else if (strcmp(name, "interreflection") == 0)
        params->interreflection = (int)value;
    else if (strcmp(name, "gain") == 0)
        params->gain = (int)value;
    else
        return 0;
    return 1;
}

int main(int argc, char **argv)
{
    RetexError err = {0};
    RetexCompactParams params = RETEX_COMPACT_INIT;
    RetexSet *set = NULL, *compact = NULL;
    int good = argc > 2;
    for (int i = 3; i < argc; i++)
        good &= take(&params, argv[i]);
    if (!good) {
        fprintf(stderr, "usage: make_compact IN OUT [psnr=DB] [broad=N] [later=N] [gain=N]\n");
        return 2;
    }
    test_must(retex_set_read(argv[1], &set, 0, &err), &err);
    test_must(retex_set_compact(&compact, set, &params, 0, &err), &err);
    test_must(retex_set_write(compact, argv[2], NULL, 0, &err), &err);
    retex_set_close(&set);
    retex_set_close(&compact);
    return 0;
}
