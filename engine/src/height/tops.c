#include "height/tops.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "base/vector.h"

/* Share of the steepest slope over which tops lose their weight: one that is a hair too steep must
 * not be left alone where its neighbour counts in full. */
#define FADE 0.1

typedef struct facet {
    iso_vec3 corner[3];
    double slope_x, slope_y, weight;
} facet;

static double weight_of(double slope, double steepest) {
    return fmin(fmax((steepest - slope) / (FADE * steepest), 0), 1);
}

static iso_status add_sample(tops *t, const spline *s, const facet *f, int64_t i, int64_t j) {
    double step = s->step / TOPS_ACROSS;
    top at = {.x = s->corner.x + ((double)i + 0.5) * step,
              .y = s->corner.y + ((double)j + 0.5) * step,
              .slope_x = f->slope_x,
              .slope_y = f->slope_y,
              .weight = f->weight};
    at.z = f->corner[0].z + (at.x - f->corner[0].x) * f->slope_x +
           (at.y - f->corner[0].y) * f->slope_y;
    int64_t cell = i / TOPS_ACROSS + s->columns * (j / TOPS_ACROSS);
    t->tallest[cell] = fmax(t->tallest[cell], at.z);
    if (!(at.weight > 0))
        return ISO_OK;
    ISO_TRY(ISO_GROW(t->top, t->capacity, t->count + 1));
    t->top[t->count++] = at;
    return ISO_OK;
}

static int64_t sample_number(double at, double corner, double step, int64_t most) {
    return (int64_t)fmin(fmax(ceil((at - corner) / step - 0.5), 0), (double)most);
}

/* Where a row at y crosses the facet, if it does. */
static int crossing(double *from, double *to, const facet *f, double y) {
    *from = INFINITY;
    *to = -INFINITY;
    for (int k = 0; k < 3; k++) {
        iso_vec3 a = f->corner[k], b = f->corner[(k + 1) % 3];
        if ((a.y <= y) == (b.y <= y))
            continue;
        double x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
        *from = fmin(*from, x);
        *to = fmax(*to, x);
    }
    return *from < *to;
}

static iso_status add_facet(tops *t, const spline *s, const facet *f) {
    double step = s->step / TOPS_ACROSS;
    int64_t columns = (int64_t)TOPS_ACROSS * (s->columns - 1);
    int64_t rows = (int64_t)TOPS_ACROSS * (s->rows - 1);
    double low = fmin(f->corner[0].y, fmin(f->corner[1].y, f->corner[2].y));
    double high = fmax(f->corner[0].y, fmax(f->corner[1].y, f->corner[2].y));
    int64_t end = sample_number(high, s->corner.y, step, rows);
    for (int64_t j = sample_number(low, s->corner.y, step, rows); j < end; j++) {
        double from, to;
        if (!crossing(&from, &to, f, s->corner.y + ((double)j + 0.5) * step))
            continue;
        int64_t last = sample_number(to, s->corner.x, step, columns);
        for (int64_t i = sample_number(from, s->corner.x, step, columns); i < last; i++)
            ISO_TRY(add_sample(t, s, f, i, j));
    }
    return ISO_OK;
}

static iso_status add_mesh(tops *t, const spline *s, const iso_mesh *mesh, double steepest) {
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        facet f;
        for (int k = 0; k < 3; k++)
            f.corner[k] = mesh->position[mesh->origin[3 * i + k]];
        iso_vec3 normal =
            vec3_cross(vec3_minus(f.corner[1], f.corner[0]), vec3_minus(f.corner[2], f.corner[0]));
        if (!(normal.z > 1e-6 * vec3_length(normal)))
            continue;
        f.slope_x = -normal.x / normal.z;
        f.slope_y = -normal.y / normal.z;
        f.weight = weight_of(sqrt(f.slope_x * f.slope_x + f.slope_y * f.slope_y), steepest);
        ISO_TRY(add_facet(t, s, &f));
    }
    return ISO_OK;
}

iso_status tops_find(tops *t, const spline *s, const iso_mesh *mesh, int32_t count,
                     double steepest) {
    int64_t cells = (int64_t)s->columns * s->rows;
    *t = (tops){0};
    ISO_TRY(ISO_ALLOCATE(t->tallest, cells));
    for (int64_t k = 0; k < cells; k++)
        t->tallest[k] = -INFINITY;
    iso_status status = ISO_OK;
    for (int32_t i = 0; i < count && status == ISO_OK; i++)
        status = add_mesh(t, s, &mesh[i], steepest);
    if (status != ISO_OK)
        tops_free(t);
    return status;
}

void tops_free(tops *t) {
    iso_release(t->top);
    iso_release(t->tallest);
    *t = (tops){0};
}
