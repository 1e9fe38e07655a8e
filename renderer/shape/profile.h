/* Plane curves of polynomial segments, which prism sweeps and lathe turns. */
#ifndef RENDERER_SHAPE_PROFILE_H
#define RENDERER_SHAPE_PROFILE_H

#include "base/vec.h"

enum { PROFILE_DEGREE = 3 };

/* c[0] + c[1] u + c[2] u^2 + c[3] u^3 for u from 0 to 1. */
typedef struct ProfileSegment {
    Vec2 c[PROFILE_DEGREE + 1];
    Vec2 end;       /* at u = 1: the very point at which the next segment begins */
    Vec2 low, high; /* its bounds */
} ProfileSegment;

typedef struct Profile {
    int degree; /* of all segments: 1..PROFILE_DEGREE */
    int count;
    int conic;      /* of a prism: conic_sweep */
    Vec2 low, high; /* bounds */
    double size;    /* the largest coordinate of the shape */
    ProfileSegment segments[];
} Profile;

void profile_set_bounds(Profile *profile); /* of segments and all */

Vec2 profile_at(const ProfileSegment *segment, double u);
Vec2 profile_slope(const ProfileSegment *segment, double u);
/* The u of the segment's point that is nearest to p. */
double profile_nearest(const Profile *profile, const ProfileSegment *segment, Vec2 p);
/* Where the segment crosses the line a u + b v + c = 0, ascending: at most PROFILE_DEGREE. A line through the point
 * where two segments meet crosses one of them. */
int profile_crossings(const Profile *profile, const ProfileSegment *segment, double a, double b, double c,
                      double roots[PROFILE_DEGREE]);
/* Whether the curve has an odd number of points to the right of p (at its v, with larger u): it is inside. */
int profile_contains(const Profile *profile, Vec2 p);
/* A vector that stands on the curve at u, to the outside. */
Vec2 profile_normal(const Profile *profile, const ProfileSegment *segment, double u);

#endif
