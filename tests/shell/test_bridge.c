/* Directions of bridges, and walls over air, against what is known of simple places. */
#include <math.h>

#include <isoslice/shell.h>

#include "base/memory.h"
#include "check.h"
#include "shell/mask.h"
#include "shell/rows.h"

static iso_planar_scratch *scratch;

enum { MM = ISO_UNITS_PER_MM };
#define PI 3.14159265358979323846

typedef struct turned {
    double sine, cosine;
} turned;

static iso_point turn(turned t, double x, double y) {
    return (iso_point){iso_units(t.cosine * x - t.sine * y), iso_units(t.sine * x + t.cosine * y)};
}

static void add_box(iso_region *region, turned t, const double box[4], int hole) {
    iso_point p[] = {turn(t, box[0], box[1]), turn(t, box[2], box[1]), turn(t, box[2], box[3]),
                     turn(t, box[0], box[3])};
    iso_point q[] = {p[0], p[3], p[2], p[1]};
    CHECK_OK(iso_region_add(region, hole ? q : p, 4));
    region->parent[region->count - 1] = hole ? 0 : -1;
}

static uint64_t seed = 7;

static double random_between(double low, double high) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 33) / 2147483648.0;
}

/* ---- directions ---- */

static double between_directions(double a, double b) {
    double d = fmod(fabs(a - b), 180);
    return d < 90 ? d : 180 - d;
}

/* A part and boxes that carry it, turned by any angle: lines run `expected` degrees from there. */
static void check_angle(const double part[4], const double support[][4], int supports, int holes,
                        double expected, double tolerance) {
    for (int trial = 0; trial < 12; trial++) {
        double degrees = trial == 0 ? 0 : random_between(0, 180);
        turned t = {sin(degrees * PI / 180), cos(degrees * PI / 180)};
        iso_region bridge = {0}, carrier = {0};
        double angle, usual = random_between(0, 180);
        add_box(&bridge, t, part, 0);
        for (int i = 0; i < supports; i++)
            add_box(&carrier, t, support[i], i >= supports - holes);
        CHECK_OK(iso_bridge_angle(&angle, &bridge, &carrier, usual, scratch));
        CHECK(angle >= 0 && angle < 180);
        if (!CHECK(between_directions(angle, degrees + expected) <= tolerance))
            fprintf(stderr, "    %.2f, not %.2f\n", angle, fmod(degrees + expected, 180));
        iso_region_free(&bridge);
        iso_region_free(&carrier);
    }
}

static void test_across_the_gap_of_a_table(void) {
    const double part[] = {-11, -6, 11, 6};
    const double pillars[][4] = {{-20, -6, -10, 6}, {10, -6, 20, 6}};
    check_angle(part, pillars, 2, 0, 0, 1);
    const double wide[] = {-3, -30, 3, 30}; /* much wider than the gap */
    const double walls[][4] = {{-20, -30, -2, 30}, {2, -30, 20, 30}};
    check_angle(wide, walls, 2, 0, 0, 1);
}

static void test_away_from_the_wall_of_a_ledge(void) {
    const double part[] = {-1, -20, 7, 20};
    const double wall[][4] = {{-20, -20, 0, 20}};
    check_angle(part, wall, 1, 0, 0, 6); /* a few more lines are held if they run askew */
    const double far[] = {-1, -3, 15, 3};
    const double narrow[][4] = {{-20, -3, 0, 3}};
    check_angle(far, narrow, 1, 0, 0, 0.5);
}

static void test_the_short_way_over_a_pit(void) {
    const double part[] = {-16, -6, 16, 6};
    const double rim[][4] = {{-25, -15, 25, 15}, {-15, -5, 15, 5}};
    check_angle(part, rim, 2, 1, 90, 0.5);
}

/* Walls along two sides of a corner: lines that lean on both. */
static void test_across_a_corner(void) {
    const double part[] = {-1, -1, 10, 10};
    const double walls[][4] = {{-5, -5, 0, 10}, {0, -5, 10, 0}};
    check_angle(part, walls, 2, 0, 135, 30);
}

