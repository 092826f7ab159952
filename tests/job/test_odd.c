/* Models that aren't one sound shell: what is sliced is where they turn around a point once or more
 * (by sections cut here, triangle by triangle, and swept line by line), or they are refused; as
 * docs/models.md says. */
#include "checks.h"

#include <isoslice/mesh.h>
#include <stdlib.h>

#include "solids.h"

#define PLAIN                                                                                      \
    "layer_height = 0.1\nfirst_layer_height = 0.1\nfill_density = 0\nperimeters = 1\n"             \
    "top_solid_layers = 0\nbottom_solid_layers = 0\n"

enum { SLABS = 240, LINES = 240, CROSSINGS = 400 };

typedef struct hit {
    double x;
    int way;
} hit;

/* Length of a line across a section where it is turned around once or more. */
static double wound_length(double (*piece)[4], int64_t count, double y) {
    hit list[CROSSINGS];
    int hits = 0, winding = 0;
    double length = 0;
    for (int64_t i = 0; i < count; i++) {
        const double *p = piece[i];
        if ((p[1] <= y) == (p[3] <= y) || hits == CROSSINGS)
            continue;
        hit h = {p[0] + (y - p[1]) / (p[3] - p[1]) * (p[2] - p[0]), p[1] > y ? 1 : -1};
        int k = hits++;
        for (; k > 0 && list[k - 1].x > h.x; k--)
            list[k] = list[k - 1];
        list[k] = h;
    }
    for (int k = 0; k + 1 < hits; k++) {
        winding += list[k].way;
        length += winding >= 1 ? list[k + 1].x - list[k].x : 0;
    }
    return length;
}

/* Up to `top` above the lowest point. */
static double wound_volume(const shape *s, double top) {
    shape_box3 b = shape_bounds(s);
    double(*piece)[4] = malloc((size_t)s->count * sizeof *piece), sum = 0;
    double dz = top / SLABS, dy = (b.max[1] - b.min[1]) / LINES;
    for (int i = 0; i < SLABS; i++) {
        int64_t count = shape_section(piece, s, b.min[2] + (i + 0.5) * dz);
        for (int k = 0; k < LINES; k++)
            sum += wound_length(piece, count, b.min[1] + (k + 0.5) * dy) * dy * dz;
    }
    free(piece);
    return sum;
}

static shape copy_of(const shape *s) {
    shape copy = {malloc((size_t)s->count * 9 * sizeof(float)), s->count, s->count};
    memcpy(copy.triangle, s->triangle, (size_t)s->count * 9 * sizeof(float));
    return copy;
}

/* Print it, with every contour looked at. `like`: the same solid, told plainly, or NULL: itself. */
static iso_report_solid odd(const shape *s, const shape *like, const char *settings,
                            iso_mesh_defects *defects) {
    print p;
    char all[512];
    snprintf(all, sizeof all, "%scheck_solid = full\n%s", PLAIN, settings);
    print_shape(&p, s, all);
    iso_report_solid found = p.report.solid;
    if (CHECK_EQUAL(ISO_OK, p.status)) {
        double own = wound_volume(like ? like : s, p.report.printed_height);
        CHECK_NEAR(own, p.report.sliced_volume, 0.005 * own);
        CHECK_EQUAL(found.contours, found.contours_checked);
        CHECK_EQUAL(0, found.contours_wrong);
        CHECK_EQUAL(FIO_OK, p.verdict);
        *defects = p.report.input[0].defects;
    } else {
        fprintf(stderr, "    %s\n", p.message);
        *defects = (iso_mesh_defects){0};
    }
    print_free(&p);
    return found;
}

static void refused(const shape *s, const char *settings, const char *why) {
    print p;
    print_shape(&p, s, settings);
    CHECK_EQUAL(ISO_UNSLICEABLE, p.status);
    if (!CHECK(strstr(p.message, why) != NULL))
        fprintf(stderr, "    %s\n", p.message);
    CHECK(p.text == NULL);
    print_free(&p);
}

