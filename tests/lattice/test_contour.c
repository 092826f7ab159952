/* Contours where two curves come near each other in one square. */
#include "check.h"

#include "lattice/contour.h"

static iso_arena arena;

typedef struct field {
    double value[4][4];
} field;

static void field_row(contour_row *row, void *context, int32_t j) {
    const field *f = context;
    *row = (contour_row){f->value[j], NULL};
}

/* How many curves there are, and what they enclose, in squares of the grid; what is at most 0 lies
 * left of them. */
static int trace(double *area, field *f) {
    contour_grid grid = {4, 4, NULL, field_row, f};
    contour c;
    int closed, curves = 0;
    *area = 0;
    if (!CHECK_OK(contour_trace(&c, &grid, &arena)))
        return 0;
    for (int32_t start; (start = contour_start(&c, &closed)) >= 0; curves++) {
        double x[16], y[16];
        int32_t i = start, count = 0;
        for (const contour_crossing *at; count < 16 && (at = contour_step(&c, &i)); count++)
            x[count] = at->x, y[count] = at->y;
        CHECK(closed);
        for (int32_t k = 0, l = count - 1; k < count; l = k++)
            *area += (x[l] * y[k] - x[k] * y[l]) / 2;
    }
    return curves;
}

/* Two corners of the middle square, one across from the other, are below 0: where the mean of all
 * four is, too, they are of one piece, else of two. */
static void test_mean_decides(void) {
    for (int way = 0; way < 2; way++)
        for (int joined = 0; joined < 2; joined++) {
            double above = joined ? 0.5 : 2, area;
            field f;
            for (int j = 0; j < 4; j++)
                for (int i = 0; i < 4; i++)
                    f.value[j][i] = above;
            f.value[1][1 + way] = f.value[2][2 - way] = -1;
            double reach = 1 / (1 + above); /* of a corner, along its four edges */
            CHECK_EQUAL(joined ? 1 : 2, trace(&area, &f));
            double corner = 2 * reach * reach; /* a square that stands on its tip */
            /* joined, what lies outside the middle square's two other corners is inside, too */
            double rest = 1 - reach, bridge = 1 - rest * rest - reach * reach;
            CHECK_NEAR(2 * corner + (joined ? bridge : 0), area, 1e-12);
        }
}

/* A mean of just 0 counts as below, as the nodes do. */
static void test_zero_is_below(void) {
    field f = {{{1, 1, 1, 1}, {1, -1, 1, 1}, {1, 1, -1, 1}, {1, 1, 1, 1}}};
    double area;
    CHECK_EQUAL(1, trace(&area, &f));
    field g = {{{1, 1, 1, 1}, {1, 0, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}}};
    CHECK_EQUAL(1, trace(&area, &g));
    CHECK_NEAR(0, area, 1e-12);
    field h = {{{-1, -1, -1, -1}, {-1, 0, 0, -1}, {-1, 0, 0, -1}, {-1, -1, -1, -1}}};
    CHECK_EQUAL(0, trace(&area, &h));
}

int main(void) {
    RUN(test_mean_decides);
    RUN(test_zero_is_below);
    iso_arena_free(&arena);
    return check_verdict();
}
