#include <isoslice/wall.h>

#include <math.h>

#include "base/memory.h"
#include "check.h"

static const double pi = 3.14159265358979323846;
static iso_planar_scratch *scratch;

enum { MM = ISO_UNITS_PER_MM, TOLERANCE = 10 };

/* ---- outlines ---- */

static void add_ring(iso_region *region, double x, double y, double r, int32_t corners, int hole) {
    iso_point point[512];
    for (int32_t i = 0; i < corners; i++) {
        double w = 2 * pi * (hole ? corners - i : i) / corners;
        point[i] = (iso_point){iso_units(x + r * cos(w)), iso_units(y + r * sin(w))};
    }
    CHECK_OK(iso_region_add(region, point, corners));
}

static void add_box(iso_region *region, double x0, double y0, double x1, double y1, int hole) {
    iso_point a = {iso_units(x0), iso_units(y0)}, c = {iso_units(x1), iso_units(y1)};
    iso_point box[2][4] = {{a, {c.x, a.y}, c, {a.x, c.y}}, {a, {a.x, c.y}, c, {c.x, a.y}}};
    CHECK_OK(iso_region_add(region, box[hole], 4));
}

static void make_square(iso_region *region) {
    add_box(region, -10, -10, 10, 10, 0);
}

/* Radii 12 and 5. */
static void make_annulus(iso_region *region) {
    add_ring(region, 3, -2, 12, 256, 0);
    add_ring(region, 3, -2, 5, 128, 1);
    region->parent[1] = 0;
}

/* An L with two holes: corners that open up inwards and outwards. */
static void make_bracket(iso_region *region) {
    const iso_point outline[] = {{0, 0},           {20 * MM, 0},      {20 * MM, 7 * MM},
                                 {7 * MM, 7 * MM}, {7 * MM, 20 * MM}, {0, 20 * MM}};
    CHECK_OK(iso_region_add(region, outline, 6));
    add_box(region, 14, 2.5, 16.5, 4.5, 1);
    add_ring(region, 3.5, 15, 1.2, 40, 1);
    region->parent[1] = region->parent[2] = 0;
}

/* Five sharp tips. */
static void make_star(iso_region *region) {
    iso_point point[10];
    for (int i = 0; i < 10; i++) {
        double r = i % 2 ? 5 : 12, w = pi * i / 5;
        point[i] = (iso_point){iso_units(r * cos(w)), iso_units(r * sin(w))};
    }
    CHECK_OK(iso_region_add(region, point, 10));
}

typedef void make_outline(iso_region *region);
static make_outline *const outlines[] = {make_square, make_annulus, make_bracket, make_star};
enum { OUTLINES = sizeof outlines / sizeof *outlines };

static iso_wall_options usual(int32_t count) {
    return (iso_wall_options){.count = count,
                              .external = iso_bead_of(4200, 2000),
                              .inner = iso_bead_of(4500, 2000),
                              .small_length = 40 * MM,
                              .fill_inset = 0,
                              .arc_tolerance = TOLERANCE,
                              .like = {.object = 3, .group = 7, .tool = 1}};
}

/* ---- measuring ---- */

static double distance_to_segment(double x, double y, iso_point a, iso_point b) {
    double ux = (double)b.x - a.x, uy = (double)b.y - a.y, vx = x - a.x, vy = y - a.y;
    double t = (ux * vx + uy * vy) / (ux * ux + uy * uy);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return hypot(vx - t * ux, vy - t * uy);
}

static double distance_to_outline(double x, double y, const iso_region *region) {
    double least = 1e18;
    for (int32_t c = 0; c < region->count; c++)
        for (int32_t i = region->first[c]; i < region->first[c + 1]; i++) {
            int32_t next = i + 1 < region->first[c + 1] ? i + 1 : region->first[c];
            least = fmin(least, distance_to_segment(x, y, region->point[i], region->point[next]));
        }
    return least;
}

static double doubled_area(const iso_paths *paths, const iso_path *path) {
    double sum = 0;
    for (int32_t i = 0; i < path->count; i++) {
        iso_point a = paths->vertex[path->first + i].at;
        iso_point b = paths->vertex[path->first + (i + 1) % path->count].at;
        sum += (double)a.x * b.y - (double)b.x * a.y;
    }
    return sum;
}

static double length_of(const iso_paths *paths, const iso_path *path) {
    double sum = 0;
    for (int32_t i = 0; i < path->count; i++) {
        iso_point a = paths->vertex[path->first + i].at;
        iso_point b = paths->vertex[path->first + (i + 1) % path->count].at;
        sum += hypot((double)b.x - a.x, (double)b.y - a.y);
    }
    return sum;
}

static double area_of(const iso_region *region) {
    return (double)iso_region_double_area(region) / 2 / MM / MM;
}

