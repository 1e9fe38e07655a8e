/* The lexer converts a file to raw tokens in one pass: numbers on a fast path, words interned, nested comments
 * skipped. It links openers such as #if to their branches and their #end, so that the parser skips a branch by a
 * jump.
 *
 * A lexical error becomes a RAW_BAD token. It is reported only if the parser reaches it: POV-Ray accepts errors in a
 * branch that is not taken. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "sdl/lang/internal.h"

enum {
    BAD_CHARACTER = 'c',
    BAD_STRING = 's',
    BAD_COMMENT = '*',
    BAD_NESTING = 'n',
    BAD_LONG = 'l',
    BAD_DIRECTIVE = 'd' /* the directive's name is in as.word */
};

typedef struct Open {
    uint32_t start, last; /* index of the opener, and of the last branch, whose link is still missing */
    uint8_t id;
    int has_else;
} Open;

typedef struct Lexer {
    Sdl *sdl;
    const char *at, *end, *line_start;
    uint32_t line;
    Source *source;
    uint32_t capacity;
    Open *open;
    int nopen, open_capacity;
} Lexer;

static const char *problem(const Raw *raw)
{
    switch (raw->punct) {
    case BAD_STRING:
        return "a string without its closing quote";
    case BAD_COMMENT:
        return "a comment /* without its end */";
    case BAD_NESTING:
        return "a directive without the one it belongs to";
    case BAD_LONG:
        return "a string or name that is too long";
    default:
        return "a character that has no meaning here";
    }
}

void raw_fail(Sdl *sdl, const Raw *raw)
{
    if (raw->punct != BAD_DIRECTIVE)
        sdl_error(sdl, "%s", problem(raw));
    const char *nearest = directive_nearest(raw->as.word->text);
    if (nearest)
        sdl_error(sdl, "there is no directive `#%.60s`; is `#%s` meant?", raw->as.word->text, nearest);
    sdl_error(sdl, "there is no directive `#%.60s`", raw->as.word->text);
}

static int is_letter(unsigned char c)
{
    return (unsigned)((c | 32) - 'a') < 26 || c == '_';
}
static int is_digit(unsigned char c)
{
    return (unsigned)(c - '0') < 10;
}

static Raw *add(Lexer *lexer, RawKind kind, const char *at)
{
    Source *source = lexer->source;
    if (source->count == lexer->capacity) {
        uint32_t capacity = lexer->capacity ? lexer->capacity * 2 : 32;
        const uint64_t more = (uint64_t)(capacity - lexer->capacity) * sizeof(Raw);
        if (capacity > lexer->sdl->options.max_memory / sizeof(Raw) ||
            retex_budget_charge(lexer->sdl->options.budget, more, "", NULL))
            sdl_fail_memory(lexer->sdl);
        source->charged += more;
        Raw *tokens = capacity > lexer->capacity ? realloc(source->tokens, capacity * sizeof *tokens) : NULL;
        if (!tokens)
            sdl_fail(lexer->sdl, RETEX_ENOMEM, "out of memory");
        source->tokens = tokens;
        lexer->capacity = capacity;
    }
    Raw *raw = &source->tokens[source->count++];
    ptrdiff_t column = at - lexer->line_start + 1;
    raw->line = lexer->line;
    raw->column = (uint16_t)(column < 65535 ? column : 65535);
    raw->kind = (uint8_t)kind;
    raw->punct = 0;
    raw->as.number = 0;
    return raw;
}

static void bad(Lexer *lexer, char why, const char *at)
{
    add(lexer, RAW_BAD, at)->punct = why;
}

/* Up to 19 digits and a small power of ten are converted without strtod, with at most a tiny error. Other numbers
 * use strtod. */
