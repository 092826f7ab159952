/* isoslice-sample FILE: a part worth slicing, as a binary STL.
 *
 * A twisted star vase: lobed walls with diamond windows, a floor with six drain holes, and a closed
 * ring-shaped cavity inside the floor. The mesh is closed by construction: outer and inner wall are
 * the same grid of columns and rows, a window is the same triangles left out of both, and what is
 * left open is bridged corner to corner. */
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum {
    LOBES = 9,
    COLUMNS = 24 * LOBES, /* around */
    ROWS = 40,            /* up */
    FLOOR = 6,            /* the row of the inner floor */
    WINDOW = 7,           /* half a window, in columns and in rows */
    LOWER_WINDOWS = 17,   /* the row of their middles */
    UPPER_WINDOWS = 29,
    WEDGES = 6, /* of floor and bottom, each with a drain hole */
    ARC = COLUMNS / WEDGES,
    SPOKE = 12, /* steps from the centre to the wall */
    RIM = ARC + 2 * SPOKE,
    RING = 180, /* steps of the cavity, around and */
    TUBE = 24,  /* across */
    MAX_VERTICES = 60000,
    MAX_TRIANGLES = 60000
};

static const double HEIGHT = 50, TWIST = 1.1, HOLE_AT = 11, HOLE = 3.2, CAVITY_AT = 17.2,
                    CAVITY = 1.7;

static float vertex[MAX_VERTICES][3];
static int32_t triangle[MAX_TRIANGLES][3];
static int32_t vertices, triangles;

static int32_t add_vertex(double x, double y, double z) {
    if (vertices == MAX_VERTICES)
        abort();
    double at[3] = {x, y, z};
    for (int k = 0; k < 3; k++) /* to 100 nm: whatever sin and cos do in the last bit */
        vertex[vertices][k] = (float)(nearbyint(at[k] * 1e4) / 1e4);
    return vertices++;
}

static void add_triangle(int32_t a, int32_t b, int32_t c) {
    if (triangles == MAX_TRIANGLES)
        abort();
    memcpy(triangle[triangles++], (int32_t[3]){a, b, c}, sizeof triangle[0]);
}

/* a b c d counter-clockwise as seen from outside */
static void add_quad(int32_t a, int32_t b, int32_t c, int32_t d) {
    add_triangle(a, b, c);
    add_triangle(a, c, d);
}

static double row_z(int row) {
    return HEIGHT * row / ROWS;
}

/* 0 up to the inner floor, so that the drain holes are straight, then smoothly to 1 */
static double rise(int row) {
    double t = row <= FLOOR ? 0 : (double)(row - FLOOR) / (ROWS - FLOOR);
    return t * t * (3 - 2 * t);
}

static int32_t add_wall_vertex(int column, int row, bool inner) {
    double t = rise(row), turn = 2 * PI * column / COLUMNS;
    double body = 21.5 + 3.2 * sin(PI * row / ROWS) - 1.5 * t;
    double lobe = cos(LOBES * turn);
    double radius = body + (0.9 + 1.2 * t) * lobe;
    if (inner)
        radius = body - 3.4 + (0.5 + 1.1 * t) * lobe;
    double angle = turn + TWIST * t;
    return add_vertex(radius * cos(angle), radius * sin(angle), row_z(row));
}

static int32_t wall[2][ROWS + 1][COLUMNS]; /* outer, inner */

/* Windows are diamonds of half a width WINDOW around the middles of two staggered bands. */
static bool in_window(double column, double row, double *down, double *across) {
    int band = row > (LOWER_WINDOWS + UPPER_WINDOWS) / 2.0;
    double step = (double)COLUMNS / LOBES, first = band ? 0 : step / 2;
    double u = fmod(column - first + COLUMNS + step / 2, step) - step / 2;
    double v = row - (band ? UPPER_WINDOWS : LOWER_WINDOWS);
    *across = u;
    *down = v;
    return fabs(u) + fabs(v) < WINDOW;
}

/* The triangles that a cell of the grid keeps, as corners 0 1 2 3 (counter-clockwise from outside).
 * The diagonal runs along the edge of the window that passes through the cell. */
