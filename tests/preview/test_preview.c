/* The picture of hand-written G-code: which beads, how wide, in which layer. */
#include "check.h"

#include <locale.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <isoslice/path.h>
#include <isoslice/preview.h>

#include "base/memory.h"

static const char *const gcode_path = "test-preview.txt", *const svg_path = "test-preview.svg";

static void write_text(const char *text) {
    FILE *file = fopen(gcode_path, "wb");
    CHECK(file && fwrite(text, 1, strlen(text), file) == strlen(text));
    if (file)
        fclose(file);
}

static char picture[1 << 16];

static void read_picture(void) {
    picture[0] = '\0';
    FILE *file = fopen(svg_path, "rb");
    if (!CHECK(file))
        return;
    size_t size = fread(picture, 1, sizeof picture - 1, file);
    picture[size] = '\0';
    fclose(file);
}

static iso_status draw(const char *text, const int32_t *layer, int32_t count) {
    iso_preview_options options = iso_preview_defaults();
    options.layer = layer;
    options.layer_count = count;
    write_text(text);
    remove(svg_path);
    ISO_TRY(iso_preview_svg(svg_path, gcode_path, &options));
    read_picture();
    return ISO_OK;
}

static int occurrences(const char *what) {
    int count = 0;
    for (const char *at = picture; (at = strstr(at, what)); at += strlen(what))
        count++;
    return count;
}

/* Straight moves in the picture that belong to beads of a role and a width (10 um). */
static int beads(iso_role role, int width) {
    int count = 0;
    for (const char *at = picture; (at = strstr(at, "<g class=\"edge\" stroke-width=\""));) {
        at += strlen("<g class=\"edge\" stroke-width=\"");
        bool wide = atoi(at) == width;
        const char *line = strstr(at, " d=\""), *end = strstr(at, "/></g>");
        const char *use = strstr(at, "<use class=\"role-");
        if (!CHECK(line && end && use))
            return -1;
        if (!wide || atoi(use + strlen("<use class=\"role-")) != (int)role)
            continue;
        for (const char *c = line; c < end; c++)
            count += *c == 'l';
    }
    return count;
}

static const char two_layers[] = "; made by hand\n"
                                 "G90\nM82\nG92 E0\nG28\n"
                                 ";LAYER_CHANGE\n;Z:0.2\n;HEIGHT:0.2\n"
                                 "G1 Z0.2 F600\n"
                                 "G0 X10 Y10\n"
                                 ";TYPE:External perimeter\n;WIDTH:0.45\n"
                                 "G1 X20 Y10 E0.4\nG1 X20 Y20 E0.8\nG1 X10 Y20 E1.2\n"
                                 "G1 X10 Y10 E1.6\n"
                                 "G1 E0.8\n" /* retract */
                                 "G0 X11 Y11\nG1 E1.6\n"
                                 ";TYPE:Perimeter\n;WIDTH:0.5\n"
                                 "G1 X19 Y11 E2\nG1 X19 Y19 E2.4\n"
                                 ";LAYER_CHANGE\r\n;Z:0.4\r\n;HEIGHT:0.2\r\n"
                                 "M83\r\nG91\r\nG1 Z.2\r\nG1 X-9 Y-9\r\n"
                                 ";TYPE:Solid infill\r\n;WIDTH:0.42\r\n"
                                 "g1x10e+.5 ; lower case, no spaces\r\nG1Y+1.5 E.05\r\n"
                                 "M117 G1 X99 E99\r\nG1 X-1 E-.5\r\n";

static void test_counts_beads_by_role_and_width(void) {
    const int32_t both[] = {1, 2};
    CHECK_OK(draw(two_layers, both, 2));
    CHECK_EQUAL(4, beads(ISO_ROLE_EXTERNAL_PERIMETER, 45));
    CHECK_EQUAL(2, beads(ISO_ROLE_PERIMETER, 50));
    CHECK_EQUAL(2, beads(ISO_ROLE_SOLID_INFILL, 42));
    CHECK_EQUAL(3, occurrences("<use "));
    CHECK(strstr(picture, "Layer 1</tspan> of 2, z = 0.2 mm"));
    CHECK(strstr(picture, "Layer 2</tspan> of 2, z = 0.4 mm"));
    CHECK(strstr(picture, "M1000 -1000l1000 0l0 -1000l-1000 0l0 1000\"")); /* the square */
    CHECK(strstr(picture, ">External perimeter, 0.04 m<"));
    CHECK(strstr(picture, ">2 mm<")); /* the scale: at most a third of 12.45 mm */
    CHECK_EQUAL(2, occurrences("<g class=\"travel\">"));
}

