/* Finishes, interiors and textures of a scene (scene.h). */
#ifndef RENDERER_SCENE_TEXTURE_H
#define RENDERER_SCENE_TEXTURE_H

#include "scene/pigment.h"

typedef struct Finish {
    Rgb ambient, emission;
    int emission_of_ambient; /* all of it */
    double diffuse, diffuse_back;
    int diffuse_albedo;      /* `diffuse albedo D` */
    double brilliance, crand;
    double phong, phong_size;
    int phong_albedo;
    double specular, roughness;
    int specular_albedo;
    double metallic;         /* tints highlights by the pigment */
    Rgb reflection_min, reflection_max;
    int reflection_fresnel;
    double reflection_falloff, reflection_exponent, reflection_metallic;
    int conserve_energy;
    int use_alpha;           /* highlights and mirror count by the pigment's opacity */
    double irid, irid_thickness; /* thin film: its amount, and its thickness in units of irid_wavelength */
    double irid_turbulence;  /* by which share the thickness varies */
    Rgb irid_phase;          /* 2 pi thickness / wavelength; set at the end of reading, as the next one */
    int irid_noise;          /* noise generator of its turbulence */
    Rgb translucency;        /* of subsurface, in millimetres */
    Rgb mean_free_path;      /* the same in units; black: there is none. Set at the end of reading */
    /* The extension block `retex { … }`: the simplified Disney BSDF of the supplement and rough dielectrics. Where it
     * is present it replaces all of the above but ambient and emission. */
    struct {
        int present;
        double metallic;     /* m, 0..1 */
        double roughness;    /* r, 0..1; GGX alpha = r^2 */
        double ior;          /* eta of the dielectric coat and of transmission; default 1.5 */
        double specular_tint; /* t, scalar, 0..1; default 1 (F0 as it is) */
        double transmission; /* 0..1: share of the base that is a (rough) dielectric and lets light through */
        double clearcoat, clearcoat_roughness; /* weight, 0..1; GGX alpha is the square of the roughness */
        Rgb sheen;           /* of fibres; black: there is none */
        double sheen_roughness;
        /* At the shape's UV; their luminance is a factor. NULL = 1. */
        const Pigment *metallic_map, *roughness_map, *transmission_map, *clearcoat_map, *clearcoat_roughness_map;
        const Pigment *sheen_map;    /* multiplies its colour. Or NULL */
        const Normal *clearcoat_normal; /* NORMAL_TANGENT, or NULL: the coat is flat */
        const Pigment *emission_map; /* at the shape's UV; multiplies emission in place of the pigment. Or NULL */
    } retex;
    int lambert, matte;      /* finish_is_lambert, finish_is_matte; set at the end of reading; 0 is only slower */
} Finish;

/* What a finish has where nothing else is said, as designators; a scene's have an ambient besides. */
#define FINISH_DEFAULTS                                                                                                \
    .diffuse = 0.6, .brilliance = 1, .phong_size = 40, .roughness = 0.05, .reflection_falloff = 1,                     \
    .reflection_exponent = 1, .retex.ior = 1.5, .retex.specular_tint = 1, .retex.sheen_roughness = 0.3

static inline int finish_is_mirror(const Finish *f)
{
    return !rgb_is_black(f->reflection_min) || !rgb_is_black(f->reflection_max);
}
static inline int finish_is_subsurface(const Finish *f)
{
    return !f->retex.present && !rgb_is_black(f->mean_free_path);
}
/* Most surfaces scatter by Lambert's law alone, matte ones on the side that is seen only: they need less work. */
static inline int finish_is_lambert(const Finish *f)
{
    return !f->retex.present && f->specular <= 0 && f->phong <= 0 && f->brilliance == 1 &&
           f->crand <= 0 && f->irid <= 0 && !finish_is_mirror(f) && rgb_is_black(f->mean_free_path);
}
static inline int finish_is_matte(const Finish *f)
{
    return finish_is_lambert(f) && f->diffuse_back <= 0 && f->diffuse > 0;
}
/* Whether the extension lets light through, whatever the pigment says. */
static inline int finish_transmits(const Finish *f)
{
    return f->retex.present && f->retex.transmission > 0 && (f->retex.metallic < 1 || f->retex.metallic_map);
}

