/* See job_line.h. */
#include "job_line.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/beneath.h"
#include "common/beside.h"

typedef enum OptionKind { OPTION_FLAG, OPTION_VALUE, OPTION_OUTPUT } OptionKind;

typedef struct Option {
    const char *word; /* as it must be written; the value is the next word */
    OptionKind kind;
    int has_modifiers; /* 1: `:KEY=VALUE` may follow the word */
} Option;

static const Option import_options[] = {
    {"--camera", OPTION_VALUE, 0},
    {"--variant", OPTION_VALUE, 0},
    {"--unit", OPTION_VALUE, 0},
    {"--up", OPTION_VALUE, 0},
    {"--lights", OPTION_VALUE, 0},
    {"--sky", OPTION_VALUE, 0},
    {"--partial", OPTION_FLAG, 0},
    {"--force", OPTION_FLAG, 0},
    {"--list-variants", OPTION_FLAG, 0},
    {"-o", OPTION_OUTPUT, 0},
    {0},
};
static const Option render_options[] = {
    {"-t", OPTION_VALUE, 0},       {"-l", OPTION_VALUE, 0},          {"--finish", OPTION_VALUE, 0},
    {"--camera", OPTION_VALUE, 0}, {"--size", OPTION_VALUE, 0},      {"--crop", OPTION_VALUE, 0},
    {"--spp", OPTION_VALUE, 0},    {"--noise", OPTION_VALUE, 0},     {"--denoise", OPTION_FLAG, 0},
    {"--plain", OPTION_FLAG, 0},   {"--resume", OPTION_FLAG, 0},     {"--progress", OPTION_VALUE, 0},
    {"--stats", OPTION_OUTPUT, 0}, {"--list-lamps", OPTION_FLAG, 0}, {"--list-finishes", OPTION_FLAG, 0},
    {"-q", OPTION_FLAG, 0},        {"-o", OPTION_OUTPUT, 0},         {0},
};
static const Option combine_options[] = {
    {"--texture", OPTION_VALUE, 1},
    {"--light", OPTION_VALUE, 0},
    {"--finish", OPTION_VALUE, 0},
    {"--exposure", OPTION_VALUE, 0},
    {"--auto-exposure", OPTION_FLAG, 0},
    {"--white-balance", OPTION_VALUE, 0},
    {"--view", OPTION_VALUE, 0},
    {"--size", OPTION_VALUE, 0},
    {"--batch", OPTION_VALUE, 0},
    {"--batch-root", OPTION_OUTPUT, 0},
    {"--mkdir", OPTION_FLAG, 0},
    {"--keep-going", OPTION_FLAG, 0},
    {"-q", OPTION_FLAG, 0},
    {"-o", OPTION_OUTPUT, 0},
    {0},
};
static const Option pack_options[] = {
    {"--preset", OPTION_VALUE, 0}, {"--web-smaller", OPTION_VALUE, 0}, {"--web", OPTION_OUTPUT, 0},
    {"-q", OPTION_FLAG, 0},        {"-o", OPTION_OUTPUT, 0},           {0},
};

static const struct {
    const char *name;
    const Option *options;
    int is_long;
} tools[] = {
    {"retex-import", import_options, 0},
    {"retex-render", render_options, 1},
    {"retex-combine", combine_options, 0},
    {"retex-pack", pack_options, 0},
};

static int find_tool(const char *name)
{
    int k = (int)(sizeof tools / sizeof *tools) - 1;
    while (k >= 0 && strcmp(tools[k].name, name) != 0)
        k--;
    return k;
}

int line_is_long(const char *tool, const json_t *args)
{
    const int k = find_tool(tool);
    const json_t *arg;
    size_t i;
    json_array_foreach(args, i, arg) if (strncmp(json_string_value(arg), "--list-", 7) == 0) return 0;
    return k >= 0 && tools[k].is_long;
}

void line_free(Line *line)
{
    for (int i = 0; i < line->count; i++)
        free(line->words[i]);
    free(line->words);
    *line = (Line){0};
}

