/* Edits in memory, and the forms in which their statements come: see retex/edit.h. What is added is added to a copy,
 * which becomes the edit where nothing failed. */
#include <retex/edit.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/nearest.h>

#include "base/params.h"
#include "edit/edit.h"
#include "edit/finishes.h"
#include "edit/keyed.h"
#include "edit/lights.h"
#include "edit/picture.h"
#include "edit/statement.h"

enum { STATEMENT_MAX = 4096 }; /* bytes of a statement, and of the options of a texture */

const RetexKeyedKind *const retex_edit_keyed[RETEX_EDIT_KEYED] = {
    [RETEX_EDIT_LIGHTS] = &retex_keyed_light,
    [RETEX_EDIT_FINISHES] = &retex_keyed_finish,
    [RETEX_EDIT_PICTURE] = &retex_keyed_picture,
};

int retex_edit_create(RetexEdit **edit, RetexError *err)
{
    *edit = calloc(1, sizeof **edit);
    return *edit ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory for an edit");
}

void retex_edit_close(RetexEdit **edit)
{
    free(*edit);
    *edit = NULL;
}

void retex_edit_clear(RetexEdit *edit)
{
    edit->count = 0;
    for (int kind = 0; kind < RETEX_EDIT_KEYED; kind++)
        edit->keyed[kind].count = 0;
}

int retex_edit_count(const RetexEdit *edit)
{
    return edit->count;
}

RetexTextureSpec *retex_edit_texture(RetexEdit *edit, int index)
{
    return &edit->specs[index];
}

/* ---- statements ---- */

/* The index of a target, whose texture is added if there is none. */
static int find_texture(RetexEdit *edit, const char *target, int *index, RetexError *err)
{
    int at = 0, order = 1;
    while (at < edit->count && (order = strcmp(edit->specs[at].target, target)) < 0)
        at++;
    *index = at;
    if (at < edit->count && order == 0)
        return RETEX_OK;
    if (edit->count == RETEX_MAX_TARGETS)
        return retex_fail(err, RETEX_EPARSE, "textures for more than %d targets", RETEX_MAX_TARGETS);
    if (strlen(target) >= sizeof edit->specs->target)
        return retex_fail(err, RETEX_EPARSE, "texture '%.40s…': a target's name has at most %d bytes", target,
                          (int)sizeof edit->specs->target - 1);
    memmove(edit->specs + at + 1, edit->specs + at, (size_t)(edit->count - at) * sizeof *edit->specs);
    memmove(edit->said_of_layers + at + 1, edit->said_of_layers + at,
            (size_t)(edit->count - at) * sizeof *edit->said_of_layers);
    memmove(edit->said + at + 1, edit->said + at, (size_t)(edit->count++ - at) * sizeof *edit->said);
    memset(edit->said_of_layers[at], 0, sizeof edit->said_of_layers[at]);
    edit->specs[at] = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
    edit->said[at] = 0;
    strcpy(edit->specs[at].target, target);
    return RETEX_OK;
}

/* The list that a key with a prefix belongs to; *name: what is behind the prefix. -1: it is another key. */
static int keyed_of(const char *key, const char **name)
{
    for (int kind = 0; kind < RETEX_EDIT_KEYED; kind++) {
        const size_t length = strlen(retex_edit_keyed[kind]->word);
        if (strncmp(key, retex_edit_keyed[kind]->word, length) == 0 && key[length] == ':') {
            *name = key + length + 1;
            return kind;
        }
    }
    return -1;
}

const char *retex_edit_key_name(const char *key)
{
    const char *name = NULL;
    keyed_of(key, &name);
    return name;
}

/* Where the word of an option begins in a key; NULL in the key of a texture itself. */
static const char *find_option(const char *key)
{
    const char *dot = strrchr(key, '.');
    return dot && !retex_edit_key_name(key) && retex_statement_option(dot + 1, strlen(dot + 1)) >= 0 ? dot + 1 : NULL;
}

int retex_edit_key_is_option(const char *key)
{
    return find_option(key) != NULL;
}

static int no_statement(const char *key, RetexError *err)
{
    char forms[400] = "";
    for (int kind = 0; kind < RETEX_EDIT_KEYED; kind++) {
        const size_t used = strlen(forms);
        snprintf(forms + used, sizeof forms - used, "%s%s:%s", kind + 1 < RETEX_EDIT_KEYED ? ", " : " or ",
                 retex_edit_keyed[kind]->word, retex_edit_keyed[kind]->form);
    }
    return retex_fail(err, RETEX_EPARSE, "`%.200s`: expected TARGET=IMAGE, TARGET.OPTION=VALUE%s", key, forms);
}

