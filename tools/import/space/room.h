/* Whether a model is a room, and where a person would stand in it. Lengths are those of the Space. */
#ifndef RETEX_IMPORT_ROOM_H
#define RETEX_IMPORT_ROOM_H

#include "import/space/space.h"

/* A square of the floor plan. */
typedef struct RoomCell {
    float floor, reach; /* its height; free height above it, up to the top of the model where nothing is above */
    float top;          /* of what stands there, seen from below the ceiling; -INFINITY: nothing */
    float clearance;    /* from the eye's height and from half of it, to the nearest thing beside */
    float enclosed;     /* share of directions at the eye's height in which something is */
    unsigned char is_floor, is_covered; /* the room's floor is free there; something is above */
    unsigned char is_inside;            /* of the region that is the room */
} RoomCell;

typedef struct Room {
    const Space *space;
    double low[3], high[3]; /* of the plan in x and z; of the model in y */
    double cell;            /* the side of a cell */
    int nx, nz;
    RoomCell *cells; /* nx a row, nz rows */
    int ninside;
    double floor, height; /* of the floor; free height above it */
    double metre;         /* length of a metre, for the eye's height */
    double eye;           /* height of the eye */
    double enclosed;      /* mean of the region */
    double covered;       /* share of the region that has a ceiling */
    double share;         /* of the region, of all free floor */
    double clearance;     /* most of a place in it */
    int is_furnished;     /* things stand in it */
    int is_solid;         /* the region is the inside of a solid */
    int is_said;          /* the length of a metre was said */
    int is_doubtful;      /* metre is not what was said: the furniture is too high for it, or the room too low */
    int is_furniture;     /* its free space is as high as no room is, in any unit that it may be in */
    int is_found;         /* there is a floor with free space */
    int is_closed;        /* one can say that it is a room: auto goes inside */
} Room;

/* metre: length of a metre; 0: unknown, it follows from the free height. is_sure: it holds, whatever furniture says. */
int room_find(Room *room, const Space *space, double metre, int is_sure, RetexError *err);
void room_free(Room *room);
/* The middle of a cell, at a height above the floor. */
void room_point(const Room *room, int cell, double height, double point[3]);
/* Whether a cell has free floor with walls around. */
int room_is_enclosed(const RoomCell *cell);
/* Which cell is below a point, or -1. */
int room_cell_at(const Room *room, double x, double z);
/* Of all directions from places in the room, the share in which light comes from outside; what passes[tag] is of lets
 * it through. */
double room_openness(const Room *room, const unsigned char *passes);

#endif
