/* Edits as text or, where the input has a line end, as an option: `opts` and `NAME=IMAGE` before and behind it; or,
 * where it begins with a brace, as a preset. What is accepted must have a canonical text that says the same, and
 * give finite colours wherever it is looked up. */
#include <math.h>
#include <retex/edit.h>
#include <retex/host/texture_lookup.h>
#include <retex/preset.h>
#include <stdlib.h>
#include <string.h>

#include "lib_filter.h"
#include "lib_fuzz.h"
#include "texture/pyramid.h"

static RetexImage image;

static void begin(void)
{
    static const char *const seeds[] = {
        "Floor=oak.jpg;Floor.scale=2,1;Floor.rotate=30;Wall=tomato;Sofa.001=#f80",
        "Wall%2Escale=a%3Bb%26%25.png&Wall.scale.flip=uv&Wall=srgb(.5,0.25,1)",
        "Floor.colorspace=x;Floor.width=1.2,3;Floor.repeat=brick;Floor.offset=0,-1e3;Floor=#ff8800",
        "A=a;A.wrap=mirror,clamp;B=b;C=c;D=d;E=e;F=f;G=g;H=rgb(1,2,3)",
        "scale=2,2:rotate=30:offset=0,0.5:wrap=repeat\nFloor=oak.jpg",
        "scale=0.5:wrap=mirror,clamp\nWall=a b/c=d.png",
        "wrap=black:colorspace=sRGB\nfloor=rgb(0.8,0.1,0.1)",
        "\nWall=rgb(1e-3, 2, 0)",
        "flip=uv:repeat=brick:width=1.2\nFloor=planks.png",
        "width=1e-3,2:repeat=half-drop:flip=v\nFloor=a",
        "scale=1e308,2:rotate=30:offset=0,-1.7e308\nWall=a",
        "repeat=mirror:wrap=clamp,repeat:width=3:rotate=90\nWall=a",
        "light:Lamp=2.5;light:Sun=1.5*3000K;light:sky=#ffd0a0*rgb(.5,1,0);Floor=oak.jpg",
        "Floor=a;Floor.hue=30;Floor.saturation=0.5;Floor.gain=1,.5,2;Floor.gamma=2;Floor.contrast=2",
        "Floor=a;Floor.blur=.1;Floor.tint=red;Floor.colorize=#8a6d4b;finish:Wall=satin;Wall=b;Wall.finish=map.png",
        "Floor=a;Floor.width=60cm,12in;Floor.grout=4mm;Floor.groutcolor=gray;Floor.at=1m,2ft;Floor.repeat=herringbone",
        "Floor=a;Floor.vary=turn,flip,shift,7;Floor.tiles=b.jpg,c.jpg;Floor.width=1;Floor.repeat=basket",
        "Floor=a;Floor.normal=n.png,dx;Wall=b;Wall.repeat=hexagon;Wall.width=.3;Wall.grout=.01;Wall.vary=turn",
        "over:Floor=logo.png;over:Floor.at=1.2,.4;over:Floor.width=.5;over2:Floor=b.png;over2:Floor.rotate=9;Floor=tan",
        "over:width=5cm:at=1m,2m:invert=yes\nFloor=logo.png",
        "grout=.01:width=.2:vary=flip,3:repeat=brick\nFloor=#fff",
        "light:a%2Eb=0&light:Lamp=tomato*2&light:rest=1e3*12000K",
        "picture:exposure=.5;picture:white-balance=4000;picture:auto-exposure=yes;picture:view=Filmic;Floor=oak.jpg",
        "{\"retex-preset\": 1, \"edit\": \"Floor=../oak.jpg;light:Lamp=2;picture:exposure=1\"}",
        "offset=-1e3,1e9:rotate=-720.5:colorspace=Linear Rec.709\nFloor=:x",
    };
    uint64_t random = 1;
    if (retex_image_alloc(&image, 5, 4, 4, NULL))
        abort();
    for (int i = 0; i < 5 * 4 * 4; i++)
        image.pixels[i] = (float)(fuzz_next(&random) % 256) / 255;
    for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++) {
        fuzz_seed(seeds[i], strlen(seeds[i]));
        fuzz_words(seeds[i], strlen(seeds[i]));
    }
}

