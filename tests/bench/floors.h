/* Floors: what the same data costs if nothing is done with it but the unavoidable. In CPU seconds,
 * the least of several rounds. */
#ifndef TESTS_BENCH_FLOORS_H
#define TESTS_BENCH_FLOORS_H

#include <isoslice/slice.h>

/* read() of all bytes of a file, in chunks as large as the engine's. */
double floor_read(const char *path);

/* write() of as many bytes to a new file in chunks as large as the engine's; no fsync. */
double floor_write(const char *path, int64_t bytes);

/* memcpy that reads and writes as many bytes together, between warm buffers. */
double floor_copy(int64_t bytes);

/* The crossings of all levels with their successors and points in the order of the darts, by
 * arithmetic alone (paper, 5); contours are not gathered. Ends the program if the crossings or the
 * volume they enclose are not those of `slices`. */
double floor_slice(const iso_mesh *mesh, const iso_levels *levels, const iso_slices *slices);

#endif
