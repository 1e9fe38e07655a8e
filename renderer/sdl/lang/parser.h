/* The language as the builder (sdl/build) sees it: the token stream with its directives, expressions and values. The
 * builder reads objects, textures and the rest through these calls; the language calls the builder through SdlBuilder.
 *
 * A parse error does not return: sdl_error fills the error and jumps back to sdl_read. All memory is the arena's. */
#ifndef RENDERER_SDL_LANG_PARSER_H
#define RENDERER_SDL_LANG_PARSER_H

#include "scene/scene.h"
#include "sdl/lang/options.h"

typedef struct Sdl Sdl;

/* Tokens after directives and macros have done their work. Keywords and identifiers are told apart by text: a keyword
 * is an interned lower-case string, compared by pointer or with sdl_accept. */
typedef enum TokenKind {
    TOKEN_END,
    TOKEN_NUMBER,
    TOKEN_STRING,
    TOKEN_WORD /* keyword of the language or undeclared word */,
    TOKEN_IDENT /* declared: its value is in the token */,
    TOKEN_PUNCT
} TokenKind;

typedef enum ValueKind {
    VALUE_NONE,
    VALUE_FLOAT,
    VALUE_VECTOR /* 2 to 5 numbers, colours too */,
    VALUE_STRING,
    VALUE_ARRAY,
    VALUE_FUNCTION,
    VALUE_SPLINE,
    VALUE_TRANSFORM,
    VALUE_PIGMENT,
    VALUE_NORMAL,
    VALUE_FINISH,
    VALUE_TEXTURE,
    VALUE_INTERIOR,
    VALUE_MATERIAL,
    VALUE_OBJECT,
    VALUE_CAMERA,
    VALUE_LIGHT,
    VALUE_COLOR_MAP,
    VALUE_SKY_SPHERE,
    VALUE_OTHER /* declared things that are not supported: known, and ignored with a report where they are used */
} ValueKind;

typedef struct Value {
    ValueKind kind;
    int count;        /* of a vector */
    int is_color;     /* a vector written as a colour: rgb, rgbft, … */
    double number[5]; /* float: [0]; vector: [0..count); colour: r g b filter transmit */
    const char *string;
    void *data;       /* array, function, and what the builder declares */
    const char *word; /* VALUE_OTHER: its keyword */
} Value;

typedef struct Token {
    TokenKind kind;
    char punct; /* TOKEN_PUNCT: the character; 'l' 'g' 'n' for <= >= != */
    double number;
    const char *text; /* interned word or identifier as written; the string's content */
    Value *value;     /* TOKEN_IDENT: where it lives (may be assigned through by-reference parameters) */
    const char *file;
    int line, column;
} Token;

Arena *sdl_arena(Sdl *sdl);
Scene *sdl_scene(Sdl *sdl);
const SdlOptions *sdl_options(Sdl *sdl);
const RetexAccess *sdl_access(Sdl *sdl); /* what files may be read */
double sdl_version(Sdl *sdl);            /* 3.62 until #version says otherwise */
void sdl_step(Sdl *sdl, long count);     /* counts against the budget; an error beyond it */
void *sdl_alloc(Sdl *sdl, size_t bytes); /* zeroed; an error at the limit, never NULL */

_Noreturn void sdl_error(Sdl *sdl, const char *fmt, ...) RETEX_PRINTF(2, 3); /* at the current token */
_Noreturn void sdl_expected(Sdl *sdl, const char *what);                     /* "expected WHAT, found `…`" */
/* Report once per name: "FILE:LINE: warning: `NAME` is not supported yet: WHAT HAPPENS INSTEAD". With --strict an
 * error. */
void sdl_unsupported(Sdl *sdl, const char *name, const char *instead);
void sdl_warn(Sdl *sdl, const char *fmt, ...) RETEX_PRINTF(2, 3);
void sdl_warn_at(Sdl *sdl, const char *file, int line, const char *fmt, ...) RETEX_PRINTF(4, 5);

