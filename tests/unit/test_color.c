/* Pictures through OpenImageIO and OpenColorIO: exact sRGB, alpha, greys, depths, colour spaces, $OCIO, and the
 * messages when a file cannot be read or written. */
#include "lib_folder.h"
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "picture/bridge_load.h"
#include "io/output.h"

/* Pictures that we do not write ourselves come from oiiotool. */
static void oiiotool(const char *arguments, const char *output)
{
    char command[1024];
    if (system("command -v oiiotool >/dev/null 2>&1") != 0)
        skip();
    snprintf(command, sizeof command, "oiiotool %s -o %s >/dev/null", arguments, output);
    assert_int_equal(system(command), 0);
}

static double srgb_to_linear(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static RetexImage read_picture(const char *path, const char *colorspace)
{
    RetexImage im = {0};
    RetexError err = {0};
    test_must(retex_bridge_read(&im, &(RetexBridgeFile){path, NULL, -1, colorspace, 0, "", 1, NULL, NULL}, &err), &err);
    assert_int_equal(im.channels, 4);
    return im;
}

static int append(void *output, const void *data, size_t bytes, RetexError *err)
{
    return retex_output_write(output, data, bytes, err);
}

/* Encode through the bridge, from samples that it stored in pieces of a few pixels. */
static int bridge_encode(const RetexImage *im, const char *path, const RetexWriteParams *params, RetexOutput *output,
                         RetexError *err)
{
    RetexBridgePlan *plan = NULL;
    RetexBridgeStored stored;
    int code = retex_bridge_plan(&plan, &stored, path, im->width, im->height, im->channels, params, err);
    if (code)
        return code;
    const size_t pixels = (size_t)im->width * (size_t)im->height,
                 bytes = (size_t)stored.channels * (size_t)stored.bits / 8;
    char *samples = malloc(pixels * bytes);
    assert_non_null(samples);
    for (size_t done = 0; !code && done < pixels;) {
        const size_t some = pixels - done < 7 ? pixels - done : 7;
        code = retex_bridge_convert(plan, im->pixels + done * (size_t)im->channels, (long)some, samples + done * bytes,
                                    err);
        done += some;
    }
    if (!code)
        code = retex_bridge_write(plan, samples, append, output, err);
    free(samples);
    retex_bridge_plan_free(&plan);
    return code;
}

/* Through the bridge whatever the format. */
static int bridge_write(const RetexImage *im, const char *path, const RetexWriteParams *params, RetexError *err)
{
    RetexOutput *output = NULL;
    int code = retex_output_open(&output, path, err);
    if (code)
        return code;
    code = bridge_encode(im, path, params, output, err);
    if (!code)
        return retex_output_commit(&output, err);
    retex_output_abandon(&output);
    return code;
}

static void write_picture(const RetexImage *im, const char *path, const char *colorspace)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexError err = {0};
    params.colorspace = colorspace;
    test_must(bridge_write(im, path, &params, &err), &err);
}

static RetexImage new_picture(int width, int height, int channels)
{
    RetexImage im = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&im, width, height, channels, &err), &err);
    return im;
}

/* In a child, before anything here has loaded the bridge: it looks at $OCIO once. */
static void in_child(const char *config, void (*body)(void))
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        setenv("OCIO", config, 1);
        body();
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

static void must_child(int condition, const char *what)
{
    if (!condition) {
        fprintf(stderr, "%s\n", what);
        _exit(1);
    }
}

static void check_wrong_ocio(void)
{
    RetexError err = {0};
    RetexImage im = {0};
    retex_image_alloc(&im, 2, 2, 3, NULL);
    must_child(bridge_write(&im, test_in_folder("x.png"), NULL, &err) == RETEX_EIO, "a wrong $OCIO is EIO");
    must_child(strstr(err.message, "$OCIO is '/nonexistent.ocio'") != NULL, err.message);
    must_child(access(test_in_folder("x.png"), F_OK) != 0, "nothing is written");
    retex_image_free(&im);
}

