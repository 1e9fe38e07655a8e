/* The scene: what the scene language leaves and everything after it reads. It is plain data, all of it in one arena.
 * Before a render begins, scene_resolve_targets and target_units_choose mark its targets, and the render sets `pixels`;
 * then nothing changes. Units are the scene's own, angles are in radians unless said, colours scene-linear Rec.709.
 *
 * Conventions of POV-Ray hold (left-handed, row-vector matrices already turned into Transforms). Where POV-Ray and
 * physics differ, the mapping is described in retex-scene(5) and done in shade/material.c, not here: this file keeps
 * what the author wrote. */
#ifndef RENDERER_SCENE_SCENE_H
#define RENDERER_SCENE_SCENE_H

#include "scene/light.h"

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

/* What selects faces instead of objects; faces/faces.h tells which they are. */
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
    int several;      /* 1: it has several colours, or an image; or a surface whose colour has a channel of 0 */
    int has_one_color; /* 1: of which `color` is the scene's, of its brightest emitter; also where several is 1 */
    Rgb color;
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

/* A target that a scene offers: what stands after `-t NAME=`. */
typedef struct SceneTarget {
    const char *name, *selectors;
} SceneTarget;

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
    double exposure;         /* of pictures: they have the scene's light times 2^exposure */
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
    int noffered;
    SceneTarget *offered;    /* of retex_targets, each name once */
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
/* The target that the scene offers by that name: exactly, else whatever its case where no identifier is called exactly
 * so. NULL: none. */
const SceneTarget *scene_offers(const Scene *scene, const char *name);
/* Of two targets, or -1, the one that was asked for first: it wins. */
static inline int first_target(int a, int b) { return a < 0 || (b >= 0 && b < a) ? b : a; }
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
