/* See view_source.h. */
#include "retexture/view_source.h"

#include <stdlib.h>

typedef struct ViewSource {
    RetexSetSource methods; /* first */
    const RetexView *view;
} ViewSource;

static void source_close(RetexSetSource *source)
{
    free(source);
}

static int reader_open(RetexSetSource *source, void **result, RetexError *err)
{
    RetexViewReader *reader = *result = malloc(sizeof *reader);
    if (!reader)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for rows of a set");
    const int code = retex_view_reader_open(reader, ((ViewSource *)(void *)source)->view, err);
    if (code)
        free(reader);
    return code;
}

static void reader_close(void *reader)
{
    retex_view_reader_close(reader);
    free(reader);
}

static int read_row(void *reader, int image, int y, const float **row, RetexRowSpan *span, RetexError *err)
{
    return retex_view_row(reader, image, y, row, span, err);
}

int retex_view_source_open(RetexSetSource **result, const RetexView *view, RetexError *err)
{
    static const RetexSetSource methods = {source_close, reader_open, reader_close, read_row, NULL, 1};
    ViewSource *source = malloc(sizeof *source);
    *result = NULL;
    if (!source)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for rows of a set");
    *source = (ViewSource){methods, view};
    *result = &source->methods;
    return RETEX_OK;
}
