/* Names of parts and channels. */
#include "base/part_name.h"

#include <string.h>

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
