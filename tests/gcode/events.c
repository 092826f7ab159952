/* What stands between the moves: texts, events at heights, labels, comments, changes of role. */
#define SMALL_FILE "test-gcode-events.gcode"
#include "small.h"

enum { LAYERS = 5 }; /* of 0.2 mm */

static void make(iso_paths layer[LAYERS]) {
    for (int l = 0; l < LAYERS; l++) {
        layer[l] = (iso_paths){0};
        add_square(&layer[l], 0, 0, 200000, ISO_ROLE_PERIMETER, 4500);
    }
}

static void free_all(iso_paths layer[LAYERS]) {
    for (int l = 0; l < LAYERS; l++)
        iso_paths_free(&layer[l]);
}

/* Says what it is asked. */
static iso_status echo(char *text, size_t size, const void *payload, iso_gcode_text_kind kind,
                       const iso_gcode_place *place) {
    static const char *const name[] = {"START",  "END",     "START FILAMENT", "END FILAMENT",
                                       "BEFORE", "LAYER",   "BETWEEN",        "TOOL CHANGE",
                                       "COLOR",  "PAUSING", "FROM TEMPLATE"};
    const char *only = payload;
    *text = '\0';
    if (kind == ISO_TEXT_EVENT)
        snprintf(text, size, "%s", place->event);
    else if (!only || strstr(only, name[kind]))
        snprintf(text, size, ";%s %d %g %g", name[kind], place->layer, place->z, place->max_z);
    return ISO_OK;
}

/* Lines of the texts alone. */
static void lines_with(char *out, size_t size, const reading *r, const char *first_letters) {
    size_t used = 0;
    for (const char *line = r->text; *line; line = strchr(line, '\n') + 1) {
        size_t length = strcspn(line, "\n") + 1;
        if (!strncmp(line, first_letters, strlen(first_letters)) && used + length < size)
            memcpy(out + used, line, length), used += length;
    }
    out[used] = '\0';
}

/* In the order of PrusaSlicer: before_layer_gcode, the move up, layer_gcode. */
static void test_places_of_texts(void) {
    iso_paths layer[LAYERS];
    make(layer);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.text = echo;
    o.z_offset = 0.5; /* 0.2 mm layers at 0.2 in the writer's numbers: -0.3 of the part's */
    reading r = print(&totals, &o, layer, 2);
    const char *in_order[] = {
        ";TYPE:Custom\n;START -1 0 0\n",
        "M83 ; relative E\n;START FILAMENT -1 0 0\n;LAYER_CHANGE\n;Z:-0.3\n;HEIGHT:0.2\n"
        ";BEFORE 0 -0.3 -0.3\nG92 E0\nG1 Z.2 F7800\n;LAYER 0 -0.3 -0.3\n",
        ";BEFORE 1 -0.1 -0.1\nG92 E0\nG1 Z.4 F7800\n;LAYER 1 -0.1 -0.1\n",
        ";TYPE:Custom\n;END FILAMENT 1 -0.1 -0.1\n;END 1 -0.1 -0.1\n",
    };
    const char *at = r.text;
    for (size_t i = 0; i < sizeof in_order / sizeof *in_order; i++)
        if (CHECK(at && (at = strstr(at, in_order[i])) != NULL))
            at++;
    free(r.text);
    o.start_gcode = ";OWN START";
    o.end_gcode = ";OWN END";
    r = print(&totals, &o, layer, 2);
    CHECK_EQUAL(1, reading_count(&r, ";OWN START"));
    CHECK_EQUAL(0, reading_count(&r, ";START -1"));
    CHECK_EQUAL(0, reading_count(&r, ";END 1"));
    free(r.text);
    free_all(layer);
}

