/* Structs that begin with their size and may grow at the end. A program that was compiled against older headers has a
 * shorter one than the library, one that was compiled against newer headers a longer one. So each public call copies
 * its parameters into a struct of its own before it looks at them, and neither reads nor writes beyond the caller's.
 * A new member must not lie where the struct before it had padding. Private to libretex. */
#ifndef RETEX_BASE_PARAMS_H
#define RETEX_BASE_PARAMS_H

#include <stddef.h>
#include <retex/error.h>

/* Copy what the caller's struct has over `own`, which has the defaults and keeps them where given is NULL.
 * RETEX_EINVAL where its size cannot be one. */
#define RETEX_PARAMS_COPY(own, given, err) retex_params_copy(own, sizeof *(own), 1 ? (given) : (own), err)
int retex_params_copy(void *own, size_t own_size, const void *given, RetexError *err);

/* Write `own` into the caller's struct, as far as that goes. */
#define RETEX_PARAMS_RETURN(given, own, err) retex_params_return(given, own, sizeof *(1 ? (own) : (given)), err)
int retex_params_return(void *given, const void *own, size_t own_size, RetexError *err);

#endif
