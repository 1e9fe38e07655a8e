/* See name.h. */
#include "serve/request/name.h"

#include <string.h>

#include "common/json_text.h"

int serve_name_is_valid(const char *text)
{
    size_t length = strlen(text);
    if (length < 1 || length > SERVE_NAME_MAX || text[0] == '.')
        return 0;
    for (int bytes; *text; text += bytes) {
        bytes = utf8_length(text);
        int is_word =
            (*text >= '0' && *text <= '9') || (*text >= 'A' && *text <= 'Z') || (*text >= 'a' && *text <= 'z');
        if (bytes == 0 || (bytes == 1 && !is_word && !strchr(" _-.,+()", *text)))
            return 0;
    }
    return 1;
}
