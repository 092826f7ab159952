/* All memory comes through here: results from iso_allocate, scratch from a LIFO arena.
 *
 * An allocation hook lets the tests make the n-th allocation fail. */
#ifndef ISO_BASE_MEMORY_H
#define ISO_BASE_MEMORY_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <isoslice/status.h>

/* NULL if there is none; never NULL for size 0. Set the status with iso_no_memory(). */
void *iso_allocate(size_t size);
void *iso_reallocate(void *block, size_t size);
void iso_release(void *block);
iso_status iso_no_memory(size_t size);

/* Tests: from now on allocation number `n` (0 = the next one) and all after it fail; -1 never.
 * Returns how many allocations were made since the last call. Not thread-safe. */
int64_t iso_fail_allocation_after(int64_t n);

/* Grow *block to hold at least `needed` elements of `size` bytes, by a half or more; *capacity
 * counts elements. */
iso_status iso_grow(void **block, int64_t *capacity, int64_t needed, size_t size) ISO_MUST_CHECK;

#define ISO_GROW(array, capacity, needed)                                                          \
    ((int64_t)(needed) <= (capacity)                                                               \
         ? ISO_OK                                                                                  \
         : iso_grow((void **)&(array), &(capacity), (int64_t)(needed), sizeof *(array)))

/* Allocate *block for exactly `count` elements. */
iso_status iso_allocate_array(void **block, int64_t count, size_t size) ISO_MUST_CHECK;

#define ISO_ALLOCATE(array, count)                                                                 \
    iso_allocate_array((void **)&(array), (int64_t)(count), sizeof *(array))

/* Scratch memory, last in, first out: take a mark, push, pop back to the mark. Blocks are 64-byte
 * aligned and never move. Pages stay with the arena until iso_arena_free, so a loop that pushes and
 * pops allocates nothing after its first turns. */
typedef struct iso_arena {
    struct iso_arena_page *page; /* current; linked to earlier and later ones */
    size_t used;                 /* bytes of the current page */
} iso_arena;

typedef struct iso_arena_mark {
    struct iso_arena_page *page;
    size_t used;
} iso_arena_mark;

void iso_arena_free(iso_arena *arena); /* a zeroed arena is an empty one */
iso_arena_mark iso_arena_get_mark(const iso_arena *arena);
void iso_arena_pop(iso_arena *arena, iso_arena_mark mark);
void *iso_arena_push(iso_arena *arena, size_t size);
iso_status iso_arena_push_array(void **block, iso_arena *arena, int64_t count,
                                size_t size) ISO_MUST_CHECK;

#define ISO_PUSH(array, arena, count)                                                              \
    iso_arena_push_array((void **)&(array), arena, (int64_t)(count), sizeof *(array))

#endif
