/* Light sources, cameras, sky and air of a scene (scene.h). */
#ifndef RENDERER_SCENE_LIGHT_H
#define RENDERER_SCENE_LIGHT_H

#include "scene/primitive.h"

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
    int has_one_color;       /* 1: its radiance is `color` in all directions, seen and as light */
    Rgb color;
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

#endif
