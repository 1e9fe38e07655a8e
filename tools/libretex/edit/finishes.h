/* The statements of an edit about finishes. Private to this room. */
#ifndef RETEX_EDIT_FINISHES_H
#define RETEX_EDIT_FINISHES_H

#include <retex/edit.h>
#include <retex/set.h>

#include "edit/keyed.h"

extern const RetexKeyedKind retex_keyed_finish; /* finish:TARGET=NAME */

/* The number of the finish that a target has in an edit that is bound, from 1; as rendered where it is not named. */
int retex_edit_finish_of(const RetexEdit *edit, const RetexTarget *target);

#endif