/* A configuration that works in ACEScg and knows no Rec.709 of its own, but for a name that ours has too. */
static const char other_config[] =
    "ocio_profile_version: 2\n"
    "roles: {default: ap0, scene_linear: cg, aces_interchange: ap0, data: non}\n"
    "file_rules:\n  - !<Rule> {name: Default, colorspace: default}\n"
    "displays:\n  Screen:\n    - !<View> {name: Show, colorspace: out}\n    - !<View> {name: Same, colorspace: cg}\n"
    "colorspaces:\n"
    "  - !<ColorSpace>\n    name: ap0\n"
    "  - !<ColorSpace>\n    name: cg\n    to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}\n"
    "  - !<ColorSpace>\n    name: non\n    isdata: true\n"
    "  - !<ColorSpace>\n    name: Rec709\n    to_scene_reference: !<MatrixTransform> {matrix: [3, 0, 0, 0, 0, 3, 0, 0, "
    "0, 0, 3, 0, 0, 0, 0, 1]}\n"
    "  - !<ColorSpace>\n    name: out\n    to_scene_reference: !<GroupTransform>\n      children:\n"
    "        - !<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055}\n"
    "        - !<BuiltinTransform> {style: UTILITY - ACES-AP1_to_LINEAR-REC709_BFD, direction: inverse}\n"
    "        - !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}\n";

static void check_other_ocio(void)
{
    RetexImage im = {0}, back = {0}, other = {0};
    RetexError err = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    test_random_image(&im, 16, 16, 3, 1, 0, 1);
    /* Its display shows Rec.709 as sRGB, so what comes back is what went in. */
    must_child(bridge_write(&im, test_in_folder("o.tif"), NULL, &err) == 0, err.message);
    must_child(retex_bridge_read(
                   &back, &(RetexBridgeFile){test_in_folder("o.tif"), NULL, -1, NULL, 0, "", 1, NULL, NULL}, &err) == 0,
               err.message);
    for (size_t i = 0; i < 256; i++)
        for (size_t c = 0; c < 3; c++)
            must_child(fabsf(back.pixels[4 * i + c] - im.pixels[3 * i + c]) < 1e-3f, "another configuration's display");
    retex_image_free(&back);
    /* Its own names and ours both mean something. */
    must_child(retex_bridge_read(&back,
                                 &(RetexBridgeFile){test_in_folder("o.tif"), NULL, -1, "non", 0, "", 1, NULL, NULL},
                                 &err) == 0,
               err.message);
    retex_image_free(&back);
    must_child(retex_bridge_read(&back,
                                 &(RetexBridgeFile){test_in_folder("o.tif"), NULL, -1, "ACEScct", 0, "", 1, NULL, NULL},
                                 &err) == 0,
               err.message);
    retex_image_free(&back);
    /* Of a name that both have, its own meaning: thrice as bright. */
    params.colorspace = "non";
    must_child(bridge_write(&im, test_in_folder("o.tif"), &params, &err) == 0, err.message);
    for (int own = 0; own < 2; own++) {
        must_child(retex_bridge_read(&back,
                                     &(RetexBridgeFile){test_in_folder("o.tif"), NULL, -1, own ? "Rec709" : "ap0", 0,
                                                        "", 1, NULL, NULL},
                                     &err) == 0,
                   err.message);
        for (size_t i = 0; i < 256; i++)
            for (size_t c = 0; c < 3 && own; c++)
                must_child(fabsf(back.pixels[4 * i + c] - 3 * other.pixels[4 * i + c]) < 1e-3f, "its own space");
        if (own)
            retex_image_free(&back);
        else
            other = back, back = (RetexImage){0};
    }
    retex_image_free(&other);
    params.colorspace = NULL;
    /* Its other view is its working space: ACEScg, with its values unencoded. */
    static const float ap1[3][3] = {
        {0.61310f, 0.33952f, 0.04738f}, {0.07019f, 0.91635f, 0.01345f}, {0.02062f, 0.10957f, 0.86981f}};
    params.view = "same";
    must_child(bridge_write(&im, test_in_folder("o.png"), &params, &err) == 0, err.message);
    must_child(retex_bridge_read(&back,
                                 &(RetexBridgeFile){test_in_folder("o.png"), NULL, -1, "non", 0, "", 1, NULL, NULL},
                                 &err) == 0,
               err.message);
    for (size_t i = 0; i < 256; i++)
        for (size_t c = 0; c < 3; c++) {
            const float *rgb = im.pixels + 3 * i, *m = ap1[c];
            const float is = back.pixels[4 * i + c], should = m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2];
            must_child(fabsf(is - should) < 0.6f / 255, "the view that was asked for");
        }
    retex_image_free(&back);
    params.view = "Standard";
    must_child(bridge_write(&im, test_in_folder("o.png"), &params, &err) == RETEX_ENOTFOUND, "no such view");
    must_child(strstr(err.message, "Show, Same") != NULL, err.message);
    retex_image_free(&im);
}

