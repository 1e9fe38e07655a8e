/* make_digests [-a] [-s] FILE...: reads pictures as the tools read textures. For each a line: its name, then a digest
 * of its pixels as floats and one as integers, or the message of the error. What the libraries print themselves follows
 * as "printed:". Warnings are lines of their own. -a accepts damage, -s is safe access. */
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/image.h>
#include <retex/image_file.h>

#include "picture/image_read.h"

static void tell(void *context, const char *text)
{
    (void)context;
    printf("warning: %s\n", text);
}

static uint64_t digest(const void *data, size_t bytes)
{
    uint64_t sum = 14695981039346656037u;
    for (size_t i = 0; i < bytes; i++)
        sum = (sum ^ ((const unsigned char *)data)[i]) * 1099511628211u;
    return sum;
}

/* What was printed to standard error since the last time. */
static void tell_printed(FILE *printed)
{
    char line[256];
    rewind(printed);
    while (fgets(line, sizeof line, printed))
        printf("printed: %s%s", line, strchr(line, '\n') ? "" : "\n");
    rewind(printed);
    if (ftruncate(fileno(printed), 0) != 0)
        exit(2);
}

static void read_file(const char *path, const RetexReadParams *params)
{
    RetexImage wide = {0};
    RetexDecoded any;
    RetexError err = {0}, any_err = {0};
    RetexReadParams quiet = *params;
    const int code = retex_image_read(&wide, path, params, 0, &err);
    quiet.warn = NULL;
    const int any_code = retex_image_read_any(&any, path, &quiet, 0, &any_err);
    printf("%s ", path);
    if (code)
        printf("refused %d %s", code, err.message);
    else
        printf("%dx%d %016llx", wide.width, wide.height,
               (unsigned long long)digest(wide.pixels, sizeof(float) * 4 * (size_t)wide.width * (size_t)wide.height));
    if (!code != !any_code)
        printf(" but not as integers: %s", any_err.message);
    if (!any_code && any.narrow.pixels)
        printf(" %016llx",
               (unsigned long long)digest(any.narrow.pixels,
                                          sizeof(uint16_t) * 4 * (size_t)any.narrow.width * (size_t)any.narrow.height));
    printf("\n");
    retex_image_free(&wide);
    if (!any_code)
        retex_image_free(&any.image), free(any.narrow.pixels);
}

int main(int argc, char **argv)
{
    RetexReadParams params = RETEX_READ_INIT;
    RetexAccess access = RETEX_ACCESS_INIT;
    FILE *printed = tmpfile();
    params.warn = tell;
    params.access = &access;
    if (!printed || dup2(fileno(printed), 2) != 2)
        return 2;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "-a") == 0) {
            access.accept_damaged = 1;
            continue;
        }
        if (strcmp(argv[i], "-s") == 0) {
            access.safe = 1;
            continue;
        }
        read_file(argv[i], &params);
        tell_printed(printed);
        fflush(stdout);
    }
    fclose(printed);
    return 0;
}
