/* See surfaces.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/parallel.h>
#include "base/digest.h"
#include "path/surface_color.h"
#include "render/surfaces.h"

/* A level has at least this part of the picture. LEVELS_TRIED bounds the work where curved meshes have none. */
enum { LEVEL_LEAST = 1000, LEVELS_TRIED = 1000 };

enum { MATERIAL, OBJECT, FLAT, LEVEL }; /* planes, in their order */

/* A face that is seen, of all copies. */
typedef struct SeenFace {
    const Primitive *primitive;
    int face, pixels;
    int flat, level; /* surfaces, from 1; 0: none; -1: none that is worth it */
} SeenFace;
enum { LEVEL_NEW = -2 }; /* of the level that is being marked */

typedef struct Finding {
    const FirstHitWindow *window;
    Surfaces *all;
    SceneSurfaces *known;
    ShownSurface *shown; /* by pixel; no primitive: nothing is hit */
    int *buckets, nbuckets;  /* surfaces by their text: index + 1, or 0 */
    int capacity;
    SeenFace *faces;
    int *face_buckets, nface_buckets, nfaces; /* the same of faces */
    int *face_of;                         /* by pixel, or -1 */
} Finding;

/* ---- the list ---- */

static int *find_bucket(const Finding *f, const char *text)
{
    size_t i = digest_text(DIGEST_BEGIN, text) & (size_t)(f->nbuckets - 1);
    while (f->buckets[i] && strcmp(f->all->list[f->buckets[i] - 1].text, text) != 0)
        i = (i + 1) & (size_t)(f->nbuckets - 1);
    return &f->buckets[i];
}

static int grow(Finding *f)
{
    const int capacity = f->capacity ? 2 * f->capacity : 256;
    SeenSurface *list = realloc(f->all->list, (size_t)capacity * sizeof *list);
    int *buckets = calloc(2 * (size_t)capacity, sizeof *buckets);
    if (list)
        f->all->list = list;
    if (!list || !buckets) {
        free(buckets);
        return 0;
    }
    free(f->buckets);
    f->buckets = buckets, f->nbuckets = 2 * capacity, f->capacity = capacity;
    for (int k = 0; k < f->all->count; k++)
        *find_bucket(f, list[k].text) = k + 1;
    return 1;
}

/* 1 + the index of the surface with this text; 0: there are too many. -1: no memory. */
static int add(Finding *f, const char *text, SelectorScope scope, const char *name)
{
    if (f->all->count == f->capacity && !grow(f))
        return -1;
    int *bucket = find_bucket(f, text);
    if (!*bucket && f->all->count < SURFACES_MAX) {
        char *copy = strdup(text);
        if (!copy)
            return -1;
        f->all->list[f->all->count++] = (SeenSurface){.text = copy, .scope = scope, .name = name};
        *bucket = f->all->count;
    }
    return *bucket;
}

/* ---- first hits ---- */

static void shown_row(void *context, int y, int thread)
{
    const Finding *f = context;
    const FirstHitWindow *w = f->window;
    (void)thread;
    for (int x = 0; x < w->w; x++) {
        ShownSurface *shown = &f->shown[y * w->w + x];
        if (!first_hit_shown(w, x, y, shown))
            *shown = (ShownSurface){.primitive = NULL};
    }
}

/* The seen face of a pixel; it is new where it has no pixels yet. */
static int find_face(Finding *f, const ShownSurface *shown)
{
    const struct {
        const Primitive *primitive;
        size_t face;
    } key = {shown->primitive, (size_t)shown->face};
    size_t i = digest_bytes(DIGEST_BEGIN, &key, sizeof key) & (size_t)(f->nface_buckets - 1);
    for (; f->face_buckets[i]; i = (i + 1) & (size_t)(f->nface_buckets - 1)) {
        const SeenFace *face = &f->faces[f->face_buckets[i] - 1];
        if (face->primitive == shown->primitive && face->face == shown->face)
            return f->face_buckets[i] - 1;
    }
    f->faces[f->nfaces] = (SeenFace){.primitive = shown->primitive, .face = shown->face};
    f->face_buckets[i] = ++f->nfaces;
    return f->nfaces - 1;
}

/* ---- by scope ---- */

