/* Layers of auto-top: level on the tops of parts made of formulas, and nowhere too steep, too thick
 * or upside down. */
#include "height/fields.h"

#include <stdlib.h>
#include <time.h>

#include "base/memory.h"
#include "base/vector.h"
#include "check.h"
#include "models/shapes.h"

#define PI SHAPE_PI

static const iso_vec3 nowhere = {0, 0, 0};
static uint64_t seed = 5;

static double uniform(double low, double high) {
    return low + (high - low) * shape_random(&seed) / 0x1p31;
}

/* A part with a flat foot, upright sides and a top that is a height over the plane. */
typedef double height_over(double x, double y);

static void shape_under(shape *s, height_over *top, double width, double depth, int nx, int ny) {
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++) {
            shape_point p[4], q[4];
            for (int k = 0; k < 4; k++) {
                double x = width * ((i + (k == 1 || k == 2)) / (double)nx - 0.5);
                double y = depth * ((j + (k >= 2)) / (double)ny - 0.5);
                p[k] = (shape_point){x, y, top(x, y)};
                q[k] = (shape_point){x, y, 0};
            }
            shape_quad(s, p[0], p[1], p[2], p[3]);
            shape_quad(s, q[0], q[3], q[2], q[1]);
            if (j == 0)
                shape_quad(s, q[0], q[1], p[1], p[0]);
            if (j == ny - 1)
                shape_quad(s, q[2], q[3], p[3], p[2]);
            if (i == 0)
                shape_quad(s, q[3], q[0], p[0], p[3]);
            if (i == nx - 1)
                shape_quad(s, q[1], q[2], p[2], p[1]);
        }
}

typedef struct part {
    const char *name;
    height_over *top;
    double width, depth, slope;
    double spread; /* mm that F may vary by over the tops, but for a share of their area */
    double share;
} part;

static double dome(double x, double y) {
    return 10 + sqrt(80 * 80 - x * x - y * y) - sqrt(80 * 80 - 2 * 30 * 30);
}

static double wedge(double x, double y) {
    (void)y;
    return 20 + x * tan(15 * PI / 180);
}

static double saddle(double x, double y) {
    return 20 + x * x / 120 - y * y / 160;
}

/* As thick as a wing's upper side, with a steep nose. */
static double wing(double x, double y) {
    double u = (x + 40) / 80;
    return 8 +
           30 * (0.2969 * sqrt(u) - 0.126 * u - 0.3516 * u * u + 0.2843 * u * u * u -
                 0.1015 * u * u * u * u) +
           0.02 * y;
}

static double steep_wedge(double x, double y) {
    (void)y;
    return 6.4 + x * tan(22 * PI / 180);
}

static double roof(double x, double y) {
    return 22 - 0.4 * fabs(x) - 0.0 * y;
}

static double flat(double x, double y) {
    (void)x;
    (void)y;
    return 12;
}

static const part parts[] = {
    {"dome", dome, 60, 60, 40, 0.05, 0.02},
    {"wedge", wedge, 60, 40, 40, 0.05, 0.02},
    {"saddle", saddle, 70, 60, 40, 0.05, 0.02},
    {"wing", wing, 80, 50, 40, 0.05, 0.05},
    {"steep wedge", steep_wedge, 24, 10, 40, 0.1, 0.4},
    {"roof", roof, 60, 40, 40, 0.05, 0.08},
    {"plate", flat, 20, 10, 40, 0.001, 0},
};

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of all of the top that is no steeper than 0.9 of the limit, the narrowest band of F that holds
 * 1 - share. */
static double spread_of(const iso_field *field, const part *p, double share) {
    enum { N = 200 };
    static double value[N * N];
    int count = 0;
    for (int i = 0; i < N * N; i++) {
        double x = p->width * ((i % N + 0.5) / N - 0.5), y = p->depth * ((i / N + 0.5) / N - 0.5);
        double e = 1e-4, z = p->top(x, y);
        double sx = (p->top(x + e, y) - z) / e, sy = (p->top(x, y + e) - z) / e;
        if (sqrt(sx * sx + sy * sy) > 0.9 * tan(p->slope * PI / 180))
            continue;
        iso_vec3 at = {x, y, z};
        iso_field_evaluate(&value[count++], NULL, field, &at, 1);
    }
    qsort(value, (size_t)count, sizeof *value, compare);
    int band = (int)ceil((1 - share) * count) - 1;
    double best = INFINITY;
    for (int i = 0; i + band < count; i++)
        best = fmin(best, value[i + band] - value[i]);
    return best;
}

/* Within the part: rises by 0.3 at least, lies no steeper than the limit, and is flat at the
 * foot. */
