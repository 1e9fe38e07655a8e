/* What the files of the language core share: words, tokens as they stand in a file, sources, symbols and the parser's
 * state. The builder sees parser.h only.
 *
 * A file is turned into an array of raw tokens once; directives know where their #end is, so that skipping and
 * looping are jumps in that array. The stream (stream.c) walks it, runs directives (directive.c) and enters macros
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

/* A word of the scene, interned: one for each spelling. */
typedef struct Word {
    const char *text;
    size_t length;
    uint32_t hash;
    uint8_t directive;      /* a Directive where `#word` is one */
    uint8_t reserved;       /* a keyword: cannot be declared */
    const Builtin *builtin; /* constant, function or component of the expression language, or NULL */
    Symbol *symbol;         /* the innermost visible symbol of that name, or NULL */
    struct Word *next;      /* in its hash bucket */
    int declaring;          /* the line of its declaration, while that is read */
} Word;

typedef enum RawKind { RAW_END, RAW_NUMBER, RAW_STRING, RAW_WORD, RAW_PUNCT, RAW_DIRECTIVE, RAW_BAD } RawKind;

typedef enum Directive {
    DIR_NONE,
    DIR_IF,
    DIR_IFDEF,
    DIR_IFNDEF,
    DIR_WHILE,
    DIR_FOR,
    DIR_SWITCH,
    DIR_MACRO, /* these have an #end */
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

/* A token as written. A directive's link: of an opener, #elseif, #else, #case and #range the next branch or the #end
 * (0 = missing); of #end its opener; of #break the opener it leaves. Index 0 of a source is never linked to by meaning
 * "none": LINK_NONE is. */
#define LINK_NONE UINT32_MAX
typedef struct Raw {
    uint32_t line;
    uint16_t column;
    uint8_t kind;
    char punct; /* RAW_PUNCT: the character, or PUNCT_…; RAW_BAD: why, see lexer.c */
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

/* A file's tokens. Freed at the end of its #include unless a macro lives in it, or it is a small one of the disk, which
 * may be included again. */
struct Source {
    const char *name; /* as messages show it */
    Raw *tokens;
    uint32_t count;
    int on_disk, keep, users;
    uint64_t charged; /* bytes of the budget */
    Source *previous, *next;
};

/* A file written by the scene. */
typedef struct MemoryFile {
    const char *name;
    char *bytes; /* in the arena; grows by doubling */
    size_t size, capacity;
    struct MemoryFile *next;
} MemoryFile;

/* What #fopen opens. */
typedef struct FileHandle {
    MemoryFile *output; /* write, append */
    Source *input;      /* read: the file as tokens */
    uint32_t pos;
} FileHandle;

typedef struct Macro {
    Word *name;
    Source *source;
    uint32_t start, body; /* the #macro and the first token after its parameters */
    int count;
    Word **parameters;
} Macro;

/* A declared name. A by-reference parameter's value points at somebody else's. */
struct Symbol {
    Word *word;
    Value *value;
    Value own;
    Macro *macro;
    FileHandle *handle;
    Symbol *shadowed; /* the symbol of this name further out */
    Symbol *next;     /* in its scope, or in the list of unused ones */
    int scope;
};

typedef struct Array {
    int dimensions;
    int size[MAX_DIMENSIONS];
    size_t count;
    Value *items;
} Array;

/* A place the stream reads from: a file, or a macro's body. Each has a scope of #local names. */
typedef struct Frame {
    Source *source;
    const Raw *cursor;    /* where to go on when this frame is on top again */
    uint32_t macro_start; /* LINK_NONE: a file */
    int nloops;           /* #for loops running when it was entered */
    Symbol *locals;
} Frame;

typedef struct Loop {
    uint32_t start; /* its #for */
    int frame;
    Word *variable;
    double end, step;
} Loop;

/* A number, vector or colour while it is computed. */
typedef struct Num {
    double n[5];
    int count; /* 1 = float */
    int color;
} Num;

typedef struct Function Function;

/* What a value may depend on that is 0 unless -D says otherwise. */
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

    Token token; /* the next token where have is set, else the one taken last */
    int have;
    const Raw *cursor; /* in the top frame */
    Frame frames[MAX_FRAMES];
    int nframes, nmacros; /* frames in all, and of those macros */
    Loop loops[MAX_LOOPS];
    int nloops;
    int expression_depth, directive_depth, block_depth;
    struct {
        const char *file;
        int line;
    } blocks[MAX_BLOCK_DEPTH]; /* where each open `{` stands */
    unsigned frame_reads;      /* bits of FrameRead: of what names the frame of an animation, which was looked at */
    long steps, next_look;     /* taken so far; where limits are looked at next */

    Symbol *unused, **unused_tail;
    int nunused;
    uint32_t *seeds;
    int nseeds, seeds_capacity, warned_division;
    const char **reported; /* names sdl_unsupported has told about */
    int nreported, reported_capacity;
    char *pending; /* #debug text not yet ended by a newline */
    size_t npending, pending_capacity;
    size_t said;          /* bytes of messages, counted for safe access alone */
    const char **folders; /* where sdl_find_file looks */
    int nfolders;
    RetexAccess access; /* the same, resolved: reads stay under them */
    double clock, frame_number, initial_frame, final_frame, initial_clock, final_clock;
};

/* language.c */
_Noreturn void sdl_fail(Sdl *sdl, int code, const char *fmt, ...) RETEX_PRINTF(3, 4);
_Noreturn void sdl_fail_memory(Sdl *sdl); /* there is no more that the scene may have */
void sdl_message(Sdl *sdl, int level, const char *text);
void sdl_debug_text(Sdl *sdl, const char *text);

/* words.c */
Word *word_intern(Sdl *sdl, const char *text, size_t length);
void words_begin(Sdl *sdl);
const char *word_nearest(Sdl *sdl, const char *name); /* a declared name or keyword much like it, or NULL */
const char *directive_nearest(const char *name);      /* the same of directives */

/* lexer.c */
Source *source_from_text(Sdl *sdl, const char *name, const char *text, size_t length);
_Noreturn void raw_fail(Sdl *sdl, const Raw *raw); /* tell what is wrong with a RAW_BAD */

/* source.c */
Source *source_open(Sdl *sdl, const char *name);
Source *source_open_scene(Sdl *sdl, const char *path); /* wherever it lies */
void source_release(Sdl *sdl, Source *source);
void sources_close(Sdl *sdl);
void folders_begin(Sdl *sdl, const char *scene_path);
MemoryFile *memory_file_find(Sdl *sdl, const char *name);
MemoryFile *memory_file_create(Sdl *sdl, const char *name);
void memory_file_write(Sdl *sdl, MemoryFile *file, const void *bytes, size_t size);

/* stream.c */
const Token *sdl_peek_operator(Sdl *sdl, int frame); /* NULL where a declaration ends the expression begun in frame */
void stream_finish_macros(Sdl *sdl, int frame);      /* up to the next token or the end of what frame called */
const Raw *sdl_raw(Sdl *sdl);                        /* the next token as written, taken; no directive, no macro */
const Raw *sdl_raw_peek(Sdl *sdl);
int sdl_raw_accept(Sdl *sdl, char punct);
void stream_push_file(Sdl *sdl, Source *source);
void stream_push_macro(Sdl *sdl, const Macro *macro);
void stream_pop(Sdl *sdl);
void stream_jump(Sdl *sdl, uint32_t index);   /* in the top frame */
uint32_t stream_index(Sdl *sdl);              /* of the cursor in the top frame */
void stream_locate(Sdl *sdl, const Raw *raw); /* messages speak of this one from now on */
void stream_describe(Sdl *sdl, const Token *token, char *out, size_t size);

/* directive.c */
void directive_run(Sdl *sdl, const Raw *raw);

/* declare.c */
void declare_run(Sdl *sdl, int local);
void declare_undef(Sdl *sdl);
Symbol *symbol_new(Sdl *sdl);
void symbol_bind(Sdl *sdl, Symbol *symbol, Word *word, int scope);
Symbol *symbol_add(Sdl *sdl, Word *word, int scope); /* both; scope 0 is global */
void symbol_remove(Sdl *sdl, Symbol *symbol);
void scope_close(Sdl *sdl, Frame *frame);
int declare_is_defined(Sdl *sdl); /* of #ifdef and defined: reads a name with its indices, raw */

/* macro.c */
void macro_define(Sdl *sdl, const Raw *opener);
void macro_invoke(Sdl *sdl, Symbol *symbol);

/* array.c */
void array_declare(Sdl *sdl, Value *value);   /* after `array` */
Value *array_element(Sdl *sdl, Value *value); /* reads `[…]`s that follow; the element */
void array_copy(Sdl *sdl, Value *value);      /* value gets elements of its own */

/* fileio.c */
void file_open(Sdl *sdl);
void file_close(Sdl *sdl);
void file_read(Sdl *sdl);
void file_write(Sdl *sdl);

/* expression.c */
Num expression_sum(Sdl *sdl);          /* + - * / and what binds tighter */
Num expression_full(Sdl *sdl);         /* comparisons, & |, ?: too: within parentheses and #if */
double expression_condition(Sdl *sdl); /* `( … )` of #if and #while */
double expression_parameter(Sdl *sdl); /* a float of full grammar */
int expression_is_string_start(Sdl *sdl);
int expression_is_number_start(Sdl *sdl);
Value value_from_num(Num num);
Num num_float(double value);
void num_promote(Num *num, int count);
void num_component(Sdl *sdl, Num *num, const char *name);

/* color.c */
Num color_parse(Sdl *sdl); /* as a 5-vector */

/* function_builtin.c */
typedef enum BuiltinKind {
    BUILTIN_CONSTANT,
    BUILTIN_FLOAT /* floats to a float */,
    BUILTIN_NUMBER /* reads its own arguments, gives a number */,
    BUILTIN_STRING,
    BUILTIN_COLOR,
    BUILTIN_FORM /* sum, prod: in functions only */
} BuiltinKind;
struct Builtin {
    const char *name;
    BuiltinKind kind;
    int id, min, max; /* of BUILTIN_FLOAT: how many arguments */
};
extern const Builtin builtins[];
int builtin_count(void);
Num builtin_constant(Sdl *sdl, int id);
double builtin_float(Sdl *sdl, int id, const double *args, int count);
Num builtin_number(Sdl *sdl, const Builtin *builtin); /* after its name */
/* function_string.c */
const char *builtin_string(Sdl *sdl, const Builtin *builtin);

/* function_user.c */
void function_declare(Sdl *sdl, Value *value);      /* after `function` */
Num function_call(Sdl *sdl, const Value *function); /* with its arguments, from `(` on */

/* function_internal.c */
double internal_call(Sdl *sdl, int number, const double *args, int count);
int internal_arguments(int number);

/* spline.c */
void spline_declare(Sdl *sdl, Value *value);    /* after `spline` */
Num spline_call(Sdl *sdl, const Value *spline); /* from `(` on */
Num spline_value(Sdl *sdl, const Value *spline, double at);

#endif
