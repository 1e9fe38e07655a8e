/* The mutator: seeds changed a few times over, by bytes and, where the input is text, by tokens. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib_fuzz.h"

enum { SEEDS_MAX = 512, WORDS_MAX = 4096 };

typedef struct Bytes {
    const unsigned char *at;
    size_t size;
} Bytes;

static Bytes seeds[SEEDS_MAX], words[WORDS_MAX];
static size_t nseeds, nwords;

static const unsigned char *keep(const void *bytes, size_t size)
{
    unsigned char *copy = malloc(size + 1);
    if (!copy)
        abort();
    memcpy(copy, bytes, size);
    return copy;
}

void fuzz_seed(const void *bytes, size_t size)
{
    if (nseeds < SEEDS_MAX && size <= FUZZ_LARGEST)
        seeds[nseeds++] = (Bytes){keep(bytes, size), size};
}

/* The token at text + from: a word, a number, a string in quotes, blanks, or one byte; its length. */
static size_t token_length(const unsigned char *text, size_t size, size_t from)
{
    size_t i = from;
    if (isalpha(text[i]) || text[i] == '_') {
        while (i < size && (isalnum(text[i]) || text[i] == '_'))
            i++;
    } else if (isdigit(text[i])) {
        while (i < size && (isalnum(text[i]) || text[i] == '.'))
            i++;
    } else if (isspace(text[i])) {
        while (i < size && isspace(text[i]))
            i++;
    } else if (text[i] == '"') {
        do
            i++;
        while (i < size && text[i] != '"' && text[i] != '\n');
        i += i < size;
    } else {
        i++;
    }
    return i - from;
}

void fuzz_words(const char *text, size_t size)
{
    const unsigned char *bytes = keep(text, size);
    for (size_t i = 0, n; i < size && nwords < WORDS_MAX; i += n) {
        n = token_length(bytes, size, i);
        if (isalpha(bytes[i]))
            words[nwords++] = (Bytes){bytes + i, n};
        else if (bytes[i] == '"')
            n = 1; /* what stands in strings are words too */
    }
}

static FILE *open_seed(const char *folder, size_t number)
{
    char path[512];
    snprintf(path, sizeof path, "%s/seed-%zu", folder, number);
    FILE *file = fopen(path, "wb");
    if (!file)
        abort();
    return file;
}

void fuzz_write_seeds(const char *folder)
{
    for (size_t i = 0; i < nseeds; i++) {
        FILE *file = open_seed(folder, i);
        fwrite(seeds[i].at, 1, seeds[i].size, file);
        fclose(file);
    }
    FILE *file = fopen("words", "w");
    for (size_t i = 0; file && i < nwords; i++)
        if (words[i].size < 60)
            fprintf(file, "\"%.*s\"\n", (int)words[i].size, (const char *)words[i].at);
    if (!file || fclose(file))
        abort();
}