static void test_overlapping_cubes(void) {
    shape s = {0};
    iso_mesh_defects defects;
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    shape_box(&s, 4, 6, 3, 14, 16, 13);
    CHECK_NEAR(2000 - 6 * 4 * 7, wound_volume(&s, 13), 12);
    iso_report_solid found = odd(&s, NULL, "", &defects);
    CHECK_EQUAL(2, found.shells);
    CHECK_EQUAL(2, found.shells_overlapping);
    CHECK_EQUAL(0, defects.inverted_shells);
    shape_free(&s);
}

static void test_cube_in_a_cube(void) {
    for (int cavity = 0; cavity < 2; cavity++) {
        shape s = {0};
        iso_mesh_defects defects;
        shape_box(&s, 0, 0, 0, 12, 12, 12);
        shape_box(&s, 3, 3, 3.03, 9, 9, 9.03);
        if (cavity)
            shape_turn(&s, 12, 24);
        iso_report_solid found = odd(&s, NULL, "", &defects);
        CHECK_EQUAL(2, found.shells);
        CHECK_EQUAL(cavity, found.cavities);
        CHECK_EQUAL(1 - cavity, found.shells_nested);
        CHECK_EQUAL(0, found.shells_overlapping);
        CHECK_EQUAL(0, defects.inverted_shells);
        shape_free(&s);
    }
}

/* Inside out, alone and around a cavity. */
static void test_inverted_cubes(void) {
    shape s = {0}, turned = {0};
    iso_mesh_defects defects;
    for (int cavity = 0; cavity < 2; cavity++) {
        shape_box(&s, 0, 0, 0, 12, 12, 12);
        if (cavity)
            shape_box(&s, 3, 3, 3.03, 9, 9, 9.03);
        if (cavity)
            shape_turn(&s, 12, 24);
        turned = copy_of(&s);
        shape_turn(&turned, 0, turned.count);
        iso_report_solid found = odd(&turned, &s, "", &defects);
        CHECK_EQUAL(cavity, found.cavities);
        CHECK_EQUAL(1 + cavity, defects.inverted_shells);
        shape_free(&s);
        shape_free(&turned);
    }
}

/* A bar that is wound one and a half times around and through itself. */
static void test_self_intersecting_shell(void) {
    shape s = {0};
    iso_mesh_defects defects;
    shape_torus(&s, (shape_point){0, 0, 6}, 4, 6, 64, 48);
    iso_report_solid found = odd(&s, NULL, "", &defects);
    CHECK_EQUAL(1, found.shells);
    CHECK_EQUAL(1, found.shells_overlapping);
    shape_free(&s);
}

/* Many round parts, each through its neighbours, with a hole to be closed. */
static void test_clump(void) {
    shape s = {0};
    iso_mesh_defects defects;
    for (int i = 0; i < 27; i++)
        shape_sphere(&s, (shape_point){4 * (i % 3), 3.7 * (i / 3 % 3), 3.1 + 4.3 * (i / 9)}, 3, 10,
                     20);
    shape whole = copy_of(&s);
    shape_remove(&s, 1000);
    iso_report_solid found = odd(&s, &whole, "", &defects);
    CHECK_EQUAL(27, found.shells);
    CHECK_EQUAL(27, found.shells_overlapping);
    CHECK_EQUAL(1, defects.holes_closed);
    shape_free(&s);
    shape_free(&whole);
}

/* From corner `from` / 3 to the next one. */
static double edge_length(const float *corner, int from) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double d = (double)corner[from + 3 + k] - corner[from + k];
        sum += d * d;
    }
    return sqrt(sum);
}

