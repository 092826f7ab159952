#include <isoslice/wall.h>

#include <math.h>

#include "base/memory.h"
#include "check.h"
#include "wall/medial.h"

static const double pi = 3.14159265358979323846;
static iso_planar_scratch *scratch;

enum { MM = ISO_UNITS_PER_MM, HEIGHT = 2000, WIDTH = 4500 };

/* ---- places ---- */

static void make_strip(iso_region *region, double length, double width) {
    iso_point c = {iso_units(length), iso_units(width)};
    CHECK_OK(iso_region_add(region, (iso_point[]){{0, 0}, {c.x, 0}, c, {0, c.y}}, 4));
}

/* From no width at x = 0 to `width` at x = length. */
static void make_wedge(iso_region *region, double length, double width) {
    int32_t x = iso_units(length), y = iso_units(width / 2);
    CHECK_OK(iso_region_add(region, (iso_point[]){{0, 0}, {x, -y}, {x, y}}, 3));
}

static void make_annulus(iso_region *region, double inner, double outer) {
    iso_point point[600];
    for (int hole = 0; hole < 2; hole++) {
        for (int i = 0; i < 600; i++) {
            double r = hole ? inner : outer, w = 2 * pi * (hole ? -i : i) / 600;
            point[i] = (iso_point){iso_units(r * cos(w)), iso_units(r * sin(w))};
        }
        CHECK_OK(iso_region_add(region, point, 600));
    }
    region->parent[1] = 0;
}

static iso_gap_options outline(void) {
    iso_bead bead = iso_bead_of(WIDTH, HEIGHT);
    iso_gap_options options = iso_gap_defaults(&bead, HEIGHT);
    options.outline = 1;
    options.most = 7000;
    return options;
}

/* ---- what the paths hold ---- */

typedef struct figures {
    double length, seen, volume; /* mm, mm^2 from above, mm^3 */
    double left, right;          /* mm, of the middles */
} figures;

static figures measure(const iso_paths *paths) {
    figures f = {.left = 1e9, .right = -1e9};
    for (int32_t i = 0; i < paths->count; i++) {
        const iso_path *path = &paths->path[i];
        for (int32_t k = 0; k < path->count; k++) {
            const iso_path_vertex *a = &paths->vertex[path->first + k];
            const iso_path_vertex *b = &paths->vertex[path->first + (k + 1) % path->count];
            double step = hypot((double)b->at.x - a->at.x, (double)b->at.y - a->at.y) / MM;
            f.left = fmin(f.left, iso_mm(a->at.x));
            f.right = fmax(f.right, iso_mm(a->at.x));
            if (k + 1 == path->count && !path->closed)
                break;
            f.length += step;
            f.seen += step * a->width / MM;
            f.volume += step * a->area / MM / MM;
        }
    }
    return f;
}

/* ---- tests ---- */

/* A strip's bead runs along its middle, as wide as it is, to a quarter of that before its ends. */
static void test_strips(void) {
    for (double width = 0.21; width < 0.69; width += 0.06) {
        iso_region region = {0};
        iso_paths paths = {0};
        iso_gap_options options = outline();
        make_strip(&region, 30, width);
        CHECK_OK(iso_gap_fill(&paths, &region, &options, scratch));
        figures f = measure(&paths);
        CHECK_EQUAL(1, paths.count);
        for (int32_t i = 0; i < paths.vertex_count; i++) {
            CHECK_NEAR(width, iso_mm(paths.vertex[i].width), 0.002);
            CHECK_NEAR(width / 2, iso_mm(paths.vertex[i].at.y), 0.001);
        }
        CHECK_NEAR(30 * width, f.seen, 0.012 * 30 * width);
        CHECK_NEAR(width / 4, f.left, 0.02);
        CHECK_NEAR(30 - width / 4, f.right, 0.02);
        CHECK_NEAR(f.length * (iso_mm(HEIGHT) * (width - iso_mm(HEIGHT)) + pi * 0.01), f.volume,
                   0.01 * f.volume);
        iso_region_free(&region);
        iso_paths_free(&paths);
    }
}

