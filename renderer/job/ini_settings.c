/* The options of .ini files and switches: one row each. */
#include <limits.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <retex/access.h>
#include <retex/nearest.h>
#include "job/ini_settings.h"
#include "job/job.h"

typedef struct Setting Setting;

/* An option. */
typedef struct Row {
    const char *keyword, *letters; /* letters: of the switch, or NULL */
    int (*set)(const Setting *setting);
    size_t field;     /* of IniOptions, for the functions that set one */
    double low, high; /* of numbers */
} Row;

/* An option that is set. */
struct Setting {
    IniOptions *options;
    const IniPlace *place;
    const char *keyword, *value;
    RetexError *err;
    const Row *row; /* NULL for names and what has no meaning here */
    void *field;
};

int ini_fail(const IniPlace *place, RetexError *err, const char *fmt, ...)
{
    char text[sizeof err->message];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    return retex_fail_at(err, RETEX_EPARSE, place->file, place->line, 0, "%s", text);
}

/* ---- values ---- */

static int set_number(const Setting *s)
{
    char *end;
    const double number = strtod(s->value, &end);
    if (end == s->value || *end || !(number >= s->row->low && number <= s->row->high))
        return ini_fail(s->place, s->err, "%s: expected a number from %g to %g, not '%.200s'", s->keyword, s->row->low,
                        s->row->high, s->value);
    *(double *)s->field = number;
    return RETEX_OK;
}

static int read_whole(const Setting *s, long *number)
{
    char *end;
    *number = strtol(s->value, &end, 10);
    if (end == s->value || *end || *number < (long)s->row->low || *number > (long)s->row->high)
        return ini_fail(s->place, s->err, "%s: expected a whole number from %.0f to %.0f, not '%.200s'", s->keyword,
                        s->row->low, s->row->high, s->value);
    return RETEX_OK;
}

static int set_int(const Setting *s)
{
    long number;
    const int code = read_whole(s, &number);
    *(int *)s->field = code ? 0 : (int)number;
    return code;
}

static int set_seed(const Setting *s)
{
    long number;
    const int code = read_whole(s, &number);
    s->options->seed = code ? -1 : number;
    return code;
}

static int set_flag(const Setting *s)
{
    static const char *const words[2][4] = {{"off", "no", "false", "0"}, {"on", "yes", "true", "1"}};
    for (int on = 0; on < 2; on++)
        for (int k = 0; k < 4; k++)
            if (!strcasecmp(s->value, words[on][k])) {
                *(int *)s->field = on;
                return RETEX_OK;
            }
    return ini_fail(s->place, s->err, "%s: expected on or off, not '%.200s'", s->keyword, s->value);
}

static int set_text(const Setting *s, const char *text, char **field)
{
    char *copy = strdup(text);
    if (!copy)
        return retex_fail(s->err, RETEX_ENOMEM, "out of memory");
    free(*field);
    *field = copy;
    return RETEX_OK;
}

static int add_text(const Setting *s, const char *text, IniList *list)
{
    if (list->count == INI_LIST_MAX)
        return ini_fail(s->place, s->err, "more than %d of %s", INI_LIST_MAX, s->keyword);
    list->items[list->count] = NULL;
    const int code = set_text(s, text, &list->items[list->count]);
    list->count += !code;
    return code;
}

/* The path of a file or folder that an .ini file names. */
static int find_path(const Setting *s, const char *name, char path[PATH_MAX])
{
    char root[PATH_MAX];
    const char *folder = s->place->folder, *roots[] = {root};
    const RetexAccess access = {.size = sizeof access, .safe = 1, .roots = roots, .nroots = 1};
    if (snprintf(path, PATH_MAX, "%s%s", name[0] == '/' ? "" : folder, name) >= PATH_MAX)
        return ini_fail(s->place, s->err, "%s: the name is too long", s->keyword);
    if (!s->options->safe || !s->place->file[0])
        return RETEX_OK;
    const RetexAccessResult result =
        realpath(*folder ? folder : ".", root) ? retex_access_check(&access, folder, name) : RETEX_ACCESS_OUTSIDE;
    if (result == RETEX_ACCESS_OUTSIDE)
        return ini_fail(s->place, s->err, "%s: %.200s is outside the folder of the .ini file (--safe)", s->keyword,
                        name);
    return RETEX_OK;
}

/* ---- what options do ---- */

