#include "clearance/ground.h"

#include <string.h>

#include "base/memory.h"

/* Cells are small enough for a plane to lie close to a curved layer, and large enough that a bead
 * touches few. */
#define CELL 0.8   /* mm */
#define ROUND 1e-3 /* mm, more than what single precision is off */
#define SLOPE_STEPS 256.0
#define SLOPE_MOST 8.0 /* steeper planes are worth nothing */

/* A tile has 32 x 32 cells, the directory 128 x 128 tiles: all that ISO_COORDINATE_MAX allows. */
enum { TILE_LEVEL = 5, TILE = 1 << TILE_LEVEL, TOP_LEVEL = 12, SIZE = 1 << TOP_LEVEL };
enum { TILES = SIZE / TILE };
#define ORIGIN (-CELL * SIZE / 2)
#define NOWHERE (-1e30f)

typedef struct ground_cell {
    float top;        /* mm; NOWHERE: empty */
    float plane;      /* mm, at the cell's middle */
    int16_t slope[2]; /* of the plane, in 1 / SLOPE_STEPS */
} ground_cell;

/* Level k of a tile has (TILE >> k)^2 heights. */
typedef struct ground_tile {
    ground_cell cell[TILE * TILE];
    float top[TILE * TILE / 3]; /* levels 1 to TILE_LEVEL - 1 */
} ground_tile;

/* A part of the tool: lower than `height` is nothing over the box around the tip. */
typedef struct box_part {
    iso_vec2 low, high;
    double height; /* infinite: there is none */
} box_part;

struct ground_map {
    const tool_body *tool;
    double radius, inverse, cone_height, cone_radius; /* of the nozzle, shrunk and not raised */
    double shrink;
    box_part part[3]; /* block, carriage, gantry */
    ground_tile *tiles[TILES * TILES];
    float top[TILES * TILES * 4 / 3 + 1]; /* levels TILE_LEVEL to TOP_LEVEL */
    int32_t first[TOP_LEVEL + 1];         /* of each level, in its array; level 0 has none */
    int64_t tile_count;
    int32_t low[2], high[2]; /* tiles there are; low > high: none */
};

static box_part part_of(const tool_body *tool, tool_part part) {
    tool_shape shape;
    box_part none = {{0, 0}, {0, 0}, INFINITY};
    if (!tool_shape_of(&shape, tool, part, (double[]){0, CLEARANCE_TOLERANCE}, 1e6))
        return none;
    return (box_part){shape.box_low, shape.box_high, shape.low};
}

iso_status ground_new(ground_map **made, const tool_body *tool) {
    ground_map *ground;
    ISO_TRY(ISO_ALLOCATE(ground, 1));
    memset(ground, 0, sizeof *ground);
    ground->tool = tool;
    ground->shrink = CLEARANCE_TOLERANCE;
    tool_shape nozzle;
    if (tool_shape_of(&nozzle, tool, TOOL_NOZZLE, (double[]){0, CLEARANCE_TOLERANCE}, 0)) {
        ground->radius = tool->model.tip_diameter / 2 - CLEARANCE_TOLERANCE * tool->secant;
        ground->inverse = 1 / tool->tangent;
        ground->cone_height = nozzle.high;
        ground->cone_radius = nozzle.radius_high;
    } else {
        ground->cone_radius = -1;
    }
    for (int i = 0; i < 3; i++)
        ground->part[i] = part_of(tool, (tool_part)(TOOL_BLOCK + i));
    for (size_t i = 0; i < sizeof ground->top / sizeof *ground->top; i++)
        ground->top[i] = NOWHERE;
    for (int k = 1, first = 0; k <= TOP_LEVEL; k++) {
        if (k == TILE_LEVEL)
            first = 0;
        ground->first[k] = first;
        first += k < TILE_LEVEL ? (TILE >> k) * (TILE >> k) : (SIZE >> k) * (SIZE >> k);
    }
    ground->low[0] = ground->low[1] = TILES;
    ground->high[0] = ground->high[1] = -1;
    *made = ground;
    return ISO_OK;
}

