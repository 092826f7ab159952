/* What the options of filament, temperatures, retraction, cooling, printer and G-code do. */
#include "option_row.h"

/* ---- filament ---- */

static void check_ratio(const change *c, double ratio) {
    double a = print_filament(c->a, -1, -1), b = print_filament(c->b, -1, -1);
    same_places(c->a, c->b);
    CHECK_NEAR(ratio * a, b, 1e-5 * b);
}

static void filament_diameter(const change *c) {
    check_ratio(c, 1.75 * 1.75 / (2.85 * 2.85));
}

static void extrusion_multiplier(const change *c) {
    check_ratio(c, 1.07);
}

static void filament_density(const change *c) {
    double cm3 = print_footer(c->b, "; filament used [cm3] = ");
    CHECK_NEAR(0, print_footer(c->a, "; filament used [g] = "), 0);
    CHECK_NEAR(1.24 * cm3, print_footer(c->b, "; filament used [g] = "), 0.012);
    CHECK_NEAR(1.24 * c->b->report.print.filament_cm3, c->b->report.print.filament_g, 1e-9);
}

/* ---- temperatures ---- */

/* Where a line begins with the text: the layer, -1 before the first one, -2 nowhere. */
static int32_t layer_of_line(const print *p, const char *text) {
    char line[64];
    int32_t layer = -1;
    snprintf(line, sizeof line, "\n%s\n", text);
    const char *at = strstr(p->text, line);
    if (!at)
        return -2;
    for (const char *c = p->text; (c = strstr(c, ";LAYER_CHANGE")) && c < at; c++)
        layer++;
    return layer;
}

static void temperature(const change *c) {
    CHECK_EQUAL(1, layer_of_line(c->b, "M104 S222"));
    CHECK_EQUAL(-1, layer_of_line(c->b, "M109 S200"));
    CHECK_NEAR(222, c->b->machine.highest_nozzle, 1);
    CHECK_NEAR(200, c->a->machine.highest_nozzle, 1);
}

static void first_layer_temperature(const change *c) {
    CHECK_EQUAL(-1, layer_of_line(c->b, "M109 S215"));
    CHECK_EQUAL(1, layer_of_line(c->b, "M104 S200"));
    CHECK_NEAR(215, c->b->machine.highest_nozzle, 1);
}

static void bed_temperature(const change *c) {
    CHECK_EQUAL(1, layer_of_line(c->b, "M140 S55"));
    CHECK_EQUAL(-1, layer_of_line(c->b, "M190 S60"));
}

static void first_layer_bed_temperature(const change *c) {
    CHECK_EQUAL(-2, layer_of_line(c->a, "M190 S65"));
    CHECK_EQUAL(-1, layer_of_line(c->b, "M190 S65"));
    CHECK_NEAR(65, c->b->machine.highest_bed, 1);
}

/* ---- retraction ---- */

typedef struct pulls {
    int32_t count;
    double least, most, back_speed, forth_speed, forth;
} pulls;

static pulls pulls_of(const print *p) {
    pulls sum = {.least = 1e9};
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind != MOVE_FILAMENT || m->e == 0)
            continue;
        if (m->e < 0) {
            sum.count++;
            sum.least = fmin(sum.least, -m->e);
            sum.most = fmax(sum.most, -m->e);
            sum.back_speed = m->f / 60;
        } else {
            sum.forth = m->e;
            sum.forth_speed = m->f / 60;
        }
    }
    return sum;
}

static void retract_length(const change *c) {
    pulls a = pulls_of(c->a), b = pulls_of(c->b);
    CHECK_NEAR(2, a.least, 1.1e-5);
    CHECK_NEAR(2, a.most, 1.1e-5);
    CHECK_NEAR(0.8, b.least, 1.1e-5);
    CHECK_NEAR(0.8, b.most, 1.1e-5);
    CHECK_EQUAL(a.count, b.count);
    CHECK_NEAR(print_filament(c->a, -1, -1), print_filament(c->b, -1, -1), 1e-4);
}

static void retract_speed(const change *c) {
    same_places(c->a, c->b);
    CHECK_NEAR(40, pulls_of(c->a).back_speed, 0);
    CHECK_NEAR(35, pulls_of(c->b).back_speed, 0);
    CHECK_NEAR(35, pulls_of(c->b).forth_speed, 0);
}