/* The first layer whose top is as high has it, as PrusaSlicer's custom G-code does. */
static void test_events_at_heights(void) {
    iso_paths layer[LAYERS];
    make(layer);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    static const double color[] = {0.5, 0.8};
    o.text = echo;
    o.text_payload = "COLOR PAUSING FROM TEMPLATE";
    o.colorprint_height = color;
    o.colorprint_count = 2;
    o.events = " 0.6 : pause\n0.3:pause put in the magnet;; 0.8:template ; 9:color; 0:M300 S440";
    reading r = print(&totals, &o, layer, LAYERS);
    const char *in_order[] = {
        "G92 E0\n;CUSTOM_GCODE\nM300 S440\n",
        ";Z:0.4\n",
        "\n;PAUSE_PRINT\nM117 put in the magnet\n;PAUSING 1 0.4 0.4\n",
        ";Z:0.6\n",
        "\n;COLOR_CHANGE,T0\n;COLOR 2 0.6 0.6\n;PAUSE_PRINT\n;PAUSING 2 0.6 0.6\n",
        ";Z:0.8\n",
        "\n;COLOR_CHANGE,T0\n;COLOR 3 0.8 0.8\n;CUSTOM_GCODE\n;FROM TEMPLATE 3 0.8 0.8\n",
    };
    const char *at = r.text;
    for (size_t i = 0; i < sizeof in_order / sizeof *in_order; i++)
        if (CHECK(at && (at = strstr(at, in_order[i])) != NULL))
            at++;
    CHECK_EQUAL(2, reading_count(&r, ";COLOR_CHANGE"));
    free(r.text);
    free_all(layer);
}

/* Without a text of the user's the flavour's own word. */
static void test_events_by_flavour(void) {
    static const struct {
        iso_flavour flavour;
        const char *pause, *color;
    } words[] = {
        {ISO_FLAVOUR_MARLIN2, "\n;PAUSE_PRINT\nM0\n", "\n;COLOR_CHANGE,T0\nM600\n"},
        {ISO_FLAVOUR_KLIPPER, "\n;PAUSE_PRINT\nPAUSE\n", "\n;COLOR_CHANGE,T0\nPAUSE\n"},
        {ISO_FLAVOUR_REPRAPFIRMWARE, "\n;PAUSE_PRINT\nM226\n", "\n;COLOR_CHANGE,T0\nM600\n"},
        {ISO_FLAVOUR_SMOOTHIE, "\n;PAUSE_PRINT\nM600\n", "\n;COLOR_CHANGE,T0\nM600\n"},
        {ISO_FLAVOUR_MACH3, "\n;PAUSE_PRINT\n", "\n;COLOR_CHANGE,T0\n;PAUSE"}};
    iso_paths layer[LAYERS];
    make(layer);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        iso_gcode_options o = plain();
        iso_gcode_totals totals;
        o.flavour = words[i].flavour;
        o.retract_length = 0;
        o.events = "0.3:color;0.3:pause";
        reading r = print(&totals, &o, layer, 2);
        CHECK(strstr(r.text, words[i].color));
        CHECK(strstr(r.text, words[i].pause));
        free(r.text);
    }
    free_all(layer);
}

static void test_bad_events_are_refused(void) {
    static const char *const bad[] = {"color",  "5.2 color", "x:color",     "-1:color", "5.2:",
                                      "5.2: ;", ":pause",    "5:color; 7;", "nan:pause"};
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        o.events = bad[i];
        CHECK_STATUS(ISO_BAD_CONFIG, write_file(&totals, &o, NULL, 0));
        CHECK(!strncmp(iso_error_message(), "events: ", 8));
    }
    o.events = "0:colored\n1:pauses"; /* no such words: G-code */
    CHECK_OK(write_file(&totals, &o, NULL, 0));
    unlink(SMALL_FILE);
}

/* Any text is either a list of events or refused with a message. */
static void test_random_events(void) {
    static const char letter[] = "0123456789.:;; \n\t-+epauscolrtmM";
    uint64_t seed = 5;
    for (int i = 0; i < 3000; i++) {
        char text[48];
        int size = i % 40, good;
        for (int k = 0; k < size; k++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            text[k] = letter[(seed >> 33) % (sizeof letter - 1)];
        }
        text[size] = '\0';
        iso_gcode_options o = plain();
        iso_gcode_totals totals;
        o.events = text;
        iso_status status = write_file(&totals, &o, NULL, 0);
        good = status == ISO_OK;
        CHECK(good || (status == ISO_BAD_CONFIG && strstr(iso_error_message(), "events: ")));
    }
    unlink(SMALL_FILE);
}

