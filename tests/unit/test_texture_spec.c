/* Texture options on the command line, and the messages for mistakes. */
#include "lib_test.h"

#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static RetexTextureSpec parse(const char *opts, const char *arg)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    test_must(test_texture_spec(&spec, opts, arg, &err), &err);
    return spec;
}

static void test_defaults(void **state)
{
    (void)state;
    RetexTextureSpec spec = parse(NULL, "Floor=oak.png");
    assert_string_equal(spec.target, "Floor");
    assert_string_equal(spec.image, "oak.png");
    assert_string_equal(spec.colorspace, "");
    assert_int_equal(spec.constant, 0);
    assert_true(spec.scale[0] == 1 && spec.scale[1] == 1 && spec.rotate == 0);
    assert_true(spec.offset[0] == 0 && spec.offset[1] == 0);
    assert_true(spec.wrap[0] == RETEX_WRAP_REPEAT && spec.wrap[1] == RETEX_WRAP_REPEAT);
    assert_int_equal(spec.size, sizeof spec);
    assert_true(!spec.flip[0] && !spec.flip[1] && spec.repeat == RETEX_REPEAT_STRAIGHT);
    assert_true(spec.width[0] == 0 && spec.width[1] == 0 && spec.uv_scale[0] == 0 && spec.uv_scale[1] == 0);
}

static void test_options(void **state)
{
    (void)state;
    RetexTextureSpec spec =
        parse("scale=2,-0.5:rotate=-30.5:offset=0,.5:wrap=mirror,clamp:colorspace=ACES - ACEScg", "a=b");
    assert_true(spec.scale[0] == 2 && spec.scale[1] == -0.5);
    assert_true(spec.rotate == -30.5);
    assert_true(spec.offset[0] == 0 && spec.offset[1] == 0.5);
    assert_true(spec.wrap[0] == RETEX_WRAP_MIRROR && spec.wrap[1] == RETEX_WRAP_CLAMP);
    assert_string_equal(spec.colorspace, "ACES - ACEScg");
    spec = parse(":scale=3::wrap=BLACK:", "a=b");
    assert_true(spec.scale[0] == 3 && spec.scale[1] == 3);
    assert_true(spec.wrap[0] == RETEX_WRAP_BLACK && spec.wrap[1] == RETEX_WRAP_BLACK);
    spec = parse("scale=2:scale=4", "a=b"); /* the last one holds */
    assert_true(spec.scale[0] == 4);
    spec = parse("flip=u", "a=b");
    assert_true(spec.flip[0] && !spec.flip[1]);
    spec = parse("flip=V:repeat=Half-Drop", "a=b");
    assert_true(!spec.flip[0] && spec.flip[1] && spec.repeat == RETEX_REPEAT_HALF_DROP);
    spec = parse("flip=vu:repeat=brick:wrap=repeat", "a=b");
    assert_true(spec.flip[0] && spec.flip[1] && spec.repeat == RETEX_REPEAT_BRICK);
    spec = parse("repeat=mirror:wrap=clamp", "a=b");
    assert_true(spec.repeat == RETEX_REPEAT_MIRROR && spec.wrap[0] == RETEX_WRAP_CLAMP);
    spec = parse("wrap=mirror:repeat=brick:wrap=repeat:repeat=straight", "a=b");
    assert_true(spec.repeat == RETEX_REPEAT_STRAIGHT);
    spec = parse("width=1.2", "a=b");
    assert_true(spec.width[0] == 1.2 && spec.width[1] == 0 && retex_texture_spec_needs_scale(&spec));
    spec = parse("width=1.2,0.2", "a=b");
    assert_true(spec.width[0] == 1.2 && spec.width[1] == 0.2);
    spec = parse("width=1.2", "a=rgb(1,1,1)");
    assert_int_equal(retex_texture_spec_needs_scale(&spec), 0);
}

static void test_images(void **state)
{
    (void)state;
    /* Only the first '=' divides; colons and all else belong to the file. */
    assert_string_equal(parse("", "a=C:/b=c:scale=2.png").image, "C:/b=c:scale=2.png");
    assert_string_equal(parse("", "Sofa cushion= with blanks .jpg").image, " with blanks .jpg");
    assert_string_equal(parse("", "Sofa cushion=x").target, "Sofa cushion");
    assert_string_equal(parse("", "a=rgb.png").image, "rgb.png");
    RetexTextureSpec spec = parse("rotate=9", "a=rgb(0.8,0.1,0.25)");
    assert_int_equal(spec.constant, 1);
    assert_string_equal(spec.image, "");
    assert_true(spec.color[0] == 0.8f && spec.color[1] == 0.1f && spec.color[2] == 0.25f);
    spec = parse("", "a= RGB ( 1 , 0 ,\t20.5 ) ");
    assert_true(spec.constant && spec.color[0] == 1 && spec.color[1] == 0 && spec.color[2] == 20.5f);
}

