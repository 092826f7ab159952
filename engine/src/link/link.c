#include "link/multilink.h"

#include "base/memory.h"

iso_status iso_link_new(iso_link *out, int32_t size, const int32_t *successor, int dimension,
                        const double *g) {
    iso_multilink view = iso_multilink_view(ISO_KIND_LINK, size, 0, dimension, g);
    iso_map_store(&view.map[0], successor, size);
    return iso_multilink_copy(&out->link, &view);
}

/* One more than the largest; a negative value is left to the validator. */
static int32_t range_of(const int32_t *value, int32_t count) {
    int32_t most = -1;
    for (int32_t i = 0; i < count; i++)
        most = value[i] > most ? value[i] : most;
    return most < INT32_MAX ? most + 1 : INT32_MAX;
}

iso_status iso_coloured_link_new(iso_coloured_link *out, int32_t size, const int32_t *successor,
                                 const int32_t *colour, int dimension, const double *g) {
    iso_multilink view = iso_multilink_view(ISO_KIND_COLOURED_LINK, size, 0, dimension, g);
    iso_map_store(&view.map[0], successor, size);
    iso_map_store(&view.projection[0], colour, range_of(colour, size));
    return iso_multilink_copy(&out->link, &view);
}

/* Edges by the vertex they leave, in ascending order: leaving[first[v]] .. leaving[first[v+1]-1].
 */
static iso_status bucket_by_domain(int32_t *first, int32_t *leaving, int32_t edge_count,
                                   int32_t vertex_count, const int32_t *domain,
                                   const int32_t *codomain) {
    memset(first, 0, ((size_t)vertex_count + 1) * sizeof *first);
    for (int32_t e = 0; e < edge_count; e++) {
        if (domain[e] < 0 || domain[e] >= vertex_count || codomain[e] < 0 ||
            codomain[e] >= vertex_count)
            return iso_fail(ISO_USAGE,
                            "edge %d of the digraph runs from %d to %d; vertices are 0 .. %d", e,
                            domain[e], codomain[e], vertex_count - 1);
        first[domain[e]]++;
    }
    for (int32_t v = 0, sum = 0; v <= vertex_count; v++)
        sum += first[v], first[v] = sum;
    for (int32_t e = edge_count - 1; e >= 0; e--)
        leaving[--first[domain[e]]] = e;
    return ISO_OK;
}

static iso_status link_buckets(int32_t *successor, int32_t edge_count, int32_t vertex_count,
                               const int32_t *codomain, const int32_t *first, int32_t *arrived) {
    memset(arrived, 0, (size_t)vertex_count * sizeof *arrived);
    for (int32_t e = 0; e < edge_count; e++)
        arrived[codomain[e]]++;
    for (int32_t v = 0; v < vertex_count; v++)
        if (arrived[v] != first[v + 1] - first[v])
            return iso_fail(ISO_USAGE,
                            "the digraph can't be linked: %d edges arrive at vertex %d, %d leave",
                            arrived[v], v, first[v + 1] - first[v]);
    memset(arrived, 0, (size_t)vertex_count * sizeof *arrived);
    for (int32_t e = 0; e < edge_count; e++)
        successor[e] = first[codomain[e]] + arrived[codomain[e]]++;
    return ISO_OK;
}

