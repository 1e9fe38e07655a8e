/* Footprints of one class as one zlib stream: see retex-web(5). Private to libretex. */
#ifndef RETEX_WEB_FOOTPRINTS_H
#define RETEX_WEB_FOOTPRINTS_H

#include "base/json_write.h"
#include "pack/format.h"
#include "web/model.h"

/* *data is allocated. packed: the plan of all parts. */
int retex_web_footprints_encode(unsigned char **data, size_t *bytes, const RetexSet *set, const RetexPackPart *packed,
                                const RetexWebClass *c, RetexError *err);
/* The number of pixels with a footprint, summed over the class. */
size_t retex_web_records(const RetexSet *set, const RetexWebClass *c);
/* How to decode them: a list with one object a footprint, or NULL where memory is short. */
json_t *retex_web_footprints_describe(const RetexPackPart *packed, const RetexSet *set, const RetexWebClass *c);

#endif
