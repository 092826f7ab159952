/* Contours and paths of a chart that wraps: cut open, and together again. */
#include "base/memory.h"
#include "base/vector.h"
#include "chart/chart.h"
#include "check.h"

static const double pi = 3.14159265358979323846;

typedef struct mandrel {
    iso_field *field;
    chart *map;
    double half; /* mm: half a period */
    int32_t units;
} mandrel;

static mandrel mandrel_new(void) {
    const iso_vec3 box[2] = {{-10, -9, -9}, {10, 9, 9}};
    mandrel m = {0};
    CHECK_OK(iso_field_new(&m.field, "cylinder:x,0,0"));
    CHECK_OK(chart_new(&m.map, m.field, true, box, (double[2]){5, 9}));
    m.half = chart_period(m.map) / 2;
    m.units = iso_units(m.half);
    return m;
}

static void mandrel_free(mandrel *m) {
    chart_free(m->map);
    iso_field_free(m->field);
}

/* ---- contours ---- */

/* How often contours of level 0 wind around a place. */
static int winding(const iso_slices *slices, double u, double v) {
    int sum = 0;
    for (int32_t c = 0; c < slices->contour_count; c++) {
        int64_t first = slices->contour_first[c], end = slices->contour_first[c + 1];
        for (int64_t i = first; i < end; i++) {
            iso_vec2 a = slices->point[i], b = slices->point[i + 1 < end ? i + 1 : first];
            if ((a.y <= v) == (b.y <= v))
                continue;
            if (a.x + (b.x - a.x) * (v - a.y) / (b.y - a.y) > u)
                sum += b.y > a.y ? 1 : -1;
        }
    }
    return sum;
}

/* A part around x from two wavy ends, with a hole of radius 3 where the chart ends and a patch of
 * its own beyond its end: what is material is known at every angle. */
static double low_end(double angle) {
    return -6 + sin(3 * angle);
}

static double high_end(double angle) {
    return 6 + cos(2 * angle);
}

static bool is_material(double angle, double x, double r) {
    double from_hole = remainder(angle - pi, 2 * pi) * r;
    double from_patch = remainder(angle - 3, 2 * pi) * r;
    if (from_patch * from_patch + (x - 9) * (x - 9) < 1)
        return true;
    return x > low_end(angle) && x < high_end(angle) && from_hole * from_hole + x * x > 9;
}

/* In the chart's own sense: from +z towards -y. */
static iso_vec3 around(double x, double angle, double r) {
    return vec3(x, -r * sin(angle), r * cos(angle));
}

static void test_contours_around_an_axis(void) {
    enum { STEPS = 720 };
    static iso_vec3 at[4 * STEPS];
    int32_t level_first[2] = {0, 4};
    int64_t contour_first[5] = {0, STEPS, 2 * STEPS, 3 * STEPS, 4 * STEPS};
    iso_curves curves = {1, 4, 4 * STEPS, level_first, contour_first, at};
    mandrel m = mandrel_new();
    const double r = 6, margin = 4, stretch = m.half / pi;
    for (int i = 0; i < STEPS; i++) {
        double t = 2 * pi * (i + 0.5) / STEPS + 1;
        at[i] = around(low_end(t), t, r);
        at[STEPS + i] = around(high_end(-t), -t, r);
        at[2 * STEPS + i] = around(3 * sin(-t), pi + 3 / r * cos(-t), r);
        at[3 * STEPS + i] = around(9 + sin(t), 3 + 1 / r * cos(t), r);
    }
    iso_slices slices;
    CHECK_OK(chart_slices(&slices, m.map, &curves, margin));
    CHECK_OK(iso_slices_validate(&slices));
    int wrong = 0, seen = 0;
    for (double u = -m.half - margin + 0.05; u < m.half + margin; u += 0.31)
        for (double v = -9; v < 11; v += 0.23) {
            double angle = u / stretch;
            bool here = is_material(angle, v, r);
            if (here != is_material(angle + 0.02, v, r) ||
                here != is_material(angle - 0.02, v, r) || here != is_material(angle, v + 0.1, r) ||
                here != is_material(angle, v - 0.1, r))
                continue;
            wrong += winding(&slices, u, v) != here;
            seen++;
        }
    CHECK_EQUAL(0, wrong);
    CHECK(seen > 5000);
    for (int64_t i = 0; i < slices.crossing_count; i++)
        CHECK(fabs(slices.point[i].x) <= m.half + margin + 1e-9);
    iso_slices_free(&slices);

    /* a ring alone is the end of nothing */
    level_first[1] = curves.contour_count = 1;
    curves.crossing_count = STEPS;
    CHECK_STATUS(ISO_UNSLICEABLE, chart_slices(&slices, m.map, &curves, margin));
    mandrel_free(&m);
}

