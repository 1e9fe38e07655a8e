/* Surfaces that a person means by floor and wall, which the scene offers as targets.
 *
 * Rays through the view tell what is seen. Of planes that are seen, level ones that one could walk on are a floor:
 * large, low, with things and walls above; upright ones behind which little is are walls. Names of nodes, meshes and
 * materials count besides, in several languages. Each is written as a point of it and /level, which takes all that lies
 * in the plane, whatever meshes and images it is of, and gives it UV in metres. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/base/world.h"
#include "import/sense/called.h"
#include "import/sense/sense.h"
#include "import/space/space.h"

#define SEEN 0.004     /* share of the view from which on it counts */
enum { ACROSS = 112, DOWN = 84, RAYS = ACROSS * DOWN, MOST_PLANES = 96, STRIDE = 2477 /* no divisor of RAYS */ };
#define FLAT 0.9848    /* cosine of 10 degrees, as /level has it */
#define UPRIGHT 0.1736 /* its sine */

/* ---- what is seen ---- */

typedef struct Object {
    signed char floor, wall; /* by its names: 1, or -1 where they say something else */
    unsigned char passes;    /* rays go through it */
    double low[3], high[3];
} Object;

typedef struct Plane {
    double point[3], normal[3]; /* of a face; the normal towards the eye */
    double tolerance;
    double seen;  /* share of the view */
    double area;  /* of all that lies in it, by the square of a metre */
    double named; /* -1 to 1, by that area */
    double low[3], high[3];
    uint32_t material; /* of its largest face that is seen, once it is settled */
    double score;
} Plane;

enum { SELECTOR_SIZE = 96 };

