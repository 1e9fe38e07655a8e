/* Declarations that the files of the language core share: words, raw tokens, sources, symbols and the parser's
 * state. The builder includes parser.h only.
 *
 * A file is converted to an array of raw tokens once. Directives store the index of their #end, so skips and loops
 * are jumps in that array. The stream (stream.c) reads the array, runs directives (directive.c) and enters macros
 * (macro.c). */
#ifndef RENDERER_SDL_LANG_INTERNAL_H
#define RENDERER_SDL_LANG_INTERNAL_H

#include <setjmp.h>
#include <stdint.h>
#include <stddef.h>
#include <retex/access.h>
#include "sdl/lang/parser.h"

enum {
    MAX_MACRO_DEPTH = 200,
    MAX_INCLUDE_DEPTH = 32,
    MAX_FRAMES = MAX_MACRO_DEPTH + MAX_INCLUDE_DEPTH + 2,
    MAX_EXPRESSION_DEPTH = 1000,
    MAX_DIRECTIVE_DEPTH = 400,
    MAX_BLOCK_DEPTH = 400,
    MAX_DIMENSIONS = 5,
    MAX_PARAMETERS = 56,
    MAX_LOOPS = 1000,
    MAX_STRING = 1 << 20
};

typedef struct Symbol Symbol;
typedef struct Builtin Builtin;
typedef struct Source Source;

#define SEMICOLON_VERSION 3.5 /* from here on a declared number ends with a semicolon */

/* An interned word of the scene: one per spelling. */
struct Word {
    const char *text;
    size_t length;
    uint32_t hash;
    uint8_t directive;      /* a Directive if `#word` is a directive */
    uint8_t reserved;       /* 1: a keyword, which cannot be declared */
    const Builtin *builtin; /* constant, function or component of the expression language, or NULL */
    Symbol *symbol;         /* the innermost visible symbol of this name, or NULL */
    struct Word *next;      /* next word of the hash bucket */
    int declaring;          /* line of the declaration that is being parsed, else 0 */
};

typedef enum RawKind { RAW_END, RAW_NUMBER, RAW_STRING, RAW_WORD, RAW_PUNCT, RAW_DIRECTIVE, RAW_BAD } RawKind;

typedef enum Directive {
    DIR_NONE,
    DIR_IF,
    DIR_IFDEF,
    DIR_IFNDEF,
    DIR_WHILE,
    DIR_FOR,
    DIR_SWITCH,
    DIR_MACRO, /* last of the directives that have an #end */
    DIR_ELSE,
    DIR_ELSEIF,
    DIR_CASE,
    DIR_RANGE,
    DIR_BREAK,
    DIR_END,
    DIR_DECLARE,
    DIR_LOCAL,
    DIR_UNDEF,
    DIR_INCLUDE,
    DIR_DEFAULT,
    DIR_VERSION,
    DIR_DEBUG,
    DIR_WARNING,
    DIR_ERROR,
    DIR_RENDER,
    DIR_STATISTICS,
    DIR_FOPEN,
    DIR_FCLOSE,
    DIR_READ,
    DIR_WRITE
} Directive;

/* A token as written in the file. Meaning of a directive's link: an opener, #elseif, #else, #case and #range link to
 * the next branch or the #end; #end links to its opener; #break links to the opener that it leaves. LINK_NONE means
 * that the target is missing. */
#define LINK_NONE UINT32_MAX
typedef struct Raw {
    uint32_t line;
    uint16_t column;
    uint8_t kind;
    char punct; /* RAW_PUNCT: the character, or PUNCT_…; RAW_BAD: the reason, see lexer.c */
    union {
        double number;
        const char *string;
        Word *word;
        struct {
            uint32_t link;
            uint8_t id, opener;
        } directive;
    } as;
} Raw;
enum { PUNCT_LE = 'l', PUNCT_GE = 'g', PUNCT_NE = 'n' };

/* The tokens of a file. They are freed when the #include ends, except if a macro is defined in the file, or if the
 * file is small and on disk: it may be included again. */
struct Source {
    const char *name; /* name of the file in messages */
    Raw *tokens;
    uint32_t count;
    int on_disk, keep, users;
    uint64_t charged; /* bytes charged to the budget */
    Source *previous, *next;
};

/* A file that the scene has written. */
typedef struct MemoryFile {
    const char *name;
    char *bytes; /* in the arena; the capacity doubles */
    size_t size, capacity;
    struct MemoryFile *next;
} MemoryFile;

/* A file that #fopen has opened. */
typedef struct FileHandle {
    MemoryFile *output; /* for write and append */
    Source *input;      /* for read: the tokens of the file */
    uint32_t pos;
} FileHandle;

