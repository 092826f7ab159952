/* Slices by fields against closed forms. */
#include "check.h"

#include "base/memory.h"
#include "models/shapes.h"
#include "slice/brute.h"
#include "slice/fields.h"
#include "slice/range.h"

#include <isoslice/slice.h>

static double value_of(const void *field, iso_vec3 at) {
    return test_value(field, at);
}

/* Everything that can be said of any slice. `fine` as area_above has it; areas agree within
 * `allowed` mm^2. */
static void check_slice(const iso_mesh *mesh, const test_field *f, const double *level,
                        int32_t count, int fine, double allowed) {
    iso_field_slicing options = iso_field_slicing_defaults();
    iso_curves c;
    if (!CHECK_OK(iso_slice_field(&c, mesh, &f->field, level, count, &options)))
        return;
    check_structure(&c, count);
    CHECK(worst_level(&c, value_of, f, level) < 1e-6);
    CHECK(worst_mesh(&c, mesh) < 1e-9);
    for (int32_t l = 0; l < count; l++) {
        iso_vec3 expected = area_above(mesh, value_of, f, level[l], fine),
                 found = level_area(&c, l);
        /* what is above lies on the left, seen from outside */
        CHECK_NEAR(expected.x, found.x, allowed);
        CHECK_NEAR(expected.y, found.y, allowed);
        CHECK_NEAR(expected.z, found.z, allowed);
    }
    iso_curves_free(&c);
}

/* ---- models ---- */

static void make(iso_mesh *mesh, shape *s) {
    CHECK_OK(iso_mesh_from_triangles(mesh, s->triangle, s->count));
    shape_free(s);
}

static void make_cube(iso_mesh *mesh) {
    shape s = {0};
    shape_box(&s, -10, -10, -10, 10, 10, 10);
    make(mesh, &s);
}

static void make_round(iso_mesh *mesh, int torus, int n) {
    shape s = {0};
    if (torus)
        shape_torus(&s, (shape_point){0, 0, 0}, 10, 4, 2 * n, n);
    else
        shape_sphere(&s, (shape_point){0, 0, 0}, 10, n, 2 * n);
    make(mesh, &s);
}

/* Closed, with bumps and folds, as scans are. */
static void make_noisy(iso_mesh *mesh, int rings, uint64_t seed) {
    shape s = {0};
    shape_sphere(&s, (shape_point){0, 0, 0}, 10, rings, 2 * rings);
    CHECK_OK(iso_mesh_from_triangles(mesh, s.triangle, s.count));
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        iso_vec3 *p = &mesh->position[v];
        double swell = 1 + 0.3 * sin(0.5 * p->x) * cos(0.4 * p->y) +
                       0.04 * (shape_random(&seed) % 1000 / 500.0 - 1);
        *p = (iso_vec3){p->x * swell, p->y * swell, p->z * swell};
    }
    shape_free(&s);
    mesh->min = mesh->max = mesh->position[0];
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        iso_vec3 p = mesh->position[v];
        mesh->min =
            (iso_vec3){fmin(mesh->min.x, p.x), fmin(mesh->min.y, p.y), fmin(mesh->min.z, p.z)};
        mesh->max =
            (iso_vec3){fmax(mesh->max.x, p.x), fmax(mesh->max.y, p.y), fmax(mesh->max.z, p.z)};
    }
}

/* ---- tests ---- */

/* A cylinder of radius 2 through two triangles of a cube, meeting none of their edges. */
static void test_hidden_loop(void) {
    iso_mesh mesh;
    iso_curves c;
    test_field f = test_round(4, -4, 0, (iso_vec3){1, 1, 0});
    double level[] = {2};
    make_cube(&mesh);
    for (double tolerance = 0.02; tolerance > 0.0005; tolerance /= 2) {
        iso_field_slicing options = {tolerance, 0.002};
        if (!CHECK_OK(iso_slice_field(&c, &mesh, &f.field, level, 1, &options)))
            break;
        check_structure(&c, 1);
        CHECK_EQUAL(2, c.contour_count);
        for (int32_t i = 0; i < c.contour_count; i++) {
            iso_vec3 a = contour_area(&c, i);
            double circle = SHAPE_PI * 4, lost = 2 * SHAPE_PI * 2 * tolerance;
            CHECK_NEAR(circle, fabs(a.z), lost);
            CHECK(fabs(a.z) < circle);
            CHECK_NEAR(0, hypot(a.x, a.y), 1e-9);
        }
        CHECK(worst_level(&c, value_of, &f, level) < 1e-6);
        CHECK(worst_mesh(&c, &mesh) < 1e-9);
        for (int64_t i = 0; i + 1 < c.contour_first[1]; i++) { /* chords */
            iso_vec3 middle = mix(c.point[i], c.point[i + 1], 0.5);
            CHECK(2 - test_value(&f, middle) < 1.05 * tolerance);
        }
        iso_curves_free(&c);
    }
    iso_mesh_free(&mesh);
}

