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

/* The log-average luminance of a picture, from all its rows: retex_auto_exposure. Strips are added up in their order,
 * so that it is the same for every number of threads. */
typedef struct RetexMeterStrip {
    double sum; /* of the logarithms of pixels that are not black, to base 2 */
    long count; /* of these */
} RetexMeterStrip;
typedef struct RetexMeter {
    size_t width;
    int nstrips;
    RetexMeterStrip *strips;
} RetexMeter;
int retex_meter_open(RetexMeter *meter, int width, int height, RetexError *err);
/* A RetexRowSink, of whose context it is. */
int retex_meter_rows(void *meter, int y0, int y1, const float *rows, RetexError *err);
/* The exposure, in stops; 0 where all is black. */
double retex_meter_close(RetexMeter *meter);

#endif
