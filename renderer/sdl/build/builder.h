/* Private to sdl/build: how objects, textures and the rest are kept between being read and being placed in the Scene.
 *
 * Everything that can be #declared is immutable once it is read: a change (a transform, another finish, a name) is made
 * on a copy, so identifiers share what they have in common. Objects keep their transforms apart from their geometry and
 * from their textures (MovedTexture), which makes `object{Ident translate …}` one small copy however large Ident is.
 *
 * Where the language asks for more than the renderer has, the thing is marked with a Gap and reported when it is
 * placed, not when it is declared: the standard includes declare hundreds of textures that no scene uses all of. */
#ifndef RENDERER_SDL_BUILD_BUILDER_H
#define RENDERER_SDL_BUILD_BUILDER_H

#include <stdint.h>
#include "sdl/lang/parser.h"
#include "shape/csg.h"
#include "shape/isosurface.h"
#include "shape/shapes.h"
#include "shape/text.h"

/* ---- what is not supported ---- */

#define GAP_TABLE(X) \
    X(MAP_TYPE, "this map_type", "the image is mapped as a plane") \
    X(FAKE_CAUSTICS, "interior caustics", "it is ignored, see photons") \
    X(FINISH_FRESNEL, "finish fresnel", "it is ignored")

typedef enum Gap {
#define X(id, name, instead) GAP_##id,
    GAP_TABLE(X)
#undef X
    GAP_COUNT
} Gap;
typedef struct Gaps { uint64_t bits, patterns; } Gaps; /* by Gap; by the index of the pattern */
_Static_assert(GAP_COUNT <= 64, "Gaps is too small");

void gaps_add(Gaps *gaps, Gap gap);
void gaps_add_pattern(Gaps *gaps, int pattern);
void gaps_join(Gaps *gaps, const Gaps *other);
void gaps_report(Sdl *sdl, const Gaps *gaps);

/* ---- pigments, finishes, textures ---- */

enum { PALETTE_ENTRIES = 256 };
typedef struct ParsedImage {
    ImageMap map;        /* first; texture, size and alpha are filled in when the scene is complete */
    char colorspace[64]; /* of the file; "" = by its type */
    double gamma;        /* the file's numbers have this power of light; where it is not 1, colorspace is linear */
    float (*palette)[2]; /* filter and transmit of each entry; NAN: as of all; or NULL */
    const float *drawn;  /* R, G, B and A of each texel, as written, where the scene draws it; then there is no path */
    int use_alpha;       /* of an image_pattern: its value is the transparency */
    int working;         /* 1: the numbers of an integer file are colours of the working space, taken as they are */
    const char *file;    /* where it is written, for messages */
    int line;
    struct ParsedImage *next;
} ParsedImage;

typedef struct ParsedPigment {
    Pigment pigment;   /* first: a Pigment* in the Scene is one of these */
    int averaged;      /* 1: the pattern is not supported; kind is a colour, the map's mean */
    const char *file;  /* where its colour is written, for messages; line 0: nowhere */
    int line, warned;    /* warned: that it is no albedo */
    int parts, depth;    /* of its map, see ParsedColorMap */
    Gaps gaps;
    struct ParsedPigment *next; /* all there are */
} ParsedPigment;

#define PLAIN_PIGMENTS 1024

typedef struct ParsedColorMap {
    ColorMap map;
    int parts, depth; /* entries, with those of its pigments' maps; how deep these are nested */
    Gaps gaps;
} ParsedColorMap;

typedef struct ParsedFinish {
    Finish finish; /* first */
    double ior;    /* written in the finish, as old scenes do; 0 = not */
    int shines;    /* its ambient is emission, or what is left of it */
    const char *name; /* that it was declared by, or NULL */
    Gaps gaps;
    struct ParsedFinish *next;
} ParsedFinish;

typedef struct ParsedNormal {
    Normal normal; /* first */
    Gaps gaps;
} ParsedNormal;

typedef struct ParsedNormalMap {
    int count;
    NormalMapEntry *entries; /* ParsedNormals */
    Gaps gaps;
} ParsedNormalMap;

typedef struct ParsedSlopeMap {
    int count;
    SlopeMapEntry *entries;
} ParsedSlopeMap;

