#include "lattice/slice.h"

#include <math.h>
#include <stdbool.h>

#include "lattice/bulk.h"
#include "lattice/contour.h"
#include "lattice/samples.h"
#include "lattice/sheet.h"
#include "lattice/tools.h"

/* units; contours of sections are thinned by so much, and squares so near a region's boundary count
 * as on it. */
enum { THINNING = 20, REACH = 200 };

/* Material by how thick it is, in mm of half a sheet: above `thin`, to `thick`. */
typedef struct iso_share {
    double thin, thick;
} iso_share;
static const iso_share everything = {-SAMPLES_FAR, SAMPLES_FAR};

typedef struct siding {
    const samples *samples;
    iso_share share;
    double *value; /* two rows in turn */
} siding;

/* Above 0 where a place isn't of the share. */
static double off_share(const iso_share *share, double half) {
    double thin = share->thin - half, thick = half - share->thick;
    return thin > thick ? thin : thick;
}

/* Where the distance is at most half. Outside the region there is nothing, so every contour closes,
 * in squares that are outside. */
static void row(contour_row *out, void *context, int32_t j) {
    const siding *s = context;
    const raster *r = &s->samples->raster;
    const float *distance = samples_distance(s->samples, j), *half = samples_half(s->samples, j);
    double *value = s->value + (int64_t)(j & 1) * r->columns;
    for (int32_t i = 0; i < r->columns; i++) {
        double at = (double)distance[i] - half[i], off = off_share(&s->share, half[i]);
        value[i] = !raster_meets(r, i, j) ? SAMPLES_FAR : off > at ? off : at;
    }
    *out = (contour_row){value, NULL};
}

/* The far side of a sheet, below which there's none: turned round, to be taken away. */
static void far_row(contour_row *out, void *context, int32_t j) {
    const siding *s = context;
    const raster *r = &s->samples->raster;
    const float *distance = samples_distance(s->samples, j), *half = samples_half(s->samples, j);
    double *value = s->value + (int64_t)(j & 1) * r->columns;
    for (int32_t i = 0; i < r->columns; i++) {
        double at = (double)distance[i] + half[i], off = off_share(&s->share, half[i]);
        value[i] = !raster_meets(r, i, j) || half[i] < 0 ? SAMPLES_FAR : off > at ? off : at;
    }
    *out = (contour_row){value, NULL};
}

static iso_status add_curve(iso_region *raw, const contour *c, int32_t start, const raster *r,
                            iso_point *point, bool turned) {
    int32_t count = 0, i = start;
    for (const contour_crossing *at; (at = contour_step(c, &i));) {
        iso_point p = {(int32_t)floor(r->x + at->x * r->step + 0.5),
                       (int32_t)floor(r->y + at->y * r->step + 0.5)};
        if (count == 0 || point[count - 1].x != p.x || point[count - 1].y != p.y)
            point[count++] = p;
    }
    while (count > 1 && point[count - 1].x == point[0].x && point[count - 1].y == point[0].y)
        count--;
    if (count < 3)
        return ISO_OK;
    for (int32_t a = 0, b = count - 1; turned && a < b; a++, b--) {
        iso_point swap = point[a];
        point[a] = point[b];
        point[b] = swap;
    }
    return iso_region_add(raw, point, count);
}

