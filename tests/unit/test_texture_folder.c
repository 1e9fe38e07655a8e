/* Folders as textures: which file is the base colour, by the names that libraries of textures give. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <ftw.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/retex.h>

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *where)
{
    (void)info, (void)type, (void)where;
    return remove(path);
}

static int make_tree(void **state)
{
    return test_make_folder(state) || chdir(test_folder);
}

static int remove_tree(void **state)
{
    (void)state;
    return chdir("/") || nftw(test_folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

static void make_file(const char *folder, const char *name)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fclose(file), 0);
}

/* A folder with these files, and others within; names end with NULL. */
static void make_folder(const char *folder, const char *const *names)
{
    char path[PATH_MAX];
    if (access(folder, F_OK) == 0)
        assert_int_equal(nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS), 0);
    assert_int_equal(mkdir(folder, 0777), 0);
    for (; *names; names++) {
        const char *slash = strchr(*names, '/');
        snprintf(path, sizeof path, "%s/%.*s", folder, slash ? (int)(slash - *names) : 0, *names);
        mkdir(path, 0777);
        if (!slash || slash[1])
            make_file(folder, *names);
    }
}

/* The file of a folder, or the message. */
static char *find(const char *image, const RetexAccess *access, int *code)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    char *file = NULL;
    snprintf(spec.image, sizeof spec.image, "%s", image);
    spec.access = access;
    *code = retex_texture_file(&file, &spec, RETEX_TEXTURE_FILE_IMAGE, &err);
    assert_int_equal(*code, err.code);
    assert_int_equal(!file, *code != 0);
    return file ? file : strdup(err.message);
}

static void assert_found(const char *image, const char *expected, int expected_code)
{
    int code;
    char *found = find(image, NULL, &code);
    assert_string_equal(found, expected);
    assert_int_equal(code, expected_code);
    free(found);
}

#define FOUND(expected, ...)                                                                                           \
    do {                                                                                                               \
        make_folder("oak", (const char *const[]){__VA_ARGS__, NULL});                                                  \
        assert_found("oak", "oak/" expected, 0);                                                                       \
        assert_found("oak///", "oak/" expected, 0);                                                                    \
    } while (0)
#define REFUSED(expected, ...)                                                                                         \
    do {                                                                                                               \
        make_folder("oak", (const char *const[]){__VA_ARGS__, NULL});                                                  \
        assert_found("oak/", "oak: " expected, RETEX_EFORMAT);                                                         \
    } while (0)
#define NO_COLOR "a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has "

static void test_schemes(void **state)
{
    (void)state;
    FOUND("oak_diff_2k.jpg", "oak_diff_2k.jpg", "oak_rough_2k.exr", "oak_nor_gl_2k.exr", "oak_nor_dx_2k.exr",
          "oak_arm_2k.jpg", "oak_ao_2k.jpg", "oak_disp_2k.png", "oak_spec_2k.jpg");
    FOUND("textures/oak_diffuse_1k.png", "oak_1k.blend", "textures/oak_diffuse_1k.png", "textures/oak_rough_1k.jpg");
    FOUND("Textures/oak_col_4k.jpg", "oak.gltf", "Textures/oak_col_4k.jpg");
    FOUND("rough_oak_03_diff_2k.jpg", "rough_oak_03_diff_2k.jpg", "rough_oak_03_rough_2k.jpg");
    FOUND("cloth_col_01_2k.jpg", "cloth_col_01_2k.jpg", "cloth_ao_2k.jpg");
    FOUND("Wood051_2K-JPG_Color.jpg", "Wood051_2K-JPG_AmbientOcclusion.jpg", "Wood051_2K-JPG_Color.jpg",
          "Wood051_2K-JPG_Displacement.jpg", "Wood051_2K-JPG_Metalness.jpg", "Wood051_2K-JPG_NormalDX.jpg",
          "Wood051_2K-JPG_NormalGL.jpg", "Wood051_2K-JPG_Opacity.jpg", "Wood051_2K-JPG_Roughness.jpg", "Wood051.png",
          "Wood051_2K-JPG.usdc");
    static const char *const plain[] = {"basecolor.tif",   "base_color.exr", "albedo.PNG",    "DIFFUSE.TGA",
                                        "color.webp",      "Colour.JPEG",    "BaseColor.hdr", "base color.jpg",
                                        "Base-Color.tiff", "x.albedo.jpg",   "col.bmp"};
    for (size_t i = 0; i < sizeof plain / sizeof *plain; i++) {
        char expected[64];
        make_folder("oak", (const char *const[]){plain[i], "roughness.png", "normal.png", "metallic.png", "ao.png",
                                                 "height.png", NULL});
        snprintf(expected, sizeof expected, "oak/%s", plain[i]);
        assert_found("oak", expected, 0);
    }
}

