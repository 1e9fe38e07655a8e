/* The canonical text of edits. See retex/edit.h. */
#include <retex/edit.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/params.h"
#include "edit/edit.h"
#include "edit/statement.h"

/* What is divided by `;` and `&`, with these encoded, and the point at `dot`, if there is one. */
static void write_encoded(FILE *file, const char *text, const char *dot)
{
    for (; *text; text++)
        if (strchr("%&;", *text) || text == dot)
            fprintf(file, "%%%02X", (unsigned)*text);
        else
            fputc(*text, file);
}

/* TARGET or TARGET.OPTION, and `=`. A point in the target's name that would begin an option is encoded. */
static void write_key(FILE *file, const char *target, const char *option)
{
    const char *dot = retex_edit_key_is_option(target) && !*option ? strrchr(target, '.') : NULL;
    write_encoded(file, target, dot);
    fprintf(file, "%s%s=", *option ? "." : "", option);
}

/* divider: before it, or 0. */
static void write_keyed(FILE *file, const RetexKeyedKind *kind, const RetexKeyed *statement, int divider)
{
    char value[RETEX_KEYED_TEXT_MAX];
    kind->write(statement, value);
    if (divider)
        fputc(divider, file);
    fprintf(file, "%s:", kind->word);
    write_encoded(file, statement->name, NULL);
    fputc('=', file);
    write_encoded(file, value, NULL);
}

/* The caller's `file` is closed. */
static int close_text(FILE *file, char **text, RetexError *err)
{
    const int failed = !file || ferror(file);
    if ((file && fclose(file) != 0) || failed) {
        free(*text);
        *text = NULL;
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for the text of an edit");
    }
    return RETEX_OK;
}

/* The statements of a texture, or of a layer of it, each after the divider but the first of all. */
static void write_texture(FILE *file, const RetexTextureSpec *spec, int layer, int divider, int *written)
{
    char value[STATEMENT_TEXT_MAX], prefix[16] = "";
    if (layer)
        snprintf(prefix, sizeof prefix, layer > 1 ? "over%d:" : "over:", layer);
    for (int k = 0; k < RETEX_STATEMENTS; k++) {
        const int kind = retex_statement_ordered(spec, k);
        if (kind < 0 || (layer && retex_statement_is_wrap(kind)) || !retex_statement_write(spec, kind, value))
            continue;
        if ((*written)++)
            fputc(divider, file);
        fputs(prefix, file);
        write_key(file, spec->target, retex_statement_word(kind));
        write_encoded(file, value, NULL);
    }
}

int retex_edit_text(const RetexEdit *edit, int divider, char **text, RetexError *err)
{
    int written = 0;
    size_t size;
    *text = NULL;
    FILE *file = open_memstream(text, &size);
    for (int i = 0; i < edit->count && file; i++) {
        write_texture(file, &edit->specs[i], 0, divider, &written);
        for (int k = 0; k < edit->specs[i].nlayers; k++) {
            RetexTextureSpec layer = RETEX_TEXTURE_SPEC_INIT;
            retex_texture_layer_get(&layer, &edit->specs[i], k);
            write_texture(file, &layer, 1 + k, divider, &written);
        }
    }
    for (int kind = 0; kind < RETEX_EDIT_KEYED && file; kind++)
        for (int i = 0; i < edit->keyed[kind].count; i++, written++)
            write_keyed(file, retex_edit_keyed[kind], &edit->keyed[kind].of[i], written ? divider : 0);
    return close_text(file, text, err);
}

int retex_edit_options_text(const RetexTextureSpec *given, char **text, RetexError *err)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    char value[STATEMENT_TEXT_MAX];
    size_t size;
    *text = NULL;
    if (RETEX_PARAMS_COPY(&spec, given, err))
        return RETEX_EINVAL;
    FILE *file = open_memstream(text, &size);
    for (int k = 1, written = 0; k < RETEX_STATEMENTS && file; k++) {
        const int kind = retex_statement_ordered(&spec, k);
        if (kind >= 0 && retex_statement_write(&spec, kind, value))
            fprintf(file, "%s%s=%s", written++ ? ":" : "", retex_statement_word(kind), value);
    }
    return close_text(file, text, err);
}

void retex_edit_image_text(const RetexTextureSpec *given, char *text, size_t size)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    char value[STATEMENT_TEXT_MAX];
    (void)RETEX_PARAMS_COPY(&spec, given, NULL);
    const int is_original = !retex_statement_write(&spec, 0, value);
    size_t used = (size_t)snprintf(text, size, "%s", is_original ? "" : value);
    for (int k = 0; k < spec.nlayers && used < size; k++)
        used += (size_t)snprintf(text + used, size - used, "%s+ %s", used ? " " : "", spec.layers[k].image);
}
