#include "gcode/planner.h"

#include <math.h>
#include <string.h>

static double smaller(double a, double b) {
    return a < b ? a : b;
}

void iso_planner_start(iso_planner *planner, double junction_deviation) {
    planner->junction_deviation = junction_deviation;
    planner->x = planner->y = planner->z = 0;
    planner->entry = planner->time = planner->idle_time = 0;
    planner->count = 0;
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
    double next = 0;
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
        double next = i + 1 < planner->count ? b[1].entry : 0;
        double out_squared = smaller(next, in_squared + b->gain), out = sqrt(out_squared);
        double t = time_of(b, in, out);
        planner->time += t;
        if (!b->extrudes)
            planner->idle_time += t;
        in_squared = out_squared;
        in = out;
    }
    planner->entry = in_squared;
    planner->count -= count;
    memmove(planner->block, planner->block + count,
            (size_t)planner->count * sizeof planner->block[0]);
}

/* Square of the speed at which the corner's arc of the given deviation can be taken, but at most
 * `most`, which gentle corners reach without a division. */
static double junction_squared(const iso_planner *planner, double x, double y, double z,
                               double acceleration, double most) {
    double cosine = -(planner->x * x + planner->y * y + planner->z * z);
    int moved = planner->x != 0 || planner->y != 0 || planner->z != 0;
    if (!moved || cosine > 0.999999 || (x == 0 && y == 0 && z == 0))
        return 0;
    double sine = cosine < -1 ? 1 : sqrt(0.5 * (1 - cosine));
    double reached = acceleration * planner->junction_deviation * sine;
    return reached >= most * (1 - sine) ? most : reached / (1 - sine);
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
    double before = planner->count > 0 ? planner->block[planner->count - 1].speed : 0;
    double slower = smaller(before, move->speed);
    planner->block[planner->count++] = (iso_planner_block){
        .speed = move->speed,
        .acceleration = move->acceleration,
        .gain = 2 * move->acceleration * move->length,
        .limit = junction_squared(planner, x, y, z, move->acceleration, slower * slower),
        .extrudes = move->extrudes};
    planner->x = x;
    planner->y = y;
    planner->z = z;
}

double iso_planner_elapsed(const iso_planner *planner) {
    double time = planner->time;
    for (const iso_planner_block *b = planner->block; b < planner->block + planner->count; b++)
        time += b->gain / (2 * b->acceleration * b->speed);
    return time;
}

void iso_planner_stop(iso_planner *planner) {
    plan_backwards(planner);
    let_go(planner, planner->count);
    planner->x = planner->y = planner->z = 0;
    planner->entry = 0;
}