/* A wedge's bead follows its width in small steps, from the least width on. */
static void test_wedge(void) {
    iso_region region = {0};
    iso_paths paths = {0};
    iso_gap_options options = outline();
    make_wedge(&region, 30, 0.6);
    CHECK_OK(iso_gap_fill(&paths, &region, &options, scratch));
    figures f = measure(&paths);
    CHECK_EQUAL(1, paths.count);
    CHECK(paths.vertex_count > 8 && paths.vertex_count < 40);
    CHECK_NEAR(10, f.left, 0.3);
    for (int32_t i = 0; i + 1 < paths.vertex_count; i++) {
        const iso_path_vertex *a = &paths.vertex[i], *b = a + 1;
        double wide = 0.02 * (iso_mm(a->at.x) + iso_mm(b->at.x)) / 2;
        CHECK(fabs(iso_mm(a->at.y)) < 0.002);
        CHECK_NEAR(wide, iso_mm(a->width), 0.02 * wide);
    }
    CHECK_NEAR(0.01 * (30 * 30 - 10 * 10), f.seen, 0.01 * 8 + 0.08);
    iso_region_free(&region);
    iso_paths_free(&paths);
}

/* A ring gives one closed bead, and as plastic for a gap what the gap holds. */
static void test_ring(void) {
    for (double width = 0.1; width < 0.7; width += 0.15) {
        iso_region region = {0};
        iso_paths paths = {0};
        iso_bead bead = iso_bead_of(WIDTH, HEIGHT);
        iso_gap_options options = iso_gap_defaults(&bead, WIDTH / 5);
        make_annulus(&region, 5, 5 + width);
        CHECK_OK(iso_gap_fill(&paths, &region, &options, scratch));
        figures f = measure(&paths);
        double area = (double)iso_region_double_area(&region) / 2 / MM / MM;
        CHECK_EQUAL(1, paths.count);
        CHECK(paths.path[0].closed);
        CHECK_EQUAL(ISO_ROLE_GAP_FILL, paths.path[0].role);
        CHECK_NEAR(area * iso_mm(HEIGHT), f.volume, 0.01 * f.volume);
        for (int32_t i = 0; i < paths.vertex_count; i++)
            CHECK_NEAR(5 + width / 2,
                       hypot(iso_mm(paths.vertex[i].at.x), iso_mm(paths.vertex[i].at.y)), 0.005);
        iso_region_free(&region);
        iso_paths_free(&paths);
    }
}

/* The axis itself: widths of a wedge and a ring within 2 %. */
static void test_widths(void) {
    iso_region wedge = {0}, ring = {0};
    iso_medial medial;
    make_wedge(&wedge, 20, 1.2);
    CHECK_OK(medial_axis(&medial, &wedge, 1000, 500, scratch));
    CHECK_EQUAL(1, medial.count);
    double slope = 0.03 / sqrt(1 + 0.03 * 0.03);
    for (int32_t i = 0; i < medial.point_count; i++)
        if (medial.point[i].x < 19 * MM)
            CHECK_NEAR(1, medial.point[i].half / (medial.point[i].x * slope), 0.02);
    make_annulus(&ring, 3, 3.4);
    CHECK_OK(medial_axis(&medial, &ring, 1000, 500, scratch));
    CHECK(medial.count == 1 && medial.line[0].closed);
    for (int32_t i = 0; i < medial.point_count; i++)
        CHECK_NEAR(2000, medial.point[i].half, 40);
    iso_region_free(&wedge);
    iso_region_free(&ring);
}

/* Blades of 0.1 to 1.2 mm: their walls and what the outline is too narrow for cover them. */
static void test_thin_walls(void) {
    for (double width = 0.1; width < 1.25; width += 0.1) {
        iso_region region = {0}, inside = {0};
        iso_paths paths = {0};
        iso_wall_options options = {.count = 2,
                                    .external = iso_bead_of(WIDTH, HEIGHT),
                                    .inner = iso_bead_of(WIDTH, HEIGHT),
                                    .arc_tolerance = 20,
                                    .thin_least = 1333,
                                    .gap_least = 900};
        make_strip(&region, 20, width);
        CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
        if (!CHECK_EQUAL((width > 0.15) + (width > 0.95), paths.count))
            fprintf(stderr, "a blade of %g mm\n", width);
        double half = 0;
        for (int32_t i = 0; i < paths.count; i++) {
            const iso_path *path = &paths.path[i];
            if (path->role == ISO_ROLE_GAP_FILL)
                continue;
            CHECK_EQUAL(width > 0.69, path->closed);
            CHECK(path->role == ISO_ROLE_EXTERNAL_PERIMETER && path->rank == 1);
            for (int32_t k = 0; k < path->count; k++) {
                const iso_path_vertex *v = &paths.vertex[path->first + k];
                half = fmax(half, fabs(iso_mm(v->at.y) - width / 2) + iso_mm(v->width) / 2);
            }
        }
        if (paths.count)
            CHECK_NEAR(width / 2, half, 0.003);
        iso_region_free(&region);
        iso_region_free(&inside);
        iso_paths_free(&paths);
    }
}

