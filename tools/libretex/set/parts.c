/* See parts.h. */
#include "set/parts.h"

#include <stdlib.h>
#include <string.h>

#include <retex/denoise_data.h>

int retex_part_is_used(const RetexSet *set, int part)
{
    for (int i = 0; i < set->ntargets; i++)
        if (set->targets[i].original == part)
            return 1;
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *footprint = &set->footprints[i];
        if (footprint->uv == part || footprint->spread == part || footprint->albedo == part)
            return 1;
    }
    for (int i = 0; i < set->nterms; i++)
        if (set->terms[i].radiance == part || (part && set->terms[i].gain == part))
            return 1;
    for (int i = 0; i < set->nmixtures; i++)
        for (int k = 0; k < set->mixtures[i].nshares; k++)
            if (set->mixtures[i].shares[k].weight == part)
                return 1;
    return 0;
}

int retex_part_is_denoise_data(const RetexSet *set, int part)
{
    const char *name = set->parts[part].name;
    return part > 0 && (retex_name_is_noise(name) || retex_name_is_feature(name)) && !retex_part_is_used(set, part);
}

void retex_set_view_free(RetexSetView *view)
{
    free(view->set.parts);
    free(view->set.footprints);
    free(view->set.terms);
    free(view->source);
    memset(view, 0, sizeof *view);
}

static int renumber(const int *place, int part)
{
    return part < 0 ? -1 : place[part];
}

/* Copies all that refers to parts; place[i]: number of part i in the view, or -1. */
static void copy_references(RetexSetView *view, const RetexSet *set, const int *place)
{
    for (int i = 0; i < set->ntargets; i++)
        view->set.targets[i].original = renumber(place, set->targets[i].original);
    for (int i = 0; i < set->nfootprints; i++) {
        RetexFootprint *footprint = &view->set.footprints[i];
        *footprint = set->footprints[i];
        footprint->uv = renumber(place, footprint->uv);
        footprint->spread = renumber(place, footprint->spread);
        footprint->albedo = renumber(place, footprint->albedo);
    }
    for (int i = 0; i < set->nterms; i++) {
        view->set.terms[i] = set->terms[i];
        view->set.terms[i].radiance = place[set->terms[i].radiance];
        if (set->terms[i].gain)
            view->set.terms[i].gain = place[set->terms[i].gain];
    }
    for (int i = 0; i < set->nmixtures; i++)
        for (int k = 0; k < set->mixtures[i].nshares; k++)
            view->set.mixtures[i].shares[k].weight = place[set->mixtures[i].shares[k].weight];
}

int retex_set_view_make(RetexSetView *view, const RetexSet *set, const char *kept, RetexError *err)
{
    int *place = calloc((size_t)set->nparts + 1, sizeof *place);

    memset(view, 0, sizeof *view);
    view->set = *set;
    view->set.nparts = 0;
    view->set.parts = calloc((size_t)set->nparts + 1, sizeof *set->parts);
    view->set.footprints = calloc((size_t)set->nfootprints + 1, sizeof *set->footprints);
    view->set.terms = calloc((size_t)set->nterms + 1, sizeof *set->terms);
    view->source = calloc((size_t)set->nparts + 1, sizeof *view->source);
    if (!place || !view->set.parts || !view->set.footprints || !view->set.terms || !view->source) {
        retex_set_view_free(view);
        free(place);
        return retex_fail(err, RETEX_ENOMEM, "no memory to write a set");
    }
    for (int i = 0; i < set->nparts; i++) {
        place[i] = kept[i] ? view->set.nparts : -1;
        if (kept[i]) {
            view->source[view->set.nparts] = i;
            view->set.parts[view->set.nparts++] = set->parts[i];
        }
    }
    copy_references(view, set, place);
    free(place);
    return 0;
}