static void test_usual_where_all_are_alike(void) {
    iso_region disc = {0}, nothing = {0}, plate = {0};
    iso_point rim[120];
    double angle;
    turned straight = {0, 1};
    for (int i = 0; i < 120; i++)
        rim[i] = (iso_point){iso_units(8 * cos(i * PI / 60)), iso_units(8 * sin(i * PI / 60))};
    CHECK_OK(iso_region_add(&disc, rim, 120));
    add_box(&plate, straight, (double[]){-20, -20, 20, 20}, 0);
    CHECK_OK(iso_bridge_angle(&angle, &disc, &nothing, 33, scratch)); /* held nowhere */
    CHECK(angle == 33);
    CHECK_OK(iso_bridge_angle(&angle, &disc, &plate, 33, scratch)); /* not over air at all */
    CHECK(angle == 33);
    for (int i = 0; i < 60; i++) {
        iso_point swap = rim[i];
        rim[i] = rim[119 - i];
        rim[119 - i] = swap;
    }
    CHECK_OK(iso_region_add(&plate, rim, 120));
    plate.parent[1] = 0;
    CHECK_OK(iso_bridge_angle(&angle, &disc, &plate, 33, scratch)); /* over a round pit */
    CHECK(angle == 33);
    iso_region_free(&disc);
    iso_region_free(&plate);
}

/* ---- overhangs ---- */

static double distance_to(const iso_region *region, double x, double y) {
    double least = 1e18;
    for (int32_t c = 0; c < region->count; c++)
        for (int32_t i = region->first[c]; i < region->first[c + 1]; i++) {
            iso_point a = region->point[i];
            iso_point b = region->point[i + 1 < region->first[c + 1] ? i + 1 : region->first[c]];
            double ux = (double)b.x - a.x, uy = (double)b.y - a.y, vx = x - a.x, vy = y - a.y;
            double t = fmin(1, fmax(0, (ux * vx + uy * vy) / (ux * ux + uy * uy)));
            least = fmin(least, hypot(vx - t * ux, vy - t * uy));
        }
    return least;
}

static int inside(const iso_region *region, double x, double y) {
    int winding = 0;
    for (int32_t c = 0; c < region->count; c++)
        for (int32_t i = region->first[c]; i < region->first[c + 1]; i++) {
            iso_point a = region->point[i];
            iso_point b = region->point[i + 1 < region->first[c + 1] ? i + 1 : region->first[c]];
            int up = a.y <= y && b.y > y, down = a.y > y && b.y <= y;
            double side = ((double)b.x - a.x) * (y - a.y) - ((double)b.y - a.y) * (x - a.x);
            winding += (up && side > 0) - (down && side < 0);
        }
    return winding > 0;
}

static const iso_overhang_options usual = {
    .reach = 2000, .shortest = 4000, .width = 4000, .area = 12566371};

enum { WIDTH = 4500, AREA = 8141593 };

static void add_loop(iso_paths *paths, const iso_point *point, int32_t count, int closed,
                     iso_role role) {
    iso_path like = {.role = (uint8_t)role, .closed = (uint8_t)closed};
    CHECK_OK(iso_paths_add(paths, &like, point, count, WIDTH, AREA));
}

static double role_length(const iso_paths *paths, int32_t number, int role) {
    const iso_path *path = &paths->path[number];
    const iso_path_vertex *v = paths->vertex + path->first;
    double sum = 0;
    for (int32_t i = 0; i + !path->closed < path->count; i++) {
        iso_point a = v[i].at, b = v[i + 1 < path->count ? i + 1 : 0].at;
        if (role < 0 || v[i].role == role)
            sum += hypot((double)b.x - a.x, (double)b.y - a.y);
        int over = v[i].role == ISO_ROLE_OVERHANG_PERIMETER;
        CHECK_EQUAL(over ? usual.width : WIDTH, v[i].width);
        CHECK_EQUAL(over ? usual.area : AREA, v[i].area);
    }
    return sum / MM;
}

