#include "gcode/head.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "gcode/head_parts.h"
#include "gcode/number.h"
#include "gcode/space.h"

static const double pi = 3.14159265358979323846;

/* A wipe is this much slower than travel. */
#define WIPE_PACE 0.8

enum { E_DECIMALS = 100000, UNKNOWN = ISO_HEAD_UNKNOWN };

int32_t iso_head_feed(double speed) {
    double feed = speed * 60 + 0.5;
    return feed < 1 ? 1 : (int32_t)feed;
}

static int64_t to_e(double mm) {
    return (int64_t)(mm * E_DECIMALS + (mm < 0 ? -0.5 : 0.5));
}

/* Where one acceleration holds for all moves, travel goes back to the usual one. */
static int32_t travel_acceleration(const iso_head *head) {
    const iso_gcode_options *o = head->options;
    int apart = head->modes.words->travel_acceleration != NULL;
    double wanted = apart || o->default_acceleration > 0 ? o->travel_acceleration : 0;
    double limit = o->emit_machine_limits ? o->limits.travel : 0;
    if (!(wanted > 0) && !apart)
        wanted = o->default_acceleration;
    return (int32_t)((limit > 0 && wanted > limit ? limit : wanted) + 0.5);
}

/* Where the part turns the estimate follows the tip over the part, and what the axes can do is seen
 * to move by move. */
static void start_planner(iso_head *head, const iso_machine_limits *limits) {
    iso_machine_limits own = *limits;
    for (int i = 0; i < 3 && head->machine; i++) {
        own.feedrate[i] = own.acceleration[i] = INFINITY;
        own.jerk[i] = limits->jerk[0] < limits->jerk[1] ? limits->jerk[0] : limits->jerk[1];
    }
    iso_planner_start(&head->planner, &own);
}

void iso_head_start(iso_head *head, iso_lines *lines, const iso_gcode_options *options) {
    const iso_gcode_options *o = options;
    double section = pi / 4 * o->filament_diameter * o->filament_diameter;
    double e_section = o->use_volumetric_e ? 1 : section;
    double unit = 1.0 / ISO_UNITS_PER_MM;
    double z_speed = o->travel_speed_z > 0 ? o->travel_speed_z : o->travel_speed;
    double deretract_speed = o->deretract_speed > 0 ? o->deretract_speed : o->retract_speed;
    memset(head, 0, offsetof(iso_head, planner));
    head->machine = pose_turns(o->machine) ? o->machine : NULL;
    start_planner(head, &o->limits);
    iso_modes_start(&head->modes, lines, o);
    head->lines = lines;
    head->options = o;
    head->relative_e = o->use_relative_e_distances && head->modes.words->relative_e;
    head->e_unit = e_section / section;
    head->e_scale = o->extrusion_multiplier * unit * unit * unit / e_section * E_DECIMALS *
                    (double)((int64_t)1 << E_FRACTION);
    head->travel_feed = iso_head_feed(o->travel_speed);
    head->travel_feed_z = iso_head_feed(z_speed);
    head->retract_feed = iso_head_feed(o->retract_speed);
    head->deretract_feed = iso_head_feed(deretract_speed);
    head->retract_e = to_e(o->retract_length / head->e_unit);
    head->deretract_e = to_e((o->retract_length + o->retract_restart_extra) / head->e_unit);
    head->travel_acceleration = travel_acceleration(head);
    head->above = UNKNOWN;
    head->lift = iso_units(o->retract_lift);
    if (o->wipe && !o->use_firmware_retraction && o->retract_speed > 0)
        head->wipe_length = (1 - o->retract_before_wipe) * o->retract_length / o->retract_speed *
                            WIPE_PACE * o->travel_speed * ISO_UNITS_PER_MM;
    head->role = head->width = UNKNOWN;
    head->z_offset = iso_units(o->z_offset);
    head->highest = UNKNOWN;
    head->reach = -1;
    head->normal = (iso_vec3){0, 0, 1};
    iso_head_forget_place(head);
}

