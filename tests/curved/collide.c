/* Does the tool of a machine touch what it has printed? By brute force: points of its beads against
 * places of the tool, for prints with curved layers.
 *
 *     collide PRINT.gcode PART.stl [--field TEXT [--base FROM,TO,OFF]] [--told] [--center X,Y]
 *             [--kinematics NAME [--pivot X,Y,Z]] [--filament MM] [--step MM] [--tolerance MM]
 *             [--tip DIAMETER] [--cone DEGREES] [--cone-height MM] [--block X,Y,X,Y]
 *             [--carriage-height MM] [--carriage X,Y,X,Y] [--gantry MM]
 *
 * The tool stands along Z of the machine above its tip: a cone that ends in a flat, a block and a
 * carriage without upper ends, and the gantry, which is everywhere above its height. All moves are
 * looked at every --step against points on top and at the sides of all beads before. While it
 * prints, and on travels no further than a tip's diameter from where they begin or end, the nozzle
 * may reach into beads by as much as the layer is thick: it presses into its neighbours.
 *
 *     deepest_NAME MM   of each part of the tool, less what it may; below 0: it is clear. Nobody
 *                       looks for more than 0.05 mm (nozzle) or 1 mm of distance
 *     collision ...     the first one
 *
 * Exit 1 if there is one, 2 if the files can't be read. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "beads.h"

#define CELL 0.5 /* mm: points by cells, */
enum { BLOCK = 6 /* and that many cells along each side by blocks */ };

enum { NOZZLE, HEATER, CARRIAGE, GANTRY, PARTS };
static const char *const part_name[PARTS] = {"nozzle", "heater block", "carriage", "gantry"};

typedef struct tool {
    double tip, cone, cone_height, block[4], carriage_height, carriage[4], gantry;
    double rise; /* of the cone's side, mm a mm */
} tool;

typedef struct cell {
    vec *point;
    int32_t *line;
    int count, capacity;
} cell;

typedef struct world {
    vec low, last; /* the place that had points last */
    int blocks[3];
    cell **cells; /* [blocks] BLOCK^3 of each that has points */
    int *busy;    /* blocks that have some */
    int busy_count;
} world;

typedef struct check {
    tool tool;
    machine machine;
    double step, tolerance;
    world world;
    double deepest[PARTS];
    int found;
    vec looked; /* where it did last */
    int64_t samples;
} check;

/* ---- the tool ---- */

/* How far into a box [x, y, x, y] that begins at `from`; below 0: how far outside, or less. */
static double into_box(vec p, double from, const double box[4]) {
    if (box[0] >= box[2] || box[1] >= box[3])
        return -1e9;
    double x = fmin(p.x - box[0], box[2] - p.x), y = fmin(p.y - box[1], box[3] - p.y);
    return fmin(p.z - from, fmin(x, y));
}

/* How far a point, seen from the tip, may be inside, anywhere in a ball around it. */
static void depths(double depth[PARTS], const tool *t, vec p, double ball) {
    double away = fmax(0, sqrt(p.x * p.x + p.y * p.y) - ball - t->tip / 2);
    depth[NOZZLE] = p.z - ball > t->cone_height ? -1e9 : p.z + ball - away * t->rise;
    depth[HEATER] = into_box(p, t->cone_height, t->block) + ball;
    depth[CARRIAGE] = into_box(p, t->carriage_height, t->carriage) + ball;
    depth[GANTRY] = t->gantry > 0 ? p.z - t->gantry + ball : -1e9;
}

/* ---- what is printed ---- */

static void make_world(world *w, const beads *b) {
    vec high = {-1e30, -1e30, -1e30};
    w->low = (vec){1e30, 1e30, 1e30};
    for (int64_t i = 0; i < b->count; i++) {
        const bead *one = &b->at[i];
        double r = one->width + one->height + CELL;
        for (int k = 0; k < 2; k++) {
            vec p = k ? one->to : one->from;
            w->low =
                (vec){fmin(w->low.x, p.x - r), fmin(w->low.y, p.y - r), fmin(w->low.z, p.z - r)};
            high = (vec){fmax(high.x, p.x + r), fmax(high.y, p.y + r), fmax(high.z, p.z + r)};
        }
    }
    vec span = minus(high, w->low);
    const double side[3] = {span.x, span.y, span.z};
    for (int k = 0; k < 3; k++)
        w->blocks[k] = 1 + (int)(side[k] / (CELL * BLOCK));
    size_t blocks = (size_t)w->blocks[0] * (size_t)w->blocks[1] * (size_t)w->blocks[2];
    w->cells = calloc(blocks, sizeof(cell *));
    w->busy = calloc(blocks, sizeof *w->busy);
    if (!w->cells || !w->busy)
        abort();
}

static void free_world(world *w) {
    for (int i = 0; i < w->busy_count; i++) {
        for (int k = 0; k < BLOCK * BLOCK * BLOCK; k++)
            free(w->cells[w->busy[i]][k].point), free(w->cells[w->busy[i]][k].line);
        free(w->cells[w->busy[i]]);
    }
    free(w->cells);
    free(w->busy);
}

