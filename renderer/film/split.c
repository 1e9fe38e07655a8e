/* See split.h. */
#include <stdlib.h>
#include "film/split.h"

int split_open(SplitSink *s, FilmPixel *pixel, size_t paths, int nlamps, RetexError *err)
{
    s->pixel = pixel, s->count = 0;
    s->has_lamps = nlamps > 0, s->nlamp_light = 0;
    film_hit_limits(pixel, &s->orders, &s->most_hits);
    s->nodes = aligned_alloc(sizeof *s->nodes, paths * TARGET_NODES_MAX * sizeof *s->nodes);
    if (nlamps > 0)
        s->lamp_light =
            aligned_alloc(sizeof(Float4), paths * (TARGET_NODES_MAX + 1) * (size_t)nlamps * sizeof *s->lamp_light);
    return s->nodes && (s->lamp_light || !nlamps) ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory for paths");
}

void split_close(SplitSink *s)
{
    free(s->nodes);
    free(s->lamp_light);
    s->nodes = NULL, s->lamp_light = NULL;
}

/* ---- hits ---- */

/* Whether a hit keeps the factor apart: then it is counted. Else it is multiplied into `rest` as a whole, with the
 * original albedo; *folded: with a texture that changes it. counts: of the path's hits and those added since.
 *
 * A reflection is a hit even where the texture does not change it, so that what is seen reflected in a polished floor
 * stays apart from the floor's own texture. Light that only passes through a target unchanged makes no hit. */
static inline int keep_as_hit(const SplitSink *s, const SplitPath *p, Float4 *rest, TargetCounts *counts, int *folded,
                              const Factor *f)
{
    const int added = counts->nhits - p->counts.nhits, is_textured = f->target >= 0 && !is_black4(f->d);
    if ((is_textured || (f->target >= 0 && f->reflects)) && p->tree.count + added < TARGET_NODES_MAX &&
        target_counts_allow(counts, f->target, s->orders, s->most_hits)) {
        target_counts_add(counts, f->target, !is_black4(f->d) && !is_black4(f->i));
        return 1;
    }
    *rest *= factor_whole(f);
    *folded |= is_textured;
    return 0;
}

static inline TargetNode *add_hit(SplitSink *s, SplitPath *p, const Factor *f, TargetNode *before, Float4 before_d,
                                  Float4 before_i)
{
    const TargetVertex at = {.uv = f->uv,
                             .albedo = rgb_of4(f->albedo),
                             .target = (unsigned char)f->target,
                             .sharp = (unsigned char)f->sharp,
                             .direct = (unsigned char)f->direct};
    return target_tree_add(&p->tree, &s->nodes[s->count++], &at, before, before_d, before_i);
}

/* The hit of the current vertex: direct light and the continued path share it. */
static inline TargetNode *find_current_hit(SplitSink *s, SplitPath *p, const Factor *f)
{
    const TargetNode *hit = p->current_hit;
    if (!hit || hit->at.target != f->target || hit->at.uv.u != f->uv.u || hit->at.uv.v != f->uv.v ||
        hit->at.sharp != f->sharp)
        p->current_hit = add_hit(s, p, f, p->last, p->last_d, p->last_i);
    return p->current_hit;
}

/* Where one of d and i is black, the other is multiplied into `rest` and 1 stays in its place: so `rest` is black
 * wherever no texture can make the contribution other than black. */
void split_multiply(SplitSink *s, SplitPath *p, const Factor *f)
{
    if (keep_as_hit(s, p, &p->rest, &p->counts, &p->folded, f)) {
        p->last = find_current_hit(s, p, f);
        p->last_d = f->d, p->last_i = f->i;
        if (is_black4(f->i)) {
            p->rest *= f->d;
            p->last_d = splat(1);
        } else if (is_black4(f->d)) {
            p->rest *= f->i;
            p->last_i = splat(1);
        }
    }
    p->current_hit = NULL;
}

/* ---- light ---- */

/* Light that comes to a hit, D and I, or to the camera where hit is NULL: what it would be with white targets. */
static Float4 with_white_targets(const TargetNode *hit, Float4 dependent, Float4 independent)
{
    Float4 light = target_factor_white(dependent, independent);
    for (; hit && hit->before; hit = hit->before)
        light *= target_factor_white(hit->before_d, hit->before_i);
    return light;
}

/* Add light of a lamp to that which it has at the same hit. */
static void add_lamp_light(SplitSink *s, SplitPath *p, int lamp, const TargetNode *hit, Float4 d, Float4 i,
                           Float4 light)
{
    LampLight *same = p->tree.lamp_light;
    while (same && (same->lamp != lamp || same->hit != hit))
        same = (LampLight *)same->earlier;
    if (same) {
        same->dependent += d, same->independent += i, same->light += light;
        return;
    }
    LampLight *added = &s->lamp_light[s->nlamp_light++];
    *added = (LampLight){d, i, light, hit, p->tree.lamp_light, lamp};
    p->tree.lamp_light = added;
}

int split_add(SplitSink *s, SplitPath *p, const Contribution *c, Float4 light)
{
    const Factor *kept[TARGET_NODES_MAX];
    Float4 rest = p->rest * color4(c->light), d = p->last_d, i = p->last_i;
    TargetCounts counts = p->counts;
    TargetNode *last = p->last;
    int count = 0, folded = p->folded;
    for (int k = 0; k < c->nfactors; k++)
        if (keep_as_hit(s, p, &rest, &counts, &folded, &c->factors[k]))
            kept[count++] = &c->factors[k];
    if (!rgb_is_finite(rgb_of4(light + rest)))
        return 0;
    if (is_black4(rest))
        return 1;
    for (int k = 0; k < count; k++) {
        last = k == 0 ? find_current_hit(s, p, kept[0]) : add_hit(s, p, kept[k], last, d, i);
        d = kept[k]->d, i = kept[k]->i;
    }
    if (s->has_lamps)
        add_lamp_light(s, p, c->lamp, last, last ? d * rest : splat(0), last ? i * rest : rest, light);
    if (last)
        target_node_add_light(last, d, i, rest);
    else
        p->tree.without_hit += rest, p->tree.nwithout_hit++;
    if (folded)
        film_add_folded(s->pixel, rgb_of4(light), rgb_of4(last ? with_white_targets(last, d * rest, i * rest) : rest));
    return 1;
}
