#include "virtual/planner.h"

#include <math.h>

static inline double lesser(double a, double b) {
    return a < b ? a : b;
}

static inline int next_index(const fio_planner *planner, int index) {
    return index + 1 == planner->capacity ? 0 : index + 1;
}

static inline int index_before(const fio_planner *planner, int index) {
    return index == 0 ? planner->capacity - 1 : index - 1;
}

/* The most of `value` along a direction that keeps every axis within its limit. */
static double limit_by_axes(double value, const double direction[4], const double most[4]) {
    for (int i = 0; i < 4; i++) {
        double part = fabs(direction[i]);
        if (part * value > most[i])
            value = most[i] / part;
    }
    return value;
}

/* Square of the corner's speed by junction deviation: the corner is rounded by the arc that leaves
 * it by `deviation` at most, and the centripetal acceleration along that arc is limited. */
static double junction_squared(const fio_planner *planner, const fio_limits *limits,
                               const fio_block *block, const double direction[5]) {
    double cosine = 0, turn[5], length = 0; /* cosine of the angle between the two legs */
    for (int i = 0; i < 5; i++) {
        cosine -= planner->direction[i] * direction[i];
        turn[i] = direction[i] - planner->direction[i];
        length += turn[i] * turn[i];
    }
    if (cosine > 0.999999)
        return 0; /* it turns back */
    if (length < 1e-12)
        return HUGE_VAL; /* straight on */
    length = sqrt(length);
    for (int i = 0; i < 5; i++)
        turn[i] /= length;
    double acceleration = limit_by_axes(block->acceleration, turn, limits->acceleration);
    double half_sine = sqrt(0.5 * (1 - cosine));
    double squared = half_sine >= 1
                         ? HUGE_VAL
                         : acceleration * limits->junction_deviation * half_sine / (1 - half_sine);
    if (block->length < 1 && cosine < -0.70710678118654752) {
        /* Short chords of a curve: the curve's own radius is length / turning angle, and the angle
         * is 2 asin(half chord of the unit turn); four terms, since it is below 45 degrees. */
        double s = 0.5 * length, q = s * s;
        double angle = 2 * s * (1 + q * (1. / 6 + q * (3. / 40 + q * (15. / 336))));
        squared = lesser(squared, block->length / angle * acceleration);
    }
    return squared;
}

/* Speed at which a block may start or stop at once, no axis jumping by more than its jerk. */
static double rest_speed(const fio_limits *limits, const double unit[4], double nominal) {
    return limits->classic_jerk ? limit_by_axes(nominal, unit, limits->jerk) : 0;
}

/* Square of the corner's speed by the axes' jerk: an axis that turns back stops on the way. */
static double jerk_squared(const fio_planner *planner, const fio_limits *limits,
                           const double unit[4], double nominal, double rest) {
    double jump[4];
    for (int i = 0; i < 4; i++) {
        double a = planner->unit[i], b = unit[i];
        jump[i] = a * b >= 0 ? a - b : fmax(fabs(a), fabs(b));
    }
    double speed = limit_by_axes(lesser(nominal, planner->nominal), jump, limits->jerk);
    double stop = lesser(rest, planner->rest); /* stopping and starting anew is always allowed */
    speed = speed > stop ? speed : stop;
    return speed * speed;
}

/* Two passes over the blocks not yet settled, as grbl's planner does: backwards so that each block
 * can stop by the end of the newest, forwards so that no block gains more speed than it can. */
static void look_ahead(fio_planner *planner) {
    fio_block *blocks = planner->blocks;
    int newest = planner->oldest + planner->count - 1;
    if (newest >= planner->capacity)
        newest -= planner->capacity;
    if (newest == planner->settled)
        return;
    for (int i = newest; i != planner->settled; i = index_before(planner, i)) {
        double exit =
            i == newest ? blocks[i].rest_squared : blocks[next_index(planner, i)].entry_squared;
        double reach = exit + 2 * blocks[i].acceleration * blocks[i].length;
        blocks[i].entry_squared = lesser(blocks[i].most_entry_squared, reach);
    }
    for (int i = planner->settled; i != newest;) {
        const fio_block *block = &blocks[i];
        i = next_index(planner, i);
        double reach = block->entry_squared + 2 * block->acceleration * block->length;
        if (reach < blocks[i].entry_squared) {
            blocks[i].entry_squared = reach;
            planner->settled = i; /* full acceleration up to here: nothing later changes that */
        }
        if (blocks[i].entry_squared == blocks[i].most_entry_squared)
            planner->settled = i;
    }
}

