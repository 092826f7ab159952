/* Thinning of contours: from each point kept, the longest chord that passes within the tolerance of
 * every point it skips. The directions such chords may take form a sector that each skipped point
 * narrows, so one pass does it (Imai and Iri 1988, greedily). */
#include <math.h>

#include <isoslice/planar.h>

#include "planar/predicate.h"
#include "planar/region.h"
#include "planar/scratch.h"

typedef struct iso_sector {
    iso_vec2 left, right; /* directions counter-clockwise from right to left */
    bool open;            /* nothing skipped yet is farther than the tolerance */
    double farthest;      /* squared distance of the farthest point skipped */
} iso_sector;

static double cross2(iso_vec2 a, iso_vec2 b) {
    return a.x * b.y - a.y * b.x;
}

static bool sector_holds(const iso_sector *s, iso_vec2 v) {
    return s->open || (cross2(s->right, v) >= 0 && cross2(v, s->left) >= 0);
}

/* May the chord end at v, all points so far skipped? Contours that turn back end the chord. */
static bool chord_fits(const iso_sector *s, iso_vec2 v) {
    return sector_holds(s, v) && v.x * v.x + v.y * v.y >= s->farthest;
}

/* Skip the point v: chords must pass the circle around it. The tangents from the origin to it are v
 * turned by +- asin(tolerance / |v|), scaled. */
static void sector_skip(iso_sector *s, iso_vec2 v, double tolerance) {
    double square = v.x * v.x + v.y * v.y;
    s->farthest = square > s->farthest ? square : s->farthest;
    if (square <= tolerance * tolerance)
        return;
    double along = sqrt(square - tolerance * tolerance);
    iso_vec2 left = {v.x * along - v.y * tolerance, v.y * along + v.x * tolerance};
    iso_vec2 right = {v.x * along + v.y * tolerance, v.y * along - v.x * tolerance};
    if (s->open) {
        *s = (iso_sector){left, right, false, s->farthest};
        return;
    }
    if (cross2(left, s->left) > 0)
        s->left = left;
    if (cross2(s->right, right) > 0)
        s->right = right;
}

static bool is_straight(iso_point a, iso_point b, iso_point c) {
    return orient2d(a, b, c) == 0 && box_holds(a, c, b);
}

/* Thin one contour to `to`, starting from its lexicographic least point so that the result doesn't
 * depend on where the contour happens to start. Returns the number of points kept. */
static int32_t thin(iso_point *to, const iso_point *point, int32_t count, double tolerance) {
    int32_t start = 0, kept = 0;
    for (int32_t i = 1; i < count; i++)
        if (point_less(point[i], point[start]))
            start = i;
    iso_point anchor = point[start];
    iso_sector sector = {.open = true};
    to[kept++] = anchor;
    iso_point last = anchor; /* the chord's end so far */
    for (int32_t i = 1; i <= count; i++) {
        int32_t at = start + i;
        iso_point p = point[at < count ? at : at - count];
        iso_vec2 v = {(double)p.x - anchor.x, (double)p.y - anchor.y};
        bool fits = tolerance > 0 ? chord_fits(&sector, v) : is_straight(anchor, last, p);
        if (i > 1 && !fits) {
            to[kept++] = anchor = last;
            sector = (iso_sector){.open = true};
            v = (iso_vec2){(double)p.x - anchor.x, (double)p.y - anchor.y};
        }
        if (tolerance > 0)
            sector_skip(&sector, v, tolerance);
        last = p;
    }
    return kept;
}

iso_status iso_region_simplify(iso_region *out, const iso_region *in, int32_t tolerance,
                               iso_planar_scratch *scratch) {
    iso_region *raw = &scratch->raw;
    iso_region_clear(out);
    iso_region_clear(raw);
    if (tolerance < 0)
        return iso_fail(ISO_USAGE, "a tolerance can't be negative");
    ISO_TRY(region_reserve(raw, in->count, in->count ? in->first[in->count] : 0));
    for (int32_t c = 0; c < in->count; c++) {
        const iso_point *point = in->point + in->first[c];
        int32_t count = in->first[c + 1] - in->first[c], used = raw->first[c];
        int32_t kept = count ? thin(raw->point + used, point, count, tolerance) : 0;
        raw->parent[c] = -1;
        raw->first[c + 1] = used + kept;
        raw->count = c + 1;
    }
    return iso_region_clean(out, raw, ISO_FILL_POSITIVE, scratch);
}
