/* See candidates.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/digest.h"
#include "render/candidates.h"
#include "render/internal.h"
#include "render/label.h"
#include "faces/scene_faces.h"
#include "shape/shape.h"

#define FLAT_LEAST 0.01    /* share of the picture of flat faces that are listed */
#define ATLAS_LEAST 0.1    /* of a material that may be told to be an atlas */
enum { LEVELS_MAX = 16, DIRECTIONS_MAX = 8 };

/* What a pixel shows most: indices of candidates, or -1. */
typedef struct SeenPixel {
    int object, material, flat; /* material: that of the object, where no other has it */
    const Primitive *primitive;
    const Instance *instance;
    int face;
    Vec3 normal; /* towards the camera */
} SeenPixel;

typedef struct Collection {
    const FirstHitWindow *window;
    Candidates *all;
    Materials materials;
    SceneFaces faces;
    int capacity, nbuckets, failed;
    int *buckets;      /* by hash: index + 1, or 0 */
    SeenPixel *seen; /* by pixel */
    int pixel;
    float most; /* share of the leaf that is seen most at this pixel */
} Collection;

static int *find_bucket(const Collection *c, const char *text)
{
    size_t i = digest_text(DIGEST_BEGIN, text) & (size_t)(c->nbuckets - 1);
    while (c->buckets[i] && strcmp(c->all->list[c->buckets[i] - 1].text, text) != 0)
        i = (i + 1) & (size_t)(c->nbuckets - 1);
    return &c->buckets[i];
}

static int grow(Collection *c)
{
    const int capacity = c->capacity ? 2 * c->capacity : 256;
    Candidate *list = realloc(c->all->list, (size_t)capacity * sizeof *list);
    int *buckets = calloc(2 * (size_t)capacity, sizeof *buckets);
    if (list)
        c->all->list = list;
    if (!list || !buckets) {
        free(buckets);
        return 0;
    }
    free(c->buckets);
    c->buckets = buckets;
    c->capacity = capacity, c->nbuckets = 2 * capacity;
    for (int k = 0; k < c->all->count; k++)
        *find_bucket(c, list[k].text) = k + 1;
    return 1;
}

/* The index of the candidate with this text, or -1. */
static int add(Collection *c, const char *text, const char *kind, const PlaceList *place, float share)
{
    if (c->all->count == c->capacity && !grow(c)) {
        c->failed = 1;
        return -1;
    }
    int *bucket = find_bucket(c, text);
    if (!*bucket) {
        char *copy = strdup(text);
        c->failed |= !copy;
        if (!copy)
            return -1;
        c->all->list[c->all->count++] = (Candidate){.text = copy, .kind = kind, .place = place};
        *bucket = c->all->count;
    }
    c->all->list[*bucket - 1].share += (double)share;
    return *bucket - 1;
}

static const char *kind_of(const Shape *shape)
{
    return shape->ops == &shape_cone && shape->r0 == shape->r1 ? "cylinder" : shape->ops->name;
}

/* Its material, where several objects have it; else it is the object. */
static int add_material(Collection *c, const ShownSurface *shown, int object, const SeenLeaf *leaf)
{
    char text[SELECTOR_MAX];
    ObjectPart first;
    int k = object;
    if (materials_first(&c->materials, &shown->part, &first) &&
        shown_selector(text, shown, SCOPE_MATERIAL, &c->materials, NULL))
        k = add(c, text, "material", first.places, leaf->share);
    const Texture *texture = leaf->s.surface.texture;
    const Finish *finish = texture->finish;
    if (k < 0)
        return k;
    if (k != object)
        c->all->list[k].name = materials_name(&c->materials, shown->part.texture);
    if (texture->pigment->kind == PIGMENT_IMAGE) {
        c->all->list[k].directions = 1;
        c->all->list[k].is_unlit = !finish->retex.present && finish->diffuse <= 0 && !rgb_is_black(finish->emission);
    }
    return k;
}

static int add_flat(Collection *c, const ShownSurface *shown, const PlaceList *place, float share)
{
    char text[SELECTOR_MAX];
    const struct KnownFaces *known = scene_faces_of(&c->faces, shown->primitive);
    c->failed |= !known;
    if (!known || !known->flat || !shown_selector(text, shown, SCOPE_FLAT, &c->materials, known->flat))
        return -1;
    return add(c, text, "flat", place, share);
}

