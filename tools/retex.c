/* retex: one name for all tools. `retex render …` is `retex-render …`, `retex help render` its man page: retex(1).
 *
 * A command is a program retex-NAME beside this one, or else in $PATH: which there are is not listed here, and what
 * each does it says itself. */
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/beside.h"
#include "common/cli.h"

#include <retex/nearest.h>
#include <retex/retex.h>

enum { COMMANDS_MAX = 64 };

typedef struct Commands {
    char names[COMMANDS_MAX][RETEX_NEAREST_MAX]; /* without retex-, in the order of a day's work */
    int count;
} Commands;

/* The order in which the list shows them; what is not here comes last, by name. */
static const char *const order[] = {"try",    "import", "render", "denoise", "sample", "combine", "pack",
                                    "info",   "diff",   "serve",  "studio"};
static const int norder = sizeof order / sizeof *order;

static Cli cli = {.tool = "retex"};
static char folder[PATH_MAX]; /* of this program, where the others stand */

static int rank_of(const char *name)
{
    int k = 0;
    while (k < norder && strcmp(order[k], name) != 0)
        k++;
    return k;
}

static int compare_commands(const void *a, const void *b)
{
    const int x = rank_of(a), y = rank_of(b);
    return x != y ? x - y : strcmp(a, b);
}

/* The programs retex-NAME beside this one. */
static void find_commands(Commands *commands)
{
    DIR *list = opendir(folder);
    commands->count = 0;
    for (struct dirent *entry; list && (entry = readdir(list));) {
        const char *name = entry->d_name + 6;
        struct stat info;
        if (strncmp(entry->d_name, "retex-", 6) != 0 || !*name || strlen(name) >= RETEX_NEAREST_MAX ||
            strchr(name, '.') || fstatat(dirfd(list), entry->d_name, &info, 0) || !S_ISREG(info.st_mode) ||
            !(info.st_mode & 0111) || commands->count == COMMANDS_MAX)
            continue;
        strcpy(commands->names[commands->count++], name);
    }
    if (list)
        closedir(list);
    qsort(commands->names, (size_t)commands->count, sizeof *commands->names, compare_commands);
}

/* Become retex-NAME with these arguments, the first of which is replaced; returns if there is no such program. */
static void become(const char *name, char **argv)
{
    char path[2 * PATH_MAX], *tool = path + strlen(folder) + 1;
    if (!*name || strchr(name, '/'))
        return;
    snprintf(path, sizeof path, "%s/retex-%s", folder, name);
    argv[0] = tool;
    execv(path, argv);
    if (errno == ENOENT)
        execvp(tool, argv);
    if (errno != ENOENT)
        cli_die(&cli, "%s: %s", path, strerror(errno));
}

/* The first sentence of what a tool says that it is for, without its period. */
static void read_about(const char *name, char *text, int size)
{
    char command[2 * PATH_MAX], *end;
    FILE *answer = NULL;
    text[0] = 0;
    snprintf(command, sizeof command, "'%s/retex-%s' --complete 2>/dev/null </dev/null", folder, name);
    if (!strchr(folder, '\'') && !strchr(name, '\''))
        answer = popen(command, "r");
    if (answer && !fgets(text, size, answer))
        text[0] = 0;
    if (answer)
        pclose(answer);
    text[strcspn(text, "\n")] = 0;
    if ((end = strstr(text, ". ")) || ((end = strrchr(text, '.')) && !end[1]))
        *end = 0;
    cli_plain(text);
}

/* For people, or as completions: a word, a tab, its description. */
static void print_commands(int as_completions)
{
    Commands commands;
    char about[512];
    find_commands(&commands);
    for (int k = 0; k < commands.count; k++) {
        read_about(commands.names[k], about, sizeof about);
        printf(as_completions ? "%s\t%s\n" : "  %-8s %s\n", commands.names[k], about);
    }
}

static int print_help(void)
{
    printf("Usage: retex COMMAND [ARGUMENT ...]\n"
           "       retex help [COMMAND]\n\n"
           "Change the textures of a rendered picture without rendering it again. The\ncommands are:\n\n");
    print_commands(0);
    printf("\nretex COMMAND is the program retex-COMMAND; --help after it lists its options,\n"
           "and retex help COMMAND shows its man page.\n\n"
           "  -h, --help                  print this help and exit\n"
           "  -V, --version               print the version and exit\n");
    return CLI_OK;
}

static _Noreturn void unknown_command(const char *name)
{
    Commands commands;
    char meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {name, NULL, 0};
    find_commands(&commands);
    for (int k = 0; k < commands.count; k++)
        retex_nearest_try(&nearest, commands.names[k]);
    retex_nearest_try(&nearest, "help");
    if (name[0] == '-')
        cli_die(&cli, "unknown option %s; options of a command follow its name, as in retex render --help", name);
    cli_die(&cli, "there is no command '%s'%s", name, nearest.best ? retex_meant(nearest.best, meant) : "; try --help");
}

/* Show a page of the manual that lies beside the programs, as installed or in the source's tree. */
static void show_page(const char *page)
{
    for (int section = 1; section < 9; section++)
        for (int place = 0; place < 3; place++) {
            char path[2 * PATH_MAX];
            if (place == 2)
                snprintf(path, sizeof path, "%s/../../man/%s.%d", folder, page, section);
            else
                snprintf(path, sizeof path, "%s/../share/man/man%d/%s.%d%s", folder, section, page, section,
                         place ? ".gz" : "");
            if (access(path, R_OK) == 0)
                execlp("man", "man", path, (char *)NULL);
        }
}

/* `retex help combine`: also of formats, as `retex help set`; without man, --help of the tool. */
static int help(const char *name)
{
    char page[64];
    if (!name)
        return print_help();
    if (strncmp(name, "retex-", 6) == 0)
        name += 6;
    snprintf(page, sizeof page, strcmp(name, "retex") == 0 ? "%s" : "retex-%s", name);
    if (!strchr(name, '/'))
        show_page(page);
    become(name, (char *[]){NULL, (char *)"--help", NULL});
    if (strcmp(name, "retex") == 0 || strcmp(name, "help") == 0)
        return print_help();
    unknown_command(name);
}

/* `--complete WORD…`, as cli_complete: of a command's arguments the tool knows more. */
static int complete(int argc, char **argv)
{
    const int of_help = argc > 3 && strcmp(argv[2], "help") == 0;
    if (argc > 3 && !of_help) {
        char *name = argv[2];
        argv[2] = (char *)"--complete";
        become(name, argv + 1);
        return CLI_OK;
    }
    if (argc == 3 && argv[2][0] == '-')
        printf("--help\tprint this help and exit\n--version\tprint the version and exit\n");
    else if (argc <= 4)
        print_commands(1);
    if (argc == 3 && argv[2][0] != '-')
        printf("help\tshow the man page of a command\n");
    return CLI_OK;
}

int main(int argc, char **argv)
{
    const char *word = argc > 1 ? argv[1] : "--help";
    beside_folder(folder);
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0)
        return cli_close(&cli, print_help());
    if (strcmp(word, "--version") == 0 || strcmp(word, "-V") == 0) {
        printf("retex %s\n", RETEX_VERSION);
        return cli_close(&cli, CLI_OK);
    }
    if (strcmp(word, "help") == 0 && argc > 3)
        cli_die(&cli, "help of one command at a time");
    if (strcmp(word, "help") == 0)
        return cli_close(&cli, help(argv[2]));
    if (strcmp(word, "--complete") == 0)
        return cli_close(&cli, complete(argc, argv));
    become(word, argv + 1);
    unknown_command(word);
}