static void check_layers(const iso_field *field, const part *p) {
    double least = INFINITY, most = 0, steepest = 0, bent = 0;
    for (int i = 0; i < 40000; i++) {
        double x = uniform(-0.5, 0.5) * p->width, y = uniform(-0.5, 0.5) * p->depth;
        double z = uniform(0, p->top(x, y)), value;
        iso_vec3 at = {x, y, z}, g;
        iso_field_evaluate(&value, &g, field, &at, 1);
        least = fmin(least, g.z);
        most = fmax(most, g.z);
        steepest = fmax(steepest, sqrt(g.x * g.x + g.y * g.y) / g.z);
        at.z = uniform(0, 0.7);
        iso_field_evaluate(&value, &g, field, &at, 1);
        bent = fmax(bent, fabs(value - at.z) + fabs(g.x) + fabs(g.y));
    }
    printf("     %s: layers %.2f to %.2f times as thick, up to %.2f degrees\n", p->name, 1 / most,
           1 / least, atan(steepest) * 180 / PI);
    CHECK(least >= 0.3);
    CHECK(steepest <= tan(p->slope * PI / 180) * (1 + 1e-9));
    CHECK_NEAR(0, bent, 1e-15);
}

static int part_mesh(iso_mesh *mesh, const part *p) {
    shape s = {0};
    shape_under(&s, p->top, p->width, p->depth, (int)p->width, (int)p->depth);
    int made = CHECK_OK(iso_mesh_from_triangles(mesh, s.triangle, s.count));
    shape_free(&s);
    return made;
}

static void test_tops(void) {
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const part *p = &parts[i];
        iso_mesh mesh;
        iso_field *field;
        if (!part_mesh(&mesh, p))
            continue;
        clock_t begin = clock();
        if (CHECK_OK(iso_field_open(&field, "auto-top", &mesh, 1, p->slope, nowhere))) {
            double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
            printf("     %s: F varies by %.4f mm on all of its top, %.4f on %g %%; %.2f s\n",
                   p->name, spread_of(field, p, 0), spread_of(field, p, p->share),
                   100 * (1 - p->share), seconds);
            CHECK(spread_of(field, p, p->share) <= p->spread);
            check_layers(field, p);
            iso_field_free(field);
        }
        iso_mesh_free(&mesh);
    }
}

/* A dome, over it a roof that floats, which no layers can both follow, and beside them a tower: no
 * layer is too steep anywhere, and the tower has its own. */
static double high_roof(double x, double y) {
    return 45 - 0.3 * fabs(x) + 0.1 * y;
}

static double tower(double x, double y) {
    return 60 + 0.2 * x - 0.3 * y;
}

static void test_several(void) {
    const part part_of[] = {{"lower", dome, 60, 60, 40, 0, 0},
                            {"upper", high_roof, 40, 30, 40, 0, 0},
                            {"tower", tower, 20, 20, 40, 0, 0}};
    iso_mesh mesh[3] = {{0}};
    iso_field *field;
    for (int i = 0; i < 3; i++)
        if (!part_mesh(&mesh[i], &part_of[i]))
            return;
    for (int32_t v = 0; v < mesh[1].vertex_count; v++)
        if (mesh[1].position[v].z == 0)
            mesh[1].position[v].z = 30;
    mesh[1].min.z = 30;
    iso_mesh_translate(&mesh[2], (iso_vec3){45, 0, 0});
    if (CHECK_OK(iso_field_open(&field, "auto-top", mesh, 3, 40, nowhere))) {
        check_layers(field, &part_of[0]);
        check_layers(field, &part_of[1]); /* and the air below */
        double steepest = 0, least = 1, low = INFINITY, high = -INFINITY;
        for (int i = 0; i < 20000; i++) {
            double x = uniform(-10, 10), y = uniform(-10, 10), top = tower(x, y), value;
            iso_vec3 at = {x + 45, y, i % 4 ? uniform(0, top) : top}, g;
            iso_field_evaluate(&value, &g, field, &at, 1);
            steepest = fmax(steepest, sqrt(g.x * g.x + g.y * g.y) / g.z);
            least = fmin(least, g.z);
            if (i % 4 == 0 && fmax(fabs(x), fabs(y)) < 9) {
                low = fmin(low, value);
                high = fmax(high, value);
            }
        }
        CHECK(steepest <= tan(40 * PI / 180) && least >= 0.3);
        printf("     tower: F varies by %.4f mm within its edges\n", high - low);
        CHECK(high - low < 0.05);
        iso_field_free(field);
    }
    for (int i = 0; i < 3; i++)
        iso_mesh_free(&mesh[i]);
}

/* A top that is steeper than layers may lie is left alone, and so is one of a machine that can't
 * bend layers at all: F is z. */
static void test_steep(void) {
    const part p = {"ramp", steep_wedge, 24, 10, 20, 0, 0};
    iso_mesh mesh;
    iso_field *field;
    if (!part_mesh(&mesh, &p))
        return;
    for (int i = 0; i < 2; i++)
        if (CHECK_OK(iso_field_open(&field, "auto-top", &mesh, 1, i ? 0 : 20, nowhere))) {
            double worst = 0;
            for (int k = 0; k < 1000; k++) {
                double x = uniform(-12, 12), y = uniform(-5, 5), value;
                iso_vec3 at = {x, y, uniform(0, p.top(x, y))};
                iso_field_evaluate(&value, NULL, field, &at, 1);
                worst = fmax(worst, fabs(value - at.z));
            }
            CHECK_NEAR(0, worst, 1e-12);
            iso_field_free(field);
        }
    CHECK_STATUS(ISO_BAD_CONFIG, iso_field_open(&field, "auto-top", &mesh, 1, 90, nowhere));
    CHECK_STATUS(ISO_BAD_CONFIG, iso_field_open(&field, "auto-top", &mesh, 1, -1, nowhere));
    CHECK_STATUS(ISO_USAGE, iso_field_open(&field, "auto-top", NULL, 0, 40, nowhere));
    CHECK(field == NULL);
    iso_mesh_free(&mesh);
}

