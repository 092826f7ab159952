/* Layers of lattices: contours, sections, beads. */
#include "check.h"

#include <stdbool.h>

#include "lattice/contour.h"
#include "lattice/slice.h"
#include "part.h"

#define MM ISO_UNITS_PER_MM

static iso_mesh box; /* 24 by 24 by 24, its floor's middle at the origin */
static iso_arena arena;
static iso_planar_scratch *planar;

/* ---- contours ---- */

typedef struct field {
    double value[60][60];
    int32_t size;
} field;

static void field_row(contour_row *row, void *context, int32_t j) {
    field *f = context;
    *row = (contour_row){f->value[j], f->value[j]};
}

static uint64_t seed = 1;
static uint64_t random_number(void) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return seed >> 33;
}

/* Whole numbers around 0, so that nodes on the level and saddles of all kinds are common; or waves.
 * Above 0 at the border. */
static void fill_field(field *f, int32_t size, int kind) {
    double phase = (double)(random_number() % 1000) / 100;
    f->size = size;
    for (int32_t j = 0; j < size; j++)
        for (int32_t i = 0; i < size; i++) {
            bool border = i == 0 || j == 0 || i == size - 1 || j == size - 1;
            double noise = (double)(random_number() % 5) - 2;
            double wave = sin(0.5 * i + phase) + cos(0.4 * j - phase) * sin(0.3 * (i + j));
            f->value[j][i] = border ? 1 : kind == 0 ? noise : wave;
        }
}

/* All curves of the field to raw contours, 1000 units a step, points of no length left out. */
static void read_contours(iso_region *raw, field *f) {
    contour_grid grid = {.columns = f->size, .rows = f->size, .row = field_row, .context = f};
    contour c;
    int closed;
    iso_point point[8000];
    iso_region_clear(raw);
    CHECK_OK(contour_trace(&c, &grid, &arena));
    int32_t walked = 0;
    for (int32_t start; (start = contour_start(&c, &closed)) >= 0;) {
        int32_t count = 0, i = start;
        CHECK(closed);
        for (const contour_crossing *at; (at = contour_step(&c, &i)); walked++) {
            CHECK_NEAR(0, at->extra, 1e-12); /* the value itself there */
            iso_point p = {(int32_t)lround(at->x * 1000), (int32_t)lround(at->y * 1000)};
            if (count == 0 || p.x != point[count - 1].x || p.y != point[count - 1].y)
                point[count++] = p;
        }
        CHECK_EQUAL(start, i); /* back where it began */
        while (count > 1 && point[count - 1].x == point[0].x && point[count - 1].y == point[0].y)
            count--;
        if (count > 2)
            CHECK_OK(iso_region_add(raw, point, count));
    }
    CHECK_EQUAL(c.count, walked);
}

/* Crossings of the grid's edges, counted without the contours. */
static int32_t edges_crossed(const field *f) {
    int32_t count = 0;
    for (int32_t j = 0; j < f->size; j++)
        for (int32_t i = 0; i < f->size; i++) {
            bool here = f->value[j][i] > 0;
            count += i + 1 < f->size && here != (f->value[j][i + 1] > 0);
            count += j + 1 < f->size && here != (f->value[j + 1][i] > 0);
        }
    return count;
}

static void test_contours(void) {
    static field f;
    iso_region raw = {0}, clean = {0}, other = {0};
    for (int k = 0; k < 60; k++) {
        iso_arena_mark mark = iso_arena_get_mark(&arena);
        contour_grid grid = {.row = field_row, .context = &f};
        contour c;
        fill_field(&f, k < 10 ? 3 + k : 60, k % 2);
        grid.columns = grid.rows = f.size;
        CHECK_OK(contour_trace(&c, &grid, &arena));
        CHECK_EQUAL(edges_crossed(&f), c.count);
        read_contours(&raw, &f);
        CHECK_OK(iso_region_clean(&clean, &raw, ISO_FILL_POSITIVE, planar));
        CHECK_OK(iso_region_validate(&clean, planar));
        CHECK_OK(iso_region_clean(&other, &raw, ISO_FILL_NONZERO, planar));
        /* wound right and never across each other: no rule makes a difference. Rounding may. */
        double area = (double)iso_region_double_area(&raw), unit = 2e3 * c.count + 1;
        CHECK_NEAR(area, (double)iso_region_double_area(&clean), unit);
        CHECK_NEAR(area, (double)iso_region_double_area(&other), unit);
        for (int32_t j = 0; j < f.size; j++)
            for (int32_t i = 0; i < f.size; i++) {
                int side = iso_region_locate(&clean, (iso_point){1000 * i, 1000 * j});
                CHECK(fabs(f.value[j][i]) < 0.01 || side == (f.value[j][i] < 0 ? 1 : -1));
            }
        iso_arena_pop(&arena, mark);
    }
    iso_region_free(&raw);
    iso_region_free(&clean);
    iso_region_free(&other);
}

