/* What the options of flow, acceleration, the fan's place and the machine's limits do. */
#include "option_row.h"

/* Two pillars and a slab across: walls and infill over air. */
static void make_table(shape *s) {
    shape_box(s, 0, 0, 0, 6, 12, 1.9);
    shape_box(s, 16, 0, 0, 22, 12, 1.9);
    shape_box(s, 0, 0, 1.9, 22, 12, 3.6);
}

/* mm^2: of beads 0.45 mm wide on layers of 0.3 mm. */
#define AREA (0.15 * 0.3 + SHAPE_PI * 0.15 * 0.15)

/* mm^3/s of a drawing move. */
static double flow_of(const print *p, const print_move *m) {
    double d = p->options.filament_diameter;
    return m->e * SHAPE_PI / 4 * d * d / move_length(m) * m->f / 60;
}

static double most_flow(const print *p) {
    double most = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (move_chosen(&p->move[i], -1, -1) && move_length(&p->move[i]) > 1)
            most = fmax(most, flow_of(p, &p->move[i]));
    return most;
}

/* Speeds in mm/s of a role above the first layer. */
static void speeds_of(double *least, double *most, const print *p, int role) {
    *least = 1e9, *most = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (move_chosen(&p->move[i], role, -1) && p->move[i].layer > 0) {
            *least = fmin(*least, p->move[i].f / 60);
            *most = fmax(*most, p->move[i].f / 60);
        }
}

static void check_role_speed(const print *p, int role, double speed) {
    double least, most;
    speeds_of(&least, &most, p, role);
    CHECK_NEAR(speed, least, 0.01);
    CHECK_NEAR(speed, most, 0.01);
}

/* PrusaSlicer 2.5 gives walls and infill of this block F2593 with 5 mm^3/s, and leaves what is
 * slower as it is. */
static void max_volumetric_speed(const change *c) {
    double least, most;
    same_places(c->a, c->b);
    same_filament(c->a, c->b);
    CHECK(most_flow(c->a) > 8);
    CHECK(most_flow(c->b) < 5.01);
    speeds_of(&least, &most, c->b, ISO_ROLE_PERIMETER);
    CHECK_NEAR(5 / AREA, least, 0.02);
    CHECK_NEAR(2593.23 / 60, least, 0.05);
    check_role_speed(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 30);
}

static void filament_max_volumetric_speed(const change *c) {
    CHECK(most_flow(c->a) > 4.9);
    CHECK(most_flow(c->b) < 3.01);
}

/* Walls at 0: 8 mm^3/s would be 69 mm/s, max_print_speed is less. */
static void max_print_speed(const change *c) {
    check_role_speed(c->a, ISO_ROLE_PERIMETER, 80);
    check_role_speed(c->b, ISO_ROLE_PERIMETER, 44);
    check_role_speed(c->b, ISO_ROLE_INTERNAL_INFILL, 80);
}

/* PrusaSlicer 2.5: F4149 for walls with 8 mm^3/s and max_print_speed 100. */
static void perimeter_speed_zero(const change *c) {
    check_role_speed(c->a, ISO_ROLE_PERIMETER, 60);
    check_role_speed(c->b, ISO_ROLE_PERIMETER, 8 / AREA);
    CHECK_NEAR(4149.173 / 60, 8 / AREA, 0.05);
}

static void bridge_speed(const change *c) {
    same_places(c->a, c->b);
    check_role_speed(c->a, ISO_ROLE_BRIDGE_INFILL, 60);
    check_role_speed(c->b, ISO_ROLE_BRIDGE_INFILL, 33);
}

/* ---- acceleration ---- */

/* The acceleration told last before the lines of a type, on layers from `first` to `last`:
 * 0 if it isn't always the same. */
static double told_before(const print *p, const char *command, const char *type, int first,
                          int last) {
    double now = -1, found = -1;
    int layer = -1, here = 0;
    size_t size = strlen(command);
    for (const char *line = p->text; line && *line; line = strchr(line, '\n')) {
        line += *line == '\n';
        layer += !strncmp(line, ";LAYER_CHANGE", 13);
        if (!strncmp(line, command, size))
            now = strtod(line + size, NULL);
        if (!strncmp(line, ";TYPE:", 6))
            here = !strncmp(line + 6, type, strlen(type)) && line[6 + strlen(type)] == '\n';
        if (!here || strncmp(line, "G1 X", 4) || !memchr(line, 'E', strcspn(line, "\n")) ||
            layer < first || layer > last)
            continue;
        if (found >= 0 && found != now)
            return 0;
        found = now;
    }
    return found;
}

