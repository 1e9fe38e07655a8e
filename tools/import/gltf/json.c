/* See json.h. */
#include "import/gltf/json.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/json_text.h"
#include "import/base/tell.h"

uint32_t gltf_little(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

size_t gltf_rest_of(FILE *in)
{
    struct stat info;
    const long at = ftell(in);
    return at >= 0 && fstat(fileno(in), &info) == 0 && info.st_size > at ? (size_t)(info.st_size - at) : 0;
}

/* Assimp minds neither names in other encodings than UTF-8 nor NULs at the end. Returns 1 where bytes have changed;
 * `text` ends with a NUL that is not counted. */
static int repair(char *text, size_t *length)
{
    int any = 0;
    while (*length && !text[*length - 1])
        --*length;
    for (size_t i = 0; i < *length;) {
        const int bytes = utf8_length(text + i);
        if (!bytes) {
            text[i] = '?';
            any = 1;
        }
        i += bytes ? (size_t)bytes : 1;
    }
    return any;
}

GltfText gltf_load(FILE *in)
{
    GltfText got = {NULL, 0, 0, ""};
    unsigned char head[20];
    json_error_t why;
    if (fread(head, 1, sizeof head, in) != sizeof head)
        return got;
    got.is_binary = gltf_little(head) == GLTF_MAGIC;
    if (got.is_binary && gltf_little(head + 16) != GLTF_JSON_CHUNK) /* version 1, or damaged */
        return got;
    if (!got.is_binary)
        rewind(in);
    const size_t rest = gltf_rest_of(in), said = got.is_binary ? gltf_little(head + 12) : rest;
    size_t length = said < rest ? said : rest;
    char *text = malloc(length + 1);
    length = text ? fread(text, 1, length, in) : 0;
    if (text) {
        text[length] = '\0';
        got.is_repaired = repair(text, &length);
        got.is_repaired |= got.is_binary && said % 4 != 0; /* Assimp takes the next chunk to be aligned */
        got.json = json_loadb(text, length, JSON_ALLOW_NUL, &why);
    }
    if (!got.json)
        snprintf(got.why, sizeof got.why, "%s", text ? why.text : "out of memory");
    free(text);
    return got;
}

double gltf_number(const json_t *object, const char *key, double otherwise)
{
    const json_t *value = json_object_get(object, key);
    const double x = json_is_number(value) ? json_number_value(value) : otherwise;
    return isfinite(x) ? x : otherwise;
}

int gltf_flag(const json_t *object, const char *key)
{
    return json_is_true(json_object_get(object, key)) || gltf_number(object, key, 0) != 0;
}

const json_t *gltf_extension(const json_t *of, const char *name)
{
    return json_object_get(json_object_get(of, "extensions"), name);
}

const json_t *gltf_extras(const json_t *node)
{
    return json_object_get(json_object_get(node, "extras"), "retex");
}

const char *gltf_material_name(const json_t *json, size_t index, char plain[NAME_SIZE])
{
    const char *name =
        json_string_value(json_object_get(json_array_get(json_object_get(json, "materials"), index), "name"));
    char number[32];
    snprintf(number, sizeof number, "materials[%zu]", index);
    return import_plain(name && *name ? name : number, plain);
}

int gltf_material_place(const char **name)
{
    char *end;
    const long place = strtol(*name, &end, 10);
    if (end == *name || *end != ':' || place < 0 || place > INT_MAX)
        return -1;
    *name = end + 1;
    return (int)place;
}
