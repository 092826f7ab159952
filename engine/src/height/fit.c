/* In the spirit of E. Ottonello, P.-A. Hugron, A. Parmiggiani, S. Lefebvre, QuickCurve: revisiting
 * slightly non-planar 3D printing, 2024: one height over the plane, one quadratic energy.
 *
 * On a top z = t(x, y) with F = z - a(z) h(x, y) the slope of F along the surface is
 *
 *     (1 - a'(t) h) grad t - a(t) grad h
 *
 * which is linear in h. Its square is summed over all tops, and a little of h's bending, slope and
 * size besides. The limits of slope and thickness make it a quadratic program with discs and
 * intervals for constraints; it is solved by alternating directions (S. Boyd et al., Distributed
 * optimization and statistical learning via the alternating direction method of multipliers, 2011),
 * one factor and a hundred solves. Tops that the limits don't let it follow would pull at all
 * others; after each round they are trusted less (S. Geman and D. McClure, 1987). */
#include "height/fit.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/memory.h"
#include "sparse/sparse.h"

/* Against the square of a slope: bending over a distance of BENDING steps, slope, and what layers
 * are thicker or thinner than they should be. The first two are small: under tops, where all is
 * known but for a constant, they would choose one that makes h level, and layers thick; and between
 * tops h may have far to go in a few steps. */
#define BENDING 0.07
#define FLATNESS 2e-6
#define THICKNESS 1e-4
/* The constant itself, h's mean under tops, is held as if each of their points was so strongly; not
 * point by point, which would bend h. */
#define CONSTANCY 0.01
#define CONSTANCY_HELD 1e-4 /* where limits choose it */

/* Penalties of the alternating directions, for slopes and mm, and their over-relaxation. */
#define OF_SLOPE 1.0
#define OF_HEIGHT 0.01
#define RELAXATION 1.6

/* Slopes keep to a little less than the limit: they are held where control points are. */
#define ROOM 0.98
/* Of a limit: what is beyond by no more is within. */
#define CLOSE 0.003

enum {
    MOST_TERMS = 16,   /* control points that a value is of */
    SPAN = 7,          /* points in a row that share cells with one */
    SLOTS = 4 * SPAN,  /* of the lower half of a matrix's row */
    FEW = 12,          /* one top in so many that isn't followed is no reason to doubt any */
    ROUNDS = 6,        /* of trust */
    TIGHTER = 4,       /* more rounds for slopes between points */
    STEPS = 120,       /* of the alternating directions */
    MOST_SHRINKS = 60, /* each takes what the slopes are too steep by */
    BINS = 64,         /* of height */
    TRIALS = 6,        /* of a mean */
    STEPS_LEAST = 30,  /* within is not yet best */
    LAGS = 10,         /* of them between looks at the limits, which depend on h */
    HEIGHTS = 8        /* z within the ramp's soft end at which a slope is looked at */
};
/* What of a point is held to the limits: only where it has come near them. A point that is held
 * follows the others but slowly. */
enum { HOLD_SLOPE = 1, HOLD_HEIGHT = 2 };
#define NEAR 0.8
/* Of the median of squares. */
#define HALF 0.5
/* Between heights of tops that one layer can follow; and what trust is left to the others. */
#define HEIGHT_RATIO 2.5
#define GIVEN_UP 1e-3
static const double doubt[ROUNDS] = {0, 0.03, 0.1, 0.03, 0.03, 0.03}; /* slopes off by so much */

typedef struct system_of {
    double *matrix; /* [SLOTS points] */
    double *right;  /* [points] */
    sparse_entry *entry;
    sparse_factor *factor;
    /* and a term of the mean, added by Sherman and Morrison's formula */
    double *mean;   /* [points] its root */
    double *solved; /* [points] what the factor makes of that */
    double target;  /* of the mean */
} system_of;

/* What is held to the limits, and Lagrange's multipliers. */
typedef struct split {
    double *x, *y, *height;                /* [points] within the limits */
    double *push_x, *push_y, *push_height; /* [points] scaled multipliers */
    double *limit;                         /* [points] of the slope */
    double *right;                         /* [points] */
} split;

