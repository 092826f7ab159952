/* Layers that lie as the tops of a model do: F = z - ramp(z) h(x, y), with h from fit.h.
 *
 * F rises by at least MOST_THICK a mm everywhere: h is a B-spline, which stays within its control
 * points' range, and that is kept below (1 - MOST_THICK) / the ramp's steepest slope. */
#include <math.h>
#include <stddef.h>

#include "base/angle.h"
#include "base/memory.h"
#include "field/field.h"
#include "height/fields.h"
#include "height/fit.h"

/* Rise of F a mm: layers are printed so many times as thick as they are counted at most, and so
 * many times as thin. */
#define MOST_THICK 0.5
#define MOST_THIN 2.0
/* mm, and share of the height, that layers stay flat at the foot. */
#define FLAT 1.0
#define FLAT_SHARE 0.1
/* Height over which layers take on their curve, against how far that goes up and down: the more,
 * the more evenly thick they are. */
#define GENTLE 4
/* The grid: points in all, mm between them at least, points around the model. */
#define POINTS 10000.0
#define FINEST 0.25
#define MARGIN 3
/* mm: layers that are bent in full wherever the model is. */
#define FAR 1e4
/* mm, of the control points: the solver's last bits don't matter then. */
#define GRAIN 0x1p-20

typedef struct auto_top_field {
    iso_field field;
    spline height;
    ramp ramp;
} auto_top_field;

static void evaluate(double *value, iso_vec3 *gradient, const iso_field *field, const iso_vec3 *at,
                     int64_t count) {
    const auto_top_field *f = (const auto_top_field *)field;
    for (int64_t i = 0; i < count; i++) {
        double z = at[i].z, a = ramp_at(&f->ramp, z);
        spline_sample h = spline_at(&f->height, at[i].x, at[i].y);
        value[i] = z - a * h.value;
        if (gradient)
            gradient[i] = (iso_vec3){-a * h.x, -a * h.y, 1 - ramp_slope(&f->ramp, z) * h.value};
    }
}

static interval value_at(const void *context, iso_vec3 at) {
    double value;
    evaluate(&value, NULL, context, &at, 1);
    return interval_outward(value, value, 1e-14);
}

static void bound(iso_field_bound *b, const iso_field *field, iso_vec3 low, iso_vec3 high) {
    const auto_top_field *f = (const auto_top_field *)field;
    interval h[3], slope[3], z = {low.z, high.z};
    spline_bound(h, &f->height, (iso_vec2){low.x, low.y}, (iso_vec2){high.x, high.y});
    interval a = ramp_over(&f->ramp, low.z, high.z);
    interval rise = ramp_slope_over(&f->ramp, low.z, high.z);
    slope[0] = interval_negate(interval_multiply(a, h[1]));
    slope[1] = interval_negate(interval_multiply(a, h[2]));
    slope[2] = interval_subtract(interval_at(1), interval_multiply(rise, h[0]));
    field_bound_set(b, interval_subtract(z, interval_multiply(a, h[0])), slope);
    field_bound_narrow(b, value_at, f, low, high);
}

static void release(iso_field *field) {
    auto_top_field *f = (auto_top_field *)field;
    iso_release(f->height.control);
    iso_release(f);
}

static const field_operations operations = {ISO_FIELD_AUTO_TOP, evaluate, bound, release};

typedef struct box {
    iso_vec3 low, high;
} box;

static box box_of(const iso_mesh *mesh, int32_t count) {
    box b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int32_t i = 0; i < count; i++) {
        if (mesh[i].triangle_count == 0)
            continue;
        b.low.x = fmin(b.low.x, mesh[i].min.x);
        b.low.y = fmin(b.low.y, mesh[i].min.y);
        b.low.z = fmin(b.low.z, mesh[i].min.z);
        b.high.x = fmax(b.high.x, mesh[i].max.x);
        b.high.y = fmax(b.high.y, mesh[i].max.y);
        b.high.z = fmax(b.high.z, mesh[i].max.z);
    }
    return b;
}

