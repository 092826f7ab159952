#include "curved.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/series.h"
#include "base/vector.h"
#include "config/settings.h"
#include "footing.h"
#include "slice/range.h"

/* Of a layer's thickness that the tip may press into it: layers are thinner in places. */
#define TIP_SHARE 0.75

/* Layers are planned by what the field does at the part's surface: within it they may be as much
 * thicker or thinner than planned, and no more. */
#define BEYOND_PLAN 1.5

/* mm: sum of two sides of a face on which more than the corners is looked at. */
#define LARGE_FACE 6

static bool turns(const iso_options *options) {
    return options->kinematics != ISO_KINEMATICS_CARTESIAN;
}

/* ---- how thick layers are ---- */

/* mm: thickest bead that a layer may have without a limit of the user's. Blends bend layers of the
 * usual height to three halves of it at most. */
static double thickest(const iso_options *options) {
    double nozzle = options->nozzle_diameter;
    if (options->max_layer_height > 0)
        return options->max_layer_height;
    return fmax(0.75 * nozzle, fmin(nozzle, 1.5 * options->layer_height));
}

enum { PLACES_A_SIDE = 8 };

/* Places of the part to look at the field's spread: corners, and points of large faces. */
static iso_status gather_places(iso_vec3 **at, int64_t *count, const iso_object *object) {
    int64_t capacity = 0;
    for (int32_t i = 0; i < object->mesh_count; i++) {
        const iso_mesh *mesh = &object->mesh[i];
        ISO_TRY(ISO_GROW(*at, capacity, *count + mesh->vertex_count));
        memcpy(*at + *count, mesh->position, (size_t)mesh->vertex_count * sizeof **at);
        *count += mesh->vertex_count;
        for (int32_t t = 0; t < mesh->triangle_count; t++) {
            const int32_t *v = mesh->origin + 3 * (int64_t)t;
            iso_vec3 a = mesh->position[v[0]], b = mesh->position[v[1]], c = mesh->position[v[2]];
            if (vec3_distance(a, b) + vec3_distance(b, c) < LARGE_FACE)
                continue;
            ISO_TRY(ISO_GROW(*at, capacity, *count + PLACES_A_SIDE * PLACES_A_SIDE));
            for (int j = 0; j < PLACES_A_SIDE; j++)
                for (int k = 0; k < PLACES_A_SIDE - j; k++)
                    (*at)[(*count)++] = vec3_along(vec3_between(a, b, (j + 0.3) / PLACES_A_SIDE),
                                                   (k + 0.3) / PLACES_A_SIDE, vec3_minus(c, a));
        }
    }
    return ISO_OK;
}

static iso_status plan_spread(iso_curved *curved, const iso_options *options,
                              const iso_object *object) {
    spread_options limits = {.low = curved->low,
                             .high = curved->high,
                             .height = options->layer_height,
                             .least = options->min_layer_height,
                             .most = thickest(options)};
    iso_vec3 *at = NULL;
    int64_t count = 0;
    iso_status status = gather_places(&at, &count, object);
    if (status == ISO_OK)
        status = spread_plan(&curved->spread, curved->chart, at, count, &limits);
    iso_release(at);
    return status;
}

/* ---- making it ---- */

static iso_status check_options(const iso_options *options) {
    if (options->adaptive_layers)
        return iso_fail(ISO_BAD_CONFIG,
                        "adaptive_layers: layers of a field are as thick as the field says; leave "
                        "one of the two out");
    if (options->spiral_vase)
        return iso_fail(ISO_BAD_CONFIG,
                        "spiral_vase: not with layers of a field; leave one of the two out");
    return ISO_OK;
}