static void put(world *w, vec p, int32_t line) {
    vec at = times(minus(p, w->low), 1 / CELL);
    int x = (int)at.x, y = (int)at.y, z = (int)at.z;
    int block = (z / BLOCK * w->blocks[1] + y / BLOCK) * w->blocks[0] + x / BLOCK;
    if (!w->cells[block]) {
        w->cells[block] = calloc(BLOCK * BLOCK * BLOCK, sizeof(cell));
        if (!w->cells[block])
            abort();
        w->busy[w->busy_count++] = block;
    }
    cell *c = &w->cells[block][(z % BLOCK * BLOCK + y % BLOCK) * BLOCK + x % BLOCK];
    if (c->count == c->capacity) {
        c->capacity = c->capacity ? 2 * c->capacity : 8;
        c->point = realloc(c->point, (size_t)c->capacity * sizeof *c->point);
        c->line = realloc(c->line, (size_t)c->capacity * sizeof *c->line);
        if (!c->point || !c->line)
            abort();
    }
    c->point[c->count] = p;
    c->line[c->count++] = line;
}

/* Points of a stadium's top and sides, about every quarter of a mm. */
static void put_bead(world *w, const bead *b) {
    int pieces = 1 + (int)(b->length / 0.25);
    double top = fmax(0, b->width - b->height) / 2;
    for (int i = 0; i <= pieces; i++) {
        vec at = mix(b->from, b->to, (double)i / pieces), low = times(b->up, -b->height / 2);
        if (length(minus(at, w->last)) < 0.15)
            continue;
        w->last = at;
        put(w, at, b->line);
        for (int side = -1; side <= 1; side += 2) {
            put(w, plus(at, times(b->side, side * top)), b->line);
            put(w, plus(plus(at, low), times(b->side, side * b->width / 2)), b->line);
        }
    }
}

/* ---- the check ---- */

typedef struct pose {
    vec tip;
    turn turn;
    double may; /* mm that the nozzle may reach into beads */
    int32_t line;
} pose;

static void tell(check *c, int which, const pose *at, vec point, int32_t line, double depth) {
    if (c->found++ == 0)
        printf(
            "collision of the %s in line %d with the bead of line %d, %.3f mm deep: tip %.3f %.3f "
            "%.3f, bead %.3f %.3f %.3f, allowed %.3f\n",
            part_name[which], at->line, line, depth, at->tip.x, at->tip.y, at->tip.z, point.x,
            point.y, point.z, at->may);
}

/* Is anything within a ball deeper than all that was found? */
static int worth(const check *c, const pose *at, vec center, double ball) {
    double depth[PARTS];
    vec p = minus(center, at->tip);
    if (c->machine.tilt >= 0)
        p = turned(at->turn, p);
    if (p.z + ball <= c->deepest[NOZZLE] + at->may)
        return 0; /* nothing reaches below the tip */
    depths(depth, &c->tool, p, ball);
    depth[NOZZLE] -= at->may;
    for (int k = 0; k < PARTS; k++)
        if (depth[k] > c->deepest[k])
            return 1;
    return 0;
}

static void look_at_cell(check *c, const pose *at, const cell *in) {
    for (int i = 0; i < in->count; i++) {
        double depth[PARTS];
        depths(depth, &c->tool, turned(at->turn, minus(in->point[i], at->tip)), 0);
        depth[NOZZLE] -= at->may;
        for (int k = 0; k < PARTS; k++) {
            if (depth[k] > c->tolerance)
                tell(c, k, at, in->point[i], in->line[i], depth[k]);
            c->deepest[k] = fmax(c->deepest[k], depth[k]);
        }
    }
}

static void look(check *c, const pose *at) {
    const world *w = &c->world;
    c->samples++;
    for (int i = 0; i < w->busy_count; i++) {
        int b = w->busy[i],
            low[3] = {b % w->blocks[0] * BLOCK, b / w->blocks[0] % w->blocks[1] * BLOCK,
                      b / w->blocks[0] / w->blocks[1] * BLOCK};
        vec corner = plus(w->low, times((vec){low[0], low[1], low[2]}, CELL));
        double half = BLOCK * CELL / 2;
        if (!worth(c, at, plus(corner, (vec){half, half, half}), half * sqrt(3)))
            continue;
        for (int k = 0; k < BLOCK * BLOCK * BLOCK; k++) {
            int x = k % BLOCK, y = k / BLOCK % BLOCK, z = k / BLOCK / BLOCK;
            const cell *in = &w->cells[b][k];
            vec middle = plus(corner, times((vec){x + 0.5, y + 0.5, z + 0.5}, CELL));
            if (in->count > 0 && worth(c, at, middle, CELL / 2 * sqrt(3)))
                look_at_cell(c, at, in);
        }
    }
}

/* A travel's run: where it begins and ends, and the heights of the beads there. */
typedef struct run {
    vec from, to;
    double before, after;
} run;