/* Z in each move of a layer, axes that turn the part, inverse time. */
static void test_moves_in_space(void) {
    const int32_t all[] = {1, 2};
    CHECK_OK(draw("M83\n;LAYER_CHANGE\n;Z:0.2\n;HEIGHT:0.2\nG1 X10 Y10 Z3 F600\n"
                  ";TYPE:Perimeter\n;WIDTH:0.45\nG1 X20 Y10 Z3.5 E1\n;HEIGHT:0.25\n"
                  "G1 X20 Y20 Z4 E1\nG1 Z9 E.1\n"
                  ";LAYER_CHANGE\n;Z:0.4\n;HEIGHT:0.2\nG1 X10 Y10 Z1 B-4.5 C400.25\nG93\n"
                  ";TYPE:Solid infill\n;WIDTH:0.42\nG1 C410 E1 F60\n"
                  "G1 X10.001 A20 E1 F12.5\nG1 X15 Z1.5 B3 C-17 E1 F5\nG94\n",
                  all, 2));
    CHECK_EQUAL(2, beads(ISO_ROLE_PERIMETER, 45));
    CHECK_EQUAL(2, beads(ISO_ROLE_SOLID_INFILL, 42)); /* what only turns is a point */
    CHECK_EQUAL(2, occurrences("</tspan> of 2, z = "));
}

static iso_status draw_from(const char *text, double azimuth, double elevation) {
    iso_preview_options options = iso_preview_defaults();
    options.view[0] = azimuth;
    options.view[1] = elevation;
    write_text(text);
    remove(svg_path);
    ISO_TRY(iso_preview_svg(svg_path, gcode_path, &options));
    read_picture();
    return ISO_OK;
}

static const char in_space[] = "M83\n;LAYER_CHANGE\n;HEIGHT:0.2\n;TYPE:Perimeter\n;WIDTH:0.5\n"
                               "G1 X10 Y0 Z2 F600\nG1 X13 Y0 Z6 E1\nG1 X13 Y4 Z6 E1\n";

/* A layer from the front: x to the right, z up, beads no wider than they are high. */
static void test_sees_layers_from_the_side(void) {
    CHECK_OK(draw_from(in_space, -90, 0));
    CHECK(strstr(picture, "M1000 -200l300 -400l0 0\""));
    CHECK_EQUAL(2, beads(ISO_ROLE_PERIMETER, 20));
    CHECK(strstr(picture, "of 1, z = 2 to 6 mm<"));
    CHECK(strstr(picture, ">Perimeter, 0.01 m<")); /* 5 + 4 mm in space */
    CHECK_OK(draw_from(in_space, 0, 0));           /* from the right: y to the right */
    CHECK(strstr(picture, "M0 -200l0 -400l400 0\""));
    CHECK_OK(draw_from(in_space, -90, 30)); /* z cos(30) + y sin(30) upwards */
    CHECK(strstr(picture, "M1000 -173l300 -347l0 -200\""));
    CHECK_EQUAL(2, beads(ISO_ROLE_PERIMETER, 35)); /* 0.2 + 0.3 sin(30) */
    CHECK_OK(draw_from(in_space, -90, 90));
    CHECK(strstr(picture, "M1000 0l300 0l0 -400\""));
    CHECK_STATUS(ISO_USAGE, draw_from(in_space, -90, 91));
    CHECK_STATUS(ISO_USAGE, draw_from(in_space, -90, -91));
    CHECK_STATUS(ISO_USAGE, draw_from(in_space, 400, 0));
}

/* A half circle of radius 5 that rises, and a full one: ellipses, in chords of 7.5 degrees. */
static void test_sees_arcs_from_the_side(void) {
    CHECK_OK(draw_from("M83\n;LAYER_CHANGE\n;HEIGHT:0.2\n;TYPE:Perimeter\n;WIDTH:0.5\n"
                       "G1 X10 Y0 Z1 F600\nG3 X0 Y0 Z2 I-5 J0 E1\nG2 I5 J0 E1\n",
                       -90, 0));
    CHECK(!strstr(picture, "a500 "));
    int count = beads(ISO_ROLE_PERIMETER, 20);
    CHECK(count >= 3 * 24 && count <= 3 * 25);
    CHECK(strstr(picture, "M1000 -100l-4 -")); /* 5 - 5 cos(7.5) = 0.04 mm */
    CHECK(strstr(picture, "of 1, z = 1 to 2 mm<"));
}

static void test_chooses_layers(void) {
    const int32_t last[] = {-1, 2}, none[] = {3}, zero[] = {0};
    CHECK_OK(draw(two_layers, last, 2));
    CHECK_EQUAL(1, occurrences("Layer "));
    CHECK_EQUAL(0, beads(ISO_ROLE_PERIMETER, 50));
    CHECK_OK(draw(two_layers, NULL, 0)); /* as many as there are */
    CHECK_EQUAL(2, occurrences("Layer "));
    CHECK_STATUS(ISO_USAGE, draw(two_layers, none, 1));
    CHECK_STATUS(ISO_USAGE, draw(two_layers, zero, 1));
    CHECK(access(svg_path, F_OK) != 0);
}

