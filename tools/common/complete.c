/* Completion: `retex-NAME --complete WORD…` prints what could stand in place of the last word, which may be empty.
 * The scripts in completions/ call it, so that shells know the options of the very tool that is called. Each line is a
 * word, a tab and its description, or asks the shell for names of files:
 *     :files <tab> PREFIX <tab> ENDINGS      files that end in one of these ("exr retex"); none: all files
 *     :folders <tab> PREFIX
 * where PREFIX, as "--batch=" or "Floor=", is what stands before the name in the word. Words are not yet filtered by
 * what the user has typed. Without WORD, prints what the tool is for. Prints nothing where there is nothing to say:
 * mistakes in the line are for the tool itself to tell.
 *
 * What an option's argument can be follows from its name in the option's table: `a|b` in small letters are its values,
 * LIST those after "of: " in its help, DIR and FOLDER folders, FILE.x and SET files, NAME=IMAGE and NAME[=IDENT…]
 * targets. So it is with positional arguments, by the tool's usage. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/cli.h"

#include <retex/retex.h>

/* Listing the targets of a scene may take so long, unless the environment says another limit. */
#define SCENE_SECONDS "1"

/* The words before the one to complete, as far as they matter. */
typedef struct Line {
    Cli *cli;
    const char *word;         /* to complete */
    const CliOption *pending; /* the option whose argument it is, or NULL */
    int only_positional;      /* `--` stands before it */
    int npositional;
    const char *first; /* the first positional argument, or NULL */
} Line;

/* Whether an argument's name is a list of values, as in "0|2|3". */
static int lists_values(const char *argument)
{
    return strspn(argument, "abcdefghijklmnopqrstuvwxyz0123456789-|") == strlen(argument);
}

/* A name from a file can be put on a command line as it is, but for blanks: no shell would obey it. */
static int is_harmless(const char *name)
{
    for (const char *c = name; *c; c++)
        if ((unsigned char)*c < 128 && !isalnum((unsigned char)*c) && !strchr(" _-.+%@,/", *c))
            return 0;
    return *name != '-' && *name != ' ' && *name != 0;
}

/* Print the words of a list that is separated by `separator`, after `before`. */
static void print_list(const char *before, const char *list, char separator)
{
    while (*list) {
        const int length = (int)strcspn(list, (char[]){separator, 0});
        if (length)
            printf("%s%.*s\t\n", before, length, list);
        list += length;
        list += strspn(list, (char[]){separator, ' ', 0});
    }
}

/* The targets of the set on the command line. Pipes are left to the tool. */
static void print_set_targets(const char *path)
{
    RetexSet *set = NULL;
    struct stat info;
    if (stat(path, &info) || !S_ISREG(info.st_mode) || retex_set_open(path, &set, 1, NULL))
        return;
    const RetexTarget *target;
    for (int t = 0; set && (target = retex_set_target(set, t)); t++)
        if (is_harmless(target->name))
            printf("%s=\t%.1f %% of the picture\n", target->name, 100 * target->share);
    retex_set_close(&set);
}

/* Start this tool again to list the targets of a scene; its standard output, or NULL. */
static FILE *list_targets(const char *scene, pid_t *child)
{
    int ends[2];
    if (pipe(ends))
        return NULL;
    *child = fork();
    if (*child == 0) {
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]);
        close(ends[1]);
        setenv("RETEX_MAX_TIME", SCENE_SECONDS, 0);
        close(STDERR_FILENO); /* the terminal is the shell's */
        execl("/proc/self/exe", "retex-render", "-q", "--list-targets", "--", scene, (char *)NULL);
        _exit(CLI_FAIL);
    }
    close(ends[1]);
    if (*child > 0)
        return fdopen(ends[0], "r");
    close(ends[0]);
    return NULL;
}

