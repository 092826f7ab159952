/* What the options of the G-code's dialect, its texts and events do. */
#include "option_row.h"

static int count_lines(const print *p, const char *text) {
    int count = 0;
    size_t size = strlen(text);
    for (const char *line = p->text; line && *line; line = strchr(line, '\n')) {
        line += *line == '\n';
        count += !strncmp(line, text, size);
    }
    return count;
}

/* The layer that a line of the text comes in, from 0: -1 before the first, -2 nowhere. */
static int layer_with(const print *p, const char *text) {
    int layer = -1;
    size_t size = strlen(text);
    for (const char *line = p->text; line && *line; line = strchr(line, '\n')) {
        line += *line == '\n';
        layer += !strncmp(line, ";LAYER_CHANGE", 13);
        if (!strncmp(line, text, size))
            return layer;
    }
    return -2;
}

static int same_print(const change *c) {
    return same_places(c->a, c->b) && same_filament(c->a, c->b);
}

/* ---- flavours ---- */

static void marlin(const change *c) {
    same_print(c);
    CHECK(strstr(c->b->text, "\nM204 S600\n") && !strstr(c->b->text, "\nM204 P"));
}

static void klipper(const change *c) {
    same_print(c);
    CHECK(strstr(c->b->text, "\nSET_VELOCITY_LIMIT ACCEL=600\n"));
}

static void reprap(const change *c) {
    same_print(c);
    CHECK(strstr(c->b->text, "\nM204 S600\n") && strstr(c->b->text, "\nM73 P"));
}

static void smoothie(const change *c) {
    same_print(c);
    CHECK(strstr(c->b->text, "\nM204 S600\n") && !strstr(c->b->text, "\nM73 P"));
}

static void repetier(const change *c) {
    same_print(c);
    CHECK(strstr(c->b->text, "\nM201 X600 Y600\nM202 X600 Y600\n"));
}

static void use_volumetric_e(const change *c) {
    double section = SHAPE_PI / 4 * 1.75 * 1.75;
    CHECK(strstr(c->b->text, "\nM200 D1.75\n") && strstr(c->b->text, "\nM200 D0\n"));
    CHECK_NEAR(c->a->report.print.filament_mm, c->b->report.print.filament_mm, 1e-3);
    int32_t wrong = 0;
    CHECK_EQUAL(c->a->move_count, c->b->move_count);
    for (int32_t i = 0; i < c->a->move_count && i < c->b->move_count; i++)
        wrong += fabs(c->a->move[i].e * section - c->b->move[i].e) > 4e-5;
    CHECK_EQUAL(0, wrong);
}

static void use_firmware_retraction(const change *c) {
    int pulls = 0;
    for (int32_t i = 0; i < c->b->move_count; i++)
        pulls += c->b->move[i].kind == MOVE_FILAMENT && c->b->move[i].e != 0;
    CHECK_EQUAL(0, pulls);
    CHECK(c->a->report.print.retractions > 0);
    CHECK_EQUAL(c->a->report.print.retractions, count_lines(c->b, "G10\n"));
    CHECK_EQUAL(c->a->report.print.retractions, count_lines(c->b, "G11\n") + 1); /* ends back */
    CHECK_EQUAL(c->a->machine.retractions, c->b->machine.retractions);
    CHECK_NEAR(c->a->report.print.time, c->b->report.print.time, 1e-6);
}

static void gcode_comments(const change *c) {
    same_print(c);
    CHECK(!strstr(c->a->text, " ; travel\n"));
    CHECK(count_lines(c->b, "G1") > 100);
    int bare = 0;
    for (const char *line = c->b->text; line && *line; line = strchr(line, '\n')) {
        line += *line == '\n';
        bare += !strncmp(line, "G1", 2) && !memchr(line, ';', strcspn(line, "\n"));
    }
    CHECK_EQUAL(0, bare);
}

static void filament_cost(const change *c) {
    double cost = 400 * c->b->report.print.filament_g / 1000;
    CHECK(cost > 0.1);
    CHECK_NEAR(0, print_footer(c->a, "; total filament cost = "), 0);
    CHECK_NEAR(cost, print_footer(c->b, "; total filament cost = "), 0.00501);
    CHECK_NEAR(cost, print_footer(c->b, "; filament cost = "), 0.00501);
}

/* ---- texts ---- */

static void before_layer_gcode(const change *c) {
    same_print(c);
    CHECK_EQUAL(c->b->level_count, count_lines(c->b, "; before "));
    CHECK(strstr(c->b->text, "\n;HEIGHT:0.3\n; before 1 at 0.65\nG92 E0\n"));
}

static void start_filament_gcode(const change *c) {
    same_print(c);
    const char *at = strstr(c->b->text, "\n; new filament, 1.75 mm\n");
    CHECK(at && at > strstr(c->b->text, "\nG28") && at < strstr(c->b->text, "\n;LAYER_CHANGE"));
}