typedef struct ParsedBumpMap {
    BumpMap map;   /* first; heights and size are filled in when the scene is complete */
    int use_index; /* heights are the indices of a palette, if the picture has one */
} ParsedBumpMap;

/* How many plain textures a texture has, how many of them may be seen at one point, how deep maps are nested. */
typedef struct TextureCounts {
    int leaves, seen, depth;
} TextureCounts;

typedef struct ParsedTextureEntry {
    double value;
    const struct ParsedTexture *texture; /* where the whole is, not in the pattern's space; see texture_nested */
} ParsedTextureEntry;

/* Textures by the value of a pattern. */
typedef struct ParsedTextureMap {
    TextureTreeKind kind;          /* not of layers */
    const ParsedPigment *selector; /* NULL of maps that no texture has yet */
    const TextureOperands *operands;
    int count, capacity;
    ParsedTextureEntry *entries; /* in order of value */
    TextureCounts counts;
} ParsedTextureMap;

typedef struct ParsedTexture {
    Texture texture;                   /* first: its pigment is a ParsedPigment, its finish a ParsedFinish, its normal
                                          NULL or a ParsedNormal */
    const struct ParsedTexture *below; /* the layer under it */
    const ParsedTextureMap *map;       /* or NULL; then it has no layers, and pigment and finish are of a first leaf */
    Gaps gaps;
    int is_complete; /* its tree is made, and the names of pigments are joined to those of textures */
} ParsedTexture;

/* A texture and the transform written after it: `sphere{… texture{T} rotate …}` only multiplies matrices. */
typedef struct MovedTexture {
    const ParsedTexture *texture; /* or NULL */
    int is_moved;
    Transform transform; /* where is_moved */
} MovedTexture;

typedef struct ParsedInterior {
    Interior interior; /* first */
    int has_ior;       /* it is written */
    Gaps gaps;
} ParsedInterior;

typedef struct ParsedMedium {
    Medium medium; /* first */
    Rgb constant;  /* product of its densities that are the same everywhere */
    Gaps gaps;
} ParsedMedium;

typedef struct ParsedMaterial {
    const ParsedTexture *texture, *interior_texture;
    const ParsedInterior *interior;
    const IdentList *idents;
} ParsedMaterial;

/* ---- objects ---- */

typedef enum ObjectKind { OBJECT_EMPTY, OBJECT_SHAPE, OBJECT_COMPOUND, OBJECT_LIGHT } ObjectKind;
enum {
    OBJECT_NO_SHADOW = 1,
    OBJECT_NO_IMAGE = 2,
    OBJECT_NO_REFLECTION = 4,
    OBJECT_INVERSE = 8,
    OBJECT_HOLLOW = 16,
    OBJECT_CUTAWAY_TEXTURES = 32,
    OBJECT_LIGHT_GROUP = 64,
    OBJECT_GLOBAL_LIGHTS = 128, /* of a light_group */
    OBJECT_PHOTON_TARGET = 256, /* the following two count with it */
    OBJECT_PHOTONS_REFRACT = 512,
    OBJECT_PHOTONS_REFLECT = 1024,
    OBJECT_DOUBLE_ILLUMINATE = 2048
};

typedef struct ObjectList {
    const struct Object *object;
    struct ObjectList *next;
} ObjectList;

/* Objects of clipped_by or bounded_by, each added before the others. */
typedef struct ClipList {
    const struct Object *object;
    Transform written; /* the clipped object's transform where they were written: what moves it later moves them */
    const struct ClipList *next;
} ClipList;

/* Of single triangles: not yet with neighbours in one mesh, or that mesh. */
typedef enum TriangleKind { TRIANGLE_NOT, TRIANGLE_SINGLE, TRIANGLES_GATHERED } TriangleKind;

typedef struct Object {
    ObjectKind kind;
    Shape shape;      /* its textures are ParsedTextures in the shape's own space */
    TriangleKind single_triangle;
    int polygon;      /* the mesh is a polygon */
    const Light *light;
    const struct Object *projector; /* of a light: what its light passes through, in its space; or NULL */
    CsgKind csg;                /* of a compound */
    int difference;             /* an intersection written as one */
    const ObjectList *children; /* of a compound; of a light: what it looks like */
    const ClipList *clips, *bounds;
    Transform transform;        /* canonical shape, or the children's space, to here */
    MovedTexture texture, interior_texture;
    const ParsedInterior *interior;
    Transform interior_transform; /* what moved it since, where its media vary */
    unsigned flags;
    int uv_mapping;
    int depth;    /* of nested compounds */
    double parts; /* objects in it, counted through identifiers */
    const IdentList *idents;
    const PlaceList *places;
    int line;
    Gaps gaps;
} Object;

