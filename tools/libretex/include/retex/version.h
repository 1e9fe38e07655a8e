/* The version of the library and of all that is built with it. */
#ifndef RETEX_VERSION_H
#define RETEX_VERSION_H

#define RETEX_VERSION "0.1.0"

#endif
