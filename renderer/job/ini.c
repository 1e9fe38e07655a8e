/* Reads .ini files of POV-Ray; see ini.h. */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>
#include <retex/access.h>
#include <retex/nearest.h>
#include "job/ini.h"

enum { BYTES_MAX = 1 << 20, LINES_MAX = 100000, READS_MAX = 1000, DEPTH_MAX = 10 };

static int include(IniOptions *options, const IniPlace *place, const char *name, RetexError *err);

static const IniPlace command_line = {"", 0, "", include};

/* ---- text ---- */

static char *trim(char *text)
{
    text += strspn(text, " \t\r");
    for (size_t length = strlen(text); length && strchr(" \t\r", text[length - 1]);)
        text[--length] = '\0';
    return text;
}

/* Cut off a comment, `; …`, that is not inside quotes. */
static void cut_comment(char *line)
{
    char quote = 0;
    for (char *c = line; *c; c++)
        if (quote ? *c == quote : *c == '"' || *c == '\'')
            quote = quote ? 0 : *c;
        else if (*c == ';' && !quote) {
            *c = '\0';
            return;
        }
}

/* The next word of a line, without its quotes; NULL after the last. */
static char *next_word(char **rest)
{
    char *word = *rest + strspn(*rest, " \t\r"), *out = word, *in = word, quote = 0;
    if (!*word)
        return NULL;
    for (; *in && (quote || !strchr(" \t\r", *in)); in++)
        if (quote ? *in == quote : *in == '"' || *in == '\'')
            quote = quote ? 0 : *in;
        else
            *out++ = *in;
    *rest = in + (*in != '\0');
    *out = '\0';
    return word;
}

static char *unquote(char *value)
{
    const size_t length = strlen(value);
    if (length < 2 || (value[0] != '"' && value[0] != '\'') || value[length - 1] != value[0])
        return value;
    value[length - 1] = '\0';
    return value + 1;
}

static char *read_text(IniOptions *options, const IniPlace *place, const char *path, RetexError *err)
{
    RetexAccess access = RETEX_ACCESS_INIT;
    RetexError why;
    int file;
    access.safe = options->safe;
    if (retex_access_open(&access, path, &file, &why)) {
        ini_fail(place, err, "%s", why.message);
        return NULL;
    }
    char *text = malloc(BYTES_MAX + 1);
    size_t used = 0;
    ssize_t got = 1;
    while (text && got > 0 && used < BYTES_MAX)
        if ((got = read(file, text + used, BYTES_MAX - used)) > 0)
            used += (size_t)got;
    const int failed = errno;
    close(file);
    if (!text)
        retex_fail(err, RETEX_ENOMEM, "out of memory");
    else if (got < 0)
        ini_fail(place, err, "cannot read %.200s: %s", path, strerror(failed));
    else if (used == BYTES_MAX)
        ini_fail(place, err, "%.200s: an .ini file has less than %d bytes", path, BYTES_MAX);
    else if (memchr(text, 0, used))
        ini_fail(place, err, "%.200s is no .ini file: it holds NUL bytes", path);
    else {
        text[used] = '\0';
        return text;
    }
    free(text);
    return NULL;
}

/* ---- a file ---- */

typedef struct Reader {
    IniOptions *options;
    IniPlace place;
    const char *section; /* the one that is asked for, or "" */
    int inside, found;   /* lines are read now; the section was there */
    RetexNearest nearest;
} Reader;

static int read_section(Reader *r, char *line, RetexError *err)
{
    char *end = strchr(line, ']');
    if (!end)
        return ini_fail(&r->place, err, "expected `]` after a section's name");
    *end = '\0';
    const char *name = trim(line + 1);
    r->inside = *r->section && !strcasecmp(name, r->section);
    r->found |= r->inside;
    if (strlen(name) <= RETEX_NEAREST_MAX && !r->nearest.best) {
        RetexNearest one = r->nearest;
        retex_nearest_try(&one, name);
        r->nearest.best = one.best; /* the first that is near */
    }
    return RETEX_OK;
}

