/* The table of statements about a target's texture: how the value of each is read and written. Every mistake has one
 * message that names the option and says what would be right. */
#include "edit/statement.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/color_text.h>
#include <retex/nearest.h>

#include "edit/adjustment.h"
#include "edit/number.h"
#include "texture/pyramid.h"

#define OPTION "texture option "

static int write_pair(const double pair[2], double unsaid, char text[STATEMENT_TEXT_MAX])
{
    char first[RETEX_NUMBER_MAX], second[RETEX_NUMBER_MAX];
    snprintf(text, STATEMENT_TEXT_MAX, "%s,%s", retex_number_text(pair[0], first), retex_number_text(pair[1], second));
    return pair[0] != unsaid || pair[1] != unsaid;
}

/* ---- words ---- */

static int find_word(const char *const *words, int count, const char *word, size_t length)
{
    int i = 0;
    while (i < count && (strlen(words[i]) != length || strncasecmp(words[i], word, length) != 0))
        i++;
    return i < count ? i : -1;
}

static const char *const wrap_words[] = {"repeat", "mirror", "clamp", "black"};
static const char *const repeat_words[RETEX_REPEATS] = {"straight", "brick",  "half-drop", "mirror",
                                                        "herringbone", "basket", "hexagon"};

/* ---- the image ---- */

static void write_color(const float color[3], char text[STATEMENT_TEXT_MAX])
{
    char r[RETEX_NUMBER_MAX], g[RETEX_NUMBER_MAX], b[RETEX_NUMBER_MAX];
    snprintf(text, STATEMENT_TEXT_MAX, "rgb(%s,%s,%s)", retex_float_text(color[0], r), retex_float_text(color[1], g),
             retex_float_text(color[2], b));
}

static int parse_image(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    RetexError why;
    const int code = retex_color_parse(spec->color, value, &why);
    spec->constant = !code;
    if (code == RETEX_EPARSE)
        return retex_fail(err, code, "%s", why.message);
    if (!code)
        return code;
    if (strlen(value) >= sizeof spec->image)
        return retex_fail(err, RETEX_EPARSE, "texture for '%s': the image's name has at most %d bytes", spec->target,
                          (int)sizeof spec->image - 1);
    strcpy(spec->image, value);
    return RETEX_OK;
}

static int write_image(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    if (spec->constant)
        write_color(spec->color, text);
    else
        snprintf(text, STATEMENT_TEXT_MAX, "%s", spec->image);
    return spec->constant || spec->image[0];
}

/* ---- options ---- */

static int parse_scale(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    if (!retex_numbers_parse(spec->scale, 2, value))
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "scale='%s': expected one or two numbers, as in scale=2 or scale=2,1", value);
    if (spec->scale[0] == 0 || spec->scale[1] == 0)
        return retex_fail(err, RETEX_EPARSE, OPTION "scale='%s': a scale cannot be 0", value);
    return RETEX_OK;
}

static int write_scale(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    return write_pair(spec->scale, 1, text);
}

static int parse_rotate(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    const char *end;
    if (!retex_number_parse(value, &end, &spec->rotate) || *retex_skip_spaces(end))
        return retex_fail(err, RETEX_EPARSE, OPTION "rotate='%s': expected degrees, as in rotate=30", value);
    return RETEX_OK;
}

static int write_rotate(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    retex_number_text(spec->rotate, text);
    return spec->rotate != 0;
}

static int parse_offset(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    if (!retex_numbers_parse(spec->offset, 2, value))
        return retex_fail(err, RETEX_EPARSE, OPTION "offset='%s': expected one or two numbers, as in offset=0,0.5",
                          value);
    return RETEX_OK;
}

static int write_offset(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    return write_pair(spec->offset, 0, text);
}

static int parse_flip(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    const size_t length = strlen(value);
    spec->flip[0] = strpbrk(value, "uU") != NULL;
    spec->flip[1] = strpbrk(value, "vV") != NULL;
    if (length < 1 || strspn(value, "uvUV") != length || (size_t)(spec->flip[0] + spec->flip[1]) != length)
        return retex_fail(err, RETEX_EPARSE, OPTION "flip='%s': expected u, v or uv", value);
    return RETEX_OK;
}

