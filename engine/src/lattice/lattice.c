#include "lattice/lattice.h"

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "lattice/cut.h"
#include "lattice/grading.h"
#include "lattice/map.h"
#include "lattice/material.h"
#include "lattice/space.h"

struct iso_lattice {
    iso_lattice_cell cell;
    iso_grading size, density; /* mm; percent */
    iso_grading share;         /* percent, of the second material */
    iso_material material;     /* which each cell is of, if there are two */
    iso_space space;
    iso_cell_map map;
    const iso_lattice_cut *cut; /* NULL: none */
    uint32_t wanted;            /* variables, as bits */
    double samples[3];          /* of the table, in a cell */
    double smallest;            /* mm, of a cell's edge */
    double half;                /* mm, where density and size are constant */
};

static const double least_cell = 0.2, most_cell = 1e5; /* mm */

/* ---- making ---- */

static iso_status check_size(const iso_lattice *lattice, double size, iso_vec3 at) {
    if (size >= least_cell && size <= most_cell)
        return ISO_OK;
    char where[96] = "";
    if (lattice->size.expression)
        snprintf(where, sizeof where, " at x = %.4g, y = %.4g, z = %.4g", at.x, at.y, at.z);
    return iso_fail(ISO_BAD_CONFIG, "lattice_cell is %.4g mm%s; it must be %g to %g mm", size,
                    where, least_cell, most_cell);
}

enum { CHECKED = 33 }; /* places along each side of the part's box */

/* Where cells aren't counted along what their size depends on, x, y and z are divided by it; away
 * from the middle they are then as much longer as 1 is more than 1 - (p grad size) / size. */
static bool is_divided(const iso_lattice *lattice, int32_t kind) {
    int32_t only = grading_only_variable(&lattice->size);
    return kind == ISO_LATTICE_MAP_XYZ &&
           (only == -2 || only == GRADING_SKIN || only == GRADING_GRID);
}

static iso_status check_growth(iso_lattice *lattice, iso_places *places, const double *size,
                               int32_t count) {
    const double farther = 1e-6, least = 0.2, jump = 100; /* steeper than that it's a step */
    double grown[CHECKED];
    for (int k = GRADING_X; k <= GRADING_Z; k++)
        for (int32_t i = 0; i < count; i++)
            places->value[k][i] *= 1 + farther;
    space_know(places, &lattice->space, lattice->wanted, count);
    grading_evaluate(grown, &lattice->size, places->variable, count);
    for (int32_t i = 0; i < count; i++) {
        double shorter = 1 - (grown[i] - size[i]) / (size[i] * farther);
        bool is_part = !lattice->space.skin || places->value[GRADING_SKIN][i] >= 0;
        if (fabs(shorter) > jump)
            continue;
        if (shorter < least && is_part)
            return iso_fail(ISO_BAD_CONFIG,
                            "lattice_cell grows too fast at x = %.4g, y = %.4g, z = %.4g: let it "
                            "change more slowly, or with one of x, y, z and r alone",
                            places->value[GRADING_X][i], places->value[GRADING_Y][i],
                            places->value[GRADING_Z][i]);
        if (shorter > 1 && is_part)
            lattice->smallest = fmin(lattice->smallest, fmax(size[i] / shorter, size[i] / 4));
    }
    return ISO_OK;
}

/* One row along x of what is checked. */
static iso_status check_row(iso_lattice *lattice, iso_places *places, int32_t kind, int32_t j,
                            int32_t k) {
    const iso_space *space = &lattice->space;
    double size[CHECKED], *x = places->value[GRADING_X], *skin = places->value[GRADING_SKIN];
    iso_vec3 at = {0, space->min.y + (space->max.y - space->min.y) * j / (CHECKED - 1),
                   space->max.z * k / (CHECKED - 1)};
    for (int32_t i = 0; i < CHECKED; i++) {
        x[i] = space->min.x + (space->max.x - space->min.x) * i / (CHECKED - 1);
        places->value[GRADING_Y][i] = at.y;
        places->value[GRADING_Z][i] = at.z;
    }
    space_know(places, space, lattice->wanted, CHECKED);
    grading_evaluate(size, &lattice->size, places->variable, CHECKED);
    for (int32_t i = 0; i < CHECKED; i++) {
        if ((lattice->wanted >> GRADING_SKIN & 1) && skin[i] < 0)
            continue; /* no part there */
        at.x = x[i];
        ISO_TRY(check_size(lattice, size[i], at));
        lattice->smallest = fmin(lattice->smallest, size[i]);
    }
    return is_divided(lattice, kind) ? check_growth(lattice, places, size, CHECKED) : ISO_OK;
}