static void add_leaf(void *context, const SeenLeaf *leaf)
{
    Collection *c = context;
    const Surface *surface = &leaf->s.surface;
    const ShownSurface shown = first_hit_of(c->window->scene, surface);
    const ObjectPart *part = &shown.part;
    const PlaceList *place = part->places ? part->places : surface->instance ? surface->instance->places : NULL;
    char text[SELECTOR_MAX];
    if (selector_of_object(text, part)) {
        const int object = add(c, text, kind_of(&surface->primitive->shape), place, leaf->share);
        const int material = add_material(c, &shown, object, leaf), flat = add_flat(c, &shown, place, leaf->share);
        if (leaf->share > c->most) {
            const Vec3 n = surface->geometric_normal;
            c->most = leaf->share;
            c->seen[c->pixel] = (SeenPixel){.object = object,
                                            .material = material,
                                            .flat = flat,
                                            .primitive = shown.primitive,
                                            .instance = surface->instance,
                                            .face = shown.face,
                                            .normal = surface->backside ? vec_neg(n) : n};
        }
    }
    if (selector_of_color(text, surface->texture))
        add(c, text, "colour", place, leaf->share);
    if (selector_of_image(text, surface->texture))
        add(c, text, "image", place, leaf->share);
}

static void collect(Collection *c)
{
    const FirstHitWindow *w = c->window;
    for (int y = 0; y < w->h; y++)
        for (int x = 0; x < w->w; x++) {
            Ray ray;
            Hit hit;
            c->pixel = y * w->w + x;
            c->seen[c->pixel] = (SeenPixel){.object = -1, .material = -1, .flat = -1};
            c->most = 0;
            if (first_hit_ray(w, x, y, &ray, &hit))
                shading_each_leaf(w->scene, w->variants, &ray, &hit, add_leaf, c);
        }
    for (int k = 0; k < c->all->count; k++)
        c->all->list[k].share /= (double)w->w * w->h;
}

/* ---- levels ---- */

/* While levels are found: shares of the picture by candidate. */
typedef struct Levels {
    double *on;    /* of flat faces, on the level that is looked at */
    char *is_done; /* of flat faces: a level has them, or none is to be looked for */
} Levels;

/* The flat faces that are seen most, of which no level is known yet; -1: none. */
static int next_flat(const Collection *c, const Levels *levels)
{
    int best = -1;
    for (int k = 0; k < c->all->count; k++) {
        const Candidate *one = &c->all->list[k];
        if (strcmp(one->kind, "flat") == 0 && one->share >= FLAT_LEAST && !levels->is_done[k] &&
            (best < 0 || one->share > c->all->list[best].share))
            best = k;
    }
    return best;
}

/* The share of what is on a level. Of copies each is looked at by itself. */
static double share_on(Collection *c, const FaceLevel *level, Levels *levels, int count)
{
    const int pixels = c->window->w * c->window->h;
    double sum = 0;
    memset(levels->on, 0, (size_t)count * sizeof *levels->on);
    for (int k = 0; k < pixels; k++) {
        const SeenPixel *seen = &c->seen[k];
        const struct KnownFaces *known = seen->flat >= 0 ? scene_faces_of(&c->faces, seen->primitive) : NULL;
        Face face;
        if (!known || !faces_placed(seen->primitive, seen->instance, seen->face, &face) ||
            !faces_is_on_level(level, &face, known->owner.is_open))
            continue;
        levels->on[seen->flat] += 1.0 / pixels;
        sum += 1.0 / pixels;
    }
    return sum;
}

static void add_level(Collection *c, Levels *levels, int flat, int count)
{
    const Candidate one = c->all->list[flat];
    const Scene *scene = c->window->scene;
    const struct KnownFaces *known;
    FaceLevel level;
    char text[SELECTOR_MAX];
    int number, face;
    levels->is_done[flat] = 1;
    if (sscanf(one.text, "#%d/flat:%d", &number, &face) != 2 ||
        !(known = scene_faces_of(&c->faces, &scene->primitives[number - 1])) ||
        faces_level_of(&level, scene, &known->owner, face - 1))
        return;
    const double share = share_on(c, &level, levels, count);
    for (int k = 0; k < count; k++)
        levels->is_done[k] |= levels->on[k] > 0.5 * c->all->list[k].share;
    if (share < 1.02 * one.share)
        return;
    snprintf(text, sizeof text, "#%d/level:%d", number, face);
    const int k = add(c, text, "level", one.place, 0);
    if (k >= 0)
        c->all->list[k].share = share;
}