static void check_told(const print *p, const char *type, int first, int last, double value) {
    if (!CHECK_NEAR(value, told_before(p, "M204 P", type, first, last), 0))
        fprintf(stderr, "    %s, layers %d to %d\n", type, first, last);
}

#define OTHERS "default_acceleration = 900\n"
enum { LAST = 1000 };

static void default_acceleration(const change *c) {
    same_places(c->a, c->b);
    CHECK(!strstr(c->a->text, "\nM204"));
    check_told(c->b, "Perimeter", 0, LAST, 600);
    check_told(c->b, "Internal infill", 0, LAST, 600);
    CHECK(!strstr(c->b->text, "\nM204 T"));
    CHECK(c->b->report.print.time > c->a->report.print.time + 1);
}

static void first_layer_acceleration(const change *c) {
    check_told(c->b, "Perimeter", 0, 0, 300);
    check_told(c->b, "Skirt/Brim", 0, 0, 300);
    check_told(c->b, "Perimeter", 1, LAST, 900);
}

static void perimeter_acceleration(const change *c) {
    check_told(c->b, "Perimeter", 0, LAST, 500);
    check_told(c->b, "External perimeter", 0, LAST, 500);
    check_told(c->b, "Internal infill", 0, LAST, 900);
}

static void external_perimeter_acceleration(const change *c) {
    check_told(c->b, "Perimeter", 0, LAST, 900);
    check_told(c->b, "External perimeter", 0, LAST, 400);
}

static void infill_acceleration(const change *c) {
    check_told(c->b, "Internal infill", 0, LAST, 700);
    check_told(c->b, "Solid infill", 0, LAST, 700);
    check_told(c->b, "Top solid infill", 0, LAST, 700);
    check_told(c->b, "Perimeter", 0, LAST, 900);
}

static void solid_infill_acceleration(const change *c) {
    check_told(c->b, "Internal infill", 0, LAST, 900);
    check_told(c->b, "Solid infill", 0, LAST, 650);
    check_told(c->b, "Top solid infill", 0, LAST, 650);
}

static void top_solid_infill_acceleration(const change *c) {
    check_told(c->b, "Solid infill", 0, LAST, 900);
    check_told(c->b, "Top solid infill", 0, LAST, 450);
}

static void bridge_acceleration(const change *c) {
    check_told(c->b, "Bridge infill", 1, LAST, 350);
    check_told(c->b, "Perimeter", 0, LAST, 900);
}

static void travel_acceleration(const change *c) {
    same_places(c->a, c->b);
    CHECK(!strstr(c->a->text, "\nM204 T"));
    CHECK(strstr(c->b->text, "\nM204 T200\n"));
    CHECK(c->b->report.print.idle_time > c->a->report.print.idle_time + 0.5);
    CHECK_NEAR(c->b->report.print.time,
               c->a->report.print.time + c->b->report.print.idle_time -
                   c->a->report.print.idle_time,
               0.5); /* corners between the two kinds of moves aside */
}

/* ---- the fan ---- */

static void fans_of(double *bridge, double *other, const print *p, int32_t from) {
    *bridge = *other = -1;
    for (int32_t i = p->level[from].first; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind == MOVE_DRAW)
            *(m->role == ISO_ROLE_BRIDGE_INFILL || m->role == ISO_ROLE_OVERHANG_PERIMETER ? bridge
                                                                                          : other) =
                m->fan;
    }
}

static void bridge_fan_speed(const change *c) {
    double bridge, other;
    same_places(c->a, c->b);
    fans_of(&bridge, &other, c->a, 4);
    CHECK_NEAR(100, bridge, 0.3);
    CHECK_NEAR(35, other, 0.3);
    fans_of(&bridge, &other, c->b, 4);
    CHECK_NEAR(70, bridge, 0.3);
    CHECK_NEAR(35, other, 0.3);
}

static double fan_on(const print *p, int32_t layer) {
    return p->move[p->level[layer + 1].first - 1].fan;
}

/* Layers count from 0: of layers 3 to 7, the fourth to the eighth. */
static void full_fan_speed_layer(const change *c) {
    same_places(c->a, c->b);
    for (int32_t i = 0; i < 9; i++) {
        CHECK_NEAR(i < 3 ? 0 : 40, fan_on(c->a, i), 0.3);
        CHECK_NEAR(i < 3 ? 0 : i < 8 ? 40 * (i - 2) / 5.0 : 40, fan_on(c->b, i), 0.3);
    }
}

/* ---- the machine ---- */

