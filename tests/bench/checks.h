/* Does the whole way hold what it promises, on a real model? */
#ifndef TESTS_BENCH_CHECKS_H
#define TESTS_BENCH_CHECKS_H

#include <isoslice/config.h>

/* Print a line of figures, and one for every promise that was broken; return how many were.
 *
 * - the same bytes for 1, 2, 4 and 8 threads, ten runs each
 * - slices, and the regions of every layer between the stages, pass their validators
 * - the area of every layer's slices is that of the mesh's cross-section, found triangle by
 *   triangle, within 1e-6 of it
 * - area times height, summed, is the volume of the mesh clipped to the printed height within 0.3 %
 * - the virtual printer finds no fault in the G-code */
int checks_run(const char *path, const iso_options *options, const char *scratch_path);

#endif
