/* IIIF Image API 3.0: which pixels a request means, and the description of an image. Level 2 is supported.
 * https://iiif.io/api/image/3.0/ */
#ifndef RETEX_SERVE_IIIF_H
#define RETEX_SERVE_IIIF_H

#include <jansson.h>

#include <retex/shrink.h>

#include "serve/request/request.h"

enum { IIIF_TILE_SIDE = 512, IIIF_URL_MAX = 3 * SERVE_URL_MAX + 1024 };

/* Parse the parameters of an image, decoded, into the request. Returns request->status. */
int iiif_parse(ServeRequest *request, const char *region, const char *size, const char *rotation, char *quality,
               unsigned formats);

/* The place of request->region and request->size, also of requests that are not IIIF's, in a room of this size: before
 * it is mirrored, then turned. Turned by a quarter, the picture is scaled_height wide.
 * Returns 0; or 400, and 501 for IIIF's `^` that would enlarge, in request->status with request->reason. */
int iiif_place(ServeRequest *request, int room_width, int room_height, RetexCut *place);

/* The URL of the image, BASE/iiif/3/ID, without a slash at its end. base is "https://example.org" or "" for a URL
 * relative to the server. Returns text. */
const char *iiif_id(char text[IIIF_URL_MAX], const ServeRequest *request, const char *base);

/* The canonical URL of the picture, for the header `Link: <URL>;rel="canonical"`. Returns text. */
const char *iiif_canonical(char text[IIIF_URL_MAX], const ServeRequest *request, const RetexCut *place,
                           const char *base, int room_width, int room_height);

/* info.json, of the type iiif_info_type(accept): application/ld+json, or application/json for those who accept only
 * that. formats as in serve_request_parse. */
json_t *iiif_info(const ServeRequest *request, const char *base, int room_width, int room_height, unsigned formats);
const char *iiif_info_type(const char *accept);

#endif
