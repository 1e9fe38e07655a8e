/* Images of glTF files that are in no format that is read: those of KHR_texture_basisu, without another one in their
 * place. */
#include <string.h>

#include "import/base/tell.h"
#include "import/gltf/json.h"
#include "import/gltf/parts.h"

/* Whether what the material says has this texture anywhere. */
static int uses_texture(const json_t *value, json_int_t texture)
{
    const char *key;
    json_t *inner;
    size_t i;
    if (json_is_object(value)) {
        const json_t *index = json_object_get(value, "index");
        if (json_is_integer(index) && json_integer_value(index) == texture)
            return 1;
        json_object_foreach((json_t *)value, key, inner) if (uses_texture(inner, texture)) return 1;
    }
    json_array_foreach(value, i, inner) if (uses_texture(inner, texture)) return 1;
    return 0;
}

/* Names of the materials that use the texture, for people; returns how many there are. */
static size_t list_materials(const json_t *json, json_int_t texture, char *list, size_t size)
{
    enum { MOST = 4 };
    const json_t *materials = json_object_get(json, "materials");
    size_t count = 0, length = 0;
    char name[NAME_SIZE];
    list[0] = '\0';
    for (size_t i = 0; i < json_array_size(materials); i++)
        if (uses_texture(json_array_get(materials, i), texture) && count++ < MOST)
            length += (size_t)snprintf(list + length, size - length, "%s`%s`", count > 1 ? ", " : "",
                                       gltf_material_name(json, i, name));
    if (count > MOST)
        snprintf(list + length, size - length, " and %zu more", count - MOST);
    return count;
}

static const char *image_name(const json_t *json, json_int_t index, char plain[NAME_SIZE])
{
    const json_t *image = json_array_get(json_object_get(json, "images"), (size_t)index);
    const char *uri = json_string_value(json_object_get(image, "uri")),
               *name = json_string_value(json_object_get(image, "name"));
    char number[32];
    snprintf(number, sizeof number, "images[%lld]", (long long)index);
    return import_plain(uri && strncmp(uri, "data:", 5) != 0 ? uri : name && *name ? name : number, plain);
}

/* Formats that prepare.c puts in the place of a texture's image. */
static int has_other(const json_t *texture)
{
    return json_object_get(texture, "source") || gltf_extension(texture, "EXT_texture_webp") ||
           gltf_extension(texture, "EXT_texture_avif") || gltf_extension(texture, "MSFT_texture_dds");
}

void gltf_note_images(Import *import, const json_t *json)
{
    const json_t *textures = json_object_get(json, "textures");
    char list[5 * NAME_SIZE], plain[NAME_SIZE], source[32];
    for (size_t i = 0; i < json_array_size(textures); i++) {
        const json_t *texture = json_array_get(textures, i);
        const json_t *image = json_object_get(gltf_extension(texture, "KHR_texture_basisu"), "source");
        if (!json_is_integer(image) || has_other(texture))
            continue;
        const size_t count = list_materials(json, (json_int_t)i, list, sizeof list);
        snprintf(source, sizeof source, "texture %zu", i);
        if (count && losses_of_image(import, source))
            import_tell(import, IMPORT_WARNING,
                        "the image `%s` of the material%s %s is lost: KTX2 is not read; "
                        "`npx @gltf-transform/cli ktxdecompress OLD NEW` converts the model",
                        image_name(json, json_integer_value(image), plain), count == 1 ? "" : "s", list);
    }
}

static int is_lost(const json_t *json, const json_t *use)
{
    const json_t *index = json_object_get(use, "index"), *textures = json_object_get(json, "textures");
    const json_t *texture = json_is_integer(index) ? json_array_get(textures, (size_t)json_integer_value(index)) : NULL;
    return texture && gltf_extension(texture, "KHR_texture_basisu") && !has_other(texture);
}

int gltf_put_out_lost(json_t *json)
{
    const json_t *materials = json_object_get(json, "materials");
    int any = 0;
    for (size_t i = 0; i < json_array_size(materials); i++) {
        json_t *m = json_array_get(materials, i);
        if (is_lost(json, json_object_get(json_object_get(m, "pbrMetallicRoughness"), "baseColorTexture")))
            any |= json_object_del(json_object_get(m, "extensions"), "KHR_materials_unlit") == 0;
        if (is_lost(json, json_object_get(m, "emissiveTexture")))
            any |= json_object_del(m, "emissiveFactor") == 0;
    }
    return any;
}
