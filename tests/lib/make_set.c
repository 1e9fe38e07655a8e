/* Writes the synthetic set of lib_set.c, what the command-line tests work on:
 * make_set FILE.exr [WIDTH HEIGHT [SEED]] */
#include <stdio.h>
#include <stdlib.h>

#include "lib_test.h"

int main(int argc, char **argv)
{
    RetexError err = {0};
    if (argc < 2) {
        fprintf(stderr, "usage: make_set FILE.exr [WIDTH HEIGHT [SEED]]\n");
        return 2;
    }
    RetexSet *set =
        test_set(argc > 3 ? atoi(argv[2]) : 48, argc > 3 ? atoi(argv[3]) : 32, argc > 4 ? (uint32_t)atoi(argv[4]) : 1);
    test_must(retex_set_write(set, NULL, argv[1], NULL, &err), &err);
    retex_set_close(&set);
    return 0;
}
