/* Properties of the kernel's results, asked of many cases.
 *
 * A property is a function that says NULL or what is wrong. When it fails, run_cases drops contours
 * and points from the case as long as it still fails, and prints what is left. ISO_TEST_ONLY=i runs
 * case i alone; ISO_TEST_TRACE=1 names each case before it runs (for crashes). */
#ifndef TESTS_PLANAR_PROPERTY_H
#define TESTS_PLANAR_PROPERTY_H

#include "cases.h"

extern iso_planar_scratch
    *scratch; /* one for the whole program: what one case leaves, the next finds */

typedef const char *property(const planar_case *c);

/* Returns the number of cases that failed. `largest` bounds the coordinates. */
int run_cases(const char *name, property *holds, int64_t usual_count, int32_t largest);

/* Faults, as text in a buffer of their own. */
const char *fault(const char *format, ...) ISO_PRINTF(1, 2);

/* Must this point be inside (1), outside (-1), or may it be either (0)? */
typedef int expectation(const void *context, iso_point p);

/* NULL, or where the result is not as expected. Half of the points are taken near `around`'s edges,
 * the others anywhere; every winding number of the result must be 0 or 1. */
const char *points_fault(const iso_region *result, const iso_region *around, expectation *expected,
                         const void *context, int count);

/* NULL, or how the region is no region: by the kernel, and by the oracle if it is small. */
const char *region_fault(const iso_region *region);

/* NULL, or how cleaning a clean region changes it. */
const char *settled_fault(const iso_region *region);

#endif
