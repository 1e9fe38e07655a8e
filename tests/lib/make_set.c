/* Writes the synthetic set of lib_set.c, the input of the command-line tests:
 * make_set FILE.exr [WIDTH HEIGHT [SEED]] [WORD...]; WORD:
 *     footprints  layout footprints instead of paper
 *     plain       no terms, no targets: the beauty, and the other parts as AOVs
 *     denoise     with denoising data
 *     lamp:NAME   with a parameter of that name, which half of the light has as a factor
 *     name:TEXT   the next target, from the first on, has this name
 *     PART=VALUE  that value, such as nan or -inf, in the last channel of a part at 5,3 */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib_test.h"

static void spoil(RetexSet *set, char *word)
{
    char *value = strchr(word, '=');
    *value++ = '\0';
    const int part = retex_set_find_part(set, word);
    if (part < 0) {
        fprintf(stderr, "make_set: the set has no part '%s'\n", word);
        exit(2);
    }
    RetexImage *image = &set->parts[part].image;
    image->pixels[retex_image_index(image, 6, 3) - 1] = strtof(value, NULL);
}

int main(int argc, char **argv)
{
    RetexError err = {0};
    int numbers[3] = {48, 32, 1}, next = 2, renamed = 0;
    if (argc < 2) {
        fprintf(stderr, "usage: make_set FILE.exr [WIDTH HEIGHT [SEED]] [footprints] [plain] [denoise] [lamp:NAME] "
                        "[name:TEXT] [PART=VALUE]\n");
        return 2;
    }
    for (int n = 0; n < 3 && next < argc && isdigit((unsigned char)argv[next][0]); n++)
        numbers[n] = atoi(argv[next++]);
    RetexSet *set = test_set(numbers[0], numbers[1], (uint32_t)numbers[2]);
    for (; next < argc; next++) {
        if (strcmp(argv[next], "footprints") == 0) {
            test_make_footprints(set);
        } else if (strcmp(argv[next], "plain") == 0) {
            strcpy(set->layout, "plain");
            set->nterms = set->nmixtures = set->nfootprints = set->ntargets = 0;
        } else if (strcmp(argv[next], "denoise") == 0) {
            test_add_denoise_data(set);
        } else if (strncmp(argv[next], "lamp:", 5) == 0) {
            test_add_lamp(set, argv[next] + 5);
        } else if (strncmp(argv[next], "name:", 5) == 0 && renamed < set->ntargets) {
            snprintf(set->targets[renamed++].name, RETEX_NAME_MAX, "%s", argv[next] + 5);
        } else if (strchr(argv[next], '=')) {
            spoil(set, argv[next]);
        } else {
            fprintf(stderr, "make_set: what is '%s'?\n", argv[next]);
            return 2;
        }
    }
    test_must(retex_set_write(set, argv[1], NULL, 0, &err), &err);
    retex_set_close(&set);
    return 0;
}
