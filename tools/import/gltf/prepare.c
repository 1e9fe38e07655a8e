/* glTF files as Assimp reads them well: a file that says the same in other words takes the place of one that it would
 * misread. */
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "import/gltf/buffers.h"
#include "import/gltf/decode.h"
#include "import/gltf/floats.h"
#include "import/gltf/gltf.h"
#include "import/gltf/json.h"
#include "import/gltf/parts.h"

/* Images in formats that only an extension may name, where there is no other image in its place. Returns 1 if there
 * are any. */
static int take_images(json_t *json)
{
    static const char *const extensions[] = {"EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"};
    const json_t *textures = json_object_get(json, "textures");
    int any = 0;
    for (size_t i = 0; i < json_array_size(textures); i++) {
        json_t *texture = json_array_get(textures, i);
        for (size_t k = 0; k < sizeof extensions / sizeof *extensions; k++) {
            json_t *source = json_object_get(gltf_extension(texture, extensions[k]), "source");
            if (json_is_integer(source) && !json_object_get(texture, "source"))
                any |= json_object_set(texture, "source", source) == 0;
        }
    }
    return any;
}

/* A node's own weights of morph targets go into a mesh of its own, for Assimp reads those of meshes alone. Returns 1 if
 * there are any. */
static int take_weights(json_t *json)
{
    const json_t *nodes = json_object_get(json, "nodes");
    json_t *meshes = json_object_get(json, "meshes");
    int any = 0;
    for (size_t i = 0; i < json_array_size(nodes); i++) {
        json_t *node = json_array_get(nodes, i), *weights = json_object_get(node, "weights");
        const json_t *index = json_object_get(node, "mesh");
        const json_int_t place = json_is_integer(index) ? json_integer_value(index) : -1;
        json_t *mesh = place < 0 ? NULL : json_array_get(meshes, (size_t)place);
        if (!json_array_size(weights) || !mesh || json_equal(weights, json_object_get(mesh, "weights")))
            continue;
        json_t *own = json_copy(mesh), *at = json_integer((json_int_t)json_array_size(meshes));
        any |= json_object_set(own, "weights", weights) == 0 && json_array_append(meshes, own) == 0 &&
               json_object_set(node, "mesh", at) == 0;
        json_decref(own);
        json_decref(at);
    }
    return any;
}

static int without(json_t *of, const char *key)
{
    return json_object_get(of, key) && json_object_del(of, key) == 0;
}

/* Assimp wants numbered attributes without gaps and in their order, which glTF does not: a gap is filled by a set that
 * there is. Returns 1 if any are moved. */
static int order_sets(json_t *attributes, const char *prefix)
{
    enum { MOST_SETS = 8 };
    json_t *sets[MOST_SETS], *any = NULL;
    char key[32];
    int last = -1, is_odd = 0, seen = 0;
    const char *name;
    json_t *value;
    json_object_foreach (attributes, name, value)
        if (strncmp(name, prefix, strlen(prefix)) == 0) {
            snprintf(key, sizeof key, "%s%d", prefix, seen++);
            is_odd |= strcmp(name, key) != 0;
        }
    for (int i = 0; i < MOST_SETS && is_odd; i++) {
        snprintf(key, sizeof key, "%s%d", prefix, i);
        sets[i] = json_incref(json_object_get(attributes, key));
        if (without(attributes, key))
            last = i, any = any ? any : sets[i];
    }
    for (int i = 0; i <= last; i++) {
        snprintf(key, sizeof key, "%s%d", prefix, i);
        json_object_set(attributes, key, sets[i] ? sets[i] : any);
    }
    for (int i = 0; i <= last; i++)
        json_decref(sets[i]);
    return last >= 0;
}

static int order_attributes(json_t *json)
{
    static const char *const prefixes[] = {"TEXCOORD_", "COLOR_"};
    const json_t *meshes = json_object_get(json, "meshes");
    int any = 0;
    for (size_t i = 0; i < json_array_size(meshes); i++) {
        const json_t *primitives = json_object_get(json_array_get(meshes, i), "primitives");
        for (size_t k = 0; k < json_array_size(primitives); k++)
            for (size_t p = 0; p < sizeof prefixes / sizeof *prefixes; p++)
                any |= order_sets(json_object_get(json_array_get(primitives, k), "attributes"), prefixes[p]);
    }
    return any;
}

/* Cameras and lights, which Assimp knows by the names of nodes alone, and refuses where these are the same. They are
 * taken from nodes themselves (nodes.c). Returns 1 if there were any. */
