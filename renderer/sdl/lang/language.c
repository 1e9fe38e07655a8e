/* sdl_read, and the functions that all parts of the language need: memory, messages, errors.
 *
 * An error jumps back to sdl_read (longjmp), which frees everything: the scene's arena, the tokens of files and the
 * parser's state. There are no global variables, so several scenes can be parsed at the same time. */
#include <locale.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "sdl/lang/internal.h"

Arena *sdl_arena(Sdl *sdl)
{
    return sdl->arena;
}
Scene *sdl_scene(Sdl *sdl)
{
    return sdl->scene;
}
const SdlOptions *sdl_options(Sdl *sdl)
{
    return &sdl->options;
}
const RetexAccess *sdl_access(Sdl *sdl)
{
    return &sdl->access;
}
double sdl_version(Sdl *sdl)
{
    return sdl->version;
}
void *sdl_builder_state(Sdl *sdl)
{
    return sdl->builder_state;
}
void sdl_set_builder_state(Sdl *sdl, void *state)
{
    sdl->builder_state = state;
}

void *sdl_alloc(Sdl *sdl, size_t bytes)
{
    void *memory = arena_alloc(sdl->arena, bytes);
    if (!memory)
        sdl_fail_memory(sdl);
    return memory;
}

void *sdl_grow(Sdl *sdl, void *array, int count, int *capacity, size_t size)
{
    if (count < *capacity)
        return array;
    if (*capacity > 1 << 28)
        sdl_error(sdl, "more than %d things of one kind", *capacity);
    *capacity = *capacity ? *capacity * 2 : 16;
    void *larger = sdl_alloc(sdl, (size_t)*capacity * size);
    if (count > 0)
        memcpy(larger, array, (size_t)count * size);
    return larger;
}

char *sdl_reserve(Sdl *sdl, char *bytes, size_t used, size_t wanted, size_t *capacity)
{
    if (wanted <= *capacity)
        return bytes;
    *capacity = *capacity ? *capacity : 32;
    while (*capacity < wanted)
        *capacity *= 2;
    char *larger = sdl_alloc(sdl, *capacity);
    if (used)
        memcpy(larger, bytes, used);
    return larger;
}

void sdl_fail_memory(Sdl *sdl)
{
    const size_t own = sdl->options.max_memory;
    const uint64_t all = retex_budget_memory(sdl->options.budget), most = all && all < own ? all : own;
    sdl_fail(sdl, RETEX_ELIMIT, "the scene takes more than the %.0f MB of --max-memory", (double)most / (1 << 20));
}

void sdl_add_file(Sdl *sdl, const char *path)
{
    for (const SceneFile *file = sdl->scene->files; file; file = file->next)
        if (strcmp(file->path, path) == 0)
            return;
    SceneFile *added = sdl_alloc(sdl, sizeof *added);
    char *copy = sdl_alloc(sdl, strlen(path) + 1);
    strcpy(copy, path);
    *added = (SceneFile){copy, sdl->scene->files};
    sdl->scene->files = added;
}

void sdl_step(Sdl *sdl, long count)
{
    enum { STEPS_A_LOOK = 4096 }; /* steps between two checks of the limits: well below a millisecond */
    RetexError why;
    sdl->steps += count;
    if (sdl->steps <= sdl->next_look)
        return;
    if (sdl->steps > sdl->options.max_steps)
        sdl_fail(sdl, RETEX_ELIMIT, "the scene takes more than the %ld steps of --max-steps; is a loop endless?",
                 sdl->options.max_steps);
    const int code = retex_budget_check(sdl->options.budget, &why);
    if (code)
        sdl_fail(sdl, code, "%s", why.message);
    const long left = sdl->options.max_steps - sdl->steps;
    sdl->next_look = sdl->steps + (left < STEPS_A_LOOK ? left : STEPS_A_LOOK);
}

static const char *file_name(const Sdl *sdl)
{
    return sdl->token.file ? sdl->token.file : sdl->scene->path;
}

void sdl_fail(Sdl *sdl, int code, const char *fmt, ...)
{
    char text[1024];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    sdl->code = retex_fail_at(sdl->err, code, file_name(sdl), sdl->token.line, sdl->token.column, "%s", text);
    longjmp(sdl->jump, 1);
}

/* If a `}` is missing, the error names the line of the matching `{`. An error about an undeclared name does not get
 * this hint. */
