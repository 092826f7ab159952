#include "channel/curve.h"

void curve_free(curve *c) {
    iso_release(c->point);
    *c = (curve){0};
}

iso_status curve_add(curve *c, iso_vec3 p) {
    if (c->count == INT32_MAX)
        return iso_fail(ISO_OUTSIDE, "a channel of more than 2^31 - 1 points");
    ISO_TRY(ISO_GROW(c->point, c->capacity, c->count + 1));
    c->point[c->count++] = p;
    return ISO_OK;
}

double curve_length(const curve *c) {
    double sum = 0;
    for (int32_t i = 1; i < c->count; i++)
        sum += vec3_distance(c->point[i - 1], c->point[i]);
    if (c->closed && c->count > 0)
        sum += vec3_distance(c->point[c->count - 1], c->point[0]);
    return sum;
}

void curve_measure(double *length, const curve *c) {
    length[0] = 0;
    for (int32_t i = 1; i < c->count + c->closed; i++)
        length[i] = length[i - 1] + vec3_distance(c->point[i - 1], c->point[i % c->count]);
}

static iso_status resample(curve *made, const curve *c, double step, const double *length) {
    int32_t last = c->closed ? c->count : c->count - 1, at = 0;
    double whole = length[last], pieces = ceil(whole / step - 1e-9);
    double least = c->closed ? 3 : 1;
    if (!(pieces < 1e8))
        return iso_fail(ISO_OUTSIDE, "a channel of %g mm in steps of %g mm", whole, step);
    int32_t n = (int32_t)(pieces > least ? pieces : least);
    for (int32_t i = 0; i < n; i++) {
        double s = whole * i / n;
        while (at + 1 < last && length[at + 1] <= s)
            at++;
        double side = length[at + 1] - length[at];
        ISO_TRY(curve_add(made, vec3_between(c->point[at], c->point[(at + 1) % c->count],
                                             side > 0 ? (s - length[at]) / side : 0)));
    }
    return c->closed ? ISO_OK : curve_add(made, c->point[last]);
}

iso_status curve_resample(curve *out, const curve *c, double step) {
    double *length = NULL;
    curve made = {.closed = c->closed};
    *out = (curve){.closed = c->closed};
    if (c->count < 2)
        return iso_fail(ISO_BUG, "a channel without length");
    ISO_TRY(ISO_ALLOCATE(length, (int64_t)c->count + 1));
    curve_measure(length, c);
    iso_status status = resample(&made, c, step, length);
    iso_release(length);
    if (status == ISO_OK)
        *out = made;
    else
        curve_free(&made);
    return status;
}

static bool has_neighbours(const curve *c, int32_t i) {
    return c->closed || (i > 0 && i + 1 < c->count);
}

double curve_radius(const curve *c, int32_t i) {
    if (!has_neighbours(c, i))
        return INFINITY;
    iso_vec3 a = c->point[i > 0 ? i - 1 : c->count - 1], b = c->point[i];
    iso_vec3 d = c->point[i + 1 < c->count ? i + 1 : 0];
    iso_vec3 u = vec3_minus(b, a), v = vec3_minus(d, b);
    double twice = 2 * vec3_length(vec3_cross(u, v)); /* four times the triangle's area */
    double product = vec3_length(u) * vec3_length(v) * vec3_distance(a, d);
    return product > 0 && twice > 1e-12 * product ? product / twice : INFINITY;
}

double curve_least_radius(int32_t *at, const curve *c) {
    double least = INFINITY;
    *at = 0;
    for (int32_t i = 0; i < c->count; i++) {
        double radius = curve_radius(c, i);
        if (radius < least)
            least = radius, *at = i;
    }
    return least;
}

/* One turn. The angle that a vertex may turn by is that of a circle of the radius with the same
 * steps; a vertex that turns by more goes as far to the middle of its neighbours as would leave it
 * that angle, by half: all go at once. */
static bool relax_once(curve *c, iso_vec3 *moved, double radius, int32_t fixed) {
    bool all = true;
    for (int32_t i = 0; i < c->count; i++) {
        double r = curve_radius(c, i);
        moved[i] = c->point[i];
        if (r >= radius || (!c->closed && (i < fixed || i >= c->count - fixed)))
            continue;
        iso_vec3 a = c->point[i > 0 ? i - 1 : c->count - 1];
        iso_vec3 b = c->point[i + 1 < c->count ? i + 1 : 0];
        moved[i] =
            vec3_between(c->point[i], vec3_between(a, b, 0.5), 0.5 * (1 - r / (1.02 * radius)));
        all = false;
    }
    if (!all)
        memcpy(c->point, moved, (size_t)c->count * sizeof *moved);
    return all;
}

enum { TURNS = 40, TURNS_BETWEEN = 50 };

/* After *settled no bend is too narrow any more. */
static iso_status relax(curve *c, bool *settled, double radius, double step, int32_t fixed) {
    for (int32_t turn = 0; turn < TURNS && !*settled; turn++) {
        curve even;
        iso_vec3 *moved;
        if (c->closed && curve_length(c) < 6 * radius)
            break; /* not even a circle has room */
        ISO_TRY(curve_resample(&even, c, step));
        curve_free(c);
        *c = even;
        ISO_TRY(ISO_ALLOCATE(moved, c->count));
        bool done = *settled = relax_once(c, moved, radius, fixed);
        for (int32_t i = 0; i < TURNS_BETWEEN && !done; i++)
            done = relax_once(c, moved, radius, fixed);
        iso_release(moved);
    }
    return ISO_OK;
}

iso_status curve_relax(curve *c, double radius, double step, int32_t fixed) {
    curve made;
    bool settled = false;
    ISO_TRY(curve_resample(&made, c, step));
    curve even = made;
    even.point = NULL;
    even.capacity = 0;
    iso_status status = ISO_ALLOCATE(even.point, made.count);
    if (status == ISO_OK) {
        even.capacity = made.count;
        memcpy(even.point, made.point, (size_t)made.count * sizeof *made.point);
        status = relax(&made, &settled, radius, step, fixed);
    }
    if (status == ISO_OK) {
        bool back = c->closed && !settled; /* a ring would have shrunk to nothing */
        curve_free(c);
        *c = back ? even : made;
        curve_free(back ? &made : &even);
        return ISO_OK;
    }
    curve_free(&even);
    curve_free(&made);
    return status;
}
