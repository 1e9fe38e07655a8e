/* Folders of textures. A file is recognised by its name alone: the last word that is neither a resolution, a format nor
 * a number says what the file is a map of, and the words without resolution and format say whether two files are one
 * map in two forms. The result does not depend on the order in which the system lists the files, and memory does not
 * depend on their number. See retex-edit(5). */
#include "texture/folder.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/texture.h>

#include "base/params.h"
#include "texture/lay.h"

enum { MOST_ENTRIES = 100000, NAME_SIZE = 256, PATH_SIZE = 2 * NAME_SIZE, SHOWN = 3 };

/* ---- names ---- */

typedef enum Map {
    MAP_ROUGHNESS,
    MAP_GLOSS,
    MAP_METALNESS,
    MAP_SPECULAR,
    MAP_NORMAL,
    MAP_DISPLACEMENT,
    MAP_OCCLUSION,
    MAP_OPACITY,
    MAP_EMISSION,
    MAPS,
    MAP_COLOR = MAPS
} Map;

static const char *const map_names[MAPS] = {"roughness",         "gloss",   "metalness",
                                            "specular",          "normal",  "displacement",
                                            "ambient occlusion", "opacity", "emission"};

enum { PACKED = 1 << MAP_OCCLUSION | 1 << MAP_ROUGHNESS | 1 << MAP_METALNESS, COLOR = 1 << MAP_COLOR };

static const struct {
    const char *word;
    unsigned maps; /* bits */
} map_words[] = {{"diff", COLOR},
                 {"diffuse", COLOR},
                 {"col", COLOR},
                 {"color", COLOR},
                 {"colour", COLOR},
                 {"basecolor", COLOR},
                 {"basecolour", COLOR},
                 {"albedo", COLOR},
                 {"rough", 1 << MAP_ROUGHNESS},
                 {"roughness", 1 << MAP_ROUGHNESS},
                 {"gloss", 1 << MAP_GLOSS},
                 {"glossiness", 1 << MAP_GLOSS},
                 {"metal", 1 << MAP_METALNESS},
                 {"metalness", 1 << MAP_METALNESS},
                 {"metallic", 1 << MAP_METALNESS},
                 {"spec", 1 << MAP_SPECULAR},
                 {"specular", 1 << MAP_SPECULAR},
                 {"nor", 1 << MAP_NORMAL},
                 {"normal", 1 << MAP_NORMAL},
                 {"normalgl", 1 << MAP_NORMAL},
                 {"normaldx", 1 << MAP_NORMAL},
                 {"disp", 1 << MAP_DISPLACEMENT},
                 {"displacement", 1 << MAP_DISPLACEMENT},
                 {"height", 1 << MAP_DISPLACEMENT},
                 {"bump", 1 << MAP_DISPLACEMENT},
                 {"ao", 1 << MAP_OCCLUSION},
                 {"ambientocclusion", 1 << MAP_OCCLUSION},
                 {"occlusion", 1 << MAP_OCCLUSION},
                 {"arm", PACKED},
                 {"orm", PACKED},
                 {"opacity", 1 << MAP_OPACITY},
                 {"alpha", 1 << MAP_OPACITY},
                 {"emission", 1 << MAP_EMISSION},
                 {"emissive", 1 << MAP_EMISSION}};

/* What OpenImageIO reads as pictures. */
static const char *const endings[] = {
    "avif", "bmp",  "bw",  "cin",  "dds",  "dpx",  "exr", "fits", "gif", "hdr",  "heic", "heif", "ico", "iff", "j2c",
    "j2k",  "jfif", "jp2", "jpc",  "jpe",  "jpeg", "jpg", "jxl",  "pbm", "pfm",  "pgm",  "pic",  "png", "pnm", "ppm",
    "psb",  "psd",  "rgb", "rgba", "rgbe", "rla",  "sgi", "tga",  "tif", "tiff", "tpic", "tx",   "webp"};

static int is_one_of(const char *const *words, size_t count, const char *word)
{
    for (size_t i = 0; i < count; i++)
        if (strcasecmp(words[i], word) == 0)
            return 1;
    return 0;
}
#define IS_ONE_OF(words, word) is_one_of(words, sizeof(words) / sizeof *(words), word)