/* That of its material, where the object has none; or NULL. */
static const char *name_of_object(const Finding *f, const ShownSurface *shown)
{
    const char *name = shown->part.idents ? shown->part.idents->name : NULL;
    if (!name && shown->part.texture)
        name = materials_name(&f->known->materials, shown->part.texture);
    return name ? scene_name_of(f->window->scene, name) : NULL;
}

static int add_object(Finding *f, const ShownSurface *shown)
{
    char text[SELECTOR_MAX];
    return shown_selector(text, shown, SCOPE_OBJECT, &f->known->materials, NULL)
               ? add(f, text, SCOPE_OBJECT, name_of_object(f, shown))
               : 0;
}

static int add_material(Finding *f, const ShownSurface *shown)
{
    char text[SELECTOR_MAX];
    const char *name = shown->part.texture ? materials_name(&f->known->materials, shown->part.texture) : NULL;
    return shown_selector(text, shown, SCOPE_MATERIAL, &f->known->materials, NULL)
               ? add(f, text, SCOPE_MATERIAL, name ? scene_name_of(f->window->scene, name) : NULL)
               : 0;
}

static int add_flat(Finding *f, const ShownSurface *shown)
{
    char text[SELECTOR_MAX];
    if (!faces_count(shown->primitive))
        return 0;
    const struct KnownFaces *known = scene_faces_of(&f->known->faces, shown->primitive);
    if (!known)
        return -1;
    return known->flat && shown_selector(text, shown, SCOPE_FLAT, &f->known->materials, known->flat)
               ? add(f, text, SCOPE_FLAT, NULL)
               : 0;
}

static uint16_t *plane(const Finding *f, int scope)
{
    return f->all->planes + (size_t)scope * (size_t)f->window->w * (size_t)f->window->h;
}

static int is_same(const ShownSurface *a, const ShownSurface *b)
{
    return a->primitive == b->primitive && a->face == b->face && a->part.texture == b->part.texture &&
           a->part.number == b->part.number && a->part.part == b->part.part && a->part.idents == b->part.idents &&
           a->part.places == b->part.places;
}

/* Materials, objects and flat faces. 0: no memory. */
static int name_pixels(Finding *f)
{
    const int pixels = f->window->w * f->window->h;
    int found[3] = {0};
    for (int k = 0; k < pixels; k++) {
        const ShownSurface *shown = &f->shown[k];
        f->face_of[k] = -1;
        if (!shown->primitive)
            continue;
        if (!k || !is_same(shown, shown - 1)) {
            found[OBJECT] = add_object(f, shown), found[MATERIAL] = add_material(f, shown);
            found[FLAT] = add_flat(f, shown);
        }
        if (found[MATERIAL] < 0 || found[OBJECT] < 0 || found[FLAT] < 0)
            return 0;
        for (int scope = MATERIAL; scope <= FLAT; scope++)
            plane(f, scope)[k] = (uint16_t)found[scope];
        if (!found[FLAT])
            continue;
        SeenFace *face = &f->faces[f->face_of[k] = find_face(f, shown)];
        face->pixels++, face->flat = found[FLAT];
    }
    return 1;
}

/* ---- levels ---- */

/* What is looked for by: where the first copy of each seen face is, and weights of flat faces by surface. */
typedef struct LevelSearch {
    Face *placed; /* without corners: it has no area */
    int *weights, least;
} LevelSearch;

static int is_placed(const Face *face)
{
    return face->ncorners > 0;
}

/* The face that is seen most, of the flat faces that are seen most and of which no level is known. -1: there are none
 * that are worth it. */
static int next_face(const Finding *f, const LevelSearch *search)
{
    int flat = 0, best = -1, *weights = search->weights;
    memset(weights, 0, ((size_t)f->all->count + 1) * sizeof *weights);
    for (int k = 0; k < f->nfaces; k++)
        if (!f->faces[k].level)
            weights[f->faces[k].flat] += f->faces[k].pixels;
    for (int k = 1; k <= f->all->count; k++)
        flat = weights[k] > weights[flat] ? k : flat;
    if (weights[flat] < search->least)
        return -1;
    for (int k = 0; k < f->nfaces; k++)
        if (!f->faces[k].level && f->faces[k].flat == flat && (best < 0 || f->faces[k].pixels > f->faces[best].pixels))
            best = k;
    return best;
}

