#include "stages.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "floors.h"
#include "gcode/writer.h"
#include "measure.h"
#include "path/order.h"
#include "planar/island.h"
#include "planar/section.h"
#include "slice/range.h"

typedef struct bench_stages {
    bench_part part;
    const char *scratch_path;
    bench_table *table;

    iso_mesh mesh; /* made anew by each round */
    float *triangle;
    int64_t triangle_count;
    iso_slices slices;
    iso_field *field; /* of curved layers */
    double *level;    /* [level_count] of it */
    int32_t level_count;
    iso_curves curves;
    iso_region *raw;    /* [levels] rounded, not yet clean */
    iso_region *inside; /* [levels] for the middles of the fill's lines */
    iso_paths *ordered; /* [levels] */
    iso_region out;     /* of the kernel, level after level */
    iso_paths paths;
    int64_t bytes; /* that a round read and wrote */
    iso_gcode_totals totals;
    bool solid; /* fill */
} bench_stages;

static int32_t points_of(const iso_region *region) {
    return region->count ? region->first[region->count] : 0;
}

static int64_t bytes_of(const iso_region *region) {
    return points_of(region) * (int64_t)sizeof(iso_point) + region->count * 8;
}

static int64_t bytes_of_paths(const iso_paths *paths) {
    return paths->count * (int64_t)sizeof(iso_path) +
           paths->vertex_count * (int64_t)sizeof(iso_path_vertex);
}

static void add_row(bench_stages *s, bench_row row) {
    s->table->row[s->table->count++] = row;
}

/* ---- mesh and slices ---- */

static void read_mesh(void *payload) {
    bench_stages *s = payload;
    bench_must(iso_mesh_read(&s->mesh, s->part.path), s->part.path);
}

static void weld_mesh(void *payload) {
    bench_stages *s = payload;
    bench_must(iso_mesh_from_triangles(&s->mesh, s->triangle, s->triangle_count), s->part.path);
}

static void free_mesh(void *payload) {
    iso_mesh_free(&((bench_stages *)payload)->mesh);
}

static void slice_mesh(void *payload) {
    bench_stages *s = payload;
    bench_must(iso_slice_planar(&s->slices, &s->part.mesh, &s->part.levels), s->part.path);
}

static void free_slices(void *payload) {
    iso_slices_free(&((bench_stages *)payload)->slices);
}

/* Triangles of the mended mesh, in the file's order but for the mending. */
static void soup_of(bench_stages *s) {
    const iso_mesh *mesh = &s->part.mesh;
    s->triangle_count = mesh->triangle_count;
    s->triangle = bench_allocate(9 * s->triangle_count * (int64_t)sizeof *s->triangle);
    for (int64_t a = 0; a < 3 * s->triangle_count; a++) {
        iso_vec3 p = mesh->position[mesh->origin[a]];
        s->triangle[3 * a] = (float)p.x;
        s->triangle[3 * a + 1] = (float)p.y;
        s->triangle[3 * a + 2] = (float)p.z;
    }
}

static void measure_mesh(bench_stages *s) {
    const iso_mesh *mesh = &s->part.mesh;
    struct stat about;
    bench_must_system(stat(s->part.path, &about) == 0, s->part.path);
    bench_rate triangles = {1e-6 * mesh->triangle_count, "M triangles/s"};
    int64_t bytes = 24 * mesh->triangle_count + (int64_t)sizeof(iso_vec3) * mesh->vertex_count;
    add_row(s, (bench_row){"read, weld and link",
                           bench_least(read_mesh, free_mesh, s),
                           {{1e-6 * (double)about.st_size, "MB/s"}, triangles},
                           "read",
                           floor_read(s->part.path)});
    soup_of(s);
    add_row(s, (bench_row){"weld and link",
                           bench_least(weld_mesh, free_mesh, s),
                           {triangles},
                           "copy",
                           floor_copy(36 * s->triangle_count + bytes)});
    free(s->triangle);
}