bool fio_planner_add(fio_planner *planner, const fio_limits *limits, const double delta[5],
                     double feedrate, double *nominal) {
    double squared = delta[0] * delta[0] + delta[1] * delta[1] + delta[2] * delta[2];
    bool still = squared<1e-16, extrudes = fabs(delta[3])> 1e-9;
    bool turns = delta[4] != 0;
    if (still && !extrudes && !turns)
        return false;
    double length = !still ? sqrt(squared) : turns ? fabs(delta[4]) : fabs(delta[3]);
    double unit[5], direction[5], norm = 0;
    for (int i = 0; i < 5; i++) {
        unit[i] = delta[i] / length;
        norm += unit[i] * unit[i];
    }
    norm = 1 / sqrt(norm);
    for (int i = 0; i < 5; i++)
        direction[i] = unit[i] * norm;

    fio_block block = {.length = length};
    double least = extrudes ? limits->minimum_feedrate : limits->minimum_travel_feedrate;
    block.nominal = limit_by_axes(feedrate > least ? feedrate : least, unit, limits->feedrate);
    still = still && !turns;
    double acceleration = still      ? limits->retract_acceleration
                          : extrudes ? limits->print_acceleration
                                     : limits->travel_acceleration;
    block.acceleration = limit_by_axes(acceleration, unit, limits->acceleration);
    double rest = rest_speed(limits, unit, block.nominal);
    block.rest_squared = block.most_entry_squared = rest * rest;
    if (planner->joined) {
        double corner = limits->classic_jerk
                            ? jerk_squared(planner, limits, unit, block.nominal, rest)
                            : junction_squared(planner, limits, &block, direction);
        double slower = lesser(block.nominal, planner->nominal);
        block.most_entry_squared = lesser(corner, slower * slower);
    }
    block.entry_squared = block.rest_squared;

    planner->count++;
    fio_block *place = fio_planner_newest(planner);
    *place = block;
    if (planner->count == 1)
        planner->settled = planner->oldest;
    for (int i = 0; i < 5; i++) {
        planner->unit[i] = unit[i];
        planner->direction[i] = direction[i];
    }
    planner->nominal = *nominal = block.nominal;
    planner->rest = rest;
    planner->joined = true;
    look_ahead(planner);
    return true;
}

static double trapezoid_time(const fio_block *block, double exit_squared) {
    double a = block->acceleration, v = block->nominal;
    double entry = sqrt(block->entry_squared), exit = sqrt(exit_squared);
    double ramps = (2 * v * v - block->entry_squared - exit_squared) / (2 * a);
    if (ramps <= block->length)
        return (2 * v - entry - exit) / a + (block->length - ramps) / v;
    double peak = sqrt(0.5 * (2 * a * block->length + block->entry_squared + exit_squared));
    double faster = entry > exit ? entry : exit;
    if (peak < faster) /* by rounding only */
        peak = faster;
    return (2 * peak - entry - exit) / a;
}

double fio_planner_take(fio_planner *planner, fio_block *taken) {
    *taken = planner->blocks[planner->oldest];
    int next = next_index(planner, planner->oldest);
    double exit_squared =
        planner->count > 1 ? planner->blocks[next].entry_squared : taken->rest_squared;
    if (planner->settled == planner->oldest)
        planner->settled = next;
    planner->oldest = next;
    planner->count--;
    return trapezoid_time(taken, exit_squared);
}

void fio_planner_rest(fio_planner *planner) {
    planner->joined = false;
}
