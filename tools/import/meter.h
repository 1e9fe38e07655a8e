/* An exposure meter: what a small picture of a scene shows, and how bright it is to be. */
#ifndef RETEX_IMPORT_METER_H
#define RETEX_IMPORT_METER_H

#include <retex/retex.h>

#define METER_BRIGHTEST 0.89  /* 95 % of the range of sRGB */
#define METER_ENOUGH_LIT 0.93 /* of a picture within the range */
enum { METER_WIDTH = 96, METER_HEIGHT = 72, METER_BLOCKS = METER_WIDTH / 4 * (METER_HEIGHT / 4) };

/* What is seen in a block of pixels, in the mean of those that show a surface. */
typedef struct MeterBlock {
    double light, reflectance;
    int pixels, faint; /* those that show one; those that have next to nothing of its light */
} MeterBlock;

typedef struct Meter {
    MeterBlock blocks[METER_BLOCKS];
    int count;                /* of blocks that show surfaces */
    double bright;            /* nine tenths of them are darker */
    double stops;             /* that bring them to about their reflectance */
    double all[METER_BLOCKS]; /* the light of all blocks, with backdrop and what shines */
    double dark, white;       /* shares of them: dark after that; white as they are */
    int empty;                /* pixels without a surface */
    double backdrop;          /* the mean of their light */
    int is_noisy;
} Meter;

/* Read a set of METER_WIDTH x METER_HEIGHT pixels with the AOVs depth and reflectance. */
void meter_read(Meter *meter, const RetexSet *set);
/* The share of the picture that is between 5 and 95 % of the range with an exposure. */
double meter_lit(const Meter *meter, double stops);
/* The exposure of the whole picture: as its surfaces want, or somewhat darker if more is within the range by that. */
double meter_whole_stops(const Meter *meter);
/* What is brighter than nearly all of the picture, as the sky in windows. */
double meter_brightest(const Meter *meter);
/* The mean light of what is judged. */
double meter_mean(const Meter *meter);
/* Whether things are seen before black. */
int meter_is_bare(const Meter *meter);

#endif
