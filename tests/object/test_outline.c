/* Outlines of cells at random against the columns that are filled, and their pieces. */
#include "object/solid.h"

#include "planar/hull.h"
#include "object/outline.h"

enum { SIDE = 7, TALL = 3 };

/* Beside a cell that is reached, or at its corner too? */
static int beside_open(uint8_t open[SIDE + 2][SIDE + 2], int x, int y, int corners) {
    for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < SIDE + 2; i++)
        for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < SIDE + 2; j++)
            if (open[i][j] == 2 && (corners || i == x || j == y))
                return 1;
    return 0;
}

/* Columns that are filled somewhere, and those that can't be reached from beside them. */
static int covered_cells(const uint8_t *filled, int corners) {
    uint8_t open[SIDE + 2][SIDE + 2] = {{0}}; /* 1: nothing there, 2: reached */
    int count = (SIDE + 2) * (SIDE + 2);
    for (int x = 0; x < SIDE + 2; x++)
        for (int y = 0; y < SIDE + 2; y++) {
            open[x][y] = 1;
            for (int z = 0; z < TALL && x > 0 && y > 0 && x <= SIDE && y <= SIDE; z++)
                if (filled[x - 1 + SIDE * (y - 1 + SIDE * z)])
                    open[x][y] = 0;
        }
    open[0][0] = 2;
    for (int turn = 0; turn < SIDE * SIDE; turn++)
        for (int x = 0; x < SIDE + 2; x++)
            for (int y = 0; y < SIDE + 2; y++)
                if (open[x][y] == 1 && beside_open(open, x, y, corners))
                    open[x][y] = 2;
    for (int x = 0; x < SIDE + 2; x++)
        for (int y = 0; y < SIDE + 2; y++)
            count -= open[x][y] == 2;
    return count;
}

/* Convex, and together as large as the region. */
static void check_pieces(const iso_region *region) {
    iso_pieces pieces;
    int64_t area = 0;
    int bent = 0;
    if (!CHECK_OK(outline_pieces(&pieces, region)))
        return;
    for (int32_t i = 0; i < pieces.count; i++) {
        const iso_point *p = pieces.point + pieces.first[i];
        int32_t n = pieces.first[i + 1] - pieces.first[i];
        area += hull_double_area(p, n);
        for (int32_t k = 0; k < n; k++) {
            iso_point a = p[k], b = p[(k + 1) % n], c = p[(k + 2) % n];
            bent += ((int64_t)b.x - a.x) * (c.y - b.y) - ((int64_t)b.y - a.y) * (c.x - b.x) <= 0;
        }
    }
    CHECK_EQUAL(iso_region_double_area(region), area);
    CHECK_EQUAL(0, bent);
    outline_pieces_free(&pieces);
}

static void test_cells(void) {
    uint64_t state = 5;
    iso_planar_scratch *scratch;
    if (!CHECK_OK(iso_planar_scratch_new(&scratch)))
        return;
    for (int turn = 0; turn < 100; turn++) {
        uint8_t filled[SIDE * SIDE * TALL];
        shape s = {0};
        iso_mesh mesh;
        iso_region outline = {0};
        for (int i = 0; i < SIDE * SIDE * TALL; i++)
            filled[i] = shape_random(&state) % 10 < 1 + (uint32_t)turn % 5;
        shape_cells(&s, filled, SIDE, SIDE, TALL);
        if (s.count == 0 || !solid_made(&mesh, &s))
            continue;
        if (CHECK_OK(outline_of(&outline, &mesh, 1, scratch))) {
            double area = (double)iso_region_double_area(&outline) / 2e8;
            /* a hole that touches the outside in a corner alone may count as either */
            CHECK(area > covered_cells(filled, 1) - 1e-9 && area < covered_cells(filled, 0) + 1e-9);
            check_pieces(&outline);
        }
        iso_region_free(&outline);
        iso_mesh_free(&mesh);
    }
    iso_planar_scratch_free(scratch);
}

/* A ring seen from above is a disc, from the side a slot; two meshes count together. */
static void test_ring(void) {
    shape s = {0};
    iso_mesh mesh[2];
    iso_region outline = {0};
    iso_planar_scratch *scratch;
    shape_torus(&s, (shape_point){0, 0, 0}, 9, 4, 200, 100);
    if (!CHECK_OK(iso_planar_scratch_new(&scratch)) || !solid_made(&mesh[0], &s))
        return;
    if (CHECK_OK(outline_of(&outline, mesh, 1, scratch))) {
        CHECK_EQUAL(1, outline.count);
        CHECK_NEAR(SHAPE_PI * 169, (double)iso_region_double_area(&outline) / 2e8, 0.2);
    }
    CHECK_OK(iso_meshes_transform(mesh, 1, &(iso_transform){.rotate = {90, 0, 0}}));
    shape_box(&s, 30, 0, 0, 32, 3, 1);
    if (solid_made(&mesh[1], &s) && CHECK_OK(outline_of(&outline, mesh, 2, scratch))) {
        CHECK_EQUAL(2, outline.count);
        CHECK_NEAR(18 * 8 + SHAPE_PI * 16 + 6, (double)iso_region_double_area(&outline) / 2e8, 0.2);
        check_pieces(&outline);
    }
    iso_region_free(&outline);
    iso_mesh_free(&mesh[0]);
    iso_mesh_free(&mesh[1]);
    iso_planar_scratch_free(scratch);
}

/* A corner of a thread of 48 turns, some tenths of a micrometre off. */
static shape_point thread_corner(int row, int sector) {
    static const double crest[4] = {0, 0.5, 1, 0.5};
    double u = 2 * SHAPE_PI * sector / 48;
    uint64_t state = (uint64_t)(row * 48 + sector % 48) + 1;
    double r = 5 + crest[(row + sector / 12) % 4] + (shape_random(&state) % 8) * 1e-4;
    return (shape_point){r * cos(u), r * sin(u), row * 0.25 + (sector % 48) / 48.0 * 0.2};
}

/* The sides of every turn lie upon those of all others. Each meets its like of every other turn,
 * but doesn't cross their neighbours as well. */
static void test_thread(void) {
    enum { ROWS = 192 };
    shape s = {0};
    iso_mesh mesh;
    iso_region outline = {0};
    iso_planar_scratch *scratch;
    for (int j = 0; j < 48; j++) {
        for (int k = 0; k < ROWS; k++)
            shape_quad(&s, thread_corner(k, j), thread_corner(k, (j + 1) % 48),
                       thread_corner(k + 1, (j + 1) % 48), thread_corner(k + 1, j));
        shape_add(&s, (shape_point){0, 0, -1}, thread_corner(0, (j + 1) % 48), thread_corner(0, j));
        shape_add(&s, (shape_point){0, 0, 30}, thread_corner(ROWS, j),
                  thread_corner(ROWS, (j + 1) % 48));
    }
    if (!CHECK_OK(iso_planar_scratch_new(&scratch)) || !solid_made(&mesh, &s))
        return;
    if (CHECK_OK(outline_of(&outline, &mesh, 1, scratch))) {
        CHECK_EQUAL(1, outline.count);
        CHECK_NEAR(SHAPE_PI * 36, (double)iso_region_double_area(&outline) / 2e8, 1);
        CHECK(iso_planar_get_counts(scratch).collisions < 1500000);
    }
    iso_region_free(&outline);
    iso_mesh_free(&mesh);
    iso_planar_scratch_free(scratch);
}

int main(void) {
    RUN(test_cells);
    RUN(test_ring);
    RUN(test_thread);
    return check_verdict();
}
