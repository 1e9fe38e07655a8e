/* See json_text.h. */
#include "common/json_text.h"

int utf8_length(const char *characters)
{
    const unsigned char *text = (const unsigned char *)characters;
    const unsigned first = text[0];
    const int length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    for (int i = 1; i < length; i++)
        if ((text[i] & 0xc0) != 0x80)
            return 0;
    if ((first == 0xe0 && text[1] < 0xa0) || (first == 0xed && text[1] > 0x9f) || (first == 0xf0 && text[1] < 0x90) ||
        (first == 0xf4 && text[1] > 0x8f))
        return 0;
    return length;
}

void utf8_trim(char *text)
{
    for (int length; (length = utf8_length(text)) > 0 && *text; text += length)
        ;
    *text = '\0';
}

void json_text(FILE *file, const char *text)
{
    putc('"', file);
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        const int length = utf8_length((const char *)c);
        if (*c == '"' || *c == '\\')
            fprintf(file, "\\%c", *c);
        else if (*c < 32)
            fprintf(file, "\\u%04x", *c);
        else if (length)
            fwrite(c, 1, (size_t)length, file);
        else
            fputs("\\ufffd", file);
        c += length ? length : 1;
    }
    putc('"', file);
}
