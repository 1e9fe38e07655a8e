/* See lib_error.h. */
#include "lib_error.h"

#include "lib_test.h"
#include "retexture/sample_row.h"
#include "texture/pyramid.h"

RetexImage test_error(const RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads)
{
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexImage error = {0};
    RetexError err = {0};
    test_must(retex_textures_load(textures, set, specs, nspecs, nthreads, &err), &err);
    test_must(retex_image_alloc(&error, set->width, set->height, 3, &err), &err);
    test_must(retex_estimate_error(set, textures, NULL, retex_image_keep_rows, &error, nthreads, &err), &err);
    retex_textures_close(textures);
    return error;
}

void test_lay_variances(RetexSet *set, const RetexTextureSpec *specs, int nspecs)
{
    RetexTexture *textures[RETEX_MAX_TARGETS], *squares[RETEX_MAX_TARGETS] = {0};
    RetexRowReader *reader;
    RetexError err = {0};
    test_must(retex_sample(set, specs, nspecs, 1, &err), &err);
    test_must(retex_textures_load(textures, set, specs, nspecs, 1, &err), &err);
    test_must(retex_row_reader_open(&reader, set, &err), &err);
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        const int t = f->target;
        if (!textures[t])
            continue;
        const RetexImage *image = test_laid(set, i);
        if (!squares[t])
            test_must(retex_texture_square(&squares[t], textures[t], 0, &err), &err);
        for (int y = 0; y < image->height; y++) {
            RetexFootprintRow row;
            test_must(retex_footprint_row_read(&row, reader, set, f, y, 0, &err), &err);
            retex_variance_row(textures[t], squares[t], retex_footprint_filter(set, f), &row,
                               image->pixels + retex_image_index(image, 0, y));
        }
    }
    retex_row_reader_close(&reader);
    retex_textures_close(textures);
    retex_textures_close(squares);
}