typedef struct fit {
    spline *s;
    const tops *t;
    const ramp *r;
    const fit_limits *limits; /* or NULL */
    int32_t points;
    double *error;      /* [tops] */
    double *trust;      /* [tops] */
    double *tallest;    /* [points] near each; -INFINITY: none of the model */
    double *room;       /* [points] share of the limit that slopes are held to */
    uint8_t *is_top;    /* [points] the cell that starts there is all under tops */
    uint8_t *held;      /* [points] HOLD_ */
    double least, most; /* of h */
    system_of system;
    split split;
} fit;

// The matrix

static void add_to(fit *f, int32_t point, double value) {
    f->system.matrix[(int64_t)SLOTS * point + SPAN / 2] += value;
}

/* Square of a sum of control points, at most MOST_TERMS, less `right`. */
static void add_square(fit *f, const int32_t *point, const double *share, int count, double weight,
                       double right) {
    int32_t columns = f->s->columns, row[MOST_TERMS], slot[MOST_TERMS];
    for (int i = 0; i < count;
         i++) { /* a point's slot in its own row of the matrix grows with it */
        row[i] = point[i] / columns;
        slot[i] = SPAN * row[i] - (point[i] - columns * row[i]);
        f->system.right[point[i]] += weight * right * share[i];
    }
    for (int i = 0; i < count; i++)
        for (int j = 0; j <= i; j++) {
            double value = weight * share[i] * share[j];
            int high = point[i] >= point[j] ? i : j, low = i + j - high;
            /* two terms that are one point where the grid ends: both halves of the matrix are one
             */
            if (j < i && point[i] == point[j])
                value *= 2;
            f->system.matrix[(int64_t)SLOTS * point[high] + slot[high] - slot[low] + SPAN / 2] +=
                value;
        }
}

/* How the slope of F along a top depends on h. */
static void terms_of_top(double x[16], double y[16], spline_terms *terms, const fit *f,
                         const top *t) {
    double a = ramp_at(f->r, t->z), rise = ramp_slope(f->r, t->z);
    spline_terms_at(terms, f->s, t->x, t->y);
    for (int k = 0; k < 16; k++) {
        x[k] = a * terms->x[k] + rise * t->slope_x * terms->value[k];
        y[k] = a * terms->y[k] + rise * t->slope_y * terms->value[k];
    }
}

static void add_tops(fit *f) {
    for (int64_t i = 0; i < f->t->count; i++) {
        const top *t = &f->t->top[i];
        spline_terms terms;
        double x[16], y[16], weight = t->weight * f->trust[i] / (TOPS_ACROSS * TOPS_ACROSS);
        terms_of_top(x, y, &terms, f, t);
        add_square(f, terms.point, x, 16, weight, t->slope_x);
        add_square(f, terms.point, y, 16, weight, t->slope_y);
    }
}

/* Over differences of neighbours. */
static void add_smoothness(fit *f) {
    const int32_t columns = f->s->columns, rows = f->s->rows;
    double square_of_step = f->s->step * f->s->step, rise = RAMP_STEEPEST / f->r->length;
    const double second[] = {1, -2, 1}, first[] = {-1, 1}, cross[] = {1, -1, -1, 1};
    for (int32_t j = 0; j < rows; j++)
        for (int32_t i = 0; i < columns; i++) {
            int32_t k = i + columns * j;
            double flat = FLATNESS / square_of_step;
            double bend = BENDING * BENDING / square_of_step;
            const int32_t x[] = {k, k + 1, k + 2}, y[] = {k, k + columns, k + 2 * columns};
            const int32_t square[] = {k, k + 1, k + columns, k + columns + 1};
            if (i + 2 < columns)
                add_square(f, x, second, 3, bend, 0);
            if (j + 2 < rows)
                add_square(f, y, second, 3, bend, 0);
            if (i + 1 < columns)
                add_square(f, x, first, 2, flat, 0);
            if (j + 1 < rows)
                add_square(f, y, first, 2, flat, 0);
            if (i + 1 < columns && j + 1 < rows)
                add_square(f, square, cross, 4, 2 * bend, 0);
            add_to(f, k, THICKNESS * rise * rise);
        }
}