static void deretract_speed(const change *c) {
    same_places(c->a, c->b);
    CHECK_NEAR(40, pulls_of(c->b).back_speed, 0);
    CHECK_NEAR(22, pulls_of(c->b).forth_speed, 0);
}

static void retract_restart_extra(const change *c) {
    same_places(c->a, c->b);
    CHECK_NEAR(2, pulls_of(c->a).forth, 1.1e-5);
    CHECK_NEAR(1.9, pulls_of(c->b).forth, 1.1e-5);
}

/* Each travel longer than the option is made with the filament drawn back, each shorter one
 * without; the first one of all is. */
static void check_retracted_travel(const print *p, double limit) {
    int32_t wrong = 0, first = 1, back = 0, some[2] = {0};
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind == MOVE_FILAMENT && m->e != 0)
            back = m->e < 0;
        if (m->kind != MOVE_TRAVEL || m->layer < 0)
            continue;
        wrong += !first && back != (move_length(m) > limit);
        some[back] += !first;
        first = 0;
    }
    CHECK_EQUAL(0, wrong);
    CHECK(some[0] > 0 || limit == 0);
    CHECK(some[1] > 0 || limit > 50);
}

static void retract_before_travel(const change *c) {
    check_retracted_travel(c->a, 2);
    check_retracted_travel(c->b, 5);
    CHECK(pulls_of(c->b).count < pulls_of(c->a).count);
}

static void retract_lift(const change *c) {
    int32_t wrong = 0, lifted = 0, back = 0;
    for (int32_t i = 0; i < c->b->move_count; i++) {
        const print_move *m = &c->b->move[i];
        if (m->kind == MOVE_FILAMENT && m->e != 0)
            back = m->e < 0;
        if (m->kind != MOVE_TRAVEL || m->layer < 0)
            continue;
        lifted += back;
        wrong += fabs(m->bz - c->b->level[m->layer].z - (back ? 0.6 : 0)) > 0.00051;
    }
    CHECK(lifted > 0);
    CHECK_EQUAL(0, wrong);
    CHECK_NEAR(print_length(c->a, -1, -1), print_length(c->b, -1, -1), 1e-9);
}

/* ---- cooling ---- */

/* Bridges, which have a fan speed of their own, left out. */
static double highest_fan(const print *p, int32_t from, int32_t to) {
    double fan = 0;
    for (int32_t i = p->level[from].first; i < p->level[to].first; i++) {
        const print_move *m = &p->move[i];
        if (m->kind == MOVE_DRAW && m->role != ISO_ROLE_BRIDGE_INFILL &&
            m->role != ISO_ROLE_OVERHANG_PERIMETER)
            fan = fmax(fan, m->fan);
    }
    return fan;
}

static double lowest_feed(const print *p) {
    double feed = 1e9;
    for (int32_t i = 0; i < p->move_count; i++)
        feed = move_chosen(&p->move[i], -1, -1) ? fmin(feed, p->move[i].f) : feed;
    return feed / 60;
}

/* s that a layer takes at the speeds given; ramps, which count too, would add some tenths */
static double layer_time(const print *p, int32_t layer) {
    double time = 0;
    for (int32_t i = p->level[layer].first; i < p->level[layer + 1].first; i++) {
        const print_move *m = &p->move[i];
        double length = m->kind == MOVE_FILAMENT ? fabs(m->e) : move_length(m);
        time += m->f > 0 ? length * 60 / m->f : 0;
    }
    return time;
}

static void cooling(const change *c) {
    same_places(c->a, c->b);
    CHECK(highest_fan(c->a, 3, c->a->level_count) > 50);
    CHECK_NEAR(0, highest_fan(c->b, 0, c->b->level_count), 0);
    CHECK(lowest_feed(c->b) > lowest_feed(c->a));
    CHECK_NEAR(15, lowest_feed(c->b), 1e-9);
}

static void slowdown_below_layer_time(const change *c) {
    same_places(c->a, c->b);
    for (int32_t i = 1; i < c->b->level_count; i++)
        CHECK(layer_time(c->a, i) < 19 && layer_time(c->b, i) > 19 && layer_time(c->b, i) < 23);
}