static void add_levels(Collection *c)
{
    const int count = c->all->count;
    Levels levels = {calloc((size_t)count + 1, sizeof *levels.on), calloc((size_t)count + LEVELS_MAX + 1, 1)};
    c->failed |= !levels.on || !levels.is_done;
    for (int n = 0, flat; !c->failed && n < LEVELS_MAX && (flat = next_flat(c, &levels)) >= 0; n++)
        add_level(c, &levels, flat, count);
    free(levels.on);
    free(levels.is_done);
}

/* ---- atlases ---- */

typedef struct Seen {
    int count;
    Vec3 normals[DIRECTIONS_MAX];
    double shares[DIRECTIONS_MAX];
} Seen;

/* Those that differ by more than 45 degrees. */
static void add_direction(Seen *seen, Vec3 normal, double share)
{
    int k = 0;
    while (k < seen->count && vec_dot(seen->normals[k], normal) < sqrt(0.5))
        k++;
    if (k == DIRECTIONS_MAX)
        return;
    if (k == seen->count)
        seen->normals[seen->count++] = normal, seen->shares[k] = 0;
    seen->shares[k] += share;
}

/* Of images: the directions in which a good part of what shows them looks. */
static void count_directions(Collection *c)
{
    const int pixels = c->window->w * c->window->h;
    Seen *all = calloc((size_t)c->all->count + 1, sizeof *all);
    c->failed |= !all;
    for (int k = 0; all && k < pixels; k++) {
        const int material = c->seen[k].material;
        if (material >= 0 && c->all->list[material].directions && c->all->list[material].share >= ATLAS_LEAST)
            add_direction(&all[material], c->seen[k].normal, 1.0 / pixels);
    }
    for (int k = 0; all && k < c->all->count; k++) {
        c->all->list[k].directions = 0;
        for (int i = 0; i < all[k].count; i++)
            c->all->list[k].directions += all[k].shares[i] >= fmax(FLAT_LEAST, 0.05 * c->all->list[k].share);
    }
    free(all);
}

/* ---- what is not worth a line ---- */

/* Flat faces of which little is seen, or that are all that is seen of their object. Indices of pixels are lost. */
static void drop_flat(Collection *c)
{
    const int pixels = c->window->w * c->window->h;
    int *objects = calloc((size_t)c->all->count + 1, sizeof *objects), kept = 0;
    c->failed |= !objects;
    for (int k = 0; objects && k < pixels; k++)
        if (c->seen[k].flat >= 0)
            objects[c->seen[k].flat] = c->seen[k].object;
    for (int k = 0; objects && k < c->all->count; k++) {
        Candidate *one = &c->all->list[k];
        const double whole = c->all->list[objects[k]].share;
        if (strcmp(one->kind, "flat") == 0 && (one->share < FLAT_LEAST || fabs(one->share - whole) < 1e-9))
            one->share = -1;
    }
    for (int k = 0; objects && k < c->all->count; k++) {
        if (c->all->list[k].share < 0)
            free(c->all->list[k].text);
        else
            c->all->list[kept++] = c->all->list[k];
    }
    if (objects)
        c->all->count = kept;
    free(objects);
}

/* ---- the sheet ---- */

/* Hues far from each other for neighbours in the list. */
static Rgb hue(int index)
{
    float c[3];
    for (int k = 0; k < 3; k++) {
        const double turn = fmod(index * 0.61803398875 + k / 3.0, 1);
        c[k] = (float)fmin(1, fmax(0, fabs(6 * turn - 3) - 1));
    }
    const float light = index % 3 == 1 ? 0.35f : 0.8f, pale = index % 2 ? 0.05f : 0.25f;
    return rgb(light * (pale + (1 - pale) * c[0]), light * (pale + (1 - pale) * c[1]),
               light * (pale + (1 - pale) * c[2]));
}

