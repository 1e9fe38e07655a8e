/* Candidates of views, and the choice. Inside, a panorama is taken by rays from each place, and small pictures are cut
 * out of it in all directions; outside, small pictures are taken from all sides. The best of all these are looked at
 * again, larger, and judged by the same score. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/space/space.h"
#include "import/space/views.h"

#define PI 3.14159265358979323846

enum { COLUMNS = 72, ROWS = 16, LOWEST = -45 /* degrees */, STEP = 360 / COLUMNS };
enum { MOST_PLACES = 96, AZIMUTHS = 36, SIDES = 16, SMALL_WIDTH = 16, SMALL_HEIGHT = 12 };
enum { FINALISTS = 40, ANGLE = 74 /* inside, degrees */ };

static const double pitches[] = {-12, -5}, elevations[] = {7, 20, 33, 45}; /* degrees */

enum { PITCHES = sizeof pitches / sizeof *pitches, ELEVATIONS = sizeof elevations / sizeof *elevations };

typedef struct Panorama {
    PictureSample samples[ROWS][COLUMNS];
} Panorama;

typedef struct Candidates {
    ViewChoice *list;
    int count;
} Candidates;

/* ---- views ---- */

static void normalize(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= length > 0 ? length : 1;
}

View view_level(const double eye[3], const double ahead[3], double angle)
{
    View view = {.angle = angle, .aspect = 4.0 / 3};
    memcpy(view.eye, eye, sizeof view.eye);
    memcpy(view.ahead, ahead, sizeof view.ahead);
    normalize(view.ahead);
    for (int k = 0; k < 3; k++)
        view.up[k] = (k == 1) - view.ahead[1] * view.ahead[k];
    normalize(view.up);
    return view;
}

/* How far from its middle the corners of a box are all in the picture, with a margin. back: of unit length. */
static double distance_to_fit(const double low[3], const double high[3], const double back[3], double angle)
{
    const double across = tan(angle / 2 * PI / 180) * 0.9, along = across * 3 / 4, level = hypot(back[0], back[2]);
    const double right[3] = {-back[2] / level, 0, back[0] / level};
    const double up[3] = {-back[1] * right[2], back[0] * right[2] - back[2] * right[0], back[1] * right[0]};
    double distance = 0;
    for (int corner = 0; corner < 8; corner++) {
        double x = 0, y = 0, z = 0;
        for (int k = 0; k < 3; k++) {
            const double half = (high[k] - low[k]) / 2, c = corner >> k & 1 ? half : -half;
            x += c * right[k], y += c * up[k], z += c * back[k];
        }
        distance = fmax(distance, z + fmax(fabs(x) / across, fabs(y) / along));
    }
    return distance;
}

void view_fit(const double low[3], const double high[3], const double side[3], double angle, double eye[3],
              double target[3])
{
    double back[3] = {side[0], side[1], side[2]};
    normalize(back);
    const double distance = distance_to_fit(low, high, back, angle);
    for (int k = 0; k < 3; k++) {
        target[k] = low[k] + (high[k] - low[k]) / 2;
        eye[k] = target[k] + back[k] * distance;
    }
}

static void add(Candidates *candidates, const View *view, ViewsFrom from, const Content *content)
{
    candidates->list[candidates->count++] =
        (ViewChoice){.view = *view, .from = from, .content = *content, .score = content_score(content)};
}

/* ---- from inside ---- */

static void direction_of(double azimuth, double elevation, double direction[3])
{
    const double a = azimuth * PI / 180, e = elevation * PI / 180;
    direction[0] = cos(e) * cos(a), direction[1] = sin(e), direction[2] = cos(e) * sin(a);
}

/* Returns in which share of it there is nothing. */
static double take_panorama(const Room *room, const double eye[3], Panorama *panorama)
{
    int open = 0;
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            double direction[3];
            direction_of(STEP * column, LOWEST + STEP * row, direction);
            panorama->samples[row][column] = picture_sample(room, eye, direction);
            open += panorama->samples[row][column].kind == PICTURE_NOTHING;
        }
    return (double)open / (ROWS * COLUMNS);
}

