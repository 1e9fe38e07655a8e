/* Edits: the cases of tests/data/edits.txt, texts of random edits, cells of tables, targets by name, colours. */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "common/cli.h"

static RetexEdit *create(void)
{
    RetexEdit *edit;
    RetexError err = {0};
    test_must(retex_edit_create(&edit, &err), &err);
    return edit;
}

/* The canonical text of an edit; freed with the next one. */
static const char *text_of(const RetexEdit *edit)
{
    static char *text;
    RetexError err = {0};
    free(text);
    test_must(retex_edit_text(edit, ';', &text, &err), &err);
    return text;
}

static void assert_fails(int code, const char *what, const RetexError *err, const char *says)
{
    if (code != err->code || !code || !strstr(err->message, says))
        fail_msg("%s: %d, '%s' does not say '%s'", what, code, err->message, says);
}

/* ---- the table ---- */

static void check_canonical(const char *text, const char *canonical)
{
    RetexEdit *edit = create();
    RetexError err = {0};
    if (retex_edit_parse(edit, text, &err))
        fail_msg("%s: %s", text, err.message);
    assert_int_equal(err.code, RETEX_OK);
    if (strcmp(text_of(edit), canonical) != 0)
        fail_msg("%s: '%s' instead of '%s'", text, text_of(edit), canonical);
    retex_edit_clear(edit);
    test_must(retex_edit_parse(edit, canonical, &err), &err);
    assert_string_equal(text_of(edit), canonical);
    retex_edit_close(&edit);
}

static void check_refused(const char *text, const char *says)
{
    RetexEdit *edit = create();
    RetexError err = {0};
    test_must(retex_edit_parse(edit, "Kept=kept.png", &err), &err);
    assert_fails(retex_edit_parse(edit, text, &err), text, &err, says);
    assert_int_equal(retex_edit_parse(edit, text, NULL), err.code);
    assert_string_equal(text_of(edit), "Kept=kept.png");
    retex_edit_close(&edit);
}

static void test_table(void **state)
{
    char line[512], text[512] = "";
    int cases = 0;
    FILE *file = fopen("tests/data/edits.txt", "r");
    (void)state;
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        const char *rest = line[0] && line[1] ? line + 2 : "";
        if (line[0] == '<')
            strcpy(text, rest);
        else if (line[0] == '>')
            check_canonical(text, rest), cases++;
        else if (line[0] == '!')
            check_refused(text, rest), cases++;
    }
    fclose(file);
    assert_true(cases > 90);
}

/* ---- random edits ---- */

static uint32_t seed = 1;

static int random_below(int count)
{
    return (int)(test_random(&seed) * count);
}

static double random_number(void)
{
    const double digits = random_below(2) ? random_below(2000) / 100.0 - 10 : test_random(&seed) - 0.5;
    return digits * pow(10, random_below(8) ? 0 : random_below(60) - 30);
}

static const char *random_letters(char text[8])
{
    static const char letters[] = "aZ.;&%=25 EBé#()/:\n";
    const int length = 1 + random_below(6);
    for (int i = 0; i < length; i++)
        text[i] = letters[random_below((int)sizeof letters - 1)];
    text[length] = '\0';
    return text;
}

/* A texture of the target with random members, by their own names. */
static void set_random(RetexTextureSpec *spec)
{
    if (random_below(4) == 0) {
        spec->constant = 1;
        for (int c = 0; c < 3; c++)
            spec->color[c] = (float)fabs(random_number());
    } else {
        strcpy(spec->image, "./");
        random_letters(spec->image + 2);
    }
    for (int axis = 0; axis < 2; axis++) {
        if (random_below(2))
            spec->scale[axis] = random_number() + 1e-40;
        if (random_below(2))
            spec->offset[axis] = random_number();
        spec->flip[axis] = random_below(2);
    }
    if (random_below(2))
        spec->rotate = random_number();
    if (random_below(2))
        spec->width[0] = fabs(random_number()) + 1e-30, spec->width[1] = random_below(2) * spec->width[0] / 3;
    if (random_below(2))
        for (random_letters(spec->colorspace); strchr(spec->colorspace, ':');)
            *strchr(spec->colorspace, ':') = '-';
    spec->repeat = (RetexRepeat)random_below(4);
    for (int axis = 0; axis < 2 && (spec->repeat == RETEX_REPEAT_STRAIGHT || spec->repeat == RETEX_REPEAT_MIRROR);
         axis++)
        spec->wrap[axis] = (RetexWrap)random_below(4);
}

static void assert_same(const RetexTextureSpec *a, const RetexTextureSpec *b)
{
    assert_string_equal(a->target, b->target);
    assert_string_equal(a->image, b->image);
    assert_string_equal(a->colorspace, b->colorspace);
    assert_int_equal(a->constant, b->constant);
    assert_int_equal(a->repeat, b->repeat);
    assert_true(a->rotate == b->rotate);
    for (int c = 0; c < 3; c++)
        assert_true(a->color[c] == b->color[c]);
    for (int axis = 0; axis < 2; axis++) {
        assert_true(a->scale[axis] == b->scale[axis] && a->offset[axis] == b->offset[axis]);
        assert_true(a->width[axis] == b->width[axis]);
        assert_true(a->wrap[axis] == b->wrap[axis] && a->flip[axis] == b->flip[axis]);
    }
}

