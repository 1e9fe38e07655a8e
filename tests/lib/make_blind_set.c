/* make_blind_set SET OUT: writes the set with a black beauty part, which is not its picture any more, to show that
 * recombination does not read that part of such a set. */
#include <retex/set.h>
#include <retex/set_file.h>
#include <stdio.h>
#include <string.h>

#include "set/laid.h"

int main(int argc, char **argv)
{
    RetexError err;
    RetexSet *set = NULL;
    if (argc != 3)
        return 2;
    if (retex_set_read(argv[1], &set, 0, &err))
        goto failed;
    RetexImage *beauty = &set->parts[0].image;
    memset(beauty->pixels, 0,
           (size_t)beauty->width * (size_t)beauty->height * (size_t)beauty->channels * sizeof(float));
    for (int t = set->nterms - 1; t >= 0; t--)
        if (set->terms[t].role == RETEX_ROLE_PICTURE)
            memmove(&set->terms[t], &set->terms[t + 1], sizeof *set->terms * (size_t)(--set->nterms - t));
    if (retex_set_write(set, argv[2], NULL, 0, &err))
        goto failed;
    retex_set_close(&set);
    return 0;
failed:
    fprintf(stderr, "make_blind_set: %s\n", err.message);
    return 2;
}
