/* See listen.h. */
#include "listen.h"

#include <errno.h>
#include <netdb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

int listen_on(const char *address, int port, int *bound_port, RetexError *err)
{
    struct addrinfo hints = {.ai_flags = AI_PASSIVE | AI_NUMERICSERV, .ai_socktype = SOCK_STREAM}, *found = NULL;
    char text[16];
    snprintf(text, sizeof text, "%d", port);
    const int unknown = getaddrinfo(address, text, &hints, &found);
    if (unknown) {
        retex_fail(err, RETEX_EINVAL, "--listen %s: %s", address, gai_strerror(unknown));
        return -1;
    }
    const int one = 1;
    int file = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    struct sockaddr_storage bound;
    socklen_t size = sizeof bound;
    if (file < 0 || setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one) != 0 ||
        bind(file, found->ai_addr, found->ai_addrlen) != 0 || listen(file, SOMAXCONN) != 0 ||
        getsockname(file, (struct sockaddr *)&bound, &size) != 0) {
        retex_fail(err, RETEX_EIO, "cannot listen on %s, port %d: %s", address, port, strerror(errno));
        if (file >= 0)
            close(file);
        file = -1;
    } else if (getnameinfo((struct sockaddr *)&bound, size, NULL, 0, text, sizeof text, NI_NUMERICSERV) == 0) {
        *bound_port = atoi(text);
    }
    freeaddrinfo(found);
    return file;
}