static void test_random_edits(void **state)
{
    (void)state;
    for (int n = 0; n < 3000; n++) {
        RetexEdit *edit = create(), *same = create();
        RetexError err = {0};
        for (int k = random_below(4); k > 0; k--) {
            char target[8];
            random_letters(target);
            for (char *c = target; *c; c++) /* it ends the name in options */
                *c = *c == '=' ? '-' : *c;
            char argument[32];
            snprintf(argument, sizeof argument, "%s=./x", target);
            (void)retex_edit_option(edit, "", argument, NULL); /* the name may be there already */
        }
        for (int i = 0; i < retex_edit_count(edit); i++) {
            memset(retex_edit_texture(edit, i)->image, 0, 8);
            set_random(retex_edit_texture(edit, i));
        }
        if (retex_edit_parse(same, text_of(edit), &err))
            fail_msg("%s: %s", text_of(edit), err.message);
        assert_int_equal(retex_edit_count(edit), retex_edit_count(same));
        for (int i = 0; i < retex_edit_count(edit); i++)
            assert_same(retex_edit_texture(edit, i), retex_edit_texture(same, i));
        char *text = strdup(text_of(edit)), *query;
        assert_string_equal(text_of(same), text);
        /* divided by & it is the same; and each texture is, as an option */
        test_must(retex_edit_text(edit, '&', &query, &err), &err);
        assert_null(strchr(query, ';'));
        retex_edit_clear(same);
        test_must(retex_edit_parse(same, query, &err), &err);
        assert_string_equal(text_of(same), text);
        free(query);
        free(text);
        for (int i = 0; i < retex_edit_count(edit); i++) {
            RetexTextureSpec *spec = retex_edit_texture(edit, i);
            char *options, image[sizeof spec->image], argument[sizeof spec->image + sizeof spec->target];
            test_must(retex_edit_options_text(spec, &options, &err), &err);
            retex_edit_image_text(spec, image, sizeof image);
            snprintf(argument, sizeof argument, "%s=%s", spec->target, image);
            retex_edit_clear(same);
            test_must(retex_edit_option(same, options, argument, &err), &err);
            assert_same(spec, retex_edit_texture(same, 0));
            free(options);
        }
        retex_edit_close(&edit);
        retex_edit_close(&same);
    }
}

/* ---- other forms ---- */

static void test_cells(void **state)
{
    static const struct {
        const char *cell, *text;
    } cells[] = {
        {"oak.jpg", "Floor=oak.jpg"},
        {"a b.jpg", "Floor=a b.jpg"},
        {":scale=2,3:rotate=30  oak b.jpg", "Floor=oak b.jpg;Floor.scale=2,3;Floor.rotate=30"},
        {": :x.png", "Floor=:x.png"},
        {"rgb(1,0,0)", "Floor=rgb(1,0,0)"},
        {":scale=2 tan", "Floor=rgb(0.6444797,0.45641103,0.26225066);Floor.scale=2,2"},
        {"a;b&c%", "Floor=a%3Bb%26c%25"},
    };
    RetexEdit *edit = create();
    RetexError err = {0};
    (void)state;
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
        retex_edit_clear(edit);
        test_must(retex_edit_cell(edit, "Floor", cells[i].cell, &err), &err);
        assert_string_equal(text_of(edit), cells[i].text);
    }
    assert_fails(retex_edit_cell(edit, "Floor", "x.png", &err), "twice", &err, "target Floor is given two textures");
    assert_int_equal(err.code, RETEX_EINVAL);
    assert_fails(retex_edit_cell(edit, "Wall", ":scale=2", &err), "options", &err, "without an image");
    assert_fails(retex_edit_cell(edit, "Wall", ":scal=2 x", &err), "options", &err, "is scale meant?");
    assert_fails(retex_edit_cell(edit, "Wall", ":scale x", &err), "options", &err, "has no value");
    retex_edit_close(&edit);
}

/* What was divided elsewhere is taken as it is. */
static void test_statements(void **state)
{
    RetexEdit *edit = create();
    RetexError err = {0};
    (void)state;
    test_must(retex_edit_set(edit, "Floor.scale", "2,1", &err), &err);
    assert_fails(retex_edit_check(edit, &err), "no texture", &err, "expected Floor=IMAGE too");
    test_must(retex_edit_set(edit, "Floor", "50%25;a&b", &err), &err);
    test_must(retex_edit_check(edit, &err), &err);
    assert_string_equal(retex_edit_texture(edit, 0)->image, "50%25;a&b");
    assert_string_equal(text_of(edit), "Floor=50%2525%3Ba%26b;Floor.scale=2,1");
    assert_fails(retex_edit_set(edit, "Floor", "b", &err), "Floor", &err, "given twice");
    assert_fails(retex_edit_set(edit, "", "b", &err), "", &err, "TARGET=IMAGE");
    assert_true(retex_edit_key_is_option("Wall.001.flip") && !retex_edit_key_is_option("Wall.001"));
    assert_true(!retex_edit_key_is_option("scale") && !retex_edit_key_is_option("Wall.Scale"));
    retex_edit_close(&edit);
}

