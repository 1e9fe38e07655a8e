/* See parse.h. */
#include "serve/request/parse.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "serve/request/iiif.h"
#include "serve/request/url.h"

/* ---- formats ---- */

/* The format of the highest weight; of several, the smallest files. The first three must be named, for a program that
 * accepts anything may know none of them. */
static int choose_format(ServeRequest *request, const char *accept, unsigned formats)
{
    static const ServeFormat order[SERVE_FORMATS] = {SERVE_AVIF, SERVE_JXL, SERVE_WEBP, SERVE_JPEG, SERVE_PNG};
    double best = 0;
    request->format_by_accept = 1;
    enum { HAVE_TO_BE_NAMED = 3 };
    for (int i = 0; i < SERVE_FORMATS; i++) {
        int named;
        double weight = url_accepts(accept, serve_format_type(order[i]), &named);
        if (!(formats & 1u << order[i]) || (i < HAVE_TO_BE_NAMED && !named) || weight <= best)
            continue;
        best = weight;
        request->format = order[i];
    }
    return best > 0 ? 0
                    : serve_refuse(request, 406, "no picture is of a type that `Accept` allows; /v1 lists the formats");
}

/* ---- names ---- */

static int set_room(ServeRequest *request, const char *name)
{
    if (!serve_name_is_valid(name))
        return serve_refuse(request, 400, "`%s` cannot be the name of a room", name);
    strcpy(request->room, name);
    return 0;
}

/* ---- textures ---- */

static int check_name(ServeRequest *request, const char *name)
{
    return serve_name_is_valid(name) ? 0 : serve_refuse(request, 400, "`%s` cannot be the name of a texture", name);
}

/* Take what the edit says into the request. */
static int take_edit(ServeRequest *request, RetexEdit *edit)
{
    RetexError err = {0};
    char *text = NULL;
    if (retex_edit_check(edit, &err))
        return serve_refuse(request, 400, "%s", err.message);
    for (int i = 0; i < retex_edit_count(edit); i++) {
        const RetexTextureSpec *spec = retex_edit_texture(edit, i);
        request->specs[request->nspecs++] = *spec;
        int code = spec->constant || (spec->nlayers && !spec->image[0]) ? 0 : check_name(request, spec->image);
        if (!code && spec->finish[0])
            code = check_name(request, spec->finish);
        for (int k = 0; k < spec->nlayers && !code; k++)
            code = check_name(request, spec->layers[k].image);
        for (int k = 0; k < RETEX_TILES_MAX && spec->tiles[k][0] && !code; k++)
            code = check_name(request, spec->tiles[k]);
        if (code)
            return code;
    }
    if (retex_edit_text(edit, ';', &text, &err))
        return serve_refuse(request, 503, "%s", err.message);
    if (strlen(text) >= sizeof request->edits)
        serve_refuse(request, 414, "the textures take more than %d bytes", SERVE_URL_MAX);
    else
        strcpy(request->edits, text);
    free(text);
    return request->status;
}

/* A name without its folder, and without slashes at its end. */
static void cut_folder(char *name, size_t size)
{
    size_t length = strlen(name);
    while (length > 1 && name[length - 1] == '/')
        name[--length] = '\0';
    const char *slash = strrchr(name, '/');
    if (!slash)
        return;
    length = strlen(slash + 1);
    memmove(name, slash + 1, length);
    memset(name + length, 0, size - length); /* specs are compared byte by byte */
}

static void cut_folders(RetexTextureSpec *spec)
{
    cut_folder(spec->image, sizeof spec->image);
    cut_folder(spec->finish, sizeof spec->finish);
    for (int k = 0; k < RETEX_TILES_MAX; k++)
        cut_folder(spec->tiles[k], sizeof spec->tiles[k]);
    for (int k = 0; k < spec->nlayers; k++)
        cut_folder(spec->layers[k].image, sizeof spec->layers[k].image);
}

int serve_request_complete(ServeRequest *request, RetexEdit *preset)
{
    RetexEdit *edit = NULL;
    RetexError err = {0};
    int code = retex_edit_create(&edit, &err);
    if (!code)
        code = retex_edit_parse(edit, request->edits, &err);
    for (int i = 0; i < retex_edit_count(preset) && !code; i++) {
        RetexTextureSpec *spec = retex_edit_texture(preset, i);
        int has = 0;
        for (int k = 0; k < request->nspecs; k++)
            has |= strcasecmp(request->specs[k].target, spec->target) == 0;
        cut_folders(spec);
        code = has ? RETEX_OK : retex_edit_add(edit, spec, &err);
    }
    if (!code)
        code = retex_edit_complete_lights(edit, preset, &err);
    request->nspecs = 0;
    if (code)
        serve_refuse(request, code == RETEX_ENOMEM ? 503 : 400, "%s", err.message);
    else
        take_edit(request, edit);
    retex_edit_close(&edit);
    return request->status;
}

static int add_edits(ServeRequest *request, RetexEdit *edit, const char *text)
{
    RetexError err = {0};
    if (!*text)
        return serve_refuse(request, 400, "nothing follows the semicolon; expected TARGET=IMAGE");
    return retex_edit_parse(edit, text, &err) ? serve_refuse(request, 400, "%s", err.message) : 0;
}

