#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "import/base/files.h"
#include "import/gltf/buffers.h"
#include "import/gltf/json.h"

unsigned char *gltf_extend(Bytes *data, size_t size, size_t *at)
{
    const size_t begin = (data->size + 3) / 4 * 4;
    unsigned char *bytes = size < SIZE_MAX - begin ? realloc(data->bytes, begin + size + 1) : NULL;
    if (!bytes)
        return NULL;
    memset(bytes + data->size, 0, begin - data->size);
    data->bytes = bytes;
    data->size = begin + size;
    *at = begin;
    return bytes + begin;
}

json_int_t gltf_add_view(json_t *json, size_t buffer, size_t at, size_t size)
{
    json_t *views = json_object_get(json, "bufferViews");
    if (!json_is_array(views)) {
        views = json_array();
        json_object_set_new(json, "bufferViews", views);
    }
    const json_int_t index = (json_int_t)json_array_size(views);
    const int code = json_array_append_new(views, json_pack("{s:I,s:I,s:I}", "buffer", (json_int_t)buffer, "byteOffset",
                                                            (json_int_t)at, "byteLength", (json_int_t)size));
    return code == 0 ? index : -1;
}

int gltf_get_size(const json_t *object, const char *key, size_t otherwise, size_t *size)
{
    const json_t *value = json_object_get(object, key);
    const double x = json_number_value(value);
    *size = otherwise;
    if (!value)
        return 1;
    if (!json_is_number(value) || x != floor(x) || x < 0 || x > UINT32_MAX)
        return 0;
    *size = (size_t)x;
    return 1;
}

static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static int digit_of(char c)
{
    const char *at = c ? strchr(digits, c) : NULL;
    return at ? (int)(at - digits) : -1;
}

static Bytes decode_base64(const char *text)
{
    Bytes data = {malloc(strlen(text) / 4 * 3 + 3), 0};
    unsigned bits = 0, held = 0;
    for (; data.bytes && digit_of(*text) >= 0; text++) {
        bits = (bits << 6 | (unsigned)digit_of(*text)) & 0xffff;
        held += 6;
        if (held >= 8) {
            held -= 8;
            data.bytes[data.size++] = (unsigned char)(bits >> held);
        }
    }
    return data;
}

char *gltf_encode_base64(const Bytes *data, const char *before)
{
    char *text = malloc(strlen(before) + (data->size + 2) / 3 * 4 + 1), *to = text;
    if (!text)
        return NULL;
    to = stpcpy(to, before);
    for (size_t i = 0; i < data->size; i += 3) {
        const size_t left = data->size - i;
        const unsigned char *b = data->bytes + i;
        const unsigned bits = (unsigned)b[0] << 16 | (left > 1 ? (unsigned)b[1] << 8 : 0) | (left > 2 ? b[2] : 0u);
        for (size_t k = 0; k < 4; k++)
            *to++ = k <= left ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
    *to = '\0';
    return text;
}

static Bytes read_named(Import *import, const char *name)
{
    Bytes data = {NULL, 0};
    char path[PATH_MAX];
    int found = 0, descriptor = -1;
    struct stat info;
    if (files_find(import, name, path, &found, NULL) || !found ||
        retex_access_open(&import->access, path, &descriptor, NULL))
        return data;
    FILE *in = fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) ? fdopen(descriptor, "rb") : NULL;
    data.bytes = in ? malloc((size_t)info.st_size + 1) : NULL;
    if (data.bytes)
        data.size = fread(data.bytes, 1, (size_t)info.st_size, in);
    if (in)
        fclose(in);
    else
        close(descriptor);
    return data;
}

void gltf_buffers_read_inside(GltfBuffers *b)
{
    unsigned char head[8];
    if (!b->is_binary || b->inside_is_read)
        return;
    b->inside_is_read = 1;
    if (fread(head, 1, sizeof head, b->in) != sizeof head || gltf_little(head + 4) != GLTF_BINARY_CHUNK)
        return;
    const size_t said = gltf_little(head), left = gltf_rest_of(b->in), size = said < left ? said : left;
    b->inside.bytes = malloc(size + 1);
    b->inside.size = b->inside.bytes ? fread(b->inside.bytes, 1, size, b->in) : 0;
}

const Bytes *gltf_buffer(GltfBuffers *b, size_t index)
{
    const json_t *buffers = json_object_get(b->json, "buffers");
    const char *uri = json_string_value(json_object_get(json_array_get(buffers, index), "uri")), *comma;
    if (b->decoded.bytes && index == b->decoded_index)
        return &b->decoded;
    if (index >= json_array_size(buffers))
        return NULL;
    if (!uri) {
        gltf_buffers_read_inside(b);
        return index == 0 && b->inside.bytes ? &b->inside : NULL;
    }
    if (!b->named) {
        b->count = json_array_size(buffers);
        b->named = calloc(b->count, sizeof *b->named);
    }
    Bytes *data = b->named && index < b->count ? &b->named[index] : NULL;
    if (data && !data->bytes) {
        const int is_inside = strncmp(uri, "data:", 5) == 0;
        comma = is_inside ? strstr(uri, ";base64,") : NULL;
        *data = comma ? decode_base64(comma + 8) : is_inside ? (Bytes){NULL, 0} : read_named(b->import, uri);
    }
    return data && data->bytes ? data : NULL;
}

const unsigned char *gltf_bytes(GltfBuffers *b, size_t index, size_t at, size_t size)
{
    const Bytes *buffer = gltf_buffer(b, index);
    return buffer && at <= buffer->size && size <= buffer->size - at ? buffer->bytes + at : NULL;
}

void gltf_buffers_free(GltfBuffers *b)
{
    for (size_t i = 0; i < b->count && b->named; i++)
        free(b->named[i].bytes);
    free(b->named);
    free(b->inside.bytes);
    free(b->decoded.bytes);
}
