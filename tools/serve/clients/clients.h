/* The connections of the server, and since when each is waited for: who sends a request, or takes an answer, byte by
 * byte is cut off. Any thread may call. */
#ifndef RETEX_SERVE_CLIENTS_H
#define RETEX_SERVE_CLIENTS_H

#include <stddef.h>

typedef struct Clients Clients;
typedef struct Client Client;

/* What the server waits for. */
typedef enum ClientState {
    CLIENT_SENDS,   /* a request, or its rest */
    CLIENT_UPLOADS, /* an image, which is large */
    CLIENT_WAITS,   /* nothing: the client waits for its answer */
    CLIENT_TAKES    /* that the answer is taken */
} ClientState;

Clients *clients_open(void); /* NULL: no memory */
void clients_close(Clients *clients);

Client *clients_add(Clients *clients, int socket); /* NULL: no memory */
void clients_remove(Clients *clients, Client *client);
void clients_set(Clients *clients, Client *client, ClientState state);

/* So many bytes of an image have come. */
void clients_received(Clients *clients, Client *client, size_t bytes);

/* Shut down the sockets of those that, at the time `now` of retex_clock_seconds, took longer than `seconds` to send a
 * request, or ten times as long to send an image or to take an answer, or that sent fewer than `rate` bytes of an image
 * a second over CLIENTS_RATE_SECONDS, or that have left. */
enum { CLIENTS_RATE_SECONDS = 10 };
void clients_sweep(Clients *clients, double now, double seconds, double rate);
int clients_count(Clients *clients);

#endif
