/* The sky as a light: its radiance, and a table over the sphere for sampling directions by luminance. */
#include <stdlib.h>
#include <string.h>
#include "light/entry.h"
#include "light/environment.h"
#include "pattern/pattern.h"
#include "shade/pigment.h"
#include "shade/working_space.h"

#define TABLE_WIDTH SKY_TABLE_WIDTH
#define TABLE_HEIGHT SKY_TABLE_HEIGHT

/* Of the background, as surfaces see it. */
static Rgb background_light(const Scene *scene)
{
    return scene->background_only_seen ? rgb_grey(0) : scene->background;
}

Rgb sky_radiance(const Scene *scene, Vec3 direction, int seen)
{
    Rgb sum = seen ? scene->background : background_light(scene);
    if (!scene->sky)
        return sum;
    for (int k = 0; k < scene->sky->npigments; k++) {
        Rgbft c = pigment_eval(scene->sky->pigments[k], direction, (Vec2){0, 0});
        float opaque = fmaxf(0, 1 - c.filter - c.transmit);
        Rgb color = rgb(c.r, c.g, c.b), tint = scene->sky->filters ? color : rgb_grey(1),
            through = rgb_add(rgb_scale(tint, c.filter), rgb_grey(c.transmit));
        sum = rgb_add(rgb_mul(sum, through), rgb_mul(rgb_scale(color, opaque), scene->sky->emission));
    }
    return sum;
}

/* Sines and cosines of the angles that cells are looked at, two in each column and row. */
typedef struct Angles {
    double sine[2 * TABLE_WIDTH], cosine[2 * TABLE_WIDTH]; /* of longitudes */
    double polar_sine[2 * TABLE_HEIGHT], polar_cosine[2 * TABLE_HEIGHT];
} Angles;

static void find_angles(Angles *angles)
{
    for (int i = 0; i < 2 * TABLE_WIDTH; i++) {
        const double phi = 2 * PI * (0.5 * i + 0.25) / TABLE_WIDTH;
        angles->sine[i] = sin(phi), angles->cosine[i] = cos(phi);
    }
    for (int j = 0; j < 2 * TABLE_HEIGHT; j++) {
        const double theta = PI * (0.5 * j + 0.25) / TABLE_HEIGHT;
        angles->polar_sine[j] = sin(theta), angles->polar_cosine[j] = cos(theta);
    }
}

static int has_image(const Pigment *pigment)
{
    if (pigment->kind == PIGMENT_IMAGE)
        return 1;
    for (int i = 0; pigment->kind != PIGMENT_COLOR && i < pigment->map.count; i++)
        if (pigment->map.entries[i].pigment && has_image(pigment->map.entries[i].pigment))
            return 1;
    return 0;
}

static int sky_has_image(const Scene *scene)
{
    for (int k = 0; scene->sky && k < scene->sky->npigments; k++)
        if (has_image(scene->sky->pigments[k]))
            return 1;
    return 0;
}

/* Of a cell: the mean of its points from `first` on and before `end`, of four. */
static float cell_luminance(const Scene *scene, const Angles *angles, int x, int y, int first, int end)
{
    float sum = 0;
    for (int k = first; k < end; k++) {
        const int i = 2 * x + (k & 1), j = 2 * y + (k >> 1);
        const double sine = angles->polar_sine[j];
        const Vec3 direction = {sine * angles->cosine[i], angles->polar_cosine[j], sine * angles->sine[i]};
        sum += fmaxf(0, rgb_luminance(sky_radiance(scene, direction, 0)));
    }
    return sum / (float)(end - first);
}

/* In pictures a cell's is the mean of four points, so that a small sun between centres is not missed; of patterns,
 * which take long, it is that of one of the four in turn. */
static float pattern_luminance(const Scene *scene, const Angles *angles, int x, int y)
{
    const int k = (x + 2 * y) & 3;
    return cell_luminance(scene, angles, x, y, k, k + 1);
}

/* Luminances of a row's cells, only of the first count. */
static void row_luminances(const Scene *scene, const Angles *angles, int y, int count, float *luminances)
{
    const int whole = count == 1 || sky_has_image(scene);
    for (int x = 0; x < count; x++)
        luminances[x] = whole ? cell_luminance(scene, angles, x, y, 0, 4)
                              : pattern_luminance(scene, angles, x, y);
}

/* Whether the pigment depends on the height alone, to the bit: as most skies do. */
static int is_level(const Pigment *pigment)
{
    const Pattern *pattern = &pigment->pattern;
    const double vector[3] = {pattern->vector.x, pattern->vector.y, pattern->vector.z};
    const Vec3 *turbulence = &pattern->turbulence.amount;
    if (pigment->kind == PIGMENT_COLOR)
        return 1;
    if (pigment->kind != PIGMENT_PATTERN || pattern->ops != &pattern_gradient || pattern->warps || turbulence->x != 0 ||
        turbulence->y != 0 || turbulence->z != 0 || pigment->uv_mapping)
        return 0;
    for (int i = 0; i < pigment->map.count; i++)
        if (pigment->map.entries[i].pigment)
            return 0;
    for (int i = 0; i < 3; i++)
        if (vector[i] * pigment->transform.inverse[i][0] != 0 || vector[i] * pigment->transform.inverse[i][2] != 0)
            return 0;
    return 1;
}

