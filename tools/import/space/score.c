/* What a small picture has, and how much that is worth. The weights are such that views which people chose for models
 * of theirs are among the best of all: they stand far back, and see many things in whole. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "import/space/picture.h"

/* ---- what is in it ---- */

enum { MOST_PARTS = 96 };

/* Samples by what they are of; beyond so many, what else there is counts as one. */
typedef struct Parts {
    uint64_t of[MOST_PARTS];
    double shares[MOST_PARTS];
    unsigned char is_cut[MOST_PARTS]; /* by the edge of the picture */
    int count, last;
} Parts;

static void count_part(Parts *parts, uint64_t of, double share, int is_at_edge)
{
    int i = parts->count && parts->of[parts->last] == of ? parts->last : 0;
    while (i < parts->count && parts->of[i] != of)
        i++;
    if (i == MOST_PARTS)
        i--;
    if (i == parts->count)
        parts->of[i] = of, parts->is_cut[i] = 0, parts->shares[i] = 0, parts->count++;
    parts->shares[i] += share;
    parts->is_cut[i] |= (unsigned char)is_at_edge;
    parts->last = i;
}

static double entropy_of(const Parts *parts)
{
    double sum = 0;
    for (int i = 0; i < parts->count; i++)
        sum -= parts->shares[i] * log2(parts->shares[i]);
    return sum;
}

/* One object may be the floor, the walls and all that stands there: it is told apart by kinds. */
static void count_things(const Picture *picture, const uint32_t *materials, Content *c)
{
    Parts objects = {.count = 0}, substances = {.count = 0};
    const double share = 1.0 / (picture->width * picture->height);
    for (int j = 0; j < picture->height; j++)
        for (int i = 0; i < picture->width; i++) {
            const PictureSample *s = &picture->samples[j * picture->width + i];
            if (s->kind == PICTURE_NOTHING)
                continue;
            const int is_at_edge = i == 0 || i == picture->width - 1 || j == 0 || j == picture->height - 1;
            count_part(&objects, (uint64_t)s->tag * 8 + s->kind, share, is_at_edge);
            count_part(&substances, materials ? materials[s->tag] : s->tag, share, 0);
        }
    for (int i = 0; i < objects.count; i++) {
        c->things += objects.shares[i] > 0.003;
        if (objects.of[i] % 8 == PICTURE_FURNITURE) {
            c->largest = fmax(c->largest, objects.shares[i]);
            c->cut += objects.is_cut[i] ? objects.shares[i] : 0;
        }
    }
    c->objects = entropy_of(&objects), c->materials = entropy_of(&substances);
}

static void add_shares(const Picture *picture, Content *c)
{
    const double share = 1.0 / (picture->width * picture->height);
    double pieces = 0;
    for (int i = 0; i < picture->width * picture->height; i++) {
        const PictureSample *s = &picture->samples[i];
        const double u = 2 * (i % picture->width + 0.5) / picture->width - 1;
        const double v = 1 - 2 * (i / picture->width + 0.5) / picture->height, distance = (double)s->distance;
        if (s->kind == PICTURE_NOTHING) {
            c->nothing += share;
            continue;
        }
        c->near += share * fmin(fmax((1 - distance) / 0.5, 0), 1);
        c->back += s->is_front ? 0 : share;
        c->floor += s->kind == PICTURE_FLOOR ? share : 0;
        c->wall += s->kind == PICTURE_WALL ? share : 0;
        c->ceiling += s->kind == PICTURE_CEILING ? share : 0;
        if (s->kind != PICTURE_FURNITURE)
            continue;
        c->furniture += share;
        c->middle += share * fmax(0, 1 - u * u - v * v), pieces += share;
    }
    c->middle /= pieces > 0 ? pieces : 1;
}

static int is_other(const PictureSample *a, const PictureSample *b)
{
    return a->kind != b->kind || a->tag != b->tag || a->side != b->side;
}

/* Models of one mesh have no objects, but edges. */
static void add_detail(const Picture *picture, Content *c)
{
    int edges = 0;
    for (int j = 1; j < picture->height; j++)
        for (int i = 1; i < picture->width; i++) {
            const PictureSample *s = &picture->samples[j * picture->width + i];
            edges += is_other(s, s - 1) + is_other(s, s - picture->width);
        }
    c->detail = (double)edges / (picture->width + picture->height);
}

