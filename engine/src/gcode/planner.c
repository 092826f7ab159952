#include "gcode/planner.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static double smaller(double a, double b) {
    return a < b ? a : b;
}

void iso_planner_start(iso_planner *planner, const iso_machine_limits *limits) {
    const double *v = limits->feedrate, *a = limits->acceleration;
    memset(planner, 0, offsetof(iso_planner, block));
    planner->limits = *limits;
    planner->classic_jerk = !(limits->junction_deviation > 0);
    planner->axes_speed = smaller(v[0], v[1]);
    planner->axes_acceleration = smaller(a[0], a[1]);
    planner->mark = -1;
}

/* Seconds for a block entered and left at the given speeds. With a the acceleration, v the speed
 * and L the length, ramps and cruise add up to ((v - in)^2 + (v - out)^2 + 2 a L) / (2 a v). */
static double time_of(const iso_planner_block *b, double in, double out) {
    double peak_squared = (b->gain + in * in + out * out) / 2, v = b->speed;
    if (peak_squared <= v * v)
        return (2 * sqrt(peak_squared) - in - out) / b->acceleration;
    return ((v - in) * (v - in) + (v - out) * (v - out) + b->gain) / (2 * b->acceleration * v);
}

/* Entry speeds from which the machine can still brake, were it to stop behind the last block. */
static void plan_backwards(iso_planner *planner) {
    double next = planner->count > 0 ? planner->block[planner->count - 1].rest : 0;
    for (int32_t i = planner->count; i-- > 0;) {
        iso_planner_block *b = &planner->block[i];
        next = b->entry = smaller(b->limit, next + b->gain);
    }
}

/* Time the first `count` blocks and let them go. Squares of speeds go from block to block, so that
 * no block waits for the root of the one before. */
static void let_go(iso_planner *planner, int32_t count) {
    double in_squared = planner->entry, in = sqrt(in_squared);
    for (int32_t i = 0; i < count; i++) {
        const iso_planner_block *b = &planner->block[i];
        double next = i + 1 < planner->count ? b[1].entry : b->rest;
        double out_squared = smaller(next, in_squared + b->gain), out = sqrt(out_squared);
        double t = time_of(b, in, out);
        if (i == planner->mark)
            planner->mark_time = planner->time;
        planner->time += t;
        if (!b->extrudes)
            planner->idle_time += t;
        in_squared = out_squared;
        in = out;
    }
    planner->entry = in_squared;
    planner->count -= count;
    planner->mark = planner->mark >= count ? planner->mark - count : -1;
    memmove(planner->block, planner->block + count,
            (size_t)planner->count * sizeof planner->block[0]);
}

/* Square of the speed at which the corner's arc of the given deviation can be taken, but at most
 * `most`. q is the square of the cosine of half the angle between the moves, 0 straight on; its
 * sine is at least 1 - q, which tells gentle corners without a root. */
static double junction_squared(const iso_planner *planner, double q, double acceleration,
                               double most) {
    double pull = acceleration * planner->limits.junction_deviation;
    if (pull * (1 - q) >= most * q)
        return most;
    double sine = sqrt(1 - q), reached = pull * sine;
    return reached >= most * (1 - sine) ? most : reached / (1 - sine);
}

/* Chords of a curve, below 1 mm and 45 degrees: Marlin takes the curve's own radius, the chord
 * divided by its turn. The turn is 2 asin(s), s^2 = q, here by the asin's series. */
static double curve_squared(double q, double length, double acceleration, double most) {
    double pull = length * acceleration;
    if (pull * pull >= most * most * 4.3 * q) /* the series is below 1.03 */
        return most;
    double series = 1 + q * (1. / 6 + q * (3. / 40 + q * (15. / 336)));
    double squared = pull / (2 * series * sqrt(q));
    return squared < most ? squared : most;
}

/* Square of the speed at which a block can be entered, at most `most`. */
static double corner_squared(const iso_planner *planner, const double to[3], double length,
                             double acceleration, double most) {
    double cosine = -(planner->x * to[0] + planner->y * to[1] + planner->z * to[2]);
    int moved = planner->x != 0 || planner->y != 0 || planner->z != 0;
    if (!moved || cosine > 0.999999 || (to[0] == 0 && to[1] == 0 && to[2] == 0))
        return 0;
    double q = cosine < -1 ? 0 : 0.5 * (1 + cosine);
    double squared = junction_squared(planner, q, acceleration, most);
    if (length < 1 && cosine < -0.70710678118654752)
        squared = curve_squared(q, length, acceleration, squared);
    return squared;
}