static int read_words(Reader *r, char *line, RetexError *err)
{
    int code = RETEX_OK;
    for (char *word, *equals; !code && (word = next_word(&line));)
        if (*word == '+' || *word == '-')
            code = ini_set_switch(r->options, &r->place, word, err);
        else if ((equals = strchr(word, '=')))
            *equals = '\0', code = ini_set(r->options, &r->place, word, equals + 1, err);
        else
            code = ini_set_name(r->options, &r->place, word, err);
    return code;
}

static int read_line(Reader *r, char *line, RetexError *err)
{
    if (++r->options->nlines > LINES_MAX)
        return ini_fail(&r->place, err, "more than %d lines in all", LINES_MAX);
    cut_comment(line);
    line = trim(line);
    if (*line == '[')
        return read_section(r, line, err);
    if (!*line || !r->inside)
        return RETEX_OK;
    char *equals = *line == '+' || *line == '-' ? NULL : strchr(line, '=');
    if (!equals)
        return read_words(r, line, err);
    *equals = '\0';
    return ini_set(r->options, &r->place, trim(line), unquote(trim(equals + 1)), err);
}

/* All lines. place: where the file is named, for the section that is not there. */
static int read_lines(Reader *r, const IniPlace *place, char *text, RetexError *err)
{
    char meant[RETEX_MEANT_SIZE];
    int code = RETEX_OK;
    for (char *line = text; line && !code;) {
        char *end = strchr(line, '\n');
        if (end)
            *end++ = '\0';
        r->place.line++;
        code = read_line(r, line, err);
        line = end;
    }
    if (!code && *r->section && !r->found)
        code = ini_fail(place, err, "%.200s has no section [%.100s]%s", r->place.file, r->section,
                        retex_meant(r->nearest.best, meant));
    return code;
}

/* Whether a file is being read, under that name. */
static int is_open(const IniOptions *options, const char *path)
{
    for (int k = options->files.count - 1; k >= 0; k--)
        if (!strcmp(options->files.items[k], path))
            return 1;
    return 0;
}

static int include(IniOptions *options, const IniPlace *place, const char *name, RetexError *err)
{
    const char *bracket = strchr(name, '['), *slash;
    char *path = strndup(name, bracket ? (size_t)(bracket - name) : strlen(name));
    char *section = strndup(bracket ? bracket + 1 : "", bracket ? strcspn(bracket + 1, "]") : 0);
    char *folder = NULL, *text = NULL;
    int code = RETEX_OK;
    if (path)
        slash = strrchr(path, '/'), folder = strndup(path, slash ? (size_t)(slash + 1 - path) : 0);
    if (!path || !section || !folder)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory");
    else if (options->depth == DEPTH_MAX)
        code = ini_fail(place, err, "%.200s: .ini files that include each other more than %d deep", path, DEPTH_MAX);
    else if (++options->nreads > READS_MAX)
        code = ini_fail(place, err, "more than %d .ini files in all", READS_MAX);
    else if (!(text = read_text(options, place, path, err)))
        code = RETEX_EIO;
    if (!code && !is_open(options, path) && options->files.count < INI_LIST_MAX) {
        options->files.items[options->files.count++] = path;
        path = NULL;
    }
    if (!code) {
        Reader reader = {options, {path ? path : options->files.items[options->files.count - 1], 0, folder, include},
                         section, 1,
                         0,       {section, NULL, 0}};
        options->depth++;
        code = read_lines(&reader, place, text, err);
        options->depth--;
    }
    free(text), free(path), free(section), free(folder);
    return code;
}

/* ---- the whole ---- */

int ini_is_file(const char *word)
{
    const char *bracket = strchr(word, '[');
    const size_t length = bracket ? (size_t)(bracket - word) : strlen(word);
    return length > 4 && !strncasecmp(word + length - 4, ".ini", 4) &&
           (!bracket || bracket[strlen(bracket) - 1] == ']');
}

int ini_read(IniOptions *options, const char *name, RetexError *err)
{
    return include(options, &command_line, name, err);
}

int ini_switch(IniOptions *options, const char *word, RetexError *err)
{
    return ini_set_switch(options, &command_line, word, err);
}