typedef struct Macro {
    Word *name;
    Source *source;
    uint32_t start, body; /* index of the #macro, and of the first token after its parameters */
    int count;
    Word **parameters;
} Macro;

/* A declared name. The value of a by-reference parameter points at the caller's value. */
struct Symbol {
    Word *word;
    Value *value;
    Value own;
    Macro *macro;
    FileHandle *handle;
    Symbol *shadowed; /* the symbol of this name in an outer scope */
    Symbol *next;     /* next symbol of the scope, or of the list of unused symbols */
    int scope;
};

typedef struct Array {
    int dimensions;
    int size[MAX_DIMENSIONS];
    size_t count;
    Value *items;
} Array;

/* An input of the stream: a file, or a macro's body. Each frame has a scope of #local names. */
typedef struct Frame {
    Source *source;
    const Raw *cursor;    /* where reading continues when this frame is on top again */
    uint32_t macro_start; /* LINK_NONE if the frame is a file */
    int nloops;           /* number of active #for loops when the frame was entered */
    Symbol *locals;
} Frame;

typedef struct Loop {
    uint32_t start; /* index of the #for */
    int frame;
    Word *variable;
    double end, step;
} Loop;

/* A number, vector or colour during evaluation. */
typedef struct Num {
    double n[5];
    int count; /* number of components; 1 = float */
    int color;
} Num;

typedef struct Function Function;

/* Animation variables that an expression may have read. Both are 0 unless -D declares them. */
typedef enum FrameRead { READ_FRAME_NUMBER = 1, READ_CLOCK = 2 } FrameRead;

struct Sdl {
    Arena *arena;
    Scene *scene;
    SdlOptions options;
    RetexError *err;
    int code;
    jmp_buf jump;
    double version;
    const SdlBuilder *builder;
    void *builder_state;

    Word **buckets;
    uint32_t nbuckets, nwords;
    Source *sources;
    MemoryFile *memory_files;

    Token token; /* the lookahead if `have` is set, else the token consumed last */
    int have;
    const Raw *cursor; /* position in the top frame */
    Frame frames[MAX_FRAMES];
    int declarations;    /* whose values are being read */
    int nframes, nmacros; /* number of frames, and of those that are macros */
    Loop loops[MAX_LOOPS];
    int nloops;
    int expression_depth, directive_depth, block_depth;
    struct {
        const char *file;
        int line;
    } blocks[MAX_BLOCK_DEPTH]; /* position of each open `{` */
    unsigned frame_reads;      /* FrameRead bits of the animation variables read so far */
    long steps, next_look;     /* steps counted so far, and the count of the next check of limits */

    Symbol *unused, **unused_tail;
    int nunused;
    uint32_t *seeds;
    int nseeds, seeds_capacity, warned_division;
    const char **reported; /* names that sdl_unsupported has reported */
    int nreported, reported_capacity;
    char *pending; /* #debug text without a final newline yet */
    size_t npending, pending_capacity;
    size_t said;          /* bytes of messages, counted for safe access only */
    const char **folders; /* search path of sdl_find_file */
    int nfolders;
    RetexAccess access; /* the resolved search path: only files under it may be read */
    double clock, clock_delta, clock_on, frame_number, initial_frame, final_frame, initial_clock, final_clock;
};

/* language.c */
/* The bytes, used so many of them, or a copy of them where there is place for all that are wanted. */
char *sdl_reserve(Sdl *sdl, char *bytes, size_t used, size_t wanted, size_t *capacity);
_Noreturn void sdl_fail_memory(Sdl *sdl); /* error: the scene's memory limit is reached */
void sdl_debug_text(Sdl *sdl, const char *text);

/* words.c */
Word *word_intern(Sdl *sdl, const char *text, size_t length);
void words_begin(Sdl *sdl);
const char *word_nearest(Sdl *sdl, const char *name); /* most similar declared name or keyword, or NULL */
const char *directive_nearest(const char *name);      /* most similar directive, or NULL */

/* lexer.c */
Source *source_from_text(Sdl *sdl, const char *name, const char *text, size_t length);
_Noreturn void raw_fail(Sdl *sdl, const Raw *raw); /* reports the error of a RAW_BAD token */

/* source.c */
Source *source_open(Sdl *sdl, const char *name);
Source *source_open_scene(Sdl *sdl, const char *path); /* the scene file itself, in any folder */
void source_release(Sdl *sdl, Source *source);
void sources_close(Sdl *sdl);
void folders_begin(Sdl *sdl, const char *scene_path);
MemoryFile *memory_file_find(Sdl *sdl, const char *name);
MemoryFile *memory_file_create(Sdl *sdl, const char *name);
void memory_file_write(Sdl *sdl, MemoryFile *file, const void *bytes, size_t size);