/* The eight points around one, where the grid ends itself: from low to high, row by row. */
static void points_around(int32_t point[9], const spline *s, int32_t i, int32_t j) {
    int32_t k = i + s->columns * j, left = i > 0 ? -1 : 0, right = i + 1 < s->columns ? 1 : 0;
    int32_t below = j > 0 ? -s->columns : 0, above = j + 1 < s->rows ? s->columns : 0;
    const int32_t row[] = {k + below, k, k + above};
    for (int b = 0; b < 3; b++) {
        point[3 * b] = row[b] + left;
        point[3 * b + 1] = row[b];
        point[3 * b + 2] = row[b] + right;
    }
}

/* Slopes of the spline at a control point are sums over those, times 1 / (12 step). */
static const double along_x[9] = {-1, 0, 1, -4, 0, 4, -1, 0, 1};
static const double along_y[9] = {-1, -4, -1, 0, 0, 0, 1, 4, 1};

// Limits

/* The steepest that h may be for layers not to be too steep anywhere up to `tallest`. Their slope
 * grows with z up to the ramp's soft end, whatever h is; within it, it is looked at one by one. */
static double slope_limit(const fit *f, double tallest, double h) {
    double limit = INFINITY;
    if (!(tallest > f->limits->floor))
        return limit;
    for (int i = 0; i <= HEIGHTS; i++) {
        double s = 1 - RAMP_SOFT + RAMP_SOFT * i / HEIGHTS;
        double z = fmin(tallest, f->r->from + s * f->r->length), a = ramp_at(f->r, z);
        double upright = fmax(1 - ramp_slope(f->r, z) * h, f->limits->low);
        if (a > 0)
            limit = fmin(limit, f->limits->slope * upright / a);
        if (z == tallest)
            break;
    }
    return limit;
}

static void slope_at_point(double slope[2], const fit *f, int32_t i, int32_t j) {
    const double *c = f->s->control;
    int32_t p[9];
    double unit = 1 / (12 * f->s->step);
    points_around(p, f->s, i, j);
    slope[0] = unit * (c[p[2]] - c[p[0]] + 4 * (c[p[5]] - c[p[3]]) + c[p[8]] - c[p[6]]);
    slope[1] = unit * (c[p[6]] - c[p[0]] + 4 * (c[p[7]] - c[p[1]]) + c[p[8]] - c[p[2]]);
}

/* Which limits a point is beyond `share` of, as HOLD_. */
static uint8_t beyond(const fit *f, int32_t i, int32_t j, double share) {
    int32_t k = i + f->s->columns * j;
    double h = f->s->control[k], slope[2];
    slope_at_point(slope, f, i, j);
    double steep = sqrt(slope[0] * slope[0] + slope[1] * slope[1]);
    return (steep > f->room[k] * share * slope_limit(f, f->tallest[k], h) ? HOLD_SLOPE : 0) |
           (h < f->least * share || h > f->most * share ? HOLD_HEIGHT : 0);
}

static bool is_within(const fit *f, double share) {
    for (int32_t j = 0; j < f->s->rows; j++)
        for (int32_t i = 0; i < f->s->columns; i++)
            if (beyond(f, i, j, share))
                return false;
    return true;
}

static void hold_near_limits(fit *f) {
    for (int32_t j = 0, k = 0; j < f->s->rows; j++)
        for (int32_t i = 0; i < f->s->columns; i++, k++)
            f->held[k] |= beyond(f, i, j, NEAR);
}

// One round

static void add_penalties(fit *f) {
    double weight = OF_SLOPE / (144 * f->s->step * f->s->step);
    for (int32_t j = 0, k = 0; j < f->s->rows; j++)
        for (int32_t i = 0; i < f->s->columns; i++, k++) {
            int32_t point[9];
            points_around(point, f->s, i, j);
            if (f->held[k] & HOLD_SLOPE) {
                add_square(f, point, along_x, 9, weight, 0);
                add_square(f, point, along_y, 9, weight, 0);
            }
            if (f->held[k] & HOLD_HEIGHT)
                add_to(f, k, OF_HEIGHT);
        }
}

