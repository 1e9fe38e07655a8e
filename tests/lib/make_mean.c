/* make_mean OUT.exr IN...: the mean of pictures of one size. */
#include <stdio.h>
#include <string.h>
#include <retex/image.h>
#include <retex/image_file.h>

static int fail(const RetexError *err)
{
    fprintf(stderr, "make_mean: %s\n", err->message);
    return 2;
}

int main(int argc, char **argv)
{
    RetexImage sum = {0}, picture = {0};
    RetexError err = {0};
    for (int k = 2; k < argc; k++) {
        if (retex_image_read(&picture, argv[k], NULL, 1, &err))
            return fail(&err);
        if (k == 2 && retex_image_alloc(&sum, picture.width, picture.height, 3, &err))
            return fail(&err);
        if (picture.width != sum.width || picture.height != sum.height) {
            fprintf(stderr, "make_mean: %s has another size\n", argv[k]);
            return 2;
        }
        for (size_t i = 0; i < (size_t)sum.width * (size_t)sum.height; i++)
            for (size_t c = 0; c < 3; c++)
                sum.pixels[3 * i + c] += picture.pixels[4 * i + c] / (float)(argc - 2);
        retex_image_free(&picture);
    }
    if (argc < 3 || retex_image_write(&sum, argv[1], NULL, 1, &err))
        return fail(&err);
    retex_image_free(&sum);
    return 0;
}
