/* See reuse.h. The table is known beforehand. So memory goes to the samples that are needed again soonest, which no
 * order of uses has more of found (Belady, 'A study of replacement algorithms for a virtual-storage computer', 1966),
 * and what is needed no more goes at once. Rows stay in their order. */
#include <stdlib.h>
#include <string.h>

#include "combine/reuse.h"

/* ---- the plan ---- */

static int add_use(Reuse *reuse, int row, int target, char *text, RetexError *err)
{
    if (reuse->nuses == reuse->capacity) {
        const int capacity = reuse->capacity ? 2 * reuse->capacity : 64;
        ReuseUse *uses = realloc(reuse->uses, (size_t)capacity * sizeof *uses);
        if (!uses)
            return retex_fail(err, RETEX_ENOMEM, "not enough memory to plan %d textures", capacity);
        reuse->uses = uses;
        reuse->capacity = capacity;
    }
    reuse->uses[reuse->nuses++] = (ReuseUse){row, target, 0, -1, text};
    return RETEX_OK;
}

int reuse_add_row(Reuse *reuse, const RetexSet *set, int row, const RetexTextureSpec *specs, int count, RetexError *err)
{
    RetexEdit *edit = NULL;
    int code = retex_edit_create(&edit, err);
    for (int i = 0; i < count && !code; i++) {
        char *text = NULL;
        if (specs[i].constant && !specs[i].nlayers) /* a colour is not filtered */
            continue;
        retex_edit_clear(edit);
        code = retex_edit_add(edit, &specs[i], err);
        if (!code)
            code = retex_edit_text(edit, ';', &text, err);
        if (!code)
            code = add_use(reuse, row, retex_set_find_target(set, specs[i].target), text, err);
        if (code)
            free(text);
    }
    retex_edit_close(&edit);
    return code;
}

static int compare_textures(const ReuseUse *a, const ReuseUse *b)
{
    return a->target != b->target ? a->target - b->target : strcmp(a->text, b->text);
}

static int by_texture(const void *left, const void *right)
{
    const ReuseUse *a = left, *b = right;
    const int order = compare_textures(a, b);
    return order ? order : a->row - b->row;
}

static int by_row(const void *left, const void *right)
{
    const ReuseUse *a = left, *b = right;
    return a->row != b->row ? a->row - b->row : a->target - b->target;
}

int reuse_plan(Reuse *reuse, uint64_t bytes, RetexError *err)
{
    ReuseUse *uses = reuse->uses;
    int count = 0;
    if (reuse->nuses)
        qsort(uses, (size_t)reuse->nuses, sizeof *uses, by_texture);
    for (int begin = 0, end; begin < reuse->nuses; begin = end) {
        for (end = begin + 1; end < reuse->nuses && !compare_textures(&uses[begin], &uses[end]); end++)
            uses[end - 1].next = uses[end].row;
        for (int i = begin; i < end; i++)
            free(uses[i].text);
        for (int i = begin; i < end && end > begin + 1 && bytes; i++)
            uses[count++] = (ReuseUse){uses[i].row, uses[i].target, reuse->ntextures, uses[i].next, NULL};
        reuse->ntextures += end > begin + 1;
    }
    reuse->nuses = count;
    reuse->ntextures = count ? reuse->ntextures : 0;
    if (!count)
        return RETEX_OK;
    qsort(uses, (size_t)count, sizeof *uses, by_row);
    reuse->textures = calloc((size_t)reuse->ntextures, sizeof *reuse->textures);
    if (!reuse->textures)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to plan %d textures", reuse->ntextures);
    const int code = retex_budget_create(&reuse->budget, err);
    if (!code)
        retex_budget_set_memory(reuse->budget, bytes);
    return code;
}

/* ---- the rows ---- */

/* The uses of a row, which follow each other; returns their number. */
static int uses_of(const Reuse *reuse, int row, ReuseUse **uses)
{
    int low = 0, high = reuse->nuses;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (reuse->uses[middle].row < row)
            low = middle + 1;
        else
            high = middle;
    }
    *uses = reuse->uses + low;
    while (high < reuse->nuses && reuse->uses[high].row == row)
        high++;
    return high - low;
}

static RetexKeptSamplesInfo info_of(const RetexKeptSamples *samples)
{
    RetexKeptSamplesInfo info = {.size = sizeof info};
    retex_kept_samples_get_info(samples, &info);
    return info;
}

static void drop(Reuse *reuse, ReusedTexture *texture)
{
    const RetexKeptSamplesInfo info = info_of(texture->samples);
    reuse->made += info.made;
    reuse->found += info.found;
    retex_kept_samples_close(&texture->samples);
}

/* Drop samples that are needed later than row `before`, the last needed first, until so many bytes are free. */
static void make_room(Reuse *reuse, uint64_t bytes, int before)
{
    while (retex_budget_left(reuse->budget) < bytes) {
        ReusedTexture *last = NULL;
        for (int i = 0; i < reuse->ntextures; i++)
            if (reuse->textures[i].samples && reuse->textures[i].next > (last ? last->next : before))
                last = &reuse->textures[i];
        if (!last)
            return;
        drop(reuse, last);
    }
}

void reuse_begin(Reuse *reuse, const RetexSet *set, int row)
{
    ReuseUse *uses;
    const int count = uses_of(reuse, row, &uses);
    memset(reuse->kept, 0, sizeof reuse->kept);
    for (int i = 0; i < count; i++) {
        ReusedTexture *texture = &reuse->textures[uses[i].texture];
        if (!texture->samples && uses[i].next >= 0) /* without memory they are not kept */
            (void)retex_kept_samples_create(&texture->samples, set, uses[i].target, reuse->budget, NULL);
        texture->next = uses[i].next;
        texture->lacked = texture->samples ? info_of(texture->samples).lacked : 0;
        reuse->kept[uses[i].target] = texture->samples;
    }
}

void reuse_end(Reuse *reuse, int row)
{
    ReuseUse *uses;
    const int count = uses_of(reuse, row, &uses);
    uint64_t bytes = 0;
    for (int i = 0; i < reuse->ntextures; i++)
        bytes += reuse->textures[i].samples ? info_of(reuse->textures[i].samples).bytes : 0;
    reuse->most_bytes = bytes > reuse->most_bytes ? bytes : reuse->most_bytes;
    for (int i = 0; i < reuse->ntextures; i++)
        if (reuse->textures[i].samples && reuse->textures[i].next <= row)
            drop(reuse, &reuse->textures[i]);
    for (int i = 0; i < count; i++) {
        const ReusedTexture *texture = &reuse->textures[uses[i].texture];
        if (texture->samples)
            make_room(reuse, info_of(texture->samples).lacked - texture->lacked, texture->next);
    }
}

void reuse_close(Reuse *reuse)
{
    for (int i = 0; i < reuse->ntextures && reuse->textures; i++)
        if (reuse->textures[i].samples)
            drop(reuse, &reuse->textures[i]);
    for (int i = 0; i < reuse->nuses; i++)
        free(reuse->uses[i].text);
    free(reuse->textures);
    free(reuse->uses);
    retex_budget_close(&reuse->budget);
}
