/* The sky as a light: its radiance, and a table over the sphere for sampling directions by luminance. */
#include <stdlib.h>
#include "light/entry.h"
#include "light/environment.h"
#include "pattern/pattern.h"
#include "shade/pigment.h"

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

/* Sines and cosines of the longitudes that cells are looked at, two in each column. */
typedef struct Longitudes {
    double sine[2 * TABLE_WIDTH], cosine[2 * TABLE_WIDTH];
} Longitudes;

static void find_longitudes(Longitudes *longitudes)
{
    for (int i = 0; i < 2 * TABLE_WIDTH; i++) {
        const double phi = 2 * PI * (0.5 * i + 0.25) / TABLE_WIDTH;
        longitudes->sine[i] = sin(phi), longitudes->cosine[i] = cos(phi);
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

/* Luminances of a row's cells, only of the first count. In pictures a cell's is the mean of four points, so that a
 * small sun between centres is not missed; of patterns, which take long, it is that of one of the four in turn. */
static void row_luminances(const Scene *scene, const Longitudes *longitudes, int y, int count, float *luminances)
{
    const int whole = count == 1 || sky_has_image(scene);
    double sine[2], cosine[2];
    for (int k = 0; k < 2; k++) {
        const double theta = PI * (y + 0.25 + 0.5 * k) / TABLE_HEIGHT;
        sine[k] = sin(theta), cosine[k] = cos(theta);
    }
    for (int x = 0; x < count; x++) {
        const int first = whole ? 0 : (x + 2 * y) & 3, end = whole ? 4 : first + 1;
        float sum = 0;
        for (int k = first; k < end; k++) {
            const int i = 2 * x + (k & 1), j = k >> 1;
            const Vec3 direction = {sine[j] * longitudes->cosine[i], cosine[j], sine[j] * longitudes->sine[i]};
            sum += fmaxf(0, rgb_luminance(sky_radiance(scene, direction, 0)));
        }
        luminances[x] = sum / (float)(end - first);
    }
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
    Longitudes longitudes;
    find_longitudes(&longitudes);
    for (int y = 0; y < TABLE_HEIGHT; y++) {
        row_luminances(scene, &longitudes, y, count, luminances);
        for (int x = 0; x < count; x++)
            if (luminances[x] > 0)
                return 1;
    }
    return 0;
}

int sky_table_of(SkyTable **table, const Scene *scene, RetexError *err)
{
    *table = NULL;
    if (!scene->sky && rgb_is_black(background_light(scene)))
        return RETEX_OK;
    const int looked_at = columns_looked_at(scene);
    float *luminances = malloc(sizeof(float) * TABLE_WIDTH * TABLE_HEIGHT);
    Longitudes longitudes;
    find_longitudes(&longitudes);
    for (int y = 0; luminances && y < TABLE_HEIGHT; y++) {
        float *row = luminances + (size_t)y * TABLE_WIDTH;
        row_luminances(scene, &longitudes, y, looked_at, row);
        for (int x = looked_at; x < TABLE_WIDTH; x++)
            row[x] = row[0];
    }
    *table = luminances ? sky_table_create(luminances) : NULL;
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
    int code = list->scene->sky ? sky_table_of(&table, list->scene, err) : RETEX_OK;
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
