/* What the list of lights holds: light sources, emitting shapes and meshes, the sky. Each kind of entry is a row of
 * operations, so that the choice among lights (light/lights.c) knows none of them. */
#ifndef RENDERER_LIGHT_ENTRY_H
#define RENDERER_LIGHT_ENTRY_H

#include "light/light_tree.h"
#include "light/mesh_light.h"
#include "light/source.h"

/* The light that was chosen. */
typedef struct LightPick {
    int entry; /* -1: there is no light */
    int face;  /* of its mesh light, or -1: the point's numbers choose it */
    float probability;
} LightPick;

typedef struct LightEntryOps LightEntryOps;

typedef struct LightEntry {
    const LightEntryOps *ops;
    const Scene *scene;
    int index;       /* of the light source or primitive */
    int lamp;        /* of the scene's lamps */
    float strength;  /* shape: radiance * area; sky: irradiance; source: luminance of its colour times pi */
    int is_infinite; /* infinitely far: it has no place in the tree */
    int nfaces;      /* of a mesh of which each face is a light of its own; 0: it is one light */
    void *data;      /* the row's own, or NULL; its `close` frees it */
    /* of shapes: */
    Vec3 center;     /* of the bounds */
    double radius, area;
    int is_sphere;   /* sampled by the cone it is seen in */
    float weight;    /* of the list: by which its estimates are multiplied, as its lamp has it */
} LightEntry;

/* The list while it is made. */
typedef struct LightEntries {
    const Scene *scene;
    LightEntry *entries;
    int count, capacity;
} LightEntries;

struct LightEntryOps {
    /* Add all entries of this kind that the scene has; NULL: another row does. */
    int (*add)(LightEntries *list, RetexError *err);
    void (*close)(LightEntry *entry); /* or NULL */
    /* Whether it shines on what is in a light group. NULL: on everything. */
    int (*reaches)(const LightEntry *entry, const LightGroup *light_group);
    /* Estimate of the irradiance on a surface that faces it. NULL: its strength, everywhere. */
    float (*estimate)(const LightEntry *entry, Vec3 position);
    /* For the tree: of one of its nfaces, or of the whole, -1. NULL where all entries of this kind are infinite. */
    LightBounds (*bounds)(const LightEntry *entry, int face);
    /* Sample light for a point; pick_probability and lamp are filled in. Returns 0 where no light reaches it. */
    int (*sample)(const LightEntry *entry, const LightPick *pick, Vec3 position, float u1, float u2,
                  LightSample *sample);
    /* Density of `sample`, per solid angle, in a direction in which a ray met the entry: at that surface, if it is a
     * shape. *face: which of nfaces, else it stays. NULL: no ray meets it. */
    double (*pdf)(const LightEntry *entry, Vec3 from, Vec3 direction, const Surface *surface, int *face);
    /* Of shapes, NULL elsewhere. Sample a point by area, where photons may start, too: returns its density, or 0 where
     * nothing is left of an operand of CSG. And the density at a surface that a ray met, with *face as above. */
    double (*point)(const LightEntry *entry, const LightPick *pick, float u1, float u2, Surface *surface);
    double (*point_density)(const LightEntry *entry, const Surface *surface, int *face);
    /* See lights_uniform_point. NULL: it has none. */
    int (*uniform_point)(const LightEntry *entry, const LightPick *pick, float u1, float u2, MeshLightPoint *point);
};

/* The rows, in the order of the list: shapes stand first, where photons look for them. A new kind of light is a line
 * here, and a file with its row; a new kind of light_source is one of light/sources.h. */
#define LIGHT_ENTRY_TABLE(X) \
    X(shape)                 \
    X(mesh)                  \
    X(source)                \
    X(sky)

#define X(name) extern const LightEntryOps entry_##name;
LIGHT_ENTRY_TABLE(X)
#undef X

/* entries.c: a copy of the entry, of the list's scene, is the list's last one. On failure the caller still owns the
 * entry's data. */
int light_entries_add(LightEntries *list, const LightEntry *entry, RetexError *err);

#endif
