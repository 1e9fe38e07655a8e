/* How much each client has of what all share: connections, or requests that come through a proxy, and uploads on their
 * way. One thread calls. */
#ifndef RETEX_SERVE_PEERS_H
#define RETEX_SERVE_PEERS_H

#include "serve/clients/address.h"

typedef struct Peers Peers;
typedef struct Peer Peer;

/* At most so many of a client; 0 = any number, of uploads too, which are otherwise an eighth. NULL: no memory. */
Peers *peers_open(int most);
void peers_close(Peers *peers); /* NULL is fine */

/* Whether the client may have one more. */
int peers_has_place(Peers *peers, const Address *address);
/* Count one more of it. NULL: it has too many, or there is no memory. */
Peer *peers_enter(Peers *peers, const Address *address);
void peers_leave(Peers *peers, Peer *peer); /* NULL is fine */

/* The same for an upload, of who has entered: 0 where it has too many. */
int peers_begin_upload(const Peers *peers, Peer *peer);
void peers_end_upload(Peer *peer);

#endif
