/* See gate.h. */
#include "gate.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>

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

/* ---- connections without the token ---- */

void strangers_open(Strangers *strangers)
{
    *strangers = (Strangers){0};
    pthread_mutex_init(&strangers->lock, NULL);
}

void strangers_close(Strangers *strangers)
{
    pthread_mutex_destroy(&strangers->lock);
}

static void remove_at(Strangers *strangers, int at)
{
    strangers->count--;
    memmove(strangers->sockets + at, strangers->sockets + at + 1,
            (size_t)(strangers->count - at) * sizeof *strangers->sockets);
}

void strangers_add(Strangers *strangers, int socket)
{
    pthread_mutex_lock(&strangers->lock);
    if (strangers->count == STRANGERS_MOST) {
        shutdown(strangers->sockets[0], SHUT_RDWR); /* whoever waits for it finds its end, and closes it */
        remove_at(strangers, 0);
    }
    strangers->sockets[strangers->count++] = socket;
    pthread_mutex_unlock(&strangers->lock);
}

void strangers_remove(Strangers *strangers, int socket)
{
    pthread_mutex_lock(&strangers->lock);
    for (int i = strangers->count - 1; i >= 0; i--)
        if (strangers->sockets[i] == socket)
            remove_at(strangers, i);
    pthread_mutex_unlock(&strangers->lock);
}
