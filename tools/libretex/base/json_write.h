/* Building JSON. jansson's own calls drop a value that there is no memory for; with these the whole becomes NULL, as
 * with json_pack, and json_dumps of NULL is NULL. Private to libretex. */
#ifndef RETEX_BASE_JSON_WRITE_H
#define RETEX_BASE_JSON_WRITE_H

#include <jansson.h>

static inline void retex_json_keep(json_t **whole, int failed)
{
    if (!failed)
        return;
    json_decref(*whole);
    *whole = NULL;
}

/* Put a value, which may be NULL, into an object, which may have become NULL; takes ownership of the value. */
static inline void retex_json_put(json_t **object, const char *key, json_t *value)
{
    retex_json_keep(object, json_object_set_new(*object, key, value));
}

/* Append a value to an array in the same way. */
static inline void retex_json_add(json_t **array, json_t *value)
{
    retex_json_keep(array, json_array_append_new(*array, value));
}

#endif