static int cell_triangles(int column, int row, int corner[2][3]) {
    static const int rising[2][3] = {{0, 1, 2}, {0, 2, 3}}, falling[2][3] = {{0, 1, 3}, {1, 2, 3}};
    static const double x[4] = {0, 1, 1, 0}, y[4] = {0, 0, 1, 1};
    double u, v;
    (void)in_window(column + 0.5, row + 0.5, &v, &u);
    int count = 0;
    for (int k = 0; k < 2; k++) {
        const int *t = u * v < 0 ? rising[k] : falling[k];
        double middle_x = column + (x[t[0]] + x[t[1]] + x[t[2]]) / 3;
        double middle_y = row + (y[t[0]] + y[t[1]] + y[t[2]]) / 3;
        if (!in_window(middle_x, middle_y, &v, &u))
            memcpy(corner[count++], t, 3 * sizeof *t);
    }
    return count;
}

static void cell_corners(int32_t corner[4], int side, int column, int row) {
    int next = (column + 1) % COLUMNS;
    corner[0] = wall[side][row][column];
    corner[1] = wall[side][row][next];
    corner[2] = wall[side][row + 1][next];
    corner[3] = wall[side][row + 1][column];
}

/* Does the wall have a triangle with the edge from a to b, among those of the cells around? */
static bool has_edge(int32_t a, int32_t b, int column, int row) {
    for (int r = row - 1; r <= row + 1; r++)
        for (int c = column - 1; c <= column + 1; c++) {
            int32_t at[4];
            int kept[2][3];
            if (r < 0 || r >= ROWS)
                continue;
            int around = (c + COLUMNS) % COLUMNS;
            cell_corners(at, 0, around, r);
            int count = cell_triangles(around, r, kept);
            for (int k = 0; k < count; k++)
                for (int e = 0; e < 3; e++)
                    if (at[kept[k][e]] == a && at[kept[k][(e + 1) % 3]] == b)
                        return true;
        }
    return false;
}

static void add_cell(int column, int row) {
    int32_t outer[4], inner[4];
    int kept[2][3];
    int count = cell_triangles(column, row, kept);
    cell_corners(outer, 0, column, row);
    if (row >= FLOOR)
        cell_corners(inner, 1, column, row);
    for (int k = 0; k < count; k++) {
        const int *t = kept[k];
        add_triangle(outer[t[0]], outer[t[1]], outer[t[2]]);
        if (row < FLOOR)
            continue;
        add_triangle(inner[t[0]], inner[t[2]], inner[t[1]]);
        for (int e = 0; e < 3; e++) {
            int a = t[e], b = t[(e + 1) % 3];
            bool end = (row == ROWS - 1 && a >= 2 && b >= 2) || (row == FLOOR && a <= 1 && b <= 1);
            if (!end && !has_edge(outer[b], outer[a], column, row))
                add_quad(outer[b], outer[a], inner[a], inner[b]);
        }
    }
}

static void add_walls(void) {
    for (int row = 0; row <= ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            wall[0][row][column] = add_wall_vertex(column, row, false);
            if (row >= FLOOR)
                wall[1][row][column] = add_wall_vertex(column, row, true);
        }
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++)
            add_cell(column, row);
    for (int column = 0; column < COLUMNS; column++) { /* the rim on top */
        int next = (column + 1) % COLUMNS;
        add_quad(wall[0][ROWS][column], wall[0][ROWS][next], wall[1][ROWS][next],
                 wall[1][ROWS][column]);
    }
}

/* Bottom or floor: wedges from the centre to the wall's ring. A wedge is a strip of quads between
 * its edge and the hole; the edge's points pull the hole's points towards them. */
typedef struct disc {
    const int32_t *ring;
    double z;
    int32_t centre, spoke[WEDGES][SPOKE], hole[WEDGES][RIM];
} disc;

static void add_disc_vertices(disc *d) {
    d->centre = add_vertex(0, 0, d->z);
    for (int w = 0; w < WEDGES; w++)
        for (int i = 1; i < SPOKE; i++) {
            const float *end = vertex[d->ring[w * ARC]];
            d->spoke[w][i] =
                add_vertex((double)end[0] * i / SPOKE, (double)end[1] * i / SPOKE, d->z);
        }
}