static int set_scene(const Setting *s)
{
    char path[PATH_MAX], name[PATH_MAX];
    const char *slash = strrchr(s->value, '/');
    if (!*s->value)
        return ini_fail(s->place, s->err, "%s: the name is empty", s->keyword);
    snprintf(name, sizeof name, "%s%s", s->value, strchr(slash ? slash : s->value, '.') ? "" : ".pov");
    const int code = find_path(s, name, path);
    return code ? code : set_text(s, path, &s->options->scene);
}

static int set_output(const Setting *s)
{
    if (s->options->safe && s->place->file[0])
        return ini_fail(s->place, s->err, "%s: an .ini file names no output (--safe): give -o", s->keyword);
    return set_text(s, s->value, &s->options->output);
}

static int set_output_type(const Setting *s)
{
    s->options->output_type = s->value[0];
    return RETEX_OK;
}

static int set_declare(const Setting *s)
{
    RetexError err;
    if (job_check_declare(s->value, &err))
        return ini_fail(s->place, s->err, "%s: %s", s->keyword, err.message);
    return add_text(s, s->value, &s->options->declares);
}

static int set_folder(const Setting *s)
{
    char path[PATH_MAX];
    const int code = find_path(s, s->value, path);
    return code || !*s->value ? code : add_text(s, path, &s->options->folders);
}

static int include(const Setting *s)
{
    return ini_set_name(s->options, s->place, s->value, s->err);
}

static void say(const Setting *s, int level, const char *what)
{
    char text[1200];
    if (!s->options->message)
        return;
    if (s->place->file[0])
        snprintf(text, sizeof text, "%.512s:%d: %s%s %s", s->place->file, s->place->line, level ? "warning: " : "",
                 s->keyword, what);
    else
        snprintf(text, sizeof text, "%s%s %s", level ? "warning: " : "", s->keyword, what);
    s->options->message(s->options->message_context, level, text);
}

static int ignore(const Setting *s)
{
    say(s, 0, "has no meaning here");
    return RETEX_OK;
}

static int ignore_command(const Setting *s)
{
    if (*s->value)
        say(s, 1, "is not run");
    return RETEX_OK;
}

static int refuse_fields(const Setting *s)
{
    int on = 0;
    Setting flag = *s;
    flag.field = &on;
    const int code = set_flag(&flag);
    if (!code && on)
        say(s, 1, "is not supported: whole frames are rendered");
    return code;
}

#define FIELD(name) offsetof(IniOptions, name)
#define SIZES 1, 1 << 24
#define PARTS 0, 1 << 24
#define FRAMES 0, 999999999
#define CLOCKS -1e30, 1e30

/* clang-format off */
static const Row rows[] = { /* of switches that begin alike, the longest first */
    {"Initial_Frame", "KFI", set_int, FIELD(animation.first_frame), FRAMES},
    {"Final_Frame", "KFF", set_int, FIELD(animation.last_frame), FRAMES},
    {"Initial_Clock", "KI", set_number, FIELD(animation.first_clock), CLOCKS},
    {"Final_Clock", "KF", set_number, FIELD(animation.last_clock), CLOCKS},
    {"Cyclic_Animation", "KC", set_flag, FIELD(animation.cyclic), 0, 0},
    {"Clock", "K", set_number, FIELD(clock), CLOCKS},
    {"Subset_Start_Frame", "SF", set_number, FIELD(subset[0]), FRAMES},
    {"Subset_End_Frame", "EF", set_number, FIELD(subset[1]), FRAMES},
    {"Frame_Step", "STP", set_int, FIELD(step), 1, 999999999},
    {"Field_Render", "UF", refuse_fields, 0, 0, 0},
    {"Width", "W", set_int, FIELD(width), SIZES},
    {"Height", "H", set_int, FIELD(height), SIZES},
    {"Start_Column", "SC", set_number, FIELD(window[0]), PARTS},
    {"End_Column", "EC", set_number, FIELD(window[1]), PARTS},
    {"Start_Row", "SR", set_number, FIELD(window[2]), PARTS},
    {"End_Row", "ER", set_number, FIELD(window[3]), PARTS},
    {"Input_File_Name", "I", set_scene, 0, 0, 0},
    {"Output_File_Name", "O", set_output, 0, 0, 0},
    {"Output_File_Type", "F", set_output_type, 0, 0, 0},
    {"Declare", NULL, set_declare, 0, 0, 0},
    {"Library_Path", "L", set_folder, 0, 0, 0},
    {"Include_Ini", NULL, include, 0, 0, 0},
    {"Stochastic_Seed", "SS", set_seed, 0, 0, 4294967295.0},
    {"Work_Threads", "WT", set_int, FIELD(threads), 1, 256},
    {"Continue_Trace", "C", set_flag, FIELD(resume), 0, 0},
    {"Pre_Scene_Command", NULL, ignore_command, 0, 0, 0},
    {"Pre_Frame_Command", NULL, ignore_command, 0, 0, 0},
    {"Post_Scene_Command", NULL, ignore_command, 0, 0, 0},
    {"Post_Frame_Command", NULL, ignore_command, 0, 0, 0},
    {"User_Abort_Command", NULL, ignore_command, 0, 0, 0},
    {"Fatal_Error_Command", NULL, ignore_command, 0, 0, 0},
};
/* clang-format on */

