/* Fewer orders: terms of many further hits told by others. Private to libretex. */
#ifndef RETEX_COMPACT_ORDERS_H
#define RETEX_COMPACT_ORDERS_H

#include "compact/light.h"

/* Give a kind its gains: which there are, and what each term is in them. */
int retex_compact_orders_make(RetexCompactKind *kind, const RetexSet *set, RetexCompactMixed mixed, RetexError *err);

#endif