static iso_status check_sizes(iso_lattice *lattice, int32_t kind) {
    lattice->smallest = HUGE_VAL;
    if (!lattice->size.expression) {
        lattice->smallest = lattice->size.value;
        return check_size(lattice, lattice->size.value, (iso_vec3){0});
    }
    iso_places *places;
    ISO_TRY(ISO_ALLOCATE(places, 1));
    iso_status status = ISO_OK;
    for (int32_t k = 0; k < CHECKED && status == ISO_OK; k++)
        for (int32_t j = 0; j < CHECKED && status == ISO_OK; j++)
            status = check_row(lattice, places, kind, j, k);
    iso_release(places);
    if (status == ISO_OK && lattice->smallest == HUGE_VAL) /* thinner than the grid of places */
        lattice->smallest = least_cell;
    return status;
}

/* Around an axis cells get narrower towards it: to half their size that is followed. */
static double narrowest(const iso_lattice *lattice) {
    double smallest = fmin(lattice->smallest, lattice->map.smallest);
    if (map_is_even(&lattice->map))
        return smallest;
    double inner = lattice->map.kind == ISO_LATTICE_MAP_SPHERE
                       ? 0
                       : lattice->space.least_r / lattice->space.mean_r;
    return smallest * fmin(1, fmax(inner, 0.5));
}

/* mm from the skeleton to the surface of the material; density in percent. */
static double half_of(const iso_lattice *lattice, double density, double size) {
    if (!(density > 0))
        return -HUGE_VAL;
    if (density >= 100)
        return HUGE_VAL;
    return cell_level(&lattice->cell, density / 100) * size;
}

static uint32_t find_wanted(const iso_lattice *lattice, int32_t kind) {
    uint32_t wanted = map_wants(kind);
    for (int32_t k = 0; k < GRADING_VARIABLES; k++)
        if (grading_uses(&lattice->size, k) || grading_uses(&lattice->density, k) ||
            grading_uses(&lattice->share, k))
            wanted |= (uint32_t)1 << k;
    return wanted;
}

/* Cells of one size, along x, y and z. */
static bool is_straight(const iso_lattice *lattice) {
    return !lattice->size.expression && lattice->map.kind == ISO_LATTICE_MAP_XYZ;
}

static bool has_two_materials(const iso_lattice_options *options) {
    return options->material && *options->material;
}

static iso_status make_material(iso_lattice *lattice) {
    iso_material_source source = {.space = &lattice->space,
                                  .map = &lattice->map,
                                  .size = &lattice->size,
                                  .share = &lattice->share,
                                  .wanted = lattice->wanted,
                                  .smallest = lattice->smallest,
                                  .straight = is_straight(lattice)};
    return material_make(&lattice->material, &source);
}

static iso_status make(iso_lattice *lattice, const iso_lattice_options *options,
                       const iso_mesh *mesh, int32_t count) {
    if (options->map < 0 || options->map >= ISO_LATTICE_MAP_COUNT)
        return iso_fail(ISO_BAD_CONFIG, "there is no lattice_map %d", (int)options->map);
    ISO_TRY(grading_make(&lattice->size, options->cell, "lattice_cell"));
    ISO_TRY(grading_make(&lattice->density, options->density, "lattice_density"));
    if (has_two_materials(options))
        ISO_TRY(grading_make(&lattice->share, options->material, "lattice_material"));
    lattice->wanted = find_wanted(lattice, options->map);
    ISO_TRY(space_make(&lattice->space, options, lattice->wanted, mesh, count));
    ISO_TRY(check_sizes(lattice, options->map));
    ISO_TRY(cell_make(&lattice->cell, options));
    ISO_TRY(map_make(&lattice->map, options->map, &lattice->space, &lattice->size,
                     lattice->cell.repeat[0], least_cell));
    lattice->smallest = narrowest(lattice);
    for (int k = 0; k < 3; k++)
        lattice->samples[k] = (double)lattice->cell.size[k] / lattice->cell.repeat[k];
    lattice->cut = options->cut && options->cut->count > 0 ? options->cut : NULL;
    lattice->half = half_of(lattice, lattice->density.value, lattice->size.value);
    return has_two_materials(options) ? make_material(lattice) : ISO_OK;
}

iso_status lattice_new(iso_lattice **lattice, const iso_lattice_options *options,
                       const iso_mesh *mesh, int32_t count) {
    *lattice = NULL;
    iso_lattice *out;
    ISO_TRY(ISO_ALLOCATE(out, 1));
    *out = (iso_lattice){0};
    iso_status status = make(out, options, mesh, count);
    if (status == ISO_OK)
        *lattice = out;
    else
        lattice_free(out);
    return status;
}