/* Keywords that have no meaning here. */
/* clang-format off */
static const char *const ignored[] = {
    "Pre_Scene_Return", "Pre_Frame_Return", "Post_Scene_Return", "Post_Frame_Return", "User_Abort_Return",
    "Fatal_Error_Return", "Test_Abort", "Test_Abort_Count", "Pause_When_Done", "Verbose", "Display", "Video_Mode",
    "Palette", "Display_Gamma", "Preview_Start_Size", "Preview_End_Size", "Render_Block_Size", "Render_Block_Step",
    "Render_Pattern", "Max_Image_Buffer_Memory", "High_Reproducibility", "Output_To_File", "Output_Alpha",
    "Bits_Per_Color", "Bits_Per_Colour", "Compression", "Grayscale_Output", "File_Gamma", "Dither", "Dithering",
    "Dither_Method", "Buffer_Output", "Buffer_Size", "Append_File", "Create_Ini", "Create_Histogram", "Histogram_Name",
    "Histogram_Type", "Histogram_Grid_Size", "Include_Header", "Version", "Split_Unions", "Remove_Bounds", "Bounding",
    "Bounding_Method", "Bounding_Threshold", "BSP_MaxDepth", "BSP_ISectCost", "BSP_BaseAccessCost",
    "BSP_ChildAccessCost", "BSP_MissChance", "Light_Buffer", "Vista_Buffer", "Draw_Vistas", "Quality", "Radiosity",
    "Radiosity_File_Name", "Radiosity_From_File", "Radiosity_To_File", "Radiosity_Vain_Pretrace", "Antialias",
    "Antialias_Depth", "Antialias_Gamma", "Antialias_Threshold", "Sampling_Method", "Jitter", "Jitter_Amount",
    "All_Console", "All_File", "Debug_Console", "Debug_File", "Fatal_Console", "Fatal_File", "Render_Console",
    "Render_File", "Statistic_Console", "Statistic_File", "Warning_Console", "Warning_File", "Warning_Level",
    "Odd_Field", "Clockless_Animation", "Real_Time_Raytracing"};
/* clang-format on */
static const char *const ignored_switches[] = {"A",  "B", "D", "F", "G",  "HI", "HN", "HS", "HT", "J", "M",
                                               "NR", "P", "Q", "R", "SP", "SU", "T",  "U",  "V",  "X"};

enum { NROWS = sizeof rows / sizeof *rows, NIGNORED = sizeof ignored / sizeof *ignored };

static int unknown_keyword(const Setting *s)
{
    char meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {s->keyword, NULL, 0};
    for (int k = 0; k < NROWS; k++)
        retex_nearest_try(&nearest, rows[k].keyword);
    for (int k = 0; k < NIGNORED; k++)
        retex_nearest_try(&nearest, ignored[k]);
    return ini_fail(s->place, s->err, "POV-Ray has no option `%.100s`%s", s->keyword, retex_meant(nearest.best, meant));
}

static int set_row(Setting setting, const Row *row)
{
    setting.row = row;
    setting.field = (char *)setting.options + row->field;
    return row->set(&setting);
}

int ini_set(IniOptions *options, const IniPlace *place, const char *keyword, const char *value, RetexError *err)
{
    const Setting setting = {options, place, keyword, value, err, NULL, NULL};
    for (int k = 0; k < NROWS; k++)
        if (!strcasecmp(keyword, rows[k].keyword))
            return set_row(setting, &rows[k]);
    for (int k = 0; k < NIGNORED; k++)
        if (!strcasecmp(keyword, ignored[k]))
            return ignore(&setting);
    return unknown_keyword(&setting);
}