/* Squares that aren't looked at cut curves open, and the pieces are those of the whole. */
static void test_squares_left_out(void) {
    static field f;
    static uint8_t square[59 * 59];
    fill_field(&f, 60, 1);
    for (int32_t k = 0; k < 59 * 59; k++)
        square[k] = k % 59 > 20 && k % 59 < 40;
    contour_grid grid = {60, 60, square, field_row, &f};
    contour c;
    int closed, open = 0;
    CHECK_OK(contour_trace(&c, &grid, &arena));
    for (int32_t start; (start = contour_start(&c, &closed)) >= 0;) {
        int32_t i = start;
        for (const contour_crossing *at; (at = contour_step(&c, &i));)
            if (at->next >= 0)
                CHECK(square[at->square]);
        CHECK(closed ? i == start : i == -1);
        open += !closed;
    }
    CHECK(open > 4);
}

/* ---- lattices ---- */

static iso_lattice *make(int32_t pattern, const char *cell, const char *density) {
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = NULL;
    options.pattern = pattern;
    options.cell = cell;
    options.density = density;
    CHECK_OK(lattice_new(&lattice, &options, &box, 1));
    return lattice;
}

static iso_fill_options fill_of(double density) {
    iso_fill_options fill = iso_fill_defaults(iso_bead_of(4500, 2000), density);
    fill.link_max = fill.anchor = fill.margin = 0;
    return fill;
}

static void add_square(iso_region *region, double x, double y, double half, bool hole) {
    int32_t l = iso_units(x - half), r = iso_units(x + half);
    int32_t b = iso_units(y - half), t = iso_units(y + half);
    iso_point outer[4] = {{l, b}, {r, b}, {r, t}, {l, t}},
              inner[4] = {{l, b}, {l, t}, {r, t}, {r, b}};
    CHECK_OK(iso_region_add(region, hole ? inner : outer, 4));
}

static double volume_of(const iso_paths *paths) { /* units^3 */
    double sum = 0;
    for (int32_t p = 0; p < paths->count; p++) {
        const iso_path *path = &paths->path[p];
        const iso_path_vertex *v = paths->vertex + path->first;
        for (int32_t i = 0; i + 1 < path->count + path->closed; i++) {
            const iso_path_vertex *to = &v[(i + 1) % path->count];
            sum += v[i].area * hypot((double)to->at.x - v[i].at.x, (double)to->at.y - v[i].at.y);
        }
    }
    return sum;
}

/* Square mm of material in the square about the axis, by samples in its layer. */
static double sampled_area(const iso_lattice *lattice, double z, double half) {
    enum { SIDE = 300 };
    static iso_vec3 point[SIDE];
    static double value[SIDE];
    int64_t inside = 0;
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++)
            point[i] =
                (iso_vec3){half * (2 * (i + 0.5) / SIDE - 1), half * (2 * (j + 0.5) / SIDE - 1), z};
        lattice_sample(value, lattice, point, SIDE);
        for (int i = 0; i < SIDE; i++)
            inside += value[i] <= 0;
    }
    return 4 * half * half * (double)inside / SIDE / SIDE;
}

/* Cells of 9 beads, so many layers over one of them: the section is that of the samples, the beads
 * hold it, and what all layers hold is the density that was asked. */