/* The root of the mean's term. */
static void set_mean(fit *f, double constancy) {
    int32_t count = 0;
    double rise = RAMP_STEEPEST / f->r->length;
    for (int32_t k = 0; k < f->points; k++)
        count += f->is_top[k];
    for (int32_t k = 0; k < f->points; k++)
        f->system.mean[k] = f->is_top[k] ? rise * sqrt(constancy / count) : 0;
}

static iso_status factorise(fit *f, bool penalties) {
    system_of *system = &f->system;
    memset(system->matrix, 0, (size_t)f->points * SLOTS * sizeof *system->matrix);
    memset(system->right, 0, (size_t)f->points * sizeof *system->right);
    add_tops(f);
    add_smoothness(f);
    set_mean(f, penalties ? CONSTANCY_HELD : CONSTANCY);
    if (penalties) {
        hold_near_limits(f);
        add_penalties(f);
    }
    int64_t count = 0;
    for (int32_t row = 0; row < f->points; row++)
        for (int slot = 0; slot < SLOTS; slot++) {
            double value = system->matrix[(int64_t)SLOTS * row + slot];
            int32_t column = row - f->s->columns * (slot / SPAN) + slot % SPAN - SPAN / 2;
            if (value != 0)
                system->entry[count++] = (sparse_entry){row, column, value};
        }
    sparse_free(system->factor);
    ISO_TRY(sparse_factorise(&system->factor, system->entry, count, f->points));
    return sparse_solve(system->solved, system->factor, system->mean);
}

/* right is changed. */
static iso_status find_height(fit *f, double *right) {
    const system_of *system = &f->system;
    double *control = f->s->control, product = 0, norm = 1, sum = 0;
    for (int32_t k = 0; k < f->points; k++)
        sum += system->mean[k];
    /* the root of a sum over n points of 1 / n each */
    double push = sum > 0 ? system->target * sum : 0;
    for (int32_t k = 0; k < f->points; k++)
        right[k] += push * system->mean[k];
    ISO_TRY(sparse_solve(control, system->factor, right));
    for (int32_t k = 0; k < f->points; k++) {
        product += system->mean[k] * control[k];
        norm += system->mean[k] * system->solved[k];
    }
    for (int32_t k = 0; k < f->points; k++)
        control[k] -= product / norm * system->solved[k];
    return ISO_OK;
}

/* The mean that leaves h as far from its least as from its most, by a few trials. */
static iso_status balance(fit *f) {
    for (int i = 0; i < TRIALS; i++) {
        memcpy(f->split.right, f->system.right, (size_t)f->points * sizeof(double));
        ISO_TRY(find_height(f, f->split.right));
        if (!f->limits)
            return ISO_OK;
        double low = INFINITY, high = -INFINITY;
        for (int32_t k = 0; k < f->points; k++)
            if (f->tallest[k] > f->limits->floor) {
                low = fmin(low, f->s->control[k]);
                high = fmax(high, f->s->control[k]);
            }
        f->system.target += (low / f->least - high / f->most) / (1 / f->most - 1 / f->least);
    }
    return ISO_OK;
}

/* One point's turn: over-relax, bring within the limits, add up what was cut off. */
static void hold_point(fit *f, int32_t i, int32_t j) {
    split *p = &f->split;
    int32_t k = i + f->s->columns * j;
    double slope[2], h = f->s->control[k];
    if (f->held[k] & HOLD_HEIGHT) {
        double height = RELAXATION * h + (1 - RELAXATION) * p->height[k] + p->push_height[k];
        p->height[k] = fmin(fmax(height, f->least), f->most);
        p->push_height[k] = height - p->height[k];
    }
    if (!(f->held[k] & HOLD_SLOPE))
        return;
    slope_at_point(slope, f, i, j);
    double x = RELAXATION * slope[0] + (1 - RELAXATION) * p->x[k] + p->push_x[k];
    double y = RELAXATION * slope[1] + (1 - RELAXATION) * p->y[k] + p->push_y[k];
    double length = sqrt(x * x + y * y), most = p->limit[k];
    double share = length > most ? most / length : 1;
    p->x[k] = share * x;
    p->y[k] = share * y;
    p->push_x[k] = x - p->x[k];
    p->push_y[k] = y - p->y[k];
}

