/* How pictures are developed: exposure and white balance, row by row. Private to libretex. */
#ifndef RETEX_RETEXTURE_DEVELOP_H
#define RETEX_RETEXTURE_DEVELOP_H

#include <retex/combine.h>

typedef struct RetexDeveloper {
    int is_needed;      /* 0: colours stay as they are */
    float matrix[3][3]; /* of scene-linear Rec.709 colours, rows first */
} RetexDeveloper;

/* given: as of RetexCombineParams, or NULL. Its auto_exposure is for the caller, who gives the stops that are added to
 * its exposure. RETEX_EINVAL where it is out of range. */
int retex_developer_open(RetexDeveloper *developer, const RetexDevelop *given, double stops, RetexError *err);

/* Develop pixels of red, green and blue in place. Results are limited to the largest float. */
void retex_develop_kernel(const RetexDeveloper *developer, float *rgb, size_t pixels);

#endif
