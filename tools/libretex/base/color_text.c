/* See retex/color_text.h. */
#include <retex/color_text.h>

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/color.h>

/* The named colours of CSS Color Module Level 4, as #rrggbb. The player has them from here. */
/* clang-format off */
static const struct {
    const char *name;
    unsigned code;
} named[] = {
    {"aliceblue", 0xf0f8ff}, {"antiquewhite", 0xfaebd7}, {"aqua", 0x00ffff}, {"aquamarine", 0x7fffd4},
    {"azure", 0xf0ffff}, {"beige", 0xf5f5dc}, {"bisque", 0xffe4c4}, {"black", 0x000000}, {"blanchedalmond", 0xffebcd},
    {"blue", 0x0000ff}, {"blueviolet", 0x8a2be2}, {"brown", 0xa52a2a}, {"burlywood", 0xdeb887},
    {"cadetblue", 0x5f9ea0}, {"chartreuse", 0x7fff00}, {"chocolate", 0xd2691e}, {"coral", 0xff7f50},
    {"cornflowerblue", 0x6495ed}, {"cornsilk", 0xfff8dc}, {"crimson", 0xdc143c}, {"cyan", 0x00ffff},
    {"darkblue", 0x00008b}, {"darkcyan", 0x008b8b}, {"darkgoldenrod", 0xb8860b}, {"darkgray", 0xa9a9a9},
    {"darkgreen", 0x006400}, {"darkgrey", 0xa9a9a9}, {"darkkhaki", 0xbdb76b}, {"darkmagenta", 0x8b008b},
    {"darkolivegreen", 0x556b2f}, {"darkorange", 0xff8c00}, {"darkorchid", 0x9932cc}, {"darkred", 0x8b0000},
    {"darksalmon", 0xe9967a}, {"darkseagreen", 0x8fbc8f}, {"darkslateblue", 0x483d8b}, {"darkslategray", 0x2f4f4f},
    {"darkslategrey", 0x2f4f4f}, {"darkturquoise", 0x00ced1}, {"darkviolet", 0x9400d3}, {"deeppink", 0xff1493},
    {"deepskyblue", 0x00bfff}, {"dimgray", 0x696969}, {"dimgrey", 0x696969}, {"dodgerblue", 0x1e90ff},
    {"firebrick", 0xb22222}, {"floralwhite", 0xfffaf0}, {"forestgreen", 0x228b22}, {"fuchsia", 0xff00ff},
    {"gainsboro", 0xdcdcdc}, {"ghostwhite", 0xf8f8ff}, {"gold", 0xffd700}, {"goldenrod", 0xdaa520},
    {"gray", 0x808080}, {"green", 0x008000}, {"greenyellow", 0xadff2f}, {"grey", 0x808080}, {"honeydew", 0xf0fff0},
    {"hotpink", 0xff69b4}, {"indianred", 0xcd5c5c}, {"indigo", 0x4b0082}, {"ivory", 0xfffff0}, {"khaki", 0xf0e68c},
    {"lavender", 0xe6e6fa}, {"lavenderblush", 0xfff0f5}, {"lawngreen", 0x7cfc00}, {"lemonchiffon", 0xfffacd},
    {"lightblue", 0xadd8e6}, {"lightcoral", 0xf08080}, {"lightcyan", 0xe0ffff}, {"lightgoldenrodyellow", 0xfafad2},
    {"lightgray", 0xd3d3d3}, {"lightgreen", 0x90ee90}, {"lightgrey", 0xd3d3d3}, {"lightpink", 0xffb6c1},
    {"lightsalmon", 0xffa07a}, {"lightseagreen", 0x20b2aa}, {"lightskyblue", 0x87cefa}, {"lightslategray", 0x778899},
    {"lightslategrey", 0x778899}, {"lightsteelblue", 0xb0c4de}, {"lightyellow", 0xffffe0}, {"lime", 0x00ff00},
    {"limegreen", 0x32cd32}, {"linen", 0xfaf0e6}, {"magenta", 0xff00ff}, {"maroon", 0x800000},
    {"mediumaquamarine", 0x66cdaa}, {"mediumblue", 0x0000cd}, {"mediumorchid", 0xba55d3}, {"mediumpurple", 0x9370db},
    {"mediumseagreen", 0x3cb371}, {"mediumslateblue", 0x7b68ee}, {"mediumspringgreen", 0x00fa9a},
    {"mediumturquoise", 0x48d1cc}, {"mediumvioletred", 0xc71585}, {"midnightblue", 0x191970}, {"mintcream", 0xf5fffa},
    {"mistyrose", 0xffe4e1}, {"moccasin", 0xffe4b5}, {"navajowhite", 0xffdead}, {"navy", 0x000080},
    {"oldlace", 0xfdf5e6}, {"olive", 0x808000}, {"olivedrab", 0x6b8e23}, {"orange", 0xffa500},
    {"orangered", 0xff4500}, {"orchid", 0xda70d6}, {"palegoldenrod", 0xeee8aa}, {"palegreen", 0x98fb98},
    {"paleturquoise", 0xafeeee}, {"palevioletred", 0xdb7093}, {"papayawhip", 0xffefd5}, {"peachpuff", 0xffdab9},
    {"peru", 0xcd853f}, {"pink", 0xffc0cb}, {"plum", 0xdda0dd}, {"powderblue", 0xb0e0e6}, {"purple", 0x800080},
    {"rebeccapurple", 0x663399}, {"red", 0xff0000}, {"rosybrown", 0xbc8f8f}, {"royalblue", 0x4169e1},
    {"saddlebrown", 0x8b4513}, {"salmon", 0xfa8072}, {"sandybrown", 0xf4a460}, {"seagreen", 0x2e8b57},
    {"seashell", 0xfff5ee}, {"sienna", 0xa0522d}, {"silver", 0xc0c0c0}, {"skyblue", 0x87ceeb},
    {"slateblue", 0x6a5acd}, {"slategray", 0x708090}, {"slategrey", 0x708090}, {"snow", 0xfffafa},
    {"springgreen", 0x00ff7f}, {"steelblue", 0x4682b4}, {"tan", 0xd2b48c}, {"teal", 0x008080}, {"thistle", 0xd8bfd8},
    {"tomato", 0xff6347}, {"turquoise", 0x40e0d0}, {"violet", 0xee82ee}, {"wheat", 0xf5deb3}, {"white", 0xffffff},
    {"whitesmoke", 0xf5f5f5}, {"yellow", 0xffff00}, {"yellowgreen", 0x9acd32},
};
/* clang-format on */