static void end_filament_gcode(const change *c) {
    same_print(c);
    const char *at = strstr(c->b->text, "\n; filament done\n");
    CHECK(at && at < strstr(c->b->text, "\nM84"));
    CHECK(at && !strstr(at, "\n;LAYER_CHANGE"));
}

/* Two copies, one after the other. */
static void between_objects_gcode(const change *c) {
    CHECK_EQUAL(0, count_lines(c->a, "; next, please\n"));
    CHECK_EQUAL(1, count_lines(c->b, "; next, please\n"));
}

/* ---- events ---- */

/* Layers' tops: 0.35, 0.65, 0.95, 1.25, 1.55 and so on. */
static void colorprint_heights(const change *c) {
    same_print(c);
    CHECK_EQUAL(2, count_lines(c->b, ";COLOR_CHANGE,T0\n"));
    CHECK_EQUAL(2, count_lines(c->b, "M600\n"));
    CHECK_EQUAL(2, layer_with(c->b, ";COLOR_CHANGE,T0")); /* at 0.95 */
}

static void events(const change *c) {
    same_print(c);
    CHECK_EQUAL(1, layer_with(c->b, ";COLOR_CHANGE,T0\nM600\n"));
    CHECK_EQUAL(3, layer_with(c->b, ";PAUSE_PRINT\nM117 magnet\nM400\n"));
    CHECK_EQUAL(4, layer_with(c->b, ";CUSTOM_GCODE\nM300 S444\n"));
}

static void color_change_gcode(const change *c) {
    same_print(c);
    CHECK_EQUAL(2, layer_with(c->a, ";COLOR_CHANGE,T0\nM600\n"));
    CHECK_EQUAL(2, layer_with(c->b, ";COLOR_CHANGE,T0\nM0 ; change to red\n"));
}

static void pause_print_gcode(const change *c) {
    same_print(c);
    CHECK_EQUAL(2, layer_with(c->b, ";PAUSE_PRINT\nM400\n"));
}

static void template_custom_gcode(const change *c) {
    same_print(c);
    CHECK_EQUAL(2, layer_with(c->b, ";CUSTOM_GCODE\nM300 S880\n"));
}

/* ---- labels ---- */

static void labels_octoprint(const change *c) {
    same_print(c);
    CHECK_EQUAL(0, count_lines(c->a, "; printing object"));
    CHECK_EQUAL(c->b->level_count, count_lines(c->b, "; printing object model.stl id:0 copy 0\n"));
    CHECK_EQUAL(c->b->level_count,
                count_lines(c->b, "; stop printing object model.stl id:0 copy 0\n"));
}

static void labels_firmware(const change *c) {
    same_print(c);
    CHECK_EQUAL(1, count_lines(c->b, "M486 T1\n"));
    CHECK_EQUAL(c->b->level_count, count_lines(c->b, "M486 S0\n"));
    CHECK_EQUAL(c->b->level_count, count_lines(c->b, "M486 S-1\n"));
}

#define FASTER "default_acceleration = 600"

const option_row option_rows_gcode[] = {
    {make_block, "gcode_flavor", "marlin", FASTER, marlin},
    {make_block, "gcode_flavor", "klipper", FASTER, klipper},
    {make_block, "gcode_flavor", "reprap", FASTER, reprap},
    {make_block, "gcode_flavor", "smoothie", FASTER, smoothie},
    {make_block, "gcode_flavor", "repetier", FASTER, repetier},
    {make_block, "gcode_comments", "1", "", gcode_comments},
    {make_block, "filament_cost", "400", "filament_density = 1.24", filament_cost},
    {make_block, "before_layer_gcode", "; before [layer_num] at [layer_z]", "", before_layer_gcode},
    {make_block, "start_filament_gcode", "; new filament\\, [filament_diameter] mm", "",
     start_filament_gcode},
    {make_block, "end_filament_gcode", "; filament done", "", end_filament_gcode},
    {make_block, "colorprint_heights", "0.7,1.9", "", colorprint_heights},
    {make_block, "events", "0.4:color\\n1.25:pause magnet\\n1.26:M300 S{440+layer_num}",
     "pause_print_gcode = M400", events},
    {make_block, "color_change_gcode", "M0 ; change to red", "colorprint_heights = 0.7",
     color_change_gcode},
    {make_block, "pause_print_gcode", "M400", "events = 0.7:pause\npause_print_gcode = M0",
     pause_print_gcode},
    {make_block, "template_custom_gcode", "M300 S880", "events = 0.7:template",
     template_custom_gcode},
    {make_block, "gcode_label_objects", "octoprint", "", labels_octoprint},
    {make_block, "gcode_label_objects", "firmware", "", labels_firmware},
    {0},
};

/* Other amounts of filament, or other moves, than the printer's checks are made for. */
const option_row option_rows_dialect[] = {
    {make_block, "use_volumetric_e", "1", "", use_volumetric_e},
    {make_block, "use_firmware_retraction", "1", "", use_firmware_retraction},
    {make_small, "between_objects_gcode", "; next, please",
     "complete_objects = 1\nduplicate = 2\nextruder_clearance_radius = 10", between_objects_gcode},
    {0},
};
