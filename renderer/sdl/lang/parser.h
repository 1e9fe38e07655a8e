/* The interface of the language for the builder, the rooms beside this one: the token stream with its directives,
 * expressions and values. The builder parses objects, textures and other statements by these calls. The language calls
 * the builder through SdlBuilder.
 *
 * A parse error does not return: sdl_error fills the error and jumps back to sdl_read. All memory is from the
 * scene's arena. */
#ifndef RENDERER_SDL_LANG_PARSER_H
#define RENDERER_SDL_LANG_PARSER_H

#include "function/function.h"
#include "scene/scene.h"
#include "sdl/lang/options.h"

typedef struct Sdl Sdl;
typedef struct Word Word;

/* Tokens after directives and macros were processed. The text of a keyword is an interned lower-case string: compare
 * it by pointer or with sdl_accept. */
typedef enum TokenKind {
    TOKEN_END,
    TOKEN_NUMBER,
    TOKEN_STRING,
    TOKEN_WORD /* keyword of the language, or undeclared word */,
    TOKEN_IDENT /* declared identifier: the token has its value */,
    TOKEN_PUNCT
} TokenKind;

typedef enum ValueKind {
    VALUE_NONE,
    VALUE_FLOAT,
    VALUE_VECTOR /* 2 to 5 numbers; also colours */,
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
    VALUE_OTHER /* a declared item of an unsupported type: it is ignored with a warning where it is used */
} ValueKind;

typedef struct Value {
    ValueKind kind;
    int count;        /* number of a vector's components */
    int is_color;     /* 1: a vector written as a colour: rgb, rgbft, … */
    double number[5]; /* float: [0]; vector: [0..count); colour: r g b filter transmit */
    const char *string;
    void *data;       /* data of arrays, functions and the builder's types */
    const char *word; /* keyword of a VALUE_OTHER */
} Value;

typedef struct Token {
    TokenKind kind;
    char punct; /* TOKEN_PUNCT: the character; 'l' 'g' 'n' for <= >= != */
    double number;
    const char *text; /* interned word, identifier as written, or content of the string */
    const Word *word; /* TOKEN_WORD: the word itself */
    Value *value;     /* TOKEN_IDENT: the stored value (assignable through by-reference parameters) */
    const char *file;
    int line, column;
} Token;

Arena *sdl_arena(Sdl *sdl);
Scene *sdl_scene(Sdl *sdl);
const SdlOptions *sdl_options(Sdl *sdl);
const RetexAccess *sdl_access(Sdl *sdl); /* rules for files that may be read */
double sdl_version(Sdl *sdl);            /* language version: 3.62 unless #version sets it */
void sdl_step(Sdl *sdl, long count);     /* counts steps against the limit; an error if it is exceeded */
void *sdl_alloc(Sdl *sdl, size_t bytes); /* zeroed memory; an error at the limit, never NULL */
/* The array, or a copy twice as large where it is full: there is place for one more of size bytes. */
void *sdl_grow(Sdl *sdl, void *array, int count, int *capacity, size_t size);

/* Report an error at the current token: of the scene's text, or another code. */
#define sdl_error(sdl, ...) sdl_fail(sdl, RETEX_EPARSE, __VA_ARGS__)
_Noreturn void sdl_fail(Sdl *sdl, int code, const char *fmt, ...) RETEX_PRINTF(3, 4);
_Noreturn void sdl_expected(Sdl *sdl, const char *what);                     /* "expected WHAT, found `…`" */
/* Warn once per name: "FILE:LINE: warning: `NAME` is not supported yet: INSTEAD". With --strict it is an error. */
void sdl_unsupported(Sdl *sdl, const char *name, const char *instead);
/* The same of what gives objects and the view their shape and place: without --lenient it is an error, because the
 * picture would be wrong. */
void sdl_unsupported_geometry(Sdl *sdl, const char *name, const char *instead);
void sdl_warn(Sdl *sdl, const char *fmt, ...) RETEX_PRINTF(2, 3);
void sdl_warn_at(Sdl *sdl, const char *file, int line, const char *fmt, ...) RETEX_PRINTF(4, 5);

/* Where the next token stands; one of a macro, where the macro is called. */
void sdl_place(Sdl *sdl, const char **file, int *line);
const Token *sdl_peek(Sdl *sdl);                     /* the next token, after directives and macros */
const Token *sdl_next(Sdl *sdl);                     /* consumes the next token; valid until the next call */
int sdl_accept(Sdl *sdl, const char *word_or_punct); /* consumes the next token if it matches; 1 if so */
int sdl_accept_float(Sdl *sdl, const char *word, double *value); /* the word and its float; 1 if so */
void sdl_expect(Sdl *sdl, const char *word_or_punct);
int sdl_is(Sdl *sdl, const char *word_or_punct); /* 1 if the next token matches; consumes nothing */
void sdl_optional_comma(Sdl *sdl);
void sdl_skip_block(Sdl *sdl); /* skips from `{` to the matching `}` */
/* Consume the word if it is the next raw token. Unlike sdl_accept this runs no directive or macro before it. */
int sdl_accept_written(Sdl *sdl, const char *word);

