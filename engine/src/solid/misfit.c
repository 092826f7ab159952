#include "solid/misfit.h"

#include <math.h>

#include "base/memory.h"
#include "base/sort.h"
#include "solid/distance.h"

/* Triangles of the new surface by the cell, a voxel wide, that the middle of their box is in. */
typedef struct entry {
    int64_t cell;
    int32_t triangle;
} entry;

static inline int entry_before(const entry *a, const entry *b) {
    return a->cell != b->cell ? a->cell < b->cell : a->triangle < b->triangle;
}
ISO_SORT(sort_entries, entry, entry_before)

typedef struct cells {
    const iso_mesh *mesh;
    entry *entry; /* [triangle_count] */
    double width;
    double spread; /* no triangle reaches further from the middle of its box */
    int64_t nx, ny, nz;
} cells;

static iso_vec3 corner_of(const iso_mesh *mesh, int64_t dart) {
    return mesh->position[mesh->origin[dart]];
}

static double middle_of(double *spread, double a, double b, double c) {
    double low = fmin(a, fmin(b, c)), high = fmax(a, fmax(b, c));
    *spread = fmax(*spread, (high - low) / 2);
    return (low + high) / 2;
}

static int64_t index_of(double at, double from, double width, int64_t count) {
    double i = floor((at - from) / width);
    return i < 0 ? 0 : i >= (double)count ? count - 1 : (int64_t)i;
}

static iso_status cells_new(cells *c, const iso_mesh *mesh, double width) {
    *c = (cells){.mesh = mesh, .width = width};
    c->nx = (int64_t)((mesh->max.x - mesh->min.x) / width) + 1;
    c->ny = (int64_t)((mesh->max.y - mesh->min.y) / width) + 1;
    c->nz = (int64_t)((mesh->max.z - mesh->min.z) / width) + 1;
    ISO_TRY(ISO_ALLOCATE(c->entry, mesh->triangle_count));
    double spread[3] = {0, 0, 0};
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 p = corner_of(mesh, 3 * (int64_t)t), q = corner_of(mesh, 3 * (int64_t)t + 1);
        iso_vec3 r = corner_of(mesh, 3 * (int64_t)t + 2);
        int64_t x = index_of(middle_of(&spread[0], p.x, q.x, r.x), mesh->min.x, width, c->nx);
        int64_t y = index_of(middle_of(&spread[1], p.y, q.y, r.y), mesh->min.y, width, c->ny);
        int64_t z = index_of(middle_of(&spread[2], p.z, q.z, r.z), mesh->min.z, width, c->nz);
        c->entry[t] = (entry){x + c->nx * (y + c->ny * z), t};
    }
    for (int k = 0; k < 3; k++)
        c->spread += spread[k] * spread[k];
    c->spread = sqrt(c->spread);
    sort_entries(c->entry, mesh->triangle_count);
    return ISO_OK;
}

static int64_t first_entry(const cells *c, int64_t cell) {
    int64_t low = 0, high = c->mesh->triangle_count;
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (c->entry[middle].cell < cell)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static int64_t larger(int64_t a, int64_t b) {
    return a > b ? a : b;
}

static int64_t smaller(int64_t a, int64_t b) {
    return a < b ? a : b;
}

/* Square of the distance to the triangles in the cells around a point, so many to each side. */
static double nearest_within(const cells *c, iso_vec3 p, int64_t around) {
    const iso_mesh *mesh = c->mesh;
    int64_t x = (int64_t)floor((p.x - mesh->min.x) / c->width);
    int64_t y = (int64_t)floor((p.y - mesh->min.y) / c->width);
    int64_t z = (int64_t)floor((p.z - mesh->min.z) / c->width);
    int64_t from = larger(x - around, 0), to = smaller(x + around, c->nx - 1);
    double least = INFINITY;
    for (int64_t k = larger(z - around, 0); k <= smaller(z + around, c->nz - 1); k++)
        for (int64_t j = larger(y - around, 0); j <= smaller(y + around, c->ny - 1); j++) {
            int64_t row = c->nx * (j + c->ny * k), i = first_entry(c, row + from);
            for (; i < mesh->triangle_count && c->entry[i].cell <= row + to; i++) {
                int64_t dart = 3 * (int64_t)c->entry[i].triangle;
                iso_vec3 corner[3] = {corner_of(mesh, dart), corner_of(mesh, dart + 1),
                                      corner_of(mesh, dart + 2)};
                least = fmin(least, distance_to_triangle(p, corner));
            }
        }
    return least;
}

/* INFINITY beyond `reach`. */
static double nearest(const cells *c, iso_vec3 p, double reach) {
    for (int64_t around = 1;; around++) {
        double distance = sqrt(nearest_within(c, p, around)), sure = (double)around * c->width;
        if (distance + c->spread <= sure)
            return distance <= reach ? distance : INFINITY;
        if (reach + c->spread <= sure)
            return distance <= reach ? distance : INFINITY;
    }
}

/* Negative: it doesn't count. */
static iso_status misfit_of(double *off, const cells *c, const iso_volume *whole, iso_vec3 p,
                            double half, double voxel) {
    double distance = nearest(c, p, half + MISFIT_REACH * voxel), side = -1;
    *off = fabs(distance - half);
    if (half > 0 && distance - half > voxel)
        *off = -1;
    if (half > 0 || distance < INFINITY)
        return ISO_OK;
    if (whole)
        ISO_TRY(volume_sample(&side, whole, &p, 1));
    *off = side > 0 ? MISFIT_REACH * voxel : -1;
    return ISO_OK;
}

iso_status misfit_measure(iso_mesh_defects *errors, const iso_mesh *made, const iso_mesh *soup,
                          const iso_volume *whole, double half, double voxel) {
    cells c;
    double sum = 0, largest = 0;
    int64_t count = 0;
    iso_status status = cells_new(&c, made, voxel);
    for (int32_t v = 0; v < soup->vertex_count && status == ISO_OK; v++) {
        double off = -1;
        status = misfit_of(&off, &c, whole, soup->position[v], half, voxel);
        if (off < 0)
            continue;
        sum += off;
        largest = fmax(largest, off);
        count++;
    }
    iso_release(c.entry);
    errors->largest_error = largest;
    errors->mean_error = count > 0 ? sum / (double)count : 0;
    return status;
}
