/* What is answered where: a row for each address, and what it does. Answers are JSON but where the rows say so. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/version.h>

#include "folder.h"
#include "media.h"
#include "common/beneath.h"
#include "common/output_folder.h"
#include "page.h"

enum { WAIT_SECONDS = 25, HEADER_BYTES = 8192 };

/* The object that a window has sent, or NULL and the reply. */
static json_t *read_object(const Request *request, Reply *reply)
{
    json_error_t fault;
    json_t *root = json_loadb(request->body ? request->body : "", request->bytes, JSON_REJECT_DUPLICATES, &fault);
    if (json_is_object(root))
        return root;
    *reply =
        reply_error(MHD_HTTP_BAD_REQUEST, "expected an object of JSON%s%s", root ? "" : ": ", root ? "" : fault.text);
    json_decref(root);
    return NULL;
}

static const char *text_of(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

static Reply done(void)
{
    return reply_json(MHD_HTTP_OK, json_object());
}

/* 0: the user has made this model's folder, or agreed to go on with it; else the reply. */
static int refuse_foreign(Request *request, const Model *model, Reply *reply)
{
    RetexError err = {0};
    if (!places_check_trust(&request->studio->places, model, &err))
        return 0;
    *reply = reply_of_error(&err);
    return 1;
}

/* The path as requests name it: relative to the model's folder if it lies there. */
static json_t *shown_path(const Model *model, const char *path)
{
    const size_t length = model ? strlen(model->folder) : 0;
    const int is_below = model && strncmp(path, model->folder, length) == 0 && path[length] == '/';
    return json_of_text(is_below ? path + length + 1 : path);
}

/* ---- the page ---- */

/* Scripts are those two of the program, by their whole addresses; styles and pictures of the player are also made by
 * it. */
static void allow_page(const Request *request, Reply *reply)
{
    char policy[1024], script[2][256];
    static const char *const names[] = {"studio.js", "retex-room.js"};
    for (int i = 0; i < 2; i++) /* the gate has seen that the host is this server */
        snprintf(script[i], sizeof script[i], "http://%s/%s/%s", request_header(request, "Host"),
                 request->studio->gate.token, names[i]);
    snprintf(policy, sizeof policy,
             "default-src 'none'; script-src %s %s; style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; "
             "connect-src 'self' blob: data:; object-src 'none'; base-uri 'none'; form-action 'none'; "
             "frame-ancestors 'none'",
             script[0], script[1]);
    reply_header(reply, "Content-Security-Policy", policy);
}

static Reply answer_page(Request *request)
{
    const char *name = *request->path ? request->path : "index.html";
    Reply reply = {0};
    for (const PageFile *file = studio_page; file->name; file++)
        if (strcmp(file->name, name) == 0)
            reply = reply_constant(media_type(name, 1), file->data, file->bytes);
    if (!reply.status)
        return reply_error(MHD_HTTP_NOT_FOUND, "there is nothing at this address");
    allow_page(request, &reply);
    return reply;
}

/* ---- the model and the project ---- */

static json_t *model_json(Studio *studio, const Model *model)
{
    struct stat info;
    const json_int_t size = stat(model->path, &info) == 0 ? info.st_size : 0;
    changes_lock(&studio->changes);
    json_t *json =
        json_pack("{s:o, s:o, s:o, s:I, s:s}", "path", json_of_text(model->name), "name", json_of_text(model->name),
                  "folder", json_of_text(model->folder), "bytes", size, "changed", studio->watch.id);
    changes_unlock(&studio->changes);
    return json;
}

static Reply answer_state(Request *request)
{
    Studio *studio = request->studio;
    const Model *model = places_model(&studio->places);
    char *text = NULL, etag[PROJECT_ETAG];
    size_t bytes = 0;
    json_t *textures = json_array(), *state = json_pack("{s:s}", "version", RETEX_VERSION);
    (void)project_read(model, &text, &bytes, etag, NULL);
    json_t *project = text ? project_parse(text, bytes, model, NULL) : NULL;
    json_object_set_new(state, "model", model ? model_json(studio, model) : json_null());
    json_object_set_new(state, "folder", model ? json_of_text(strrchr(model->written, '/') + 1) : json_null());
    json_object_set_new(state, "dropped", json_of_text(studio->places.dropped));
    json_object_set_new(state, "home", studio->places.home ? json_of_text(studio->places.home) : json_null());
    json_object_set_new(
        state, "limits",
        json_pack("{s:b, s:I}", "safe", !studio->limits.is_unsafe, "memory", (json_int_t)studio->limits.memory));
    changes_lock(&studio->changes);
    json_object_set_new(state, "foreign", model && model->foreign ? json_string(model->foreign) : json_null());
    for (int i = 0; i < studio->places.ntextures; i++)
        json_array_append_new(textures, json_of_text(studio->places.textures[i]));
    json_object_set_new(state, "jobs", jobs_list(&studio->jobs, 0));
    json_object_set_new(state, "preview", preview_json(&studio->preview));
    json_object_set_new(state, "number", json_integer((json_int_t)studio->changes.number));
    changes_unlock(&studio->changes);
    json_object_set_new(state, "textures", textures);
    /* of one that is damaged, the call for the project alone says what is wrong */
    json_object_set_new(state, "project", project ? project : text ? json_object() : json_null());
    json_object_set_new(state, "etag", text ? json_string(etag) : json_null());
    free(text);
    return reply_json(MHD_HTTP_OK, state);
}

static Reply answer_project(Request *request)
{
    char *text, etag[PROJECT_ETAG];
    size_t bytes;
    const Model *model = places_model(&request->studio->places);
    RetexError err = {0};
    if (project_read(model, &text, &bytes, etag, &err))
        return reply_of_error(&err);
    json_t *project = project_parse(text, bytes, model, &err);
    json_decref(project);
    if (!project) {
        free(text);
        return reply_of_error(&err);
    }
    Reply reply = reply_bytes(MHD_HTTP_OK, "application/json", text, bytes);
    reply_header(&reply, "ETag", etag);
    return reply;
}

static Reply answer_project_put(Request *request)
{
    Studio *studio = request->studio;
    const char *seen = request_header(request, "If-Match"), *none = request_header(request, "If-None-Match");
    char etag[PROJECT_ETAG];
    RetexError err = {0};
    if (!seen == !none || (none && strcmp(none, "*") != 0))
        return reply_error(MHD_HTTP_PRECONDITION_REQUIRED,
                           "expected If-Match with what was seen, or If-None-Match: * for the first");
    const Model *model = places_model(&studio->places);
    Reply refusal;
    if (refuse_foreign(request, model, &refusal))
        return refusal;
    const int code =
        project_write(&studio->project, model, request->body ? request->body : "", request->bytes, seen, etag, &err);
    if (code == RETEX_EACCESS)
        return reply_error(MHD_HTTP_PRECONDITION_FAILED, "%s", err.message);
    if (code == RETEX_EIO)
        return reply_error(MHD_HTTP_INSUFFICIENT_STORAGE, "%s", err.message);
    if (code)
        return reply_of_error(&err);
    Reply reply = reply_json(MHD_HTTP_OK, json_pack("{s:s}", "etag", etag));
    reply_header(&reply, "ETag", etag);
    return reply;
}

/* A path of the window, within reach: absolute. 0: it is, else the reply. */
static int reach(Request *request, const char *path, Reach how, ReachAccess *access, char absolute[PATH_MAX],
                 Reply *reply)
{
    RetexError err = {0};
    if (places_resolve(&request->studio->places, path, absolute, &err)) {
        *reply = reply_of_error(&err);
        return -1;
    }
    places_access(&request->studio->places, how, access);
    if (retex_access_check(&access->access, "", absolute) == RETEX_ACCESS_OUTSIDE) {
        *reply = reply_error(MHD_HTTP_FORBIDDEN, "this lies outside of the folders that the studio shows");
        return -1;
    }
    return 0;
}

static Reply answer_open(Request *request)
{
    Studio *studio = request->studio;
    Reply reply;
    ReachAccess access;
    RetexError err = {0};
    char path[PATH_MAX];
    json_t *asked = read_object(request, &reply);
    if (!asked || reach(request, text_of(asked, "path"), REACH_LISTED, &access, path, &reply)) {
        json_decref(asked);
        return reply;
    }
    json_decref(asked);
    if (places_open_model(&studio->places, path, &err))
        return reply_of_error(&err);
    preview_stop(&studio->preview);
    changes_wake(&studio->changes);
    return answer_state(request);
}

static Reply answer_trust(Request *request)
{
    Reply reply;
    RetexError err = {0};
    json_t *asked = read_object(request, &reply);
    if (!asked)
        return reply;
    const int code = places_trust(&request->studio->places, text_of(asked, "model"), &err);
    json_decref(asked);
    return code ? reply_of_error(&err) : answer_state(request);
}

static Reply answer_textures(Request *request)
{
    const Model *model = places_model(&request->studio->places);
    Reply reply;
    ReachAccess access;
    RetexError err = {0};
    char path[PATH_MAX];
    if (model && refuse_foreign(request, model, &reply))
        return reply;
    json_t *asked = read_object(request, &reply);
    const int is_refused = !asked || reach(request, text_of(asked, "path"), REACH_LISTED, &access, path, &reply);
    json_decref(asked);
    if (is_refused)
        return reply;
    if (places_add_textures(&request->studio->places, path, &err))
        return reply_of_error(&err);
    return done();
}

/* ---- files ---- */

Reply reply_of_received(const RetexError *err)
{
    if (err->code == RETEX_ELIMIT)
        return reply_error(MHD_HTTP_CONTENT_TOO_LARGE, "%s", err->message);
    if (err->code == RETEX_EIO)
        return reply_error(MHD_HTTP_INSUFFICIENT_STORAGE, "%s", err->message);
    return reply_of_error(err);
}

/* The folder that files are sent to, open, and its path. Below 0: the error. */
static int open_files(Places *places, const Model *model, char folder[PATH_MAX], RetexError *err)
{
    const char *last;
    int top = -1;
    if (model && places_check_trust(places, model, err))
        return -1;
    snprintf(folder, PATH_MAX, "%s%s", model ? model->written : places->dropped, model ? "/" PLACES_FILES : "");
    if (model)
        top = beneath_open_parent(model->top, PLACES_FILES "/.", 1, &last);
    else if (mkdir(folder, 0777) == 0 || errno == EEXIST) /* the user's own, who may have a link there */
        top = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (top < 0)
        retex_fail(err, errno == ELOOP ? RETEX_EACCESS : RETEX_EIO, "cannot write into %s: %s", folder,
                   strerror(errno));
    return top;
}

static int receive_upload(Request *request, Reply *reply)
{
    const char *name = request_query(request, "name"), *as = request_query(request, "as");
    Places *places = &request->studio->places;
    const Model *model = as && strcmp(as, "model") == 0 ? NULL : places_model(places);
    char folder[PATH_MAX];
    RetexError err = {0};
    const int top = open_files(places, model, folder, &err);
    if (top < 0 || received_begin(&request->received, top, folder, name ? name : "", request_length(request), &err))
        *reply = reply_of_received(&err);
    return err.code;
}

static Reply answer_upload(Request *request)
{
    char path[PATH_MAX];
    RetexError err = {0};
    if (received_end(&request->received, path, &err))
        return reply_of_received(&err);
    return reply_json(MHD_HTTP_OK,
                      json_pack("{s:o, s:I}", "path", shown_path(places_model(&request->studio->places), path), "bytes",
                                (json_int_t)request->received.bytes));
}

static json_t *parent_of(const Model *model, const char *absolute)
{
    char parent[PATH_MAX];
    snprintf(parent, sizeof parent, "%s", absolute);
    char *slash = strrchr(parent, '/');
    if (!slash || !slash[1])
        return json_null();
    slash[slash == parent] = 0;
    return model && strcmp(parent, model->folder) == 0 ? json_string("") : shown_path(model, parent);
}

static int is_missing(const char *path)
{
    struct stat status;
    return stat(path, &status) != 0 && (errno == ENOENT || errno == ENOTDIR);
}

/* Folders below that of what is written are made when they get their first file: until then they are empty. */
static Reply answer_folder(Request *request)
{
    const char *asked = request_query(request, "path");
    const Model *model = places_model(&request->studio->places);
    Reply reply;
    ReachAccess access, above;
    RetexError err = {0};
    char path[PATH_MAX], parent[PATH_MAX];
    json_t *list = NULL;
    int is_cut = 0;
    if (reach(request, asked ? asked : "", REACH_LISTED, &access, path, &reply))
        return reply;
    /* paths of entries are relative where they can be */
    json_t *shown = model && strcmp(path, model->folder) == 0 ? json_string("") : shown_path(model, path);
    const int is_to_come = is_missing(path) && model && output_is_below(path, model->written);
    if (is_to_come)
        list = json_array();
    const int code =
        is_to_come ? RETEX_OK : folder_list(path, json_string_value(shown), &access.access, &list, &is_cut, &err);
    if (code) {
        json_decref(list);
        json_decref(shown);
        return is_missing(path) ? reply_error(MHD_HTTP_NOT_FOUND, "there is no folder %s", path) : reply_of_error(&err);
    }
    snprintf(parent, sizeof parent, "%s", path);
    *(strrchr(parent, '/') ? strrchr(parent, '/') : parent) = 0;
    places_access(&request->studio->places, REACH_LISTED, &above);
    const int is_top = !*parent || retex_access_check(&above.access, "", parent) == RETEX_ACCESS_OUTSIDE;
    return reply_json(MHD_HTTP_OK,
                      json_pack("{s:o, s:o, s:o, s:b}", "path", shown, "parent",
                                is_top ? json_null() : parent_of(model, path), "entries", list, "cut", is_cut));
}

static Reply answer_thumb(Request *request)
{
    const char *asked = request_query(request, "path"), *wanted = request_query(request, "size");
    const int size = wanted ? atoi(wanted) : 256;
    char path[PATH_MAX], etag[THUMBS_KEY + 2];
    ReachAccess access;
    Reply reply;
    RetexError err = {0};
    void *data = NULL;
    size_t bytes = 0;
    if (size < THUMB_LEAST || size > THUMB_MOST)
        return reply_error(MHD_HTTP_BAD_REQUEST, "size: expected %d to %d", THUMB_LEAST, THUMB_MOST);
    if (reach(request, asked ? asked : "", REACH_LISTED, &access, path, &reply))
        return reply;
    if (is_missing(path))
        return reply_error(MHD_HTTP_NOT_FOUND, "there is no file %s", path);
    if (thumbs_get(&request->studio->thumbs, path, &access.access, size, &data, &bytes, etag, &err))
        return reply_of_error(&err);
    const char *seen = request_header(request, "If-None-Match");
    const int is_seen = seen && strcmp(seen, etag) == 0;
    reply = reply_bytes(is_seen ? MHD_HTTP_NOT_MODIFIED : MHD_HTTP_OK, "image/jpeg", data, is_seen ? 0 : bytes);
    reply_header(&reply, "ETag", etag);
    reply_header(&reply, "Cache-Control", "no-cache");
    return reply;
}

static Reply answer_files(Request *request)
{
    char path[PATH_MAX];
    ReachAccess access;
    Reply reply;
    RetexError err = {0};
    int file = -1;
    if (reach(request, request->rest, REACH_SHOWN, &access, path, &reply))
        return reply;
    if (retex_access_open(&access.access, path, &file, &err))
        return reply_error(err.code == RETEX_EACCESS ? MHD_HTTP_FORBIDDEN : MHD_HTTP_NOT_FOUND,
                           "%s: there is no such file", request->rest);
    return media_file(request, file, media_type(path, 0));
}

/* ---- jobs ---- */

static Reply answer_jobs(Request *request)
{
    Studio *studio = request->studio;
    changes_lock(&studio->changes);
    json_t *list = jobs_list(&studio->jobs, 0);
    changes_unlock(&studio->changes);
    return reply_json(MHD_HTTP_OK, list);
}

static Reply answer_job(Request *request)
{
    Studio *studio = request->studio;
    const Model *model = places_model(&studio->places);
    Reply reply;
    RetexError err = {0};
    json_t *asked = refuse_foreign(request, model, &reply) ? NULL : read_object(request, &reply);
    if (!asked)
        return reply;
    const int number = jobs_add(&studio->jobs, asked, &studio->limits, model, &err);
    json_decref(asked);
    return number < 0 ? reply_of_error(&err) : reply_json(MHD_HTTP_OK, json_pack("{s:i}", "job", number));
}

static Reply answer_job_stop(Request *request)
{
    RetexError err = {0};
    return jobs_stop(&request->studio->jobs, atoi(request->rest), &err) ? reply_of_error(&err) : done();
}

static Reply answer_events(Request *request)
{
    const char *last = request_header(request, "Last-Event-ID");
    return events_stream(request->studio, last ? strtoull(last, NULL, 10) : 0);
}

/* ---- preview ---- */

static Reply answer_preview(Request *request)
{
    Studio *studio = request->studio;
    changes_lock(&studio->changes);
    json_t *json = preview_json(&studio->preview);
    changes_unlock(&studio->changes);
    return reply_json(MHD_HTTP_OK, json);
}

static Reply answer_preview_start(Request *request)
{
    Studio *studio = request->studio;
    const Model *model = places_model(&studio->places);
    Reply reply;
    RetexError err = {0};
    Line line;
    json_t *asked = refuse_foreign(request, model, &reply) ? NULL : read_object(request, &reply);
    if (!asked)
        return reply;
    const int code =
        line_make_live(&line, text_of(asked, "scene"), json_object_get(asked, "args"), &studio->limits, model, &err);
    json_decref(asked);
    if (code)
        return reply_of_error(&err);
    preview_start(&studio->preview, &line, model, !studio->limits.is_unsafe);
    return done();
}

static Reply answer_preview_stop(Request *request)
{
    preview_stop(&request->studio->preview);
    return done();
}

static Reply answer_preview_line(Request *request)
{
    Reply reply;
    RetexError err = {0};
    json_t *asked = read_object(request, &reply);
    if (!asked)
        return reply;
    const int code = preview_send(&request->studio->preview, text_of(asked, "line"), &err);
    json_decref(asked);
    return code == RETEX_ENOTFOUND ? reply_error(MHD_HTTP_CONFLICT, "%s", err.message)
           : code == RETEX_ELIMIT  ? reply_error(MHD_HTTP_SERVICE_UNAVAILABLE, "%s", err.message)
           : code                  ? reply_of_error(&err)
                                   : done();
}

static void release_answer(void *answer)
{
    live_answer_release(answer);
}

/* Bytes of an answer, without a copy. */
static Reply reply_of_answer(LiveAnswer *answer)
{
    Reply reply = {MHD_HTTP_OK, MHD_create_response_from_buffer_with_free_callback_cls(answer->bytes, answer->data,
                                                                                       release_answer, answer)};
    reply_header(&reply, "Content-Type", "application/octet-stream");
    reply_header(&reply, "Retex-Picture", answer->line);
    if (!reply.response)
        live_answer_release(answer);
    return reply;
}

/* The line of an answer is too long for a header where it lists surfaces: it stands before the bytes then. */
static Reply reply_with_line(LiveAnswer *answer)
{
    const size_t line = strlen(answer->line), bytes = line + 1 + answer->bytes;
    char *data = malloc(bytes);
    if (data) {
        memcpy(data, answer->line, line);
        data[line] = '\n';
        memcpy(data + line + 1, answer->data, answer->bytes);
    }
    live_answer_release(answer);
    return data ? reply_bytes(MHD_HTTP_OK, "application/octet-stream", data, bytes)
                : reply_error(MHD_HTTP_INTERNAL_SERVER_ERROR, "not enough memory");
}

static LiveAnswer *wait_for_answer(Request *request, AnswerKind kind, Reply *reply)
{
    const char *after = request_query(request, "after"), *wait = request_query(request, "wait");
    char why[SAID_LINE + 1];
    int is_running, seconds = wait ? atoi(wait) : WAIT_SECONDS;
    LiveAnswer *answer = preview_answer(&request->studio->preview, kind, after ? strtoull(after, NULL, 10) : 0,
                                        seconds < WAIT_SECONDS ? seconds : WAIT_SECONDS, &is_running, why);
    if (answer)
        return answer;
    *reply = is_running ? reply_constant("application/octet-stream", "", 0)
                        : reply_error(MHD_HTTP_CONFLICT, "%s", *why ? why : "there is no preview");
    if (is_running)
        reply->status = MHD_HTTP_NO_CONTENT;
    return NULL;
}

static Reply answer_picture(Request *request)
{
    Reply reply;
    LiveAnswer *answer = wait_for_answer(request, ANSWER_PICTURE, &reply);
    return !answer ? reply : strlen(answer->line) < HEADER_BYTES ? reply_of_answer(answer) : reply_with_line(answer);
}

static Reply answer_preview_answer(Request *request)
{
    const char *name = request_query(request, "kind");
    AnswerKind kind;
    Reply reply;
    if (!name || !preview_kind(name, &kind))
        return reply_error(MHD_HTTP_BAD_REQUEST, "kind: expected live, picture, surfaces, uv or error");
    LiveAnswer *answer = wait_for_answer(request, kind, &reply);
    return answer ? reply_with_line(answer) : reply;
}

/* ---- the end ---- */

static Reply answer_quit(Request *request)
{
    Studio *studio = request->studio;
    changes_lock(&studio->changes);
    studio->is_quitting = 1;
    changes_unlock(&studio->changes);
    changes_wake(&studio->changes);
    return done();
}

/* ---- all of them ---- */

static const Route routes[] = {
    {"GET", "api/state", answer_state, NULL},
    {"GET", "api/project", answer_project, NULL},
    {"PUT", "api/project", answer_project_put, NULL},
    {"POST", "api/open", answer_open, NULL},
    {"POST", "api/trust", answer_trust, NULL},
    {"POST", "api/textures", answer_textures, NULL},
    {"POST", "api/upload", answer_upload, receive_upload},
    {"GET", "api/folder", answer_folder, NULL},
    {"GET", "api/thumb", answer_thumb, NULL},
    {"GET", "files/*", answer_files, NULL},
    {"GET", "api/jobs", answer_jobs, NULL},
    {"POST", "api/jobs", answer_job, NULL},
    {"POST", "api/jobs/*/stop", answer_job_stop, NULL},
    {"GET", "api/events", answer_events, NULL},
    {"GET", "api/preview", answer_preview, NULL},
    {"POST", "api/preview", answer_preview_line, NULL},
    {"POST", "api/preview/start", answer_preview_start, NULL},
    {"POST", "api/preview/stop", answer_preview_stop, NULL},
    {"GET", "api/preview/picture", answer_picture, NULL},
    {"GET", "api/preview/answer", answer_preview_answer, NULL},
    {"POST", "api/quit", answer_quit, NULL},
    {"GET", "*", answer_page, NULL}, /* last */
};

/* Whether a path is as a row says; rest: what the asterisk stands for. */
static int is_path(const char *row, const char *path, char *rest, size_t size)
{
    const size_t before = strcspn(row, "*"), length = strlen(path);
    if (!row[before])
        return strcmp(row, path) == 0;
    const size_t after = strlen(row + before + 1);
    if (length < before + after || strncmp(row, path, before) != 0 ||
        strcmp(row + before + 1, path + length - after) != 0 || length - before - after >= size)
        return 0;
    memcpy(rest, path + before, length - before - after);
    rest[length - before - after] = 0;
    return 1;
}

const Route *route_find(const char *method, const char *path, char *rest, size_t size, int *other_method)
{
    const char *asked = strcmp(method, "HEAD") == 0 ? "GET" : method;
    *rest = 0;
    *other_method = 0;
    for (size_t k = 0; k < sizeof routes / sizeof *routes; k++) {
        if (!is_path(routes[k].path, path, rest, size))
            continue;
        if (strcmp(routes[k].method, asked) == 0)
            return &routes[k];
        *other_method = 1;
    }
    return NULL;
}
