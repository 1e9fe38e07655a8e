/* See clients.h. */
#include "serve/clients/clients.h"

#include <pthread.h>
#include <stdlib.h>
#include <sys/socket.h>

#include <retex/clock.h>

enum { TAKES_LONGER = 10 };
static const double look_seconds = 0.2;

struct Client {
    Client *next, **place;
    int socket;
    ClientState state;
    double since;
    double counted; /* of an image: since when its bytes are counted */
    size_t bytes;
};

struct Clients {
    pthread_mutex_t lock;
    Client *first;
    int count;
    double looked; /* for those that have left */
};

Clients *clients_open(void)
{
    Clients *clients = calloc(1, sizeof *clients);
    if (clients)
        pthread_mutex_init(&clients->lock, NULL);
    return clients;
}

void clients_close(Clients *clients)
{
    if (!clients)
        return;
    for (Client *client = clients->first, *next; client; client = next) {
        next = client->next;
        free(client);
    }
    pthread_mutex_destroy(&clients->lock);
    free(clients);
}

Client *clients_add(Clients *clients, int socket)
{
    Client *client = calloc(1, sizeof *client);
    if (!client)
        return NULL;
    pthread_mutex_lock(&clients->lock);
    *client = (Client){.next = clients->first,
                       .place = &clients->first,
                       .socket = socket,
                       .state = CLIENT_SENDS,
                       .since = retex_clock_seconds()};
    if (client->next)
        client->next->place = &client->next;
    clients->first = client;
    clients->count++;
    pthread_mutex_unlock(&clients->lock);
    return client;
}

void clients_remove(Clients *clients, Client *client)
{
    if (!client)
        return;
    pthread_mutex_lock(&clients->lock);
    *client->place = client->next;
    if (client->next)
        client->next->place = client->place;
    clients->count--;
    pthread_mutex_unlock(&clients->lock);
    free(client);
}

void clients_set(Clients *clients, Client *client, ClientState state)
{
    if (!client)
        return;
    pthread_mutex_lock(&clients->lock);
    client->state = state;
    client->since = client->counted = retex_clock_seconds();
    client->bytes = 0;
    pthread_mutex_unlock(&clients->lock);
}

void clients_received(Clients *clients, Client *client, size_t bytes)
{
    if (!client)
        return;
    pthread_mutex_lock(&clients->lock);
    client->bytes += bytes;
    pthread_mutex_unlock(&clients->lock);
}

/* Whether an image comes too slowly; the next bytes are counted anew. */
static int crawls(Client *client, double now, double rate)
{
    if (client->state != CLIENT_UPLOADS || now - client->counted < CLIENTS_RATE_SECONDS)
        return 0;
    const int is_slow = (double)client->bytes < rate * CLIENTS_RATE_SECONDS;
    client->counted = now;
    client->bytes = 0;
    return is_slow;
}

static int is_late(const Client *client, double now, double seconds)
{
    const double waited = now - client->since;
    return (client->state == CLIENT_SENDS && waited > seconds) ||
           ((client->state == CLIENT_TAKES || client->state == CLIENT_UPLOADS) && waited > TAKES_LONGER * seconds);
}

/* Whether it is waited for somebody who has closed the connection, which libmicrohttpd 0.9.75 does not notice before a
 * request's first line, or an image, is complete. */
static int has_left(const Client *client)
{
    char byte;
    return (client->state == CLIENT_SENDS || client->state == CLIENT_UPLOADS) &&
           recv(client->socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
}

void clients_sweep(Clients *clients, double now, double seconds, double rate)
{
    pthread_mutex_lock(&clients->lock); /* so that no socket is closed, and its number used again, meanwhile */
    const int looks = now - clients->looked >= look_seconds;
    for (Client *client = clients->first; client; client = client->next)
        if (is_late(client, now, seconds) || crawls(client, now, rate) || (looks && has_left(client)))
            shutdown(client->socket, SHUT_RDWR);
    clients->looked = looks ? now : clients->looked;
    pthread_mutex_unlock(&clients->lock);
}

int clients_count(Clients *clients)
{
    pthread_mutex_lock(&clients->lock);
    const int count = clients->count;
    pthread_mutex_unlock(&clients->lock);
    return count;
}
