/* See entry.h. */
#include <stdlib.h>
#include <retex/host/assert.h>
#include "light/entry.h"

int light_entries_add(LightEntries *list, const LightEntry *entry, RetexError *err)
{
    if (list->count == list->capacity) {
        const int capacity = 2 * list->capacity + 16;
        LightEntry *entries = realloc(list->entries, (size_t)capacity * sizeof *entries);
        if (!entries)
            return retex_fail(err, RETEX_ENOMEM, "out of memory for %d lights", capacity);
        list->entries = entries, list->capacity = capacity;
    }
    RETEX_ASSERT(!entry->ops->point == !entry->ops->point_density); /* a shape has both, what is none neither */
    RETEX_ASSERT(entry->is_infinite || entry->ops->bounds);         /* the tree asks for them */
    list->entries[list->count] = *entry;
    list->entries[list->count++].scene = list->scene;
    return RETEX_OK;
}
