/* Predicates where doubles know nothing: corners 2^28 away from the point span a volume of one grid
 * cell around it. Sheared cells keep their volume, so that the truth is known beforehand. */
#include "solid/inside.h"

#include "check.h"
#include "solid/shapes.h"

enum { TETRAHEDRA = 20000, LIMIT = 1 << 28 };

typedef int32_t cell[3][3]; /* corners relative to the point */

static int32_t absolute(int32_t a) {
    return a < 0 ? -a : a;
}

/* From the unit cell, by adding multiples of one corner to another, as long as coordinates stay in
 * the limit. */
static void shear(cell corner, uint64_t *seed) {
    memset(corner, 0, sizeof(cell));
    for (int k = 0; k < 3; k++)
        corner[k][k] = 1;
    for (int turn = 0; turn < 90; turn++) {
        int to = (int)(3 * shape_random(seed)), from = (to + 1 + (int)(2 * shape_random(seed))) % 3;
        int32_t times = (int32_t)(7 * shape_random(seed)) - 3, most = 0;
        for (int k = 0; k < 3; k++) {
            int32_t sum = absolute(corner[to][k] + times * corner[from][k]);
            most = sum > most ? sum : most;
        }
        for (int k = 0; k < 3 && most < LIMIT; k++)
            corner[to][k] += times * corner[from][k];
    }
}

static int sum_of_faces(int32_t corner[4][3], const int32_t point[3], int direction) {
    static const int face[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    int32_t triangle[9];
    int sum = 0;
    for (int f = 0; f < 4; f++) {
        for (int k = 0; k < 9; k++)
            triangle[k] = corner[face[f][k / 3]][k % 3];
        sum += inside_crossing(triangle, point, direction);
    }
    return sum;
}

/* The fourth corner is opposite to the sum of the others: the point is inside, half a cell around
 * it. */
static void test_around_a_point(void) {
    uint64_t seed = 1;
    int wrong = 0, large = 0;
    for (int i = 0; i < TETRAHEDRA; i++) {
        cell c;
        shear(c, &seed);
        int32_t point[3], corner[4][3];
        for (int k = 0; k < 3; k++) {
            point[k] = (int32_t)(2e6 * shape_random(&seed) - 1e6);
            for (int j = 0; j < 3; j++)
                corner[j][k] = point[k] + c[j][k];
            corner[3][k] = point[k] - c[0][k] - c[1][k] - c[2][k];
        }
        large += absolute(c[0][0]) > 1 << 20;
        for (int direction = 0; direction < INSIDE_DIRECTIONS; direction++)
            wrong += sum_of_faces(corner, point, direction) != 1;
        for (int k = 0; k < 3; k++) { /* two corners change places: inside out */
            int32_t kept = corner[0][k];
            corner[0][k] = corner[1][k];
            corner[1][k] = kept;
        }
        for (int direction = 0; direction < INSIDE_DIRECTIONS; direction++)
            wrong += sum_of_faces(corner, point, direction) != -1;
    }
    CHECK_EQUAL(0, wrong);
    CHECK(large > TETRAHEDRA / 4);
}

/* All corners on one side of a plane through the point that is a cell away from them. */
static void test_beside_a_point(void) {
    uint64_t seed = 2;
    int wrong = 0;
    for (int i = 0; i < TETRAHEDRA; i++) {
        cell c;
        shear(c, &seed);
        int32_t point[3] = {0}, corner[4][3];
        for (int k = 0; k < 3; k++) {
            for (int j = 0; j < 3; j++)
                corner[j][k] = c[j][k];
            corner[3][k] = c[0][k] + c[1][k] + c[2][k];
        }
        for (int direction = 0; direction < INSIDE_DIRECTIONS; direction++)
            wrong += sum_of_faces(corner, point, direction) != 0;
    }
    CHECK_EQUAL(0, wrong);
}

/* A point in the middle of a triangle, beside it in its plane, a step off it, and on its edge. */
static void test_touching(void) {
    uint64_t seed = 3;
    int wrong = 0;
    for (int i = 0; i < TETRAHEDRA; i++) {
        cell c;
        shear(c, &seed);
        int32_t point[3] = {0}, t[9];
        for (int k = 0; k < 3; k++) {
            t[k] = c[0][k];
            t[3 + k] = c[1][k];
            t[6 + k] = -c[0][k] - c[1][k];
        }
        wrong += !inside_touches(t, point);
        for (int k = 0; k < 3; k++)
            t[6 + k] = c[0][k] + c[1][k];
        wrong += inside_touches(t, point);
        for (int k = 0; k < 3; k++)
            t[6 + k] = c[2][k] - c[0][k] - c[1][k];
        wrong += inside_touches(t, point);
        for (int k = 0; k < 3; k++) {
            t[6 + k] = -c[0][k];
            point[k] = 0;
        }
        wrong += !inside_touches(t, point);
    }
    CHECK_EQUAL(0, wrong);
}

/* The largest differences that there may be. */
static void test_limits(void) {
    int32_t low = -INSIDE_SPAN_MAX / 2, high = low + INSIDE_SPAN_MAX;
    int32_t corner[4][3] = {{low, low, low}, {low, high, low}, {high, low, low}, {low, low, high}};
    int32_t inside[3] = {low + 1, low + 1, low + 1}, outside[3] = {high, high, high};
    int32_t slope[3] = {low + (1 << 30), low + (1 << 29), low + (1 << 29) - 2};
    int32_t beyond[3] = {low + (1 << 30), low + (1 << 29), low + (1 << 29) + 2};
    for (int direction = 0; direction < INSIDE_DIRECTIONS; direction++) {
        CHECK_EQUAL(1, sum_of_faces(corner, inside, direction));
        CHECK_EQUAL(0, sum_of_faces(corner, outside, direction));
        CHECK_EQUAL(1, sum_of_faces(corner, slope, direction));
        CHECK_EQUAL(0, sum_of_faces(corner, beyond, direction));
    }
}

int main(void) {
    RUN(test_around_a_point);
    RUN(test_beside_a_point);
    RUN(test_touching);
    RUN(test_limits);
    return check_verdict();
}
