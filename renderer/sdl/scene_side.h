/* The scene side of the language, private to sdl/parse_*.c: how objects, textures and the rest are kept between being
 * read and being placed in the Scene.
 *
 * Everything that can be #declared is immutable once it is read: a change (a transform, another finish, a name) is made
 * on a copy, so identifiers share what they have in common. Objects keep their transforms apart from their geometry and
 * from their textures (Dressed), which makes `object{Ident translate …}` one small copy however large Ident is.
 *
 * Where the language asks for more than the renderer has, the thing is marked with a Gap and reported when it is
 * placed, not when it is declared: the standard includes declare hundreds of textures that no scene uses all of. */
#ifndef RENDERER_SDL_SCENE_SIDE_H
#define RENDERER_SDL_SCENE_SIDE_H

#include <stdint.h>
#include "sdl/parser.h"

/* ---- what is not supported ---- */

#define GAP_TABLE(X) \
    X(AGATE, "agate", "its mean colour is used") \
    X(AOI, "aoi", "its mean colour is used") \
    X(AVERAGE, "average", "its mean colour is used") \
    X(BOXED, "boxed", "its mean colour is used") \
    X(BOZO, "bozo", "its mean colour is used") \
    X(BRICK, "brick", "its mean colour is used") \
    X(BUMPS, "bumps", "its mean colour is used") \
    X(CELLS, "cells", "its mean colour is used") \
    X(CRACKLE, "crackle", "its mean colour is used") \
    X(CUBIC_PATTERN, "cubic pattern", "its mean colour is used") \
    X(CYLINDRICAL, "cylindrical", "its mean colour is used") \
    X(DENSITY_FILE, "density_file", "its mean colour is used") \
    X(DENTS, "dents", "its mean colour is used") \
    X(FACETS, "facets", "its mean colour is used") \
    X(FUNCTION, "function pattern", "its mean colour is used") \
    X(GRANITE, "granite", "its mean colour is used") \
    X(HEXAGON, "hexagon", "its mean colour is used") \
    X(IMAGE_PATTERN, "image_pattern", "its mean colour is used") \
    X(JULIA, "julia", "its mean colour is used") \
    X(LEOPARD, "leopard", "its mean colour is used") \
    X(MAGNET, "magnet", "its mean colour is used") \
    X(MANDEL, "mandel", "its mean colour is used") \
    X(MARBLE, "marble", "its mean colour is used") \
    X(OBJECT_PATTERN, "object pattern", "the colour outside the object is used") \
    X(ONION, "onion", "its mean colour is used") \
    X(PAVEMENT, "pavement", "its mean colour is used") \
    X(PIGMENT_PATTERN, "pigment_pattern", "its mean colour is used") \
    X(PLANAR, "planar", "its mean colour is used") \
    X(PROJECTION, "projection", "its mean colour is used") \
    X(QUILTED, "quilted", "its mean colour is used") \
    X(RADIAL, "radial", "its mean colour is used") \
    X(RIPPLES, "ripples", "its mean colour is used") \
    X(SLOPE, "slope", "its mean colour is used") \
    X(SPHERICAL, "spherical", "its mean colour is used") \
    X(SPIRAL, "spiral", "its mean colour is used") \
    X(SPOTTED, "spotted", "its mean colour is used") \
    X(SQUARE, "square", "its mean colour is used") \
    X(TILING, "tiling", "its mean colour is used") \
    X(TRIANGULAR, "triangular", "its mean colour is used") \
    X(WAVES, "waves", "its mean colour is used") \
    X(WOOD, "wood", "its mean colour is used") \
    X(WRINKLES, "wrinkles", "its mean colour is used") \
    X(TURBULENCE, "turbulence", "the pattern is left undisturbed") \
    X(WARP, "warp", "the pattern is left undisturbed") \
    X(PIGMENT_MAP, "pigment_map", "each pigment's mean colour is used") \
    X(TEXTURE_MAP, "texture_map", "each texture's mean colour is used, with the first one's finish") \
    X(MATERIAL_MAP, "material_map", "its first texture is used") \
    X(IMAGE_FUNCTION, "image_map of a function", "a middle grey is used") \
    X(IMAGE_PALETTE, "filter or transmit of a palette entry", "the entry stays opaque") \
    X(IMAGE_PLACE, "repeat and offset of an image", "they are ignored") \
    X(MAP_TYPE, "this map_type", "the image is mapped as a plane") \
    X(LAYERED, "a layered texture", "its topmost opaque layer is used") \
    X(NORMAL, "normal", "the surface stays smooth") \
    X(IRID, "irid", "it is ignored") \
    X(SUBSURFACE, "subsurface", "it is ignored") \
    X(MEDIA, "media", "it is ignored") \
    X(DISPERSION, "dispersion", "one ior is used for all colours") \
    X(DIFFERENCE, "difference", "its first object is used whole") \
    X(INTERSECTION, "intersection", "its first object that is not a plane is used whole") \
    X(MERGE, "merge", "it is treated as a union") \
    X(CLIPPED_BY, "clipped_by", "the object stays whole") \
    X(LIGHT_GROUP, "light_group", "its lights light everything") \
    X(PROJECTED_THROUGH, "projected_through", "the light shines everywhere") \
    X(BICUBIC_PATCH, "bicubic_patch", "it is left out") \
    X(BLOB, "blob", "it is left out") \
    X(CUBIC, "cubic", "it is left out") \
    X(HEIGHT_FIELD, "height_field", "it is left out") \
    X(ISOSURFACE, "isosurface", "it is left out") \
    X(JULIA_FRACTAL, "julia_fractal", "it is left out") \
    X(LATHE, "lathe", "it is left out") \
    X(OVUS, "ovus", "it is left out") \
    X(PARAMETRIC, "parametric", "it is left out") \
    X(POLY, "poly", "it is left out") \
    X(POLYNOMIAL, "polynomial", "it is left out") \
    X(PRISM, "prism", "it is left out") \
    X(QUADRIC, "quadric", "it is left out") \
    X(QUARTIC, "quartic", "it is left out") \
    X(SOR, "sor", "it is left out") \
    X(SPHERE_SWEEP, "sphere_sweep", "it is left out") \
    X(SUPERELLIPSOID, "superellipsoid", "it is left out") \
    X(TEXT, "text", "it is left out")

