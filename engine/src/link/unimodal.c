/* The conditions are those of slice/refine.c, for faces of any degree: F is monotonic along every
 * edge that a level comes near, goes up once and down once around the face, and rises along some
 * line of the face's plane all over it. Faces that aren't flat count as lying in the plane that is
 * nearest to them. */
#include "link/unimodal.h"

#include <stdbool.h>

#include "base/vector.h"
#include "slice/bounds.h"
#include "slice/search.h"

/* mm, as refine.c has it: all of a face with less is on the level. */
#define FLAT 1e-6

typedef struct checker {
    const iso_double_link *surface;
    const iso_field *field;
    const double *height, *level;
    int32_t level_count;
    double scale;
} checker;

static iso_vec3 place_of(const checker *c, int32_t dart) {
    const double *g = c->surface->link.g + 3 * (int64_t)dart;
    return vec3(g[0], g[1], g[2]);
}

static bool meets_level(const checker *c, double low, double high) {
    int32_t i = levels_first_at(c->level, c->level_count, c->scale, low);
    return high - low > FLAT && i < c->level_count && c->level[i] < high;
}

/* F may be below `low` or above `high`, its values at corners, by half the spread `of`. */
static bool may_meet(const checker *c, double low, double high, double of, const bounds *bound) {
    return meets_level(c, fmax(low - 0.5 * of, bound->low), fmin(high + 0.5 * of, bound->high));
}

static bool is_edge_steady(const checker *c, int32_t a) {
    int32_t b = iso_double_link_alpha(c->surface, a);
    iso_vec3 p = place_of(c, a), q = place_of(c, b), edge = vec3_minus(q, p);
    bounds bound = bounds_over(c->field, vec3(fmin(p.x, q.x), fmin(p.y, q.y), fmin(p.z, q.z)),
                               vec3(fmax(p.x, q.x), fmax(p.y, q.y), fmax(p.z, q.z)));
    double spread = bounds_spread(&bound, edge);
    return fabs(vec3_dot(bound.middle, edge)) > spread ||
           !may_meet(c, fmin(c->height[a], c->height[b]), fmax(c->height[a], c->height[b]), spread,
                     &bound);
}

typedef struct face {
    int32_t dart; /* the lowest */
    iso_vec3 low, high, normal;
    double least, most; /* of the heights */
    int rises;          /* of the heights, around the face: runs of them */
} face;

static face read_face(const checker *c, int32_t dart) {
    face f = {
        dart, place_of(c, dart), place_of(c, dart), {0, 0, 0}, c->height[dart], c->height[dart], 0};
    int32_t a = dart;
    bool up = false, first_up = false, known = false;
    do {
        int32_t b = iso_double_link_alpha(c->surface, a);
        iso_vec3 p = place_of(c, a), q = place_of(c, b);
        f.low = vec3(fmin(f.low.x, p.x), fmin(f.low.y, p.y), fmin(f.low.z, p.z));
        f.high = vec3(fmax(f.high.x, p.x), fmax(f.high.y, p.y), fmax(f.high.z, p.z));
        f.least = fmin(f.least, c->height[a]);
        f.most = fmax(f.most, c->height[a]);
        iso_vec3 from = place_of(c, dart);
        f.normal = vec3_plus(f.normal, vec3_cross(vec3_minus(p, from), vec3_minus(q, from)));
        if (c->height[a] != c->height[b]) {
            bool now = c->height[a] < c->height[b];
            f.rises += known && now && !up;
            first_up = known ? first_up : now;
            up = now;
            known = true;
        }
        a = b;
    } while (a != dart);
    f.rises += known && first_up && !up;
    return f;
}

static bool rises_along_a_line(const face *f, const bounds *bound) {
    double n2 = vec3_dot(f->normal, f->normal);
    if (!(n2 > 0))
        return true;
    iso_vec3 g = bound->middle;
    iso_vec3 way = vec3_along(g, -vec3_dot(g, f->normal) / n2, f->normal);
    return vec3_dot(g, way) > bounds_spread(bound, way);
}

static bool is_unimodal(const checker *c, const face *f) {
    bounds bound = bounds_over(c->field, f->low, f->high);
    double across = bounds_spread(&bound, vec3_minus(f->high, f->low));
    if (!may_meet(c, f->least, f->most, 2 * across, &bound))
        return true;
    if (f->rises > 1 || !rises_along_a_line(f, &bound))
        return false;
    int32_t a = f->dart;
    do {
        if (!is_edge_steady(c, a))
            return false;
        a = iso_double_link_alpha(c->surface, a);
    } while (a != f->dart);
    return true;
}

iso_status unimodal_check(const iso_double_link *surface, const iso_field *field,
                          const double *height, const double *level, int32_t level_count) {
    if (level_count == 0)
        return ISO_OK;
    checker c = {surface, field, height, level, level_count, levels_scale(level, level_count)};
    int32_t size = surface->link.size;
    for (int32_t a = 0; a < size; a++) {
        bool lowest = true; /* each face once, however its darts are numbered */
        for (int32_t b = iso_double_link_alpha(surface, a); b != a && lowest;
             b = iso_double_link_alpha(surface, b))
            lowest = b > a;
        if (!lowest)
            continue;
        face f = read_face(&c, a);
        if (!is_unimodal(&c, &f)) {
            iso_vec3 p = place_of(&c, a);
            return iso_fail(ISO_UNSLICEABLE,
                            "a level may cross face %d, at (%.4f, %.4f, %.4f), more than once: "
                            "split it, or slice it as a mesh",
                            iso_double_link_face(surface, a), p.x, p.y, p.z);
        }
    }
    return ISO_OK;
}