typedef struct Search {
    Import *import;
    const Sense *sense;
    const SpaceTriangles *triangles;
    Object *objects;
    double eye[3], low[3], high[3], metre;
    int count; /* of what is seen */
    SpaceHit *hits;
    Plane planes[MOST_PLANES];
    int nplanes;
} Search;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] - b[k];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Its corners, its normal of unit length; returns its area. */
static double triangle_at(const SpaceTriangles *t, size_t number, double corners[3][3], double normal[3])
{
    double a[3], b[3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            corners[i][k] = (double)t->vertices[t->corners[number][i]][k];
    subtract(corners[1], corners[0], a), subtract(corners[2], corners[0], b);
    cross(a, b, normal);
    const double length = sqrt(dot(normal, normal));
    for (int k = 0; k < 3; k++)
        normal[k] /= length > 0 ? length : 1;
    return length / 2;
}

/* Rays through the view, of the shape of the picture. */
static void see(Search *s, const double target[3], double angle)
{
    double ahead[3], right[3], up[3];
    const unsigned char *passes = NULL;
    unsigned char *list = malloc((size_t)s->sense->nobjects + 1);
    subtract(target, s->eye, ahead);
    const double length = sqrt(dot(ahead, ahead)), half = tan(fmin(fmax(angle, 1), 170) / 2 * PI / 180);
    for (int k = 0; k < 3; k++)
        ahead[k] /= length > 0 ? length : 1;
    cross(fabs(ahead[1]) < 0.999 ? (double[3]){0, 1, 0} : (double[3]){0, 0, 1}, ahead, right);
    const double wide = sqrt(dot(right, right));
    for (int k = 0; k < 3; k++)
        right[k] /= wide;
    cross(ahead, right, up);
    for (uint32_t i = 0; list && i < s->sense->nobjects; i++)
        list[i] = s->objects[i].passes, passes = list;
    for (int i = 0; i < RAYS; i++) {
        const int at = (int)((long)i * STRIDE % RAYS);
        const double u = (2 * (at % ACROSS + 0.5) / ACROSS - 1) * half,
                     v = (1 - 2 * (at / ACROSS + 0.5) / DOWN) * half * DOWN / ACROSS;
        double direction[3];
        for (int k = 0; k < 3; k++)
            direction[k] = ahead[k] + u * right[k] + v * up[k];
        s->count += space_ray_through(s->sense->space, s->eye, direction, passes, &s->hits[s->count]);
    }
    free(list);
}

/* ---- planes ---- */

/* As the renderer's /level. */
static int is_on(const Search *s, const Plane *plane, size_t triangle)
{
    double corners[3][3], normal[3];
    for (int i = 0; i < 3; i++) {
        const float *at = s->triangles->vertices[s->triangles->corners[triangle][i]];
        const double from[3] = {(double)at[0] - plane->point[0], (double)at[1] - plane->point[1],
                                (double)at[2] - plane->point[2]};
        if (fabs(dot(from, plane->normal)) > plane->tolerance)
            return 0;
    }
    triangle_at(s->triangles, triangle, corners, normal);
    return fabs(dot(normal, plane->normal)) >= FLAT;
}

static Plane plane_of(const Search *s, const SpaceHit *hit)
{
    const Object *object = &s->objects[hit->tag];
    double corners[3][3], size[3], all[3];
    Plane plane = {.score = 0};
    triangle_at(s->triangles, hit->triangle, corners, plane.normal);
    for (int k = 0; k < 3; k++) {
        plane.point[k] = (corners[0][k] + corners[1][k] + corners[2][k]) / 3;
        plane.normal[k] *= hit->is_front ? 1 : -1;
    }
    subtract(object->high, object->low, size), subtract(s->high, s->low, all);
    plane.tolerance = fmin(sqrt(dot(size, size)) / 100, sqrt(dot(all, all)) / 2000);
    return plane;
}

static void find_planes(Search *s)
{
    for (int i = 0; i < s->count; i++) {
        const double up = fabs(s->hits[i].normal[1]);
        int k = 0;
        if (up < FLAT && up > UPRIGHT)
            continue;
        while (k < s->nplanes && !is_on(s, &s->planes[k], s->hits[i].triangle))
            k++;
        if (k == MOST_PLANES)
            continue;
        if (k == s->nplanes)
            s->planes[s->nplanes++] = plane_of(s, &s->hits[i]);
        s->planes[k].seen += 1.0 / RAYS;
    }
}

static int is_level(const Plane *plane)
{
    return fabs(plane->normal[1]) > FLAT;
}

/* Over all that lies in it. */
static void measure(const Search *s, Plane *plane)
{
    double corners[3][3], normal[3], named = 0;
    for (int k = 0; k < 3; k++)
        plane->low[k] = INFINITY, plane->high[k] = -INFINITY;
    plane->area = 0;
    for (size_t i = 0; i < s->triangles->ntriangles; i++) {
        if (s->objects[s->triangles->tags[i]].passes || !is_on(s, plane, i))
            continue;
        const double area = triangle_at(s->triangles, i, corners, normal);
        const Object *object = &s->objects[s->triangles->tags[i]];
        plane->area += area / (s->metre * s->metre);
        named += area / (s->metre * s->metre) * (is_level(plane) ? object->floor : object->wall);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) {
                plane->low[k] = fmin(plane->low[k], corners[c][k]);
                plane->high[k] = fmax(plane->high[k], corners[c][k]);
            }
    }
    plane->named = plane->area > 0 ? named / plane->area : 0;
}

static void measure_all(Search *s, int level)
{
    for (int i = 0; i < s->nplanes; i++) {
        s->planes[i].score = 0;
        if (is_level(&s->planes[i]) == level && s->planes[i].seen >= SEEN)
            measure(s, &s->planes[i]);
    }
}

/* The same plane by its largest face that is seen, whose middle is surely of it. */
static void settle(const Search *s, Plane *plane)
{
    double corners[3][3], normal[3], largest = 0;
    Plane best = *plane;
    uint32_t material = 0;
    for (int i = 0; i < s->count; i++) {
        const double area = triangle_at(s->triangles, s->hits[i].triangle, corners, normal);
        if (area <= largest || !is_on(s, plane, s->hits[i].triangle))
            continue;
        largest = area;
        best = plane_of(s, &s->hits[i]);
        material = s->sense->materials[s->hits[i].tag];
    }
    best.seen = 0, best.material = material, best.score = plane->score;
    for (int i = 0; i < s->count; i++)
        best.seen += is_on(s, &best, s->hits[i].triangle) / (double)RAYS;
    *plane = best;
    measure(s, plane);
}

/* ---- floors ---- */

/* The length of a metre where what is above the floor is lower than rooms are, as in models of toys. */
static double small_metre(const Search *s, double above)
{
    return fmin(s->metre, above / 2.4);
}