typedef enum Gap {
#define X(id, name, instead) GAP_##id,
    GAP_TABLE(X)
#undef X
    GAP_COUNT
} Gap;
typedef struct Gaps { uint64_t bits[2]; } Gaps;
_Static_assert(GAP_COUNT <= 128, "Gaps is too small");

void gaps_add(Gaps *gaps, Gap gap);
void gaps_join(Gaps *gaps, const Gaps *other);
void gaps_report(Sdl *sdl, const Gaps *gaps);

/* ---- pigments, finishes, textures ---- */

typedef struct SideImage {
    ImageMap map;            /* first; texture, size and alpha are filled in when the scene is complete */
    char colorspace[64];     /* of the file; "" = by its type */
    int working;             /* 1: the numbers of an integer file are colours of the working space, taken as they are */
    const char *file;        /* where it is written, for messages */
    int line;
    struct SideImage *next;
} SideImage;

/* A pattern that is not supported becomes the mean of its map, or for `average` of the entries by their weights. */
typedef enum Averaged { AVERAGED_NOT, AVERAGED, AVERAGED_BY_WEIGHT } Averaged;

typedef struct SidePigment {
    Pigment pigment;         /* first: a Pigment* in the Scene is one of these */
    Averaged averaged;       /* then kind is a colour */
    int disturbed;           /* has turbulence or a warp */
    const char *file;        /* where its colour is written, for messages; line 0: nowhere */
    int line, told;          /* told: that it is no albedo */
    Gaps gaps;
    struct SidePigment *next; /* all there are */
} SidePigment;

typedef struct SideColorMap {
    ColorMap map;
    Gaps gaps;
    const struct SideTexture *texture; /* of a texture_map: its first */
    struct SideColorMap *next;
} SideColorMap;

typedef struct SideFinish {
    Finish finish;           /* first */
    double ior;              /* written in the finish, as old scenes do; 0 = not */
    Gaps gaps;
    struct SideFinish *next;
} SideFinish;

typedef struct SideTexture {
    Texture texture;         /* first: its pigment is a SidePigment, its finish a SideFinish */
    const struct SideTexture *below; /* the layer under it */
    Gaps gaps;
    int settled;             /* the names of its pigment are joined to its own */
} SideTexture;

/* A texture and what has moved it since: `sphere{… texture{T} rotate … scale …}` composes matrices only. */
typedef struct Dressed {
    const SideTexture *texture; /* or NULL */
    int moved;
    Transform pending;
} Dressed;

typedef struct SideInterior {
    Interior interior;       /* first */
    Gaps gaps;
} SideInterior;