/* So small that no edge that is split for other reasons happens to meet it. */
static void test_tiny_loops(void) {
    iso_mesh mesh;
    uint64_t seed = 4;
    double level[] = {0.05};
    make_cube(&mesh);
    for (int i = 0; i < 40; i++) {
        iso_curves c;
        double x = shape_random(&seed) % 18000 / 1000.0 - 9;
        double y = shape_random(&seed) % 18000 / 1000.0 - 9;
        test_field f = test_round(x, y, 0, (iso_vec3){1, 1, 0});
        if (!CHECK_OK(iso_slice_field(&c, &mesh, &f.field, level, 1, NULL)))
            break;
        CHECK_EQUAL(2, c.contour_count);
        iso_curves_free(&c);
    }
    iso_mesh_free(&mesh);
}

/* In the middle of a slanted face, where the boxes around its three edges don't reach. */
static void test_loop_far_from_edges(void) {
    shape s = {0};
    iso_mesh mesh;
    iso_curves c;
    test_field f = test_round(20 / 3.0, 20 / 3.0, 20 / 3.0, (iso_vec3){1, 1, 1});
    double level[] = {2};
    shape_tetrahedron(&s, 20);
    make(&mesh, &s);
    if (CHECK_OK(iso_slice_field(&c, &mesh, &f.field, level, 1, NULL))) {
        CHECK_EQUAL(1, c.contour_count);
        iso_vec3 a = contour_area(&c, 0);
        CHECK_NEAR(SHAPE_PI * 4, sqrt(dot(a, a)), 2 * SHAPE_PI * 2 * 0.01);
        CHECK_NEAR(a.x, a.y, 1e-6);
        iso_curves_free(&c);
    }
    iso_mesh_free(&mesh);
}

/* A level that crosses an edge twice, with equal signs at its ends, between faces that it hides no
 * loop on; lines need not be straight. */
static void test_edge_crossed_twice(void) {
    iso_mesh mesh;
    iso_curves c;
    test_field f = test_cone(30, 0, 0.5);
    double level[] = {20.3};
    int on_edge = 0;
    make_cube(&mesh);
    if (CHECK_OK(iso_slice_field(&c, &mesh, &f.field, level, 1, &(iso_field_slicing){0, 0.002}))) {
        CHECK_EQUAL(1, c.contour_count);
        for (int64_t i = 0; i < c.crossing_count; i++)
            if (fabs(c.point[i].x - 10) < 1e-9 && fabs(c.point[i].z - 10) < 1e-9) {
                CHECK_NEAR(sqrt(20.6 * 20.6 - 400), fabs(c.point[i].y), 1e-6);
                on_edge++;
            }
        CHECK_EQUAL(2, on_edge);
        iso_curves_free(&c);
    }
    iso_mesh_free(&mesh);
}

/* With all levels and kinds on 12 triangles, where everything hides. */
static void test_cube(void) {
    test_field f[] = {
        test_plane(0.48, 0.6, 0.64),
        test_cone(2, 3, 0.5),
        test_round(4, -4, 3, (iso_vec3){1, 1, 1}),
        test_round(0, 0, 0, (iso_vec3){0, 1, 1}),
        test_wave(3, 7),
        test_saddle(1, -2, 0.2, 0.1),
        test_saddle(1, -2, 0.2, 0),
    };
    double level[] = {-8.1, -3.03, 0.05, 1.7, 4.04, 7, 9.99, 10.01, 12.5, 13.9, 17};
    iso_mesh mesh;
    make_cube(&mesh);
    for (size_t i = 0; i < sizeof f / sizeof *f; i++)
        check_slice(&mesh, &f[i], level, 11, 300, 0.35);
    iso_mesh_free(&mesh);
}