static void check_density(int32_t pattern, const char *text, double density, double tolerance) {
    enum { LAYERS = 9 };
    const double cell = 4, half = 6;
    iso_lattice *lattice = make(pattern, "4", text);
    iso_fill_options fill = fill_of(density);
    iso_region region = {0}, section = {0};
    double beads = 0, area = 0;
    add_square(&region, 0, 0, half, false);
    region.parent[0] = -1;
    for (int k = 0; k < LAYERS; k++) {
        iso_lattice_slice slice = {.lattice = lattice, .z = 4 + (k + 0.37) * cell / LAYERS};
        iso_paths paths = {0};
        CHECK_OK(lattice_section(&section, &region, &slice, &arena, planar));
        CHECK_OK(iso_region_validate(&section, planar));
        CHECK_OK(lattice_fill(&paths, &region, &slice, &fill, &arena, planar));
        double sampled = sampled_area(lattice, slice.z, half);
        double contoured = (double)iso_region_double_area(&section) / 2 / MM / MM;
        CHECK_NEAR(sampled, contoured, 0.012 * 4 * half * half);
        area += sampled;
        beads += volume_of(&paths) / 2000 / MM / MM;
        iso_paths_free(&paths);
    }
    if (!CHECK_NEAR(1, beads / area, tolerance))
        fprintf(stderr, "  %s at %s\n", iso_lattice_name(pattern), text);
    CHECK_NEAR(density, beads / LAYERS / (4 * half * half), 0.02);
    iso_region_free(&region);
    iso_region_free(&section);
    lattice_free(lattice);
}

static void test_sheets(void) {
    static const char *const text[] = {"20", "35", "50", "80"};
    static const double density[] = {0.2, 0.35, 0.5, 0.8};
    for (int32_t p = ISO_LATTICE_GYROID_SHEET; p <= ISO_LATTICE_FISCHER_KOCH_SHEET; p += 2)
        for (int k = 0; k < 4; k++)
            if (p == ISO_LATTICE_GYROID_SHEET || k % 3 == 0)
                check_density(p, text[k], density[k], k == 0 ? 0.015 : 0.01);
}

static void test_solids(void) {
    for (int32_t p = ISO_LATTICE_GYROID_SOLID; p <= ISO_LATTICE_FISCHER_KOCH_SOLID; p += 2) {
        check_density(p, "20", 0.2, 0.015);
        check_density(p, "50", 0.5, 0.01);
    }
}

static void test_struts(void) {
    for (int32_t p = ISO_LATTICE_BCC_STRUTS; p <= ISO_LATTICE_DIAMOND_STRUTS; p++) {
        check_density(p, "20", 0.2, 0.02); /* 1 percent absolute would be 0.05 */
        check_density(p, "50", 0.5, 0.01);
    }
    check_density(ISO_LATTICE_OCTET_STRUTS, "80", 0.8, 0.01);
}

/* ---- places ---- */

static double gyroid(iso_vec3 p, iso_vec3 *slope) {
    const double k = 2 * 3.14159265358979323846 / 4;
    double sx = sin(k * p.x), cx = cos(k * p.x), sy = sin(k * p.y), cy = cos(k * p.y);
    double sz = sin(k * p.z), cz = cos(k * p.z);
    *slope = (iso_vec3){k * (cx * cy - sz * sx), k * (cy * cz - sx * sy), k * (cz * cx - sy * sz)};
    return sx * cy + sy * cz + sz * cx;
}

/* The distance to the gyroid itself: its nearest point by steps down its slope, then along it until
 * the way there is upright on the surface. */
static double distance_to_gyroid(iso_vec3 p) {
    iso_vec3 q = p, n;
    for (int i = 0; i < 20; i++) {
        double value = gyroid(q, &n), square = n.x * n.x + n.y * n.y + n.z * n.z;
        q = (iso_vec3){q.x - value * n.x / square, q.y - value * n.y / square,
                       q.z - value * n.z / square};
        gyroid(q, &n);
        square = n.x * n.x + n.y * n.y + n.z * n.z;
        iso_vec3 d = {p.x - q.x, p.y - q.y, p.z - q.z};
        double along = (d.x * n.x + d.y * n.y + d.z * n.z) / square;
        q = (iso_vec3){q.x + 0.5 * (d.x - along * n.x), q.y + 0.5 * (d.y - along * n.y),
                       q.z + 0.5 * (d.z - along * n.z)};
    }
    double value = gyroid(q, &n), square = n.x * n.x + n.y * n.y + n.z * n.z;
    q = (iso_vec3){q.x - value * n.x / square, q.y - value * n.y / square,
                   q.z - value * n.z / square};
    return sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) + (p.z - q.z) * (p.z - q.z));
}