/* Low, and as wide as the model: the seat of a sofa is not. */
static int is_base(const Search *s, const Plane *plane)
{
    const double wide = plane->high[0] - plane->low[0], deep = plane->high[2] - plane->low[2];
    return plane->point[1] - s->low[1] < 0.3 * (s->high[1] - s->low[1]) &&
           wide * deep > 0.5 * (s->high[0] - s->low[0]) * (s->high[2] - s->low[2]);
}

/* How much stands around, at the height of the chest, and whether one could stand there: in the mean of places that are
 * seen. metre: of this plane. */
static void look_around(const Search *s, const Plane *plane, double metre, double *around, double *free_above)
{
    enum { PLACES = 24, WAYS = 16 };
    int places = 0, walls = 0, open = 0;
    for (int i = 0; i < s->count && places < PLACES; i++) {
        const SpaceHit *hit = &s->hits[i];
        SpaceHit other;
        if (!is_on(s, plane, hit->triangle))
            continue;
        const double from[3] = {hit->point[0], hit->point[1] + 1.1 * metre, hit->point[2]}, up[3] = {0, 1, 0};
        const double above[3] = {hit->point[0], hit->point[1] + 0.02 * metre, hit->point[2]};
        places++;
        open += !space_ray(s->sense->space, above, up, 0, 1.6 * metre, &other);
        for (int k = 0; k < WAYS; k++) {
            const double a = 2 * PI * (k + 0.37) / WAYS, way[3] = {cos(a), 0, sin(a)};
            walls += space_ray(s->sense->space, from, way, 0, INFINITY, &other);
        }
    }
    *around = places ? (double)walls / (places * WAYS) : 0;
    *free_above = places ? (double)open / places : 0;
}

/* The share of what is seen that lies below it, under its bounds. */
static double share_below(const Search *s, const Plane *plane, double metre)
{
    int below = 0;
    for (int i = 0; i < s->count; i++) {
        const double *p = s->hits[i].point;
        below += p[1] < plane->point[1] - 0.25 * metre && p[0] > plane->low[0] && p[0] < plane->high[0] &&
                 p[2] > plane->low[2] && p[2] < plane->high[2];
    }
    return s->count ? (double)below / s->count : 0;
}

static double floor_score(const Search *s, const Plane *plane)
{
    const Room *room = &s->sense->room;
    const double above = s->high[1] - plane->point[1];
    /* models of rooms are small sometimes */
    const double metre = small_metre(s, above), area = plane->area * s->metre * s->metre / (metre * metre);
    double around, free_above;
    if (plane->point[1] >= s->eye[1] || !(metre > 0) || area < 1.5)
        return 0;
    if (metre < 0.7 * s->metre && !is_base(s, plane))
        return 0;
    look_around(s, plane, metre, &around, &free_above);
    const double below = share_below(s, plane, metre);
    if (around < 0.3 || free_above < 0.3 || below > 0.3)
        return 0;
    const int is_known = room->is_found && fabs(plane->point[1] - room->floor) < 0.03 * room->height;
    return sqrt(area * plane->seen) * around * free_above * (1 - 2 * below) * (is_known ? 2 : 1) *
           exp2(1.5 * plane->named);
}

/* ---- walls ---- */

/* The share of what is seen that is behind it. */
static double share_behind(const Search *s, const Plane *plane)
{
    int behind = 0;
    for (int i = 0; i < s->count; i++) {
        double from[3];
        subtract(s->hits[i].point, plane->point, from);
        behind += dot(from, plane->normal) < -0.1 * s->metre;
    }
    return s->count ? (double)behind / s->count : 0;
}

/* ground: the floor's height. */
static double wall_score(const Search *s, const Plane *plane, double ground)
{
    const double metre = small_metre(s, s->high[1] - ground);
    const double wide = hypot(plane->high[0] - plane->low[0], plane->high[2] - plane->low[2]);
    const double tall = plane->high[1] - fmax(plane->low[1], ground);
    const int stands = plane->low[1] < ground + 0.35 * metre;
    const double behind = share_behind(s, plane);
    if (tall < 1.2 * metre || wide < 0.6 * metre || behind > 0.45 || plane->seen < 0.025) /* as posts are */
        return 0;
    return plane->seen * (stands ? 1 : 0.3) * (1 - 2 * behind) * fmin(tall / (1.9 * metre), 1) *
           exp2(1.5 * plane->named);
}

