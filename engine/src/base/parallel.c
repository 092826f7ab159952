#include "base/parallel.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

#include "base/memory.h"

enum { THREADS_MAX = 256 };

typedef struct iso_worker {
    iso_pool *pool;
    pthread_t thread;
    int number;
} iso_worker;

struct iso_pool {
    int threads;
    int started; /* workers 1 .. started run */
    pthread_mutex_t lock;
    pthread_cond_t work, done;
    /* under the lock */
    uint64_t round; /* counts parallel loops, so that a late waker sees a new one */
    int busy;
    int quit;
    iso_task *task;
    void *payload;
    int64_t next, count;
    int64_t failed_index;
    iso_status status;
    char message[1024];
    iso_worker worker[];
};

/* Take numbers until none is left. The lock is held on entry and on return. Tasks are whole layers:
 * a mutex costs nothing beside them. */
static void pool_run(iso_pool *pool, int number) {
    while (pool->next < pool->count && pool->status == ISO_OK) {
        int64_t index = pool->next++;
        pthread_mutex_unlock(&pool->lock);
        iso_status status = pool->task(pool->payload, index, number);
        pthread_mutex_lock(&pool->lock);
        if (status != ISO_OK && (pool->status == ISO_OK || index < pool->failed_index)) {
            pool->status = status;
            pool->failed_index = index;
            snprintf(pool->message, sizeof pool->message, "%s", iso_error_message());
        }
    }
}

static void *worker_main(void *argument) {
    iso_worker *worker = argument;
    iso_pool *pool = worker->pool;
    uint64_t seen = 0;
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (!pool->quit && pool->round == seen)
            pthread_cond_wait(&pool->work, &pool->lock);
        if (pool->quit)
            break;
        seen = pool->round;
        pool->busy++;
        pool_run(pool, worker->number);
        if (--pool->busy == 0)
            pthread_cond_signal(&pool->done);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

/* Signals are the caller's affair: the workers leave them to the threads that were there before. */
static void start_workers(iso_pool *pool) {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    for (int i = 1; i < pool->threads; i++) {
        iso_worker *worker = &pool->worker[i];
        *worker = (iso_worker){.pool = pool, .number = i};
        if (pthread_create(&worker->thread, NULL, worker_main, worker) != 0)
            break; /* fewer threads do the same work */
        pool->started = i;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

iso_status iso_pool_new(iso_pool **out, int threads) {
    *out = NULL;
    if (threads <= 0)
        threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
    threads = threads < 1 ? 1 : threads > THREADS_MAX ? THREADS_MAX : threads;
    size_t size = sizeof(iso_pool) + (size_t)threads * sizeof(iso_worker);
    iso_pool *pool = iso_allocate(size);
    if (!pool)
        return iso_no_memory(size);
    memset(pool, 0, size);
    pool->threads = threads;
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->work, NULL);
    pthread_cond_init(&pool->done, NULL);
    start_workers(pool);
    *out = pool;
    return ISO_OK;
}

void iso_pool_free(iso_pool *pool) {
    if (!pool)
        return;
    pthread_mutex_lock(&pool->lock);
    pool->quit = 1;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->lock);
    for (int i = 1; i <= pool->started; i++)
        pthread_join(pool->worker[i].thread, NULL);
    pthread_mutex_destroy(&pool->lock);
    pthread_cond_destroy(&pool->work);
    pthread_cond_destroy(&pool->done);
    iso_release(pool);
}

int iso_pool_threads(const iso_pool *pool) {
    return pool ? pool->threads : 1;
}

iso_status iso_parallel_for(iso_pool *pool, int64_t count, iso_task *task, void *payload) {
    if (!pool || pool->started == 0 || count < 2) {
        for (int64_t i = 0; i < count; i++)
            ISO_TRY(task(payload, i, 0));
        return ISO_OK;
    }
    pthread_mutex_lock(&pool->lock);
    pool->task = task;
    pool->payload = payload;
    pool->next = 0;
    pool->count = count;
    pool->status = ISO_OK;
    pool->round++;
    pthread_cond_broadcast(&pool->work);
    pool_run(pool, 0);
    while (pool->busy > 0)
        pthread_cond_wait(&pool->done, &pool->lock);
    iso_status status = pool->status;
    pool->count = 0; /* whoever wakes late finds nothing to do */
    pthread_mutex_unlock(&pool->lock);
    return status == ISO_OK ? ISO_OK : iso_fail(status, "%s", pool->message);
}
