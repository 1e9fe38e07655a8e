/* #fopen, #fclose, #read and #write. Files that the scene writes are kept in memory, where #read, #include and
 * file_exists find them; the disk is never written. #read parses a list of numbers, vectors and strings, separated
 * by commas. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "sdl/lang/internal.h"

static FileHandle *handle_argument(Sdl *sdl, Symbol **symbol)
{
    const Raw *raw = sdl_raw(sdl);
    *symbol = raw->kind == RAW_WORD ? raw->as.word->symbol : NULL;
    if (!*symbol || !(*symbol)->handle)
        sdl_error(sdl, "expected the name of an open file%s%s", raw->kind == RAW_WORD ? ", not " : "",
                  raw->kind == RAW_WORD ? raw->as.word->text : "");
    return (*symbol)->handle;
}

void file_open(Sdl *sdl)
{
    const Raw *raw = sdl_raw(sdl);
    if (raw->kind != RAW_WORD || raw->as.word->reserved)
        sdl_error(sdl, "expected a name for the file");
    Word *word = raw->as.word;
    const char *name = sdl_string(sdl);
    if (word->symbol && !word->symbol->handle)
        sdl_error(sdl, "`%s` is declared already", word->text);
    FileHandle *handle = sdl_alloc(sdl, sizeof *handle);
    const Raw *mode = sdl_raw(sdl);
    const char *text = mode->kind == RAW_WORD ? mode->as.word->text : "";
    if (strcmp(text, "read") == 0) {
        handle->input = source_open(sdl, name);
        handle->input->users++;
    } else if (strcmp(text, "write") == 0 || strcmp(text, "append") == 0) {
        handle->output = memory_file_create(sdl, name);
        if (*text == 'w')
            handle->output->size = 0;
    } else
        sdl_error(sdl, "expected read, write or append");
    if (!word->symbol)
        symbol_add(sdl, word, 0);
    else if (word->symbol->handle) {
        if (word->symbol->handle->input)
            source_release(sdl, word->symbol->handle->input);
        word->symbol->handle->input = NULL;
    }
    word->symbol->handle = handle;
}

static void close_handle(Sdl *sdl, Symbol *symbol)
{
    if (symbol->handle->input)
        source_release(sdl, symbol->handle->input);
    symbol->handle->input = NULL;
    symbol->handle = NULL;
    symbol_remove(sdl, symbol);
}

void file_close(Sdl *sdl)
{
    /* #fclose of a file that #read has read to its end is allowed: #read has closed the file. */
    const Raw *raw = sdl_raw(sdl);
    if (raw->kind != RAW_WORD)
        sdl_error(sdl, "expected the name of an open file");
    Symbol *symbol = raw->as.word->symbol;
    if (symbol && symbol->handle)
        close_handle(sdl, symbol);
}

/* Parse one number of a file, with its sign. */
static double read_number(Sdl *sdl, FileHandle *handle)
{
    const Raw *tokens = handle->input->tokens;
    double sign = 1;
    while (tokens[handle->pos].kind == RAW_PUNCT && strchr("+-", tokens[handle->pos].punct))
        if (tokens[handle->pos++].punct == '-')
            sign = -sign;
    if (tokens[handle->pos].kind != RAW_NUMBER)
        sdl_error(sdl, "%s:%u: expected a number to #read", handle->input->name, (unsigned)tokens[handle->pos].line);
    return sign * tokens[handle->pos++].as.number;
}

static int next_is(const FileHandle *handle, char punct)
{
    const Raw *raw = &handle->input->tokens[handle->pos];
    return raw->kind == RAW_PUNCT && raw->punct == punct;
}

static Value read_value(Sdl *sdl, FileHandle *handle)
{
    const Raw *raw = &handle->input->tokens[handle->pos];
    Value value = {.kind = VALUE_NONE};
    if (raw->kind == RAW_STRING) {
        handle->pos++;
        value = (Value){.kind = VALUE_STRING, .string = raw->as.string};
    } else if (next_is(handle, '<')) {
        Num vector = {{0}, 0, 0};
        handle->pos++;
        while (!next_is(handle, '>')) {
            if (vector.count == 5)
                sdl_error(sdl, "%s:%u: a vector too long", handle->input->name, (unsigned)raw->line);
            vector.n[vector.count++] = read_number(sdl, handle);
            handle->pos += (uint32_t)next_is(handle, ',');
        }
        handle->pos++;
        if (vector.count < 2)
            sdl_error(sdl, "%s:%u: a vector too short", handle->input->name, (unsigned)raw->line);
        value = value_from_num(vector);
    } else
        value = value_from_num(num_float(read_number(sdl, handle)));
    handle->pos += (uint32_t)next_is(handle, ',');
    return value;
}

