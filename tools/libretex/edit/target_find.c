/* The target that a name means, or what would be right. See retex/edit.h. */
#include <retex/edit.h>

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <retex/nearest.h>

#include "edit/statement.h"

int retex_target_find(int *target, const RetexTargetNames *names, const char *name, RetexError *err)
{
    char all[sizeof err->message] = "", meant[RETEX_MEANT_SIZE];
    const char *dot = strrchr(name, '.');
    RetexNearest nearest = {name, NULL, 0};
    *target = retex_target_index(names, name);
    if (*target >= 0)
        return RETEX_OK;
    for (int i = 0; i < names->count; i++) {
        const size_t used = strlen(all), length = dot ? (size_t)(dot - name) : 0;
        snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "", names->names[i]);
        retex_nearest_try(&nearest, names->names[i]);
        if (length && strlen(names->names[i]) == length && strncasecmp(names->names[i], name, length) == 0)
            return retex_statement_unknown(dot + 1, err);
    }
    if (!names->count)
        return retex_fail(err, RETEX_ENOTFOUND, "no target is called '%s': %s has no targets%s", name, names->of,
                          names->advice);
    return retex_fail(err, RETEX_ENOTFOUND, "no target is called '%s'; %s has %.700s%s", name, names->of, all,
                      nearest.best ? retex_meant(nearest.best, meant) : names->advice);
}