/* stream.c */
const Token *sdl_peek_operator(Sdl *sdl, int frame); /* NULL if a declaration ends the expression that began in frame */
void stream_finish_macros(Sdl *sdl, int frame);      /* reads on until the macros called from frame end */
const Raw *sdl_raw(Sdl *sdl);                        /* consumes the next raw token; runs no directive or macro */
const Raw *sdl_raw_peek(Sdl *sdl);
int sdl_raw_accept(Sdl *sdl, char punct);
void sdl_raw_expect(Sdl *sdl, char punct);
void stream_push_file(Sdl *sdl, Source *source);
void stream_push_macro(Sdl *sdl, const Macro *macro);
void stream_pop(Sdl *sdl);
void stream_jump(Sdl *sdl, uint32_t index);   /* jumps to a token of the top frame */
uint32_t stream_index(Sdl *sdl);              /* index of the cursor in the top frame */
void stream_locate(Sdl *sdl, const Raw *raw); /* sets the position for later messages */
void stream_describe(Sdl *sdl, const Token *token, char *out, size_t size);

/* directive.c */
void directive_run(Sdl *sdl, const Raw *raw);

/* declare.c */
void declare_run(Sdl *sdl, int local);
void declare_undef(Sdl *sdl);
Symbol *symbol_new(Sdl *sdl);
void symbol_bind(Sdl *sdl, Symbol *symbol, Word *word, int scope);
Symbol *symbol_add(Sdl *sdl, Word *word, int scope); /* for #declare and #local; scope 0 is global */
void symbol_remove(Sdl *sdl, Symbol *symbol);
void scope_close(Sdl *sdl, Frame *frame);
int declare_is_defined(Sdl *sdl); /* for #ifdef and defined(): reads a name with its indices in parentheses, raw */

/* macro.c */
void macro_define(Sdl *sdl, const Raw *opener);
void macro_invoke(Sdl *sdl, Symbol *symbol);

/* array.c */
void array_declare(Sdl *sdl, Value *value);   /* after `array` */
Value *array_element(Sdl *sdl, Value *value); /* reads the indices `[…]` that follow; returns the element */
void array_copy(Sdl *sdl, Value *value);      /* gives value its own copy of the elements */

/* fileio.c */
void file_open(Sdl *sdl);
void file_close(Sdl *sdl);
void file_read(Sdl *sdl);
void file_write(Sdl *sdl);

/* expression.c */
Num expression_sum(Sdl *sdl);          /* + - * / and operators of higher precedence */
Num expression_full(Sdl *sdl);         /* comparisons, & | and ?: too: in parentheses and #if */
double expression_condition(Sdl *sdl); /* the condition `( … )` of #if and #while */
double expression_parameter(Sdl *sdl); /* a float, with the full grammar */
int expression_is_string_start(Sdl *sdl);
int expression_is_number_start(Sdl *sdl);
Value value_from_num(Num num);
Num num_float(double value);
void num_promote(Num *num, int count);
void num_component(Sdl *sdl, Num *num, const char *name);
int component_index(const char *name); /* of a vector; -1: gray, a sum of the first three; -2: there is none */

/* color.c */
Num color_parse(Sdl *sdl); /* a colour as a vector of 5 components */

/* function_builtin.c */
typedef enum BuiltinKind {
    BUILTIN_CONSTANT,
    BUILTIN_FLOAT /* functions of floats that return a float */,
    BUILTIN_NUMBER /* parses its own arguments, returns a number */,
    BUILTIN_STRING,
    BUILTIN_COLOR,
    BUILTIN_FORM /* sum, prod: only in user functions */
} BuiltinKind;
struct Builtin {
    const char *name;
    BuiltinKind kind;
    int id, min, max; /* min, max: number of arguments of a BUILTIN_FLOAT */
};
extern const Builtin builtins[];
int builtin_count(void);
Num builtin_constant(Sdl *sdl, int id);
Num builtin_number(Sdl *sdl, const Builtin *builtin); /* parses what follows the name */
/* function_string.c */
const char *builtin_string(Sdl *sdl, const Builtin *builtin);

/* function_user.c */
void function_declare(Sdl *sdl, Value *value);      /* after `function` */
Num function_call(Sdl *sdl, const Value *function); /* parses the arguments from `(` on */

/* spline.c */
void spline_declare(Sdl *sdl, Value *value);    /* after `spline` */
Num spline_call(Sdl *sdl, const Value *spline); /* parses the arguments from `(` on */
FunctionForeign spline_foreign(const Value *spline);

#endif
