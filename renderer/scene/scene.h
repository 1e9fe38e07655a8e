/* The scene: what the scene language leaves and everything after it reads. It is plain data, all of it in one arena.
 * Before a render begins, scene_resolve_targets and target_units_choose mark its targets, and the render sets `pixels`;
 * then nothing changes. Units are the scene's own, angles are in radians unless said, colours scene-linear Rec.709.
 *
 * Conventions of POV-Ray hold (left-handed, row-vector matrices already turned into Transforms). Where POV-Ray and
 * physics differ, the mapping is described in retex-scene(5) and done in shade/material.c, not here: this file keeps
 * what the author wrote. */
#ifndef RENDERER_SCENE_SCENE_H
#define RENDERER_SCENE_SCENE_H

#include <stdint.h>
#include <retex/image.h>
#include <retex/texture.h>
#include <retex/set.h>
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

/* ---- finish, interior, texture ---- */

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

/* ---- primitives ---- */

/* Triangles. Indices are into the arrays; a normal or UV index of -1 means that the corner has none. */
typedef struct MeshFace {
    int vertex[3], normal[3], uv[3];
    int texture;             /* index into the shape's textures; -1 = the primitive's own texture */
} MeshFace;
/* Of corners, for normal maps; see mesh_add_tangents. */
typedef struct MeshTangents {
    int count;
    Vec3 *vectors;           /* of unit length */
    int (*corners)[3];       /* of each face: indices, or -1 in all three */
} MeshTangents;
typedef struct Mesh {
    int nvertices, nnormals, nuvs, nfaces;
    Vec3 *vertices, *normals;
    Vec2 *uvs;
    MeshFace *faces;
    int (*corner_textures)[2]; /* of each face: textures of corners 1 and 2, where `texture` is that of corner 0; or
                                  NULL: each face has one texture */
    int closed_inside;       /* inside_vector was given: has an inside */
    int inward;              /* 1: the faces' winding (edge 01 x edge 02) points inside; set from mesh_winds_inward */
    const struct Bvh *tree;  /* over the faces, or NULL: see mesh_index */
    const MeshTangents *tangents; /* or NULL: each face has its own */
    const struct Mesh *second;    /* the same mesh with its second set of UV, or NULL */
} Mesh;

static inline int mesh_face_has_normals(const MeshFace *f)
{
    return f->normal[0] >= 0 && f->normal[1] >= 0 && f->normal[2] >= 0;
}
static inline int mesh_face_has_uvs(const MeshFace *f) { return f->uv[0] >= 0 && f->uv[1] >= 0 && f->uv[2] >= 0; }

static inline int mesh_face_blends(const Mesh *mesh, int face)
{
    const int *others = mesh->corner_textures ? mesh->corner_textures[face] : NULL;
    return others && (others[0] != mesh->faces[face].texture || others[1] != mesh->faces[face].texture);
}

typedef struct ShapeOps ShapeOps; /* shape/shape.h */

/* Textures of parts of a shape, in world space like all textures. ShapeOps.texture says which a point has. */
typedef struct FaceTextures {
    int count;
    const Texture **list;
} FaceTextures;

/* A shape in its canonical space, which shape/NAME.c describes, with its parameters there. */
typedef struct Shape {
    const ShapeOps *ops;
    double r0, r1;           /* radii, exponents and the like */
    int open;                /* of a cone: without caps */
    const Mesh *mesh;        /* of a mesh, and of nothing else; shared by copies that differ in transform only */
    const void *data;        /* what else the shape's operations read */
    const FaceTextures *textures; /* or NULL: the primitive's own is on all of it */
} Shape;

/* Primitives in a space of their own. They are where the prototype's instances are, and nowhere else. */
typedef struct Prototype {
    int number;              /* index into scene->prototypes */
    int first, count;        /* of scene->primitives */
    int ncsgs;
    struct Csg **csgs;       /* its trees: indices of their leaves count from first */
    int inherits;            /* some of its primitives do */
    const struct Prototype *next;
} Prototype;

/* A copy of a prototype. Where it has names or a texture that are targets, so are the primitives that have them. */
typedef struct Instance {
    const Prototype *prototype;
    Transform transform;     /* the prototype's space to the world */
    const Texture *texture;  /* in the prototype's space: of primitives that inherit theirs; NULL where none does */
    const IdentList *idents;
    const PlaceList *places;
    int target, texture_target; /* by idents; by the texture. -1: none */
    int lamp;                /* that its emission is of; -1: those of its primitives */
    int line;
} Instance;