/* Both sides of the wall are half its thickness from the surface: within 5 percent of the
 * thickness; beads run along the surface itself. */
static void test_wall_thickness(void) {
    iso_lattice *lattice = make(ISO_LATTICE_GYROID_SHEET, "4", "35");
    iso_fill_options fill = fill_of(0.35);
    iso_region region = {0}, section = {0};
    iso_lattice_plane plane = {.step = 1, .z = 4, .columns = 1, .rows = 1};
    double distance, half, sum = 0;
    int64_t count = 0;
    add_square(&region, 0, 0, 8, false);
    region.parent[0] = -1;
    lattice_sample_row(&distance, &half, lattice, &plane, 0, 0, 1);
    CHECK(half > 0.2 && half < 0.25);
    for (int k = 0; k < 10; k++) {
        iso_lattice_slice slice = {.lattice = lattice, .z = 8.05 + 0.4 * k};
        iso_paths paths = {0};
        CHECK_OK(lattice_section(&section, &region, &slice, &arena, planar));
        CHECK_OK(lattice_fill(&paths, &region, &slice, &fill, &arena, planar));
        for (int32_t i = 0; i < section.first[section.count]; i++) {
            iso_vec3 p = {iso_mm(section.point[i].x), iso_mm(section.point[i].y), slice.z};
            if (fabs(p.x) > 7.95 || fabs(p.y) > 7.95)
                continue;
            double off = distance_to_gyroid(p) - half;
            CHECK_NEAR(0, off, 0.05 * 2 * half);
            sum += off;
            count++;
        }
        for (int32_t i = 0; i < paths.vertex_count; i++) {
            iso_vec3 p = {iso_mm(paths.vertex[i].at.x), iso_mm(paths.vertex[i].at.y), slice.z};
            CHECK_NEAR(0, distance_to_gyroid(p), 0.05 * 2 * half);
        }
        iso_paths_free(&paths);
    }
    CHECK(count > 2000);
    CHECK_NEAR(0, sum / (double)count, 0.01 * 2 * half);
    iso_region_free(&region);
    iso_region_free(&section);
    lattice_free(lattice);
}

/* A square with a hole, an island in that, and another square that the hole's corner touches. */
static void make_odd(iso_region *region) {
    iso_region raw = {0};
    add_square(&raw, 0, 0, 9, false);
    add_square(&raw, 1, 1.3, 5.1, true);
    add_square(&raw, 1.2, 0.7, 2.2, false);
    CHECK_OK(iso_region_clean(region, &raw, ISO_FILL_POSITIVE, planar));
    iso_region_free(&raw);
}

static double off_edges(const iso_region *region, iso_point p) { /* to the nearest, units */
    double best = HUGE_VAL;
    for (int32_t m = 0; m < region->count; m++)
        for (int32_t i = region->first[m]; i < region->first[m + 1]; i++) {
            iso_point a = region->point[i];
            iso_point b = region->point[i + 1 < region->first[m + 1] ? i + 1 : region->first[m]];
            double dx = (double)b.x - a.x, dy = (double)b.y - a.y, px = (double)p.x - a.x;
            double py = (double)p.y - a.y, t = (px * dx + py * dy) / (dx * dx + dy * dy);
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            best = fmin(best, hypot(px - t * dx, py - t * dy));
        }
    return best;
}

