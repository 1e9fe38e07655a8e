/* See parts.h. */
#include "set/parts.h"

#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>
#include <retex/host/denoise_data.h>
#include <retex/host/set_build.h>
#include <retex/parallel.h>

#include "base/half.h"
#include "base/image.h"
#include "set/references.h"
#include "set/source.h"

static void find_part(void *context, RetexPartUse use, int user, int *part)
{
    int *wanted = context; /* the part, and whether it is used */
    (void)use, (void)user;
    wanted[1] |= *part == wanted[0];
}

int retex_part_is_used(const RetexSet *set, int part)
{
    int wanted[2] = {part, 0};
    retex_set_visit_const_parts(set, find_part, wanted);
    return wanted[1];
}

int retex_part_is_denoise_data(const RetexSet *set, int part)
{
    const char *name = set->parts[part].name;
    return part > 0 && (retex_name_is_noise(name) || retex_name_is_feature(name)) && !retex_part_is_used(set, part);
}

int retex_term_add_image(RetexTerm *term, const RetexSet *set, int part, RetexError *err)
{
    const int place = retex_set_scale(set, &set->parts[part].image) > 1 ? 0 : term->nfactors;
    const int code = retex_term_add_factor(term, retex_factor(RETEX_FACTOR_IMAGE, part), err);

    for (int k = term->nfactors - 1; k > place && !code; k--) {
        const RetexFactor image = term->factors[k];
        term->factors[k] = term->factors[k - 1];
        term->factors[k - 1] = image;
    }
    return code;
}

void retex_set_view_free(RetexSetView *view)
{
    for (int i = 0; i < view->set.nparts; i++)
        retex_part_set_source(&view->set.parts[i], NULL, 0);
    free(view->set.parts);
    free(view->set.footprints);
    free(view->set.terms);
    free(view->source);
    memset(view, 0, sizeof *view);
}

static void renumber(void *context, RetexPartUse use, int user, int *part)
{
    const int *place = context; /* the number of each part in the view, or -1 */
    const int may_lack = use != RETEX_PART_RADIANCE && use != RETEX_PART_IMAGE && use != RETEX_PART_WEIGHT;
    (void)user;
    *part = place[*part];
    RETEX_ASSERT(*part >= 0 || may_lack);
    (void)may_lack;
}

int retex_set_view_make(RetexSetView *view, const RetexSet *set, const char *in_view, RetexError *err)
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
        place[i] = in_view[i] ? view->set.nparts : -1;
        if (in_view[i]) {
            view->source[view->set.nparts] = i;
            view->set.parts[view->set.nparts] = set->parts[i];
            retex_part_hold(&view->set.parts[view->set.nparts++]);
        }
    }
    for (int i = 0; i < set->nfootprints; i++)
        view->set.footprints[i] = set->footprints[i];
    for (int i = 0; i < set->nterms; i++)
        view->set.terms[i] = set->terms[i];
    retex_set_visit_parts(&view->set, renumber, place);
    free(place);
    return 0;
}

void retex_part_round_row(RetexPart *part, int y)
{
    RetexImage *im = &part->image;
    float *row = im->pixels + retex_image_index(im, 0, y);
    const size_t count = (size_t)im->width * (size_t)im->channels;
    uint16_t halves[256];
    for (size_t i = 0; i < count && part->type == RETEX_HALF; i += 256) {
        const size_t n = count - i < 256 ? count - i : 256;
        retex_half_from_float(halves, row + i, n);
        retex_half_to_float(row + i, halves, n);
    }
}

static void round_parts(void *context, int y, int thread)
{
    RetexSet *set = context;
    (void)thread;
    for (int k = 0; k < set->nparts; k++)
        if (set->parts[k].image.pixels && set->parts[k].image.height == set->height)
            retex_part_round_row(&set->parts[k], y);
}

void retex_set_round_to_types(RetexSet *set, int nthreads)
{
    retex_parallel(retex_threads(nthreads), set->height, round_parts, set);
}
