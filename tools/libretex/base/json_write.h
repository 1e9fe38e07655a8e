/* Building JSON. jansson's own calls drop a value that there is no memory for; with these the whole becomes NULL, as
 * with json_pack, and so does its text. Private to libretex. */
#ifndef RETEX_BASE_JSON_WRITE_H
#define RETEX_BASE_JSON_WRITE_H

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

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

typedef struct RetexJsonText {
    char *bytes;
    size_t used, capacity;
    int failed;
} RetexJsonText;

static inline int retex_json_append(const char *piece, size_t length, void *context)
{
    RetexJsonText *text = context;
    if (text->capacity - text->used <= length) {
        const size_t capacity = 2 * text->capacity + length + 256;
        char *bytes = text->failed ? NULL : realloc(text->bytes, capacity);
        if (!bytes) {
            text->failed = 1;
            return -1;
        }
        text->bytes = bytes;
        text->capacity = capacity;
    }
    memcpy(text->bytes + text->used, piece, length);
    text->used += length;
    text->bytes[text->used] = '\0';
    return 0;
}

/* As json_dumps, which leaves out keys that there is no memory for, without a word: NULL where memory is short. */
static inline char *retex_json_text(const json_t *root, size_t style)
{
    RetexJsonText text = {0};
    if (json_dump_callback(root, retex_json_append, &text, style) == 0 && !text.failed)
        return text.bytes;
    free(text.bytes);
    return NULL;
}

#endif
