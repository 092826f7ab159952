/* Prints with two tools: the change, what each nozzle is told, filament of each. */
#define SMALL_FILE "test-gcode-tools.gcode"
#include "small.h"

static void add_line(iso_paths *paths, int tool, int32_t y) {
    iso_point line[2] = {{0, y}, {100000, y}};
    iso_path like = {.role = ISO_ROLE_INTERNAL_INFILL, .tool = (uint8_t)tool};
    CHECK_OK(iso_paths_add(paths, &like, line, 2, 5000, 10000000));
}

/* Lines 5 mm apart; each line's tool as a digit, layers split by spaces. */
static int make(iso_paths *layer, const char *tools) {
    int layers = 1;
    int32_t y = 0;
    for (const char *c = tools; *c; c++)
        if (*c == ' ')
            layers++;
        else
            add_line(&layer[layers - 1], *c - '0', y += 50000);
    return layers;
}

static reading print_tools(iso_gcode_totals *totals, const iso_gcode_options *o,
                           const char *tools) {
    static iso_paths layer[8];
    int layers = make(layer, tools);
    reading r = print(totals, o, layer, layers);
    for (int i = 0; i < 8; i++)
        iso_paths_free(&layer[i]);
    return r;
}

static iso_gcode_options two(void) {
    iso_gcode_options o = plain();
    o.tools = 2;
    return o;
}

static int count(const char *text, const char *line) {
    int n = 0;
    for (const char *at = text; (at = strstr(at, line)); at++)
        n += at[-1] == '\n';
    return n;
}

static int in_order(const char *text, const char *const *line, int lines) {
    for (int i = 0; i < lines; i++) {
        text = strstr(text, line[i]);
        if (!text) {
            fprintf(stderr, "    not in its place: %s\n", line[i]);
            return 0;
        }
        text += strlen(line[i]);
    }
    return 1;
}
#define IN_ORDER(text, ...)                                                                        \
    in_order(text, (const char *const[]){__VA_ARGS__},                                             \
             (int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)))

/* One change a layer, each filament drawn back by its own, the place said anew. */
static void test_change(void) {
    iso_gcode_options o = two();
    iso_gcode_totals totals;
    reading r = print_tools(&totals, &o, "001 110 0");
    CHECK_EQUAL(2, totals.tool_changes);
    CHECK_EQUAL(1, count(r.text, "T1\n"));
    CHECK_EQUAL(2, count(r.text, "T0\n")); /* at the beginning, and back */
    CHECK(IN_ORDER(r.text, "T0\n", "G1 X10 Y10 E", "G1 E-2 F2400\nT1\n",
                   "G1 Z.2 F7800\nG1 X0 Y15\n", "G1 E2 ", "G1 X10 Y15 E", "G1 X10 Y25 E",
                   "G1 E-2 F2400\nT0\n", "G1 X0 Y30", "G1 E2 ", "G1 X10 Y30 E"));
    double line = 10 * 0.1 / (3.14159265358979 / 4 * 1.75 * 1.75);
    CHECK_NEAR(7 * line, totals.filament_mm, 1e-4);
    CHECK_NEAR(4 * line, totals.tool_mm[0], 1e-4);
    CHECK_NEAR(3 * line, totals.tool_mm[1], 1e-4);
    CHECK(strstr(r.text, "; filament used [mm] = 1.66, 1.25\n"));
    CHECK_NEAR(r.pulled, r.fed + 4, 1e-9); /* both end drawn back */
    free(r.text);
}

/* A print that could change but doesn't; and one with a single tool has no word of it. */
static void test_no_change(void) {
    iso_gcode_options o = two();
    iso_gcode_totals totals;
    reading r = print_tools(&totals, &o, "00 0");
    CHECK_EQUAL(0, totals.tool_changes);
    CHECK_EQUAL(0, count(r.text, "T1"));
    free(r.text);
    o.tools = 1;
    r = print_tools(&totals, &o, "00 0");
    CHECK_EQUAL(0, count(r.text, "T"));
    CHECK(!strstr(r.text, " T0") && !strstr(r.text, " T1"));
    free(r.text);
}

/* Absolute E is counted anew for each filament, and none is lost. */
static void test_absolute_e(void) {
    for (int firmware = 0; firmware < 2; firmware++) {
        iso_gcode_options o = two();
        iso_gcode_totals totals;
        o.use_relative_e_distances = 0;
        o.use_firmware_retraction = firmware;
        reading r = print_tools(&totals, &o, "01 10");
        CHECK(strstr(r.text, "T1\nG92 E0\n"));
        CHECK_EQUAL(2 + 2, count(r.text, "G92 E0\n"));
        CHECK_NEAR(totals.filament_mm, r.drawn, 1e-4);
        CHECK((r.pulls == 0) == firmware);
        if (firmware)
            CHECK_EQUAL(count(r.text, "G10\n"), count(r.text, "G11\n") + 2);
        free(r.text);
    }
}

