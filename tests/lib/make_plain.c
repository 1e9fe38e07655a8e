/* Copies a set, a stream or samples without compression, as pipes had them before: make_plain IN OUT */
#include <stdio.h>

#include <retex/retex.h>

int main(int argc, char **argv)
{
    RetexStoreParams store = RETEX_STORE_INIT;
    RetexSet *set = NULL;
    RetexError err = {0};

    store.compress = 0;
    if (argc != 3 || retex_set_open_any(argv[1], &set, 0, &err) || retex_set_write(set, argv[2], &store, 0, &err)) {
        fprintf(stderr, "make_plain: %s\n", argc == 3 ? err.message : "expected IN OUT");
        return 2;
    }
    retex_set_close(&set);
    return 0;
}
