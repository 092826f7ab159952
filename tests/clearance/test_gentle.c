/* Fields so gentle that no tool of a shape can touch the print: never said where samples of a level
 * show the tool in it. */
#include "gentle.h"

#include <math.h>
#include <stdlib.h>

#include "base/random.h"
#include "check.h"
#include "models/shapes.h"

static const clearance_tool usual = {.tip_diameter = 0.8,
                                     .cone_angle = 45,
                                     .cone_height = 6,
                                     .block_low = {-10, -10},
                                     .block_high = {10, 10},
                                     .carriage_height = 20,
                                     .carriage_low = {-30, -30},
                                     .carriage_high = {30, 30},
                                     .gantry_height = 40};

enum { SIZE = 40, HEIGHT = 30 };

/* A part of that size under a blended field, layers 0.3 of F thick; 0: no such field, or chart. */
static int make(iso_curved *curved, const char *text) {
    const iso_vec3 box[2] = {{-SIZE / 2, -SIZE / 2, 0}, {SIZE / 2, SIZE / 2, HEIGHT}};
    const double range[2] = {0, HEIGHT};
    iso_field *field;
    *curved = (iso_curved){.thinnest = 0.3};
    if (iso_field_new(&field, text) != ISO_OK ||
        iso_field_blend(&curved->field, field, 2, 0, 15) != ISO_OK)
        return 0;
    for (int k = 0; k < 2; k++)
        curved->box[k] = box[k];
    return chart_new(&curved->chart, curved->field, false, box, range) == ISO_OK;
}

static int is_free(const char *text, const clearance_tool *tool) {
    iso_curved curved;
    int result = CHECK(make(&curved, text)) && gentle_is_free(&curved, tool, 0.02, false);
    curved_free(&curved);
    return result;
}

static void test_what_is_free(void) {
    clearance_tool tool = usual;
    CHECK(is_free("cone:8", &usual));
    CHECK(is_free("wave:0.4,40", &usual));
    CHECK(is_free("sqrt(x^2 + y^2 + (z + 150)^2) - 150", &usual));
    CHECK(!is_free("cone:35", &usual));
    CHECK(!is_free("wave:1,8", &usual));
    tool.turning = CLEARANCE_ABOUT_ALL;
    CHECK(!is_free("cone:8", &tool));
}

/* Each part of the tool counts. */
static void test_parts(void) {
    clearance_tool tool = usual;
    tool.tip_diameter = 3;
    CHECK(!is_free("cone:8", &tool));
    tool = usual;
    tool.cone_angle = 84;
    CHECK(!is_free("cone:8", &tool));
    tool = usual;
    tool.cone_height = 2;
    CHECK(!is_free("cone:8", &tool));
    tool.block_low = tool.block_high = (iso_vec2){0, 0};
    CHECK(is_free("cone:8", &tool));
    tool = usual;
    tool.carriage_height = 6;
    CHECK(!is_free("cone:8", &tool));
    tool = usual;
    tool.gantry_height = 3;
    CHECK(!is_free("cone:8", &tool));
    tool.gantry_height = 0;
    CHECK(is_free("cone:8", &tool));
}

/* Square on its layers, above a part from low to high of F. */
static int is_free_turned(const char *text, double low, double high, bool bare) {
    const iso_vec3 box[2] = {{-SIZE / 2, -SIZE / 2, 0}, {SIZE / 2, SIZE / 2, HEIGHT}};
    iso_curved curved = {.low = low, .high = high, .thinnest = 0.3};
    clearance_tool tool = usual;
    tool.turning = CLEARANCE_ABOUT_ALL;
    if (!CHECK_EQUAL(ISO_OK, iso_field_new(&curved.field, text)) ||
        !CHECK_EQUAL(ISO_OK,
                     chart_new(&curved.chart, curved.field, true, box, (double[2]){low, high})))
        return -1;
    int result = gentle_is_free(&curved, &tool, 0.02, bare);
    curved_free(&curved);
    return result;
}