typedef struct ParsedSky {
    Rgb emission;
    Transform transform;
    int npigments;
    const ParsedPigment *pigments[16];
} ParsedSky;

typedef struct ParsedCamera {
    Camera camera; /* without aperture and bokeh */
    Vec3 look_at;
    double aperture;
    int blur;                   /* blur_samples is given: the aperture counts */
    const ParsedPigment *bokeh; /* or NULL */
    const char *name;           /* in the builder's list of cameras that are #declared: */
    const struct ParsedCamera *next;
} ParsedCamera;

/* ---- the state ---- */

#define PLACED_CACHE 256
typedef struct PlacedTexture {
    const ParsedTexture *from, *to;
    Transform by;
} PlacedTexture;

typedef struct CsgRoot {
    CsgNode *root;
    const Prototype *prototype; /* or NULL */
    int line;
} CsgRoot;

typedef struct Builder {
    const ParsedTexture *default_texture;
    ParsedCamera camera;
    const ParsedCamera *cameras; /* the last one first */
    const ParsedSky *sky;
    const ParsedPigment *bokeh; /* of the camera in use, or NULL */
    int has_assumed_gamma;
    int gamma_srgb; /* `assumed_gamma srgb` */
    double assumed_gamma;
    double gamma_version; /* the version where it was set */
    int radiosity;        /* global_settings has a block of it */
    int photons;          /* global_settings has a block of them */
    Rgb irid_wavelength;
    int name_capacity; /* of the scene's names */
    int has_subsurface;  /* global_settings has the block, without which POV-Ray has none either */
    double mm_per_unit;
    int depth;            /* of nested statements being read */
    /* what is decoded from the working space at the end, each once */
    ParsedPigment *pigments;
    ParsedPigment *plain_pigments[PLAIN_PIGMENTS]; /* of one colour, which textures share: by a hash of it */
    ParsedPigment *spare_pigment;                  /* memory for the next one */
    struct Object *spare_object;
    ParsedFinish *finishes;
    ParsedImage *images;
    int primitive_capacity, light_capacity, image_capacity;
    unsigned char *single_triangle; /* of each primitive */
    CsgRoot *csg_roots;             /* placed, to be completed with the scene */
    int ncsg_roots, csg_capacity;
    PlacedTexture placed[PLACED_CACHE];
    const FaceTextures *placed_textures, *placed_textures_from; /* the last that were placed */
    Transform placed_textures_by;
    struct Tracer *tracer; /* trace.c: objects made ready for rays */
    struct CopiedCompounds *copied; /* instance.c: compounds that were placed */
    const Prototype *prototypes; /* all, the last first */
    const ParsedTexture *inherited_texture; /* stands for the instance's while a prototype is placed */
    int instance_capacity;
    struct FontFiles *fonts; /* font.c */
    struct IesFile *ies_files; /* ies.c */
} Builder;

static inline Builder *builder_of(Sdl *sdl)
{
    return sdl_builder_state(sdl);
}
static inline const ParsedNormal *default_normal(Sdl *sdl)
{
    return (const ParsedNormal *)builder_of(sdl)->default_texture->texture.normal;
}
static inline const ParsedPigment *default_pigment(Sdl *sdl)
{
    return (const ParsedPigment *)builder_of(sdl)->default_texture->texture.pigment;
}

/* Nesting of statements that the parser recurses for; an error when too deep. */
void statement_begin(Sdl *sdl);
void statement_end(Sdl *sdl);
/* The array, or a copy twice as large where it is full: there is place for one more of size bytes. */
void *builder_grow(Sdl *sdl, void *array, int count, int *capacity, size_t size);

