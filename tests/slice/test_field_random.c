/* Random expressions on random meshes: texts for the engine, formulas of the same for the test. */
#include "check.h"

#include "models/shapes.h"
#include "slice/brute.h"

#include <isoslice/slice.h>

/* a x + b y + c z + d sin(e x + f y + 1) + g x y / 9 + h sqrt(x^2 + y^2 + z^2 + 4) + i |x - j|
 * + k exp(-((x - j)^2 + y^2) / 8) */
enum { NUMBERS = 11 };

typedef struct expression {
    double number[NUMBERS];
} expression;

static double value_of(const void *field, iso_vec3 p) {
    const double *n = ((const expression *)field)->number;
    double x = p.x, y = p.y, z = p.z;
    return n[0] * x + n[1] * y + n[2] * z + n[3] * sin(n[4] * x + n[5] * y + 1) + n[6] * x * y / 9 +
           n[7] * sqrt(x * x + y * y + z * z + 4) + n[8] * fabs(x - n[9]) +
           n[10] * exp(-((x - n[9]) * (x - n[9]) + y * y) / 8);
}

static void write_text(char *text, size_t size, const expression *e) {
    const double *n = e->number;
    snprintf(text, size,
             "%.3f*x + %.3f*y + %.3f*z + %.3f*sin(%.3f*x + %.3f*y + 1) + %.3f*x*y/9 + "
             "%.3f*sqrt(x^2 + y^2 + z^2 + 4) + %.3f*abs(x - %.3f) + "
             "%.3f*exp(-((x - %.3f)^2 + y^2)/8)",
             n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9], n[10], n[9]);
}

static double random_number(uint64_t *seed, double scale) {
    double number = (shape_random(seed) % 2001 / 1000.0 - 1) * scale;
    return round(number * 1000) / 1000;
}

static expression random_expression(uint64_t *seed) {
    static const double scale[NUMBERS] = {1, 1, 1, 0.8, 0.9, 0.9, 0.7, 0.6, 0.5, 4, 2};
    expression e;
    for (int i = 0; i < NUMBERS; i++)
        e.number[i] = i < 3 || shape_random(seed) % 2 ? random_number(seed, scale[i]) : 0;
    e.number[9] = fabs(e.number[9]); /* the text has a minus before it already */
    return e;
}

/* A box, a ball or a torus, with its corners a little anywhere; all fit into 8 mm round 0. */
static void random_mesh(iso_mesh *mesh, uint64_t *seed) {
    shape s = {0};
    int kind = (int)(shape_random(seed) % 3);
    if (kind == 0)
        shape_box(&s, -5, -6, -4, 6, 5, 4);
    else if (kind == 1)
        shape_sphere(&s, (shape_point){0.3, 0.2, 0}, 6, 7, 11);
    else
        shape_torus(&s, (shape_point){0, 0, 0.5}, 5, 2, 13, 6);
    CHECK_OK(iso_mesh_from_triangles(mesh, s.triangle, s.count));
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        mesh->position[v].x += random_number(seed, 0.5);
        mesh->position[v].y += random_number(seed, 0.5);
        mesh->position[v].z += random_number(seed, 0.5);
    }
    mesh->min = (iso_vec3){-8, -8, -8}, mesh->max = (iso_vec3){8, 8, 8};
    shape_free(&s);
}

static void check_one(uint64_t *seed) {
    expression e = random_expression(seed);
    char text[512];
    iso_mesh mesh;
    iso_field *field;
    iso_curves c;
    double level[12];
    write_text(text, sizeof text, &e);
    random_mesh(&mesh, seed);
    for (int i = 0; i < 12; i++)
        level[i] = -8.77 + 1.53 * i;
    if (!CHECK_OK(iso_field_new(&field, text)))
        return;
    if (CHECK_OK(iso_slice_field(&c, &mesh, field, level, 12, NULL))) {
        check_structure(&c, 12);
        CHECK(worst_level(&c, value_of, &e, level) < 1e-6);
        CHECK(worst_mesh(&c, &mesh) < 1e-9);
        for (int32_t l = 0; l < 12; l++) {
            iso_vec3 area = area_above(&mesh, value_of, &e, level[l], 40);
            iso_vec3 found = level_area(&c, l);
            double off = fabs(area.x - found.x) + fabs(area.y - found.y) + fabs(area.z - found.z);
            if (!CHECK_NEAR(0, off, 0.9))
                printf("  level %g of %s\n", level[l], text);
        }
        iso_curves_free(&c);
    }
    iso_field_free(field);
    iso_mesh_free(&mesh);
}

static void test_random(void) {
    uint64_t seed = 20;
    for (int i = 0; i < 40; i++)
        check_one(&seed);
}

/* The same bytes however often. */
static void test_repeatable(void) {
    shape s = {0};
    iso_mesh mesh;
    iso_field *field;
    iso_curves c[2];
    double level[] = {-2, 0.5, 3};
    shape_torus(&s, (shape_point){0, 0, 0}, 5, 2, 40, 20);
    CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count));
    CHECK_OK(iso_field_new(&field, "z + sin(x) + 0.1*x*y"));
    for (int k = 0; k < 2; k++)
        CHECK_OK(iso_slice_field(&c[k], &mesh, field, level, 3, NULL));
    CHECK_EQUAL(c[0].crossing_count, c[1].crossing_count);
    CHECK(!memcmp(c[0].point, c[1].point, (size_t)c[0].crossing_count * sizeof *c[0].point));
    for (int k = 0; k < 2; k++)
        iso_curves_free(&c[k]);
    iso_field_free(field);
    iso_mesh_free(&mesh);
    shape_free(&s);
}

int main(void) {
    RUN(test_random);
    RUN(test_repeatable);
    return check_verdict();
}
