/* Names of parts and channels, and of targets: retex/target_name.h. */
#include "base/part_name.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <retex/target_name.h>
#include <retex/set.h>

int retex_name_is_valid(const char *name)
{
    const size_t length = strlen(name);

    return length > 0 && length < RETEX_NAME_MAX &&
           strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == length;
}

int retex_letters_are_valid(const char *letters)
{
    const size_t length = strlen(letters);

    if (length == 0 || length >= sizeof((RetexPart *)0)->letters)
        return 0;
    for (const char *letter = letters; *letter; letter++)
        if (*letter < 'A' || *letter > 'Z' || strchr(letter + 1, *letter))
            return 0;
    return 1;
}

/* ---- names of targets ---- */

/* Bytes of the UTF-8 character at the start of the text; 0: it is none. */
static int character_length(const unsigned char *text)
{
    const unsigned char first = text[0];
    const int length = first < 0x80 ? 1 : first >= 0xc2 && first < 0xe0 ? 2 : first >= 0xe0 && first < 0xf0 ? 3 : 4;

    if (length == 4 && !(first >= 0xf0 && first < 0xf5))
        return 0;
    for (int k = 1; k < length; k++)
        if ((text[k] & 0xc0) != 0x80)
            return 0;
    if ((first == 0xe0 && text[1] < 0xa0) || (first == 0xed && text[1] > 0x9f) || (first == 0xf0 && text[1] < 0x90) ||
        (first == 0xf4 && text[1] > 0x8f)) /* longer than it must be, half of a pair, beyond Unicode */
        return 0;
    return first == 0xc2 && text[1] < 0xa0 ? 0 : length; /* control characters */
}

int retex_target_name_is_valid(const char *name)
{
    static const char *const allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 _-.+()";
    const size_t length = strlen(name);

    if (length == 0 || length >= RETEX_NAME_MAX || strchr(" .", name[0]) || name[length - 1] == ' ')
        return 0;
    for (size_t i = 0; i < length;) {
        const int bytes = character_length((const unsigned char *)name + i);
        if (bytes == 0 || (bytes == 1 && !strchr(allowed, name[i])))
            return 0;
        i += (size_t)bytes;
    }
    return 1;
}

/* FNV-1a. */
static uint32_t checksum(const char *name)
{
    uint32_t sum = 0x811c9dc5u;

    for (; *name; name++)
        sum = (sum ^ (unsigned char)*name) * 0x01000193u;
    return sum;
}

void retex_target_word(char word[RETEX_NAME_MAX], const char *name)
{
    enum { KEPT = 64 };
    char kept[KEPT + 1];

    if (retex_name_is_valid(name)) {
        memcpy(word, name, strlen(name) + 1);
        return;
    }
    snprintf(kept, sizeof kept, "%s", name);
    for (char *letter = kept; *letter; letter++)
        if (!retex_name_is_valid((char[]){*letter, 0}))
            *letter = '_';
    snprintf(word, RETEX_NAME_MAX, "%s_%08x", kept, (unsigned)checksum(name));
}

void retex_lamp_word(char word[RETEX_NAME_MAX], const char *lamp, const char *target)
{
    enum { KEPT = 64, LONGEST = 90 };
    char names[2 * RETEX_NAME_MAX], plain[sizeof names + 8];

    snprintf(names, sizeof names, "%s%s%s", lamp, target ? "/" : "", target ? target : "");
    snprintf(plain, sizeof plain, "lamp_%s%s%s", lamp, target ? "_" : "", target ? target : "");
    if (strlen(plain) <= LONGEST && retex_name_is_valid(plain) && !(target && strchr(names, '_'))) {
        snprintf(word, RETEX_NAME_MAX, "%.*s", LONGEST, plain);
        return;
    }
    plain[KEPT] = 0;
    for (char *letter = plain; *letter; letter++)
        if (!retex_name_is_valid((char[]){*letter, 0}))
            *letter = '_';
    snprintf(word, RETEX_NAME_MAX, "%.*s_%08x", KEPT, plain, (unsigned)checksum(names));
}

int retex_target_index(const RetexTargetNames *names, const char *name)
{
    int found = -1, count = 0, of_ident = 0;

    for (int i = 0; i < names->count; i++) {
        if (strcmp(names->names[i], name) == 0)
            return i;
        if (strcasecmp(names->names[i], name) == 0) {
            found = i;
            count++;
        }
    }
    for (int i = 0; !count && i < names->count; i++)
        if (strcmp(names->idents[i], name) == 0) {
            found = i;
            of_ident++;
        }
    return count + of_ident == 1 ? found : -1;
}
