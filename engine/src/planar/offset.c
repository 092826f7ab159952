/* Offsets by a raw contour and winding numbers.
 *
 * The raw contour is the convolution of the region's boundary with a circle: each edge's shifted
 * copy, joined around opening corners, and across closing corners by the chord between the two
 * copies' ends, in place of the arc run backwards. When growing, its winding about q is the Euler
 * characteristic of what the region shares with the disc around q, or more: 0 outside the offset;
 * the number of pieces inside it, at least 1, unless a whole hole fits in the disc. Such holes
 * vanish anyway and are left out beforehand; the same goes, in the complement, for islands when
 * shrinking. So winding >= 1 is the offset, exactly. (Going back through the original vertex at
 * closing corners needs no such proviso, but a fillet of n short edges then costs n^2 crossings.)
 *
 * A closing corner whose two copies meet within half of both edges is cut there at once: that is
 * the convolution of the region with the corner filled up to the circle that touches both edges,
 * which grows to the same. So is a whole fillet of short edges that all stay outside of that
 * circle. */
#include <math.h>

#include <isoslice/planar.h>

#include "planar/predicate.h"
#include "planar/region.h"
#include "planar/scratch.h"

enum { ARC_DEPTH_MAX = 10 }; /* 2^10 chords at most in one join */

typedef struct iso_side {
    iso_vec2 along; /* unit vector of the edge */
    iso_vec2 shift; /* unit vector towards the shifted copy */
    double length;
} iso_side;

typedef struct iso_rawing {
    iso_region *raw;
    int64_t count;   /* points written in raw->point */
    double distance; /* > 0 */
    double sign;     /* 1 grows, -1 shrinks */
    const iso_offset_options *options;
} iso_rawing;

iso_offset_options iso_offset_defaults(int32_t distance) {
    return (iso_offset_options){
        .distance = distance, .join = ISO_JOIN_MITRE, .mitre_limit = 2, .arc_tolerance = 50};
}

static double dot(iso_vec2 a, iso_vec2 b) {
    return a.x * b.x + a.y * b.y;
}

static double cross2(iso_vec2 a, iso_vec2 b) {
    return a.x * b.y - a.y * b.x;
}

static iso_side side_of(iso_point a, iso_point b, double sign) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y, length = sqrt(dx * dx + dy * dy);
    iso_vec2 along = {dx / length, dy / length};
    return (iso_side){along, {along.y * sign, -along.x * sign}, length};
}

/* Coordinates may leave int32 by at most the distance's mitre: clamp, edges_add will refuse them.
 */
static int32_t to_units(double x) {
    double limit = 4.0 * ISO_COORDINATE_MAX;
    return (int32_t)floor((x < -limit ? -limit : x > limit ? limit : x) + 0.5);
}

static iso_status put(iso_rawing *r, iso_point corner, iso_vec2 shift, double reach) {
    ISO_TRY(ISO_GROW(r->raw->point, r->raw->point_capacity, r->count + 1));
    r->raw->point[r->count++] =
        (iso_point){to_units(corner.x + shift.x * reach), to_units(corner.y + shift.y * reach)};
    return ISO_OK;
}

/* Unit vector half-way from a to b the short way; through `ahead` if they are opposite. */
static iso_vec2 halfway(iso_vec2 a, iso_vec2 b, iso_vec2 ahead) {
    iso_vec2 sum = {a.x + b.x, a.y + b.y};
    double length = sqrt(dot(sum, sum));
    return length < 1e-6 ? ahead : (iso_vec2){sum.x / length, sum.y / length};
}

/* The arc between the shifts a and b as tangents: the points where they meet, by halving the arc
 * until these lie within the tolerance. Tangents keep outside the circle, so that no point loses a
 * disc that covers it; the first and the last are the edges' own copies. Only square roots, and the
 * same on every machine. */
static iso_status put_arc(iso_rawing *r, iso_point corner, iso_vec2 a, iso_vec2 b, int depth) {
    double cosine = dot(a, b);
    if (cosine > -0.9 &&
        (depth == 0 || r->distance * (sqrt(2 / (1 + cosine)) - 1) <= r->options->arc_tolerance)) {
        iso_vec2 sum = {a.x + b.x, a.y + b.y};
        return put(r, corner, sum, r->distance / (1 + cosine));
    }
    iso_vec2 middle = halfway(a, b, (iso_vec2){-a.y * r->sign, a.x * r->sign});
    ISO_TRY(put_arc(r, corner, a, middle, depth - 1));
    return put_arc(r, corner, middle, b, depth - 1);
}