static void test_moebius_strip(void) {
    shape s = {0};
    shape_moebius(&s, 18, 4, 180);
    print p;
    refused(&s, "", "one side only");
    refused(&s, "", "sheet-thickness");
    print_shape(&p, &s, PLAIN "sheet_thickness = 1.6\ncheck_solid = full");
    double wanted = shape_surface(&s) * 1.6;
    if (CHECK_EQUAL(ISO_OK, p.status)) {
        CHECK_NEAR(wanted, p.report.sliced_volume, 0.005 * wanted);
        CHECK_EQUAL(1, p.report.input[0].defects.sheets);
        CHECK_EQUAL(0, p.report.solid.contours_wrong);
        CHECK(p.report.warning_count > 0 && strstr(p.report.warning[0].message, "1.6 mm"));
    }
    print_free(&p);
    /* on a grid the rim is round: half a disc along it */
    print_shape(&p, &s,
                PLAIN "sheet_thickness = 1.6\nrepair = volume\nrepair_voxel = 0.2\n"
                      "check_solid = full");
    double rim = 0; /* the edges of one quad's ends that run on to the next */
    for (int64_t t = 0; t < s.count; t++)
        rim += edge_length(s.triangle + 9 * t, t % 2 ? 3 : 0);
    wanted += rim * SHAPE_PI * 0.8 * 0.8 / 2;
    if (CHECK_EQUAL(ISO_OK, p.status)) {
        CHECK_NEAR(wanted, p.report.sliced_volume, 0.01 * wanted);
        CHECK_NEAR(0.2, p.report.input[0].defects.voxel, 0);
        CHECK(p.report.input[0].defects.largest_error < 0.2);
        CHECK_EQUAL(0, p.report.solid.contours_wrong);
    }
    print_free(&p);
    shape_free(&s);
}

static void test_open_surfaces(void) {
    shape s = {0}, whole = {0};
    iso_mesh_defects defects;
    shape_box(&s, 0, 0, 0, 16, 16, 16);
    shape_remove(&s, 2);
    shape_remove(&s, 2);
    refused(&s, "", "repair volume");
    /* the box of 17 x 17 x 16.5 that sheet_thickness makes around it, less what is within */
    shape_box(&whole, -0.5, -0.5, -0.5, 16.5, 16.5, 16);
    shape_box(&whole, 0.5, 0.5, 0.5, 15.5, 15.5, 16.001);
    shape_turn(&whole, 12, 24);
    odd(&s, &whole, "sheet_thickness = 1", &defects);
    CHECK_EQUAL(1, defects.sheets);
    shape_free(&whole);
    /* or the box that it encloses */
    shape_box(&whole, 0, 0, 0, 16, 16, 16);
    odd(&s, &whole, "repair = volume\nrepair_voxel = 0.25", &defects);
    CHECK_NEAR(0.25, defects.voxel, 0);
    CHECK(defects.largest_error > 0 && defects.largest_error < 0.25 * 1.8);
    shape_free(&whole);
    shape_free(&s);
}

/* A ball whose triangles have come apart. */
static void test_torn_ball(void) {
    shape s = {0}, whole = {0};
    iso_mesh_defects defects;
    uint64_t seed = 11;
    shape_sphere(&s, (shape_point){0, 0, 8}, 8, 24, 48);
    shape_sphere(&whole, (shape_point){0, 0, 8}, 8, 24, 48);
    for (int64_t i = 0; i < 9 * s.count; i++)
        s.triangle[i] += (float)(0.04 * (shape_random(&seed) / 2147483648.0 - 0.5));
    refused(&s, "", "open");
    odd(&s, &whole, "repair = volume\nrepair_voxel = 0.25", &defects);
    CHECK(defects.largest_error < 0.15);
    CHECK_EQUAL(s.count, defects.triangles_read);
    shape_free(&s);
    shape_free(&whole);
}

/* By solid angles, triangle by triangle: halves of them as angles of complex numbers, multiplied.
 * Each turn past the negative real axis, where the angle jumps, counts. */