static iso_status make_grid(spline *s, const box *b) {
    double width = b->high.x - b->low.x, depth = b->high.y - b->low.y;
    s->step = fmax(FINEST, sqrt(width * depth / POINTS));
    /* of a long thin model */
    s->step = fmax(s->step, fmax(width, depth) / POINTS);
    s->columns = (int32_t)ceil(width / s->step) + 1 + 2 * MARGIN;
    s->rows = (int32_t)ceil(depth / s->step) + 1 + 2 * MARGIN;
    s->corner = (iso_vec2){b->low.x - MARGIN * s->step, b->low.y - MARGIN * s->step};
    int64_t points = (int64_t)s->columns * s->rows;
    ISO_TRY(ISO_ALLOCATE(s->control, points));
    memset(s->control, 0, (size_t)points * sizeof *s->control);
    return ISO_OK;
}

/* How far a free fit goes up and down over the tops, and how high those reach. */
static void extent(double *range, double *highest, const spline *s, const tops *t) {
    double low = INFINITY, high = -INFINITY;
    *highest = -INFINITY;
    for (int64_t i = 0; i < t->count; i++) {
        double h = spline_at(s, t->top[i].x, t->top[i].y).value;
        low = fmin(low, h);
        high = fmax(high, h);
        *highest = fmax(*highest, t->top[i].z);
    }
    *range = high - low;
}

static void round_off(spline *s) {
    for (int64_t k = 0; k < (int64_t)s->columns * s->rows; k++) {
        double grains = s->control[k] / GRAIN;
        s->control[k] = GRAIN * (double)(int64_t)(grains < 0 ? grains - 0.5 : grains + 0.5);
    }
}

static iso_status fit_tops(auto_top_field *f, const tops *t, const box *b, double slope) {
    const ramp everywhere = {b->low.z - 2 * FAR, FAR};
    double range, highest;
    if (t->count == 0)
        return ISO_OK;
    ISO_TRY(fit_freely(&f->height, t, &everywhere));
    extent(&range, &highest, &f->height, t);
    double tall = highest - b->low.z, flat = fmin(FLAT, FLAT_SHARE * tall);
    f->ramp = (ramp){b->low.z + flat, fmax(fmin(tall - flat, GENTLE * range), 0.1)};
    const fit_limits limits = {slope, MOST_THICK, MOST_THIN, b->low.z};
    ISO_TRY(fit_within(&f->height, t, &f->ramp, &limits));
    round_off(&f->height);
    return ISO_OK;
}

static iso_status make(auto_top_field *f, const iso_mesh *mesh, int32_t count, double degrees) {
    box b = box_of(mesh, count);
    if (!(b.low.x < b.high.x))
        return iso_fail(ISO_USAGE, "auto-top looks at the tops of a model, and there is none");
    double sine, cosine;
    iso_sine_cosine(&sine, &cosine, degrees);
    tops t;
    ISO_TRY(make_grid(&f->height, &b));
    ISO_TRY(tops_find(&t, &f->height, mesh, count, sine / cosine));
    iso_status status = fit_tops(f, &t, &b, sine / cosine);
    tops_free(&t);
    return status;
}

iso_status height_new_auto_top(iso_field **field, const iso_mesh *mesh, int32_t count,
                               double slope) {
    auto_top_field *f;
    *field = NULL;
    if (!(slope >= 0 && slope < 90))
        return iso_fail(ISO_BAD_CONFIG, "layers at %g degrees: it must be 0 to less than 90",
                        slope);
    ISO_TRY(ISO_ALLOCATE(f, 1));
    *f = (auto_top_field){.field = {&operations}, .ramp = {0, 1}};
    iso_status status = make(f, mesh, count, slope);
    if (status != ISO_OK) {
        release(&f->field);
        return status;
    }
    *field = &f->field;
    return ISO_OK;
}
