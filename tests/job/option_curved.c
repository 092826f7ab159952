/* Options of curved layers, of the tool that must not touch them, and of machines that turn the
 * part. What they make can't be held against planar sections of the model. */
#include "option_row.h"

#define QUICK "layer_height = 0.3\nfirst_layer_height = 0.3\nperimeters = 1\n" STEADY
#define FULL "fill_density = 100%\n"
#define SHORT "field_blend = 4\n"

static void make_tower(shape *s) {
    shape_box(s, 0, 0, 0, 16, 16, 9);
}

/* A pipe around the x axis through its middle, of four plates. */
static void make_pipe(shape *s) {
    shape_box(s, 0, -6, -6, 12, 6, -4);
    shape_box(s, 0, -6, 4, 12, 6, 6);
    shape_box(s, 0, -6, -6, 12, -4, 6);
    shape_box(s, 0, 4, -6, 12, 6, 6);
}

/* A beam beside an axis along y. */
static void make_beam(shape *s) {
    shape_box(s, 20, 0, 0, 28, 8, 9);
}

static double steepest(const print *p, double low, double high) {
    double most = 0;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind != MOVE_DRAW || m->az < low || m->az > high || move_length(m) < 0.2)
            continue;
        most = fmax(most, fabs(m->bz - m->az) / move_length(m));
    }
    return most;
}

static double highest_travel(const print *p) {
    double most = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (p->move[i].kind == MOVE_TRAVEL && p->move[i].layer == p->level_count / 2)
            most = fmax(most, p->move[i].bz);
    return most;
}

/* Is the model with these settings refused, with words of the message? */
static int is_refused(void (*make)(shape *), const char *settings, const char *words) {
    shape model = {0};
    print p;
    make(&model);
    print_shape(&p, &model, settings);
    int refused = p.status == ISO_NOT_VERIFIED && strstr(p.message, words) && !p.text;
    if (!refused)
        fprintf(stderr, "    status %d: %s\n", p.status, p.message);
    print_free(&p);
    shape_free(&model);
    return refused;
}

/* Or is it more than the machine can do? */
static void is_outside(void (*make)(shape *), const char *settings, const char *words) {
    shape model = {0};
    print p;
    make(&model);
    print_shape(&p, &model, settings);
    CHECK_EQUAL(ISO_OUTSIDE, p.status);
    if (!CHECK(strstr(p.message, words)))
        fprintf(stderr, "    %s\n", p.message);
    print_free(&p);
    shape_free(&model);
}

static void field(const change *c) {
    CHECK(steepest(c->a, 0, 20) == 0);
    CHECK_NEAR(tan(12 * SHAPE_PI / 180), steepest(c->b, 7, 20), 0.02);
    CHECK_NEAR(16 * 16 * 9, print_volume(c->b), 0.015 * 16 * 16 * 9);
}

/* Smaller than a unit: from above there is nothing of it to bend over. */
static void make_speck(shape *s) {
    shape_box(s, 0, 0, 0, 3e-5, 3e-5, 3e-5);
}

static void field_flat_base(const change *c) {
    CHECK(steepest(c->a, 0, 0.4) < 0.01);
    CHECK(steepest(c->b, 0, 0.4) > 0.15);
    is_outside(make_speck, QUICK "field = cone:12\n", "nothing that could be printed");
}

static void field_base(const change *c) {
    CHECK(steepest(c->a, 2, 4.9) > 0.05);
    CHECK(steepest(c->b, 0, 4.9) == 0);
    CHECK(steepest(c->b, 6, 20) > 0.02);
}

/* Bent over too little a height, layers would be thicker than the nozzle can make them. */
static void field_blend(const change *c) {
    is_outside(make_tower, QUICK "field = cone:18\nfield_blend = 4\n", "may not be thicker");
    CHECK(steepest(c->b, 1, 3.5) < 0.7 * steepest(c->a, 1, 3.5));
}

static void field_slope(const change *c) {
    CHECK(same_places(c->a, c->b));
    is_outside(make_tower, QUICK "field = cone:25\nfield_flat_base = 0\nfield_slope = 20\n",
               "field_slope");
}

static void field_tolerance(const change *c) {
    CHECK(c->b->move_count < 0.9 * c->a->move_count);
    CHECK_NEAR(print_volume(c->a), print_volume(c->b), 0.005 * print_volume(c->a));
}

#define STEEP QUICK "field = cone:25\nfield_flat_base = 0\nclearance_cone = 75\n"
static void check_clearance(const change *c) {
    CHECK(same_places(c->a, c->b));
    CHECK(is_refused(make_tower, STEEP, "nozzle"));
    shape model = {0};
    print p;
    make_tower(&model);
    print_shape(&p, &model, STEEP "check_clearance = 0\n");
    CHECK_EQUAL(ISO_OK, p.status);
    print_free(&p);
    shape_free(&model);
}

/* Travels keep the tip's edge off the layer as well. */
static void clearance_tip(const change *c) {
    CHECK(highest_travel(c->b) > highest_travel(c->a) + 0.05);
    CHECK(is_refused(make_tower, QUICK "field_blend = 6\nfield = cone:18\nclearance_tip = 4\n",
                     "nozzle"));
}

static void clearance_cone(const change *c) {
    CHECK(same_places(c->a, c->b));
    CHECK(is_refused(make_tower, STEEP, "nozzle"));
}

