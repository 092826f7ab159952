/* Bytes as contours on a small grid, where everything touches and overlaps: what the kernel makes
 * of them is a region. */
#include "fuzz.h"

#include <isoslice/planar.h>

enum { MOST_POINTS = 64 };

/* Two bytes a point; an x of 255 begins a new contour. */
static void read_contours(iso_region *region, const uint8_t *bytes, size_t size, int32_t step) {
    iso_point point[MOST_POINTS];
    int32_t count = 0;
    for (size_t i = 0; i + 1 < size; i += 2) {
        if (bytes[i] < 255 && count < MOST_POINTS)
            point[count++] = (iso_point){bytes[i] % 32 * step, bytes[i + 1] % 32 * step};
        if (bytes[i] < 255 && i + 3 < size)
            continue;
        if (count > 0)
            fuzz_right(iso_region_add(region, point, count));
        count = 0;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    if (size < 4 || size > 600)
        return 0;
    iso_planar_scratch *scratch = NULL;
    iso_region raw = {0}, clean = {0}, moved = {0}, both = {0};
    fuzz_right(iso_planar_scratch_new(&scratch));
    read_contours(&raw, bytes + 2, size - 2, bytes[0] % 8 < 4 ? 1 : 997);
    fuzz_right(iso_region_clean(&clean, &raw, (iso_fill_rule)(bytes[0] % 3), scratch));
    fuzz_right(iso_region_validate(&clean, scratch));
    iso_offset_options offset = iso_offset_defaults((int32_t)((int8_t)bytes[1]) * 19);
    offset.join = (iso_join)(bytes[0] / 64 % 3);
    fuzz_right(iso_offset(&moved, &clean, &offset, scratch));
    fuzz_right(iso_region_validate(&moved, scratch));
    fuzz_right(iso_boolean(&both, (iso_boolean_kind)(bytes[0] / 16 % 4), &raw, &moved, scratch));
    fuzz_right(iso_region_validate(&both, scratch));
    iso_region_free(&raw);
    iso_region_free(&clean);
    iso_region_free(&moved);
    iso_region_free(&both);
    iso_planar_scratch_free(scratch);
    return 0;
}
