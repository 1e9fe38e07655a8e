/* What the values of lamps mean: the grammar, numbers, colours and kelvins on lamps of each kind, black bodies against
 * published approximations of another form, and edits with lamps. */
#include "lib_test.h"
#include <cmocka.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/retex.h>

/* ---- black bodies ---- */

/* Krystek, 'An algorithm to calculate correlated colour temperature' (1985): CIE 1960 u, v from 1000 to 15000 K. */
static void krystek(double t, double *x, double *y)
{
    const double u =
        (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) / (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t);
    const double v =
        (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) / (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t);
    *x = 3 * u / (2 * u - 8 * v + 4), *y = 2 * v / (2 * u - 8 * v + 4);
}

/* Kang et al., 'Design of advanced color temperature control system for HDTV applications' (2002), from 4000 K on. */
static void kang(double t, double *x, double *y)
{
    const double c = *x = -3.0258469e9 / (t * t * t) + 2.1070379e6 / (t * t) + 0.2226347e3 / t + 0.240390;
    *y = 3.0817580 * c * c * c - 5.87338670 * c * c + 3.75112997 * c - 0.37001483;
}

static void expect_body(double t, double x, double y, double tolerance)
{
    float color[3];
    retex_kelvin_color(color, t);
    const double r = (double)color[0], g = (double)color[1], b = (double)color[2];
    assert_float_equal(0.2126 * r + 0.7152 * g + 0.0722 * b, 1, 1e-6);
    if (color[2] == 0) { /* out of Rec. 709: only on the line to its blue is there anything to compare */
        assert_true(t < 2000);
        return;
    }
    const double X = 0.4124564 * r + 0.3575761 * g + 0.1804375 * b, Y = 0.2126729 * r + 0.7151522 * g + 0.0721750 * b,
                 Z = 0.0193339 * r + 0.1191920 * g + 0.9503041 * b;
    if (fabs(X / (X + Y + Z) - x) > tolerance || fabs(Y / (X + Y + Z) - y) > tolerance)
        fail_msg("%g K: %g %g, not %g %g", t, X / (X + Y + Z), Y / (X + Y + Z), x, y);
}

static void black_bodies_have_their_colors(void **state)
{
    (void)state;
    double x, y;
    for (double t = 1000; t <= 15000; t *= 1.07) {
        krystek(t, &x, &y);
        expect_body(t, x, y, t < 2000 ? 0.012 : 0.003);
    }
    for (double t = 4000; t <= 25000; t *= 1.07) {
        kang(t, &x, &y);
        expect_body(t, x, y, 0.001);
    }
    expect_body(2856, 0.44757, 0.40745, 0.002); /* CIE standard illuminant A */
    float warm[3], cold[3];
    retex_kelvin_color(warm, RETEX_KELVIN_MIN);
    retex_kelvin_color(cold, RETEX_KELVIN_MAX);
    assert_true(warm[0] > 4 && warm[1] > 0 && warm[2] == 0);
    assert_true(cold[2] > 1.9f && cold[0] < 0.75f);
}

/* ---- values ---- */

static const RetexParameter RED = {"Red", RETEX_PARAMETER_COLOR, -1, {4, 0, 0}, {4, 4, 4}, 0},
                            OFF = {"Off", RETEX_PARAMETER_COLOR, -1, {0, 0, 0}, {2, 1, 1}, 0},
                            SKY = {"Sky", RETEX_PARAMETER_COLOR, -1, {1, 1, 1}, {1, 1, 1}, 1};

static void expect_light(const RetexParameter *lamp, const char *text, double r, double g, double b)
{
    RetexLampValue value;
    RetexError err = {0};
    float color[3];
    test_must(retex_lamp_value_parse(&value, text, &err), &err);
    test_must(retex_lamp_value_apply(color, &value, lamp, &err), &err);
    const double want[] = {r, g, b};
    for (int c = 0; c < 3; c++)
        if (fabs((double)color[c] - want[c]) > 2e-6 * (1 + want[c]))
            fail_msg("%s=%s: %g %g %g, not %g %g %g", lamp->name, text, (double)color[0], (double)color[1],
                     (double)color[2], r, g, b);
}