/* The value of the next token where it is an identifier of that kind, else NULL. */
Value *peek_ident(Sdl *sdl, ValueKind kind);
/* … taken: its data, or NULL. */
void *accept_ident(Sdl *sdl, ValueKind kind);
/* The same of a VALUE_OTHER with that word. */
void *accept_ident_of_word(Sdl *sdl, const char *word);
/* 1 where the next token begins a number (not a vector or colour). */
int is_float_start(Sdl *sdl);
double optional_float(Sdl *sdl, double missing);
/* A word that introduces a block which is skipped. */
void skip_statement(Sdl *sdl);

/* transform.c */
int accept_transform(Sdl *sdl, Transform *by); /* one translate, rotate, scale, matrix or transform */
Transform parse_transform(Sdl *sdl);           /* after `transform` */
int transform_is_identity(const Transform *t);

/* pigment.c, pattern.c, image.c */
ParsedPigment *pigment_new(Sdl *sdl, const ParsedPigment *from /* or NULL */);
ParsedPigment *parse_pigment_body(Sdl *sdl, const ParsedPigment *from, char end);
ParsedPigment *parse_pigment(Sdl *sdl, const ParsedPigment *from); /* with its braces */
/* The same, of a texture without uv_mapping, which would change it: it may be another texture's too. */
ParsedPigment *parse_shared_pigment(Sdl *sdl, const ParsedPigment *from);
const Pigment *parse_uv_pigment(Sdl *sdl); /* of the block `retex` and the like: on the shape's UV, with its braces */
Rgbft pigment_mean(const Pigment *pigment);
/* A pattern of textures, up to the end: the pattern as a pigment without colours, and its textures in map. */
ParsedPigment *parse_selector(Sdl *sdl, char end, ParsedTextureMap *map);
ParsedColorMap *parse_color_map(Sdl *sdl);   /* after color_map */
ParsedColorMap *parse_pigment_map(Sdl *sdl); /* after pigment_map */
/* A pattern's keyword and arguments, no list of colours. Of `object`, the list and the closing brace follow. */
int accept_pattern_word(Sdl *sdl, ParsedPigment *pigment);
void parse_pattern_data(Sdl *sdl, ParsedPigment *pigment);        /* pattern_data.c: after the keyword */
int accept_pattern_data_modifier(Sdl *sdl, Pattern *pattern);
/* textures: gets a list of textures in place of colours; NULL: there are colours. */
int accept_pattern(Sdl *sdl, ParsedPigment *pigment, ParsedTextureMap *textures);
int accept_pattern_modifier(Sdl *sdl, ParsedPigment *pigment);
/* Of the colours that POV-Ray takes where none are given. */
ParsedColorMap *color_list_new(Sdl *sdl, const PatternOps *ops);
void color_map_set(Sdl *sdl, ParsedColorMap *map, int entry, const ParsedPigment *pigment);
void pigment_set_map(ParsedPigment *pigment, const ParsedColorMap *map);
/* The name of an image and before it `png` and the like, which are not looked at: its file, also by a name without its
 * ending; or an error. */
const char *parse_image_path(Sdl *sdl);
void parse_image_map(Sdl *sdl, ParsedPigment *pigment); /* after image_map */
/* An image and its options, up to what is none. */
ParsedImage *parse_image(Sdl *sdl, ParsedPigment *pigment);
/* drawn_image.c: `function WIDTH, HEIGHT { … }` in place of an image's file. */
typedef struct DrawnImage {
    int width, height;
    const FunctionProgram *program; /* or NULL: then the pigment */
    const Pigment *pigment;
} DrawnImage;
/* After `function`. of: what is to have it, for messages; least: texels along a side. */
void parse_drawn_image(Sdl *sdl, DrawnImage *image, const char *of, int least, Gaps *gaps);
/* Row 0 is the top. Both evaluate the function: each texel is to be asked for once. */
double drawn_image_grey(const DrawnImage *image, int column, int row);
void drawn_image_texel(const DrawnImage *image, int column, int row, float rgba[4]); /* as written, from 0 to 1 */
/* image_file.c: the images of a pigment and of its map's pigments; is_light: their colours may be brighter than 1. */
void load_pigment_images(Sdl *sdl, const Pigment *pigment, int is_light);