void ground_free(ground_map *ground) {
    for (int i = 0; ground && i < TILES * TILES; i++)
        iso_release(ground->tiles[i]);
    iso_release(ground);
}

int64_t ground_bytes(const ground_map *ground) {
    return (int64_t)sizeof *ground + ground->tile_count * (int64_t)sizeof(ground_tile);
}

/* ---- beads come in ---- */

static iso_status tile_at(ground_tile **found, ground_map *ground, int32_t x, int32_t y) {
    ground_tile **there = &ground->tiles[y * TILES + x];
    if (!*there) {
        ISO_TRY(ISO_ALLOCATE(*there, 1));
        for (int i = 0; i < TILE * TILE; i++)
            (*there)->cell[i] = (ground_cell){NOWHERE, 0, {0, 0}};
        for (int i = 0; i < TILE * TILE / 3; i++)
            (*there)->top[i] = NOWHERE;
        ground->tile_count++;
        const int32_t at[2] = {x, y};
        for (int k = 0; k < 2; k++) {
            ground->low[k] = at[k] < ground->low[k] ? at[k] : ground->low[k];
            ground->high[k] = at[k] > ground->high[k] ? at[k] : ground->high[k];
        }
    }
    *found = *there;
    return ISO_OK;
}

/* The heights of all that the cell is in. */
static void raise_top(ground_map *ground, ground_tile *tile, int32_t x, int32_t y, float top) {
    int32_t u = x & (TILE - 1), v = y & (TILE - 1), first = 0;
    for (int k = 1; k < TILE_LEVEL; k++) {
        float *there = tile->top + first + (v >> k) * (TILE >> k) + (u >> k);
        if (*there >= top)
            return;
        *there = top;
        first += (TILE >> k) * (TILE >> k);
    }
    first = 0;
    for (int k = TILE_LEVEL; k <= TOP_LEVEL; k++) {
        float *there = ground->top + first + (y >> k) * (SIZE >> k) + (x >> k);
        if (*there >= top)
            return;
        *there = top;
        first += (SIZE >> k) * (SIZE >> k);
    }
}

/* A bead as the ground sees it: its tip's line, and how far it is above that line along z, or above
 * planes of a slope through it. */
typedef struct ground_print {
    iso_vec3 from, way;
    double around; /* mm that it is wide to either side */
    double above;
    int16_t slope[2];
    double gx, gy, above_plane;
    iso_vec3 normal[2];
    double disc, ball;
} ground_print;

/* How far the bead is above a plane through its tip's line, at most, times the plane's steepness.
 */
static double above_plane(const ground_print *print, double gx, double gy) {
    iso_vec3 up = vec3(-gx, -gy, 1);
    double most = 0, size = vec3_dot(up, up), length = sqrt(size);
    for (int end = 0; end < 2; end++) {
        double along = vec3_dot(up, print->normal[end]);
        double above =
            print->disc * sqrt(most_of(0, size - along * along)) + print->ball * (length - along);
        most = most_of(most, above);
    }
    return most;
}

static int16_t slope_of(double slope) {
    double steps = slope * SLOPE_STEPS;
    return (int16_t)(steps < 0 ? steps - 0.5 : steps + 0.5);
}

static ground_print print_of(const clearance_move *bead) {
    double across = least_of(bead->width, bead->height);
    ground_print print = {.from = bead->from,
                          .way = vec3_minus(bead->to, bead->from),
                          .normal = {bead->from_normal, bead->to_normal},
                          .disc = (bead->width - across) / 2,
                          .ball = across / 2};
    iso_vec3 normal = vec3_plus(bead->from_normal, bead->to_normal);
    if (normal.z > 0 && fabs(normal.x) < SLOPE_MOST * normal.z &&
        fabs(normal.y) < SLOPE_MOST * normal.z) {
        print.slope[0] = slope_of(-normal.x / normal.z);
        print.slope[1] = slope_of(-normal.y / normal.z);
    }
    print.gx = print.slope[0] / SLOPE_STEPS;
    print.gy = print.slope[1] / SLOPE_STEPS;
    print.above = above_plane(&print, 0, 0);
    print.above_plane = above_plane(&print, print.gx, print.gy);
    /* Seen from above a bead on a slope is shifted, by its ball's radius at most. */
    double steep = least_of(fabs(print.normal[0].z), fabs(print.normal[1].z));
    print.around = print.disc + print.ball + (steep < 1 ? print.ball : 0);
    return print;
}