/* A statement of a texture, or of a layer of it. */
static int parse_of(RetexTextureSpec *spec, int layer, int kind, const char *value, RetexError *err)
{
    return layer ? retex_statement_parse_layer(spec, layer, kind, value, err)
                 : retex_statement_parse(spec, kind, value, err);
}

static int state(RetexEdit *edit, const char *target, const char *option /* or NULL */, const char *value,
                 RetexError *err)
{
    const int kind = option ? retex_statement_option(option, strlen(option)) : 0;
    const char *name;
    const int layer = retex_statement_layer(target, &name);
    int at, code = find_texture(edit, name, &at, err);
    if (code)
        return code;
    unsigned *said = layer ? &edit->said_of_layers[at][layer - 1] : &edit->said[at];
    if (*said & 1u << kind)
        return retex_fail(err, RETEX_EPARSE, "%s%s%s is given twice", target, option ? "." : "", option ? option : "");
    *said |= 1u << kind;
    return parse_of(&edit->specs[at], layer, kind, value, err);
}

/* A statement that is decoded; option: or NULL. */
static int add_statement(RetexEdit *edit, const char *key, const char *option, const char *value, RetexError *err)
{
    const char *name;
    const int kind = keyed_of(key, &name);
    return kind < 0 ? state(edit, key, option, value, err)
                    : retex_keyed_add(&edit->keyed[kind], retex_edit_keyed[kind], name, value, err);
}

int retex_edit_set(RetexEdit *edit, const char *key, const char *value, RetexError *err)
{
    char target[STATEMENT_MAX];
    const char *option = find_option(key);
    const size_t length = option ? (size_t)(option - 1 - key) : strlen(key);
    if (length < 1 || length >= sizeof target || !*value)
        return no_statement(key, err);
    memcpy(target, key, length);
    target[length] = '\0';
    RetexEdit next = *edit;
    const int code = add_statement(&next, target, option, value, err);
    if (!code)
        *edit = next;
    return code;
}

int retex_edit_check(const RetexEdit *edit, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < edit->count && !code; i++) {
        const char *target = edit->specs[i].target;
        const int is_original = !edit->said[i] && edit->specs[i].nlayers; /* layers lie on it */
        code = (edit->said[i] & 1) || is_original
                   ? retex_statement_check(&edit->specs[i], err)
                   : retex_fail(err, RETEX_EPARSE, "%s has options, but no texture; expected %s=IMAGE too", target,
                                target);
        for (int k = 0; k < edit->specs[i].nlayers && !code; k++)
            if (!(edit->said_of_layers[i][k] & 1))
                code = retex_fail(err, RETEX_EPARSE, "layer %d on %s has no image; the first is over:%s=IMAGE", k + 1,
                                  target, target);
    }
    return code;
}

/* ---- text ---- */

/* Decodes, in place, the characters that mean something in the text of an edit. */
static void decode(char *text)
{
    static const char *const codes[] = {"25", "26", "2E", "2e", "3B", "3b"};
    enum { CODES = sizeof codes / sizeof *codes };
    char *out = text;
    for (const char *c = text; *c; c++) {
        int i = *c == '%' ? 0 : CODES;
        while (i < CODES && strncmp(c + 1, codes[i], 2) != 0)
            i++;
        *out++ = i < CODES ? "%&..;;"[i] : *c;
        c += i < CODES ? 2 : 0;
    }
    *out = '\0';
}

/* One statement of a text, which is changed. */
static int parse_statement(RetexEdit *edit, char *text, RetexError *err)
{
    char *value = strchr(text, '='), *option;
    if (!value)
        return no_statement(text, err);
    *value++ = '\0';
    option = (char *)find_option(text);
    if (option)
        option[-1] = '\0';
    decode(text);
    decode(value);
    if (!*text || !*value)
        return no_statement(text, err);
    return add_statement(edit, text, option, value, err);
}