static int write_flip(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    snprintf(text, STATEMENT_TEXT_MAX, "%s%s", spec->flip[0] ? "u" : "", spec->flip[1] ? "v" : "");
    return text[0] != '\0';
}

static int parse_wrap(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    const size_t first = strcspn(value, ",");
    const char *second = value[first] ? value + first + 1 : value;
    const int u = find_word(wrap_words, 4, value, first);
    const int v = find_word(wrap_words, 4, second, second == value ? first : strlen(second));
    if (u < 0 || v < 0)
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "wrap='%s': expected repeat, mirror, clamp or black, or two of them for u,v", value);
    spec->wrap[0] = (RetexWrap)u, spec->wrap[1] = (RetexWrap)v;
    return RETEX_OK;
}

static int write_wrap(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    const int both = spec->wrap[0] == spec->wrap[1];
    snprintf(text, STATEMENT_TEXT_MAX, both ? "%s" : "%s,%s", wrap_words[spec->wrap[0]], wrap_words[spec->wrap[1]]);
    return !both || spec->wrap[0] != RETEX_WRAP_REPEAT;
}

static int parse_repeat(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    const int found = find_word(repeat_words, RETEX_REPEATS, value, strlen(value));
    if (found < 0)
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "repeat='%s': expected straight, brick, half-drop, mirror, herringbone, basket or "
                                 "hexagon",
                          value);
    spec->repeat = (RetexRepeat)found;
    return RETEX_OK;
}

static int write_repeat(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    snprintf(text, STATEMENT_TEXT_MAX, "%s", repeat_words[spec->repeat]);
    return spec->repeat != RETEX_REPEAT_STRAIGHT;
}

static void set_metric(RetexTextureSpec *spec, int length, int metric)
{
    spec->metric = metric ? spec->metric | length : spec->metric & ~length;
}

static void write_lengths(const RetexTextureSpec *spec, int length, const double *values, int count,
                          char text[STATEMENT_TEXT_MAX])
{
    const char *unit = spec->metric & length ? "m" : "";
    char numbers[2][RETEX_NUMBER_MAX];
    retex_number_text(values[0], numbers[0]);
    if (count > 1)
        snprintf(text, STATEMENT_TEXT_MAX, "%s%s,%s%s", numbers[0], unit, retex_number_text(values[1], numbers[1]),
                 unit);
    else
        snprintf(text, STATEMENT_TEXT_MAX, "%s%s", numbers[0], unit);
}

/* One or two lengths; the image determines the second where it is missing. */
static int parse_width(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    int metric;
    if (!retex_lengths_parse(spec->width, 2, value, &metric) || !(spec->width[0] > 0) || !(spec->width[1] > 0))
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "width='%s': expected one or two lengths above 0, as in width=1.2 or width=60cm,9cm",
                          value);
    set_metric(spec, RETEX_METRIC_WIDTH, metric);
    if (!strchr(value, ','))
        spec->width[1] = 0;
    return RETEX_OK;
}

static int write_width(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    write_lengths(spec, RETEX_METRIC_WIDTH, spec->width, spec->width[1] > 0 ? 2 : 1, text);
    return spec->width[0] > 0;
}

static int parse_colorspace(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    if (!*value || strlen(value) >= sizeof spec->colorspace || strchr(value, ':')) /* which would end it in an option */
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "colorspace='%.80s': expected the name of a colour space, as in colorspace=sRGB",
                          value);
    strcpy(spec->colorspace, value);
    return RETEX_OK;
}

static int write_colorspace(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    snprintf(text, STATEMENT_TEXT_MAX, "%s", spec->colorspace);
    return text[0] != '\0';
}

/* Both would need the same light. */
static int check_one_map(const RetexTextureSpec *spec, int is_normal, RetexError *err)
{
    if (!spec->finish[0] || is_normal == (spec->normal != RETEX_NORMAL_NONE))
        return RETEX_OK;
    return retex_fail(err, RETEX_EPARSE, "texture options: finish= and normal= exclude each other");
}

static int parse_finish(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    if (check_one_map(spec, 0, err))
        return RETEX_EPARSE;
    if (!*value || strlen(value) >= sizeof spec->finish || strchr(value, ':')) /* which would end it in an option */
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "finish='%.80s': expected a picture without a colon in its name, as in "
                                 "finish=gloss.png, or none",
                          value);
    strcpy(spec->finish, value);
    return RETEX_OK;
}

