/* The colour tags of EXR files: they are written to headers and obeyed when files are read. */
#include "lib_folder.h"
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>
#include <openexr.h>

#include "exr/io.h"

/* From AP1 to Rec.709, as ACES publishes it, Bradford's adaptation included. */
static const double ap1_to_rec709[3][3] = {{1.7050509926, -.6217921206, -.0832588720},
                                           {-.1302564174, 1.1408047365, -.0105483191},
                                           {-.0240033568, -.1289689760, 1.1529723328}};

static const float swatch[3] = {.7f, .25f, .1f};

static RetexColorTag header_of(const char *path, int part)
{
    RetexColorTag tag;
    RetexInput *input = NULL;
    RetexExr *exr = NULL;
    RetexError err = {0};
    test_must(retex_input_open(&input, path, &err), &err);
    test_must(retex_exr_open(&exr, input, &err), &err);
    retex_exr_color_tag(exr, part, &tag);
    retex_exr_close(&exr);
    retex_input_close(&input);
    return tag;
}

static RetexImage one_color(int channels)
{
    RetexImage im = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&im, 5, 70, channels, &err), &err);
    for (size_t i = 0; i < 350; i++)
        for (size_t c = 0; c < (size_t)channels; c++)
            im.pixels[i * (size_t)channels + c] = c < 3 ? swatch[c] : .5f;
    return im;
}

/* An EXR of that swatch whose header says this, by the writer of sets, which takes any. */
static void write_tagged(const char *path, const RetexColorTag *tag)
{
    RetexImage im = one_color(3);
    RetexExrPart part = {.name = "a", .letters = "RGB", .type = RETEX_FLOAT, .image = &im, .color = tag};
    RetexExrEncoding *encoding = NULL;
    RetexError err = {0};
    test_must(retex_exr_encode(&encoding, &part, 1, 1, 1, &err), &err);
    test_must(retex_exr_write(encoding, im.width, im.height, NULL, NULL, path, &err), &err);
    retex_exr_encoding_free(&encoding);
    retex_image_free(&im);
}

static void read_first(const char *path, const char *colorspace, float rgb[3])
{
    RetexImage im = {0};
    RetexError err = {0};
    const RetexReadParams params = {.size = sizeof params, .colorspace = colorspace, .pixel_bytes = 16};
    test_must(retex_image_read(&im, path, &params, 1, &err), &err);
    memcpy(rgb, im.pixels, 3 * sizeof *rgb);
    retex_image_free(&im);
}

static void expect(const float rgb[3], const double expected[3], double tolerance)
{
    for (int c = 0; c < 3; c++)
        assert_float_equal(rgb[c], expected[c], tolerance);
}

static const double as_stored[3] = {.7f, .25f, .1f};

static void ap1_in_rec709(double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = ap1_to_rec709[c][0] * as_stored[0] + ap1_to_rec709[c][1] * as_stored[1] +
                 ap1_to_rec709[c][2] * as_stored[2];
}

