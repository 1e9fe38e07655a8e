/* See keys.h. */
#include "serve/clients/keys.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include <nettle/base16.h>
#include <nettle/base64.h>
#include <nettle/hmac.h>
#include <nettle/memops.h>

/* ---- the file ---- */

enum { FILE_BYTES = 16 << 10 };

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static int add_key(Keys *keys, const char *digits, size_t length)
{
    struct base16_decode_ctx decoder;
    size_t bytes = KEY_BYTES_MAX;
    if (length < 2 * KEY_BYTES_MIN || length > 2 * KEY_BYTES_MAX)
        return -1;
    for (size_t i = 0; i < length; i++)
        if (!isxdigit((unsigned char)digits[i]))
            return -1;
    base16_decode_init(&decoder);
    if (!base16_decode_update(&decoder, &bytes, keys->keys[keys->count].bytes, length, digits) ||
        !base16_decode_final(&decoder)) /* an odd number of digits */
        return -1;
    keys->keys[keys->count++].count = bytes;
    return 0;
}

/* What a line holds is in no message: it may be a secret that is only written wrongly. */
static int add_lines(Keys *keys, const char *text, size_t bytes, const char *name, RetexError *err)
{
    int number = 1;
    for (const char *line = text, *last = text + bytes, *next; line < last; line = next, number++) {
        const char *end = memchr(line, '\n', (size_t)(last - line));
        end = end ? end : last;
        next = end + 1;
        while (line < end && is_blank(*line))
            line++;
        while (end > line && is_blank(end[-1]))
            end--;
        if (line == end || *line == '#')
            continue;
        if (keys->count == KEYS_MAX)
            return retex_fail_at(err, RETEX_EPARSE, name, number, 0, "at most %d keys are taken", KEYS_MAX);
        if (add_key(keys, line, (size_t)(end - line)))
            return retex_fail_at(err, RETEX_EPARSE, name, number, 0,
                                 "expected a key of %d to %d hexadecimal digits, an even number, and nothing else",
                                 2 * KEY_BYTES_MIN, 2 * KEY_BYTES_MAX);
    }
    return keys->count ? RETEX_OK : retex_fail(err, RETEX_EPARSE, "there is no key in %s", name);
}

static int read_file(Keys *keys, FILE *file, const char *name, RetexError *err)
{
    char text[FILE_BYTES];
    struct stat info;
    if (fstat(fileno(file), &info) == 0 && info.st_mode & S_IRWXO)
        return retex_fail(err, RETEX_EACCESS, "everybody may use the keys in %s; `chmod o= %s` helps", name, name);
    const size_t bytes = fread(text, 1, sizeof text, file);
    if (ferror(file))
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", name, strerror(errno));
    return bytes < sizeof text ? add_lines(keys, text, bytes, name, err)
                               : retex_fail(err, RETEX_ELIMIT, "%s is too large for a file of keys", name);
}

int keys_read(Keys *keys, const char *name, RetexError *err)
{
    FILE *file = fopen(name, "re");
    keys->count = 0;
    if (!file)
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", name, strerror(errno));
    const int code = read_file(keys, file, name, err);
    fclose(file);
    return code;
}

/* ---- signatures ---- */

static void sign(const Keys *keys, int number, const char *path, size_t length, char text[SIGNATURE_LENGTH + 1])
{
    struct hmac_sha256_ctx hmac;
    struct base64_encode_ctx encoder;
    uint8_t digest[SHA256_DIGEST_SIZE];
    char padded[BASE64_ENCODE_LENGTH(SHA256_DIGEST_SIZE) + BASE64_ENCODE_FINAL_LENGTH];
    hmac_sha256_set_key(&hmac, keys->keys[number].count, keys->keys[number].bytes);
    hmac_sha256_update(&hmac, length, (const uint8_t *)path);
    hmac_sha256_digest(&hmac, sizeof digest, digest);
    base64url_encode_init(&encoder);
    const size_t begun = base64_encode_update(&encoder, padded, sizeof digest, digest);
    base64_encode_final(&encoder, padded + begun);
    memcpy(text, padded, SIGNATURE_LENGTH);
    text[SIGNATURE_LENGTH] = '\0';
}

/* How much of a path and query is signed. */
static size_t signed_length(const char *path)
{
    static const char iiif[] = "/iiif/3/";
    const size_t prefix = sizeof iiif - 1;
    return strncmp(path, iiif, prefix) == 0 ? prefix + strcspn(path + prefix, "/?") : strlen(path);
}

const char *keys_sign(const Keys *keys, const char *path, char text[SIGNATURE_LENGTH + 1])
{
    sign(keys, 0, path, signed_length(path), text);
    return text;
}

const char *keys_check(const Keys *keys, const char *url)
{
    char right[SIGNATURE_LENGTH + 1];
    int is_right = 0;
    if (!keys->count)
        return url;
    if (url[0] != '/' || strlen(url) < 1 + SIGNATURE_LENGTH || url[1 + SIGNATURE_LENGTH] != '/')
        return NULL;
    const char *given = url + 1, *path = given + SIGNATURE_LENGTH;
    for (int i = 0; i < keys->count; i++) {
        sign(keys, i, path, signed_length(path), right);
        is_right |= memeql_sec(given, right, SIGNATURE_LENGTH);
    }
    return is_right ? path : NULL;
}

/* ---- logs ---- */

/* Put a star in place of each word that is so long; signatures may be spelled by escapes. */
static void hide_words(char *text, size_t least)
{
    char *to = text;
    for (const char *at = text; *at;) {
        size_t length = 0;
        while (isalnum((unsigned char)at[length]) || (at[length] && strchr("-_%+=", at[length])))
            length++;
        if (length >= least) {
            *to++ = '*';
        } else {
            length += length == 0;
            memmove(to, at, length);
            to += length;
        }
        at += length;
    }
    *to = '\0';
}

const char *keys_hide(char *url)
{
    static const char *const begins[] = {"/v1", "/iiif/", "/metrics", "/health"};
    enum { PART = 12 }; /* of a signature, cut by what does not belong into one */
    char *path = NULL;
    for (size_t i = 0; i < sizeof begins / sizeof *begins; i++) {
        char *found = strstr(url, begins[i]);
        path = found && (!path || found < path) ? found : path;
    }
    hide_words(path ? path : url, path ? SIGNATURE_LENGTH : PART);
    return path ? path : url;
}