/* Cut square across the bisector at the distance: where that line meets the two copies. */
static iso_status put_square(iso_rawing *r, iso_point corner, const iso_side *in,
                             const iso_side *out) {
    iso_vec2 middle = halfway(in->shift, out->shift, in->along);
    double cosine = dot(in->shift, middle); /* of half the turn */
    double sine = sqrt(cosine >= 1 ? 0 : 1 - cosine * cosine);
    double slide = sine < 1e-9 ? 0 : r->distance * (1 - cosine) / sine;
    iso_vec2 a = {in->shift.x * r->distance + in->along.x * slide,
                  in->shift.y * r->distance + in->along.y * slide};
    iso_vec2 b = {out->shift.x * r->distance - out->along.x * slide,
                  out->shift.y * r->distance - out->along.y * slide};
    ISO_TRY(put(r, corner, a, 1));
    return put(r, corner, b, 1);
}

static iso_status put_opening(iso_rawing *r, iso_point corner, const iso_side *in,
                              const iso_side *out, double cosine) {
    if (r->options->join == ISO_JOIN_ROUND)
        return put_arc(r, corner, in->shift, out->shift, ARC_DEPTH_MAX);
    double mitre = sqrt(2 / (1 + cosine)); /* tip's distance, in distances */
    double limit =
        r->options->join == ISO_JOIN_MITRE ? r->options->mitre_limit : 1 + 0.5 / r->distance;
    if (cosine > -0.999 && mitre <= limit) {
        iso_vec2 sum = {in->shift.x + out->shift.x, in->shift.y + out->shift.y};
        return put(r, corner, sum, r->distance / (1 + cosine));
    }
    return put_square(r, corner, in, out);
}

/* Straight back counts as an opening corner of half a turn. */
static bool is_opening(const iso_rawing *r, const iso_side *in, const iso_side *out) {
    double sine = cross2(in->along, out->along);
    return sine * r->sign > 0 || (fabs(sine) < 1e-12 && dot(in->along, out->along) < 0);
}

enum { FILLET_EDGES = 24 }; /* short edges between the two that meet, at most */

/* Where the shifted copies of the edges before `from` and after `to` meet, within half of both. */
static bool copies_meet(iso_vec2 *meet, const iso_rawing *r, iso_point from, const iso_side *in,
                        iso_point to, const iso_side *out) {
    double sine = cross2(in->along, out->along);
    iso_vec2 apart = {(double)from.x - to.x + r->distance * (in->shift.x - out->shift.x),
                      (double)from.y - to.y + r->distance * (in->shift.y - out->shift.y)};
    if (sine * r->sign > -1e-9)
        return false;
    double back = cross2(apart, out->along) / sine, ahead = cross2(in->along, apart) / sine;
    *meet = (iso_vec2){from.x + r->distance * in->shift.x - back * in->along.x,
                       from.y + r->distance * in->shift.y - back * in->along.y};
    return back >= 0 && ahead >= 0 && 2 * back <= in->length && 2 * ahead <= out->length;
}

/* Do the lines through the short edges pass the circle around `center`? Then the edges do. */
static bool stays_outside(const iso_rawing *r, iso_vec2 center, const iso_point *point,
                          int32_t edges) {
    for (int32_t i = 0; i < edges; i++) {
        iso_side side = side_of(point[i], point[i + 1], r->sign);
        iso_vec2 reach = {center.x - point[i].x, center.y - point[i].y};
        if (dot(reach, side.shift) < r->distance - 0.5)
            return false;
    }
    return true;
}

/* Cut the closing corner at point[i], or the fillet that starts there; *in becomes the edge after
 * it. Returns the index of the corner's or the fillet's last point, or -1 if nothing can be cut. */
static int32_t find_cut(iso_vec2 *meet, iso_side *in, const iso_rawing *r, const iso_point *point,
                        int32_t count, int32_t i) {
    iso_side before = *in;
    for (int32_t last = i; last < count && last <= i + FILLET_EDGES; last++) {
        iso_side out = side_of(point[last], point[last + 1 == count ? 0 : last + 1], r->sign);
        if (is_opening(r, &before, &out))
            return -1;
        if (copies_meet(meet, r, point[i], in, point[last], &out) &&
            stays_outside(r, *meet, point + i, last - i)) {
            *in = out;
            return last;
        }
        before = out;
    }
    return -1;
}