static void test_odd_region(void) {
    static const int32_t pattern[] = {ISO_LATTICE_GYROID_SHEET, ISO_LATTICE_DIAMOND_SHEET,
                                      ISO_LATTICE_IWP_SHEET, ISO_LATTICE_KELVIN_STRUTS,
                                      ISO_LATTICE_PRIMITIVE_SOLID};
    iso_region region = {0}, section = {0}, outside = {0};
    make_odd(&region);
    CHECK_EQUAL(3, region.count);
    for (int k = 0; k < 5; k++) {
        iso_lattice *lattice = make(pattern[k], "3.3", k == 1 ? "20+x+10" : "35");
        iso_fill_options fill = fill_of(0.35);
        fill.link_max = k % 2 ? 30000 : 0;
        for (double z = 3; z < 6; z += 0.7) {
            iso_lattice_slice slice = {.lattice = lattice, .z = z, .shift = {1234, -777}};
            iso_paths paths = {0}, again = {0};
            CHECK_OK(lattice_section(&section, &region, &slice, &arena, planar));
            CHECK_OK(iso_region_validate(&section, planar));
            CHECK_OK(iso_boolean(&outside, ISO_DIFFERENCE, &section, &region, planar));
            CHECK(iso_region_double_area(&outside) < 4e5);
            CHECK_OK(lattice_fill(&paths, &region, &slice, &fill, &arena, planar));
            CHECK_OK(lattice_fill(&again, &region, &slice, &fill, &arena, planar));
            CHECK(paths.vertex_count > 20);
            CHECK_EQUAL(paths.vertex_count, again.vertex_count);
            CHECK(!memcmp(paths.vertex, again.vertex,
                          sizeof *paths.vertex * (size_t)paths.vertex_count));
            for (int32_t i = 0; i < paths.vertex_count; i++) {
                const iso_path_vertex *v = &paths.vertex[i];
                CHECK(iso_region_locate(&region, v->at) >= 0 || off_edges(&region, v->at) < 1500);
                CHECK(v->width > 500 && v->area > 0);
            }
            iso_paths_free(&paths);
            iso_paths_free(&again);
        }
        lattice_free(lattice);
    }
    iso_region_free(&region);
    iso_region_free(&section);
    iso_region_free(&outside);
}

/* Two sheets' lines joined along the wall are one path; without links each is its own. */
static void test_links(void) {
    iso_lattice *lattice = make(ISO_LATTICE_GYROID_SHEET, "4", "35");
    iso_lattice_slice slice = {.lattice = lattice, .z = 8.1};
    iso_fill_options fill = fill_of(0.35);
    iso_region region = {0};
    iso_paths apart = {0}, joined = {0};
    add_square(&region, 0, 0, 10, false);
    region.parent[0] = -1;
    CHECK_OK(lattice_fill(&apart, &region, &slice, &fill, &arena, planar));
    fill.link_max = 5 * MM;
    CHECK_OK(lattice_fill(&joined, &region, &slice, &fill, &arena, planar));
    CHECK(apart.count > 10 && joined.count * 2 < apart.count);
    CHECK(volume_of(&joined) > volume_of(&apart));
    iso_paths_free(&apart);
    iso_paths_free(&joined);
    iso_region_free(&region);
    lattice_free(lattice);
}

static void test_memory(void) {
    static const int32_t pattern[] = {ISO_LATTICE_GYROID_SHEET, ISO_LATTICE_KELVIN_STRUTS};
    iso_region region = {0};
    add_square(&region, 0, 0, 3, false);
    region.parent[0] = -1;
    for (int k = 0; k < 2; k++) {
        iso_lattice *lattice = make(pattern[k], "4", "30");
        iso_lattice_slice slice = {.lattice = lattice, .z = 5};
        iso_fill_options fill = fill_of(0.3);
        iso_status status = ISO_NO_MEMORY;
        int64_t n = 0;
        for (; status == ISO_NO_MEMORY && n < 2000; n++) {
            iso_arena own = {0};
            iso_planar_scratch *room;
            iso_paths paths = {0};
            CHECK_OK(iso_planar_scratch_new(&room));
            iso_fail_allocation_after(n);
            status = lattice_fill(&paths, &region, &slice, &fill, &own, room);
            iso_fail_allocation_after(-1);
            CHECK(status == ISO_OK || (paths.count == 0 && paths.vertex_count == 0));
            iso_paths_free(&paths);
            iso_arena_free(&own);
            iso_planar_scratch_free(room);
        }
        CHECK_STATUS(ISO_OK, status);
        CHECK(n > 2);
        lattice_free(lattice);
    }
    iso_region_free(&region);
}

int main(void) {
    CHECK_OK(part_box(&box, (double[3]){24, 24, 24}, (double[3]){-12, -12, 0}));
    CHECK_OK(iso_planar_scratch_new(&planar));
    RUN(test_contours);
    RUN(test_squares_left_out);
    RUN(test_sheets);
    RUN(test_solids);
    RUN(test_struts);
    RUN(test_wall_thickness);
    RUN(test_odd_region);
    RUN(test_links);
    RUN(test_memory);
    iso_planar_scratch_free(planar);
    iso_arena_free(&arena);
    iso_mesh_free(&box);
    return check_verdict();
}
