#include "height/spline.h"

#include <math.h>

/* Boxes of more cells along a side are bounded by the whole grid. */
enum { CELLS_MOST = 12 };

static int32_t clamped(int64_t i, int32_t count) {
    return (int32_t)(i < 0 ? 0 : i < count ? i : count - 1);
}

/* The cell of a coordinate in steps, where even the border's points are all that counts beyond. */
static int64_t cell_of(double u, int32_t count) {
    return (int64_t)floor(fmin(fmax(u, -3), count + 2.0));
}

/* Weights of four points in a row, and of their slopes per step. */
static void basis(double value[4], double slope[4], double t) {
    double s = 1 - t;
    value[0] = s * s * s / 6;
    value[1] = (3 * t * t * t - 6 * t * t + 4) / 6;
    value[2] = (3 * s * s * s - 6 * s * s + 4) / 6;
    value[3] = t * t * t / 6;
    slope[0] = -s * s / 2;
    slope[1] = (3 * t - 4) * t / 2;
    slope[2] = -(3 * s - 4) * s / 2;
    slope[3] = t * t / 2;
}

typedef struct place {
    int64_t cell;
    double value[4], slope[4];
} place;

static place place_of(double at, double corner, double step, int32_t count) {
    double u = fmin(fmax((at - corner) / step, -2), count + 1.0);
    place p = {.cell = cell_of(u, count)};
    basis(p.value, p.slope, u - (double)p.cell);
    for (int k = 0; k < 4; k++)
        p.slope[k] /= step;
    return p;
}

void spline_terms_at(spline_terms *terms, const spline *s, double x, double y) {
    place px = place_of(x, s->corner.x, s->step, s->columns);
    place py = place_of(y, s->corner.y, s->step, s->rows);
    for (int j = 0, k = 0; j < 4; j++)
        for (int i = 0; i < 4; i++, k++) {
            terms->point[k] = clamped(px.cell + i - 1, s->columns) +
                              s->columns * clamped(py.cell + j - 1, s->rows);
            terms->value[k] = px.value[i] * py.value[j];
            terms->x[k] = px.slope[i] * py.value[j];
            terms->y[k] = px.value[i] * py.slope[j];
        }
}

spline_sample spline_at(const spline *s, double x, double y) {
    place px = place_of(x, s->corner.x, s->step, s->columns);
    place py = place_of(y, s->corner.y, s->step, s->rows);
    spline_sample sum = {0, 0, 0};
    for (int j = 0; j < 4; j++) {
        const double *row = s->control + (int64_t)s->columns * clamped(py.cell + j - 1, s->rows);
        double value = 0, slope = 0;
        for (int i = 0; i < 4; i++) {
            double control = row[clamped(px.cell + i - 1, s->columns)];
            value += px.value[i] * control;
            slope += px.slope[i] * control;
        }
        sum.value += py.value[j] * value;
        sum.x += py.value[j] * slope;
        sum.y += py.slope[j] * value;
    }
    return sum;
}

static void include(interval *span, double x) {
    span->low = fmin(span->low, x);
    span->high = fmax(span->high, x);
}

/* Points first to last, as far as they reach into the cells from low to high. */
static void reach_of(int32_t *first, int32_t *last, double low, double high, int32_t count) {
    int64_t a = cell_of(low, count) - 1, b = cell_of(high, count) + 2;
    if (b - a > CELLS_MOST + 3) {
        a = 0;
        b = count - 1;
    }
    *first = clamped(a, count);
    *last = clamped(b, count);
}

static double control_at(const spline *s, int32_t i, int32_t j) {
    return s->control[clamped(i, s->columns) + (int64_t)s->columns * clamped(j, s->rows)];
}

/* How fast slopes change at most among those points: along x, along y, and of either by the other.
 */
static void bending(double most[3], const spline *s, const int32_t first[2],
                    const int32_t last[2]) {
    most[0] = most[1] = most[2] = 0;
    for (int32_t j = first[1]; j <= last[1]; j++)
        for (int32_t i = first[0]; i <= last[0]; i++) {
            double c = control_at(s, i, j), x = control_at(s, i + 1, j);
            double y = control_at(s, i, j + 1);
            most[0] = fmax(most[0], fabs(control_at(s, i - 1, j) - 2 * c + x));
            most[1] = fmax(most[1], fabs(control_at(s, i, j - 1) - 2 * c + y));
            most[2] = fmax(most[2], fabs(control_at(s, i + 1, j + 1) - x - y + c));
        }
    for (int k = 0; k < 3; k++)
        most[k] /= s->step * s->step;
}

static void narrow(interval *span, double middle, double reach) {
    *span = interval_both(*span, (interval){middle - reach, middle + reach});
}

/* By the mean value theorem: what is left of a small box is as small. */
static void narrow_bound(interval bound[3], const spline *s, iso_vec2 low, iso_vec2 high,
                         const double bend[3]) {
    double x = (high.x - low.x) / 2, y = (high.y - low.y) / 2;
    if (!(x + y < HUGE_VAL))
        return;
    spline_sample middle = spline_at(s, low.x + x, low.y + y);
    narrow(&bound[1], middle.x, bend[0] * x + bend[2] * y);
    narrow(&bound[2], middle.y, bend[2] * x + bend[1] * y);
    narrow(&bound[0], middle.value,
           fmax(-bound[1].low, bound[1].high) * x + fmax(-bound[2].low, bound[2].high) * y);
}

void spline_bound(interval bound[3], const spline *s, iso_vec2 low, iso_vec2 high) {
    int32_t i0, i1, j0, j1;
    reach_of(&i0, &i1, (low.x - s->corner.x) / s->step, (high.x - s->corner.x) / s->step,
             s->columns);
    reach_of(&j0, &j1, (low.y - s->corner.y) / s->step, (high.y - s->corner.y) / s->step, s->rows);
    interval empty = {INFINITY, -INFINITY};
    bound[0] = bound[1] = bound[2] = empty;
    for (int32_t j = j0; j <= j1; j++)
        for (int32_t i = i0; i <= i1; i++) {
            const double *c = s->control + i + (int64_t)s->columns * j;
            include(&bound[0], c[0]);
            if (i < i1)
                include(&bound[1], (c[1] - c[0]) / s->step);
            if (j < j1)
                include(&bound[2], (c[s->columns] - c[0]) / s->step);
        }
    /* level beyond the border, and where one column of points is all */
    if (i0 == i1 || i0 == 0 || i1 == s->columns - 1)
        include(&bound[1], 0);
    if (j0 == j1 || j0 == 0 || j1 == s->rows - 1)
        include(&bound[2], 0);
    double bend[3];
    bending(bend, s, (const int32_t[]){i0, j0}, (const int32_t[]){i1, j1});
    narrow_bound(bound, s, low, high, bend);
    for (int k = 0; k < 3; k++) {
        double slack = 1e-12 * (1 + fmax(-bound[k].low, bound[k].high));
        bound[k] = (interval){bound[k].low - slack, bound[k].high + slack};
    }
}