static int write_finish(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    snprintf(text, STATEMENT_TEXT_MAX, "%s", spec->normal ? "" : spec->finish);
    return text[0] != '\0';
}

static const char *const normal_words[] = {[RETEX_NORMAL_GL] = "gl", [RETEX_NORMAL_DX] = "dx"};

/* A picture, and where its green points, if its name does not say it. */
static int parse_normal(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    const char *comma = strrchr(value, ',');
    size_t length = strlen(value);
    RetexNormalMap normal = RETEX_NORMAL_BY_NAME;
    if (check_one_map(spec, 1, err))
        return RETEX_EPARSE;
    for (int k = RETEX_NORMAL_GL; comma && k <= RETEX_NORMAL_DX; k++)
        if (strcasecmp(comma + 1, normal_words[k]) == 0)
            normal = (RetexNormalMap)k, length = (size_t)(comma - value);
    if (length == 0 || length >= sizeof spec->finish || strchr(value, ':')) /* which would end it in an option */
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "normal='%.80s': expected a picture without a colon in its name, as in "
                                 "normal=bricks_nor_gl.png or normal=bricks.png,dx, or none",
                          value);
    memset(spec->finish, 0, sizeof spec->finish); /* specs are compared byte by byte */
    memcpy(spec->finish, value, length);
    spec->normal = normal;
    return RETEX_OK;
}

static int write_normal(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    if (!spec->normal)
        return 0;
    const int is_said = spec->normal != RETEX_NORMAL_BY_NAME;
    snprintf(text, STATEMENT_TEXT_MAX, "%s%s%s", spec->finish, is_said ? "," : "",
             is_said ? normal_words[spec->normal] : "");
    return text[0] != '\0';
}

/* ---- laying ---- */

static int parse_grout(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    int metric;
    if (!retex_lengths_parse(&spec->grout, 1, value, &metric) || spec->grout < 0)
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "grout='%.80s': expected a length of 0 or more, as in grout=0.004 or grout=4mm",
                          value);
    set_metric(spec, RETEX_METRIC_GROUT, metric && spec->grout > 0);
    return RETEX_OK;
}

static int write_grout(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    write_lengths(spec, RETEX_METRIC_GROUT, &spec->grout, 1, text);
    return spec->grout > 0;
}

static int parse_grout_color(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    RetexError why = {0};
    return !retex_color_parse(spec->grout_color, value, &why)
               ? RETEX_OK
               : retex_fail(err, RETEX_EPARSE, OPTION "groutcolor='%.80s': expected a colour, as in groutcolor=#888",
                            value);
}

static int write_grout_color(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    const RetexTextureSpec plain = RETEX_TEXTURE_SPEC_INIT;
    write_color(spec->grout_color, text);
    return memcmp(spec->grout_color, plain.grout_color, sizeof plain.grout_color) != 0;
}

static const char *const vary_words[] = {"turn", "flip", "shift"};

/* Words, and a number that picks which repeat has what. */
static int parse_vary(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    int vary = 0, is_right = 1;
    unsigned seed = 0;
    for (const char *at = value; is_right; at += strcspn(at, ",") + 1) {
        const size_t length = strcspn(at, ",");
        const int word = find_word(vary_words, 3, at, length);
        if (word >= 0)
            vary |= 1 << word;
        else if (length >= 1 && length <= 9 && strspn(at, "0123456789") == length)
            seed = (unsigned)strtoul(at, NULL, 10);
        else
            is_right = 0;
        if (!at[length])
            break;
    }
    if (!is_right)
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "vary='%.80s': expected turn, flip, shift and a number of at most 9 digits, or some "
                                 "of them, as in vary=turn,flip,7",
                          value);
    spec->vary = vary;
    spec->vary_seed = seed;
    return RETEX_OK;
}

static int write_vary(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; k < 3; k++)
        if (spec->vary & 1 << k)
            used += (size_t)snprintf(text + used, STATEMENT_TEXT_MAX - used, "%s%s", used ? "," : "", vary_words[k]);
    if (spec->vary_seed)
        snprintf(text + used, STATEMENT_TEXT_MAX - used, "%s%u", used ? "," : "", spec->vary_seed);
    return text[0] != '\0';
}