/* TARGET.OPTION=VALUE, or a key with a prefix, of a query. */
static int add_option(ServeRequest *request, RetexEdit *edit, const char *key, const char *value)
{
    RetexError err = {0};
    if (strchr(value, ';'))
        return serve_refuse(request, 400, "%s: expected & before what follows, not a semicolon", key);
    return retex_edit_set(edit, key, value, &err) ? serve_refuse(request, 400, "%s", err.message) : 0;
}

/* The key of an edit, picture:NAME, of a name that queries have without the prefix; or NULL. */
static const char *picture_key(const char *name)
{
    static const char *const keys[] = {"picture:exposure", "picture:white-balance", "picture:auto-exposure",
                                       "picture:view"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strcmp(name, retex_edit_key_name(keys[i])) == 0)
            return keys[i];
    return NULL;
}

/* ---- pictures ---- */

/* X,Y,WIDTH,HEIGHT */
static int set_crop(ServeRequest *request, char *text)
{
    int values[4];
    for (int i = 0; i < 4; i++) {
        char *next = text ? url_cut(text, ',') : NULL;
        if (!text || !url_integer(text, &values[i]) || (i == 3 && next))
            return serve_refuse(request, 400, "crop: expected X,Y,WIDTH,HEIGHT in pixels");
        text = next;
    }
    request->region = (ServeRegion){SERVE_REGION_PIXELS, values[0], values[1], values[2], values[3]};
    return 0;
}

static int parse_query(ServeRequest *request, RetexEdit *edit, char *query)
{
    int has_crop = 0;
    if (query && !*query)
        query = NULL;
    for (char *next; query; query = next) {
        next = url_cut(query, '&');
        char *value = url_cut(query, '=');
        if (!value || !url_decode(query) || !url_decode(value))
            return serve_refuse(request, 400, "the query is not well formed; expected KEY=VALUE&KEY=VALUE");
        if (strcmp(query, "crop") == 0 && !has_crop++) {
            if (set_crop(request, value))
                return request->status;
        } else if (strcmp(query, "quality") == 0 && !request->quality) {
            if (!url_integer(value, &request->quality) || request->quality < 1 || request->quality > 100)
                return serve_refuse(request, 400, "quality: expected 1 to 100, not `%s`", value);
        } else if (strcmp(query, "preset") == 0 && !request->preset[0]) {
            if (!serve_name_is_valid(value))
                return serve_refuse(request, 400, "`%s` cannot be the name of a preset", value);
            strcpy(request->preset, value);
        } else if (picture_key(query)) {
            if (add_option(request, edit, picture_key(query), value))
                return request->status;
        } else if (retex_edit_key_is_option(query) || retex_edit_key_name(query)) {
            if (add_option(request, edit, query, value))
                return request->status;
        } else {
            return serve_refuse(request, 400,
                                "`%s`: expected crop, quality, preset, exposure, white-balance, auto-exposure, view, "
                                "TARGET.OPTION, light:LAMP or finish:TARGET, each once",
                                query);
        }
    }
    return 0;
}

/* WIDTHxHEIGHT, one of them may be missing; full; auto; thumbnail. */
static int set_size(ServeRequest *request, char *text)
{
    ServeSize *size = &request->size;
    request->route = SERVE_PICTURE;
    if (strcmp(text, "full") == 0 || strcmp(text, "auto") == 0) {
        request->size_by_hints = *text == 'a';
        size->kind = SERVE_SIZE_MAX;
        return 0;
    }
    if (strcmp(text, "thumbnail") == 0) {
        request->route = SERVE_THUMBNAIL;
        *size = (ServeSize){.kind = SERVE_SIZE_WITHIN, .width = SERVE_THUMBNAIL_SIDE, .height = SERVE_THUMBNAIL_SIDE};
        return 0;
    }
    char *height = url_cut(text, 'x');
    int is_number = height && (*text || *height) && (!*text || url_integer(text, &size->width)) &&
                    (!*height || url_integer(height, &size->height));
    if (!is_number)
        return serve_refuse(request, 404,
                            "expected a size: WIDTHxHEIGHT, WIDTHx, xHEIGHT, full, auto or thumbnail, as in 800x.jpg");
    if ((*text && !size->width) || (*height && !size->height))
        return serve_refuse(request, 400, "a size of 0 pixels");
    size->kind = !*height ? SERVE_SIZE_WIDTH : !*text ? SERVE_SIZE_HEIGHT : SERVE_SIZE_FILL;
    return 0;
}

/* The last part of a picture's path, and the query. */
static int parse_picture(ServeRequest *request, RetexEdit *edit, char *name, char *query, const char *accept,
                         unsigned formats)
{
    char *dot = strrchr(name, '.');
    if (dot)
        *dot = '\0';
    if (set_size(request, name) || parse_query(request, edit, query) || take_edit(request, edit))
        return request->status;
    return !dot                               ? choose_format(request, accept, formats)
           : strcasecmp(dot + 1, "jpeg") == 0 ? serve_format_set(request, "jpg", formats)
                                              : serve_format_set(request, dot + 1, formats);
}