static void numbers_multiply_and_colors_keep_the_luminance(void **state)
{
    (void)state;
    const double red = 0.2126 * 4, off = 0.2126 * 2 + 0.7152 + 0.0722;
    float body[3];
    retex_kelvin_color(body, 3000);
    expect_light(&RED, "1", 4, 0, 0);
    expect_light(&RED, "0", 0, 0, 0);
    expect_light(&RED, " 2.5 * 2 ", 20, 0, 0);
    expect_light(&RED, "blue", 0, 0, red / 0.0722);
    expect_light(&RED, "rgb(0,0,9)*2", 0, 0, 2 * red / 0.0722);
    expect_light(&RED, "white", red, red, red);
    expect_light(&RED, "gray", red, red, red);
    expect_light(&RED, "black", 0, 0, 0);
    expect_light(&OFF, "1", 2, 1, 1);
    expect_light(&OFF, "2*#fff", 2 * off, 2 * off, 2 * off);
    expect_light(&OFF, "0*red", 0, 0, 0);
    expect_light(&SKY, "3", 3, 3, 3);
    expect_light(&SKY, "2*red", 2 / 0.2126, 0, 0);
    expect_light(&SKY, "1.5*3000K", 1.5 * (double)body[0], 1.5 * (double)body[1], 1.5 * (double)body[2]);
    expect_light(&SKY, "3000k", (double)body[0], (double)body[1], (double)body[2]);
    const double sum = 0.2126 * 0.5 * (double)body[0] + 0.7152 * (double)body[1]; /* a filter before a lamp */
    expect_light(&SKY, "3000K*rgb(.5,1,0)", 0.5 * (double)body[0] / sum, (double)body[1] / sum, 0);
}

static void what_is_no_value_is_refused(void **state)
{
    static const char *const wrong[][2] = {
        {"", "expected"},     {"-1", "expected"},        {"2*", "expected"},   {"*2", "expected"},
        {"2**3", "expected"}, {"2 3", "expected"},       {"1e31", "expected"}, {"nan", "expected"},
        {"+inf", "expected"}, {"999K", "1000 to 40000"}, {"40001K", "40000"},  {"3000Kx", "expected"},
        {"rde", "red"},       {"rgb(1,2)", "rgb"},       {"#12", "#rgb"},      {"1e30*1e30", "expected"}};
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        RetexLampValue value = {.gain = 7};
        RetexError err = {0};
        assert_int_equal(retex_lamp_value_parse(&value, wrong[k][0], &err), RETEX_EPARSE);
        if (!strstr(err.message, wrong[k][1]))
            fail_msg("%s: %s", wrong[k][0], err.message);
        assert_true(value.gain == 7);
        assert_int_equal(retex_lamp_value_parse(&value, wrong[k][0], NULL), RETEX_EPARSE);
    }
    const RetexParameter bright = {"Bright", RETEX_PARAMETER_COLOR, -1, {1e20f, 1, 1}, {1e20f, 1, 1}, 0};
    const RetexLampValue value = {.gain = 1e30, .color = {1, 1, 1}};
    RetexError err = {0};
    float color[3];
    assert_int_equal(retex_lamp_value_apply(color, &value, &bright, &err), RETEX_EINVAL);
    assert_non_null(strstr(err.message, "Bright"));
}

/* ---- edits ---- */

static RetexEdit *edit_of(const char *text)
{
    RetexEdit *edit;
    RetexError err = {0};
    test_must(retex_edit_create(&edit, &err), &err);
    test_must(retex_edit_parse(edit, text, &err), &err);
    return edit;
}

static void expect_text(const RetexEdit *edit, const char *want)
{
    char *text;
    RetexError err = {0};
    test_must(retex_edit_text(edit, ';', &text, &err), &err);
    assert_string_equal(text, want);
    free(text);
}

static void edits_have_canonical_texts(void **state)
{
    static const char *const cases[][2] = {
        {"light:Lamp=2", "light:Lamp=2"},
        {"light:b=0;Floor=red;light:a=1*2*.5", "Floor=rgb(1,0,0);light:a=1;light:b=0"},
        {"light:Lamp.scale=rgb(1,1,1)*2&light:%26=.1", "light:%26=0.1;light:Lamp.scale=2*rgb(1,1,1)"},
        {"light:*=0;light:Lamp=black", "light:*=0;light:Lamp=0"}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RetexEdit *edit = edit_of(cases[k][0]), *again = edit_of(cases[k][1]);
        expect_text(edit, cases[k][1]);
        expect_text(again, cases[k][1]);
        retex_edit_close(&edit);
        retex_edit_close(&again);
    }
    uint32_t seed = 5;
    for (int k = 0; k < 2000; k++) { /* texts mean the same to the bit */
        RetexLampValue value, back;
        RetexError err = {0};
        char text[256];
        snprintf(text, sizeof text, "%.17g*rgb(%.9g,%.9g,%.9g)", test_random(&seed), test_random(&seed),
                 test_random(&seed), test_random(&seed));
        test_must(retex_lamp_value_parse(&value, text, &err), &err);
        retex_lamp_value_text(&value, text);
        test_must(retex_lamp_value_parse(&back, text, &err), &err);
        assert_true(value.gain == back.gain && value.colored == back.colored);
        assert_memory_equal(value.color, back.color, sizeof value.color);
    }
}