static void look_up(const RetexTextureSpec *spec)
{
    static const double places[] = {0.1, -3.7, 1e6, -1e300}, widths[] = {0, 1e-6, 0.1, 1e9};
    RetexTexture *texture, *square;
    float rgba[4];
    if (spec->constant ? retex_texture_load(&texture, spec, 1, NULL)
                       : retex_texture_create(&texture, &image, spec, 0, NULL))
        return;
    for (int i = 0; i < 16; i++) {
        const double *covariance = (double[3]){widths[i % 4], widths[i % 4] / 3, widths[i % 4]};
        filter_gaussian(texture, places[i / 4], places[3 - i / 4], covariance, rgba);
        fuzz_must(isfinite(rgba[0] + rgba[1] + rgba[2] + rgba[3]), "a filtered colour is finite");
        filter_disc(texture, places[i / 4], places[3 - i / 4], covariance, rgba);
        fuzz_must(isfinite(rgba[0] + rgba[1] + rgba[2] + rgba[3]), "a colour averaged over a disc is finite");
        retex_texture_point(texture, places[i / 4], places[i % 4], rgba);
        fuzz_must(isfinite(rgba[0] + rgba[1] + rgba[2] + rgba[3]), "a colour is finite");
        retex_texture_nearest(texture, places[i / 4], places[i % 4], rgba);
        fuzz_must(isfinite(rgba[0] + rgba[1] + rgba[2] + rgba[3]), "a texel is finite");
    }
    if (!retex_texture_square(&square, texture, 0, NULL)) {
        filter_disc(square, 0.1, 0.2, (double[3]){0.1, 0, 0.1}, rgba);
        fuzz_must(isfinite(rgba[0] + rgba[1] + rgba[2] + rgba[3]), "a square is finite");
        retex_texture_close(&square);
    }
    retex_texture_close(&texture);
}

static void check_texture(RetexTextureSpec *spec)
{
    fuzz_must(spec->scale[0] != 0 && spec->scale[1] != 0, "a scale is not 0");
    fuzz_must(isfinite(spec->scale[0]) && isfinite(spec->scale[1]) && isfinite(spec->rotate) &&
                  isfinite(spec->offset[0]) && isfinite(spec->offset[1]),
              "numbers are finite");
    fuzz_must(isfinite(spec->width[0]) && spec->width[0] >= 0 && isfinite(spec->width[1]) && spec->width[1] >= 0,
              "a width is finite and not negative");
    spec->uv_scale[0] = 2;
    spec->uv_scale[1] = 0.3;
    look_up(spec);
}

/* The text of an edit, which the caller frees. */
static char *text_of(const RetexEdit *edit)
{
    char *text;
    if (retex_edit_text(edit, ';', &text, NULL))
        abort();
    return text;
}

static void check_canonical(const RetexEdit *edit, RetexEdit *again)
{
    char *text = text_of(edit), *same;
    retex_edit_clear(again);
    fuzz_must(!retex_edit_parse(again, text, NULL), "the canonical text is accepted");
    same = text_of(again);
    fuzz_must(strcmp(text, same) == 0 && retex_edit_count(edit) == retex_edit_count(again),
              "the canonical text is canonical itself");
    free(same);
    free(text);
}

static int run(const unsigned char *bytes, size_t size)
{
    char *text = strdup((const char *)bytes), *line = text ? strchr(text, '\n') : NULL;
    RetexEdit *edit = NULL, *again = NULL;
    int code = -1;
    (void)size;
    if (line)
        *line = '\0';
    if (text && !retex_edit_create(&edit, NULL) && !retex_edit_create(&again, NULL))
        code = *text == '{' ? retex_preset_parse(edit, text, strlen(text), "a preset", NULL)
               : line       ? retex_edit_option(edit, text, line + 1, NULL)
                            : retex_edit_parse(edit, text, NULL);
    fuzz_must(!edit || !code || retex_edit_count(edit) == 0, "what fails adds nothing");
    if (!code)
        check_canonical(edit, again);
    for (int i = 0; !code && i < retex_edit_count(edit); i++)
        check_texture(retex_edit_texture(edit, i));
    retex_edit_close(&edit);
    retex_edit_close(&again);
    free(text);
    return !code;
}

int main(int argc, char **argv)
{
    static const FuzzDriver driver = {"edit", 1, begin, run};
    int found = fuzz_main(&driver, argc, argv);
    retex_image_free(&image);
    return found;
}
