/* See site.h. */
#include "serve/request/parse.h"
#include "serve/site/site.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color_text.h>
#include <retex/edit.h>
#include <retex/version.h>

#include "http/hash.h"
#include "http/thumbnail.h"
#include "common/json.h"
#include "serve/site/picture.h"

/* ---- what a request is of ---- */

typedef struct Text {
    char *text;
    size_t used, size;
} Text;

static RETEX_PRINTF(2, 3) void append(Text *to, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    const int length = vsnprintf(to->text + to->used, to->size - to->used, fmt, args);
    va_end(args);
    if (length > 0)
        to->used += (size_t)length < to->size - to->used ? (size_t)length : to->size - to->used - 1;
}

static int is_picture(ServeRoute route)
{
    return route == SERVE_PICTURE || route == SERVE_THUMBNAIL || route == SERVE_IIIF_IMAGE;
}

/* Whether the answer is one of pixels, which is kept. */
static int has_pixels(ServeRoute route)
{
    return is_picture(route) || route == SERVE_TEXTURE;
}

SiteWork site_work_of(const Site *site, const ServeRequest *request)
{
    if (request->route == SERVE_UPLOAD)
        return SITE_UPLOAD;
    for (int i = 0; is_picture(request->route) && i < request->nspecs; i++)
        if (images_is_new_upload(site->images, &request->specs[i]))
            return SITE_UPLOAD;
    if (request->route == SERVE_TEXTURE && images_is_upload(site->images, &request->specs[0]))
        return SITE_UPLOAD;
    return has_pixels(request->route) ? SITE_PICTURE : SITE_TEXT;
}

static int quality_of(const Site *site, const ServeRequest *request)
{
    return request->quality ? request->quality : site->quality;
}

/* What an answer is made of. */
typedef struct SiteFiles {
    FileId room, images[RETEX_MAX_TARGETS][RETEX_TEXTURE_FILES]; /* the latter by spec */
} SiteFiles;

/* The files that names stand for now; the specs of textures get the paths. */
static Answer *find_files(const Site *site, ServeRequest *request, SiteFiles *files)
{
    char path[PATH_MAX], meant[RETEX_MEANT_SIZE];
    if (request->route != SERVE_TEXTURE && rooms_find(site->rooms, request->room, path, &files->room))
        return answer_error(404, "there is no room '%s'; /v1 lists them", request->room);
    for (int i = 0; i < request->nspecs; i++) {
        RetexTextureSpec *spec = &request->specs[i];
        const int missing = images_find(site->images, spec, files->images[i]);
        if (request->route == SERVE_TEXTURE) /* of which the image alone is read */
            memset(&files->images[i][RETEX_TEXTURE_FILE_IMAGE + 1], 0,
                   sizeof files->images[i] - sizeof files->images[i][RETEX_TEXTURE_FILE_IMAGE]);
        if (missing == 1 + RETEX_TEXTURE_FILE_FINISH && images_has_map(spec))
            return answer_error(404, "%s.%s: there is no texture '%s'; /v1 lists them", spec->target,
                                spec->normal ? "normal" : "finish", spec->finish);
        if (missing > RETEX_TEXTURE_FILE_LAYERS)
            return answer_error(404, "over:%s: there is no texture '%s'; /v1 lists them", spec->target,
                                spec->layers[missing - 1 - RETEX_TEXTURE_FILE_LAYERS].image);
        if (missing > RETEX_TEXTURE_FILE_TILES)
            return answer_error(404, "%s.tiles: there is no texture '%s'; /v1 lists them", spec->target,
                                spec->tiles[missing - 1 - RETEX_TEXTURE_FILE_TILES]);
        if (missing && request->route == SERVE_TEXTURE)
            return answer_error(404, "there is no texture '%s'; /v1 lists them", spec->image);
        if (missing)
            return answer_error(404, "%s: there is no texture '%s'; /v1 lists them%s", spec->target, spec->image,
                                retex_color_meant(spec->image, meant));
    }
    return NULL;
}