/* Both nozzles are as hot; one that the start text forgets is heated, and waited for once. */
static void test_heat(void) {
    iso_gcode_options o = two();
    iso_gcode_totals totals;
    o.first_layer_temperature = 215;
    o.temperature = 210;
    o.end_gcode = "M104 S0\n";
    reading r = print_tools(&totals, &o, "01 10 01");
    CHECK(IN_ORDER(r.text, "M104 S215 T0\nM104 S215 T1\n", "M109 S215 T0\nM109 S215 T1\n",
                   "M104 S210 T0\nM104 S210 T1\n", "M104 S0 T0\nM104 S0\n"));
    CHECK_EQUAL(2, count(r.text, "M109"));
    free(r.text);
    o.start_gcode = "G28\nM109 S215\n";
    r = print_tools(&totals, &o, "01 10 01 1");
    CHECK(
        IN_ORDER(r.text, "G28\nM109 S215\n", "M104 S215 T1\n", "G1 E-2 F2400\nM109 S215 T1\nT1\n"));
    CHECK_EQUAL(2, count(r.text, "M109"));
    free(r.text);
    o.start_gcode = "M104 S215 T1\nM109 S215 T0\nM109 S215 T1\n";
    r = print_tools(&totals, &o, "01 10");
    CHECK_EQUAL(1, count(r.text, "M104 S215 T1\n"));
    CHECK_EQUAL(1, count(r.text, "M109 S215 T1\n"));
    free(r.text);
    o = two();
    o.temperature = o.first_layer_temperature = 0;
    r = print_tools(&totals, &o, "01 10");
    CHECK(!strstr(r.text, "M104") && !strstr(r.text, "M109"));
    free(r.text);
}

/* Words of the flavours that have their own. */
static void test_flavours(void) {
    static const struct {
        const char *name, *heat, *take;
    } of[] = {
        {"marlin2", "M104 S200 T1\n", "T1\n"},       {"klipper", "M104 S200 T1\n", "T1\n"},
        {"reprapfirmware", "G10 S200 P1\n", "T1\n"}, {"teacup", "M104 S200 T1\n", "T1\n"},
        {"machinekit", "M104 P200 T1\n", "T1\n"},    {"sailfish", "M104 S200 T1\n", "M108 T1\n"},
        {"makerware", "M104 S200 T1\n", "M135 T1\n"}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        iso_gcode_options o = two();
        iso_gcode_totals totals;
        CHECK_OK(iso_flavour_from_name(&o.flavour, of[i].name));
        reading r = print_tools(&totals, &o, "01");
        CHECK(count(r.text, of[i].heat) >= 1);
        CHECK_EQUAL(1, count(r.text, of[i].take));
        free(r.text);
    }
}

typedef struct asked {
    int count;
    iso_gcode_place place[8];
    const char *text;
} asked;

static iso_status answer(char *text, size_t size, const void *payload, iso_gcode_text_kind kind,
                         const iso_gcode_place *place) {
    asked *a = *(asked *const *)payload;
    *text = '\0';
    if (kind == ISO_TEXT_TOOLCHANGE) {
        a->place[a->count++] = *place;
        snprintf(text, size, "%s", a->text);
    }
    return ISO_OK;
}

/* Before the command, or instead of it; knows which tools and where. */
static void test_text(void) {
    asked a = {.text = "M117 change"}, *at = &a;
    iso_gcode_options o = two();
    iso_gcode_totals totals;
    o.text = answer;
    o.text_payload = &at;
    reading r = print_tools(&totals, &o, "01 10");
    CHECK_EQUAL(2, a.count);
    CHECK(a.place[0].tool == 0 && a.place[0].next_tool == 1 && a.place[0].tool_changes == 1);
    CHECK(a.place[1].tool == 1 && a.place[1].next_tool == 0 && a.place[1].tool_changes == 2);
    CHECK(a.place[1].layer == 1 && fabs(a.place[1].z - 0.4) < 1e-9);
    CHECK(strstr(r.text, "M117 change\nT1\n") && strstr(r.text, "M117 change\nT0\n"));
    free(r.text);
    a = (asked){.text = "G1 X0 Y0\nT1\nG1 E3\n"};
    r = print_tools(&totals, &o, "01");
    CHECK(strstr(r.text, "T1\nG1 E3\nG1 E-2") && count(r.text, "T1\n") == 1);
    free(r.text);
}

/* A change belongs to no object: a firmware that leaves one out must not leave it out. */
static void test_labels(void) {
    iso_gcode_options o = two();
    iso_gcode_totals totals;
    iso_gcode_object object = {.name = "part.stl"};
    o.labels = ISO_LABELS_OCTOPRINT;
    o.object = &object;
    o.object_count = 1;
    reading r = print_tools(&totals, &o, "01 1");
    CHECK(IN_ORDER(r.text, "; printing object part.stl", "; stop printing object part.stl", "T1\n",
                   "; printing object part.stl", "; stop printing object part.stl"));
    free(r.text);
}

static void test_tools_there_are_not(void) {
    iso_paths layer = {0};
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    add_line(&layer, 1, 0);
    CHECK_STATUS(ISO_BUG, write_file(&totals, &o, &layer, 1));
    o.tools = 3;
    CHECK_STATUS(ISO_BUG, write_file(&totals, &o, &layer, 1));
    iso_paths_free(&layer);
}

int main(void) {
    RUN(test_change);
    RUN(test_no_change);
    RUN(test_absolute_e);
    RUN(test_heat);
    RUN(test_flavours);
    RUN(test_text);
    RUN(test_labels);
    RUN(test_tools_there_are_not);
    return check_verdict();
}
