/* What the files of retex-import share. */
#ifndef RETEX_IMPORT_INTERNAL_H
#define RETEX_IMPORT_INTERNAL_H

#include <limits.h>
#include <stdint.h>
#include <stdio.h>

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <jansson.h>

#include "import/import.h"

#define PI 3.14159265358979323846

enum { GLTF_REFUSED_SIZE = 256 };
enum { NAME_MAX_LENGTH = 48, NAME_SIZE = 64, TEXT_SIZE = sizeof((struct aiString *)NULL)->data }; /* of Assimp */

/* ---- names.c: identifiers that are legal, unique whatever the case, and no keywords ---- */

typedef struct Names {
    struct NamesEntry *entries;
    size_t size, count;
} Names;

/* Make an identifier of a text; of `fallback` where the text has no letters. Returns 0 without memory. */
int names_make(Names *names, const char *text, const char *fallback, char name[NAME_SIZE]);
/* Whether that is one of them, with the same case of letters. */
int names_have(const Names *names, const char *text);
/* Keep a text as it is. Returns 0 if it was there, whatever its case; -1 without memory. */
int names_add(Names *names, const char *text);
void names_free(Names *names);

/* ---- affine.c: transforms of the scene, in doubles ---- */

typedef struct Affine {
    double m[3][4]; /* of column vectors, as Assimp's: the last column is the translation */
} Affine;

extern const Affine affine_identity;
Affine affine_from(const struct aiMatrix4x4 *m);
int affine_is_finite(const Affine *a);
Affine affine_multiply(const Affine *a, const Affine *b); /* b first */
void affine_point(const Affine *a, const double p[3], double out[3]);
void affine_vector(const Affine *a, const double v[3], double out[3]);
/* The same map for points whose z has the other sign: from a right-handed space to POV-Ray's left-handed one. */
Affine affine_mirror_z(const Affine *a);
/* Write as transforms of POV-Ray with a space before each; nothing for the identity. */
void affine_print(FILE *out, const Affine *a);
void vector_print(FILE *out, const char *before, const double v[3], const char *after);

/* ---- the import ---- */

typedef struct Import Import;
typedef struct Sense Sense;

typedef enum AlphaMode { ALPHA_IGNORE, ALPHA_BLEND, ALPHA_MASK } AlphaMode;

/* An image as a pigment uses it. Where the file as it is will not do, a new one is made. */
typedef struct ImageUse {
    const char *source;  /* as the model names it; "*3" is the fourth one inside of it */
    const char *opacity; /* an image whose alpha or grey is the opacity, or NULL */
    float factor[3];     /* multiplies the colours, linear */
    float opacity_factor;
    AlphaMode alpha;
    float cutoff; /* of ALPHA_MASK */
} ImageUse;

typedef struct ImportMaterial {
    char name[NAME_SIZE];
    int uv_set;    /* of the meshes, which the image uses */
    int second_uv; /* the set that maps use which do not use the first; -1: none */
    int has_image;
    int has_maps; /* images of any kind, so that UV matter */
    float vertex_factor[3]; /* of colours of vertices, where there is no image */
    int place;     /* in a glTF file; -1: not there */
    int is_solid;  /* declared as a material, with an interior */
    int is_opaque; /* nowhere does light go through it */
    int is_clear;  /* light goes through all of it */
    float radiance; /* of what it shines, about */
    int is_used;
} ImportMaterial;

/* Cameras and lights of a glTF file are those of its nodes. Assimp knows nodes by their names only, which may be
 * missing or the same, and one node of each camera or light. */
typedef struct GltfCamera {
    char name[TEXT_SIZE];               /* of the node; see gltf_node_name */
    Affine place;                       /* of the node, in the scene; z not mirrored */
    double angle, aspect;               /* from top to bottom, in radians; width by height. 0 = not there */
    double width, height;               /* of an orthographic one, or 0 */
    double shift[2];                    /* of the lens, in widths and heights of the picture */
    double lens_radius, focus_distance; /* 0 = sharp everywhere */
} GltfCamera;

/* Lengths are in the node's space, angles in radians. */
typedef struct GltfLight {
    char name[TEXT_SIZE]; /* of the node */
    Affine place;
    enum aiLightSourceType type;
    double color[3];         /* W/sr or W/m2 where the file has watts; of an area, radiance */
    double inner, outer;     /* of a spot: half angles */
    double tightness;        /* of a spot: the power of the cosine that dims it */
    double radius;           /* of a point or spot */
    double angle;            /* of the sun: its diameter in the sky */
    double width, height;    /* of an area, which shines towards -z */
    int is_ellipse, is_seen; /* an area; by the camera */
} GltfLight;