static int is_flag(const Row *row)
{
    return row->set == set_flag || row->set == refuse_fields;
}

int ini_set_switch(IniOptions *options, const IniPlace *place, const char *word, RetexError *err)
{
    char name[32];
    snprintf(name, sizeof name, "%s", word);
    Setting setting = {options, place, name, "", err, NULL, NULL};
    const Row *row = NULL; /* with the most letters */
    size_t most = 0;
    for (int k = 0; k < NROWS; k++) {
        const size_t length = rows[k].letters ? strlen(rows[k].letters) : 0;
        if (length > most && !strncasecmp(word + 1, rows[k].letters, length) &&
            (!is_flag(&rows[k]) || !word[1 + length]))
            row = &rows[k], most = length;
    }
    if (row) {
        name[1 + most] = '\0';
        setting.value = !is_flag(row) ? word + 1 + most : word[0] == '+' ? "on" : "off";
        return set_row(setting, row);
    }
    for (size_t k = 0; k < sizeof ignored_switches / sizeof *ignored_switches; k++)
        if (!strncasecmp(word + 1, ignored_switches[k], strlen(ignored_switches[k])))
            return ignore(&setting);
    return ini_fail(place, err, "POV-Ray has no switch `%.100s`", word);
}

int ini_set_name(IniOptions *options, const IniPlace *place, const char *name, RetexError *err)
{
    const Setting setting = {options, place, "the file", name, err, NULL, NULL};
    const size_t length = strlen(name);
    char path[PATH_MAX], file[PATH_MAX];
    if (length > 4 && !strcasecmp(name + length - 4, ".pov"))
        return set_scene(&setting);
    const size_t base = strcspn(name, "[");
    const char *ending = base > 4 && !strncasecmp(name + base - 4, ".ini", 4) ? "" : ".ini";
    snprintf(file, sizeof file, "%.*s%s", (int)base, name, ending);
    int code = find_path(&setting, file, path);
    if (code)
        return code;
    if (snprintf(file, sizeof file, "%s%s", path, name + base) >= (int)sizeof file)
        return ini_fail(place, err, "the name is too long: %.100s…", name);
    return place->include(options, place, file, err);
}

/* ---- the whole ---- */

char *ini_output_name(const IniOptions *options)
{
    static const char *const endings[][2] = {{"Bb", ".bmp"}, {"Ee", ".exr"}, {"Hh", ".hdr"},
                                             {"Jj", ".jpg"}, {"Pp", ".ppm"}, {"TtCc", ".tga"}};
    if (!options->output)
        return NULL;
    const size_t length = strlen(options->output);
    const char *slash = strrchr(options->output, '/'), *dot = strrchr(slash ? slash : options->output, '.');
    const int base = dot ? (int)(dot - options->output) : (int)length;
    const char *ending = dot ? dot : ".png";
    for (size_t k = 0; !dot && options->output_type && k < sizeof endings / sizeof *endings; k++)
        if (strchr(endings[k][0], options->output_type))
            ending = endings[k][1];
    char *name = malloc(2 * length + 32), *out = name;
    if (!name)
        return NULL;
    const int frames = options->animation.last_frame >= 0;
    for (int k = 0; k < base; k++) {
        *out++ = options->output[k];
        if (frames && options->output[k] == '%')
            *out++ = '%';
    }
    if (frames)
        out += sprintf(out, "%%0%dd", snprintf(NULL, 0, "%d", options->animation.last_frame));
    strcpy(out, ending);
    return name;
}

static int subset_frame(const Animation *a, double value, int otherwise)
{
    if (value <= 0)
        return otherwise;
    if (value >= 1)
        return (int)value;
    const int frame = (int)(value * (a->last_frame + a->cyclic - a->first_frame + 1));
    return frame < a->first_frame ? a->first_frame : frame;
}

void ini_frames(const IniOptions *options, int *first, int *last)
{
    const Animation *a = &options->animation;
    *first = subset_frame(a, options->subset[0], a->first_frame);
    *last = subset_frame(a, options->subset[1], a->last_frame);
}

static void close_list(IniList *list)
{
    for (int k = 0; k < list->count; k++)
        free(list->items[k]);
    list->count = 0;
}

void ini_close(IniOptions *options)
{
    free(options->scene), free(options->output);
    options->scene = options->output = NULL;
    close_list(&options->declares), close_list(&options->folders), close_list(&options->files);
}