/* Between the outermost loops of a strip that the second don't fit into. */
static void test_gap_between_walls(void) {
    iso_region region = {0}, inside = {0};
    iso_paths paths = {0};
    iso_wall_options options = {.count = 2,
                                .external = iso_bead_of(WIDTH, HEIGHT),
                                .inner = iso_bead_of(WIDTH, HEIGHT),
                                .arc_tolerance = 20,
                                .thin_least = 1333,
                                .gap_least = 900};
    make_strip(&region, 20, 1.1);
    CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
    int seen = 0;
    CHECK_EQUAL(2, paths.count);
    for (int32_t i = 0; i < paths.count; i++) {
        const iso_path *path = &paths.path[i];
        double gap = 1.1 - 0.45 - iso_mm(options.external.spacing);
        if (path->role != ISO_ROLE_GAP_FILL)
            continue;
        seen++;
        CHECK(!path->closed && path->rank == 2);
        CHECK_EQUAL(ISO_ROLE_GAP_FILL, paths.vertex[path->first].role);
        CHECK_NEAR(gap * HEIGHT * MM, paths.vertex[path->first].area, 0.02 * gap * HEIGHT * MM);
        CHECK_NEAR(0.55, iso_mm(paths.vertex[path->first].at.y), 0.002);
    }
    CHECK_EQUAL(1, seen);
    iso_region_free(&region);
    iso_region_free(&inside);
    iso_paths_free(&paths);
}

/* Slivers between a ring and the lines in it: two sides so near each other that their pieces cross
 * once they are rounded. */
static void test_sides_that_all_but_touch(void) {
    static const iso_point sliver[][6] = {
        {{-107059, -28686},
         {-103859, -38115},
         {-103796, -37361},
         {-103415, -36648},
         {-102821, -36177},
         {-104374, -36593}},
        {{-38115, 103859},
         {-37361, 103796},
         {-36648, 103415},
         {-36177, 102821},
         {-36593, 104374},
         {-28686, 107059}},
    };
    for (int i = 0; i < 2; i++) {
        iso_region region = {0};
        iso_medial medial;
        CHECK_OK(iso_region_add(&region, sliver[i], 6));
        CHECK_OK(iso_region_validate(&region, scratch));
        CHECK_OK(medial_axis(&medial, &region, 900, 450, scratch));
        for (int32_t k = 0; k < medial.point_count; k++)
            CHECK(medial.point[k].half < 1000);
        iso_region_free(&region);
    }
}

static void test_no_memory(void) {
    iso_region region = {0};
    iso_gap_options options = outline();
    iso_status status = ISO_NO_MEMORY;
    int64_t n = 0;
    make_annulus(&region, 3, 3.5);
    for (; status == ISO_NO_MEMORY && n < 200; n++) {
        iso_paths paths = {0};
        iso_fail_allocation_after(n);
        status = iso_gap_fill(&paths, &region, &options, scratch);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK)
            CHECK(paths.count == 0 && paths.vertex_count == 0);
        iso_paths_free(&paths);
    }
    CHECK_STATUS(ISO_OK, status);
    CHECK(n > 4);
    iso_region_free(&region);
}

int main(void) {
    CHECK_OK(iso_planar_scratch_new(&scratch));
    RUN(test_strips);
    RUN(test_wedge);
    RUN(test_ring);
    RUN(test_widths);
    RUN(test_thin_walls);
    RUN(test_gap_between_walls);
    RUN(test_sides_that_all_but_touch);
    RUN(test_no_memory);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}
