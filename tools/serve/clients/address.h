/* Addresses of clients, and of the proxies that are trusted to tell them. */
#ifndef RETEX_SERVE_ADDRESS_H
#define RETEX_SERVE_ADDRESS_H

#include <sys/socket.h>

enum { ADDRESS_TEXT = 46 };

/* Of IPv6; that of IPv4 is ::ffff:a.b.c.d. */
typedef struct Address {
    unsigned char bytes[16];
} Address;

/* 0, or -1 for one of another kind. */
int address_of_socket(Address *address, const struct sockaddr *socket);
/* Of text, such as 192.0.2.1 or 2001:db8::1: 0, or -1. */
int address_parse(Address *address, const char *text);
const char *address_text(const Address *address, char text[ADDRESS_TEXT]);
int address_is_same(const Address *a, const Address *b);
/* What one client has: an address of IPv4, but 64 bits of IPv6, in which a machine chooses the rest itself. */
Address address_of_client(const Address *address);

enum { TRUSTED_MAX = 16 };

/* Networks whose proxies are trusted. Zero-initialized: none. */
typedef struct Trusted {
    struct {
        Address address;
        int bits;
    } networks[TRUSTED_MAX];
    int count;
} Trusted;

/* Add ADDRESS or ADDRESS/BITS: 0, or -1 if it is none, or one too many. */
int trusted_add(Trusted *trusted, const char *text);
int trusted_has(const Trusted *trusted, const Address *address);
/* The client by a list of X-Forwarded-For, to which each proxy adds who has asked it: the last one that is no trusted
 * proxy itself; where no address stands there, one that is ::, the same for all. -1 if there is none, so that a proxy
 * has asked for itself. */
int trusted_client(const Trusted *trusted, const char *list, Address *client);

#endif