static void min_print_speed(const change *c) {
    same_places(c->a, c->b);
    CHECK_NEAR(10, lowest_feed(c->a), 0.01);
    CHECK_NEAR(4, lowest_feed(c->b), 0.01);
}

static void fan_always_on(const change *c) {
    same_places(c->a, c->b);
    CHECK_NEAR(0, highest_fan(c->a, 0, c->a->level_count), 0);
    CHECK_NEAR(35, highest_fan(c->b, 3, c->b->level_count), 0.3);
}

static void fan_below_layer_time(const change *c) {
    same_places(c->a, c->b);
    CHECK(highest_fan(c->a, 3, c->a->level_count) > 35);
    CHECK_NEAR(0, highest_fan(c->b, 3, c->b->level_count), 0);
}

static void min_fan_speed(const change *c) {
    same_places(c->a, c->b);
    CHECK_NEAR(35, highest_fan(c->a, 3, c->a->level_count), 0.3);
    CHECK_NEAR(50, highest_fan(c->b, 3, c->b->level_count), 0.3);
}

static void max_fan_speed(const change *c) {
    same_places(c->a, c->b);
    CHECK_NEAR(100, highest_fan(c->a, 3, c->a->level_count), 0.3);
    CHECK_NEAR(80, highest_fan(c->b, 3, c->b->level_count), 0.3);
}

static void disable_fan_first_layers(const change *c) {
    same_places(c->a, c->b);
    CHECK_NEAR(0, highest_fan(c->a, 0, 3), 0);
    CHECK(highest_fan(c->a, 3, 4) > 0);
    CHECK_NEAR(0, highest_fan(c->b, 0, 6), 0);
    CHECK(highest_fan(c->b, 6, 7) > 0);
}

/* ---- printer ---- */

static void check_moved(const change *c, double x, double y) {
    double a[4], b[4];
    CHECK(print_box(a, c->a, -1, -1) && print_box(b, c->b, -1, -1));
    for (int k = 0; k < 4; k++)
        CHECK_NEAR(a[k] + (k % 2 ? y : x), b[k], 1e-6);
}

static void bed_shape(const change *c) {
    check_moved(c, -100, -50); /* -50 .. 50, 0 .. 100 */
}

static void center(const change *c) {
    check_moved(c, -60, 40);
}

static void max_print_height(const change *c) {
    same_places(c->a, c->b); /* the failures have their own test */
    CHECK_EQUAL(ISO_OK, c->b->status);
}

/* So far the two are the same but for their name. */
static void gcode_flavor(const change *c) {
    same_places(c->a, c->b);
    same_filament(c->a, c->b);
}

static void use_relative_e_distances(const change *c) {
    CHECK(strstr(c->a->text, "\nM83") && !strstr(c->a->text, "\nM82"));
    CHECK(strstr(c->b->text, "\nM82") && !strstr(c->b->text, "\nM83"));
    CHECK(c->a->relative && !c->b->relative);
    same_places(c->a, c->b);
    same_filament(c->a, c->b);
    CHECK_NEAR(c->a->machine.filament, c->b->machine.filament, 1e-3);
}

/* Moves as before, only the estimate is another. */
static void check_estimate(const change *c, int sign) {
    same_places(c->a, c->b);
    same_filament(c->a, c->b);
    CHECK((c->b->report.print.time - c->a->report.print.time) * sign > 0.05);
}

static void longer(const change *c) {
    check_estimate(c, 1);
}

static void shorter(const change *c) {
    check_estimate(c, -1);
}

/* ---- texts ---- */

static void start_gcode(const change *c) {
    const char *text = strstr(c->b->text, "\nG28\n; first 0.35, 3 walls\n");
    CHECK(text && text < strstr(c->b->text, ";LAYER_CHANGE"));
    CHECK(!strstr(c->b->text, "G1 Z5 F1200"));
    CHECK(strstr(c->a->text, "\nG1 Z5 F1200") != NULL);
}

static void end_gcode(const change *c) {
    const char *text = strstr(c->b->text, "\n; done at 200\nM104 S0\nM107\n"), *last = NULL;
    for (const char *l = c->b->text; (l = strstr(l, ";LAYER_CHANGE")); l++)
        last = l;
    CHECK(text && text > last);
    CHECK(strstr(c->a->text, "\nM84") && !strstr(c->b->text, "\nM84"));
}