/* Of a material's extras: its image of normals has heights. */
typedef struct GltfBump {
    int is_there, is_color;    /* its colours are sRGB; else numbers */
    float distance, strength; /* height of white; of the mixture with a smooth surface */
} GltfBump;

typedef struct Gltf {
    /* by material: of emission, of the reflectance at normal incidence, 20 over Abbe's number */
    float *strengths, *speculars, *dispersions;
    GltfBump *bumps;
    GltfCamera *cameras;
    GltfLight *lights;
    int nmaterials, ncameras, nlights;
} Gltf;

/* Surfaces whose material variants change together. */
typedef struct VariantSurfaces {
    int material; /* its place in the file as Assimp is given it; theirs alone */
    int *others;  /* by variant: the material that takes its place, or itself */
} VariantSurfaces;

typedef struct Variants {
    int count, nsurfaces;
    char (*names)[NAME_SIZE]; /* by variant, for people */
    VariantSurfaces *surfaces;
    char *command; /* which renders those of the table; NULL: there is no table */
    char *is_apart; /* by variant: it needs a scene of its own */
} Variants;

/* A view into rooms from above, of a model without what stands before them. */
typedef struct Cutaway {
    double eye[3], target[3], angle; /* of the camera, in the scene */
    long count;                      /* of triangles that are left out */
} Cutaway;

typedef struct ImportPlace {
    Affine world; /* z not mirrored */
    int is_known; /* 0: left out, which is told */
} ImportPlace;

struct Import {
    const ImportOptions *options; /* their scale is that of the unit, too */
    ImportOptions *own_options;   /* the same, to be changed */
    const struct aiScene *scene;
    RetexAccess access; /* of files that the model names */
    const char *roots[64];
    char root[PATH_MAX];   /* folder of the model, resolved */
    char denied[PATH_MAX]; /* the first file outside that the model asked for */
    int is_gltf, is_fbx, is_3ds;
    int axes_are_unknown; /* the format does not say which one is up */
    int has_metres;       /* lengths are metres, by the format or as Assimp makes them */
    Gltf gltf;
    int gltf_is_prepared;
    Variants variants;      /* that are still to be chosen */
    FILE *gltf_prepared;    /* of gltf_prepare, or NULL */
    char gltf_refused[GLTF_REFUSED_SIZE]; /* what it cannot say in other words, or "" */
    Names names, files; /* identifiers; names of files */
    Affine world;       /* from the model's space: axes and scale, before z is mirrored */
    ImportPlace *light_places, *camera_places; /* of Assimp's lights and cameras */
    Sense *sense; /* of sense_find, or NULL */
    ImportMaterial *materials;
    char (*meshes)[NAME_SIZE]; /* identifiers; "" = without surface */
    unsigned char *is_dropped; /* objects in the order of a walk: the same one is there already, or it is cut away */
    unsigned long walked;      /* objects that write_object has seen */
    Cutaway *cutaway;          /* NULL: not asked for */
    double low[3], high[3];    /* of the scene as written */
    long triangles, objects;
    int emits; /* some material shines enough to light the scene */
    struct ImageFile *images;
    int nimages, image_capacity;
    unsigned long left_out; /* bits of LeftOut */
    Names lost_images;      /* each once */
    int nlost_images;
};

/* Features that a scene cannot say yet: told once each. */
typedef enum LeftOut {
    LEFT_NORMAL_MAP,
    LEFT_FINISH_MAP,
    LEFT_EMISSION_MAP,
    LEFT_SPECULAR_MAP,
    LEFT_SHEEN_ROUGHNESS_MAP,
    LEFT_VERTEX_COLORS,
    LEFT_ANIMATION,
    LEFT_SKIN,
    LEFT_MORPHS,
    LEFT_AMBIENT_LIGHT,
    LEFT_OTHER_UV,
    LEFT_NO_UV,
    LEFT_NOWHERE,
    LEFT_LINES,
    LEFT_SAME_NAME
} LeftOut;

void import_leave_out(Import *import, LeftOut what);
void import_tell(const Import *import, char kind, const char *fmt, ...) RETEX_PRINTF(3, 4);