static void write_key(const Site *site, const ServeRequest *request, const char *base, const SiteFiles *files,
                      char text[SITE_KEY_MAX])
{
    Text key = {text, 0, SITE_KEY_MAX};
    char id_text[FILE_ID_TEXT];
    append(&key, "%d\n%s\n%s\n%s", is_picture(request->route) ? SERVE_PICTURE : request->route, request->room,
           file_id_text(&files->room, id_text), request->edits);
    for (int i = 0; i < request->nspecs; i++)
        for (int number = 0; number < RETEX_TEXTURE_FILES; number++)
            append(&key, "\n%s", file_id_text(&files->images[i][number], id_text));
    if (has_pixels(request->route)) {
        const ServeRegion *r = &request->region;
        const ServeSize *s = &request->size;
        append(&key, "\n%d %.17g %.17g %.17g %.17g\n%d %d %d %.17g %d\n%d %d %d %d %d", r->kind, r->x, r->y, r->width,
               r->height, s->kind, s->width, s->height, s->percent, s->may_enlarge, request->quarter_turns,
               request->mirror, request->gray, request->format, quality_of(site, request));
    } else {
        append(&key, "\n%s", base);
    }
}

static Answer *add_preset(const Site *site, ServeRequest *request)
{
    RetexEdit *preset = NULL;
    RetexError err = {0};
    int code = retex_edit_create(&preset, &err);
    if (!code)
        code = presets_read(&site->presets, request->preset, preset, &err);
    Answer *error = code == RETEX_ENOTFOUND ? answer_error(404, "%s; /v1 lists them", err.message)
                    : code                  ? answer_error(code == RETEX_ENOMEM ? 503 : 500, "%s", err.message)
                                            : NULL;
    if (!code && serve_request_complete(request, preset))
        error = answer_error(request->status, "%s", request->reason);
    retex_edit_close(&preset);
    return error;
}

Answer *site_key(const Site *site, ServeRequest *request, const char *base, char text[SITE_KEY_MAX])
{
    SiteFiles files = {0};
    if (request->route == SERVE_ROOMS) {
        Text key = {text, 0, SITE_KEY_MAX};
        append(&key, "%d", request->route);
        return NULL;
    }
    Answer *error = request->preset[0] ? add_preset(site, request) : NULL;
    if (!error)
        error = find_files(site, request, &files);
    if (!error)
        write_key(site, request, base, &files, text);
    return error;
}

/* What the files of textures hold, by spec. Of those that are not read it is nothing. */
typedef struct SiteContents {
    Content images[RETEX_MAX_TARGETS][RETEX_TEXTURE_FILES];
} SiteContents;

static void write_etag(const char *text, char etag[ETAG_SIZE])
{
    static const Hash128 begin = HASH128_BEGIN;
    const Hash128 hash = hash128_text(begin, text);
    snprintf(etag, ETAG_SIZE, "\"%016llx%016llx\"", (unsigned long long)hash.high, (unsigned long long)hash.low);
}

/* The tag says what the picture is made of: the build, the colours that a display needs, the contents of the room and
 * of the files of textures, the edits, and the pixels. It is the same on all machines that have the same files. */
static void make_etag(const Site *site, const ServeRequest *request, const RetexCut *place, const Room *room,
                      const SiteContents *contents, char etag[ETAG_SIZE])
{
    const char *config = getenv("OCIO");
    char text[SERVE_URL_MAX + RETEX_MAX_TARGETS * RETEX_TEXTURE_FILES * 64 + 1024], digest[2 * CONTENT_DIGEST + 1];
    Text all = {text, 0, sizeof text};
    append(&all, RETEX_VERSION "\n%.256s\n%s\n%s", config ? config : "", content_text(&room->content, digest),
           request->edits);
    for (int i = 0; i < request->nspecs; i++)
        for (int number = 0; number < RETEX_TEXTURE_FILES; number++)
            append(&all, "\n%s", content_text(&contents->images[i][number], digest));
    append(&all, "\n%d %d %d %d %d %d %d %d %d %d %d", place->x, place->y, place->width, place->height,
           place->scaled_width, place->scaled_height, request->quarter_turns, request->mirror, request->gray,
           request->format, quality_of(site, request));
    write_etag(text, etag);
}