iso_status iso_link_digraph(int32_t *successor, int32_t edge_count, int32_t vertex_count,
                            const int32_t *domain, const int32_t *codomain) {
    int32_t *first = NULL, *leaving = NULL, *arrived = NULL;
    if (edge_count < 0 || vertex_count < 0)
        return iso_fail(ISO_USAGE, "a digraph of %d edges and %d vertices", edge_count,
                        vertex_count);
    iso_status status = ISO_ALLOCATE(first, (int64_t)vertex_count + 1);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(leaving, edge_count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(arrived, vertex_count);
    if (status == ISO_OK)
        status = bucket_by_domain(first, leaving, edge_count, vertex_count, domain, codomain);
    if (status == ISO_OK)
        status = link_buckets(successor, edge_count, vertex_count, codomain, first, arrived);
    for (int32_t e = 0; status == ISO_OK && e < edge_count; e++)
        successor[e] = leaving[successor[e]];
    iso_release(first);
    iso_release(leaving);
    iso_release(arrived);
    return status;
}

/* What slices and curves have in common. */
typedef struct contours {
    int32_t level_count;
    const int32_t *level_first;
    const int64_t *contour_first;
    int64_t crossing_count;
} contours;

/* A link of contours; returns its g, which is still to be filled. NULL: out of memory. */
static double *begin_contours(iso_multilink *made, const contours *c, int dimension) {
    int32_t size = (int32_t)c->crossing_count;
    *made = iso_multilink_begin(ISO_KIND_COLOURED_LINK, size, dimension);
    int32_t *successor = iso_map_allocate(&made->map[0], size, size);
    int32_t *colour = iso_map_allocate(&made->projection[0], size, c->level_count);
    double *g = iso_multilink_allocate_g(made);
    if (!successor || !colour || !g)
        return NULL;
    for (int32_t level = 0; level < c->level_count; level++)
        for (int32_t k = c->level_first[level]; k < c->level_first[level + 1]; k++) {
            int32_t first = (int32_t)c->contour_first[k];
            int32_t end = (int32_t)c->contour_first[k + 1];
            for (int32_t i = first; i < end; i++) {
                successor[i] = i + 1 < end ? i + 1 : first;
                colour[i] = level;
            }
        }
    return g;
}

static iso_status check_crossings(int64_t count) {
    if (count > INT32_MAX)
        return iso_fail(ISO_OUTSIDE, "%lld crossings are more than a link can index (2^31 - 1)",
                        (long long)count);
    return ISO_OK;
}

iso_status iso_slices_to_link(iso_coloured_link *out, const iso_slices *slices,
                              const iso_levels *levels) {
    contours c = {slices->level_count, slices->level_first, slices->contour_first,
                  slices->crossing_count};
    iso_multilink made;
    out->link = (iso_multilink){0};
    ISO_TRY(check_crossings(c.crossing_count));
    if (levels && levels->count != slices->level_count)
        return iso_fail(ISO_USAGE, "%d levels given for slices of %d levels", levels->count,
                        slices->level_count);
    double *g = begin_contours(&made, &c, levels ? 3 : 2), *to = g;
    for (int64_t i = 0; to && i < c.crossing_count; i++) {
        *to++ = slices->point[i].x;
        *to++ = slices->point[i].y;
        if (levels)
            *to++ = levels->cut[made.projection[0].image[i]];
    }
    return iso_multilink_finish(&out->link, &made, g ? ISO_OK : ISO_NO_MEMORY);
}

iso_status iso_curves_to_link(iso_coloured_link *out, const iso_curves *curves) {
    contours c = {curves->level_count, curves->level_first, curves->contour_first,
                  curves->crossing_count};
    iso_multilink made;
    out->link = (iso_multilink){0};
    ISO_TRY(check_crossings(c.crossing_count));
    double *g = begin_contours(&made, &c, 3), *to = g;
    for (int64_t i = 0; to && i < c.crossing_count; i++) {
        *to++ = curves->point[i].x;
        *to++ = curves->point[i].y;
        *to++ = curves->point[i].z;
    }
    return iso_multilink_finish(&out->link, &made, g ? ISO_OK : ISO_NO_MEMORY);
}

iso_status iso_filling_link_new(iso_filling_link *out, int32_t crossing_count, const int32_t *arc,
                                const int32_t *line, const int32_t *contour) {
    out->link = (iso_multilink){0};
    if (crossing_count < 0 || crossing_count > INT32_MAX / 2)
        return iso_fail(ISO_USAGE, "a contour filling of %d crossings", crossing_count);
    int32_t size = 2 * crossing_count;
    iso_multilink made = iso_multilink_begin(ISO_KIND_FILLING_LINK, size, 0);
    iso_map_step(&made.map[0], ISO_MAP_CYCLIC, 2, 2, size);
    iso_map_step(&made.map[1], ISO_MAP_CYCLIC, 1, 2, size);
    int32_t *g = iso_map_allocate(&made.map[2], size, size);
    int32_t *q = iso_map_allocate(&made.projection[0], size, range_of(line, crossing_count));
    int32_t *p = iso_map_allocate(&made.projection[1], size, range_of(contour, crossing_count));
    int complete = g && q && p;
    for (int32_t d = 0; complete && d < size; d++) {
        g[d] = arc[d];
        q[d] = line[d >> 1];
        p[d] = contour[d >> 1];
    }
    return iso_multilink_finish(&out->link, &made, complete ? ISO_OK : ISO_NO_MEMORY);
}