/* 1: the face is on the level. Most are not, as their first copy tells. */
static int is_on(const Finding *f, const LevelSearch *search, const FaceLevel *level, int face)
{
    const SeenFace *seen = &f->faces[face];
    const struct KnownFaces *known = scene_faces_of(&f->known->faces, seen->primitive);
    return is_placed(&search->placed[face]) &&
           faces_is_on_level(level, &search->placed[face], known->owner.is_open) &&
           (known->owner.first_copy < 0 ||
            faces_are_on_level(level, f->window->scene, &known->owner, seen->face));
}

/* Mark the faces of a face's level: -1 where they are too few, and are not to be looked at again. 0: no memory. */
static int take_level(Finding *f, const LevelSearch *search, SeenFace *face)
{
    const Scene *scene = f->window->scene;
    const struct KnownFaces *known = scene_faces_of(&f->known->faces, face->primitive);
    FaceLevel level;
    char text[SELECTOR_MAX];
    int pixels = 0;
    face->level = -1;
    if (faces_level_of(&level, scene, &known->owner, face->face))
        return 1;
    for (int k = 0; k < f->nfaces; k++)
        if (&f->faces[k] == face || (!f->faces[k].level && is_on(f, search, &level, k)))
            f->faces[k].level = LEVEL_NEW, pixels += f->faces[k].pixels;
    snprintf(text, sizeof text, "#%d/level:%d", (int)(face->primitive - scene->primitives) + 1, face->face + 1);
    const int found = pixels < search->least ? 0 : add(f, text, SCOPE_LEVEL, NULL);
    for (int k = 0; k < f->nfaces; k++)
        if (f->faces[k].level == LEVEL_NEW)
            f->faces[k].level = found > 0 ? found : -1;
    return found >= 0;
}

static void place_faces(const Finding *f, const LevelSearch *search)
{
    for (int k = 0; k < f->nfaces; k++) {
        const SeenFace *seen = &f->faces[k];
        const struct KnownFaces *known = scene_faces_of(&f->known->faces, seen->primitive);
        const int first = known->owner.first_copy;
        if ((seen->primitive->prototype && first < 0) ||
            !faces_placed(seen->primitive, first < 0 ? NULL : &f->window->scene->instances[first], seen->face,
                          &search->placed[k]))
            search->placed[k].ncorners = 0;
    }
}

static int find_levels(Finding *f)
{
    const int pixels = f->window->w * f->window->h;
    LevelSearch search = {.least = pixels / LEVEL_LEAST + 1};
    search.placed = malloc(((size_t)f->nfaces + 1) * sizeof *search.placed);
    search.weights = malloc(((size_t)f->all->count + LEVELS_TRIED + 1) * sizeof *search.weights);
    int is_right = search.placed && search.weights;
    if (is_right)
        place_faces(f, &search);
    for (int n = 0, face; is_right && n < LEVELS_TRIED && (face = next_face(f, &search)) >= 0; n++)
        is_right = take_level(f, &search, &f->faces[face]);
    for (int k = 0; is_right && k < pixels; k++)
        if (f->face_of[k] >= 0 && f->faces[f->face_of[k]].level > 0)
            plane(f, LEVEL)[k] = (uint16_t)f->faces[f->face_of[k]].level;
    free(search.placed);
    free(search.weights);
    return is_right;
}

/* ---- */

static void count_shares(const Finding *f)
{
    const int pixels = f->window->w * f->window->h;
    int *counts = calloc((size_t)SURFACE_SCOPES * ((size_t)f->all->count + 1), sizeof *counts);
    for (int scope = 0; counts && scope < SURFACE_SCOPES; scope++)
        for (int k = 0; k < pixels; k++)
            counts[plane(f, scope)[k] * SURFACE_SCOPES + scope]++;
    for (int i = 0; counts && i < f->all->count; i++)
        for (int scope = 0; scope < SURFACE_SCOPES; scope++) {
            const double share = (double)counts[(i + 1) * SURFACE_SCOPES + scope] / pixels;
            f->all->list[i].share = share > f->all->list[i].share ? share : f->all->list[i].share;
        }
    free(counts);
}

