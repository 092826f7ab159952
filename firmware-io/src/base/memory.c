#include "base/memory.h"

#include <stdlib.h>

static int64_t fail_after = -1, made;

int64_t fio_fail_allocation_after(int64_t n) {
    int64_t before = made;
    fail_after = n;
    made = 0;
    return before;
}

void *fio_allocate(size_t size) {
    if (fail_after >= 0) { /* counted only on demand: threads may allocate at once */
        if (made >= fail_after)
            return NULL;
        made++;
    }
    return calloc(1, size ? size : 1);
}

void fio_release(void *block) {
    free(block);
}
