/* Colours: `rgb <…>` and its variants, `color NAME`, and the old form `red 1 green 0.5`. */
#include <string.h>
#include <retex/color.h>
#include "sdl/lang/internal.h"

/* A colour keyword: the number of components that follow it, and whether they are sRGB-encoded. */
typedef struct Form {
    const char *name;
    int count;    /* number of components */
    int transmit; /* 1 if the fourth component is transmit */
    int srgb;
} Form;
static const Form forms[] = {{"rgb", 3, 0, 0},  {"rgbf", 4, 0, 0},  {"rgbt", 4, 1, 0},  {"rgbft", 5, 0, 0},
                             {"srgb", 3, 0, 1}, {"srgbf", 4, 0, 1}, {"srgbt", 4, 1, 1}, {"srgbft", 5, 0, 1}};
static const char *const channels[] = {"red", "green", "blue", "filter", "transmit"};

/* 1 if a colour can start with this word. */
static int color_word(const char *text)
{
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        if (strcmp(text, forms[i].name) == 0)
            return 1;
    for (int i = 0; i < 5; i++)
        if (strcmp(text, channels[i]) == 0)
            return 1;
    return strcmp(text, "color") == 0 || strcmp(text, "colour") == 0 || strcmp(text, "alpha") == 0;
}

int sdl_is_color_start(Sdl *sdl)
{
    const Token *token = sdl_peek(sdl);
    if (token->kind == TOKEN_WORD)
        return color_word(token->text);
    return token->kind == TOKEN_IDENT && token->value->kind == VALUE_VECTOR;
}

/* Colour from a plain expression, as in POV-Ray. A float fills all five components, filter and transmit too. A
 * vector gives red, green, blue, filter, transmit, in this order, up to its length. */
static Num from_num(Num num)
{
    num_promote(&num, 5);
    num.color = 1;
    return num;
}

static Num from_form(Sdl *sdl, const Form *form)
{
    Num num = expression_sum(sdl);
    if (num.count == 1) {
        num_promote(&num, form->count);
        num.count = form->count;
    }
    num_promote(&num, 5);
    if (form->transmit) {
        num_promote(&num, 5);
        num.n[4] = num.n[3];
        num.n[3] = 0;
    }
    num_promote(&num, 5);
    num.color = 1;
    for (int i = 0; i < 3 && form->srgb; i++)
        num.n[i] = retex_srgb_decode(num.n[i]);
    return num;
}

Num color_parse(Sdl *sdl)
{
    Num color = {{0}, 5, 1};
    int started = 0;
    if (++sdl->expression_depth > MAX_EXPRESSION_DEPTH)
        sdl_fail(sdl, RETEX_ELIMIT, "expressions nested more than %d deep", MAX_EXPRESSION_DEPTH);
    int frame = sdl->nframes;
    if (!sdl_accept(sdl, "color"))
        sdl_accept(sdl, "colour");
    for (;; started = 1) {
        const Token *token = started ? sdl_peek_operator(sdl, frame) : sdl_peek(sdl);
        const Form *form = NULL;
        int channel = -1;
        if (token && token->kind == TOKEN_WORD) {
            for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
                if (strcmp(token->text, forms[i].name) == 0)
                    form = &forms[i];
            for (int i = 0; i < 5; i++)
                if (strcmp(token->text, channels[i]) == 0)
                    channel = i;
            if (strcmp(token->text, "alpha") == 0)
                channel = 3;
        }
        if (channel >= 0) {
            sdl_next(sdl);
            color.n[channel] = sdl_float(sdl);
        } else if (started)
            break;
        else if (form) {
            sdl_next(sdl);
            color = from_form(sdl, form);
        } else if (expression_is_number_start(sdl))
            color = from_num(expression_sum(sdl));
        else
            sdl_expected(sdl, "a color");
    }
    sdl->expression_depth--;
    return color;
}

Rgbft sdl_color(Sdl *sdl)
{
    Num c = color_parse(sdl);
    return (Rgbft){(float)c.n[0], (float)c.n[1], (float)c.n[2], (float)c.n[3], (float)c.n[4]};
}