void lattice_free(iso_lattice *lattice) {
    if (!lattice)
        return;
    grading_free(&lattice->size);
    grading_free(&lattice->density);
    grading_free(&lattice->share);
    material_free(&lattice->material);
    space_free(&lattice->space);
    map_free(&lattice->map);
    cell_free(&lattice->cell);
    iso_release(lattice);
}

const iso_lattice_cell *lattice_cell(const iso_lattice *lattice) {
    return &lattice->cell;
}

int lattice_is_uniform(const iso_lattice *lattice) {
    return is_straight(lattice) && !lattice->density.expression && !lattice->cut;
}

const iso_material *lattice_material(const iso_lattice *lattice) {
    return lattice->material.tool ? &lattice->material : NULL;
}

double lattice_smallest_cell(const iso_lattice *lattice) {
    return lattice->smallest;
}

/* ---- rows of straight lattices ---- */

enum { ROW = 1024 }; /* samples of the table that are blended for a row at once */

/* The table along u at one v and w: four of its rows, blended. */
typedef struct row_of_table {
    const float *row[4];
    float part_v, part_w;
    int32_t mask;
} row_of_table;

static row_of_table find_row(const iso_lattice_cell *cell, double v, double w) {
    iso_cell_place y = cell_place(v, cell->size[1]), z = cell_place(w, cell->size[2]);
    int64_t n0 = cell->size[0], n1 = cell->size[1];
    const float *low = cell->distance + n0 * n1 * z.low, *high = cell->distance + n0 * n1 * z.high;
    return (row_of_table){
        {low + n0 * y.low, low + n0 * y.high, high + n0 * y.low, high + n0 * y.high},
        (float)y.part,
        (float)z.part,
        cell->size[0] - 1};
}

/* Samples at, at + 1, ... of it; each depends on its index alone, wherever a row begins. */
static void blend(float *to, const row_of_table *table, int32_t at, int32_t count) {
    for (int32_t done = 0; done < count;) {
        int32_t from = (at + done) & table->mask, n = table->mask + 1 - from;
        n = n < count - done ? n : count - done;
        const float *a = table->row[0] + from, *b = table->row[1] + from;
        const float *c = table->row[2] + from, *d = table->row[3] + from;
        float v = table->part_v, w = table->part_w;
        for (int32_t i = 0; i < n; i++) {
            float low = a[i] + v * (b[i] - a[i]), high = c[i] + v * (d[i] - c[i]);
            to[done + i] = low + w * (high - low);
        }
        done += n;
    }
}

/* Nodes first .. first + count - 1 of a row whose samples, from `base` to the last that is needed
 * or a whole period, fit into `blended`. */
static void sample_blended(double *distance, const row_of_table *table, double from, double step,
                           double size, int32_t count, int32_t first) {
    float blended[ROW + 1];
    double begin = from + step * first, end = from + step * (first + count - 1);
    int32_t base = (int32_t)floor(begin), last = (int32_t)floor(end) + 1, mask = -1;
    if (last - base > table->mask) {
        base = 0;
        last = table->mask + 1;
        mask = table->mask;
    }
    blend(blended, table, base, last - base + 1);
    for (int32_t i = 0; i < count; i++) {
        double u = from + step * (first + i);
        int32_t low = (int32_t)u;
        low -= u < low;
        double part = u - low;
        const float *at = blended + ((low - base) & mask);
        distance[i] = (at[0] + part * (at[1] - at[0])) * size;
    }
}

/* Of a straight lattice. */
static void sample_row_straight(double *distance, const iso_lattice *lattice,
                                const iso_lattice_plane *plane, int32_t row, int32_t first,
                                int32_t count) {
    const double *samples = lattice->samples;
    double size = lattice->size.value, scale = samples[0] / size;
    iso_vec3 origin = lattice->space.origin;
    double y = plane->origin.y + plane->step * row - origin.y, z = plane->z - origin.z;
    row_of_table table = find_row(&lattice->cell, y / size * samples[1], z / size * samples[2]);
    double from = (plane->origin.x - origin.x) * scale, step = plane->step * scale;
    int32_t most = count; /* nodes at once */
    if (table.mask >= ROW && step * count > ROW - 2)
        most = step > ROW - 2 ? 1 : (int32_t)((ROW - 2) / step);
    for (int32_t done = 0; done < count; done += most) {
        int32_t n = count - done < most ? count - done : most;
        sample_blended(distance + done, &table, from, step, size, n, first + done);
    }
}

