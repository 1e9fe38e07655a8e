/* Textures laid on a set: see <retex/laid.h>. What is filtered into them is in retexture/sample.c. */
#include "set/laid.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <jansson.h>
#include <retex/host/assert.h>
#include <retex/host/set_build.h>

#include "base/part_name.h"
#include "set/parts.h"
#include "set/source.h"

/* ---- parts ---- */

/* Where a footprint or a target refers to a part of a texture: 1 + the part, or 0. */
static int *reference_to(RetexSet *set, int target, int footprint, int finish)
{
    RETEX_ASSERT(footprint >= -1 && footprint < set->nfootprints && finish < RETEX_FINISHES_MAX);
    if (footprint < 0)
        return &set->targets[target].gates;
    return finish < 0 ? &set->footprints[footprint].sampled : &set->footprints[footprint].finished[finish];
}

/* A name that no part of the set has; names of targets are free, names of parts are not. */
static void choose_name(char name[RETEX_NAME_MAX], const RetexSet *set, int target, int footprint, int finish)
{
    char of[64], what[32] = "";
    const int hit = footprint < 0 ? 1 : set->footprints[footprint].hit;
    snprintf(of, sizeof of, "%.63s", set->targets[target].name);
    for (char *letter = of; *letter; letter++)
        if (!retex_name_is_valid((char[]){*letter, 0}))
            *letter = '_';
    if (finish >= 0)
        snprintf(what, sizeof what, "_finish%d", finish);
    else if (footprint < 0)
        snprintf(what, sizeof what, "_gate");
    snprintf(name, RETEX_NAME_MAX, "sample_%s%s_%d", of, what, hit);
    for (int number = 2; retex_set_find_part(set, name) >= 0; number++)
        snprintf(name, RETEX_NAME_MAX, "sample_%s%s_%d_%d", of, what, hit, number);
}

int retex_set_add_laid(RetexSet *set, int target, int footprint, int finish, int *part, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    const int scale = footprint < 0 ? 1 : retex_set_footprint_scale(set, footprint);
    RETEX_ASSERT(!*reference_to(set, target, footprint, finish) && scale > 0);
    choose_name(name, set, target, footprint, finish);
    const int code = retex_set_add_absent(set, name, "RGB", RETEX_FLOAT, (set->width + scale - 1) / scale,
                                          (set->height + scale - 1) / scale, part, err);
    if (!code)
        *reference_to(set, target, footprint, finish) = 1 + *part;
    return code;
}

static void remove_laid(RetexSet *set, int *reference)
{
    const int part = *reference - 1;
    *reference = 0;
    if (part >= 0)
        retex_set_remove_part(set, part);
}

void retex_set_lift(RetexSet *set, int target)
{
    for (int t = 0; t < set->ntargets; t++) {
        if (target >= 0 && t != target)
            continue;
        for (int f = 0; f < set->nfootprints; f++)
            for (int k = -1; k < RETEX_FINISHES_MAX && set->footprints[f].target == t; k++)
                remove_laid(set, reference_to(set, t, f, k));
        remove_laid(set, &set->targets[t].gates);
        set->targets[t].texture[0] = '\0';
    }
}

int retex_target_has_laid(const RetexSet *set, int target)
{
    int found = 0;
    for (int f = 0; f < set->nfootprints; f++)
        found |= set->footprints[f].target == target && set->footprints[f].sampled;
    return found;
}

int retex_set_has_laid(const RetexSet *set)
{
    int found = 0;
    for (int t = 0; t < set->ntargets; t++)
        found |= retex_target_has_laid(set, t);
    return found;
}

int retex_set_check_bare(const RetexSet *set, const char *what, RetexError *err)
{
    if (set->is_samples)
        return retex_fail(err, RETEX_EINVAL, "samples are no set: %s cannot be made of them", what);
    for (int t = 0; t < set->ntargets; t++)
        if (retex_target_has_laid(set, t))
            return retex_fail(err, RETEX_EINVAL, "a texture is laid on %s: %s is made of the set without it",
                              set->targets[t].name, what);
    return RETEX_OK;
}

/* ---- from one set to another ---- */