static void test_several_forms(void **state)
{
    (void)state;
    FOUND("oak_diff_4k.jpg", "oak_diff_1k.jpg", "oak_diff_4k.jpg", "oak_diff_2k.jpg");
    FOUND("oak_diff_16k.jpg", "oak_diff_8k.jpg", "oak_diff_16k.jpg", "oak_diff.jpg");
    FOUND("oak_4096_color.jpg", "oak_512_color.png", "oak_4096_color.jpg", "oak_2048x2048_color.png");
    FOUND("oak_diff_2k.png", "oak_diff_2k.jpg", "oak_diff_2k.png", "oak_diff_1k.exr");
    FOUND("oak_diff_2k.exr", "oak_diff_2k.jpg", "oak_diff_2k.png", "oak_diff_2k.exr");
    FOUND("o_8K-PNG_Color.png", "o_8K-JPG_Color.jpg", "o_8K-PNG_Color.png");
    FOUND("Oak_DIFF_2K.jpg", "oak_diff_1k.jpg", "Oak_DIFF_2K.jpg");
    FOUND("oak_diff_2k.jpg", "oak_diff_2k.jpg", "textures/oak_diff_2k.jpg");
    FOUND("textures/oak_diff_4k.jpg", "oak_diff_2k.jpg", "textures/oak_diff_4k.jpg");
}

static void test_refused(void **state)
{
    (void)state;
    REFUSED(NO_COLOR "no files", "textures/");
    REFUSED(NO_COLOR "roughness, normal and opacity maps", "Oak_NormalGL.png", "Oak_Opacity.png", "Oak_Roughness.png",
            "Oak.png");
    REFUSED(NO_COLOR "an ambient occlusion map", "oak_ao_2k.jpg");
    REFUSED(NO_COLOR "roughness, metalness and ambient occlusion maps", "oak_arm_2k.jpg");
    REFUSED(NO_COLOR "a.jpg", "a.jpg");
    REFUSED(NO_COLOR "a.jpg, b.jpg, c.txt and 2 more", "c.txt", "e", "b.jpg", "d.png", "a.jpg");
    REFUSED(NO_COLOR "color, color., color.txt", "color.txt", "color", "color.", ".color.jpg", "._oak_diff_2k.jpg",
            "other/oak_diff_2k.jpg");
    REFUSED(NO_COLOR "oak_diffident.jpg", "oak_diffident.jpg");
    REFUSED("a folder with several base colours, such as oak_col_01_2k.jpg and oak_col_02_2k.jpg: name one of them",
            "oak_col_02_2k.jpg", "oak_col_03_2k.jpg", "oak_col_01_1k.jpg", "oak_col_01_2k.jpg");
    REFUSED(
        "a folder with several base colours, such as oak_diff_2k.jpg and textures/pine_diff_2k.jpg: name one of them",
        "oak_diff_2k.jpg", "textures/pine_diff_2k.jpg");
}

