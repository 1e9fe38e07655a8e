/* See references.h. */
#include "set/references.h"

#include "set/set.h"

typedef struct Visiting {
    RetexPartVisit *visit;
    void *context;
} Visiting;

static void visit_part(const Visiting *v, RetexPartUse use, int user, int *part)
{
    if (*part >= 0)
        v->visit(v->context, use, user, part);
}

/* Visits a part that is referred to by 1 + its number. */
static void visit_laid(const Visiting *v, RetexPartUse use, int user, int *reference)
{
    int part = *reference - 1;
    if (part < 0)
        return;
    v->visit(v->context, use, user, &part);
    if (part != *reference - 1)
        *reference = 1 + part;
}

void retex_set_visit_parts(RetexSet *set, RetexPartVisit *visit, void *context)
{
    const Visiting v = {visit, context};
    for (int t = 0; t < set->nterms; t++) {
        RetexTerm *term = &set->terms[t];
        if (term->role == RETEX_ROLE_PICTURE)
            continue;
        visit_part(&v, RETEX_PART_RADIANCE, t, &term->radiance);
        for (int k = 0; k < term->nfactors; k++)
            if (term->factors[k].kind == RETEX_FACTOR_IMAGE)
                visit_part(&v, RETEX_PART_IMAGE, t, &term->factors[k].index);
    }
    for (int f = 0; f < set->nfootprints; f++) {
        visit_part(&v, RETEX_PART_UV, f, &set->footprints[f].uv);
        visit_part(&v, RETEX_PART_SPREAD, f, &set->footprints[f].spread);
        visit_part(&v, RETEX_PART_ALBEDO, f, &set->footprints[f].albedo);
        visit_laid(&v, RETEX_PART_LAID, f, &set->footprints[f].sampled);
        for (int k = 0; k < RETEX_FINISHES_MAX; k++)
            visit_laid(&v, RETEX_PART_LAID, f, &set->footprints[f].finished[k]);
    }
    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            visit_part(&v, RETEX_PART_WEIGHT, m, &set->mixtures[m].shares[k].weight);
    for (int t = 0; t < set->ntargets; t++) {
        visit_part(&v, RETEX_PART_ORIGINAL, t, &set->targets[t].original);
        visit_laid(&v, RETEX_PART_GATES, t, &set->targets[t].gates);
    }
}
