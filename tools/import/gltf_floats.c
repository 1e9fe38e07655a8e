/* Integers in glTF files: positions, normals and UV may be stored as numbers of 8 or 16 bits, the first two by
 * KHR_mesh_quantization. Assimp takes their bytes for floats. Such files are given to it with accessors of floats. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "import/internal.h"

enum { BYTE = 5120, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, FLOAT = 5126 };

typedef struct Data {
    unsigned char *bytes;
    size_t size;
} Data;

typedef struct Converter {
    Import *import;
    json_t *json;
    FILE *in; /* where a .glb has its binary chunk next */
    int is_binary;
    Data inside;   /* that chunk, once it is read */
    Data *buffers; /* of the file, where they were needed */
    size_t nbuffers;
    Data floats; /* the new buffer */
} Converter;

/* ---- buffers ---- */

static int digit_of(char c)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = c ? strchr(digits, c) : NULL;
    return at ? (int)(at - digits) : -1;
}

static Data decode_base64(const char *text)
{
    Data data = {malloc(strlen(text) / 4 * 3 + 3), 0};
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

static char *encode_base64(const Data *data, const char *before)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
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

static Data read_named(Import *import, const char *name)
{
    Data data = {NULL, 0};
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

static void read_inside(Converter *c)
{
    unsigned char head[8];
    if (!c->is_binary || c->inside.bytes || fread(head, 1, sizeof head, c->in) != sizeof head ||
        gltf_little(head + 4) != GLTF_BINARY_CHUNK)
        return;
    c->inside.bytes = malloc((size_t)gltf_little(head) + 1);
    c->inside.size = c->inside.bytes ? fread(c->inside.bytes, 1, gltf_little(head), c->in) : 0;
}

static const Data *buffer_of(Converter *c, size_t index)
{
    const json_t *buffers = json_object_get(c->json, "buffers");
    const char *uri = json_string_value(json_object_get(json_array_get(buffers, index), "uri")), *comma;
    if (index >= json_array_size(buffers))
        return NULL;
    if (!uri) {
        read_inside(c);
        return index == 0 && c->inside.bytes ? &c->inside : NULL;
    }
    if (!c->buffers) {
        c->nbuffers = json_array_size(buffers);
        c->buffers = calloc(c->nbuffers, sizeof *c->buffers);
    }
    Data *data = c->buffers && index < c->nbuffers ? &c->buffers[index] : NULL;
    if (data && !data->bytes) {
        const int is_inside = strncmp(uri, "data:", 5) == 0;
        comma = is_inside ? strstr(uri, ";base64,") : NULL;
        *data = comma ? decode_base64(comma + 8) : is_inside ? (Data){NULL, 0} : read_named(c->import, uri);
    }
    return data && data->bytes ? data : NULL;
}

/* ---- accessors ---- */

/* Not negative, or `otherwise` where it is not there. 0 where it is no such number. */
static int get_size(const json_t *object, const char *key, size_t otherwise, size_t *size)
{
    const json_t *value = json_object_get(object, key);
    *size = otherwise;
    if (!value)
        return 1;
    if (!json_is_integer(value) || json_integer_value(value) < 0 || json_integer_value(value) > INT32_MAX)
        return 0;
    *size = (size_t)json_integer_value(value);
    return 1;
}

static float number_at(const unsigned char *at, size_t type, int is_normalized)
{
    const int word = at[0] | (type >= SHORT ? at[1] << 8 : 0);
    const int value = type == BYTE ? (int8_t)word : type == SHORT ? (int16_t)word : word;
    const float most = type == BYTE ? 127 : type == UNSIGNED_BYTE ? 255 : type == SHORT ? 32767 : 65535;
    return is_normalized ? fmaxf((float)value / most, -1) : (float)value;
}

static int append_floats(Data *floats, const unsigned char *from, size_t count, size_t width, size_t stride,
                         size_t type, int is_normalized)
{
    unsigned char *bytes = realloc(floats->bytes, floats->size + count * width * sizeof(float));
    if (!bytes)
        return 0;
    floats->bytes = bytes;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < width; k++) {
            const float x = number_at(from + i * stride + k * (type >= SHORT ? 2 : 1), type, is_normalized);
            uint32_t word;
            memcpy(&word, &x, sizeof word);
            for (int byte = 0; byte < 4; byte++)
                bytes[floats->size++] = (unsigned char)(word >> 8 * byte);
        }
    return 1;
}

/* The bytes of an accessor of integers: 0 where it is something else, or not within its buffer. */
static int convert(Converter *c, json_t *accessor)
{
    const char *kind = json_string_value(json_object_get(accessor, "type"));
    const size_t width = kind && strcmp(kind, "VEC2") == 0 ? 2 : kind && strcmp(kind, "VEC3") == 0 ? 3 : 4;
    size_t type, view_index, buffer_index, count, at, view_at, stride, view_size;
    if (!get_size(accessor, "componentType", 0, &type) || type < BYTE || type > UNSIGNED_SHORT || !kind ||
        strncmp(kind, "VEC", 3) != 0 || json_object_get(accessor, "sparse") ||
        !get_size(accessor, "bufferView", SIZE_MAX, &view_index) || !get_size(accessor, "count", 0, &count) ||
        !get_size(accessor, "byteOffset", 0, &at))
        return 0;
    const json_t *view = json_array_get(json_object_get(c->json, "bufferViews"), view_index);
    const size_t element = width * (type >= SHORT ? 2 : 1);
    if (!get_size(view, "buffer", SIZE_MAX, &buffer_index) || !get_size(view, "byteOffset", 0, &view_at) ||
        !get_size(view, "byteStride", element, &stride) || !get_size(view, "byteLength", 0, &view_size))
        return 0;
    const Data *buffer = buffer_of(c, buffer_index);
    if (!buffer || count == 0 || stride < element || view_at > buffer->size || view_size > buffer->size - view_at ||
        at > view_size || element > view_size - at || count - 1 > (view_size - at - element) / stride)
        return 0;
    const size_t begin = c->floats.size;
    json_t *views = json_object_get(c->json, "bufferViews"), *buffers = json_object_get(c->json, "buffers");
    if (!append_floats(&c->floats, buffer->bytes + view_at + at, count, width, stride, type,
                       json_is_true(json_object_get(accessor, "normalized"))))
        return 0;
    json_array_append_new(views,
                          json_pack("{s:I,s:I,s:I}", "buffer", (json_int_t)json_array_size(buffers), "byteOffset",
                                    (json_int_t)begin, "byteLength", (json_int_t)(c->floats.size - begin)));
    json_object_set_new(accessor, "bufferView", json_integer((json_int_t)json_array_size(views) - 1));
    json_object_set_new(accessor, "byteOffset", json_integer(0));
    json_object_set_new(accessor, "componentType", json_integer(FLOAT));
    static const char *const of_integers[] = {"normalized", "min", "max"};
    for (size_t i = 0; i < sizeof of_integers / sizeof *of_integers; i++)
        json_object_del(accessor, of_integers[i]);
    return 1;
}

static int convert_attributes(Converter *c, json_t *attributes)
{
    static const char *const names[] = {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_"};
    const char *key;
    json_t *index;
    int any = 0;
    json_object_foreach(attributes, key,
                        index) for (size_t i = 0; i < sizeof names / sizeof *names;
                                    i++) if (strncmp(key, names[i], strlen(names[i])) == 0 && json_is_integer(index))
        any |= convert(c, json_array_get(json_object_get(c->json, "accessors"), (size_t)json_integer_value(index)));
    return any;
}

static int convert_all(Converter *c)
{
    const json_t *meshes = json_object_get(c->json, "meshes");
    int any = 0;
    for (size_t i = 0; i < json_array_size(meshes); i++) {
        const json_t *primitives = json_object_get(json_array_get(meshes, i), "primitives");
        for (size_t k = 0; k < json_array_size(primitives); k++) {
            const json_t *primitive = json_array_get(primitives, k), *targets = json_object_get(primitive, "targets");
            any |= convert_attributes(c, json_object_get(primitive, "attributes"));
            for (size_t t = 0; t < json_array_size(targets); t++)
                any |= convert_attributes(c, json_array_get(targets, t));
        }
    }
    return any;
}

/* ---- the file ---- */

static void put_word(FILE *out, size_t word)
{
    for (int byte = 0; byte < 4; byte++)
        fputc((int)(word >> 8 * byte & 255), out);
}

/* Written as the file was: Assimp goes by the ending of its name. */
static int write_file(const Converter *c, FILE *out)
{
    char *uri = encode_base64(&c->floats, "data:application/octet-stream;base64,");
    json_t *buffers = json_object_get(c->json, "buffers");
    if (!uri || json_array_append_new(
                    buffers, json_pack("{s:I,s:s}", "byteLength", (json_int_t)c->floats.size, "uri", uri)) != 0) {
        free(uri);
        return 0;
    }
    free(uri);
    char *text = json_dumps(c->json, JSON_COMPACT);
    const size_t length = text ? strlen(text) : 0, padded = (length + 3) / 4 * 4, rest = (c->inside.size + 3) / 4 * 4;
    if (c->is_binary) {
        put_word(out, GLTF_MAGIC), put_word(out, 2), put_word(out, 12 + 8 + padded + (rest ? 8 + rest : 0));
        put_word(out, padded), put_word(out, GLTF_JSON_CHUNK);
    }
    fwrite(text ? text : "", 1, length, out);
    for (size_t i = length; i < padded; i++)
        fputc(' ', out);
    if (c->is_binary && rest) {
        put_word(out, rest), put_word(out, GLTF_BINARY_CHUNK);
        fwrite(c->inside.bytes, 1, c->inside.size, out);
        for (size_t i = c->inside.size; i < rest; i++)
            fputc(0, out);
    }
    free(text);
    return length > 0 && fflush(out) == 0 && !ferror(out);
}

FILE *gltf_with_floats(Import *import, FILE *in)
{
    Converter c = {.import = import, .in = in};
    FILE *out = NULL;
    c.json = gltf_load(in, &c.is_binary);
    if (c.json && convert_all(&c) && (out = tmpfile())) {
        read_inside(&c);
        if (!write_file(&c, out)) {
            fclose(out);
            out = NULL;
        }
    }
    for (size_t i = 0; i < c.nbuffers && c.buffers; i++)
        free(c.buffers[i].bytes);
    free(c.buffers);
    free(c.inside.bytes);
    free(c.floats.bytes);
    json_decref(c.json);
    rewind(out ? out : in);
    if (out)
        fclose(in);
    return out ? out : in;
}
