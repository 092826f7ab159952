/* How far apart two points of a layer may be for their normals to tell what is between them. */
#include <math.h>

#include "base/vector.h"
#include "chart/kind.h"

enum {
    CELLS_MOST = 192, /* along a side of the grid */
    LEVELS = 2,
    SPANS = 8,
    STRIDE = 2 /* not every point begins a line that is looked at */
};

/* Steps of the grid. Each is longer than the one before by so little that a wave as long as one of
 * them shows in the one before: its ends are alike, and tell nothing of what is between. */
static const int32_t span[SPANS] = {1, 2, 3, 4, 6, 8, 12, 16};

/* mm: of the grid. Waves shorter than a few times that can't be printed. */
static const double finest = 1;
/* A crease halfway is twice as far off as what bends evenly, with the same normals at the ends. */
static const double crease = 2.05;
/* mm: what is off by less doesn't matter at all. */
static const double negligible = 0.002;

typedef struct grid {
    int32_t columns, rows;
    double size;        /* mm */
    chart_point *point; /* [rows][columns]; without a volume: no layer is there */
} grid;

/* Row by row: some may lead beyond where the layer ends. Are there some that don't? */
static bool lift_grid(grid *g, iso_vec2 *flat, const chart *map, iso_vec2 low, double r) {
    int32_t there = 0;
    for (int32_t row = 0; row < g->rows; row++) {
        chart_point *point = g->point + (int64_t)row * g->columns;
        for (int32_t i = 0; i < g->columns; i++)
            flat[i] = (iso_vec2){low.x + i * g->size, low.y + row * g->size};
        if (chart_lift(point, map, flat, r, g->columns) == ISO_OK)
            there++;
        else
            for (int32_t i = 0; i < g->columns; i++)
                point[i].volume = 0;
    }
    return 4 * there >= g->rows;
}

/* Of three points in a line, the second at `share` of the way: do the outer ones tell how far it is
 * off? */
static bool are_told(const chart_point *a, const chart_point *between, const chart_point *b,
                     double share) {
    if (a->volume == 0 || between->volume == 0 || b->volume == 0)
        return true;
    iso_vec3 off = vec3_minus(between->at, vec3_between(a->at, b->at, share));
    return fabs(vec3_dot(off, between->normal)) <= crease * fabs(chart_rise(a, b)) + negligible;
}

/* All lines of that many steps: along both axes and both diagonals. */
static bool grid_tells(const grid *g, int32_t steps) {
    static const int32_t to[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    int32_t half = steps / 2;
    for (int32_t row = 0; row < g->rows; row += STRIDE)
        for (int32_t i = 0; i < g->columns; i += STRIDE)
            for (int k = 0; k < 4; k++) {
                int32_t x = i + steps * to[k][0], y = row + steps * to[k][1];
                if (x < 0 || x >= g->columns || y >= g->rows)
                    continue;
                const chart_point *a = g->point + (int64_t)row * g->columns + i;
                int64_t step = to[k][1] * (int64_t)g->columns + to[k][0];
                if (!are_told(a, a + half * step, a + steps * step, (double)half / steps))
                    return false;
            }
    return true;
}

iso_status graph_reach(double *reach, const chart *map, const iso_vec3 box[2],
                       const double range[2]) {
    double width = box[1].x - box[0].x, depth = box[1].y - box[0].y;
    grid g = {.size = fmax(finest, fmax(width, depth) / CELLS_MOST)};
    iso_vec2 flat[CELLS_MOST + 2];
    int spans = SPANS - 1;
    g.columns = (int32_t)(width / g.size) + 1;
    g.rows = (int32_t)(depth / g.size) + 1;
    ISO_TRY(ISO_ALLOCATE(g.point, (int64_t)g.columns * g.rows));
    for (int k = 0; k < LEVELS && spans > 0; k++) {
        double r = range[0] + (range[1] - range[0]) * (k + 0.5) / LEVELS;
        int told = 0;
        bool there = lift_grid(&g, flat, map, (iso_vec2){box[0].x, box[0].y}, r);
        while (there && told < spans && grid_tells(&g, span[told + 1]))
            told++;
        spans = told;
    }
    iso_release(g.point);
    *reach = finest * span[spans]; /* of a coarser grid less than it says */
    return ISO_OK;
}