/* The most of `value` that keeps each axis within its limit. */
static double within(double value, const double direction[4], const double most[4]) {
    for (int i = 0; i < 4; i++) {
        double part = direction[i] < 0 ? -direction[i] : direction[i];
        if (part * value > most[i])
            value = most[i] / part;
    }
    return value;
}

/* Square of the speed at which no axis jumps by more than its jerk; one that turns back stops on
 * the way. Stopping and starting anew is always allowed. */
static double jerk_squared(const iso_planner *planner, const double to[4], double rest,
                           double slower) {
    const double from[4] = {planner->x, planner->y, planner->z, planner->filament};
    double jump[4], stop = planner->count > 0 ? planner->block[planner->count - 1].rest : rest;
    int moved = 0;
    for (int i = 0; i < 4; i++) {
        double a = from[i] < 0 ? -from[i] : from[i], b = to[i] < 0 ? -to[i] : to[i];
        moved |= a > 0;
        jump[i] = from[i] * to[i] >= 0 ? a - b : a > b ? a : b;
    }
    if (!moved)
        return rest;
    double speed = within(slower, jump, planner->limits.jerk);
    stop = smaller(stop, rest);
    return speed * speed > stop ? speed * speed : stop;
}

/* In place of junction deviation: limits of entry and rest by jerk. */
static void limit_by_jerk(iso_planner *planner, iso_planner_block *block, const double to[4],
                          double slower) {
    double rest = within(block->speed, to, planner->limits.jerk);
    block->rest = rest * rest;
    block->limit = jerk_squared(planner, to, block->rest, slower);
    if (planner->count == 0 && planner->x == 0 && planner->y == 0 && planner->z == 0 &&
        planner->filament == 0)
        planner->entry = block->rest;
}

/* Hardly a move needs it: those up, those of the filament alone, and where an axis is slow. */
static void limit_by_axes(const iso_planner *planner, iso_planner_block *block,
                          const double to[4]) {
    block->speed = within(block->speed, to, planner->limits.feedrate);
    block->acceleration = within(block->acceleration, to, planner->limits.acceleration);
}

void iso_planner_add(iso_planner *planner, const iso_planner_move *move) {
    if (!(move->length > 0) || !(move->speed > 0))
        return;
    if (planner->count == ISO_PLANNER_WINDOW) {
        plan_backwards(planner);
        let_go(planner, ISO_PLANNER_WINDOW - ISO_PLANNER_AHEAD);
    }
    double inverse = 1 / move->length;
    double x = move->dx * inverse, y = move->dy * inverse, z = move->dz * inverse;
    double filament = x == 0 && y == 0 && z == 0;
    iso_planner_block *block = &planner->block[planner->count];
    block->speed = move->speed;
    block->acceleration = move->acceleration;
    block->extrudes = move->extrudes;
    block->rest = 0;
    if (z != 0 || filament > 0 || move->speed > planner->axes_speed ||
        move->acceleration > planner->axes_acceleration)
        limit_by_axes(planner, block, (const double[4]){x, y, z, filament});
    double before = planner->count > 0 ? block[-1].speed : 0;
    double slower = smaller(before, block->speed);
    block->gain = 2 * block->acceleration * move->length;
    if (planner->classic_jerk)
        limit_by_jerk(planner, block, (const double[4]){x, y, z, filament}, slower);
    else
        block->limit = corner_squared(planner, (const double[3]){x, y, z}, move->length,
                                      block->acceleration, slower * slower);
    planner->count++;
    planner->x = x;
    planner->y = y;
    planner->z = z;
    planner->filament = filament;
}

void iso_planner_set_mark(iso_planner *planner) {
    planner->mark = planner->count;
    planner->mark_time = -1;
}

double iso_planner_elapsed(const iso_planner *planner) {
    double time = planner->time;
    for (const iso_planner_block *b = planner->block; b < planner->block + planner->count; b++)
        time += b->gain / (2 * b->acceleration * b->speed);
    return time;
}

void iso_planner_stop(iso_planner *planner) {
    int32_t marked = planner->mark >= 0 && planner->mark == planner->count;
    plan_backwards(planner);
    let_go(planner, planner->count);
    if (marked)
        planner->mark_time = planner->time;
    planner->x = planner->y = planner->z = planner->filament = 0;
    planner->entry = 0;
}
