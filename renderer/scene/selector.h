/* What -t names after `NAME=`: selectors, each a predicate over textures and over the objects that have them. Their
 * forms are rows of a table in selector.c. A pixel, @X:Y, is no row: the job finds what it shows, and names that by its
 * number. */
#ifndef RENDERER_SCENE_SELECTOR_H
#define RENDERER_SCENE_SELECTOR_H

#include "scene/scene.h"

enum { SELECTOR_MAX = 512 }; /* bytes of its text */

/* An object, or one of its textures, where the shape has several. */
typedef struct ObjectPart {
    const IdentList *idents;
    const PlaceList *places;
    int number; /* of the primitive, from 1, as in AOV `object`; 0: an instance */
    int part;   /* of the shape's textures, from 1; 0: what has the object's own texture */
} ObjectPart;

typedef struct SelectorForm SelectorForm;
typedef struct Selector {
    const SelectorForm *form;
    const char *text; /* as the set keeps it: in the scene's spelling; in its arena */
    const char *name; /* an identifier, a file, or a pattern of files */
    int number, part; /* of an object and its texture; or a line */
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
/* texture: a plain one, or NULL; of layers and maps as a whole nothing is known. object: or NULL. */
int selector_matches(const Selector *selector, const Texture *texture, const ObjectPart *object);

/* 1: it selects objects or colours, which need no name; 0: what is declared, or shows an image. */
int selector_points(const Selector *selector);

ObjectPart object_part(const Scene *scene, const Primitive *primitive, int part);

/* The text that selects a surface, by each form; 0 where there is none. */
int selector_of_object(char text[SELECTOR_MAX], const ObjectPart *object);
int selector_of_color(char text[SELECTOR_MAX], const Texture *texture);
int selector_of_image(char text[SELECTOR_MAX], const Texture *texture);
int selector_of_place(char text[SELECTOR_MAX], const PlaceList *place);

#endif