static void pull_towards(fit *f) {
    split *p = &f->split;
    double unit = OF_SLOPE / (12 * f->s->step);
    for (int32_t j = 0, k = 0; j < f->s->rows; j++)
        for (int32_t i = 0; i < f->s->columns; i++, k++) {
            int32_t point[9];
            if (!f->held[k])
                continue;
            double x = unit * (p->x[k] - p->push_x[k]), y = unit * (p->y[k] - p->push_y[k]);
            points_around(point, f->s, i, j);
            for (int n = 0; n < 9; n++)
                p->right[point[n]] += along_x[n] * x + along_y[n] * y;
            p->right[k] += OF_HEIGHT * (p->height[k] - p->push_height[k]);
        }
}

static iso_status alternate(fit *f) {
    split *p = &f->split;
    for (int step = 0; step < STEPS; step++) {
        if (step % LAGS == 0 && step >= STEPS_LEAST && is_within(f, 1 + CLOSE))
            break;
        for (int32_t k = 0; k < f->points && step % LAGS == 0; k++)
            p->limit[k] = f->room[k] * slope_limit(f, f->tallest[k], f->s->control[k]);
        for (int32_t j = 0; j < f->s->rows; j++)
            for (int32_t i = 0; i < f->s->columns; i++)
                hold_point(f, i, j);
        memcpy(p->right, f->system.right, (size_t)f->points * sizeof *p->right);
        pull_towards(f);
        ISO_TRY(find_height(f, p->right));
    }
    return ISO_OK;
}

/* The tallest of a cell and those around it; -INFINITY: it has nothing of the model. A wall may
 * pass through a cell between its samples. */
static double tallest_around(const fit *f, int32_t i, int32_t j) {
    const double *tallest = f->t->tallest + i + (int64_t)f->s->columns * j;
    double most = tallest[0];
    if (!(most > -INFINITY) || i == 0 || j == 0)
        return most;
    for (int n = 0; n < 9; n++)
        most = fmax(most, tallest[n % 3 - 1 + f->s->columns * (n / 3 - 1)]);
    return most;
}

/* The steepest layer of a cell, against the limit. */
static double steepest_in(const fit *f, int32_t i, int32_t j) {
    const spline *s = f->s;
    double worst = 0, tallest = tallest_around(f, i, j);
    for (int n = 0; n < 16 && tallest > f->limits->floor; n++) {
        spline_sample h = spline_at(s, s->corner.x + (i + n % 4 / 3.0) * s->step,
                                    s->corner.y + (j + n / 4 / 3.0) * s->step);
        double slope = sqrt(h.x * h.x + h.y * h.y);
        worst = fmax(worst, slope / slope_limit(f, tallest, h.value));
    }
    return worst;
}

/* The steepest of all. Where it is too steep, the points around get less room. */
static double steepest(fit *f) {
    double worst = 0;
    for (int32_t j = 0; j + 1 < f->s->rows; j++)
        for (int32_t i = 0; i + 1 < f->s->columns; i++) {
            double steep = steepest_in(f, i, j);
            worst = fmax(worst, steep);
            for (int n = 0; n < 4 && steep > 1; n++) {
                double *room = &f->room[i + n % 2 + f->s->columns * (j + n / 2)];
                *room = fmax(0.5 * *room, fmin(*room, ROOM / steep));
            }
        }
    return worst;
}

/* Control points within their range, whatever the last steps left; then what is too steep yet makes
 * all layers flatter. */
static void enforce(fit *f) {
    double *control = f->s->control;
    for (int32_t k = 0; k < f->points; k++)
        control[k] = fmin(fmax(control[k], f->least), f->most);
    for (int i = 0; i < MOST_SHRINKS; i++) {
        double worst = steepest(f);
        if (worst <= 1)
            return;
        for (int32_t k = 0; k < f->points; k++)
            control[k] /= fmin(1.001 * worst, 2);
    }
    memset(control, 0, (size_t)f->points * sizeof *control);
}

// Rounds

