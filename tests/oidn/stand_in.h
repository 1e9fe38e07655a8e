/* What the stand-in for Open Image Denoise counts and keeps, as the variable oidn_stand_in of the library. */
#ifndef OIDN_STAND_IN_H
#define OIDN_STAND_IN_H

enum { OIDN_PICTURES = 8, OIDN_PIXELS = 20000 };

typedef struct OidnStandIn {
    int devices, filters;           /* made and not released */
    int made_devices, made_filters; /* ever */
    int executed, misused; /* calls of oidnExecuteFilter; calls that the real library refuses or answers wrongly */
    int cancelled;         /* filters that were told to stop */
    int type, threads, affinity, megabytes, width, height;
    int npictures; /* executed, as far as they are kept */
    float color[OIDN_PICTURES][3 * OIDN_PIXELS], albedo[OIDN_PICTURES][3 * OIDN_PIXELS],
        normal[OIDN_PICTURES][3 * OIDN_PIXELS];
} OidnStandIn;

#endif