/* The bead's piece between t[0] and t[1] goes through a cell. */
static void enter(ground_cell *cell, const ground_print *print, const double t[2],
                  const double middle[2]) {
    double z[2], x[2], y[2];
    for (int i = 0; i < 2; i++) {
        z[i] = print->from.z + t[i] * print->way.z;
        x[i] = print->from.x + t[i] * print->way.x - middle[0];
        y[i] = print->from.y + t[i] * print->way.y - middle[1];
    }
    double top = most_of(z[0], z[1]) + print->above + ROUND;
    double plane = most_of(z[0] - print->gx * x[0] - print->gy * y[0],
                           z[1] - print->gx * x[1] - print->gy * y[1]) +
                   print->above_plane + ROUND;
    if (cell->top == NOWHERE) {
        *cell = (struct ground_cell){(float)top, (float)plane, {print->slope[0], print->slope[1]}};
        return;
    }
    cell->top = fmaxf(cell->top, (float)top);
    if (cell->slope[0] == print->slope[0] && cell->slope[1] == print->slope[1]) {
        cell->plane = fmaxf(cell->plane, (float)plane);
        return;
    }
    /* Either slope will do: the one of the lower plane. */
    double gx = cell->slope[0] / SLOPE_STEPS, gy = cell->slope[1] / SLOPE_STEPS;
    double turned =
        cell->plane + (fabs(gx - print->gx) + fabs(gy - print->gy)) * (CELL / 2) + ROUND;
    double kept = most_of(z[0] - gx * x[0] - gy * y[0], z[1] - gx * x[1] - gy * y[1]) +
                  above_plane(print, gx, gy) + ROUND;
    turned = most_of(turned, plane);
    kept = most_of(kept, cell->plane);
    if (kept <= turned) {
        cell->plane = (float)kept;
    } else {
        cell->plane = (float)turned;
        cell->slope[0] = print->slope[0];
        cell->slope[1] = print->slope[1];
    }
}

/* Where from + t way is between low and high, within t. */
static bool clip(double t[2], double from, double way, double low, double high) {
    if (way == 0)
        return from >= low && from <= high;
    double a = (low - from) / way, b = (high - from) / way;
    t[0] = most_of(t[0], least_of(a, b));
    t[1] = least_of(t[1], most_of(a, b));
    return t[0] <= t[1];
}

static int32_t cell_at(double mm) {
    double at = (mm - ORIGIN) / CELL;
    return at < 0 ? 0 : at >= SIZE ? SIZE - 1 : (int32_t)at;
}

static iso_status enter_row(ground_map *ground, const ground_print *print, int32_t y,
                            const double row[2]) {
    double x[2] = {print->from.x + row[0] * print->way.x, print->from.x + row[1] * print->way.x};
    int32_t last = cell_at(most_of(x[0], x[1]) + print->around);
    ground_tile *tile = NULL;
    for (int32_t i = cell_at(least_of(x[0], x[1]) - print->around), in = -1; i <= last; i++) {
        double t[2] = {row[0], row[1]}, left = ORIGIN + CELL * i;
        if (!clip(t, print->from.x, print->way.x, left - print->around,
                  left + CELL + print->around))
            continue;
        if (i >> TILE_LEVEL != in) {
            in = i >> TILE_LEVEL;
            ISO_TRY(tile_at(&tile, ground, in, y >> TILE_LEVEL));
        }
        ground_cell *cell = tile->cell + (y & (TILE - 1)) * TILE + (i & (TILE - 1));
        enter(cell, print, t, (double[]){left + CELL / 2, ORIGIN + CELL * y + CELL / 2});
        raise_top(ground, tile, i, y, cell->top);
    }
    return ISO_OK;
}

