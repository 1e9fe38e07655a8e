/* Views of buffers that EXT_meshopt_compression has compressed. */
#include <string.h>

#include <meshoptimizer.h>

#include "import/gltf/buffers.h"
#include "import/gltf/decode.h"
#include "import/gltf/json.h"

static const char extension[] = "EXT_meshopt_compression", newer[] = "KHR_meshopt_compression";

typedef enum Mode { ATTRIBUTES, TRIANGLES, INDICES, MODES } Mode;
typedef enum Filter { NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL, FILTERS } Filter;

/* What the extension says of a view. */
typedef struct Stream {
    Mode mode;
    Filter filter;
    size_t buffer, at, size; /* of the compressed bytes */
    size_t count, stride;    /* of the elements */
} Stream;

/* The place of a property's text among those that there are; `otherwise` where it is not there; `count` if it is
 * none of them. */
static int choose(const json_t *json, const char *key, const char *const *texts, int count, int otherwise)
{
    const json_t *value = json_object_get(json, key);
    const char *text = json_string_value(value);
    int i = 0;
    while (i < count && (!text || strcmp(text, texts[i]) != 0))
        i++;
    return value ? i : otherwise;
}

/* The sizes of elements that a mode and a filter have. */
static int fits(const Stream *s)
{
    if (s->mode != ATTRIBUTES)
        return (s->stride == 2 || s->stride == 4) && s->filter == NONE && (s->mode == INDICES || s->count % 3 == 0);
    if (s->stride == 0 || s->stride > 256 || s->stride % 4 != 0)
        return 0;
    return s->filter == OCTAHEDRAL ? s->stride == 4 || s->stride == 8 : s->filter == QUATERNION ? s->stride == 8 : 1;
}

/* No stream of that few bytes holds so many elements: two bits stand for 16 bytes at least, and one byte for an index
 * or a triangle. */
static int is_plausible(const Stream *s)
{
    return s->mode == ATTRIBUTES  ? s->count <= 64 * s->size / s->stride
           : s->mode == TRIANGLES ? s->count / 3 <= s->size
                                  : s->count <= s->size;
}

static int read_stream(const json_t *json, Stream *s)
{
    static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
    static const char *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    s->mode = (Mode)choose(json, "mode", modes, MODES, MODES);
    s->filter = (Filter)choose(json, "filter", filters, FILTERS, NONE);
    return s->mode < MODES && s->filter < FILTERS && gltf_get_size(json, "buffer", SIZE_MAX, &s->buffer) &&
           gltf_get_size(json, "byteOffset", 0, &s->at) && gltf_get_size(json, "byteLength", 0, &s->size) &&
           gltf_get_size(json, "byteStride", 0, &s->stride) && gltf_get_size(json, "count", 0, &s->count) && fits(s) &&
           is_plausible(s) && s->count > 0;
}

static int decode(const Stream *s, const unsigned char *from, unsigned char *to)
{
    if (s->mode == TRIANGLES)
        return meshopt_decodeIndexBuffer(to, s->count, s->stride, from, s->size) == 0;
    if (s->mode == INDICES)
        return meshopt_decodeIndexSequence(to, s->count, s->stride, from, s->size) == 0;
    if (meshopt_decodeVertexBuffer(to, s->count, s->stride, from, s->size) != 0)
        return 0;
    if (s->filter == OCTAHEDRAL)
        meshopt_decodeFilterOct(to, s->count, s->stride);
    else if (s->filter == QUATERNION)
        meshopt_decodeFilterQuat(to, s->count, s->stride);
    else if (s->filter == EXPONENTIAL)
        meshopt_decodeFilterExp(to, s->count, s->stride);
    return 1;
}

static void decode_view(GltfDecode *d, json_t *view, size_t index)
{
    json_t *extensions = json_object_get(view, "extensions");
    const json_t *json = json_object_get(extensions, extension);
    Stream s;
    size_t at;
    if (!json)
        return;
    const int is_sound = read_stream(json, &s);
    const unsigned char *from = is_sound ? gltf_bytes(d->buffers, s.buffer, s.at, s.size) : NULL;
    unsigned char *to = from ? gltf_extend(&d->buffers->decoded, s.count * s.stride, &at) : NULL;
    if (!to || !decode(&s, from, to)) {
        snprintf(d->refused, sizeof d->refused, "bufferViews[%zu], compressed by %s: %s", index, extension,
                 !is_sound ? "what it says of its data cannot be"
                 : !from   ? "its data do not lie within their buffer"
                 : !to     ? GLTF_NO_MEMORY
                           : "its data are damaged, or of a newer version");
        return;
    }
    json_object_set_new(view, "buffer", json_integer((json_int_t)d->buffers->decoded_index));
    json_object_set_new(view, "byteOffset", json_integer((json_int_t)at));
    json_object_set_new(view, "byteLength", json_integer((json_int_t)(s.count * s.stride)));
    json_object_del(extensions, extension);
    d->any = 1;
}

/* Buffers that stand in for the decoded bytes and have none: nothing asks for them any more. */
static void empty_fallbacks(const json_t *json)
{
    const json_t *buffers = json_object_get(json, "buffers");
    for (size_t i = 0; i < json_array_size(buffers); i++) {
        json_t *buffer = json_array_get(buffers, i);
        if (json_object_get(buffer, "uri") ||
            !json_is_true(json_object_get(gltf_extension(buffer, extension), "fallback")))
            continue;
        json_object_del(buffer, "extensions");
        json_object_set_new(buffer, "byteLength", json_integer(4));
        json_object_set_new(buffer, "uri", json_string("data:application/octet-stream;base64,AAAAAA=="));
    }
}

void gltf_decode_views(GltfDecode *d)
{
    const json_t *views = json_object_get(d->json, "bufferViews");
    for (size_t i = 0; i < json_array_size(views) && !d->refused[0]; i++) {
        json_t *view = json_array_get(views, i);
        if (gltf_extension(view, newer))
            snprintf(d->refused, sizeof d->refused,
                     "bufferViews[%zu] is compressed by %s, which cannot be read: compress it by %s, or not at all", i,
                     newer, extension);
        else
            decode_view(d, view, i);
    }
    if (d->any)
        empty_fallbacks(d->json);
}