/* A zero offset from a null pointer, once. */
static void test_a_layer_with_nothing_in_it(void) {
    const int32_t empty[] = {1};
    CHECK_OK(draw(";LAYER_CHANGE\n;LAYER_CHANGE\nM83\nG1 X9 E1\n", empty, 1));
    CHECK(strstr(picture, "Layer 1</tspan> of 2"));
    CHECK_EQUAL(0, occurrences("<use "));
}

/* Without comments: layers by z, widths by the filament in them. */
static void test_width_from_extrusion(void) {
    double height = 0.25, width = 0.6, pi = acos(-1);
    double area = (width - height) * height + pi * height * height / 4;
    double e = area * 10 / (pi * 1.75 * 1.75 / 4);
    char text[512];
    snprintf(text, sizeof text,
             "M83\nG1 Z0.25\nG1 X10 E%.5f\nG1 Y10 E%.5f\nG1 Z5\nG1 X0\nG1 Z0.5\nG1 Y0 E%.5f\n", e,
             e, e);
    CHECK_OK(draw(text, NULL, 0));
    CHECK_EQUAL(2, occurrences("Layer "));
    CHECK_EQUAL(3, beads(ISO_ROLE_CUSTOM, 60));
}

/* Half a circle one way, a quarter the other way, a large arc, a whole circle. */
static void test_arcs(void) {
    CHECK_OK(draw("M83\nG92 X10 Y0\n;WIDTH:0.4\nG3 X-10 Y0 I-10 J0 E1\n"
                  "G2 X0 Y10 I10 J0 E1\nG3 X10 Y0 I0 J-10 E1\nG2 X10 Y0 I-10 J0 E1\n",
                  NULL, 0));
    CHECK(strstr(picture, "M1000 0a1000 1000 0 0 0 -2000 0a1000 1000 0 0 1 1000 -1000"
                          "a1000 1000 0 1 0 1000 1000a1000 1000 0 0 1 -2000 0"
                          "a1000 1000 0 0 1 2000 0\""));
    CHECK_STATUS(ISO_UNREADABLE, draw("M83\nG2 X10 Y0 R5 E1\n", NULL, 0));
}

static void test_ignores_the_locale(void) {
    if (!setlocale(LC_ALL, "de_DE.UTF-8"))
        return;
    CHECK_OK(draw(two_layers, NULL, 0));
    CHECK_EQUAL(2, beads(ISO_ROLE_SOLID_INFILL, 42));
    setlocale(LC_ALL, "C");
}

static void test_refuses_what_is_no_gcode(void) {
    iso_preview_options options = iso_preview_defaults();
    CHECK_STATUS(ISO_UNREADABLE, draw("", NULL, 0));
    CHECK_STATUS(ISO_UNREADABLE, draw("solid cube\nfacet normal 0 0 1\n", NULL, 0));
    CHECK_STATUS(ISO_UNREADABLE, draw("G1 X10\nG1 Y10\n", NULL, 0));
    CHECK_STATUS(ISO_UNREADABLE, draw("M83\nG1 X1e999 Y1 E1\nG1 X99999 E1\n", NULL, 0));
    CHECK_STATUS(ISO_UNREADABLE, draw("M83\n;WIDTH:1000\nG1 X1 E1\n", NULL, 0));
    CHECK_STATUS(ISO_UNREADABLE, draw("M83\nG3 X1 I99999999999999 E1\n", NULL, 0));
    CHECK_STATUS(ISO_UNREADABLE, iso_preview_svg(svg_path, "no/such/file", &options));
    CHECK_STATUS(ISO_NOT_WRITTEN, draw(two_layers, NULL, 0) == ISO_OK
                                      ? iso_preview_svg("no/such/folder.svg", gcode_path, &options)
                                      : ISO_BUG);
    options.columns = 0;
    CHECK_STATUS(ISO_USAGE, iso_preview_svg(svg_path, gcode_path, &options));
}

static void test_survives_every_failing_allocation(void) {
    iso_preview_options options = iso_preview_defaults();
    write_text(two_layers);
    remove(svg_path);
    iso_status status = ISO_NO_MEMORY;
    for (int64_t n = 0; n < 100 && status != ISO_OK; n++) {
        iso_fail_allocation_after(n);
        status = iso_preview_svg(svg_path, gcode_path, &options);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
        CHECK((access(svg_path, F_OK) == 0) == (status == ISO_OK));
    }
    CHECK_OK(status);
}

int main(void) {
    RUN(test_counts_beads_by_role_and_width);
    RUN(test_moves_in_space);
    RUN(test_sees_layers_from_the_side);
    RUN(test_sees_arcs_from_the_side);
    RUN(test_chooses_layers);
    RUN(test_a_layer_with_nothing_in_it);
    RUN(test_width_from_extrusion);
    RUN(test_arcs);
    RUN(test_ignores_the_locale);
    RUN(test_refuses_what_is_no_gcode);
    RUN(test_survives_every_failing_allocation);
    remove(gcode_path);
    remove(svg_path);
    return check_verdict();
}