/* ---- paths ---- */

static double length_of(const iso_path_vertex *a, const iso_path_vertex *b, int64_t period) {
    double x = remainder((double)b->at.x - a->at.x, (double)period), y = (double)b->at.y - a->at.y;
    return sqrt(x * x + y * y);
}

static double content_of(const iso_paths *paths, int64_t period) {
    double sum = 0;
    for (int32_t p = 0; p < paths->count; p++) {
        const iso_path *path = &paths->path[p];
        for (int32_t i = 0; i < path->count - !path->closed; i++) {
            const iso_path_vertex *a = &paths->vertex[path->first + i];
            sum +=
                a->area * length_of(a, &paths->vertex[path->first + (i + 1) % path->count], period);
        }
    }
    return sum;
}

static void add(iso_paths *paths, int closed, int group, const iso_point *point, int32_t count) {
    iso_path like = {.role = closed ? ISO_ROLE_PERIMETER : ISO_ROLE_SOLID_INFILL,
                     .closed = (uint8_t)closed,
                     .group = group,
                     .object = 7};
    CHECK_OK(iso_paths_add(paths, &like, point, count, 4000, 700000 + 1000 * paths->count));
}

static void clip(iso_paths *out, const iso_paths *paths, const mandrel *m) {
    iso_arena arena = {0};
    CHECK_OK(chart_clip_paths(out, paths, m->map, &arena));
    for (int32_t i = 0; i < out->vertex_count; i++)
        CHECK(out->vertex[i].at.x >= -m->units && out->vertex[i].at.x <= m->units);
    iso_arena_free(&arena);
}

/* The wall of a strip that the chart cuts open is two loops around the axis. */
static void test_a_loop_around_everything_closes(void) {
    mandrel m = mandrel_new();
    iso_paths paths = {0}, out = {0};
    int32_t far = m.units + 30000;
    iso_point wall[5] = {{-far, 0}, {-5, 1000}, {far, 0}, {far, 90000}, {-far, 90000}};
    add(&paths, 1, 0, wall, 5);
    clip(&out, &paths, &m);
    CHECK_EQUAL(2, out.count);
    for (int32_t p = 0; p < out.count; p++) {
        const iso_path *path = &out.path[p];
        CHECK_EQUAL(1, path->closed);
        CHECK_EQUAL(7, path->object);
        for (int32_t i = 0; i < path->count; i++) {
            const iso_path_vertex *a = &out.vertex[path->first + i];
            CHECK(length_of(a, &out.vertex[path->first + (i + 1) % path->count], 2 * m.units) <
                  0.51 * m.units);
        }
    }
    CHECK_NEAR(700000 * 4.0 * m.units, content_of(&out, 2 * (int64_t)m.units), 700000 * 200.0);
    iso_paths_free(&paths);
    iso_paths_free(&out);
    mandrel_free(&m);
}

/* A hole's wall where the chart ends is there at both ends, and once at last; groups become one. */
static void test_a_loop_across_the_end_closes(void) {
    mandrel m = mandrel_new();
    iso_paths paths = {0}, out = {0};
    iso_point ring[64], line[2] = {{m.units - 50000, 0}, {m.units - 40000, 5}};
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < 64; i++)
            ring[i] = (iso_point){(side ? m.units : -m.units) + iso_units(2 * cos(pi * i / 32)),
                                  iso_units(2 * sin(pi * i / 32))};
        add(&paths, 1, 3 + side, ring, 64);
    }
    paths.vertex[64].area = 0; /* whichever copy a bead is of */
    for (int i = 0; i < 128; i++)
        paths.vertex[i].area = 700000;
    add(&paths, 0, 3, line, 2);
    add(&paths, 0, 4, line, 2);
    clip(&out, &paths, &m);
    CHECK_EQUAL(3, out.count);
    CHECK_EQUAL(1, out.path[0].closed + out.path[1].closed + out.path[2].closed);
    CHECK_EQUAL(out.path[0].group, out.path[1].group);
    CHECK_EQUAL(out.path[0].group, out.path[2].group);
    double exact = 64 * 2 * sin(pi / 64) * 2e4 * 700000 + content_of(&paths, 1 << 30) -
                   2 * 64 * 2 * sin(pi / 64) * 2e4 * 700000;
    CHECK_NEAR(exact, content_of(&out, 2 * (int64_t)m.units), 1e-5 * exact);
    iso_paths_free(&paths);
    iso_paths_free(&out);
    mandrel_free(&m);
}

