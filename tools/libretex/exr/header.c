/* What the headers of an open EXR file say of its parts: names, channels, sizes, attributes. */
#include <string.h>
#include <strings.h>

#include "exr/decode.h"

int retex_exr_part_count(const RetexExr *exr)
{
    return exr->nparts;
}

int retex_exr_find_part(const RetexExr *exr, const char *name)
{
    for (int i = 0; i < exr->nparts; i++) {
        const char *found = NULL;
        if (exr_get_name(exr->context, i, &found) == EXR_ERR_SUCCESS && found && strcmp(found, name) == 0)
            return i;
    }
    return -1;
}

const char *retex_exr_part_name(const RetexExr *exr, int part)
{
    const char *name = NULL;

    return exr_get_name(exr->context, part, &name) == EXR_ERR_SUCCESS && name ? name : "";
}

int retex_exr_channel_count(const RetexExr *exr, int part)
{
    const exr_attr_chlist_t *channels;

    return exr_get_channels(exr->context, part, &channels) ? 0 : channels->num_channels;
}

const char *retex_exr_channel_name(const RetexExr *exr, int part, int channel)
{
    const exr_attr_chlist_t *channels;

    if (exr_get_channels(exr->context, part, &channels) || channel < 0 || channel >= channels->num_channels)
        return "";
    return channels->entries[channel].name.str;
}

void retex_exr_data_window(const RetexExr *exr, int part, exr_attr_box2i_t *window)
{
    if (exr_get_data_window(exr->context, part, window) != EXR_ERR_SUCCESS)
        *window = (exr_attr_box2i_t){.min = {.x = 0, .y = 0}, .max = {.x = -1, .y = -1}};
}

void retex_exr_part_size(const RetexExr *exr, int part, int *width, int *height)
{
    exr_attr_box2i_t window;

    retex_exr_data_window(exr, part, &window);
    const int64_t w = (int64_t)window.max.x - window.min.x + 1, h = (int64_t)window.max.y - window.min.y + 1;
    *width = w > 0 && w <= RETEX_MAX_SIZE ? (int)w : 0;
    *height = h > 0 && h <= RETEX_MAX_SIZE ? (int)h : 0;
}

int retex_exr_part_readable(const RetexExr *exr, int part, const char **reason)
{
    exr_storage_t storage;
    exr_compression_t compression;
    const exr_attr_chlist_t *channels;
    int width, height;

    *reason = "its header is incomplete";
    if (exr_get_storage(exr->context, part, &storage) || exr_get_compression(exr->context, part, &compression) ||
        exr_get_channels(exr->context, part, &channels))
        return 0;
    *reason = "deep parts are not read";
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return 0;
    *reason = "its compression is not known";
    if (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB ||
        compression >= EXR_COMPRESSION_LAST_TYPE)
        return 0;
    *reason = "its size is out of bounds";
    retex_exr_part_size(exr, part, &width, &height);
    if (!width || !height)
        return 0;
    *reason = "subsampled channels are not read";
    for (int i = 0; i < channels->num_channels; i++)
        if (channels->entries[i].x_sampling != 1 || channels->entries[i].y_sampling != 1)
            return 0;
    *reason = NULL;
    return 1;
}

static const exr_attr_chlist_entry_t *find_channel(const RetexExr *exr, int part, const char *name)
{
    const exr_attr_chlist_t *channels;

    if (exr_get_channels(exr->context, part, &channels))
        return NULL;
    for (int i = 0; i < channels->num_channels; i++)
        if (strcmp(channels->entries[i].name.str, name) == 0)
            return &channels->entries[i];
    return NULL;
}

int retex_exr_has_channel(const RetexExr *exr, int part, const char *channel)
{
    return find_channel(exr, part, channel) != NULL;
}

int retex_exr_channel_type(const RetexExr *exr, int part, const char *channel, RetexPixelType *type)
{
    const exr_attr_chlist_entry_t *entry = find_channel(exr, part, channel);

    if (!entry || (entry->pixel_type != EXR_PIXEL_HALF && entry->pixel_type != EXR_PIXEL_FLOAT))
        return 0;
    *type = entry->pixel_type == EXR_PIXEL_HALF ? RETEX_HALF : RETEX_FLOAT;
    return 1;
}

const char *retex_exr_attribute(const RetexExr *exr, int part, const char *name)
{
    const exr_attribute_t *attribute;
    const char *text = NULL;
    int32_t length;

    if (exr_get_attribute_by_name(exr->context, part, name, &attribute) || attribute->type != EXR_ATTR_STRING ||
        exr_attr_get_string(exr->context, part, name, &length, &text))
        return NULL;
    return text;
}

/* The name of a space that OpenImageIO's attribute gives; NULL where it only says that values are linear. */
static const char *color_space_name(const RetexExr *exr, int part)
{
    const char *name = retex_exr_attribute(exr, part, "oiio:ColorSpace");

    return name && strcasecmp(name, "linear") != 0 && strcasecmp(name, "scene_linear") != 0 ? name : NULL;
}

void retex_exr_color_tag(const RetexExr *exr, int part, RetexColorTag *tag)
{
    const exr_attribute_t *attribute;
    exr_attr_chromaticities_t c;
    int32_t is_aces = 0;

    *tag = (RetexColorTag){.interop = ""};
    if (!exr_get_attribute_by_name(exr->context, part, "acesImageContainerFlag", &attribute) &&
        attribute->type == EXR_ATTR_INT && !exr_attr_get_int(exr->context, part, "acesImageContainerFlag", &is_aces) &&
        is_aces == 1) {
        *tag = *retex_color_tag_find("lin_ap0_scene");
        return;
    }
    const char *interop = retex_exr_attribute(exr, part, "colorInteropID");
    if (!interop)
        interop = color_space_name(exr, part);
    if (interop && strlen(interop) < sizeof tag->interop)
        strcpy(tag->interop, interop);
    if (!exr_get_attribute_by_name(exr->context, part, "chromaticities", &attribute) &&
        attribute->type == EXR_ATTR_CHROMATICITIES &&
        !exr_attr_get_chromaticities(exr->context, part, "chromaticities", &c)) {
        const float values[8] = {c.red_x, c.red_y, c.green_x, c.green_y, c.blue_x, c.blue_y, c.white_x, c.white_y};
        memcpy(tag->chromaticities, values, sizeof values);
        tag->has_chromaticities = 1;
    }
}