iso_status ground_add(ground_map *ground, const clearance_move *bead) {
    ground_print print = print_of(bead);
    int32_t last = cell_at(most_of(bead->from.y, bead->to.y) + print.around);
    for (int32_t y = cell_at(least_of(bead->from.y, bead->to.y) - print.around); y <= last; y++) {
        double t[2] = {0, 1}, low = ORIGIN + CELL * y;
        if (clip(t, print.from.y, print.way.y, low - print.around, low + CELL + print.around))
            ISO_TRY(enter_row(ground, &print, y, t));
    }
    return ISO_OK;
}

/* ---- questions ---- */

/* The box of a piece of the tip's way. */
typedef struct ground_reach {
    double low[2], high[2], z, raise;
} ground_reach;

/* How high the nozzle is above its tip's lowest place, at a distance of its axis. */
static double cone_height(const ground_map *ground, double square, double raise) {
    if (square > ground->cone_radius * ground->cone_radius)
        return INFINITY;
    double distance = sqrt(square);
    return raise + most_of(ground->shrink, (distance - ground->radius) * ground->inverse);
}

static double beyond(double low, double high, double from, double to) {
    return most_of(0, most_of(from - high, low - to));
}

/* Parts, but for the nozzle, that something as high as `top` in the square may reach. */
static int boxes_over(const ground_map *ground, const ground_reach *reach, const double square[4],
                      double top) {
    int parts = 0;
    for (int i = 0; i < 3; i++) {
        const box_part *part = &ground->part[i];
        if (top > reach->z + part->height && square[0] < reach->high[0] + part->high.x &&
            square[2] > reach->low[0] + part->low.x && square[1] < reach->high[1] + part->high.y &&
            square[3] > reach->low[1] + part->low.y)
            parts |= 1 << (TOOL_BLOCK + i);
    }
    return parts;
}

static bool under_nozzle(const ground_map *ground, const ground_reach *reach,
                         const double square[4], double top) {
    if (top <= reach->z + reach->raise)
        return true;
    double x = beyond(square[0], square[2], reach->low[0], reach->high[0]);
    double y = beyond(square[1], square[3], reach->low[1], reach->high[1]);
    return top <= reach->z + cone_height(ground, x * x + y * y, reach->raise);
}

/* Is the nozzle above the cell's plane? Wherever the plane goes: its tip and its upper end are. Or
 * in the cell: there a plane is, that touches the cone where it faces the cell. Planes above planes
 * are so everywhere if at the corners. */
static bool above_cell(const ground_map *ground, const ground_step *step, const ground_cell *cell,
                       const double middle[2]) {
    double gx = cell->slope[0] / SLOPE_STEPS, gy = cell->slope[1] / SLOPE_STEPS;
    double steep = sqrt(gx * gx + gy * gy);
    double radius = ground->radius + ground->shrink * ground->tool->tangent;
    double least = least_of(step->raise + ground->shrink - steep * most_of(0, radius),
                            ground->cone_height - steep * ground->cone_radius);
    double x[2] = {middle[0] - step->from.x, middle[0] - step->to.x};
    double y[2] = {middle[1] - step->from.y, middle[1] - step->to.y};
    double over[2] = {cell->plane - step->from.z, cell->plane - step->to.z}; /* the tip */
    if (over[0] - gx * x[0] - gy * y[0] <= least && over[1] - gx * x[1] - gy * y[1] <= least)
        return true;
    double wx = x[0] + x[1], wy = y[0] + y[1], length = sqrt(wx * wx + wy * wy);
    if (length < CELL)
        return false;
    wx *= ground->inverse / length;
    wy *= ground->inverse / length;
    double corner = (fabs(gx - wx) + fabs(gy - wy)) * (CELL / 2) + ground->radius * ground->inverse;
    for (int end = 0; end < 2; end++)
        if (over[end] + corner > step->raise + wx * x[end] + wy * y[end])
            return false;
    return true;
}