static int add(Line *line, const char *word, RetexError *err)
{
    if (!line->words)
        line->words = calloc(LINE_WORDS + 1, sizeof *line->words);
    if (line->words && line->count == LINE_WORDS)
        return retex_fail(err, RETEX_EINVAL, "a job has at most %d words", LINE_WORDS);
    if (!line->words || !(line->words[line->count] = strdup(word)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory");
    line->count++;
    return RETEX_OK;
}

/* Programs stand beside this one. */
static int add_program(Line *line, const char *tool, RetexError *err)
{
    char path[PATH_MAX];
    beside_program(path, tool);
    return add(line, path, err);
}

/* Safe access has limits of its own, of which that of time is made for strangers: a render may take long. */
static int add_limits(Line *line, const ProgramLimits *limits, RetexError *err)
{
    char memory[32];
    snprintf(memory, sizeof memory, "%lluM", (unsigned long long)(limits->memory >> 20));
    const char *const words[] = {"--safe", "--max-time", "10000000", "--max-memory", memory};
    int code = RETEX_OK;
    for (size_t i = 0; i < sizeof words / sizeof *words - (limits->memory ? 0 : 2) && !limits->is_unsafe && !code; i++)
        code = add(line, words[i], err);
    return code;
}

/* ---- what a window may ask for ---- */

/* Whether a path is relative, leads nowhere else, and can be shown in one line. */
static int is_plain(const char *path)
{
    for (const char *c = path; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127)
            return 0;
    for (const char *part = path; part; part = strchr(part, '/'), part = part ? part + 1 : NULL) {
        const size_t length = strcspn(part, "/");
        if (length == 0 || strncmp(part, "..", length) == 0) /* `.` too */
            return 0;
    }
    return 1;
}

/* An output lies below the folder that is written to; the folders that it lies in are made. */
static int check_output(const Model *model, const char *output, RetexError *err)
{
    const char *written = strrchr(model->written, '/') + 1, *last;
    const size_t length = strlen(written);
    if (strcmp(output, "-") == 0)
        return RETEX_OK;
    if (!is_plain(output) || strncmp(output, written, length) != 0 || output[length] != '/')
        return retex_fail(err, RETEX_EINVAL, "%s: outputs must lie in %s", output, written);
    const int folder = beneath_open_parent(model->top, output + length + 1, 1, &last);
    if (folder < 0)
        return retex_fail(err, RETEX_EINVAL, "%s: its folder cannot be made: %s", output, strerror(errno));
    close(folder);
    return RETEX_OK;
}

/* Tools follow links, as a shell's user wants it. A link in this folder comes from an archive: through it they would
 * write elsewhere. */
static int check_links(const Model *model, RetexError *err)
{
    char found[PATH_MAX];
    const char *written = strrchr(model->written, '/') + 1;
    const int is_found = beneath_find_link(model->top, found);
    if (is_found > 0)
        return retex_fail(err, RETEX_EACCESS, "%s/%s is a link: nothing is written while there is one; remove it",
                          written, found);
    return is_found ? retex_fail(err, RETEX_EIO, "cannot look through %s: %s", written, strerror(errno)) : RETEX_OK;
}

static const Option *find_option(const Option *options, const char *word)
{
    for (; options->word; options++) {
        const size_t length = strlen(options->word);
        if (strncmp(options->word, word, length) == 0 &&
            (!word[length] || (options->has_modifiers && word[length] == ':')))
            return options;
    }
    return NULL;
}

static const char *text_at(const json_t *args, size_t at)
{
    return json_string_value(json_array_get(args, at));
}

/* Add the option at a place of the arguments, which goes on behind it. */
static int add_option(Line *line, int tool, const json_t *args, size_t *at, const Model *model, RetexError *err)
{
    const char *word = text_at(args, (*at)++);
    const Option *option = find_option(tools[tool].options, word);
    if (!option)
        return retex_fail(err, RETEX_EINVAL, "%s: %s cannot be used here", tools[tool].name, word);
    int code = add(line, word, err);
    if (code || option->kind == OPTION_FLAG)
        return code;
    const char *value = *at < json_array_size(args) ? text_at(args, (*at)++) : NULL;
    if (!value)
        return retex_fail(err, RETEX_EINVAL, "%s needs a value", word);
    if (option->kind == OPTION_OUTPUT)
        code = check_output(model, value, err);
    return code ? code : add(line, value, err);
}

static int add_arguments(Line *line, int tool, const json_t *args, const Model *model, RetexError *err)
{
    int are_names = 0, code = RETEX_OK;
    size_t bytes = 0;
    if (args && !json_is_array(args))
        return retex_fail(err, RETEX_EINVAL, "args: expected a list of texts");
    for (size_t i = 0; i < json_array_size(args); i++)
        if (!text_at(args, i) || (bytes += strlen(text_at(args, i))) > LINE_BYTES)
            return retex_fail(err, RETEX_EINVAL, "args: expected a list of texts, of less than 1 MB in all");
    for (size_t at = 0; at < json_array_size(args) && !code;) {
        const char *word = text_at(args, at);
        const int is_end = !are_names && strcmp(word, "--") == 0;
        if (!are_names && !is_end) {
            code = add_option(line, tool, args, &at, model, err);
            continue;
        }
        if (are_names && !is_plain(word))
            return retex_fail(err, RETEX_EINVAL, "%s: expected a name below the model's folder", word);
        code = add(line, word, err);
        are_names = 1;
        at++;
    }
    return code;
}

int line_make(Line *line, const char *tool, const json_t *args, const ProgramLimits *limits, const Model *model,
              RetexError *err)
{
    const int k = tool ? find_tool(tool) : -1;
    *line = (Line){0};
    if (k < 0)
        return retex_fail(err, RETEX_EINVAL, "%s is none of the tools that can be run here", tool ? tool : "this");
    if (!model)
        return retex_fail(err, RETEX_EINVAL, "no model is open");
    int code = add_program(line, tool, err);
    if (!code)
        code = add_limits(line, limits, err);
    if (!code)
        code = add_arguments(line, k, args, model, err);
    if (!code)
        code = check_links(model, err);
    if (code)
        line_free(line);
    return code;
}

int line_make_live(Line *line, const char *scene, const json_t *args, const ProgramLimits *limits, const Model *model,
                   RetexError *err)
{
    int code = line_make(line, "retex-render", args, limits, model, err);
    const char *const last[] = {"--live", "--", scene};
    for (int i = 0; i < line->count && !code; i++)
        if (strcmp(line->words[i], "--") == 0)
            code = retex_fail(err, RETEX_EINVAL, "args: expected options alone");
    if (!code && !is_plain(scene))
        code = retex_fail(err, RETEX_EINVAL, "%s: expected a scene below the model's folder", scene);
    for (int i = 0; i < 3 && !code; i++)
        code = add(line, last[i], err);
    if (code)
        line_free(line);
    return code;
}
