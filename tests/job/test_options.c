/* Every option does to the G-code what its help says. One row an option: an option of the table
 * without a row fails the test. */
#include "option_paths.h"
#include "solids.h"

typedef struct row {
    int model;
    const char *key, *value;
    const char *base; /* settings of both */
    void (*check)(const change *c);
} row;

enum { BLOCK, SMALL, PART };

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

static double highest_fan(const print *p, int32_t from, int32_t to) {
    double fan = 0;
    for (int32_t i = p->level[from].first; i < p->level[to].first; i++)
        fan = p->move[i].kind == MOVE_DRAW ? fmax(fan, p->move[i].fan) : fan;
    return fan;
}

static double lowest_feed(const print *p) {
    double feed = 1e9;
    for (int32_t i = 0; i < p->move_count; i++)
        feed = move_chosen(&p->move[i], -1, -1) ? fmin(feed, p->move[i].f) : feed;
    return feed / 60;
}

/* s that a layer takes at the speeds given */
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
        CHECK(layer_time(c->a, i) < 19 && layer_time(c->b, i) > 19.5 && layer_time(c->b, i) < 23);
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

static void nozzle_diameter(const change *c) {
    check_width(c->b, ISO_ROLE_PERIMETER, 0, 0.6 * 1.125);
    check_width(c->b, SPARSE, 0, 0.6 * 1.125);
    check_fitted(c->b, ISO_ROLE_TOP_SOLID_INFILL, 0.6);
}

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

#define STEADY "cooling = 0\n"

static const row rows[] = {
    {BLOCK, "layer_height", "0.2", "", layer_height},
    {BLOCK, "first_layer_height", "50%", "", first_layer_height},
    {BLOCK, "layer_heights", "0.3,0.2,0.1", "", layer_heights},
    {PART, "gcode_resolution", "0.1", "", gcode_resolution},
    {BLOCK, "z_offset", "0.25", "", z_offset},
    {BLOCK, "perimeters", "5", "", perimeters},
    {BLOCK, "external_perimeters_first", "1", "", external_perimeters_first},
    {BLOCK, "fill_density", "40%", "perimeters = 1", fill_density},
    {BLOCK, "fill_pattern", "grid", "perimeters = 1\nfill_density = 30%", fill_pattern},
    {BLOCK, "fill_angle", "20", "perimeters = 1\nfill_density = 30%", fill_angle},
    {BLOCK, "infill_overlap", "0.3", "fill_angle = 0\nbottom_solid_layers = 4", infill_overlap},
    {BLOCK, "top_solid_layers", "2", "", top_solid_layers},
    {BLOCK, "bottom_solid_layers", "1", "", bottom_solid_layers},
    {BLOCK, "skirts", "4", "", skirts},
    {BLOCK, "skirt_distance", "2.5", "", skirt_distance},
    {BLOCK, "perimeter_speed", "44", STEADY, perimeter_speed},
    {BLOCK, "external_perimeter_speed", "25", STEADY, external_perimeter_speed},
    {SMALL, "small_perimeter_speed", "40%", STEADY, small_perimeter_speed},
    {BLOCK, "infill_speed", "70", STEADY, infill_speed},
    {BLOCK, "solid_infill_speed", "50%", STEADY "top_solid_infill_speed = 15\n",
     solid_infill_speed},
    {BLOCK, "top_solid_infill_speed", "60%", STEADY, top_solid_infill_speed},
    {BLOCK, "gap_fill_speed", "33", STEADY, no_path_of_it},
    {BLOCK, "bridge_speed", "33", STEADY, no_path_of_it},
    {BLOCK, "first_layer_speed", "22", STEADY, first_layer_speed},
    {BLOCK, "first_layer_speed", "50%", STEADY, first_layer_speed_in_percent},
    {BLOCK, "travel_speed", "99", STEADY, travel_speed},
    {BLOCK, "travel_speed_z", "9", STEADY, travel_speed_z},
    {BLOCK, "extrusion_width", "180%", "", extrusion_width},
    {BLOCK, "first_layer_extrusion_width", "0.5", "", first_layer_extrusion_width},
    {BLOCK, "perimeter_extrusion_width", "200%", "", perimeter_extrusion_width},
    {BLOCK, "external_perimeter_extrusion_width", "0.4", "", external_perimeter_extrusion_width},
    {BLOCK, "infill_extrusion_width", "0.6", "", infill_extrusion_width},
    {BLOCK, "solid_infill_extrusion_width", "0.6", "", solid_infill_extrusion_width},
    {BLOCK, "top_infill_extrusion_width", "0.6", "", top_infill_extrusion_width},
    {BLOCK, "filament_diameter", "2.85", "", filament_diameter},
    {BLOCK, "filament_density", "1.24", "", filament_density},
    {BLOCK, "extrusion_multiplier", "1.07", "", extrusion_multiplier},
    {BLOCK, "temperature", "222", "", temperature},
    {BLOCK, "first_layer_temperature", "215", "", first_layer_temperature},
    {BLOCK, "bed_temperature", "55", "first_layer_bed_temperature = 60", bed_temperature},
    {BLOCK, "first_layer_bed_temperature", "65", "", first_layer_bed_temperature},
    {PART, "retract_length", "0.8", "", retract_length},
    {PART, "retract_speed", "35", "", retract_speed},
    {PART, "deretract_speed", "22", "", deretract_speed},
    {PART, "retract_restart_extra", "-0.1", "", retract_restart_extra},
    {PART, "retract_before_travel", "5", "", retract_before_travel},
    {PART, "retract_lift", "0.6", "", retract_lift},
    {SMALL, "cooling", "0", "slowdown_below_layer_time = 20", cooling},
    {SMALL, "slowdown_below_layer_time", "20", "min_print_speed = 0.5", slowdown_below_layer_time},
    {SMALL, "min_print_speed", "4", "slowdown_below_layer_time = 200", min_print_speed},
    {BLOCK, "fan_always_on", "1", "fan_below_layer_time = 0", fan_always_on},
    {BLOCK, "fan_below_layer_time", "2", "slowdown_below_layer_time = 1", fan_below_layer_time},
    {BLOCK, "min_fan_speed", "50", "fan_always_on = 1\nfan_below_layer_time = 0", min_fan_speed},
    {BLOCK, "max_fan_speed", "80", "slowdown_below_layer_time = 1000", max_fan_speed},
    {BLOCK, "disable_fan_first_layers", "6", "", disable_fan_first_layers},
    {BLOCK, "nozzle_diameter", "0.6", "first_layer_extrusion_width = 0", nozzle_diameter},
    {BLOCK, "bed_shape", "-50x0,50x0,50x100,-50x100", "", bed_shape},
    {BLOCK, "max_print_height", "50", "", max_print_height},
    {BLOCK, "center", "40,140", "", center},
    {BLOCK, "gcode_flavor", "marlin", "", gcode_flavor},
    {BLOCK, "use_relative_e_distances", "0", "", use_relative_e_distances},
    {BLOCK, "machine_max_acceleration_extruding", "200", "", longer},
    {BLOCK, "machine_max_acceleration_travel", "100", "", longer},
    {BLOCK, "machine_max_acceleration_retracting", "100", "", longer},
    {BLOCK, "machine_max_feedrate_z", "1", "retract_lift = 1", longer},
    {BLOCK, "machine_max_junction_deviation", "0.5", "", shorter},
    {BLOCK, "start_gcode", "G28\\n; first [first_layer_height], {perimeters} walls", "",
     start_gcode},
    {BLOCK, "end_gcode", "; done at [temperature]\\nM104 S0\\nM107", "", end_gcode},
    {BLOCK, "layer_gcode", "; layer [layer_num] at {layer_z}, [perimeters] walls", "", layer_gcode},
    {BLOCK, "remaining_times", "0", "", remaining_times},
};