static void test_matrices(void **state)
{
    (void)state;
    double m[3][3];
    assert_int_equal(retex_color_tag_to_rec709(retex_color_tag_find("lin_ap1_scene")->chromaticities, m), 1);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            assert_float_equal(m[i][j], ap1_to_rec709[i][j], 2e-5);
    assert_int_equal(retex_color_tag_to_rec709(retex_color_tag_rec709.chromaticities, m), 0);
    static const float none[][8] = {{0},
                                    {.64f, .33f, .64f, .33f, .15f, .06f, .3127f, .329f},
                                    {.64f, .33f, .3f, .6f, .15f, .06f, .3127f, 0},
                                    {.64f, .33f, .3f, .6f, .15f, .06f, NAN, .329f},
                                    {.64f, .33f, .3f, .6f, .15f, .06f, .7f, .5f},
                                    {.64f, .33f, .3f, .6f, .15f, .06f, .6895f, .3125f}, /* Z is negative, no cone is */
                                    {INFINITY, .33f, .3f, .6f, .15f, .06f, .3127f, .329f},
                                    {3e38f, 3e38f, -3e38f, 3e38f, 0, 1, .3127f, .329f}};
    for (size_t k = 0; k < sizeof none / sizeof *none; k++)
        assert_int_equal(retex_color_tag_to_rec709(none[k], m), -1);
    static const double same[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                        half[3][3] = {{.5, 0, 0}, {0, .5, 0}, {0, 0, .5}},
                        to_p3[3][3] = {{.822462, .177538, 0}, {.033194, .966806, 0}, {.017083, .072397, .910520}};
    assert_string_equal(retex_color_tag_of_matrix(same)->interop, "lin_rec709_scene");
    assert_string_equal(retex_color_tag_of_matrix(to_p3)->interop, "lin_p3d65_scene");
    assert_null(retex_color_tag_of_matrix(half));
}

/* Written in every space by its name, with what its header then says. */
static void test_written(void **state)
{
    (void)state;
    static const struct {
        const char *colorspace, *interop;
        int linear, data;
    } cases[] = {
        {NULL, "lin_rec709_scene", 1, 0},
        {"linear", "lin_rec709_scene", 1, 0},
        {"ACEScg", "lin_ap1_scene", 1, 0},
        {"lin_ap0", "lin_ap0_scene", 1, 0},
        {"sRGB", "srgb_rec709_scene", 0, 0},
        {"ACEScct", "ocio:acescct_ap1_scene", 0, 0},
        {"Rec709", "", 0, 0},
        {"raw", "data", 0, 0},
        {NULL, "data", 0, 1},
    };
    for (int channels = 3; channels <= 4; channels++)
        for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
            const char *path = test_in_folder("w.exr");
            RetexImage im = one_color(channels);
            RetexWriteParams params = RETEX_WRITE_INIT;
            RetexError err = {0};
            params.colorspace = cases[k].colorspace;
            params.is_data = cases[k].data;
            test_must(retex_image_write(&im, path, &params, 1, &err), &err);
            retex_image_free(&im);
            const RetexColorTag tag = header_of(path, 0);
            assert_string_equal(tag.interop, cases[k].interop);
            assert_int_equal(tag.has_chromaticities, cases[k].linear);
            if (cases[k].linear)
                assert_memory_equal(tag.chromaticities, retex_color_tag_find(tag.interop)->chromaticities,
                                    sizeof tag.chromaticities);
            float rgb[3]; /* what was written comes back, whatever it is in */
            if (tag.interop[0]) {
                read_first(path, NULL, rgb);
                expect(rgb, as_stored, 4e-3); /* halves of logarithms */
            }
        }
}

static void test_read(void **state)
{
    (void)state;
    const char *path = test_in_folder("r.exr");
    const RetexColorTag ap1 = *retex_color_tag_find("lin_ap1_scene");
    double converted[3], srgb[3];
    float rgb[3];
    ap1_in_rec709(converted);
    for (int c = 0; c < 3; c++)
        srgb[c] = as_stored[c] <= .04045 ? as_stored[c] / 12.92 : pow((as_stored[c] + .055) / 1.055, 2.4);
    const struct {
        const char *interop;
        int has_chromaticities; /* those of AP1 */
        const double *expected;
    } cases[] = {{"", 0, as_stored},
                 {"", 1, converted},
                 {"unknown", 1, converted},
                 {"lin_ap1_scene", 0, converted},
                 {"lin_rec709_scene", 1, as_stored}, /* the name goes first */
                 {"data", 1, as_stored},
                 {"srgb_rec709_scene", 1, srgb},
                 {"studio:our_camera", 1, converted}, /* no configuration knows it */
                 {"studio:our_camera", 0, as_stored}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RetexColorTag tag = ap1;
        snprintf(tag.interop, sizeof tag.interop, "%s", cases[k].interop);
        tag.has_chromaticities = cases[k].has_chromaticities;
        write_tagged(path, &tag);
        read_first(path, NULL, rgb);
        expect(rgb, cases[k].expected, 1e-5);
        read_first(path, "linear", rgb); /* who names a space is believed */
        expect(rgb, as_stored, 0);
        read_first(path, "ACEScg", rgb);
        expect(rgb, converted, 1e-5);
    }
    RetexColorTag odd = {.has_chromaticities = 1, .chromaticities = {NAN}};
    write_tagged(path, &odd);
    read_first(path, NULL, rgb);
    expect(rgb, as_stored, 0);
}