/* "2k", "2048", "2048x2048": texels, else 0. Only powers of two are, so that numbers of versions and tiles are not. */
static int resolution_of(const char *word)
{
    enum { MOST_DIGITS = 6, LEAST = 128 };
    const size_t digits = strspn(word, "0123456789");
    if (digits < 1 || digits > MOST_DIGITS)
        return 0;
    const int number = atoi(word);
    const char *rest = word + digits;
    if (strcmp(rest, "k") == 0)
        return 1024 * number;
    if (*rest == 'x' && rest[1 + strspn(rest + 1, "0123456789")] == '\0')
        return number;
    return *rest || number < LEAST || (number & (number - 1)) ? 0 : number;
}

static int is_format(const char *word)
{
    static const char *const formats[] = {"jpg", "jpeg", "png", "exr", "tif", "tiff", "8bit", "16bit", "32bit"};
    return IS_ONE_OF(formats, word);
}

static unsigned maps_of_word(const char *word)
{
    for (size_t i = 0; i < sizeof map_words / sizeof *map_words; i++)
        if (strcmp(map_words[i].word, word) == 0)
            return map_words[i].maps;
    return 0;
}

/* A file by its name. */
typedef struct Named {
    unsigned maps;        /* 0: none is known */
    int resolution;       /* 0: the name says nothing */
    int is_lossy;         /* JPEG */
    int up;               /* see maps_of */
    char key[NAME_SIZE];  /* equal for one map in several forms */
    char path[PATH_SIZE]; /* in the folder */
} Named;

/* Splits a name into words, in small letters; returns their number. Bytes beyond ASCII are letters. */
static int split(char name[NAME_SIZE], const char *words[NAME_SIZE])
{
    int count = 0, inside = 0;
    for (char *c = name; *c; c++) {
        const int is_letter = isalnum((unsigned char)*c) || (unsigned char)*c >= 0x80;
        if (is_letter && !inside)
            words[count++] = c;
        inside = is_letter;
        *c = is_letter ? (char)tolower((unsigned char)*c) : '\0';
    }
    return count;
}

/* The last word that says something; -1 = none. */
static int telling_word(const char *const *words, int count)
{
    int k = count - 1;
    while (k >= 0 &&
           (words[k][strspn(words[k], "0123456789")] == '\0' || resolution_of(words[k]) || is_format(words[k])))
        k--;
    return k;
}

/* The maps by that word; of normals the one before may say it, as in nor_gl. up: 1 where green points up, -1 down, 0
 * where the name does not tell. */
static unsigned maps_of(const char *const *words, int count, int *up)
{
    static const char *const ups[] = {"gl", "opengl", "normalgl"}, *const downs[] = {"dx", "directx", "normaldx"};
    const int k = telling_word(words, count);
    *up = 0;
    if (k < 0)
        return 0;
    *up = IS_ONE_OF(ups, words[k]) ? 1 : IS_ONE_OF(downs, words[k]) ? -1 : 0;
    if (*up && !maps_of_word(words[k])) /* normalgl says both */
        return k > 0 ? maps_of_word(words[k - 1]) & 1 << MAP_NORMAL : 0;
    return maps_of_word(words[k]);
}

/* 0 where the name is that of no picture. */
static int read_name(Named *file, const char *folder, const char *name)
{
    char text[NAME_SIZE];
    const char *words[NAME_SIZE], *dot = strrchr(name, '.');
    *file = (Named){.maps = 0};
    if (!dot || dot == name || strlen(name) >= sizeof text || !IS_ONE_OF(endings, dot + 1))
        return 0;
    snprintf(text, sizeof text, "%.*s", (int)(dot - name), name);
    const int count = split(text, words);
    file->maps = maps_of(words, count, &file->up);
    file->is_lossy = tolower((unsigned char)dot[1]) == 'j' && strcasecmp(dot + 1, "jxl") != 0;
    for (int k = 0, used = 0; k < count; k++) {
        const int resolution = resolution_of(words[k]);
        if (resolution > file->resolution)
            file->resolution = resolution;
        if (!resolution && !is_format(words[k])) /* words are shorter than the name together */
            used += snprintf(file->key + used, sizeof file->key - (size_t)used, "%s%s", used ? "_" : "", words[k]);
    }
    snprintf(file->path, sizeof file->path, "%s%s%s", folder, *folder ? "/" : "", name);
    return 1;
}

/* ---- the folder ---- */