static ground_reach reach_of(const ground_step *step, int count) {
    ground_reach reach = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, INFINITY, INFINITY};
    for (int i = 0; i < count; i++)
        for (int end = 0; end < 2; end++) {
            iso_vec3 tip = end ? step[i].to : step[i].from;
            const double at[2] = {tip.x, tip.y};
            for (int k = 0; k < 2; k++) {
                reach.low[k] = least_of(reach.low[k], at[k]);
                reach.high[k] = most_of(reach.high[k], at[k]);
            }
            reach.z = least_of(reach.z, tip.z);
            reach.raise = least_of(reach.raise, step[i].raise);
        }
    return reach;
}

typedef struct ground_question {
    ground_map *ground;
    const ground_step *step;
    int count;
    ground_reach all;
    ground_reach one[GROUND_STEPS];
    ground_doubt *doubt;
} ground_question;

static void ask_cell(ground_question *question, const ground_cell *cell, const double square[4]) {
    const ground_map *ground = question->ground;
    const double middle[2] = {square[0] + CELL / 2, square[1] + CELL / 2};
    for (int i = 0; i < question->count; i++) {
        const ground_reach *reach = &question->one[i];
        int parts = boxes_over(ground, reach, square, cell->top);
        if (!under_nozzle(ground, reach, square, cell->top) &&
            !above_cell(ground, &question->step[i], cell, middle))
            parts |= 1 << TOOL_NOZZLE;
        if (!parts)
            continue;
        const ground_doubt more = {
            parts, {square[0], square[1], -INFINITY}, {square[2], square[3], INFINITY}};
        ground_doubt_add(&question->doubt[i], &more);
    }
}

/* A square of level `level` and all that is in it. */
static void ask(ground_question *question, int level, int32_t x, int32_t y,
                const ground_tile *tile) {
    ground_map *ground = question->ground;
    const ground_cell *cell = NULL;
    float top;
    if (level >= TILE_LEVEL) {
        top = ground->top[ground->first[level] + y * (SIZE >> level) + x];
    } else {
        int32_t mask = (TILE >> level) - 1, at = (y & mask) * (TILE >> level) + (x & mask);
        cell = tile->cell + at;
        top = level ? tile->top[ground->first[level] + at] : cell->top;
    }
    if (top == NOWHERE)
        return;
    double size = CELL * (1 << level), left = ORIGIN + size * x, lower = ORIGIN + size * y;
    const double square[4] = {left, lower, left + size, lower + size};
    if (under_nozzle(ground, &question->all, square, top) &&
        !boxes_over(ground, &question->all, square, top))
        return;
    if (level == 0) {
        ask_cell(question, cell, square);
        return;
    }
    if (level == TILE_LEVEL)
        tile = ground->tiles[y * TILES + x];
    for (int i = 0; i < 4; i++)
        ask(question, level - 1, 2 * x + i % 2, 2 * y + i / 2, tile);
}

void ground_check(ground_doubt *doubt, ground_map *ground, const ground_step *step, int count) {
    ground_question question = {.ground = ground, .step = step, .count = count, .doubt = doubt};
    question.all = reach_of(step, count);
    for (int i = 0; i < count; i++) {
        question.one[i] = reach_of(step + i, 1);
        doubt[i] = ground_doubt_none();
    }
    /* From the level where all there is lies in 2 x 2 squares. */
    int shift = 0;
    const int32_t *low = ground->low, *high = ground->high;
    while ((high[0] >> shift) - (low[0] >> shift) > 1 || (high[1] >> shift) - (low[1] >> shift) > 1)
        shift++;
    for (int32_t y = low[1] >> shift; y <= high[1] >> shift; y++)
        for (int32_t x = low[0] >> shift; x <= high[0] >> shift; x++)
            ask(&question, TILE_LEVEL + shift, x, y, NULL);
}