static iso_status put_contour(iso_rawing *r, const iso_point *point, int32_t count) {
    iso_side in = side_of(point[count - 1], point[0], r->sign);
    for (int32_t i = 0; i < count; i++) {
        iso_side out = side_of(point[i], point[i + 1 == count ? 0 : i + 1], r->sign);
        iso_vec2 meet;
        if (is_opening(r, &in, &out)) {
            ISO_TRY(put_opening(r, point[i], &in, &out, dot(in.along, out.along)));
        } else if (cross2(in.along, out.along) * r->sign > -1e-9) { /* straight on */
            ISO_TRY(put(r, point[i], out.shift, r->distance));
        } else {
            int32_t last = find_cut(&meet, &in, r, point, count, i);
            if (last >= 0) {
                ISO_TRY(put(r, (iso_point){0, 0}, meet, 1));
                i = last;
                continue;
            }
            ISO_TRY(put(r, point[i], in.shift, r->distance));
            ISO_TRY(put(r, point[i], out.shift, r->distance));
        }
        in = out;
    }
    return ISO_OK;
}

/* An outer contour that shrinks, or a hole that is grown over, is gone if it fits in a band of
 * twice the distance, and so if it fits in a disc. */
static bool vanishes(const iso_point *point, int32_t count, double sign, double distance) {
    bool outer = contour_double_area(point, count) > 0;
    if (outer == (sign > 0))
        return false;
    iso_box box = {point[0], point[0]};
    for (int32_t i = 1; i < count; i++)
        box_add(&box, point[i]);
    return (double)box.max.x - box.min.x <= 2 * distance ||
           (double)box.max.y - box.min.y <= 2 * distance;
}

static iso_status draw_raw(const iso_region *in, const iso_offset_options *options,
                           iso_planar_scratch *scratch) {
    iso_region *raw = &scratch->raw;
    iso_rawing r = {.raw = raw, .options = options};
    r.sign = options->distance < 0 ? -1 : 1;
    r.distance = r.sign * (double)options->distance;
    iso_region_clear(raw);
    ISO_TRY(region_reserve(raw, in->count, in->count ? 2 * in->first[in->count] : 0));
    for (int32_t c = 0; c < in->count; c++) {
        const iso_point *point = in->point + in->first[c];
        int32_t count = in->first[c + 1] - in->first[c];
        if (count >= 3 && !vanishes(point, count, r.sign, r.distance))
            ISO_TRY(put_contour(&r, point, count));
        if (r.count > INT32_MAX)
            return iso_fail(ISO_OUTSIDE, "an offset contour has too many points");
        raw->parent[c] = -1;
        raw->first[c + 1] = (int32_t)r.count;
        raw->count = c + 1;
    }
    return ISO_OK;
}

static bool is_inside(const iso_winding *w, const void *context) {
    return w->of[0] > 0;
}

static iso_status check_range(iso_region *out, int32_t distance) {
    int32_t count = out->count ? out->first[out->count] : 0;
    for (int32_t i = 0; i < count; i++) {
        iso_point p = out->point[i];
        if (p.x >= -ISO_COORDINATE_MAX && p.x <= ISO_COORDINATE_MAX && p.y >= -ISO_COORDINATE_MAX &&
            p.y <= ISO_COORDINATE_MAX)
            continue;
        iso_region_clear(out);
        return iso_fail(ISO_OUTSIDE,
                        "an offset by %.4f mm reaches (%.4f, %.4f) mm, beyond +-%.1f mm",
                        iso_mm(distance), iso_mm(p.x), iso_mm(p.y), iso_mm(ISO_COORDINATE_MAX));
    }
    return ISO_OK;
}

static iso_status offset_once(iso_region *out, const iso_region *in,
                              const iso_offset_options *options, iso_planar_scratch *scratch) {
    scratch->edges.count = 0;
    if (options->distance == 0) {
        ISO_TRY(edges_add(&scratch->edges, in, 0));
    } else {
        ISO_TRY(draw_raw(in, options, scratch));
        ISO_TRY(edges_add_raw(&scratch->edges, &scratch->raw));
    }
    ISO_TRY(planar_resolve(&(iso_choice){out, is_inside, NULL}, 1, scratch));
    return check_range(out, options->distance);
}