/* Wall k's middle: half a full width inside the outline, then spacings. */
static double depth_of(const iso_wall_options *options, int32_t wall) {
    double depth = options->external.width / 2.0;
    for (int32_t w = 1; w <= wall; w++)
        depth += (w == 1 ? (options->external.spacing + options->inner.spacing) / 2.0
                         : options->inner.spacing);
    return depth;
}

static int32_t wall_of(const iso_wall_options *options, const iso_path *path) {
    return options->external_first ? path->rank : options->count - 1 - path->rank;
}

/* ---- tests ---- */

/* A stadium by its own figures: rectangle and circle. */
static void test_flow(void) {
    for (int32_t height = 500; height <= 4000; height += 350)
        for (int32_t width = height; width <= 12000; width += 770) {
            iso_bead bead = iso_bead_of(width, height);
            double h = height, w = width, area = (w - h) * h + pi * h * h / 4;
            CHECK_EQUAL(width, bead.width);
            CHECK_EQUAL(height, bead.height);
            CHECK_NEAR(area, bead.area, 0.51);
            CHECK_NEAR(area / h, bead.spacing, 0.51);
        }
}

/* How far the walls of one count are from where they ought to be, every point and every middle of
 * a segment; each inset rounds to a unit and turns corners within the arc tolerance. */
static void check_depths(const iso_region *region, const iso_wall_options *options) {
    iso_paths paths = {0};
    iso_region inside = {0};
    double worst = 0;
    CHECK_OK(iso_walls(&paths, &inside, region, options, scratch));
    CHECK(paths.count > 0);
    for (int32_t i = 0; i < paths.count; i++) {
        const iso_path *path = &paths.path[i];
        int32_t wall = wall_of(options, path);
        const iso_bead *bead = wall == 0 ? &options->external : &options->inner;
        double allowed = (TOLERANCE + 2) * (wall + 1), depth = depth_of(options, wall);
        CHECK(path->closed && path->count >= 3);
        CHECK_EQUAL(wall == 0 ? ISO_ROLE_EXTERNAL_PERIMETER : ISO_ROLE_PERIMETER, path->role);
        CHECK(path->object == 3 && path->group == 7 && path->tool == 1);
        for (int32_t k = 0; k < path->count; k++) {
            const iso_path_vertex *v = &paths.vertex[path->first + k];
            iso_point b = paths.vertex[path->first + (k + 1) % path->count].at;
            CHECK(v->width == bead->width && v->area == bead->area && v->z == 0);
            for (int half = 0; half < 2; half++) {
                double x = half ? (v->at.x + b.x) / 2.0 : v->at.x;
                double y = half ? (v->at.y + b.y) / 2.0 : v->at.y;
                double off = fabs(distance_to_outline(x, y, region) - depth);
                worst = fmax(worst, off / allowed);
                CHECK(iso_region_locate(region, (iso_point){(int32_t)x, (int32_t)y}) > 0);
            }
        }
    }
    CHECK(worst <= 1);
    CHECK_OK(iso_region_validate(&inside, scratch));
    iso_paths_free(&paths);
    iso_region_free(&inside);
}

static void test_depths(void) {
    for (int o = 0; o < OUTLINES; o++)
        for (int first = 0; first < 2; first++) {
            iso_region region = {0};
            iso_wall_options options = usual(4);
            options.external_first = first;
            outlines[o](&region);
            check_depths(&region, &options);
            iso_region_free(&region);
        }
}

/* Straight sides are exact: two roundings of a unit each at most. */
static void test_square_exactly(void) {
    iso_region region = {0}, inside = {0};
    iso_paths paths = {0};
    iso_wall_options options = usual(3);
    make_square(&region);
    CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
    CHECK_EQUAL(3, paths.count);
    for (int32_t i = 0; i < paths.count; i++) {
        const iso_path *path = &paths.path[i];
        double half = 10 * MM - depth_of(&options, wall_of(&options, path));
        CHECK_EQUAL(4, path->count);
        for (int32_t k = 0; k < 4; k++) {
            iso_point p = paths.vertex[path->first + k].at;
            CHECK_NEAR(half, fabs((double)p.x), 2);
            CHECK_NEAR(half, fabs((double)p.y), 2);
        }
        CHECK_NEAR(8 * half * half, doubled_area(&paths, path), 64.0 * half);
    }
    double left = 10 * MM - depth_of(&options, 2) - options.inner.spacing / 2.0;
    CHECK_NEAR(4 * left * left / MM / MM, area_of(&inside), 1e-2);
    iso_region_free(&region);
    iso_region_free(&inside);
    iso_paths_free(&paths);
}