/* Lines are split exactly where the chart ends, keep their beads, and what lies beyond goes. */
static void test_lines_are_split_at_the_end(void) {
    mandrel m = mandrel_new();
    iso_paths paths = {0}, out = {0};
    int32_t h = m.units;
    iso_point zigzag[4] = {
        {h - 20000, 0}, {h + 20000, 40000}, {h + 20000, 44000}, {h - 20000, 4000}};
    iso_point beyond[2] = {{h + 100, 0}, {h + 9000, 0}}, within[2] = {{-h, 0}, {-h + 9000, 77}};
    iso_point across[2] = {{-h - 10000, 500}, {h + 10000, 500}};
    add(&paths, 0, 0, zigzag, 4);
    add(&paths, 0, 0, beyond, 2);
    add(&paths, 0, 0, within, 2);
    add(&paths, 0, 0, across, 2);
    paths.path[2].follows = paths.path[3].follows = 1;
    clip(&out, &paths, &m);
    CHECK_EQUAL(4, out.count);
    CHECK_EQUAL(h, out.vertex[out.path[0].first + 1].at.x);
    CHECK_EQUAL(20000, out.vertex[out.path[0].first + 1].at.y);
    CHECK_EQUAL(h, out.vertex[out.path[1].first].at.x);
    CHECK_EQUAL(24000, out.vertex[out.path[1].first].at.y);
    CHECK_EQUAL(0, out.path[2].follows); /* what it followed isn't there */
    double exact =
        2 * sqrt(2) * 20000 * 700000.0 + sqrt(9000.0 * 9000 + 77 * 77) * 702000 + 2.0 * h * 703000;
    /* the last one, around everything, has become a loop */
    CHECK_EQUAL(1, out.path[3].closed);
    CHECK_NEAR(exact, content_of(&out, 2 * (int64_t)h), 1e-6 * exact);
    iso_paths_free(&paths);
    iso_paths_free(&out);
    mandrel_free(&m);
}

/* Random loops, copied as chart_slices copies them: as much of every one as there is. */
static void test_what_there_is_stays(void) {
    mandrel m = mandrel_new();
    uint32_t seed = 5;
    for (int turn = 0; turn < 50; turn++) {
        iso_paths paths = {0}, out = {0};
        double exact = 0;
        for (int k = 0; k < 10; k++) {
            iso_point p[9], copy[9];
            int64_t middle = 0;
            for (int i = 0; i < 9; i++) {
                seed = seed * 1664525u + 1013904223u;
                if (i == 0)
                    middle = (int64_t)(seed >> 8) * 2 * m.units >> 24;
                p[i] = (iso_point){(int32_t)(middle - m.units) + (int32_t)(seed >> 16) % 40000,
                                   (int32_t)(seed >> 13) % 30000};
            }
            for (int j = -1; j <= 1; j++) {
                iso_path like = {.role = ISO_ROLE_PERIMETER, .closed = 1, .group = 3 * k + j};
                for (int i = 0; i < 9; i++)
                    copy[i] = (iso_point){p[i].x + 2 * j * m.units, p[i].y};
                CHECK_OK(iso_paths_add(&paths, &like, copy, 9, 4000, 700000));
            }
            for (int i = 0; i < 9; i++) {
                double x = p[i].x - p[(i + 1) % 9].x, y = p[i].y - p[(i + 1) % 9].y;
                exact += 700000 * sqrt(x * x + y * y);
            }
        }
        clip(&out, &paths, &m);
        CHECK_NEAR(exact, content_of(&out, 2 * (int64_t)m.units), 1e-4 * exact);
        for (int32_t i = 0; i < out.count; i++)
            CHECK(out.path[i].closed);
        iso_paths_free(&paths);
        iso_paths_free(&out);
    }
    mandrel_free(&m);
}

static void test_out_of_memory(void) {
    mandrel m = mandrel_new();
    iso_paths paths = {0};
    int32_t far = m.units + 30000;
    iso_point wall[4] = {{-far, 0}, {far, 0}, {far, 90000}, {-far, 90000}};
    for (int i = 0; i < 20; i++)
        add(&paths, 1, i, wall, 4);
    iso_status status = ISO_NO_MEMORY;
    for (int64_t n = 0; status != ISO_OK && n < 100; n++) {
        iso_paths out = {0};
        iso_arena arena = {0};
        iso_fail_allocation_after(n);
        status = chart_clip_paths(&out, &paths, m.map, &arena);
        iso_fail_allocation_after(-1);
        CHECK_EQUAL(status == ISO_OK ? 40 : 0, out.count);
        iso_paths_free(&out);
        iso_arena_free(&arena);
    }
    CHECK_EQUAL(ISO_OK, status);
    iso_paths_free(&paths);
    mandrel_free(&m);
}

int main(void) {
    RUN(test_contours_around_an_axis);
    RUN(test_a_loop_around_everything_closes);
    RUN(test_a_loop_across_the_end_closes);
    RUN(test_lines_are_split_at_the_end);
    RUN(test_what_there_is_stays);
    RUN(test_out_of_memory);
    return check_verdict();
}