static void number(Lexer *lexer)
{
    static const double powers[] = {1,    1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const char *start = lexer->at, *p = start, *end = lexer->end;
    uint64_t mantissa = 0;
    int digits = 0, exponent = 0;
    for (; p < end && is_digit((unsigned char)*p); p++) {
        if (digits < 19)
            mantissa = mantissa * 10 + (unsigned)(*p - '0');
        digits += digits || *p != '0';
    }
    if (p < end && *p == '.')
        for (p++; p < end && is_digit((unsigned char)*p); p++) {
            if (digits < 19)
                mantissa = mantissa * 10 + (unsigned)(*p - '0'), exponent--;
            digits += digits || *p != '0';
        }
    if (p < end && (*p | 32) == 'e') {
        const char *q = p + 1;
        int negative = 0, value = 0;
        if (q < end && (*q == '+' || *q == '-'))
            negative = *q++ == '-';
        if (q < end && is_digit((unsigned char)*q)) {
            for (; q < end && is_digit((unsigned char)*q); q++)
                if (value < 10000)
                    value = value * 10 + (*q - '0');
            exponent += negative ? -value : value;
            p = q;
        }
    }
    double value;
    if (mantissa < (uint64_t)1 << 53 && digits < 19 && exponent >= -22 && exponent <= 22)
        value = exponent < 0 ? (double)mantissa / powers[-exponent] : (double)mantissa * powers[exponent];
    else {
        /* strtod needs a terminating NUL, which the text may lack: copy the number. */
        char small[64], *text = small;
        size_t length = (size_t)(p - start);
        if (length >= sizeof small)
            text = sdl_alloc(lexer->sdl, length + 1);
        memcpy(text, start, length);
        text[length] = 0;
        value = strtod(text, NULL);
    }
    add(lexer, RAW_NUMBER, start)->as.number = value;
    lexer->at = p;
}

static char *put_utf8(char *out, unsigned code)
{
    if (code < 0x80)
        *out++ = (char)code;
    else if (code < 0x800)
        *out++ = (char)(0xc0 | code >> 6), *out++ = (char)(0x80 | (code & 63));
    else
        *out++ = (char)(0xe0 | code >> 12), *out++ = (char)(0x80 | (code >> 6 & 63)),
        *out++ = (char)(0x80 | (code & 63));
    return out;
}

/* Decode one escape sequence after its backslash and advance *p past it. Unknown escapes are kept unchanged, because
 * Windows paths contain backslashes. */
static char *escape(const char **p, const char *end, char *out)
{
    static const char letters[] = "abfnrtv0\\\"'", values[] = "\a\b\f\n\r\t\v\0\\\"'";
    const char *found = memchr(letters, **p, sizeof letters - 1);
    if (**p == 'u' && end - *p >= 5) {
        unsigned code = 0;
        for (int i = 1; i <= 4; i++) {
            unsigned char c = (unsigned char)(*p)[i];
            int digit = is_digit(c) ? c - '0' : (unsigned)((c | 32) - 'a') < 6 ? (c | 32) - 'a' + 10 : -1;
            if (digit < 0)
                code = 0x10000;
            code = code * 16 + (unsigned)(digit < 0 ? 0 : digit);
        }
        if (code > 0 && code < 0x10000) {
            *p += 5;
            return put_utf8(out, code);
        }
    }
    if (found && *found != '0')
        *out++ = values[found - letters];
    else
        *out++ = '\\', *out++ = **p;
    (*p)++;
    return out;
}

static void string(Lexer *lexer)
{
    const char *start = lexer->at, *p = start + 1, *line_start = lexer->line_start;
    uint32_t line = lexer->line;
    int escapes = 0;
    while (p < lexer->end && *p != '"') {
        if (*p == '\\' && p + 1 < lexer->end)
            p++, escapes = 1;
        if (*p == '\n')
            line++, line_start = p + 1;
        p++;
    }
    if (p >= lexer->end) {
        bad(lexer, BAD_STRING, start);
        lexer->at = lexer->end;
        return;
    }
    size_t length = (size_t)(p - start - 1);
    Raw *raw = add(lexer, length <= MAX_STRING ? RAW_STRING : RAW_BAD, start);
    if (length <= MAX_STRING) {
        /* Decoding never lengthens the text: the six bytes of \uXXXX become three bytes at most. */
        char *text = sdl_alloc(lexer->sdl, length + 1), *out = text;
        if (!escapes)
            memcpy(text, start + 1, length);
        else
            for (const char *q = start + 1; q < p;)
                if (*q == '\\' && q + 1 < p) {
                    q++;
                    out = escape(&q, p, out);
                } else
                    *out++ = *q++;
        raw->as.string = text;
    } else
        raw->punct = BAD_LONG;
    lexer->line = line;
    lexer->line_start = line_start;
    lexer->at = p + 1;
}

/* C comments nest, as in POV-Ray. */
static void comment(Lexer *lexer)
{
    const char *start = lexer->at, *p = start + 2, *line_start = lexer->line_start;
    uint32_t line = lexer->line;
    int depth = 1;
    while (p < lexer->end && depth) {
        if (*p == '/' && p + 1 < lexer->end && p[1] == '*')
            depth++, p += 2;
        else if (*p == '*' && p + 1 < lexer->end && p[1] == '/')
            depth--, p += 2;
        else {
            if (*p == '\n')
                line++, line_start = p + 1;
            p++;
        }
    }
    if (depth)
        bad(lexer, BAD_COMMENT, start);
    lexer->line = line;
    lexer->line_start = line_start;
    lexer->at = p;
}

static Word *word(Lexer *lexer)
{
    const char *start = lexer->at, *p = start;
    while (p < lexer->end && (is_letter((unsigned char)*p) || is_digit((unsigned char)*p)))
        p++;
    lexer->at = p;
    return word_intern(lexer->sdl, start, (size_t)(p - start));
}

static void push_open(Lexer *lexer, uint32_t index, uint8_t id)
{
    lexer->open = sdl_grow(lexer->sdl, lexer->open, lexer->nopen, &lexer->open_capacity, sizeof *lexer->open);
    lexer->open[lexer->nopen++] = (Open){index, index, id, 0};
}

/* Link a directive to its construct. A branch outside a construct becomes a RAW_BAD token. */
static void link_directive(Lexer *lexer, uint32_t index)
{
    Raw *tokens = lexer->source->tokens, *raw = &tokens[index];
    uint8_t id = raw->as.directive.id;
    Open *top = lexer->nopen ? &lexer->open[lexer->nopen - 1] : NULL;
    raw->as.directive.link = LINK_NONE;
    if (id >= DIR_IF && id <= DIR_MACRO)
        push_open(lexer, index, id);
    else if (id == DIR_BREAK) {
        for (int i = lexer->nopen - 1; i >= 0; i--)
            if (lexer->open[i].id >= DIR_WHILE) {
                raw->as.directive.link = lexer->open[i].start;
                break;
            }
    } else if (id == DIR_ELSE || id == DIR_ELSEIF || id == DIR_CASE || id == DIR_RANGE || id == DIR_END) {
        int is_if = top && top->id <= DIR_IFNDEF, is_switch = top && top->id == DIR_SWITCH;
        int fits = top && (id == DIR_END || (!top->has_else && ((is_if && (id == DIR_ELSE || id == DIR_ELSEIF)) ||
                                                                (is_switch && id != DIR_ELSEIF))));
        if (!fits) {
            raw->kind = RAW_BAD;
            raw->punct = BAD_NESTING;
            return;
        }
        tokens[top->last].as.directive.link = index;
        raw->as.directive.opener = top->id;
        top->last = index;
        top->has_else |= id == DIR_ELSE;
        if (id == DIR_END) {
            raw->as.directive.link = top->start;
            lexer->nopen--;
        }
    }
}

static void add_directive(Lexer *lexer, const Word *name, const char *start)
{
    Raw *raw = add(lexer, RAW_DIRECTIVE, start);
    memset(&raw->as, 0, sizeof raw->as);
    raw->as.directive.id = name->directive;
    link_directive(lexer, lexer->source->count - 1);
}

static void directive(Lexer *lexer)
{
    const char *start = lexer->at++;
    while (lexer->at < lexer->end && (*lexer->at == ' ' || *lexer->at == '\t'))
        lexer->at++;
    /* A `#` that starts no directive is skipped, as in POV-Ray. Existing scenes rely on this. */
    if (lexer->at >= lexer->end || !is_letter((unsigned char)*lexer->at))
        return;
    Word *name = word(lexer);
    if (name->directive) {
        add_directive(lexer, name, start);
        return;
    }
    Raw *raw = add(lexer, name->reserved ? RAW_WORD : RAW_BAD, start);
    raw->punct = name->reserved ? 0 : BAD_DIRECTIVE;
    raw->as.word = name;
}

/* Words that were directives without `#` in old POV-Ray versions. */
static int is_old_directive(const Word *word)
{
    return word->directive == DIR_DECLARE || word->directive == DIR_INCLUDE || word->directive == DIR_DEFAULT;
}

static void punctuation(Lexer *lexer, char c)
{
    const char *start = lexer->at++;
    int equals = lexer->at < lexer->end && *lexer->at == '=';
    if (c == '!' && equals)
        c = PUNCT_NE;
    else if (c == '<' && equals)
        c = PUNCT_LE;
    else if (c == '>' && equals)
        c = PUNCT_GE;
    else
        equals = 0;
    lexer->at += equals;
    if (c && (strchr("{}()[]<>,;:.+-*/=&|!?", c) || equals))
        add(lexer, RAW_PUNCT, start)->punct = c;
    else
        bad(lexer, BAD_CHARACTER, start);
}

Source *source_from_text(Sdl *sdl, const char *name, const char *text, size_t length)
{
    sdl_step(sdl, (long)(length / 16)); /* comments count as steps too: a loop may include the file many times */
    Source *source = calloc(1, sizeof *source);
    if (!source)
        sdl_fail(sdl, RETEX_ENOMEM, "out of memory");
    source->next = sdl->sources;
    if (source->next)
        source->next->previous = source;
    sdl->sources = source;
    source->name = name;
    Lexer lexer = {sdl, text, text + length, text, 1, source, 0, NULL, 0, 0};
    if (length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)
        lexer.at += 3;
    while (lexer.at < lexer.end) {
        unsigned char c = (unsigned char)*lexer.at;
        int more = lexer.at + 1 < lexer.end;
        if (c == '\n')
            lexer.line++, lexer.line_start = ++lexer.at;
        else if (c <= ' ' && c != 0)
            lexer.at++;
        else if (is_digit(c) || (c == '.' && more && is_digit((unsigned char)lexer.at[1])))
            number(&lexer);
        else if (is_letter(c)) {
            const char *start = lexer.at;
            Word *w = word(&lexer);
            if (is_old_directive(w))
                add_directive(&lexer, w, start);
            else
                add(&lexer, RAW_WORD, start)->as.word = w;
        } else if (c == '"')
            string(&lexer);
        else if (c == '#')
            directive(&lexer);
        else if (c == '/' && more && lexer.at[1] == '*')
            comment(&lexer);
        else if (c == '/' && more && lexer.at[1] == '/') {
            const char *newline = memchr(lexer.at, '\n', (size_t)(lexer.end - lexer.at));
            lexer.at = newline ? newline : lexer.end;
        } else
            punctuation(&lexer, (char)c);
    }
    add(&lexer, RAW_END, lexer.at);
    return source;
}
