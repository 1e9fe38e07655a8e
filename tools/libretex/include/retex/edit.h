/* Edits: what a user wants to have changed in a set. Options, tables of batches, names that OpenImageIO opens, URLs,
 * Python and links to the player all say it in the words of one grammar; retex-edit(5) has it for users.
 *
 * An edit is a list of statements KEY=VALUE in any order, each at most once:
 *
 *     TARGET=IMAGE           a texture, the name of a file
 *     TARGET=COLOUR          a colour, see retex/color_text.h
 *     TARGET.OPTION=VALUE    how the texture lies; OPTION is scale, rotate, hue or another word of retex-edit(5),
 *                            which fills a member of RetexTextureSpec
 *     over:TARGET=IMAGE      a layer on it, with options of its own; over2: to over4: lie on that
 *     light:LAMP=VALUE       a lamp's new value, see retex/lamp.h; LAMP `*` is all lamps that the edit does not name
 *     finish:TARGET=NAME     one of the finishes that the set has for a target
 *     picture:exposure=EV    how the picture is developed, see retex/develop.h: `exposure`, `white-balance`,
 *                            `auto-exposure`, which is yes or no; and its `view`, see retex/image_file.h
 *
 * as in `Floor=oak.jpg;Floor.scale=2,1;Wall=tomato`. What follows the last point of a key is an option if it is the
 * word of one; else the point belongs to the name of the target. Calls that add to an edit leave it as it was where
 * they fail, with RETEX_EPARSE and a message that says what would be right, or RETEX_EINVAL for a second texture on one
 * target. An edit holds at most RETEX_MAX_TARGETS textures, sorted by target, then the values of lamps, sorted by lamp,
 * finishes, sorted by target, and statements about the picture, sorted by key. */
#ifndef RETEX_EDIT_H
#define RETEX_EDIT_H

#include <retex/develop.h>
#include <retex/lamp.h>
#include <retex/target_name.h>
#include <retex/texture.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

typedef struct RetexEdit RetexEdit;

/* An edit that changes nothing. */
int retex_edit_create(RetexEdit **edit, RetexError *err);
void retex_edit_close(RetexEdit **edit);
/* Remove all that it says. Needs no memory, nor does what is added then. */
void retex_edit_clear(RetexEdit *edit);

/* ---- the forms in which statements come ---- */

/* Add the statements of a text, divided by `;` or `&`. In keys and values %25 stands for %, %26 for &, %3B for ; and
 * %2E for a point that begins no option. All textures must be complete then, as retex_edit_check says. */
int retex_edit_parse(RetexEdit *edit, const char *text, RetexError *err);
/* Add a statement that something else has divided and decoded already. */
int retex_edit_set(RetexEdit *edit, const char *key, const char *value, RetexError *err);
/* Whether each target with options has a texture, and the options suit each other. */
int retex_edit_check(const RetexEdit *edit, RetexError *err);
/* Add the texture of an option of a command line, --texture[:opts] NAME=IMAGE. opts: `scale=2,2:rotate=30`, of which
 * the last of a name holds; or NULL. The word `over` among them makes it the target's next layer. */
int retex_edit_option(RetexEdit *edit, const char *opts, const char *arg, RetexError *err);
/* Add a texture with its layers, for its target. */
int retex_edit_add(RetexEdit *edit, const RetexTextureSpec *spec, RetexError *err);
/* Add the texture of a cell of a table, for the target that its column has: IMAGE or `:opts IMAGE`, and layers behind
 * ` + `; `+ IMAGE` lies on the original. */
int retex_edit_cell(RetexEdit *edit, const char *target, const char *cell, RetexError *err);
/* Add the value of an option of a command line, --light NAME=VALUE. */
int retex_edit_light(RetexEdit *edit, const char *arg, RetexError *err);
/* Turn off all lamps that the edit does not name, but this one, which stays as it is: `light:*=0;light:LAMP=1`. A lamp
 * that was rendered while it was off is turned on. */
int retex_edit_solo(RetexEdit *edit, const char *lamp, RetexError *err);
/* Add the finish of an option of a command line, --finish TARGET=NAME. */
int retex_edit_finish(RetexEdit *edit, const char *arg, RetexError *err);
/* Add the lamps, the finishes of targets, and what is said of the picture, of another edit that this one does not
 * name. */
int retex_edit_complete_lights(RetexEdit *edit, const RetexEdit *from, RetexError *err);
/* What a key with a prefix names: the lamp of light:LAMP, the target of finish:TARGET, the key of picture:KEY. NULL: it
 * is another key. */
const char *retex_edit_key_name(const char *key);
/* Whether a key is TARGET.OPTION. */
int retex_edit_key_is_option(const char *key);

/* The canonical text: equal edits have equal texts, parsing it gives the edit, and options of their default values are
 * left out. Numbers have the fewest digits that mean the same, colours are rgb(). divider: ';' or '&'. *text is the
 * caller's to free. */
int retex_edit_text(const RetexEdit *edit, int divider, char **text, RetexError *err);
/* The options of a texture as retex_edit_option takes them, "" where it has none. *text is the caller's to free. */
int retex_edit_options_text(const RetexTextureSpec *spec, char **text, RetexError *err);
/* Its image's name or its colour, for messages too: cut off where it is longer than `size` bytes. */
void retex_edit_image_text(const RetexTextureSpec *spec, char *text, size_t size);

/* A length: a number with mm, cm, m, in or ft; the number alone is metres, the unit alone one of it. RETEX_EPARSE. */
int retex_length_parse(double *metres, const char *text, RetexError *err);

/* ---- what it says ---- */

int retex_edit_count(const RetexEdit *edit);
/* One of its textures, sorted by target; borrowed until the edit changes. They stand one after the other: that
 * of index 0 and retex_edit_count are what retex_sample and retex_textures_load take. What RetexTextureSpec says is
 * filled in by the caller is for the caller to set, and the image's name may be replaced. In a copy of one, size is to
 * become sizeof(RetexTextureSpec): the library may know more members than its caller. */
RetexTextureSpec *retex_edit_texture(RetexEdit *edit, int index);

/* How many lamps it names, `*` among them, and finishes. */
int retex_edit_lights(const RetexEdit *edit);
/* How the picture is developed: what the edit says takes the place of what *develop, begun with RETEX_DEVELOP_INIT,
 * says. */
int retex_edit_develop(const RetexEdit *edit, RetexDevelop *develop, RetexError *err);
/* The view of the picture, for RetexWriteParams; borrowed until the edit changes. NULL: it names none. */
const char *retex_edit_view(const RetexEdit *edit);

/* ---- the targets and lamps that there are ---- */

/* The index of the target that a name means, as retex_target_index, or -1. RETEX_ENOTFOUND lists what there is, with
 * the nearest name; RETEX_EPARSE where it is a target's name with an option that there is not. */
int retex_target_find(int *target, const RetexTargetNames *names, const char *name, RetexError *err);
/* Give the targets of an edit the names that the set, or scene, has them by. RETEX_EINVAL where two are one there.
 * After a failure the edit is as it was. */
int retex_edit_bind(RetexEdit *edit, const RetexTargetNames *names, RetexError *err);
/* The same of its lamps, as retex_lamp_find finds them, and of its finishes. */
int retex_edit_bind_lamps(RetexEdit *edit, const RetexSet *set, RetexError *err);
/* The values of a set's parameters, three numbers each, for RetexCombineParams: as rendered, but where the edit has
 * another one for a lamp or a finish. These need not be bound. */
int retex_edit_parameters(const RetexEdit *edit, const RetexSet *set, float *values, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
