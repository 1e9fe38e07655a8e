/* How a picture is developed, in scene-linear colours, before it is written or shown through a view. */
#ifndef RETEX_DEVELOP_H
#define RETEX_DEVELOP_H

#include <stddef.h>

#define RETEX_EXPOSURE_MAX 30
#define RETEX_WHITE_BALANCE_MIN 1000
#define RETEX_WHITE_BALANCE_MAX 25000

/* Begin with RETEX_DEVELOP_INIT. */
typedef struct RetexDevelop {
    size_t size;
    double exposure;      /* stops: colours times 2^exposure; -RETEX_EXPOSURE_MAX to RETEX_EXPOSURE_MAX, default 0 */
    double white_balance; /* kelvins, RETEX_WHITE_BALANCE_MIN to _MAX: the colour of that light, retex_kelvin_color,
                             becomes white of the same luminance, and all colours follow by Bradford's adaptation (Lam,
                             'Metamerism and Colour Constancy', 1985). Default 0: as it is */
    int auto_exposure;    /* 1: retex_auto_exposure is added to the exposure, within the same limits. Default 0 */
} RetexDevelop;
#define RETEX_DEVELOP_INIT { sizeof(RetexDevelop), 0, 0, 0 }

#endif