/* ---- labels ---- */

static const iso_vec2 outline[] = {{10, 20}, {30, 20}, {20.5, 40.25}};
static const iso_gcode_object two[] = {{"a b.stl", 0, 0, {20, 30}, outline, 3},
                                       {"a b.stl", 0, 1, {-7.5, 3}, NULL, 0}};

static void make_objects(iso_paths *layer) {
    add_square(layer, 0, 0, 900000, ISO_ROLE_SKIRT, 4500);
    for (int i = 0; i < 3; i++) {
        add_square(layer, 100000 * i, 0, 50000, ISO_ROLE_PERIMETER, 4500);
        layer->path[layer->count - 1].object = i == 1; /* 0 1 0 */
    }
}

static reading print_labels(iso_label_style style, iso_flavour flavour) {
    iso_paths layer[2] = {{0}, {0}};
    iso_gcode_totals totals;
    iso_gcode_options o = plain();
    make_objects(&layer[0]);
    make_objects(&layer[1]);
    o.labels = style;
    o.flavour = flavour;
    o.object = two;
    o.object_count = 2;
    reading r = print(&totals, &o, layer, 2);
    iso_paths_free(&layer[0]);
    iso_paths_free(&layer[1]);
    return r;
}

/* "; printing object cube.stl id:0 copy 0" is PrusaSlicer's. */
static void test_labels_in_comments(void) {
    char lines[4096];
    reading r = print_labels(ISO_LABELS_OCTOPRINT, ISO_FLAVOUR_MARLIN2);
    const char *first = strstr(r.text, "; printing object a b.stl id:0 copy 0\n");
    const char *skirt = strstr(r.text, ";TYPE:Skirt/Brim");
    CHECK(skirt && first && skirt < first);
    lines_with(lines, sizeof lines, &r, "; printing object");
    CHECK(!strcmp(lines, "; printing object a b.stl id:0 copy 0\n"
                         "; printing object a b.stl id:0 copy 1\n"
                         "; printing object a b.stl id:0 copy 0\n"
                         "; printing object a b.stl id:0 copy 0\n"
                         "; printing object a b.stl id:0 copy 1\n"
                         "; printing object a b.stl id:0 copy 0\n"));
    CHECK_EQUAL(4, reading_count(&r, "; stop printing object a b.stl id:0 copy 0"));
    CHECK_EQUAL(2, reading_count(&r, "; stop printing object a b.stl id:0 copy 1"));
    CHECK(strstr(r.text, "; stop printing object a b.stl id:0 copy 0\n;LAYER_CHANGE"));
    free(r.text);
    r = print_labels(ISO_LABELS_DISABLED, ISO_FLAVOUR_MARLIN2);
    CHECK_EQUAL(0, reading_count(&r, "; printing object"));
    free(r.text);
}

/* Names of any length and with any bytes stay on their line. */
static void test_strange_names(void) {
    char name[400];
    for (int i = 0; i < 399; i++)
        name[i] = (char)(i % 255 + 1);
    name[399] = '\0';
    const iso_gcode_object strange[] = {{name, 12345678, 999999, {-1e6, 1e6}, NULL, 0},
                                        {NULL, 0, 0, {0, 0}, NULL, 0}};
    static const iso_flavour flavour[] = {ISO_FLAVOUR_MARLIN2, ISO_FLAVOUR_KLIPPER,
                                          ISO_FLAVOUR_REPRAPFIRMWARE};
    for (int i = 0; i < 6; i++) {
        iso_paths layer = {0};
        iso_gcode_totals totals;
        iso_gcode_options o = plain();
        make_objects(&layer);
        o.labels = i < 3 ? ISO_LABELS_FIRMWARE : ISO_LABELS_OCTOPRINT;
        o.flavour = flavour[i % 3];
        o.object = strange;
        o.object_count = 2;
        reading r = print(&totals, &o, &layer, 1);
        long odd = 0;
        for (const char *line = r.text; *line; line = strchr(line, '\n') + 1)
            odd += !strchr("\n;GM", *line) && strncmp(line, "EXCLUDE_OBJECT", 14) != 0;
        CHECK_EQUAL(0, odd);
        CHECK_EQUAL(i >= 3 ? 3 : 0, reading_count(&r, "; stop printing object "));
        free(r.text);
        iso_paths_free(&layer);
    }
}

