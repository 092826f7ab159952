#include "base/memory.h"

#include <stdlib.h>

/* The only malloc, realloc and free of the engine. The counter is touched by tests alone. */
static int64_t fail_after = -1;
static int64_t allocation_count;

static int allocation_refused(void) {
    if (fail_after < 0)
        return 0;
    return allocation_count++ >= fail_after;
}

int64_t iso_fail_allocation_after(int64_t n) {
    int64_t made = allocation_count;
    allocation_count = 0;
    fail_after = n;
    return made;
}

void *iso_allocate(size_t size) {
    return allocation_refused() ? NULL : malloc(size ? size : 1);
}

void *iso_reallocate(void *block, size_t size) {
    return allocation_refused() ? NULL : realloc(block, size ? size : 1);
}

void iso_release(void *block) {
    free(block);
}

iso_status iso_no_memory(size_t size) {
    return iso_fail(ISO_NO_MEMORY, "out of memory: %zu bytes could not be had", size);
}

iso_status iso_grow(void **block, int64_t *capacity, int64_t needed, size_t size) {
    int64_t grown = *capacity < 16 ? 16 : *capacity;
    while (grown < needed)
        grown += grown / 2;
    if ((uint64_t)grown > PTRDIFF_MAX / size)
        return iso_no_memory(SIZE_MAX);
    void *moved = iso_reallocate(*block, (size_t)grown * size);
    if (!moved)
        return iso_no_memory((size_t)grown * size);
    *block = moved;
    *capacity = grown;
    return ISO_OK;
}

iso_status iso_allocate_array(void **block, int64_t count, size_t size) {
    *block = NULL;
    if (count < 0 || (uint64_t)count > PTRDIFF_MAX / size)
        return iso_no_memory(SIZE_MAX);
    *block = iso_allocate((size_t)count * size);
    return *block ? ISO_OK : iso_no_memory((size_t)count * size);
}

/* Pages double, so a few of them hold any job; a page once reached is kept for the next push. */
struct iso_arena_page {
    struct iso_arena_page *before, *after;
    size_t capacity;
    char pad[64 - 3 * sizeof(void *)]; /* blocks start 64 bytes in */
};

enum { ARENA_ALIGNMENT = 64, ARENA_FIRST_PAGE = 64 << 10 };

static char *page_bytes(struct iso_arena_page *page) {
    return (char *)page + sizeof *page;
}

static struct iso_arena_page *page_new(struct iso_arena_page *before, size_t least) {
    size_t capacity = before ? 2 * before->capacity : ARENA_FIRST_PAGE;
    while (capacity < least)
        capacity *= 2;
    /* aligned_alloc would bypass the hook: over-allocate and let the first push align instead */
    struct iso_arena_page *page = iso_allocate(sizeof *page + capacity + ARENA_ALIGNMENT);
    if (!page)
        return NULL;
    *page = (struct iso_arena_page){.before = before, .capacity = capacity + ARENA_ALIGNMENT};
    return page;
}

void iso_arena_free(iso_arena *arena) {
    struct iso_arena_page *page = arena->page;
    while (page && page->after)
        page = page->after;
    while (page) {
        struct iso_arena_page *before = page->before;
        iso_release(page);
        page = before;
    }
    *arena = (iso_arena){0};
}

iso_arena_mark iso_arena_get_mark(const iso_arena *arena) {
    return (iso_arena_mark){arena->page, arena->used};
}

void iso_arena_pop(iso_arena *arena, iso_arena_mark mark) {
    if (!mark.page) { /* back to the beginning */
        while (arena->page && arena->page->before)
            arena->page = arena->page->before;
    } else {
        arena->page = mark.page;
    }
    arena->used = mark.used;
}

void *iso_arena_push(iso_arena *arena, size_t size) {
    for (;;) {
        struct iso_arena_page *page = arena->page;
        if (page) {
            uintptr_t at = (uintptr_t)page_bytes(page) + arena->used;
            size_t pad = (size_t)(-at & (ARENA_ALIGNMENT - 1));
            if (pad + size <= page->capacity - arena->used) {
                arena->used += pad + size;
                return (char *)at + pad;
            }
            if (page->after && page->after->capacity < size + ARENA_ALIGNMENT) {
                /* too small for this block: a larger one takes the place of all that follow */
                iso_arena rest = {page->after, 0};
                page->after->before = NULL;
                page->after = NULL;
                iso_arena_free(&rest);
            }
        }
        if (!page || !page->after) {
            struct iso_arena_page *fresh = page_new(page, size);
            if (!fresh)
                return NULL;
            if (page)
                page->after = fresh;
            arena->page = fresh;
        } else {
            arena->page = page->after;
        }
        arena->used = 0;
    }
}

iso_status iso_arena_push_array(void **block, iso_arena *arena, int64_t count, size_t size) {
    *block = NULL;
    if (count < 0 || (uint64_t)count > PTRDIFF_MAX / 4 / size)
        return iso_no_memory(SIZE_MAX);
    *block = iso_arena_push(arena, (size_t)count * size);
    return *block ? ISO_OK : iso_no_memory((size_t)count * size);
}