/* Folders that are called as files, links, devices. */
static void test_odd_entries(void **state)
{
    (void)state;
    make_folder("oak", (const char *const[]){"color.jpg/", "textures/", NULL});
    assert_int_equal(mkdir("oak/textures/textures", 0777), 0);
    make_file("oak/textures/textures", "color.jpg");
    assert_found("oak", "oak: " NO_COLOR "no files", RETEX_EFORMAT);
    FOUND("color.png", "color.jpg/", "color.png");
    assert_int_equal(mkfifo("oak/diffuse.png", 0666), 0);
    assert_found("oak", "oak/color.png", 0);
    make_folder("linked", (const char *const[]){"x", NULL});
    assert_int_equal(symlink("../oak/color.png", "linked/color.png"), 0);
    assert_found("linked", "linked/color.png", 0);
    assert_int_equal(symlink("linked", "to-linked"), 0);
    assert_found("to-linked/", "to-linked/color.png", 0);
    assert_found("none", "none", 0); /* what is no folder stays itself */
    assert_found("oak/color.png", "oak/color.png", 0);
    assert_found("-", "-", 0);
}

static void test_unreadable(void **state)
{
    (void)state;
    struct rlimit limit, none;
    make_folder("oak", (const char *const[]){"color.png", NULL});
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &limit), 0);
    none = limit;
    none.rlim_cur = 0; /* root may read everything, but not without a descriptor */
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &none), 0);
    int code;
    char *found = find("oak", NULL, &code);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &limit), 0);
    assert_string_equal(found, "cannot read oak: Too many open files");
    assert_int_equal(code, RETEX_EIO);
    free(found);
}

static void test_very_many(void **state)
{
    (void)state;
    char name[32], expected[160];
    make_folder("many", (const char *const[]){"oak_diff_2k.jpg", NULL});
    for (int i = 0; i < 5000; i++) {
        snprintf(name, sizeof name, "file%04d.jpg", (i * 7919) % 5000);
        make_file("many", name);
    }
    assert_found("many", "many/oak_diff_2k.jpg", 0);
    assert_int_equal(unlink("many/oak_diff_2k.jpg"), 0);
    snprintf(expected, sizeof expected, "many: %sfile0000.jpg, file0001.jpg, file0002.jpg and 4997 more", NO_COLOR);
    assert_found("many", expected, RETEX_EFORMAT);
    for (int i = 0; i < 1000; i++) {
        snprintf(name, sizeof name, "oak%04d_color.jpg", (i * 7919) % 1000);
        make_file("many", name);
    }
    assert_found(
        "many",
        "many: a folder with several base colours, such as oak0000_color.jpg and oak0001_color.jpg: name one of "
        "them",
        RETEX_EFORMAT);
}

static void test_long_names(void **state)
{
    (void)state;
    char name[NAME_MAX + 1], expected[NAME_MAX + 16], longest[sizeof((RetexTextureSpec *)0)->image] = "";
    memset(name, 'a', sizeof name);
    strcpy(name + NAME_MAX - 10, "_color.jpg");
    make_folder("oak", (const char *const[]){name, NULL});
    snprintf(expected, sizeof expected, "oak/%s", name);
    assert_found("oak", expected, 0);
    for (int i = 0; i < NAME_MAX - 10; i += 2)
        name[i] = '_';
    make_folder("oak", (const char *const[]){name, NULL});
    snprintf(expected, sizeof expected, "oak/%s", name);
    assert_found("oak", expected, 0);
    while (strlen(longest) + 6 < sizeof longest) /* the path of the file is longer than a spec's image */
        strcat(longest, "./");
    strcat(longest, "oak");
    int code;
    char *found = find(longest, NULL, &code);
    assert_int_equal(code, 0);
    assert_true(strlen(found) > sizeof longest && access(found, R_OK) == 0);
    free(found);
}