static void measure_slices(bench_stages *s) {
    const iso_mesh *mesh = &s->part.mesh;
    double seconds = bench_least(slice_mesh, free_slices, s);
    double count = (double)s->part.slices.crossing_count;
    int64_t bytes = 24 * mesh->triangle_count + (int64_t)sizeof(iso_vec3) * mesh->vertex_count +
                    (int64_t)sizeof(iso_vec2) * s->part.slices.crossing_count;
    bench_rate crossings = {1e-6 * count, "M crossings/s"};
    add_row(s, (bench_row){"slice",
                           seconds,
                           {crossings},
                           "arithmetic",
                           floor_slice(mesh, &s->part.levels, &s->part.slices)});
    add_row(s, (bench_row){"slice", seconds, {crossings}, "copy", floor_copy(bytes)});
}

static void slice_field(void *payload) {
    bench_stages *s = payload;
    bench_must(iso_slice_field(&s->curves, &s->part.mesh, s->field, s->level, s->level_count, NULL),
               s->part.path);
}

static void free_curves(void *payload) {
    iso_curves_free(&((bench_stages *)payload)->curves);
}

/* Cones as far apart as the flat layers are, and flat ones the way of fields. */
static void measure_field(bench_stages *s, const char *text, const char *name) {
    const iso_mesh *mesh = &s->part.mesh;
    double range[2];
    bench_must(iso_field_new(&s->field, text), text);
    bench_must(field_range(range, s->field, mesh, 1), s->part.path);
    double height = s->part.levels.height[s->part.levels.count - 1];
    s->level_count = (int32_t)((range[1] - range[0]) / height);
    s->level = bench_allocate(s->level_count * (int64_t)sizeof *s->level);
    for (int32_t i = 0; i < s->level_count; i++)
        s->level[i] = range[0] + height * (i + 0.5);
    slice_field(s);
    double crossings = (double)s->curves.crossing_count;
    free_curves(s);
    int64_t bytes = 24 * mesh->triangle_count + (int64_t)sizeof(iso_vec3) * mesh->vertex_count +
                    (int64_t)sizeof(iso_vec3) * (int64_t)crossings;
    add_row(s, (bench_row){name,
                           bench_least(slice_field, free_curves, s),
                           {{1e-6 * crossings, "M crossings/s"},
                            {1e-6 * mesh->triangle_count, "M triangles/s"}},
                           "copy",
                           floor_copy(bytes)});
    free(s->level);
    iso_field_free(s->field);
}

/* ---- the kernel ---- */

static void count_bytes(bench_stages *s, const iso_region *in) {
    s->bytes += bytes_of(in) + bytes_of(&s->out);
}

static void clean_all(void *payload) {
    bench_stages *s = payload;
    s->bytes = 0;
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        bench_must(iso_region_clean(&s->out, &s->raw[i], ISO_FILL_NONZERO, s->part.hand.planar),
                   "clean");
        count_bytes(s, &s->raw[i]);
    }
}

static void simplify_all(void *payload) {
    bench_stages *s = payload;
    s->bytes = 0;
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        bench_must(iso_region_simplify(&s->out, &s->raw[i],
                                       s->part.window.layer[i].settings.thinning,
                                       s->part.hand.planar),
                   "simplify");
        count_bytes(s, &s->raw[i]);
    }
}

/* Round joins, and by as much as the outermost wall is inset. */
static void offset_all(bench_stages *s, int sign) {
    s->bytes = 0;
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        const iso_wall_options *wall = &s->part.window.layer[i].settings.wall;
        iso_offset_options offset = iso_offset_defaults(sign * wall->external.width / 2);
        offset.join = ISO_JOIN_ROUND;
        offset.arc_tolerance = wall->arc_tolerance;
        const iso_region *in = &s->part.window.layer[i].region;
        bench_must(iso_offset(&s->out, in, &offset, s->part.hand.planar), "offset");
        count_bytes(s, in);
    }
}

static void offset_in(void *payload) {
    offset_all(payload, -1);
}

static void offset_out(void *payload) {
    offset_all(payload, 1);
}