static void test_ocio(void **state)
{
    (void)state;
    in_child("/nonexistent.ocio", check_wrong_ocio);
    FILE *file = fopen(test_in_folder("other.ocio"), "w");
    assert_non_null(file);
    assert_true(fputs(other_config, file) >= 0);
    assert_int_equal(fclose(file), 0);
    in_child(test_in_folder("other.ocio"), check_other_ocio);
}

/* All 256 values of a PNG and all 65536 of a TIFF come back as they went in, and mean what IEC 61966-2-1 says. */
static void test_exact_srgb(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int width, height;
    } files[] = {{"e.png", 256, 1}, {"e.tif", 256, 256}};
    for (int k = 0; k < 2; k++) {
        int levels = files[k].width * files[k].height;
        RetexImage im = new_picture(files[k].width, files[k].height, 3);
        for (int i = 0; i < levels; i++)
            for (int c = 0; c < 3; c++)
                im.pixels[3 * i + c] = (float)srgb_to_linear((c == 1 ? levels - 1 - i : i) / (double)(levels - 1));
        write_picture(&im, test_in_folder(files[k].name), NULL);
        RetexImage back = read_picture(test_in_folder(files[k].name), NULL);
        for (int i = 0; i < levels; i++)
            for (int c = 0; c < 3; c++)
                assert_true(back.pixels[4 * i + c] == im.pixels[3 * i + c]);
        assert_true(back.pixels[3] == 1);
        retex_image_free(&back);
        back = read_picture(test_in_folder(files[k].name), "raw");
        for (int i = 0; i < levels; i++)
            assert_float_equal(back.pixels[4 * i], i / (double)(levels - 1), 1e-6);
        retex_image_free(&back);
        retex_image_free(&im);
    }
}

static void test_alpha(void **state)
{
    (void)state;
    RetexImage im = {0};
    test_random_image(&im, 20, 10, 4, 4, 0.05, 1);
    static const struct {
        const char *name;
        double tolerance;
        int alpha;
    } files[] = {
        {"a.png", 0.006, 1}, {"a.tif", 5e-5, 1}, {"a.exr", 2e-3, 1},  {"a.webp", 2, 1},
        {"a.tga", 0.006, 1}, {"a.bmp", 0.1, 1},  {"a.ppm", 0.006, 0}, {"a.pfm", 1e-6, 0},
    };
    for (size_t k = 0; k < sizeof files / sizeof files[0]; k++) {
        write_picture(&im, test_in_folder(files[k].name), NULL);
        RetexImage back = read_picture(test_in_folder(files[k].name), NULL);
        for (size_t i = 0; i < 200; i++) {
            float alpha = im.pixels[4 * i + 3];
            assert_float_equal(back.pixels[4 * i + 3], files[k].alpha ? alpha : 1, files[k].tolerance);
            for (size_t c = 0; c < 3; c++) /* without alpha: over black */
                assert_float_equal(back.pixels[4 * i + c], im.pixels[4 * i + c] * (files[k].alpha ? 1 : alpha),
                                   files[k].tolerance);
        }
        retex_image_free(&back);
    }
    retex_image_free(&im);
}

/* A TIFF's directory says what the fourth channel is: ExtraSamples, one, alpha that colours are not multiplied by. */
static void test_alpha_is_said(void **state)
{
    (void)state;
    const uint16_t tag[2] = {338, 3}, value = 2;
    const uint32_t count = 1;
    unsigned char entry[10];
    RetexImage im = {0};
    RetexError err = {0};
    size_t bytes;
    memcpy(entry, tag, 4), memcpy(entry + 4, &count, 4), memcpy(entry + 8, &value, 2);
    for (int channels = 3; channels <= 4; channels++) {
        test_random_image(&im, 20, 10, channels, channels, 0.05, 1);
        test_must(retex_image_write(&im, test_in_folder("said.tif"), NULL, 1, &err), &err);
        unsigned char *file = test_read_file(test_in_folder("said.tif"), &bytes);
        assert_int_equal(memmem(file, bytes, entry, sizeof entry) != NULL, channels == 4);
        free(file);
        retex_image_free(&im);
    }
}