typedef struct SideMaterial {
    const SideTexture *texture, *interior_texture;
    const SideInterior *interior;
    const IdentList *idents;
} SideMaterial;

/* ---- objects ---- */

typedef enum ObjectKind { OBJECT_EMPTY, OBJECT_SHAPE, OBJECT_GROUP, OBJECT_LIGHT } ObjectKind;
enum {
    OBJECT_NO_SHADOW = 1, OBJECT_NO_IMAGE = 2, OBJECT_NO_REFLECTION = 4, OBJECT_INVERSE = 8, OBJECT_HOLLOW = 16
};

typedef struct ObjectList {
    const struct Object *object;
    struct ObjectList *next;
} ObjectList;

typedef struct Object {
    ObjectKind kind;
    ShapeKind shape;
    double r0, r1;
    int open;
    const Mesh *mesh;        /* its textures are SideTextures in the mesh's own space */
    int loose;               /* a triangle of its own, which may be gathered into one mesh with its like */
    int polygon;             /* the mesh is a polygon */
    const Light *light;
    const ObjectList *children; /* of a group; of a light: what it looks like */
    Transform transform;     /* canonical shape, or the children's space, to here */
    Dressed texture, interior_texture;
    const SideInterior *interior;
    unsigned flags;
    int uv_mapping;
    int depth;               /* of nested groups */
    double parts;            /* objects in it, counted through identifiers */
    const IdentList *idents;
    int line;
    Gaps gaps;
} Object;

typedef struct SideSky {
    Rgb emission;
    Transform transform;
    int npigments;
    const SidePigment *pigments[16];
} SideSky;

typedef struct SideCamera {
    Camera camera;
    Vec3 sky, look_at;
} SideCamera;

/* ---- the state ---- */

#define PLACED_CACHE 256
typedef struct PlacedTexture {
    const SideTexture *from, *to;
    Transform by;
} PlacedTexture;

typedef struct Side {
    const SideTexture *default_texture;
    SideCamera camera;
    const SideSky *sky;
    int has_assumed_gamma;
    int gamma_srgb;          /* `assumed_gamma srgb` */
    double assumed_gamma;
    double gamma_version;    /* the version where it was set */
    int depth;               /* of nested statements being read */
    /* what is decoded from the working space at the end, each once */
    SidePigment *pigments;
    SideColorMap *maps;
    SideFinish *finishes;
    SideImage *images;
    int primitive_room, light_room;
    unsigned char *loose;    /* by primitive: may be gathered */
    PlacedTexture placed[PLACED_CACHE];
    Mesh *placed_mesh;       /* the last mesh whose own textures were placed */
    const Mesh *placed_mesh_from;
    Transform placed_mesh_by;
    struct Tracer *tracer;   /* trace.c: objects made ready for rays */
} Side;

static inline Side *side_of(Sdl *sdl) { return sdl_side(sdl); }
static inline const SidePigment *side_default_pigment(Sdl *sdl)
{
    return (const SidePigment *)side_of(sdl)->default_texture->texture.pigment;
}

/* Nesting of statements that the parser recurses for; an error when too deep. */
void side_enter(Sdl *sdl);
void side_leave(Sdl *sdl);
/* Room for one more of size bytes in an array of the arena: doubled when full. */
void *side_grow(Sdl *sdl, void *array, int count, int *room, size_t size);

/* The value of the next token where it is an identifier of that kind, else NULL. */
Value *side_peek_ident(Sdl *sdl, ValueKind kind);
/* … taken: its data, or NULL. */
void *side_accept_ident(Sdl *sdl, ValueKind kind);
/* 1 where the next token begins a number (not a vector or colour). */
int side_is_float_start(Sdl *sdl);
double side_optional_float(Sdl *sdl, double missing);
/* A word that introduces a block which is skipped. */
void side_skip_statement(Sdl *sdl);

/* parse_transform.c */
int side_accept_transform(Sdl *sdl, Transform *by); /* one translate, rotate, scale, matrix or transform */
Transform side_transform_block(Sdl *sdl);           /* after `transform` */
int side_transform_is_identity(const Transform *t);

