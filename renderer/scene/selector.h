/* What -t names after `NAME=`: selectors, each a predicate over textures and over the objects that have them. Their
 * forms are rows of a table in selector.c. A pixel, @X:Y, is no row: the job finds what it shows, and names that by its
 * material or its number. */
#ifndef RENDERER_SCENE_SELECTOR_H
#define RENDERER_SCENE_SELECTOR_H

#include "scene/materials.h"

enum { SELECTOR_MAX = 512 }; /* bytes of its text */

/* How much is selected with an object. */
typedef enum SelectorScope {
    SCOPE_OBJECT,   /* itself, or one of its textures */
    SCOPE_MATERIAL, /* all that has the same texture of the scene */
    SCOPE_FLAT,     /* the faces that are flat with one of its faces */
    SCOPE_LEVEL     /* the faces of the scene on the level of one of its faces */
} SelectorScope;

typedef struct SelectorForm SelectorForm;
typedef struct Selector {
    const SelectorForm *form;
    const char *text; /* as the set keeps it: in the scene's spelling; in its arena */
    const char *name; /* an identifier, a file, or a pattern of files */
    int number, part; /* of an object and its texture; or a line */
    SelectorScope scope; /* with an object */
    int face;            /* of the object, from 1, of SCOPE_FLAT and SCOPE_LEVEL */
    const Texture *texture; /* of SCOPE_MATERIAL; its name is that which the texture came through, or NULL */
    Rgb color;
} Selector;

/* The length of the first selector of a list, up to a comma outside parentheses. */
size_t selector_length(const char *list);
/* Read a selector, whether or not it selects anything; but an identifier must be one of textures and objects. */
int selector_parse(Selector *selector, const Scene *scene, const char *text, RetexError *err);
/* The selector of an identifier, which stays the caller's. */
Selector selector_named(const char *ident);
/* RETEX_ENOTFOUND, with the nearest that there are, where it selects nothing. */
int selector_read(Selector *selector, const Scene *scene, const char *text, RetexError *err);
/* 1: it selects faces, which is told by their geometry: it matches nothing. */
static inline int selector_selects_faces(const Selector *selector)
{
    return selector->scope == SCOPE_FLAT || selector->scope == SCOPE_LEVEL;
}
/* The scope that a word names: material, object, flat or level; 0 where it names none. */
int selector_scope(SelectorScope *scope, const char *word);
/* texture: a plain one, or NULL; of layers and maps as a whole nothing is known. object: or NULL. */
int selector_matches(const Selector *selector, const Texture *texture, const ObjectPart *object);

/* 1: it selects objects or colours, which need no name; 0: what is declared, or shows an image. */
int selector_points(const Selector *selector);

/* The text that selects a surface, by each form; 0 where there is none. face: from 1; of scopes of faces. */
int selector_of_object(char text[SELECTOR_MAX], const ObjectPart *object);
int selector_of_scope(char text[SELECTOR_MAX], const ObjectPart *object, SelectorScope scope, int face);
int selector_of_color(char text[SELECTOR_MAX], const Texture *texture);
int selector_of_image(char text[SELECTOR_MAX], const Texture *texture);
int selector_of_place(char text[SELECTOR_MAX], const PlaceList *place);

/* The name before `=` of what selectors are given for: length bytes of the spec. what: "target", "lamp". */
int selector_read_name(char name[RETEX_NAME_MAX], const char *what, const char *spec, size_t length, RetexError *err);

#endif
