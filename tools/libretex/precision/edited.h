/* What the terms of a pixel give where one target alone has a new colour and all others keep their originals: a
 * polynomial in that colour. Private to libretex.
 *
 * It is what the corrections of a set make exact (see retex-set(5)). Whoever changes numbers of a set by little, and
 * adds what this polynomial lost to the corrections, keeps such pictures. */
#ifndef RETEX_SET_EDITED_H
#define RETEX_SET_EDITED_H

#include <retex/set.h>

/* Which targets of a set have corrections. */
typedef struct RetexEdited RetexEdited;

/* Coefficients by the number of factors. Those of more than the target's corrections have are added to the last. */
enum { RETEX_EDITED_POWERS = 4 };
typedef double RetexEditedLight[RETEX_EDITED_POWERS][3];

int retex_edited_open(RetexEdited **edited, const RetexSet *set, RetexError *err);
void retex_edited_close(RetexEdited **edited); /* NULL and pointers to NULL are fine */

/* The most factors of a correction of the target. -1 where it has none, and in sets with reduced parts, gains, or
 * shares by colour. */
int retex_edited_powers(const RetexEdited *edited, int target);
/* The corrections of a target with so many factors: a list of terms. */
int retex_edited_terms(const RetexEdited *edited, int target, int power, const int **terms);

/* The terms that are light of all lamps: how many there are. */
int retex_edited_light_count(const RetexEdited *edited);
/* Those of them that are not black in pixel `at` of rows of the set, in their order; few are. Returns their number. */
int retex_edited_find_lit(const RetexEdited *edited, const RetexSet *rows, size_t at, int *lit);

/* The polynomial in a pixel, without corrections. lit: all terms that are not black there, and maybe others. */
void retex_edited_light(const RetexEdited *edited, const RetexSet *rows, int target, size_t at, const int *lit,
                        int nlit, RetexEditedLight light);
/* 1 if every factor of the term has a place in the pixel, without which it is black. */
int retex_edited_is_seen(const RetexSet *rows, const RetexTerm *term, size_t at);

#endif