static void layer_gcode(const change *c) {
    CHECK_NEAR(c->a->report.print.bead_mm, c->b->report.print.bead_mm, 1e-9);
    CHECK_NEAR(c->a->report.print.filament_mm, c->b->report.print.filament_mm, 1e-9);
    CHECK(!strstr(c->a->text, "\n; layer "));
    CHECK(strstr(c->b->text, "\nG1 Z.35 F7800\n; layer 0 at 0.35, 3 walls\n"));
    CHECK(strstr(c->b->text, "\nG1 Z.65 F7800\n; layer 1 at 0.65, 3 walls\n"));
}

static void remaining_times(const change *c) {
    CHECK(strstr(c->a->text, "\nM73 P0") && strstr(c->a->text, "\nM73 P100 R0 "));
    CHECK(!strstr(c->b->text, "\nM73"));
    CHECK_EQUAL(100, c->a->state.progress_percent);
    CHECK_EQUAL(-1, c->b->state.progress_percent);
    same_places(c->a, c->b);
}

/* ---- the rows ---- */

const option_row option_rows_machine[] = {
    {make_block, "filament_diameter", "2.85", "", filament_diameter},
    {make_block, "filament_density", "1.24", "", filament_density},
    {make_block, "extrusion_multiplier", "1.07", "", extrusion_multiplier},
    {make_block, "temperature", "222", "", temperature},
    {make_block, "first_layer_temperature", "215", "", first_layer_temperature},
    {make_block, "bed_temperature", "55", "first_layer_bed_temperature = 60", bed_temperature},
    {make_block, "first_layer_bed_temperature", "65", "", first_layer_bed_temperature},
    {make_part, "retract_length", "0.8", "", retract_length},
    {make_part, "retract_speed", "35", "", retract_speed},
    {make_part, "deretract_speed", "22", "", deretract_speed},
    {make_part, "retract_restart_extra", "-0.1", "", retract_restart_extra},
    {make_part, "retract_before_travel", "5", "only_retract_when_crossing_perimeters = 0",
     retract_before_travel},
    {make_part, "retract_lift", "0.6", "", retract_lift},
    {make_small, "cooling", "0", "slowdown_below_layer_time = 20", cooling},
    {make_small, "slowdown_below_layer_time", "20", "min_print_speed = 0.5",
     slowdown_below_layer_time},
    {make_small, "min_print_speed", "4", "slowdown_below_layer_time = 200", min_print_speed},
    {make_block, "fan_always_on", "1", "fan_below_layer_time = 0", fan_always_on},
    {make_block, "fan_below_layer_time", "2", "slowdown_below_layer_time = 1",
     fan_below_layer_time},
    {make_block, "min_fan_speed", "50", "fan_always_on = 1\nfan_below_layer_time = 0",
     min_fan_speed},
    {make_block, "max_fan_speed", "80", "slowdown_below_layer_time = 1000", max_fan_speed},
    {make_block, "disable_fan_first_layers", "6", "", disable_fan_first_layers},
    {make_block, "bed_shape", "-50x0,50x0,50x100,-50x100", "", bed_shape},
    {make_block, "max_print_height", "50", "", max_print_height},
    {make_block, "center", "40,140", "", center},
    {make_block, "gcode_flavor", "marlin", "", gcode_flavor},
    {make_block, "use_relative_e_distances", "0", "", use_relative_e_distances},
    {make_block, "machine_max_acceleration_extruding", "200", "", longer},
    {make_block, "machine_max_acceleration_travel", "100", "", longer},
    {make_block, "machine_max_acceleration_retracting", "100", "", longer},
    {make_block, "machine_max_feedrate_z", "1", "retract_lift = 1", longer},
    {make_block, "machine_max_junction_deviation", "0.5", "", shorter},
    {make_block, "start_gcode", "G28\\n; first [first_layer_height], {perimeters} walls", "",
     start_gcode},
    {make_block, "end_gcode", "; done at [temperature]\\nM104 S0\\nM107", "", end_gcode},
    {make_block, "layer_gcode", "; layer [layer_num] at {layer_z}, [perimeters] walls", "",
     layer_gcode},
    {make_block, "remaining_times", "0", "", remaining_times},
    {0},
};
