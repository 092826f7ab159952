/* Each flavour's words are those that PrusaSlicer 2.5.0 wrote for its gcode_flavor of that name:
 * a block with --temperature 210 --first-layer-temperature 220 --bed-temperature 50
 * --first-layer-bed-temperature 60 --default-acceleration 1111 --perimeter-acceleration 800
 * --first-layer-acceleration 500 --fan-always-on --disable-fan-first-layers 1. (It writes the fan's
 * half as 127.5; here it is rounded.) */
#define SMALL_FILE "test-gcode-flavours.gcode"
#include "small.h"

typedef struct facts {
    const char *name;
    const char *nozzle_first, *nozzle_wait, *nozzle, *bed_wait, *bed;
    const char *fan, *fan_off;
    const char *first, *perimeter; /* acceleration */
    const char *reset, *way;       /* NULL: none */
    const char *drawn;             /* before the amount of filament, or the end of the line */
    const char *retract, *deretract;
    int units;
} facts;

#define SPRINTER_HEAT "M104 S220", "M109 S220", "M104 S210", "M190 S60", "M140 S50"
#define P_HEAT "M104 P220", "M109 P220", "M104 P210", "M190 P60", "M140 P50"

static const facts known[] = {
    {"marlin2", SPRINTER_HEAT, "M106 S128", "M107", "M204 P500", "M204 P800", "G92 E0", "M82",
     "G1 X20 Y0 E", "G10", "G11", 1},
    {"marlin", SPRINTER_HEAT, "M106 S128", "M107", "M204 S500", "M204 S800", "G92 E0", "M82",
     "G1 X20 Y0 E", "G10", "G11", 1},
    {"reprap", SPRINTER_HEAT, "M106 S128", "M107", "M204 S500", "M204 S800", "G92 E0", "M82",
     "G1 X20 Y0 E", "G10", "G11", 1},
    {"smoothie", SPRINTER_HEAT, "M106 S128", "M107", "M204 S500", "M204 S800", "G92 E0", "M82",
     "G1 X20 Y0 E", "G10", "G11", 1},
    {"reprapfirmware", "G10 S220 P0", "G10 S220 P0\nM116", "G10 S210 P0", "M190 S60", "M140 S50",
     "M106 S128", "M107", "M204 P500", "M204 P800", "G92 E0", "M82", "G1 X20 Y0 E", "G10", "G11",
     1},
    {"repetier", SPRINTER_HEAT, "M106 S128", "M107", "M201 X500 Y500\nM202 X500 Y500",
     "M201 X800 Y800\nM202 X800 Y800", "G92 E0", "M82", "G1 X20 Y0 E", "G10", "G11", 1},
    {"teacup", "M104 S220", "M104 S220\nM116", "M104 S210", "M140 S60\nM116", "M140 S50",
     "M106 S128", "M106 S0", "M204 S500", "M204 S800", "G92 E0", "M82", "G1 X20 Y0 E", "G10", "G11",
     1},
    {"machinekit", P_HEAT, "M106 P128", "M107", "M204 S500", "M204 S800", "G92 A0", NULL,
     "G1 X20 Y0 A", "G22", "G23", 1},
    {"mach3", P_HEAT, "M106 P128", "M107", "M204 S500", "M204 S800", NULL, NULL, "G1 X20 Y0 A",
     "G10", "G11", 1},
    {"sailfish", "M104 S220 T0", NULL, "M104 S210 T0", "M109 S60", "M140 S50", "M126", "M127",
     "M204 S500", "M204 S800", NULL, NULL, "G1 X20 Y0 E", "G10", "G11", 1},
    {"makerware", "M104 S220 T0", NULL, "M104 S210 T0", "M109 S60", "M140 S50", "M126", "M127",
     "M204 S500", "M204 S800", NULL, NULL, "G1 X20 Y0 E", "G10\nM103", "M101\nG11", 0},
    {"no-extrusion", SPRINTER_HEAT, "M106 S128", "M107", "M204 S500", "M204 S800", NULL, NULL,
     "G1 X20 Y0 F", NULL, NULL, 1},
    /* Klipper's own manual: SET_VELOCITY_LIMIT, and what it takes over from Marlin */
    {"klipper", SPRINTER_HEAT, "M106 S128", "M107", "SET_VELOCITY_LIMIT ACCEL=500",
     "SET_VELOCITY_LIMIT ACCEL=800", "G92 E0", "M82", "G1 X20 Y0 E", "G10", "G11", 1},
};