/* parse_pigment.c, parse_pattern.c, parse_image.c */
SidePigment *side_pigment_new(Sdl *sdl, const SidePigment *from /* or NULL */);
SidePigment *side_pigment_body(Sdl *sdl, const SidePigment *from, char end);
SidePigment *side_pigment_block(Sdl *sdl, const SidePigment *from); /* with its braces */
Rgbft side_pigment_mean(const SidePigment *pigment);
int side_pigment_opaque(const SidePigment *pigment);
/* A pattern of whole textures (texture_map, tiles, texture lists): the pigment of their mean colours. */
SidePigment *side_texture_pattern(Sdl *sdl, char end, const SideTexture **first, Gaps *gaps);
SideColorMap *side_color_map(Sdl *sdl);   /* after color_map */
SideColorMap *side_pigment_map(Sdl *sdl); /* after pigment_map */
SideColorMap *side_texture_map(Sdl *sdl); /* after texture_map */
Rgbft side_map_mean(const ColorMap *map);
int side_accept_pattern(Sdl *sdl, SidePigment *pigment, const SideTexture **first, int textures);
int side_accept_pattern_modifier(Sdl *sdl, SidePigment *pigment);
/* `checker A B`, `brick pigment{A} pigment{B}`: up to n of them replace list[]. */
void side_color_list(Sdl *sdl, Rgbft *list, int n, SidePigment *pigment, const SideTexture **first, int textures);
void side_image_map(Sdl *sdl, SidePigment *pigment); /* after image_map */

/* parse_finish.c */
SideFinish *side_finish_new(Sdl *sdl, const SideFinish *from /* or NULL: the built-in one */);
SideFinish *side_finish_block(Sdl *sdl, const SideFinish *from);

/* parse_texture.c */
const SideTexture *side_texture_block(Sdl *sdl); /* after `texture` */
const SideTexture *side_texture_body(Sdl *sdl, char end);
const SideTexture *side_texture_moved(Sdl *sdl, const SideTexture *texture, const Transform *by);
const SideTexture *side_texture_over(Sdl *sdl, const SideTexture *top, const SideTexture *bottom);
const SideTexture *side_texture_named(Sdl *sdl, const SideTexture *texture, const IdentList *more);
/* pigment, finish or normal where the next token is one of them: changes the top layer of *texture (NULL = default). */
int side_accept_texture_part(Sdl *sdl, const SideTexture **texture);
const SideTexture *side_texture_visible(const SideTexture *texture); /* the layer that is shown */
SideTexture *side_texture_copy(Sdl *sdl, const SideTexture *from);
const SideInterior *side_interior_block(Sdl *sdl, const SideInterior *from);
const SideMaterial *side_material_block(Sdl *sdl);

/* parse_object.c, parse_shape.c, parse_polygon.c, parse_mesh.c, parse_light.c */
const Object *side_accept_object(Sdl *sdl); /* an object statement or identifier, or NULL where none is next */
Object *side_object_new(Sdl *sdl, ObjectKind kind);
void side_object_holds(Sdl *sdl, Object *object, const Object *child); /* counts; an error beyond all bounds */
void side_object_move(Object *object, const Transform *by);
int side_accept_object_modifier(Sdl *sdl, Object *object);
void side_object_modifiers(Sdl *sdl, Object *object); /* up to the closing brace */
typedef void ShapeParser(Sdl *sdl, Object *object);   /* what stands between `{` and the modifiers */
ShapeParser side_sphere, side_box, side_plane, side_cylinder, side_cone, side_torus, side_disc, side_triangle,
    side_smooth_triangle, side_polygon, side_mesh, side_mesh2;
const Object *side_light_source(Sdl *sdl); /* after light_source */
int side_polygon_triangulate(Sdl *sdl, const Vec2 *points, const int *starts, int nrings, Vec2 **corners,
                             int *ncorners);

/* trace.c */
int side_mesh_holds(Sdl *sdl, const Mesh *mesh, Vec3 p); /* an odd number of faces lies between p and far away */

/* parse_camera.c, parse_global.c */
void side_camera_default(SideCamera *camera);
const SideCamera *side_camera_block(Sdl *sdl);
void side_camera_use(Sdl *sdl, const SideCamera *camera);
void side_global_settings(Sdl *sdl);
void side_background(Sdl *sdl);
const SideSky *side_sky_sphere(Sdl *sdl);

/* parse_place.c, parse_settle.c */
void side_place(Sdl *sdl, const Object *object);
void side_gather_triangles(Sdl *sdl);
void side_settle(Sdl *sdl); /* everything that waits for the end of the scene */
Rgb side_decode_color(Sdl *sdl, Rgb color); /* from the working space */

/* parse_albedo.c */
int side_finish_shines(const Finish *finish); /* 1: its pigment stands for light */
void side_check_albedo(Sdl *sdl, const Texture *texture);

#endif
