/* See address.h. */
#include "serve/clients/address.h"

#include <arpa/inet.h>
#include <ctype.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <string.h>

static const unsigned char of_ipv4[12] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

static int is_ipv4(const Address *address)
{
    return memcmp(address->bytes, of_ipv4, sizeof of_ipv4) == 0;
}

static void set_ipv4(Address *address, const struct in_addr *four)
{
    memcpy(address->bytes, of_ipv4, sizeof of_ipv4);
    memcpy(address->bytes + sizeof of_ipv4, four, sizeof *four);
}

int address_of_socket(Address *address, const struct sockaddr *socket)
{
    if (socket && socket->sa_family == AF_INET) {
        set_ipv4(address, &((const struct sockaddr_in *)(const void *)socket)->sin_addr);
        return 0;
    }
    if (socket && socket->sa_family == AF_INET6) {
        memcpy(address->bytes, &((const struct sockaddr_in6 *)(const void *)socket)->sin6_addr, sizeof address->bytes);
        return 0;
    }
    return -1;
}

int address_parse(Address *address, const char *text)
{
    struct in_addr four;
    if (inet_pton(AF_INET, text, &four) == 1) {
        set_ipv4(address, &four);
        return 0;
    }
    return inet_pton(AF_INET6, text, address->bytes) == 1 ? 0 : -1;
}

const char *address_text(const Address *address, char text[ADDRESS_TEXT])
{
    const char *done = is_ipv4(address)
                           ? inet_ntop(AF_INET, address->bytes + sizeof of_ipv4, text, ADDRESS_TEXT)
                           : inet_ntop(AF_INET6, address->bytes, text, ADDRESS_TEXT);
    return done ? done : "";
}

int address_is_same(const Address *a, const Address *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

Address address_of_client(const Address *address)
{
    Address client = *address;
    if (!is_ipv4(address))
        memset(client.bytes + 8, 0, 8);
    return client;
}

/* ---- trusted proxies ---- */

int trusted_add(Trusted *trusted, const char *text)
{
    char copy[ADDRESS_TEXT + 5], *end = NULL;
    Address address;
    if (trusted->count == TRUSTED_MAX || strlen(text) >= sizeof copy)
        return -1;
    strcpy(copy, text);
    char *slash = strchr(copy, '/');
    if (slash)
        *slash++ = '\0';
    if (address_parse(&address, copy))
        return -1;
    const int offset = is_ipv4(&address) ? 96 : 0;
    const long bits = slash ? strtol(slash, &end, 10) : 128 - offset;
    if (slash && (!isdigit((unsigned char)*slash) || *end || bits > 128 - offset))
        return -1;
    trusted->networks[trusted->count].address = address;
    trusted->networks[trusted->count++].bits = offset + (int)bits;
    return 0;
}

int trusted_has(const Trusted *trusted, const Address *address)
{
    for (int i = 0; i < trusted->count; i++) {
        const unsigned char *a = trusted->networks[i].address.bytes, *b = address->bytes;
        const int bits = trusted->networks[i].bits, whole = bits / 8, rest = bits % 8;
        if (memcmp(a, b, (size_t)whole) == 0 && (!rest || (a[whole] ^ b[whole]) >> (8 - rest) == 0))
            return 1;
    }
    return 0;
}

/* One of a list, which may have a port: 192.0.2.1:80, [2001:db8::1]:80. */
static int parse_forwarded(Address *address, const char *text, size_t length)
{
    char copy[ADDRESS_TEXT + 8];
    if (length >= sizeof copy)
        return -1;
    memcpy(copy, text, length);
    copy[length] = '\0';
    char *begin = copy, *colon = strchr(copy, ':');
    if (*copy == '[') {
        begin++;
        copy[strcspn(copy, "]")] = '\0';
    } else if (colon && !strchr(colon + 1, ':')) {
        *colon = '\0';
    }
    return address_parse(address, begin);
}

int trusted_client(const Trusted *trusted, const char *list, Address *client)
{
    for (const char *end = list ? list + strlen(list) : NULL; end;) {
        const char *begin = end, *last = end;
        while (begin > list && begin[-1] != ',')
            begin--;
        end = begin > list ? begin - 1 : NULL;
        begin += strspn(begin, " \t");
        while (last > begin && (last[-1] == ' ' || last[-1] == '\t'))
            last--;
        if (parse_forwarded(client, begin, last > begin ? (size_t)(last - begin) : 0)) {
            *client = (Address){{0}};
            return 0;
        }
        if (!trusted_has(trusted, client))
            return 0;
    }
    return -1;
}