/* Faces of a primitive that are targets by themselves, whatever the rest of it is. */
typedef struct FaceTargets {
    const int8_t *of;        /* of each face, as Hit counts them: the target, or -1 */
    int count;               /* the textures of these faces, each with each of their targets */
    struct FaceTexture {
        const Texture *texture;
        int target;
    } *textures;
} FaceTargets;

typedef struct Primitive {
    Shape shape;
    Transform transform;     /* canonical shape to world */
    const Texture *texture;  /* never NULL after parsing */
    const Texture *interior_texture; /* or NULL: the same on both sides */
    const Interior *interior; /* or NULL */
    int no_shadow, no_image, no_reflection, inverse, hollow;
    int double_illuminate;   /* 1: its diffuse lobes take light from both sides */
    const struct CsgNode *csg; /* its place in the tree of which it is an operand, or NULL; shape/csg.h */
    const struct LightGroup *light_group; /* that it is in, or NULL */
    const Prototype *prototype; /* that it is part of: its world is the prototype's space; or NULL */
    int inherits;            /* 1: its texture is the instance's */
    int is_solid;            /* 1: neither fog nor media are in it; 0 where the scene has none */
    int caustics;            /* CAUSTICS_…: of light sources that have caustics */
    const IdentList *idents; /* names of the objects it is part of */
    const PlaceList *places; /* their statements; NULL where the scene is made without a file */
    int line;                /* of the scene file, for messages */
    int target;              /* index into scene->targets, or -1; parts may have others, see face_targets */
    int interior_target;     /* the same for interior_texture */
    const int8_t *face_targets; /* of each of the shape's textures, or NULL: their targets instead */
    const FaceTargets *faces; /* or NULL: no face is a target by itself */
    int lamp;                /* of the scene's lamps, that its emission is of */
    const struct Target *unit_targets; /* the scene's targets, where one has a uv_unit or a projection, else NULL */
} Primitive;

/* ---- lights, camera, sky ---- */

/* How a primitive may throw caustics of light sources, and a light source may shine through such primitives. */
enum { CAUSTICS_REFRACT = 1, CAUSTICS_REFLECT = 2 };

/* A light_group: its lights shine only on what is in it, without the light groups within it. */
typedef struct LightGroup {
    int global_lights; /* lights of no light group shine on what is in it */
} LightGroup;

typedef struct LightOps LightOps; /* light/source.h */
typedef struct Light {
    const LightOps *ops;
    int lamp;                /* of the scene's lamps */
    const IdentList *idents; /* names of the objects it is part of */
    const PlaceList *places; /* their statements */
    Vec3 location, point_at;
    int is_aimed;            /* point_at is written */
    Rgb color;               /* irradiance pi * color on a surface that faces it */
    const struct Ies *ies;   /* light/ies.h: share of the colour by direction; NULL: its kind alone says */
    double ies_turn;         /* degrees, from the distribution's horizontal angle 0 to 90 */
    Vec3 ies_axes[3];        /* of unit length, in world space: horizontal angles 0 and 90, and vertical angle 0 */
    double radius, falloff;  /* spot: half-angles in degrees; cylinder: lengths */
    double tightness;
    double fade_distance, fade_power; /* fade_power 0 = none */
    int area;                /* 1: area_light */
    Vec3 axis1, axis2;
    int size1, size2;        /* lights along each axis */
    int circular, orient, jitter;
    int dimmed_by_air;       /* by fog and media of the scene, as media_attenuation says */
    int passes_media;        /* 1: no medium scatters its light */
    int area_illumination;   /* 1: each light of the grid shines from its own place; 0: all from the middle, and only
                                shadows are those of the grid */
    int shadowless;
    const struct Csg *projected_through; /* in world space, or NULL: only light that passes it shines on */
    const LightGroup *light_group; /* or NULL */
    int caustics;            /* CAUSTICS_…; 0: shines straight through glass */
    double size;             /* with caustics: radius of the sphere as which refracted and mirrored paths meet it */
} Light;

/* Whether a light source shines on what is in a light group, or in none. */
static inline int light_reaches(const Light *light, const LightGroup *light_group)
{
    return light->light_group == light_group || (!light->light_group && light_group->global_lights);
}

/* The density of points on a lens, row by row: cumulative sums that end at 1. */
typedef struct Bokeh {
    int size; /* rows; cells of each */
    float *rows, *cells;
} Bokeh;

typedef struct CameraLens {
    double aperture;       /* POV-Ray's: the disc has a quarter of it as its radius; 0 = everything is sharp */
    double focal_distance; /* along the direction of view */
    const Bokeh *bokeh;    /* or NULL: a disc */
} CameraLens;