static void check_move(check *c, const move *m, const run *travel, double height) {
    int pieces = 1 + (int)(length(minus(m->to, m->from)) / c->step);
    for (int i = 1; i <= pieces; i++) {
        double t = (double)i / pieces, angle[2];
        if (length(minus(mix(m->from, m->to, t), c->looked)) < c->step / 2)
            continue;
        c->looked = mix(m->from, m->to, t);
        for (int k = 0; k < 2; k++)
            angle[k] = m->before[k] + t * (m->angle[k] - m->before[k]);
        pose at = {mix(m->from, m->to, t), machine_turn(&c->machine, angle), height, m->line};
        if (travel) {
            at.may = 0;
            if (length(minus(at.tip, travel->from)) <= c->tool.tip)
                at.may = travel->before;
            if (length(minus(at.tip, travel->to)) <= c->tool.tip)
                at.may = fmax(at.may, travel->after);
        }
        look(c, &at);
    }
}

static int is_bead(const move *m, const beads *b, int64_t next) {
    return next < b->count && m->volume > 0 && m->line == b->at[next].line &&
           length(minus(m->from, b->at[next].from)) < 1e-9;
}

static void check_all(check *c, const moves *m, const beads *b) {
    int64_t next = 0;
    run travel = {{0, 0, 0}, {0, 0, 0}, 0, 0};
    for (int64_t i = 0; i < m->count; i++) {
        if (is_bead(&m->at[i], b, next)) {
            check_move(c, &m->at[i], NULL, b->at[next].height);
            put_bead(&c->world, &b->at[next++]);
            continue;
        }
        if (i == 0 || is_bead(&m->at[i - 1], b, next - 1)) {
            int64_t last = i;
            while (last + 1 < m->count && !is_bead(&m->at[last + 1], b, next))
                last++;
            travel = (run){m->at[i].from, m->at[last].to, next > 0 ? b->at[next - 1].height : 0,
                           next < b->count ? b->at[next].height : 0};
        }
        /* after the last bead the end G-code goes where it likes */
        if (next > 0 && next < b->count)
            check_move(c, &m->at[i], &travel, 0);
    }
}

int main(int count, char **word) {
    const char *gcode = NULL, *stl = NULL, *text = NULL, *kinematics = "cartesian";
    double told = 0, base[3] = {0, 0, 0}, center[2] = {100, 100}, pivot[3] = {0, 0, 0};
    check c = {.tool = {0.8, 45, 6, {-10, -10, 10, 10}, 20, {-30, -30, 30, 30}, 40},
               .machine = {.filament = 1.75},
               .step = 0.5,
               .tolerance = 0.015,
               .deepest = {-0.05, -1, -1, -1}};
    const argument known[] = {{"", &gcode, 0, NULL},
                              {"", &stl, 0, NULL},
                              {"--field", &text, 0, NULL},
                              {"--kinematics", &kinematics, 0, NULL},
                              {"--told", NULL, 0, &told},
                              {"--base", NULL, 3, base},
                              {"--center", NULL, 2, center},
                              {"--pivot", NULL, 3, pivot},
                              {"--filament", NULL, 1, &c.machine.filament},
                              {"--step", NULL, 1, &c.step},
                              {"--tolerance", NULL, 1, &c.tolerance},
                              {"--tip", NULL, 1, &c.tool.tip},
                              {"--cone", NULL, 1, &c.tool.cone},
                              {"--cone-height", NULL, 1, &c.tool.cone_height},
                              {"--block", NULL, 4, c.tool.block},
                              {"--carriage-height", NULL, 1, &c.tool.carriage_height},
                              {"--carriage", NULL, 4, c.tool.carriage},
                              {"--gantry", NULL, 1, &c.tool.gantry}};
    if (!arguments_read(known, sizeof known / sizeof *known, count, word) || !stl ||
        !machine_named(&c.machine, kinematics)) {
        fprintf(stderr, "usage: collide PRINT.gcode PART.stl [options], see collide.c\n");
        return 2;
    }
    c.tool.rise = 1 / tan(c.tool.cone * PI / 180);
    c.machine.pivot = (vec){pivot[0], pivot[1], pivot[2]};
    heights *field = text ? heights_new(text, base) : NULL;
    part model;
    moves way;
    beads printed;
    if ((text && !field) || !part_read(&model, stl, center[0], center[1]) ||
        !moves_read(&way, gcode, &c.machine) ||
        !beads_make(&printed, &way, field, &model, told != 0))
        return 2;
    make_world(&c.world, &printed);
    check_all(&c, &way, &printed);
    for (int k = 0; k < PARTS; k++)
        printf("deepest_%s %.3f\n", k == HEATER ? "block" : part_name[k], c.deepest[k]);
    printf("samples %lld\ncollisions %d\n", (long long)c.samples, c.found);
    free_world(&c.world);
    free(way.at);
    beads_free(&printed);
    part_free(&model);
    heights_free(field);
    return c.found > 0;
}
