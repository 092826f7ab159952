/* Each layer's area, against a sum over the triangles that knows nothing of neighbours. */
#include "checks.h"
#include "solids.h"

#include "config/settings.h"
#include "planar/section.h"

static double perimeter_of(const iso_region *region) {
    double sum = 0;
    for (int32_t c = 0; c < region->count; c++) {
        int32_t first = region->first[c], end = region->first[c + 1];
        for (int32_t i = first; i < end; i++) {
            iso_point a = region->point[i], b = region->point[i + 1 == end ? first : i + 1];
            sum += hypot((double)b.x - a.x, (double)b.y - a.y);
        }
    }
    return sum / ISO_UNITS_PER_MM;
}

static double area_of(const iso_region *region) {
    return (double)iso_region_double_area(region) / 2 / ISO_UNITS_PER_MM / ISO_UNITS_PER_MM;
}

/* Rounding moves a boundary by less than a unit, thinning by at most its tolerance. */
static void check_region(const iso_slices *slices, int32_t level, double area, int32_t thinning,
                         iso_planar_scratch *scratch) {
    iso_region raw = {0}, exact = {0}, thin = {0};
    CHECK_OK(section_add(&raw, slices, level));
    CHECK_OK(iso_region_clean(&exact, &raw, ISO_FILL_POSITIVE, scratch));
    CHECK_OK(iso_region_simplify(&thin, &raw, thinning, scratch));
    CHECK_OK(iso_region_validate(&thin, scratch));
    double edge = perimeter_of(&exact);
    CHECK_NEAR(area, area_of(&exact), edge * 1e-4 + 1e-7);
    CHECK_NEAR(area, area_of(&thin), edge * (thinning + 1) * 1e-4 + 1e-7);
    iso_region_free(&raw);
    iso_region_free(&exact);
    iso_region_free(&thin);
}

static void check_sections(const shape *s, const char *name, double height, double angle) {
    iso_mesh mesh = {0};
    iso_levels levels = {0};
    iso_slices slices = {0};
    iso_planar_scratch *scratch;
    shape_box3 box = shape_bounds(s);
    int before = check_failures;
    if (!CHECK_OK(iso_planar_scratch_new(&scratch)))
        return;
    CHECK_OK(iso_mesh_from_triangles(&mesh, s->triangle, s->count));
    CHECK_OK(iso_levels_uniform(&levels, box.max[2] - box.min[2], 1.1 * height, height));
    for (int32_t i = 0; i < levels.count; i++)
        levels.cut[i] += box.min[2];
    CHECK_OK(iso_slice_planar(&slices, &mesh, &levels));
    CHECK_OK(iso_slices_validate(&slices));
    for (int32_t i = 0; i < levels.count; i++) {
        double area = shape_area_at(s, levels.cut[i]);
        CHECK_NEAR(area, section_area(&slices, i), 1e-6 * fabs(area) + 1e-9);
        check_region(&slices, i, area, 50, scratch);
    }
    if (check_failures > before)
        fprintf(stderr, "    that was %s, turned by %g\n", name, angle);
    iso_planar_scratch_free(scratch);
    iso_slices_free(&slices);
    iso_levels_free(&levels);
    iso_mesh_free(&mesh);
}

/* About the axis (1, 2, 3), so that no face stays level. */
static void turn_shape(shape *s, double angle) {
    double n[3] = {1 / sqrt(14), 2 / sqrt(14), 3 / sqrt(14)}, c = cos(angle), d = sin(angle);
    for (int64_t i = 0; i < 3 * s->count; i++) {
        float *f = s->triangle + 3 * i;
        double v[3] = {f[0], f[1], f[2]};
        double dot = v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
        double cross[3] = {n[1] * v[2] - n[2] * v[1], n[2] * v[0] - n[0] * v[2],
                           n[0] * v[1] - n[1] * v[0]};
        for (int k = 0; k < 3; k++)
            f[k] = (float)(v[k] * c + cross[k] * d + n[k] * dot * (1 - c));
    }
}

static void test_areas(void) {
    for (int m = 0; m < SOLID_COUNT; m++)
        for (int turn = 0; turn < 3; turn++) {
            shape s = {0};
            all_solids[m].make(&s);
            turn_shape(&s, 0.7 * turn);
            check_sections(&s, all_solids[m].name, 0.23, 0.7 * turn);
            shape_free(&s);
        }
}

/* Known areas, so that the sum itself is known to be right. */
static void test_areas_in_closed_form(void) {
    shape s = {0};
    solid_cavity(&s);
    CHECK_NEAR(256, shape_area_at(&s, 1), 1e-12);
    CHECK_NEAR(192, shape_area_at(&s, 6), 1e-12);
    CHECK_NEAR(16 * 16 * 12 - 8 * 8 * 6, shape_volume(&s), 1e-9);
    shape_free(&s);
    shape_tetrahedron(&s, 10);
    CHECK_NEAR(18, shape_area_at(&s, 4), 1e-12);
    shape_free(&s);
    shape_torus(&s, (shape_point){0, 0, 0}, 9, 4, 400, 400);
    CHECK_NEAR(SHAPE_PI * (13 * 13 - 5 * 5), shape_area_at(&s, 0), 0.05);
    shape_free(&s);
}

/* What outlines lose by gcode_resolution is what the settings say: 0.4 of it. */
static void test_thinning_of_settings(void) {
    iso_options options;
    iso_layer_settings settings;
    iso_options_defaults(&options);
    settings_of_layer(&settings, &options, 1, 0.3);
    CHECK_EQUAL(50, settings.thinning);
    options.gcode_resolution = 0;
    settings_of_layer(&settings, &options, 1, 0.3);
    CHECK_EQUAL(0, settings.thinning);
}

int main(void) {
    RUN(test_areas_in_closed_form);
    RUN(test_areas);
    RUN(test_thinning_of_settings);
    return check_verdict();
}