/* What the rays of a mesh_camera start from. */
typedef struct CameraMesh {
    const Mesh *mesh;
    Transform transform; /* to the world */
    int nfaces;
    const int *faces;    /* those that have an area */
} CameraMesh;
typedef struct MeshCamera {
    int rays;            /* for each pixel */
    int distribution;    /* POV-Ray's distribution type, 0 to 3 */
    int smooth;          /* along interpolated normals */
    double length;       /* of rays; 0 = not limited */
    int nmeshes;
    const CameraMesh *meshes;
    /* distribution 3: faces of the first mesh by columns times columns cells of UV; those of cell k are from starts[k]
     * to starts[k + 1] in entries */
    int columns;
    const int *starts, *entries;
} MeshCamera;

typedef struct CameraOps CameraOps; /* camera/camera.h */
/* Transforms already applied. What right, up and direction mean is told where the kinds are. */
typedef struct Camera {
    const CameraOps *ops;
    Vec3 location, direction, right, up;
    Vec3 sky;                     /* what is above; not transformed */
    double angle, vertical_angle; /* degrees; of kinds that have them */
    CameraLens lens;
    const struct Normal *normal;  /* tilts rays by their place in the picture, or NULL */
    const MeshCamera *mesh;       /* of a mesh_camera, and of nothing else */
} Camera;

/* One that is #declared; no lens, no normal. */
typedef struct NamedCamera {
    const char *name;
    Camera camera;
} NamedCamera;

typedef struct SkySphere {
    int npigments;           /* later ones lie over earlier ones by their filter and transmit */
    const Pigment **pigments;
    Rgb emission;            /* factor on it, default 1 */
    int filters;             /* filter tints what lies below; in scenes before version 3.7 it is the same as transmit */
} SkySphere;

/* ---- air ---- */

typedef enum FogKind { FOG_CONSTANT, FOG_GROUND } FogKind;
typedef struct Fog {
    FogKind kind;
    double distance;         /* over which light falls to 1/e; above 0 */
    Rgb color;
    float filter, transmit;  /* its colour filters light; the least that passes */
    double offset, altitude; /* of ground fog: up to where it is full, and how far above that it is half */
    Vec3 up;                 /* unit length */
    int has_turbulence;
    Turbulence turbulence;
    double turbulence_depth;
    struct Fog *next;
} Fog;

typedef struct Rainbow {
    Vec3 direction, up, right; /* orthonormal: of its middle, and across it */
    double angle, width;     /* radians from the direction: of the bow's middle, and between its edges */
    double arc, falloff;     /* radians round the direction, from up to either side: where it ends and begins to fade */
    double distance;         /* over which light falls to 1/e */
    double jitter;           /* most that is added to the place in the map */
    const Pigment *colors;   /* by x, 0 at the inner edge and 1 at the outer one */
    struct Rainbow *next;
} Rainbow;

/* A finish that the scene declares, by its name. */
typedef struct NamedFinish {
    const char *name;
    const Finish *finish;
} NamedFinish;

/* What a target may be finished with, to choose after rendering. */
#define FINISHES_MAX RETEX_FINISHES_MAX
typedef struct TargetFinish {
    char name[RETEX_NAME_MAX];
    const Finish *finish; /* NULL: what the scene has */
} TargetFinish;

/* Of targets for whose textures normal maps can be chosen: degrees by which the normal is tilted in two of their
 * finishes. Of 10, 15 and 20 this was nearest to pictures rendered with maps of 10 and 30 degrees. */
#define NORMAL_TILT 15.0

/* What selects faces instead of objects; shape/faces.h tells which they are. */
typedef struct FaceSelection {
    int number, face; /* of the object, and of the face that was seen: both from 1 */
    int level;        /* 1: all faces of the scene on its level; 0: those of the object that are flat with it */
    const char *text;
} FaceSelection;

/* How a target gets UV that its model lacks; path/projection.h. */
typedef enum UvProjection {
    UV_UNSAID, /* planar where faces are selected, box where a target that is pointed at has none, else the model's */
    UV_MODEL,
    UV_PLANAR,
    UV_BOX,
    UV_CYLINDER
} UvProjection;

/* Coordinates are along the axes, in scene units. */
typedef struct TargetProjection {
    UvProjection kind; /* UV_UNSAID, UV_MODEL: there is none */
    Vec3 axes[3];      /* of unit length, at right angles. Planar: of u, of v, normal; else of the sides, and up in the
                          middle */
    double low[3], high[3]; /* of the target; both 0 where it has no end */
    double unit;       /* of UV in a scene unit */
} TargetProjection;