static iso_status make(iso_curved *curved, iso_report *report, const iso_options *options,
                       const iso_object *object) {
    iso_vec3 origin = {object->origin.x, object->origin.y, object->floor};
    ISO_TRY(iso_field_open(&curved->field, options->field, object->mesh, object->mesh_count,
                           curved_steepest(options), origin));
    if (iso_field_is_z(curved->field)) {
        curved_free(curved);
        return ISO_OK;
    }
    iso_field_kind kind = iso_field_kind_of(curved->field);
    if (kind == ISO_FIELD_GEODESIC)
        return iso_fail(ISO_BAD_CONFIG, "field: geodesic is of a model's surface only, for "
                                        "isoslice contours and channels, not for layers");
    ISO_TRY(check_options(options));
    if (options->field_flat_base && !turns(options) && kind != ISO_FIELD_AUTO_TOP)
        ISO_TRY(footing_blend(&curved->field, report, options, object));
    const iso_vec3 bead = {1, 1, 1};
    double range[2];
    curved->box[0] = vec3_minus(object->min, bead);
    curved->box[1] = vec3_plus(object->max, bead);
    const iso_vec3 box[2] = {object->min, object->max};
    ISO_TRY(field_range(range, curved->field, object->mesh, object->mesh_count));
    curved->low = range[0];
    curved->high = range[1];
    curved->margin = 4 + options->perimeters * options->nozzle_diameter * 2;
    ISO_TRY(chart_new(&curved->chart, curved->field, turns(options), box, range));
    return plan_spread(curved, options, object);
}

/* On a slope the flat tip presses into its own layer, and may do so by no more than that is thick.
 */
double curved_steepest(const iso_options *options) {
    const double degree = 180 / 3.14159265358979323846;
    if (turns(options) || !options->check_clearance)
        return options->field_slope;
    double tip =
        series_arctangent(TIP_SHARE * options->layer_height / (options->clearance_tip / 2));
    return fmin(options->field_slope, degree * tip);
}

iso_status curved_new(iso_curved *curved, iso_report *report, const iso_options *options,
                      const iso_object *object) {
    if (!options->field[0])
        return ISO_OK;
    iso_status status = make(curved, report, options, object);
    if (status != ISO_OK)
        curved_free(curved);
    return status;
}

void curved_free(iso_curved *curved) {
    chart_free(curved->chart);
    iso_field_free(curved->field);
    *curved = (iso_curved){0};
}

/* ---- levels and slices ---- */

/* Steps of the usual height do: then a first layer on the bed is as the user wants it. */
static bool are_even(const iso_curved *curved, const iso_options *options) {
    return curved->spread.doublings == 0 && curved->spread.step > 0.9 * options->layer_height;
}

static iso_status spread_levels(iso_levels *levels, const iso_curved *curved) {
    const spread *plan = &curved->spread;
    double *height;
    ISO_TRY(ISO_ALLOCATE(height, plan->count));
    for (int32_t i = 0; i < plan->count; i++)
        height[i] = plan->step;
    iso_status status =
        iso_levels_from_heights(levels, height, plan->count, (plan->count - 0.25) * plan->step);
    iso_release(height);
    return status;
}

static iso_status make_levels(iso_levels *levels, const iso_curved *curved,
                              const iso_options *options) {
    double height[ISO_NUMBERS_MAX + 1], span = curved->high - curved->low;
    int32_t count = iso_options_heights(height, options), kept = 1;
    if (!are_even(curved, options))
        return spread_levels(levels, curved);
    if (!options->field_flat_base || turns(options)) {
        height[0] = options->layer_height;
        kept = 0;
    }
    ISO_TRY(iso_levels_from_heights(levels, height, count, span));
    if (levels->count <= kept)
        return ISO_OK;
    double below = kept ? levels->top[0] : 0;
    double factor = (span - below) / (levels->top[levels->count - 1] - below);
    for (int32_t i = kept; i < levels->count; i++) {
        levels->cut[i] = below + (levels->cut[i] - below) * factor;
        levels->top[i] = below + (levels->top[i] - below) * factor;
        levels->height[i] *= factor;
    }
    return ISO_OK;
}

iso_status curved_levels(iso_levels *levels, iso_curved *curved, const iso_options *options) {
    ISO_TRY(make_levels(levels, curved, options));
    curved->thinnest = INFINITY;
    for (int32_t i = 0; i < levels->count; i++)
        curved->thinnest = fmin(curved->thinnest, levels->height[i]);
    return ISO_OK;
}