static void describe_open_block(Sdl *sdl, const char *expected, char *out, size_t size)
{
    const Token *token = &sdl->token;
    int closes = strchr(expected, '}') || strstr(expected, "the end of the");
    *out = 0;
    if (token->kind == TOKEN_WORD && !token->word->reserved)
        return;
    if (!sdl->block_depth || (token->kind != TOKEN_END && !closes))
        return;
    const char *file = sdl->blocks[sdl->block_depth - 1].file;
    int line = sdl->blocks[sdl->block_depth - 1].line, here = strcmp(file, file_name(sdl)) == 0;
    if (!here)
        snprintf(out, size, "; the `{` of %.200s:%d is not closed", file, line);
    else if (token->kind == TOKEN_END || line != token->line)
        snprintf(out, size, "; the `{` of line %d is not closed", line);
}

void sdl_expected(Sdl *sdl, const char *what)
{
    char found[256], open[256];
    stream_describe(sdl, sdl_peek(sdl), found, sizeof found);
    describe_open_block(sdl, what, open, sizeof open);
    sdl_error(sdl, "expected %s, found %s%s", what, found, open);
}

/* ---- messages ---- */

/* Limit of the messages' bytes for an untrusted scene. A loop of #warning would otherwise fill the caller's log. */
enum { SAFE_MESSAGES = 64 << 10 };

static void send_message(Sdl *sdl, int level, const char *text)
{
    if (!sdl->options.message || sdl->said > SAFE_MESSAGES)
        return;
    sdl->said += sdl->options.safe ? strlen(text) + 1 : 0;
    if (sdl->said > SAFE_MESSAGES)
        text = "warning: the scene says more, which is left out (--safe)", level = 1;
    sdl->options.message(sdl->options.message_context, level, text);
}

static void flush_debug(Sdl *sdl)
{
    if (sdl->npending)
        send_message(sdl, 0, sdl->pending);
    sdl->npending = 0;
}

/* #debug may print a line in several pieces. Only whole lines are passed to the callback. */
void sdl_debug_text(Sdl *sdl, const char *text)
{
    for (; *text; text++) {
        sdl->pending = sdl_reserve(sdl, sdl->pending, sdl->npending, sdl->npending + 2, &sdl->pending_capacity);
        sdl->pending[sdl->npending] = 0;
        if (*text == '\n') {
            send_message(sdl, 0, sdl->pending);
            sdl->npending = 0;
        } else
            sdl->pending[sdl->npending++] = *text;
        sdl->pending[sdl->npending] = 0;
    }
}

static void warn(Sdl *sdl, const char *file, int line, const char *fmt, va_list args)
{
    char text[1024], message[2200];
    vsnprintf(text, sizeof text, fmt, args);
    snprintf(message, sizeof message, "%s:%d: warning: %s", file, line, text);
    flush_debug(sdl);
    send_message(sdl, 1, message);
}

void sdl_warn(Sdl *sdl, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    warn(sdl, file_name(sdl), sdl->token.line, fmt, args);
    va_end(args);
}

void sdl_warn_at(Sdl *sdl, const char *file, int line, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    warn(sdl, file, line, fmt, args);
    va_end(args);
}

void sdl_unsupported_geometry(Sdl *sdl, const char *name, const char *instead)
{
    if (!sdl->options.lenient && !sdl->options.strict)
        sdl_fail(sdl, RETEX_EUNSUPPORTED, "`%s` is not supported yet; with --lenient, %s", name, instead);
    sdl_unsupported(sdl, name, instead);
}

void sdl_unsupported(Sdl *sdl, const char *name, const char *instead)
{
    if (sdl->options.strict)
        sdl_fail(sdl, RETEX_EUNSUPPORTED, "`%s` is not supported yet", name);
    for (int i = 0; i < sdl->nreported; i++)
        if (strcmp(sdl->reported[i], name) == 0)
            return;
    sdl->reported =
        sdl_grow(sdl, sdl->reported, sdl->nreported, &sdl->reported_capacity, sizeof *sdl->reported);
    char *copy = sdl_alloc(sdl, strlen(name) + 1);
    strcpy(copy, name);
    sdl->reported[sdl->nreported++] = copy;
    sdl_warn(sdl, "`%s` is not supported yet: %s", name, instead);
}

/* ---- identifier lists ---- */

const IdentList *sdl_ident_add(Sdl *sdl, const IdentList *list, const char *name, int line)
{
    for (const IdentList *i = list; i; i = i->next)
        if (strcmp(i->name, name) == 0)
            return list;
    IdentList *added = sdl_alloc(sdl, sizeof *added);
    *added = (IdentList){word_intern(sdl, name, strlen(name))->text, line, list};
    return added;
}

const IdentList *sdl_ident_join(Sdl *sdl, const IdentList *a, const IdentList *b)
{
    if (!a || a == b)
        return b;
    for (; b; b = b->next)
        a = sdl_ident_add(sdl, a, b->name, b->line);
    return a;
}

/* ---- reading a scene ---- */

