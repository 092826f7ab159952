#include "checks.h"

#include <isoprint/virtual_printer.h>
#include <isoslice/job.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "measure.h"
#include "part.h"
#include "planar/section.h"

enum { RUNS = 10, AROUND_MOST = 64 };

#define AREA_ALLOWED 1e-6
#define VOLUME_ALLOWED 3e-3

typedef struct check {
    const char *name;
    int broken;
} check;

static void ISO_PRINTF(2, 3) complain(check *c, const char *format, ...) {
    va_list values;
    va_start(values, format);
    printf("%s: VIOLATED: ", c->name);
    vprintf(format, values);
    putchar('\n');
    va_end(values);
    c->broken++;
}

/* ---- the same bytes ---- */

typedef struct text {
    char *bytes;
    size_t size;
} text;

static text read_text(const char *path) {
    FILE *file = fopen(path, "rb");
    bench_must_system(file != NULL, path);
    text t = {0};
    bench_must_system(fseek(file, 0, SEEK_END) == 0, path);
    t.size = (size_t)ftell(file);
    rewind(file);
    t.bytes = bench_allocate((int64_t)t.size);
    bench_must_system(fread(t.bytes, 1, t.size, file) == t.size, path);
    fclose(file);
    return t;
}

static text slice_to_text(iso_report *report, const char *model, const iso_options *options,
                          int threads, const char *path) {
    iso_job_hooks hooks = {.threads = threads};
    *report = (iso_report){0};
    bench_must(iso_job_run(report, options, &model, 1, path, &hooks), model);
    text t = read_text(path);
    unlink(path);
    return t;
}

/* The text of the first run, and its report. */
static text check_bytes(check *c, iso_report *report, const char *model, const iso_options *options,
                        const char *path) {
    text first = slice_to_text(report, model, options, 1, path);
    for (int threads = 1; threads <= 8; threads *= 2)
        for (int run = threads == 1; run < RUNS; run++) {
            iso_report other;
            text again = slice_to_text(&other, model, options, threads, path);
            if (again.size != first.size || memcmp(again.bytes, first.bytes, first.size) != 0)
                complain(c, "other bytes with %d threads, run %d", threads, run + 1);
            free(again.bytes);
            iso_report_free(&other);
        }
    return first;
}

/* ---- areas and volume ---- */

/* Green's theorem over the triangles, each cut by itself: no opposites, no contours. */
static void add_cut(double *area, const iso_vec3 corner[3], const iso_vec2 *base, double z) {
    double x[2], y[2];
    int found = 0, down_first = 0;
    for (int k = 0; k < 3; k++) {
        iso_vec3 p = corner[k], q = corner[(k + 1) % 3];
        if ((p.z <= z) == (q.z <= z))
            continue;
        double u = (z - p.z) / (q.z - p.z);
        if (found == 0)
            down_first = p.z > z;
        x[found] = p.x - base->x + u * (q.x - p.x);
        y[found++] = p.y - base->y + u * (q.y - p.y);
    }
    if (found == 2)
        *area += (down_first ? 1 : -1) * (x[0] * y[1] - y[0] * x[1]) / 2;
}

static void corners_of(iso_vec3 corner[3], const iso_mesh *mesh, int32_t triangle) {
    for (int k = 0; k < 3; k++)
        corner[k] = mesh->position[mesh->origin[3 * triangle + k]];
}

/* cut[] ascending. */
static void find_sections(double *area, const iso_mesh *mesh, const double *cut, int32_t count) {
    iso_vec2 base = {(mesh->min.x + mesh->max.x) / 2, (mesh->min.y + mesh->max.y) / 2};
    for (int32_t i = 0; i < count; i++)
        area[i] = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 corner[3];
        corners_of(corner, mesh, t);
        double low = fmin(corner[0].z, fmin(corner[1].z, corner[2].z));
        double high = fmax(corner[0].z, fmax(corner[1].z, corner[2].z));
        int32_t i = 0;
        for (int32_t end = count; i < end;) {
            int32_t middle = (i + end) / 2;
            if (cut[middle] < low)
                i = middle + 1;
            else
                end = middle;
        }
        for (; i < count && cut[i] <= high; i++)
            add_cut(&area[i], corner, &base, cut[i]);
    }
}

/* Flux of (0, 0, z) through the part of a triangle below `top`. */
static double flux_below(const iso_vec3 corner[3], double top) {
    iso_vec3 kept[6];
    int count = 0;
    for (int k = 0; k < 3; k++) {
        iso_vec3 p = corner[k], q = corner[(k + 1) % 3];
        if (p.z <= top)
            kept[count++] = p;
        if ((p.z <= top) != (q.z <= top)) {
            double u = (top - p.z) / (q.z - p.z);
            kept[count++] = (iso_vec3){p.x + u * (q.x - p.x), p.y + u * (q.y - p.y), top};
        }
    }
    double sum = 0;
    for (int k = 2; k < count; k++) {
        iso_vec3 a = kept[0], b = kept[k - 1], c = kept[k];
        double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        sum += twice / 2 * (a.z + b.z + c.z) / 3;
    }
    return sum;
}

static double volume_below(const iso_mesh *mesh, double top) {
    double lid, sum = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 corner[3];
        corners_of(corner, mesh, t);
        sum += flux_below(corner, top);
    }
    find_sections(&lid, mesh, &top, 1);
    return sum + top * lid;
}

typedef struct figures {
    double slice_area; /* largest relative deviation of a layer's slices */
    double rounded;    /* of all layers together: rounded to units */
    double thinned;    /* and then thinned */
    double volume;     /* relative deviation, signed */
    int64_t regions;   /* validated */
    int32_t layers;    /* on which anything is drawn */
} figures;

