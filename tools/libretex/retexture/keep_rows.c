/* The rows of a retexture as an image, see combine.h. */
#include <retex/combine.h>
#include <string.h>

int retex_image_keep_rows(void *image, int y0, int y1, const float *rows, RetexError *err)
{
    RetexImage *kept = image;
    if (!kept->pixels || kept->channels != 3 || y0 < 0 || y1 < y0 || y1 > kept->height)
        return retex_fail(err, RETEX_EINVAL, "rows %d to %d of a picture do not fit an image of %d rows, %d channels",
                          y0, y1, kept->height, kept->channels);
    const size_t first = retex_image_index(kept, 0, y0);
    memcpy(kept->pixels + first, rows, sizeof *rows * (retex_image_index(kept, 0, y1) - first));
    return RETEX_OK;
}
