/* Interned words: one Word per spelling. Keywords are compared by pointer, and a name finds its innermost symbol
 * without a search. The table of reserved words is in this file too. */
#include <stdlib.h>
#include <string.h>
#include <retex/nearest.h>
#include "sdl/lang/internal.h"

/* Reserved words of POV-Ray 3.7, except the built-in functions, which have their own table. Reserved words cannot be
 * declared. The parser of each statement decides which of them are supported. The words of the renderer's own
 * extension block are not reserved, because existing scenes declare names such as `metalness`. */
static const char reserved_words[] =
    "aa_level aa_threshold absorption accuracy adaptive adc_bailout agate agate_turb albedo all all_intersections "
    "alpha altitude always_sample ambient ambient_light angle aoi aperture append arc_angle area_illumination "
    "area_light array ascii assumed_gamma autostop average b_spline background bezier_spline bicubic_patch "
    "black_hole blob blue blur_samples bmp bokeh bounded_by box boxed bozo break brick brick_size brightness "
    "brilliance bump_map bump_size bumps camera case caustics cells charset checker circular clipped_by collect "
    "color color_map colour colour_map component composite cone confidence conic_sweep conserve_energy "
    "contained_by control0 control1 coords count crackle crand cube cubic cubic_spline cubic_wave cutaway_textures "
    "cylinder cylindrical debug declare default density density_file density_map dents deprecated df3 difference "
    "diffuse direction disc dispersion dispersion_samples dist_exp distance double_illuminate eccentricity else "
    "elseif emission end error error_bound evaluate expand_thresholds exponent exr exterior extinction "
    "face_indices facets fade_color fade_colour fade_distance fade_power falloff falloff_angle fclose filter "
    "finish fisheye flatness flip focal_point fog fog_alt fog_offset fog_type fopen for form frequency fresnel "
    "function gamma gather gif global_lights global_settings gradient granite gray gray_threshold green "
    "height_field hexagon hf_gray_16 hierarchy hollow hypercomplex if ifdef iff ifndef image_map image_pattern "
    "importance include input_file_name inside_vector interior interior_texture internal interpolate intersection "
    "intervals inverse ior irid irid_wavelength isosurface jitter jpeg julia julia_fractal lambda lathe leopard "
    "light_group light_source linear_spline linear_sweep load_file local location look_at looks_like "
    "low_error_factor macro magnet major_radius mandel map_type marble material material_map matrix max_gradient "
    "max_intersections max_iteration max_sample max_trace max_trace_level maximum_reuse media media_attenuation "
    "media_interaction merge mesh mesh2 mesh_camera metallic method metric minimum_reuse mm_per_unit mortar "
    "natural_spline nearest_count no_bump_scale no_image no_radiosity no_reflection no_shadow noise_generator "
    "normal normal_indices normal_map normal_vectors number_of_sides "
    "number_of_tiles number_of_waves object octaves offset omega omnimax once "
    "onion open orient orientation orthographic ovus panoramic parallel parametric pass_through pattern pavement "
    "perspective pgm phase phong phong_size photons pigment pigment_map pigment_pattern planar plane png point_at "
    "poly poly_wave polygon polynomial pot ppm precision precompute premultiplied pretrace_end pretrace_start "
    "prism projected_through pwr quadratic_spline quadric quartic quaternion quick_color quick_colour quilted "
    "radial radiosity radius rainbow ramp_wave range ratio read reciprocal recursion_limit red reflection "
    "reflection_exponent refraction render repeat rgb rgbf rgbft rgbt right ripples rotate roughness samples "
    "save_file scale scallop_wave scattering shadowless sine_wave sint16be sint16le sint32be sint32le sint8 size "
    "sky sky_sphere slice slope slope_map smooth smooth_triangle solid sor spacing specular sphere sphere_sweep "
    "spherical spiral1 spiral2 spline split_union spotlight spotted square srgb srgbf srgbft srgbt statistics "
    "strength sturm subsurface superellipsoid switch sys target text texture texture_list texture_map tga "
    "thickness threshold tiff tightness tile2 tiles tiling tolerance toroidal torus transform translate "
    "translucency transmit triangle triangle_wave triangular ttf turb_depth turbulence type u_steps uint16be "
    "uint16le uint8 ultra_wide_angle undef union up use_alpha use_color use_colour use_index utf8 uv_indices "
    "uv_mapping uv_vectors v_steps variance vertex_vectors warning warp water_level waves while width wood "
    "wrinkles write ";

