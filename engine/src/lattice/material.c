#include "lattice/material.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

enum {
    THRESHOLDS = 512,
    CELLS_MOST = 1 << 27, /* a byte each */
    SAMPLES_MOST = 1 << 27,
    ALONG = 3 /* samples along the smallest cell, where they have no exact middle */
};

/* ---- thresholds ---- */

/* A matrix of 512 cells a side whose thresholds are a lattice themselves. Odd factors take each
 * line of it through all thresholds; these ones, found by trying, spread them most evenly over
 * blocks and slabs of 2 and 4 cells a side, about twice as well as Bayer's matrix does: that one
 * has but every other eighth in a plane, which shows where the share varies across it. */
double material_threshold(int32_t u, int32_t v, int32_t w) {
    uint32_t rank = 287u * (uint32_t)u + 387u * (uint32_t)v + 311u * (uint32_t)w;
    return (rank % THRESHOLDS + 0.5) / THRESHOLDS;
}

/* ---- cells ---- */

static int32_t cell_of(const iso_material *material, int k, double at) {
    double cell = floor(at) - material->first[k], last = material->length[k] - 1;
    return cell > 0 ? (int32_t)(cell < last ? cell : last) : 0;
}

/* Turns begin at 0, so that the cell where they meet is a whole one. */
static double unturned(double u, double around) {
    return around > 0 && u < 0 ? u + around : u;
}

static int64_t index_of(const iso_material *material, double u, double v, double w) {
    int64_t i = cell_of(material, 0, unturned(u, material->around));
    int64_t j = cell_of(material, 1, v), k = cell_of(material, 2, w);
    return i + material->length[0] * (j + material->length[1] * k);
}

int32_t material_at(const iso_material *material, double u, double v, double w) {
    return material->tool ? material->tool[index_of(material, u, v, w)] : 0;
}

static int64_t count_cells(const iso_material *material) {
    return (int64_t)material->length[0] * material->length[1] * material->length[2];
}

/* ---- samples ---- */

/* A grid of them over the part's box. */
typedef struct sampling {
    const iso_material_source *source;
    int32_t count[3];
    iso_vec3 first, step; /* mm, in the part's frame */
    double low[3], high[3];
    double *sum; /* [cells] of the shares */
    int32_t *hits;
    iso_places places;
    iso_cell_places cells;
} sampling;

/* Some of a row: the cells that they are in. */
static void locate(sampling *s, int32_t i, int32_t j, int32_t k, int32_t n) {
    const iso_material_source *source = s->source;
    double size[GRADING_BLOCK];
    for (int32_t a = 0; a < n; a++) {
        s->places.value[GRADING_X][a] = s->first.x + s->step.x * (i + a);
        s->places.value[GRADING_Y][a] = s->first.y + s->step.y * j;
        s->places.value[GRADING_Z][a] = s->first.z + s->step.z * k;
    }
    space_know(&s->places, source->space, source->wanted, n);
    grading_evaluate(size, source->size, s->places.variable, n);
    map_cells(s->cells, source->map, &s->places, size, n);
    for (int32_t a = 0; a < n; a++)
        s->cells[0][a] = unturned(s->cells[0][a], source->map->around);
}

static void widen(sampling *s, int32_t n) {
    for (int k = 0; k < 3; k++)
        for (int32_t a = 0; a < n; a++) {
            s->low[k] = fmin(s->low[k], s->cells[k][a]);
            s->high[k] = fmax(s->high[k], s->cells[k][a]);
        }
}

static void add_up(sampling *s, const iso_material *material, int32_t n) {
    double share[GRADING_BLOCK];
    grading_evaluate(share, s->source->share, s->places.variable, n);
    for (int32_t a = 0; a < n; a++) {
        int64_t cell = index_of(material, s->cells[0][a], s->cells[1][a], s->cells[2][a]);
        s->sum[cell] += share[a];
        s->hits[cell]++;
    }
}

/* All of them; with a material into its cells, else to see how far those reach. */
static void sample(sampling *s, const iso_material *material) {
    for (int32_t k = 0; k < s->count[2]; k++)
        for (int32_t j = 0; j < s->count[1]; j++)
            for (int32_t i = 0, n; i < s->count[0]; i += n) {
                n = s->count[0] - i < GRADING_BLOCK ? s->count[0] - i : GRADING_BLOCK;
                locate(s, i, j, k, n);
                if (material)
                    add_up(s, material, n);
                else
                    widen(s, n);
            }
}

/* From end to end of the box, so that no cell that it meets by much is left out. */
static void spread(double *first, double *step, int32_t *count, const double range[2],
                   double most) {
    double steps = ceil((range[1] - range[0]) / most);
    *count = steps >= 1 ? (int32_t)steps + 1 : 2;
    *first = range[0];
    *step = (range[1] - range[0]) / (*count - 1);
}