/* A square loop, half of it over air: cut where it is 0.2 mm out, wherever the loop begins. */
static void test_loop_half_over_air(void) {
    turned straight = {0, 1};
    iso_region support = {0};
    add_box(&support, straight, (double[]){-20, -20, 3, 20}, 0);
    for (int start = 0; start < 4; start++)
        for (int closed = 0; closed < 2; closed++) {
            const double corner[4][2] = {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}};
            iso_paths paths = {0};
            iso_point point[5];
            for (int i = 0; i < 5; i++)
                point[i] = turn(straight, corner[(start + i) % 4][0], corner[(start + i) % 4][1]);
            add_loop(&paths, point, closed ? 4 : 5, closed, ISO_ROLE_EXTERNAL_PERIMETER);
            add_loop(&paths, point, closed ? 4 : 5, closed, ISO_ROLE_SKIRT);
            CHECK_OK(iso_walls_find_overhangs(&paths, &support, &usual, scratch));
            CHECK_NEAR(80, role_length(&paths, 0, -1), 1e-6);
            CHECK_NEAR(20 + 2 * 6.8, role_length(&paths, 0, ISO_ROLE_OVERHANG_PERIMETER), 5e-3);
            CHECK_NEAR(0, role_length(&paths, 1, ISO_ROLE_OVERHANG_PERIMETER), 0);
            CHECK_EQUAL(closed ? 6 : 7, paths.path[0].count);
            iso_paths_free(&paths);
        }
    iso_region_free(&support);
}

/* All of it over air, none of it, and on the edge of the reach. */
static void test_all_or_nothing(void) {
    turned straight = {0, 1};
    const double out[] = {0, 0.19, 0.21, 5};
    for (int i = 0; i < 4; i++) {
        iso_region support = {0};
        iso_paths paths = {0};
        double half = 10 - out[i];
        iso_point point[] = {turn(straight, -10, -10), turn(straight, 10, -10),
                             turn(straight, 10, 10), turn(straight, -10, 10)};
        add_box(&support, straight, (double[]){-half, -half, half, half}, 0);
        add_loop(&paths, point, 4, 1, ISO_ROLE_PERIMETER);
        CHECK_OK(iso_walls_find_overhangs(&paths, &support, &usual, scratch));
        double over = role_length(&paths, 0, ISO_ROLE_OVERHANG_PERIMETER);
        CHECK_NEAR(i < 2 ? 0 : 80, over, 1e-6); /* corners alone are too short */
        CHECK_EQUAL(4, paths.path[0].count);
        iso_paths_free(&paths);
        iso_region_free(&support);
    }
}

/* Slots narrower than what is told apart are nothing; nor are ribs between wider ones. */
static void test_short_pieces(void) {
    turned straight = {0, 1};
    iso_region slot = {0}, rib = {0};
    add_box(&slot, straight, (double[]){-30, -5, -0.38, 5}, 0); /* 0.36 mm out of reach */
    add_box(&slot, straight, (double[]){0.38, -5, 30, 5}, 0);
    add_box(&rib, straight, (double[]){-30, -5, -10, 5}, 0);
    add_box(&rib, straight, (double[]){-0.01, -5, -0.005, 5}, 0); /* 0.405 mm long, with reach */
    add_box(&rib, straight, (double[]){10, -5, 30, 5}, 0);
    iso_point line[] = {turn(straight, -20, 0), turn(straight, 20, 0)};
    iso_overhang_options wider = usual;
    wider.shortest = 4100;
    for (int k = 0; k < 3; k++) {
        iso_paths paths = {0};
        add_loop(&paths, line, 2, 0, ISO_ROLE_PERIMETER);
        CHECK_OK(iso_walls_find_overhangs(&paths, k == 0 ? &slot : &rib, k == 2 ? &wider : &usual,
                                          scratch));
        double over = role_length(&paths, 0, ISO_ROLE_OVERHANG_PERIMETER);
        CHECK_NEAR(k == 0 ? 0 : k == 1 ? 19.6 - 0.405 : 19.6, over, 5e-3);
        iso_paths_free(&paths);
    }
    iso_region_free(&slot);
    iso_region_free(&rib);
}