/* Expressions. As in POV-Ray, a float fills all components of a vector, and a short vector is padded with zeros. A
 * vector with too many components is an error. */
double sdl_float(Sdl *sdl);
int sdl_optional_bool(Sdl *sdl, int missing); /* a float, or on/off/yes/no/true/false; missing: where there is none */
Vec3 sdl_vector(Sdl *sdl);
Vec2 sdl_vector2(Sdl *sdl);
Rgbft sdl_color(Sdl *sdl); /* `color rgb <…>`, names, arithmetic on colours; a float fills all five components */
int sdl_is_color_start(Sdl *sdl);
const char *sdl_string(Sdl *sdl);
int sdl_is_expression_start(Sdl *sdl); /* 1 if a number, vector, numeric identifier or function is next */
Value sdl_expression(Sdl *sdl);        /* a float, vector or string */
Value sdl_function(Sdl *sdl);          /* parses from the word `function` on, with parameters and body */
Value sdl_function_body(Sdl *sdl);     /* … without that word, parameters and braces: an expression of x, y and z */
/* The function as a program of so many arguments, an error where it takes another number; 3 may stand for 2. */
const FunctionProgram *sdl_function_program(Sdl *sdl, const Value *function, int nargs);

/* The identifier list with one more name. */
const IdentList *sdl_ident_add(Sdl *sdl, const IdentList *list, const char *name, int line);
const IdentList *sdl_ident_join(Sdl *sdl, const IdentList *a, const IdentList *b);

/* Find a file as #include and image_map do: in the current folder, the scene's folder, the include paths and the
 * system's folders. Returns a path in the arena, or NULL. Only files under those folders are found. */
const char *sdl_find_file(Sdl *sdl, const char *name);
/* Like sdl_find_file, but an error if there is no readable file: it lists the folders or gives the reason. what:
 * "file", "image". */
const char *sdl_need_file(Sdl *sdl, const char *what, const char *name);
void sdl_add_file(Sdl *sdl, const char *path); /* adds a file, before it is read, to the scene's files */

/* The file's content, in the arena, with a NUL behind it. The file is added to the scene's. */
const char *sdl_read_file(Sdl *sdl, const char *path, size_t *size);

/* ---- interface of the builder ---- */

/* Callbacks from the language to the builder. */
typedef struct SdlBuilder {
    void (*begin)(Sdl *sdl); /* creates the builder's state: see sdl_set_builder_state */
    /* Parse the right side of `#declare NAME =` if the next token starts no expression (texture, object, …). Fills
     * value and returns 1, or returns 0 if the keyword is unknown. */
    int (*declare)(Sdl *sdl, Value *value);
    void (*name)(Sdl *sdl, Value *value, const char *name, int line); /* appends name to the value's IdentList */
    void (*statement)(Sdl *sdl);   /* parses a statement at top level: object, light, camera, global_settings, … */
    void (*set_default)(Sdl *sdl); /* parses `#default{…}` after its keyword, braces included */
    void (*finish)(Sdl *sdl);      /* called at the end of the scene file */
    /* Functions of objects. They return 0 (inside: -1) if the value is no object. trace gives the nearest
     * intersection of the ray with the object and the unit normal there; both are zero if there is none. */
    int (*extent)(Sdl *sdl, const Value *object, Vec3 *low, Vec3 *high);
    int (*trace)(Sdl *sdl, const Value *object, Vec3 from, Vec3 direction, Vec3 *point, Vec3 *normal);
    int (*inside)(Sdl *sdl, const Value *object, Vec3 p);
    /* Parse the block after `pattern` or `pigment` as a function of a point: fills call and data. Returns 0 if
     * something of it is not supported. */
    int (*field)(Sdl *sdl, const char *word, FunctionForeign *function);
} SdlBuilder;

/* The builder's own state, which the language stores. */
void *sdl_builder_state(Sdl *sdl);
void sdl_set_builder_state(Sdl *sdl, void *state);

/* Read a scene file; the builder creates the scene. On failure *scene is NULL, and err has file, line, column and
 * the expected token. */
int sdl_read(Scene **scene, const char *path, const SdlOptions *options /* NULL = defaults */,
             const SdlBuilder *builder, RetexError *err);

#endif