/* Whether direct-light samples look for the light of an emitter. What `ambient` below 1 gives fills shadows: paths find
 * it with little noise, and samples are left to lamps. */
static inline int finish_is_sampled(const Finish *f)
{
    return !rgb_is_black(f->emission) && !(f->emission_of_ambient && rgb_max(f->emission) < 1);
}

typedef enum PhaseKind {
    PHASE_ISOTROPIC = 1,     /* POV-Ray's numbers */
    PHASE_MIE_HAZY = 2,
    PHASE_MIE_MURKY = 3,
    PHASE_RAYLEIGH = 4,
    PHASE_HENYEY_GREENSTEIN = 5
} PhaseKind;

/* What fills space, per unit of length where all its densities are 1. */
typedef struct Medium {
    Rgb absorption, emission, scattering;
    PhaseKind phase;
    double eccentricity;     /* of Henyey and Greenstein's phase function, -1 to 1 */
    double extinction;       /* share of the scattering that dims light; 1 in nature */
    int ndensities;          /* those that vary; each multiplies */
    const struct Pigment *const *densities;
    Rgb most;                /* bound of their product */
    const struct Medium *next;
} Medium;

typedef struct Interior {
    double ior;              /* default 1 */
    double dispersion;       /* ior of violet over that of red; 0 or 1: one ior for all colours */
    double fade_distance, fade_power;
    Rgb fade_color;
    const Medium *media;     /* a list, or NULL */
    const IdentList *idents;
} Interior;

static inline int interior_disperses(const Interior *in) { return in && in->dispersion > 0 && in->dispersion != 1; }
/* Whether what passes a surface of the object is refracted. */
static inline int interior_bends(const Interior *in)
{
    return in && in->ior > 0 && (in->ior != 1 || interior_disperses(in));
}

typedef struct Texture {
    const Pigment *pigment;
    const Finish *finish;
    const Normal *normal;    /* or NULL: smooth */
    const IdentList *idents; /* of the texture, its pigment and its material */
    int uv_mapping;          /* written at the texture's level; also set in the pigment */
    int target;              /* of a leaf of a tree, by its own idents: index into scene->targets, or -1 */
    const struct TextureTree *tree; /* or NULL: a plain texture. Else pigment and finish are those of its first leaf */
} Texture;

typedef enum TextureTreeKind {
    TEXTURE_LAYERS,   /* parts: the topmost first */
    TEXTURE_MAP,      /* by the selector's value, or by which of its colours it would choose */
    TEXTURE_AVERAGE,  /* by values as weights */
    TEXTURE_MATERIALS, /* by the index of the selector's image */
    TEXTURE_OPERANDS  /* of CSG with cutaway_textures: each operand that contains the point counts alike; where none
                         does, the first part */
} TextureTreeKind;

/* Operands that have one texture. */
typedef struct TextureOperands {
    int count;
    const struct CsgNode **nodes; /* leaves */
} TextureOperands;

/* Textures that make one together: in layers, or side by side with smooth or hard edges. Parts may be trees; the plain
 * textures are its leaves. */
typedef struct TextureTree {
    TextureTreeKind kind;
    const Pigment *selector; /* of maps and materials: its pattern, or its image; what else it has is not looked at */
    int count;
    const Texture **parts;
    const TextureOperands *operands; /* of each part, of TEXTURE_OPERANDS */
    const double *values; /* of a map's parts, ascending; weights of an average, their sum 1 */
    int is_untinted; /* of layers before version 3.5: filter tints nothing but what lies behind the lowest one */
    int nleaves;
    Texture **leaves; /* of all its parts: no two trees share a leaf */
} TextureTree;

static inline int texture_leaf_count(const Texture *texture) { return texture->tree ? texture->tree->nleaves : 1; }
static inline const Texture *texture_leaf(const Texture *texture, int k)
{
    return texture->tree ? texture->tree->leaves[k] : texture;
}

#endif
