/* Prints whose layers aren't flat: made, read back, and watched move by move. */
#ifndef TESTS_GCODE_SPACE_PRINT_H
#define TESTS_GCODE_SPACE_PRINT_H

#include "small.h"

#include <stdbool.h>

#include "base/vector.h"
#include "pose/pose.h"

static const double pi = 3.14159265358979323846;

/* ---- layers ---- */

/* A path through places in mm; `z` of vertices counts from the layer's top. */
static inline void add_path(iso_paths *paths, const iso_path *like, const iso_vec3 *place,
                            const iso_vec3 *normal, int count, double top) {
    iso_point *at = calloc((size_t)count, sizeof *at);
    int32_t first = paths->vertex_count;
    for (int i = 0; i < count; i++)
        at[i] = (iso_point){iso_units(place[i].x), iso_units(place[i].y)};
    iso_bead bead = iso_bead_of(4500, 2000);
    CHECK_OK(iso_paths_add(paths, like, at, count, bead.width, bead.area));
    CHECK_OK(ISO_GROW(paths->frame, paths->frame_capacity, paths->vertex_count));
    for (int i = 0; i < count; i++) {
        paths->vertex[first + i].z = iso_units(place[i].z - top);
        paths->frame[first + i] = (iso_frame){.normal = normal[i], .height = 2000};
    }
    free(at);
}

/* The way to the path added last. */
static inline void add_travel(iso_paths *paths, const iso_vec3 *place, const iso_vec3 *normal,
                              int count, double top) {
    iso_path *path = &paths->path[paths->count - 1];
    int32_t first = paths->travel_count;
    CHECK_OK(ISO_GROW(paths->travel, paths->travel_capacity, first + count));
    CHECK_OK(ISO_GROW(paths->travel_frame, paths->travel_frame_capacity, first + count));
    for (int i = 0; i < count; i++) {
        paths->travel[first + i] = (iso_point){iso_units(place[i].x), iso_units(place[i].y)};
        paths->travel_frame[first + i] =
            (iso_frame){.normal = normal[i], .z = iso_units(place[i].z - top)};
    }
    paths->travel_count += count;
    path->travel_first = first;
    path->travel_count = count;
}

static inline iso_paths two_lines(bool with_travel) {
    iso_paths layer = {0};
    iso_vec3 up[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    iso_vec3 low[2] = {{10, 10, 1}, {20, 10, 7}}, high[2] = {{20, 30, 3}, {10, 30, 3}};
    iso_vec3 way[3] = {{20, 10, 8}, {20, 20, 9}, {20, 30, 4}};
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, low, up, 2, 0.2);
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, high, up, 2, 0.2);
    if (with_travel)
        add_travel(&layer, way, up, 3, 0.2);
    return layer;
}

/* ---- the file read back, knowing nothing of the writer ---- */

typedef struct line_move {
    double from[5], to[5]; /* X Y Z, tilt, turn */
    double e, f, height;
    bool inverse;
} line_move;

enum { MOVES_MOST = 20000 };

typedef struct moves {
    line_move move[MOVES_MOST];
    int count, heights, widths, modes; /* comments and G93, G94 */
    double drawn, seconds;
} moves;

static inline double counted(const line_move *m, int from, int to) {
    double sum = 0;
    for (int i = from; i < to; i++)
        sum += (m->to[i] - m->from[i]) * (m->to[i] - m->from[i]);
    return sqrt(sum);
}

/* s that F asks for: over minutes, else of X, Y, Z, or degrees if none of them moves. */
static inline double seconds_of(const line_move *m) {
    double mm = counted(m, 0, 3);
    return m->inverse ? 60 / m->f : 60 * (mm > 0 ? mm : counted(m, 3, 5)) / m->f;
}

static inline void read_moves(moves *r, const char *text, const char *letters) {
    double at[5] = {0}, f = 0, height = 0;
    bool inverse = false;
    memset(r, 0, sizeof *r);
    for (const char *line = text, *end; *line; line = end + 1) {
        end = strchr(line, '\n');
        if (!strncmp(line, "G93", 3) || !strncmp(line, "G94", 3)) {
            CHECK(inverse != (line[2] == '3')); /* said only to change it */
            inverse = line[2] == '3';
            r->modes++;
            f = 0;
        }
        r->widths += !strncmp(line, ";WIDTH:", 7);
        r->heights += !strncmp(line, ";HEIGHT:", 8);
        if (!strncmp(line, ";HEIGHT:", 8))
            height = strtod(line + 8, NULL);
        if (strncmp(line, "G1 ", 3) != 0)
            continue;
        line_move *m = &r->move[r->count];
        memcpy(m->from, at, sizeof at);
        for (int i = 0; i < 5; i++)
            at[i] = reading_word(line, end, letters[i], at[i]);
        memcpy(m->to, at, sizeof at);
        m->e = reading_word(line, end, 'E', 0);
        double said = reading_word(line, end, 'F', 0);
        CHECK(!inverse || said > 0); /* in G93 each has its own */
        f = m->f = said > 0 ? said : f;
        CHECK(f > 0);
        m->inverse = inverse;
        m->height = height;
        if (counted(m, 0, 5) == 0)
            continue;
        r->drawn += m->e > 0 ? m->e : 0;
        r->seconds += r->count > 0 ? seconds_of(m) : 0;
        CHECK(++r->count < MOVES_MOST);
    }
    CHECK(!inverse); /* the end text finds F as it knows it */
}

