/* A small pool of our own. OpenMP's workers spin while they wait, and CPU seconds are what we
 * count.
 *
 * Tasks are numbered; each writes only what belongs to its number, so any number of threads gives
 * the same result. */
#ifndef ISO_BASE_PARALLEL_H
#define ISO_BASE_PARALLEL_H

#include <stdint.h>

#include <isoslice/status.h>

typedef struct iso_pool iso_pool;

/* `threads` includes the caller, which works too; 1 starts none. 0 takes the number of processors.
 */
iso_status iso_pool_new(iso_pool **pool, int threads) ISO_MUST_CHECK;
void iso_pool_free(iso_pool *pool);
int iso_pool_threads(const iso_pool *pool);

/* `worker` < iso_pool_threads() names the thread, for scratch memory of its own. */
typedef iso_status iso_task(void *payload, int64_t index, int worker);

/* Run tasks 0 .. count - 1 and wait for all of them. After a failure no further task starts; the
 * failure of the lowest number that failed is returned, with its message. pool may be NULL: the
 * caller alone. */
iso_status iso_parallel_for(iso_pool *pool, int64_t count, iso_task *task,
                            void *payload) ISO_MUST_CHECK;

#endif
