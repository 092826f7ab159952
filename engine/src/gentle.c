#include "gentle.h"

#include <math.h>

#include "base/series.h"
#include "base/vector.h"
#include "field/field.h"

#define PI 3.14159265358979323846

/* Boxes that are looked at before giving up: some milliseconds' worth. */
enum { BOXES = 32768 };

/* mm: of boxes that may be steeper, as where a cone has its axis and all its slopes are in one box;
 * and how far such boxes may be apart. A way of that length rises by little more than elsewhere. */
#define KINK 0.5
#define KINKS 2.0
#define KINKS_RISE 1.0

typedef struct survey {
    const iso_field *field;
    double near; /* tangent that no level surface may exceed, for what is right above the tip, */
    double far;  /* and for all else, but for a kink */
    double tip;  /* mm: half the flat tip, which may press as deep as the layer is thick there: */
    double thinnest, margin;      /* its thickness in F, and what of it is used up, mm */
    int32_t left;                 /* boxes */
    iso_vec2 kink_low, kink_high; /* around all kinks, seen from above */
    double bend[2]; /* least and greatest of F - z: a level's heights differ by no more */
} survey;

static double larger(double low, double high) {
    return fmax(fabs(low), fabs(high));
}

/* One of few steep boxes close to each other? */
static bool is_kink(survey *s, iso_vec3 low, iso_vec3 high) {
    if (high.x - low.x > KINK || high.y - low.y > KINK)
        return false;
    s->kink_low = (iso_vec2){fmin(s->kink_low.x, low.x), fmin(s->kink_low.y, low.y)};
    s->kink_high = (iso_vec2){fmax(s->kink_high.x, high.x), fmax(s->kink_high.y, high.y)};
    return s->kink_high.x - s->kink_low.x <= KINKS && s->kink_high.y - s->kink_low.y <= KINKS;
}

static void take_bend(survey *s, const iso_field_bound *b, iso_vec3 low, iso_vec3 high) {
    iso_vec3 middle = vec3_between(low, high, 0.5), half = vec3_minus(high, middle);
    double value, reach = half.x * larger(b->gradient_low.x, b->gradient_high.x) +
                          half.y * larger(b->gradient_low.y, b->gradient_high.y) +
                          half.z * larger(b->gradient_low.z - 1, b->gradient_high.z - 1);
    iso_field_evaluate(&value, NULL, s->field, &middle, 1);
    s->bend[0] = fmin(s->bend[0], value - middle.z - reach);
    s->bend[1] = fmax(s->bend[1], value - middle.z + reach);
}

static bool holds(survey *s, iso_vec3 low, iso_vec3 high) {
    iso_field_bound b;
    iso_field_bound_over(&b, s->field, low, high);
    double x = larger(b.gradient_low.x, b.gradient_high.x);
    double y = larger(b.gradient_low.y, b.gradient_high.y);
    double across = sqrt(x * x + y * y), z = b.gradient_low.z, steepest = b.gradient_high.z;
    double gradient = sqrt(across * across + steepest * steepest);
    bool fine = z > 0 && across <= s->near * z &&
                (s->tip * across / z + s->margin) * gradient <= s->thinnest &&
                (across <= s->far * z || is_kink(s, low, high));
    if (fine)
        take_bend(s, &b, low, high);
    return fine;
}

/* mm: what isn't known of a box as small as this never will be. */
#define SMALLEST 0.1

/* In eighths, for as long as it takes. */
static bool look(survey *s, iso_vec3 low, iso_vec3 high) {
    if (s->left-- <= 0)
        return false;
    if (holds(s, low, high))
        return true;
    if (high.x - low.x < SMALLEST)
        return false;
    iso_vec3 middle = vec3_between(low, high, 0.5);
    for (int k = 0; k < 8; k++) {
        iso_vec3 from = {k & 1 ? middle.x : low.x, k & 2 ? middle.y : low.y,
                         k & 4 ? middle.z : low.z};
        iso_vec3 to = {k & 1 ? high.x : middle.x, k & 2 ? high.y : middle.y,
                       k & 4 ? high.z : middle.z};
        if (!look(s, from, to))
            return false;
    }
    return true;
}

static double farthest(iso_vec2 low, iso_vec2 high) {
    double x = larger(low.x, high.x), y = larger(low.y, high.y);
    return sqrt(x * x + y * y);
}

/* What begins at that height and reaches that far must not be steeper to reach. */
static double limit(double slope, double height, double reach) {
    return reach > 0 ? fmin(slope, height / reach) : slope;
}

/* Of the cone's side. */
static double steepest_near(const clearance_tool *tool, double margin) {
    double side = series_tangent(tool->cone_angle * PI / 180);
    return limit(1, tool->cone_height - margin, tool->tip_diameter / 2 + tool->cone_height * side);
}

/* Of block and carriage, on a part whose places are at most `across` apart. */
static double steepest_far(const clearance_tool *tool, double across, double margin) {
    double slope = limit(1, tool->cone_height - margin,
                         fmin(farthest(tool->block_low, tool->block_high), across));
    return limit(slope, tool->carriage_height - margin,
                 fmin(farthest(tool->carriage_low, tool->carriage_high), across));
}

static bool is_free_upright(const iso_curved *curved, const clearance_tool *tool,
                            double tolerance) {
    iso_vec3 low = curved->box[0], high = curved->box[1];
    double x = high.x - low.x, y = high.y - low.y, across = sqrt(x * x + y * y);
    double margin = 2 * tolerance + CLEARANCE_TOLERANCE;
    survey s = {.field = curved->field,
                .near = steepest_near(tool, margin),
                .far = steepest_far(tool, across, margin + KINKS_RISE),
                .tip = tool->tip_diameter / 2,
                .thinnest = curved->thinnest,
                .margin = margin,
                .left = BOXES,
                .kink_low = {INFINITY, INFINITY},
                .kink_high = {-INFINITY, -INFINITY},
                .bend = {INFINITY, -INFINITY}};
    if (chart_kind_of(curved->chart) != CHART_GRAPH || !(s.near > 0 && s.far > 0))
        return false;
    /* between two places of the part a layer may run outside its box */
    double beyond = fmin(s.far, s.near) * across + KINKS_RISE;
    low.z -= beyond;
    high.z += beyond;
    return look(&s, low, high) &&
           (!(tool->gantry_height > 0) || s.bend[1] - s.bend[0] <= tool->gantry_height - margin);
}

/* Near its axis a turning table is left as it stands (POSE_POLE): radians that the tool may be off
 * square there, and a little more. Its own cone and tip don't come near anything by that. */
#define POLE 0.01

/* A tool square on a cylinder or a sphere is outside of it, whatever its shape, and all that is
 * printed is inside. A half plane of a fan has it all on one side, for half a turn. */
static bool is_free_square(const iso_curved *curved, const clearance_tool *tool) {
    double across = vec3_distance(curved->box[0], curved->box[1]);
    if (steepest_far(tool, across, CLEARANCE_TOLERANCE) < POLE ||
        (tool->gantry_height > 0 && tool->gantry_height < POLE * across))
        return false;
    switch (chart_kind_of(curved->chart)) {
    case CHART_CYLINDER:
    case CHART_SPHERE:
        return true;
    case CHART_FAN:
        return curved->high - curved->low <= PI * field_shape_of(curved->field).radius;
    default:
        return false;
    }
}

bool gentle_is_free(const iso_curved *curved, const clearance_tool *tool, double tolerance,
                    bool bare) {
    if (tool->turning == CLEARANCE_UPRIGHT)
        return is_free_upright(curved, tool, tolerance);
    return bare && is_free_square(curved, tool);
}