static inline iso_vec3 tip_of(const double at[5], const pose_machine *machine) {
    iso_pose pose = {.at = {at[0], at[1], at[2]}, .angle = {at[3], at[4]}};
    iso_vec3 tip, normal;
    pose_place(&tip, &normal, &pose, machine);
    return tip;
}

/* ---- printing ---- */

/* Layers at 0.2, 0.4, ...; with the machine's poses. */
static inline iso_status write_layers(iso_gcode_totals *totals, const iso_gcode_options *o,
                                      const iso_paths *layer, int layers) {
    iso_output *output;
    iso_gcode_writer *writer = NULL;
    static iso_pose pose[4096], travel[256];
    iso_pose last = {0};
    ISO_TRY(iso_output_open(&output, SMALL_FILE));
    iso_status status = iso_gcode_writer_new(&writer, output, o);
    if (status == ISO_OK)
        status = iso_gcode_begin(writer);
    for (int i = 0; i < layers && status == ISO_OK; i++) {
        int32_t z = 2000 * (i + 1);
        if (o->machine)
            status = pose_paths(pose, travel, &last, &layer[i], z, o->machine);
        if (status == ISO_OK)
            status = iso_gcode_layer(
                writer, &(iso_gcode_layer_info){.index = i,
                                                .z = z + iso_units(o->z_offset),
                                                .height = 2000,
                                                .paths = &layer[i],
                                                .pose = o->machine ? pose : NULL,
                                                .travel_pose = o->machine ? travel : NULL});
    }
    if (status == ISO_OK)
        status = iso_gcode_finish(totals, writer, NULL, NULL);
    iso_gcode_writer_free(writer);
    if (status != ISO_OK) {
        iso_output_abandon(output);
        return status;
    }
    return iso_output_commit(output);
}

static moves read_back;

static inline char *print_layers(iso_gcode_totals *totals, const iso_gcode_options *o,
                                 const iso_paths *layer, int layers, const char *letters) {
    CHECK_OK(write_layers(totals, o, layer, layers));
    reading r = reading_of(SMALL_FILE);
    unlink(SMALL_FILE);
    read_moves(&read_back, r.text, letters);
    return r.text;
}

static inline iso_gcode_options bare(void) {
    iso_gcode_options o = plain();
    o.retract_length = 0;
    return o;
}

/* ---- the watch ---- */

typedef struct watched {
    iso_gcode_move move[MOVES_MOST];
    int count, fail_at;
} watched;

static inline iso_status watch(void *payload, const iso_gcode_move *move) {
    watched *w = payload;
    if (w->count == w->fail_at)
        return iso_fail(ISO_OUTSIDE, "move %d hits", w->count);
    w->move[w->count++] = *move;
    return ISO_OK;
}

static watched seen;

/* Everything in the file from the first known place on, whatever the layer; each begins where the
 * one before ended. */
static inline void check_watched(const pose_machine *machine, double z_offset) {
    int k = 0;
    for (int i = 3; i < read_back.count; i++) { /* the first way is up, across, down */
        const line_move *m = &read_back.move[i];
        double to[5], done = 0;
        memcpy(to, m->to, sizeof to);
        to[2] -= z_offset;
        iso_vec3 end = tip_of(to, machine);
        if (i == 3)
            k = 1;
        do {
            const iso_gcode_move *s = &seen.move[k];
            CHECK(k < seen.count && vec3_distance(s->from, s[-1].to) < 1e-9);
            CHECK((s->width > 0) == (m->e > 0));
            done = vec3_distance(s->to, end);
        } while (++k < seen.count && done > 1e-6 && machine);
        if (!CHECK(done <= 1e-6))
            return;
    }
    CHECK_EQUAL(seen.count, k);
}

/* One layer on a machine that turns the part, by way of the watch. */
static inline void print_watched(const pose_machine *machine, const iso_paths *layer,
                                 const char *letters) {
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = machine;
    o.watch = watch;
    o.watch_payload = &seen;
    seen = (watched){.fail_at = -1};
    free(print_layers(&totals, &o, layer, 1, letters));
}

#endif