/* ---- the whole ---- */

typedef struct Naming {
    Search *search;
    uint32_t object;
} Naming;

static void name_objects(Import *import, const struct aiNode *node, const Affine *world, void *context)
{
    Naming *naming = context;
    const Affine placed = affine_mirror_z(world);
    for (unsigned i = 0; i < node->mNumMeshes && affine_is_finite(&placed); i++) {
        const unsigned index = node->mMeshes[i];
        const struct aiMesh *mesh = index < import->scene->mNumMeshes ? import->scene->mMeshes[index] : NULL;
        if (!mesh || naming->object >= naming->search->sense->nobjects)
            continue;
        Object *object = &naming->search->objects[naming->object++];
        const ImportMaterial *material = &import->materials[mesh->mMaterialIndex];
        const char *const names[3] = {material->name, node->mName.data, mesh->mName.data};
        object->floor = (signed char)called_floor(names);
        object->wall = (signed char)called_wall(names);
        object->passes = (unsigned char)material->is_clear;
    }
}

static void find_bounds(Search *s)
{
    const SpaceTriangles *t = s->triangles;
    for (uint32_t i = 0; i < s->sense->nobjects; i++)
        for (int k = 0; k < 3; k++)
            s->objects[i].low[k] = INFINITY, s->objects[i].high[k] = -INFINITY;
    for (size_t i = 0; i < 3 * t->ntriangles; i++) {
        const float *v = t->vertices[t->corners[i / 3][i % 3]];
        Object *object = &s->objects[t->tags[i / 3]];
        for (int k = 0; k < 3; k++) {
            object->low[k] = fmin(object->low[k], (double)v[k]);
            object->high[k] = fmax(object->high[k], (double)v[k]);
        }
    }
    space_bounds(s->sense->space, s->low, s->high);
}

static Plane *best_of(Search *s)
{
    Plane *best = NULL;
    for (int i = 0; i < s->nplanes; i++)
        if (s->planes[i].score > (best ? best->score : 0))
            best = &s->planes[i];
    return best;
}

/* A selector's text: a point of a plane. */
static int print_plane(const Search *s, const Plane *plane, char text[SELECTOR_SIZE])
{
    const double scale = s->sense->scale;
    return snprintf(text, SELECTOR_SIZE, "@%.7g:%.7g:%.7g/level", plane->point[0] * scale, plane->point[1] * scale,
                    plane->point[2] * scale);
}

static void offer(const Search *s, FILE *out, const char *name, const char *selector, double seen)
{
    fprintf(out, "\n  \"%s\" \"%s\" // %.0f %% of the view", name, selector, 100 * seen);
    import_tell(s->import, IMPORT_TARGET, "%s\t%s\t%.1f %%", name, selector, 100 * seen);
}

/* With its grooves: what is made of the same a little below, between boards and tiles. */
static void offer_floor(const Search *s, const Plane *plane, FILE *out)
{
    enum { MOST_GROOVES = 2 };
    char text[(MOST_GROOVES + 1) * SELECTOR_SIZE];
    double seen = plane->seen;
    int length = print_plane(s, plane, text), count = 0;
    for (int i = 0; i < s->nplanes && count < MOST_GROOVES; i++) {
        Plane groove = s->planes[i];
        const double depth = plane->point[1] - groove.point[1];
        if (!is_level(&groove) || groove.seen < SEEN || depth <= plane->tolerance || depth > 0.03 * s->metre)
            continue;
        settle(s, &groove);
        if (groove.material != plane->material)
            continue;
        text[length++] = ',';
        length += print_plane(s, &groove, text + length);
        seen += groove.seen, count++;
    }
    offer(s, out, "Floor", text, seen);
}

/* Of the area of a material. */
static double upright_share(const Search *s, uint32_t material)
{
    double corners[3][3], normal[3], upright = 0, all = 0;
    for (size_t i = 0; i < s->triangles->ntriangles; i++) {
        if (s->sense->materials[s->triangles->tags[i]] != material)
            continue;
        const double area = triangle_at(s->triangles, i, corners, normal);
        all += area, upright += fabs(normal[1]) < UPRIGHT ? area : 0;
    }
    return all > 0 ? upright / all : 0;
}

