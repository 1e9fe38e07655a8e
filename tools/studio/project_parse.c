/* What a project may hold. retex-studio(5) describes the members. */
#include "project.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { VERSION = 1 };

typedef enum Kind {
    TEXT,   /* of one line */
    WORDS,  /* the same, not empty */
    LINES,  /* any text, which is only shown */
    SET,    /* the path of a set that was rendered here */
    MODEL,  /* the model's name */
    PATH,   /* of a folder that the user chose */
    THUMB,  /* a JPEG as a data URL, or nothing */
    NUMBER, /* of a range */
    COUNT,  /* a whole one */
    FLAG,
    VECTOR,
    OBJECT, /* of fields */
    LIST,   /* of what one field says */
    MAP     /* the same, by names */
} Kind;

typedef struct Field {
    const char *name; /* NULL: the end of an object's */
    Kind kind;
    enum { NEEDED, OPTIONAL, OR_NULL } presence; /* OR_NULL: is optional too */
    double least, most;                          /* of numbers; most: of a list, how many */
    const struct Field *of;
} Field;

static const Field a_word = {"", WORDS, NEEDED, 0, 0, NULL}, a_line = {"", LINES, NEEDED, 0, 0, NULL},
                   a_path = {"", PATH, NEEDED, 0, 0, NULL}, a_width = {"", NUMBER, NEEDED, 0, 1e6, NULL};

static const Field import_fields[] = {{"camera", TEXT, OPTIONAL, 0, 0, NULL},
                                      {"variant", TEXT, OPTIONAL, 0, 0, NULL},
                                      {"unit", TEXT, OPTIONAL, 0, 0, NULL},
                                      {"up", TEXT, OPTIONAL, 0, 0, NULL},
                                      {"lights", TEXT, OPTIONAL, 0, 0, NULL},
                                      {"sky", TEXT, OPTIONAL, 0, 0, NULL},
                                      {"partial", FLAG, OPTIONAL, 0, 0, NULL},
                                      {"done", FLAG, OPTIONAL, 0, 0, NULL},
                                      {"number", COUNT, OPTIONAL, 0, 1e9, NULL},
                                      {"lines", LIST, OPTIONAL, 0, 1000, &a_line},
                                      {0}};
#define CAMERA                                                                                                         \
    {"eye", VECTOR, NEEDED, 0, 0, NULL}, {"at", VECTOR, NEEDED, 0, 0, NULL},                                           \
    {                                                                                                                  \
        "angle", NUMBER, NEEDED, 1e-6, 179.999999, NULL                                                                \
    }
static const Field view_fields[] = {CAMERA, {0}};
static const Field camera_fields[] = {
    CAMERA, {"name", WORDS, NEEDED, 0, 0, NULL}, {"thumb", THUMB, OPTIONAL, 0, 0, NULL}, {0}};
static const Field target_fields[] = {{"name", WORDS, NEEDED, 0, 0, NULL},
                                      {"select", WORDS, NEEDED, 0, 0, NULL},
                                      {"uv", TEXT, OPTIONAL, 0, 0, NULL},
                                      {"share", NUMBER, OPTIONAL, 0, 1, NULL},
                                      {0}};
static const Field render_fields[] = {
    {"width", COUNT, NEEDED, 16, 16384, NULL}, {"height", COUNT, NEEDED, 16, 16384, NULL},
    {"samples", COUNT, NEEDED, 1, 1e9, NULL},  {"noise", NUMBER, NEEDED, 0, 1e3, NULL},
    {"denoise", FLAG, OPTIONAL, 0, 0, NULL},   {0}};
static const Field a_target = {"", OBJECT, NEEDED, 0, 0, target_fields},
                   a_camera = {"", OBJECT, NEEDED, 0, 0, camera_fields},
                   some_finishes = {"", LIST, NEEDED, 0, 100, &a_word};
/* What a render depends on. */
#define SETTINGS(presence)                                                                                             \
    {"view", OBJECT, OR_NULL, 0, 0, view_fields}, {"targets", LIST, presence, 0, 8, &a_target},                        \
        {"lamps", LIST, presence, 0, 100, &a_word}, {"finishes", MAP, presence, 0, 0, &some_finishes},                 \
    {                                                                                                                  \
        "render", OBJECT, presence, 0, 0, render_fields                                                                \
    }
static const Field settings_fields[] = {SETTINGS(NEEDED), {0}};
static const Field set_fields[] = {{"set", SET, NEEDED, 0, 0, NULL},
                                   {"settings", OBJECT, NEEDED, 0, 0, settings_fields},
                                   {"done", FLAG, OPTIONAL, 0, 0, NULL},
                                   {"when", TEXT, OPTIONAL, 0, 0, NULL},
                                   {"seconds", NUMBER, OPTIONAL, 0, 1e12, NULL},
                                   {"part", NUMBER, OPTIONAL, 0, 1, NULL},
                                   {"error", LINES, OPTIONAL, 0, 0, NULL},
                                   {0}};
static const Field texture_fields[] = {
    {"folders", LIST, NEEDED, 0, PLACES_TEXTURES, &a_path}, {"widths", MAP, NEEDED, 0, 0, &a_width}, {0}};
static const Field preset_fields[] = {{"name", WORDS, NEEDED, 0, 0, NULL}, {"look", TEXT, NEEDED, 0, 0, NULL}, {0}};
static const Field a_set = {"", OBJECT, NEEDED, 0, 0, set_fields}, a_preset = {"", OBJECT, NEEDED, 0, 0, preset_fields};

