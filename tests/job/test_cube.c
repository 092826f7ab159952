/* A cube, whose paths are known in closed form. */
#include "checks.h"
#include "solids.h"

enum { EXTERNAL = ISO_ROLE_EXTERNAL_PERIMETER, INNER = ISO_ROLE_PERIMETER };

static const double side = 20;

static double spacing_of(double width, double height) {
    return width - height * (1 - SHAPE_PI / 4);
}

static double section_of(double width, double height) {
    return (width - height) * height + SHAPE_PI * height * height / 4;
}

static void print_cube(print *p, const char *settings) {
    shape s = {0};
    solid_cube(&s);
    print_shape(p, &s, settings);
    print_check(p, &s);
    shape_free(&s);
}

/* Walls are squares: 8 times the half side, which is 10 less width / 2 less k spacings. */
static void check_walls(const print *p, int32_t layer, int walls, double outer, double inner) {
    double height = p->level[layer].height, half = side / 2 - outer / 2, sum = 0;
    double s0 = spacing_of(outer, height), s1 = spacing_of(inner, height);
    double filament = SHAPE_PI / 4 * 1.75 * 1.75;
    CHECK_NEAR(8 * half, print_length(p, EXTERNAL, layer), 0.01);
    CHECK_NEAR(8 * half * section_of(outer, height) / filament, print_filament(p, EXTERNAL, layer),
               1e-4);
    CHECK_EQUAL(1, print_runs(p, EXTERNAL, layer));
    for (int w = 1; w < walls; w++) {
        half -= w == 1 ? (s0 + s1) / 2 : s1;
        sum += 8 * half;
    }
    CHECK_NEAR(sum, print_length(p, INNER, layer), 0.02 * walls);
    CHECK_NEAR(sum * section_of(inner, height) / filament, print_filament(p, INNER, layer),
               2e-4 * walls);
}

static void test_walls(void) {
    print p;
    print_cube(&p, "perimeters = 3\nlayer_height = 0.2\nfirst_layer_height = 0.3\n"
                   "external_perimeter_extrusion_width = 0.42\nperimeter_extrusion_width = 0.5\n"
                   "first_layer_extrusion_width = 0.6");
    check_walls(&p, 0, 3, 0.6, 0.6);
    for (int32_t i = 1; i < p.level_count; i++)
        check_walls(&p, i, 3, 0.42, 0.5);
    print_free(&p);
    print_cube(&p, "perimeters = 1\nlayer_height = 0.3");
    for (int32_t i = 1; i < p.level_count; i++)
        check_walls(&p, i, 1, 0.45, 0.45);
    print_free(&p);
}

/* Layers whose middle lies below the top: 0.35 + 0.3 n, so 66 of them. */
static void test_layers(void) {
    print p;
    print_cube(&p, "");
    CHECK_EQUAL(66, p.level_count);
    CHECK_NEAR(0.35 + 65 * 0.3, p.level[65].z, 1e-9);
    CHECK_NEAR(19.85, p.report.printed_height, 1e-9);
    CHECK_NEAR(400 * 19.85, p.report.mesh_volume, 1e-6);
    CHECK_NEAR(400 * 19.85, p.report.sliced_volume, 1e-6);
    CHECK_NEAR(8000, p.report.input[0].volume, 1e-9);
    CHECK_NEAR(20, p.report.input[0].size.z, 1e-12);
    CHECK_EQUAL(12, p.report.input[0].triangle_count);
    CHECK_EQUAL(8, p.report.input[0].vertex_count);
    print_free(&p);
}

/* Solid infill that isn't the top: the lowest over sparse infill is printed as a bridge. */
static double solid_length(const print *p, int32_t layer) {
    return print_length(p, ISO_ROLE_SOLID_INFILL, layer) +
           print_length(p, ISO_ROLE_BRIDGE_INFILL, layer);
}

/* Solid above the bed and below the top, sparse between: with no solid role in the middle. */
static void test_shells(void) {
    print p;
    print_cube(&p, "top_solid_layers = 4\nbottom_solid_layers = 2\nlayer_height = 0.25\n"
                   "first_layer_height = 0.25");
    CHECK_EQUAL(80, p.level_count);
    for (int32_t i = 0; i < p.level_count; i++) {
        int top = i == 79, solid = i < 2 || (i >= 76 && !top);
        CHECK_EQUAL(top, print_length(&p, ISO_ROLE_TOP_SOLID_INFILL, i) > 0);
        CHECK_EQUAL(solid, solid_length(&p, i) > 0);
        CHECK_EQUAL(i == 76, print_length(&p, ISO_ROLE_BRIDGE_INFILL, i) > 0);
        CHECK_EQUAL(!top && !solid, print_length(&p, ISO_ROLE_INTERNAL_INFILL, i) > 0);
    }
    print_free(&p);
}

/* The region of the fill's lines is a square; lines at distance d draw area / d, and the links
 * between them come on top: about half its perimeter, as every second end is linked. */
