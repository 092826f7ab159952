/* The rectilinear fill, on shapes of known area, at many angles. */
#include <isoslice/fill.h>

#include <math.h>

#include "base/memory.h"
#include "check.h"
#include "fill/shapes.h"

static double drawn_volume(const iso_paths *paths) { /* units^3 */
    double volume = 0;
    for (int i = 0; i < paths->count; i++) {
        const iso_path_vertex *vertex = paths->vertex + paths->path[i].first;
        for (int k = 0; k + 1 < paths->path[i].count; k++)
            volume +=
                hypot(vertex[k + 1].at.x - vertex[k].at.x, vertex[k + 1].at.y - vertex[k].at.y) *
                vertex[k].area;
    }
    return volume;
}

static double perimeter(const iso_region *region) {
    double length = 0;
    for (int i = 0; i < region->count; i++)
        for (int a = region->first[i + 1] - 1, b = region->first[i]; b < region->first[i + 1];
             a = b++)
            length += hypot(region->point[b].x - region->point[a].x,
                            region->point[b].y - region->point[a].y);
    return length;
}

/* A solid fill of a region holds what the region, grown by half a spacing, does. */
static void test_volume(void) {
    iso_arena scratch = {0};
    for (int i = 0; i < shape_count; i++)
        for (double angle = 0; angle < 180; angle += 15) {
            iso_region region = {0};
            iso_paths paths = {0};
            shapes[i].make(&region, 0);
            iso_bead bead = iso_bead_of(4500, 2000);
            iso_fill_options options = iso_fill_defaults(bead, 1);
            options.angle = angle;
            CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
            double whole = region_area(&region) + perimeter(&region) * bead.spacing / 2;
            double tolerance = strcmp(shapes[i].name, "comb") ? 0.01 : 0.07;
            CHECK_NEAR(1, drawn_volume(&paths) / (whole * bead.height), tolerance);
            iso_paths_free(&paths);
            drop_region(&region);
        }
    iso_arena_free(&scratch);
}

int main(void) {
    RUN(test_volume);
    return check_verdict();
}