static void test_grey(void **state)
{
    (void)state;
    RetexImage im = new_picture(1, 1, 1), back;
    im.pixels[0] = 0.5f;
    static const char *const names[] = {"g.png", "g.jpg", "g.exr", "g.hdr", "g.tif", "g.pfm"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        write_picture(&im, test_in_folder(names[k]), NULL);
        back = read_picture(test_in_folder(names[k]), NULL);
        for (int c = 0; c < 3; c++)
            assert_float_equal(back.pixels[c], 0.5, 0.005);
        assert_true(back.pixels[3] == 1);
        retex_image_free(&back);
    }
    retex_image_free(&im);
    /* grey and alpha */
    oiiotool("--pattern constant:color=0.2,0.5 5x4 2 --chnames Y,A --attrib oiio:UnassociatedAlpha 1 -d uint8",
             test_in_folder("ga.png"));
    back = read_picture(test_in_folder("ga.png"), NULL);
    for (int c = 0; c < 3; c++)
        assert_float_equal(back.pixels[c], back.pixels[0], 0);
    assert_true(back.pixels[0] > 0);
    assert_float_equal(back.pixels[3], 0.5, 0.003);
    retex_image_free(&back);
}

static void test_unusual_files(void **state)
{
    (void)state;
    RetexImage back;
    oiiotool("--pattern constant:color=0.25,0.5,2 70x30 3 -d half --compression dwaa", test_in_folder("dwaa.exr"));
    back = read_picture(test_in_folder("dwaa.exr"), NULL);
    assert_float_equal(back.pixels[2], 2, 0.01);
    retex_image_free(&back);
    oiiotool("--pattern constant:color=0.25,0.5,1 70x30 3 -d uint8 --tile 16 16", test_in_folder("tiled.tif"));
    back = read_picture(test_in_folder("tiled.tif"), NULL);
    assert_float_equal(back.pixels[4 * 2099], srgb_to_linear(64 / 255.0), 1e-6);
    retex_image_free(&back);
    /* many channels: colours are found by name */
    oiiotool("--pattern constant:color=.1,.2,.3,.4,.5,.6,.7 6x6 7 --chnames N.X,N.Y,N.Z,A,B,G,R -d float",
             test_in_folder("many.exr"));
    back = read_picture(test_in_folder("many.exr"), NULL);
    const double want[4] = {0.7 / 0.4, 0.6 / 0.4, 0.5 / 0.4, 0.4};
    for (int c = 0; c < 4; c++)
        assert_float_equal(back.pixels[c], want[c], 1e-5);
    retex_image_free(&back);
    /* a data window smaller than what is shown */
    oiiotool("--pattern constant:color=1,1,1 4x4 3 --origin +2+3 --fullsize 10x8+0+0 -d half",
             test_in_folder("window.exr"));
    back = read_picture(test_in_folder("window.exr"), NULL);
    assert_int_equal(back.width, 10);
    assert_int_equal(back.height, 8);
    assert_true(back.pixels[retex_image_index(&back, 2, 3)] == 1 && back.pixels[retex_image_index(&back, 1, 3)] == 0);
    retex_image_free(&back);
    /* and where what is shown does not begin at 0: only the part of it that has data */
    oiiotool("--pattern constant:color=1,1,1 4x4 3 --origin +2+3 --fullsize 10x8+1+5 -d half", test_in_folder("w.exr"));
    back = read_picture(test_in_folder("w.exr"), NULL);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 10; x++)
            assert_true(back.pixels[retex_image_index(&back, x, y)] == (x >= 1 && x < 5 && y < 2));
    retex_image_free(&back);
    /* PNG says how it is encoded: linear, or by a gamma */
    oiiotool("--pattern constant:color=0.5,0.25,0.75 4x4 3 --attrib oiio:ColorSpace Linear -d uint16",
             test_in_folder("linear.png"));
    back = read_picture(test_in_folder("linear.png"), NULL);
    assert_float_equal(back.pixels[0], 0.5, 1e-4);
    assert_float_equal(back.pixels[1], 0.25, 1e-4);
    retex_image_free(&back);
    oiiotool("--pattern constant:color=0.5,0.25,0.75 4x4 3 --attrib oiio:ColorSpace GammaCorrected "
             "--attrib oiio:Gamma 1.8 -d uint16",
             test_in_folder("gamma.png"));
    back = read_picture(test_in_folder("gamma.png"), NULL);
    assert_float_equal(back.pixels[0], pow(0.5, 1.8), 1e-3);
    assert_float_equal(back.pixels[2], pow(0.75, 1.8), 1e-3);
    retex_image_free(&back);
}

