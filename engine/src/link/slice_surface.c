/* The iso-slice of any double-link (paper, 5), for every level at once, by heights or by a field.
 * The slicer of meshes is a faster one of its own (slice/); this one takes faces of any degree and
 * places in any R^n. */
#include "link/multilink.h"

#include <math.h>

#include "base/memory.h"
#include "base/vector.h"
#include "link/unimodal.h"
#include "slice/curves.h"

typedef struct slicer {
    const iso_double_link *surface;
    const iso_field *field; /* or NULL: linear along edges */
    const double *height;
    double *value; /* of a field: what `height` is */
    const double *level;
    int32_t level_count;
    int32_t *lower; /* [size] the first level >= the dart's height */
    int32_t *base;  /* [size + 1] number of the dart's first crossing */
} slicer;

static iso_status check_heights(const slicer *s) {
    for (int32_t a = 0; a < s->surface->link.size; a++)
        if (!isfinite(s->height[a]))
            return iso_fail(ISO_USAGE, "the height of dart %d is not finite", a);
    for (int32_t a = 0; a < s->surface->link.size; a++) {
        int32_t b = iso_double_link_beta(s->surface, a);
        if (s->height[a] != s->height[b])
            return iso_fail(ISO_USAGE, "hβ = h fails at dart %d: %.17g and %.17g around one vertex",
                            a, s->height[b], s->height[a]);
    }
    return ISO_OK;
}