/* The identifiers of a scene that can be targets, if it is read quickly: lines of --list-targets. */
static void print_scene_targets(const char *scene, const char *after)
{
    char text[512], name[256], share[32];
    struct stat info;
    pid_t child;
    if (!cli_ends_with(scene, ".pov") || stat(scene, &info) || !S_ISREG(info.st_mode))
        return;
    FILE *answer = list_targets(scene, &child);
    while (answer && fgets(text, sizeof text, answer))
        if (sscanf(text, " %31[0-9.]%% %255[^\t\n]", share, name) == 2 && is_harmless(name) && !strchr(name, '='))
            printf("%s%s\t%s %% of the picture\n", name, after, share);
    if (answer) {
        fclose(answer);
        waitpid(child, NULL, 0);
    }
}

static void print_targets(const Line *line, const char *after)
{
    if (line->first && cli_find_option(line->cli, "list-targets", 12, 0))
        print_scene_targets(line->first, after);
    else if (line->first)
        print_set_targets(line->first);
}

/* What a name such as SET, FILE.csv or FOLDER stands for. `before` stands before it in the word. Of alternatives,
 * SCENE.pov|FILE.ini, all endings count. */
static void print_kind(const char *name, size_t length, const char *before)
{
    char endings[64] = "";
    if (length >= 3 && (strncmp(name, "DIR", 3) == 0 || strncmp(name, "FOLDER", 6) == 0)) {
        printf(":folders\t%s\n", before);
        return;
    }
    if (length == 3 && strncmp(name, "SET", 3) == 0)
        strcpy(endings, "exr retex");
    else if (length == 7 && strncmp(name, "SAMPLES", 7) == 0)
        strcpy(endings, "exr");
    for (size_t k = 0; k < length; k++)
        if (name[k] == '.') {
            const int ending = (int)strcspn(name + k + 1, "|]");
            const size_t used = strlen(endings);
            snprintf(endings + used, sizeof endings - used, "%s%.*s", used ? " " : "", ending, name + k + 1);
        }
    printf(":files\t%s\t%s\n", before, endings);
}

/* The argument of an option. `before` is what the word has before it, as in --layout=; `typed` what follows. */
static void print_argument(const Line *line, const CliOption *option, const char *before, const char *typed)
{
    const char *argument = option->argument + (*option->argument == '=');
    char head[4096];
    if (lists_values(argument)) {
        print_list(before, argument, '|');
    } else if (strcmp(argument, "LIST") == 0 && strstr(option->help, "of: ")) {
        const char *last = strrchr(typed, ',');
        snprintf(head, sizeof head, "%s%.*s", before, last ? (int)(last + 1 - typed) : 0, typed);
        print_list(head, strstr(option->help, "of: ") + 4, ',');
    } else if (strcmp(argument, "NAME=IMAGE") == 0) {
        const char *image = strchr(typed, '=');
        snprintf(head, sizeof head, "%s%.*s", before, image ? (int)(image + 1 - typed) : 0, typed);
        if (image)
            print_kind("FILE", 4, head);
        else if (!*before)
            print_targets(line, "=");
    } else if (strncmp(argument, "NAME[=IDENT", 11) == 0 && !*before) {
        print_targets(line, "");
    } else if (strncmp(argument, "FILE", 4) == 0 || strcmp(argument, "SET") == 0 || strcmp(argument, "DIR") == 0 ||
               strcmp(argument, "FOLDER") == 0) {
        print_kind(argument, strlen(argument), before);
    }
}

/* --texture:scale=2:wr: the modifiers that can follow the last colon, and the words of one that has a list of them. */
static void print_modifiers(const char *word)
{
    const char *typed = strrchr(word, ':') + 1, *value = strchr(typed, '=');
    for (const char *opt = CLI_TEXTURE_OPTS; *opt; opt += strcspn(opt, " "), opt += strspn(opt, " ")) {
        const size_t length = strcspn(opt, "="), end = strcspn(opt, " ") - (opt[strcspn(opt, " ")] ? 1 : 0);
        char values[128], head[4096];
        snprintf(values, sizeof values, "%.*s", (int)(end - length - 1), opt + length + 1);
        if (!value) {
            printf("%.*s%.*s=\t%s\n", (int)(typed - word), word, (int)length, opt, values);
        } else if ((size_t)(value - typed) == length && strncmp(typed, opt, length) == 0 && lists_values(values)) {
            snprintf(head, sizeof head, "%.*s", (int)(value + 1 - word), word);
            print_list(head, values, '|');
        }
    }
}

