/* Fuzzed entries: any bytes may give any status, but never a crash, a leak or a broken structure.
 */
#ifndef TESTS_FUZZ_H
#define TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <isoslice/status.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* What succeeded must be right. */
static inline void fuzz_right(iso_status status) {
    if (status == ISO_OK)
        return;
    fprintf(stderr, "status %d: %s\n", (int)status, iso_error_message());
    abort();
}

#endif