enum { ROWS = sizeof rows / sizeof *rows };

/* What it stands on: a bundle of settings for both, then the option itself. */
static void print_row(print *a, print *b, const row *r, const shape *s) {
    char settings[1024];
    size_t length = strlen(r->base);
    print_shape(a, s, r->base);
    snprintf(settings, sizeof settings, "%s%s%s = %s", r->base,
             length == 0 || r->base[length - 1] == '\n' ? "" : "\n", r->key, r->value);
    print_shape(b, s, settings);
    /* The user may ask for less filament than was drawn back: the printer warns, and is right. */
    if (b->options.retract_restart_extra < 0 && CHECK(b->machine.warning_count > 0))
        b->machine.warning_count = 0;
}

static void check_row(const row *r, const shape *s) {
    char line[1024], value[512];
    print a, b;
    int before = check_failures;
    print_row(&a, &b, r, s);
    print_check(&a, s);
    print_check(&b, s);
    if (a.status == ISO_OK && b.status == ISO_OK) {
        iso_options_format(value, sizeof value, &b.options, iso_option_find(r->key));
        snprintf(line, sizeof line, "\n; %s = %s\n", r->key, value);
        CHECK(strstr(b.text, line) && !strstr(a.text, line));
        r->check(&(change){&a, &b});
    }
    if (check_failures > before)
        fprintf(stderr, "    that was %s = %s\n", r->key, r->value);
    print_free(&a);
    print_free(&b);
}

/* A block beside a round tower: curved walls, travels of all lengths. */
static void make_part(shape *s) {
    const solid_ring ring[] = {{1, 0}, {1, 3}};
    solid_star(s, 5, 7, 0.15, 0, ring, 2, 96);
    shape_move(s, 0, s->count, 22, 6, 0);
    shape_box(s, 0, 0, 0, 12, 12, 3);
}

static void test_each_option(void) {
    shape model[3] = {0};
    shape_box(&model[BLOCK], 0, 0, 0, 16, 16, 3);
    shape_box(&model[SMALL], 0, 0, 0, 9, 9, 3);
    make_part(&model[PART]);
    for (int32_t o = 0; o < iso_option_count(); o++) {
        const char *key = iso_option_at(o)->key;
        int found = 0;
        for (int i = 0; i < ROWS; i++)
            if (strcmp(rows[i].key, key) == 0) {
                check_row(&rows[i], &model[rows[i].model]);
                found++;
            }
        if (!CHECK(found > 0))
            fprintf(stderr, "    %s has no row\n", key);
    }
    for (int i = 0; i < 3; i++)
        shape_free(&model[i]);
}

int main(void) {
    RUN(test_each_option);
    CHECK(print_folder_remove());
    return check_verdict();
}