enum { KNOWN = sizeof known / sizeof *known };

static iso_gcode_options options_for(const char *name) {
    iso_gcode_options o = plain();
    CHECK_OK(iso_flavour_from_name(&o.flavour, name));
    o.use_relative_e_distances = 0;
    o.first_layer_temperature = 220;
    o.temperature = 210;
    o.first_layer_bed_temperature = 60;
    o.bed_temperature = 50;
    o.default_acceleration = 1111;
    o.first_layer_acceleration = 500;
    o.role_acceleration[ISO_ROLE_PERIMETER] = 800;
    o.fan_always_on = 1;
    o.min_fan_speed = 50;
    o.disable_fan_first_layers = 1;
    return o;
}

/* Lines of the text, one after the other, somewhere in the file. */
static int has_lines(const reading *r, const char *lines) {
    char between[128];
    snprintf(between, sizeof between, "\n%s\n", lines);
    return strstr(r->text, between) != NULL;
}

static void check_line(const reading *r, const char *name, const char *what, const char *lines) {
    if (lines && !CHECK(has_lines(r, lines)))
        fprintf(stderr, "    %s has no %s: %s\n", name, what, lines);
}

static void check_facts(const reading *r, const facts *f) {
    check_line(r, f->name, "first temperature", f->nozzle_first);
    check_line(r, f->name, "wait for the nozzle", f->nozzle_wait);
    check_line(r, f->name, "temperature", f->nozzle);
    check_line(r, f->name, "wait for the bed", f->bed_wait);
    check_line(r, f->name, "bed", f->bed);
    check_line(r, f->name, "fan", f->fan);
    check_line(r, f->name, "fan off", f->fan_off);
    check_line(r, f->name, "first acceleration", f->first);
    check_line(r, f->name, "acceleration", f->perimeter);
    check_line(r, f->name, "reset of E", f->reset);
    CHECK(strstr(r->text, f->drawn));
    CHECK_EQUAL(f->way != NULL, reading_count(r, "M82"));
    CHECK_EQUAL(0, reading_count(r, "M83"));
    CHECK_EQUAL(f->units, reading_count(r, "G21"));
    CHECK_EQUAL(f->units, reading_count(r, "G90"));
    CHECK_EQUAL(f->reset ? 2 : 0, reading_count(r, "G92"));
    CHECK_EQUAL(!f->nozzle_wait, reading_count(r, "M109 S220") + reading_count(r, "M109 P220") +
                                         reading_count(r, "M116") ==
                                     0);
}

static void make_two(iso_paths layer[2]) {
    for (int l = 0; l < 2; l++) {
        layer[l] = (iso_paths){0};
        add_square(&layer[l], 0, 0, 200000, ISO_ROLE_PERIMETER, 4500);
    }
}

static void test_words_of_each_flavour(void) {
    iso_paths layer[2];
    make_two(layer);
    CHECK_EQUAL(ISO_FLAVOUR_COUNT, KNOWN);
    for (int i = 0; i < KNOWN; i++) {
        iso_gcode_options o = options_for(known[i].name);
        iso_gcode_totals totals;
        reading r = print(&totals, &o, layer, 2);
        check_facts(&r, &known[i]);
        free(r.text);
    }
    iso_paths_free(&layer[0]);
    iso_paths_free(&layer[1]);
}

/* What tells M83 counts from there on; what can't be told so goes on from the start. */
static void test_relative_filament(void) {
    iso_paths layer[2];
    make_two(layer);
    for (int i = 0; i < KNOWN; i++) {
        iso_gcode_options o = options_for(known[i].name);
        iso_gcode_totals totals;
        o.use_relative_e_distances = 1;
        reading r = print(&totals, &o, layer, 2);
        CHECK_EQUAL(known[i].way != NULL, reading_count(&r, "M83"));
        CHECK_EQUAL(0, reading_count(&r, "M82"));
        if (strchr(known[i].drawn, 'E') || strchr(known[i].drawn, 'A')) {
            const char *first = strstr(r.text, known[i].drawn) + strlen(known[i].drawn);
            double e = strtod(first, NULL), side = 20 * 0.08141593 / (3.14159265 / 4 * 1.75 * 1.75);
            CHECK_NEAR(side, e, 2e-5); /* absolute: drawn back and forth before it */
        }
        free(r.text);
    }
    iso_paths_free(&layer[0]);
    iso_paths_free(&layer[1]);
}