static void spread_evenly(sampling *s) {
    const iso_space *space = s->source->space;
    double x[2] = {space->min.x, space->max.x}, y[2] = {space->min.y, space->max.y};
    double z[2] = {space->min.z, space->max.z};
    double step = s->source->smallest / ALONG;
    double all =
        ((x[1] - x[0]) / step + 2) * ((y[1] - y[0]) / step + 2) * ((z[1] - z[0]) / step + 2);
    if (all > SAMPLES_MOST) /* cells of many sizes: the smallest are seen by fewer */
        step *= ceil(sqrt(all / SAMPLES_MOST));
    spread(&s->first.x, &s->step.x, &s->count[0], x, step);
    spread(&s->first.y, &s->step.y, &s->count[1], y, step);
    spread(&s->first.z, &s->step.z, &s->count[2], z, step);
}

/* One in the middle of each. */
static void spread_over_cubes(sampling *s) {
    const iso_space *space = s->source->space;
    double size = s->source->smallest;
    const double low[3] = {space->min.x, space->min.y, space->min.z};
    const double high[3] = {space->max.x, space->max.y, space->max.z};
    double first[3];
    for (int k = 0; k < 3; k++) {
        double begin = floor(low[k] / size), cells = floor(high[k] / size) - begin + 1;
        first[k] = (begin + 0.5) * size;
        s->count[k] = cells < CELLS_MOST ? (int32_t)cells : CELLS_MOST;
    }
    s->first = (iso_vec3){first[0], first[1], first[2]};
    s->step = (iso_vec3){size, size, size};
}

/* ---- making ---- */

/* Straight cells need no look: they are as many as samples. */
static iso_status bound(iso_material *material, sampling *s) {
    double cells = 1;
    for (int k = 0; k < 3; k++) {
        s->low[k] = HUGE_VAL;
        s->high[k] = -HUGE_VAL;
    }
    if (!s->source->straight) {
        sample(s, NULL);
    } else {
        const double first[3] = {s->first.x, s->first.y, s->first.z};
        for (int k = 0; k < 3; k++) {
            s->low[k] = first[k] / s->source->smallest;
            s->high[k] = s->low[k] + s->count[k] - 1;
        }
    }
    for (int k = 0; k < 3; k++) {
        double length = floor(s->high[k]) - floor(s->low[k]) + 1;
        cells *= length;
        if (!(cells <= CELLS_MOST && fabs(s->low[k]) < 1e9))
            return iso_fail(ISO_BAD_CONFIG,
                            "lattice_material: the part has more than %d cells; larger ones are "
                            "needed, see lattice_cell",
                            (int)CELLS_MOST);
        material->first[k] = (int32_t)floor(s->low[k]);
        material->length[k] = (int32_t)length;
    }
    return ISO_OK;
}

static void choose(iso_material *material, const sampling *s) {
    const int32_t *length = material->length, *first = material->first;
    int64_t at = 0;
    for (int32_t k = 0; k < length[2]; k++)
        for (int32_t j = 0; j < length[1]; j++)
            for (int32_t i = 0; i < length[0]; i++, at++) {
                double share = s->hits[at] > 0 ? s->sum[at] / s->hits[at] : 0;
                material->tool[at] =
                    share > 100 * material_threshold(first[0] + i, first[1] + j, first[2] + k);
            }
}

static iso_status make(iso_material *material, sampling *s) {
    ISO_TRY(bound(material, s));
    int64_t count = count_cells(material);
    ISO_TRY(ISO_ALLOCATE(material->tool, count));
    ISO_TRY(ISO_ALLOCATE(s->sum, count));
    ISO_TRY(ISO_ALLOCATE(s->hits, count));
    memset(s->sum, 0, (size_t)count * sizeof *s->sum);
    memset(s->hits, 0, (size_t)count * sizeof *s->hits);
    sample(s, material);
    choose(material, s);
    return ISO_OK;
}

iso_status material_make(iso_material *material, const iso_material_source *source) {
    sampling *s;
    *material = (iso_material){.around = source->map->around};
    ISO_TRY(ISO_ALLOCATE(s, 1));
    memset(s, 0, sizeof *s);
    s->source = source;
    if (source->straight)
        spread_over_cubes(s);
    else
        spread_evenly(s);
    iso_status status = make(material, s);
    iso_release(s->sum);
    iso_release(s->hits);
    iso_release(s);
    if (status != ISO_OK)
        material_free(material);
    return status;
}

void material_free(iso_material *material) {
    iso_release(material->tool);
    material->tool = NULL;
}

/* ---- the link ---- */

iso_status material_link(iso_cube_link *out, const iso_material *material) {
    int64_t count = count_cells(material);
    const iso_axis axis[4] = {
        {material->length[0], 0}, {material->length[1], 0}, {material->length[2], 0}, {2, 0}};
    int32_t *p;
    if (!material->tool || 2 * count > INT32_MAX)
        return iso_fail(ISO_USAGE, "lattice: no cells to link, or too many");
    ISO_TRY(ISO_ALLOCATE(p, 2 * count));
    for (int64_t a = 0; a < count; a++) {
        int32_t tool = material->tool[a];
        p[a] = tool == 0 ? 1 : 0;
        p[count + a] = tool == 1 ? 2 : 0;
    }
    iso_status status = iso_cube_link_box(out, 4, axis, 0, NULL, p);
    iso_release(p);
    return status;
}
