/* Arrays: up to five dimensions, elements of any type, one block of memory per array. */
#include <stdio.h>
#include <string.h>
#include "sdl/lang/internal.h"

static void initialise(Sdl *sdl, Array *array, int dimension, size_t *offset)
{
    size_t below = 1;
    for (int d = dimension + 1; d < array->dimensions; d++)
        below *= (size_t)array->size[d];
    sdl_expect(sdl, "{");
    for (int i = 0; i < array->size[dimension]; i++) {
        if (sdl_is(sdl, "}")) { /* an initializer list may have fewer elements than the array */
            *offset += below * (size_t)(array->size[dimension] - i);
            break;
        }
        if (dimension + 1 < array->dimensions)
            initialise(sdl, array, dimension + 1, offset);
        else {
            Value *item = &array->items[(*offset)++];
            const Token *token = sdl_peek(sdl);
            if (sdl_accept(sdl, "function"))
                function_declare(sdl, item);
            else if (sdl_accept(sdl, "spline"))
                spline_declare(sdl, item);
            else if (sdl_is_expression_start(sdl) || sdl_is_color_start(sdl))
                *item = sdl_expression(sdl);
            else if (token->kind == TOKEN_IDENT) {
                *item = *sdl_next(sdl)->value;
                if (item->kind == VALUE_ARRAY)
                    array_copy(sdl, item);
            } else if (!sdl->builder->declare(sdl, item))
                sdl_expected(sdl, "an array's element");
        }
        sdl_optional_comma(sdl);
    }
    sdl_expect(sdl, "}");
}

void array_declare(Sdl *sdl, Value *value)
{
    Array *array = sdl_alloc(sdl, sizeof *array);
    array->count = 1;
    while (sdl_accept(sdl, "[")) {
        double size = expression_parameter(sdl);
        sdl_expect(sdl, "]");
        if (array->dimensions == MAX_DIMENSIONS)
            sdl_error(sdl, "an array has at most %d dimensions", MAX_DIMENSIONS);
        if (!(size >= 1 && size < 1e9))
            sdl_error(sdl, "an array cannot have %g elements", size);
        array->size[array->dimensions++] = (int)(size + 1e-8);
        array->count *= (size_t)(size + 1e-8);
        if (array->count > (size_t)1 << 32)
            sdl_fail(sdl, RETEX_ELIMIT, "an array this large is too much");
        /* Only a bracket that is written directly here adds a dimension. The lookahead must not run a directive or
         * macro. */
        if (sdl->have || sdl->cursor->kind != RAW_PUNCT || sdl->cursor->punct != '[')
            break;
    }
    if (!array->dimensions)
        sdl_expected(sdl, "`[` and the array's size");
    array->items = sdl_alloc(sdl, array->count * sizeof *array->items);
    *value = (Value){.kind = VALUE_ARRAY, .data = array};
    size_t offset = 0;
    if (!sdl->have && sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == '{')
        initialise(sdl, array, 0, &offset);
}

/* Report an index out of range. Scenes of animations often index an array by the frame number, which is 0 unless it
 * is declared; `reads` tells whether the index depends on it (FrameRead bits). */
static _Noreturn void fail_index(Sdl *sdl, double index, int count, unsigned reads)
{
    char advice[128] = "";
    unsigned from = reads ? reads : index < 0 ? sdl->frame_reads : 0;
    const char *name = from & READ_FRAME_NUMBER ? "frame_number" : from ? "clock" : NULL;
    double value = from & READ_FRAME_NUMBER ? sdl->frame_number : sdl->clock;
    if (name)
        snprintf(advice, sizeof advice, "; `%s` is %g: -D %s=%d sets it", name, value, name,
                 value > 0 && !(from & READ_FRAME_NUMBER) ? 0 : 1);
    sdl_error(sdl, "index %g is outside of an array of %d elements%s", index, count, advice);
}

/* The element may have no value yet: it is the target of an assignment or the argument of defined(). */
Value *array_element(Sdl *sdl, Value *value)
{
    while (value->kind == VALUE_ARRAY && sdl->cursor->kind == RAW_PUNCT && sdl->cursor->punct == '[') {
        Array *array = value->data;
        size_t offset = 0;
        for (int d = 0; d < array->dimensions; d++) {
            sdl_expect(sdl, "[");
            unsigned before = sdl->frame_reads;
            sdl->frame_reads = 0;
            double index = expression_parameter(sdl);
            unsigned reads = sdl->frame_reads;
            sdl->frame_reads |= before;
            sdl_expect(sdl, "]");
            int i = index > -1 && index < 2e9 ? (int)(index + 1e-8) : -1;
            if (i < 0 || i >= array->size[d])
                fail_index(sdl, index, array->size[d], reads);
            offset = offset * (size_t)array->size[d] + (size_t)i;
        }
        value = &array->items[offset];
    }
    return value;
}

static void copy_items(Sdl *sdl, Value *value, int depth)
{
    if (depth > 32)
        sdl_fail(sdl, RETEX_ELIMIT, "arrays nested more than 32 deep");
    const Array *array = value->data;
    Array *copy = sdl_alloc(sdl, sizeof *copy);
    sdl_step(sdl, (long)(array->count / 8));
    *copy = *array;
    copy->items = sdl_alloc(sdl, array->count * sizeof *copy->items);
    memcpy(copy->items, array->items, array->count * sizeof *copy->items);
    for (size_t i = 0; i < copy->count; i++)
        if (copy->items[i].kind == VALUE_ARRAY)
            copy_items(sdl, &copy->items[i], depth + 1);
    value->data = copy;
}

void array_copy(Sdl *sdl, Value *value)
{
    copy_items(sdl, value, 0);
}