/* Walls come first, and stand higher than what is within them. */
#define LOW QUICK "field = cone:-12\nclearance_cone_height = 0.6\n"
static void clearance_cone_height(const change *c) {
    CHECK(same_places(c->a, c->b));
    CHECK(is_refused(make_tower, LOW, "heater block"));
}

static void clearance_block(const change *c) {
    CHECK(same_places(c->a, c->b));
}

#define NO_BLOCK LOW "clearance_block =\n"
static void clearance_carriage_height(const change *c) {
    CHECK(same_places(c->a, c->b));
    CHECK(is_refused(make_tower, NO_BLOCK "clearance_carriage_height = 0.7\n", "carriage"));
}

static void clearance_carriage(const change *c) {
    CHECK(same_places(c->a, c->b));
    CHECK(is_refused(make_tower, NO_BLOCK "clearance_carriage_height = 0.7\n", "carriage"));
}

static void clearance_gantry_height(const change *c) {
    CHECK(same_places(c->a, c->b));
    CHECK(is_refused(make_tower, NO_BLOCK "clearance_carriage =\nclearance_gantry_height = 0.7\n",
                     "gantry"));
}

/* ---- machines that turn the part ---- */

static int says(const print *p, const char *text) {
    return strstr(p->text, text) != NULL;
}

static void kinematics(const change *c) {
    CHECK(!says(c->a, " A") && says(c->b, " A"));
    CHECK_NEAR(12 * (12 * 12 - 8 * 8), print_volume(c->b), 0.02 * 12 * (12 * 12 - 8 * 8));
}

/* How far the nozzle goes up and down within a layer. */
static double swing(const print *p, int32_t layer) {
    double low = 1e9, high = -1e9;
    for (int32_t i = 0; i < p->move_count; i++)
        if (p->move[i].kind == MOVE_DRAW && p->move[i].layer == layer) {
            low = fmin(low, p->move[i].bz);
            high = fmax(high, p->move[i].bz);
        }
    return high - low;
}

/* The axis is the pipe's at first, then 14 mm above it. */
static void kinematics_pivot(const change *c) {
    CHECK_NEAR(0, swing(c->a, 5), 0.05);
    CHECK_NEAR(28, swing(c->b, 5), 0.1);
}

#define FAN QUICK "field = fan:y,-24,0,24\ncheck_clearance = 0\n"
static void tilt_limits(const change *c) {
    CHECK(same_places(c->a, c->b));
    is_outside(make_beam, FAN "kinematics = table_bc\ntilt_limits = -5,5\n", "B");
}

static void turn_limits(const change *c) {
    CHECK(same_places(c->a, c->b));
    is_outside(make_beam, FAN "kinematics = table_ac\nturn_limits = -5,5\n", "C");
}

static void slower(const change *c) {
    CHECK(same_filament(c->a, c->b));
    CHECK(c->b->report.print.time > 1.5 * c->a->report.print.time);
}

static void rotary_feed(const change *c) {
    CHECK(same_filament(c->a, c->b));
    CHECK(!says(c->a, "G93") && says(c->b, "G93"));
}

#define ROUND QUICK FULL "field = cylinder:x,0,6\ncheck_clearance = 0\n"
#define MANDREL ROUND "kinematics = rotary_a\n"

const option_row option_rows_curved[] = {
    {make_tower, "field", "cone:12", QUICK FULL SHORT, field},
    {make_tower, "field_flat_base", "0", QUICK "field = cone:12\n", field_flat_base},
    {make_tower, "field_base", "5", QUICK SHORT "field = cone:8\n", field_base},
    {make_tower, "field_blend", "8", QUICK SHORT "field = cone:8\n", field_blend},
    {make_tower, "field_slope", "60", QUICK SHORT "field = cone:8\n", field_slope},
    {make_tower, "field_tolerance", "0.2", QUICK SHORT "field = cone:12\n", field_tolerance},
    {make_tower, "check_clearance", "0", QUICK SHORT "field = cone:8\n", check_clearance},
    {make_tower, "clearance_tip", "2", QUICK SHORT "field = cone:8\n", clearance_tip},
    {make_tower, "clearance_cone", "60", QUICK SHORT "field = cone:4\n", clearance_cone},
    {make_tower, "clearance_cone_height", "4", QUICK SHORT "field = cone:4\n",
     clearance_cone_height},
    {make_tower, "clearance_block", "", QUICK SHORT "field = cone:4\n", clearance_block},
    {make_tower, "clearance_carriage_height", "15", QUICK SHORT "field = cone:4\n",
     clearance_carriage_height},
    {make_tower, "clearance_carriage", "-1,-1,1,1", QUICK SHORT "field = cone:4\n",
     clearance_carriage},
    {make_tower, "clearance_gantry_height", "30", QUICK SHORT "field = cone:4\n",
     clearance_gantry_height},
    {make_pipe, "kinematics", "rotary_a", ROUND "field_flat_base = 0\n", kinematics},
    {make_pipe, "kinematics_pivot", "100,100,20", MANDREL, kinematics_pivot},
    {make_beam, "tilt_limits", "-60,60", FAN "kinematics = table_bc\n", tilt_limits},
    {make_beam, "turn_limits", "-400,400", FAN "kinematics = table_ac\n", turn_limits},
    {make_beam, "tilt_speed", "0.02", FAN "kinematics = table_bc\n", slower},
    {make_pipe, "turn_speed", "2", MANDREL, slower},
    {make_pipe, "rotary_feed", "inverse_time", MANDREL, rotary_feed},
    {0},
};
