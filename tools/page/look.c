/* See look.h. */
#include "page/look.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/file_sum.h>
#include <retex/image_file.h>
#include <retex/output_file.h>
#include <retex/preset.h>
#include <retex/set_file.h>

#define TEXTURES "textures"
#define DRAWING ".svg"
/* Letters of names that need no escapes in addresses. */
#define LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_"
enum { STEM_MOST = 60 }; /* bytes of the name that a copy keeps */

/* ---- reading ---- */

/* Pages have the views of the built-in configuration. */
static int check_view(const RetexEdit *edit, const char *preset, RetexError *err)
{
    static const char *const views[] = {"Standard", "Filmic", "Neutral", "Raw"};
    const char *view = retex_edit_view(edit);
    for (int i = 0; view && i < 4; i++)
        if (strcasecmp(view, views[i]) == 0)
            return RETEX_OK;
    return view ? retex_fail(err, RETEX_EUNSUPPORTED,
                             "%s: pages have no view '%s': expected Standard, Filmic, Neutral or Raw", preset, view)
                : RETEX_OK;
}

/* Pages show no normal maps, and no roughness of folders. */
static int leave_out_maps(RetexTextureSpec *spec, const Cli *cli, RetexError *err)
{
    char *rough = NULL;
    int code = RETEX_OK;
    if (spec->normal != RETEX_NORMAL_NONE) {
        if (strcmp(spec->finish, "none") != 0)
            cli_warn(cli, "%s: a page does not show normal maps: %s", spec->target, spec->finish);
        spec->normal = RETEX_NORMAL_NONE;
        memset(spec->finish, 0, sizeof spec->finish);
    } else if (!spec->finish[0]) {
        code = retex_texture_file(&rough, spec, RETEX_TEXTURE_FILE_FINISH, err);
        if (!code && rough && spec->nfinishes > 1)
            cli_warn(cli, "%s: a page does not show the roughness of a folder: %s", spec->target, rough);
    }
    free(rough);
    return code;
}

int look_read(RetexEdit *edit, const Cli *cli, const char *preset, const RetexSet *set, RetexError *err)
{
    RetexTargetNames names;
    int code = retex_preset_read(edit, preset, err);
    retex_set_target_names(&names, set);
    if (!code)
        code = retex_edit_bind(edit, &names, err);
    if (!code)
        code = retex_edit_bind_lamps(edit, set, err);
    if (!code)
        code = check_view(edit, preset, err);
    const int count = retex_edit_count(edit);
    for (int i = 0; i < count && !code; i++) {
        RetexTextureSpec *spec = retex_edit_texture(edit, i);
        spec->access = &cli->access;
        spec->nfinishes = retex_set_target(set, retex_set_find_target(set, spec->target))->nfinishes;
        code = leave_out_maps(spec, cli, err);
    }
    if (!code && count)
        code = retex_textures_check(set, retex_edit_texture(edit, 0), count, err);
    return code;
}

/* ---- pictures ---- */

static int too_long(const char *folder, RetexError *err)
{
    return retex_fail(err, RETEX_EINVAL, "the name of the folder is too long: %.200s…", folder);
}

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "not enough memory for the names of files");
}

typedef struct Copies {
    const Cli *cli;
    const char *folder;
    Added *added;
} Copies;

/* The ending of a picture that browsers read, by its content; "" of others. Drawings are known by their name. */
static int ending_of(const char **ending, const Copies *copies, const char *file, RetexError *err)
{
    static const struct {
        int at;
        const char *bytes, *ending;
    } kinds[] = {{0, "\xff\xd8\xff", ".jpg"}, {0, "\x89PNG", ".png"}, {8, "WEBP", ".webp"},
                 {4, "ftypavif", ".avif"},    {0, "GIF8", ".gif"},    {0, "BM", ".bmp"}};
    char begin[16] = "";
    int descriptor = -1;
    const int code = retex_access_open(&copies->cli->access, file, &descriptor, err);
    if (code)
        return code;
    const ssize_t bytes = pread(descriptor, begin, sizeof begin, 0);
    close(descriptor);
    *ending = cli_ends_with(file, DRAWING) ? DRAWING : "";
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && !**ending; i++)
        if (bytes == sizeof begin && memcmp(begin + kinds[i].at, kinds[i].bytes, strlen(kinds[i].bytes)) == 0)
            *ending = kinds[i].ending;
    return RETEX_OK;
}

/* FOLDER/textures/STEM-SUM.ENDING: a name that needs no escapes in addresses, and may be kept by caches for ever. */
static int name_copy(char path[PATH_MAX], const char *folder, const char *file, unsigned sum, const char *ending)
{
    const char *name = strrchr(file, '/') ? strrchr(file, '/') + 1 : file, *dot = strrchr(name, '.');
    const size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    char stem[STEM_MOST + 1], suffix[16];
    size_t n = 0;
    for (; n < length && n < STEM_MOST; n++)
        stem[n] = strchr(LETTERS, name[n]) ? name[n] : '_';
    stem[n] = '\0';
    snprintf(suffix, sizeof suffix, "-%08x", sum);
    if (n > strlen(suffix) && strcmp(stem + n - strlen(suffix), suffix) == 0) /* it is such a copy */
        stem[n - strlen(suffix)] = '\0';
    return snprintf(path, PATH_MAX, "%s/" TEXTURES "/%s%s%s", folder, stem, suffix, ending) < PATH_MAX;
}