static iso_region random_region(void) {
    iso_region raw = {0}, region = {0};
    for (int i = 0; i < 7; i++) {
        double x = random_between(-8, 8), y = random_between(-8, 8), r = random_between(1, 6);
        double a = random_between(0, 6.28);
        turned t = {sin(a), cos(a)};
        iso_point at = {iso_units(x), iso_units(y)}, corner[4];
        const double unit[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        for (int k = 0; k < 4; k++) {
            int j = i == 6 ? 3 - k : k;
            iso_point p = turn(t, unit[j][0] * r, unit[j][1] * r * 0.6);
            corner[k] = (iso_point){at.x + p.x, at.y + p.y};
        }
        CHECK_OK(iso_region_add(&raw, corner, 4));
    }
    CHECK_OK(iso_region_clean(&region, &raw, ISO_FILL_POSITIVE, scratch));
    iso_region_free(&raw);
    return region;
}

/* The contours of one region drawn over another: role by distance, place by place, where no short
 * run is near. The path itself stays where it was. */
static void test_random_walls(void) {
    iso_overhang_options exact = usual;
    exact.shortest = 0;
    long over_count = 0, wrong = 0, moved = 0;
    for (int trial = 0; trial < 30; trial++) {
        iso_region walls = random_region(), support = random_region();
        iso_paths paths = {0};
        for (int32_t c = 0; c < walls.count; c++)
            add_loop(&paths, walls.point + walls.first[c], walls.first[c + 1] - walls.first[c], 1,
                     ISO_ROLE_PERIMETER);
        CHECK_OK(iso_walls_find_overhangs(&paths, &support, &exact, scratch));
        for (int32_t p = 0; p < paths.count; p++) {
            const iso_path *path = &paths.path[p];
            const iso_path_vertex *v = paths.vertex + path->first;
            for (int32_t i = 0; i < path->count; i++) {
                iso_point a = v[i].at, b = v[i + 1 < path->count ? i + 1 : 0].at;
                double length = hypot((double)b.x - a.x, (double)b.y - a.y);
                for (double s = 300; s < length; s += 700) {
                    double x = a.x + s / length * (b.x - a.x), y = a.y + s / length * (b.y - a.y);
                    double d = distance_to(&support, x, y);
                    int over = !inside(&support, x, y) && d > usual.reach;
                    moved += distance_to(&walls, x, y) > 2;
                    over_count += over;
                    /* an excursion shorter than a step may go unseen */
                    if (fabs(d - usual.reach) > 400)
                        wrong += over != (v[i].role == ISO_ROLE_OVERHANG_PERIMETER);
                }
            }
        }
        iso_paths_free(&paths);
        iso_region_free(&walls);
        iso_region_free(&support);
    }
    CHECK(over_count > 1000);
    CHECK_EQUAL(0, wrong);
    CHECK_EQUAL(0, moved);
}

/* ---- masks and rows ---- */

static void test_masks(void) {
    for (int trial = 0; trial < 20; trial++) {
        iso_region region = random_region(), other = random_region();
        iso_arena arena = {0};
        iso_box box = {{-30000, -40000}, {50000, 60000}}, core;
        iso_mask mask, second;
        int32_t cell = (int32_t)random_between(300, 4000), wrong = 0, shared = 0;
        CHECK_OK(mask_of(&mask, &region, &box, cell, &arena));
        CHECK_OK(mask_of(&second, &other, &box, cell, &arena));
        iso_mask grown = mask;
        CHECK_OK(mask_grow(&grown, &arena));
        CHECK_EQUAL(cell, mask.cell);
        for (int32_t r = 0; r < mask.rows; r++)
            for (int32_t c = 0; c < mask.columns; c++) {
                iso_point at = {mask.origin.x + c * cell + cell / 2,
                                mask.origin.y + r * cell + cell / 2};
                int set = 0, both = 0;
                for (int k = 0; k < 5; k++) {
                    iso_point q = {at.x + cell * ((k == 1) - (k == 2)),
                                   at.y + cell * ((k == 3) - (k == 4))};
                    set += mask_has(&mask, q);
                    both += mask_has(&mask, q) && mask_has(&second, q);
                }
                shared += both == 5;
                wrong += mask_has(&grown, at) != (set > 0);
                if (distance_to(&region, at.x, at.y) > 2)
                    wrong += mask_has(&mask, at) != inside(&region, at.x, at.y);
            }
        CHECK_EQUAL(0, wrong);
        CHECK_EQUAL(shared > 0, masks_share_core(&core, &mask, &second));
        CHECK(!mask_has(&mask, (iso_point){-200000, 0}) &&
              !mask_has(&mask, (iso_point){0, 200000}));
        iso_arena_free(&arena);
        iso_region_free(&region);
        iso_region_free(&other);
    }
}

/* Too many cells are made larger, so that a bed of metres takes no gigabytes. */
static void test_cells_of_a_large_box(void) {
    iso_region region = random_region();
    iso_arena arena = {0};
    iso_mask mask;
    iso_box box = {{-10000000, -10000000}, {10000000, 10000000}};
    CHECK_OK(mask_of(&mask, &region, &box, 100, &arena));
    CHECK(mask.cell > 100 && (int64_t)mask.rows * mask.columns <= 1 << 24);
    iso_arena_free(&arena);
    iso_region_free(&region);
}

static void test_rows(void) {
    int wrong = 0;
    for (int trial = 0; trial < 20; trial++) {
        iso_region region = random_region();
        iso_arena arena = {0};
        iso_rows rows;
        CHECK_OK(rows_of(&rows, &region, &arena));
        for (int i = 0; i < 400; i++) {
            iso_point p = {iso_units(random_between(-16, 16)), iso_units(random_between(-16, 16))};
            int32_t reach = (int32_t)random_between(0, 20000);
            double d = distance_to(&region, p.x, p.y);
            if (fabs(d - reach) > 1 && d > 1)
                wrong += rows_reach(&rows, p, reach) != (inside(&region, p.x, p.y) || d < reach);
        }
        iso_arena_free(&arena);
        iso_region_free(&region);
    }
    iso_region nothing = {0};
    iso_arena arena = {0};
    iso_rows rows;
    CHECK_OK(rows_of(&rows, &nothing, &arena));
    CHECK(!rows_reach(&rows, (iso_point){5, 5}, 100000));
    iso_arena_free(&arena);
    CHECK_EQUAL(0, wrong);
}

static void test_no_memory(void) {
    iso_region bridge = random_region(), support = random_region();
    iso_point line[] = {{-150000, 0}, {150000, 20000}};
    int64_t n = 0;
    for (iso_status status = ISO_NO_MEMORY; status == ISO_NO_MEMORY && n < 500; n++) {
        iso_planar_scratch *own;
        double angle;
        CHECK_OK(iso_planar_scratch_new(&own));
        iso_fail_allocation_after(n);
        status = iso_bridge_angle(&angle, &bridge, &support, 45, own);
        iso_fail_allocation_after(-1);
        iso_planar_scratch_free(own);
    }
    CHECK(n > 5 && n < 500);
    n = 0;
    for (iso_status status = ISO_NO_MEMORY; status == ISO_NO_MEMORY && n < 500; n++) {
        iso_planar_scratch *own;
        iso_paths paths = {0};
        CHECK_OK(iso_planar_scratch_new(&own));
        add_loop(&paths, line, 2, 0, ISO_ROLE_PERIMETER);
        iso_fail_allocation_after(n);
        status = iso_walls_find_overhangs(&paths, &support, &usual, own);
        iso_fail_allocation_after(-1);
        CHECK_NEAR(hypot(30, 2), role_length(&paths, 0, -1), 1e-3);
        iso_paths_free(&paths);
        iso_planar_scratch_free(own);
    }
    CHECK(n > 2 && n < 500);
    iso_region_free(&bridge);
    iso_region_free(&support);
}

int main(void) {
    CHECK_OK(iso_planar_scratch_new(&scratch));
    RUN(test_across_the_gap_of_a_table);
    RUN(test_away_from_the_wall_of_a_ledge);
    RUN(test_the_short_way_over_a_pit);
    RUN(test_across_a_corner);
    RUN(test_usual_where_all_are_alike);
    RUN(test_loop_half_over_air);
    RUN(test_all_or_nothing);
    RUN(test_short_pieces);
    RUN(test_random_walls);
    RUN(test_masks);
    RUN(test_cells_of_a_large_box);
    RUN(test_rows);
    RUN(test_no_memory);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}