/* Runs of layers, then every layer's split. */
static void split_all(void *payload) {
    bench_stages *s = payload;
    const iso_window *window = &s->part.window;
    iso_planar_scratch *planar = s->part.hand.planar;
    int32_t count = s->part.levels.count;
    s->bytes = 0;
    for (int32_t level = 1; level < window->levels; level++)
        for (int32_t i = 0; i < window_wide_end(level, count); i++)
            bench_must(window_widen(window, i, level, planar), "shells");
    for (int32_t i = 0; i < count; i++) {
        iso_layer *layer = &window->layer[i];
        iso_shell *shell = &layer->shell;
        iso_shell_neighbours around = window_around(window, i);
        bench_must(iso_shell_split(shell, &layer->area, &around, &layer->settings.shell, planar),
                   "shells");
        s->bytes += bytes_of(&layer->area) + bytes_of(&shell->top) + bytes_of(&shell->solid) +
                    bytes_of(&shell->sparse);
        for (int32_t k = 0; k < window->levels; k++)
            s->bytes += bytes_of(&layer->run[k]);
    }
}

static void measure_kernel(bench_stages *s, const char *name, void (*run)(void *), int64_t points) {
    double seconds = bench_least(run, NULL, s);
    add_row(s, (bench_row){name,
                           seconds,
                           {{1e-6 * (double)points, "M vertices/s"}},
                           "copy",
                           floor_copy(s->bytes)});
}

static void measure_regions(bench_stages *s) {
    int64_t raw = 0, thinned = 0, split = 0;
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        const iso_layer *layer = &s->part.window.layer[i];
        bench_must(section_add(&s->raw[i], &s->part.slices, i), s->part.path);
        raw += points_of(&s->raw[i]);
        thinned += points_of(&layer->region);
        split += points_of(&layer->area) + points_of(&layer->run[0]);
    }
    measure_kernel(s, "clean", clean_all, raw);
    measure_kernel(s, "simplify", simplify_all, raw);
    measure_kernel(s, "offset in", offset_in, thinned);
    measure_kernel(s, "offset out", offset_out, thinned);
    measure_kernel(s, "shells", split_all, split);
}

/* ---- fill ---- */

static const iso_fill_options *fill_options(const bench_stages *s, int32_t i) {
    const iso_layer_settings *settings = &s->part.window.layer[i].settings;
    return s->solid ? &settings->solid : &settings->sparse;
}

static void fill_all(void *payload) {
    bench_stages *s = payload;
    s->bytes = 0;
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        iso_paths_clear(&s->paths);
        bench_must(
            iso_fill_rectilinear(&s->paths, &s->inside[i], fill_options(s, i), &s->part.hand.arena),
            "fill");
        s->bytes += bytes_of(&s->inside[i]) + bytes_of_paths(&s->paths);
    }
}

/* Crossings of the lines with the boundary: twice the pieces of line that are drawn. */
static int64_t count_fill_crossings(bench_stages *s) {
    int64_t count = 0;
    iso_hand *hand = &s->part.hand;
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        iso_arena_mark mark = iso_arena_get_mark(&hand->arena);
        iso_islands parts;
        bench_must(islands_of(&parts, &s->inside[i], &hand->arena), "fill");
        for (int32_t k = 0; k < parts.count; k++) {
            iso_filling_link link;
            bench_must(island_copy(&hand->part, &s->inside[i], &parts, k), "fill");
            bench_must(iso_fill_to_link(&link, &hand->part, fill_options(s, i), &hand->arena),
                       "fill");
            count += link.link.size / 2;
            iso_multilink_free(&link.link);
        }
        iso_arena_pop(&hand->arena, mark);
    }
    return count;
}

static void measure_fill(bench_stages *s) {
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        const iso_layer *layer = &s->part.window.layer[i];
        iso_offset_options inset = iso_offset_defaults(-layer->settings.fill_inset);
        inset.join = ISO_JOIN_ROUND;
        bench_must(iso_offset(&s->inside[i], &layer->area, &inset, s->part.hand.planar), "inset");
    }
    for (int solid = 0; solid < 2; solid++) {
        s->solid = solid;
        bench_rate crossings = {1e-6 * (double)count_fill_crossings(s), "M crossings/s"};
        double seconds = bench_least(fill_all, NULL, s);
        add_row(s, (bench_row){solid ? "fill, solid" : "fill, 15 %",
                               seconds,
                               {crossings},
                               "copy",
                               floor_copy(s->bytes)});
    }
}