static double square_mm(const iso_region *region) {
    return (double)iso_region_double_area(region) / 2 /
           ((double)ISO_UNITS_PER_MM * ISO_UNITS_PER_MM);
}

/* How far the outlines are from the sections, before and after they are thinned. */
static void compare_outlines(figures *f, bench_part *part, const double *area) {
    iso_region *raw = &part->hand.raw;
    double rounded = 0, thinned = 0, sum = 0;
    for (int32_t i = 0; i < part->levels.count; i++) {
        iso_region_clear(raw);
        bench_must(section_add(raw, &part->slices, i), part->path);
        rounded += fabs(square_mm(raw) - area[i]);
        thinned += fabs(window_layer(&part->window, i)->square_mm - area[i]);
        sum += area[i];
    }
    f->rounded = rounded / sum;
    f->thinned = thinned / sum;
}

static void check_areas(check *c, figures *f, bench_part *part) {
    int32_t count = part->levels.count;
    double *area = bench_allocate(count * (int64_t)sizeof *area), sum = 0;
    double volume = volume_below(&part->mesh, part->levels.top[count - 1]);
    find_sections(area, &part->mesh, part->levels.cut, count);
    for (int32_t i = 0; i < count; i++) {
        double found = section_area(&part->slices, i);
        double off = fabs(found - area[i]) / fmax(area[i], 1e-3); /* specks by the dot */
        f->slice_area = fmax(f->slice_area, off);
        if (off > AREA_ALLOWED)
            complain(c, "layer %d: %.9g mm^2 instead of %.9g", i, found, area[i]);
        sum += window_layer(&part->window, i)->square_mm * part->levels.height[i];
    }
    compare_outlines(f, part, area);
    f->volume = sum / volume - 1;
    if (fabs(f->volume) > VOLUME_ALLOWED)
        complain(c, "%.4f mm^3 printed, the mesh has %.4f", sum, volume);
    free(area);
}

/* ---- regions ---- */

static void check_region(check *c, figures *f, bench_part *part, const iso_region *region,
                         const char *what, int32_t layer) {
    f->regions++;
    if (iso_region_validate(region, part->hand.planar) != ISO_OK)
        complain(c, "layer %d, %s: %s", layer, what, iso_error_message());
}

static bool is_drawn(const iso_paths *paths) {
    for (int32_t i = 0; i < paths->count; i++)
        if (paths->path[i].count > 1)
            return true;
    return false;
}

static void check_regions(check *c, figures *f, bench_part *part) {
    if (iso_mesh_validate(&part->mesh) != ISO_OK || iso_slices_validate(&part->slices) != ISO_OK)
        complain(c, "%s", iso_error_message());
    for (int32_t i = 0; i < part->levels.count; i++) {
        iso_layer *layer = window_layer(&part->window, i);
        iso_shell *shell = &layer->shell;
        check_region(c, f, part, &layer->region, "outline", i);
        for (int32_t k = 0; k < part->window.levels; k++)
            if (i < window_wide_end(k, part->levels.count))
                check_region(c, f, part, &layer->run[k], "run of layers", i);
        check_region(c, f, part, &layer->area, "area of the fill", i);
        part_fill(part, i);
        check_region(c, f, part, &shell->top, "top", i);
        check_region(c, f, part, &shell->solid, "solid", i);
        check_region(c, f, part, &shell->sparse, "sparse", i);
        f->layers += is_drawn(&layer->paths);
    }
}

/* ---- the printer ---- */

static void check_printing(check *c, fio_statistics *statistics, const text *gcode) {
    fio_virtual_options options = fio_virtual_options_defaults();
    fio_virtual_printer *printer;
    for (int axis = 0; axis < 3; axis++)
        options.size[axis] = 400;
    if (fio_virtual_printer_create(&printer, &options, NULL) != FIO_OK ||
        fio_virtual_printer_run(printer, gcode->bytes, gcode->size) != FIO_OK ||
        fio_virtual_printer_finish(printer) != FIO_OK)
        complain(c, "virtual printer: %s", fio_error_message());
    if (printer)
        *statistics = *fio_virtual_printer_statistics(printer);
    fio_virtual_printer_free(printer);
}

static void print_figures(const check *c, const figures *f, const bench_part *part,
                          const fio_statistics *printed, size_t bytes) {
    printf("%s: %s; %d layers, %d empty; %zu bytes, %d runs alike; area off by %.1e at most "
           "(rounded %.1e, thinned %.1e); volume %+.4f %%; %lld regions; printer: %lld faults, "
           "%lld warnings, %.0f s, %.1f mm\n",
           c->name, c->broken ? "BROKEN" : "good", part->levels.count,
           part->levels.count - f->layers, bytes, 4 * RUNS, f->slice_area, f->rounded, f->thinned,
           100 * f->volume, (long long)f->regions, (long long)printed->fault_count,
           (long long)printed->warning_count, printed->total_time, printed->filament);
    fflush(stdout);
}

int checks_run(const char *path, const iso_options *options, const char *scratch_path) {
    const char *slash = strrchr(path, '/');
    check c = {.name = slash ? slash + 1 : path};
    figures f = {0};
    fio_statistics printed = {0};
    iso_report report;
    bench_part part;
    text gcode = check_bytes(&c, &report, path, options, scratch_path);
    part_load(&part, path, options);
    check_areas(&c, &f, &part);
    check_regions(&c, &f, &part);
    check_printing(&c, &printed, &gcode);
    if (printed.layers != f.layers)
        complain(&c, "%lld layers were printed, not %d", (long long)printed.layers, f.layers);
    print_figures(&c, &f, &part, &printed, gcode.size);
    free(gcode.bytes);
    part_free(&part);
    iso_report_free(&report);
    return c.broken;
}