void iso_head_begin_layer(iso_head *head, int32_t z, int32_t height, int space) {
    if (head->space && !space)
        head->above = iso_space_height_above_all(head);
    head->space = space;
    if (!space)
        head->normal = (iso_vec3){0, 0, 1};
    if (!space && (head->highest == UNKNOWN || z > head->highest))
        head->highest = z;
    if (head->modes.words->reset_e)
        head->e = 0;
    head->layer_z = z;
    head->role = head->width = head->area = UNKNOWN;
    head->height = head->layer_height = height;
}

void iso_head_forget_place(iso_head *head) {
    head->x = head->y = head->z = head->feed = UNKNOWN;
    head->angle[0] = head->angle[1] = INT64_MIN;
    head->fine_feed = 0;
}

double iso_head_retraction_time(const iso_head *head) {
    double back = (double)head->retract_e / E_DECIMALS / head->retract_feed;
    double forth = (double)head->deretract_e / E_DECIMALS / head->deretract_feed;
    return 60 * head->e_unit * (back + forth);
}

double iso_head_filament(const iso_head *head) {
    return (double)head->emitted / E_DECIMALS * head->e_unit;
}

void head_tell(iso_head *head, const iso_gcode_move *move) {
    if (head->watched == ISO_OK)
        head->watched = head->options->watch(head->options->watch_payload, move);
}

/* Of a move on a flat layer, from where the head is. */
static void tell_flat(iso_head *head, int32_t x, int32_t y, int32_t z, int32_t width,
                      int32_t height) {
    double offset = head->options->z_offset;
    if (head->x == UNKNOWN || head->z == UNKNOWN)
        return;
    iso_gcode_move move = {
        .from = {head->x / 1000.0, head->y / 1000.0, to_micrometres(head->z) / 1000.0 - offset},
        .to = {x / 1000.0, y / 1000.0, to_micrometres(z) / 1000.0 - offset},
        .from_normal = {0, 0, 1},
        .to_normal = {0, 0, 1},
        .width = iso_mm(width),
        .height = iso_mm(height)};
    head_tell(head, &move);
}

static inline void tell(iso_head *head, int32_t x, int32_t y, int32_t z, int32_t width,
                        int32_t height) {
    if (head->options->watch)
        tell_flat(head, x, y, z, width, height);
}

/* What is told holds, but no more than the machine's own. */
static double acceleration_of(int32_t told, double limit) {
    return told > 0 && told < limit ? told : limit;
}

void head_plan(iso_head *head, const double delta[3], double length, double speed, int extrudes,
               double most) {
    const iso_machine_limits *limits = &head->options->limits;
    const iso_modes *modes = &head->modes;
    iso_planner_move move = {.dx = delta[0],
                             .dy = delta[1],
                             .dz = delta[2],
                             .length = length,
                             .speed = speed,
                             .extrudes = extrudes};
    move.acceleration = extrudes ? acceleration_of(modes->acceleration, limits->extruding)
                                 : acceleration_of(modes->travel_acceleration, limits->travel);
    if (move.acceleration > most)
        move.acceleration = most;
    iso_planner_add(&head->planner, &move);
    head->moves++;
}

static void plan(iso_head *head, double dx, double dy, double dz, int extrudes) {
    const iso_machine_limits *limits = &head->options->limits;
    const iso_modes *modes = &head->modes;
    iso_planner_move move = {.dx = dx, .dy = dy, .dz = dz, .extrudes = extrudes};
    move.length = sqrt(dx * dx + dy * dy + dz * dz);
    move.speed = head->speed;
    move.acceleration = extrudes ? acceleration_of(modes->acceleration, limits->extruding)
                                 : acceleration_of(modes->travel_acceleration, limits->travel);
    iso_planner_add(&head->planner, &move);
    head->moves++;
    *(extrudes ? &head->bead_mm : &head->travel_mm) += move.length;
}

