/* All memory of the printer side comes through here; tests make the n-th allocation fail. */
#ifndef FIO_BASE_MEMORY_H
#define FIO_BASE_MEMORY_H

#include <stddef.h>
#include <stdint.h>

/* Zeroed; NULL if there is none. */
void *fio_allocate(size_t size);
void fio_release(void *block);

/* From now on allocation number `n` (0 = the next one) and all after it fail; -1 never. Returns how
 * many allocations were made since the last call. Not thread-safe. */
int64_t fio_fail_allocation_after(int64_t n);

#endif
