/* Pigments, patterns, images and normals of a scene (scene.h). */
#ifndef RENDERER_SCENE_PIGMENT_H
#define RENDERER_SCENE_PIGMENT_H

#include <stdint.h>
#include <retex/image.h>
#include <retex/set.h>
#include <retex/texture.h>
#include "base/arena.h"
#include "base/vec.h"

/* A colour of the language: filter tints what passes by the colour, transmit does not. */
typedef struct Rgbft { float r, g, b, filter, transmit; } Rgbft;

/* Names #declared in the scene that a thing came through: `texture{Oak}` carries Oak, and the names Oak itself was made
 * of. Targets are found by them. The list is immutable, so that lists can share their ends. */
typedef struct IdentList {
    const char *name;
    int line;
    const struct IdentList *next;
} IdentList;

/* Where the statements stand that a thing is from, from the inside out: those of its shape, of the compounds that it is
 * in, of `object{Ident}`. What a macro writes stands where the macro is called. Immutable and shared, as IdentList. */
typedef struct PlaceList {
    const char *file;
    int line;
    const struct PlaceList *next;
} PlaceList;

/* ---- pigments ---- */

typedef enum PigmentKind {
    PIGMENT_COLOR,
    PIGMENT_IMAGE,
    PIGMENT_PATTERN,
    PIGMENT_AVERAGE /* the mean of the map's entries, by their values as weights */
} PigmentKind;
typedef enum MapType {
    MAP_PLANAR = 0,
    MAP_SPHERICAL = 1,
    MAP_CYLINDRICAL = 2,
    MAP_TORUS = 5,
    MAP_ANGULAR = 7 /* a light probe: angles from the z axis are distances from the middle */
} MapType;

/* The space of which the scene's colours are numbers. Pigments blend in it. */
typedef enum WorkingSpaceKind { WORKING_LINEAR, WORKING_SRGB, WORKING_POWER } WorkingSpaceKind;
typedef struct WorkingSpace {
    WorkingSpaceKind kind;
    double gamma; /* of WORKING_POWER */
    int dark_filters_hide; /* before version 3.7: the darker a colour, the less its filter lets what is below be seen */
} WorkingSpace;

struct Pigment;
typedef struct ColorMapEntry {
    double value;
    Rgbft color;                   /* of the working space; of a pigment, its mean */
    const struct Pigment *pigment; /* or NULL. It lies in the pattern space of the pigment with the map */
} ColorMapEntry;
typedef struct ColorMap {
    int count; /* entries sorted by value; two of one value make a step */
    ColorMapEntry *entries;
} ColorMap;
typedef enum WaveKind { WAVE_RAMP, WAVE_TRIANGLE, WAVE_SINE, WAVE_SCALLOP, WAVE_CUBIC, WAVE_POLY } WaveKind;

/* What is done to UV after the projection. */
typedef struct ImagePlacement {
    Vec2 repeat, offset;     /* times repeat, minus offset */
} ImagePlacement;

/* An image file in the scene's memory; one for each file and interpretation. */
typedef struct ImageMap {
    const char *path;        /* as found on disk; NULL: the scene draws it */
    RetexTexture *texture;   /* scene-linear, alpha unassociated; owned by the scene (closed with it) */
    int width, height;
    int has_alpha;
    MapType map_type;
    const ImagePlacement *place; /* or NULL */
    int once;                /* 1: outside (0,0)-(1,1) fully transparent */
    int interpolate;         /* POV-Ray's: 0 none (nearest texel), 2 bilinear, 3 bicubic, 4 normalised distance; others
                                are taken as bilinear */
    float filter_all, transmit_all;
    const unsigned char *indices; /* of a material_map: of each texel, row by row from the top; else NULL */
    const float (*transparency)[2]; /* filter and transmit of each texel, row by row from the top, where a palette's
                                entries have their own, instead of those of all; or NULL */
} ImageMap;