uint64_t fuzz_next(uint64_t *random)
{
    uint64_t z = *random += 0x9e3779b97f4a7c15u; /* splitmix64 */
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* The input while it is being changed. */
typedef struct Draft {
    unsigned char *at;
    size_t size, room;
    uint64_t *random;
} Draft;

/* 0..n-1; 0 where n is 0. */
static size_t below(Draft *d, size_t n)
{
    return n ? (size_t)(fuzz_next(d->random) % n) : 0;
}

/* A length: mostly short. */
static size_t some_length(Draft *d, size_t most)
{
    size_t scale = (size_t)1 << below(d, 14);
    size_t n = 1 + below(d, scale);
    return n < most ? n : most;
}

/* A place: in every second case near the beginning, where headers are. */
static size_t some_place(Draft *d)
{
    return below(d, below(d, 2) && d->size > 4096 ? 4096 : d->size);
}

/* Put count bytes in the place of `removed` bytes at `place`; what does not fit is cut off the end. */
static void replace(Draft *d, size_t place, size_t removed, const unsigned char *bytes, size_t count)
{
    size_t rest = d->size - place - removed;
    if (place + count > d->room)
        count = d->room - place;
    if (place + count + rest > d->room)
        rest = d->room - place - count;
    unsigned char *copy = malloc(count + 1); /* bytes may be of the draft itself */
    if (!copy)
        abort();
    memcpy(copy, bytes, count);
    memmove(d->at + place + count, d->at + place + removed, rest);
    memcpy(d->at + place, copy, count);
    free(copy);
    d->size = place + count + rest;
}

static Bytes some_seed(Draft *d)
{
    return seeds[below(d, nseeds)];
}

/* A whole number at the edge of something, written little-endian or big-endian. */
static void change_number(Draft *d)
{
    static const uint64_t edges[] = {0,
                                     1,
                                     2,
                                     0x7f,
                                     0x80,
                                     0xff,
                                     0x7fff,
                                     0x8000,
                                     0xffff,
                                     0x10000,
                                     0x10001,
                                     0x7fffffff,
                                     0x80000000,
                                     0xffffffff,
                                     0x100000000,
                                     0x7fffffffffffffff,
                                     0x8000000000000000,
                                     0xffffffffffffffff};
    size_t width = (size_t)1 << below(d, 4), place = some_place(d);
    uint64_t value = edges[below(d, sizeof edges / sizeof *edges)];
    int big = below(d, 4) == 0;
    if (place + width > d->size)
        return;
    if (below(d, 2)) { /* a little more or less than what is there */
        value = 0;
        memcpy(&value, d->at + place, width);
        value += below(d, 33) - 16;
    }
    for (size_t i = 0; i < width; i++)
        d->at[place + i] = (unsigned char)(value >> 8 * (big ? width - 1 - i : i));
}

static void change_bytes(Draft *d)
{
    size_t place = some_place(d);
    size_t length = some_length(d, d->size - place);
    Bytes other;
    switch (below(d, 8)) {
    case 0:
        d->at[place] ^= (unsigned char)(1 << below(d, 8));
        break;
    case 1:
        d->at[place] = (unsigned char)below(d, 256);
        break;
    case 2:
    case 3:
        change_number(d);
        break;
    case 4: /* a block again, elsewhere: in the place of what is there, or between */
        replace(d, below(d, d->size), 0, d->at + place, length);
        break;
    case 5:
        replace(d, place, length, d->at, 0);
        break;
    case 6: /* cut off the end, in every fourth case anywhere */
        d->size = below(d, 4) ? d->size - some_length(d, d->size) : below(d, d->size);
        break;
    default: /* go on as another seed does */
        other = some_seed(d);
        if (other.size > place)
            replace(d, place, below(d, 2) ? d->size - place : (length < other.size - place ? length : 0),
                    other.at + place,
                    below(d, 2)                   ? other.size - place
                    : length < other.size - place ? length
                                                  : 0);
    }
}

/* A token of the text that is no blank: where it begins; *length. Found from a random place on. */
static size_t some_token(Draft *d, const unsigned char *text, size_t size, size_t *length)
{
    size_t place = below(d, size);
    while (place > 0 && text[place - 1] != '\n' && !isspace(text[place]))
        place--;
    for (int tries = 0; tries < 1 + (int)below(d, 8) && place < size; tries++) {
        while (place < size && isspace(text[place]))
            place += token_length(text, size, place);
        if (place < size && tries)
            place += token_length(text, size, place);
    }
    if (place >= size || isspace(text[place]))
        place = 0;
    *length = size ? token_length(text, size, place) : 0;
    return place;
}

/* From a token over a few more, keeping braces in pairs where it can: its length. */
static size_t token_run(Draft *d, const unsigned char *text, size_t size, size_t place)
{
    size_t tokens = some_length(d, 200), depth = 0, i = place;
    for (size_t n = 0; i < size && (n < tokens || (depth > 0 && n < 1000)); n++) {
        depth += text[i] == '{' || text[i] == '(' || text[i] == '[';
        depth -= depth && (text[i] == '}' || text[i] == ')' || text[i] == ']');
        i += token_length(text, size, i);
    }
    return i - place;
}

static void change_tokens(Draft *d)
{
    static const char *const numbers[] = {
        "0",     "1",     "-1",      "0.5",         "2",      "3",     "1e-30",      "-1e-30",
        "1e30",  "-1e30", "1e308",   "1e999",       "-1e999", "65536", "2147483647", "1/0",
        "0/0",   "100",   "1000000", "-2147483648", "1e-320", "255",   "4294967296", "1000000000000000000000000",
        ".1e+1", "0x10",  "1.7e308", "7",           "9",      "360"};
    size_t length, place = some_token(d, d->at, d->size, &length), from, count;
    Bytes other;
    const char *number;
    switch (below(d, 8)) {
    case 0: /* another word of the language, or of a seed */
    case 1:
        if (nwords && below(d, 2)) {
            other = words[below(d, nwords)];
        } else {
            Bytes seed = some_seed(d);
            from = some_token(d, seed.at, seed.size, &count);
            other = (Bytes){seed.at + from, count};
        }
        replace(d, place, length, other.at, other.size);
        break;
    case 2:
        for (int tries = 0; tries < 20 && place < d->size && !isdigit(d->at[place]); tries++)
            place = some_token(d, d->at, d->size, &length);
        number = numbers[below(d, sizeof numbers / sizeof *numbers)];
        replace(d, place, length, (const unsigned char *)number, strlen(number));
        break;
    case 3:
        replace(d, place, length, d->at, 0);
        break;
    case 4:
        replace(d, place, token_run(d, d->at, d->size, place), d->at, 0);
        break;
    case 5: /* a run again, here or elsewhere */
        from = some_token(d, d->at, d->size, &count);
        replace(d, place, 0, d->at + from, token_run(d, d->at, d->size, from));
        break;
    case 6: /* a run of another seed, between or instead */
        other = some_seed(d);
        from = some_token(d, other.at, other.size, &count);
        count = token_run(d, other.at, other.size, from);
        replace(d, place, below(d, 2) ? token_run(d, d->at, d->size, place) : 0, other.at + from, count);
        break;
    default: /* two tokens as one */
        place += length;
        if (place < d->size)
            replace(d, place, token_length(d->at, d->size, place), d->at, 0);
    }
}

size_t fuzz_mutate(unsigned char *out, size_t room, int text, uint64_t *random)
{
    Draft d = {out, 0, room, random};
    Bytes seed = some_seed(&d);
    d.size = seed.size < room ? seed.size : room;
    memcpy(out, seed.at, d.size);
    for (size_t changes = 1 + below(&d, (size_t)1 << below(&d, 4)); changes > 0 && d.size > 0; changes--)
        if (text && below(&d, 8))
            change_tokens(&d);
        else
            change_bytes(&d);
    return d.size;
}