static void test_mistakes(void **state)
{
    (void)state;
    char longer[2000];
    memset(longer, 'x', sizeof longer);
    memcpy(longer, "a=", 2);
    longer[sizeof longer - 1] = '\0';
    const struct {
        const char *opts, *arg, *says;
    } cases[] = {
        {"", "Floor", "NAME=IMAGE"},
        {"", "=x.png", "NAME=IMAGE"},
        {"", "Floor=", "no image"},
        {"", "", "NAME=IMAGE"},
        {"", NULL, "NAME=IMAGE"},
        {"scale", "a=b", "'scale' has no value"},
        {"scale=", "a=b", "scale=''"},
        {"scale=0", "a=b", "cannot be 0"},
        {"scale=1,0", "a=b", "cannot be 0"},
        {"scale=1,2,3", "a=b", "one or two"},
        {"scale=1;2", "a=b", "one or two"},
        {"scale=nan", "a=b", "one or two"},
        {"scale=inf", "a=b", "one or two"},
        {"rotate=30deg", "a=b", "degrees"},
        {"rotate=1,2", "a=b", "degrees"},
        {"offset=a", "a=b", "offset='a'"},
        {"offset=1,", "a=b", "offset='1,'"},
        {"wrap=tile", "a=b", "repeat, mirror, clamp or black"},
        {"wrap=repeat,tile", "a=b", "repeat, mirror"},
        {"wrap=", "a=b", "repeat, mirror"},
        {"flip=", "a=b", "u, v or uv"},
        {"flip=uu", "a=b", "u, v or uv"},
        {"flip=x", "a=b", "u, v or uv"},
        {"repeat=bricks", "a=b", "straight, brick, half-drop, mirror, herringbone, basket or hexagon"},
        {"repeat=brick:wrap=repeat,clamp", "a=b", "repeat=brick needs wrap=repeat"},
        {"wrap=mirror:repeat=half-drop", "a=b", "repeat=half-drop needs wrap=repeat"},
        {"width=0", "a=b", "lengths above 0"},
        {"width=1,-2", "a=b", "lengths above 0"},
        {"width=1km", "a=b", "lengths above 0"},
        {"width=1,2,3", "a=b", "lengths above 0"},
        {"width=1,0", "a=b", "lengths above 0"},
        {"colorspace=", "a=b", "colour space"},
        {"size=2", "a=b", "'size'; there are scale"},
        {"=2", "a=b", "''"},
        {"", "a=rgb(1,2)", "three numbers"},
        {"", "a=rgb(1,2,3,4)", "three numbers"},
        {"", "a=rgb(1,2,-3)", "0 or more"},
        {"", "a=rgb(1,2,x)", "0 or more"},
        {"", "a=rgb(1,2,3).png", "nothing may follow"},
        {"", "a=rgb(", "three numbers"},
        {"", "a=rgb(1,2,nan)", "0 or more"},
        {"", longer, "at most 1023 bytes"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        RetexError err = {0};
        assert_int_equal(test_texture_spec(&spec, cases[i].opts, cases[i].arg, &err), RETEX_EPARSE);
        assert_int_equal(err.code, RETEX_EPARSE);
        if (!strstr(err.message, cases[i].says))
            fail_msg("'%s' '%.40s': '%s' does not say '%s'", cases[i].opts, cases[i].arg, err.message, cases[i].says);
        assert_int_equal(test_texture_spec(&spec, cases[i].opts, cases[i].arg, NULL), RETEX_EPARSE);
    }
    memset(longer + 2, 'y', sizeof longer - 3);
    longer[300] = '=';
    longer[1] = 'a';
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    assert_int_equal(test_texture_spec(&spec, "", longer, &err), RETEX_EPARSE);
    assert_non_null(strstr(err.message, "at most 127 bytes"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_defaults), cmocka_unit_test(test_options),
                                       cmocka_unit_test(test_images), cmocka_unit_test(test_mistakes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