/* Compressions that are left to OpenImageIO, and grey, which has no primaries. */
static void test_read_others(void **state)
{
    (void)state;
    char command[512];
    double converted[3];
    float rgb[3];
    ap1_in_rec709(converted);
    const char *from = test_in_folder("o.exr"), *dwa = test_in_folder("dwa.exr"), *grey = test_in_folder("grey.exr");
    RetexImage im = one_color(1);
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexError err = {0};
    params.colorspace = "ACEScg";
    test_must(retex_image_write(&im, grey, &params, 1, &err), &err);
    retex_image_free(&im);
    read_first(grey, NULL, rgb);
    expect(rgb, (const double[3]){.7, .7, .7}, 1e-3);
    write_tagged(from, retex_color_tag_find("lin_ap1_scene"));
    if (system("command -v oiiotool >/dev/null 2>&1") != 0)
        skip();
    snprintf(command, sizeof command, "oiiotool %s -d half --compression dwaa -o %s >/dev/null", from, dwa);
    assert_int_equal(system(command), 0);
    read_first(dwa, NULL, rgb);
    expect(rgb, converted, 5e-3);
    snprintf(
        command, sizeof command,
        "oiiotool %s --eraseattrib 'colorInteropID|chromaticities' --attrib:type=int acesImageContainerFlag 1 -o %s",
        from, dwa);
    assert_int_equal(system(command), 0);
    read_first(dwa, NULL, rgb);
    assert_true(rgb[0] > converted[0]); /* AP0's red is farther out than AP1's */
}

/* OpenImageIO's own attribute: the name of a space, but for the two that only say that values are linear. */
static void test_names_of_openimageio(void **state)
{
    (void)state;
    static const char *const cases[][2] = {{"sRGB", "sRGB"}, {"linear", ""}, {"scene_linear", ""}, {"Linear", ""}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *path = test_in_folder("named.exr");
        exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
        exr_context_t context;
        int part;
        assert_int_equal(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &settings), 0);
        assert_int_equal(exr_add_part(context, "x", EXR_STORAGE_SCANLINE, &part), 0);
        assert_int_equal(exr_initialize_required_attr_simple(context, part, 1, 1, EXR_COMPRESSION_NONE), 0);
        assert_int_equal(exr_add_channel(context, part, "Y", EXR_PIXEL_HALF, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), 0);
        assert_int_equal(exr_attr_set_string(context, part, "oiio:ColorSpace", cases[k][0]), 0);
        assert_int_equal(exr_write_header(context), 0);
        assert_int_equal(exr_write_scanline_chunk(context, part, 0, "\0", 2), 0);
        assert_int_equal(exr_finish(&context), 0);
        assert_string_equal(header_of(path, 0).interop, cases[k][1]);
    }
}

/* A set's parts: colours are named, all else is data. */
static void test_set_parts(void **state)
{
    (void)state;
    const char *path = test_in_folder("s.exr");
    RetexSet *set = test_set(20, 18, 1);
    RetexError err = {0};
    int colors = 0;
    test_must(retex_set_add_part(set, "albedo", "RGB", RETEX_FLOAT, 0, 0, NULL, &err), &err);
    test_must(retex_set_add_part(set, "normal", "RGB", RETEX_FLOAT, 0, 0, NULL, &err), &err);
    test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    for (int i = 0; i < set->nparts; i++) {
        const RetexColorTag tag = header_of(path, i);
        const int color = retex_set_part_is_color(set, i);
        assert_string_equal(tag.interop, color ? "lin_rec709_scene" : "data");
        assert_int_equal(tag.has_chromaticities, color);
        colors += color;
    }
    assert_true(retex_set_part_is_color(set, 0));
    assert_true(retex_set_part_is_color(set, set->terms[1].radiance));
    assert_true(retex_set_part_is_color(set, set->footprints[0].albedo));
    assert_false(retex_set_part_is_color(set, set->footprints[0].uv));
    assert_true(retex_set_part_is_color(set, set->nparts - 2));
    assert_false(retex_set_part_is_color(set, set->nparts - 1));
    assert_true(colors > 4);
    retex_set_close(&set);
}

