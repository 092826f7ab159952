/* Cells that are made again, and cells that there's no memory for. */
#include "base/memory.h"
#include "check.h"
#include "lattice/cell.h"

static iso_lattice_options options_of(int32_t pattern) {
    iso_lattice_options options = iso_lattice_defaults();
    options.pattern = pattern;
    options.seed = 7;
    return options;
}

/* Twice the same, and another seed gives another structure of what is random, of nothing else. */
static void test_determinism(void) {
    static const int32_t patterns[] = {ISO_LATTICE_GYROID_SOLID, ISO_LATTICE_BCC_STRUTS,
                                       ISO_LATTICE_FOAM_SHEET, ISO_LATTICE_BONE_SHEET};
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
        iso_lattice_options options = options_of(patterns[i]), other = options;
        other.seed = 8;
        iso_lattice_cell a, b, c;
        if (!CHECK_OK(cell_make(&a, &options)) || !CHECK_OK(cell_make(&b, &options)) ||
            !CHECK_OK(cell_make(&c, &other)))
            return;
        size_t bytes = (size_t)a.size[0] * a.size[1] * a.size[2] * sizeof(float);
        CHECK(memcmp(a.distance, b.distance, bytes) == 0);
        CHECK(memcmp(a.level, b.level, sizeof a.level) == 0);
        CHECK((memcmp(a.distance, c.distance, bytes) != 0) == (i >= 2));
        cell_free(&a);
        cell_free(&b);
        cell_free(&c);
    }
}

static void test_no_memory(void) {
    static const int32_t patterns[] = {ISO_LATTICE_GYROID_SHEET, ISO_LATTICE_OCTET_STRUTS,
                                       ISO_LATTICE_FOAM_SHEET, ISO_LATTICE_VOXEL_RANDOM};
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
        iso_lattice_options options = options_of(patterns[i]);
        iso_lattice_cell cell;
        iso_fail_allocation_after(INT32_MAX);
        if (!CHECK_OK(cell_make(&cell, &options)))
            return;
        cell_free(&cell);
        int64_t count = iso_fail_allocation_after(-1), step = count / 8 + 1;
        CHECK(count > 2);
        for (int64_t n = 0; n < count; n += step) {
            iso_fail_allocation_after(n);
            iso_status status = cell_make(&cell, &options);
            iso_fail_allocation_after(-1);
            CHECK_EQUAL(ISO_NO_MEMORY, status);
            CHECK(cell.distance == NULL);
        }
    }
}

int main(void) {
    RUN(test_determinism);
    RUN(test_no_memory);
    return check_verdict();
}