static void test_annulus(void) {
    iso_region region = {0}, inside = {0};
    iso_paths paths = {0};
    iso_wall_options options = usual(3);
    make_annulus(&region);
    CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
    CHECK_EQUAL(6, paths.count);
    int outer = 0, holes = 0;
    for (int32_t i = 0; i < paths.count; i++) {
        const iso_path *path = &paths.path[i];
        double turned = doubled_area(&paths, path) / 2, r = sqrt(fabs(turned) / pi);
        double depth = depth_of(&options, wall_of(&options, path));
        *(turned > 0 ? &outer : &holes) += 1;
        CHECK_NEAR(turned > 0 ? 12 * MM - depth : 5 * MM + depth, r, 40);
        CHECK_NEAR(2 * pi * r, length_of(&paths, path), 0.001 * r);
    }
    CHECK(outer == 3 && holes == 3);
    double depth = (depth_of(&options, 2) + options.inner.spacing / 2.0) / MM;
    CHECK_NEAR(pi * ((12 - depth) * (12 - depth) - (5 + depth) * (5 + depth)), area_of(&inside),
               0.2);
    CHECK_EQUAL(2, inside.count);
    iso_region_free(&region);
    iso_region_free(&inside);
    iso_paths_free(&paths);
}

/* Ranks count in printing order; paths of a rank are one wall. */
static void test_ranks(void) {
    for (int32_t count = 1; count <= 4; count++)
        for (int first = 0; first < 2; first++) {
            iso_region region = {0}, inside = {0};
            iso_paths paths = {0};
            iso_wall_options options = usual(count);
            int32_t seen[4] = {0};
            options.external_first = first;
            make_square(&region);
            CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
            CHECK_EQUAL(count, paths.count);
            for (int32_t i = 0; i < paths.count; i++) {
                const iso_path *path = &paths.path[i];
                double depth = 10 * MM - length_of(&paths, path) / 8;
                int32_t wall = (int32_t)lround((depth - 2100) / options.inner.spacing);
                CHECK_EQUAL(first ? wall : count - 1 - wall, path->rank);
                CHECK_EQUAL(wall == 0, path->role == ISO_ROLE_EXTERNAL_PERIMETER);
                seen[path->rank]++;
            }
            for (int32_t r = 0; r < count; r++)
                CHECK_EQUAL(1, seen[r]);
            iso_region_free(&region);
            iso_region_free(&inside);
            iso_paths_free(&paths);
        }
}

/* Loops up to the length are small, longer ones aren't: 40 mm at the outermost wall of a square. */
static void test_small_perimeters(void) {
    for (int larger = 0; larger < 2; larger++) {
        iso_region region = {0}, inside = {0};
        iso_paths paths = {0};
        iso_wall_options options = usual(1);
        double half = 5 + 0.21 + 0.001 * larger;
        add_box(&region, -half, -half, half, half, 0);
        CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
        CHECK_EQUAL(1, paths.count);
        CHECK_EQUAL(!larger, paths.path[0].speed_class);
        iso_region_free(&region);
        iso_region_free(&inside);
        iso_paths_free(&paths);
    }
    iso_region region = {0}, inside = {0};
    iso_paths paths = {0};
    iso_wall_options options = usual(2);
    make_annulus(&region); /* the hole is small, what is around it isn't */
    options.small_length = 45 * MM;
    CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
    for (int32_t i = 0; i < paths.count; i++)
        CHECK_EQUAL(doubled_area(&paths, &paths.path[i]) < 0, paths.path[i].speed_class);
    iso_region_free(&region);
    iso_region_free(&inside);
    iso_paths_free(&paths);
}

/* A strip holds as many walls as it is wide for, and then neither more nor a fill. */
static void test_narrow_parts(void) {
    static const struct {
        double width;
        int32_t walls;
        int fill;
    } strip[] = {{0.41, 0, 0}, {0.43, 1, 0}, {1.1, 1, 1}, {1.3, 2, 0}, {2.02, 2, 1}, {2.1, 3, 0}};
    for (int i = 0; i < 6; i++) {
        iso_region region = {0}, inside = {0};
        iso_paths paths = {0};
        iso_wall_options options = usual(5);
        if (strip[i].fill)
            options.count = strip[i].walls;
        add_box(&region, 0, 0, strip[i].width, 30, 0);
        CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
        CHECK_EQUAL(strip[i].walls, paths.count);
        CHECK_EQUAL(strip[i].fill, inside.count);
        iso_region_free(&region);
        iso_region_free(&inside);
        iso_paths_free(&paths);
    }
}