static int find_place(ServeRequest *request, const Room *room, RetexCut *place)
{
    const RetexSetInfo info = retex_set_info(room->set);
    return iiif_place(request, info.width, info.height, place);
}

/* A texture of a request on its target of the set. A target that is not there, or has no finishes, has no map:
 * place_textures tells. */
static RetexTextureSpec spec_on(const RetexSet *set, const RetexTextureSpec *of)
{
    RetexTextureSpec spec = *of;
    const int target = retex_set_find_target(set, spec.target);
    if (target >= 0) {
        spec.nfinishes = retex_set_target(set, target)->nfinishes;
        memcpy(spec.roughness, retex_set_target(set, target)->finish_roughness, sizeof spec.roughness);
        spec.normal_tilt = retex_set_target(set, target)->normal_tilt;
    }
    const int takes_map = spec.normal ? spec.normal_tilt > 0 : spec.nfinishes && !(spec.normal_tilt > 0);
    if (!takes_map && images_has_map(&spec))
        spec.finish[0] = '\0', spec.normal = RETEX_NORMAL_NONE;
    return spec;
}

/* Whether the contents of a picture's textures are known. */
static int find_contents(const Site *site, const ServeRequest *request, const RetexSet *set, SiteContents *contents)
{
    for (int i = 0; i < request->nspecs; i++) {
        const RetexTextureSpec spec = spec_on(set, &request->specs[i]);
        if (!images_find_contents(site->images, &spec, contents->images[i]))
            return 0;
    }
    return 1;
}

int site_known_etag(const Site *site, const ServeRequest *request, char etag[ETAG_SIZE])
{
    char path[PATH_MAX];
    FileId id;
    RetexCut place;
    SiteContents contents = {0};
    if (!is_picture(request->route) || rooms_find(site->rooms, request->room, path, &id))
        return 0;
    const Room *room = rooms_peek(site->rooms, request->room, &id);
    ServeRequest copy = *request; /* iiif_place may put an error into it */
    const int is_known =
        room && find_contents(site, request, room->set, &contents) && !find_place(&copy, room, &place);
    if (is_known)
        make_etag(site, request, &place, room, &contents, etag);
    rooms_return(site->rooms, room);
    return is_known;
}

/* ---- pictures ---- */

typedef struct Textures {
    RetexTexture *textures[RETEX_MAX_TARGETS]; /* by target */
    OpenImage *images[RETEX_MAX_TARGETS];      /* by spec; NULL for a colour all over */
} Textures;

static void return_images(const Site *site, Textures *textures)
{
    for (int i = 0; i < RETEX_MAX_TARGETS; i++)
        images_return(site->images, textures->images[i]);
}

static int take_images(const Site *site, const ServeRequest *request, const RetexSet *set, double deadline,
                       Textures *textures, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < request->nspecs && !code; i++) {
        const RetexTextureSpec spec = spec_on(set, &request->specs[i]);
        if (images_has_files(&spec))
            code = images_take(site->images, &spec, deadline, &textures->images[i], err);
    }
    return code;
}

/* Put on the targets what a request says. */
static int place_textures(const Site *site, const ServeRequest *request, const RetexSet *set, Textures *textures,
                          RetexError *err)
{
    RetexTextureSpec colors[RETEX_MAX_TARGETS];
    int ncolors = 0;
    for (int i = 0; i < request->nspecs; i++)
        if (!textures->images[i])
            colors[ncolors++] = request->specs[i];
    int code = retex_textures_check(set, request->specs, request->nspecs, err);
    if (!code)
        code = retex_textures_load(textures->textures, set, colors, ncolors, 1, err);
    for (int i = 0; i < request->nspecs && !code; i++) {
        const RetexTextureSpec spec = spec_on(set, &request->specs[i]);
        RetexTexture **texture = &textures->textures[retex_set_find_target(set, spec.target)];
        if (textures->images[i])
            code = images_place(site->images, textures->images[i], set, &spec, texture, err);
    }
    return code;
}

/* The targets whose corrections a picture reads. Of those that the set does not have, place_textures
 * tells. */