static void cut_out(const Room *room, const Panorama *panorama, const View *view, Picture *picture)
{
    picture->width = SMALL_WIDTH, picture->height = SMALL_HEIGHT;
    picture->tilt = picture_tilt(view);
    picture->size = picture_size(room);
    for (int j = 0; j < SMALL_HEIGHT; j++)
        for (int i = 0; i < SMALL_WIDTH; i++) {
            double from[3], d[3];
            picture_ray(view, 2 * (i + 0.5) / SMALL_WIDTH - 1, 1 - 2 * (j + 0.5) / SMALL_HEIGHT, from, d);
            const int column = (int)lround(atan2(d[2], d[0]) * 180 / PI / STEP + COLUMNS) % COLUMNS;
            const int row = (int)lround((asin(d[1]) * 180 / PI - LOWEST) / STEP);
            picture->samples[j * SMALL_WIDTH + i] = panorama->samples[row < 0      ? 0
                                                                      : row < ROWS ? row
                                                                                   : ROWS - 1][column];
        }
}

/* Of a room that is closed, those in it; else all where there is a floor, and walls on two sides. */
static int is_place(const Room *room, int cell, double clearance)
{
    const RoomCell *c = &room->cells[cell];
    return (room->is_closed ? c->is_inside : c->is_floor && (double)c->enclosed > 0.4) &&
           (double)c->clearance > clearance;
}

/* Places with some space around them; where there are none, those with most of it. */
static int find_places(const Room *room, int *places)
{
    double least = 0.42 * room->metre;
    int count = 0, kept = 0;
    for (int tries = 0; tries < 6 && !count; tries++, least *= 0.6)
        for (int i = 0; i < room->nx * room->nz; i++)
            if (is_place(room, i, least))
                places[count++] = i;
    const int step = count / MOST_PLACES + 1;
    for (int i = step / 2; i < count; i += step)
        places[kept++] = places[i];
    return kept;
}

/* Whether people can stand there: not on the seat of a chair, not between the boards of a shelf, nor in its hull.
 * Where one does not know how long a metre is, free space that is as high as a room is to be as wide, and not as wide
 * as a square: it may be a board with chessmen. */
static int is_for_people(const Room *room)
{
    const int is_known = room->is_said && !room->is_doubtful;
    double area = 0;
    for (int i = 0; i < room->nx * room->nz; i++)
        area += is_place(room, i, (is_known ? 0.3 : 0.42) * room->metre) ? pow(room->cell / room->metre, 2) : 0;
    if (room->is_furniture || (room->is_solid && !room->is_said))
        return 0;
    if (room->is_closed)
        return 1;
    return is_known ? room->height > 1.9 * room->metre && area > 0
                    : room->height > 1.6 * room->metre && area > 1 && (area < 400 || room->covered > 0.5);
}

static int look_around(const Room *room, const uint32_t *materials, Candidates *candidates, Picture *picture,
                       RetexError *err)
{
    Panorama *panorama = malloc(sizeof *panorama);
    int *places = malloc((size_t)(room->nx * room->nz) * sizeof *places);
    const int code = panorama && places ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory");
    const int count = code ? 0 : find_places(room, places);
    for (int i = 0; i < count; i++) {
        double eye[3], ahead[3];
        room_point(room, places[i], room->eye, eye);
        const double open = take_panorama(room, eye, panorama);
        for (int k = 0; k < PITCHES * AZIMUTHS; k++) {
            direction_of(360.0 / AZIMUTHS * (k % AZIMUTHS), pitches[k / AZIMUTHS], ahead);
            const View view = view_level(eye, ahead, ANGLE);
            cut_out(room, panorama, &view, picture);
            Content content = picture_content(picture, materials);
            content.open = open;
            add(candidates, &view, VIEWS_INSIDE, &content);
        }
    }
    free(panorama);
    free(places);
    return code;
}

/* ---- from outside ---- */

