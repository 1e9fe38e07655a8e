/* The view from inside of a room: of places with some space around them, and of directions, the one that shows most.
 * From each place a panorama is taken by rays, and pictures are judged that are windows of it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/space/room.h"
#include "import/space/space.h"

#define PI 3.14159265358979323846

enum { MOST_PLACES = 180, COLUMNS = 72, ROWS = 16, LOWEST = -45 /* degrees */, STEP = 360 / COLUMNS, MOST_THINGS = 48 };

typedef enum Kind { NOTHING, FLOOR, CEILING, WALL, FURNITURE } Kind;

typedef struct Sample {
    float distance; /* in metres */
    uint32_t tag;
    unsigned char kind, is_front;
} Sample;

typedef struct Panorama {
    Sample samples[ROWS][COLUMNS];
} Panorama;

/* What a picture has, as shares of it. */
typedef struct Content {
    double near, furniture, floor, ceiling, nothing, back, depth, variety;
    double ahead; /* metres, in the middle */
    int things;
} Content;

/* Things that are lower than the ceiling and stand under free space are furniture, whatever meshes they are of. */
static Kind kind_of(const Room *room, const SpaceHit *hit)
{
    const double above = (hit->point[1] - room->floor) / room->height, into = hit->is_front ? -0.6 : 0.6;
    const int is_level = fabs(hit->normal[1]) > 0.7;
    if (above < 0.03 && is_level)
        return FLOOR;
    const int cell = room_cell_at(room, hit->point[0] + into * hit->normal[0] * room->cell,
                                  hit->point[2] + into * hit->normal[2] * room->cell);
    if (cell >= 0) {
        const double top = ((double)room->cells[cell].top - room->floor) / room->height;
        if (top > 0.06 && top < 0.8 && above < top + 0.03)
            return FURNITURE;
    }
    return is_level && above > 0.7 ? CEILING : WALL;
}

static void look(const Room *room, const double eye[3], Panorama *to)
{
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            const double e = (LOWEST + STEP * row) * PI / 180, a = STEP * column * PI / 180;
            const double direction[3] = {cos(e) * cos(a), sin(e), cos(e) * sin(a)};
            Sample *sample = &to->samples[row][column];
            SpaceHit hit;
            memset(sample, 0, sizeof *sample);
            if (!space_ray(room->space, eye, direction, 0, INFINITY, &hit))
                continue;
            *sample = (Sample){(float)(hit.t / room->metre), hit.tag, (unsigned char)kind_of(room, &hit),
                               (unsigned char)hit.is_front};
        }
}

typedef struct Things {
    uint32_t tags[MOST_THINGS];
    double shares[MOST_THINGS];
    int count;
} Things;

static void count_thing(Things *things, uint32_t tag, double share)
{
    for (int i = 0; i < things->count; i++)
        if (things->tags[i] == tag) {
            things->shares[i] += share;
            return;
        }
    if (things->count < MOST_THINGS) {
        things->tags[things->count] = tag;
        things->shares[things->count++] = share;
    }
}

/* Entropy, in bits. */
static double variety_of(const Things *things, double all)
{
    double sum = 0;
    for (int i = 0; i < things->count; i++)
        sum -= things->shares[i] / all * log2(things->shares[i] / all);
    return sum;
}

/* A picture as a window of the panorama: `across` columns to each side, `along` rows up and down. */
static Content content_of(const Panorama *from, int column, int row, int across, int along)
{
    Content c = {0};
    Things things = {.count = 0};
    double all = 0, depth = 0;
    for (int j = row - along; j <= row + along; j++)
        for (int i = column - across; i <= column + across; i++) {
            const double weight = cos((LOWEST + STEP * j) * PI / 180);
            all += weight;
            if (j < 0 || j >= ROWS)
                continue;
            /* what is in the middle of the picture counts more than what its edges cut */
            const double u = (double)(i - column) / across, v = (double)(j - row) / along;
            const double central = weight * (1.3 - 0.45 * (u * u + v * v));
            const Sample *s = &from->samples[j][(i + COLUMNS) % COLUMNS];
            const double distance = (double)s->distance;
            if (s->kind == NOTHING) {
                c.nothing += weight, depth += 3 * weight;
                continue;
            }
            c.near += distance < 0.75 ? weight : 0;
            c.floor += s->kind == FLOOR ? weight : 0;
            c.ceiling += s->kind == CEILING ? weight : 0;
            /* what is near hides the rest, what is far is small */
            c.furniture += s->kind == FURNITURE && distance > 1 ? central * fmin(1, distance - 0.6) : 0;
            c.back += s->is_front ? 0 : weight;
            depth += weight * fmin(fmax(log2(distance / 0.75), 0), 4);
            count_thing(&things, s->tag, weight);
        }
    for (int i = 0; i < things.count; i++)
        c.things += things.shares[i] > 0.003 * all;
    c.variety = variety_of(&things, all);
    c.ahead = (double)from->samples[row][column].distance;
    c.near /= all, c.floor /= all, c.ceiling /= all, c.furniture /= all, c.back /= all, c.nothing /= all;
    c.depth = depth / all;
    return c;
}