/* A list of names: a colon would end it in an option. */
static int parse_tiles(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    enum { BYTES = sizeof spec->tiles[0] };
    char tiles[RETEX_TILES_MAX][BYTES] = {""};
    int count = 0, is_right = !strchr(value, ':');
    for (const char *at = value; is_right; at += strcspn(at, ",") + 1) {
        const size_t length = strcspn(at, ",");
        if (length < 1 || length >= BYTES || count == RETEX_TILES_MAX)
            is_right = 0;
        else
            memcpy(tiles[count++], at, length);
        if (!at[length])
            break;
    }
    if (!is_right)
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "tiles='%.80s': expected 1 to %d pictures without a colon or comma in their names, of "
                                 "at most %d bytes each, as in tiles=b.jpg,c.jpg",
                          value, RETEX_TILES_MAX, BYTES - 1);
    memcpy(spec->tiles, tiles, sizeof tiles);
    return RETEX_OK;
}

static int write_tiles(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; k < RETEX_TILES_MAX && spec->tiles[k][0]; k++)
        used += (size_t)snprintf(text + used, STATEMENT_TEXT_MAX - used, "%s%s", k ? "," : "", spec->tiles[k]);
    return text[0] != '\0';
}

static int parse_at(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    int metric;
    if (!strchr(value, ',') || !retex_lengths_parse(spec->at, 2, value, &metric))
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "at='%.80s': expected two numbers or lengths, as in at=1.2,0.4 or at=120cm,40cm",
                          value);
    spec->has_at = 1;
    set_metric(spec, RETEX_METRIC_AT, metric && (spec->at[0] != 0 || spec->at[1] != 0));
    return RETEX_OK;
}

static int write_at(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    write_lengths(spec, RETEX_METRIC_AT, spec->at, 2, text);
    return spec->has_at;
}

/* ---- the table ---- */

static const struct {
    const char *word;
    int (*parse)(RetexTextureSpec *spec, const char *value, RetexError *err);
    int (*write)(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX]);
} kinds[RETEX_STATEMENT_ADJUSTMENTS] = {
    {"", parse_image, write_image},
    {"scale", parse_scale, write_scale},
    {"rotate", parse_rotate, write_rotate},
    {"offset", parse_offset, write_offset},
    {"flip", parse_flip, write_flip},
    {"wrap", parse_wrap, write_wrap},
    {"repeat", parse_repeat, write_repeat},
    {"width", parse_width, write_width},
    {"colorspace", parse_colorspace, write_colorspace},
    {"finish", parse_finish, write_finish},
    {"normal", parse_normal, write_normal},
    {"grout", parse_grout, write_grout},
    {"groutcolor", parse_grout_color, write_grout_color},
    {"vary", parse_vary, write_vary},
    {"tiles", parse_tiles, write_tiles},
    {"at", parse_at, write_at},
};

int retex_statement_is_wrap(int kind)
{
    return kind < RETEX_STATEMENT_ADJUSTMENTS && kinds[kind].parse == parse_wrap;
}

static RetexAdjust adjustment_of(int kind)
{
    return (RetexAdjust)(kind - RETEX_STATEMENT_ADJUSTMENTS);
}

const char *retex_statement_word(int kind)
{
    return kind < RETEX_STATEMENT_ADJUSTMENTS ? kinds[kind].word : retex_adjustment_word(adjustment_of(kind));
}

int retex_statement_parse(RetexTextureSpec *spec, int kind, const char *value, RetexError *err)
{
    return kind < RETEX_STATEMENT_ADJUSTMENTS ? kinds[kind].parse(spec, value, err)
                                              : retex_adjustment_parse(spec, adjustment_of(kind), value, err);
}

int retex_statement_write(const RetexTextureSpec *spec, int kind, char text[STATEMENT_TEXT_MAX])
{
    return kind < RETEX_STATEMENT_ADJUSTMENTS
               ? kinds[kind].write(spec, text)
               : retex_adjustment_write(spec, adjustment_of(kind), text, STATEMENT_TEXT_MAX);
}

int retex_statement_layer(const char *key, const char **name)
{
    enum { LENGTH = 4 };
    *name = key;
    if (strncmp(key, "over", LENGTH) != 0)
        return 0;
    const int is_numbered = key[LENGTH] >= '2' && key[LENGTH] <= '0' + RETEX_LAYERS_MAX;
    if (key[LENGTH + is_numbered] != ':')
        return 0;
    *name = key + LENGTH + is_numbered + 1;
    return is_numbered ? key[LENGTH] - '0' : 1;
}