static void plan_filament(iso_head *head, int64_t e) {
    iso_planner_move move = {.length = (double)(e < 0 ? -e : e) / E_DECIMALS * head->e_unit,
                             .speed = head->speed,
                             .acceleration = head->options->limits.retracting};
    iso_planner_add(&head->planner, &move);
    head->moves++;
}

void iso_head_end_inverse_time(iso_head *head) {
    if (!head->inverse)
        return;
    head->inverse = 0;
    head->feed = UNKNOWN;
    iso_modes_say(&head->modes, "G94", 0, "F in mm a minute");
}

static void move_filament(iso_head *head, int64_t e, int32_t feed, const char *comment) {
    iso_head_end_inverse_time(head);
    head->fine_feed = 0;
    char *p = ISO_PUT(iso_lines_reserve(head->lines), "G1");
    p = put_e(head, p, e);
    p = put_feed(head, p, feed);
    iso_lines_accept(head->lines, iso_modes_end_line(&head->modes, p, comment));
    plan_filament(head, e);
}

/* The firmware's own: how far and how fast is its affair, and taken to be as here. */
static void put_comment_line(iso_head *head, const char *text) {
    iso_lines_accept(head->lines, iso_put_text(iso_lines_reserve(head->lines), text));
}

/* In the plane, with so much filament drawn back. */
static void move_wiping(iso_head *head, int32_t x, int32_t y, int64_t e, int32_t feed) {
    char *p = ISO_PUT(iso_lines_reserve(head->lines), "G1 X");
    p = iso_put_thousandths(p, x);
    p = ISO_PUT(p, " Y");
    p = iso_put_thousandths(p, y);
    if (e != 0)
        p = put_e(head, p, -e);
    p = put_feed(head, p, feed);
    iso_lines_accept(head->lines, iso_modes_end_line(&head->modes, p, "wipe and retract"));
    tell(head, x, y, head->z, 0, 0);
    plan(head, (x - head->x) / 1000.0, (y - head->y) / 1000.0, 0, 0);
    head->x = x;
    head->y = y;
}

static void move_filament_by_firmware(iso_head *head, const char *command, int64_t e, int32_t feed,
                                      const char *comment) {
    double speed = head->speed;
    iso_modes_say(&head->modes, command, 0, comment);
    head->speed = feed / 60.0;
    plan_filament(head, e);
    head->speed = speed;
}

/* Along the path just printed, drawing the filament back as evenly as the way is long. Returns what
 * is left to draw. */
static int64_t wipe(iso_head *head, int64_t e) {
    const iso_wipe *way = &head->wipe;
    int32_t feed = iso_head_feed(WIPE_PACE * head->options->travel_speed);
    double reached = 0;
    int64_t drawn = 0;
    put_comment_line(head, ";WIPE_START\n");
    for (int32_t i = 0; i < way->count && reached < head->wipe_length; i++) {
        int32_t x = to_micrometres(way->point[i].x), y = to_micrometres(way->point[i].y);
        double dx = x - head->x, dy = y - head->y, length = 10 * sqrt(dx * dx + dy * dy);
        double rest = head->wipe_length - reached;
        if (length == 0)
            continue;
        if (length > rest) {
            x = head->x + (int32_t)floor(dx * rest / length + 0.5);
            y = head->y + (int32_t)floor(dy * rest / length + 0.5);
        }
        reached += length;
        int64_t due =
            reached < head->wipe_length ? (int64_t)((double)e * reached / head->wipe_length) : e;
        move_wiping(head, x, y, due - drawn, feed);
        drawn = due;
    }
    put_comment_line(head, ";WIPE_END\n");
    return e - drawn;
}

/* With a wipe, part of it may come before, and the rest of a short way after. */
static void retract_wiping(iso_head *head) {
    int64_t before = (int64_t)((double)head->retract_e * head->options->retract_before_wipe);
    if (before > 0)
        move_filament(head, -before, head->retract_feed, "retract");
    int64_t rest = wipe(head, head->retract_e - before);
    if (rest > 0)
        move_filament(head, -rest, head->retract_feed, "retract");
}

