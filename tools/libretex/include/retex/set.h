/* The set: everything one render leaves for retexturing.
 *
 * A set is a polynomial in the textures, per pixel:
 *
 *     I = sum over terms t of  C_t * product over the factors f of t of  A_f
 *
 * over terms that count: those of role PICTURE and LAMP_PICTURE stand for the sum of others where nothing else is
 * edited, and those of LAMP add what a lamp has beyond all others (RetexRole). C_t is a radiance image. A factor is a
 * quantity of the (new) texture at a footprint, or at several of them (a mixture); an image; or a parameter, which has
 * one value for the whole picture. A footprint holds, per pixel, where on its target the light that reached the pixel
 * met it: mean UV, its spread, and the mean original albedo found there. A target that keeps its original is a factor
 * too, by that mean; corrections make up for what a product of means differs from the mean of products. Both layouts,
 * 'paper' and 'footprints', are such polynomials and differ only in which terms and footprints they list.
 * Source: 'Efficient physically-based retexturing in image-space', supplement 4.2 Eq. 4 and 4.3.
 *
 * On disk: a multi-part OpenEXR file. Part 0 is the beauty picture (plain R,G,B), so that any viewer shows something;
 * the string attribute `retex` of part 0 is the manifest, JSON, described in retex-set(5). */
#ifndef RETEX_SET_H
#define RETEX_SET_H

#include <stddef.h>
#include <stdint.h>
#include <retex/image.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_FORMAT_VERSION 1 /* of sets, samples, streams, packs and pages, see retex-set(5) */
#define RETEX_MAX_TARGETS 8
#define RETEX_MAX_ORDERS 6   /* hits of one target that a path keeps apart */
#define RETEX_MAX_HITS 12    /* hits of all targets together that a path keeps apart */
#define RETEX_MAX_FACTORS 16 /* of a term: its hits, images and parameters */
#define RETEX_PARAMETERS_MAX 64
#define RETEX_MIXTURES_MAX (5 * RETEX_MAX_TARGETS + 1)
#define RETEX_SHARES_MAX 20
#define RETEX_FINISHES_MAX 4 /* of a target */
#define RETEX_AXES 4        /* channels of a part of axes */
#define RETEX_QUADRANTS 4   /* of a pixel */
#define RETEX_NAME_MAX 128  /* bytes of a target or part name, with the final NUL */
#define RETEX_TEXTURE_TEXT_MAX 256 /* bytes of a texture in words, with the final NUL: longer ones are cut off */
#define RETEX_SCENE_MAX 256 /* bytes of a scene's name, with the final NUL: longer ones are cut off */

typedef struct RetexSetSource RetexSetSource; /* where rows of parts are that are not in memory: a file that is open */

/* One named image of the file. All AOVs have the set's size, but those that a footprint, a mixture's weight or an IMAGE
 * factor refers to may be smaller by a scale of 2, 4 or 8: ceil(width / scale) x ceil(height / scale) pixels, of which
 * each stands for scale x scale of the picture's. What is made of them (samples, mixtures, products) is enlarged
 * bilinearly, its pixels' values lying at their centres. Originals have a size of their own. letters names its channels
 * ("RGB", "RGA", "RG", "R"): the EXR channels are `R` in part 0 and `NAME.R` in all others. Values are float in memory;
 * type is how they are stored. */
typedef struct RetexPart {
    char name[RETEX_NAME_MAX]; /* letters, digits, '_' and '-' */
    char letters[8];
    RetexPixelType type;
    uint32_t crc; /* CRC-32 of the stored samples, planes in the order of letters, little-endian, rows from the top;
                     filled by reading and writing */
    RetexSetSource *source; /* where its rows are, or NULL: in memory */
    int source_part;        /* its number there */
    RetexImage image;       /* has its size, but no pixels where these are in the source alone */
} RetexPart;

