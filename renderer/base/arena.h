/* An arena: memory that is freed all at once. The scene lives in one. */
#ifndef RENDERER_BASE_ARENA_H
#define RENDERER_BASE_ARENA_H

#include <stddef.h>
#include <retex/budget.h>

typedef struct Arena Arena;

/* limit: bytes it may hold in all, 0 = no limit; budget: what its blocks are charged to, or NULL. NULL without
 * memory. */
Arena *arena_create(size_t limit, RetexBudget *budget);
void arena_close(Arena **arena);
void *arena_alloc(Arena *arena, size_t bytes);                    /* zeroed, 16-aligned; NULL at the limit */
char *arena_string(Arena *arena, const char *text, size_t length); /* with a final NUL */
void *arena_copy(Arena *arena, const void *data, size_t bytes);

#endif