static iso_status add_contours(iso_region *raw, siding *s, bool far, iso_arena *scratch) {
    const raster *r = &s->samples->raster;
    contour_grid grid = {
        .columns = r->columns, .rows = r->rows, .row = far ? far_row : row, .context = s};
    contour c;
    iso_point *point;
    int closed;
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ISO_TRY(ISO_PUSH(s->value, scratch, 2 * (int64_t)r->columns));
    ISO_TRY(contour_trace(&c, &grid, scratch));
    ISO_TRY(ISO_PUSH(point, scratch, c.count));
    for (int32_t start; (start = contour_start(&c, &closed)) >= 0;)
        ISO_TRY(add_curve(raw, &c, start, r, point, far));
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

/* A layer that is being filled. */
typedef struct filling {
    iso_paths *out;
    const iso_lattice_slice *slice;
    const iso_fill_options *fill;
    iso_arena *scratch;
    iso_planar_scratch *planar;
} filling;

static iso_status section_of(iso_region *out, const iso_region *area, const samples *taken,
                             const iso_share *share, const filling *f) {
    siding s = {taken, *share, NULL};
    iso_region raw = {0}, clean = {0};
    iso_status status = add_contours(&raw, &s, false, f->scratch);
    if (status == ISO_OK && taken->has_sides)
        status = add_contours(&raw, &s, true, f->scratch);
    if (status == ISO_OK)
        status = iso_region_simplify(&clean, &raw, THINNING, f->planar);
    if (status == ISO_OK)
        status = iso_boolean(out, ISO_INTERSECTION, &clean, area, f->planar);
    iso_region_free(&raw);
    iso_region_free(&clean);
    return status;
}

iso_status lattice_section(iso_region *out, const iso_region *area, const iso_lattice_slice *slice,
                           iso_arena *scratch, iso_planar_scratch *planar) {
    samples taken;
    filling f = {NULL, slice, NULL, scratch, planar};
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_region_clear(out);
    if (area->count == 0)
        return ISO_OK;
    iso_status status =
        samples_take(&taken, area, slice, samples_section_step(slice), REACH, scratch);
    if (status == ISO_OK)
        status = section_of(out, area, &taken, &everything, &f);
    iso_arena_pop(scratch, mark);
    return status;
}

static iso_status fill_share(const filling *f, const iso_region *area, const samples *taken,
                             const iso_share *share) {
    iso_region section = {0};
    iso_status status = section_of(&section, area, taken, share, f);
    if (status == ISO_OK)
        status = bulk_draw(f->out, &section, f->fill, f->scratch, f->planar);
    iso_region_free(&section);
    return status;
}

/* What isn't drawn as lines along its middle. Beads may reach to the edge of what is to be filled,
 * the margin further out than their middles. */
static iso_status fill_bulk(const filling *f, const iso_region *region, uint32_t left) {
    samples taken;
    sheet_bead bead = sheet_bead_of(f->fill);
    iso_region area = {0};
    iso_offset_options grow = iso_offset_defaults(f->fill->margin);
    iso_status status = iso_offset(&area, region, &grow, f->planar);
    if (status == ISO_OK)
        status = samples_take(&taken, &area, f->slice, samples_section_step(f->slice), REACH,
                              f->scratch);
    if (status == ISO_OK && !taken.has_sides)
        status = fill_share(f, &area, &taken, &everything);
    else
        for (int lines = 1; status == ISO_OK && lines <= SHEET_LINES + 1; lines++) {
            iso_share share = {sheet_limit(&bead, lines - 1),
                               lines > SHEET_LINES ? SAMPLES_FAR : sheet_limit(&bead, lines)};
            if (left >> lines & 1)
                status = fill_share(f, &area, &taken, &share);
        }
    iso_region_free(&area);
    return status;
}

static iso_status fill_all(const filling *f, const iso_region *region) {
    samples taken;
    uint32_t left = 0;
    sheet_bead bead = sheet_bead_of(f->fill);
    if (!lattice_cell(f->slice->lattice)->has_sides)
        return fill_bulk(f, region, left);
    ISO_TRY(samples_take(&taken, region, f->slice, samples_line_step(f->slice),
                         bead.tolerance + REACH, f->scratch));
    ISO_TRY(sheet_draw(f->out, &left, region, &taken, f->fill, f->scratch));
    return left ? fill_bulk(f, region, left) : ISO_OK;
}

iso_status lattice_fill(iso_paths *out, const iso_region *region, const iso_lattice_slice *slice,
                        const iso_fill_options *fill, iso_arena *scratch,
                        iso_planar_scratch *planar) {
    filling f = {out, slice, fill, scratch, planar};
    int32_t count = out->count, vertex_count = out->vertex_count;
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ISO_TRY(iso_fill_options_validate(fill));
    if (region->count == 0)
        return ISO_OK;
    iso_status status = fill_all(&f, region);
    if (status == ISO_OK)
        status = tools_choose(out, count, vertex_count, slice, scratch);
    iso_arena_pop(scratch, mark);
    if (status != ISO_OK) {
        out->count = count;
        out->vertex_count = vertex_count;
    }
    return status;
}