typedef struct RetexTarget {
    char name[RETEX_NAME_MAX];
    char idents[512];            /* the scene's identifiers it was made of, comma-separated */
    int periodic[2];             /* 1: the surface closes in u (or v): 0 and 1 are the same place */
    double uv_min[2], uv_max[2]; /* range of UV that was met */
    float mean_albedo[3];        /* of the original, over all that was met; scene-linear */
    int original;                /* part that holds the original texture over original_min..original_max, or -1 */
    double original_min[2], original_max[2]; /* UV rectangle the original covers: an image_map's is 0,0 1,1 */
    double uv_scale[2]; /* scene units a unit of u and of v spans on the surface, at the median; 0 = unknown */
    double share;       /* of the picture's pixels, whose centre sees the target directly; 0..1 */
    int nfinishes;      /* 0: it has the one that it was rendered with; else 2..RETEX_FINISHES_MAX, to choose from */
    char finishes[RETEX_FINISHES_MAX][RETEX_NAME_MAX]; /* their names */
    int finish;         /* the number of the one in the picture as rendered, from 1; 0: it has none to choose from */
    float finish_roughness[RETEX_FINISHES_MAX]; /* of each, 0 a mirror, 1 matt, as maps of roughness have it; -1: of a
                                                   metal, or unknown */
    double normal_tilt; /* degrees, 0..90. Above 0: its finishes are three, of which the second and third are the
                           first with the normal of the diffuse lobe tilted to where u grows, and v, for textures'
                           normal maps. There is nothing to choose then. 0: it takes no normal maps */
    char texture[RETEX_TEXTURE_TEXT_MAX]; /* the texture that is laid on it, in words, for people to read; "": none */
    int gates; /* of a texture laid on it that has a map of finishes or normals: 1 + part "RGB", of which red, green and
                  blue are the weights of the second finish and later ones; 0: there is no map */
} RetexTarget;

typedef enum RetexFootprintKind {
    RETEX_FOOTPRINT_HIT,            /* layout paper: the j-th hit of the target along the path */
    RETEX_FOOTPRINT_SHARP,          /* layout footprints: met first, seen directly, in mirrors or through glass */
    RETEX_FOOTPRINT_BROAD,          /* met first, by light scattered widely before */
    RETEX_FOOTPRINT_INTERREFLECTION /* hits after the first one, pooled into two, up to four where that shows */
} RetexFootprintKind;
enum { RETEX_FOOTPRINT_KINDS = RETEX_FOOTPRINT_INTERREFLECTION + 1 };

typedef struct RetexFootprint {
    int target; /* index of the target it lies on */
    int hit;    /* its number among the target's, from 1; layout paper: the how-manieth hit it is of */
    RetexFootprintKind kind;
    int uv;       /* part "RGA": mean u, mean v, and coverage: the share of samples with a connection, of
                                layout footprints that of the effective ones, (sum of weights)^2 / sum of squares;
                                0 = this pixel has no such footprint and u, v mean nothing. float */
    int spread;   /* part "RG": standard deviation of u and of v, or "RGB": also their correlation. half. Of a footprint
                   that is a parallelogram its axes, part "RGBA": du/dx, dv/dx, du/dy, dv/dy for a step of a pixel to
                   the right and down */
    int albedo;   /* part "RGB": mean original albedo, weighted by the light it multiplies. half */
    int quadrant; /* of a parallelogram: 0 is the whole pixel, 1 to 4 its quarter at the upper left, upper right, lower
                     left and lower right, with the centre uv -+ axes / 4 and half the axes. Else 0 */
    int sampled;  /* 1 + part "RGB", of the size of the others: what the texture that is laid on the target shows there.
                     float. 0: none is laid on it */
    int finished[RETEX_FINISHES_MAX]; /* 1 + part: the same times the weight of each finish, of a texture that has a map
                                         of finishes or normals; else 0 */
} RetexFootprint;

/* What a factor is. A later version may add kinds. */
typedef enum RetexFactorKind {
    RETEX_FACTOR_FOOTPRINT, /* a quantity of the texture at a footprint */
    RETEX_FACTOR_MIXTURE,   /* the mean of a quantity over the footprints of a mixture */
    RETEX_FACTOR_IMAGE,     /* a part "R" or "RGB", but not the picture. half */
    RETEX_FACTOR_PARAMETER  /* a parameter of the set */
} RetexFactorKind;
enum { RETEX_FACTOR_KINDS = RETEX_FACTOR_PARAMETER + 1 };