/* normal.c, bump_map.c */
const ParsedNormal *parse_normal(Sdl *sdl, const ParsedNormal *from /* or NULL */); /* after `normal` */
const ParsedNormal *parse_normal_body(Sdl *sdl, const ParsedNormal *from, char end);
const ParsedNormalMap *parse_normal_map(Sdl *sdl); /* after normal_map */
const ParsedSlopeMap *parse_slope_map(Sdl *sdl);   /* after slope_map */
/* NULL stays NULL. */
const ParsedNormal *normal_moved(Sdl *sdl, const ParsedNormal *normal, const Transform *by);
const ParsedNormal *normal_changed(Sdl *sdl, const ParsedNormal *normal, int uv_mapping, int keeps_size);
void normal_load(Sdl *sdl, const Normal *normal);          /* the pictures of it, once it is known to be used */
const BumpMap *parse_bump_map(Sdl *sdl, double *size);     /* after bump_map; *size: where it says bump_size */
void load_bump_map(Sdl *sdl, const BumpMap *map);
/* mesh_tangents.c: once textures are complete */
void add_tangents(Sdl *sdl);

/* warp.c */
int accept_turbulence(Sdl *sdl, Turbulence *turbulence); /* turbulence, octaves, lambda or omega */
int accept_warp(Sdl *sdl, Pigment *pigment);

/* field.c: see SdlBuilder */
int parse_field(Sdl *sdl, const char *word, FunctionForeign *function);

/* finish.c */
ParsedFinish *finish_new(Sdl *sdl, const ParsedFinish *from /* or NULL: the built-in one */);
ParsedFinish *parse_finish(Sdl *sdl, const ParsedFinish *from);

/* texture_map.c */
ParsedTextureMap *parse_texture_map(Sdl *sdl); /* after texture_map */
/* `texture{…}` up to n times, in place of a list of colours. */
void parse_texture_list(Sdl *sdl, ParsedTextureMap *map, int n);
const ParsedTexture *parse_tiles(Sdl *sdl);        /* after tiles */
const ParsedTexture *parse_material_map(Sdl *sdl); /* after material_map */
/* Of a map without a selector. The textures are seen in the selector's pattern space. */
const ParsedTexture *texture_of_map(Sdl *sdl, const ParsedTextureMap *map, ParsedPigment *selector,
                                    TextureTreeKind kind);
/* A pattern with its textures, up to the end of the texture. */
const ParsedTexture *parse_texture_pattern(Sdl *sdl, char end, int uv_mapping);

/* texture_tree.c: what is done to all of a texture's layers and maps. Changed ones are copies. */
const ParsedTexture *texture_moved(Sdl *sdl, const ParsedTexture *texture, const Transform *by);
/* Lying in the pattern space of a pigment. */
const ParsedTexture *texture_nested(Sdl *sdl, const ParsedTexture *texture, const Pigment *in);
const ParsedTexture *texture_uv_mapped(Sdl *sdl, const ParsedTexture *texture);
const ParsedTexture *texture_named(Sdl *sdl, const ParsedTexture *texture, const IdentList *more);
const ParsedTexture *texture_over(Sdl *sdl, const ParsedTexture *top, const ParsedTexture *bottom);
TextureCounts texture_counts(Sdl *sdl, const ParsedTexture *texture); /* an error beyond all bounds */
void texture_check_counts(Sdl *sdl, const TextureCounts *counts);
/* Calls of each plain texture, layer or leaf, and of each pigment that chooses among textures. */
typedef void TextureVisitor(Sdl *sdl, const ParsedTexture *texture, void *context);
typedef void SelectorVisitor(Sdl *sdl, const ParsedTextureMap *map, void *context);
void texture_visit(Sdl *sdl, const ParsedTexture *texture, TextureVisitor *visit, SelectorVisitor *selector,
                   void *context);
/* The texture of the scene: its tree is made, where it is no plain texture. Only once nothing is read any more. */
const Texture *texture_complete(Sdl *sdl, const ParsedTexture *texture);

/* texture.c */
const ParsedTexture *parse_texture(Sdl *sdl); /* after `texture` */
const ParsedTexture *parse_texture_body(Sdl *sdl, char end);
/* pigment, finish or normal where the next token is one of them: changes the top layer of *texture (NULL = default). */
int accept_texture_part(Sdl *sdl, const ParsedTexture **texture);
ParsedTexture *texture_copy(Sdl *sdl, const ParsedTexture *from);
const ParsedInterior *parse_interior(Sdl *sdl, const ParsedInterior *from);
const ParsedMaterial *parse_material(Sdl *sdl);