/* ---- any lattice, anywhere ---- */

/* g in cells, and how it changes there, per cell. */
static double distance_and_slope(double slope[3], const iso_lattice *lattice, const double at[3]) {
    const iso_lattice_cell *cell = &lattice->cell;
    iso_cell_place x = cell_place(at[0], cell->size[0]), y = cell_place(at[1], cell->size[1]),
                   z = cell_place(at[2], cell->size[2]);
    int64_t n0 = cell->size[0], n1 = cell->size[1];
    const float *low = cell->distance + n0 * n1 * z.low, *high = cell->distance + n0 * n1 * z.high;
    const float *row[4] = {low + n0 * y.low, low + n0 * y.high, high + n0 * y.low,
                           high + n0 * y.high};
    double value[4], along[4];
    for (int i = 0; i < 4; i++) {
        along[i] = row[i][x.high] - row[i][x.low];
        value[i] = row[i][x.low] + x.part * along[i];
    }
    double near = value[0] + y.part * (value[1] - value[0]);
    double far = value[2] + y.part * (value[3] - value[2]);
    double near_along = along[0] + y.part * (along[1] - along[0]);
    double far_along = along[2] + y.part * (along[3] - along[2]);
    double near_across = value[1] - value[0], far_across = value[3] - value[2];
    slope[0] = (near_along + z.part * (far_along - near_along)) * lattice->samples[0];
    slope[1] = (near_across + z.part * (far_across - near_across)) * lattice->samples[1];
    slope[2] = (far - near) * lattice->samples[2];
    return near + z.part * (far - near);
}

/* mm in a cell, across the surface: its slope tells which way that is. */
static double length_of_cell(const double slope[3], const double stretch[3], double size) {
    double square = 0, stretched = 0;
    for (int k = 0; k < 3; k++) {
        double part = slope[k] / stretch[k];
        square += slope[k] * slope[k];
        stretched += part * part;
    }
    return square > 1e-6 && stretched > 0 ? sqrt(square / stretched) : size;
}

/* Is this within what the table can be asked? Else something was no number, or divided by 0. */
static bool is_usable(const double at[3], double size) {
    return fabs(at[0]) < 1e9 && fabs(at[1]) < 1e9 && fabs(at[2]) < 1e9 && size > 0 &&
           size < HUGE_VAL;
}

/* distance: mm; unit: mm in a cell, or 0 where there is no lattice. */
static void measure(double *distance, double *unit, const iso_lattice *lattice,
                    const iso_places *places, int32_t count) {
    iso_cell_places cells, stretch;
    double size[GRADING_BLOCK];
    bool even = map_is_even(&lattice->map);
    grading_evaluate(size, &lattice->size, places->variable, count);
    map_cells(cells, &lattice->map, places, size, count);
    if (!even)
        map_stretch(stretch, &lattice->map, places, size, count);
    for (int32_t i = 0; i < count; i++) {
        double at[3], slope[3], g;
        for (int k = 0; k < 3; k++)
            at[k] = cells[k][i] * lattice->samples[k];
        distance[i] = unit[i] = 0;
        if (!is_usable(at, size[i]))
            continue;
        unit[i] = size[i];
        if (even) {
            g = cell_at(&lattice->cell, at[0], at[1], at[2]);
        } else {
            g = distance_and_slope(slope, lattice, at);
            const double length[3] = {stretch[0][i], stretch[1][i], stretch[2][i]};
            unit[i] = length_of_cell(slope, length, size[i]);
        }
        distance[i] = g * unit[i];
    }
}

static void find_halves(double *half, const double *unit, const iso_lattice *lattice,
                        const iso_places *places, int32_t count) {
    double density[GRADING_BLOCK];
    grading_evaluate(density, &lattice->density, places->variable, count);
    for (int32_t i = 0; i < count; i++)
        half[i] = unit[i] > 0 ? half_of(lattice, density[i], unit[i]) : -HUGE_VAL;
}

/* In the frame; depends on the node alone, wherever a piece of its row begins. */
static double x_of_node(const iso_lattice *lattice, const iso_lattice_plane *plane, int32_t node) {
    return plane->origin.x + plane->step * node - lattice->space.origin.x;
}

