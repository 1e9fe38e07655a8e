/* Light distributions, from files of IES LM-63 of 1986, 1991, 1995, 2002 and 2019, photometric type C: lines of text,
 * the line TILT=, and after it numbers, with white space or commas between them. Intensities are taken as shares of the
 * greatest one, so lumens, multipliers, ballast factors and watts, and the luminaire's size, mean nothing here. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "light/ies.h"
#include "sdl/object/object.h"

#define END_OF_TEXT '\x1a' /* with which old programs close a file */

/* Each file is read once. */
struct IesFile {
    const char *path;
    const Ies *ies;
    struct IesFile *next;
};

typedef struct Reader {
    Sdl *sdl;
    const char *path, *at, *end; /* a NUL is at the end */
    int line;
} Reader;

/* ---- numbers ---- */

static int is_space(char c)
{
    return isspace((unsigned char)c) || c == ',';
}

static void skip_space(Reader *r)
{
    for (; r->at < r->end && is_space(*r->at); r->at++)
        r->line += *r->at == '\n';
}

static double number(Reader *r)
{
    char *after;
    skip_space(r);
    sdl_step(r->sdl, 1);
    if (r->at == r->end)
        sdl_error(r->sdl, "`%s` ends early, in line %d", r->path, r->line);
    const double x = strtod(r->at, &after);
    if (isalpha((unsigned char)*r->at) || after == r->at || (after < r->end && !is_space(*after)) || !isfinite(x))
        sdl_error(r->sdl, "`%s`, line %d: a number is expected", r->path, r->line);
    r->at = after;
    return x;
}

static void skip_numbers(Reader *r, int n)
{
    for (int k = 0; k < n; k++)
        number(r);
}

/* How many numbers follow, each of which takes two bytes at least. */
static int count(Reader *r, const char *of, int least)
{
    const double n = number(r), most = (double)(r->end - r->at) / 2;
    if (!(n >= least && n <= most && n == floor(n)))
        sdl_error(r->sdl, "`%s`, line %d: it cannot have %g %s", r->path, r->line, n, of);
    return (int)n;
}

static double *angles(Reader *r, const char *of, int n, double most)
{
    double *list = sdl_alloc(r->sdl, ((size_t)n + 1) * sizeof *list); /* one more: see symmetry */
    for (int k = 0; k < n; k++) {
        list[k] = number(r);
        if (list[k] < 0 || list[k] > most)
            sdl_error(r->sdl, "`%s`, line %d: a %s angle of %g degrees", r->path, r->line, of, list[k]);
        if (k > 0 && !(list[k] > list[k - 1]))
            sdl_error(r->sdl, "`%s`, line %d: the %s angles do not rise", r->path, r->line, of);
    }
    return list;
}

/* ---- the parts of a file ---- */

/* Whether the rest of a line is that word, in any case. */
static int is_word(const char *text, const char *word)
{
    const size_t length = strlen(word);
    return strncasecmp(text, word, length) == 0 && (text[length] == 0 || is_space(text[length]));
}

/* How an odd lamp's light depends on how it is tilted. */
static void skip_tilt(Reader *r)
{
    number(r); /* how the lamp lies in the luminaire */
    const int n = count(r, "tilt angles", 0);
    int differs = 0;
    skip_numbers(r, n);
    for (int k = 0; k < n; k++)
        differs |= number(r) != 1;
    if (differs)
        sdl_warn(r->sdl, "`%s`: what the lamp loses where it is tilted (TILT=INCLUDE) is left out", r->path);
}

/* All up to the numbers of the photometry. */
static void skip_head(Reader *r)
{
    while (r->at < r->end && strncasecmp(r->at, "TILT=", 5) != 0) {
        const char *next = memchr(r->at, '\n', (size_t)(r->end - r->at));
        r->at = next ? next + 1 : r->end;
        r->line++;
    }
    if (r->at == r->end)
        sdl_error(r->sdl, "`%s` is no light distribution of IES LM-63: it has no line TILT=", r->path);
    r->at += 5;
    const int includes = is_word(r->at, "INCLUDE");
    if (!includes && !is_word(r->at, "NONE"))
        sdl_error(r->sdl, "`%s`, line %d: TILT= with a file is not supported, only NONE and INCLUDE", r->path, r->line);
    r->at += strlen(includes ? "INCLUDE" : "NONE");
    if (includes)
        skip_tilt(r);
}

