/* Textures by the value of a pattern: texture_map, lists of textures, tiles, average, material_map. */
#include <string.h>
#include <retex/image_file.h>
#include "base/digest.h"
#include "pattern/pattern.h"
#include "sdl/texture/texture.h"

static void add_entry(Sdl *sdl, ParsedTextureMap *map, double value, const ParsedTexture *texture)
{
    map->entries = sdl_grow(sdl, map->entries, map->count, &map->capacity, sizeof *map->entries);
    int i = map->count++;
    /* In order of value, what was written first first. */
    for (; i > 0 && map->entries[i - 1].value > value; i--)
        map->entries[i] = map->entries[i - 1];
    map->entries[i] = (ParsedTextureEntry){value, texture};
}

static ParsedTextureMap *known_map(Sdl *sdl)
{
    Value *value = peek_ident(sdl, VALUE_OTHER);
    if (!value || !value->word || strcmp(value->word, "texture_map") != 0)
        return NULL;
    ParsedTextureMap *known = value->data;
    sdl_next(sdl);
    return known;
}

ParsedTextureMap *parse_texture_map(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    ParsedTextureMap *map = known_map(sdl);
    if (map) {
        sdl_expect(sdl, "}");
        return map;
    }
    map = sdl_alloc(sdl, sizeof *map);
    statement_begin(sdl);
    while (sdl_accept(sdl, "[")) {
        const double value = optional_float(sdl, 1); /* of `average` it may be left out */
        sdl_optional_comma(sdl);
        add_entry(sdl, map, value, parse_texture_body(sdl, ']'));
        sdl_optional_comma(sdl);
    }
    statement_end(sdl);
    if (map->count == 0)
        sdl_expected(sdl, "`[` and an entry of the texture_map");
    sdl_expect(sdl, "}");
    return map;
}

void parse_texture_list(Sdl *sdl, ParsedTextureMap *map, int n)
{
    map->count = map->capacity = 0; /* of two lists the last one counts */
    while (map->count < n && sdl_accept(sdl, "texture")) {
        add_entry(sdl, map, map->count, parse_texture(sdl));
        sdl_optional_comma(sdl);
    }
}

/* ---- the whole ---- */

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* Of a map two neighbours are seen at one point, of an average all, else one; of operands a few. */
static void count(Sdl *sdl, ParsedTextureMap *map)
{
    TextureCounts *all = &map->counts;
    const int chooses =
        map->kind == TEXTURE_MATERIALS || (map->kind == TEXTURE_MAP && map->selector->pigment.pattern.ops->colors > 0);
    int before = 0;
    *all = (TextureCounts){0};
    for (int i = 0; i < map->count; i++) {
        const TextureCounts of = texture_counts(sdl, map->entries[i].texture);
        all->leaves += of.leaves;
        all->depth = larger(all->depth, of.depth + 1);
        all->seen =
            map->kind == TEXTURE_AVERAGE ? all->seen + of.seen : larger(all->seen, of.seen + (chooses ? 0 : before));
        before = of.seen;
        texture_check_counts(sdl, all);
    }
}

/* A copy of the map for its selector, with the textures in the selector's pattern space. */
const ParsedTexture *texture_of_map(Sdl *sdl, const ParsedTextureMap *from, ParsedPigment *selector,
                                    TextureTreeKind kind)
{
    ParsedTextureMap *map = sdl_alloc(sdl, sizeof *map);
    ParsedTexture *texture = sdl_alloc(sdl, sizeof *texture);
    *map = *from;
    map->kind = kind, map->selector = selector;
    map->entries = sdl_alloc(sdl, (size_t)from->count * sizeof *map->entries);
    for (int i = 0; i < from->count; i++) {
        map->entries[i].value = from->entries[i].value;
        map->entries[i].texture = texture_nested(sdl, from->entries[i].texture, &selector->pigment);
    }
    count(sdl, map);
    texture->texture = map->entries[0].texture->texture;
    texture->texture.idents = NULL;
    texture->texture.uv_mapping = selector->pigment.uv_mapping;
    texture->map = map;
    return texture;
}

/* A pattern that is not supported: the mean over its values. */
static ParsedTextureMap *averaged(Sdl *sdl, const ParsedTextureMap *from, int chooses)
{
    ParsedTextureMap *map = sdl_alloc(sdl, sizeof *map);
    for (int i = 0; i < from->count; i++) {
        const double before = i > 0 ? from->entries[i - 1].value : -from->entries[i].value,
                     after = i + 1 < from->count ? from->entries[i + 1].value : 2 - from->entries[i].value;
        add_entry(sdl, map, chooses ? 1 : (after - before) / 2, from->entries[i].texture);
    }
    return map;
}