/* ---- order and G-code ---- */

static void order_all(void *payload) {
    bench_stages *s = payload;
    iso_order_state state = {0};
    iso_order_options order = settings_of_order(s->part.options);
    s->bytes = 0;
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        bench_must(iso_order_layer(&s->ordered[i], &s->part.window.layer[i].paths, &state, &order,
                                   &s->part.hand.arena),
                   "order");
        s->bytes += 2 * bytes_of_paths(&s->ordered[i]);
    }
    iso_order_state_free(&state);
}

static void write_all(void *payload) {
    bench_stages *s = payload;
    iso_gcode_options options = settings_of_gcode(s->part.options, NULL, 0);
    iso_output *output;
    iso_gcode_writer *writer;
    bench_must(iso_output_open(&output, s->scratch_path), s->scratch_path);
    bench_must(iso_gcode_writer_new(&writer, output, &options), s->scratch_path);
    bench_must(iso_gcode_begin(writer), s->scratch_path);
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        iso_gcode_layer_info info = {.index = i,
                                     .z = iso_units(s->part.levels.top[i]),
                                     .height = iso_units(s->part.levels.height[i]),
                                     .paths = &s->ordered[i]};
        bench_must(iso_gcode_layer(writer, &info), s->scratch_path);
    }
    bench_must(iso_gcode_finish(&s->totals, writer, NULL, NULL), s->scratch_path);
    s->bytes = iso_output_size(output);
    iso_gcode_writer_free(writer);
    iso_output_abandon(output); /* so nothing is synced */
}

static void measure_writing(bench_stages *s) {
    int64_t paths = 0;
    for (int32_t i = 0; i < s->part.levels.count; i++) {
        part_fill(&s->part, i);
        paths += s->part.window.layer[i].paths.count;
    }
    double seconds = bench_least(order_all, NULL, s);
    add_row(
        s,
        (bench_row){
            "order", seconds, {{1e-6 * (double)paths, "M paths/s"}}, "copy", floor_copy(s->bytes)});
    seconds = bench_least(write_all, NULL, s);
    add_row(s, (bench_row){"G-code",
                           seconds,
                           {{1e-6 * (double)s->bytes, "MB/s"},
                            {1e-6 * (double)s->totals.moves, "M moves/s"}},
                           "write",
                           floor_write(s->scratch_path, s->bytes)});
}

void stages_measure(bench_table *table, const char *path, const iso_options *options,
                    const char *scratch_path) {
    bench_stages s = {.scratch_path = scratch_path, .table = table};
    part_load(&s.part, path, options);
    int32_t count = s.part.levels.count;
    s.raw = bench_allocate(count * (int64_t)sizeof *s.raw);
    s.inside = bench_allocate(count * (int64_t)sizeof *s.inside);
    s.ordered = bench_allocate(count * (int64_t)sizeof *s.ordered);
    memset(s.raw, 0, (size_t)count * sizeof *s.raw);
    memset(s.inside, 0, (size_t)count * sizeof *s.inside);
    memset(s.ordered, 0, (size_t)count * sizeof *s.ordered);
    measure_mesh(&s);
    measure_slices(&s);
    measure_field(&s, "z", "slice by field z");
    measure_field(&s, "cone:20", "slice by a cone");
    measure_regions(&s);
    measure_fill(&s);
    measure_writing(&s);
    for (int32_t i = 0; i < count; i++) {
        iso_region_free(&s.raw[i]);
        iso_region_free(&s.inside[i]);
        iso_paths_free(&s.ordered[i]);
    }
    free(s.raw);
    free(s.inside);
    free(s.ordered);
    iso_region_free(&s.out);
    iso_paths_free(&s.paths);
    part_free(&s.part);
}
