/* A program of somebody else: puts a texture on a target of a set, and writes the picture.
 * outsider SET TARGET=IMAGE OUTPUT */
#include <retex/retex.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    RetexError err = {0};
    RetexSet *set = NULL;
    RetexSamples *samples = NULL;
    RetexImage picture = {0};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    if (argc != 4) {
        fprintf(stderr, "usage: outsider SET TARGET=IMAGE OUTPUT\n");
        return 2;
    }
    int code = retex_texture_spec_parse(&spec, "", argv[2], &err);
    if (code == RETEX_OK)
        code = retex_set_read(argv[1], &set, NULL, 0, &err);
    if (code == RETEX_OK)
        code = retex_sample(&samples, set, &spec, 1, 0, &err);
    if (code == RETEX_OK)
        code = retex_combine(&picture, set, samples, NULL, NULL, 0, &err);
    if (code == RETEX_OK)
        code = retex_image_write(&picture, argv[3], NULL, 0, &err);
    if (code != RETEX_OK)
        fprintf(stderr, "outsider: %s: %s\n", err.file, err.message);
    retex_image_free(&picture);
    retex_samples_close(&samples);
    retex_set_close(&set);
    return code == RETEX_OK ? 0 : 2;
}