/* The eight EXIF orientations of a picture whose upright top left corner is red and top right corner green. */
static void test_orientation(void **state)
{
    (void)state;
    for (int o = 1; o <= 8; o++) {
        char arguments[256], name[32];
        snprintf(name, sizeof name, "turned%d.tif", o);
        /* --orient and its kin change pixels; the inverse of what a viewer does is what a camera stored */
        static const char *const stored[] = {
            "",          "--flop", "--rotate180", "--flip", "--transpose", "--rotate270", "--transpose --rotate180",
            "--rotate90"};
        snprintf(arguments, sizeof arguments,
                 "--pattern constant:color=0,0,0 6x4 3 --fill:color=1,0,0 2x2+0+0 --fill:color=0,1,0 2x2+4+0 %s "
                 "--attrib:type=int Orientation %d -d uint8",
                 stored[o - 1], o);
        oiiotool(arguments, test_in_folder(name));
        RetexImage im = read_picture(test_in_folder(name), NULL);
        assert_int_equal(im.width, 6);
        assert_int_equal(im.height, 4);
        assert_true(im.pixels[0] == 1 && im.pixels[1] == 0);
        assert_true(im.pixels[retex_image_index(&im, 5, 0) + 1] == 1 && im.pixels[retex_image_index(&im, 5, 0)] == 0);
        assert_true(im.pixels[retex_image_index(&im, 0, 3)] == 0 && im.pixels[retex_image_index(&im, 5, 3) + 1] == 0);
        retex_image_free(&im);
    }
}

static void test_colorspaces(void **state)
{
    (void)state;
    static const char *const names[] = {"linear",     "sRGB",    "srgb", "Rec709", "ACEScg",       "acescg",
                                        "ACES2065-1", "ACEScct", "raw",  "data",   "scene_linear", "lin_rec709"};
    RetexImage im = {0};
    test_random_image(&im, 16, 16, 3, 8, 0.01, 0.9);
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        write_picture(&im, test_in_folder("c.pfm"), names[k]);
        RetexImage back = read_picture(test_in_folder("c.pfm"), names[k]);
        for (size_t i = 0; i < 256; i++)
            for (size_t c = 0; c < 3; c++)
                assert_float_equal(back.pixels[4 * i + c], im.pixels[3 * i + c], 2e-5);
        retex_image_free(&back);
    }
    /* Known values: grey stays grey under a change of primaries, and red of Rec.709 in ACEScg is (.6131, .0702,
     * .0206). */
    for (int i = 0; i < 2; i++)
        memcpy(im.pixels + 3 * i, i ? (float[3]){1, 0, 0} : (float[3]){0.18f, 0.18f, 0.18f}, 12);
    write_picture(&im, test_in_folder("c.pfm"), "ACEScg");
    RetexImage back = read_picture(test_in_folder("c.pfm"), "raw");
    const double want[6] = {0.18, 0.18, 0.18, 0.6131, 0.0702, 0.0206};
    for (int i = 0; i < 6; i++)
        assert_float_equal(back.pixels[4 * (i / 3) + i % 3], want[i], 2e-4);
    retex_image_free(&back);
    write_picture(&im, test_in_folder("c.pfm"), "ACEScct"); /* middle grey of ACEScct is .4135884 */
    back = read_picture(test_in_folder("c.pfm"), "raw");
    assert_float_equal(back.pixels[0], 0.4135884, 1e-4);
    retex_image_free(&back);
    retex_image_free(&im);
}