typedef struct Target {
    char name[RETEX_NAME_MAX];
    char idents[512];        /* its selectors, comma-separated; identifiers as the scene spells them */
    int is_pointed_at;       /* 1: one of them selects objects or colours that need no name */
    int nselections;         /* of faces */
    FaceSelection *selections;
    UvProjection uv;         /* that was asked for */
    TargetProjection projection;
    double uv_unit[2];       /* path/target_units.h; 0, 0: UV are those of shapes and patterns */
    int uv_folds;            /* 1: shapes that close have their UV there and back, mirrored */
    int nfinishes;           /* 0: it keeps its own */
    int has_normals;         /* 1: they are three: one, and the same with the normal of its diffuse lobe tilted to
                                where u grows, and v */
    TargetFinish finishes[FINISHES_MAX];
} Target;

/* Emitters whose light can be changed after rendering: light sources, surfaces that emit, the sky. A lamp has one
 * colour where the light of all its emitters differs in strength only. */
#define LAMPS_MAX 16
typedef struct Lamp {
    char name[RETEX_NAME_MAX];
    char idents[512]; /* its selectors, comma-separated */
    int several;      /* 1: it has several colours, or an image */
    Rgb value;        /* the colour of its light in the scene; white where it has several */
    Rgb kept;         /* the colour that its light has while paths are traced: value, but where that has a channel of 0,
                         which nothing could be made of: then white of the same luminance, or what it would be if on */
    Rgb shown;        /* by which traced light is multiplied in the picture */
    float weight;     /* of its light where lights are chosen, 0 or more: 1 where its light is kept apart */
} Lamp;

/* Light whose images sets keep apart: of one lamp, or all where there are none, with one choice among the finishes of
 * all targets (a combination), or of paths that met no target which has several. */
#define COMBINATIONS_MAX 8
#define KEPT_MAX 27 /* LAMPS_MAX lamps and the rest; or with combinations, at most 16 times the lamps, and one more */
typedef struct KeptLight {
    char name[RETEX_NAME_MAX]; /* of its parameter */
    int lamp;
    int combination; /* -1: such a target was not met, or there is none */
} KeptLight;

/* What an identifier is called where it comes from, which identifiers cannot be called. */
typedef struct SceneName {
    const char *ident, *name;
} SceneName;

typedef struct SceneFile {
    const char *path;
    const struct SceneFile *next;
} SceneFile;

typedef struct Scene {
    Arena *arena;
    char path[1024];
    const SceneFile *files;  /* all that were read from the disk: the scene's own, included ones, images */
    uint64_t digest;         /* of all files that it was read from, see base/digest.h */
    int width, height;       /* the size its author had in mind, from the camera's right and up: 640 wide */
    PixelSize *pixels;       /* of the render; never NULL after parsing a normal that needs it */
    Camera camera;
    int ncameras;            /* those that are #declared, in the scene's order; of one name the last */
    NamedCamera *cameras;
    Rgb background;
    int background_only_seen; /* 1: directly and by delta lobes; it lights no surface */
    SkySphere *sky;          /* or NULL */
    Fog *fogs;               /* a list, or NULL */
    Rainbow *rainbows;       /* the same */
    const Medium *media;     /* of the air: a list, or NULL */
    int has_media;           /* there, or in something */
    int nprimitives, ncsgs, nprototypes, ninstances, nlights, nimages;
    Primitive *primitives;
    struct Csg **csgs;       /* trees over primitives, but for those of prototypes; shape/csg.h */
    const Prototype **prototypes;
    Instance *instances;
    Light *lights;
    int nlamps;              /* whose light is kept apart; 0, or those asked for and the rest, which is the last */
    Lamp lamps[LAMPS_MAX + 1];
    int sky_lamp;            /* the lamp of sky and background */
    ImageMap **images;
    WorkingSpace working_space;
    int number_of_waves;     /* of ripples and waves */
    int noise_generator;     /* of noise that names none: 1 to 3, see base/noise.h */
    Rgb ambient_light;
    /* every identifier that textures, pigments, materials or objects in use came through */
    int nidents;
    const char **idents;
    int nnames;
    SceneName *names;        /* of retex_names */
    int ntargets;
    Target targets[RETEX_MAX_TARGETS];
    int nnamed_finishes;
    NamedFinish *named_finishes;   /* those that are #declared */
    int ncombinations;             /* 0: no target has several finishes; else 2 to COMBINATIONS_MAX */
    int shown;                     /* the combination that the picture has */
    unsigned char finish_of[COMBINATIONS_MAX][RETEX_MAX_TARGETS]; /* by combination and target, of its finishes */
    int nkept;                     /* 0: there are neither lamps nor combinations */
    KeptLight kept[KEPT_MAX];      /* by lamp; of each what met no target with several finishes, then combinations */
} Scene;

