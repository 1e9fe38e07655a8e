/* See job_line.h. */
#include "job_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/output_folder.h"

static const struct {
    const char *name;
    int is_long;
} tools[] = {
    {"retex-import", 0}, {"retex-render", 1}, {"retex-denoise", 1}, {"retex-combine", 0},
    {"retex-pack", 0},   {"retex-info", 0},   {"retex-diff", 0},    {"retex-sample", 0},
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
    json_array_foreach (args, i, arg)
        if (strncmp(json_string_value(arg), "--list-", 7) == 0)
            return 0;
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
    char path[2 * PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", path, PATH_MAX - 1);
    path[length > 0 ? length : 0] = 0;
    char *slash = strrchr(path, '/');
    snprintf(slash ? slash + 1 : path, PATH_MAX, "%s", tool);
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

/* ---- outputs ---- */

/* The output that a word names, `-oFILE` or `--output=FILE`; or that the next one is: *is_next. NULL: none. What else a
 * tool may write is confined by the kernel: see child.h. */
static const char *output_of(const char *word, int *is_next)
{
    const char *letters = word[0] == '-' && word[1] != '-' ? word + 1 + strspn(word + 1, "qv") : "";
    *is_next = strcmp(word, "--output") == 0 || strcmp(letters, "o") == 0;
    if (*letters == 'o' && letters[1])
        return letters + 1;
    return strncmp(word, "--output=", 9) == 0 ? word + 9 : NULL;
}

static int check_output(const Model *model, const char *output, RetexError *err)
{
    char path[2 * PATH_MAX], real[PATH_MAX], written[PATH_MAX];
    int missing;
    if (strcmp(output, "-") == 0)
        return RETEX_OK;
    snprintf(path, sizeof path, *output == '/' ? "%.0s%s" : "%s/%s", model->folder, output);
    if (strlen(path) >= PATH_MAX || !realpath(model->written, written))
        return retex_fail(err, RETEX_EINVAL, "%s: this path is too long", output);
    int code = output_resolve(real, &missing, path, output, err);
    if (!code && !output_is_below(real, written))
        return retex_fail(err, RETEX_EINVAL, "%s: outputs must lie in %s", output, strrchr(model->written, '/') + 1);
    return code ? code : output_make_folders(real, err);
}

static int add_arguments(Line *line, const json_t *args, const ProgramLimits *limits, const Model *model,
                         RetexError *err)
{
    int is_output = 0, code = RETEX_OK;
    size_t bytes = 0;
    if (args && !json_is_array(args))
        return retex_fail(err, RETEX_EINVAL, "args: expected a list of texts");
    for (size_t i = 0; i < json_array_size(args) && !code; i++) {
        const char *word = json_string_value(json_array_get(args, i));
        if (!word || (bytes += strlen(word)) > LINE_BYTES)
            return retex_fail(err, RETEX_EINVAL, "args: expected a list of texts, of less than 1 MB in all");
        const char *output = is_output ? word : output_of(word, &is_output);
        if (output)
            is_output = 0;
        if (output && !limits->is_unsafe)
            code = check_output(model, output, err);
        if (!code)
            code = add(line, word, err);
    }
    return code;
}

int line_make(Line *line, const char *tool, const json_t *args, const ProgramLimits *limits, const Model *model,
              RetexError *err)
{
    *line = (Line){0};
    if (!tool || find_tool(tool) < 0)
        return retex_fail(err, RETEX_EINVAL, "%s is none of the tools that can be run here", tool ? tool : "this");
    int code = places_make_written(model, err);
    if (!code)
        code = add_program(line, tool, err);
    if (!code)
        code = add_limits(line, limits, err);
    if (!code)
        code = add_arguments(line, args, limits, model, err);
    if (code)
        line_free(line);
    return code;
}

int line_make_live(Line *line, const char *scene, const json_t *args, const ProgramLimits *limits, const Model *model,
                   RetexError *err)
{
    int code = line_make(line, "retex-render", args, limits, model, err);
    const char *const last[] = {"--live", "--", scene};
    for (int i = 0; i < 3 && !code; i++)
        code = add(line, last[i], err);
    if (code)
        line_free(line);
    return code;
}
