/* Photons from lights through glass and off mirrors, traced before the picture for the guide to caustics. */
#ifndef RENDERER_PATH_PHOTONS_H
#define RENDERER_PATH_PHOTONS_H

#include "accel/accel.h"
#include "light/lights.h"

/* A photon that landed on a surface that scatters widely. */
typedef struct Landing {
    Vec3 position, from; /* from: on the last surface that refracted or mirrored it */
    float power;
} Landing;

typedef struct Photons {
    Landing *landings; /* to be freed */
    int count, tried;
} Photons;

/* Whether a shape that emits looks small from what may throw caustics: there photons may be worth their time. */
int photons_small_emitters(const Scene *scene, const Lights *lights);

/* What photons start from, and how many: see caustics_create. None land where nothing throws caustics. */
typedef struct PhotonSources {
    const Scene *scene;
    const Accel *accel;
    const Lights *lights;
    long paths; /* of the picture, of whose time photons take a small share */
    const RetexBudget *budget; /* may stop it, or NULL */
    int of_emitters; /* set by caustics_create */
} PhotonSources;

/* The result is the same for every nthreads. */
int photons_trace(Photons *photons, const PhotonSources *sources, int nthreads, RetexError *err);

#endif