int retex_edit_parse(RetexEdit *edit, const char *text, RetexError *err)
{
    RetexEdit next = *edit;
    int code = RETEX_OK;
    while (*text && !code) {
        char statement[STATEMENT_MAX];
        const size_t length = strcspn(text, ";&");
        if (length >= sizeof statement)
            return retex_fail(err, RETEX_EPARSE, "`%.40s…`: a statement of more than %d characters", text,
                              STATEMENT_MAX - 1);
        memcpy(statement, text, length);
        statement[length] = '\0';
        code = parse_statement(&next, statement, err);
        text += length;
        if (!code && *text && !*++text)
            code = no_statement(text, err);
    }
    if (!code)
        code = retex_edit_check(&next, err);
    if (!code)
        *edit = next;
    return code;
}

/* ---- options and cells ---- */

/* Whether the word `over` is among the options. */
static int has_over(const char *opts)
{
    for (const char *at = opts; *at; at += strcspn(at, ":"), at += *at == ':')
        if (strcspn(at, ":") == 4 && strncmp(at, "over", 4) == 0)
            return 1;
    return 0;
}

/* `opts`, of which the last of a name holds, of a texture or a layer, whose word is passed over. */
static int parse_options(RetexTextureSpec *spec, int layer, const char *opts, RetexError *err)
{
    char text[STATEMENT_MAX];
    int code = RETEX_OK;
    if (strlen(opts) >= sizeof text)
        return retex_fail(err, RETEX_EPARSE, "texture options of more than %zu characters", sizeof text - 1);
    strcpy(text, opts);
    for (char *at = text, *next; at && !code; at = next) {
        next = strchr(at, ':');
        if (next)
            *next++ = '\0';
        if (!*at || (layer && strcmp(at, "over") == 0)) /* "::" and a colon at either end are allowed */
            continue;
        char *value = strchr(at, '=');
        if (!value)
            return retex_fail(err, RETEX_EPARSE, "texture option '%s' has no value; expected name=value, as in scale=2",
                              at);
        *value++ = '\0';
        const int kind = retex_statement_option(at, strlen(at));
        code = kind < 0 ? retex_statement_unknown(at, err) : parse_of(spec, layer, kind, value, err);
    }
    return code;
}

/* A target that is called as a key with a prefix would be that in the text of the edit. */
static int no_target(const char *name, RetexError *err)
{
    return retex_fail(err, RETEX_EPARSE, "texture '%.80s': the name of a target cannot begin so", name);
}

/* layer: of `target`, from 1; 0: the texture itself; -1: the next layer. */
static int add_texture(RetexEdit *edit, const char *target, int layer, const char *opts, const char *image,
                       RetexError *err)
{
    RetexEdit next = *edit;
    if (retex_edit_key_name(target))
        return no_target(target, err);
    int at, code = find_texture(&next, target, &at, err);
    layer = layer < 0 && !code ? 1 + next.specs[at].nlayers : layer;
    if (!code && layer > RETEX_LAYERS_MAX)
        code = retex_fail(err, RETEX_EINVAL, "target %s is given more than %d layers", target, RETEX_LAYERS_MAX);
    unsigned *said = layer && !code ? &next.said_of_layers[at][layer - 1] : &next.said[at];
    if (!code && *said)
        code = retex_fail(err, RETEX_EINVAL, "target %s is given two textures", target);
    if (!code)
        code = parse_options(&next.specs[at], layer, opts, err);
    if (!code)
        code = parse_of(&next.specs[at], layer, 0, image, err);
    if (!code)
        *said |= 1;
    if (!code)
        code = retex_statement_check(&next.specs[at], err);
    if (!code)
        *edit = next;
    return code;
}

int retex_edit_option(RetexEdit *edit, const char *opts, const char *arg, RetexError *err)
{
    char key[sizeof edit->specs->target + 8];
    const char *target, *equals = arg ? strchr(arg, '=') : NULL;
    if (!equals || equals == arg)
        return retex_fail(err, RETEX_EPARSE, "texture '%s': expected NAME=IMAGE, a target and what to put on it",
                          arg ? arg : "");
    if (!equals[1])
        return retex_fail(err, RETEX_EPARSE, "texture '%s': no image after '='", arg);
    snprintf(key, sizeof key, "%.*s", (int)(equals - arg), arg);
    opts = opts ? opts : "";
    const int is_layer = retex_statement_layer(key, &target) || has_over(opts); /* the next one */
    return add_texture(edit, target, is_layer ? -1 : 0, opts, equals + 1, err);
}

