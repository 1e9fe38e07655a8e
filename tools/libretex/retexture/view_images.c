/* See view_images.h. */
#include "retexture/view_images.h"

#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>

#include "retexture/view_rows.h"
#include "set/parts.h"
#include "set/set.h"

static RetexViewMake *const makers[VIEW_KINDS] = {
    [VIEW_PART] = retex_view_make_part,           [VIEW_FOOTPRINT] = retex_view_make_footprint,
    [VIEW_MIXTURE] = retex_view_make_mixture,     [VIEW_FURTHER] = retex_view_make_further,
    [VIEW_GATE_SUMS] = retex_view_make_gate_sums, [VIEW_GATES] = retex_view_make_gates,
    [VIEW_GATE] = retex_view_make_gate,           [VIEW_ENLARGED] = retex_view_make_enlarged,
    [VIEW_SUM] = retex_view_make_sum,
};

static int are_same(const RetexViewImage *a, const RetexViewImage *b)
{
    return a->kind == b->kind && a->index == b->index && a->finish == b->finish && a->scale == b->scale &&
           a->channels == b->channels && a->ninputs == b->ninputs && a->kind != VIEW_SUM &&
           memcmp(a->inputs, b->inputs, sizeof *a->inputs * (size_t)a->ninputs) == 0;
}

int retex_view_add(RetexView *view, RetexViewImage wanted)
{
    for (int i = 0; i < view->nimages; i++)
        if (are_same(&view->images[i], &wanted))
            return i;
    if (view->nimages == view->room) {
        const int room = view->room ? 2 * view->room : 64;
        RetexViewImage *images = realloc(view->images, sizeof *images * (size_t)room);
        if (!images) {
            free(wanted.products);
            return RETEX_ENOMEM;
        }
        view->images = images;
        view->room = room;
    }
    wanted.make = makers[wanted.kind];
    wanted.width = (view->set->width + wanted.scale - 1) / wanted.scale;
    wanted.height = (view->set->height + wanted.scale - 1) / wanted.scale;
    view->images[view->nimages] = wanted;
    return view->nimages++;
}

int retex_view_enlarge(RetexView *view, int image, int scale)
{
    if (image < 0 || view->images[image].scale == scale)
        return image;
    RETEX_ASSERT(view->images[image].scale > scale);
    view->images[image].is_enlarged = 1;
    const int channels = view->images[image].channels == 1 ? 3 : view->images[image].channels;
    return retex_view_add(view, (RetexViewImage){.kind = VIEW_ENLARGED, .finish = -1, .scale = scale,
                                                 .channels = channels, .ninputs = 1, .inputs = {image}});
}

int retex_view_part(RetexView *view, int part, int channels)
{
    const int scale = retex_set_scale(view->set, &view->set->parts[part].image);
    return retex_view_add(view, (RetexViewImage){.kind = VIEW_PART, .index = part, .finish = -1, .scale = scale,
                                                 .channels = channels});
}

int retex_view_footprint(RetexView *view, int footprint, int finish, const RetexImage *shape)
{
    return retex_view_add(view, (RetexViewImage){.kind = VIEW_FOOTPRINT, .index = footprint, .finish = finish,
                                                 .scale = retex_set_scale(view->set, shape), .channels = 3});
}

int retex_view_mixture(RetexView *view, int mixture, int finish, const RetexImage *shape)
{
    const RetexMixture *m = &view->set->mixtures[mixture];
    RetexViewImage wanted = {.kind = VIEW_MIXTURE, .index = mixture, .finish = finish,
                             .scale = retex_set_scale(view->set, shape), .channels = 3, .ninputs = m->nshares};
    for (int k = 0; k < m->nshares; k++) {
        const int footprint = m->shares[k].footprint;
        wanted.inputs[k] = finish == VIEW_ORIGINALS
                               ? retex_view_part(view, view->set->footprints[footprint].albedo, 3)
                               : retex_view_footprint(view, footprint, finish, shape);
        if (wanted.inputs[k] < 0)
            return RETEX_ENOMEM;
    }
    return retex_view_add(view, wanted);
}

/* The first footprint of an image of colours that lacks its original albedo, or -1. */
static int lacks_original(const RetexView *view, int colors)
{
    const RetexViewImage *of = &view->images[colors];
    if (of->kind == VIEW_FOOTPRINT)
        return view->set->footprints[of->index].albedo < 0 ? of->index : -1;
    for (int k = 0; k < of->ninputs; k++)
        if (lacks_original(view, of->inputs[k]) >= 0)
            return view->images[of->inputs[k]].index;
    return -1;
}

int retex_view_further(RetexView *view, int colors, const RetexImage *shape, RetexError *err)
{
    const int lacking = lacks_original(view, colors), of = view->images[colors].index;
    if (lacking >= 0)
        return retex_fail(err, RETEX_EFORMAT, "footprint %d of the set lacks its original albedo", lacking);
    const int originals = view->images[colors].kind == VIEW_FOOTPRINT
                              ? retex_view_part(view, view->set->footprints[of].albedo, 3)
                              : retex_view_mixture(view, of, VIEW_ORIGINALS, shape);
    if (originals < 0)
        return RETEX_ENOMEM;
    return retex_view_add(view, (RetexViewImage){.kind = VIEW_FURTHER, .index = of, .finish = -1,
                                                 .scale = view->images[colors].scale, .channels = 3, .ninputs = 2,
                                                 .inputs = {colors, originals}});
}

/* Adds the sums of a target's footprints of that scale, if it has any, to the inputs of its gates. */
static int add_gate_sums(RetexView *view, int target, int scale, RetexViewImage *gates)
{
    int any = 0;
    for (int f = 0; f < view->set->nfootprints; f++)
        any |= view->set->footprints[f].target == target && retex_set_footprint_scale(view->set, f) == scale;
    if (!any)
        return RETEX_OK;
    const int sums = retex_view_add(view, (RetexViewImage){.kind = VIEW_GATE_SUMS, .index = target, .finish = -1,
                                                           .scale = scale, .channels = 4});
    gates->inputs[gates->ninputs] = retex_view_enlarge(view, sums, 1);
    return gates->inputs[gates->ninputs++] < 0 ? RETEX_ENOMEM : RETEX_OK;
}

int retex_view_gates(RetexView *view, int target)
{
    RetexViewImage gates = {.kind = VIEW_GATES, .index = target, .finish = -1, .scale = 1, .channels = 3};
    for (int scale = 1; scale <= RETEX_SCALE_MAX && view->textures && view->textures[target]; scale *= 2)
        if (add_gate_sums(view, target, scale, &gates))
            return RETEX_ENOMEM;
    return retex_view_add(view, gates);
}

int retex_view_gate(RetexView *view, int target, int finish)
{
    const int gates = retex_view_gates(view, target);
    if (gates < 0)
        return gates;
    return retex_view_add(view, (RetexViewImage){.kind = VIEW_GATE, .index = target, .finish = finish, .scale = 1,
                                                 .channels = 3, .ninputs = 1, .inputs = {gates}});
}
