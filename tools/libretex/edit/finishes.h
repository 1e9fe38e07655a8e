/* The statements of an edit about finishes. Private to this room. */
#ifndef RETEX_EDIT_FINISHES_H
#define RETEX_EDIT_FINISHES_H

#include <retex/edit.h>
#include <retex/set.h>

/* The target of a key finish:TARGET; NULL where it is another one. */
const char *retex_edit_key_finish(const char *key);
/* Add one statement; the edit may be changed where that fails. */
int retex_edit_add_finish(RetexEdit *edit, const char *target, const char *finish, RetexError *err);
/* Add those of another edit whose targets this one does not name. */
int retex_edit_complete_finishes(RetexEdit *edit, const RetexEdit *from, RetexError *err);
/* Give targets and finishes the names that a set has them by. */
int retex_edit_bind_finishes(RetexEdit *edit, const RetexSet *set, RetexError *err);
/* The number of the finish that a target has in an edit that is bound; as rendered where it is not named. */
int retex_edit_finish_of(const RetexEdit *edit, const RetexTarget *target);

#endif