static void test_firmware_retraction(void) {
    iso_paths layer[2];
    make_two(layer);
    for (int i = 0; i < KNOWN; i++) {
        iso_gcode_options o = options_for(known[i].name);
        iso_gcode_totals own, theirs;
        reading r = print(&own, &o, layer, 2);
        free(r.text);
        o.use_firmware_retraction = 1;
        r = print(&theirs, &o, layer, 2);
        CHECK_EQUAL(0, r.pulls);
        if (known[i].retract) {
            check_line(&r, known[i].name, "retraction", known[i].retract);
            check_line(&r, known[i].name, "its end", known[i].deretract);
            CHECK_EQUAL(own.retractions, theirs.retractions);
            CHECK_NEAR(own.time, theirs.time, 1e-9);
        } else {
            CHECK_EQUAL(0, theirs.retractions);
        }
        free(r.text);
    }
    iso_paths_free(&layer[0]);
    iso_paths_free(&layer[1]);
}

/* --machine-limits-usage emit_to_gcode, the values PrusaSlicer's defaults. */
static void test_machine_limits(void) {
    static const char marlin[] = "M201 X9000 Y9000 Z500 E10000\nM203 X500 Y500 Z12 E120\n"
                                 "M204 P1500 R1500 T1500\nM205 X10 Y10 Z0.2 E2.5",
                      duet[] = "M201 X9000 Y9000 Z500 E10000\nM203 X30000 Y30000 Z720 E7200\n"
                               "M204 P1500 T1500\nM566 X600 Y600 Z12 E150",
                      klipper[] = "SET_VELOCITY_LIMIT VELOCITY=500 ACCEL=1500";
    iso_paths layer[2];
    make_two(layer);
    for (int i = 0; i < KNOWN; i++) {
        iso_gcode_options o = options_for(known[i].name);
        iso_gcode_totals totals;
        o.emit_machine_limits = 1;
        o.limits.extruding = o.limits.retracting = o.limits.travel = 1500;
        reading r = print(&totals, &o, layer, 2);
        CHECK_EQUAL(!strncmp(known[i].name, "marlin", 6), has_lines(&r, marlin));
        CHECK_EQUAL(!strcmp(known[i].name, "reprapfirmware"), has_lines(&r, duet));
        CHECK_EQUAL(!strcmp(known[i].name, "klipper"), has_lines(&r, klipper));
        free(r.text);
    }
    iso_paths_free(&layer[0]);
    iso_paths_free(&layer[1]);
}

static void test_names(void) {
    iso_flavour flavour = ISO_FLAVOUR_COUNT;
    CHECK_OK(iso_flavour_from_name(&flavour, "marlin2"));
    CHECK_EQUAL(ISO_FLAVOUR_MARLIN2, flavour);
    CHECK_OK(iso_flavour_from_name(&flavour, "klipper"));
    CHECK_EQUAL(ISO_FLAVOUR_KLIPPER, flavour);
    CHECK_STATUS(ISO_BAD_CONFIG, iso_flavour_from_name(&flavour, "cura"));
    CHECK(strstr(iso_error_message(), "\"cura\" is not known; there are marlin2, marlin, klipper"));
    CHECK_EQUAL(ISO_FLAVOUR_KLIPPER, flavour);
}

/* M73 where the firmware knows it. */
static void test_progress(void) {
    iso_paths layer[2];
    make_two(layer);
    for (int i = 0; i < KNOWN; i++) {
        iso_gcode_options o = options_for(known[i].name);
        iso_gcode_totals totals;
        o.remaining_times = 1;
        reading r = print(&totals, &o, layer, 2);
        static const char *const without[] = {"smoothie",   "repetier", "teacup",
                                              "machinekit", "mach3",    "no-extrusion"};
        int none = 0;
        for (size_t k = 0; k < sizeof without / sizeof *without; k++)
            none += !strcmp(known[i].name, without[k]);
        CHECK_EQUAL(none ? 0 : 4, reading_count(&r, "M73 P"));
        free(r.text);
    }
    iso_paths_free(&layer[0]);
    iso_paths_free(&layer[1]);
}

int main(void) {
    RUN(test_words_of_each_flavour);
    RUN(test_relative_filament);
    RUN(test_firmware_retraction);
    RUN(test_machine_limits);
    RUN(test_names);
    RUN(test_progress);
    return check_verdict();
}