/* #read (FILE, NAME, …). FILE is undefined once the end of the file is reached, so that `#while(defined(FILE))`
 * ends. */
void file_read(Sdl *sdl)
{
    sdl_raw_expect(sdl, '(');
    Symbol *symbol;
    FileHandle *handle = handle_argument(sdl, &symbol);
    if (!handle->input)
        sdl_error(sdl, "`%s` was not opened to read", symbol->word->text);
    while (sdl_raw_accept(sdl, ',')) {
        const Raw *raw = sdl_raw(sdl);
        if (raw->kind != RAW_WORD || raw->as.word->reserved)
            sdl_error(sdl, "expected the name of a variable to #read");
        Word *word = raw->as.word;
        if (word->symbol && (word->symbol->macro || word->symbol->handle))
            sdl_error(sdl, "`%s` cannot be read into", word->text);
        if (!word->symbol)
            symbol_add(sdl, word, 0);
        Value *target = word->symbol->value;
        if (target->kind == VALUE_ARRAY)
            target = array_element(sdl, target);
        if (!handle->input)
            sdl_error(sdl, "the file was closed while it was read");
        int at_end = handle->input->tokens[handle->pos].kind == RAW_END;
        Value value = at_end ? (Value){.kind = VALUE_FLOAT, .count = 1} : read_value(sdl, handle);
        *target = value;
    }
    sdl_raw_expect(sdl, ')');
    if (handle->input && handle->input->tokens[handle->pos].kind == RAW_END)
        close_handle(sdl, symbol);
}

/* Format keyword of integers for df3 files and similar: `uint16be <1,2,3>`. Returns the bytes per integer, or 0 if
 * the token is no format keyword. */
static int integer_format(const Token *token, int *little)
{
    if (token->kind != TOKEN_WORD)
        return 0;
    const char *text = token->text + (*token->text == 'u' || *token->text == 's');
    if (strncmp(text, "int", 3) != 0)
        return 0;
    *little = strstr(text, "le") != NULL;
    return text[3] == '8' ? 1 : text[3] == '1' ? 2 : text[3] == '3' ? 4 : 0;
}

static void write_integers(Sdl *sdl, MemoryFile *file, int bytes, int little)
{
    Num num = expression_sum(sdl);
    for (int i = 0; i < num.count; i++) {
        uint32_t bits = fabs(num.n[i]) < 9e15 ? (uint32_t)(int64_t)num.n[i] : 0;
        for (int b = 0; b < bytes; b++) {
            unsigned char byte = (unsigned char)(bits >> 8 * (little ? b : bytes - 1 - b));
            memory_file_write(sdl, file, &byte, 1);
        }
    }
}

static void write_number(Sdl *sdl, MemoryFile *file)
{
    Num num = expression_sum(sdl);
    char text[5 * 32];
    size_t length = 0;
    if (num.count > 1)
        text[length++] = '<';
    for (int i = 0; i < num.count; i++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%g", i ? "," : "", num.n[i]);
    if (num.count > 1)
        length += (size_t)snprintf(text + length, sizeof text - length, "> ");
    memory_file_write(sdl, file, text, length);
}

void file_write(Sdl *sdl)
{
    sdl_raw_expect(sdl, '(');
    Symbol *symbol;
    FileHandle *handle = handle_argument(sdl, &symbol);
    if (!handle->output)
        sdl_error(sdl, "`%s` was not opened to write", symbol->word->text);
    sdl_optional_comma(sdl);
    while (!sdl_accept(sdl, ")")) {
        int little = 0, bytes = integer_format(sdl_peek(sdl), &little);
        if (bytes) {
            sdl_next(sdl);
            write_integers(sdl, handle->output, bytes, little);
        } else if (expression_is_string_start(sdl)) {
            const char *text = sdl_string(sdl);
            memory_file_write(sdl, handle->output, text, strlen(text));
        } else
            write_number(sdl, handle->output);
        sdl_optional_comma(sdl);
    }
}