static void test_labels_by_firmware(void) {
    reading r = print_labels(ISO_LABELS_FIRMWARE, ISO_FLAVOUR_KLIPPER);
    CHECK_EQUAL(1, reading_count(&r, "EXCLUDE_OBJECT_DEFINE NAME=a_b_stl_id_0_copy_0 CENTER=20,30 "
                                     "POLYGON=[[10,20],[30,20],[20.5,40.25]]\n"));
    CHECK_EQUAL(
        1, reading_count(&r, "EXCLUDE_OBJECT_DEFINE NAME=a_b_stl_id_0_copy_1 CENTER=-7.5,3\n"));
    CHECK_EQUAL(4, reading_count(&r, "EXCLUDE_OBJECT_START NAME=a_b_stl_id_0_copy_0\n"));
    CHECK_EQUAL(2, reading_count(&r, "EXCLUDE_OBJECT_END NAME=a_b_stl_id_0_copy_1\n"));
    CHECK_EQUAL(0, reading_count(&r, "; printing object"));
    free(r.text);
    r = print_labels(ISO_LABELS_FIRMWARE, ISO_FLAVOUR_MARLIN2);
    CHECK_EQUAL(1, reading_count(&r, "M486 T2\n"));
    CHECK_EQUAL(4, reading_count(&r, "M486 S0\n"));
    CHECK_EQUAL(2, reading_count(&r, "M486 S1\n"));
    CHECK_EQUAL(6, reading_count(&r, "M486 S-1\n"));
    free(r.text);
    r = print_labels(ISO_LABELS_FIRMWARE, ISO_FLAVOUR_REPRAPFIRMWARE);
    CHECK_EQUAL(1, reading_count(&r, "M486 S0 A\"a_b_stl\"\nM486 S1 A\"a_b_stl\"\nM486 S-1\n"));
    CHECK_EQUAL(2, reading_count(&r, "M486 S1\n"));
    free(r.text);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.labels = ISO_LABELS_FIRMWARE;
    o.flavour = ISO_FLAVOUR_TEACUP;
    CHECK_STATUS(ISO_BAD_CONFIG, write_file(&totals, &o, NULL, 0));
    CHECK(strstr(iso_error_message(), "gcode_label_objects: teacup has no commands"));
}

/* ---- roles, flow, comments, units of E ---- */

/* A wall whose middle hangs over: fan, acceleration and speed change there and back. */
static void test_pieces_of_a_path(void) {
    iso_paths layer = {0};
    iso_point p[4] = {{0, 0}, {100000, 0}, {200000, 0}, {300000, 0}};
    CHECK_OK(iso_paths_add(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, p, 4, 4500, 8141593));
    layer.vertex[1].role = ISO_ROLE_OVERHANG_PERIMETER;
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.fan_always_on = 1;
    o.min_fan_speed = 40;
    o.bridge_fan_speed = 100;
    o.disable_fan_first_layers = 0;
    o.default_acceleration = 900;
    o.role_acceleration[ISO_ROLE_OVERHANG_PERIMETER] = 300;
    o.speed[ISO_ROLE_OVERHANG_PERIMETER] = o.first_layer_speed[ISO_ROLE_OVERHANG_PERIMETER] = 25;
    reading r = print(&totals, &o, &layer, 1);
    const char *expected = "M106 S102\nG1 E-2 F2400\nG1 Z.2 F7800\nG1 X0 Y0\nG1 E2 F2400\n"
                           "M204 P900\n;TYPE:Perimeter\n;WIDTH:0.45\nG1 X10 Y0 E.33849 F3600\n"
                           "M106 S255\nM204 P300\n;TYPE:Overhang perimeter\n"
                           "G1 X20 Y0 E.33849 F1500\n"
                           "M106 S102\nM204 P900\n;TYPE:Perimeter\nG1 X30 Y0 E.33848 F3600\n";
    if (!CHECK(strstr(r.text, expected)))
        fputs(r.text, stderr);
    free(r.text);
    iso_paths_free(&layer);
}

