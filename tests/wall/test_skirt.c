#include <isoslice/skirt.h>

#include <math.h>

#include "base/memory.h"
#include "check.h"

static const double pi = 3.14159265358979323846;
static iso_planar_scratch *scratch;

enum { MM = ISO_UNITS_PER_MM };

/* Two boxes and a notched one: concave together, with the hull's corners known. */
static const iso_point boxes[3][8] = {
    {{0, 0}, {8 * MM, 0}, {8 * MM, 6 * MM}, {0, 6 * MM}},
    {{20 * MM, 10 * MM}, {26 * MM, 10 * MM}, {26 * MM, 18 * MM}, {20 * MM, 18 * MM}},
    {{2 * MM, 12 * MM},
     {10 * MM, 12 * MM},
     {10 * MM, 20 * MM},
     {7 * MM, 20 * MM},
     {7 * MM, 14 * MM},
     {5 * MM, 14 * MM},
     {5 * MM, 20 * MM},
     {2 * MM, 20 * MM}},
};
static const iso_point hull[] = {{0, 0},
                                 {8 * MM, 0},
                                 {26 * MM, 10 * MM},
                                 {26 * MM, 18 * MM},
                                 {10 * MM, 20 * MM},
                                 {2 * MM, 20 * MM},
                                 {0, 6 * MM}};
enum { CORNERS = sizeof hull / sizeof *hull };

static void make_boxes(iso_region *region) {
    CHECK_OK(iso_region_add(region, boxes[0], 4));
    CHECK_OK(iso_region_add(region, boxes[1], 4));
    CHECK_OK(iso_region_add(region, boxes[2], 8));
}

static double distance_to_hull(iso_point p) {
    double least = 1e18;
    for (int i = 0; i < CORNERS; i++) {
        iso_point a = hull[i], b = hull[(i + 1) % CORNERS];
        double ux = (double)b.x - a.x, uy = (double)b.y - a.y;
        double vx = (double)p.x - a.x, vy = (double)p.y - a.y;
        double t = fmin(1, fmax(0, (ux * vx + uy * vy) / (ux * ux + uy * uy)));
        least = fmin(least, hypot(vx - t * ux, vy - t * uy));
    }
    return least;
}

static double hull_length(void) {
    double sum = 0;
    for (int i = 0; i < CORNERS; i++)
        sum += hypot((double)hull[(i + 1) % CORNERS].x - hull[i].x,
                     (double)hull[(i + 1) % CORNERS].y - hull[i].y);
    return sum;
}

/* Every loop is the convex hull grown by its distance, the outermost printed first. */
static void test_loops(void) {
    iso_region region = {0};
    iso_paths paths = {0};
    iso_bead bead = iso_bead_of(6000, 3000);
    int32_t distance = 5 * MM;
    make_boxes(&region);
    CHECK_OK(iso_skirt(&paths, &region,
                       &(iso_skirt_options){.loops = 3, .distance = distance, .bead = bead},
                       scratch));
    CHECK_EQUAL(3, paths.count);
    for (int32_t i = 0; i < paths.count; i++) {
        const iso_path *path = &paths.path[i];
        double away = distance + i * (double)bead.spacing, length = 0, turned = 0;
        CHECK_EQUAL(2 - i, path->rank);
        CHECK_EQUAL(ISO_ROLE_SKIRT, path->role);
        CHECK(path->closed);
        for (int32_t k = 0; k < path->count; k++) {
            const iso_path_vertex *v = &paths.vertex[path->first + k];
            iso_point b = paths.vertex[path->first + (k + 1) % path->count].at;
            CHECK_NEAR(away, distance_to_hull(v->at), 52);
            CHECK(v->width == bead.width && v->area == bead.area);
            length += hypot((double)b.x - v->at.x, (double)b.y - v->at.y);
            turned += (double)v->at.x * b.y - (double)b.x * v->at.y;
        }
        CHECK_NEAR(hull_length() + 2 * pi * away, length, 0.002 * length);
        CHECK(turned > 0);
    }
    iso_region_free(&region);
    iso_paths_free(&paths);
}

static void test_none(void) {
    iso_region region = {0};
    iso_paths paths = {0};
    iso_bead bead = iso_bead_of(6000, 3000);
    CHECK_OK(iso_skirt(&paths, &region,
                       &(iso_skirt_options){.loops = 3, .distance = 100, .bead = bead}, scratch));
    CHECK_EQUAL(0, paths.count);
    make_boxes(&region);
    CHECK_OK(
        iso_skirt(&paths, &region, &(iso_skirt_options){.distance = 100, .bead = bead}, scratch));
    CHECK_EQUAL(0, paths.count);
    iso_region_free(&region);
    iso_paths_free(&paths);
}

static void test_no_memory(void) {
    iso_region region = {0};
    iso_bead bead = iso_bead_of(6000, 3000);
    iso_status status = ISO_NO_MEMORY;
    int64_t n = 0;
    make_boxes(&region);
    for (; status == ISO_NO_MEMORY && n < 1000; n++) {
        iso_paths paths = {0};
        iso_planar_scratch *own;
        CHECK_OK(iso_planar_scratch_new(&own));
        iso_fail_allocation_after(n);
        status = iso_skirt(&paths, &region,
                           &(iso_skirt_options){.loops = 2, .distance = 3 * MM, .bead = bead}, own);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK)
            CHECK(paths.count == 0 && paths.vertex_count == 0);
        iso_planar_scratch_free(own);
        iso_paths_free(&paths);
    }
    CHECK_STATUS(ISO_OK, status);
    CHECK(n > 5);
    iso_region_free(&region);
}

int main(void) {
    CHECK_OK(iso_planar_scratch_new(&scratch));
    RUN(test_loops);
    RUN(test_none);
    RUN(test_no_memory);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}
