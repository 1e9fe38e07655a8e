/* See gate.h. */
#include "gate.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>

int gate_open(Gate *gate, RetexError *err)
{
    unsigned char bytes[GATE_TOKEN / 2];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return retex_fail(err, RETEX_EIO, "no random numbers: %s", strerror(errno));
    for (size_t i = 0; i < sizeof bytes; i++)
        snprintf(gate->token + 2 * i, 3, "%02x", bytes[i]);
    return RETEX_OK;
}

/* Whether text is `before` and an address of this server. */
static int is_here(const Gate *gate, const char *before, const char *text)
{
    static const char *const names[] = {"127.0.0.1", "localhost"};
    for (int i = 0; i < 2; i++) {
        char address[64];
        snprintf(address, sizeof address, "%s%s:%d", before, names[i], gate->port);
        if (strcmp(text, address) == 0)
            return 1;
    }
    return 0;
}

/* Takes the same time wherever they differ. */
static int is_token(const Gate *gate, const char *text)
{
    int different = 0;
    if (strnlen(text, GATE_TOKEN) < GATE_TOKEN)
        return 0;
    for (int i = 0; i < GATE_TOKEN; i++)
        different |= text[i] ^ gate->token[i];
    return !different;
}

const char *gate_enter(const Gate *gate, const char *url, const char *host, const char *origin, const char **why)
{
    if (!host || !is_here(gate, "", host))
        *why = "this server has another name";
    else if (origin && !is_here(gate, "http://", origin))
        *why = "pages of other sites are refused";
    else if (url[0] != '/' || !is_token(gate, url + 1) || url[1 + GATE_TOKEN] != '/')
        *why = "the address has no token, or an old one: open the address that retex-studio has printed";
    else
        return url + GATE_TOKEN + 2;
    return NULL;
}
