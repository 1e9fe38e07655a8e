/* text: outlines as FreeType's own rasteriser fills them, places as POV-Ray has them (measured by its min_extent and
 * max_extent), crossings against inside(), and fonts that are damaged. */
#include "lib_scene_text.h"
#include "lib_shape.h"
#include "shape/surface.h"
#include "shape/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#define FONTS "/usr/share/fonts/truetype/povray/"

/* Every pixel that FreeType fills wholly is inside, every one that it leaves empty is outside: pixels of the glyph at
 * 200 pixels for the font's size. A ray along z and a ray across agree. */
static void compare_with_raster(const Primitive *p, FT_Face face, unsigned long character)
{
    enum { SIZE = 200, MARGIN = 8 };
    static unsigned char pixels[2 * SIZE][2 * SIZE];
    FT_Bitmap bitmap = {.rows = 2 * SIZE,
                        .width = 2 * SIZE,
                        .pitch = 2 * SIZE,
                        .buffer = &pixels[0][0],
                        .num_grays = 256,
                        .pixel_mode = FT_PIXEL_MODE_GRAY};
    const double shift_x = p->transform.m[0][3];
    int full = 0;

    memset(pixels, 0, sizeof pixels);
    assert_int_equal(FT_Set_Pixel_Sizes(face, 0, SIZE), 0);
    assert_int_equal(FT_Load_Char(face, character, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP), 0);
    FT_Outline_Translate(&face->glyph->outline, SIZE / 2 * 64, SIZE / 2 * 64);
    assert_int_equal(FT_Outline_Get_Bitmap(face->glyph->library, &face->glyph->outline, &bitmap), 0);
    for (int y = MARGIN; y < 2 * SIZE - MARGIN; y++)
        for (int x = MARGIN; x < 2 * SIZE - MARGIN; x++) {
            int lowest = 255, highest = 0;
            /* FreeType rounds outlines to 64ths of a pixel: the neighbours must agree. */
            for (int k = 0; k < 9; k++) {
                const int v = pixels[2 * SIZE - 1 - (y + k / 3 - 1)][x + k % 3 - 1];
                lowest = v < lowest ? v : lowest;
                highest = v > highest ? v : highest;
            }
            if (lowest < 255 && highest > 0)
                continue;
            const Vec3 at = vec3(shift_x + (x + 0.5 - SIZE / 2.0) / SIZE, (y + 0.5 - SIZE / 2.0) / SIZE, 0.1);
            const Ray front = {vec3(at.x, at.y, -3), vec3(0, 0, 1), 0, 100};
            double t;
            int hit_face = -1;
            assert_int_equal(test_inside(p, at), lowest == 255);
            assert_int_equal(shape_intersect(p, &front, &t, &hit_face), lowest == 255);
            if (lowest == 255) {
                assert_near(t, 3);
                assert_int_equal(hit_face, 0);
            }
            full += lowest == 255;
        }
    assert_true(full > 100);
}

static void test_outlines(void **state)
{
    static const char *const fonts[] = {"timrom.ttf", "cyrvetic.ttf", "crystal.ttf"};
    static const char letters[] = "A8&@gR%";
    FT_Library library;
    (void)state;
    assert_int_equal(FT_Init_FreeType(&library), 0);
    for (int f = 0; f < 3; f++) {
        char path[200];
        FT_Face face;
        snprintf(path, sizeof path, FONTS "%s", fonts[f]);
        assert_int_equal(FT_New_Face(library, path, 0, &face), 0);
        for (int i = 0; letters[i]; i++) {
            char text[200];
            snprintf(text, sizeof text, V37 "text{ttf \"%s\" \"%c\" .25, 0}", fonts[f], letters[i]);
            Scene *scene = parse(text);
            compare_with_raster(only(scene), face, (unsigned char)letters[i]);
            scene_close(&scene);
        }
        FT_Done_Face(face);
    }
    FT_Done_FreeType(library);
}

static void extent_of(const Scene *scene, Vec3 *low, Vec3 *high)
{
    *low = vec3(INFINITY, INFINITY, INFINITY);
    *high = vec_neg(*low);
    for (int i = 0; i < scene->nprimitives; i++) {
        Vec3 a, b;
        assert_true(shape_bounds(&scene->primitives[i], &a, &b));
        shape_bound_point(low, high, a);
        shape_bound_point(low, high, b);
    }
}