static int open_finding(Finding *f)
{
    const FirstHitWindow *w = f->window;
    const size_t pixels = (size_t)w->w * (size_t)w->h;
    for (f->nface_buckets = 16; (size_t)f->nface_buckets < 2 * pixels;)
        f->nface_buckets *= 2;
    f->all->planes = calloc(SURFACE_SCOPES * pixels, sizeof *f->all->planes);
    f->shown = malloc(pixels * sizeof *f->shown);
    f->faces = malloc(pixels * sizeof *f->faces);
    f->face_of = malloc(pixels * sizeof *f->face_of);
    f->face_buckets = calloc((size_t)f->nface_buckets, sizeof *f->face_buckets);
    return f->all->planes && f->shown && f->faces && f->face_of && f->face_buckets;
}

int scene_surfaces_open(SceneSurfaces *known, const Scene *scene, RetexError *err)
{
    *known = (SceneSurfaces){.scene = scene};
    if (materials_open(&known->materials, scene) && scene_faces_open(&known->faces, scene))
        return RETEX_OK;
    scene_surfaces_close(known);
    return retex_fail(err, RETEX_ENOMEM, "out of memory for the scene's surfaces");
}

void scene_surfaces_close(SceneSurfaces *known)
{
    if (!known->scene)
        return;
    materials_close(&known->materials);
    scene_faces_close(&known->faces);
    known->scene = NULL;
}

int surfaces_find(Surfaces *surfaces, SceneSurfaces *known, const FirstHitWindow *window, RetexBudget *budget,
                  RetexError *err)
{
    const uint64_t pixels = (uint64_t)window->w * (uint64_t)window->h;
    const uint64_t bytes =
        pixels * (sizeof(ShownSurface) + sizeof(SeenFace) + sizeof(Face) + 5 * sizeof(int) +
                                     SURFACE_SCOPES * sizeof(uint16_t));
    Finding f = {.window = window, .all = surfaces, .known = known};
    *surfaces = (Surfaces){.count = 0};
    int code = retex_budget_charge(budget, bytes, "what pixels show", err);
    if (code)
        return code;
    surfaces->charged = bytes;
    int is_right = open_finding(&f);
    if (is_right)
        retex_parallel(window->nthreads, window->h, shown_row, &f);
    is_right = is_right && name_pixels(&f) && find_levels(&f);
    if (is_right)
        count_shares(&f);
    free(f.shown);
    free(f.faces);
    free(f.face_of);
    free(f.face_buckets);
    free(f.buckets);
    if (is_right)
        return RETEX_OK;
    surfaces_close(surfaces, budget);
    return retex_fail(err, RETEX_ENOMEM, "out of memory for what pixels show");
}

void surfaces_close(Surfaces *surfaces, RetexBudget *budget)
{
    for (int k = 0; k < surfaces->count; k++)
        free(surfaces->list[k].text);
    free(surfaces->list);
    free(surfaces->planes);
    retex_budget_release(budget, surfaces->charged);
    *surfaces = (Surfaces){.count = 0};
}

/* ---- UV ---- */

typedef struct UvJob {
    const FirstHitWindow *window;
    uint16_t *targets;
    float *u, *v;
} UvJob;

typedef struct UvPixel {
    int target; /* from 1; 0: none */
    float share;
    Vec2 uv;
} UvPixel;

static void see_leaf(void *context, const SeenLeaf *leaf)
{
    UvPixel *pixel = context;
    if (!leaf->targets || leaf->share <= pixel->share)
        return;
    *pixel = (UvPixel){__builtin_ctz(leaf->targets) + 1, leaf->share, surface_target_uv(&leaf->s.surface)};
}

static void uv_row(void *context, int y, int thread)
{
    const UvJob *job = context;
    const FirstHitWindow *w = job->window;
    (void)thread;
    for (int x = 0; x < w->w; x++) {
        const size_t k = (size_t)y * (size_t)w->w + (size_t)x;
        UvPixel pixel = {.target = 0};
        Ray ray;
        Hit hit;
        if (first_hit_ray(w, x, y, &ray, &hit))
            shading_each_leaf(w->scene, w->variants, &ray, &hit, see_leaf, &pixel);
        job->targets[k] = (uint16_t)pixel.target;
        job->u[k] = (float)pixel.uv.u, job->v[k] = (float)pixel.uv.v;
    }
}

void surfaces_uv(const FirstHitWindow *window, uint16_t *targets, float *u, float *v)
{
    UvJob job = {window, targets, u, v};
    retex_parallel(window->nthreads, window->h, uv_row, &job);
}
