/* See retex/host/denoise_data.h. */
#include <retex/host/denoise_data.h>
#include <retex/target_name.h>

#include <stdio.h>
#include <string.h>

#include "set/parts.h"

#define ROW(id, name, letters, type, kind, hit)                                                                        \
    [RETEX_FEATURE_##                                                                                                  \
        id] = {RETEX_FEATURE_PREFIX name, letters, type, RETEX_FEATURE_KIND_##kind, RETEX_FEATURE_HIT_##hit},
static const RetexFeatureInfo features[RETEX_FEATURE_COUNT] = {RETEX_FEATURE_TABLE(ROW)};

const RetexFeatureInfo *retex_feature_info(int feature)
{
    return feature >= 0 && feature < RETEX_FEATURE_COUNT ? &features[feature] : NULL;
}

void retex_cover_part_name(char name[RETEX_NAME_MAX], const char *target)
{
    char word[RETEX_NAME_MAX];
    retex_target_word(word, target);
    snprintf(name, RETEX_NAME_MAX, RETEX_FEATURE_PREFIX "cover_%.90s", word);
}

void retex_noise_part_name(char name[RETEX_NAME_MAX], const char *target, const char *signal)
{
    char word[RETEX_NAME_MAX];
    if (target) {
        retex_target_word(word, target);
        snprintf(name, RETEX_NAME_MAX, RETEX_NOISE_PREFIX "%.90s_%s", word, signal);
    } else
        snprintf(name, RETEX_NAME_MAX, RETEX_NOISE_PREFIX "%s", signal);
}

void retex_lamp_noise_part_name(char name[RETEX_NAME_MAX], const char *lamp, const char *target, const char *signal)
{
    char word[RETEX_NAME_MAX];
    retex_lamp_word(word, lamp, target);
    snprintf(name, RETEX_NAME_MAX, RETEX_NOISE_PREFIX "%.90s_%s", word, signal);
}

int retex_name_is_noise(const char *name)
{
    return strncmp(name, RETEX_NOISE_PREFIX, strlen(RETEX_NOISE_PREFIX)) == 0;
}

int retex_name_is_feature(const char *name)
{
    return strncmp(name, RETEX_FEATURE_PREFIX, strlen(RETEX_FEATURE_PREFIX)) == 0;
}
