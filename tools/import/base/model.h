/* A model as it is imported: what the rooms of retex-import know of it. Each has calls in its own headers. */
#ifndef RETEX_IMPORT_MODEL_H
#define RETEX_IMPORT_MODEL_H

#include <limits.h>
#include <stdint.h>
#include <stdio.h>

#include <assimp/scene.h>

#include "import/base/affine.h"
#include "import/base/names.h"
#include "import/base/options.h"

enum { GLTF_REFUSED_SIZE = 256 };
enum { TEXT_SIZE = sizeof((struct aiString *)NULL)->data }; /* of Assimp */

typedef struct Import Import;
typedef struct Sense Sense;

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
    char denied[PATH_MAX]; /* the first file outside that the model asked for, of those that are no pictures */
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
    double eye[3], target[3];  /* of the camera in use, in the scene; what it looks at */
    double angle;              /* of it, in degrees from left to right */
    long triangles, objects;
    int emits; /* some material shines enough to light the scene */
    struct ImageFile *images;
    int nimages, image_capacity;
    unsigned long left_out; /* bits of LeftOut */
    Names lost_images;      /* each once */
    int nlost_images;
};

#endif