int retex_edit_add(RetexEdit *edit, const RetexTextureSpec *given, RetexError *err)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexEdit next = *edit;
    int at, code = RETEX_PARAMS_COPY(&spec, given, err);
    if (!code && retex_edit_key_name(spec.target))
        code = no_target(spec.target, err);
    if (!code)
        code = find_texture(&next, spec.target, &at, err);
    if (!code && (next.said[at] || next.specs[at].nlayers))
        code = retex_fail(err, RETEX_EINVAL, "target %s is given two textures", spec.target);
    if (!code)
        code = retex_statement_check(&spec, err);
    if (code)
        return code;
    next.specs[at] = spec;
    next.said[at] = spec.constant || spec.image[0];
    for (int k = 0; k < spec.nlayers; k++)
        next.said_of_layers[at][k] = 1;
    *edit = next;
    return RETEX_OK;
}

/* A part of a cell: `IMAGE`, or `:opts IMAGE`. */
static int add_part(RetexEdit *edit, const char *target, int layer, char *part, RetexError *err)
{
    char *image = part;
    if (*part == ':') {
        image += strcspn(part, " ");
        if (*image)
            *image++ = '\0';
        image += strspn(image, " ");
    }
    if (!*image)
        return retex_fail(err, RETEX_EPARSE, "options without an image; expected `:scale=2 IMAGE`");
    return add_texture(edit, target, layer, *part == ':' ? part : "", image, err);
}

int retex_edit_cell(RetexEdit *edit, const char *target, const char *cell, RetexError *err)
{
    static const char divider[] = " + ";
    char text[STATEMENT_MAX], *part = text;
    if (strlen(cell) >= sizeof text)
        return retex_fail(err, RETEX_EPARSE, "a cell of more than %d characters", STATEMENT_MAX - 1);
    strcpy(text, cell);
    const int is_original = strncmp(text, divider + 1, 2) == 0; /* `+ logo.png`: layers on the original */
    part += is_original ? 2 : 0;
    int code = RETEX_OK;
    for (int layer = is_original ? -1 : 0; part && !code; layer = -1) {
        char *next = strstr(part, divider);
        if (next) {
            *next = '\0';
            next += strlen(divider);
        }
        code = add_part(edit, target, layer, part, err);
        part = next;
    }
    return code;
}

/* ---- targets ---- */

int retex_edit_bind(RetexEdit *edit, const RetexTargetNames *names, RetexError *err)
{
    RetexEdit next = *edit;
    next.count = 0;
    for (int i = 0; i < edit->count; i++) {
        int target, at, code = retex_target_find(&target, names, edit->specs[i].target, err);
        if (!code)
            code = find_texture(&next, names->names[target], &at, err);
        if (!code && (next.said[at] || next.specs[at].nlayers))
            code = retex_fail(err, RETEX_EINVAL, "target %s is given two textures", names->names[target]);
        if (code)
            return code;
        next.specs[at] = edit->specs[i];
        next.said[at] = edit->said[i];
        memcpy(next.said_of_layers[at], edit->said_of_layers[i], sizeof next.said_of_layers[at]);
        strcpy(next.specs[at].target, names->names[target]);
    }
    *edit = next;
    return RETEX_OK;
}

/* ---- keyed statements ---- */

int retex_edit_lights(const RetexEdit *edit)
{
    return edit->keyed[RETEX_EDIT_LIGHTS].count + edit->keyed[RETEX_EDIT_FINISHES].count;
}

int retex_edit_complete_lights(RetexEdit *edit, const RetexEdit *from, RetexError *err)
{
    RetexEdit next = *edit;
    int code = RETEX_OK;
    for (int kind = 0; kind < RETEX_EDIT_KEYED && !code; kind++)
        code = retex_keyed_complete(&next.keyed[kind], retex_edit_keyed[kind], &from->keyed[kind], err);
    if (!code)
        *edit = next;
    return code;
}

int retex_edit_bind_lamps(RetexEdit *edit, const RetexSet *set, RetexError *err)
{
    RetexEdit next = *edit;
    int code = RETEX_OK;
    for (int kind = 0; kind < RETEX_EDIT_KEYED && !code; kind++)
        code = retex_keyed_bind(&next.keyed[kind], retex_edit_keyed[kind], set, err);
    if (!code)
        *edit = next;
    return code;
}
