/* Views of a model: where one can look from, inside and outside, and which of it shows most. */
#ifndef RETEX_IMPORT_VIEWS_H
#define RETEX_IMPORT_VIEWS_H

#include "import/space/picture.h"

typedef enum ViewsFrom { VIEWS_INSIDE = 1, VIEWS_OUTSIDE = 2, VIEWS_EITHER = 3, VIEWS_GIVEN = 4 } ViewsFrom;

typedef struct ViewChoice {
    View view;
    ViewsFrom from;
    Content content;
    double score;
} ViewChoice;

enum { VIEWS_MOST = 4 };

typedef struct Views {
    ViewChoice list[VIEWS_MOST]; /* no two alike; the best first, or the one that is given */
    int count;
    int candidates, better; /* how many there were; and how many of them are better than the first one of the list */
} Views;

/* A view with an upright camera. */
View view_level(const double eye[3], const double ahead[3], double angle);
/* Where a camera sees all of a box, from a side: a vector from its middle, of any length. angle: degrees, from left to
 * right. */
void view_fit(const double low[3], const double high[3], const double side[3], double angle, double eye[3],
              double target[3]);
/* Find the best views, from inside, outside or either; at most VIEWS_MOST. given: a view that is to be the first, or
 * NULL. materials: by tag, or NULL. Two calls give the same. */
int views_find(const Room *room, const uint32_t *materials, ViewsFrom from, const View *given, Views *views,
               RetexError *err);

#endif