void iso_head_retract(iso_head *head) {
    const iso_flavour_words *words = head->modes.words;
    if (head->retracted || head->retract_e == 0 || !*words->axis)
        return;
    head->retracted = 1;
    head->retractions++;
    if (head->options->use_firmware_retraction)
        move_filament_by_firmware(head, words->retract, -head->retract_e, head->retract_feed,
                                  "retract");
    else if (head->wipe_length > 0 && head->wipe.count > 0 && head->x != UNKNOWN)
        retract_wiping(head);
    else
        move_filament(head, -head->retract_e, head->retract_feed, "retract");
    head->wipe.count = 0;
    iso_modes_say(&head->modes, words->retracted, 0, "extruder off");
}

void head_deretract(iso_head *head) {
    const iso_flavour_words *words = head->modes.words;
    if (!head->retracted)
        return;
    head->retracted = 0;
    iso_modes_say(&head->modes, words->deretracting, 0, "extruder on");
    if (head->options->use_firmware_retraction)
        move_filament_by_firmware(head, words->deretract, head->deretract_e, head->deretract_feed,
                                  "unretract");
    else
        move_filament(head, head->deretract_e, head->deretract_feed, "unretract");
}

void iso_head_take_tool(iso_head *head, int32_t from, int32_t to) {
    const char *reset = head->modes.words->reset_e;
    head->retracted_tool[from] = head->retracted;
    head->retracted = head->retracted_tool[to];
    head->wipe.count = 0;
    head->z = head->feed = UNKNOWN;
    head->doubtful = 1;
    if (head->relative_e || !reset)
        return;
    head->e = 0;
    iso_modes_say(&head->modes, reset, 0, "of another filament");
}

static void move_z(iso_head *head, int32_t z, const char *comment) {
    if (z == head->z)
        return;
    char *p = ISO_PUT(iso_lines_reserve(head->lines), "G1 Z");
    p = iso_put_thousandths(p, to_micrometres(z));
    p = put_feed(head, p, head->travel_feed_z);
    iso_lines_accept(head->lines, iso_modes_end_line(&head->modes, p, comment));
    if (head->z != UNKNOWN)
        plan(head, 0, 0, iso_mm(z - head->z), 0);
    tell(head, head->x, head->y, z, 0, 0);
    head->z = z;
}

/* How far the nozzle rises on its way, at this height. */
static int32_t lift_of(const iso_head *head) {
    const iso_gcode_options *o = head->options;
    double z = iso_mm(head->layer_z);
    bool here =
        z >= o->retract_lift_above && (!(o->retract_lift_below > 0) || z <= o->retract_lift_below);
    return head->retracted && here ? head->lift : 0;
}

void iso_head_reach_layer(iso_head *head) {
    if (head->above == UNKNOWN && !head->space)
        move_z(head, head->layer_z + lift_of(head), "to the layer");
}

void iso_head_rise_above(iso_head *head, int32_t z) {
    iso_head_retract(head);
    if (head->machine) {
        iso_space_rise(head);
        return;
    }
    int32_t all = head->highest == UNKNOWN ? z : iso_space_height_above_all(head);
    head->above = z = z > all ? z : all;
    move_z(head, z, "above all");
}

static double mm_between(const iso_head *head, int32_t x, int32_t y) {
    double dx = (double)x - head->x, dy = (double)y - head->y;
    return sqrt(dx * dx + dy * dy) / 1000;
}

static void move_flat(iso_head *head, int32_t x, int32_t y) {
    char *p = ISO_PUT(iso_lines_reserve(head->lines), "G1 X");
    p = iso_put_thousandths(p, x);
    p = ISO_PUT(p, " Y");
    p = iso_put_thousandths(p, y);
    p = put_feed(head, p, head->travel_feed);
    iso_lines_accept(head->lines, iso_modes_end_line(&head->modes, p, "travel"));
    if (head->x != UNKNOWN && !(head->doubtful && x == head->x && y == head->y))
        plan(head, (x - head->x) / 1000.0, (y - head->y) / 1000.0, 0, 0);
    tell(head, x, y, head->z, 0, 0);
    head->x = x;
    head->y = y;
    head->doubtful = 0;
}