static int copy_bytes(const Copies *copies, const char *path, const char *file, RetexError *err)
{
    struct stat info;
    int descriptor = -1, code = retex_access_open(&copies->cli->access, file, &descriptor, err);
    if (code)
        return code;
    FILE *stream = fdopen(descriptor, "rb");
    const size_t bytes = stream && fstat(descriptor, &info) == 0 ? (size_t)info.st_size : 0;
    void *data = malloc(bytes + 1);
    if (!stream || !data)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory for %s", file);
    else if (fread(data, 1, bytes + 1, stream) != bytes || ferror(stream))
        code = retex_fail(err, RETEX_EIO, "%s cannot be read", file);
    if (!code)
        code = retex_file_write(path, data, bytes, err);
    free(data);
    if (stream)
        fclose(stream);
    else
        close(descriptor);
    return code;
}

/* What browsers do not read becomes PNG, in their colours. */
static int convert(const Copies *copies, const char *path, const char *file, const char *colorspace, RetexError *err)
{
    RetexImage image = {0};
    RetexReadParams read = RETEX_READ_INIT;
    RetexWriteParams write = RETEX_WRITE_INIT;
    const char *ocio = getenv("OCIO");
    read.colorspace = colorspace[0] ? colorspace : NULL;
    read.access = &copies->cli->access;
    read.budget = copies->cli->budget;
    read.warn = cli_warn_text;
    read.warn_context = (void *)copies->cli;
    write.colorspace = ocio && ocio[0] ? "sRGB" : NULL;
    int code = retex_image_read(&image, file, &read, copies->cli->threads, err);
    if (!code)
        code = retex_image_write(&image, path, &write, copies->cli->threads, err);
    retex_image_free(&image);
    return code;
}

/* Give a copy the name that its content has. */
static int place_copy(const Copies *copies, char path[PATH_MAX], const char *file, const char *ending, RetexError *err)
{
    char made[PATH_MAX];
    RetexFileSum sum;
    strcpy(made, path);
    int code = retex_file_sum(&sum, made, NULL, err);
    if (!code && !name_copy(path, copies->folder, file, sum.crc, ending))
        code = too_long(copies->folder, err);
    if (!code && !added_note(copies->added, path))
        code = no_memory(err);
    if (!code && rename(made, path))
        code = retex_fail(err, RETEX_EIO, "cannot write %s: %s", path, strerror(errno));
    return code;
}

/* Copy the picture that name, one of the edit, is. file: where it is now, of a folder that of its base colour.
 * is_map: its numbers are no colours. */
static int copy_picture(const Copies *copies, char *name, size_t size, const char *file, const char *colorspace,
                        int is_map, RetexError *err)
{
    RetexReadParams read = RETEX_READ_INIT;
    const char *ending = "";
    char path[PATH_MAX];
    read.access = &copies->cli->access;
    int code = ending_of(&ending, copies, file, err);
    if (!code && strcmp(ending, DRAWING) != 0)
        code = retex_image_read_check(file, &read, err);
    const int as_it_is = ending[0] && (!colorspace[0] || strcasecmp(colorspace, "sRGB") == 0);
    if (!code && is_map && !as_it_is)
        code = retex_fail(err, RETEX_EUNSUPPORTED, "a page cannot show the map of finishes %s: it must be PNG or JPEG",
                          file);
    if (!code && (!name_copy(path, copies->folder, file, 0, "") || strlen(path) + strlen(".jpeg") >= size))
        code = too_long(copies->folder, err);
    ending = as_it_is ? ending : ".png";
    if (!code)
        strcat(path, ending);
    if (!code && !added_note(copies->added, path))
        code = no_memory(err);
    if (!code)
        code = as_it_is ? copy_bytes(copies, path, file, err) : convert(copies, path, file, colorspace, err);
    if (!code)
        code = place_copy(copies, path, file, ending, err);
    if (!code)
        strcpy(memset(name, 0, size), path); /* specs are compared byte by byte */
    return code;
}