/* Gradients against differences, bounds against points, the same bits from the same part. */
static void test_field(void) {
    const part p = {"small saddle", saddle, 24, 20, 40, 0, 0};
    iso_mesh mesh;
    iso_field *field, *again;
    if (!part_mesh(&mesh, &p))
        return;
    if (CHECK_OK(iso_field_open(&field, "auto-top", &mesh, 1, 40, nowhere)) &&
        CHECK_OK(iso_field_open(&again, "auto-top", &mesh, 1, 40, nowhere))) {
        CHECK_EQUAL(ISO_FIELD_AUTO_TOP, iso_field_kind_of(field));
        int off = 0, broken = 0, useful = 0, differ = 0;
        for (int i = 0; i < 3000; i++) {
            iso_vec3 at = {uniform(-16, 16), uniform(-14, 14), uniform(-3, 30)}, g;
            iso_vec3 way = {uniform(-1e-5, 1e-5), uniform(-1e-5, 1e-5), uniform(-1e-5, 1e-5)};
            iso_vec3 to = vec3_plus(at, way);
            double value[3];
            iso_field_evaluate(&value[0], &g, field, &at, 1);
            iso_field_evaluate(&value[1], NULL, field, &to, 1);
            iso_field_evaluate(&value[2], NULL, again, &at, 1);
            off += fabs(value[1] - value[0] - vec3_dot(g, way)) > 1e-9;
            differ += memcmp(&value[0], &value[2], sizeof *value) != 0;
            double size = i % 4 ? 0.4 : i % 3 ? 4 : 30;
            iso_vec3 high = {at.x + uniform(0, size), at.y + uniform(0, size),
                             at.z + uniform(0, size)};
            iso_field_bound b;
            iso_field_bound_over(&b, field, at, high);
            useful += b.gradient_low.z > 0;
            for (int k = 0; k < 20; k++) {
                iso_vec3 q = {uniform(at.x, high.x), uniform(at.y, high.y), uniform(at.z, high.z)};
                iso_field_evaluate(&value[0], &g, field, &q, 1);
                broken += !(value[0] >= b.low && value[0] <= b.high && g.x >= b.gradient_low.x &&
                            g.x <= b.gradient_high.x && g.y >= b.gradient_low.y &&
                            g.y <= b.gradient_high.y && g.z >= b.gradient_low.z &&
                            g.z <= b.gradient_high.z);
            }
        }
        CHECK_EQUAL(0, off);
        CHECK_EQUAL(0, broken);
        CHECK_EQUAL(0, differ);
        CHECK_EQUAL(3000, useful);
        iso_field_free(field);
        iso_field_free(again);
    }
    iso_mesh_free(&mesh);
}

static void test_memory(void) {
    const part p = {"tiny", saddle, 4, 3, 40, 0, 0};
    iso_mesh mesh;
    if (!part_mesh(&mesh, &p))
        return;
    iso_status status = ISO_NO_MEMORY;
    int64_t n = 0;
    for (; n < 2000 && status != ISO_OK; n++) {
        iso_field *field = NULL;
        iso_fail_allocation_after(n);
        status = iso_field_open(&field, "auto-top", &mesh, 1, 40, nowhere);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK)
            CHECK_EQUAL(ISO_NO_MEMORY, status);
        CHECK_EQUAL(status == ISO_OK, field != NULL);
        iso_field_free(field);
    }
    CHECK(n > 30 && status == ISO_OK);
    iso_mesh_free(&mesh);
}

/* How long a part of 100 x 100 mm takes: `test-height-auto-top time`. */
static void measure(void) {
    const part p = {"large wedge", wedge, 100, 100, 40, 0, 0};
    iso_mesh mesh;
    iso_field *field;
    if (!part_mesh(&mesh, &p))
        return;
    clock_t begin = clock();
    if (CHECK_OK(iso_field_open(&field, "auto-top", &mesh, 1, 40, nowhere))) {
        printf("     100 x 100 mm: %.2f s\n", (double)(clock() - begin) / CLOCKS_PER_SEC);
        iso_field_free(field);
    }
    iso_mesh_free(&mesh);
}

int main(int count, char **argument) {
    if (count > 1 && strcmp(argument[1], "time") == 0) {
        RUN(measure);
    } else if (count > 1) { /* "several" */
        RUN(test_several);
        RUN(test_steep);
        RUN(test_field);
        RUN(test_memory);
    } else {
        RUN(test_tops);
    }
    return check_verdict();
}
