/* What the fuzz drivers share: seeds, a repeatable mutator, and a parent process that watches over the one that runs
 * the inputs.
 *
 * A driver is a program:
 *     fuzz_NAME [--seconds N] [--seed N] [--keep FOLDER] [--words FILE]... [SEED-FILE]...
 *     fuzz_NAME --run FILE...      run these inputs only, to look at what was found
 *     fuzz_NAME --seeds FOLDER [--words FILE]... [SEED-FILE]...    write the seeds there, and words into the file words
 *     fuzz_NAME -OPTION=VALUE... FOLDER...    with libFuzzer, if it is linked with that: these are its options
 * Input number i of seed s is the same in every run with the same seeds. A finding is a crash, a report of a sanitizer,
 * a leak, an input that takes more than FUZZ_CPU_SECONDS or FUZZ_MEMORY bytes, or an abort() of the driver itself, for
 * what must hold and does not. Findings with the same place in the code are kept once: the input, and its report beside
 * it. */
#ifndef LIB_FUZZ_H
#define LIB_FUZZ_H

#include <stddef.h>
#include <stdint.h>

#define FUZZ_CPU_SECONDS 10
#define FUZZ_WALL_SECONDS 120 /* for what waits without working, on a busy machine */
#define FUZZ_MEMORY ((size_t)2 << 30)
#define FUZZ_LARGEST ((size_t)1 << 19) /* bytes of an input */

typedef struct FuzzDriver {
    const char *name;
    int text;                                            /* 1: mutated by tokens as well as by bytes */
    void (*begin)(void);                                 /* give seeds and words of its own; NULL = none */
    int (*run)(const unsigned char *bytes, size_t size); /* one input; a NUL stands behind its last byte. 1: accepted */
} FuzzDriver;

int fuzz_main(const FuzzDriver *driver, int argc, char **argv);

/* For begin: another seed (copied), or words of a text for the tokens to be exchanged with. */
void fuzz_seed(const void *bytes, size_t size);
void fuzz_words(const char *text, size_t size);

void fuzz_write_seeds(const char *folder);

/* The mutator: room bytes at out; returns how many it used. Depends on nothing but the seeds, words and *random. */
size_t fuzz_mutate(unsigned char *out, size_t room, int text, uint64_t *random);
uint64_t fuzz_next(uint64_t *random);

/* For run: abort with a message unless it holds. */
void fuzz_must(int holds, const char *what);

#endif
