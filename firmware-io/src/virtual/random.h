/* A small generator of our own, so that a seed means the same everywhere (splitmix64; Steele, Lea
 * and Flood, Fast splittable pseudorandom number generators, 2014). */
#ifndef FIO_VIRTUAL_RANDOM_H
#define FIO_VIRTUAL_RANDOM_H

#include <stdbool.h>
#include <stdint.h>

typedef struct fio_random {
    uint64_t state;
} fio_random;

static inline uint64_t fio_random_next(fio_random *random) {
    uint64_t z = random->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* 0 … count - 1 */
static inline int fio_random_below(fio_random *random, int count) {
    return (int)((fio_random_next(random) >> 32) * (uint64_t)count >> 32);
}

/* True with this probability; draws nothing for 0, so that what is off disturbs nothing. */
static inline bool fio_random_chance(fio_random *random, double probability) {
    return probability > 0 && (double)(fio_random_next(random) >> 11) * 0x1p-53 < probability;
}

#endif