static void print_options(const Line *line)
{
    const CliOption *tables[] = {line->cli->options, cli_common_options};
    for (int t = 0; t < 2; t++)
        for (const CliOption *o = tables[t]; o && o->name; o++) {
            printf("--%s\t%s\n", o->name, o->help);
            if (o->letter && !line->word[1])
                printf("-%c\t%s\n", o->letter, o->help);
        }
}

/* A word that begins with a dash. */
static void print_option_word(const Line *line)
{
    const char *word = line->word;
    const size_t length = word[1] == '-' ? strcspn(word + 2, "=:") : 0;
    const CliOption *option = length    ? cli_find_option(line->cli, word + 2, length, 0)
                              : word[1] ? cli_find_option(line->cli, NULL, 0, word[1])
                                        : NULL;
    const char after = length ? word[2 + length] : 0;
    char before[256];
    if (option && option->modifiers && after == ':') {
        print_modifiers(word);
    } else if (option && option->argument && after == '=') {
        snprintf(before, sizeof before, "--%s=", option->name);
        print_argument(line, option, before, word + 3 + length);
    } else if (!length && option && option->argument && word[2]) {
        print_argument(line, option, (char[]){'-', word[1], 0}, word + 2);
    } else if ((word[1] == '-' && !after) || !word[1]) {
        print_options(line);
    }
}

/* Positional arguments stand first in the tool's usage: "SET [SAMPLES] [--texture …", "[options] A B [-o FILE]". */
static void print_positional(const Line *line)
{
    int number = 0;
    for (const char *word = line->cli->usage; *word && *word != '\n';
         word += strcspn(word, " "), word += *word == ' ') {
        const char *name = word + (*word == '[');
        const size_t length = strcspn(name, " ]\n");
        if (*name == '-')
            return;
        if (isupper((unsigned char)*name) && number++ == line->npositional) {
            print_kind(name, length, "");
            return;
        }
    }
}

/* Go over the words before the last one, as cli_next would. */
static void read_words(Line *line, int count, char **words)
{
    for (int k = 0; k < count; k++) {
        const char *word = words[k];
        const CliOption *option = NULL;
        if (line->pending) {
            line->pending = NULL;
        } else if (line->only_positional || word[0] != '-' || !word[1]) {
            line->first = line->npositional++ ? line->first : word;
        } else if (strcmp(word, "--") == 0) {
            line->only_positional = 1;
        } else if (word[1] == '-') {
            option = strchr(word, '=') ? NULL : cli_find_option(line->cli, word + 2, strcspn(word + 2, ":"), 0);
        } else {
            for (const char *c = word + 1; *c; c++) {
                option = cli_find_option(line->cli, NULL, 0, *c);
                if (option && option->argument && c[1])
                    option = NULL, c += strlen(c) - 1; /* the rest is the argument */
            }
        }
        if (option && option->argument && *option->argument != '=')
            line->pending = option;
    }
}

void cli_complete(Cli *cli)
{
    Line line = {.cli = cli};
    if (cli->argc < 3) {
        printf("%s\n", cli->about);
        exit(cli_close(cli, CLI_OK));
    }
    line.word = cli->argv[cli->argc - 1];
    read_words(&line, cli->argc - 3, cli->argv + 2);
    if (line.pending)
        print_argument(&line, line.pending, "", line.word);
    else if (line.word[0] == '-' && !line.only_positional)
        print_option_word(&line);
    else
        print_positional(&line);
    exit(cli_close(cli, CLI_OK));
}