/* 3 mm^3/s: a wide bead's feed follows from its section, a thin one's is its role's. */
static void test_flow_limit_by_vertex(void) {
    iso_paths layer = {0};
    iso_point p[3] = {{0, 0}, {300000, 0}, {600000, 0}};
    CHECK_OK(iso_paths_add(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, p, 3, 4500, 4000000));
    layer.vertex[1].area = 10000000;
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.max_volumetric_speed = 3;
    reading r = print(&totals, &o, &layer, 1);
    CHECK(strstr(r.text, "G1 X30 Y0 E.4989 F3600\n")); /* 2.4 mm^3/s */
    CHECK(strstr(r.text, "G1 X60 Y0 E1.24726 F1800\n"));
    free(r.text);
    iso_paths_free(&layer);
}

static void test_comments(void) {
    iso_paths layer[LAYERS];
    make(layer);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.gcode_comments = 1;
    o.default_acceleration = 900;
    reading r = print(&totals, &o, layer, 1);
    CHECK(strstr(r.text, "\nG1 E-2 F2400 ; retract\nG1 Z.2 F7800 ; lift\nG1 X0 Y0 ; travel\n"
                         "G1 E2 F2400 ; unretract\nM204 P900 ; acceleration\n"));
    CHECK(strstr(r.text, "\nG1 X20 Y20 E.67697 ; perimeter\n"));
    long lines = 0, bare = 0;
    for (const char *line = r.text; *line; line = strchr(line, '\n') + 1)
        if (!strncmp(line, "G1", 2))
            lines++, bare += memchr(line, ';', strcspn(line, "\n")) == NULL;
    CHECK(lines > 7);
    CHECK_EQUAL(0, bare);
    free(r.text);
    free_all(layer);
}

/* E in mm^3: 2.405 of them are a mm of filament; the firmware is told, and told back. */
static void test_volumetric(void) {
    const double section = 3.14159265358979 / 4 * 1.75 * 1.75;
    iso_paths layer[LAYERS];
    make(layer);
    iso_gcode_options o = plain();
    iso_gcode_totals mm, mm3;
    reading r = print(&mm, &o, layer, 2);
    double drawn = r.drawn, pulled = r.pulled;
    free(r.text);
    o.use_volumetric_e = 1;
    o.end_gcode = "M84";
    r = print(&mm3, &o, layer, 2);
    CHECK_NEAR(drawn * section, r.drawn, 1e-4);
    CHECK_NEAR(pulled * section, r.pulled, 1e-4);
    CHECK_NEAR(mm.filament_mm, mm3.filament_mm, 1e-4);
    CHECK_NEAR(mm.time, mm3.time, 0.02 * mm.time);
    CHECK(strstr(r.text, "M83 ; relative E\nM200 D1.75\n"));
    CHECK(strstr(r.text, "\nM200 D0\nM84\n"));
    free(r.text);
    free_all(layer);
}

static void test_cost(void) {
    iso_paths layer[LAYERS];
    make(layer);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.filament_cost = 25000; /* so that so little costs something */
    reading r = print(&totals, &o, layer, LAYERS);
    CHECK_NEAR(totals.filament_g / 1000 * 25000, totals.filament_cost, 1e-9);
    CHECK_NEAR(totals.filament_cost, reading_figure(&r, "; filament cost = "), 0.00501);
    CHECK_NEAR(totals.filament_cost, reading_figure(&r, "; total filament cost = "), 0.00501);
    free(r.text);
    free_all(layer);
}