typedef struct Folder {
    const char *image; /* as it was named, for messages without its last slashes: */
    int length;
    const RetexAccess *access;
    int is_safe;
    unsigned maps; /* all that there are */
    long entries;
    Named colors[2];               /* the best forms of the two base colours whose keys are first */
    Named roughness[2];            /* the same of roughness, or of what says it best; the second: there are several */
    Named normals[2];              /* and of normal maps */
    char others[SHOWN][NAME_SIZE]; /* the first names of files that are no map, sorted */
    long nothers;
} Folder;

static int is_better(const Named *a, const Named *b)
{
    if (a->resolution != b->resolution)
        return a->resolution > b->resolution;
    return a->is_lossy != b->is_lossy ? !a->is_lossy : strcmp(a->path, b->path) < 0;
}

/* Keeps the best forms of the two maps whose keys are first. */
static void keep_best(Named best[2], const Named *file)
{
    for (int i = 0; i < 2; i++) {
        const int order = best[i].maps ? strcmp(file->key, best[i].key) : -1;
        if (order > 0)
            continue;
        if (order < 0 && i == 0)
            best[1] = best[0];
        if (order < 0 || is_better(file, &best[i]))
            best[i] = *file;
        return;
    }
}

/* A map of roughness is preferred to one of gloss, and that to a channel of a packed one. */
static int roughness_rank(const Named *file)
{
    return file->maps == 1 << MAP_ROUGHNESS ? 3 : file->maps == 1 << MAP_GLOSS ? 2 : file->maps == PACKED;
}

/* Of normal maps one whose green points up, as here; then one that does not say it. */
static int normal_rank(const Named *file)
{
    return file->maps == 1 << MAP_NORMAL ? 2 + file->up : 0;
}

static void add_ranked(Named best[2], const Named *file, int (*rank_of)(const Named *))
{
    const int rank = rank_of(file), before = rank_of(&best[0]);
    if (rank > before)
        memset(best, 0, 2 * sizeof *best);
    if (rank && rank >= before)
        keep_best(best, file);
}

static void add_other(Folder *folder, const char *name)
{
    const int kept = folder->nothers < SHOWN ? (int)folder->nothers : SHOWN;
    int at = kept;
    folder->nothers++;
    while (at > 0 && strcmp(name, folder->others[at - 1]) < 0)
        at--;
    if (at == SHOWN)
        return;
    const int moved = kept < SHOWN ? kept - at : SHOWN - 1 - at;
    memmove(folder->others[at + 1 < SHOWN ? at + 1 : at], folder->others[at], (size_t)moved * sizeof *folder->others);
    snprintf(folder->others[at], sizeof folder->others[at], "%s", name);
}

static void add_file(Folder *folder, const char *below, const char *name)
{
    Named file;
    if (!read_name(&file, below, name) || !file.maps) {
        add_other(folder, name);
        return;
    }
    folder->maps |= file.maps;
    if (file.maps & COLOR)
        keep_best(folder->colors, &file);
    add_ranked(folder->roughness, &file, roughness_rank);
    add_ranked(folder->normals, &file, normal_rank);
}

/* The type of an entry. Safe access does not follow links here, so that nothing is told of what is outside: what they
 * lead to is seen when they are opened. */
static mode_t type_of(const Folder *folder, DIR *directory, const char *name)
{
    struct stat info;
    return fstatat(dirfd(directory), name, &info, folder->is_safe ? AT_SYMLINK_NOFOLLOW : 0) == 0
               ? info.st_mode & S_IFMT
               : 0;
}

/* The path of a file or folder within, or "" for the folder itself. */
static char *path_in(const Folder *folder, const char *below)
{
    char *path = NULL;
    const int is_root = folder->image[folder->length - 1] == '/'; /* of the file system */
    const char *slash = is_root || !*below ? "" : "/";
    return asprintf(&path, "%.*s%s%s", folder->length, folder->image, slash, below) < 0 ? NULL : path;
}

static int no_memory(const Folder *folder, RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "not enough memory to read %s", folder->image);
}

static int list(Folder *folder, const char *below, RetexError *err);

/* A folder `textures` is a part of the one that holds it; other folders are not looked into. Links count as files in
 * safe access, unless they are called so. */