/* Which quantity of a texture FOOTPRINT and MIXTURE stand for. A later version may add quantities. */
typedef enum RetexQuantity {
    RETEX_QUANTITY_COLOR,  /* its colour, scene-linear: the factor is a hit */
    RETEX_QUANTITY_FURTHER /* what light changes by that meets the texture more often than the term has hits, and is in
                              its radiance with original albedos: S(texture) / S(albedo), both means of a mixture,
                              with S(a) = 1 + q a + ... + (q a)^n for the set's further_ratio q and further_hits n */
} RetexQuantity;
enum { RETEX_QUANTITIES = RETEX_QUANTITY_FURTHER + 1 };

typedef struct RetexFactor {
    RetexFactorKind kind;
    RetexQuantity quantity; /* COLOR for kinds that have none */
    int index;              /* of a footprint, mixture, part or parameter */
} RetexFactor;

/* Which light a term is. */
typedef enum RetexRole {
    RETEX_ROLE_FULL,   /* layout paper: paths that met no target */
    RETEX_ROLE_INDEP,  /* no texture: every hit took its albedo-independent part. Layout footprints: full as well */
    RETEX_ROLE_DEP,    /* layout paper: every hit (of up to three) took its albedo-dependent part; of more hits also
                          mixed terms */
    RETEX_ROLE_CROSS2, /* layout paper: cross terms of paths with two hits, supplement 4.3 */
    RETEX_ROLE_CROSS3, /* layout paper: cross terms of paths with three hits */
    RETEX_ROLE_SHARP,  /* layout footprints: light whose first hit is a footprint of kind SHARP */
    RETEX_ROLE_BROAD,  /* layout footprints: light whose first hit is a footprint of kind BROAD */
    RETEX_ROLE_INTERREFLECTION, /* light that has hits of kind INTERREFLECTION only */
    RETEX_ROLE_CORRECTION,      /* of either sign; it has the parameter of kind CORRECTION of its target */
    RETEX_ROLE_PICTURE,         /* part 0, without factors: the picture with all originals and all parameters as
                                   rendered. It is not added to the others: where nothing is edited it stands for their
                                   sum, from which rounding has not taken anything. At most one term has it */
    RETEX_ROLE_LAMP,            /* light of one lamp, for the value 1 of its parameter of kind COLOR, which is a factor.
                                   Of the light that all lamps have in common, in times of `kept`, the other terms are
                                   the sum; of these counts what each lamp has beyond */
    RETEX_ROLE_LAMP_PICTURE     /* the picture by one lamp with all originals, for the value 1 of its parameter of kind
                                   COLOR, its only factor. Where no target is edited, and a lamp has a value that it
                                   was not rendered with, their sum is the picture */
} RetexRole;
enum { RETEX_ROLES = RETEX_ROLE_LAMP_PICTURE + 1 };

typedef struct RetexTerm {
    RetexRole role;
    int target;   /* which its first hit is on, of CORRECTION: which is edited; -1: none */
    int radiance; /* part "RGB". half */
    int nfactors; /* 0..RETEX_MAX_FACTORS; of these 0..RETEX_MAX_HITS footprints and mixtures */
    RetexFactor factors[RETEX_MAX_FACTORS]; /* in the order of multiplication */
    float noise_weight; /* by which its light, with the parameters as rendered, is multiplied in the sum whose noise is
                           stored: 2^-RETEX_MAX_HITS..1. 0: 1/2 for each further hit */
} RetexTerm;

typedef enum RetexParameterKind {
    RETEX_PARAMETER_COLOR,     /* set by whoever edits: the colour of a lamp, scene-linear Rec.709 */
    RETEX_PARAMETER_CORRECTION /* weight of a target's corrections, see retex_correction_weight: set by recombination */
} RetexParameterKind;
enum { RETEX_PARAMETER_KINDS = RETEX_PARAMETER_CORRECTION + 1 };