static void expect_refused(RetexEdit *edit, int code, const RetexError *err, const char *says)
{
    assert_true(code < 0);
    if (!strstr(err->message, says))
        fail_msg("'%s' does not say '%s'", err->message, says);
    expect_text(edit, "light:lamp=2;light:rest=0");
}

static void textures_get_their_names_beside_lamps(void **state)
{
    (void)state;
    const RetexTargetNames names = {1, {"Floor"}, {"Oak"}, "the room", ""};
    RetexEdit *edit = edit_of("floor=tomato;light:Lamp=2");
    RetexError err = {0};
    test_must(retex_edit_bind(edit, &names, &err), &err);
    assert_string_equal(retex_edit_texture(edit, 0)->target, "Floor");
    assert_int_equal(retex_edit_lights(edit), 1);
    retex_edit_close(&edit);
}

static void edits_name_the_lamps_of_a_set(void **state)
{
    (void)state;
    RetexSet *set = test_set(9, 7, 1), *dark = test_set(9, 7, 1);
    RetexEdit *edit = edit_of("light:lamp=2;light:rest=0"), *none = edit_of("light:*=1"), *solo = edit_of("");
    RetexError err = {0};
    float values[9], some[9];
    test_add_lamp_terms(set, 1, 1);
    test_must(retex_edit_parameters(edit, set, values, &err), &err);
    const float want[] = {2, 1, 4, 0, 0, 0, 0, 0, 0}; /* the second lamp is off */
    assert_memory_equal(values, want, sizeof want);
    expect_refused(edit, retex_edit_parse(edit, "light:rest=1", &err), &err, "light:rest is given twice");
    expect_refused(edit, retex_edit_light(edit, "rest", &err), &err, "LAMP=VALUE");
    expect_refused(edit, retex_edit_light(edit, "=1", &err), &err, "LAMP=VALUE");
    expect_refused(edit, retex_edit_light(edit, "x=", &err), &err, "LAMP=VALUE");
    expect_refused(edit, retex_edit_set(edit, "light:", "1", &err), &err, "name");
    expect_refused(edit, retex_edit_parameters(edit, dark, some, &err), &err, "the set has no lamps");
    assert_int_equal(retex_edit_parameters(none, dark, some, &err), RETEX_ENOTFOUND);
    test_must(retex_edit_bind_lamps(edit, set, &err), &err);
    expect_text(edit, "light:Lamp=2;light:rest=0");
    test_must(retex_edit_light(edit, "lAMP=1", &err), &err);
    assert_int_equal(retex_edit_bind_lamps(edit, set, &err), RETEX_EPARSE);
    expect_text(edit, "light:Lamp=2;light:lAMP=1;light:rest=0");
    assert_int_equal(retex_edit_light(solo, "Widnow=1", &err), RETEX_OK);
    assert_int_equal(retex_edit_parameters(solo, set, some, &err), RETEX_ENOTFOUND);
    assert_non_null(strstr(err.message, "the set has Lamp, Window, rest; is Window meant?"));
    retex_edit_clear(solo);
    expect_text(solo, "");
    test_must(retex_edit_light(solo, "Lamp=3", &err), &err);
    test_must(retex_edit_solo(solo, "Lamp", &err), &err);
    test_must(retex_edit_solo(solo, "Window", &err), &err);
    expect_text(solo, "light:*=0;light:Lamp=3;light:Window=1");
    test_must(retex_edit_parameters(solo, set, values, &err), &err);
    const float alone[] = {3, 1.5f, 6, 1, 1, 1, 0, 0, 0};
    assert_memory_equal(values, alone, sizeof alone);
    retex_edit_clear(edit);
    test_must(retex_edit_light(edit, "Lamp=1", &err), &err);
    test_must(retex_edit_complete_lights(edit, solo, &err), &err);
    expect_text(edit, "light:*=0;light:Lamp=1;light:Window=1");
    assert_int_equal(retex_edit_lights(edit), 3);
    retex_edit_close(&edit);
    retex_edit_close(&none);
    retex_edit_close(&solo);
    retex_set_close(&set);
    retex_set_close(&dark);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(black_bodies_have_their_colors),
        cmocka_unit_test(numbers_multiply_and_colors_keep_the_luminance),
        cmocka_unit_test(what_is_no_value_is_refused),
        cmocka_unit_test(edits_have_canonical_texts),
        cmocka_unit_test(edits_name_the_lamps_of_a_set),
        cmocka_unit_test(textures_get_their_names_beside_lamps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
