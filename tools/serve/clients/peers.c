/* See peers.h. A hash table with chains; who has nothing is not in it. */
#include "serve/clients/peers.h"

#include <stdint.h>
#include <stdlib.h>

#include "http/hash.h"

enum { CHAINS = 1024, UPLOADS_SHARE = 8 };

struct Peer {
    Peer *next;
    Address address;
    int count, uploads;
};

struct Peers {
    int most, most_uploads;
    Peer *chains[CHAINS];
};

Peers *peers_open(int most)
{
    Peers *peers = calloc(1, sizeof *peers);
    if (peers) {
        peers->most = most;
        peers->most_uploads = most ? (most + UPLOADS_SHARE - 1) / UPLOADS_SHARE : 0;
    }
    return peers;
}

void peers_close(Peers *peers)
{
    for (int i = 0; peers && i < CHAINS; i++)
        for (Peer *peer = peers->chains[i], *next; peer; peer = next) {
            next = peer->next;
            free(peer);
        }
    free(peers);
}

/* The place of a client in its chain, which is its end where the client is not there. */
static Peer **find_place(Peers *peers, const Address *client)
{
    Peer **place = &peers->chains[hash_bytes(HASH_BEGIN, client->bytes, sizeof client->bytes) % CHAINS];
    while (*place && !address_is_same(&(*place)->address, client))
        place = &(*place)->next;
    return place;
}

int peers_has_place(Peers *peers, const Address *address)
{
    const Address client = address_of_client(address);
    const Peer *peer = *find_place(peers, &client);
    return !peers->most || !peer || peer->count < peers->most;
}

Peer *peers_enter(Peers *peers, const Address *address)
{
    const Address client = address_of_client(address);
    Peer **place = find_place(peers, &client);
    if (*place && peers->most && (*place)->count >= peers->most)
        return NULL;
    if (!*place) {
        if (!(*place = calloc(1, sizeof **place)))
            return NULL;
        (*place)->address = client;
    }
    (*place)->count++;
    return *place;
}

void peers_leave(Peers *peers, Peer *peer)
{
    if (!peer || --peer->count > 0)
        return;
    *find_place(peers, &peer->address) = peer->next;
    free(peer);
}

int peers_begin_upload(const Peers *peers, Peer *peer)
{
    if (peers->most && peer->uploads >= peers->most_uploads)
        return 0;
    peer->uploads++;
    return 1;
}

void peers_end_upload(Peer *peer)
{
    peer->uploads--;
}
