/* Packs in memory. */
#ifndef LIB_PACK_READ_H
#define LIB_PACK_READ_H

#include <retex/set.h>

int pack_read(const void *data, size_t bytes, RetexSet **set, int nthreads, RetexError *err);
int pack_check(const void *data, size_t bytes, int nthreads, RetexError *err); /* its checksums */

#endif