static void test_mistakes(void **state)
{
    (void)state;
    RetexImage im = new_picture(3, 2, 3), back = {0}, two = new_picture(3, 2, 2);
    RetexError err = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    const struct {
        const char *path;
        int code;
        const char *says;
    } writes[] = {
        {"x", RETEX_EINVAL, "no ending"},
        {"x.nope", RETEX_EINVAL, ".nope"},
    };
    for (size_t i = 0; i < sizeof writes / sizeof writes[0]; i++) {
        assert_int_equal(bridge_write(&im, test_in_folder(writes[i].path), NULL, &err), writes[i].code);
        assert_non_null(strstr(err.message, writes[i].says));
        assert_string_equal(err.file, test_in_folder(writes[i].path));
    }
    assert_int_equal(bridge_write(&two, test_in_folder("x.png"), NULL, &err), RETEX_EINVAL);
    /* a full disk, for each way of writing */
    static const char *const full[] = {"full.png", "full.jpg", "full.tif", "full.hdr", "full.exr", "full.pfm"};
    for (size_t i = 0; i < sizeof full / sizeof full[0]; i++) {
        assert_int_equal(symlink("/dev/full", test_in_folder(full[i])), 0);
        assert_int_equal(bridge_write(&im, test_in_folder(full[i]), NULL, &err), RETEX_EIO);
        assert_non_null(strstr(err.message, "No space left"));
    }
    params.colorspace = "Bleu";
    assert_int_equal(bridge_write(&im, test_in_folder("x.png"), &params, &err), RETEX_ENOTFOUND);
    assert_non_null(strstr(err.message, "'Bleu'; there are Linear Rec.709, sRGB"));
    params = (RetexWriteParams)RETEX_WRITE_INIT;
    params.display = "Cinema";
    assert_int_equal(bridge_write(&im, test_in_folder("x.png"), &params, &err), RETEX_ENOTFOUND);
    assert_non_null(strstr(err.message, "there are sRGB"));
    assert_int_equal(access(test_in_folder("x.png"), F_OK), -1);

    write_picture(&im, test_in_folder("fine.png"), NULL);
    assert_int_equal(
        retex_bridge_read(&back, &(RetexBridgeFile){test_in_folder("fine.png"), NULL, -1, NULL, 5, "", 1, NULL, NULL},
                          &err),
        RETEX_ELIMIT);
    assert_int_equal(
        retex_bridge_read(&back, &(RetexBridgeFile){test_in_folder("fine.png"), NULL, -1, "Bleu", 0, "", 1, NULL, NULL},
                          &err),
        RETEX_ENOTFOUND);
    assert_int_equal(
        retex_bridge_read(&back, &(RetexBridgeFile){test_in_folder("none.png"), NULL, -1, NULL, 0, "", 1, NULL, NULL},
                          &err),
        RETEX_EIO);
    assert_int_equal(
        retex_bridge_read(&back, &(RetexBridgeFile){test_folder, NULL, -1, NULL, 0, "", 1, NULL, NULL}, &err),
        RETEX_EIO);
    assert_non_null(strstr(err.message, "folder"));
    static const char *const bad[] = {"empty.png", "text.png", "cut.tif"};
    write_picture(&im, test_in_folder(bad[2]), NULL);
    assert_int_equal(truncate(test_in_folder(bad[2]), 60), 0);
    for (int i = 0; i < 2; i++) {
        FILE *file = fopen(test_in_folder(bad[i]), "w");
        assert_non_null(file);
        if (i)
            fputs("this is no picture\n", file);
        fclose(file);
    }
    for (int i = 0; i < 3; i++) {
        assert_int_equal(
            retex_bridge_read(&back, &(RetexBridgeFile){test_in_folder(bad[i]), NULL, -1, NULL, 0, "", 1, NULL, NULL},
                              &err),
            RETEX_EFORMAT);
        assert_null(back.pixels);
        assert_true(err.message[0] != '\0');
    }
    retex_image_free(&im);
    retex_image_free(&two);
}

/* NaN, infinities and negative light leave as something a viewer can show. */
static void test_wild_values(void **state)
{
    (void)state;
    RetexImage im = new_picture(4, 1, 3);
    for (int i = 0; i < 3; i++) {
        im.pixels[i] = NAN;
        im.pixels[3 + i] = INFINITY;
        im.pixels[6 + i] = -1;
        im.pixels[9 + i] = 1e6f;
    }
    write_picture(&im, test_in_folder("wild.png"), NULL);
    RetexImage back = read_picture(test_in_folder("wild.png"), NULL);
    assert_true(back.pixels[0] == 0 && back.pixels[4] == 1 && back.pixels[8] == 0 && back.pixels[12] == 1);
    retex_image_free(&back);
    write_picture(&im, test_in_folder("wild.exr"), NULL);
    back = read_picture(test_in_folder("wild.exr"), NULL);
    assert_true(back.pixels[8] == -1 && back.pixels[12] == 65504);
    retex_image_free(&back);
    retex_image_free(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ocio), /* first: it must load the bridge in children */
        cmocka_unit_test(test_exact_srgb),    cmocka_unit_test(test_alpha),       cmocka_unit_test(test_grey),
        cmocka_unit_test(test_alpha_is_said),
        cmocka_unit_test(test_unusual_files), cmocka_unit_test(test_orientation), cmocka_unit_test(test_colorspaces),
        cmocka_unit_test(test_mistakes),      cmocka_unit_test(test_wild_values),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
