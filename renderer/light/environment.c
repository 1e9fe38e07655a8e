/* The sky as a light: its radiance, and a table over the sphere for sampling directions by luminance. */
#include <stdlib.h>
#include "light/entry.h"
#include "light/environment.h"
#include "pattern/pattern.h"
#include "shade/pigment.h"

#define TABLE_WIDTH 1024 /* over longitude; the height is half of it, over the polar angle */
#define TABLE_HEIGHT 512

struct Environment {
    float mean;
    float conditional[TABLE_HEIGHT][TABLE_WIDTH + 1]; /* running sums of a row, from 0 to 1 */
    float marginal[TABLE_HEIGHT + 1];
    float density[TABLE_HEIGHT][TABLE_WIDTH]; /* per solid angle */
};

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

static void normalize_sums(float *sums, int count)
{
    float total = sums[count];
    for (int k = 1; k <= count; k++)
        sums[k] = total > 0 ? sums[k] / total : (float)k / (float)count;
    sums[count] = 1;
}

int environment_create(Environment **environment, const Scene *scene, RetexError *err)
{
    *environment = NULL;
    if (!scene->sky && rgb_is_black(background_light(scene)))
        return RETEX_OK;
    Environment *e = malloc(sizeof *e);
    if (!e)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the table of the sky");
    const int looked_at = columns_looked_at(scene);
    Longitudes longitudes;
    double total = 0;
    find_longitudes(&longitudes);
    for (int y = 0; y < TABLE_HEIGHT; y++) {
        double area = (cos(PI * y / TABLE_HEIGHT) - cos(PI * (y + 1) / TABLE_HEIGHT)) * 2 * PI / TABLE_WIDTH, row = 0;
        float *luminances = e->density[y];
        row_luminances(scene, &longitudes, y, looked_at, luminances);
        e->conditional[y][0] = 0;
        for (int x = 0; x < TABLE_WIDTH; x++) {
            row += luminances[x] = luminances[x < looked_at ? x : 0];
            e->conditional[y][x + 1] = (float)row;
        }
        normalize_sums(e->conditional[y], TABLE_WIDTH);
        total += row * area;
        e->marginal[y + 1] = (float)total;
    }
    e->marginal[0] = 0;
    normalize_sums(e->marginal, TABLE_HEIGHT);
    e->mean = (float)(total / (4 * PI));
    if (!(total > 0)) {
        free(e);
        return RETEX_OK;
    }
    for (int y = 0; y < TABLE_HEIGHT; y++)
        for (int x = 0; x < TABLE_WIDTH; x++)
            e->density[y][x] = (float)(e->density[y][x] / total);
    *environment = e;
    return RETEX_OK;
}

void environment_close(Environment **environment)
{
    free(*environment);
    *environment = NULL;
}

/* Largest k with sums[k] <= u. */
static int find_cell(const float *sums, int count, float u)
{
    int low = 0, high = count;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (sums[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    return low;
}

Vec3 environment_sample(const Environment *e, float u1, float u2, float *pdf)
{
    int y = find_cell(e->marginal, TABLE_HEIGHT, u2), x = find_cell(e->conditional[y], TABLE_WIDTH, u1);
    float width = e->conditional[y][x + 1] - e->conditional[y][x], height = e->marginal[y + 1] - e->marginal[y];
    double fx = width > 0 ? (u1 - e->conditional[y][x]) / width : 0.5,
           fy = height > 0 ? (u2 - e->marginal[y]) / height : 0.5;
    /* uniform in solid angle within the cell: cos(theta) is linear */
    double c0 = cos(PI * y / TABLE_HEIGHT), c1 = cos(PI * (y + 1) / TABLE_HEIGHT), c = c0 + (c1 - c0) * fy;
    double phi = 2 * PI * (x + fx) / TABLE_WIDTH, s = sqrt(fmax(0, 1 - c * c));
    *pdf = e->density[y][x];
    return vec3(s * cos(phi), c, s * sin(phi));
}

float environment_pdf(const Environment *e, Vec3 direction)
{
    double phi = atan2(direction.z, direction.x);
    if (phi < 0)
        phi += 2 * PI;
    int x = (int)(phi / (2 * PI) * TABLE_WIDTH), y = (int)(acos(fmax(-1, fmin(1, direction.y))) / PI * TABLE_HEIGHT);
    if (x >= TABLE_WIDTH)
        x = TABLE_WIDTH - 1;
    if (y >= TABLE_HEIGHT)
        y = TABLE_HEIGHT - 1;
    return e->density[y][x];
}

float environment_mean(const Environment *e)
{
    return e->mean;
}

/* ---- in the list of lights ---- */

/* A uniform sky is sampled as well by the BSDF alone, without noise where nothing occludes it. */
static int add_sky(LightEntries *list, RetexError *err)
{
    Environment *environment = NULL;
    int code = list->scene->sky ? environment_create(&environment, list->scene, err) : RETEX_OK;
    if (environment)
        code = light_entries_add(list,
                                 &(LightEntry){.ops = &entry_sky,
                                               .lamp = list->scene->sky_lamp,
                                               .strength = environment->mean * (float)PI,
                                               .is_infinite = 1,
                                               .data = environment},
                                 err);
    if (code)
        environment_close(&environment);
    return code;
}

static void close_sky(LightEntry *e)
{
    Environment *environment = e->data;
    environment_close(&environment);
}

static int sample_sky(const LightEntry *e, const LightPick *pick, Vec3 position, float u1, float u2,
                      LightSample *sample)
{
    (void)pick, (void)position;
    sample->source = NULL, sample->surface.primitive = NULL, sample->shadowless = 0;
    sample->direction = environment_sample(e->data, u1, u2, &sample->pdf);
    sample->distance = INFINITY;
    sample->radiance = sky_radiance(e->scene, sample->direction, 0);
    return sample->pdf > 0;
}

static double sky_pdf(const LightEntry *e, Vec3 from, Vec3 direction, const Surface *surface, int *face)
{
    (void)from, (void)surface, (void)face;
    return environment_pdf(e->data, direction);
}

const LightEntryOps entry_sky = {.add = add_sky, .close = close_sky, .sample = sample_sky, .pdf = sky_pdf};
