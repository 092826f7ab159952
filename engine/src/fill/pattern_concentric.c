/* Successive insets: as walls, but as far apart as the fill's lines. */
#include <math.h>

#include "fill/pattern.h"

enum { THINNING = 20 }; /* units; each loop would carry all the points of those around it */

typedef struct room {
    iso_region a, b, half, whole;
} room;

static iso_status inset(iso_region *out, const iso_region *in, double distance, room *spare,
                        iso_planar_scratch *planar) {
    iso_offset_options options = iso_offset_defaults(-(int32_t)(distance + 0.5));
    ISO_TRY(iso_offset(&spare->whole, in, &options, planar));
    return iso_region_simplify(out, &spare->whole, THINNING, planar);
}

static double loop_length(const iso_point *point, int32_t count) {
    double length = 0;
    for (int32_t i = 0, last = count - 1; i < count; last = i++) {
        double dx = (double)point[i].x - point[last].x, dy = (double)point[i].y - point[last].y;
        length += sqrt(dx * dx + dy * dy);
    }
    return length;
}

typedef struct rings {
    iso_paths *out;
    const iso_fill_options *options;
    double spacing, share; /* between loops; of the usual volume */
    int32_t rank;
} rings;

static iso_status draw_contour(const rings *r, const iso_region *region, int32_t m) {
    const iso_fill_options *options = r->options;
    const iso_point *point = region->point + region->first[m];
    int32_t count = region->first[m + 1] - region->first[m];
    iso_path like = options->like;
    like.closed = 1;
    like.rank += r->rank;
    if (count < 3 || loop_length(point, count) <= options->shortest)
        return ISO_OK;
    double bead = iso_pattern_bead(options), width = options->width + (r->share - 1) * bead;
    return iso_paths_add(r->out, &like, point, count, (int32_t)(width + 0.5),
                         (int32_t)(options->area * r->share + 0.5));
}

static iso_status draw_loops(const rings *r, const iso_region *region) {
    for (int32_t m = 0; m < region->count; m++)
        ISO_TRY(draw_contour(r, region, m));
    return ISO_OK;
}

/* Is a point of `inner` within contour m? Then the whole part of it is. */
static int has_within(const iso_region *region, int32_t m, const iso_region *inner) {
    int32_t first[2] = {0, region->first[m + 1] - region->first[m]};
    iso_region contour = {.count = 1, .first = first, .point = region->point + region->first[m]};
    for (int32_t i = 0; i < inner->count; i++)
        if (inner->parent[i] < 0 && iso_region_locate(&contour, inner->point[inner->first[i]]) >= 0)
            return 1;
    return 0;
}

/* Parts that the next inset swallows may leave up to two spacings open in their middle. Those with
 * more than one get a loop half a spacing in. */
static iso_status draw_middles(const rings *r, const iso_region *now, const iso_region *next,
                               room *spare, iso_planar_scratch *planar) {
    iso_region *half = &spare->half;
    ISO_TRY(inset(half, now, r->spacing / 2, spare, planar));
    for (int32_t m = 0; m < half->count; m++)
        if (half->parent[m] < 0 && !has_within(half, m, next))
            ISO_TRY(draw_contour(r, half, m));
    return ISO_OK;
}

static iso_status draw_rings(rings *r, const iso_region *region, room *spare,
                             iso_planar_scratch *planar) {
    const iso_region *now = region;
    iso_region *next = &spare->a;
    for (; now->count > 0; r->rank++) {
        ISO_TRY(draw_loops(r, now));
        ISO_TRY(inset(next, now, r->spacing, spare, planar));
        r->rank++;
        if (r->options->density < 1)
            ISO_TRY(draw_middles(r, now, next, spare, planar));
        r->rank--;
        now = next;
        next = next == &spare->a ? &spare->b : &spare->a;
    }
    return ISO_OK;
}

/* The largest inset that leaves anything, to a sixteenth of a spacing. */
static iso_status find_depth(double *depth, const iso_region *region, double spacing, room *spare,
                             iso_planar_scratch *planar) {
    const iso_region *now = region;
    iso_region *next = &spare->a;
    double step = spacing;
    *depth = 0;
    while (step > spacing / 20) {
        ISO_TRY(inset(next, now, step, spare, planar));
        if (next->count == 0) {
            step /= 2;
            continue;
        }
        *depth += step;
        now = next;
        next = next == &spare->a ? &spare->b : &spare->a;
    }
    *depth += step;
    return ISO_OK;
}

/* Loops of a solid fill are spread so that those around its deepest place are a spacing apart
 * there, and draw the more or the less. */
static iso_status draw_all(rings *r, const iso_region *region, room *spare,
                           iso_planar_scratch *planar) {
    if (r->options->density >= 1) {
        double depth;
        ISO_TRY(find_depth(&depth, region, r->spacing, spare, planar));
        double count = floor(depth / r->spacing); /* of loops but the first */
        r->share = depth / (r->spacing * (count + 0.5));
        if (r->share < 0.75 || r->share > 1.25) /* a loop or two: nothing to spread over */
            r->share = 1;
        r->spacing *= r->share;
    }
    return draw_rings(r, region, spare, planar);
}

iso_status iso_pattern_concentric(iso_paths *out, const iso_region *region,
                                  const iso_fill_options *options, iso_planar_scratch *planar) {
    rings r = {.out = out, .options = options, .spacing = options->spacing, .share = 1};
    room spare = {0};
    iso_status status = draw_all(&r, region, &spare, planar);
    iso_region_free(&spare.a);
    iso_region_free(&spare.b);
    iso_region_free(&spare.half);
    iso_region_free(&spare.whole);
    return status;
}