static int sky_is_level(const Scene *scene)
{
    for (int k = 0; scene->sky && k < scene->sky->npigments; k++)
        if (!is_level(scene->sky->pigments[k]))
            return 0;
    return 1;
}

/* Columns of a row that differ. */
static int columns_looked_at(const Scene *scene)
{
    return sky_is_level(scene) ? 1 : TABLE_WIDTH;
}

int sky_shines(const Scene *scene)
{
    const int count = columns_looked_at(scene);
    float luminances[TABLE_WIDTH];
    Angles angles;
    find_angles(&angles);
    for (int y = 0; y < TABLE_HEIGHT; y++) {
        row_luminances(scene, &angles, y, count, luminances);
        for (int x = 0; x < count; x++)
            if (luminances[x] > 0)
                return 1;
    }
    return 0;
}

/* ---- patterns: as coarse as they are smooth ---- */

#define BLOCK 4     /* cells a side that are looked at once, where the sky is smooth */
#define ROUGH 1.5f  /* ratio of blocks side by side from which on each of their cells is looked at */
#define BRIGHT 24.0f /* times the mean: a sky that may be brighter somewhere has no blocks, which might miss a sun */
#define EDGE 8.0f    /* no cell has less than a cell beside it, over this */
#define BLOCKS_WIDE (TABLE_WIDTH / BLOCK)
#define BLOCKS_HIGH (TABLE_HEIGHT / BLOCK)

static float brightest_color(const WorkingSpace *space, Rgbft c)
{
    const float most = rgb_max(working_decode(space, rgb(c.r, c.g, c.b)));
    const int adds_light = c.filter < 0 || c.transmit < 0 || c.filter + c.transmit > 1 || (c.filter > 0 && most > 1);
    return adds_light ? INFINITY : most;
}

/* No luminance of the pigment is larger. INFINITY: that is not known. */
static float brightest(const Pigment *pigment)
{
    float most = 0;
    if (pigment->kind == PIGMENT_COLOR)
        return brightest_color(NULL, pigment->color);
    if (pigment->kind == PIGMENT_IMAGE)
        return INFINITY;
    for (int i = 0; i < pigment->map.count; i++) {
        const ColorMapEntry *e = &pigment->map.entries[i];
        if (pigment->kind == PIGMENT_AVERAGE && e->value < 0)
            return INFINITY;
        most = fmaxf(most, e->pigment ? brightest(e->pigment) : brightest_color(pigment->space, e->color));
    }
    return most;
}

/* Layers blend: none makes what is below it brighter. */
static float brightest_of_sky(const Scene *scene)
{
    float most = rgb_max(background_light(scene));
    for (int k = 0; k < scene->sky->npigments; k++)
        most = fmaxf(most, brightest(scene->sky->pigments[k]) * rgb_max(scene->sky->emission));
    return most;
}

/* Whether a block and those about it are much the same. Columns wrap around. */
static int is_smooth(float (*blocks)[BLOCKS_WIDE], int i, int j)
{
    float least = INFINITY, most = 0;
    for (int k = 0; k < 9; k++) {
        const int y = j + k / 3 - 1;
        const float at = y < 0 || y >= BLOCKS_HIGH ? blocks[j][i] : blocks[y][(i + k % 3 - 1) & (BLOCKS_WIDE - 1)];
        least = fminf(least, at), most = fmaxf(most, at);
    }
    return most <= ROUGH * least;
}

/* Look at one cell of each block. Returns their mean. */
static double look_at_blocks(const Scene *scene, const Angles *angles, float (*blocks)[BLOCKS_WIDE])
{
    double sum = 0, weights = 0;
    for (int j = 0; j < BLOCKS_HIGH; j++)
        for (int i = 0; i < BLOCKS_WIDE; i++) {
            const double weight = sin(PI * (j + 0.5) / BLOCKS_HIGH);
            blocks[j][i] = cell_luminance(scene, angles, BLOCK * i + BLOCK / 2, BLOCK * j + BLOCK / 2, 0, 1);
            sum += weight * (double)blocks[j][i], weights += weight;
        }
    return sum / weights;
}

/* Between the looks at the blocks about the middle of a cell, linearly. */
static float smooth_luminance(float (*blocks)[BLOCKS_WIDE], int x, int y)
{
    const float u = ((float)x + 0.25f) / BLOCK + 0.5f, v = fmaxf(((float)y + 0.25f) / BLOCK + 0.5f, 1);
    const int i = (int)u, j = (int)v < BLOCKS_HIGH ? (int)v : BLOCKS_HIGH - 1; /* behind it */
    const int left = (i - 1) & (BLOCKS_WIDE - 1), right = i & (BLOCKS_WIDE - 1);
    const float s = u - (float)i, t = fminf(v - (float)j, 1);
    return (1 - t) * ((1 - s) * blocks[j - 1][left] + s * blocks[j - 1][right]) +
           t * ((1 - s) * blocks[j][left] + s * blocks[j][right]);
}