/* losses.c */
/* An image that is lost. Returns 1 if that is to be told: each is once, and not without end. */
int losses_of_image(Import *import, const char *source);
/* At the end: fails where something is lost, unless a scene without it was asked for. */
int losses_check(Import *import, RetexError *err);
/* import.c */
/* Called for every node with its transform, z not mirrored. Returns 0 without memory. */
typedef void ImportVisit(Import *import, const struct aiNode *node, const Affine *world, void *context);
int import_visit_nodes(Import *import, ImportVisit *visit, void *context);
/* Which axis is up, before nodes are placed. */
void import_set_world(Import *import, char up);
/* Multiply all lengths, before nodes are placed; cameras and lights of glTF are. */
void import_set_scale(Import *import, double scale);
/* sense.c */
/* Find out what the model means: whether it is a room, and its unit. */
int sense_find(Import *import, RetexError *err);
void sense_free(Import *import);

/* files.c */
int files_begin(Import *import, RetexError *err);
struct aiFileIO *files_io(Import *import);
void files_close_io(struct aiFileIO *io);
/* Find a file that the model names, in its folder and those of -I. RETEX_EACCESS: it is outside of them. found = 0: it
 * is nowhere. */
int files_find(Import *import, const char *name, char path[PATH_MAX], int *found, RetexError *err);

/* gltf.c */
enum { GLTF_MAGIC = 0x46546c67, GLTF_JSON_CHUNK = 0x4e4f534a, GLTF_BINARY_CHUNK = 0x004e4942 };
uint32_t gltf_little(const unsigned char *bytes);
/* How many bytes of a file are left. */
size_t gltf_rest_of(FILE *in);
typedef struct GltfText {
    json_t *json;               /* of a .gltf or .glb file; NULL: there is none */
    int is_binary, is_repaired; /* repaired: Assimp does not read it as it is */
    char why[160];              /* there is no JSON although there should be */
} GltfText;
/* In a .glb, the binary chunk is next. */
GltfText gltf_load(FILE *in);
/* What Assimp leaves out, into import->gltf. */
int gltf_read(Import *import, RetexError *err);
/* Tell the names of the file's variants. */
int gltf_list_variants(const Import *import, RetexError *err);
/* Fail where this tool, or the file itself, says better than Assimp why it cannot be read. */
int gltf_explain(const Import *import, RetexError *err);
void gltf_free(Gltf *gltf);
double gltf_number(const json_t *object, const char *key, double otherwise);
/* Whether something is so: Blender writes 1 for true. */
int gltf_flag(const json_t *object, const char *key);
const json_t *gltf_extension(const json_t *of, const char *name);
/* A material's name, or its place in the file. */
const char *gltf_material_name(const json_t *json, size_t index, char plain[NAME_SIZE]);
/* What extras of a node say for this tool, or NULL. */
const json_t *gltf_extras(const json_t *node);
/* gltf_indices.c: why the file cannot be read, which may not refer to more than it has; or nothing. */
void gltf_check_indices(const json_t *json, char why[GLTF_REFUSED_SIZE]);
/* The place in the file of a material of that name, which gltf_prepare has marked; *name becomes its own. -1: Assimp
 * made it. */
int gltf_material_place(const char **name);
/* gltf_prepare.c */
/* The file, or in its place one that says the same in words that Assimp reads well. NULL: it is refused (see
 * gltf_explain), or cannot be opened again. */
FILE *gltf_prepare(Import *import, FILE *in);
/* morphs.c: into Assimp's meshes */
int morphs_apply(Import *import, RetexError *err);
/* tds.c: into Assimp's cameras */
void tds_read(Import *import);
/* gltf_nodes.c */
/* A node of the scene that the file shows. */
typedef struct GltfNode {
    const json_t *json;
    Affine place; /* z not mirrored */
    int is_shown; /* neither it nor a node above it is hidden by KHR_node_visibility */
} GltfNode;
/* Returns 0 to stop. */
typedef int GltfVisit(Import *import, const json_t *json, const GltfNode *node, void *context);
/* Whether the node says that it and all below it are hidden. */
int gltf_is_hidden(const json_t *node);
/* Returns 0 without memory, or where a visit stopped. */
int gltf_visit_nodes(Import *import, const json_t *json, GltfVisit *visit, void *context);
/* Its name, else that of the camera or light that it has, else its number. */
void gltf_node_name(const json_t *json, const json_t *node, const json_t *has, char name[TEXT_SIZE]);
/* gltf_cameras.c. Returns 0 without memory. */
int gltf_take_cameras(Import *import, const json_t *json);
/* gltf_images.c: tell of images that are lost. */
void gltf_note_images(Import *import, const json_t *json);
/* gltf_lights.c. Returns 0 without memory. */
int gltf_take_lights(Import *import, const json_t *json);
/* Returns 1 if there are any. */
int gltf_lights_write(Import *import, double user, FILE *out);