/* Safe access: neither folders nor links lead out of the roots. */
static void test_access(void **state)
{
    (void)state;
    char root[PATH_MAX];
    const char *roots[] = {root};
    RetexAccess access = RETEX_ACCESS_INIT;
    const struct {
        const char *image, *expected;
        int code;
    } cases[] = {
        {"base/in", "base/in/color.png", 0},
        {"base/../base/in/", "base/../base/in/color.png", 0},
        {"out", "out is outside the folders that may be read (--safe)", RETEX_EACCESS},
        {"base/link", "base/link is outside the folders that may be read (--safe)", RETEX_EACCESS},
        {"base/half", "base/half/textures is outside the folders that may be read (--safe)", RETEX_EACCESS},
        {"base/whole", "base/whole/textures/color.png", 0},
        {"base/away", "base/away/color.png", 0}, /* reading it is refused */
    };
    make_folder("base", (const char *const[]){"in/color.png", "away/x", "half/x", "whole/x", NULL});
    make_folder("out", (const char *const[]){"color.png", NULL});
    assert_int_equal(symlink("../out", "base/link") | symlink("../../out", "base/half/textures") |
                         symlink("../in", "base/whole/textures") |
                         symlink("../../out/color.png", "base/away/color.png"),
                     0);
    assert_non_null(realpath("base", root));
    access.safe = 1, access.roots = roots, access.nroots = 1;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int code;
        char *found = find(cases[i].image, &access, &code);
        assert_string_equal(found, cases[i].expected);
        assert_int_equal(code, cases[i].code);
        free(found);
    }
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture;
    RetexError err;
    strcpy(spec.image, "base/away");
    spec.access = &access;
    assert_int_equal(retex_texture_load(&texture, &spec, 1, &err), RETEX_EACCESS);
    assert_string_equal(err.message, "base/away/color.png is outside the folders that may be read (--safe)");
}

static void keep_line(void *context, const char *line)
{
    char *lines = context;
    strcat(strcat(lines, line), "\n");
}

/* The texture is that of the file, and what else the folder has is told once. */
static void test_loaded(void **state)
{
    (void)state;
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture;
    RetexError err;
    char lines[1024] = "";
    int width, height;
    const float pixels[2 * 3 * 3] = {0.5F};
    RetexImage image = {0};
    assert_int_equal(retex_image_alloc(&image, 3, 2, 3, NULL), 0);
    memcpy(image.pixels, pixels, sizeof pixels);
    make_folder("oak", (const char *const[]){"oak_rough_2k.jpg", "oak_nor_gl_2k.jpg", "oak_nor_dx_2k.jpg", NULL});
    test_must(retex_image_write(&image, "oak/oak_diff_2k.png", NULL, 1, &err), &err);
    retex_image_free(&image);
    strcpy(spec.image, "oak/");
    spec.warn = keep_line, spec.warn_context = lines;
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    retex_texture_size(texture, &width, &height);
    assert_true(width == 3 && height == 2);
    assert_string_equal(lines, "oak: roughness and normal maps are not used\n");
    retex_texture_close(&texture);
    assert_int_equal(unlink("oak/oak_rough_2k.jpg"), 0);
    lines[0] = '\0';
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    assert_string_equal(lines, "oak: the normal map is not used\n");
    retex_texture_close(&texture);
    assert_int_equal(unlink("oak/oak_nor_gl_2k.jpg") | unlink("oak/oak_nor_dx_2k.jpg"), 0);
    lines[0] = '\0';
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    assert_string_equal(lines, "");
    retex_texture_close(&texture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_schemes),     cmocka_unit_test(test_several_forms), cmocka_unit_test(test_refused),
        cmocka_unit_test(test_odd_entries), cmocka_unit_test(test_unreadable),    cmocka_unit_test(test_very_many),
        cmocka_unit_test(test_long_names),  cmocka_unit_test(test_access),        cmocka_unit_test(test_loaded),
    };
    return cmocka_run_group_tests(tests, make_tree, remove_tree);
}