const Token *sdl_peek(Sdl *sdl);                     /* the next token, directives done, macros expanded */
const Token *sdl_next(Sdl *sdl);                     /* take it; valid until the next call */
int sdl_accept(Sdl *sdl, const char *word_or_punct); /* take it if it is this one; 1 if so */
void sdl_expect(Sdl *sdl, const char *word_or_punct);
int sdl_is(Sdl *sdl, const char *word_or_punct); /* look only */
void sdl_optional_comma(Sdl *sdl);
void sdl_skip_block(Sdl *sdl); /* from `{` to its `}`, over anything */
/* Take the word if it is written next. Unlike sdl_accept it runs no directive and no macro that stands before it. */
int sdl_accept_written(Sdl *sdl, const char *word);

/* Expressions. As in POV-Ray a float fills a vector and a short vector is filled up with zeros; one too long is an
 * error. */
double sdl_float(Sdl *sdl);
int sdl_bool(Sdl *sdl);                       /* a float, on/off/yes/no/true/false */
int sdl_optional_bool(Sdl *sdl, int missing); /* a switch whose value may be left out */
Vec3 sdl_vector(Sdl *sdl);
Vec2 sdl_vector2(Sdl *sdl);
Rgbft sdl_color(Sdl *sdl); /* `color rgb <…>`, names, arithmetic on them; a float fills all five */
int sdl_is_color_start(Sdl *sdl);
const char *sdl_string(Sdl *sdl);
int sdl_is_expression_start(Sdl *sdl); /* a number, vector, numeric identifier or function is next */
Value sdl_expression(Sdl *sdl);        /* float, vector or string, whatever comes */
Value sdl_function(Sdl *sdl);          /* from the word `function` on, with parameters and body */

/* Idents: a list with one more name. */
const IdentList *sdl_ident_add(Sdl *sdl, const IdentList *list, const char *name, int line);
const IdentList *sdl_ident_join(Sdl *sdl, const IdentList *a, const IdentList *b);

/* Find a file as #include and image_map do: the current folder, the scene's folder, the include paths, the system's.
 * Returns a path in the arena or NULL. Reads stay under those folders. */
const char *sdl_find_file(Sdl *sdl, const char *name);
/* The same; fails with where it was looked for, or why it may not be read. what: "file", "image". */
const char *sdl_need_file(Sdl *sdl, const char *what, const char *name);
void sdl_add_file(Sdl *sdl, const char *path); /* to what the scene was read from, before it is read */

/* ---- the builder ---- */

/* What the language asks of the builder. */
typedef struct SdlBuilder {
    void (*begin)(Sdl *sdl); /* makes the builder's state: see sdl_set_builder_state */
    /* After `#declare NAME =`, where the next token starts no expression (texture, object, …): fills value and
     * returns 1, or returns 0 where it does not know the keyword. */
    int (*declare)(Sdl *sdl, Value *value);
    void (*name)(Sdl *sdl, Value *value, const char *name, int line); /* adds name to the value's IdentList */
    void (*statement)(Sdl *sdl);   /* at top level, no directive: object, light, camera, global_settings, … */
    void (*set_default)(Sdl *sdl); /* `#default{…}`: after its keyword, braces included */
    void (*finish)(Sdl *sdl);      /* at the end of the file */
    /* Functions that look at objects. They return 0 (inside: -1) where the value is no object. trace gives the nearest
     * point of the object on the ray and its unit normal there; both are zero where there is none. */
    int (*extent)(Sdl *sdl, const Value *object, Vec3 *low, Vec3 *high);
    int (*trace)(Sdl *sdl, const Value *object, Vec3 from, Vec3 direction, Vec3 *point, Vec3 *normal);
    int (*inside)(Sdl *sdl, const Value *object, Vec3 p);
} SdlBuilder;

/* The builder's own state, which the language keeps for it. */
void *sdl_builder_state(Sdl *sdl);
void sdl_set_builder_state(Sdl *sdl, void *state);

/* Read a scene file and have the builder build the scene. On failure *scene is NULL and err has file, line, column and
 * what was expected. */
int sdl_read(Scene **scene, const char *path, const SdlOptions *options /* NULL = defaults */,
             const SdlBuilder *builder, RetexError *err);

#endif