typedef struct PatternOps PatternOps; /* pattern/pattern.h */
typedef struct Warp Warp;             /* pattern/warp.h */
typedef struct Turbulence {
    Vec3 amount;
    double lambda, omega, octaves; /* see noise_turbulence */
} Turbulence;
/* A function of space, with its arguments. */
typedef struct Pattern {
    const PatternOps *ops;
    Vec3 vector;             /* the direction written after the keyword, unit length */
    double number;
    double agate_turbulence;
    double control[2];       /* of quilted: how it begins and ends */
    struct Crackle {
        Vec3 form;           /* factors of the distances to the three nearest points */
        double metric, offset;
        int is_solid;
    } crackle;
    const void *data;        /* what else the row's value reads */
    const int *number_of_waves; /* the scene's; NULL: the default, 10 */
    const int *noise_generator; /* its own, or the scene's; NULL: the default one. See base/noise.h */
    const Warp *warps;       /* the last written first */
    Turbulence turbulence;   /* next to the pattern, after all warps */
    WaveKind wave;           /* of patterns that make a value 0..1 */
    double frequency, phase, wave_exponent;
} Pattern;
enum { PATTERN_COLORS = 6 }; /* the longest list of colours */

typedef struct Pigment {
    PigmentKind kind;
    Rgbft color;             /* PIGMENT_COLOR, or is_tinted: scene-linear */
    Pattern pattern;         /* PIGMENT_PATTERN */
    ColorMap map;            /* by the pattern's value; empty = black to white. Of patterns that choose among colours,
                                colour i is entry i, with the value i */
    const WorkingSpace *space; /* of the map's colours; NULL: linear */
    ImageMap *image;         /* PIGMENT_IMAGE */
    int is_tinted;           /* PIGMENT_IMAGE: the image's colours times `color` */
    int uv_mapping;
    int second_uv;           /* of maps of our extension: they take the mesh's second set of UV */
    Transform transform;     /* pattern space to world; inverse takes a world point to where the pattern is evaluated.
                                With uv_mapping it takes (u, v, 0) instead of the point */
    const IdentList *idents;
} Pigment;

/* ---- normals ---- */

/* A picture as heights: its grey values 0..1 or, with use_index, the indices of its palette. Rows from the top. */
typedef struct BumpMap {
    ImageMap image;          /* how it is projected; no texture, no colours */
    const float *heights;
} BumpMap;

typedef struct SlopeMapEntry { double value, height, slope; } SlopeMapEntry;
typedef struct NormalMapEntry {
    double value;            /* of the pattern; of `average` its weight */
    const struct Normal *normal;
} NormalMapEntry;

typedef enum NormalKind {
    NORMAL_SLOPE,            /* by the slope of the pattern's value */
    NORMAL_VECTORS,          /* by a field of vectors: the pattern has one, see shade/normal_vectors.c */
    NORMAL_IMAGE,
    NORMAL_TANGENT,          /* by a normal map in tangent space */
    NORMAL_HEIGHTS,          /* by heights at the shape's UV, in units of the scene */
    NORMAL_MAP,              /* normals by the pattern's value, or which of a list's */
    NORMAL_AVERAGE
} NormalKind;

/* How far apart two pixels of the picture are at a point: `apart`, and angle times its distance from the eye. A render
 * sets it; 0 before. */
typedef struct PixelSize {
    Vec3 eye;
    double angle, apart;
} PixelSize;

/* What tilts the normals of a surface. */
typedef struct Normal {
    NormalKind kind;
    Pattern pattern;
    double size;             /* bump_size */
    double accuracy;         /* NORMAL_SLOPE: how far apart the points are whose values are compared */
    int keeps_size;          /* no_bump_scale */
    int uv_mapping;          /* evaluated at (u, v, 0), on the shape's normal as it is in world space */
    int nslopes, nentries;
    const SlopeMapEntry *slopes; /* NORMAL_SLOPE: a curve over the value; sorted by value */
    const NormalMapEntry *entries; /* NORMAL_MAP: sorted by value, or the list; NORMAL_AVERAGE */
    const BumpMap *bump_map;
    const Pigment *vectors;  /* NORMAL_TANGENT: colours that stand for vectors, at the shape's UV; NORMAL_HEIGHTS:
                                whose luminance times size is the height */
    double strength;         /* NORMAL_HEIGHTS: 1, or less for a mixture with the normal without bumps */
    const struct PixelSize *pixels; /* NORMAL_HEIGHTS: the scene's */
    struct Facets {
        double size, coords, metric; /* coords 0: a facet is where normals are alike, else where points are */
    } facets;
    Transform transform;     /* pattern space to world, as of pigments */
} Normal;

#endif