/* object.c, shape.c, polygon.c, mesh.c, light.c */
const Object *accept_object(Sdl *sdl); /* an object statement or identifier, or NULL where none is next */
Object *object_new(Sdl *sdl, ObjectKind kind);
const PlaceList *places_join(Sdl *sdl, const PlaceList *within, const PlaceList *around);
void object_report(Sdl *sdl, const Object *object); /* what of it is not supported */
void object_count_child(Sdl *sdl, Object *object, const Object *child); /* counts; an error beyond all bounds */
void object_move(Object *object, const Transform *by);
int accept_object_modifier(Sdl *sdl, Object *object);
void parse_object_modifiers(Sdl *sdl, Object *object); /* up to the closing brace */
typedef void ShapeParser(Sdl *sdl, Object *object);    /* what stands between `{` and the modifiers */
/* Keywords that are not the name of a shape's operations. */
#define SHAPE_KEYWORDS(X) \
    X(bicubic_patch) X(cubic) X(cylinder) X(mesh2) X(parametric) X(polygon) X(polynomial) X(quadric) \
    X(quartic) X(smooth_triangle) X(triangle)
#define X(name) ShapeParser parse_##name;
SHAPE_TABLE(X)
SHAPE_KEYWORDS(X)
#undef X
/* isosurface.c: also of other shapes that a function gives */
int accept_container(Sdl *sdl, Container *container);
double positive_or(Sdl *sdl, const char *what, double value, double instead); /* warns where it is not */
const Object *parse_light_source(Sdl *sdl); /* after light_source */
int polygon_triangulate(Sdl *sdl, const Vec2 *points, const int *starts, int nrings, Vec2 **corners, int *ncorners);

/* palette.c, gif.c: 1 and the indices, row by row from the top, if the file is a GIF picture, or a PNG picture that has
 * a palette; else 0. */
typedef struct PaletteIndices {
    int width, height;
    const unsigned char *indices; /* in the arena */
} PaletteIndices;
/* A RetexWarn of pictures that are read for something else than their colours; the context is the Sdl. */
void warn_of_picture(void *context, const char *text);
int read_palette_indices(Sdl *sdl, const char *path, int side_max, PaletteIndices *out);
void read_gif_indices(Sdl *sdl, const char *path, int side_max, PaletteIndices *out);

/* font.c: a font's letters, in units of its size. Each file is read and each letter is made once. */
typedef struct Font Font;
typedef struct Letter {
    const Glyph *glyph; /* NULL: blank */
    double advance;     /* to the next letter */
    double bearing;     /* from the pen to the left edge */
} Letter;
Font *font_open(Sdl *sdl, const char *name);
unsigned font_letter_index(Font *font, unsigned long character); /* 0: the font lacks it */
const Letter *font_letter(Sdl *sdl, Font *font, unsigned index);
double font_kerning(const Font *font, unsigned left, unsigned right);

const struct Ies *parse_ies(Sdl *sdl); /* ies.c: the name of a file that has a light distribution, after `ies` */

/* extent.c, trace.c: see SdlBuilder */
int object_extent(Sdl *sdl, const Value *object, Vec3 *low, Vec3 *high);
int object_trace(Sdl *sdl, const Value *object, Vec3 from, Vec3 direction, Vec3 *point, Vec3 *normal);
int object_inside(Sdl *sdl, const Value *object, Vec3 p);
const Csg *object_solid(Sdl *sdl, const Object *object); /* in its own space; kept for the next call */

/* camera.c, global.c */
void camera_default(ParsedCamera *camera);
const ParsedCamera *parse_camera(Sdl *sdl);
void camera_use(Sdl *sdl, const ParsedCamera *camera);
void camera_choose(Sdl *sdl); /* at the end of the scene: the one that is asked for */
void camera_finish(Sdl *sdl); /* what of it waits for the end of the scene */
void parse_global_settings(Sdl *sdl);
void parse_background(Sdl *sdl);
const ParsedSky *parse_sky_sphere(Sdl *sdl);