/* F = z by the way of fields is what planar slicing gives. */
static void test_plane_is_planar(void) {
    iso_mesh mesh;
    iso_slices s;
    iso_curves c[2];
    iso_levels levels;
    test_field f = test_plane(0, 0, 1);
    make_noisy(&mesh, 20, 5);
    iso_mesh_translate(&mesh, (iso_vec3){0, 0, -mesh.min.z});
    CHECK_OK(iso_levels_uniform(&levels, mesh.max.z, 0.3, 0.3));
    double *height = malloc((size_t)mesh.vertex_count * sizeof *height);
    for (int32_t v = 0; v < mesh.vertex_count; v++)
        height[v] = mesh.position[v].z;
    CHECK_OK(iso_slice_planar(&s, &mesh, &levels));
    CHECK_OK(iso_slice_field(&c[0], &mesh, &f.field, levels.cut, levels.count, NULL));
    CHECK_OK(iso_slice_heights(&c[1], &mesh, height, levels.cut, levels.count));
    for (int k = 0; k < 2; k++) {
        CHECK_EQUAL(s.crossing_count, c[k].crossing_count);
        CHECK_EQUAL(s.contour_count, c[k].contour_count);
        CHECK(!memcmp(s.contour_first, c[k].contour_first,
                      ((size_t)s.contour_count + 1) * sizeof *s.contour_first));
        CHECK(!memcmp(s.level_first, c[k].level_first,
                      ((size_t)s.level_count + 1) * sizeof *s.level_first));
        for (int64_t i = 0; i < s.crossing_count; i++)
            CHECK(s.point[i].x == c[k].point[i].x && s.point[i].y == c[k].point[i].y);
        CHECK(worst_level(&c[k], value_of, &f, levels.cut) < 1e-12);
        iso_curves_free(&c[k]);
    }
    free(height);
    iso_slices_free(&s);
    iso_levels_free(&levels);
    iso_mesh_free(&mesh);
}

/* Twice as fine a mesh has a quarter of the error: of curves on a sphere and a torus, whose area
 * is known. */
static void check_convergence(int torus, const test_field *f, double level, int32_t contours,
                              double area) {
    double error[4];
    for (int k = 0; k < 4; k++) {
        iso_mesh mesh;
        iso_curves c;
        iso_field_slicing options = {1e-4, 1e-3};
        make_round(&mesh, torus, 12 << k);
        if (!CHECK_OK(iso_slice_field(&c, &mesh, &f->field, &level, 1, &options)))
            return;
        CHECK_EQUAL(contours, c.contour_count);
        CHECK(worst_level(&c, value_of, f, &level) < 1e-6);
        double found = 0;
        for (int32_t i = 0; i < c.contour_count; i++) {
            iso_vec3 a = contour_area(&c, i);
            found += sqrt(dot(a, a));
        }
        error[k] = fabs(found - area);
        iso_curves_free(&c);
        iso_mesh_free(&mesh);
    }
    double exponent = log2(error[1] / error[3]) / 2;
    printf("  %s at %g: errors %.2g %.2g %.2g %.2g, exponent %.2f\n", torus ? "torus" : "sphere",
           level, error[0], error[1], error[2], error[3], exponent);
    CHECK_NEAR(2, exponent, 0.25);
}

/* Area of x = c cut from a torus, by the trapezium rule after y = Y sin(w). */
static double spiric_area(double c, double ring, double tube) {
    double sum = 0, most = sqrt((ring + tube) * (ring + tube) - c * c);
    int n = 200000;
    for (int i = 0; i <= n; i++) {
        double y = most * sin(SHAPE_PI * ((double)i / n - 0.5));
        double far = sqrt(c * c + y * y) - ring, z2 = tube * tube - far * far;
        sum += z2 > 0 ? 2 * sqrt(z2) * most * cos(SHAPE_PI * ((double)i / n - 0.5)) : 0;
    }
    return sum * SHAPE_PI / n;
}

