/* Directives: conditions, loops, #include, #version and messages. The lexer has linked each directive to its
 * branches and its #end, so taking a branch is a jump. Declarations are in declare.c, macros in macro.c, file
 * directives in fileio.c. */
#include <math.h>
#include <string.h>
#include "sdl/lang/internal.h"

static Raw *token_at(Sdl *sdl, uint32_t index)
{
    return &sdl->frames[sdl->nframes - 1].source->tokens[index];
}

/* Index of a directive's token in its source, for a jump back after the condition was evaluated. */
static uint32_t index_of(Sdl *sdl, const Raw *raw)
{
    return (uint32_t)(raw - sdl->frames[sdl->nframes - 1].source->tokens);
}

static void check_end(Sdl *sdl, const Raw *raw)
{
    if (raw->as.directive.link == LINK_NONE)
        sdl_error(sdl, "a directive without its #end");
}

/* Index of the #end that closes the construct of the branch at `index`. */
static uint32_t find_end(Sdl *sdl, uint32_t index)
{
    for (;;) {
        const Raw *raw = token_at(sdl, index);
        if (raw->as.directive.id == DIR_END)
            return index;
        if (raw->as.directive.link == LINK_NONE)
            sdl_error(sdl, "a directive without its #end");
        index = raw->as.directive.link;
    }
}

/* A condition may call macros. They must have ended when the condition ends. */
static void check_frame(Sdl *sdl, int frame)
{
    if (sdl->nframes != frame)
        sdl_error(sdl, "the condition began in another file or macro than it ends in");
}

static int condition(Sdl *sdl)
{
    int frame = sdl->nframes;
    double value = expression_condition(sdl);
    check_frame(sdl, frame);
    return value != 0;
}

/* #if, #ifdef, #ifndef and #elseif: evaluate the condition, then enter the branch or continue with the next one. */
static void run_if(Sdl *sdl, const Raw *raw)
{
    for (;;) {
        uint32_t next = raw->as.directive.link;
        check_end(sdl, raw);
        int id = raw->as.directive.id;
        int taken =
            id == DIR_ELSE || id == DIR_END ||
            (id == DIR_IFDEF || id == DIR_IFNDEF ? declare_is_defined(sdl) == (id == DIR_IFDEF) : condition(sdl));
        if (taken)
            return;
        raw = token_at(sdl, next);
        stream_locate(sdl, raw);
        stream_jump(sdl, next + 1);
    }
}

static void run_while(Sdl *sdl, const Raw *raw)
{
    check_end(sdl, raw);
    if (!condition(sdl))
        stream_jump(sdl, raw->as.directive.link + 1);
}

/* The loop variable is an ordinary #local variable: the loop's body may assign to it. */
static Value *loop_variable(Sdl *sdl, Word *word)
{
    Symbol *symbol = word->symbol;
    if (!symbol || symbol->macro)
        sdl_error(sdl, "the variable `%s` of #for is gone", word->text);
    if (symbol->value->kind != VALUE_FLOAT)
        sdl_error(sdl, "the variable `%s` of #for is no float any more", word->text);
    return symbol->value;
}

static int loop_goes_on(Sdl *sdl, const Loop *loop)
{
    /* A tolerance for rounding errors of the step, as in POV-Ray: #for(I,0,1,.1) includes 1. */
    double value = loop_variable(sdl, loop->variable)->number[0];
    return loop->step > 0 ? value <= loop->end + 1e-10 * fabs(loop->step)
                          : value >= loop->end - 1e-10 * fabs(loop->step);
}