static double mm_of_way(const iso_point *way, int32_t count) {
    double sum = 0;
    for (int32_t i = 0; i + 1 < count; i++) {
        double dx = (double)way[i + 1].x - way[i].x, dy = (double)way[i + 1].y - way[i].y;
        sum += sqrt(dx * dx + dy * dy) / ISO_UNITS_PER_MM;
    }
    return sum;
}

static int is_long(const iso_head *head, const iso_path *path, const iso_point *way, iso_point to) {
    double limit = head->options->retract_before_travel;
    if (path->travel_count == 0)
        return mm_between(head, to_micrometres(to.x), to_micrometres(to.y)) > limit;
    iso_point last[2] = {way[path->travel_count - 1], to};
    return mm_between(head, to_micrometres(way->x), to_micrometres(way->y)) +
               mm_of_way(way, path->travel_count) + mm_of_way(last, 2) >
           limit;
}

/* To the beginning of a path, filament ready. */
static void travel(iso_head *head, const iso_path *path, const iso_point *way, iso_point to,
                   int32_t z) {
    int32_t x = to_micrometres(to.x), y = to_micrometres(to.y);
    int known = head->x != UNKNOWN, away = x != head->x || y != head->y || head->doubtful;
    if (!known || (away && path->retract != ISO_RETRACT_NOT && is_long(head, path, way, to)))
        iso_head_retract(head);
    if (away) {
        int32_t low = z > head->layer_z ? z : head->layer_z;
        int32_t high = low + lift_of(head);
        move_z(head, head->above > high ? head->above : high, "lift");
        iso_modes_accelerate_travel(&head->modes, head->travel_acceleration);
        for (int32_t i = 0; known && i < path->travel_count; i++)
            move_flat(head, to_micrometres(way[i].x), to_micrometres(way[i].y));
        move_flat(head, x, y);
    }
    head->above = UNKNOWN;
    move_z(head, z, "to the layer");
    head_deretract(head);
}

static void say_role(iso_head *head, int32_t role) {
    if (role == head->role)
        return;
    head->role = role;
    char *p = ISO_PUT(iso_lines_reserve(head->lines), ";TYPE:");
    p = iso_put_text(p, iso_role_name((iso_role)role));
    iso_lines_accept(head->lines, iso_put_newline(p));
}

void head_blow(iso_head *head, int32_t role, const iso_layer_pace *pace) {
    iso_modes_set_fan(&head->modes, iso_role_is_bridge(role) ? pace->bridge_fan : pace->fan);
}

void head_begin_piece(iso_head *head, int32_t role, const iso_layer_pace *pace) {
    head_blow(head, role, pace);
    iso_modes_accelerate(&head->modes, pace->acceleration[role]);
    say_role(head, role);
}

const char *head_comment_of(int32_t role) {
    static const char *const comment[ISO_ROLE_COUNT] = {[ISO_ROLE_EXTERNAL_PERIMETER] = "perimeter",
                                                        [ISO_ROLE_PERIMETER] = "perimeter",
                                                        [ISO_ROLE_OVERHANG_PERIMETER] = "perimeter",
                                                        [ISO_ROLE_INTERNAL_INFILL] = "infill",
                                                        [ISO_ROLE_SOLID_INFILL] = "infill",
                                                        [ISO_ROLE_TOP_SOLID_INFILL] = "infill",
                                                        [ISO_ROLE_IRONING] = "ironing",
                                                        [ISO_ROLE_BRIDGE_INFILL] = "bridge",
                                                        [ISO_ROLE_GAP_FILL] = "gap fill",
                                                        [ISO_ROLE_SKIRT] = "skirt",
                                                        [ISO_ROLE_SUPPORT] = "support",
                                                        [ISO_ROLE_SUPPORT_INTERFACE] = "support",
                                                        [ISO_ROLE_CUSTOM] = "custom"};
    return comment[role];
}