/* A number by colour that is the same in all pixels. */
typedef struct RetexParameter {
    char name[RETEX_NAME_MAX]; /* not empty; no two parameters of a set share a name */
    RetexParameterKind kind;
    int target;     /* of CORRECTION: which is edited; else -1 */
    float value[3]; /* as rendered; not negative. CORRECTION: 0 */
    float kept[3];  /* of COLOR, in sets with terms of role LAMP: its value in all other terms. It is `value`, but
                       where that has a channel of 0: of a lamp that is off it is what makes it shine. 0 0 0 becomes
                       `value` */
    int several;    /* of COLOR: 1: the lamp has light of several colours, by which its value is multiplied; 0: the
                       value is the colour of its light */
    /* Of COLOR, in a set whose targets have finishes; else "" and all 0. */
    char lamp[RETEX_NAME_MAX];                /* the lamp whose light it is; "": all light */
    signed char finishes[RETEX_MAX_TARGETS]; /* by target, the number of the finish with which the light met it, from 1;
                                                 all 0: paths that met no target which has several */
} RetexParameter;

#define RETEX_SCALE_MAX 8
#define RETEX_FURTHER_HITS_MAX 255
#define RETEX_FURTHER_RATIO_MAX 2

/* The mean of several footprints' textures, pixel by pixel: sum of weights times textures over the sum of weights. A
 * colour that has no weight takes the mean of those that have; 0 where none has. It stands for hits that are not kept
 * apart: of all clusters of a kind, of several later ones, or of several targets. Its footprints and weights all have
 * one scale. */
typedef struct RetexMixture {
    int nshares;
    struct RetexShare {
        int footprint;
        int weight; /* part "R", or "RGB": colour by colour. Not negative. half */
    } shares[RETEX_SHARES_MAX];
} RetexMixture;

/* A set is opaque: it is read by retex_set_open and others of <retex/set_file.h>, built by <retex/host/set_build.h>,
 * and looked at by the calls below. */
typedef struct RetexSet RetexSet;

/* What a set says about itself as a whole. The texts belong to the set. */
typedef struct RetexSetInfo {
    size_t size; /* sizeof(RetexSetInfo): a later version may add members at the end */
    int width, height;
    const char *layout;    /* "footprints", "paper", or "plain": no terms */
    const char *filter;    /* pixel filter: "box" or "gaussian" */
    const char *scene;     /* base name of the scene file */
    const char *generator; /* program and version: "retex-render 1.0" */
    int orders, spp, max_depth;
    uint32_t seed;
    uint32_t id;         /* tells one render's set from another's; kept by packing; 0 = unknown */
    int denoised;        /* 1: the coefficients were filtered, see denoise.h */
    int strict_paper;    /* 1: mixed terms of 4 and more hits were dropped, as the supplement does */
    double folded;       /* share of the picture's luminance whose hits beyond `orders` kept their original albedo */
    double folded_white; /* layout footprints: the same share, were every target painted white (albedo 0.8) */
    int ntargets, nfootprints, nmixtures, nterms, nparameters, nparts;
    int further_hits;       /* 0..RETEX_FURTHER_HITS_MAX: see RETEX_QUANTITY_FURTHER; 0: no factor has that quantity */
    float further_ratio[3]; /* of light with one more hit to light without it, textures left out; 0..2 */
    double unit;            /* metres of a scene unit, above 0, for lengths of textures that have a unit; 1 where the
                               scene did not say */
    double depth_cut;       /* share of the light, of what there is and what max_depth left out, that was left out: an
                               estimate; 0: none, or not known */
    double exposure;        /* stops: the picture has the scene's light times 2^exposure; 0 where nothing was said */
    int is_samples;         /* 1: a file of samples: targets, footprints and textures laid on them, but no picture and
                               no terms. See retex_set_open_any */
} RetexSetInfo;

/* Fill what info->size says that the caller knows. */
void retex_set_get_info(const RetexSet *set, RetexSetInfo *info);
static inline RetexSetInfo retex_set_info(const RetexSet *set)
{
    RetexSetInfo info;
    info.size = sizeof info;
    retex_set_get_info(set, &info);
    return info;
}

/* One of what a set lists; NULL where index is not 0..count-1. It belongs to the set, and stays until the set is
 * changed or closed. A later version may add members at the end of these structs, so programs neither copy them nor put
 * them into arrays. Renderers, which make them, depend on the version of <retex/host/>. Part 0 is the beauty. */
