/* The folders that the server knows: that of the model, what it writes, textures, and what the dialog for opening may
 * show. Nothing outside of them is read or listed, wherever links lead. */
#ifndef RETEX_STUDIO_PLACES_H
#define RETEX_STUDIO_PLACES_H

#include <limits.h>

#include <retex/access.h>

#include "changes.h"

#define PLACES_FILES "files" /* folder of files that were sent, in the one that is written to */

enum { PLACES_TEXTURES = 64 };

/* An opened model. It stays as it is, and is freed at the end only, so that whoever has it may keep it. */
typedef struct Model {
    struct Model *older;
    char *path;    /* of the file, absolute, links resolved */
    char *name;    /* its last part */
    char *folder;  /* that it lies in */
    char *written; /* folder `room.glb.studio` beside it; names in messages end in it */
    int top;       /* that folder, open: it stays the one that was judged */
    char *project; /* file `room.glb.studio.json` beside it */
    /* Why somebody else may have filled the folder or written the project; NULL: the user's studio has, or the user has
     * agreed. Until then nothing is run for it. Guarded by the lock of changes. */
    const char *foreign;
} Model;

typedef struct Places {
    Changes *changes;
    Model *model;                    /* the newest; guarded by the lock of changes; NULL: none is open */
    char *textures[PLACES_TEXTURES]; /* as realpath(3) gives them; they are added only */
    int ntextures;
    char *home;    /* or NULL */
    char *dropped; /* folder for models that are dropped while none is open; need not exist */
} Places;

int places_open(Places *places, Changes *changes, RetexError *err);
void places_close(Places *places);

const Model *places_model(Places *places);
/* Open another model, or by a project its model. The path is absolute, or relative to the model that is open, or
 * without one to the current folder. The folder that is written to is made; where a link has its name, that is an
 * error. */
int places_open_model(Places *places, const char *path, RetexError *err);
/* The user agrees to go on with a foreign model. RETEX_ENOTFOUND: it is not the one that is open. */
int places_trust(Places *places, const char *path, RetexError *err);
/* RETEX_EACCESS: nothing is run or written for this model, until the user has agreed; RETEX_EINVAL: none is open. */
int places_check_trust(Places *places, const Model *model, RetexError *err);
int places_add_textures(Places *places, const char *path, RetexError *err);
/* What a path of a request may name. */
typedef enum Reach {
    REACH_SHOWN,  /* what is served as it is: written files and textures */
    REACH_LISTED, /* besides: the model's folder, dropped models and the home folder, without hidden files */
} Reach;

/* Access to what is within reach, for the time of a request. */
typedef struct ReachAccess {
    RetexAccess access;
    const char *roots[PLACES_TEXTURES + 4];
    char resolved[PATH_MAX];
} ReachAccess;
void places_access(Places *places, Reach reach, ReachAccess *access);

/* The absolute path of one of a request: absolute, or relative to the model's folder, without a model to the home
 * folder. RETEX_EINVAL where it is none, or has a hidden part. */
int places_resolve(Places *places, const char *path, char absolute[PATH_MAX], RetexError *err);

#endif
