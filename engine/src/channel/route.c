#include "channel/route.h"

/* The edge of the ring that passes a place along the side nearest to it; -1: none. */
static int32_t find_front(const curve *ring, double middle, const port_side *side) {
    double front = -INFINITY;
    int32_t found = -1;
    for (int32_t i = 0; i < ring->count; i++) {
        iso_vec3 a = ring->point[i], b = ring->point[i + 1 < ring->count ? i + 1 : 0];
        double x = vec3_dot(a, side->along) - middle, y = vec3_dot(b, side->along) - middle;
        double at = vec3_dot(a, side->out);
        if ((x <= 0) != (y <= 0) && at > front)
            front = at, found = i;
    }
    return found;
}

/* Steps from point `from` in a direction until it is `half` off the middle. */
static int32_t walk(iso_vec3 *end, const curve *ring, int32_t from, int32_t direction,
                    const double limit[2], const port_side *side) {
    int32_t n = ring->count;
    iso_vec3 before = ring->point[(from - direction + n) % n];
    for (int32_t k = 0; k < n; k++) {
        iso_vec3 at = ring->point[((from + direction * k) % n + n) % n];
        double x = vec3_dot(before, side->along), y = vec3_dot(at, side->along);
        for (int edge = 0; edge < 2; edge++)
            if (edge == 0 ? y <= limit[0] : y >= limit[1]) {
                double share = y != x ? (limit[edge] - x) / (y - x) : 1;
                *end = vec3_between(before, at, share < 0 ? 0 : share > 1 ? 1 : share);
                return k;
            }
        before = at;
    }
    return n;
}

static iso_status fail_small(const curve *ring, const port_side *side) {
    iso_vec3 at = ring->point[0];
    return iso_fail(ISO_NOT_VERIFIED,
                    "the ring at (%.2f, %.2f, %.2f), %.4g mm long, has no room for an inlet and an "
                    "outlet %.4g mm apart: closed rings or a smaller section have",
                    at.x, at.y, at.z, curve_length(ring), 2 * side->half);
}

static iso_status open_at(curve *out, bool *done, const curve *ring, double middle,
                          const port_side *side) {
    iso_vec3 first, last;
    int32_t n = ring->count, front = find_front(ring, middle, side);
    *done = false;
    if (front < 0)
        return ISO_OK;
    double limit[2] = {middle - side->half, middle + side->half};
    int32_t ahead = walk(&first, ring, (front + 1) % n, 1, limit, side);
    int32_t back = walk(&last, ring, front, -1, limit, side);
    bool right = vec3_dot(first, side->along) > middle;
    if (ahead + back > n / 2 || right == (vec3_dot(last, side->along) > middle))
        return ISO_OK;
    int32_t count = n - ahead - back, begin = front + 1 + ahead;
    ISO_TRY(curve_add(out, right ? first : last));
    for (int32_t k = 0; k < count; k++)
        ISO_TRY(curve_add(out, ring->point[(begin + (right ? k : count - 1 - k)) % n]));
    *done = true;
    return curve_add(out, right ? last : first);
}

/* Places that are tried, in shares of the ring's width from its middle. */
static const double tried[] = {0, 0.1, -0.1, 0.2, -0.2, 0.3, -0.3, 0.4, -0.4};
enum { TRIED = sizeof tried / sizeof *tried };

iso_status route_open(curve *out, double *middle, const curve *ring, const port_side *side) {
    double low = INFINITY, high = -INFINITY;
    bool done = false;
    *out = (curve){0};
    for (int32_t i = 0; i < ring->count; i++) {
        double x = vec3_dot(ring->point[i], side->along);
        low = x < low ? x : low;
        high = x > high ? x : high;
    }
    iso_status status = isnan(*middle) ? ISO_OK : open_at(out, &done, ring, *middle, side);
    for (int k = 0; k < TRIED && !done && status == ISO_OK; k++) {
        *middle = low + (0.5 + tried[k]) * (high - low);
        status = open_at(out, &done, ring, *middle, side);
    }
    if (status == ISO_OK && !done)
        status = fail_small(ring, side);
    if (status != ISO_OK)
        curve_free(out);
    return status;
}

iso_status route_append(curve *out, const curve *opened, bool backwards) {
    for (int32_t i = 0; i < opened->count; i++)
        ISO_TRY(curve_add(out, opened->point[backwards ? opened->count - 1 - i : i]));
    return ISO_OK;
}

/* Where it leaves the mould, to a unit of the planar kernel: the side has a hole of these points.
 */
static iso_vec3 foot(double *leg, iso_vec3 p, const port_side *side) {
    *leg = side->face - vec3_dot(p, side->out);
    p.z = iso_mm(iso_units(p.z));
    if (side->axis == 0)
        p = (iso_vec3){side->out.x * side->face, iso_mm(iso_units(p.y)), p.z};
    else
        p = (iso_vec3){iso_mm(iso_units(p.x)), side->out.y * side->face, p.z};
    return p;
}

iso_status route_ports(curve *out, double leg[2], const curve *way, const port_side *side) {
    *out = (curve){0};
    iso_vec3 in = foot(&leg[0], way->point[0], side);
    iso_vec3 away = foot(&leg[1], way->point[way->count - 1], side);
    iso_status status = curve_add(out, in);
    /* legs run straight at the side: their inner ends are right behind their feet */
    for (int32_t i = 0; i < way->count && status == ISO_OK; i++) {
        iso_vec3 p = way->point[i];
        if (i == 0)
            p = vec3_along(in, -leg[0], side->out);
        else if (i + 1 == way->count)
            p = vec3_along(away, -leg[1], side->out);
        status = curve_add(out, p);
    }
    if (status == ISO_OK)
        status = curve_add(out, away);
    if (status != ISO_OK)
        curve_free(out);
    return status;
}