static const char *skip_blanks(const char *text)
{
    while (isspace((unsigned char)*text))
        text++;
    return text;
}

static void decode(float color[3], unsigned code)
{
    for (int c = 0; c < 3; c++)
        color[c] = (float)retex_srgb_decode((code >> (16 - 8 * c) & 255) / 255.0);
}

/* Of `text`, what stands from `at` on in the parentheses of rgb() or srgb(). */
static int parse_numbers(float color[3], const char *text, const char *at, int encoded, RetexError *err)
{
    const char *const form = encoded ? "srgb(r,g,b) with three numbers from 0 to 1" : "rgb(r,g,b) with three numbers";
    for (int c = 0; c < 3; c++) {
        char *end;
        const double value = strtod(at, &end);
        if (end == at || !(value >= 0) || value > (encoded ? 1 : 1e30))
            return retex_fail(err, RETEX_EPARSE, "colour '%s': expected %s%s", text, form,
                              encoded ? "" : " of 0 or more");
        color[c] = (float)(encoded ? retex_srgb_decode(value) : value);
        at = skip_blanks(end);
        if (*at++ != (c < 2 ? ',' : ')'))
            return retex_fail(err, RETEX_EPARSE, "colour '%s': expected %s", text, form);
    }
    return *skip_blanks(at) ? retex_fail(err, RETEX_EPARSE, "colour '%s': nothing may follow %s", text,
                                         encoded ? "srgb(r,g,b)" : "rgb(r,g,b)")
                            : RETEX_OK;
}

/* `length` characters behind a `#`. */
static int parse_digits(float color[3], const char *text, const char *digits, size_t length, RetexError *err)
{
    unsigned code = 0;
    if ((length != 3 && length != 6) || strspn(digits, "0123456789abcdefABCDEF") < length)
        return retex_fail(err, RETEX_EPARSE, "colour '%s': expected #rgb or #rrggbb with hexadecimal digits", text);
    for (size_t i = 0; i < length; i++) {
        const char c = digits[i];
        const unsigned digit = isdigit((unsigned char)c) ? (unsigned)(c - '0') : ((unsigned)c & 7) + 9;
        code = length == 3 ? code << 8 | digit * 17 : code << 4 | digit;
    }
    decode(color, code);
    return RETEX_OK;
}

int retex_color_parse(float color[3], const char *text, RetexError *err)
{
    const char *const word = skip_blanks(text), *at;
    size_t length = strlen(word);
    while (length && isspace((unsigned char)word[length - 1]))
        length--;
    for (int encoded = 0; encoded < 2; encoded++)
        if (strncasecmp(word, "srgb" + !encoded, 3 + (size_t)encoded) == 0 &&
            *(at = skip_blanks(word + 3 + encoded)) == '(')
            return parse_numbers(color, text, at + 1, encoded, err);
    if (*word == '#' && !strpbrk(word, "./"))
        return parse_digits(color, text, word + 1, length - 1, err);
    for (size_t i = 0; i < sizeof named / sizeof *named; i++)
        if (strlen(named[i].name) == length && strncasecmp(named[i].name, word, length) == 0) {
            decode(color, named[i].code);
            return RETEX_OK;
        }
    return retex_fail(err, RETEX_ENOTFOUND, "no colour is written '%s'", text);
}

const char *retex_color_meant(const char *name, char text[RETEX_MEANT_SIZE])
{
    RetexNearest nearest = {name, NULL, 0};
    for (size_t i = 0; i < sizeof named / sizeof *named && !strpbrk(name, "./"); i++)
        retex_nearest_try(&nearest, named[i].name);
    return retex_meant(nearest.best, text);
}