/* The second wall of a square that is hardly wide enough for it is a dot, and not drawn. */
static void test_dots_are_left_out(void) {
    static const struct {
        double side;
        int32_t walls;
    } box[] = {{1.205, 1}, {1.3, 1}, {1.35, 2}, {1.6, 2}};
    for (int i = 0; i < 4; i++) {
        iso_region region = {0}, inside = {0};
        iso_paths paths = {0};
        iso_wall_options options = usual(2);
        add_box(&region, 0, 0, box[i].side, box[i].side, 0);
        CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
        CHECK_EQUAL(box[i].walls, paths.count);
        for (int32_t k = 0; k < paths.count; k++)
            CHECK(length_of(&paths, &paths.path[k]) > paths.vertex[paths.path[k].first].width);
        iso_region_free(&region);
        iso_region_free(&inside);
        iso_paths_free(&paths);
    }
}

/* A dumb-bell falls in two where the bar is too narrow. */
static void test_parts_come_apart(void) {
    iso_region region = {0}, inside = {0};
    iso_paths paths = {0};
    iso_wall_options options = usual(1);
    const iso_point outline[] = {
        {0, 0},           {6 * MM, 0},     {6 * MM, 28000},   {12 * MM, 28000},
        {12 * MM, 0},     {18 * MM, 0},    {18 * MM, 6 * MM}, {12 * MM, 6 * MM},
        {12 * MM, 32000}, {6 * MM, 32000}, {6 * MM, 6 * MM},  {0, 6 * MM}};
    CHECK_OK(iso_region_add(&region, outline, 12));
    CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
    CHECK_EQUAL(2, paths.count);
    CHECK_EQUAL(2, inside.count);
    CHECK_NEAR(4 * (6 - 0.42), length_of(&paths, &paths.path[0]) / MM, 0.3);
    iso_region_free(&region);
    iso_region_free(&inside);
    iso_paths_free(&paths);
}

/* More inset leaves less; below zero the fill reaches into the walls; without walls it starts from
 * the outline. */
static void test_fill_inset(void) {
    iso_region region = {0}, inside = {0};
    iso_paths paths = {0};
    make_square(&region);
    for (int32_t count = 0; count <= 2; count++)
        for (int32_t inset = -1000; inset <= 1000; inset += 500) {
            iso_wall_options options = usual(count);
            options.fill_inset = inset;
            iso_paths_clear(&paths);
            CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
            CHECK_EQUAL(count, paths.count);
            double depth = inset;
            if (count > 0)
                depth += depth_of(&options, count - 1) +
                         (count == 1 ? options.external.spacing : options.inner.spacing) / 2.0;
            double half = 10 - depth / MM, corner = (4 - pi) * (inset < 0 ? 0.01 : 0);
            CHECK_NEAR(4 * half * half, area_of(&inside), 0.02 + corner);
        }
    iso_region_free(&region);
    iso_region_free(&inside);
    iso_paths_free(&paths);
}

/* Walls are added to what is there, and no region gives none. */
static void test_appends(void) {
    iso_region region = {0}, inside = {0}, nothing = {0};
    iso_paths paths = {0};
    iso_wall_options options = usual(2);
    make_square(&region);
    CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
    CHECK_OK(iso_walls(&paths, &inside, &region, &options, scratch));
    CHECK_EQUAL(4, paths.count);
    CHECK_EQUAL(16, paths.vertex_count);
    CHECK_OK(iso_walls(&paths, &inside, &nothing, &options, scratch));
    CHECK_EQUAL(4, paths.count);
    CHECK_EQUAL(0, inside.count);
    iso_region_free(&region);
    iso_region_free(&inside);
    iso_paths_free(&paths);
}

static void test_no_memory(void) {
    iso_region region = {0};
    iso_wall_options options = usual(3);
    make_bracket(&region);
    iso_status status = ISO_NO_MEMORY;
    int64_t n = 0;
    for (; status == ISO_NO_MEMORY && n < 1000; n++) {
        iso_region inside = {0};
        iso_paths paths = {0};
        iso_planar_scratch *own;
        CHECK_OK(iso_planar_scratch_new(&own));
        iso_fail_allocation_after(n);
        status = iso_walls(&paths, &inside, &region, &options, own);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK)
            CHECK(paths.count == 0 && paths.vertex_count == 0 && inside.count == 0);
        iso_planar_scratch_free(own);
        iso_region_free(&inside);
        iso_paths_free(&paths);
    }
    CHECK_STATUS(ISO_OK, status);
    CHECK(n > 10);
    iso_region_free(&region);
}

int main(void) {
    CHECK_OK(iso_planar_scratch_new(&scratch));
    RUN(test_flow);
    RUN(test_depths);
    RUN(test_square_exactly);
    RUN(test_annulus);
    RUN(test_ranks);
    RUN(test_small_perimeters);
    RUN(test_narrow_parts);
    RUN(test_dots_are_left_out);
    RUN(test_parts_come_apart);
    RUN(test_fill_inset);
    RUN(test_appends);
    RUN(test_no_memory);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}