static int drop_cameras_and_lights(json_t *json)
{
    static const char *const lights = "KHR_lights_punctual";
    const json_t *nodes = json_object_get(json, "nodes");
    int any = without(json, "cameras") | without(json_object_get(json, "extensions"), lights);
    for (size_t i = 0; i < json_array_size(nodes); i++) {
        json_t *node = json_array_get(nodes, i);
        any |= without(node, "camera") | without(json_object_get(node, "extensions"), lights);
    }
    return any;
}

/* Assimp reads those materials that meshes use, in the order in which it finds them: names begin with their place in
 * the file, see gltf_material_place. */
static int mark_materials(json_t *json)
{
    const json_t *materials = json_object_get(json, "materials");
    for (size_t i = 0; i < json_array_size(materials); i++) {
        json_t *material = json_array_get(materials, i);
        const json_t *name = json_object_get(material, "name");
        const char *text = json_string_value(name);
        const int length = text ? (int)strlen(text) : 0;
        json_object_set_new(material, "name", json_sprintf("%zu:%.*s", i, length < 900 ? length : 0, text ? text : ""));
    }
    return json_array_size(materials) > 0;
}

/* Nodes that are hidden: marks for each, and those whose children are still to be marked. */
typedef struct Hidden {
    char *marks;
    size_t *open, nopen, count;
} Hidden;

/* Files may say that a node is below itself: each is marked once. */
static void mark_hidden(Hidden *hidden, size_t index)
{
    if (index >= hidden->count || hidden->marks[index])
        return;
    hidden->marks[index] = 1;
    hidden->open[hidden->nopen++] = index;
}

/* The meshes of nodes that are hidden, and of those below them. Returns 1 if there were any. */
static int drop_hidden(json_t *json)
{
    const json_t *nodes = json_object_get(json, "nodes");
    Hidden hidden = {.count = json_array_size(nodes)};
    int any = 0;
    hidden.open = malloc((hidden.count + 1) * sizeof *hidden.open);
    hidden.marks = calloc(hidden.count + 1, 1);
    for (size_t i = 0; hidden.open && hidden.marks && i < hidden.count; i++)
        if (gltf_is_hidden(json_array_get(nodes, i)))
            mark_hidden(&hidden, i);
    while (hidden.nopen) {
        json_t *node = json_array_get(nodes, hidden.open[--hidden.nopen]);
        const json_t *children = json_object_get(node, "children");
        any |= without(node, "mesh");
        for (size_t k = 0; k < json_array_size(children); k++) {
            const json_t *child = json_array_get(children, k);
            if (json_is_integer(child))
                mark_hidden(&hidden, (size_t)json_integer_value(child));
        }
    }
    free(hidden.open);
    free(hidden.marks);
    return any;
}

static void put_word(FILE *out, size_t word)
{
    for (int byte = 0; byte < 4; byte++)
        fputc((int)(word >> 8 * byte & 255), out);
}

/* A buffer of the file, its bytes as text of it. */
static int fill_buffer(json_t *buffer, const Bytes *data)
{
    char *uri = gltf_encode_base64(data, "data:application/octet-stream;base64,");
    const int code = uri ? json_object_set_new(buffer, "byteLength", json_integer((json_int_t)data->size)) |
                               json_object_set_new(buffer, "uri", json_string_nocheck(uri))
                         : -1;
    free(uri);
    return code == 0;
}

static json_t *add_buffer(json_t *json, const char *name)
{
    json_t *buffers = json_object_get(json, "buffers"), *buffer = json_pack("{s:s}", "name", name);
    if (!json_is_array(buffers)) { /* all accessors are sparse */
        buffers = json_array();
        json_object_set_new(json, "buffers", buffers);
    }
    return json_array_append_new(buffers, buffer) == 0 ? buffer : NULL;
}

/* What is compressed goes into a buffer of its own, which other changes then read. Returns 1 if there is any. */
static int decode_all(GltfFloats *f)
{
    GltfDecode d = {.json = f->json, .buffers = &f->buffers};
    f->buffers.decoded_index = json_array_size(json_object_get(f->json, "buffers"));
    gltf_decode_views(&d);
    gltf_decode_meshes(&d);
    memcpy(f->refused, d.refused, sizeof f->refused);
    if (d.any && !add_buffer(f->json, "decoded"))
        snprintf(f->refused, sizeof f->refused, GLTF_NO_MEMORY);
    return d.any;
}