static double score_of(const Content *c)
{
    return 1.2 * fmin(c->furniture / 0.35, 1) + 0.5 * fmin(c->floor / 0.2, 1) + 0.9 * fmin(c->depth / 2.6, 1) +
           0.5 * fmin(c->variety / 3, 1) - 4 * c->near - 1.5 * fmax(c->nothing - 0.15, 0) - 0.7 * c->back -
           1.5 * fmax(c->ceiling - 0.15, 0);
}

/* Narrow where the room is long, wide where it is small. */
static double angle_of(const Content *c)
{
    return c->depth > 2.6 ? 65 : c->depth > 1.6 ? 70 : 75;
}

/* Cells with some space around; where there are none, those with most of it. */
static int choose_places(const Room *room, int *places)
{
    double least = 0.42 * room->metre;
    int count = 0;
    for (int tries = 0; tries < 6 && !count; tries++, least *= 0.6) {
        for (int i = 0; i < room->nx * room->nz; i++)
            if (room->cells[i].is_inside && (double)room->cells[i].clearance > least)
                places[count++] = i;
    }
    const int step = count / MOST_PLACES + 1;
    int kept = 0;
    for (int i = step / 2; i < count; i += step)
        places[kept++] = places[i];
    return kept;
}

static void take_view(const Room *room, int cell, int column, int row, const Content *c, RoomView *view)
{
    const double e = (LOWEST + STEP * row) * PI / 180, a = STEP * column * PI / 180;
    const double ahead = fmin(fmax(c->ahead, 1), 3) * room->metre;
    const double direction[3] = {cos(e) * cos(a), sin(e), cos(e) * sin(a)};
    room_point(room, cell, room->eye, view->eye);
    for (int k = 0; k < 3; k++)
        view->target[k] = view->eye[k] + ahead * direction[k];
    view->angle = angle_of(c);
    view->furniture = c->furniture, view->floor = c->floor;
    view->depth = 0.75 * exp2(c->depth) * room->metre;
    view->things = c->things;
}

/* Directions look down by 5 to 15 degrees: a floor belongs to a room. */
static double best_of(const Room *room, int cell, const Panorama *panorama, double best, RoomView *view)
{
    const int across = 35 / STEP, along = 25 / STEP;
    for (int row = (-15 - LOWEST) / STEP; row <= (-5 - LOWEST) / STEP; row++)
        for (int column = 0; column < COLUMNS; column++) {
            const Content c = content_of(panorama, column, row, across, along);
            const double score = score_of(&c);
            if (score <= best)
                continue;
            best = score;
            take_view(room, cell, column, row, &c, view);
        }
    return best;
}

int room_view(const Room *room, RoomView *view, RetexError *err)
{
    if (!room->is_found || room->ninside == 0)
        return 0;
    Panorama *panorama = malloc(sizeof *panorama);
    int *places = malloc((size_t)(room->nx * room->nz) * sizeof *places);
    int count = 0;
    if (!panorama || !places)
        retex_fail(err, RETEX_ENOMEM, "out of memory");
    else
        count = choose_places(room, places);
    double best = -INFINITY;
    for (int i = 0; i < count; i++) {
        double eye[3];
        room_point(room, places[i], room->eye, eye);
        look(room, eye, panorama);
        best = best_of(room, places[i], panorama, best, view);
    }
    free(panorama);
    free(places);
    return count > 0;
}