static void test_places(void **state)
{
    static const struct {
        const char *text;
        double low_y, high_x, high_y;
    } cases[] = {
        /* by POV-Ray 3.7.0.10, which widens its boxes by about 1e-5 */
        {"ttf \"timrom.ttf\" \"A\" .25, 0", 0, .736, .696},
        {"ttf \"timrom.ttf\" \"V\" .25, 0", -.016, .721, .68},
        {"ttf \"timrom.ttf\" \"AV\" .25, 0", -.016, 1.278, .696},
        {"ttf \"timrom.ttf\" \"AVA\" .25 0", -.016, 1.873, .696},
        {"ttf \"timrom.ttf\" \"A V\" .25, 0", -.016, 1.719, .696},
        {"ttf \"timrom.ttf\" \"AV\" .25, .1", 0, 1.378, .78},
        {"ttf \"timrom.ttf\" \"AVA\" .25, <.1,.2,.3>", 0, 2.073, 1.096},
        {"ttf \"timrom.ttf\" \"  A\" .25, <.1,.2,.3>", .4, 1.45, 1.096},
        {"ttf \"cyrvetic.ttf\" \"AV\" .25, 0", 0, 1.188, .728},
        {"ttf \"povlogo.ttf\" \"P\" .25, 0", .001953, .669922, 1.001953},
        {"internal 0 \"AV\" .25, 0", .001953, 1.669922, 1.001953},
        {"internal 1 \"AV\" .25, 0", -.016, 1.278, .696},
        {"internal 2 \"AV\" .25, 0", 0, 1.188, .728},
        {"internal 3 \"P\" .25, 0", -.000977, .312988, .675781},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[200];
        Vec3 low, high;
        snprintf(text, sizeof text, V37 "text{%s}", cases[i].text);
        Scene *scene = parse(text);
        extent_of(scene, &low, &high);
        if (fabs(high.x - cases[i].high_x) > 2e-5 || fabs(high.y - cases[i].high_y) > 2e-5 ||
            fabs(low.y - cases[i].low_y) > 2e-5 || fabs(high.z - .25) > 1e-9 || low.z != 0)
            fail_msg("%s: y from %g, to %g %g %g", cases[i].text, low.y, high.x, high.y, high.z);
        scene_close(&scene);
    }
}

static void test_crossings(void **state)
{
    static const double scales[] = {1e-4, 1e-2, 1, 1e2, 1e5};
    uint32_t random = 7;
    (void)state;
    for (size_t s = 0; s < sizeof scales / sizeof *scales; s++)
        for (int k = 0; k < 4; k++) {
            char text[300];
            snprintf(text, sizeof text,
                     V37 "text{ttf \"timrom.ttf\" \"%c\" %g, 0 rotate <10,20,%d> scale %g translate %g*<1,2,3>}",
                     "&@e8"[k], k == 3 ? -.3 : .3, k * 30, scales[s], k == 1 ? 30 * scales[s] : 0);
            Scene *scene = parse(text);
            const Primitive *p = only(scene);
            Vec3 low, high;
            assert_true(shape_bounds(p, &low, &high));
            const Vec3 centre = vec_scale(vec_add(low, high), 0.5);
            const int count = test_shape_crossings(p, centre, 0.6 * scales[s], 400, 1e-9, &random);
            assert_true(count > 400);
            scene_close(&scene);
        }
}

/* Rays in canonical space that meet corners and run along edges exactly: what lies inside on either side of the ray is
 * between crossings, what lies outside on both is not. */
static void test_along_edges(void **state)
{
    Scene *scene = parse(V37 "text{ttf \"cyrvetic.ttf\" \"H\" .25, 0}");
    const Primitive *p = only(scene);
    const Glyph *glyph = p->shape.data;
    (void)state;
    assert_int_equal(glyph->ncurves, 12);
    for (int i = 0; i < 2 * glyph->ncurves; i++) {
        const Vec2 a = glyph->curves[i / 2].p[0];
        const int k = i % 2;
        ShapeRay ray = {vec3(k ? a.u : -3, k ? -3 : a.v, .1), vec3(!k, k, 0), 0, 10, 0};
        double ends[100], t;
        int count = 0, face;
        for (; p->shape.ops->intersect(p, &ray, &t, &face); ray.tmin = t)
            ends[count++] = t;
        assert_int_equal(count % 2, 0);
        for (t = 2.0005; t < 5; t += 0.003) {
            const Vec3 at = vec_mad(ray.origin, ray.direction, t), off = vec3(1e-9 * k, 1e-9 * !k, 0);
            const int one = p->shape.ops->inside(&p->shape, vec_add(at, off));
            const int other = p->shape.ops->inside(&p->shape, vec_sub(at, off));
            int before = 0;
            while (before < count && ends[before] < t)
                before++;
            if (one == other)
                assert_int_equal(before % 2, one);
        }
    }
    scene_close(&scene);
}