static void wedge_rim(int32_t rim[RIM], const disc *d, int wedge) {
    int next = (wedge + 1) % WEDGES, count = 0;
    rim[count++] = d->centre;
    for (int i = 1; i < SPOKE; i++)
        rim[count++] = d->spoke[wedge][i];
    for (int i = 0; i <= ARC; i++)
        rim[count++] = d->ring[(wedge * ARC + i) % COLUMNS];
    for (int i = SPOKE - 1; i >= 1; i--)
        rim[count++] = d->spoke[next][i];
}

static void add_hole_vertices(disc *d, int wedge, const int32_t rim[RIM]) {
    double angle = 2 * PI * (wedge + 0.5) / WEDGES;
    double x = HOLE_AT * cos(angle), y = HOLE_AT * sin(angle);
    for (int i = 0; i < RIM; i++) {
        const float *at = vertex[rim[i]];
        double dx = at[0] - x, dy = at[1] - y, pull = HOLE / sqrt(dx * dx + dy * dy);
        d->hole[wedge][i] = add_vertex(x + dx * pull, y + dy * pull, d->z);
    }
}

static void add_floor(void) {
    static disc bottom, top;
    bottom = (disc){.ring = wall[0][0], .z = 0};
    top = (disc){.ring = wall[1][FLOOR], .z = row_z(FLOOR)};
    add_disc_vertices(&bottom);
    add_disc_vertices(&top);
    for (int w = 0; w < WEDGES; w++) {
        int32_t low[RIM], high[RIM];
        wedge_rim(low, &bottom, w);
        wedge_rim(high, &top, w);
        add_hole_vertices(&bottom, w, low);
        add_hole_vertices(&top, w, high);
        for (int i = 0, j = 1; i < RIM; i++, j = (i + 1) % RIM) {
            add_quad(low[j], low[i], bottom.hole[w][i], bottom.hole[w][j]);
            add_quad(high[i], high[j], top.hole[w][j], top.hole[w][i]);
            add_quad(bottom.hole[w][j], bottom.hole[w][i], top.hole[w][i], top.hole[w][j]);
        }
    }
}

/* A closed shell of its own, facing inwards. */
static void add_cavity(void) {
    static int32_t at[RING][TUBE];
    double middle = row_z(FLOOR) / 2;
    for (int i = 0; i < RING; i++)
        for (int j = 0; j < TUBE; j++) {
            double u = 2 * PI * i / RING, v = 2 * PI * j / TUBE;
            double radius = CAVITY_AT + CAVITY * cos(v);
            at[i][j] = add_vertex(radius * cos(u), radius * sin(u), middle + CAVITY * sin(v));
        }
    for (int i = 0; i < RING; i++)
        for (int j = 0; j < TUBE; j++) {
            int k = (i + 1) % RING, l = (j + 1) % TUBE;
            add_quad(at[i][j], at[i][l], at[k][l], at[k][j]);
        }
}

static void put32(unsigned char *at, uint32_t value) {
    for (int k = 0; k < 4; k++)
        at[k] = (unsigned char)(value >> (8 * k));
}

static bool write_stl(const char *path) {
    FILE *file = fopen(path, "wb");
    if (!file)
        return false;
    unsigned char record[84] = "isoslice sample: a twisted star vase";
    put32(record + 80, (uint32_t)triangles);
    bool good = fwrite(record, 84, 1, file) == 1;
    for (int32_t i = 0; good && i < triangles; i++) {
        memset(record, 0, 50);
        for (int k = 0; k < 9; k++) {
            uint32_t bits;
            memcpy(&bits, &vertex[triangle[i][k / 3]][k % 3], 4);
            put32(record + 12 + 4 * k, bits);
        }
        good = fwrite(record, 50, 1, file) == 1;
    }
    return fclose(file) == 0 && good;
}

int main(int count, char **word) {
    if (count != 2) {
        fprintf(stderr, "usage: isoslice-sample FILE.stl\n");
        return 2;
    }
    add_walls();
    add_floor();
    add_cavity();
    if (!write_stl(word[1])) {
        fprintf(stderr, "isoslice-sample: %s: %s\n", word[1], strerror(errno));
        return 7;
    }
    printf("%s: a star vase with 18 windows, 6 drain holes and a hidden ring-shaped cavity, "
           "%d triangles\n",
           word[1], triangles);
    return 0;
}
