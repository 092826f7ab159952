/* The planar kernel beside Clipper 6, on the layers of real models.
 *
 *     bench-planar part.stl...
 *
 * Union of the layers as sliced, then offsets of the cleaned and thinned layers. Both libraries
 * take turns, so that a slow moment of the machine hits both; the least CPU time of the rounds
 * counts. Conversion into Clipper's own types is not timed. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <isoslice/mesh.h>
#include <isoslice/planar.h>
#include <isoslice/slice.h>

#include "clipper_shim.h"

enum { ROUNDS = 5, THINNED_TO = 50 /* units */ };

typedef struct layers {
    int32_t count;
    iso_region *ours;
    clipper_paths **theirs;
} layers;

typedef struct stage {
    const char *name;
    int offsets; /* else cleans */
    iso_offset_options options;
} stage;

typedef struct result {
    double seconds, area;
    int64_t contours;
} result;

static void must(iso_status status) {
    if (status == ISO_OK)
        return;
    fprintf(stderr, "bench-planar: %s\n", iso_error_message());
    exit(1);
}

static double cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void *zeroed(int64_t count, size_t size) {
    void *block = calloc((size_t)count + 1, size);
    if (!block)
        exit(1);
    return block;
}

static int64_t points_of(const layers *in) {
    int64_t sum = 0;
    for (int32_t i = 0; i < in->count; i++)
        sum += in->ours[i].count ? in->ours[i].first[in->ours[i].count] : 0;
    return sum;
}

static void convert(layers *in) {
    in->theirs = zeroed(in->count, sizeof *in->theirs);
    for (int32_t i = 0; i < in->count; i++)
        in->theirs[i] = clipper_from_region(&in->ours[i]);
}

static void layers_free(layers *in) {
    for (int32_t i = 0; i < in->count; i++) {
        iso_region_free(&in->ours[i]);
        clipper_free(in->theirs[i]);
    }
    free(in->ours);
    free(in->theirs);
}

static void add_contour(iso_region *region, const iso_vec2 *point, int64_t count) {
    iso_point *whole = zeroed(count, sizeof *whole);
    for (int64_t k = 0; k < count; k++)
        whole[k] = (iso_point){iso_units(point[k].x), iso_units(point[k].y)};
    must(iso_region_add(region, whole, (int32_t)count));
    free(whole);
}

/* The model's layers of 0.2 mm, as they come from the slicer, rounded to units. */
static layers sliced(const char *path) {
    iso_mesh mesh = {0};
    iso_levels levels = {0};
    iso_slices slices = {0};
    must(iso_mesh_read(&mesh, path));
    iso_vec3 middle = {-(mesh.min.x + mesh.max.x) / 2, -(mesh.min.y + mesh.max.y) / 2, -mesh.min.z};
    iso_mesh_translate(&mesh, middle);
    must(iso_levels_uniform(&levels, mesh.max.z, 0.2, 0.2));
    must(iso_slice_planar(&slices, &mesh, &levels));
    layers out = {.count = slices.level_count};
    out.ours = zeroed(out.count, sizeof *out.ours);
    for (int32_t i = 0; i < slices.level_count; i++)
        for (int32_t c = slices.level_first[i]; c < slices.level_first[i + 1]; c++)
            add_contour(&out.ours[i], slices.point + slices.contour_first[c],
                        slices.contour_first[c + 1] - slices.contour_first[c]);
    iso_slices_free(&slices);
    iso_levels_free(&levels);
    iso_mesh_free(&mesh);
    convert(&out);
    return out;
}

static layers cleaned_and_thinned(const layers *raw, iso_planar_scratch *scratch) {
    layers out = {.count = raw->count};
    iso_region clean = {0};
    out.ours = zeroed(out.count, sizeof *out.ours);
    for (int32_t i = 0; i < raw->count; i++) {
        must(iso_region_clean(&clean, &raw->ours[i], ISO_FILL_NONZERO, scratch));
        must(iso_region_simplify(&out.ours[i], &clean, THINNED_TO, scratch));
    }
    iso_region_free(&clean);
    convert(&out);
    return out;
}