static void test_density(void) {
    static const double density[] = {0.1, 0.2, 0.5};
    for (int i = 0; i < 3; i++) {
        char settings[160];
        print p;
        snprintf(settings, sizeof settings,
                 "fill_density = %g%%\ninfill_overlap = 0\nperimeters = 2\nfill_angle = 0\n"
                 "top_solid_layers = 0\nbottom_solid_layers = 0",
                 100 * density[i]);
        print_cube(&p, settings);
        double s = spacing_of(0.45, 0.3), width = side - 0.45 - 2 * s - s;
        double lines = (width - s) * (width - s) / s * density[i];
        for (int32_t layer = 10; layer < 12; layer++) {
            double drawn = print_length(&p, ISO_ROLE_INTERNAL_INFILL, layer);
            double links = 2 * width;
            CHECK(drawn > 0.93 * lines - 20 && drawn < 1.07 * lines + links);
        }
        double along = print_length(&p, ISO_ROLE_INTERNAL_INFILL, 10);
        double across = print_length(&p, ISO_ROLE_INTERNAL_INFILL, 11);
        CHECK_NEAR(along, across, 0.1 * along);
        print_free(&p);
    }
}

/* Without walls there is nothing to overlap: the fill ends half a spacing inside the outline. */
static void test_no_overlap_without_walls(void) {
    print p;
    double box[4], s = spacing_of(0.45, 0.3);
    print_cube(&p, "perimeters = 0\nfill_density = 100%");
    CHECK(print_box(box, &p, ISO_ROLE_INTERNAL_INFILL, 10));
    for (int k = 0; k < 4; k++)
        CHECK_NEAR(100 + (k < 2 ? -1 : 1) * (side / 2 - s / 2), box[k], 0.02);
    print_free(&p);
}

/* The overlap is that of the layer's own beads: narrow first layers aren't left by the fill of wide
 * ones. */
static void test_overlap_of_narrow_first_layer(void) {
    print p;
    double box[4], h = 0.3, w = 0.36, s = spacing_of(w, h);
    print_cube(&p, "nozzle_diameter = 0.8\nperimeters = 1\nperimeter_extrusion_width = 1.6\n"
                   "first_layer_height = 0.3\nfirst_layer_extrusion_width = 120%");
    CHECK(print_box(box, &p, ISO_ROLE_SOLID_INFILL, 0));
    double half = side / 2 - w / 2 - s / 2 + 0.25 * w - s / 2;
    double margin = s / 2 - 0.25 * w; /* ends without a link go on to the wall */
    for (int k = 0; k < 4; k++)
        CHECK_NEAR(100 + (k < 2 ? -1 : 1) * (half + margin / 2), box[k], margin / 2 + 0.02);
    print_free(&p);
    print_cube(&p, "perimeters = 1\ninfill_overlap = 3"); /* no further than through the wall */
    for (int32_t i = 0; i < p.level_count; i++) {
        double width = i ? 0.45 : 0.7, height = p.level[i].height;
        s = spacing_of(width, height);
        CHECK(print_box(box, &p, -1, i));
        CHECK(box[0] > 90 + s / 2 - 0.01 && box[2] < 110 - s / 2 + 0.01);
    }
    print_free(&p);
}

/* Distances of skirts to a convex part are those of the loops' middles. */
static void test_skirt(void) {
    print p;
    double box[4];
    print_cube(&p, "skirts = 3\nskirt_distance = 4\nfirst_layer_height = 0.3\n"
                   "first_layer_extrusion_width = 0.5");
    double s = spacing_of(0.5, 0.3), sum = 0;
    for (int i = 0; i < 3; i++)
        sum += 4 * side + 2 * SHAPE_PI * (4 + 0.25 + i * s);
    CHECK(print_box(box, &p, ISO_ROLE_SKIRT, 0));
    for (int k = 0; k < 4; k++)
        CHECK_NEAR(100 + (k < 2 ? -1 : 1) * (side / 2 + 4 + 0.25 + 2 * s), box[k], 0.01);
    CHECK_NEAR(sum, print_length(&p, ISO_ROLE_SKIRT, -1), 0.03);
    CHECK_EQUAL(3, print_runs(&p, ISO_ROLE_SKIRT, -1));
    CHECK_NEAR(sum, print_length(&p, ISO_ROLE_SKIRT, 0), 0.03);
    print_free(&p);
}

/* A cube with a cavity has solid floors and roofs around it: right below, and right above. */
static void test_cavity_is_closed(void) {
    shape s = {0};
    print p;
    solid_cavity(&s);
    print_shape(&p, &s,
                "layer_height = 0.25\nfirst_layer_height = 0.25\nfill_density = 10%\n"
                "top_solid_layers = 2\nbottom_solid_layers = 3");
    print_check(&p, &s);
    for (int32_t i = 0; i < p.level_count; i++) {
        int floor = i == 10 || i == 11, roof = i >= 36 && i < 39, hollow = i >= 12 && i < 36;
        int bed = i < 3, top = i >= 46;
        double solid = solid_length(&p, i) + print_length(&p, ISO_ROLE_TOP_SOLID_INFILL, i);
        CHECK_EQUAL(floor || roof || bed || top, solid > 0);
        CHECK_EQUAL(1 + hollow, print_runs(&p, EXTERNAL, i));
    }
    print_free(&p);
    shape_free(&s);
}

int main(void) {
    RUN(test_walls);
    RUN(test_layers);
    RUN(test_shells);
    RUN(test_density);
    RUN(test_no_overlap_without_walls);
    RUN(test_overlap_of_narrow_first_layer);
    RUN(test_skirt);
    RUN(test_cavity_is_closed);
    CHECK(print_folder_remove());
    return check_verdict();
}
