/* Building JSON: where jansson's own calls would drop what there was no memory for, all of it becomes NULL here, as
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

/* Take over a value, which may be NULL, into an object, which may have become so. */
static inline void retex_json_put(json_t **object, const char *key, json_t *value)
{
    retex_json_keep(object, json_object_set_new(*object, key, value));
}

/* The same into an array. */
static inline void retex_json_add(json_t **array, json_t *value)
{
    retex_json_keep(array, json_array_append_new(*array, value));
}

#endif