static result run_ours(const layers *in, const stage *s, iso_planar_scratch *scratch) {
    result r = {0};
    iso_region out = {0};
    double start = cpu_seconds();
    for (int32_t i = 0; i < in->count; i++) {
        if (s->offsets)
            must(iso_offset(&out, &in->ours[i], &s->options, scratch));
        else
            must(iso_region_clean(&out, &in->ours[i], ISO_FILL_NONZERO, scratch));
        r.area += (double)iso_region_double_area(&out) / 2;
        r.contours += out.count;
    }
    r.seconds = cpu_seconds() - start;
    iso_region_free(&out);
    return r;
}

static result run_theirs(const layers *in, const stage *s) {
    result r = {0};
    double start = cpu_seconds();
    for (int32_t i = 0; i < in->count; i++) {
        clipper_paths *out = s->offsets ? clipper_offset(in->theirs[i], &s->options)
                                        : clipper_clean(in->theirs[i], ISO_FILL_NONZERO);
        if (!out)
            continue;
        r.area += clipper_area(out);
        r.contours += clipper_contours(out);
        clipper_free(out);
    }
    r.seconds = cpu_seconds() - start;
    return r;
}

static void keep_best(result *best, result now, int first) {
    if (first || now.seconds < best->seconds)
        *best = now;
}

static void measure(const layers *in, const stage *s, double *sum) {
    iso_planar_scratch *scratch = NULL;
    result ours = {0}, theirs = {0};
    must(iso_planar_scratch_new(&scratch));
    for (int k = 0; k < ROUNDS; k++) {
        keep_best(&ours, run_ours(in, s, scratch), k == 0);
        keep_best(&theirs, run_theirs(in, s), k == 0);
    }
    iso_planar_counts n = iso_planar_get_counts(scratch);
    double points = (double)points_of(in);
    printf("%-16s %9.0f %8.1f %9.1f %6.1f %13.4f %13.4f %8lld %8lld %6lld %6lld %9lld\n", s->name,
           points, ours.seconds * 1e9 / points, theirs.seconds * 1e9 / points,
           theirs.seconds / ours.seconds, ours.area / 1e8, theirs.area / 1e8,
           (long long)ours.contours, (long long)theirs.contours, (long long)(n.untouched / ROUNDS),
           (long long)(n.arranged / ROUNDS), (long long)(n.collisions / ROUNDS));
    sum[0] += ours.seconds;
    sum[1] += theirs.seconds;
    iso_planar_scratch_free(scratch);
}

static void bench(const char *path) {
    stage stages[] = {{"union", 0, {0}},
                      {"+0.2 mm mitre", 1, iso_offset_defaults(2000)},
                      {"-0.2 mm mitre", 1, iso_offset_defaults(-2000)},
                      {"+0.2 mm round", 1, iso_offset_defaults(2000)},
                      {"-0.2 mm round", 1, iso_offset_defaults(-2000)}};
    stages[3].options.join = stages[4].options.join = ISO_JOIN_ROUND;
    iso_planar_scratch *scratch = NULL;
    must(iso_planar_scratch_new(&scratch));
    layers raw = sliced(path), thin = cleaned_and_thinned(&raw, scratch);
    double sum[2] = {0, 0};
    printf("%s, %d layers\n%-16s %9s %8s %9s %6s %13s %13s %8s %8s %6s %6s %9s\n", path, raw.count,
           "stage", "vertices", "ours ns", "Clipper ns", "ratio", "ours mm2", "Clipper mm2",
           "contours", "Clipper", "clear", "arr.", "collisions");
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++) {
        measure(stages[i].offsets ? &thin : &raw, &stages[i], sum);
        if (i == 2)
            printf("union and mitred offsets: %.3f s, Clipper %.3f s, ratio %.1f\n", sum[0], sum[1],
                   sum[1] / sum[0]);
    }
    printf("\n");
    layers_free(&raw);
    layers_free(&thin);
    iso_planar_scratch_free(scratch);
}

int main(int argc, char **argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: bench-planar part.stl...\n");
        return 2;
    }
    for (int i = 1; i < argc; i++)
        bench(argv[i]);
    return 0;
}