const RetexTarget *retex_set_target(const RetexSet *set, int index);
const RetexFootprint *retex_set_footprint(const RetexSet *set, int index);
const RetexMixture *retex_set_mixture(const RetexSet *set, int index);
const RetexTerm *retex_set_term(const RetexSet *set, int index);
const RetexParameter *retex_set_parameter(const RetexSet *set, int index);
const RetexPart *retex_set_part(const RetexSet *set, int index);

void retex_set_close(RetexSet **set); /* NULL and pointers to NULL are fine */
/* Names in the manifest: of a RetexFootprintKind "hit", "sharp", "broad" or "interreflection", also in names of parts;
 * of a RetexRole "full" and so on; of a RetexFactorKind "footprint", "mixture", "image" or "parameter"; of a
 * RetexQuantity "color"; of a RetexParameterKind "color" or "correction". */
const char *retex_footprint_kind_name(int kind);
const char *retex_role_name(int role);
const char *retex_factor_kind_name(int kind);
const char *retex_quantity_name(int quantity);
const char *retex_parameter_kind_name(int kind);

/* A factor of that kind, of quantity COLOR. */
static inline RetexFactor retex_factor(RetexFactorKind kind, int index)
{
    RetexFactor factor;
    factor.kind = kind;
    factor.quantity = RETEX_QUANTITY_COLOR;
    factor.index = index;
    return factor;
}
/* 1: it depends on a texture. */
static inline int retex_factor_is_texture(RetexFactor factor)
{
    return factor.kind == RETEX_FACTOR_FOOTPRINT || factor.kind == RETEX_FACTOR_MIXTURE;
}
/* 1: it is a hit, which light is multiplied by once. */
static inline int retex_factor_is_hit(RetexFactor factor)
{
    return retex_factor_is_texture(factor) && factor.quantity == RETEX_QUANTITY_COLOR;
}
/* 1: the term is part of the sum that is the picture as rendered; 0: a correction, a picture, or a lamp. */
static inline int retex_term_is_light(const RetexTerm *term)
{
    return term->role < RETEX_ROLE_CORRECTION;
}
/* 1: the term is a picture, of all light or of one lamp, that stands for the sum of others. */
static inline int retex_term_is_picture(const RetexTerm *term)
{
    return term->role == RETEX_ROLE_PICTURE || term->role == RETEX_ROLE_LAMP_PICTURE;
}
/* The number of hits of a term: of its footprints and mixtures of quantity COLOR. */
int retex_term_hits(const RetexTerm *term);
/* The part of a term's first IMAGE factor, or -1. */
int retex_term_image(const RetexTerm *term);

/* The parameter of that name, or -1. */
int retex_set_find_parameter(const RetexSet *set, const char *name);
/* The parameter of the lamp whose light or picture, or the correction of that, a term is; -1: all light. Only sets that
 * have terms of role LAMP have such terms. */
int retex_set_term_lamp(const RetexSet *set, const RetexTerm *term);
/* 1: some target has finishes to choose from. */
int retex_set_has_finishes(const RetexSet *set);
/* The name of the lamp whose value a parameter is: its own, or in a set with finishes that of its light which met no
 * target that has them. NULL: it is another parameter. */
const char *retex_parameter_lamp(const RetexSet *set, int parameter);
/* 1: the set has lamps. */
int retex_set_has_lamps(const RetexSet *set);
/* 1: the set has a term of that role. */
int retex_set_has_role(const RetexSet *set, RetexRole role);
int retex_set_find_part(const RetexSet *set, const char *name); /* index or -1 */
/* The scale of an image, 1, 2, 4 or 8: how many times smaller than the set it is; 0 where it has none of these
 * sizes. */
int retex_set_scale(const RetexSet *set, const RetexImage *image);
/* 1 if the part holds colours, scene-linear Rec.709: the picture, radiance, albedos and originals. 0: other values. */
int retex_set_part_is_color(const RetexSet *set, int part);
/* The weight of the corrections of each edited target, where `edited` of `ntargets` have a new texture: 1 of one, 0 of
 * all, between them linear, divided among the edited ones. */
double retex_correction_weight(int ntargets, int edited);
/* The target of that name, exactly, else ignoring case if that is unique, else the one whose only identifier that is;
 * or -1. */
int retex_set_find_target(const RetexSet *set, const char *name);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