static int32_t first_level_from(const slicer *s, double height) {
    int32_t low = 0, high = s->level_count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (s->level[middle] < height)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Dart a is crossed on the levels lower[a] .. lower[α a] - 1: h(a) <= r < h(αa). */
static iso_status number_crossings(slicer *s) {
    int32_t size = s->surface->link.size;
    int64_t sum = 0;
    for (int32_t a = 0; a < size; a++)
        s->lower[a] = first_level_from(s, s->height[a]);
    for (int32_t a = 0; a < size; a++) {
        int32_t count = s->lower[iso_double_link_alpha(s->surface, a)] - s->lower[a];
        s->base[a] = (int32_t)sum;
        sum += count > 0 ? count : 0;
        if (sum > INT32_MAX)
            return iso_fail(ISO_OUTSIDE, "more than 2^31 - 1 crossings of levels with edges");
    }
    s->base[size] = (int32_t)sum;
    return ISO_OK;
}

static void place(double *g, const slicer *s, int32_t a, double r) {
    const iso_multilink *link = &s->surface->link;
    int n = link->dimension;
    int32_t b = iso_double_link_alpha(s->surface, a);
    double t = (r - s->height[a]) / (s->height[b] - s->height[a]);
    for (int k = 0; k < n; k++) {
        double x = link->g[(int64_t)a * n + k];
        g[k] = x + t * (link->g[(int64_t)b * n + k] - x);
    }
}

/* The successor is the up-crossing of the neighbour's face that comes first behind the shared
 * edge: c = α(opp a), then c = α c while h(αc) <= r. It exists, for opp(a) itself runs from above
 * r to below. Where several faces' worth of rising edges exist (h not unimodal on a face) the
 * choice is still a bijection. As r grows c only moves on, so a dart costs the degree of its
 * neighbour's face plus its levels; only faces of very many rising edges add up to more. */
static void link_dart(const slicer *s, int32_t a, int32_t *successor, int32_t *colour,
                      int32_t *dart) {
    const iso_double_link *surface = s->surface;
    int32_t c = iso_double_link_alpha(surface, iso_double_link_opposite(surface, a));
    for (int32_t id = s->base[a]; id < s->base[a + 1]; id++) {
        int32_t level = s->lower[a] + id - s->base[a], next;
        while (next = iso_double_link_alpha(surface, c), s->lower[next] <= level)
            c = next;
        successor[id] = s->base[c] + level - s->lower[c];
        colour[id] = level;
        dart[id] = a;
    }
}

static iso_vec3 place_of(const slicer *s, int32_t dart) {
    const double *g = s->surface->link.g + 3 * (int64_t)dart;
    return vec3(g[0], g[1], g[2]);
}

static root_edge edge_of(const slicer *s, int32_t a, double level) {
    int32_t b = iso_double_link_alpha(s->surface, a);
    double rise = s->height[b] - s->height[a];
    return (root_edge){
        {place_of(s, a), place_of(s, b)}, {s->height[a], s->height[b]}, {rise, rise}, level};
}

static void place_roots(double *g, const slicer *s, const int32_t *dart, const int32_t *colour,
                        int32_t count) {
    root_edge edge[ROOTS_BLOCK];
    iso_vec3 point[ROOTS_BLOCK];
    for (int32_t first = 0; first < count; first += ROOTS_BLOCK) {
        int32_t size = count - first < ROOTS_BLOCK ? count - first : ROOTS_BLOCK;
        for (int32_t i = 0; i < size; i++)
            edge[i] = edge_of(s, dart[first + i], s->level[colour[first + i]]);
        roots_find(point, s->field, edge, size);
        for (int32_t i = 0; i < size; i++) {
            double *to = g + 3 * (int64_t)(first + i);
            to[0] = point[i].x, to[1] = point[i].y, to[2] = point[i].z;
        }
    }
}

static iso_status build(iso_multilink *made, const slicer *s) {
    const iso_multilink *from = &s->surface->link;
    int32_t *successor = iso_map_allocate(&made->map[0], made->size, made->size);
    int32_t *colour = iso_map_allocate(&made->projection[0], made->size, s->level_count);
    iso_map *inclusion = iso_multilink_add_projection(made, "dart");
    int32_t *dart = iso_map_allocate(inclusion, made->size, from->size);
    double *g = iso_multilink_allocate_g(made);
    if (!successor || !colour || !dart || !g)
        return ISO_NO_MEMORY;
    for (int32_t a = 0; a < from->size; a++)
        link_dart(s, a, successor, colour, dart);
    if (s->field)
        place_roots(g, s, dart, colour, made->size);
    else
        for (int32_t id = 0; id < made->size; id++)
            place(g + (int64_t)id * made->dimension, s, dart[id], s->level[colour[id]]);
    return ISO_OK;
}

static iso_status evaluate(slicer *s) {
    const iso_multilink *link = &s->surface->link;
    if (link->dimension != 3)
        return iso_fail(ISO_USAGE, "a field is of space; the surface is in R^%d", link->dimension);
    ISO_TRY(ISO_ALLOCATE(s->value, link->size));
    s->height = s->value;
    for (int32_t a = 0; a < link->size; a++) {
        iso_vec3 at = place_of(s, a);
        iso_field_evaluate(s->value + a, NULL, s->field, &at, 1);
        if (!isfinite(s->value[a]))
            return iso_fail(ISO_UNSLICEABLE, "the field has no value at (%.4f, %.4f, %.4f)", at.x,
                            at.y, at.z);
    }
    return unimodal_check(s->surface, s->field, s->height, s->level, s->level_count);
}

static iso_status slice(iso_coloured_link *out, slicer *s) {
    int32_t size = s->surface->link.size;
    ISO_TRY(iso_multilink_validate(&s->surface->link));
    ISO_TRY(curves_check_levels(s->level, s->level_count));
    if (s->field)
        ISO_TRY(evaluate(s));
    else
        ISO_TRY(check_heights(s));
    ISO_TRY(ISO_ALLOCATE(s->lower, size));
    ISO_TRY(ISO_ALLOCATE(s->base, (int64_t)size + 1));
    ISO_TRY(number_crossings(s));
    iso_multilink made =
        iso_multilink_begin(ISO_KIND_COLOURED_LINK, s->base[size], s->surface->link.dimension);
    iso_status status = build(&made, s);
    return iso_multilink_finish(&out->link, &made, status);
}

iso_status iso_slice_double_link(iso_coloured_link *out, const iso_double_link *surface,
                                 const double *height, const double *level, int32_t level_count) {
    slicer s = {.surface = surface, .height = height, .level = level, .level_count = level_count};
    out->link = (iso_multilink){0};
    iso_status status = slice(out, &s);
    iso_release(s.lower);
    iso_release(s.base);
    return status;
}

iso_status iso_slice_double_link_field(iso_coloured_link *out, const iso_double_link *surface,
                                       const iso_field *field, const double *level,
                                       int32_t level_count) {
    slicer s = {.surface = surface, .field = field, .level = level, .level_count = level_count};
    out->link = (iso_multilink){0};
    iso_status status = slice(out, &s);
    iso_release(s.lower);
    iso_release(s.base);
    iso_release(s.value);
    return status;
}