/* The k-th texture of a primitive, from 0: its own, the interior's, those of its parts, and once more those of faces
 * that are targets by themselves; and the target that it is as a whole, or -1. NULL: there are no more. */
const Texture *primitive_texture(const Primitive *primitive, int k, int *target);
/* What people call that identifier: its name of retex_names, where a target can be named so, or itself. */
const char *scene_name_of(const Scene *scene, const char *ident);
/* The target of a leaf of a texture that is a target as a whole, or -1: the first that was asked for wins. */
static inline int texture_leaf_target(const Texture *leaf, int whole)
{
    return leaf->target < 0 || (whole >= 0 && whole < leaf->target) ? whole : leaf->target;
}
/* A plain texture of the primitive that is the target, or NULL. */
const Texture *primitive_target_texture(const Primitive *primitive, int target);
/* The same of the instance's own texture and names, and a primitive that has it; of may be NULL. */
const Texture *instance_target_texture(const Scene *scene, const Instance *instance, int target, const Primitive **of);
/* Where the options of one -t begin, ":uv=WORD" at its end; or its end. */
const char *target_spec_options(const char *spec);
/* Each of one -t of the command line: "NAME" or "NAME=SELECTOR,SELECTOR", see selector.h, with or without options. */
int scene_resolve_targets(Scene *scene, const char *const *specs, int nspecs, RetexError *err);
/* Each of one -l of the command line: "NAME" or "NAME=SELECTOR,SELECTOR", see scene/lamps.c. Without any, all light is
 * of lamp 0, and there is nothing to keep apart. */
int scene_resolve_lamps(Scene *scene, const char *const *specs, int nspecs, RetexError *err);
/* The specs of --lamps each: every light source and every emitter that has a name, and the sky, if it shines; unnamed:
 * 1: then emitting objects without a name. They are in the scene's arena. RETEX_ELIMIT, with the first of them, where
 * there are more than LAMPS_MAX. */
int scene_each_lamp(Scene *scene, int sky_shines, int unnamed, const char *const **specs, int *nspecs, RetexError *err);
/* Give a lamp another value, in the picture and in what sets say of it. is_kept: its light is kept apart, so that
 * lights are chosen as before; else by what it is now. */
void scene_light_lamp(Lamp *lamp, Rgb value, int is_kept);
RetexParameter lamp_parameter(const Lamp *lamp); /* as sets have it */

/* Each of one --finish of the command line: "TARGET=NAME,NAME"; names are those of finishes that the scene declares,
 * of built-in ones, or `original`. shown: each "TARGET=NAME", the finish in the picture; else it is the first. After
 * targets and lamps are resolved. */
int scene_resolve_finishes(Scene *scene, const char *const *specs, int nspecs, const char *const *shown, int nshown,
                           RetexError *err);
/* Number the light that is kept apart, once lamps or combinations are known. */
void scene_number_kept(Scene *scene);
/* What can be named there besides: the k-th built-in finish, or NULL. */
const char *scene_built_in_finish(int k);
/* As maps of roughness have it: 0 a mirror, 1 matt; -1 of a metal. */
float finish_roughness(const Finish *finish);
/* The same of a target's, which may be the scene's own: -1. */
float target_finish_roughness(const Target *target, int k);
/* The finish that a texture of a target has in a combination. */
static inline const Finish *target_finish(const Target *target, int k, const Finish *own)
{
    return target->finishes[k].finish ? target->finishes[k].finish : own;
}
RetexParameter kept_parameter(const Scene *scene, int kept); /* as sets have it */
Rgb kept_color(const Scene *scene, int kept); /* by which its light is multiplied while paths are traced */
/* The kept light of a lamp and a combination; -1: of paths that met no target with several finishes. */
static inline int scene_kept(const Scene *scene, int lamp, int combination)
{
    return scene->ncombinations ? lamp * (1 + scene->ncombinations) + 1 + combination : lamp;
}
/* The light of the air, such as fog, is of the lamp that is the rest. */
static inline int scene_rest_lamp(const Scene *scene)
{
    return scene->nlamps > 0 ? scene->nlamps - 1 : 0;
}
/* Whether any surface emits; whether the primitive does, or something of the instance. */
int scene_has_emitters(const Scene *scene);
int primitive_emits(const Primitive *primitive);
int instance_emits(const Scene *scene, const Instance *instance);
int scene_caustic_sources(const Scene *scene); /* how many light sources have caustics */
void scene_close(Scene **scene); /* textures of image maps, then the arena */

#endif