/* The hue of the material; lighter and darker by flat faces, or by objects without. */
static Rgb sheet_color(const SeenPixel *seen)
{
    const double light = fmod(0.61803398875 * (seen->flat >= 0 ? seen->flat : seen->object), 1);
    return rgb_scale(hue(seen->material), 1 - 0.55f * (float)light);
}

/* How much room for a label there is around a pixel of an object: half the side of the largest square. */
static void measure_rooms(const Collection *c, int w, int h, int *rooms)
{
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < w * h; k++) {
            const int i = pass ? w * h - 1 - k : k, x = i % w, y = i / w, step = pass ? 1 : -1;
            const int at_edge = (pass ? x == w - 1 : x == 0) || (pass ? y == h - 1 : y == 0);
            int least = 0;
            if (!at_edge) {
                const int near[3] = {i + step, i + step * w, i + step * (w + 1)};
                least = w;
                for (int n = 0; n < 3; n++) {
                    const int room = c->seen[near[n]].object == c->seen[i].object ? rooms[near[n]] : 0;
                    least = room < least ? room : least;
                }
            }
            rooms[i] = pass ? (rooms[i] < least + 1 ? rooms[i] : least + 1) : least + 1;
        }
}

static int draw_sheet(const Collection *c, RetexImage *sheet, RetexError *err)
{
    const int w = c->window->w, h = c->window->h;
    int *rooms = malloc((size_t)w * (size_t)h * sizeof *rooms), *best = calloc((size_t)c->all->count + 1, sizeof *best);
    int code = rooms && best ? retex_image_alloc(sheet, w, h, 3, err)
                             : retex_fail(err, RETEX_ENOMEM, "out of memory for the sheet of targets");
    if (!code) {
        measure_rooms(c, w, h, rooms);
        for (int i = 0; i < w * h; i++) {
            const int object = c->seen[i].object;
            const Rgb color = object >= 0 ? sheet_color(&c->seen[i]) : rgb_grey(0);
            memcpy(sheet->pixels + 3 * (size_t)i, &color, 3 * sizeof(float));
            if (object >= 0 && rooms[i] > rooms[best[object]])
                best[object] = i;
            else if (object >= 0 && c->seen[best[object]].object != object)
                best[object] = i;
        }
        for (int k = 0; k < c->all->count; k++)
            if (c->seen[best[k]].object == k)
                label_draw(sheet, c->all->list[k].text + 1, best[k] % w, best[k] / w, rooms[best[k]]);
    }
    free(rooms);
    free(best);
    return code;
}

/* ---- */

static int compare(const void *a, const void *b)
{
    const Candidate *x = a, *y = b;
    return x->share < y->share ? 1 : x->share > y->share ? -1 : strcmp(x->text, y->text);
}

static int open_collection(Collection *c)
{
    const FirstHitWindow *w = c->window;
    c->seen = malloc((size_t)w->w * (size_t)w->h * sizeof *c->seen);
    return c->seen && materials_open(&c->materials, w->scene) && scene_faces_open(&c->faces, w->scene);
}

int render_candidates(Candidates *candidates, RetexImage *sheet, const Scene *scene, const RenderParams *params,
                      RetexError *err)
{
    Render r;
    *candidates = (Candidates){.count = 0};
    int code = render_open(&r, scene, params, err);
    const FirstHitWindow window = render_window(&r);
    Collection c = {.window = &window, .all = candidates};
    if (!code && !open_collection(&c))
        c.failed = 1;
    if (!code && !c.failed)
        collect(&c);
    if (!code && !c.failed)
        add_levels(&c);
    if (!code && !c.failed)
        count_directions(&c);
    if (!code && !c.failed && sheet)
        code = draw_sheet(&c, sheet, err);
    if (!code && !c.failed)
        drop_flat(&c);
    if (!code && c.failed)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory for the list of targets");
    if (!code && candidates->count)
        qsort(candidates->list, (size_t)candidates->count, sizeof *candidates->list, compare);
    free(c.buckets);
    free(c.seen);
    materials_close(&c.materials);
    scene_faces_close(&c.faces);
    render_close(&r);
    if (code)
        candidates_close(candidates);
    return code;
}

void candidates_close(Candidates *candidates)
{
    for (int k = 0; k < candidates->count; k++)
        free(candidates->list[k].text);
    free(candidates->list);
    *candidates = (Candidates){.count = 0};
}