/* Up to this many mean edges an offset goes in one step. The copies of n short edges that all turn
 * over cross each other n^2 times; in steps that double, the short edges are gone before the long
 * steps come. */
enum { STEP_EDGES = 32, STEPS_MAX = 8, STEP_POINTS = 64 };

/* Nor may the arcs around opening corners together get longer than so many times around all: those
 * of a comb's n teeth would cross each other n^2 times. After a short step its gaps are closed. */
#define STEP_CROWD 2.0

static double mean_edge(const iso_region *region) {
    double sum = 0;
    int32_t count = region->first[region->count];
    for (int32_t c = 0; c < region->count; c++) {
        int32_t first = region->first[c], end = region->first[c + 1];
        for (int32_t i = first; i < end; i++) {
            iso_point a = region->point[i], b = region->point[i + 1 == end ? first : i + 1];
            double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
            sum += sqrt(dx * dx + dy * dy);
        }
    }
    return sum / count;
}

/* By how much all corners open together that growing opens, in radians, those of a turn around as
 * its chord. */
static double opening(const iso_region *region) {
    double sum = 0;
    for (int32_t c = 0; c < region->count; c++) {
        int32_t first = region->first[c], end = region->first[c + 1];
        iso_side in = side_of(region->point[end - 1], region->point[first], 1);
        for (int32_t i = first; i < end; i++) {
            iso_side out =
                side_of(region->point[i], region->point[i + 1 == end ? first : i + 1], 1);
            if (cross2(in.along, out.along) > 0)
                sum += sqrt(fmax(0, 2 - 2 * dot(in.along, out.along)));
            in = out;
        }
    }
    return sum;
}

/* Once around the box. */
static double way_around(const iso_region *region) {
    iso_point low = region->point[0], high = low;
    for (int32_t i = 1; i < region->first[region->count]; i++) {
        iso_point p = region->point[i];
        low = (iso_point){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y};
        high = (iso_point){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y};
    }
    return 2 * ((double)high.x - low.x + high.y - low.y);
}

/* How many doubling steps: 1 + 2 + ... + 2^(n - 1) first steps make the distance. */
static int count_steps(const iso_region *in, double growth) {
    if (in->count == 0 || in->first[in->count] < STEP_POINTS)
        return 1;
    double distance = fabs(growth), step = STEP_EDGES * mean_edge(in);
    if (growth > 0)
        step = fmin(step, STEP_CROWD * way_around(in) / (opening(in) + 1));
    double reach = step;
    int steps = 1;
    for (; steps < STEPS_MAX && reach < distance; steps++)
        reach += step *= 2;
    return steps;
}

/* Round offsets by parts of a distance add up to that by all of it; mitres and squares don't. */
static iso_status offset_in_steps(iso_region *out, const iso_region *in,
                                  const iso_offset_options *options, int steps,
                                  iso_planar_scratch *scratch) {
    iso_offset_options part = *options;
    int64_t done = 0, shares = ((int64_t)1 << steps) - 1;
    part.arc_tolerance = options->arc_tolerance / steps > 1 ? options->arc_tolerance / steps : 1;
    for (int k = 0; k < steps; k++) {
        int64_t reach = (int64_t)options->distance * (((int64_t)2 << k) - 1) / shares;
        part.distance = (int32_t)(reach - done);
        done = reach;
        ISO_TRY(offset_once(out, k == 0 ? in : out, &part, scratch));
    }
    return ISO_OK;
}

iso_status iso_offset(iso_region *out, const iso_region *in, const iso_offset_options *options,
                      iso_planar_scratch *scratch) {
    if ((unsigned)options->join > ISO_JOIN_SQUARE || options->arc_tolerance < 1 ||
        !(options->mitre_limit >= 1)) {
        iso_region_clear(out);
        return iso_fail(ISO_USAGE,
                        "an offset needs a join, an arc tolerance of at least 1 unit and "
                        "a mitre limit of at least 1");
    }
    bool adds_up = options->join == ISO_JOIN_ROUND;
    int steps = adds_up ? count_steps(in, options->distance) : 1;
    iso_status status = steps == 1 ? offset_once(out, in, options, scratch)
                                   : offset_in_steps(out, in, options, steps, scratch);
    if (status != ISO_OK)
        iso_region_clear(out);
    return status;
}
