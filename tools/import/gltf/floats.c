/* Integers in glTF files: positions, normals and UV may be stored as numbers of 8 or 16 bits, the first two by
 * KHR_mesh_quantization. Assimp takes their bytes for floats. They become accessors of floats, and are sparse no
 * more. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/gltf/buffers.h"
#include "import/gltf/floats.h"

enum { BYTE = 5120, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5125, FLOAT };

enum { MOST_ZEROS = 1 << 26 }; /* bytes of an accessor without a view */

typedef enum Change { KEPT, CONVERTED, REFUSED } Change;

/* Elements within a buffer. */
typedef struct View {
    const unsigned char *bytes;
    size_t stride;
} View;

/* What the numbers of an accessor are. */
typedef struct Numbers {
    size_t type, width, count;
    int is_normalized;
} Numbers;

static size_t size_of(size_t type)
{
    return type == BYTE || type == UNSIGNED_BYTE ? 1 : type == SHORT || type == UNSIGNED_SHORT ? 2 : 4;
}

static uint32_t word_at(const unsigned char *at, size_t size)
{
    uint32_t word = 0;
    for (size_t i = 0; i < size; i++)
        word |= (uint32_t)at[i] << 8 * i;
    return word;
}

/* The bits of the float. */
static uint32_t number_at(const unsigned char *at, const Numbers *numbers)
{
    const size_t type = numbers->type;
    const uint32_t word = word_at(at, size_of(type));
    if (type == FLOAT)
        return word;
    const int value = type == BYTE ? (int8_t)word : type == SHORT ? (int16_t)word : (int)word;
    const float most = type == BYTE ? 127 : type == UNSIGNED_BYTE ? 255 : type == SHORT ? 32767 : 65535;
    const float x = numbers->is_normalized ? fmaxf((float)value / most, -1) : (float)value;
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static void put_element(unsigned char *to, const unsigned char *from, const Numbers *numbers)
{
    for (size_t k = 0; k < numbers->width; k++) {
        const uint32_t bits = number_at(from + k * size_of(numbers->type), numbers);
        for (int byte = 0; byte < 4; byte++)
            *to++ = (unsigned char)(bits >> 8 * byte);
    }
}

/* Where `count` elements begin, of an accessor or one of the parts of a sparse one. 0 where they do not lie within
 * their buffer. */
static int find_view(GltfFloats *f, const json_t *of, size_t element, size_t count, View *view)
{
    size_t view_index, buffer_index, at, view_at, size;
    if (!gltf_get_size(of, "bufferView", SIZE_MAX, &view_index) || !gltf_get_size(of, "byteOffset", 0, &at))
        return 0;
    const json_t *json = json_array_get(json_object_get(f->json, "bufferViews"), view_index);
    if (!gltf_get_size(json, "buffer", SIZE_MAX, &buffer_index) || !gltf_get_size(json, "byteOffset", 0, &view_at) ||
        !gltf_get_size(json, "byteStride", 0, &view->stride) || !gltf_get_size(json, "byteLength", 0, &size))
        return 0;
    if (view->stride == 0) /* as Assimp reads it, though glTF has no such stride */
        view->stride = element;
    const Bytes *buffer = gltf_buffer(&f->buffers, buffer_index);
    if (!buffer || view->stride < element || view_at > buffer->size || size > buffer->size - view_at || at > size ||
        element > size - at || count - 1 > (size - at - element) / view->stride)
        return 0;
    view->bytes = buffer->bytes + view_at + at;
    return 1;
}

/* The elements that a sparse accessor has in place of others. */
static int put_sparse(GltfFloats *f, const json_t *sparse, const Numbers *numbers, unsigned char *to)
{
    const json_t *indices = json_object_get(sparse, "indices");
    size_t count, type;
    View places, values;
    if (!gltf_get_size(sparse, "count", 0, &count) || !gltf_get_size(indices, "componentType", 0, &type))
        return 0;
    if (count == 0)
        return 1;
    if ((type != UNSIGNED_BYTE && type != UNSIGNED_SHORT && type != UNSIGNED_INT) ||
        !find_view(f, indices, size_of(type), count, &places) ||
        !find_view(f, json_object_get(sparse, "values"), numbers->width * size_of(numbers->type), count, &values))
        return 0;
    for (size_t i = 0; i < count; i++) {
        const size_t place = word_at(places.bytes + i * places.stride, size_of(type));
        if (place >= numbers->count)
            return 0;
        put_element(to + place * numbers->width * sizeof(float), values.bytes + i * values.stride, numbers);
    }
    return 1;
}

/* Where the elements are: bytes are NULL where they are 0, but for sparse ones. */
static int find_elements(GltfFloats *f, const json_t *accessor, const Numbers *numbers, View *view)
{
    *view = (View){NULL, 0};
    return !json_object_get(accessor, "bufferView") ||
           find_view(f, accessor, numbers->width * size_of(numbers->type), numbers->count, view);
}

static int put_elements(GltfFloats *f, const json_t *accessor, const Numbers *numbers, const View *view,
                        unsigned char *to)
{
    const json_t *sparse = json_object_get(accessor, "sparse");
    const size_t element = numbers->width * sizeof(float);
    if (view->bytes)
        for (size_t i = 0; i < numbers->count; i++)
            put_element(to + i * element, view->bytes + i * view->stride, numbers);
    else
        memset(to, 0, numbers->count * element);
    return !sparse || put_sparse(f, sparse, numbers, to);
}

/* The elements as floats behind those that there are. */
static int append_floats(GltfFloats *f, const json_t *accessor, const Numbers *numbers, size_t *at)
{
    View view;
    if (!find_elements(f, accessor, numbers, &view))
        return 0;
    unsigned char *to = gltf_extend(&f->floats, numbers->count * numbers->width * sizeof(float), at);
    return to && put_elements(f, accessor, numbers, &view, to);
}

/* Whether it is a vector of numbers whose type and count glTF knows. */
static int read_numbers(const json_t *accessor, Numbers *numbers)
{
    const char *kind = json_string_value(json_object_get(accessor, "type"));
    *numbers = (Numbers){.is_normalized = json_is_true(json_object_get(accessor, "normalized"))};
    if (kind && strncmp(kind, "VEC", 3) == 0 && kind[3] >= '2' && kind[3] <= '4')
        numbers->width = (size_t)(kind[3] - '0');
    return gltf_get_size(accessor, "componentType", 0, &numbers->type) && numbers->width && numbers->type >= BYTE &&
           (numbers->type <= UNSIGNED_SHORT || numbers->type == FLOAT) &&
           gltf_get_size(accessor, "count", 0, &numbers->count) && numbers->count > 0;
}

float *gltf_floats_read(GltfFloats *f, const json_t *index, size_t width, size_t most, size_t *count)
{
    const size_t place = json_is_integer(index) ? (size_t)json_integer_value(index) : SIZE_MAX;
    const json_t *accessor = json_array_get(json_object_get(f->json, "accessors"), place);
    Numbers numbers;
    View view;
    if (!read_numbers(accessor, &numbers) || numbers.width != width || numbers.count > most ||
        !find_elements(f, accessor, &numbers, &view))
        return NULL;
    float *floats = calloc(numbers.count, width * sizeof *floats);
    if (floats && !put_elements(f, accessor, &numbers, &view, (unsigned char *)floats)) {
        free(floats);
        return NULL;
    }
    *count = numbers.count;
    return floats;
}

static Change convert(GltfFloats *f, json_t *accessor)
{
    static const char *const obsolete[] = {"normalized", "min", "max", "sparse"};
    Numbers numbers;
    size_t begin;
    if (!accessor || json_number_value(json_object_get(accessor, "componentType")) == FLOAT)
        return KEPT;
    if (!read_numbers(accessor, &numbers) || !append_floats(f, accessor, &numbers, &begin))
        return REFUSED;
    const json_int_t view =
        gltf_add_view(f->json, json_array_size(json_object_get(f->json, "buffers")), begin, f->floats.size - begin);
    json_object_set_new(accessor, "bufferView", json_integer(view));
    json_object_set_new(accessor, "byteOffset", json_integer(0));
    json_object_set_new(accessor, "componentType", json_integer(FLOAT));
    for (size_t i = 0; i < sizeof obsolete / sizeof *obsolete; i++)
        json_object_del(accessor, obsolete[i]);
    return CONVERTED;
}

/* Those of the mesh itself must be read: a model without them would be another one. */
static void convert_attributes(GltfFloats *f, json_t *attributes, int of_mesh)
{
    static const char *const names[] = {"POSITION", "NORMAL", "TEXCOORD_", "TANGENT"};
    enum { NEEDED = 3, NAMES = sizeof names / sizeof *names };
    const char *key;
    json_t *index;
    char plain[NAME_SIZE];
    json_object_foreach(attributes, key, index)
    {
        size_t i = 0;
        while (i < NAMES && strncmp(key, names[i], strlen(names[i])) != 0)
            i++;
        if (i == NAMES || !json_is_integer(index) || json_integer_value(index) < 0)
            continue;
        const json_int_t number = json_integer_value(index);
        const Change change = convert(f, json_array_get(json_object_get(f->json, "accessors"), (size_t)number));
        f->any |= change == CONVERTED;
        if (change == REFUSED && of_mesh && i < NEEDED && !f->refused[0])
            snprintf(f->refused, sizeof f->refused,
                     "the numbers of accessors[%lld], %s, do not lie within their buffer, or are of a type that glTF "
                     "does not know there",
                     (long long)number, import_plain(key, plain));
    }
}

/* An accessor without a view is 0, which Assimp refuses: it gets a view of zeros. */
static void fill_empty(GltfFloats *f, json_t *accessor)
{
    static const struct {
        const char *type;
        size_t width;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    const char *type = json_string_value(json_object_get(accessor, "type"));
    size_t count, component, begin, width = 0;
    if (!type || json_object_get(accessor, "bufferView") || json_object_get(accessor, "sparse") ||
        !gltf_get_size(accessor, "count", 0, &count) || !gltf_get_size(accessor, "componentType", 0, &component))
        return;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        width = strcmp(type, types[i].type) == 0 ? types[i].width : width;
    if (!width || !count || count > MOST_ZEROS / (width * sizeof(float)))
        return;
    const size_t bytes = count * width * size_of(component);
    unsigned char *to = gltf_extend(&f->floats, bytes, &begin);
    if (!to)
        return;
    memset(to, 0, bytes);
    const json_int_t view = gltf_add_view(f->json, json_array_size(json_object_get(f->json, "buffers")), begin, bytes);
    f->any |= json_object_set_new(accessor, "bufferView", json_integer(view)) == 0;
}

void gltf_floats_convert(GltfFloats *f)
{
    const json_t *accessors = json_object_get(f->json, "accessors");
    for (size_t i = 0; i < json_array_size(accessors); i++)
        fill_empty(f, json_array_get(accessors, i));
    const json_t *meshes = json_object_get(f->json, "meshes");
    for (size_t i = 0; i < json_array_size(meshes); i++) {
        const json_t *primitives = json_object_get(json_array_get(meshes, i), "primitives");
        for (size_t k = 0; k < json_array_size(primitives); k++) {
            const json_t *primitive = json_array_get(primitives, k), *targets = json_object_get(primitive, "targets");
            convert_attributes(f, json_object_get(primitive, "attributes"), 1);
            for (size_t t = 0; t < json_array_size(targets); t++)
                convert_attributes(f, json_array_get(targets, t), 0);
        }
    }
}