static void test_convergence(void) {
    test_field up = test_plane(0, 0, 1), tilted = test_plane(0.48, 0.6, 0.64);
    test_field across = test_plane(1, 0, 0);
    test_field cone = test_cone(0, 0, 0.5), ball = test_round(0, 0, 7, (iso_vec3){1, 1, 1});
    check_convergence(0, &up, 3.3, 1, SHAPE_PI * (100 - 3.3 * 3.3));
    check_convergence(0, &tilted, 3.3, 1, SHAPE_PI * (100 - 3.3 * 3.3));
    /* two spheres whose middles are 7 apart: z = (100 - r^2 + 49) / 14 on both */
    double z = (100 - 36 + 49) / 14.0;
    check_convergence(0, &ball, 6, 1, SHAPE_PI * (100 - z * z));
    /* z + rho / 2 = 6 on the sphere: rho^2 + (6 - rho / 2)^2 = 100 */
    double root = sqrt(36 + 5 * 64.0), rho = (6 + root) / 2.5;
    check_convergence(0, &cone, 6, 1, SHAPE_PI * rho * rho);
    double far = sqrt(16 - 1.1 * 1.1);
    check_convergence(1, &up, 1.1, 2,
                      SHAPE_PI * ((10 + far) * (10 + far) + (10 - far) * (10 - far)));
    check_convergence(1, &across, 2.2, 2, spiric_area(2.2, 10, 4));
    check_convergence(1, &across, 8, 1, spiric_area(8, 10, 4));
}

/* A cylinder round the axis of a sphere or a torus cuts out circles of its own radius whatever the
 * mesh, but at heights that get better with it. */
static void check_coaxial(int torus) {
    test_field f = test_round(0, 0, 0, (iso_vec3){1, 1, 0});
    double error[4], level[16];
    for (int l = 0; l < 16; l++)
        level[l] = torus ? 10.53 + 0.11 * l : 3.1 + 0.17 * l;
    for (int k = 0; k < 4; k++) {
        iso_mesh mesh;
        iso_curves c;
        make_round(&mesh, torus, 12 << k);
        if (!CHECK_OK(
                iso_slice_field(&c, &mesh, &f.field, level, 16, &(iso_field_slicing){1e-4, 1e-3})))
            return;
        CHECK_EQUAL(32, c.contour_count);
        error[k] = 0;
        for (int l = 0; l < 16; l++) {
            double r = level[l], z = sqrt(torus ? 16 - (r - 10) * (r - 10) : 100 - r * r);
            for (int32_t i = c.level_first[l]; i < c.level_first[l + 1]; i++) {
                CHECK_NEAR(SHAPE_PI * r * r, fabs(contour_area(&c, i).z), 2 * SHAPE_PI * r * 1e-4);
                for (int64_t j = c.contour_first[i]; j < c.contour_first[i + 1]; j++) {
                    double off = fabs(c.point[j].z) - z;
                    error[k] += off * off / (double)c.crossing_count;
                }
            }
        }
        iso_curves_free(&c);
        iso_mesh_free(&mesh);
    }
    double exponent = log2(error[1] / error[3]) / 4;
    printf("  coaxial cylinders and %s: errors %.2g %.2g %.2g %.2g mm, exponent %.2f\n",
           torus ? "torus" : "sphere", sqrt(error[0]), sqrt(error[1]), sqrt(error[2]),
           sqrt(error[3]), exponent);
    CHECK_NEAR(2, exponent, 0.25);
}

static void test_coaxial(void) {
    check_coaxial(0);
    check_coaxial(1);
}

static void test_noisy(void) {
    test_field f[] = {
        test_plane(0.48, 0.6, 0.64),
        test_cone(1, 0.5, 0.3),
        test_round(2, 1, -20, (iso_vec3){1, 1, 1}),
        test_round(0.5, 0.5, 1, (iso_vec3){1, 0, 1}),
        test_wave(1, 8),
        test_saddle(0, 0, 0.1, 1),
    };
    iso_mesh mesh;
    double level[40];
    make_noisy(&mesh, 16, 77);
    for (int i = 0; i < 40; i++)
        level[i] = -9.5 + 0.81 * i;
    for (size_t i = 0; i < sizeof f / sizeof *f; i++)
        check_slice(&mesh, &f[i], level, 40, 8, 0.35);
    iso_mesh_free(&mesh);
}

