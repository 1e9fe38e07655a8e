/* Adds the light of each lamp to a set: make_lamp_terms IN OUT [off | several]. */
#include <stdio.h>
#include <string.h>

#include "lib_test.h"

int main(int argc, char **argv)
{
    RetexError err = {0};
    RetexSet *set = NULL;
    const char *how = argc > 3 ? argv[3] : "";
    if (argc < 3) {
        fprintf(stderr, "usage: make_lamp_terms IN OUT [off | several]\n");
        return 2;
    }
    test_must(retex_set_read(argv[1], &set, 0, &err), &err);
    test_add_lamp_terms(set, strcmp(how, "off") == 0, strcmp(how, "several") == 0);
    if (!strcmp(how, "off")) /* the picture without it */
        test_must(retex_combine(&set->parts[0].image, set, NULL, NULL, 0, &err), &err);
    test_must(retex_set_write(set, argv[2], NULL, 0, &err), &err);
    retex_set_close(&set);
    return 0;
}