/* ---- one object after the other ---- */

static iso_status write_objects(const iso_gcode_options *o, const iso_paths *layer) {
    iso_output *output;
    iso_gcode_writer *writer = NULL;
    iso_gcode_totals totals;
    ISO_TRY(iso_output_open(&output, SMALL_FILE));
    CHECK_OK(iso_gcode_writer_new(&writer, output, o));
    CHECK_OK(iso_gcode_begin(writer));
    for (int object = 0; object < 2; object++) {
        if (object > 0)
            CHECK_OK(iso_gcode_next_object(writer, object));
        for (int i = 0; i < LAYERS - object; i++)
            CHECK_OK(iso_gcode_layer(writer, &(iso_gcode_layer_info){.index = i,
                                                                     .z = 2000 * (i + 1),
                                                                     .height = 2000,
                                                                     .paths = &layer[object]}));
    }
    CHECK_OK(iso_gcode_finish(&totals, writer, NULL, NULL));
    iso_gcode_writer_free(writer);
    CHECK_EQUAL(2 * LAYERS - 1, totals.layers);
    return iso_output_commit(output);
}

/* No move across at a height that something stands at. */
static void test_next_object(void) {
    iso_paths layer[2] = {{0}, {0}};
    add_square(&layer[0], 0, 0, 100000, ISO_ROLE_PERIMETER, 4500);
    add_square(&layer[1], 500000, 0, 100000, ISO_ROLE_PERIMETER, 4500);
    iso_gcode_options o = plain();
    o.retract_lift = 0.4;
    o.text = echo;
    o.text_payload = "BETWEEN LAYER";
    o.temperature = 190;
    o.events = "0.5:M300";
    CHECK_OK(write_objects(&o, layer));
    reading r = reading_of(SMALL_FILE);
    unlink(SMALL_FILE);
    /* 1 mm of top, 1 of clearance, the lift */
    const char *expected = "G1 E-2 F2400\nG1 Z2.4 F7800\n;BETWEEN 4 1 1\n;LAYER_CHANGE\n;Z:0.2\n"
                           ";HEIGHT:0.2\nG92 E0\n;LAYER 0 0.2 1\nM104 S200\n"
                           "G1 X50 Y0 F7800\nG1 Z.2\nG1 E2 F2400\n";
    if (!CHECK(strstr(r.text, expected)))
        fputs(r.text, stderr);
    CHECK_EQUAL(2, reading_count(&r, "M104 S190"));
    CHECK_EQUAL(1, reading_count(&r, "M300"));
    free(r.text);
    iso_paths_free(&layer[0]);
    iso_paths_free(&layer[1]);
}

static void test_without_memory(void) {
    iso_gcode_options o = plain();
    o.text = echo;
    o.events = "1:color;2:pause";
    o.remaining_times = 1;
    for (int64_t n = 0;; n++) {
        iso_gcode_totals totals;
        iso_fail_allocation_after(n);
        iso_status status = write_file(&totals, &o, NULL, 0);
        iso_fail_allocation_after(-1);
        unlink(SMALL_FILE);
        if (status == ISO_OK) {
            CHECK(n >= 4);
            break;
        }
        CHECK_EQUAL(ISO_NO_MEMORY, status);
    }
}

int main(void) {
    RUN(test_places_of_texts);
    RUN(test_events_at_heights);
    RUN(test_events_by_flavour);
    RUN(test_bad_events_are_refused);
    RUN(test_random_events);
    RUN(test_labels_in_comments);
    RUN(test_strange_names);
    RUN(test_labels_by_firmware);
    RUN(test_pieces_of_a_path);
    RUN(test_flow_limit_by_vertex);
    RUN(test_comments);
    RUN(test_volumetric);
    RUN(test_cost);
    RUN(test_next_object);
    RUN(test_without_memory);
    return check_verdict();
}
