/* What a view shows, taken by rays at the size of a thumbnail, and how much that is worth. */
#ifndef RETEX_IMPORT_PICTURE_H
#define RETEX_IMPORT_PICTURE_H

#include "import/space/room.h"

enum { PICTURE_WIDTH = 64, PICTURE_HEIGHT = 48 };

/* Where a view is from. Lengths are those of the Space. */
typedef struct View {
    double eye[3], ahead[3], up[3]; /* of length 1 */
    double angle, aspect;           /* degrees from left to right; width by height */
    double width;                   /* of a parallel projection, or 0 */
} View;

typedef enum PictureKind {
    PICTURE_NOTHING,
    PICTURE_FLOOR,
    PICTURE_CEILING,
    PICTURE_WALL,
    PICTURE_FURNITURE
} PictureKind;

typedef struct PictureSample {
    float distance; /* in metres */
    uint32_t tag;
    float at[2]; /* x and z of the point */
    unsigned char kind, is_front;
    unsigned char side; /* of a cube, which the surface faces like */
} PictureSample;

typedef struct Picture {
    int width, height; /* rows from the top */
    double tilt;       /* of the view: 0 = its horizon is level and verticals are upright, 1 = neither at all */
    double size;
    PictureSample samples[PICTURE_WIDTH * PICTURE_HEIGHT];
} Picture;

/* Shares of the picture, but for what is said. */
typedef struct Content {
    double furniture, floor, wall, ceiling, nothing;
    double near;     /* nearer than half a metre; less and less of what is up to a metre away */
    double back;     /* seen from behind */
    double middle;   /* of furniture: 1 in the middle of the picture, 0 in its corners */
    double cut;      /* of furniture that the edges cut */
    double largest;  /* of the largest piece of furniture */
    double obstacle; /* of what is much nearer than the rest, but for the floor */
    double extent;   /* not a share: how far apart what is seen lies, by the size of the model */
    double depth;    /* 0 to 1: how much is near, at a middle distance and far, as that of most of the picture goes */
    double objects, materials; /* how different it is in them: bits of entropy */
    double detail; /* the length of edges between surfaces of other objects or directions, in diagonals or so */
    int things;    /* number of objects that can be made out */
    double tilt;   /* see Picture */
    double open;   /* of views from inside: share of all that is around in which there is nothing */
    double behind; /* of views from outside: how far it is from the side on which things have their front */
} Content;

/* The length that distances are told in: a metre, or less where the model is no larger than a piece of furniture. */
double picture_metre(const Room *room);
/* What a ray meets, in metres. */
PictureSample picture_sample(const Room *room, const double from[3], const double direction[3]);
/* The direction of a place in the picture: u and v from -1 to 1, to the right and up. */
void picture_ray(const View *view, double u, double v, double from[3], double direction[3]);
/* width, height: at most PICTURE_WIDTH and PICTURE_HEIGHT. */
void picture_take(const Room *room, const View *view, int width, int height, Picture *picture);
double picture_size(const Room *room);
double picture_tilt(const View *view);
/* materials: by tag; NULL: each is of its own. */
Content picture_content(const Picture *picture, const uint32_t *materials);
double content_score(const Content *content);

#endif