static const Field project_fields[] = {{"model", MODEL, NEEDED, 0, 0, NULL},
                                       {"import", OBJECT, OPTIONAL, 0, 0, import_fields},
                                       {"cameras", LIST, OPTIONAL, 0, 1000, &a_camera},
                                       SETTINGS(OPTIONAL),
                                       {"renders", LIST, OPTIONAL, 0, 10000, &a_set},
                                       {"textures", OBJECT, OPTIONAL, 0, 0, texture_fields},
                                       {"look", TEXT, OPTIONAL, 0, 0, NULL},
                                       {"presets", LIST, OPTIONAL, 0, 10000, &a_preset},
                                       {0}};
static const Field project_field = {"", OBJECT, NEEDED, 0, 0, project_fields};

/* ---- texts ---- */

static int is_one_line(const char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < 32 || *text == 127)
            return 0;
    return 1;
}

/* `room.glb.studio/renders/1.exr`: below the model's own folder, and not hidden, upwards, or an option. */
static int is_set_of(const char *path, const Model *model)
{
    const char *written = strrchr(model->written, '/') + 1, *dot = strrchr(path, '.');
    const size_t length = strlen(written);
    if (strncmp(path, written, length) != 0 || path[length] != '/' || strcmp(dot, ".exr") != 0)
        return 0;
    for (const char *slash = strchr(path, '/'); slash; slash = strchr(slash + 1, '/'))
        if (strchr("./-", slash[1])) /* or the end */
            return 0;
    return 1;
}

static int is_text(Kind kind, const char *text, const Model *model)
{
    static const char jpeg[] = "data:image/jpeg;base64,";
    if (!text || (kind != LINES && !is_one_line(text)))
        return 0;
    return kind == WORDS   ? *text != 0
           : kind == PATH  ? *text && *text != '-'
           : kind == SET   ? is_set_of(text, model)
           : kind == MODEL ? strcmp(text, model->name) == 0
           : kind == THUMB ? !*text || strncmp(text, jpeg, sizeof jpeg - 1) == 0
                           : 1;
}

/* ---- values ---- */

/* Where the check is: what of the name of a member stays where it fails. */
typedef struct Check {
    const Model *model;
    char at[128];
} Check;

static int check_value(Check *check, const Field *field, const json_t *value);

/* Check what is called so below the present place. */
static int check_below(Check *check, const Field *field, const json_t *value, const char *name)
{
    const size_t length = strlen(check->at);
    snprintf(check->at + length, sizeof check->at - length, "%s%s", length && *name != '[' ? "." : "", name);
    const int is_right = check_value(check, field, value);
    if (is_right)
        check->at[length] = 0;
    return is_right;
}

static int check_object(Check *check, const Field *fields, const json_t *value)
{
    for (; json_is_object(value) && fields->name; fields++) {
        const json_t *member = json_object_get(value, fields->name);
        const int may_be_so = member ? fields->presence == OR_NULL && json_is_null(member) : fields->presence != NEEDED;
        if (!may_be_so && !check_below(check, fields, member, fields->name))
            return 0;
    }
    return json_is_object(value);
}

static int check_list(Check *check, const Field *field, const json_t *value)
{
    char number[32];
    if (!json_is_array(value) || (double)json_array_size(value) > field->most)
        return 0;
    for (size_t i = 0; i < json_array_size(value); i++) {
        snprintf(number, sizeof number, "[%zu]", i);
        if (!check_below(check, field->of, json_array_get(value, i), number))
            return 0;
    }
    return 1;
}

static int check_map(Check *check, const Field *field, const json_t *value)
{
    const char *name;
    json_t *of;
    json_object_foreach((json_t *)value, name,
                        of) if (!is_one_line(name) || !check_value(check, field->of, of)) return 0;
    return json_is_object(value);
}

static int is_vector(const json_t *value)
{
    for (size_t i = 0; i < 3; i++)
        if (!json_is_number(json_array_get(value, i)))
            return 0;
    return json_array_size(value) == 3;
}

static int check_value(Check *check, const Field *field, const json_t *value)
{
    const double number = json_number_value(value);
    switch (field->kind) {
    case NUMBER:
    case COUNT:
        return json_is_number(value) && number >= field->least && number <= field->most &&
               (field->kind == NUMBER || number == floor(number));
    case FLAG:
        return json_is_boolean(value);
    case VECTOR:
        return is_vector(value);
    case OBJECT:
        return check_object(check, field->of, value);
    case LIST:
        return check_list(check, field, value);
    case MAP:
        return check_map(check, field, value);
    default:
        return is_text(field->kind, json_string_value(value), check->model);
    }
}

json_t *project_parse(const char *text, size_t bytes, const Model *model, RetexError *err)
{
    json_error_t fault;
    json_t *root = json_loadb(text, bytes, JSON_REJECT_DUPLICATES, &fault);
    const json_t *version = json_object_get(root, "retex-studio");
    Check check = {.model = model};
    if (!root)
        retex_fail(err, RETEX_EPARSE, "the project is damaged: %s", fault.text);
    else if (!json_is_integer(version))
        retex_fail(err, RETEX_EPARSE, "this is no project of retex studio");
    else if (json_integer_value(version) != VERSION)
        retex_fail(err, RETEX_EPARSE,
                   "this project was written by a newer retex studio: install that version to open it");
    else if (!check_value(&check, &project_field, root))
        retex_fail(err, RETEX_EPARSE, "the project is damaged: \"%s\" is not as it should be", check.at);
    else
        return root;
    json_decref(root);
    return NULL;
}
