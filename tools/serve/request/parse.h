/* What a URL asks retex-serve for. Only text is looked at here: no sockets, no files, no room.
 *
 *     /health   /metrics
 *     /v1                                               rooms and textures
 *     /v1/ROOM                                          a room: its size, targets
 *     /v1/ROOM[/EDITS]/SIZE[.EXTENSION][?QUERY]         a picture
 *     /v1/textures/NAME/thumbnail[.EXTENSION][?quality=N]
 *                                                       a texture, which no EDITS look like
 *     /iiif/3/ID   /iiif/3/ID/info.json                 IIIF Image API 3.0; ID = ROOM[;EDITS]
 *     /iiif/3/ID/REGION/SIZE/ROTATION/QUALITY.FORMAT
 *
 * EDITS are the text of an edit, see retex/edit.h, as in `Floor=oak;Floor.scale=2,1;Wall=rgb(.2,.3,.4)`. QUERY may have
 * further options of these targets, lamps `light:LAMP=VALUE`, finishes `finish:TARGET=NAME`, exposure=STOPS,
 * white-balance=KELVINS, auto-exposure=yes and view=NAME, which mean picture:exposure and so on, preset=NAME, and
 * crop=X,Y,WIDTH,HEIGHT, quality=1..100. SIZE is WIDTHxHEIGHT, WIDTHx, xHEIGHT, full, auto or thumbnail.
 *
 * Parts of the path and of the query are percent-decoded once, after they were divided. What they then hold must be
 * UTF-8 without control characters, slashes and backslashes. */
#ifndef RETEX_SERVE_PARSE_H
#define RETEX_SERVE_PARSE_H

#include <retex/edit.h>

#include "serve/request/request.h"

/* Parse the URL of a GET or HEAD: its path and query as they came, percent-encoded. accept is the header of that name,
 * or NULL; formats has the bit 1 << f of each ServeFormat f that can be written, JPEG's always. Returns
 * request->status. */
int serve_request_parse(ServeRequest *request, const char *url, const char *accept, unsigned formats);

/* Add what a preset says and the request does not: textures of targets, lamps, and so on. Images that it names with
 * folders are meant without these. Returns request->status. */
int serve_request_complete(ServeRequest *request, RetexEdit *preset);

#endif
