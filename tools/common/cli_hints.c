/* What was probably meant by an unknown option or a surplus argument: see cli.h. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include <retex/nearest.h>

#include "common/cli.h"

/* Names by which other programs, and other tools of retex, know what a tool has or does. The first row that has the
 * name and fits the tool counts. */
typedef struct Hint {
    const char *names; /* long names and letters, between blanks */
    const char *own;   /* options, between blanks: the first that the tool has is meant; NULL: any tool */
    const char *text; /* what is meant in its place, as in "is TEXT meant?"; NULL: the option. With own NULL: the end of
                          the message; NULL: it is what the tool reads, which stands alone */
} Hint;

static const Hint hints[] = {
    {" samples sample num-samples n-samples samples-per-pixel aa passes ", "spp", NULL},
    {" width height W H w res resolution resize image-size dimensions ", "size", "--size WxH"},
    {" bounces max-bounces depth path-depth ray-depth trace-depth ", "max-depth", NULL},
    {" window crop-window cropwindow region border roi ", "crop", "--crop X,Y,W,H"},
    {" noise-threshold noise-level threshold ", "noise", NULL},
    {" aovs layers channels ", "aov", NULL},
    {" denoiser ", "denoise", NULL},
    {" out outfile out-file output-file output-image outfilename render-output output-dir outdir out-dir dest "
     "destination save write ",
     "output", NULL},
    {" i in input infile in-file input-file inputs scene set samples model sdl room folder ", NULL, NULL},
    {" t target targets ", "texture", "--texture NAME=IMAGE"},
    {" tex texture image map material replace swap ", "texture replace", NULL},
    {" texture texture-dir texture-folder images ", "textures", NULL},
    {" table csv variants batch ", "batch variants", NULL},
    {" start end from to range frame frame-start frame-end start-frame end-frame animation anim ", "frames",
     "--frames A-B"},
    {" j jobs cpus cores nproc nthreads num-threads workers ", "threads", NULL},
    {" mem memory memory-limit mem-limit max-mem ram ", "max-memory", NULL},
    {" timeout time time-limit ", "max-time", NULL},
    {" include-path include-dir library-path search-path L ", "include", NULL},
    {" define set-variable ", "declare", NULL},
    {" silent nologo ", "quiet", NULL},
    {" debug loglevel log-level ", "verbose", NULL},
    {" usage ? ", "help", NULL},
    {" n noop just-print ", "dry-run", NULL},
    {" k ignore-errors continue-on-error ", "keep-going", NULL},
    {" continue ", "resume", NULL},
    {" p ", "port", NULL},
    {" host bind address interface ", "listen", NULL},
    {" fail tolerance threshold epsilon hardfail ", "fail-abs", NULL},
    {" bits bit-depth bitdepth ", "depth", NULL},
    {" f y force overwrite clobber ", NULL, "a file that exists is replaced when the new one is complete"},
    {" format fmt type filetype file-type extension ", NULL, "the format follows the ending of the output's name"},
    {" t target targets ", NULL, "targets are chosen when retex-render renders"},
    {" spp size seed crop aov max-depth layout clusters orders plain include declare width height ", NULL,
     "retex-render decides this when it renders"},
    {" texture replace ", NULL, "retex-sample and retex-combine put textures on a set"},
    {" view display colorspace ", NULL, "retex-combine makes pictures for a display"},
};

/* Whether the word of `length` bytes is one of those between blanks. */
static int has_word(const char *words, const char *word, size_t length)
{
    for (const char *at = words; length && (at = strchr(at, ' ')) && *++at;)
        if (strncmp(at, word, length) == 0 && at[length] == ' ')
            return 1;
    return 0;
}

/* The first of these options that the tool has. */
static const CliOption *first_option(const Cli *cli, const char *names)
{
    const CliOption *option = NULL;
    for (size_t length; !option && *names; names += length + (names[length] == ' ')) {
        length = strcspn(names, " ");
        option = cli_find_option(cli, names, length, 0);
    }
    return option;
}

