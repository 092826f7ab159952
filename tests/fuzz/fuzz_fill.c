/* Bytes as contours on a small grid, cleaned and filled with every pattern: all that is drawn stays
 * within the region. Builds that check themselves validate each link besides. */
#include "fuzz.h"

#include <math.h>

#include <isoslice/fill.h>

enum { MOST_POINTS = 64, HEADER = 6 };

/* Two bytes a point; an x of 255 begins a new contour. */
static void read_contours(iso_region *region, const uint8_t *bytes, size_t size, int32_t step) {
    iso_point point[MOST_POINTS];
    int32_t count = 0;
    for (size_t i = 0; i + 1 < size; i += 2) {
        if (bytes[i] < 255 && count < MOST_POINTS)
            point[count++] =
                (iso_point){(bytes[i] % 32 - 16) * step, (bytes[i + 1] % 32 - 16) * step};
        if (bytes[i] < 255 && i + 3 < size)
            continue;
        if (count > 0)
            fuzz_right(iso_region_add(region, point, count));
        count = 0;
    }
}

/* Inside, or no further than two units from an edge: tips may be thinner than a unit. */
static int is_near(const iso_region *region, iso_point p) {
    if (iso_region_locate(region, p) >= 0)
        return 1;
    for (int32_t m = 0; m < region->count; m++)
        for (int32_t i = region->first[m], last = region->first[m + 1] - 1;
             i < region->first[m + 1]; last = i++) {
            iso_point a = region->point[last], b = region->point[i];
            double dx = b.x - a.x, dy = b.y - a.y, px = p.x - a.x, py = p.y - a.y;
            double t = (px * dx + py * dy) / (dx * dx + dy * dy);
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            if (hypot(px - t * dx, py - t * dy) <= 2)
                return 1;
        }
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    if (size < HEADER + 4 || size > 400)
        return 0;
    iso_planar_scratch *scratch = NULL;
    iso_region raw = {0}, clean = {0};
    iso_paths paths = {0};
    int solid = bytes[0] & 128;
    iso_fill_options options =
        iso_fill_defaults(iso_bead_of(4500, 2000), solid ? 1 : (bytes[1] + 10) / 270.0);
    fuzz_right(iso_planar_scratch_new(&scratch));
    read_contours(&raw, bytes + HEADER, size - HEADER, bytes[0] & 64 ? 1 << 12 : 1999);
    fuzz_right(iso_region_clean(&clean, &raw, ISO_FILL_NONZERO, scratch));
    options.pattern = bytes[0] % ISO_PATTERN_COUNT;
    options.layer = bytes[2];
    options.z = bytes[2] * 317;
    options.angle = bytes[3] % 4 ? bytes[3] * 1.7 : 45 * (bytes[3] / 4);
    options.origin = bytes[4] % 2 ? (iso_point){0, 0} : (iso_point){bytes[4] * 4001, -70000};
    options.link_max = bytes[5] * 1000;
    options.anchor = bytes[4] * 300;
    options.fit = 0; /* fitted lines may reach beyond */
    options.deviation = 0;
    fuzz_right(iso_fill(&paths, &clean, &options, NULL, scratch));
    for (int32_t i = 0; i < paths.vertex_count; i++)
        if (!is_near(&clean, paths.vertex[i].at)) {
            fprintf(stderr, "(%d, %d) is outside\n", paths.vertex[i].at.x, paths.vertex[i].at.y);
            abort();
        }
    iso_paths_free(&paths);
    iso_region_free(&raw);
    iso_region_free(&clean);
    iso_planar_scratch_free(scratch);
    return 0;
}
