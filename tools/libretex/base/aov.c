/* See retex/host/aov.h. */
#include <retex/host/aov.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <retex/nearest.h>

#define ROW(id, ...) [RETEX_AOV_##id] = {__VA_ARGS__},
static const RetexAovInfo rows[RETEX_AOV_COUNT] = {RETEX_AOV_TABLE(ROW)};

const RetexAovInfo *retex_aov_info(int aov)
{
    return aov >= 0 && aov < RETEX_AOV_COUNT ? &rows[aov] : NULL;
}

static int find(const char *name, size_t length)
{
    for (int k = 0; k < RETEX_AOV_COUNT; k++)
        if (strlen(rows[k].name) == length && strncmp(rows[k].name, name, length) == 0)
            return k;
    return -1;
}

int retex_aov_find(const char *name)
{
    return find(name, strlen(name));
}

int retex_aov_is_color(RetexAov aov)
{
    return rows[aov].shown == RETEX_AOV_COLOR || rows[aov].shown == RETEX_AOV_EXPOSED;
}

int retex_aov_channels(unsigned aovs)
{
    size_t sum = 0;

    for (int k = 0; k < RETEX_AOV_COUNT; k++)
        sum += aovs >> k & 1 ? strlen(rows[k].letters) : 0;
    return (int)sum;
}

static int fail_unknown(const char *option, const char *name, size_t length, RetexError *err)
{
    char word[RETEX_NEAREST_MAX + 1], meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {word, NULL, 0};

    snprintf(word, sizeof word, "%.*s", (int)length, name);
    retex_nearest_try(&nearest, "beauty");
    for (int k = 0; k < RETEX_AOV_COUNT; k++)
        retex_nearest_try(&nearest, rows[k].name);
    return retex_fail(err, RETEX_EPARSE, "%s: expected " RETEX_AOV_NAMES ", not `%.*s`%s", option, (int)length, name,
                      retex_meant(nearest.best, meant));
}

int retex_aov_parse(unsigned *aovs, const char *list, const char *option, RetexError *err)
{
    unsigned found = 0;

    for (const char *name = list;; name++) {
        const size_t length = strcspn(name, ",");
        const int aov = find(name, length), is_beauty = length == 6 && strncmp(name, "beauty", 6) == 0;
        if (aov < 0 && !is_beauty)
            return fail_unknown(option, name, length, err);
        found |= is_beauty ? 0 : 1u << aov;
        name += length;
        if (!*name)
            break;
    }
    *aovs |= found;
    return RETEX_OK;
}