iso_status curved_slice(iso_slices *slices, const iso_curved *curved, const iso_mesh *mesh,
                        const iso_levels *levels) {
    iso_curves curves;
    iso_field_slicing slicing = iso_field_slicing_defaults();
    double *level;
    *slices = (iso_slices){0};
    ISO_TRY(ISO_ALLOCATE(level, levels->count));
    for (int32_t i = 0; i < levels->count; i++)
        level[i] = curved->low + levels->cut[i];
    iso_status status =
        iso_slice_field(&curves, mesh, curved->field, level, levels->count, &slicing);
    iso_release(level);
    ISO_TRY(status);
    status = chart_slices(slices, curved->chart, &curves, curved->margin);
    iso_curves_free(&curves);
    return status;
}

iso_status curved_volume(double *volume, const iso_curved *curved, const iso_slices *slices,
                         const iso_levels *levels, int32_t level, iso_arena *scratch) {
    const double layer[2] = {curved->low + levels->top[level], levels->height[level]};
    return chart_volume(volume, curved->chart, slices, level, layer, scratch);
}

iso_status curved_clip(iso_paths *paths, iso_paths *spare, const iso_curved *curved,
                       iso_arena *scratch) {
    if (curved_is_flat(curved) || !(chart_period(curved->chart) > 0))
        return ISO_OK;
    ISO_TRY(chart_clip_paths(spare, paths, curved->chart, scratch));
    iso_paths clipped = *spare;
    *spare = *paths;
    *paths = clipped;
    return ISO_OK;
}

/* ---- layers that merge ---- */

int32_t curved_behind(const iso_curved *curved) {
    return curved_is_flat(curved) || curved->spread.doublings == 0
               ? 0
               : 1 << (curved->spread.doublings - 1);
}

int32_t curved_merges(const iso_curved *curved, int32_t level) {
    return curved_behind(curved) == 0 ? 1 : 1 + spread_most(&curved->spread, level + 1);
}

int32_t curved_source(const iso_curved *curved, int32_t level, int32_t k) {
    return curved_behind(curved) == 0 ? level : spread_source(level + 1, k) - 1;
}

iso_status curved_part(const iso_paths **part, iso_paths *room, const iso_curved *curved,
                       const iso_paths *paths, const int32_t level_k[2], iso_arena *scratch) {
    *part = paths;
    if (curved_behind(curved) == 0)
        return ISO_OK;
    *part = room;
    const int32_t block[2] = {level_k[0] + 1, level_k[1]};
    return spread_paths(room, paths, &curved->spread, block, scratch);
}

/* ---- into space ---- */

lift_options curved_lift_options(const iso_curved *curved, const iso_options *options,
                                 const iso_levels *levels, int32_t level, int32_t k) {
    const double degree = 3.14159265358979323846 / 180;
    lift_options lift = {.r = curved->low + levels->top[level],
                         .thickness = levels->height[level] * (double)(1 << k),
                         .z = levels->top[level],
                         .tolerance = options->field_tolerance,
                         .near = options->retract_before_travel,
                         .least = options->min_layer_height / BEYOND_PLAN,
                         .most = curved->spread.thickest * BEYOND_PLAN,
                         .clearance = fmax(options->retract_lift, 2 * options->layer_height)};
    if (options->kinematics == ISO_KINEMATICS_TABLE_AC ||
        options->kinematics == ISO_KINEMATICS_TABLE_BC)
        lift.turn = degree; /* 0.01 mm between two poses 250 mm from the pivot */
    lift.arcs = options->kinematics == ISO_KINEMATICS_ROTARY_A ||
                options->kinematics == ISO_KINEMATICS_ROTARY_B;
    if (!turns(options)) {
        lift.slope = series_tangent(options->field_slope * degree);
        lift.tip = options->clearance_tip / 2;
    }
    return lift;
}

iso_status curved_lift(iso_paths *out, const iso_curved *curved, const iso_paths *flat,
                       const lift_options *options, iso_arena *scratch) {
    return lift_paths(out, flat, curved->chart, options, scratch);
}
