/* An arena of growing blocks. Blocks come from calloc: fresh pages are zero already, so big ones are not cleared. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/arena.h"

#define ALIGNMENT ((size_t)16)
#define FIRST_BLOCK ((size_t)64 << 10)
#define LARGEST_BLOCK ((size_t)4 << 20)

typedef struct Block {
    struct Block *next;
    size_t size, used; /* bytes after this header */
} Block;

struct Arena {
    Block *blocks; /* the first one is being filled */
    size_t limit, used, next_size;
    RetexBudget *budget;
};

/* The header takes whole alignment units, so that what follows is aligned. */
#define HEADER ((sizeof(Block) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT)

Arena *arena_create(size_t limit, RetexBudget *budget)
{
    Arena *arena = calloc(1, sizeof(*arena));

    if (!arena)
        return NULL;
    arena->limit = limit ? limit : SIZE_MAX;
    arena->next_size = FIRST_BLOCK;
    arena->budget = budget;
    return arena;
}

void arena_close(Arena **arena)
{
    if (!arena || !*arena)
        return;
    for (Block *block = (*arena)->blocks, *next; block; block = next) {
        next = block->next;
        retex_budget_release((*arena)->budget, HEADER + block->size);
        free(block);
    }
    free(*arena);
    *arena = NULL;
}

/* Something larger than a quarter of the usual block gets its own, behind the one being filled, whose rest stays
 * usable. */
static Block *add_block(Arena *arena, size_t bytes)
{
    int own = bytes > arena->next_size / 4;
    size_t size = own ? bytes : arena->next_size;
    if (retex_budget_charge(arena->budget, HEADER + size, "", NULL))
        return NULL;
    Block *block = calloc(1, HEADER + size);
    if (!block) {
        retex_budget_release(arena->budget, HEADER + size);
        return NULL;
    }
    block->size = size;
    if (own && arena->blocks) {
        block->next = arena->blocks->next;
        arena->blocks->next = block;
    } else {
        block->next = arena->blocks;
        arena->blocks = block;
    }
    if (!own && arena->next_size < LARGEST_BLOCK)
        arena->next_size *= 2;
    return block;
}

void *arena_alloc(Arena *arena, size_t bytes)
{
    Block *block = arena->blocks;
    void *out;

    if (bytes > SIZE_MAX - HEADER - ALIGNMENT)
        return NULL;
    bytes = bytes ? (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT : ALIGNMENT;
    if (bytes > arena->limit - arena->used)
        return NULL;
    if (!block || bytes > block->size - block->used)
        block = add_block(arena, bytes);
    if (!block)
        return NULL;
    out = (char *)block + HEADER + block->used;
    block->used += bytes;
    arena->used += bytes;
    return out;
}

void *arena_copy(Arena *arena, const void *data, size_t bytes)
{
    void *out = arena_alloc(arena, bytes);

    if (out && bytes)
        memcpy(out, data, bytes);
    return out;
}

char *arena_string(Arena *arena, const char *text, size_t length)
{
    char *out = length < SIZE_MAX ? arena_alloc(arena, length + 1) : NULL;

    if (out && length)
        memcpy(out, text, length);
    return out;
}