/* Declare a variable before the scene file is read: `NAME=VALUE`, where VALUE is a float or a quoted string. */
static void predeclare(Sdl *sdl, const char *text)
{
    const char *equals = strchr(text, '=');
    size_t length = equals ? (size_t)(equals - text) : strlen(text);
    Value value = {.kind = VALUE_FLOAT, .count = 1, .number = {1}};
    char *end = NULL;
    if (equals && equals[1] == '"') {
        size_t size = strlen(equals + 2);
        if (size && equals[1 + size] == '"')
            size--;
        value = (Value){.kind = VALUE_STRING, .string = arena_string(sdl->arena, equals + 2, size)};
    } else if (equals) {
        value.number[0] = strtod(equals + 1, &end);
        if (end == equals + 1 || *end)
            value = (Value){.kind = VALUE_STRING, .string = arena_string(sdl->arena, equals + 1, strlen(equals + 1))};
    }
    for (size_t i = 0; i < length; i++) {
        char c = text[i], lower = (char)(c | 32);
        if (!((lower >= 'a' && lower <= 'z') || c == '_' || (i && c >= '0' && c <= '9')))
            length = 0;
    }
    if (!length)
        sdl_fail(sdl, RETEX_EINVAL, "`%s` is not of the form NAME=VALUE", text);
    Word *word = word_intern(sdl, text, length);
    struct {
        const char *name;
        double *value;
    } settings[] = {{"clock", &sdl->clock},
                    {"clock_delta", &sdl->clock_delta},
                    {"clock_on", &sdl->clock_on},
                    {"frame_number", &sdl->frame_number},
                    {"initial_frame", &sdl->initial_frame},
                    {"final_frame", &sdl->final_frame},
                    {"initial_clock", &sdl->initial_clock},
                    {"final_clock", &sdl->final_clock}};
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        if (strcmp(word->text, settings[i].name) == 0 && value.kind == VALUE_FLOAT) {
            sdl->clock_on = 1;
            *settings[i].value = value.number[0];
            return;
        }
    if (word->reserved)
        sdl_fail(sdl, RETEX_EINVAL, "`%s` is a keyword and cannot be declared", word->text);
    if (!word->symbol)
        symbol_add(sdl, word, 0);
    word->symbol->own = value;
}

static void run(Sdl *sdl, const char *path)
{
    words_begin(sdl);
    folders_begin(sdl, path);
    sdl->unused_tail = &sdl->unused;
    predeclare(sdl, "Retex=1");
    for (int i = 0; i < sdl->options.ndeclares; i++)
        predeclare(sdl, sdl->options.declares[i]);
    sdl->builder->begin(sdl);
    stream_push_file(sdl, source_open_scene(sdl, path));
    while (sdl_peek(sdl)->kind != TOKEN_END)
        if (!sdl_raw_accept(sdl, ';'))
            sdl->builder->statement(sdl);
    sdl->builder->finish(sdl);
}

static void set_options(Sdl *sdl, const SdlOptions *options)
{
    SdlOptions defaults = SDL_OPTIONS_INIT;
    sdl->options = defaults;
    if (options)
        memcpy(&sdl->options, options, options->size < sizeof defaults ? options->size : sizeof defaults);
    if (sdl->options.max_steps <= 0)
        sdl->options.max_steps = defaults.max_steps;
    if (!sdl->options.max_memory)
        sdl->options.max_memory = defaults.max_memory;
    sdl->version = 3.62;
}

int sdl_read(Scene **scene, const char *path, const SdlOptions *options, const SdlBuilder *builder, RetexError *err)
{
    *scene = NULL;
    Sdl *sdl = calloc(1, sizeof *sdl);
    if (!sdl)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    sdl->err = err;
    sdl->builder = builder;
    set_options(sdl, options);
    sdl->arena = arena_create(sdl->options.max_memory, sdl->options.budget);
    sdl->scene = sdl->arena ? arena_alloc(sdl->arena, sizeof *sdl->scene) : NULL;
    if (!sdl->scene) {
        arena_close(&sdl->arena);
        free(sdl);
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    }
    sdl->scene->arena = sdl->arena;
    snprintf(sdl->scene->path, sizeof sdl->scene->path, "%s", path);
    /* The decimal separator of the language is a point in every locale. */
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = c ? uselocale(c) : (locale_t)0;
    if (setjmp(sdl->jump) == 0)
        run(sdl, path);
    flush_debug(sdl);
    if (c) {
        uselocale(before);
        freelocale(c);
    }
    int code = sdl->code;
    Scene *result = sdl->scene;
    sources_close(sdl);
    free(sdl);
    if (code)
        scene_close(&result);
    *scene = result;
    return code;
}