const ParsedTexture *parse_texture_pattern(Sdl *sdl, char end, int uv_mapping)
{
    ParsedTextureMap map = {.kind = TEXTURE_MAP};
    ParsedPigment *selector = parse_selector(sdl, end, &map);
    const PatternOps *ops = selector->pigment.pattern.ops;
    const int is_average = selector->pigment.kind == PIGMENT_AVERAGE;
    if (uv_mapping)
        selector->pigment.uv_mapping = 1;
    if (!is_average && !ops)
        sdl_expected(sdl, "a pattern before the texture_map");
    if (map.count == 0)
        sdl_error(sdl, "a pattern without textures");
    if (is_average)
        return texture_of_map(sdl, &map, selector, TEXTURE_AVERAGE);
    if (!ops->value)
        return texture_of_map(sdl, averaged(sdl, &map, ops->colors > 0), selector, TEXTURE_AVERAGE);
    return texture_of_map(sdl, &map, selector, TEXTURE_MAP);
}

/* tiles{ texture{…} tile2 texture{…} }: an old form of a checker; the first texture is that of the odd fields. */
const ParsedTexture *parse_tiles(Sdl *sdl)
{
    ParsedTextureMap map = {.kind = TEXTURE_MAP};
    ParsedPigment *selector = pigment_new(sdl, NULL);
    selector->pigment.kind = PIGMENT_PATTERN;
    selector->pigment.pattern.ops = &pattern_checker;
    sdl_expect(sdl, "{");
    sdl_expect(sdl, "texture");
    const ParsedTexture *odd = parse_texture(sdl);
    sdl_expect(sdl, "tile2");
    sdl_expect(sdl, "texture");
    add_entry(sdl, &map, 0, parse_texture(sdl));
    add_entry(sdl, &map, 1, odd);
    sdl_expect(sdl, "}");
    return texture_of_map(sdl, &map, selector, TEXTURE_MAP);
}

/* ---- material_map ---- */

enum { LARGEST_SIDE = 16384 };

static unsigned char index_of_red(float red)
{
    red *= 255;
    return (unsigned char)(red > 0 ? red < 255 ? red + 0.5f : 255 : 0);
}

/* Of a picture without a palette, red tells the texture. */
static void take_red(Sdl *sdl, ImageMap *image)
{
    const SdlOptions *options = sdl_options(sdl);
    const RetexReadParams params = {.size = sizeof params,
                                    .colorspace = "linear",
                                    .max_pixels = (long)LARGEST_SIDE * LARGEST_SIDE,
                                    .access = sdl_access(sdl),
                                    .budget = options->budget,
                                    .pixel_bytes = 16 + 1,
                                    .warn = warn_of_picture,
                                    .warn_context = sdl};
    RetexImage pixels = {0};
    RetexError err = {0};
    sdl_add_file(sdl, image->path);
    if (retex_image_read(&pixels, image->path, &params, options->nthreads, &err))
        sdl_error(sdl, "material_map: %s%s%s", err.file, err.file[0] ? ": " : "", err.message);
    unsigned char *indices = arena_alloc(sdl_arena(sdl), (size_t)pixels.width * (size_t)pixels.height);
    for (int y = 0; indices && y < pixels.height; y++)
        for (int x = 0; x < pixels.width; x++)
            *(indices + (size_t)y * (size_t)pixels.width + (size_t)x) =
                index_of_red(pixels.pixels[retex_image_index(&pixels, x, y)]);
    image->width = pixels.width, image->height = pixels.height, image->indices = indices;
    retex_image_free(&pixels);
    if (!indices)
        sdl_error(sdl, "material_map: no memory for its picture");
}

static void take_drawn(Sdl *sdl, ParsedImage *from)
{
    const size_t n = (size_t)from->map.width * (size_t)from->map.height;
    unsigned char *indices = sdl_alloc(sdl, n);
    for (size_t i = 0; i < n; i++)
        indices[i] = index_of_red(from->drawn[4 * i]);
    from->map.indices = indices;
}

static void read_indices(Sdl *sdl, ParsedImage *from)
{
    Scene *scene = sdl_scene(sdl);
    ImageMap *image = &from->map;
    PaletteIndices palette;
    if (from->drawn)
        take_drawn(sdl, from);
    else if (read_palette_indices(sdl, image->path, LARGEST_SIDE, &palette))
        image->width = palette.width, image->height = palette.height, image->indices = palette.indices;
    else
        take_red(sdl, image);
    scene->digest = digest_bytes(scene->digest, image->indices, (size_t)image->width * (size_t)image->height);
}

const ParsedTexture *parse_material_map(Sdl *sdl)
{
    ParsedTextureMap map = {.kind = TEXTURE_MATERIALS};
    ParsedPigment *selector = pigment_new(sdl, NULL);
    sdl_expect(sdl, "{");
    ParsedImage *image = parse_image(sdl, selector);
    while (sdl_accept(sdl, "texture")) {
        add_entry(sdl, &map, map.count, parse_texture(sdl));
        sdl_optional_comma(sdl);
    }
    if (map.count == 0)
        sdl_error(sdl, "a material_map without textures");
    if (!sdl_accept(sdl, "}"))
        sdl_expected(sdl, "an option of the image, texture or } in material_map");
    read_indices(sdl, image);
    return texture_of_map(sdl, &map, selector, TEXTURE_MATERIALS);
}
