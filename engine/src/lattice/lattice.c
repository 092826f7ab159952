#include "lattice/lattice.h"

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "lattice/grading.h"
#include "lattice/space.h"

struct iso_lattice {
    iso_lattice_cell cell;
    iso_grading size, density; /* mm; percent */
    iso_space space;
    uint32_t wanted;   /* variables, as bits */
    double samples[3]; /* of the table, in a cell */
    double smallest;   /* mm, of a cell's edge */
    double half;       /* mm, where density and size are constant */
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

/* mm from the skeleton to the surface of the material; density in percent. */
static double half_of(const iso_lattice *lattice, double density, double size) {
    if (!(density > 0))
        return -HUGE_VAL;
    if (density >= 100)
        return HUGE_VAL;
    return cell_level(&lattice->cell, density / 100) * size;
}

static iso_status make(iso_lattice *lattice, const iso_lattice_options *options,
                       const iso_mesh *mesh, int32_t count) {
    ISO_TRY(grading_make(&lattice->size, options->cell, "lattice_cell"));
    ISO_TRY(grading_make(&lattice->density, options->density, "lattice_density"));
    ISO_TRY(space_make(&lattice->space, mesh, count));
    if (!lattice->size.expression)
        ISO_TRY(check_size(lattice, lattice->size.value, (iso_vec3){0}));
    ISO_TRY(cell_make(&lattice->cell, options));
    for (int k = 0; k < 3; k++)
        lattice->samples[k] = (double)lattice->cell.size[k] / lattice->cell.repeat[k];
    lattice->smallest = lattice->size.value;
    lattice->half = half_of(lattice, lattice->density.value, lattice->size.value);
    return ISO_OK;
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
    cell_free(&lattice->cell);
    iso_release(lattice);
}

const iso_lattice_cell *lattice_cell(const iso_lattice *lattice) {
    return &lattice->cell;
}

int lattice_is_uniform(const iso_lattice *lattice) {
    return !lattice->size.expression && !lattice->density.expression;
}

double lattice_smallest_cell(const iso_lattice *lattice) {
    return lattice->smallest;
}

/* ---- sampling, uniform ---- */

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

static void sample_row_uniform(double *distance, const iso_lattice *lattice,
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

/* ---- sampling ---- */

void lattice_sample_row(double *distance, double *half, const iso_lattice *lattice,
                        const iso_lattice_plane *plane, int32_t row, int32_t first, int32_t count) {
    sample_row_uniform(distance, lattice, plane, row, first, count);
    for (int32_t i = 0; i < count; i++)
        half[i] = lattice->half;
}

void lattice_sample(double *value, const iso_lattice *lattice, const iso_vec3 *point,
                    int64_t count) {
    const double *samples = lattice->samples;
    double size = lattice->size.value;
    iso_vec3 origin = lattice->space.origin;
    for (int64_t i = 0; i < count; i++) {
        double x = (point[i].x - origin.x) / size, y = (point[i].y - origin.y) / size;
        double z = (point[i].z - origin.z) / size;
        double g = cell_at(&lattice->cell, x * samples[0], y * samples[1], z * samples[2]) * size;
        value[i] = (lattice->cell.has_sides ? fabs(g) : g) - lattice->half;
    }
}