static int compare_distances(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Half of what is seen is nearer than the middle distance. Nearer and farther by a third are the foreground and the
 * background. */
static void add_depth(const Picture *picture, Content *c)
{
    enum { LAYERS = 3 };
    float distances[PICTURE_WIDTH * PICTURE_HEIGHT];
    double layers[LAYERS] = {0};
    const int all = picture->width * picture->height;
    int count = 0;
    for (int i = 0; i < all; i++)
        if (picture->samples[i].kind != PICTURE_NOTHING)
            distances[count++] = picture->samples[i].distance;
    if (!count)
        return;
    qsort(distances, (size_t)count, sizeof *distances, compare_distances);
    const double middle = (double)distances[count / 2];
    for (int i = 0; i < count; i++) {
        const double by = (double)distances[i] / middle;
        layers[by < 0.75 ? 0 : by < 1.33 ? 1 : 2] += 1.0 / count;
    }
    for (int i = 0; i < LAYERS; i++)
        c->depth += fmin(layers[i] / 0.15, 1) / LAYERS;
    for (int i = 0; i < all; i++) {
        const PictureSample *s = &picture->samples[i];
        const int stands = s->kind != PICTURE_NOTHING && s->kind != PICTURE_FLOOR;
        c->obstacle += stands && (double)s->distance < 0.65 * middle ? 1.0 / all : 0;
    }
}

/* The standard deviation of the places that are seen. */
static void add_extent(const Picture *picture, Content *c)
{
    double sum[2] = {0}, squares = 0, n = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < picture->width * picture->height; i++) {
            const PictureSample *s = &picture->samples[i];
            if (s->kind == PICTURE_NOTHING)
                continue;
            n += !pass;
            for (int k = 0; k < 2; k++) {
                const double x = (double)s->at[k];
                sum[k] += pass ? 0 : x;
                squares += pass ? pow(x - sum[k] / n, 2) : 0;
            }
        }
    c->extent = n > 0 && picture->size > 0 ? sqrt(squares / n) / picture->size : 0;
}

Content picture_content(const Picture *picture, const uint32_t *materials)
{
    Content content = {.tilt = picture->tilt};
    count_things(picture, materials, &content);
    add_shares(picture, &content);
    add_detail(picture, &content);
    add_depth(picture, &content);
    add_extent(picture, &content);
    return content;
}

/* ---- what that is worth ---- */

/* It counts from `none` on, and in full at `all`. */
typedef struct Term {
    size_t at; /* in Content */
    double weight, none, all;
} Term;

#define TERM(name, weight, none, all)                                                                                  \
    {                                                                                                                  \
        offsetof(Content, name), weight, none, all                                                                     \
    }

static const Term terms[] = {
    TERM(objects, 1.0, 0, 4.5), /* much is to be seen, */
    TERM(detail, 1.0, 1, 7),       TERM(materials, 0.7, 0, 3.5),
    TERM(extent, 1.8, 0, 0.3), /* of the whole room, */
    TERM(furniture, 0.8, 0, 0.15), TERM(middle, 0.8, 0, 0.7),
    TERM(depth, 0.3, 0, 1),        TERM(floor, 0.8, 0, 0.2), /* which has a floor, at least some of it, and walls; */
    TERM(floor, 1.0, 0.01, 0.06),  TERM(wall, 0.4, 0, 0.15),
    TERM(ceiling, -0.6, 0.2, 1),                           /* little of the picture is lost, */
    TERM(nothing, -0.9, 0.15, 1),  TERM(back, -1.5, 0, 1), /* above all if one is not within a solid; */
    TERM(back, -1.2, 0.8, 1),      TERM(near, -4, 0, 1),   /* nothing stands in the way, */
    TERM(obstacle, -1.2, 0, 0.5),  TERM(largest, -1.2, 0.12, 0.5),
    TERM(cut, -1.0, 0, 1),         TERM(tilt, -0.4, 0.3, 1),  /* the horizon is level, and it is no plan from above; */
    TERM(tilt, -0.4, 0.55, 0.7),   TERM(open, -3, 0.08, 0.2), /* one is in a room, or outside of one that is open, */
    TERM(behind, -0.6, 0, 1),                                 /* and things have their front there */
};

double content_score(const Content *content)
{
    double score = 0;
    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        const Term *t = &terms[i];
        const double value = *(const double *)((const char *)content + t->at);
        score += t->weight * fmin(fmax((value - t->none) / (t->all - t->none), 0), 1);
    }
    return score;
}
