/* A program that was compiled against the headers of an older release, whose parameter structs are shorter than the
 * library's: shorten.py makes such headers. It hands one to each call that takes one, at the end of a page after which
 * nothing may be read or written, and the names of the calls and their results are printed.
 * older SET TARGET=IMAGE FOLDER */
#include <retex/host/set_build.h>
#include <retex/retex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* A copy of `count` structs that ends where a page ends that nobody may touch. */
static void *at_the_end(const void *from, size_t bytes, int count)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), all = bytes * (size_t)count;
    const size_t room = (all + page - 1) / page * page;
    unsigned char *pages = mmap(NULL, room + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED || mprotect(pages + room, page, PROT_NONE) != 0)
        exit(2);
    for (int i = 0; i < count; i++)
        memcpy(pages + room - all + bytes * (size_t)i, from, bytes);
    return pages + room - all;
}
#define OLDER(type, init) ((type *)at_the_end(&(type)init, sizeof(type), 1))

static RetexError err;

static void tell(const char *call, int code)
{
    printf("%s: %s\n", call, code ? err.message : "ok");
}
#define CALL(call, ...) tell(#call, call(__VA_ARGS__, &err))

static void call_limits(void)
{
    RetexLimits *limits = OLDER(RetexLimits, RETEX_LIMITS_INIT);
    RetexBudget *budget = NULL;
    CALL(retex_limits_set, limits, "max-pixels", "4711");
    CALL(retex_limits_environment, limits);
    retex_budget_create(&budget, NULL);
    retex_budget_set_limits(budget, limits);
    printf("retex_budget_set_limits: %ld pixels\n", retex_budget_pixels(budget));
    retex_limits_safe(limits);
    printf("retex_limits_safe: %g seconds\n", limits->seconds);
    retex_budget_close(&budget);
}

static int files_opened;

static int look_at_file(void *context, int descriptor, RetexError *error)
{
    (void)descriptor, (void)error;
    files_opened++;
    return context ? RETEX_EINVAL : RETEX_OK;
}

static RetexAccess *access_of_all(void)
{
    RetexAccess *access = OLDER(RetexAccess, RETEX_ACCESS_INIT);
    access->opened = look_at_file;
    return access;
}

static void call_files(const char *image, const char *written)
{
    RetexReadParams *read = OLDER(RetexReadParams, RETEX_READ_INIT);
    RetexWriteParams *write = OLDER(RetexWriteParams, RETEX_WRITE_INIT);
    RetexDiffParams *diff = OLDER(RetexDiffParams, RETEX_DIFF_INIT);
    RetexImage picture = {0};
    RetexPicture *rows = NULL;
    RetexDiff *difference = NULL;
    RetexFileSum sum;
    int descriptor = -1;
    void *data = NULL;
    size_t bytes = 0;
    diff->access = read->access = access_of_all();
    printf("retex_access_check: %s\n", retex_access_check(read->access, "", image) ? "no" : "ok");
    CALL(retex_access_open, read->access, image, &descriptor);
    close(descriptor);
    CALL(retex_access_open_folder, read->access, ".", &descriptor);
    close(descriptor);
    CALL(retex_file_sum, &sum, image, read->access);
    CALL(retex_image_read_check, image, read);
    CALL(retex_image_read, &picture, image, read, 1);
    CALL(retex_image_write_check, written, write);
    CALL(retex_image_format_check, written, write);
    CALL(retex_image_write, &picture, written, write, 1);
    CALL(retex_diff, &difference, image, written, diff, 1);
    CALL(retex_picture_open, &rows, written, 8, 8, 3, write);
    retex_picture_close(&rows, 0, NULL);
    CALL(retex_picture_open_memory, &rows, "png", 8, 8, 3, write);
    retex_picture_close(&rows, 0, NULL);
    retex_image_free(&picture);
    CALL(retex_image_alloc, &picture, 8, 8, 3);
    CALL(retex_picture_encode, &data, &bytes, &picture, "webp", write, NULL, 1);
    free(data);
    retex_diff_close(&difference);
    retex_image_free(&picture);
}