/* What the horizontal angles say of the others. Files without symmetry may leave out 360, which is 0 again. */
static void set_symmetry(const Reader *r, Ies *ies, double *angle)
{
    const int n = ies->ncolumns = ies->nhorizontal;
    const double first = angle[0], last = angle[n - 1];
    if (n == 1)
        ies->symmetry = IES_AXIAL;
    else if (first == 0 && last == 90)
        ies->symmetry = IES_QUARTERS;
    else if (first == 0 && last == 180)
        ies->symmetry = IES_HALVES;
    else if (first == 90 && last == 270)
        ies->symmetry = IES_ACROSS;
    else if (first == 0 && last > 180)
        ies->symmetry = IES_NONE;
    else
        sdl_error(r->sdl,
                  "`%s`, line %d: horizontal angles from %g to %g are not supported, only one, 0 to 90, 0 to "
                  "180, 90 to 270, and 0 to 360",
                  r->path, r->line, first, last);
    ies->horizontal = angle;
    if (ies->symmetry == IES_NONE && last < 360)
        angle[ies->nhorizontal++] = 360;
}

static void read_shares(Reader *r, Ies *ies)
{
    const int rows = ies->nvertical;
    const size_t n = (size_t)ies->ncolumns * (size_t)rows;
    double *candela = sdl_alloc(r->sdl, n * sizeof *candela), most = 0;
    float *shares = sdl_alloc(r->sdl, n * sizeof *shares);
    int first = rows, last = 0;
    for (size_t k = 0; k < n; k++) {
        candela[k] = number(r);
        if (candela[k] < 0)
            sdl_error(r->sdl, "`%s`, line %d: a luminous intensity is below 0", r->path, r->line);
        if (candela[k] > 0)
            first = (int)fmin(first, (double)(k % (size_t)rows)), last = (int)fmax(last, (double)(k % (size_t)rows));
        most = fmax(most, candela[k]);
    }
    if (!(most > 0))
        sdl_error(r->sdl, "`%s`: all luminous intensities are 0", r->path);
    for (size_t k = 0; k < n; k++)
        shares[k] = (float)(candela[k] / most);
    ies->shares = shares;
    ies->first_lit = ies->vertical[first > 0 ? first - 1 : 0];
    ies->last_lit = ies->vertical[last < rows - 1 ? last + 1 : last];
}

static const Ies *read_ies(Reader *r)
{
    Ies *ies = sdl_alloc(r->sdl, sizeof *ies);
    skip_head(r);
    skip_numbers(r, 3); /* lamps, lumens of each, multiplier of intensities */
    ies->nvertical = count(r, "vertical angles", 2);
    ies->nhorizontal = count(r, "horizontal angles", 1);
    const double type = number(r), left = (double)(r->end - r->at) / 2;
    if (type != 1)
        sdl_error(r->sdl, "`%s`, line %d: photometry of type %s is not supported, only type C", r->path, r->line,
                  type == 2   ? "B"
                  : type == 3 ? "A"
                              : "?");
    if ((double)ies->nvertical * ies->nhorizontal > left)
        sdl_error(r->sdl, "`%s` is too short for luminous intensities at %d by %d angles", r->path, ies->nvertical,
                  ies->nhorizontal);
    skip_numbers(r, 7); /* units, width, length, height, ballast factor, another or the file's origin, watts */
    ies->vertical = angles(r, "vertical", ies->nvertical, 180);
    set_symmetry(r, ies, angles(r, "horizontal", ies->nhorizontal, 360));
    read_shares(r, ies);
    skip_space(r);
    if (r->at < r->end && *r->at != END_OF_TEXT)
        sdl_warn(r->sdl, "`%s`, line %d: what follows the last luminous intensity is left out", r->path, r->line);
    return ies;
}

const Ies *parse_ies(Sdl *sdl)
{
    ObjectState *objects = objects_of(sdl);
    const char *name = sdl_string(sdl), *path = sdl_find_file(sdl, name);
    size_t size;
    if (!path)
        path = sdl_need_file(sdl, "light distribution", name);
    for (const struct IesFile *known = objects->ies_files; known; known = known->next)
        if (strcmp(known->path, path) == 0)
            return known->ies;
    const char *text = sdl_read_file(sdl, path, &size);
    Reader reader = {.sdl = sdl, .path = path, .at = text, .end = text + size, .line = 1};
    struct IesFile *file = sdl_alloc(sdl, sizeof *file);
    *file = (struct IesFile){path, read_ies(&reader), objects->ies_files};
    objects->ies_files = file;
    return file->ies;
}