static void find_corrected(const ServeRequest *request, const RetexSet *set, int corrected[RETEX_MAX_TARGETS])
{
    const int ntargets = retex_set_info(set).ntargets;
    memset(corrected, 0, RETEX_MAX_TARGETS * sizeof *corrected);
    for (int i = 0; i < request->nspecs && retex_correction_weight(ntargets, request->nspecs) > 0; i++) {
        const int target = retex_set_find_target(set, request->specs[i].target);
        if (target >= 0)
            corrected[target] = 1;
    }
}

/* What a request says beside textures: how the picture is developed, and the values of the set's parameters, which stay
 * NULL where it says nothing. */
static int plan_light(PicturePlan *plan, const ServeRequest *request, const RetexSet *set, float values[],
                      RetexError *err)
{
    RetexEdit *edit = NULL;
    int code = retex_edit_create(&edit, err);
    plan->develop = (RetexDevelop)RETEX_DEVELOP_INIT;
    if (!code)
        code = retex_edit_parse(edit, request->edits, err);
    if (!code)
        code = retex_edit_develop(edit, &plan->develop, err);
    if (!code && retex_edit_view(edit))
        strcpy(plan->view, retex_edit_view(edit));
    if (!code && retex_edit_lights(edit)) {
        code = retex_edit_parameters(edit, set, values, err);
        plan->parameters = values;
    }
    retex_edit_close(&edit);
    return code;
}

/* The file of a picture: 0. Placing textures looks at the parts of the set, so that no other thread may decode them
 * meanwhile. */
static int make_file(const Site *site, const ServeRequest *request, PicturePlan *plan, const Room *room,
                     Textures *textures, int nthreads, void **data, size_t *bytes, RetexError *err)
{
    int corrected[RETEX_MAX_TARGETS];
    float values[3 * RETEX_PARAMETERS_MAX];
    find_corrected(request, room->set, corrected);
    int code = rooms_begin_picture(site->rooms, room, corrected, err);
    const int is_begun = !code;
    plan->textures = textures->textures;
    if (!code)
        code = place_textures(site, request, room->set, textures, err);
    if (!code)
        code = plan_light(plan, request, room->set, values, err);
    if (!code)
        code = picture_make(plan, nthreads, data, bytes, err);
    retex_textures_close(textures->textures);
    if (is_begun)
        rooms_end_picture(site->rooms, room);
    return code;
}

/* Whether the files that were read are those of the key, and no change of them could be missed. */
static int is_of_key(const Site *site, const WorkItem *item, const Content *room, const SiteContents *contents)
{
    SiteFiles files = {.room = room->id};
    char key[SITE_KEY_MAX];
    int are_settled = room->is_settled;
    for (int i = 0; i < item->request.nspecs; i++)
        for (int number = 0; number < RETEX_TEXTURE_FILES; number++) {
            files.images[i][number] = contents->images[i][number].id;
            are_settled &= contents->images[i][number].is_settled;
        }
    write_key(site, &item->request, item->base, &files, key);
    return are_settled && strcmp(key, item->key) == 0;
}

/* room: the whole one; used: what plan->set is of, it or a level of it. place: of the whole. */
static Answer *make_picture_of(const Site *site, const WorkItem *item, const Room *room, const Room *used,
                               const RetexCut *place, PicturePlan *plan, Textures *textures, int nthreads)
{
    const ServeRequest *request = &item->request;
    SiteContents contents = {0};
    RetexError err = {0};
    void *data = NULL;
    size_t bytes = 0;
    if (make_file(site, request, plan, used, textures, nthreads, &data, &bytes, &err))
        return answer_of_error(&err);
    Answer *answer = answer_new(200, serve_format_type(request->format), data, bytes);
    if (!answer)
        return NULL;
    for (int i = 0; i < request->nspecs; i++)
        for (int number = 0; number < RETEX_TEXTURE_FILES; number++)
            contents.images[i][number] = textures->images[i] ? images_contents(textures->images[i])[number]
                                                             : (Content){.is_settled = 1};
    make_etag(site, request, place, room, &contents, answer->etag);
    const RetexSetInfo info = retex_set_info(room->set);
    answer->width = info.width;
    answer->height = info.height;
    if (is_of_key(site, item, &room->content, &contents))
        cache_add(site->pictures, item->key, answer);
    return answer;
}