static int drop_rows(void *context, int y0, int y1, const float *rows, RetexError *error)
{
    (void)context, (void)y0, (void)y1, (void)rows, (void)error;
    return RETEX_OK;
}

/* What is written into the caller's structs; they have no layers. */
static void call_specs(const RetexTextureSpec *spec)
{
    RetexTextureSpec *own = OLDER(RetexTextureSpec, RETEX_TEXTURE_SPEC_INIT),
                     *layer = OLDER(RetexTextureSpec, RETEX_TEXTURE_SPEC_INIT);
    const size_t size = own->size;
    *own = *spec;
    own->size = size;
    retex_texture_spec_unplace(own);
    printf("retex_texture_spec_unplace: scale %g\n", own->scale[0]);
    printf("retex_texture_specs_alike: %d\n", retex_texture_specs_alike(own, spec));
    retex_texture_layer_get(layer, own, 0);
    printf("retex_texture_layer_get: '%s'\n", layer->image);
    CALL(retex_texture_layer_set, own, 0, layer);
    strcpy(layer->image, "");
    CALL(retex_texture_spec_join, own, layer);
}

static void call_textures(RetexSet *set, const char *argument, const char *written)
{
    RetexTextureSpec *specs = at_the_end(&(RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT, sizeof *specs, 2);
    RetexTextureSpec *spec = &specs[1];
    RetexCombineParams *params = OLDER(RetexCombineParams, RETEX_COMBINE_INIT);
    RetexTexture *textures[RETEX_MAX_TARGETS] = {NULL}, *texture = NULL;
    RetexImage picture = {0};
    RetexEdit *edit = NULL;
    char *text = NULL, image[32];
    CALL(retex_edit_create, &edit);
    CALL(retex_edit_option, edit, "scale=3", argument);
    CALL(retex_edit_option, edit, "", "Wall=rgb(0.1,0.2,0.3)");
    for (int i = 0; i < 2; i++) {
        specs[i] = *retex_edit_texture(edit, 1 - i);
        specs[i].size = sizeof specs[i];
    }
    RetexDevelop *develop = OLDER(RetexDevelop, RETEX_DEVELOP_INIT);
    CALL(retex_edit_set, edit, "picture:exposure", "2");
    CALL(retex_edit_develop, edit, develop);
    printf("retex_edit_develop: %g\n", develop->exposure);
    retex_edit_clear(edit);
    CALL(retex_edit_add, edit, spec);
    retex_edit_close(&edit);
    CALL(retex_edit_options_text, spec, &text);
    retex_edit_image_text(spec, image, sizeof image);
    printf("retex_edit_image_text: %s of %s\n", image, text);
    free(text);
    spec->access = access_of_all();
    printf("retex_texture_spec_needs_scale: %d\n", retex_texture_spec_needs_scale(spec));
    CALL(retex_texture_file, &text, spec, 0);
    free(text);
    CALL(retex_texture_load, &texture, spec, 1);
    retex_texture_close(&texture);
    call_specs(spec);
    CALL(retex_textures_check, set, specs, 2);
    CALL(retex_textures_load, textures, set, specs, 2, 1);
    CALL(retex_textures_place, &texture, textures[0], set, spec);
    retex_texture_close(&texture);
    CALL(retex_retexture, set, textures, params, drop_rows, NULL, 1);
    double exposure;
    CALL(retex_auto_exposure, &exposure, set, textures, params, 1);
    CALL(retex_estimate_error, set, textures, params, drop_rows, NULL, 1);
    RetexKeptSamples *kept = NULL;
    RetexKeptSamplesInfo *rows = OLDER(RetexKeptSamplesInfo, {.size = sizeof(RetexKeptSamplesInfo)});
    CALL(retex_kept_samples_create, &kept, set, 0, NULL);
    retex_kept_samples_get_info(kept, rows);
    retex_kept_samples_close(&kept);
    CALL(retex_sample_textures, set, textures, specs, 2, written, 1);
    CALL(retex_set_refer, set, "room.exr");
    CALL(retex_set_write_samples, set, written, NULL, 1);
    RetexSet *same = NULL;
    CALL(retex_set_open_any, written, &same, 1);
    CALL(retex_set_open_referred, &same, access_of_all(), 1);
    retex_set_close(&same);
    CALL(retex_sample, set, specs, 2, 1);
    CALL(retex_combine, &picture, set, params, NULL, 1);
    retex_set_lift(set, -1);
    CALL(retex_image_write, &picture, written, NULL, 1);
    CALL(retex_texture_create, &texture, &picture, spec, 1);
    retex_texture_close(&texture);
    retex_textures_close(textures);
    retex_image_free(&picture);
}

static void call_solve(const RetexSet *set)
{
    RetexTexture *textures[RETEX_MAX_TARGETS] = {NULL};
    RetexSolution *solution = NULL;
    RetexImage picture = {0};
    CALL(retex_combine, &picture, set, NULL, NULL, 1);
    CALL(retex_solve, &solution, set, textures, &picture, OLDER(RetexSolveParams, RETEX_SOLVE_INIT), 1);
    retex_solution_close(&solution);
    retex_image_free(&picture);
}

/* Sets and packs into FOLDER. */
static void call_sets(RetexSet *set, const char *folder)
{
    char path[1024];
    RetexSetInfo *info = OLDER(RetexSetInfo, {.size = sizeof(RetexSetInfo)});
    retex_set_get_info(set, info);
    printf("retex_set_get_info: %d x %d, %s, %s\n", info->width, info->height, info->layout, info->generator);
    info->generator = "older";
    CALL(retex_set_describe, set, info);
    printf("retex_set_describe: %s\n", retex_set_info(set).generator);
    snprintf(path, sizeof path, "%s/set.exr", folder);
    CALL(retex_set_write, set, path, OLDER(RetexStoreParams, RETEX_STORE_INIT), 1);
    snprintf(path, sizeof path, "%s/set.retex", folder);
    printf("retex_pack_level: %d\n", retex_pack_level(OLDER(RetexPackLevel, {.size = sizeof(RetexPackLevel)}), set, 0));
    CALL(retex_pack_write, set, path, OLDER(RetexPackParams, RETEX_PACK_INIT), NULL, 1);
    CALL(retex_web_write, set, folder, OLDER(RetexWebParams, RETEX_WEB_INIT), NULL, 1);
    CALL(retex_denoise, set, OLDER(RetexDenoiseParams, RETEX_DENOISE_INIT), NULL, 1);
}

/* A picture that is no set, denoised into FOLDER. */
static void call_denoise_picture(const char *picture, const char *folder)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/clean.exr", folder);
    printf("retex_is_picture: %d\n", retex_is_picture(picture, access_of_all()));
    RetexSet *set = NULL; /* the picture has no light groups */
    CALL(retex_set_read_light_groups, &set, picture, OLDER(RetexDenoisePictureParams, RETEX_DENOISE_PICTURE_INIT), NULL,
         1);
    CALL(retex_denoise_picture, picture, path, OLDER(RetexDenoisePictureParams, RETEX_DENOISE_PICTURE_INIT),
         OLDER(RetexDenoiseParams, RETEX_DENOISE_INIT), 1);
}

int main(int argc, char **argv)
{
    RetexSet *set = NULL;
    char path[1024];
    if (argc != 4 || retex_set_read(argv[1], &set, 1, &err))
        return 2;
    setvbuf(stdout, NULL, _IOLBF, 0); /* the last line names the last call that is right */
    call_limits();
    snprintf(path, sizeof path, "%s/copy.png", argv[3]);
    call_files(strchr(argv[2], '=') + 1, path);
    snprintf(path, sizeof path, "%s/older.exr", argv[3]);
    call_textures(set, argv[2], path);
    call_solve(set);
    call_denoise_picture(path, argv[3]);
    call_sets(set, argv[3]);
    printf("%d files were opened\n", files_opened);
    retex_set_close(&set);
    return 0;
}