/* Levels that touch faces, edges and corners without crossing them, or lie in a face. */
static void test_touching(void) {
    iso_mesh mesh;
    make_cube(&mesh);
    double round[] = {10, 10 * sqrt(2), 10 * sqrt(3)}, height[] = {-10, 10}, zero[] = {0};
    test_field axis = test_round(0, 0, 0, (iso_vec3){1, 1, 0});
    test_field ball = test_round(0, 0, 0, (iso_vec3){1, 1, 1});
    test_field slab = test_round(0, 0, 0, (iso_vec3){0, 0, 1}), up = test_plane(0, 0, 1);
    test_field nothing = test_plane(0, 0, 0), saddle = test_saddle(0, 0, 1, 0);
    check_slice(&mesh, &axis, round, 3, 100, 0.5);
    check_slice(&mesh, &ball, round, 3, 100, 0.5);
    check_slice(&mesh, &slab, round, 1, 10, 1e-9);
    check_slice(&mesh, &up, height, 2, 10, 1e-9);
    check_slice(&mesh, &nothing, zero, 1, 10, 1e-9);
    check_slice(&mesh, &saddle, zero, 1, 100, 0.5);
    iso_mesh_free(&mesh);
}

/* What hides inside faces counts, as far as samples can tell. */
static void test_range(void) {
    test_field f[] = {test_round(4, -4, 0, (iso_vec3){1, 1, 0}),
                      test_wave(3, 7),
                      test_saddle(1, -2, 0.2, 0.1),
                      test_cone(2, 3, 0.5),
                      test_round(20, 1, 2, (iso_vec3){1, 1, 1}),
                      test_plane(0.48, 0.6, 0.64)};
    double expected[][2] = {
        {0, hypot(14, 14)},          {-13, 13},    {-27.4, 22.6}, {-10, 10 + 0.5 * hypot(12, 13)},
        {10, sqrt(900 + 121 + 144)}, {-17.2, 17.2}};
    iso_mesh mesh[2];
    make_cube(&mesh[0]);
    make_noisy(&mesh[1], 24, 77); /* all of it inside */
    for (int32_t v = 0; v < mesh[1].vertex_count; v++) {
        iso_vec3 *p = &mesh[1].position[v];
        *p = (iso_vec3){p->x / 2, p->y / 2, p->z / 2};
    }
    for (size_t i = 0; i < sizeof f / sizeof *f; i++) {
        double range[2];
        if (!CHECK_OK(field_range(range, &f[i].field, mesh, 2)))
            continue;
        CHECK_NEAR(expected[i][0], range[0], 0.0011);
        CHECK_NEAR(expected[i][1], range[1], 0.0011);
    }
    double range[2];
    test_field root = test_root(3);
    CHECK_STATUS(ISO_BAD_CONFIG, field_range(range, &root.field, mesh, 2));
    CHECK_STATUS(ISO_BAD_CONFIG, field_range(range, &f[0].field, mesh, 0));
    iso_mesh_free(&mesh[0]);
    iso_mesh_free(&mesh[1]);
}

/* Half a turn's jump in a field is no layer. */
static void jump(double *value, iso_vec3 *gradient, const iso_vec3 *at, int64_t count,
                 void *payload) {
    (void)payload;
    for (int64_t i = 0; i < count; i++) {
        value[i] = at[i].z + (at[i].x > 1.23 ? 5 : 0);
        if (gradient)
            gradient[i] = (iso_vec3){0, 0, 1};
    }
}
static void jump_bound(iso_field_bound *bound, iso_vec3 low, iso_vec3 high, void *payload) {
    (void)payload;
    double x = low.x <= 1.23 && high.x > 1.23 ? INFINITY : 0;
    *bound = (iso_field_bound){low.z, high.z + 5, {-x, 0, 1}, {x, 0, 1}};
}

static void test_jump(void) {
    iso_mesh mesh;
    iso_curves c;
    iso_field *field;
    double level[] = {0, 3, 6}, rise, x, y, z;
    make_cube(&mesh);
    CHECK_OK(iso_field_from_function(&field, jump, jump_bound, 0, NULL));
    CHECK_STATUS(ISO_UNSLICEABLE, iso_slice_field(&c, &mesh, field, level, 3, NULL));
    CHECK(sscanf(iso_error_message(), "the field jumps by %lf mm at (%lf, %lf, %lf)", &rise, &x, &y,
                 &z) == 4);
    CHECK_NEAR(5, rise, 0.1);
    CHECK_NEAR(1.23, x, 0.005);
    iso_field_free(field);
    iso_mesh_free(&mesh);
}