/* Threads through the air are round, and infill of several layers is as high as they are: a stadium
 * of width w and height h has the area w h - (1 - pi / 4) h^2. Others are as high as the layer. */
int32_t head_height_of(const iso_path_vertex *bead, int32_t local) {
    const double corners = 1 - pi / 4;
    if (!iso_role_is_bridge(bead->role) && bead->role != ISO_ROLE_INTERNAL_INFILL)
        return local;
    double w = bead->width, rest = w * w - 4 * corners * bead->area;
    double height = rest < 0 ? w : (w - sqrt(rest)) / (2 * corners);
    return height < 1.3 * local ? local : (int32_t)(height + 0.5);
}

static char *put_bead(iso_head *head, char *p, const iso_path_vertex *bead) {
    int32_t height = head_height_of(bead, head->layer_height);
    head->area = bead->area;
    if (bead->width != head->width)
        p = iso_put_newline(iso_put_decimal(ISO_PUT(p, ";WIDTH:"), bead->width, 4));
    head->width = bead->width;
    if (height != head->height)
        p = iso_put_newline(iso_put_decimal(ISO_PUT(p, ";HEIGHT:"), height, 4));
    head->height = height;
    return p;
}

/* From where the machine is to `to`, leaving a bead of `length` units and section `area`. A segment
 * that vanishes in the rounding hands its material to the next one. */
static void draw_segment(iso_head *head, const iso_path_vertex *from, iso_point to, int32_t z,
                         double length, int32_t feed) {
    head->drawn += (int64_t)(length * from->area * head->e_scale + 0.5);
    int32_t x = to_micrometres(to.x), y = to_micrometres(to.y);
    if (x == head->x && y == head->y && z == head->z)
        return;
    char *p = iso_lines_reserve(head->lines);
    if (from->width != head->width || from->area != head->area)
        p = put_bead(head, p, from);
    p = ISO_PUT(p, "G1 X");
    p = iso_put_thousandths(p, x);
    p = ISO_PUT(p, " Y");
    p = iso_put_thousandths(p, y);
    if (z != head->z) {
        p = ISO_PUT(p, " Z");
        p = iso_put_thousandths(p, to_micrometres(z));
    }
    int64_t e = take_e(head);
    if (e != 0)
        p = put_e(head, p, e);
    p = put_feed(head, p, feed);
    iso_lines_accept(head->lines, iso_modes_end_line(&head->modes, p, head_comment_of(head->role)));
    plan(head, (x - head->x) / 1000.0, (y - head->y) / 1000.0, iso_mm(z - head->z), 1);
    tell(head, x, y, z, from->width, head->height);
    head->x = x;
    head->y = y;
    head->z = z;
}

static void tell_chord(iso_head *head, const iso_path_vertex *a, const iso_path_vertex *b) {
    double z = to_micrometres(head->z) / 1000.0 - head->options->z_offset;
    iso_gcode_move move = {.from = {iso_mm(a->at.x), iso_mm(a->at.y), z},
                           .to = {iso_mm(b->at.x), iso_mm(b->at.y), z},
                           .from_normal = {0, 0, 1},
                           .to_normal = {0, 0, 1},
                           .width = iso_mm(a->width),
                           .height = iso_mm(head_height_of(a, head->layer_height))};
    head_tell(head, &move);
}

/* A run of beads in one move: as far as they reach, along the circle they lie on. The planner gets
 * them one by one, as a firmware cuts the arc up again. */