static void test_natural_uv(void **state)
{
    Scene *scene = parse(V37 "text{ttf \"cyrvetic.ttf\" \"H\" .25, 0}");
    const Primitive *p = only(scene);
    const Ray rays[2] = {{vec3(.05, .1, -1), vec3(0, 0, 1), 0, 10}, {vec3(.05, .1, 2), vec3(0, 0, -1), 0, 10}};
    (void)state;
    for (int i = 0; i < 2; i++) {
        Hit hit = {.primitive = 0};
        Surface s;
        assert_true(shape_intersect(p, &rays[i], &hit.t, &hit.face));
        surface_at(&s, scene, &rays[i], &hit);
        const SurfaceUv uv = surface_uv(&s);
        assert_int_equal(hit.face, i);
        assert_true(uv.has_natural);
        assert_near(uv.natural.v, .1);
        assert_near(uv.natural.u, (i == 0 ? 1 : -1) * (.05 - p->transform.m[0][3]));
        assert_near(uv.uv.u, .05); /* uv_mapping: of the point */
    }
    scene_close(&scene);
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

/* Cut short, changed: a text, or one error. */
static void test_damaged_fonts(void **state)
{
    char folder[] = "/tmp/test_text_XXXXXX", path[100], text[200];
    static unsigned char bytes[60000], damaged[60000];
    uint32_t random = 3;
    int refused = 0;
    (void)state;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.ttf", folder);
    snprintf(text, sizeof text, V37 "text{ttf \"%s\" \"Ag8&\" .25, 0}", "a.ttf");
    FILE *file = fopen(FONTS "cyrvetic.ttf", "rb");
    assert_non_null(file);
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    const char *folders[] = {folder};
    for (int i = 0; i < 400; i++) {
        Scene *scene;
        RetexError err = {0};
        SdlOptions options = SDL_OPTIONS_INIT;
        options.include_paths = folders;
        options.ninclude_paths = 1;
        memcpy(damaged, bytes, size);
        for (int k = 0; k < 1 + i % 20; k++)
            damaged[(size_t)(test_random(&random) * (double)(i % 3 ? size : 300))] =
                (unsigned char)(256 * test_random(&random));
        write_file(path, damaged, i % 4 == 0 ? (size_t)(test_random(&random) * (double)size) : size);
        if (parse_with(&scene, text, &options, &err)) {
            assert_null(strchr(err.message, '\n'));
            refused++;
        } else
            scene_close(&scene);
    }
    assert_true(refused > 50 && refused < 400);
    unlink(path);
    rmdir(folder);
}

static void test_errors(void **state)
{
    (void)state;
    expect_error(V37 "text{ttf \"colors.inc\" \"A\" 1, 0}", "is no TrueType or OpenType font");
    expect_error(V37 "text{\"timrom.ttf\" \"A\" 1, 0}", "expected ttf or internal in text");
    Scene *scene = parse(V37 "text{ttf \"timrom.ttf\" \" \" 1, 0} text{ttf \"timrom.ttf\" \"A\" 0, 0}");
    assert_int_equal(scene->nprimitives, 0);
    assert_non_null(strstr(messages, "a text without thickness"));
    scene_close(&scene);
}

/* A name without its ending is the same font; a font that is not there is cyrvetic.ttf, and the user is told. */
static void test_names(void **state)
{
    (void)state;
    static const char *const names[] = {"cyrvetic.ttf", "cyrvetic", "nowhere.ttf"};
    double widths[3];
    for (int i = 0; i < 3; i++) {
        char text[128];
        Vec3 low, high;
        snprintf(text, sizeof text, V37 "text{ttf \"%s\" \"W\" 1, 0}", names[i]);
        Scene *scene = parse(text);
        assert_int_equal(scene->nprimitives, 1);
        assert_int_equal(shape_bounds(&scene->primitives[0], &low, &high), 1);
        widths[i] = high.x - low.x;
        assert_int_equal(strstr(messages, "the font `nowhere.ttf` is not in the folders") != NULL, i == 2);
        scene_close(&scene);
    }
    assert_true(widths[0] == widths[1] && widths[0] == widths[2]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_outlines),    cmocka_unit_test(test_places),     cmocka_unit_test(test_crossings),
        cmocka_unit_test(test_along_edges), cmocka_unit_test(test_natural_uv), cmocka_unit_test(test_damaged_fonts),
        cmocka_unit_test(test_errors),      cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