static int add_entry(Folder *folder, DIR *directory, const char *below, const char *name, RetexError *err)
{
    if (name[0] == '.') /* ., .., and what other systems hide */
        return RETEX_OK;
    if (++folder->entries > MOST_ENTRIES)
        return retex_fail(err, RETEX_ELIMIT, "%s: a folder of more than %d files", folder->image, MOST_ENTRIES);
    const mode_t type = type_of(folder, directory, name);
    if (!*below && strcasecmp(name, "textures") == 0 && (type == S_IFDIR || type == S_IFLNK))
        return list(folder, name, err);
    if (type == S_IFREG || type == S_IFLNK || type == 0)
        add_file(folder, below, name);
    return RETEX_OK;
}

static int list(Folder *folder, const char *below, RetexError *err)
{
    int descriptor = -1, code = RETEX_OK;
    char *path = path_in(folder, below);
    if (!path)
        return no_memory(folder, err);
    code = retex_access_open_folder(folder->access, path, &descriptor, err);
    free(path);
    if (code)
        return code;
    DIR *directory = fdopendir(descriptor);
    if (!directory) {
        close(descriptor);
        return no_memory(folder, err);
    }
    for (struct dirent *entry; !code;) {
        errno = 0;
        entry = readdir(directory);
        if (!entry) {
            if (errno)
                code = retex_fail(err, RETEX_EIO, "cannot read %s: %s", folder->image, strerror(errno));
            break;
        }
        code = add_entry(folder, directory, below, entry->d_name, err);
    }
    closedir(directory);
    return code;
}

/* ---- what is said of it ---- */

/* Lists the maps besides colour; returns how many there are. */
static int name_maps(const Folder *folder, char *text, size_t size)
{
    int left = 0, count = 0;
    size_t used = 0;
    for (int i = 0; i < MAPS; i++)
        left += folder->maps >> i & 1;
    text[0] = '\0';
    for (int i = 0; i < MAPS && used < size; i++)
        if (folder->maps >> i & 1)
            used += (size_t)snprintf(text + used, size - used, "%s%s",
                                     !count++        ? ""
                                     : count == left ? " and "
                                                     : ", ",
                                     map_names[i]);
    return count;
}