/* Void where the cut says so: as deep in it as a voxel is long. Runs are walked along the row. */
static void cut_row(double *distance, double *half, const iso_lattice *lattice, iso_vec3 at,
                    const iso_lattice_plane *plane, int32_t first, int32_t count) {
    const iso_lattice_cut *cut = lattice->cut;
    at.x = x_of_node(lattice, plane, first);
    for (int64_t i = 0, run = cut_find(cut, at); i < count; i++) {
        at.x = x_of_node(lattice, plane, first + (int32_t)i);
        while (run < cut->count && cut_is_before(cut, run, at))
            run++;
        if (!cut_meets(cut, run, at))
            continue;
        distance[i] = 0;
        half[i] = -cut->voxel;
    }
}

/* Nodes in the frame, at most a block, from `at` along x. */
static void place_nodes(iso_places *places, const iso_lattice *lattice, iso_vec3 at,
                        const iso_lattice_plane *plane, int32_t first, int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        places->value[GRADING_X][i] = x_of_node(lattice, plane, first + i);
        places->value[GRADING_Y][i] = at.y;
        places->value[GRADING_Z][i] = at.z;
    }
}

void lattice_sample_row(double *distance, double *half, const iso_lattice *lattice,
                        const iso_lattice_plane *plane, int32_t row, int32_t first, int32_t count) {
    bool straight = is_straight(lattice), even = straight && !lattice->density.expression;
    if (straight)
        sample_row_straight(distance, lattice, plane, row, first, count);
    for (int32_t i = 0; i < count && even; i++)
        half[i] = lattice->half;
    if (lattice_is_uniform(lattice))
        return;
    iso_vec3 origin = lattice->space.origin;
    iso_vec3 at = {0, plane->origin.y + plane->step * row - origin.y, plane->z - origin.z};
    double unit[GRADING_BLOCK];
    for (int32_t done = 0, n; done < count && !even; done += n) {
        iso_places places;
        n = count - done < GRADING_BLOCK ? count - done : GRADING_BLOCK;
        place_nodes(&places, lattice, at, plane, first + done, n);
        space_know(&places, &lattice->space, lattice->wanted, n);
        for (int32_t i = 0; i < n && straight; i++)
            unit[i] = lattice->size.value;
        if (!straight)
            measure(distance + done, unit, lattice, &places, n);
        find_halves(half + done, unit, lattice, &places, n);
    }
    if (lattice->cut)
        cut_row(distance, half, lattice, at, plane, first, count);
}

/* Points as the part's frame has them, and all else that is asked of them. */
static void place_points(iso_places *places, const iso_lattice *lattice, const iso_vec3 *point,
                         int32_t count) {
    iso_vec3 origin = lattice->space.origin;
    for (int32_t i = 0; i < count; i++) {
        places->value[GRADING_X][i] = point[i].x - origin.x;
        places->value[GRADING_Y][i] = point[i].y - origin.y;
        places->value[GRADING_Z][i] = point[i].z - origin.z;
    }
    space_know(places, &lattice->space, lattice->wanted, count);
}

void lattice_sample(double *value, const iso_lattice *lattice, const iso_vec3 *point,
                    int64_t count) {
    double distance[GRADING_BLOCK], half[GRADING_BLOCK], unit[GRADING_BLOCK];
    for (int64_t done = 0, n; done < count; done += n) {
        iso_places places;
        n = count - done < GRADING_BLOCK ? count - done : GRADING_BLOCK;
        place_points(&places, lattice, point + done, (int32_t)n);
        measure(distance, unit, lattice, &places, (int32_t)n);
        find_halves(half, unit, lattice, &places, (int32_t)n);
        for (int64_t i = 0; i < n; i++)
            value[done + i] = (lattice->cell.has_sides ? fabs(distance[i]) : distance[i]) - half[i];
        for (int64_t i = 0; i < n && lattice->cut; i++) {
            iso_vec3 at = {places.value[GRADING_X][i], places.value[GRADING_Y][i],
                           places.value[GRADING_Z][i]};
            if (cut_meets(lattice->cut, cut_find(lattice->cut, at), at))
                value[done + i] = lattice->cut->voxel;
        }
    }
}

void lattice_tools(uint8_t *tool, const iso_lattice *lattice, const iso_vec3 *point,
                   int64_t count) {
    iso_cell_places cells;
    double size[GRADING_BLOCK];
    for (int64_t done = 0, n; done < count; done += n) {
        iso_places places;
        n = count - done < GRADING_BLOCK ? count - done : GRADING_BLOCK;
        place_points(&places, lattice, point + done, (int32_t)n);
        grading_evaluate(size, &lattice->size, places.variable, n);
        map_cells(cells, &lattice->map, &places, size, (int32_t)n);
        for (int64_t i = 0; i < n; i++)
            tool[done + i] =
                (uint8_t)material_at(&lattice->material, cells[0][i], cells[1][i], cells[2][i]);
    }
}
