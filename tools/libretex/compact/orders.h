/* Fewer orders of interreflection: terms approximated by those of other orders. Private to libretex. */
#ifndef RETEX_COMPACT_ORDERS_H
#define RETEX_COMPACT_ORDERS_H

#include "compact/kinds.h"

/* List a kind's gains, and how each term is divided among them. */
int retex_compact_orders_make(RetexCompactKind *kind, const RetexCompactLight *light, RetexCompactMixed mixed,
                              RetexError *err);

#endif