static void run_for(Sdl *sdl, const Raw *raw)
{
    check_end(sdl, raw);
    int frame = sdl->nframes;
    sdl_raw_expect(sdl, '(');
    const Raw *name = sdl_raw(sdl);
    if (name->kind != RAW_WORD || name->as.word->reserved)
        sdl_error(sdl, "expected the name of #for's variable");
    Word *word = name->as.word;
    sdl_expect(sdl, ",");
    double start = expression_parameter(sdl);
    sdl_expect(sdl, ",");
    Loop loop = {index_of(sdl, raw), frame, word, expression_parameter(sdl), 1};
    if (sdl_accept(sdl, ","))
        loop.step = expression_parameter(sdl);
    sdl_expect(sdl, ")");
    check_frame(sdl, frame);
    if (!(fabs(loop.step) >= 1e-10))
        sdl_error(sdl, "the step of #for must not be 0");
    Symbol *symbol = word->symbol;
    if (symbol && symbol->macro)
        sdl_error(sdl, "`%s` is a macro", word->text);
    int scope = frame <= 1 ? 0 : frame; /* the scope that #local uses */
    if (!symbol || symbol->scope != scope)
        symbol = symbol_add(sdl, word, scope);
    *symbol->value = value_from_num(num_float(start));
    if (!loop_goes_on(sdl, &loop)) {
        stream_jump(sdl, raw->as.directive.link + 1);
        return;
    }
    if (sdl->nloops == MAX_LOOPS)
        sdl_fail(sdl, RETEX_ELIMIT, "#for nested more than %d deep", MAX_LOOPS);
    sdl->loops[sdl->nloops++] = loop;
}

static void end_for(Sdl *sdl, uint32_t start)
{
    Loop *loop = sdl->nloops ? &sdl->loops[sdl->nloops - 1] : NULL;
    if (!loop || loop->start != start || loop->frame != sdl->nframes)
        return; /* the loop was left by #break */
    loop_variable(sdl, loop->variable)->number[0] += loop->step;
    if (!loop_goes_on(sdl, loop)) {
        sdl->nloops--;
        return;
    }
    /* Jump behind the `)` of the loop's header: its parameters were evaluated when the loop began. */
    uint32_t index = start + 2;
    for (int depth = 1; depth; index++) {
        const Raw *raw = token_at(sdl, index);
        if (raw->kind == RAW_PUNCT)
            depth += (raw->punct == '(') - (raw->punct == ')');
    }
    stream_jump(sdl, index);
}

/* #switch: run from the first #case or #range that matches to #break or #end. Later cases are run too, as in C. */
static void run_switch(Sdl *sdl, const Raw *raw)
{
    check_end(sdl, raw);
    int frame = sdl->nframes;
    double value = expression_condition(sdl);
    check_frame(sdl, frame);
    for (uint32_t index = raw->as.directive.link;; index = token_at(sdl, index)->as.directive.link) {
        const Raw *branch = token_at(sdl, index);
        int id = branch->as.directive.id;
        stream_locate(sdl, branch);
        check_end(sdl, branch);
        stream_jump(sdl, index + 1);
        if (id == DIR_END || id == DIR_ELSE)
            return;
        sdl_expect(sdl, "(");
        double low = expression_parameter(sdl), high = low;
        if (id == DIR_RANGE) {
            sdl_expect(sdl, ",");
            high = expression_parameter(sdl);
        }
        sdl_expect(sdl, ")");
        check_frame(sdl, frame);
        if (id == DIR_RANGE ? value >= low && value <= high : fabs(value - low) < 1e-10)
            return;
    }
}

/* A #case or #range reached from the branch above it: skip its parameters and continue. */
static void pass_case(Sdl *sdl)
{
    int depth = 0;
    do {
        const Raw *raw = sdl_raw(sdl);
        if (raw->kind == RAW_END)
            sdl_error(sdl, "expected `)`, found the end of the file");
        if (raw->kind == RAW_PUNCT)
            depth += (raw->punct == '(') - (raw->punct == ')');
    } while (depth > 0);
}

static void run_break(Sdl *sdl, const Raw *raw)
{
    uint32_t start = raw->as.directive.link;
    if (start == LINK_NONE)
        sdl_error(sdl, "#break outside of a loop, #switch or #macro");
    const Raw *opener = token_at(sdl, start);
    int id = opener->as.directive.id;
    if (id == DIR_MACRO) {
        if (sdl->frames[sdl->nframes - 1].macro_start == start)
            stream_pop(sdl);
        return;
    }
    Loop *loop = sdl->nloops ? &sdl->loops[sdl->nloops - 1] : NULL;
    if (id == DIR_FOR && loop && loop->start == start && loop->frame == sdl->nframes)
        sdl->nloops--;
    stream_jump(sdl, find_end(sdl, start) + 1);
}

