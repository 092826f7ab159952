#include "solid/planes.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/sort.h"
#include "slice/search.h"
#include "solid/inside.h"

/* ---- which triangles a level meets ---- */

/* Rounding moves points and corners, and points may be off their level: what is met then is listed,
 * and a little more. */
static void find_ranges(solid_planes *p) {
    const iso_levels *levels = p->levels;
    double scale = levels_scale(levels->cut, levels->count);
    double margin = PLANES_UP_MAX + 2 / p->grid.scale;
    plane_range *to = p->range;
    for (int32_t m = 0; m < p->count; m++) {
        const iso_mesh *mesh = &p->mesh[m];
        for (int64_t a = 0; a < 3 * (int64_t)mesh->triangle_count; a += 3) {
            double h[3];
            for (int k = 0; k < 3; k++)
                h[k] = mesh->position[mesh->origin[a + k]].z;
            double least = h[0] < h[1] ? h[0] : h[1], most = h[0] < h[1] ? h[1] : h[0];
            least = (h[2] < least ? h[2] : least) - margin;
            most = (h[2] > most ? h[2] : most) + margin;
            int32_t low = levels_first_at(levels->cut, levels->count, scale, least), high = low;
            while (high < levels->count && levels->cut[high] <= most)
                high++;
            *to++ = (plane_range){low, high};
        }
    }
}

static iso_status list_triangles(solid_planes *p) {
    int32_t levels = p->levels->count;
    int64_t *change;
    ISO_TRY(ISO_ALLOCATE(change, (int64_t)levels + 2));
    p->first = change;
    memset(change, 0, ((size_t)levels + 2) * sizeof *change);
    change++; /* change[i]: triangles that begin at level i, less those that ended below it */
    for (int32_t t = 0; t < p->triangles; t++)
        change[p->range[t].low]++, change[p->range[t].high]--;
    for (int turn = 0; turn < 2; turn++)
        for (int32_t i = 1; i < levels; i++)
            change[i] += change[i - 1];
    ISO_TRY(ISO_ALLOCATE(p->list, p->first[levels]));
    for (int32_t t = 0; t < p->triangles; t++)
        for (int32_t i = p->range[t].low; i < p->range[t].high; i++)
            p->list[p->first[i]++] = t;
    memmove(p->first + 1, p->first, (size_t)levels * sizeof *p->first);
    p->first[0] = 0;
    return ISO_OK;
}

iso_status planes_make(solid_planes *planes, const iso_mesh *mesh, int32_t count,
                       const iso_levels *levels) {
    solid_planes p = {.mesh = mesh, .count = count, .levels = levels};
    *planes = (solid_planes){0};
    if (levels->count > 0)
        ISO_TRY(grid_count(&p.triangles, mesh, count));
    grid_choose(&p.grid, mesh, count);
    ISO_TRY(ISO_ALLOCATE(p.range, p.triangles));
    if (p.triangles > 0)
        find_ranges(&p);
    iso_status status = list_triangles(&p);
    if (status == ISO_OK)
        *planes = p;
    else
        planes_free(&p);
    return status;
}

void planes_free(solid_planes *planes) {
    iso_release(planes->range);
    iso_release(planes->first);
    iso_release(planes->list);
    *planes = (solid_planes){0};
}

/* ---- points ---- */

static inline int point_before(const plane_point *a, const plane_point *b) {
    return a->at[1] != b->at[1] ? a->at[1] < b->at[1] : a->index < b->index;
}
ISO_SORT(sort_points, plane_point, point_before)

static int32_t first_above(const plane_point *list, int32_t count, int32_t y) {
    int32_t low = 0, high = count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (list[middle].at[1] < y)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static inline void order(int32_t *least, int32_t *most, const int32_t *at) {
    int32_t low = at[0] < at[3] ? at[0] : at[3], high = at[0] < at[3] ? at[3] : at[0];
    *least = at[6] < low ? at[6] : low;
    *most = at[6] > high ? at[6] : high;
}

/* What a triangle adds to the points whose rays in the direction of +x may meet it. Most are met by
 * none, which y alone tells. */
static void add_triangle(int32_t *winding, const solid_grid *grid, const plane_point *list,
                         int32_t count, const iso_vec3 *const at[3]) {
    int32_t corner[9], low, high;
    for (int i = 0; i < 3; i++)
        corner[3 * i + 1] = (int32_t)(grid_steps(at[i]->y, grid->scale) - grid->middle[1]);
    order(&low, &high, corner + 1);
    int32_t i = first_above(list, count, low);
    if (i == count || list[i].at[1] > high)
        return;
    for (int k = 0; k < 3; k++)
        grid_round(corner + 3 * k, grid, at[k]);
    int32_t left, right;
    order(&left, &right, corner);
    for (; i < count && list[i].at[1] <= high; i++)
        if (right >= list[i].at[0])
            winding[list[i].index] += inside_crossing(corner, list[i].at, 0);
}

void planes_winding(int32_t *winding, const solid_planes *planes, int32_t level,
                    const iso_vec3 *point, int32_t count, plane_point *scratch) {
    int32_t placed = 0;
    for (int32_t i = 0; i < count; i++) {
        winding[i] = 0;
        scratch[placed].index = i;
        placed += grid_place(scratch[placed].at, &planes->grid, &point[i]);
    }
    if (placed == 0)
        return;
    sort_points(scratch, placed);
    const iso_mesh *mesh = planes->mesh;
    int32_t base = 0;
    for (int64_t k = planes->first[level]; k < planes->first[level + 1]; k++) {
        int32_t t = planes->list[k];
        while (t - base >= mesh->triangle_count)
            base += mesh++->triangle_count;
        const int32_t *origin = &mesh->origin[3 * (int64_t)(t - base)];
        const iso_vec3 *const at[3] = {&mesh->position[origin[0]], &mesh->position[origin[1]],
                                       &mesh->position[origin[2]]};
        add_triangle(winding, &planes->grid, scratch, placed, at);
    }
}
