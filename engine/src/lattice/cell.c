#include "lattice/cell.h"

#include <math.h>

#include "base/memory.h"
#include "lattice/family.h"

/* A family's table: steps enough that the nearest surface is found within 0.001 of a cell. */
typedef struct family {
    iso_status (*fill)(iso_lattice_cell *cell, const iso_lattice_options *options);
    int32_t first, last;  /* patterns */
    int32_t size, repeat; /* 0: as its file asks for */
} family;

static const family families[] = {
    {tpms_fill, ISO_LATTICE_GYROID_SHEET, ISO_LATTICE_FISCHER_KOCH_SOLID, 64, 1},
    {strut_fill, ISO_LATTICE_BCC_STRUTS, ISO_LATTICE_DIAMOND_STRUTS, 64, 1},
    {foam_fill, ISO_LATTICE_FOAM_STRUTS, ISO_LATTICE_FOAM_SHEET, 128, 4},
    {bone_fill, ISO_LATTICE_BONE_SHEET, ISO_LATTICE_BONE_SOLID, 128, 4},
    {voxel_cubic_fill, ISO_LATTICE_VOXEL_CUBIC, ISO_LATTICE_VOXEL_CUBIC, 64, 1},
    {voxel_random_fill, ISO_LATTICE_VOXEL_RANDOM, ISO_LATTICE_VOXEL_RANDOM, 128, 4},
    {voxel_file_fill, ISO_LATTICE_VOXEL_FILE, ISO_LATTICE_VOXEL_FILE, 0, 1},
};

static const family *family_of(int32_t pattern) {
    for (size_t i = 0; i < sizeof families / sizeof *families; i++)
        if (pattern >= families[i].first && pattern <= families[i].last)
            return &families[i];
    return NULL;
}

static int32_t has_sides(int32_t pattern) {
    if (pattern <= ISO_LATTICE_FISCHER_KOCH_SOLID)
        return (pattern - ISO_LATTICE_GYROID_SHEET) % 2 == 0;
    return pattern == ISO_LATTICE_BONE_SHEET;
}

iso_status cell_make(iso_lattice_cell *cell, const iso_lattice_options *options) {
    *cell = (iso_lattice_cell){0};
    const family *f = family_of(options->pattern);
    if (!f)
        return iso_fail(ISO_USAGE, "there is no lattice of number %d", options->pattern);
    for (int axis = 0; axis < 3; axis++)
        cell->size[axis] = f->size, cell->repeat[axis] = f->repeat;
    cell->has_sides = has_sides(options->pattern);
    iso_status status = ISO_OK;
    if (f->size > 0)
        status = ISO_ALLOCATE(cell->distance, (int64_t)f->size * f->size * f->size);
    if (status == ISO_OK)
        status = f->fill(cell, options);
    if (status == ISO_OK)
        status = cell_measure(cell);
    if (status != ISO_OK)
        cell_free(cell);
    return status;
}

void cell_free(iso_lattice_cell *cell) {
    iso_release(cell->distance);
    *cell = (iso_lattice_cell){0};
}

iso_status cell_link(iso_cubic_link *out, const iso_lattice_cell *cell) {
    iso_axis axis[3];
    int64_t count = 1;
    for (int i = 0; i < 3; i++) {
        axis[i] = (iso_axis){.length = cell->size[i], .wraps = 1};
        count *= cell->size[i];
    }
    *out = (iso_cubic_link){0};
    double *g;
    ISO_TRY(ISO_ALLOCATE(g, count));
    for (int64_t a = 0; a < count; a++)
        g[a] = cell->distance[a];
    iso_status status = iso_cubic_link_box(out, axis, 1, g, NULL);
    iso_release(g);
    return status;
}

double cell_level(const iso_lattice_cell *cell, double density) {
    double place = density * ISO_CELL_LEVELS;
    if (!(place > 0))
        return cell->level[0];
    if (place >= ISO_CELL_LEVELS)
        return cell->level[ISO_CELL_LEVELS];
    int32_t k = (int32_t)place;
    return cell->level[k] + (place - k) * ((double)cell->level[k + 1] - cell->level[k]);
}

double cell_density(const iso_lattice_cell *cell, double level) {
    int32_t low = 0, high = ISO_CELL_LEVELS;
    if (!(level > cell->level[low]))
        return 0;
    if (level >= cell->level[high])
        return 1;
    while (high - low > 1) {
        int32_t middle = (low + high) / 2;
        if (cell->level[middle] <= level)
            low = middle;
        else
            high = middle;
    }
    double step = (double)cell->level[high] - cell->level[low];
    return (low + (level - cell->level[low]) / step) / ISO_CELL_LEVELS;
}

/* In samples, brought back into the box: where numbers are huge, what is left of their places. */
static double in_box(double u, int32_t size, int32_t repeat) {
    u -= repeat * floor(u / repeat);
    return u * size / repeat;
}

double cell_distance(const iso_lattice_cell *cell, double u, double v, double w) {
    return cell_at(cell, in_box(u, cell->size[0], cell->repeat[0]),
                   in_box(v, cell->size[1], cell->repeat[1]),
                   in_box(w, cell->size[2], cell->repeat[2]));
}
