/* Divides the light of a set among lamps: make_lamps IN OUT [R,G,B]; the first lamp then is of that colour, as if it
 * had been rendered so. */
#include <stdio.h>
#include <string.h>

#include "lib_test.h"

int main(int argc, char **argv)
{
    RetexError err = {0};
    RetexSet *set = NULL;
    float color[3];
    if (argc < 3 || (argc > 3 && sscanf(argv[3], "%f,%f,%f", &color[0], &color[1], &color[2]) != 3)) {
        fprintf(stderr, "usage: make_lamps IN OUT [R,G,B]\n");
        return 2;
    }
    test_must(retex_set_read(argv[1], &set, 0, &err), &err);
    for (int t = 0; t < set->nterms; t++)
        if (set->terms[t].role == RETEX_ROLE_PICTURE)
            set->terms[t] = set->terms[--set->nterms];
    test_divide_light(set);
    if (argc > 3)
        memcpy(set->parameters[retex_set_find_parameter(set, "Lamp")].value, color, sizeof color);
    test_must(retex_set_write(set, argv[2], NULL, 0, &err), &err);
    retex_set_close(&set);
    return 0;
}