/* All walls, if they have a material that little else is made of. Boxes give it UV in metres. */
static void offer_walls(const Search *s, const Plane *wall, FILE *out)
{
    const ImportMaterial *material = &s->import->materials[wall->material];
    char text[NAME_SIZE + 8];
    int of = 0, on_walls = 0;
    for (int i = 0; i < s->count; i++) {
        if (s->sense->materials[s->hits[i].tag] != wall->material)
            continue;
        of++;
        for (int k = 0; k < s->nplanes; k++)
            if (s->planes[k].score > 0 && is_on(s, &s->planes[k], s->hits[i].triangle)) {
                on_walls++;
                break;
            }
    }
    if (upright_share(s, wall->material) < 0.8 || on_walls < 0.85 * of || on_walls < 1.2 * wall->seen * RAYS)
        return;
    snprintf(text, sizeof text, "%s:uv=box", material->name);
    offer(s, out, "Walls", text, (double)of / RAYS);
}

/* Returns whether there is one. */
static int find_floor(Search *s, Plane *found)
{
    measure_all(s, 1);
    for (int i = 0; i < s->nplanes; i++)
        if (is_level(&s->planes[i]) && s->planes[i].seen >= SEEN)
            s->planes[i].score = floor_score(s, &s->planes[i]);
    const Plane *best = best_of(s);
    if (!best)
        return 0;
    *found = *best;
    settle(s, found);
    return 1;
}

static int find_wall(Search *s, double ground, Plane *found)
{
    measure_all(s, 0);
    for (int i = 0; i < s->nplanes; i++)
        if (!is_level(&s->planes[i]) && s->planes[i].seen >= SEEN)
            s->planes[i].score = wall_score(s, &s->planes[i], ground);
    const Plane *best = best_of(s);
    if (!best)
        return 0;
    *found = *best;
    settle(s, found);
    return 1;
}

/* A lawn without walls is no floor, and what stands on none is no wall, but where a room is all around. */
static void write_found(Search *s, FILE *out)
{
    const Room *room = &s->sense->room;
    Plane floor, wall;
    const int has_floor = find_floor(s, &floor);
    const double ground = has_floor ? floor.point[1] : room->is_found ? room->floor : s->low[1];
    const int has_wall = (has_floor || room->is_closed) && find_wall(s, ground, &wall);
    if (!has_wall && !(has_floor && room->is_closed))
        return;
    fprintf(out, "// ---- surfaces that are ready: retex-render -t Floor -t Wall ----\n\n"
                 "#ifdef (Retex) global_settings { retex_targets {");
    if (has_floor)
        offer_floor(s, &floor, out);
    if (has_wall) {
        char text[SELECTOR_SIZE];
        print_plane(s, &wall, text);
        offer(s, out, "Wall", text, wall.seen);
        offer_walls(s, &wall, out);
    }
    fprintf(out, "\n} } #end\n\n");
}

int targets_write(Import *import, FILE *out, RetexError *err)
{
    const Sense *sense = import->sense;
    double target[3];
    if (!sense || !sense->space)
        return RETEX_OK;
    Search *s = calloc(1, sizeof *s);
    if (s)
        *s = (Search){.import = import,
                      .sense = sense,
                      .triangles = space_triangles(sense->space),
                      .objects = calloc((size_t)sense->nobjects + 1, sizeof *s->objects),
                      .hits = malloc((RAYS + 1) * sizeof *s->hits),
                      .metre = sense->room.metre > 0 ? sense->room.metre : 1 / sense->scale};
    Naming naming = {s, 0};
    const int is_made = s && s->objects && s->hits && import_visit_nodes(import, name_objects, &naming);
    if (is_made) {
        for (int k = 0; k < 3; k++)
            s->eye[k] = import->eye[k] / sense->scale, target[k] = import->target[k] / sense->scale;
        find_bounds(s);
        see(s, target, import->angle);
        find_planes(s);
        write_found(s, out);
    }
    if (s)
        free(s->objects), free(s->hits);
    free(s);
    return is_made ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory");
}