static void pattern_luminances(const Scene *scene, const Angles *angles, float *luminances)
{
    float blocks[BLOCKS_HIGH][BLOCKS_WIDE];
    const int has_blocks =
        (double)brightest_of_sky(scene) <= (double)BRIGHT * look_at_blocks(scene, angles, blocks);
    for (int j = 0; j < BLOCKS_HIGH; j++)
        for (int i = 0; i < BLOCKS_WIDE; i++) {
            const int whole = has_blocks && is_smooth(blocks, i, j);
            for (int k = 0; k < BLOCK * BLOCK; k++) {
                const int x = BLOCK * i + k % BLOCK, y = BLOCK * j + k / BLOCK;
                luminances[y * TABLE_WIDTH + x] =
                    whole ? smooth_luminance(blocks, x, y) : pattern_luminance(scene, angles, x, y);
            }
        }
}

/* The edge of a sun goes through cells whose one point is beside it: paths that find it there must not be so few that
 * each is a spot in the picture. */
static void widen_edges(float *luminances)
{
    float rows[3][TABLE_WIDTH], *above = rows[0], *here = rows[1], *below = rows[2];
    memcpy(here, luminances, sizeof rows[0]);
    memcpy(above, here, sizeof rows[0]);
    for (int y = 0; y < TABLE_HEIGHT; y++) {
        const int next = y + 1 < TABLE_HEIGHT ? y + 1 : y;
        float *swap = above;
        memcpy(below, luminances + (size_t)next * TABLE_WIDTH, sizeof rows[0]);
        for (int x = 0; x < TABLE_WIDTH; x++) {
            float most = 0;
            for (int k = -1; k <= 1; k++) {
                const int column = (x + k) & (TABLE_WIDTH - 1);
                most = fmaxf(most, fmaxf(fmaxf(above[column], below[column]), here[column]));
            }
            luminances[y * TABLE_WIDTH + x] = fmaxf(here[x], most / EDGE);
        }
        above = here, here = below, below = swap;
    }
}

static void find_luminances(const Scene *scene, float *luminances)
{
    const int looked_at = columns_looked_at(scene);
    Angles angles;
    find_angles(&angles);
    if (looked_at > 1 && !sky_has_image(scene)) {
        pattern_luminances(scene, &angles, luminances);
        widen_edges(luminances);
        return;
    }
    for (int y = 0; y < TABLE_HEIGHT; y++) {
        float *row = luminances + (size_t)y * TABLE_WIDTH;
        row_luminances(scene, &angles, y, looked_at, row);
        for (int x = looked_at; x < TABLE_WIDTH; x++)
            row[x] = row[0];
    }
}

int sky_table_of(SkyTable **table, const Scene *scene, int for_mis, RetexError *err)
{
    *table = NULL;
    if (!scene->sky && rgb_is_black(background_light(scene)))
        return RETEX_OK;
    float *luminances = malloc(sizeof(float) * TABLE_WIDTH * TABLE_HEIGHT);
    if (luminances)
        find_luminances(scene, luminances);
    *table = luminances ? sky_table_create(luminances, for_mis) : NULL;
    free(luminances);
    if (!*table)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the table of the sky");
    if (!(sky_table_mean(*table) > 0))
        sky_table_close(table);
    return RETEX_OK;
}

/* ---- in the list of lights ---- */

/* A uniform sky is sampled as well by the BSDF alone, without noise where nothing occludes it. */
static int add_sky(LightEntries *list, RetexError *err)
{
    SkyTable *table = NULL;
    int code = list->scene->sky ? sky_table_of(&table, list->scene, 1, err) : RETEX_OK;
    if (table)
        code = light_entries_add(list,
                                 &(LightEntry){.ops = &entry_sky,
                                               .lamp = list->scene->sky_lamp,
                                               .strength = sky_table_mean(table) * (float)PI,
                                               .is_infinite = 1,
                                               .data = table},
                                 err);
    if (code)
        sky_table_close(&table);
    return code;
}

static void close_sky(LightEntry *e)
{
    SkyTable *table = e->data;
    sky_table_close(&table);
}

static int sample_sky(const LightEntry *e, const LightPick *pick, Vec3 position, float u1, float u2,
                      LightSample *sample)
{
    (void)pick, (void)position;
    sample->source = NULL, sample->surface.primitive = NULL, sample->shadowless = 0, sample->is_sky = 1;
    sample->direction = sky_table_sample(e->data, u1, u2, &sample->pdf);
    sample->distance = INFINITY;
    return sample->pdf > 0;
}

static double sky_pdf(const LightEntry *e, Vec3 from, Vec3 direction, const Surface *surface, int *face)
{
    (void)from, (void)surface, (void)face;
    return sky_table_pdf(e->data, direction);
}

const LightEntryOps entry_sky = {.add = add_sky, .close = close_sky, .sample = sample_sky, .pdf = sky_pdf};