static Answer *make_picture(const Site *site, const WorkItem *item, const Room *room, int nthreads)
{
    ServeRequest request = item->request;
    PicturePlan plan = {.quarter_turns = request.quarter_turns,
                        .mirror = request.mirror,
                        .gray = request.gray,
                        .format = request.format,
                        .quality = quality_of(site, &request),
                        .deadline = item->deadline};
    Textures textures = {0};
    RetexError err = {0};
    RetexCut place;
    if (find_place(&request, room, &place))
        return answer_error(request.status, "%s", request.reason);
    const Room *small = NULL;
    const int level = retex_set_find_level(room->set, &place, &plan.place);
    int code = level < 0 ? RETEX_OK : rooms_take_level(site->rooms, room, level, &small, &err);
    if (small && !file_id_is_same(&small->content.id, &room->content.id)) { /* the file has been replaced meanwhile */
        rooms_return(site->rooms, small);
        small = NULL;
        plan.place = place;
    }
    const Room *used = small ? small : room;
    plan.set = used->set;
    if (!code)
        code = take_images(site, &request, used->set, item->deadline, &textures, &err);
    Answer *answer = code ? answer_of_error(&err)
                          : make_picture_of(site, item, room, used, &place, &plan, &textures, nthreads);
    return_images(site, &textures);
    rooms_return(site->rooms, small);
    return answer;
}

/* ---- thumbnails of textures ---- */

/* The tag says what it is made of, as that of a picture of a room; its size follows from the file. */
static void make_texture_etag(const Site *site, const ServeRequest *request, const Content *content,
                              char etag[ETAG_SIZE])
{
    const char *config = getenv("OCIO");
    char text[sizeof RETEX_VERSION + 512], digest[2 * CONTENT_DIGEST + 1];
    snprintf(text, sizeof text, RETEX_VERSION "\ntexture\n%.256s\n%s\n%d %d", config ? config : "",
             content_text(content, digest), request->format, quality_of(site, request));
    write_etag(text, etag);
}

static Answer *make_texture(const Site *site, const WorkItem *item, int nthreads)
{
    ServeRequest request = item->request;
    SiteContents contents = {0};
    Content *content = &contents.images[0][RETEX_TEXTURE_FILE_IMAGE], none = {.is_settled = 1};
    RetexImage image = {0};
    RetexCut place;
    RetexError err = {0};
    void *data = NULL;
    size_t bytes = 0;
    for (int number = RETEX_TEXTURE_FILE_IMAGE + 1; number < RETEX_TEXTURE_FILES; number++)
        contents.images[0][number] = none;
    if (images_read(site->images, &request.specs[0], item->deadline, &image, content, &err))
        return answer_of_error(&err);
    if (iiif_place(&request, image.width, image.height, &place)) {
        retex_image_free(&image);
        return answer_error(request.status, "%s", request.reason);
    }
    const int code = thumbnail_make(&image, &place, serve_format_extension(request.format), quality_of(site, &request),
                                    nthreads, &data, &bytes, &err);
    retex_image_free(&image);
    Answer *answer = code ? answer_of_error(&err) : answer_new(200, serve_format_type(request.format), data, bytes);
    if (!code && answer) {
        make_texture_etag(site, &request, content, answer->etag);
        if (is_of_key(site, item, &none, &contents))
            cache_add(site->pictures, item->key, answer);
    }
    return answer;
}

/* ---- texts ---- */

static void tell_name(void *context, const char *name)
{
    json_add(context, json_of_text(name));
}

static json_t *format_names(void)
{
    json_t *names = json_array();
    for (int format = 0; format < SERVE_FORMATS; format++)
        if (picture_formats() & 1u << format)
            json_add(&names, json_string(serve_format_extension((ServeFormat)format)));
    return names;
}

