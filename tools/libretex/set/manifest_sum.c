/* The manifest's checksum of itself: see manifest.h. It is computed from the text, not from its meaning, so that it is
 * compared before anything is parsed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/checksum.h"
#include "set/manifest.h"

enum { DIGITS = 8 };

/* The place of the checksum's digits, or NULL. */
static const char *find_digits(const char *json)
{
    static const char begin[] = "{\"retex\":", key[] = ",\"crc32\":\"";

    if (strncmp(json, begin, sizeof begin - 1) != 0)
        return NULL;
    const char *at = json + sizeof begin - 1;
    at += strspn(at, "0123456789");
    if (strncmp(at, key, sizeof key - 1) != 0)
        return NULL;
    at += sizeof key - 1;
    return strspn(at, "0123456789abcdef") == DIGITS && at[DIGITS] == '"' ? at : NULL;
}

static void print_sum(char digits[DIGITS + 1], const char *json, const char *place)
{
    uint32_t crc = retex_crc32(CRC32_OF_NONE, json, (size_t)(place - json));

    crc = retex_crc32(crc, "00000000", DIGITS);
    crc = retex_crc32(crc, place + DIGITS, strlen(place + DIGITS));
    snprintf(digits, DIGITS + 1, "%08x", (unsigned)crc);
}

RetexManifestSum retex_manifest_sum(const char *json)
{
    const char *place = find_digits(json);
    char digits[DIGITS + 1];

    if (!place)
        return RETEX_MANIFEST_UNSEALED;
    print_sum(digits, json, place);
    return memcmp(digits, place, DIGITS) == 0 ? RETEX_MANIFEST_RIGHT : RETEX_MANIFEST_WRONG;
}

uint32_t retex_manifest_own_sum(const char *json)
{
    const char *place = find_digits(json);

    return place ? (uint32_t)strtoul(place, NULL, 16) : 0;
}

void retex_manifest_seal(char *json)
{
    const char *place = find_digits(json);
    char digits[DIGITS + 1];

    if (!place)
        return;
    print_sum(digits, json, place);
    memcpy(json + (place - json), digits, DIGITS);
}