/* The number that `rank` others are not larger than; by C. A. R. Hoare's Find, 1961. */
static double quantile(double *number, int64_t count, int64_t rank) {
    for (int64_t low = 0, high = count - 1; low < high;) {
        double pivot = number[low + (high - low) / 2];
        int64_t i = low, j = high;
        while (i <= j) {
            while (number[i] < pivot)
                i++;
            while (pivot < number[j])
                j--;
            if (i <= j) {
                double swap = number[i];
                number[i++] = number[j];
                number[j--] = swap;
            }
        }
        if (rank <= j)
            high = j;
        else if (rank >= i)
            low = i;
        else
            break;
    }
    return number[rank];
}

/* By how much the slope of F along a top is off, squared. */
static double error_of(const fit *f, const top *t) {
    spline_terms terms;
    double x[16], y[16], dx = -t->slope_x, dy = -t->slope_y;
    terms_of_top(x, y, &terms, f, t);
    for (int k = 0; k < 16; k++) {
        dx += x[k] * f->s->control[terms.point[k]];
        dy += y[k] * f->s->control[terms.point[k]];
    }
    return dx * dx + dy * dy;
}

/* Trust tops the less the further their layers are off; says how many are off by what matters. If
 * most are, the better half is to become better yet. */
static int64_t review(fit *f, double doubted) {
    int64_t off = 0;
    for (int64_t i = 0; i < f->t->count; i++)
        f->error[i] = error_of(f, &f->t->top[i]);
    memcpy(f->trust, f->error, (size_t)f->t->count * sizeof *f->trust);
    doubted = fmax(doubted * doubted, HALF * quantile(f->trust, f->t->count, f->t->count / 2));
    for (int64_t i = 0; i < f->t->count; i++) {
        double doubts = 1 + f->error[i] / doubted;
        f->trust[i] = 1 / (doubts * doubts);
        off += f->error[i] > doubted / 9;
    }
    return off;
}

/* Where layers can't follow all tops since those lie at too different heights, give up all but a
 * range of heights: the one with the most of what isn't followed yet. A layer can be no more than
 * so many times as thick here as there. Says how many are left to give up. */
static int64_t choose_heights(fit *f, double doubted) {
    double amount[BINS] = {0}, most = 0, best = 0, tall = 0, floor = f->limits->floor;
    int64_t off = 0;
    for (int64_t i = 0; i < f->t->count; i++) {
        f->error[i] = error_of(f, &f->t->top[i]);
        tall = fmax(tall, f->t->top[i].z - floor);
    }
    for (int64_t i = 0; i < f->t->count; i++)
        if (f->error[i] > doubted * doubted) {
            double bin = (f->t->top[i].z - floor) / tall * BINS;
            amount[(int)fmin(fmax(bin, 0), BINS - 1)] += f->t->top[i].weight;
            off++;
        }
    if (off < f->t->count / FEW)
        return off;
    for (int high = 0; high < BINS; high++) {
        double sum = 0;
        for (int bin = high; bin >= 0 && bin * HEIGHT_RATIO >= high; bin--)
            sum += amount[bin];
        if (sum > most) {
            most = sum;
            best = (high + 1) * tall / BINS;
        }
    }
    for (int64_t i = 0; i < f->t->count; i++) {
        double z = f->t->top[i].z - floor;
        bool given_up = f->error[i] > doubted * doubted && !(z * HEIGHT_RATIO >= best && z <= best);
        f->trust[i] = given_up ? GIVEN_UP : 1;
    }
    return off;
}

static iso_status run(fit *f) {
    for (int64_t i = 0; i < f->t->count; i++)
        f->trust[i] = 1;
    ISO_TRY(factorise(f, false));
    ISO_TRY(balance(f));
    if (!f->limits)
        return ISO_OK;
    bool bound = !is_within(f, 1);
    for (int round = bound ? 0 : 1; round < ROUNDS; round++) {
        int64_t few = f->t->count / FEW;
        if (round > 0 && (round == 1 && bound ? choose_heights(f, doubt[round]) < few
                                              : review(f, doubt[round]) < few))
            break;
        ISO_TRY(factorise(f, bound));
        if (!bound) {
            ISO_TRY(balance(f));
            bound = !is_within(f, 1);
            if (bound)
                ISO_TRY(factorise(f, bound));
        }
        if (bound)
            ISO_TRY(alternate(f));
    }
    for (int round = 0; round < TIGHTER && steepest(f) > 1; round++) {
        ISO_TRY(factorise(f, true));
        ISO_TRY(alternate(f));
    }
    enforce(f);
    return ISO_OK;
}

