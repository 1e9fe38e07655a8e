/* See candidates.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "render/candidates.h"
#include "render/internal.h"
#include "render/label.h"
#include "shape/shape.h"

typedef struct Collection {
    const FirstHitWindow *window;
    Candidates *all;
    int capacity, nslots, failed;
    int *slots;   /* by hash: index + 1, or 0 */
    int *objects; /* of each pixel: the index of its object, or -1 */
    int pixel;
    float most; /* share of the leaf that is seen most at this pixel */
} Collection;

static size_t hash_text(const char *text)
{
    size_t hash = 1469598103u;
    for (; *text; text++)
        hash = (hash ^ (unsigned char)*text) * 1099511u;
    return hash;
}

static int *find_slot(const Collection *c, const char *text)
{
    size_t i = hash_text(text) & (size_t)(c->nslots - 1);
    while (c->slots[i] && strcmp(c->all->list[c->slots[i] - 1].text, text) != 0)
        i = (i + 1) & (size_t)(c->nslots - 1);
    return &c->slots[i];
}

static int grow(Collection *c)
{
    const int capacity = c->capacity ? 2 * c->capacity : 256;
    Candidate *list = realloc(c->all->list, (size_t)capacity * sizeof *list);
    int *slots = calloc(2 * (size_t)capacity, sizeof *slots);
    if (list)
        c->all->list = list;
    if (!list || !slots) {
        free(slots);
        return 0;
    }
    free(c->slots);
    c->slots = slots;
    c->capacity = capacity, c->nslots = 2 * capacity;
    for (int k = 0; k < c->all->count; k++)
        *find_slot(c, list[k].text) = k + 1;
    return 1;
}

/* The index of the candidate with this text, or -1. */
static int add(Collection *c, const char *text, const char *kind, const PlaceList *place, float share)
{
    if (c->all->count == c->capacity && !grow(c)) {
        c->failed = 1;
        return -1;
    }
    int *slot = find_slot(c, text);
    if (!*slot) {
        char *copy = strdup(text);
        c->failed |= !copy;
        if (!copy)
            return -1;
        c->all->list[c->all->count++] = (Candidate){copy, kind, place, 0};
        *slot = c->all->count;
    }
    c->all->list[*slot - 1].share += (double)share;
    return *slot - 1;
}

static const char *kind_of(const Shape *shape)
{
    return shape->ops == &shape_cone && shape->r0 == shape->r1 ? "cylinder" : shape->ops->name;
}

static void add_leaf(void *context, const SeenLeaf *leaf)
{
    Collection *c = context;
    const Surface *surface = &leaf->s.surface;
    const ObjectPart part = first_hit_of(c->window->scene, surface).part;
    const PlaceList *place = part.places ? part.places : surface->instance ? surface->instance->places : NULL;
    char text[SELECTOR_MAX];
    if (selector_of_object(text, &part)) {
        const int object = add(c, text, kind_of(&surface->primitive->shape), place, leaf->share);
        if (leaf->share > c->most)
            c->most = leaf->share, c->objects[c->pixel] = object;
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
            c->objects[c->pixel] = -1;
            c->most = 0;
            if (first_hit_ray(w, x, y, &ray, &hit))
                shading_each_leaf(w->scene, w->variants, &ray, &hit, add_leaf, c);
        }
    for (int k = 0; k < c->all->count; k++)
        c->all->list[k].share /= (double)w->w * w->h;
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
                    const int room = c->objects[near[n]] == c->objects[i] ? rooms[near[n]] : 0;
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
            const int object = c->objects[i];
            const Rgb color = object >= 0 ? hue(object) : rgb_grey(0);
            memcpy(sheet->pixels + 3 * (size_t)i, &color, 3 * sizeof(float));
            if (object >= 0 && rooms[i] > rooms[best[object]])
                best[object] = i;
            else if (object >= 0 && c->objects[best[object]] != object)
                best[object] = i;
        }
        for (int k = 0; k < c->all->count; k++)
            if (c->objects[best[k]] == k)
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

int render_candidates(Candidates *candidates, RetexImage *sheet, const Scene *scene, const RenderParams *params,
                      RetexError *err)
{
    Render r;
    *candidates = (Candidates){.count = 0};
    int code = render_open(&r, scene, params, err);
    const FirstHitWindow window = render_window(&r);
    Collection c = {.window = &window, .all = candidates};
    if (!code && !(c.objects = malloc((size_t)window.w * (size_t)window.h * sizeof *c.objects)))
        c.failed = 1;
    if (!code && !c.failed)
        collect(&c);
    if (c.failed)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory for the list of targets");
    if (!code && sheet)
        code = draw_sheet(&c, sheet, err);
    if (!code && candidates->count)
        qsort(candidates->list, (size_t)candidates->count, sizeof *candidates->list, compare);
    free(c.slots);
    free(c.objects);
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