static void draw_arc(iso_head *head, const iso_arc *arc, const iso_path *path,
                     const iso_path_vertex *vertex, int32_t feed) {
    const iso_path_vertex *from = &vertex[arc->first];
    double length = 0;
    for (int32_t i = 0; i < arc->count; i++) {
        int32_t a = (arc->first + i) % path->count, b = (a + 1) % path->count;
        double dx = (double)vertex[b].at.x - vertex[a].at.x;
        double dy = (double)vertex[b].at.y - vertex[a].at.y, chord = sqrt(dx * dx + dy * dy);
        length += chord * (1 + chord * chord / (24 * arc->radius * arc->radius));
        head->speed = feed / 60.0;
        plan(head, dx / ISO_UNITS_PER_MM, dy / ISO_UNITS_PER_MM, 0, 1);
        if (head->options->watch)
            tell_chord(head, &vertex[a], &vertex[b]);
    }
    head->moves -= arc->count - 1;
    head->drawn += (int64_t)(length * from->area * head->e_scale + 0.5);
    iso_point to = vertex[(arc->first + arc->count) % path->count].at;
    int32_t x = to_micrometres(to.x), y = to_micrometres(to.y);
    char *p = iso_lines_reserve(head->lines);
    if (from->width != head->width || from->area != head->area)
        p = put_bead(head, p, from);
    p = arc->clockwise ? ISO_PUT(p, "G2 X") : ISO_PUT(p, "G3 X");
    p = iso_put_thousandths(p, x);
    p = iso_put_thousandths(ISO_PUT(p, " Y"), y);
    p = iso_put_thousandths(ISO_PUT(p, " I"), (int32_t)floor(arc->center.x / 10 - head->x + 0.5));
    p = iso_put_thousandths(ISO_PUT(p, " J"), (int32_t)floor(arc->center.y / 10 - head->y + 0.5));
    int64_t e = take_e(head);
    if (e != 0)
        p = put_e(head, p, e);
    p = put_feed(head, p, feed);
    iso_lines_accept(head->lines, iso_modes_end_line(&head->modes, p, head_comment_of(head->role)));
    head->x = x;
    head->y = y;
}

/* The arc that begins at vertex i of the path, if there is one. */
static const iso_arc *take_arc(iso_head *head, int32_t path, int32_t i) {
    while (head->arc < head->arc_end &&
           (head->arc->path < path || (head->arc->path == path && head->arc->first < i)))
        head->arc++;
    if (head->arc == head->arc_end || head->arc->path != path || head->arc->first != i)
        return NULL;
    return head->arc++;
}

iso_status iso_head_draw(iso_head *head, const iso_paths *paths, const iso_path *path,
                         const double *length, const iso_layer_pace *pace) {
    const iso_path_vertex *vertex = paths->vertex + path->first;
    const iso_point *way = path->travel_count > 0 ? paths->travel + path->travel_first : NULL;
    int32_t segments = path->closed ? path->count : path->count - 1;
    if (path->count < 2)
        return ISO_OK;
    if (head->space)
        return iso_space_draw(head, paths, path, length, pace);
    head_blow(head, vertex[0].role, pace); /* it takes a while to turn faster */
    travel(head, path, way, vertex[0].at, head->layer_z + vertex[0].z);
    int32_t role = UNKNOWN, feed = 0, most = 0;
    int slot = 0;
    for (int32_t i = 0; i < segments; i++) {
        const iso_path_vertex *from = &vertex[i], *to = &vertex[i + 1 < path->count ? i + 1 : 0];
        if (from->role != role) {
            role = from->role;
            slot = iso_speed_slot(role, path->speed_class);
            feed = pace->feed[slot];
            most = pace->most_area[slot];
            head_begin_piece(head, role, pace);
        }
        int32_t own = from->area > most ? iso_pace_limited_feed(pace, slot, from->area) : feed;
        const iso_arc *arc = take_arc(head, (int32_t)(path - paths->path), i);
        if (!arc) {
            draw_segment(head, from, to->at, head->layer_z + to->z, length[i], own);
            continue;
        }
        draw_arc(head, arc, path, vertex, own);
        i += arc->count - 1;
    }
    if (head->wipe_length > 0)
        iso_wipe_remember(&head->wipe, path, vertex, head->wipe_length);
    return ISO_OK;
}