/* Copy the files of a texture. */
static int copy_texture(const Copies *copies, RetexTextureSpec *spec, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < RETEX_TEXTURE_FILES && !code; k++) {
        const int tile = k - RETEX_TEXTURE_FILE_TILES, layer = k - RETEX_TEXTURE_FILE_LAYERS;
        char *file = NULL;
        const int is_named = k == RETEX_TEXTURE_FILE_FINISH && spec->finish[0];
        if ((k == RETEX_TEXTURE_FILE_FINISH && !is_named) || k == RETEX_TEXTURE_FILE_NORMAL)
            continue;
        code = retex_texture_file(&file, spec, k, err);
        if (code || !file)
            ;
        else if (k == RETEX_TEXTURE_FILE_IMAGE)
            code = copy_picture(copies, spec->image, sizeof spec->image, file, spec->colorspace, 0, err);
        else if (k == RETEX_TEXTURE_FILE_FINISH)
            code = copy_picture(copies, spec->finish, sizeof spec->finish, file, "", 1, err);
        else if (layer < 0)
            code = copy_picture(copies, spec->tiles[tile], sizeof spec->tiles[tile], file, spec->colorspace, 0, err);
        else
            code = copy_picture(copies, spec->layers[layer].image, sizeof spec->layers[layer].image, file,
                                spec->layers[layer].colorspace, 0, err);
        free(file);
    }
    memset(spec->colorspace, 0, sizeof spec->colorspace);
    for (int k = 0; k < RETEX_LAYERS_MAX; k++)
        memset(spec->layers[k].colorspace, 0, sizeof spec->layers[k].colorspace);
    return code;
}

static int has_pictures(RetexEdit *edit)
{
    for (int i = 0; i < retex_edit_count(edit); i++)
        if (!retex_edit_texture(edit, i)->constant || retex_edit_texture(edit, i)->finish[0])
            return 1;
    return 0;
}

/* ---- the folder ---- */

static int path_in(char path[PATH_MAX], const char *folder, const char *name)
{
    return snprintf(path, PATH_MAX, "%s/%s", folder, name) < PATH_MAX;
}

int look_write(RetexEdit *edit, const Cli *cli, const char *folder, Added *added, RetexError *err)
{
    const Copies copies = {cli, folder, added};
    char path[PATH_MAX];
    int code = RETEX_OK;
    if (has_pictures(edit)) {
        if (!path_in(path, folder, TEXTURES) || !added_note(added, path))
            return too_long(folder, err);
        if (mkdir(path, 0777) && errno != EEXIST)
            return retex_fail(err, RETEX_EIO, "cannot make the folder %s: %s", path, strerror(errno));
    }
    for (int i = 0; i < retex_edit_count(edit) && !code; i++)
        code = copy_texture(&copies, retex_edit_texture(edit, i), err);
    if (!code && (!path_in(path, folder, LOOK_FILE) || !added_note(added, path)))
        code = too_long(folder, err);
    return code ? code : retex_preset_write(edit, path, err);
}

void look_offer(char *text, size_t size, RetexEdit *edit)
{
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < retex_edit_count(edit); i++) {
        const RetexTextureSpec *spec = retex_edit_texture(edit, i);
        const char *name = spec->constant ? NULL : strrchr(spec->image, '/');
        if (name && used + strlen(TEXTURES) + strlen(name) + 2 <= size)
            used += (size_t)snprintf(text + used, size - used, "%s" TEXTURES "%s", used ? " " : "", name);
    }
}

int look_old(RetexEdit *old, const char *folder)
{
    RetexError ignored = {0};
    char path[PATH_MAX];
    return path_in(path, folder, LOOK_FILE) && access(path, F_OK) == 0 && !retex_preset_read(old, path, &ignored);
}

/* Picture `number` of an edit: those of one texture follow each other. NULL: it is none; "": none of this kind. */
static const char *picture_of(RetexEdit *edit, int number)
{
    const int texture = number / RETEX_TEXTURE_FILES, k = number % RETEX_TEXTURE_FILES;
    if (texture >= retex_edit_count(edit))
        return NULL;
    const RetexTextureSpec *spec = retex_edit_texture(edit, texture);
    return k == RETEX_TEXTURE_FILE_IMAGE    ? spec->image
           : k == RETEX_TEXTURE_FILE_FINISH ? spec->finish
           : k >= RETEX_TEXTURE_FILE_LAYERS ? spec->layers[k - RETEX_TEXTURE_FILE_LAYERS].image
           : k >= RETEX_TEXTURE_FILE_TILES  ? spec->tiles[k - RETEX_TEXTURE_FILE_TILES]
                                            : "";
}

static int is_in(RetexEdit *edit, const char *picture)
{
    const char *own;
    for (int i = 0; (own = picture_of(edit, i)); i++)
        if (strcmp(own, picture) == 0)
            return 1;
    return 0;
}

/* Whether a picture is a copy that look_write made: a file right in the folder of copies. */
static int is_copy(const char *picture, const char *copies)
{
    const size_t length = strlen(copies);
    return strncmp(picture, copies, length) == 0 && picture[length] == '/' && !strchr(picture + length + 1, '/');
}

void look_remove_old(RetexEdit *old, RetexEdit *edit, const char *folder)
{
    char path[PATH_MAX];
    const char *picture;
    if (!edit && path_in(path, folder, LOOK_FILE))
        unlink(path);
    if (!path_in(path, folder, TEXTURES))
        return;
    for (int i = 0; (picture = picture_of(old, i)); i++)
        if (is_copy(picture, path) && !(edit && is_in(edit, picture)))
            unlink(picture);
    rmdir(path); /* if nothing is in it */
}