/* Every face along it would take hundreds of thousands of looks, at a field that may be slow. */
static void jump_counted(double *value, iso_vec3 *gradient, const iso_vec3 *at, int64_t count,
                         void *payload) {
    *(int64_t *)payload += count;
    jump(value, gradient, at, count, NULL);
}

static void test_jump_is_found_quickly(void) {
    iso_mesh mesh;
    iso_curves c;
    iso_field *field;
    int64_t looks = 0;
    double level[] = {0, 3, 6};
    make_cube(&mesh);
    CHECK_OK(iso_field_from_function(&field, jump_counted, jump_bound, 0, &looks));
    CHECK_STATUS(ISO_UNSLICEABLE, iso_slice_field(&c, &mesh, field, level, 3, NULL));
    CHECK(looks < 1000);
    iso_field_free(field);
    iso_mesh_free(&mesh);
}

static void test_no_value(void) {
    iso_mesh mesh;
    iso_curves c = {0};
    test_field f = test_root(3);
    double level[] = {1}, x = 0, y, z;
    make_cube(&mesh);
    CHECK_STATUS(ISO_UNSLICEABLE, iso_slice_field(&c, &mesh, &f.field, level, 1, NULL));
    const char *at = strchr(iso_error_message(), '(');
    CHECK(at && sscanf(at, "(%lf, %lf, %lf) mm", &x, &y, &z) == 3);
    CHECK(x < 3 && isnan(test_value(&f, (iso_vec3){x, y, z})));
    CHECK(!c.point && c.level_count == 0);
    iso_mesh_free(&mesh);
}

static void test_bad_use(void) {
    iso_mesh mesh;
    iso_curves c;
    test_field f = test_plane(0, 0, 1);
    double twice[] = {1, 1}, infinite[] = {INFINITY}, one[] = {1};
    make_cube(&mesh);
    CHECK_STATUS(ISO_USAGE, iso_slice_field(&c, &mesh, &f.field, twice, 2, NULL));
    CHECK_STATUS(ISO_USAGE, iso_slice_field(&c, &mesh, &f.field, infinite, 1, NULL));
    CHECK_STATUS(ISO_USAGE,
                 iso_slice_field(&c, &mesh, &f.field, one, 1, &(iso_field_slicing){-1, 1}));
    CHECK_STATUS(ISO_USAGE,
                 iso_slice_field(&c, &mesh, &f.field, one, 1, &(iso_field_slicing){1, 0}));
    double height[8] = {0, 0, NAN, 0, 0, 0, 0, 0};
    CHECK_STATUS(ISO_UNSLICEABLE, iso_slice_heights(&c, &mesh, height, one, 1));
    if (CHECK_OK(iso_slice_field(&c, &mesh, &f.field, one, 0, NULL)))
        check_structure(&c, 0);
    iso_curves_free(&c);
    iso_mesh_free(&mesh);
}

static void test_allocation_failures(void) {
    iso_mesh mesh;
    iso_curves c;
    test_field f = test_round(4, -4, 0, (iso_vec3){1, 1, 0});
    double level[] = {2, 5};
    make_cube(&mesh);
    for (int64_t n = 0;; n++) {
        iso_fail_allocation_after(n);
        iso_status status = iso_slice_field(&c, &mesh, &f.field, level, 2, NULL);
        iso_fail_allocation_after(-1);
        if (status == ISO_OK) {
            CHECK(n > 20);
            iso_curves_free(&c);
            break;
        }
        CHECK_STATUS(ISO_NO_MEMORY, status);
        CHECK(!c.point);
    }
    iso_mesh_free(&mesh);
}

int main(void) {
    RUN(test_hidden_loop);
    RUN(test_tiny_loops);
    RUN(test_loop_far_from_edges);
    RUN(test_edge_crossed_twice);
    RUN(test_cube);
    RUN(test_plane_is_planar);
    RUN(test_convergence);
    RUN(test_coaxial);
    RUN(test_noisy);
    RUN(test_touching);
    RUN(test_range);
    RUN(test_jump);
    RUN(test_jump_is_found_quickly);
    RUN(test_no_value);
    RUN(test_bad_use);
    RUN(test_allocation_failures);
    return check_verdict();
}