int retex_statement_parse_layer(RetexTextureSpec *spec, int layer, int kind, const char *value, RetexError *err)
{
    const RetexTextureSpec plain = RETEX_TEXTURE_SPEC_INIT;
    RetexTextureSpec own = RETEX_TEXTURE_SPEC_INIT;
    while (spec->nlayers < layer)
        spec->layers[spec->nlayers++] = plain.layers[0];
    retex_texture_layer_get(&own, spec, layer - 1);
    RetexError why = {0};
    const int code = retex_statement_parse(&own, kind, value, err);
    return code                                                      ? code
           : !retex_texture_layer_set(spec, layer - 1, &own, &why) ? RETEX_OK
                                                                     : retex_fail(err, RETEX_EPARSE, "%s", why.message);
}

int retex_statement_ordered(const RetexTextureSpec *spec, int index)
{
    const int adjustment = index - RETEX_STATEMENT_ADJUSTMENTS;
    return adjustment < 0                     ? index
           : adjustment < spec->nadjustments ? RETEX_STATEMENT_ADJUSTMENTS + (int)spec->adjustments[adjustment].kind
                                             : -1;
}

int retex_statement_option(const char *word, size_t length)
{
    for (int k = 1; k < RETEX_STATEMENTS; k++)
        if (strlen(retex_statement_word(k)) == length && memcmp(word, retex_statement_word(k), length) == 0)
            return k;
    return -1;
}

int retex_statement_unknown(const char *word, RetexError *err)
{
    char words[320] = "", meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {word, NULL, 0};
    for (int k = 1; k < RETEX_STATEMENTS; k++) {
        const size_t used = strlen(words);
        snprintf(words + used, sizeof words - used, "%s%s", k > 1 ? ", " : "", retex_statement_word(k));
        retex_nearest_try(&nearest, retex_statement_word(k));
    }
    return retex_fail(err, RETEX_EPARSE, "no texture option is called '%s'; there are %s%s", word, words,
                      retex_meant(nearest.best, meant));
}

/* Of a texture, and of each of its layers. */
static int check_units(const RetexTextureSpec *spec, RetexError *err)
{
    RetexTextureSpec layer = *spec;
    for (int k = -1; k < spec->nlayers; k++) {
        if (k >= 0)
            retex_texture_layer_get(&layer, spec, k);
        if (retex_texture_mixes_units(&layer))
            return retex_fail(err, RETEX_EPARSE,
                              "texture options: all lengths have a unit, as in width=60cm:grout=4mm, or none");
        if (layer.metric & RETEX_METRIC_AT && !(layer.width[0] > 0))
            return retex_fail(err, RETEX_EPARSE, "texture options: at= with lengths needs width=");
    }
    return RETEX_OK;
}

int retex_statement_check(const RetexTextureSpec *spec, RetexError *err)
{
    const int is_laid = spec->repeat == RETEX_REPEAT_BRICK || spec->repeat == RETEX_REPEAT_HALF_DROP ||
                        spec->repeat >= RETEX_REPEAT_HERRINGBONE,
              needs_width = spec->grout > 0 || spec->repeat >= RETEX_REPEAT_HERRINGBONE;
    const char *option = spec->grout > 0 ? "grout" : spec->vary ? "vary" : spec->tiles[0][0] ? "tiles" : NULL;
    char repeat[40];
    snprintf(repeat, sizeof repeat, "repeat=%s", repeat_words[spec->repeat]);
    option = is_laid ? repeat : option;
    if (option && (spec->wrap[0] != RETEX_WRAP_REPEAT || spec->wrap[1] != RETEX_WRAP_REPEAT))
        return retex_fail(err, RETEX_EPARSE, "texture options: %s needs wrap=repeat, the default, on both axes",
                          option);
    if (option && spec->repeat == RETEX_REPEAT_MIRROR)
        return retex_fail(err, RETEX_EPARSE, "texture options: %s cannot be used with repeat=mirror", option);
    if (needs_width && !(spec->width[0] > 0))
        return retex_fail(err, RETEX_EPARSE, "texture options: %s needs width=, the size of a repeat", option);
    return check_units(spec, err);
}