/* ---- $OCIO: it is looked at once, so each in a child ---- */

static const char config[] =
    "ocio_profile_version: 2\n"
    "roles: {default: ap0, scene_linear: cg, %s data: non}\n"
    "file_rules:\n  - !<Rule> {name: Default, colorspace: default}\n"
    "displays:\n  Screen:\n    - !<View> {name: Same, colorspace: cg}\n"
    "colorspaces:\n"
    "  - !<ColorSpace>\n    name: ap0\n"
    "  - !<ColorSpace>\n    name: cg\n    to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}\n"
    "  - !<ColorSpace>\n    name: log\n    aliases: [\"ocio:acescct_ap1_scene\"]\n"
    "    to_scene_reference: !<BuiltinTransform> {style: ACEScct_to_ACES2065-1}\n"
    "  - !<ColorSpace>\n    name: non\n    isdata: true\n"
    "  - !<ColorSpace>\n    name: odd\n"
    "    to_scene_reference: !<MatrixTransform> {matrix: [0.9,0.1,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}\n";

typedef struct OcioCase {
    const char *colorspace, *interop;
} OcioCase;

/* In a child that has done nothing with colours yet. Its status says which case went wrong. */
static int check_config(const OcioCase *cases, int count)
{
    for (int k = 0; k < count; k++) {
        RetexImage im = one_color(3);
        RetexWriteParams params = RETEX_WRITE_INIT;
        params.colorspace = cases[k].colorspace;
        const char *path = test_in_folder("u.exr");
        if (retex_image_write(&im, path, &params, 1, NULL))
            return 100 + k;
        retex_image_free(&im);
        const RetexColorTag tag = header_of(path, 0);
        if (strcmp(tag.interop, cases[k].interop) != 0 ||
            tag.has_chromaticities != (retex_color_tag_find(cases[k].interop) != NULL))
            return 1 + k;
    }
    return 0;
}

static void in_config(const char *role, const OcioCase *cases, int count)
{
    const char *path = test_in_folder("c.ocio");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fprintf(file, config, role) > 0);
    assert_int_equal(fclose(file), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        setenv("OCIO", path, 1);
        _exit(check_config(cases, count));
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

/* By where its transforms lead, whatever the names; where the configuration does not say where its reference lies
 * nothing is claimed. */
static void test_ocio(void **state)
{
    (void)state;
    static const OcioCase known[] = {{"cg", "lin_ap1_scene"},
                                     {"ap0", "lin_ap0_scene"},
                                     {"log", "ocio:acescct_ap1_scene"},
                                     {"non", "data"},
                                     {"odd", ""},
                                     {"sRGB", "srgb_rec709_scene"},
                                     {NULL, "lin_rec709_scene"}},
                          unknown[] = {{"cg", ""}, {"ap0", ""}, {"log", ""}, {NULL, "lin_rec709_scene"}};
    in_config("aces_interchange: ap0,", known, 7);
    in_config("", unknown, 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ocio), /* first: nothing has loaded the bridge yet */
        cmocka_unit_test(test_matrices),
        cmocka_unit_test(test_written),
        cmocka_unit_test(test_read),
        cmocka_unit_test(test_read_others),
        cmocka_unit_test(test_names_of_openimageio),
        cmocka_unit_test(test_set_parts),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
