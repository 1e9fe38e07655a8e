/* The limits that a user sets, parsed from text: see <retex/budget.h>. */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/budget.h>
#include "base/params.h"

static const char *const names[] = {"max-memory", "max-time", "max-pixels", "max-steps"};
enum { LIMIT_MEMORY, LIMIT_SECONDS, LIMIT_PIXELS, LIMIT_STEPS, LIMIT_COUNT };

static const uint64_t SAFE_MEMORY = (uint64_t)2 << 30;
static const double SAFE_SECONDS = 60;
static const long SAFE_PIXELS = 7680L * 4320;

static int fail_size(const char *text, RetexError *err)
{
    return retex_fail(err, RETEX_EPARSE, "expected a size such as 512M, 4G or a number of MB, not '%s'", text);
}

int retex_size_parse(const char *text, uint64_t *bytes, RetexError *err)
{
    char *end;
    const double number = isdigit((unsigned char)text[0]) ? strtod(text, &end) : -1;
    int shift = 20;

    if (number < 0)
        return fail_size(text, err);
    if (*end && strchr("kKmMgGtT", *end))
        shift = *end == 'k' || *end == 'K'   ? 10
                : *end == 'm' || *end == 'M' ? 20
                : *end == 'g' || *end == 'G' ? 30
                                             : 40;
    end += *end != 0 && strchr("kKmMgGtT", *end);
    const double size = ldexp(number, shift);
    if (*end || !(size < 1e18))
        return fail_size(text, err);
    *bytes = (uint64_t)size;
    return 0;
}

static int parse_seconds(const char *text, double *seconds)
{
    char *end;
    const double number = isdigit((unsigned char)text[0]) || text[0] == '.' ? strtod(text, &end) : -1;

    if (!(number > 0 && number < 1e9) || *end)
        return 0;
    *seconds = number;
    return 1;
}

static int parse_count(const char *text, long *count)
{
    char *end;

    errno = 0;
    const long number = isdigit((unsigned char)text[0]) ? strtol(text, &end, 10) : 0;
    if (number < 1 || errno || *end)
        return 0;
    *count = number;
    return 1;
}

int retex_limits_set(RetexLimits *given, const char *name, const char *value, RetexError *err)
{
    RetexLimits limits = RETEX_LIMITS_INIT;
    int which = 0, right = 0;
    uint64_t bytes = 0;

    while (which < LIMIT_COUNT && strcmp(name, names[which]) != 0)
        which++;
    if (RETEX_PARAMS_COPY(&limits, given, err))
        return RETEX_EINVAL;
    if (which == LIMIT_COUNT)
        return retex_fail(err, RETEX_ENOTFOUND, "there is no limit '%s'", name);
    if (which == LIMIT_MEMORY && (right = !retex_size_parse(value, &bytes, NULL) && bytes > 0))
        limits.memory = bytes;
    else if (which == LIMIT_SECONDS)
        right = parse_seconds(value, &limits.seconds);
    else if (which != LIMIT_MEMORY)
        right = parse_count(value, which == LIMIT_PIXELS ? &limits.pixels : &limits.steps);
    if (right) {
        limits.given |= 1u << which;
        return RETEX_PARAMS_RETURN(given, &limits, err);
    }
    return retex_fail(err, RETEX_EPARSE, "%s: expected %s, not '%s'", name,
                      which == LIMIT_MEMORY    ? "a size such as 512M, 4G or a number of MB"
                      : which == LIMIT_SECONDS ? "a number of seconds"
                                               : "a whole number from 1",
                      value);
}

int retex_limits_environment(RetexLimits *limits, RetexError *err)
{
    for (size_t i = 0; i < LIMIT_COUNT; i++) {
        char variable[32] = "RETEX_";
        RetexError why;
        for (size_t k = 0; k <= strlen(names[i]); k++)
            variable[6 + k] = (char)(names[i][k] == '-' ? '_' : toupper((unsigned char)names[i][k]));
        const char *value = getenv(variable);
        if (!value || !value[0])
            continue;
        const int code = retex_limits_set(limits, names[i], value, &why);
        if (code)
            return retex_fail(err, code, "%s:%s", variable, strchr(why.message, ':') + 1);
    }
    return 0;
}

static uint64_t default_memory(void)
{
    return retex_machine_memory() / 4 * 3; /* 0: not known */
}

void retex_limits_safe(RetexLimits *given)
{
    const uint64_t most = default_memory();
    RetexLimits limits = RETEX_LIMITS_INIT;

    (void)RETEX_PARAMS_COPY(&limits, given, NULL);
    if (!(limits.given & 1u << LIMIT_MEMORY))
        limits.memory = most && most < SAFE_MEMORY ? most : SAFE_MEMORY;
    if (!(limits.given & 1u << LIMIT_SECONDS))
        limits.seconds = SAFE_SECONDS;
    if (!(limits.given & 1u << LIMIT_PIXELS))
        limits.pixels = SAFE_PIXELS;
    (void)RETEX_PARAMS_RETURN(given, &limits, NULL);
}

void retex_budget_set_limits(RetexBudget *budget, const RetexLimits *given)
{
    RetexLimits limits = RETEX_LIMITS_INIT;

    (void)RETEX_PARAMS_COPY(&limits, given, NULL);
    retex_budget_set_memory(budget, limits.memory ? limits.memory : default_memory());
    retex_budget_set_pixels(budget, limits.pixels);
    retex_budget_set_seconds(budget, limits.seconds);
}