static void test_square(void) {
    CHECK_EQUAL(1, is_free_turned("cylinder:x,0,10", 3, 12, true));
    CHECK_EQUAL(0, is_free_turned("cylinder:x,0,10", 3, 12, false));
    CHECK_EQUAL(1, is_free_turned("sphere:0,0,-20", 20, 50, true));
    CHECK_EQUAL(1, is_free_turned("fan:y,-40,0,40", 0, 40 * 3.1, true));
    CHECK_EQUAL(0, is_free_turned("fan:y,-40,0,40", 0, 40 * 3.2, true));
    CHECK_EQUAL(0, is_free_turned("cone:8", 0, 30, true));
}

static double envelope(const clearance_tool *tool, double x, double y) {
    double d = sqrt(x * x + y * y), tip = tool->tip_diameter / 2;
    double side = tan(tool->cone_angle * SHAPE_PI / 180), low = tool->gantry_height;
    if (x >= tool->carriage_low.x && x <= tool->carriage_high.x && y >= tool->carriage_low.y &&
        y <= tool->carriage_high.y)
        low = fmin(low, tool->carriage_height);
    if (x >= tool->block_low.x && x <= tool->block_high.x && y >= tool->block_low.y &&
        y <= tool->block_high.y)
        low = fmin(low, tool->cone_height);
    if (d <= tip + tool->cone_height * side)
        low = fmin(low, d <= tip ? 0 : (d - tip) / side);
    return low;
}

/* How deep the layer stands in the tool, at most, less what the tip may press. */
static double depth(const iso_curved *curved, const clearance_tool *tool, uint64_t *random) {
    enum { PAIRS = 400 };
    double deepest = -1e9;
    for (int i = 0; i < PAIRS; i++) {
        double r = 1 + (HEIGHT - 2) * random_unit(random), near = i % 2 ? 3 : SIZE;
        iso_vec2 flat[2];
        flat[0] =
            (iso_vec2){SIZE * (random_unit(random) - 0.5), SIZE * (random_unit(random) - 0.5)};
        for (int k = 1; k < 2; k++)
            flat[k] = (iso_vec2){flat[0].x + near * (random_unit(random) - 0.5),
                                 flat[0].y + near * (random_unit(random) - 0.5)};
        chart_point point[2];
        if (fabs(flat[1].x) > SIZE / 2 || fabs(flat[1].y) > SIZE / 2 ||
            chart_lift(point, curved->chart, flat, r, 2) != ISO_OK)
            continue;
        double rise = point[1].at.z - point[0].at.z;
        double allowed = envelope(tool, flat[1].x - flat[0].x, flat[1].y - flat[0].y);
        deepest = fmax(deepest, rise - allowed - 0.3 * point[0].thickness);
    }
    return deepest;
}

static void test_samples(void) {
    uint64_t random = 7;
    int free = 0, kept = 0;
    for (int i = 0; i < 150; i++) {
        char text[128];
        iso_curved curved;
        clearance_tool tool = usual;
        double a = random_unit(&random), b = random_unit(&random);
        tool.cone_angle = 20 + 60 * random_unit(&random);
        tool.cone_height = 1 + 8 * random_unit(&random);
        tool.carriage_height = tool.cone_height + 10 * random_unit(&random);
        tool.gantry_height = tool.carriage_height + 10 * random_unit(&random);
        const char *form = i % 3 == 0   ? "cone:%.3f,%.3f,0"
                           : i % 3 == 1 ? "wave:%.3f,%.3f"
                                        : "z + %.3f*sin(%.3f*x)*cos(y/5)";
        double first = i % 3 == 0 ? 25 * a : i % 3 == 1 ? 1.5 * a : a;
        double second = i % 3 == 0 ? 10 * b : i % 3 == 1 ? 10 + 40 * b : 0.4 * b;
        snprintf(text, sizeof text, form, first, second);
        if (make(&curved, text) && gentle_is_free(&curved, &tool, 0.02, false)) {
            double deepest = depth(&curved, &tool, &random);
            if (!CHECK(deepest <= 0))
                fprintf(stderr, "    %s: %g mm\n", text, deepest);
            free++;
        } else {
            kept++;
        }
        curved_free(&curved);
    }
    CHECK(free > 20 && kept > 20);
}

int main(void) {
    RUN(test_what_is_free);
    RUN(test_parts);
    RUN(test_square);
    RUN(test_samples);
    return check_verdict();
}