/* From the right in front and above, and from all other sides. */
static void look_from_sides(const Room *room, const uint32_t *materials, Candidates *candidates, Picture *picture)
{
    const double usual = atan2(-0.82, 0.45) * 180 / PI;
    double low[3], high[3];
    space_standing_bounds(room->space, low, high);
    for (int k = 0; k < SIDES * ELEVATIONS; k++) {
        const double turned = 360.0 / SIDES * (k % SIDES);
        double side[3], eye[3], ahead[3];
        direction_of(usual + turned, elevations[k / SIDES], side);
        view_fit(low, high, side, 40, eye, ahead);
        for (int i = 0; i < 3; i++)
            ahead[i] -= eye[i];
        const View view = view_level(eye, ahead, 40);
        picture_take(room, &view, SMALL_WIDTH, SMALL_HEIGHT, picture);
        Content content = picture_content(picture, materials);
        content.behind = (1 - cos(turned * PI / 180)) / 2;
        add(candidates, &view, VIEWS_OUTSIDE, &content);
    }
}

/* ---- the choice ---- */

static int compare_choices(const void *a, const void *b)
{
    const ViewChoice *x = a, *y = b;
    return x->score != y->score ? (x->score < y->score ? 1 : -1) : memcmp(&x->view, &y->view, sizeof x->view);
}

static int is_apart(const View *a, const View *b, double distance, double degrees)
{
    double squared = 0, cosine = 0;
    for (int k = 0; k < 3; k++) {
        squared += pow(a->eye[k] - b->eye[k], 2);
        cosine += a->ahead[k] * b->ahead[k];
    }
    return sqrt(squared) > distance || cosine < cos(degrees * PI / 180);
}

/* Keep the best of a sorted list that are apart from one another. */
static int keep_apart(ViewChoice *list, int count, int most, double distance, double degrees)
{
    int kept = 0;
    for (int i = 0; i < count && kept < most; i++) {
        int is_new = 1;
        for (int k = 0; k < kept && is_new; k++)
            is_new = is_apart(&list[i].view, &list[k].view, distance, degrees);
        if (is_new)
            list[kept++] = list[i];
    }
    return kept;
}

static ViewChoice judge(const Room *room, const uint32_t *materials, const ViewChoice *choice, Picture *picture)
{
    ViewChoice judged = *choice;
    picture_take(room, &choice->view, PICTURE_WIDTH, PICTURE_HEIGHT, picture);
    judged.content = picture_content(picture, materials);
    judged.content.behind = choice->content.behind, judged.content.open = choice->content.open;
    judged.score = content_score(&judged.content);
    return judged;
}

static int find(const Room *room, const uint32_t *materials, ViewsFrom from, const View *given, Candidates *candidates,
                Views *views, RetexError *err)
{
    Picture *picture = calloc(1, sizeof *picture);
    if (!picture)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    int code = RETEX_OK;
    if (from & VIEWS_INSIDE && room->is_found && (from == VIEWS_INSIDE ? !room->is_solid : is_for_people(room)))
        code = look_around(room, materials, candidates, picture, err);
    if (from & VIEWS_OUTSIDE && !code)
        look_from_sides(room, materials, candidates, picture);
    views->candidates = candidates->count;
    const double metre = picture_metre(room);
    ViewChoice *list = candidates->list;
    if (given) {
        const ViewChoice own = {.view = *given, .from = VIEWS_GIVEN};
        views->list[views->count++] = judge(room, materials, &own, picture);
        for (int i = 0; i < candidates->count; i++)
            views->better += list[i].score > views->list[0].score;
    }
    qsort(list, (size_t)candidates->count, sizeof *list, compare_choices);
    int count = keep_apart(list, candidates->count, FINALISTS, 0.5 * metre, 12);
    for (int i = 0; i < count; i++)
        list[i] = judge(room, materials, &list[i], picture);
    qsort(list, (size_t)count, sizeof *list, compare_choices);
    if (given) {
        memmove(list + 1, list, (size_t)count * sizeof *list);
        list[0] = views->list[0], count++;
    }
    views->count = keep_apart(list, count, VIEWS_MOST, metre, 30);
    memcpy(views->list, list, (size_t)views->count * sizeof *list);
    free(picture);
    return code;
}

int views_find(const Room *room, const uint32_t *materials, ViewsFrom from, const View *given, Views *views,
               RetexError *err)
{
    enum { MOST = MOST_PLACES * PITCHES * AZIMUTHS + SIDES * ELEVATIONS + 1 };
    Candidates candidates = {.list = malloc(MOST * sizeof *candidates.list)};
    memset(views, 0, sizeof *views);
    if (!candidates.list)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    const int code = find(room, materials, from, given, &candidates, views, err);
    free(candidates.list);
    return code;
}
