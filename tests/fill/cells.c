#include "fill/cells.h"

#include <stdlib.h>
#include <string.h>

#include "fill/shapes.h"

enum { SIDE = CELLS + 2, LOOP_MAX = 4 * SIDE * SIDE };

cells cells_random(unsigned seed, int percent) {
    cells grid;
    memset(&grid, 0, sizeof grid);
    for (int y = 1; y <= CELLS; y++)
        for (int x = 1; x <= CELLS; x++) {
            seed = seed * 1664525u + 1013904223u;
            grid.full[y][x] = (int)((seed >> 16) % 100) < percent;
        }
    return grid;
}

/* Label what hangs together: full cells over their sides, empty ones over corners too. */
static void label_from(int label[SIDE][SIDE], const cells *grid, int y, int x, int value) {
    label[y][x] = value;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            int v = y + dy, u = x + dx;
            if (v < 0 || v >= SIDE || u < 0 || u >= SIDE || label[v][u] ||
                grid->full[v][u] != grid->full[y][x] || (grid->full[y][x] && dx && dy))
                continue;
            label_from(label, grid, v, u, value);
        }
}

typedef struct outline {
    int count, x[LOOP_MAX], y[LOOP_MAX]; /* corners */
    int twice, left, right;              /* area; labels of the cells beside it */
} outline;

/* The cell left of the edge from corner (x, y) in direction k: corners (x, y) are the lower left
 * ones of cells, directions east, north, west, south. */
static const int step_x[4] = {1, 0, -1, 0}, step_y[4] = {0, 1, 0, -1};
static const int left_x[4] = {0, -1, -1, 0}, left_y[4] = {0, 0, -1, -1};

static int is_edge(const cells *grid, int x, int y, int k) {
    int r = (k + 3) % 4; /* the cell on the right is the one left of the direction turned right */
    if (x + left_x[k] < 0 || y + left_y[k] < 0 || x + left_x[r] < 0 || y + left_y[r] < 0 ||
        x >= SIDE || y >= SIDE)
        return 0;
    return grid->full[y + left_y[k]][x + left_x[k]] && !grid->full[y + left_y[r]][x + left_x[r]];
}

static void trace(outline *loop, char used[SIDE + 1][SIDE + 1][4], const cells *grid, int x, int y,
                  int k) {
    loop->count = loop->twice = 0;
    do {
        used[y][x][k] = 1;
        loop->x[loop->count] = x;
        loop->y[loop->count++] = y;
        loop->twice += x * step_y[k] - y * step_x[k];
        x += step_x[k];
        y += step_y[k];
        int turn = (k + 1) % 4; /* left first: full cells don't join over corners */
        while (!is_edge(grid, x, y, turn))
            turn = (turn + 3) % 4;
        k = turn;
    } while (!used[y][x][k]);
}

static int by_size(const void *a, const void *b) {
    int s = abs((*(outline *const *)a)->twice), t = abs((*(outline *const *)b)->twice);
    return (s < t) - (s > t);
}

void cells_region(iso_region *region, const cells *grid, int a, int b) {
    int label[SIDE][SIDE] = {{0}}, labels = 0, count = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (!label[y][x])
                label_from(label, grid, y, x, ++labels);
    static char used[SIDE + 1][SIDE + 1][4];
    outline *found[SIDE * SIDE];
    memset(used, 0, sizeof used);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int k = 0; k < 4; k++)
                if (!used[y][x][k] && is_edge(grid, x, y, k)) {
                    int r = (k + 3) % 4;
                    found[count] = malloc(sizeof(outline));
                    trace(found[count], used, grid, x, y, k);
                    found[count]->left = label[y + left_y[k]][x + left_x[k]];
                    found[count++]->right = label[y + left_y[r]][x + left_x[r]];
                }
    qsort(found, (size_t)count, sizeof *found, by_size); /* what lies around comes first */
    for (int i = 0; i < count; i++) {
        iso_point point[LOOP_MAX];
        int parent = -1;
        for (int j = 0; j < i; j++) /* a hole's full cells, an island's empty ones */
            if (found[i]->twice < 0 ? found[j]->twice > 0 && found[j]->left == found[i]->left
                                    : found[j]->twice < 0 && found[j]->right == found[i]->right)
                parent = j;
        for (int k = 0; k < found[i]->count; k++) {
            int x = found[i]->x[k] - SIDE / 2, y = found[i]->y[k] - SIDE / 2;
            point[k] = (iso_point){a * x - b * y, b * x + a * y};
        }
        add_points(region, point, found[i]->count, parent);
    }
    for (int i = 0; i < count; i++)
        free(found[i]);
}
