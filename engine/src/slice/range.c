#include "slice/range.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/vector.h"
#include "height/height.h"
#include "slice/bounds.h"

/* mm: what the range may be off. */
#define RANGE_EXACTNESS 0.001

enum {
    RANGE_DEPTH = 16,      /* times that a face is quartered */
    RANGE_WORK = 400000,   /* quarterings of all faces together, */
    RANGE_FACE_WORK = 4000 /* and of one: where bounds tell little, as near a surface that distances
                              are to, samples as close as this leaves are what is known */
};

typedef struct range_search {
    const iso_field *field;
    double low, high;
    bounds_cells cells;
    int32_t work, face_work; /* left to do */
} range_search;

typedef struct range_face {
    iso_vec3 corner[3];
    double value[3];
} range_face;

static void take(range_search *s, double value) {
    s->low = fmin(s->low, value);
    s->high = fmax(s->high, value);
}

static void find_box(iso_vec3 box[2], const iso_vec3 p[3]) {
    box[0] = vec3(fmin(p[0].x, fmin(p[1].x, p[2].x)), fmin(p[0].y, fmin(p[1].y, p[2].y)),
                  fmin(p[0].z, fmin(p[1].z, p[2].z)));
    box[1] = vec3(fmax(p[0].x, fmax(p[1].x, p[2].x)), fmax(p[0].y, fmax(p[1].y, p[2].y)),
                  fmax(p[0].z, fmax(p[1].z, p[2].z)));
}

/* May the face hold less or more than what is known? It is between its corners' values but for two
 * thirds of how far the slopes along its edges spread (refine.c). */
static bool may_widen(const range_search *s, const range_face *f, const bounds *b) {
    double spread = 0;
    for (int k = 0; k < 3; k++) {
        iso_vec3 edge = vec3_minus(f->corner[(k + 1) % 3], f->corner[k]);
        spread = fmax(spread, bounds_spread(b, edge));
    }
    double margin = spread * (2.0 / 3);
    double low = fmin(f->value[0], fmin(f->value[1], f->value[2])) - margin;
    double high = fmax(f->value[0], fmax(f->value[1], f->value[2])) + margin;
    return fmax(low, b->low) < s->low - RANGE_EXACTNESS ||
           fmin(high, b->high) > s->high + RANGE_EXACTNESS;
}

/* Quarter the face for as long as it may. */
static void search_face(range_search *s, const range_face *f, int depth) {
    iso_vec3 box[2], middle[3];
    double value[3];
    find_box(box, f->corner);
    bounds b = bounds_over(s->field, box[0], box[1]);
    if (depth == 0 || !may_widen(s, f, &b) || s->work == 0 || s->face_work == 0)
        return;
    s->work--;
    s->face_work--;
    for (int k = 0; k < 3; k++)
        middle[k] = vec3_between(f->corner[k], f->corner[(k + 1) % 3], 0.5);
    iso_field_evaluate(value, NULL, s->field, middle, 3);
    for (int k = 0; k < 3; k++)
        take(s, value[k]);
    for (int k = 0; k < 3; k++) {
        int before = (k + 2) % 3;
        range_face part = {{f->corner[k], middle[k], middle[before]},
                           {f->value[k], value[k], value[before]}};
        search_face(s, &part, depth - 1);
    }
    range_face inner = {{middle[0], middle[1], middle[2]}, {value[0], value[1], value[2]}};
    search_face(s, &inner, depth - 1);
}

static void search_faces(range_search *s, const double *height, const iso_mesh *mesh) {
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        range_face f;
        iso_vec3 box[2];
        for (int k = 0; k < 3; k++) {
            int32_t v = mesh->origin[3 * t + k];
            f.corner[k] = mesh->position[v];
            f.value[k] = height[v];
        }
        find_box(box, f.corner);
        const bounds *b = bounds_cells_around(&s->cells, s->field, box[0], box[1]);
        s->face_work = RANGE_FACE_WORK;
        if (!b || may_widen(s, &f, b))
            search_face(s, &f, RANGE_DEPTH);
    }
}

static iso_status take_vertices(range_search *s, const double *height, const iso_mesh *mesh) {
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        iso_vec3 p = mesh->position[v];
        if (!isfinite(height[v]))
            return iso_fail(ISO_BAD_CONFIG,
                            "field: it has no value at (%.3f, %.3f, %.3f) mm of the model", p.x,
                            p.y, p.z);
        take(s, height[v]);
    }
    return ISO_OK;
}

static iso_status search_mesh(range_search *s, double *height, const iso_mesh *mesh) {
    height_of_vertices(height, s->field, mesh);
    ISO_TRY(take_vertices(s, height, mesh));
    if (iso_field_kind_of(s->field) == ISO_FIELD_GEODESIC)
        return ISO_OK;
    iso_status status = bounds_cells_begin(&s->cells, mesh);
    if (status == ISO_OK)
        search_faces(s, height, mesh);
    bounds_cells_free(&s->cells);
    return status;
}

iso_status field_range(double range[2], const iso_field *field, const iso_mesh *mesh,
                       int32_t count) {
    range_search s = {.field = field, .low = INFINITY, .high = -INFINITY, .work = RANGE_WORK};
    iso_status status = ISO_OK;
    for (int32_t i = 0; i < count && status == ISO_OK; i++) {
        double *height;
        status = ISO_ALLOCATE(height, mesh[i].vertex_count);
        if (status == ISO_OK) {
            status = search_mesh(&s, height, &mesh[i]);
            iso_release(height);
        }
    }
    if (status == ISO_OK && !(s.low <= s.high))
        status = iso_fail(ISO_BAD_CONFIG, "field: there is nothing that it could be of");
    if (status == ISO_OK && !(isfinite(s.low) && isfinite(s.high)))
        status = iso_fail(ISO_BAD_CONFIG, "field: it has no value on some of the model");
    range[0] = s.low;
    range[1] = s.high;
    return status;
}