/* rainbow.c */
Rainbow *parse_rainbow(Sdl *sdl); /* after rainbow */
void place_rainbow(Sdl *sdl, const Rainbow *rainbow);
/* media.c */
ParsedMedium *parse_media(Sdl *sdl); /* after media */
const ParsedPigment *parse_density(Sdl *sdl); /* after density */
const Medium *media_with(Sdl *sdl, const Medium *list, const ParsedMedium *added);
int interior_varies(const ParsedInterior *interior); /* its media do, from place to place; NULL: 0 */
const ParsedInterior *interior_moved(Sdl *sdl, const ParsedInterior *interior, const Transform *by);
void complete_media(Sdl *sdl); /* with the images */

/* fog.c */
Fog *parse_fog(Sdl *sdl); /* after fog */
void complete_air(Sdl *sdl); /* at the end of reading */

/* csg.c */
typedef struct SolidLeaf {
    Primitive primitive; /* first: a leaf's primitive is one of these */
    const Object *object;
} SolidLeaf;
Csg *csg_of_object(Sdl *sdl, const Object *object); /* an object that is not placed, in its own space */
/* The object's own node, with its clips and bounds. outer: from around the object to the world. */
CsgNode *object_csg_node(Sdl *sdl, const Object *object, const Transform *outer, unsigned inverse, CsgNode *parent);
Csg *csg_complete(Sdl *sdl, CsgNode *root);
void index_mesh(Sdl *sdl, const Mesh *mesh); /* once: for what is intersected in double */

/* place.c, instance.c, finalize.c */
/* What a child inherits from the compounds around it. */
typedef struct Inherited {
    Transform to_world;
    const ParsedTexture *texture, *interior_texture; /* in world space */
    const ParsedInterior *interior;
    int uv_mapping;
    unsigned flags;
    const IdentList *idents;
    const PlaceList *places;
    const LightGroup *light_group;
    CsgNode *csg; /* the node that it is an operand of, or NULL */
    struct Cutaway *cutaway; /* of the tree of CSG that it is in, where that has cutaway_textures, or NULL */
    int is_taken_off;        /* it is in an operand that a difference takes off */
    const Prototype *prototype; /* that it is part of, or NULL: then the world is its space */
} Inherited;

/* cutaway.c: a tree of CSG with cutaway_textures while it is placed. */
typedef struct CutOperand {
    const ParsedTexture *texture;
    const IdentList *idents;
    const CsgNode *node;
} CutOperand;
typedef struct Cutaway {
    int nbare, bare_capacity, ncut, cut_capacity;
    int *bare;       /* primitives that are to show textures of others */
    CutOperand *cut; /* those with textures */
} Cutaway;
/* The last primitive, which was placed with this texture. */
void cutaway_add(Sdl *sdl, const Inherited *in, const ParsedTexture *texture);
void cutaway_complete(Sdl *sdl, const Cutaway *cutaway);

/* photons{…} of an object or light: sets and clears OBJECT_PHOTON… in flags. */
void parse_photons(Sdl *sdl, unsigned *flags);
/* caustics.c, at the end of reading: which light sources throw caustics, by which primitives. */
void find_caustics(Sdl *sdl);
void place_object(Sdl *sdl, const Object *object);
/* Nothing needs the object any more: it is placed, and has no name. */
void object_done(Sdl *sdl, const Object *object);
void place_within(Sdl *sdl, const Object *object, const Inherited *around);
int place_instance(Sdl *sdl, const Object *object, const Inherited *around); /* 0: it is to be placed by itself */
unsigned flags_within(const Object *object, const Inherited *around);
const ParsedTexture *texture_placed(Sdl *sdl, const ParsedTexture *texture, const Transform *by);
void texture_report(Sdl *sdl, const ParsedTexture *texture);
void complete_prototypes(Sdl *sdl);
void complete_csgs(Sdl *sdl);
void gather_triangles(Sdl *sdl);
void gather_children(Sdl *sdl, Object *compound);
void finalize_scene(Sdl *sdl);         /* everything that waits for the end of the scene */
WorkingSpace working_space(Sdl *sdl);  /* as far as the scene is read */
Rgb decode_color(Sdl *sdl, Rgb color); /* from the working space */

/* albedo.c */
int finish_is_emitter(const Finish *finish); /* 1: its pigment stands for light */
void check_albedo(Sdl *sdl, const Texture *texture);

#endif