static json_t *describe_rooms(const Site *site, int *failed)
{
    json_t *rooms = json_array(), *images = json_array(), *presets = json_array();
    *failed = rooms_list(site->rooms, tell_name, &rooms);
    *failed |= images_list(site->images, tell_name, &images);
    *failed |= presets_list(&site->presets, tell_name, &presets);
    json_t *all = json_pack("{s:o, s:o, s:o, s:o}", "rooms", rooms, "textures", images, "presets", presets, "formats",
                            format_names());
    if (!site->presets.folder)
        json_object_del(all, "presets");
    if (site->uploads)
        json_object_set_new(all, "upload_bytes", json_integer((json_int_t)uploads_most_bytes(site->uploads)));
    return all;
}

static json_t *pair_of(const double pair[2])
{
    return json_pack("[o, o]", json_of_number(pair[0]), json_of_number(pair[1]));
}

static json_t *describe_target(const RetexTarget *target)
{
    json_t *albedo = json_array(), *finishes = json_array();
    const int has_finishes = target->nfinishes > 0 && !(target->normal_tilt > 0);
    for (int c = 0; c < 3; c++)
        json_add(&albedo, json_of_number((double)target->mean_albedo[c]));
    for (int k = 0; k < target->nfinishes; k++)
        json_add(&finishes, json_of_text(target->finishes[k]));
    json_t *all = json_pack("{s:o, s:o, s:o, s:o, s:o, s:o*, s:o*}", "name", json_of_text(target->name), "share",
                            json_of_number(target->share), "mean_albedo", albedo, "uv_min", pair_of(target->uv_min),
                            "uv_max", pair_of(target->uv_max), "uv_scale",
                            target->uv_scale[0] > 0 ? pair_of(target->uv_scale) : NULL, "normal_tilt",
                            target->normal_tilt > 0 ? json_of_number(target->normal_tilt) : NULL);
    if (has_finishes)
        json_object_update_new(all, json_pack("{s:O, s:i}", "finishes", finishes, "finish", target->finish));
    json_decref(finishes);
    json_object_set_new(all, "periodic", json_pack("[b, b]", target->periodic[0], target->periodic[1]));
    return all;
}

static json_t *describe_room(const ServeRequest *request, const RetexSet *set)
{
    const RetexSetInfo info = retex_set_info(set);
    json_t *targets = json_array(), *lamps = json_array();
    for (int t = 0; t < info.ntargets; t++)
        json_add(&targets, describe_target(retex_set_target(set, t)));
    for (int i = 0; i < info.nparameters; i++)
        if (retex_parameter_lamp(set, i))
            json_add(&lamps, json_of_text(retex_parameter_lamp(set, i)));
    json_t *all = json_pack("{s:o, s:i, s:i, s:s, s:i, s:b, s:o, s:o}", "room", json_of_text(request->room), "width",
                            info.width, "height", info.height, "layout", info.layout, "spp", info.spp, "denoised",
                            info.denoised, "targets", targets, "lamps", lamps);
    if (!json_array_size(lamps))
        json_object_del(all, "lamps");
    return all;
}

static Answer *make_text(const Site *site, const WorkItem *item, const Room *room)
{
    json_t *value;
    int failed = 0;
    if (item->request.route == SERVE_ROOMS) {
        value = describe_rooms(site, &failed);
    } else if (item->request.route == SERVE_ROOM) {
        value = describe_room(&item->request, room->set);
    } else {
        const RetexSetInfo info = retex_set_info(room->set);
        value = iiif_info(&item->request, item->base, info.width, info.height, picture_formats());
    }
    Answer *answer = answer_json(200, value);
    if (!failed)
        return answer;
    answer_release(answer);
    return answer_error(500, "a folder cannot be read");
}

Answer *site_make(void *context, const WorkItem *item, int nthreads)
{
    const Site *site = context;
    const Room *room = NULL;
    RetexError err = {0};
    if (item->request.route == SERVE_UPLOAD)
        return uploads_keep(site->uploads, item->hash, item->body, item->bytes, item->deadline);
    if (item->request.route == SERVE_TEXTURE)
        return make_texture(site, item, nthreads);
    if (item->request.route != SERVE_ROOMS && rooms_take(site->rooms, item->request.room, &room, &err))
        return answer_of_error(&err);
    Answer *answer =
        is_picture(item->request.route) ? make_picture(site, item, room, nthreads) : make_text(site, item, room);
    rooms_return(site->rooms, room);
    return answer;
}