/* ---- targets ---- */

static const RetexTargetNames room_names = {.count = 4,
                                             .names = {"Wall", "Floor", "wall", "Sofa.001"},
                                             .idents = {"Brick", "Oak", "A,B", "Seat"},
                                             .of = "the room",
                                             .advice = "; look for it"};

/* A name is that of the target called so, else of the only one that differs in case, else of the only one that has this
 * identifier alone. An edit that gives a target two textures stays as it was. */
static void test_bind(void **state)
{
    RetexEdit *edit = create();
    RetexError err = {0};
    (void)state;
    test_must(retex_edit_parse(edit, "sofa.001=d;sofa.001.scale=2;floor=b;wall=c;Brick=a", &err), &err);
    test_must(retex_edit_bind(edit, &room_names, &err), &err);
    assert_string_equal(text_of(edit), "Floor=b;Sofa.001=d;Sofa.001.scale=2,2;Wall=a;wall=c");
    retex_edit_clear(edit);
    test_must(retex_edit_parse(edit, "Floor=b;Oak=c", &err), &err);
    assert_fails(retex_edit_bind(edit, &room_names, &err), "twice", &err, "target Floor is given two textures");
    assert_int_equal(err.code, RETEX_EINVAL);
    assert_string_equal(text_of(edit), "Floor=b;Oak=c");
    retex_edit_close(&edit);
}

/* What is said of a name that is none: what there is, and what may be meant. */
static void test_unknown_targets(void **state)
{
    static const struct {
        const char *name;
        int code;
        const char *says;
    } unknown[] = {
        {"Flor", RETEX_ENOTFOUND,
         "no target is called 'Flor'; the room has Wall, Floor, wall, Sofa.001; is Floor meant?"},
        {"Lamp", RETEX_ENOTFOUND, "no target is called 'Lamp'; the room has Wall, Floor, wall, Sofa.001; look for it"},
        {"WALL", RETEX_ENOTFOUND, "no target is called 'WALL'"}, /* two differ from it in case alone */
        {"floor.scal", RETEX_EPARSE, "no texture option is called 'scal'; there are scale, rotate, "},
        {"floor.scal", RETEX_EPARSE, "; is scale meant?"},
    };
    RetexError err = {0};
    (void)state;
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++) {
        int target = 7;
        assert_fails(retex_target_find(&target, &room_names, unknown[i].name, &err), unknown[i].name, &err,
                     unknown[i].says);
        assert_int_equal(err.code, unknown[i].code);
        assert_int_equal(target, -1);
    }
    assert_fails(retex_target_find(&(int){0}, &(RetexTargetNames){.of = "it", .advice = ""}, "a", &err), "none", &err,
                 "it has no targets");
}

/* ---- colours ---- */

static void test_advice(void **state)
{
    static const char *const cases[][2] = {
        {"rde", "; is red meant?"},
        {"tomatoe", "; is tomato meant?"},
        {"darkslategery", "; is darkslategrey meant?"},
        {"oak", ""},
        {"/pink", ""},
        {"pink.x", ""},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[RETEX_MEANT_SIZE];
        assert_string_equal(retex_color_meant(cases[i][0], text), cases[i][1]);
    }
    RetexTextureSpec spec;
    RetexTexture *texture;
    RetexError err = {0};
    test_must(test_texture_spec(&spec, "", "Floor=rde", &err), &err);
    assert_fails(retex_texture_load(&texture, &spec, 1, &err), "rde", &err, "cannot read rde: ");
    assert_non_null(strstr(err.message, "; is red meant?"));
}

/* What --help and completion say of --texture are the options that there are. */
static void test_options_of_tools(void **state)
{
    char known[400] = "";
    int options = 0;
    RetexEdit *edit = create();
    RetexError err = {0};
    (void)state;
    assert_int_equal(retex_edit_option(edit, "x=1", "a=b", &err), RETEX_EPARSE);
    snprintf(known, sizeof known, " %s,", strstr(err.message, "there are ") + strlen("there are "));
    for (const char *at = CLI_TEXTURE_OPTS; *at; options++) {
        char word[32];
        snprintf(word, sizeof word, " %.*s,", (int)strcspn(at, "="), at);
        if (!strstr(known, word))
            fail_msg("'%s' is no option of '%s'", word, known);
        at = strstr(at, ", ") ? strstr(at, ", ") + 2 : "";
    }
    for (const char *comma = known; (comma = strchr(comma, ',')); comma++)
        options--;
    assert_int_equal(options, 0);
    retex_edit_close(&edit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_random_edits),
        cmocka_unit_test(test_cells),
        cmocka_unit_test(test_statements),
        cmocka_unit_test(test_bind), cmocka_unit_test(test_unknown_targets),
        cmocka_unit_test(test_advice),
        cmocka_unit_test(test_options_of_tools),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