static void run_end(Sdl *sdl, const Raw *raw)
{
    uint32_t start = raw->as.directive.link;
    switch (raw->as.directive.opener) {
    case DIR_WHILE:
        stream_jump(sdl, start + 1);
        stream_locate(sdl, token_at(sdl, start));
        run_while(sdl, token_at(sdl, start));
        break;
    case DIR_FOR:
        end_for(sdl, start);
        break;
    case DIR_MACRO:
        if (sdl->frames[sdl->nframes - 1].macro_start == start)
            stream_pop(sdl);
        break;
    default:
        break;
    }
}

static void run_else(Sdl *sdl, const Raw *raw)
{
    if (raw->as.directive.opener == DIR_SWITCH)
        return;
    check_end(sdl, raw);
    stream_jump(sdl, find_end(sdl, raw->as.directive.link) + 1);
}

static void run_include(Sdl *sdl)
{
    const char *name = sdl_string(sdl);
    stream_push_file(sdl, source_open(sdl, name));
}

static void run_version(Sdl *sdl)
{
    /* `#version unofficial megapov 1.21;` and similar name other programs' dialects: their plain statements are
     * parsed. */
    if (sdl_raw_peek(sdl)->kind == RAW_WORD && strcmp(sdl_raw_peek(sdl)->as.word->text, "unofficial") == 0) {
        sdl_raw(sdl);
        if (sdl_raw_peek(sdl)->kind == RAW_WORD)
            sdl_raw(sdl);
        if (sdl_raw_peek(sdl)->kind == RAW_NUMBER)
            sdl_raw(sdl);
    } else {
        double version = sdl_float(sdl);
        sdl->version = version >= 100 ? version / 100 : version; /* early POV-Ray versions accepted 370 for 3.7 */
    }
    sdl_raw_accept(sdl, ';');
}

static void run_message(Sdl *sdl, int id)
{
    const char *text = sdl_string(sdl);
    size_t length = strlen(text);
    while (length && text[length - 1] == '\n')
        length--;
    if (id == DIR_ERROR)
        sdl_error(sdl, "%.*s", (int)(length < 1000 ? length : 1000), text);
    if (id == DIR_WARNING)
        sdl_warn(sdl, "%.*s", (int)(length < 1000 ? length : 1000), text);
    else
        sdl_debug_text(sdl, text);
}

void directive_run(Sdl *sdl, const Raw *raw)
{
    Directive id = (Directive)raw->as.directive.id;
    /* A directive inside the expression of another directive. Macros that return values nest in this way. */
    if (++sdl->directive_depth > MAX_DIRECTIVE_DEPTH)
        sdl_fail(sdl, RETEX_ELIMIT, "directives nested more than %d deep", MAX_DIRECTIVE_DEPTH);
    switch (id) {
    case DIR_IF:
    case DIR_IFDEF:
    case DIR_IFNDEF:
        run_if(sdl, raw);
        break;
    case DIR_WHILE:
        run_while(sdl, raw);
        break;
    case DIR_FOR:
        run_for(sdl, raw);
        break;
    case DIR_SWITCH:
        run_switch(sdl, raw);
        break;
    case DIR_MACRO:
        macro_define(sdl, raw);
        break;
    case DIR_ELSE:
    case DIR_ELSEIF:
        run_else(sdl, raw);
        break;
    case DIR_CASE:
    case DIR_RANGE:
        pass_case(sdl);
        break;
    case DIR_BREAK:
        run_break(sdl, raw);
        break;
    case DIR_END:
        run_end(sdl, raw);
        break;
    case DIR_DECLARE:
        declare_run(sdl, 0);
        break;
    case DIR_LOCAL:
        declare_run(sdl, 1);
        break;
    case DIR_UNDEF:
        declare_undef(sdl);
        break;
    case DIR_INCLUDE:
        run_include(sdl);
        break;
    case DIR_DEFAULT:
        sdl->builder->set_default(sdl);
        break;
    case DIR_VERSION:
        run_version(sdl);
        break;
    case DIR_DEBUG:
    case DIR_WARNING:
    case DIR_ERROR:
    case DIR_RENDER:
    case DIR_STATISTICS:
        run_message(sdl, id);
        break;
    case DIR_FOPEN:
        file_open(sdl);
        break;
    case DIR_FCLOSE:
        file_close(sdl);
        break;
    case DIR_READ:
        file_read(sdl);
        break;
    case DIR_WRITE:
        file_write(sdl);
        break;
    case DIR_NONE:
        break;
    }
    sdl->directive_depth--;
}
