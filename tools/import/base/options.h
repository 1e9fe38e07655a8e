/* What is asked of an import. */
#ifndef RETEX_IMPORT_OPTIONS_H
#define RETEX_IMPORT_OPTIONS_H

#include <retex/access.h>
#include <retex/budget.h>

/* How messages are told: `kind` is one of these letters. */
enum { IMPORT_WARNING = 'w', IMPORT_INFO = 'i', IMPORT_DETAIL = 'd', IMPORT_ANSWER = 'a' /* what was asked for */,
       IMPORT_TARGET = 't' /* that the scene offers: its name, selector and share of the view, between tabs */,
       IMPORT_FRAMED = 'f' /* no text: the view is none of the model's cameras */ };
typedef void ImportTell(void *context, char kind, const char *text);

typedef struct ImportOptions {
    const char *model;       /* the file to import */
    const char *name;        /* of the scene; the file is NAME.pov */
    const char *folder;      /* to write into: it exists and is empty; NULL: list_variants */
    const char *sky;         /* a picture of the sky, or NULL */
    const char *camera;      /* name or number from 1, auto, inside, outside, cutaway, or where it is; NULL: auto */
    const char *const *also; /* more folders that may be read, of -I */
    int nalso;
    const char *variant;     /* of a glTF file, or NULL: its own materials */
    int list_variants;       /* tell their names, and make no scene */
    char up;       /* 'y' or 'z': the model's axis that is up; 0: what its format says */
    double scale;  /* of all lengths, that of the unit included */
    int unit;      /* 1: the model's unit is asked for, and is in scale */
    int is_scaled; /* 1: a scale is asked for */
    double lights; /* factor of all light sources */
    double smooth; /* degrees: edges that are flatter become smooth where a mesh has no normals; 0: none */
    int looks;     /* 1: a first look at the scene follows, for which there are to be small copies of its pictures */
    int partial; /* 1: the scene is made although images, objects or lights are lost, which is told */
    int safe;           /* as of RetexAccess */
    int accept_damaged; /* 1: damaged pictures are read as far as possible, with a warning */
    long max_pixels;
    double seconds; /* of the processor, for reading */
    RetexBudget *budget;
    ImportTell *tell;
    void *context;
} ImportOptions;

#endif