static int fill_buffers(const GltfFloats *f)
{
    const Bytes *decoded = &f->buffers.decoded;
    json_t *buffers = json_object_get(f->json, "buffers");
    return (!decoded->bytes || fill_buffer(json_array_get(buffers, f->buffers.decoded_index), decoded)) &&
           (!f->any || fill_buffer(add_buffer(f->json, "floats"), &f->floats));
}

/* Written as the file was: Assimp goes by the ending of its name. */
static int write_file(const GltfFloats *f, FILE *out)
{
    const Bytes *inside = &f->buffers.inside;
    char *text = fill_buffers(f) ? json_dumps(f->json, JSON_COMPACT) : NULL;
    const size_t length = text ? strlen(text) : 0, padded = (length + 3) / 4 * 4, rest = (inside->size + 3) / 4 * 4;
    if (f->buffers.is_binary) {
        put_word(out, GLTF_MAGIC), put_word(out, 2), put_word(out, 12 + 8 + padded + (rest ? 8 + rest : 0));
        put_word(out, padded), put_word(out, GLTF_JSON_CHUNK);
    }
    fwrite(text ? text : "", 1, length, out);
    for (size_t i = length; i < padded; i++)
        fputc(' ', out);
    if (f->buffers.is_binary && rest) {
        put_word(out, rest), put_word(out, GLTF_BINARY_CHUNK);
        fwrite(inside->bytes, 1, inside->size, out);
        for (size_t i = inside->size; i < rest; i++)
            fputc(0, out);
    }
    free(text);
    return length > 0 && fflush(out) == 0 && !ferror(out);
}

/* A file in memory: this process may write to no folder but that of its results. */
static FILE *open_in_memory(void)
{
    const int descriptor = memfd_create("model", MFD_CLOEXEC);
    FILE *file = descriptor < 0 ? NULL : fdopen(descriptor, "w+b");
    if (!file && descriptor >= 0)
        close(descriptor);
    return file;
}

/* Each change, in an order in which it finds what it reads. Returns 1 where there was any. */
static int change(GltfFloats *f)
{
    Import *import = f->buffers.import;
    int any = 0;
    gltf_check_indices(f->json, f->refused);
    gltf_check_sizes(f->json, f->refused);
    if (!f->refused[0])
        any |= decode_all(f);
    if (!f->refused[0])
        any |= gltf_variants_take(f->json, import->options->variant, &import->variants, f->refused);
    if (!f->refused[0]) {
        any |= mark_materials(f->json);
        any |= drop_hidden(f->json);
        any |= take_images(f->json);
        any |= gltf_put_out_lost(f->json);
        any |= take_weights(f->json);
        any |= order_attributes(f->json);
        any |= drop_cameras_and_lights(f->json);
        any |= gltf_place_instances(f);
    }
    if (!f->refused[0])
        gltf_floats_convert(f);
    return any | f->any;
}

/* NULL: the file will do as it is, or is refused. */
static FILE *write_prepared(Import *import, FILE *in)
{
    GltfText text = gltf_load(in);
    GltfFloats f = {.json = text.json,
                    .buffers = {.import = import, .json = text.json, .in = in, .is_binary = text.is_binary}};
    FILE *out = NULL;
    if (text.json && (change(&f) || text.is_repaired) && !f.refused[0]) {
        out = open_in_memory();
        gltf_buffers_read_inside(&f.buffers);
        if (out && !write_file(&f, out)) {
            fclose(out);
            out = NULL;
        }
        if (!out)
            snprintf(f.refused, sizeof f.refused, GLTF_NO_MEMORY);
    }
    if (!text.json && text.why[0]) /* such as by depth, which Assimp does not count */
        snprintf(f.refused, sizeof f.refused, "its JSON text: %.200s", text.why);
    memcpy(import->gltf_refused, f.refused, sizeof f.refused);
    gltf_buffers_free(&f.buffers);
    free(f.floats.bytes);
    json_decref(text.json);
    return out;
}

FILE *gltf_prepare(Import *import, FILE *in)
{
    char path[64];
    if (!import->gltf_is_prepared) { /* Assimp opens the file several times */
        import->gltf_is_prepared = 1;
        import->gltf_prepared = write_prepared(import, in);
        rewind(in);
    }
    if (!import->gltf_prepared && !import->gltf_refused[0])
        return in;
    fclose(in);
    if (!import->gltf_prepared)
        return NULL;
    snprintf(path, sizeof path, "/proc/self/fd/%d", fileno(import->gltf_prepared));
    return fopen(path, "rb");
}