/* The tallest of the cells around a point, and around those, and which are under tops. */
static void look_at_cells(fit *f) {
    const int32_t columns = f->s->columns, rows = f->s->rows;
    memset(f->is_top, 0, (size_t)f->points);
    for (int64_t i = 0; i < f->t->count; i++) {
        const top *t = &f->t->top[i];
        int64_t across = (int64_t)((t->x - f->s->corner.x) / f->s->step);
        int64_t up = (int64_t)((t->y - f->s->corner.y) / f->s->step);
        uint8_t *samples = &f->is_top[across + columns * up];
        *samples += t->weight == 1 && *samples < UINT8_MAX;
    }
    for (int32_t k = 0; k < f->points; k++)
        f->is_top[k] = f->is_top[k] >= TOPS_ACROSS * TOPS_ACROSS;
    for (int32_t j = 0; j < rows; j++)
        for (int32_t i = 0; i < columns; i++) {
            double most = -INFINITY;
            for (int32_t b = j < 2 ? 0 : j - 2; b <= j + 1 && b < rows; b++)
                for (int32_t a = i < 2 ? 0 : i - 2; a <= i + 1 && a < columns; a++)
                    most = fmax(most, f->t->tallest[a + columns * b]);
            f->tallest[i + columns * j] = most;
        }
}

static iso_status allocate(fit *f) {
    double **array[] = {&f->room,         &f->tallest,      &f->system.right,
                        &f->split.x,      &f->split.y,      &f->split.height,
                        &f->split.push_x, &f->split.push_y, &f->split.push_height,
                        &f->split.limit,  &f->system.mean,  &f->system.solved,
                        &f->split.right};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++) {
        ISO_TRY(ISO_ALLOCATE(*array[i], f->points));
        memset(*array[i], 0, (size_t)f->points * sizeof(double));
    }
    ISO_TRY(ISO_ALLOCATE(f->is_top, f->points));
    ISO_TRY(ISO_ALLOCATE(f->held, f->points));
    memset(f->held, 0, (size_t)f->points);
    for (int32_t k = 0; k < f->points; k++)
        f->room[k] = ROOM;
    ISO_TRY(ISO_ALLOCATE(f->error, f->t->count));
    ISO_TRY(ISO_ALLOCATE(f->trust, f->t->count));
    ISO_TRY(ISO_ALLOCATE(f->system.matrix, (int64_t)SLOTS * f->points));
    return ISO_ALLOCATE(f->system.entry, (int64_t)SLOTS * f->points);
}

static iso_status solve(fit *f) {
    f->points = f->s->columns * f->s->rows;
    iso_status status = allocate(f);
    if (status == ISO_OK) {
        look_at_cells(f);
        status = run(f);
    }
    double *const array[] = {f->room,         f->tallest,      f->system.right,
                             f->split.x,      f->split.y,      f->split.height,
                             f->split.push_x, f->split.push_y, f->split.push_height,
                             f->split.limit,  f->system.mean,  f->system.solved,
                             f->split.right,  f->trust,        f->system.matrix};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        iso_release(array[i]);
    iso_release(f->is_top);
    iso_release(f->held);
    iso_release(f->error);
    iso_release(f->system.entry);
    sparse_free(f->system.factor);
    return status;
}

iso_status fit_freely(spline *s, const tops *t, const ramp *r) {
    fit f = {.s = s, .t = t, .r = r};
    return solve(&f);
}

iso_status fit_within(spline *s, const tops *t, const ramp *r, const fit_limits *limits) {
    double most = RAMP_STEEPEST / r->length;
    fit f = {.s = s,
             .t = t,
             .r = r,
             .limits = limits,
             .least = (1 - limits->high) / most,
             .most = (1 - limits->low) / most};
    return solve(&f);
}
