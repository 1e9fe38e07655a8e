/* A distribution of directions that is constant within the cells of a table over the sphere: for sampling the sky. */
#ifndef RENDERER_LIGHT_SKY_TABLE_H
#define RENDERER_LIGHT_SKY_TABLE_H

#include "base/vec.h"

#define SKY_TABLE_WIDTH 1024 /* over longitude, from x to z */
#define SKY_TABLE_HEIGHT 512 /* over the polar angle, from y downwards */

typedef struct SkyTable SkyTable;

/* luminances: of the cells, row by row, none below 0. for_mis: densities are larger where the sky is brighter than
 * elsewhere, for directions that paths sample too; else they are proportional to luminance. NULL: out of memory. */
SkyTable *sky_table_create(const float *luminances, int for_mis);
void sky_table_close(SkyTable **table);
float sky_table_mean(const SkyTable *table); /* luminance, over the sphere; where it is 0 nothing can be sampled */
/* u1, u2: in [0,1). *pdf: per solid angle. */
Vec3 sky_table_sample(const SkyTable *table, float u1, float u2, float *pdf);
/* Ask memory for what sky_table_sample will read, of at most SKY_TABLE_PREFETCH samples. */
#define SKY_TABLE_PREFETCH 16
void sky_table_prefetch(const SkyTable *table, const float *u1, const float *u2, int count);
float sky_table_pdf(const SkyTable *table, Vec3 direction);

#endif