/* Checks that both are of one render. */
static int check_same(const RetexSet *set, const RetexSet *from, RetexError *err)
{
    if (from->width != set->width || from->height != set->height)
        return retex_fail(err, RETEX_EINVAL, "the samples have %d x %d pixels, the set %d x %d", from->width,
                          from->height, set->width, set->height);
    if (from->ntargets != set->ntargets)
        return retex_fail(err, RETEX_EINVAL, "the samples know %d targets, the set %d", from->ntargets, set->ntargets);
    if (from->id && set->id && from->id != set->id)
        return retex_fail(err, RETEX_EINVAL, "the samples were made for another render of these targets");
    for (int i = 0; i < set->ntargets; i++)
        if (strcmp(from->targets[i].name, set->targets[i].name) != 0)
            return retex_fail(err, RETEX_EINVAL, "the samples are for target %s where the set has %s",
                              from->targets[i].name, set->targets[i].name);
    if (from->nfootprints != set->nfootprints)
        return retex_fail(err, RETEX_EINVAL, "the samples have %d footprints, the set %d", from->nfootprints,
                          set->nfootprints);
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *own = &set->footprints[i], *other = &from->footprints[i];
        if (other->target != own->target || other->hit != own->hit)
            return retex_fail(err, RETEX_EINVAL, "footprint %d of the samples is another one than the set's", i);
        if (other->sampled && own->uv >= 0 &&
            retex_set_footprint_scale(from, i) != retex_set_scale(set, &set->parts[own->uv].image))
            return retex_fail(err, RETEX_EINVAL, "samples of footprint %d have the wrong size", i);
        for (int k = set->targets[own->target].nfinishes; k < RETEX_FINISHES_MAX; k++)
            if (other->finished[k])
                return retex_fail(err, RETEX_EINVAL, "the samples have finish %d of footprint %d", k, i);
    }
    return RETEX_OK;
}

/* Moves the part to which `from` refers, and lets `set` refer to it in the same way. */
static int move_laid(RetexSet *set, RetexSet *from, int target, int footprint, int finish, RetexError *err)
{
    const int number = *reference_to(from, target, footprint, finish) - 1;
    int part;
    const int code = number < 0 ? RETEX_OK : retex_set_add_laid(set, target, footprint, finish, &part, err);
    if (number < 0 || code)
        return code;
    RetexPart *to = &set->parts[part], *of = &from->parts[number];
    to->crc = of->crc;
    to->image = of->image;
    retex_part_set_source(to, of->source, of->source_part);
    of->image.pixels = NULL;
    *reference_to(from, target, footprint, finish) = 0;
    return RETEX_OK;
}

static int lay_target(RetexSet *set, RetexSet *from, int target, RetexError *err)
{
    int code = RETEX_OK;
    retex_set_lift(set, target);
    for (int f = 0; f < set->nfootprints; f++)
        for (int k = -1; k < RETEX_FINISHES_MAX && set->footprints[f].target == target && !code; k++)
            code = move_laid(set, from, target, f, k, err);
    if (!code)
        code = move_laid(set, from, target, -1, -1, err);
    if (code)
        retex_set_lift(set, target);
    else
        memcpy(set->targets[target].texture, from->targets[target].texture, sizeof set->targets[target].texture);
    return code;
}

int retex_set_lay(RetexSet *set, RetexSet *from, RetexError *err)
{
    int code = check_same(set, from, err);
    for (int t = 0; t < set->ntargets && !code; t++)
        if (retex_target_has_laid(from, t))
            code = lay_target(set, from, t, err);
    return code;
}

/* ---- the file of their set ---- */

static int fail_refer(const char *path, const char *why, RetexError *err)
{
    return retex_fail(err, RETEX_EINVAL, "%s cannot be referred to: %s", path, why);
}

int retex_set_refer(RetexSet *set, const char *path, RetexError *err)
{
    char resolved[PATH_MAX];
    struct stat info;

    if (!path) {
        set->refers = (RetexSetReference){.bytes = 0};
        return RETEX_OK;
    }
    if (strcmp(path, "-") == 0)
        return fail_refer("standard input", "it is no file", err);
    if (!realpath(path, resolved) || stat(resolved, &info) != 0)
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", path, strerror(errno));
    if (!S_ISREG(info.st_mode) || !set->file_bytes || !set->file_sum)
        return fail_refer(path, "it is no regular file", err);
    json_t *name = json_string(resolved);
    const int is_utf8 = name != NULL;
    json_decref(name);
    if (!is_utf8 || strlen(resolved) >= sizeof set->refers.path)
        return fail_refer(path, "its name is not UTF-8, or too long", err);
    memcpy(set->refers.path, resolved, strlen(resolved) + 1);
    set->refers.bytes = set->file_bytes;
    set->refers.crc = set->file_sum;
    return RETEX_OK;
}

const char *retex_set_reference(const RetexSet *set)
{
    return set->refers.path;
}