static double generalized_winding(const shape *s, const double at[3]) {
    double re = 1, im = 0;
    int turns = 0;
    for (int64_t t = 0; t < s->count; t++) {
        double v[3][3], length[3];
        for (int k = 0; k < 9; k++)
            v[k / 3][k % 3] = s->triangle[9 * t + k] - at[k % 3];
        for (int k = 0; k < 3; k++)
            length[k] = sqrt(v[k][0] * v[k][0] + v[k][1] * v[k][1] + v[k][2] * v[k][2]);
        double det = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                     v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                     v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
        double rest = length[0] * length[1] * length[2];
        for (int k = 0; k < 3; k++) {
            const double *a = v[k], *b = v[(k + 1) % 3];
            rest += (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * length[(k + 2) % 3];
        }
        double size = fmax(fabs(det), fabs(rest)), x = rest / size, y = det / size;
        double next = re * y + im * x;
        re = re * x - im * y;
        if (y >= 0 && im >= 0 && next < 0)
            turns++;
        if (y < 0 && im < 0 && next >= 0)
            turns--;
        im = next;
        if (t % 64 == 63) { /* neither too large nor too small */
            size = fmax(fabs(re), fabs(im));
            re /= size;
            im /= size;
        }
    }
    return atan2(im, re) / (2 * SHAPE_PI) + turns;
}

static void test_random_triangles(void) {
    shape s = {0};
    uint64_t seed = 3;
    for (int i = 0; i < 1000; i++) {
        shape_point p[3];
        for (int k = 0; k < 3; k++) {
            double x = shape_random(&seed) / 2147483648.0, y = shape_random(&seed) / 2147483648.0;
            p[k] = (shape_point){24 * x, 24 * y, 24 * (shape_random(&seed) / 2147483648.0)};
        }
        shape_add(&s, p[0], p[1], p[2]);
    }
    refused(&s, "", "open");
    print p;
    print_shape(&p, &s, PLAIN "repair = volume\nrepair_voxel = 1\ncheck_solid = full");
    enum { N = 40 }; /* a million points: 5482.7 mm3 */
    const double step = 24.0 / N;
    int64_t count = 0;
    for (int i = 0; i < N * N * N; i++) {
        double at[3] = {step * (i % N + 0.5), step * (i / N % N + 0.5), step * (i / N / N + 0.5)};
        count += generalized_winding(&s, at) >= 0.5;
    }
    double inside = (double)count * step * step * step;
    CHECK_NEAR(5482.7, inside, 0.005 * inside);
    if (CHECK_EQUAL(ISO_OK, p.status)) {
        CHECK_EQUAL(0, p.report.solid.contours_wrong);
        /* lumps hardly larger than the voxels: what is finer is lost, but as much is enclosed */
        CHECK_NEAR(p.report.mesh_volume, p.report.sliced_volume, 0.005 * p.report.mesh_volume);
        CHECK_NEAR(inside, p.report.mesh_volume, 0.005 * inside);
        CHECK_NEAR(inside, p.report.sliced_volume, 0.005 * inside);
        CHECK(p.report.input[0].defects.largest_error >= 3); /* most of them bound nothing */
    }
    print_free(&p);
    shape_free(&s);
}

/* test-job-odd [SHARE]: one of three shares of the tests, so that they run beside each other. */
int main(int argc, char **argv) {
    int share = argc > 1 ? atoi(argv[1]) % 3 : -1;
    if (share <= 0) {
        RUN(test_overlapping_cubes);
        RUN(test_cube_in_a_cube);
        RUN(test_inverted_cubes);
        RUN(test_random_triangles);
    }
    if (share < 0 || share == 1) {
        RUN(test_self_intersecting_shell);
        RUN(test_clump);
        RUN(test_moebius_strip);
    }
    if (share < 0 || share == 2) {
        RUN(test_open_surfaces);
        RUN(test_torn_ball);
    }
    CHECK(print_folder_remove());
    return check_verdict();
}