static const struct {
    const char *name;
    Directive directive;
} directives[] = {
    {"if", DIR_IF},           {"ifdef", DIR_IFDEF},     {"ifndef", DIR_IFNDEF},   {"while", DIR_WHILE},
    {"for", DIR_FOR},         {"switch", DIR_SWITCH},   {"macro", DIR_MACRO},     {"else", DIR_ELSE},
    {"elseif", DIR_ELSEIF},   {"case", DIR_CASE},       {"range", DIR_RANGE},     {"break", DIR_BREAK},
    {"end", DIR_END},         {"declare", DIR_DECLARE}, {"local", DIR_LOCAL},     {"undef", DIR_UNDEF},
    {"include", DIR_INCLUDE}, {"default", DIR_DEFAULT}, {"version", DIR_VERSION}, {"debug", DIR_DEBUG},
    {"warning", DIR_WARNING}, {"error", DIR_ERROR},     {"render", DIR_RENDER},   {"statistics", DIR_STATISTICS},
    {"fopen", DIR_FOPEN},     {"fclose", DIR_FCLOSE},   {"read", DIR_READ},       {"write", DIR_WRITE},
};

static void grow(Sdl *sdl)
{
    uint32_t nbuckets = sdl->nbuckets * 4;
    Word **buckets = sdl_alloc(sdl, nbuckets * sizeof *buckets);
    for (uint32_t i = 0; i < sdl->nbuckets; i++)
        for (Word *word = sdl->buckets[i], *next; word; word = next) {
            next = word->next;
            word->next = buckets[word->hash & (nbuckets - 1)];
            buckets[word->hash & (nbuckets - 1)] = word;
        }
    sdl->buckets = buckets;
    sdl->nbuckets = nbuckets;
}

Word *word_intern(Sdl *sdl, const char *text, size_t length)
{
    uint32_t hash = 2166136261u;
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)text[i]) * 16777619u;
    hash ^= hash >> 15;
    for (Word *word = sdl->buckets[hash & (sdl->nbuckets - 1)]; word; word = word->next)
        if (word->hash == hash && word->length == length && memcmp(word->text, text, length) == 0)
            return word;
    if (sdl->nwords >= sdl->nbuckets)
        grow(sdl);
    Word *word = sdl_alloc(sdl, sizeof *word);
    char *copy = sdl_alloc(sdl, length + 1);
    memcpy(copy, text, length);
    word->text = copy;
    word->length = length;
    word->hash = hash;
    word->next = sdl->buckets[hash & (sdl->nbuckets - 1)];
    sdl->buckets[hash & (sdl->nbuckets - 1)] = word;
    sdl->nwords++;
    return word;
}

void words_begin(Sdl *sdl)
{
    sdl->nbuckets = 4096;
    sdl->buckets = sdl_alloc(sdl, sdl->nbuckets * sizeof *sdl->buckets);
    for (const char *word = reserved_words; *word;) {
        size_t length = strcspn(word, " ");
        word_intern(sdl, word, length)->reserved = 1;
        word += length + 1;
    }
    for (int i = 0; i < builtin_count(); i++) {
        Word *word = word_intern(sdl, builtins[i].name, strlen(builtins[i].name));
        word->reserved = 1;
        word->builtin = &builtins[i];
    }
    for (size_t i = 0; i < sizeof directives / sizeof *directives; i++)
        word_intern(sdl, directives[i].name, strlen(directives[i].name))->directive = (uint8_t)directives[i].directive;
}

const char *word_nearest(Sdl *sdl, const char *name)
{
    RetexNearest nearest = {name, NULL, 0};
    for (uint32_t i = 0; i < sdl->nbuckets; i++)
        for (const Word *word = sdl->buckets[i]; word; word = word->next)
            if (word->symbol || word->reserved)
                retex_nearest_try(&nearest, word->text);
    return nearest.best;
}

const char *directive_nearest(const char *name)
{
    RetexNearest nearest = {name, NULL, 0};
    for (size_t i = 0; i < sizeof directives / sizeof *directives; i++)
        retex_nearest_try(&nearest, directives[i].name);
    return nearest.best;
}