/* End with the hint for an option that other programs have, if there is one. */
static void tell_hint(const Cli *cli, const char *shown, const char *name)
{
    size_t length = strlen(name);
    if (cli_find_option(cli, name, length, 0)) /* with one dash */
        return;
    if (length > 1 && shown[1] != '-' && strspn(name + 1, "0123456789") == length - 1)
        length = 1; /* -j8 */
    for (const Hint *hint = hints; hint < hints + sizeof hints / sizeof *hints; hint++) {
        const CliOption *option = hint->own ? first_option(cli, hint->own) : NULL;
        if (!has_word(hint->names, name, length) || (hint->own && !option))
            continue;
        if (!option && !hint->text)
            cli_die(cli, "unknown option %s; what it reads is named without an option: %s %.*s", shown, cli->tool,
                    (int)strcspn(cli->usage, "\n"), cli->usage);
        if (!option)
            cli_die(cli, "unknown option %s; %s", shown, hint->text);
        cli_die(cli, "unknown option %s; is %s%s meant?", shown, hint->text ? "" : "--",
                hint->text ? hint->text : option->name);
    }
}

static const CliOption *nearest_option(const Cli *cli, const char *name)
{
    const CliOption *tables[] = {cli->options, cli_common_options};
    RetexNearest nearest = {name, NULL, 0};
    for (int t = 0; t < 2; t++)
        for (const CliOption *o = tables[t]; o && o->name; o++)
            retex_nearest_try(&nearest, o->name);
    return nearest.best ? cli_find_option(cli, nearest.best, strlen(nearest.best), 0) : NULL;
}

/* Hints cover long names with one dash and letters in the other case. */
void cli_unknown_option(const Cli *cli, const char *dashes, const char *text, int length)
{
    char name[RETEX_NEAREST_MAX + 1], shown[256];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "=:"), text);
    snprintf(shown, sizeof shown, "%s%.*s", dashes, length, text);
    tell_hint(cli, shown, name);
    int letter = name[0] && !name[1] ? isupper((unsigned char)name[0]) ? tolower((unsigned char)name[0])
                                                                       : toupper((unsigned char)name[0])
                                     : 0;
    const CliOption *option = letter ? cli_find_option(cli, NULL, 0, (char)letter) : nearest_option(cli, name);
    if (option && letter)
        cli_die(cli, "unknown option %s; is -%c meant?", shown, letter);
    if (option)
        cli_die(cli, "unknown option %s; is --%s meant?", shown, option->name);
    cli_die(cli, "unknown option %s; try --help", shown);
}

/* Whether -o was given or follows in argv. */
static int has_output(const Cli *cli)
{
    for (int i = cli->next; i < cli->argc; i++)
        if (strncmp(cli->argv[i], "-o", 2) == 0 || strncmp(cli->argv[i], "--output", 8) == 0)
            return 1;
    return cli->output != NULL;
}

const char *cli_forgotten(const Cli *cli, const char *word, char *text, size_t size)
{
    const char *textures[] = {"texture", "replace"};
    text[0] = '\0';
    for (int k = 0; k < 2 && strchr(word, '='); k++)
        if (cli_find_option(cli, textures[k], strlen(textures[k]), 0))
            snprintf(text, size, "; is --%s %s meant?", textures[k], word);
    if (strcmp(word, "-") == 0)
        return text;
    if (!text[0] && !strpbrk(word, "./") && cli_find_option(cli, NULL, 0, 't'))
        snprintf(text, size, "; is -t %s meant?", word);
    if (!text[0] && !has_output(cli))
        snprintf(text, size, "; is -o %s meant?", word);
    return text;
}

void cli_surplus(const Cli *cli, const char *problem)
{
    char forgotten[1024];
    if (*cli_forgotten(cli, cli->value, forgotten, sizeof forgotten))
        cli_die(cli, "%s%s", problem, forgotten);
    cli_die(cli, "%s; what is '%s'?", problem, cli->value);
}
