#include "slice/bounds.h"

#include <stdbool.h>

#include "base/vector.h"

enum {
    CELLS = 4096,     /* kept at a time: 400 kB */
    FACES_LEAST = 512 /* of a mesh that cells are worth it for */
};

#define UNKNOWN 1e150
#define EDGES_A_CELL 4 /* width of a cell: all that isn't longer than half of it fits in */

typedef struct bounds_cell {
    iso_vec3 place; /* whole numbers */
    bool used;
    bounds bound;
} bounds_cell;

static double middle_of(double low, double high) {
    double middle = 0.5 * (low + high);
    return fabs(middle) < UNKNOWN ? middle : 0;
}

/* Rounding is covered by a little more. */
static double spread_of(double low, double high) {
    double spread = 0.5 * (high - low) + 1e-14 * (fabs(low) + fabs(high));
    return spread < UNKNOWN ? spread : UNKNOWN;
}

bounds bounds_over(const iso_field *field, iso_vec3 low, iso_vec3 high) {
    iso_field_bound b;
    iso_field_bound_over(&b, field, low, high);
    iso_vec3 l = b.gradient_low, h = b.gradient_high;
    return (bounds){
        {middle_of(l.x, h.x), middle_of(l.y, h.y), middle_of(l.z, h.z)},
        {spread_of(l.x, h.x), spread_of(l.y, h.y), spread_of(l.z, h.z)},
        b.low > -UNKNOWN ? b.low : -UNKNOWN,
        b.high < UNKNOWN ? b.high : UNKNOWN,
    };
}

/* ---- cells ---- */

/* Of every hundredth triangle. */
static double mean_edge(const iso_mesh *mesh) {
    double sum = 0, count = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t += 100, count += 3)
        for (int k = 0; k < 3; k++)
            sum += vec3_distance(mesh->position[mesh->origin[3 * t + k]],
                                 mesh->position[mesh->origin[3 * t + (k + 1) % 3]]);
    return sum / count;
}

iso_status bounds_cells_begin(bounds_cells *cells, const iso_mesh *mesh) {
    *cells = (bounds_cells){0};
    if (mesh->triangle_count < FACES_LEAST)
        return ISO_OK;
    ISO_TRY(ISO_ALLOCATE(cells->cell, CELLS));
    memset(cells->cell, 0, CELLS * sizeof *cells->cell);
    cells->size = EDGES_A_CELL * mean_edge(mesh);
    return ISO_OK;
}

void bounds_cells_free(bounds_cells *cells) {
    iso_release(cells->cell);
    *cells = (bounds_cells){0};
}

static uint32_t slot_of(iso_vec3 place) {
    uint64_t x = (uint64_t)(int64_t)place.x, y = (uint64_t)(int64_t)place.y;
    uint64_t z = (uint64_t)(int64_t)place.z;
    uint64_t mixed =
        (x * 0x9e3779b97f4a7c15u) ^ (y * 0xc2b2ae3d27d4eb4fu) ^ (z * 0x165667b19e3779f9u);
    return (uint32_t)(mixed >> 40) % CELLS;
}

const bounds *bounds_cells_around(bounds_cells *cells, const iso_field *field, iso_vec3 low,
                                  iso_vec3 high) {
    double size = cells->size, half = 0.5 * size;
    if (!(high.x - low.x < half && high.y - low.y < half && high.z - low.z < half))
        return NULL;
    iso_vec3 at = {floor(low.x / size), floor(low.y / size), floor(low.z / size)};
    bounds_cell *cell = &cells->cell[slot_of(at)];
    if (!cell->used || cell->place.x != at.x || cell->place.y != at.y || cell->place.z != at.z) {
        iso_vec3 from = vec3_times(at, size);
        cell->bound = bounds_over(field, from, vec3_plus(from, vec3(3 * half, 3 * half, 3 * half)));
        cell->place = at;
        cell->used = true;
    }
    return &cell->bound;
}