static void machine_limits_usage(const change *c) {
    static const char told[] = "\nM201 X9000 Y9000 Z500 E10000\nM203 X500 Y500 Z12 E120\n"
                               "M204 P700 R1000 T1000\nM205 X10 Y10 Z0.2 E2.5\n";
    CHECK(!strstr(c->a->text, "\nM201"));
    CHECK(strstr(c->b->text, told));
    check_told(c->a, "Perimeter", 0, LAST, 900);
    check_told(c->b, "Perimeter", 0, LAST, 700); /* no more than the machine can do */
    CHECK_NEAR(c->a->report.print.time, c->b->report.print.time, 1e-9);
}

/* Without them the estimate is that of any machine. */
static void machine_limits_ignored(const change *c) {
    CHECK(c->b->report.print.time < c->a->report.print.time - 0.5);
}

/* As in option_machine.c: the moves are the same, they only take longer. */
static void slower(const change *c) {
    same_places(c->a, c->b);
    same_filament(c->a, c->b);
    CHECK(c->b->report.print.time > c->a->report.print.time + 0.05);
}

static void told_jerk(const change *c) {
    same_places(c->a, c->b);
    CHECK(c->b->report.print.time > c->a->report.print.time + 0.005);
    CHECK(strstr(c->b->text, "\nM205 X"));
}

#define JERK "machine_limits_usage = emit_to_gcode\ngcode_flavor = marlin\n"

const option_row option_rows_speeds[] = {
    {make_block, "max_volumetric_speed", "5", STEADY, max_volumetric_speed},
    {make_block, "filament_max_volumetric_speed", "3", STEADY "max_volumetric_speed = 5",
     filament_max_volumetric_speed},
    {make_block, "max_print_speed", "44", STEADY "perimeter_speed = 0", max_print_speed},
    {make_block, "perimeter_speed", "0",
     STEADY "external_perimeter_speed = 20\nmax_print_speed = 100\nmax_volumetric_speed = 8\n"
            "infill_speed = 20\nsolid_infill_speed = 20\ntop_solid_infill_speed = 15",
     perimeter_speed_zero},
    {make_table, "bridge_speed", "33", STEADY, bridge_speed},
    {make_block, "default_acceleration", "600", STEADY, default_acceleration},
    {make_block, "first_layer_acceleration", "300", OTHERS, first_layer_acceleration},
    {make_block, "perimeter_acceleration", "500", OTHERS, perimeter_acceleration},
    {make_block, "external_perimeter_acceleration", "400", OTHERS, external_perimeter_acceleration},
    {make_block, "infill_acceleration", "700", OTHERS, infill_acceleration},
    {make_block, "solid_infill_acceleration", "650", OTHERS, solid_infill_acceleration},
    {make_block, "top_solid_infill_acceleration", "450", OTHERS, top_solid_infill_acceleration},
    {make_table, "bridge_acceleration", "350", OTHERS, bridge_acceleration},
    {make_block, "travel_acceleration", "200", STEADY, travel_acceleration},
    {make_table, "bridge_fan_speed", "70",
     "fan_always_on = 1\nfan_below_layer_time = 0\nslowdown_below_layer_time = 0",
     bridge_fan_speed},
    {make_block, "full_fan_speed_layer", "8",
     "fan_always_on = 1\nfan_below_layer_time = 0\nslowdown_below_layer_time = 0\n"
     "min_fan_speed = 40\nbridge_fan_speed = 0",
     full_fan_speed_layer},
    {make_block, "machine_limits_usage", "emit_to_gcode",
     OTHERS "machine_max_acceleration_extruding = 700", machine_limits_usage},
    {make_block, "machine_limits_usage", "ignore", "machine_max_acceleration_extruding = 300",
     machine_limits_ignored},
    {make_block, "machine_max_feedrate_x", "20", STEADY, slower},
    {make_block, "machine_max_feedrate_y", "20", STEADY, slower},
    {make_block, "machine_max_feedrate_e", "10", STEADY, slower},
    {make_block, "machine_max_acceleration_x", "200", STEADY, slower},
    {make_block, "machine_max_acceleration_y", "200", STEADY, slower},
    {make_block, "machine_max_acceleration_z", "20", STEADY "retract_lift = 1", slower},
    {make_block, "machine_max_acceleration_e", "100", STEADY, slower},
    {make_block, "machine_max_jerk_x", "2", STEADY JERK, told_jerk},
    {make_block, "machine_max_jerk_y", "2", STEADY JERK, told_jerk},
    {make_block, "machine_max_jerk_z", "0.1", STEADY JERK "retract_lift = 1", told_jerk},
    {make_block, "machine_max_jerk_e", "0.5", STEADY JERK, told_jerk},
    {0},
};