/* What a folder without a base colour has. */
static int refuse(const Folder *folder, RetexError *err)
{
    char text[(SHOWN + 1) * NAME_SIZE];
    const int count = name_maps(folder, text, sizeof text);
    size_t used = strlen(text);
    if (count)
        snprintf(text + used, sizeof text - used, count > 1 ? " maps" : " map");
    for (int i = 0; i < SHOWN && i < folder->nothers && !count; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", i ? ", " : "", folder->others[i]);
    if (!count && folder->nothers > SHOWN)
        snprintf(text + used, sizeof text - used, " and %ld more", folder->nothers - SHOWN);
    return retex_fail(err, RETEX_EFORMAT,
                      "%.*s: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has %s%s",
                      folder->length, folder->image,
                      count != 1                 ? ""
                      : strchr("aeiou", text[0]) ? "an "
                                                 : "a ",
                      *text ? text : "no files");
}

static int name_unused(const Folder *folder, char **unused, RetexError *err)
{
    char text[NAME_SIZE];
    const int count = name_maps(folder, text, sizeof text);
    if (!count)
        return RETEX_OK;
    const int length = count > 1
                           ? asprintf(unused, "%.*s: %s maps are not used", folder->length, folder->image, text)
                           : asprintf(unused, "%.*s: the %s map is not used", folder->length, folder->image, text);
    if (length >= 0)
        return RETEX_OK;
    *unused = NULL;
    return no_memory(folder, err);
}

/* The map that is wanted, unless several might be it. */
static int choose_map(Folder *folder, RetexFolderFiles *files, RetexFolderWant want, RetexError *err)
{
    const Named *wanted = want == RETEX_FOLDER_NORMAL ? folder->normals : folder->roughness;
    files->has_maps = folder->roughness[0].maps || folder->normals[0].maps;
    if (want == RETEX_FOLDER_COLOR || !wanted[0].maps || wanted[1].maps)
        return RETEX_OK;
    files->channel = wanted->maps == PACKED; /* occlusion, roughness, metalness: red, green, blue */
    files->is_gloss = wanted->maps == 1 << MAP_GLOSS;
    folder->maps &= want == RETEX_FOLDER_NORMAL ? ~(1u << MAP_NORMAL) : ~(1u << MAP_ROUGHNESS | 1u << MAP_GLOSS);
    return (files->map = path_in(folder, wanted->path)) ? RETEX_OK : no_memory(folder, err);
}

static int choose(Folder *folder, RetexFolderFiles *files, RetexFolderWant want, RetexError *err)
{
    const Named *colors = folder->colors;
    if (!colors[0].maps)
        return refuse(folder, err);
    if (colors[1].maps)
        return retex_fail(err, RETEX_EFORMAT,
                          "%.*s: a folder with several base colours, such as %s and %s: name one of them",
                          folder->length, folder->image, colors[0].path, colors[1].path);
    if (!(files->color = path_in(folder, colors[0].path)))
        return no_memory(folder, err);
    const int code = choose_map(folder, files, want, err);
    return code ? code : name_unused(folder, &files->unused, err);
}

static int find_in_folder(RetexFolderFiles *files, const char *image, const RetexAccess *access, RetexFolderWant want,
                          RetexError *err)
{
    RetexAccess own = RETEX_ACCESS_INIT;
    if (access && RETEX_PARAMS_COPY(&own, access, err))
        return RETEX_EINVAL;
    Folder *folder = calloc(1, sizeof *folder);
    if (!folder)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to read %s", image);
    folder->image = image;
    folder->length = (int)strlen(image);
    while (folder->length > 1 && image[folder->length - 1] == '/')
        folder->length--;
    folder->access = access;
    folder->is_safe = own.safe;
    int code = list(folder, "", err);
    if (!code)
        code = choose(folder, files, want, err);
    free(folder);
    return code;
}

void retex_texture_folder_files_free(RetexFolderFiles *files)
{
    free(files->color);
    free(files->map);
    free(files->unused);
    *files = (RetexFolderFiles){.color = NULL};
}

int retex_texture_folder_find(RetexFolderFiles *files, const char *image, const RetexAccess *access,
                              RetexFolderWant want, RetexError *err)
{
    struct stat info;
    *files = (RetexFolderFiles){.color = NULL};
    int code = RETEX_OK;
    if (stat(image, &info) == 0 && S_ISDIR(info.st_mode))
        code = find_in_folder(files, image, access, want, err);
    else if (!(files->color = strdup(image)))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to read %s", image);
    if (code)
        retex_texture_folder_files_free(files);
    return code;
}

int retex_texture_name_is_dx(const char *file)
{
    const char *slash = strrchr(file, '/');
    Named named;
    return read_name(&named, "", slash ? slash + 1 : file) && named.maps == 1 << MAP_NORMAL && named.up < 0;
}

int retex_texture_file(char **file, const RetexTextureSpec *given, int number, RetexError *err)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexFolderFiles files;
    *file = NULL;
    if (RETEX_PARAMS_COPY(&spec, given, err))
        return RETEX_EINVAL;
    if (number >= RETEX_TEXTURE_FILE_LAYERS) {
        const int layer = number - RETEX_TEXTURE_FILE_LAYERS;
        if (layer >= spec.nlayers)
            return RETEX_OK;
        strcpy(spec.image, spec.layers[layer].image);
        spec.constant = 0;
    } else if (number >= RETEX_TEXTURE_FILE_TILES) {
        const int tile = number - RETEX_TEXTURE_FILE_TILES;
        if (tile >= retex_lay_tiles(&spec))
            return RETEX_OK;
        strcpy(spec.image, spec.tiles[tile]);
        spec.constant = 0;
    }
    if (number == RETEX_TEXTURE_FILE_FINISH && spec.finish[0]) {
        *file = strcmp(spec.finish, RETEX_NO_FINISH_MAP) == 0 ? NULL : strdup(spec.finish);
        return RETEX_OK;
    }
    if (spec.constant || !spec.image[0] || (number == RETEX_TEXTURE_FILE_NORMAL && spec.finish[0]))
        return RETEX_OK;
    const RetexFolderWant want = number == RETEX_TEXTURE_FILE_NORMAL   ? RETEX_FOLDER_NORMAL
                                 : number == RETEX_TEXTURE_FILE_FINISH ? RETEX_FOLDER_ROUGHNESS
                                                                       : RETEX_FOLDER_COLOR;
    const int code = retex_texture_folder_find(&files, spec.image, spec.access, want, err);
    char **found = want == RETEX_FOLDER_COLOR ? &files.color : &files.map;
    *file = *found;
    *found = NULL;
    retex_texture_folder_files_free(&files);
    return code;
}
