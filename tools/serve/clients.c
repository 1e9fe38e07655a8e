/* See clients.h. */
#include "clients.h"

#include <pthread.h>
#include <stdlib.h>
#include <sys/socket.h>

#include <retex/clock.h>

enum { TAKES_LONGER = 10 };

struct Client {
    Client *next, **place;
    int socket;
    ClientState state;
    double since;
};

struct Clients {
    pthread_mutex_t lock;
    Client *first;
    int count;
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
    *client = (Client){clients->first, &clients->first, socket, CLIENT_SENDS, retex_clock_seconds()};
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
    client->since = retex_clock_seconds();
    pthread_mutex_unlock(&clients->lock);
}

void clients_sweep(Clients *clients, double seconds)
{
    const double now = retex_clock_seconds();
    pthread_mutex_lock(&clients->lock); /* so that no socket is closed, and its number used again, meanwhile */
    for (Client *client = clients->first; client; client = client->next)
        if ((client->state == CLIENT_SENDS && now - client->since > seconds) ||
            ((client->state == CLIENT_TAKES || client->state == CLIENT_UPLOADS) &&
             now - client->since > TAKES_LONGER * seconds))
            shutdown(client->socket, SHUT_RDWR);
    pthread_mutex_unlock(&clients->lock);
}

int clients_count(Clients *clients)
{
    pthread_mutex_lock(&clients->lock);
    const int count = clients->count;
    pthread_mutex_unlock(&clients->lock);
    return count;
}