/* The name of a texture, and what follows it. */
static int parse_texture(ServeRequest *request, RetexEdit *edit, const char *texture, char *name, char *query,
                         const char *accept, unsigned formats)
{
    if (parse_picture(request, edit, name, query, accept, formats))
        return request->status;
    if (request->route != SERVE_THUMBNAIL)
        return serve_refuse(request, 404, "of a texture there is thumbnail alone, as in thumbnail.jpg");
    if (request->edits[0] || request->preset[0] || request->region.kind != SERVE_REGION_FULL)
        return serve_refuse(request, 400, "a texture's thumbnail has no option but quality");
    request->route = SERVE_TEXTURE;
    request->nspecs = 1;
    request->specs[0] = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
    strcpy(request->specs[0].image, texture);
    return 0;
}

/* ---- paths ---- */

enum { PARTS_MAX = 7 };

static int unknown_path(ServeRequest *request)
{
    return serve_refuse(request, 404, "there are /v1, /v1/ROOM, /v1/ROOM/TARGET=IMAGE/SIZE.jpg, /iiif/3/ID");
}

/* ROOM;EDITS, and what follows. */
static int parse_iiif(ServeRequest *request, RetexEdit *edit, char *parts[], int count, unsigned formats)
{
    char *text = url_cut(parts[0], ';');
    if (set_room(request, parts[0]) || (text && add_edits(request, edit, text)) || take_edit(request, edit))
        return request->status;
    if (count == 1) {
        request->route = SERVE_IIIF_BASE;
        return 0;
    }
    if (count == 2 && strcmp(parts[1], "info.json") == 0) {
        request->route = SERVE_IIIF_INFO;
        return 0;
    }
    request->route = SERVE_IIIF_IMAGE;
    if (count != 5)
        return serve_refuse(request, 404, "expected info.json or REGION/SIZE/ROTATION/QUALITY.FORMAT");
    return iiif_parse(request, parts[1], parts[2], parts[3], parts[4], formats);
}

static int parse_path(ServeRequest *request, RetexEdit *edit, char *parts[], int count, char *query, const char *accept,
                      unsigned formats)
{
    int is_picture = count >= 3 && strcmp(parts[0], "v1") == 0;
    if (!is_picture && query && *query)
        return serve_refuse(request, 400, "only pictures of /v1 have a query");
    if (count == 1 && strcmp(parts[0], "health") == 0) {
        request->route = SERVE_HEALTH;
    } else if (count == 1 && strcmp(parts[0], "metrics") == 0) {
        request->route = SERVE_METRICS;
    } else if (count == 1 && strcmp(parts[0], "v1") == 0) {
        request->route = SERVE_ROOMS;
    } else if (count == 2 && strcmp(parts[0], "v1") == 0) {
        request->route = SERVE_ROOM;
        return set_room(request, parts[1]);
    } else if (is_picture && count == 4 && strcmp(parts[1], "textures") == 0 && serve_name_is_valid(parts[2])) {
        return parse_texture(request, edit, parts[2], parts[3], query, accept, formats);
    } else if (is_picture && count <= 4) {
        if (set_room(request, parts[1]) || (count == 4 && add_edits(request, edit, parts[2])))
            return request->status;
        return parse_picture(request, edit, parts[count - 1], query, accept, formats);
    } else if (count >= 3 && strcmp(parts[0], "iiif") == 0 && strcmp(parts[1], "3") == 0) {
        return parse_iiif(request, edit, parts + 2, count - 2, formats);
    } else if (strcmp(parts[0], "iiif") == 0) {
        return serve_refuse(request, 404, "of IIIF there is version 3 of the Image API: /iiif/3/ID/info.json");
    } else {
        return unknown_path(request);
    }
    return 0;
}

int serve_request_parse(ServeRequest *request, const char *url, const char *accept, unsigned formats)
{
    char text[SERVE_URL_MAX + 1], *parts[PARTS_MAX];
    int count = 0;
    *request = (ServeRequest){.route = SERVE_PICTURE};
    if (strlen(url) > SERVE_URL_MAX)
        return serve_refuse(request, 414, "the URL is longer than %d bytes", SERVE_URL_MAX);
    if (url[0] != '/')
        return serve_refuse(request, 400, "the URL does not begin with a slash");
    strcpy(text, url);
    char *query = url_cut(text, '?');
    for (char *part = text + 1, *next; part; part = next) {
        next = url_cut(part, '/');
        if (!url_decode(part))
            return serve_refuse(request, 400,
                                "the path is not well formed; expected UTF-8, percent-encoded, without ..");
        if (!*part && url[1])
            return serve_refuse(request, 404, "a part of the path is empty: there are two slashes, or one at its end");
        if (count == PARTS_MAX || !*part)
            return unknown_path(request);
        parts[count++] = part;
    }
    RetexEdit *edit = NULL;
    RetexError err = {0};
    if (retex_edit_create(&edit, &err))
        return serve_refuse(request, 503, "%s", err.message);
    parse_path(request, edit, parts, count, query, accept, formats);
    retex_edit_close(&edit);
    return request->status;
}