/* images.c */
/* Put the image into the scene's folder. file: its name there, or "" where it is missing, which is told. */
int images_use(Import *import, const ImageUse *use, char file[NAME_SIZE + 32], RetexError *err);
/* What an image's channels are as numbers. */
typedef struct ChannelStats {
    float mean[4], low[4], high[4];
} ChannelStats;
/* found = 0: the image is missing. */
int images_stats(Import *import, const char *source, ChannelStats *stats, int *found, RetexError *err);
/* Put one channel of an image, as numbers, into the scene's folder: a grey picture whose name ends in `what`. */
int images_channel(Import *import, const char *source, int channel, const char *what, char file[NAME_SIZE + 32],
                   RetexError *err);
/* Make a normal map of an image of heights, which are as high as a hundredth of the image is wide, times scale. */
int images_normals(Import *import, const char *source, float scale, char file[NAME_SIZE + 32], RetexError *err);
int images_add_sky(Import *import, char file[NAME_SIZE + 32], RetexError *err);
/* POV-Ray's keyword for a file's format. */
const char *images_keyword(const char *file);
void images_free(Import *import);

/* materials.c */
/* The finish of one of the model's materials on surfaces of another one, `to`: "finish { … }", to be freed. */
int materials_finish(Import *import, int index, ImportMaterial *to, char **text, RetexError *err);
int materials_write(Import *import, FILE *out, RetexError *err);
/* meshes.c */
/* Whether there is a triangle with an area in it. */
int mesh_has_surface(const struct aiMesh *mesh);
/* Whether vertices have colours that show. */
int mesh_has_colors(const struct aiMesh *mesh);
/* A triangle with an area, whose indices and positions are numbers that there are. */
int mesh_is_surface(const struct aiMesh *mesh, const struct aiFace *face);
int meshes_write(Import *import, FILE *out, RetexError *err);
/* The bounds of a mesh, z mirrored. Returns 0 if it is empty. */
int mesh_bounds(const struct aiMesh *mesh, double low[3], double high[3]);
/* lights.c */
int lights_write(Import *import, FILE *out, RetexError *err);
/* cameras.c */
int cameras_write(Import *import, FILE *out, RetexError *err);
/* doubles.c */
/* Of faces that lie on one another, one stays; once materials are known. */
int doubles_drop(Import *import, RetexError *err);
int doubles_find_objects(Import *import, RetexError *err);
/* ceiling.c */
/* Whether surfaces shine enough to be the light of the scene. */
int ceiling_emits(const Import *import);
/* Whether the model is a room that no sky can light. */
int ceiling_is_needed(const Import *import, int *is_needed, RetexError *err);
int ceiling_write(Import *import, FILE *out, RetexError *err);
/* cutaway.c */
/* Whether the options ask for it. */
int cutaway_is_asked(const Import *import);
/* Place the camera, into import->cutaway, and drop what stands before the rooms, where it is asked for. */
int cutaway_find(Import *import, RetexError *err);

/* framing.c */
/* Where a camera sees all of a box, from a side: a vector from its middle, of any length. angle: degrees, from left to
 * right. */
void framing_fit(const double low[3], const double high[3], const double side[3], double angle, double eye[3],
                 double target[3]);
/* Whether --camera asks for a view that is none of the model's: a place, or the words inside and outside. */
int framing_is_asked(const Import *import, int *is_asked, RetexError *err);
/* A view of the scene: what is asked for, else from inside of a room and from outside of what is none. */
int framing_write(Import *import, FILE *out, RetexError *err);
/* places.c */
/* Where cameras and lights are that Assimp has read: it tells their nodes by names, which may be the same. Those that
 * cannot be told apart are left out, and told. */
int places_find(Import *import, RetexError *err);
/* Text for a comment, without control characters. */
const char *import_plain(const char *text, char plain[NAME_SIZE]);

#endif
