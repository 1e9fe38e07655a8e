/* Errors: every fallible call of libretex returns 0 or a negative RetexCode and, where the caller gives one, fills a
 * RetexError. The library never prints, never exits and keeps no global error state. */
#ifndef RETEX_ERROR_H
#define RETEX_ERROR_H

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define RETEX_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))
#else
#define RETEX_PRINTF(fmt, args)
#endif

typedef enum RetexCode {
    RETEX_OK = 0,
    RETEX_EINVAL = -1,       /* an argument or option is out of its range */
    RETEX_EIO = -2,          /* the system refused: no such file, full disk */
    RETEX_EFORMAT = -3,      /* the bytes are not what they should be: truncated, damaged, foreign */
    RETEX_ENOMEM = -4,       /* there is not enough memory */
    RETEX_ENOTFOUND = -5,    /* a name that nothing has: target, texture, part */
    RETEX_EUNSUPPORTED = -6, /* understood, but beyond this version */
    RETEX_EPARSE = -7,       /* a scene, option or table with an error in its text */
    RETEX_ELIMIT = -8,       /* a limit, of memory, time, pixels, steps, depth or length, is reached */
    RETEX_EINTERNAL = -9,    /* a broken promise of the library itself */
    RETEX_ESTOPPED = -10,    /* the caller asked for it */
    RETEX_EACCESS = -11,     /* a file that may not be read: see access.h */
    RETEX_EPIPE = -12        /* the reader of a pipe that was written to has gone */
} RetexCode;

/* Filled on failure only; untouched on success. file is "" and line and column are 0 where there is none; lines and
 * columns count from 1. */
typedef struct RetexError {
    int code;
    int line, column;
    char file[512];
    char message[1024];
} RetexError;

/* Receives a warning: a line of text, without the caller's file or line. */
typedef void RetexWarn(void *context, const char *text);

/* Fill err (which may be NULL) and return code, so that failing is one statement: return retex_fail(err, ...). */
int retex_fail(RetexError *err, int code, const char *fmt, ...) RETEX_PRINTF(3, 4);
int retex_fail_at(RetexError *err, int code, const char *file, int line, int column, const char *fmt, ...)
    RETEX_PRINTF(6, 7);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
