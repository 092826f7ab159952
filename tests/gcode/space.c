/* Layers that aren't flat, and machines that turn the part. */
#define SMALL_FILE "test-gcode-space.gcode"
#include "small.h"

#include <stdbool.h>

#include "base/vector.h"
#include "pose/pose.h"

static const double pi = 3.14159265358979323846;

/* ---- layers ---- */

/* A path through places in mm; `z` of vertices counts from the layer's top. */
static void add_path(iso_paths *paths, const iso_path *like, const iso_vec3 *place,
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
static void add_travel(iso_paths *paths, const iso_vec3 *place, const iso_vec3 *normal, int count,
                       double top) {
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

static double counted(const line_move *m, int from, int to) {
    double sum = 0;
    for (int i = from; i < to; i++)
        sum += (m->to[i] - m->from[i]) * (m->to[i] - m->from[i]);
    return sqrt(sum);
}

/* s that F asks for: over minutes, else of X, Y, Z, or degrees if none of them moves. */
static double seconds_of(const line_move *m) {
    double mm = counted(m, 0, 3);
    return m->inverse ? 60 / m->f : 60 * (mm > 0 ? mm : counted(m, 3, 5)) / m->f;
}

static void read_moves(moves *r, const char *text, const char *letters) {
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

static iso_vec3 tip_of(const double at[5], const pose_machine *machine) {
    iso_pose pose = {.at = {at[0], at[1], at[2]}, .angle = {at[3], at[4]}};
    iso_vec3 tip, normal;
    pose_place(&tip, &normal, &pose, machine);
    return tip;
}

/* ---- printing ---- */

/* Layers at 0.2, 0.4, ...; with the machine's poses. */
static iso_status write_layers(iso_gcode_totals *totals, const iso_gcode_options *o,
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

static char *print_layers(iso_gcode_totals *totals, const iso_gcode_options *o,
                          const iso_paths *layer, int layers, const char *letters) {
    CHECK_OK(write_layers(totals, o, layer, layers));
    reading r = reading_of(SMALL_FILE);
    unlink(SMALL_FILE);
    read_moves(&read_back, r.text, letters);
    return r.text;
}

static iso_gcode_options bare(void) {
    iso_gcode_options o = plain();
    o.retract_length = 0;
    return o;
}

/* ---- three axes ---- */

/* Three turns of a helix of radius 15 mm that rises by 12 mm: E is the bead's area by the length in
 * space, F the speed of the role, and each Z is the curve's. */
static void test_helix(void) {
    enum { COUNT = 721 };
    static iso_vec3 place[COUNT], normal[COUNT];
    double slope = 12 / (6 * pi * 15);
    for (int i = 0; i < COUNT; i++) {
        double t = 6 * pi * i / (COUNT - 1);
        place[i] = vec3(50 + 15 * cos(t), 50 + 15 * sin(t), 1 + 12 * t / (6 * pi));
        normal[i] = vec3(0, 0, 1);
    }
    iso_paths layer = {0};
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, COUNT, 0.2);
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    double mm = 6 * pi * 15 * sqrt(1 + slope * slope);
    double area = iso_bead_of(4500, 2000).area * 1e-8, section = pi / 4 * 1.75 * 1.75;
    CHECK_NEAR(mm * area / section, read_back.drawn, 1e-4 * mm * area / section);
    CHECK_NEAR(mm, totals.bead_mm, 1e-4 * mm);
    int beads = 0;
    for (int i = 0; i < read_back.count; i++) {
        const line_move *m = &read_back.move[i];
        if (m->e <= 0)
            continue;
        beads++;
        CHECK_NEAR(60 * 60, m->f, 0);
        CHECK_NEAR(place[beads].z, m->to[2], 0.00056);
        CHECK_NEAR(place[beads].x, m->to[0], 0.00056);
    }
    CHECK_EQUAL(COUNT - 1, beads);
    iso_paths_free(&layer);
}

/* A bead whose section is larger than the flow allows slows down by its own section. */
static void test_flow_is_limited_by_the_section_in_space(void) {
    iso_vec3 place[3] = {{10, 10, 1}, {13, 10, 5}, {16, 10, 5}};
    iso_vec3 normal[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    iso_paths layer = {0};
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, 3, 0.2);
    layer.vertex[0].area = 12000000; /* 0.12 mm^2 */
    iso_gcode_options o = bare();
    o.max_volumetric_speed = 5;
    iso_gcode_totals totals;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    const line_move *m = &read_back.move[read_back.count - 2];
    CHECK_NEAR(floor(5 / 0.12 * 60), m->f, 0);
    CHECK_NEAR(5 * 0.12 / (pi / 4 * 1.75 * 1.75), m->e, 1e-5); /* 5 mm in space */
    CHECK_NEAR(3600, m[1].f, 0);
    iso_paths_free(&layer);
}

/* Heights from 0.1 to 0.3 mm in 400 steps are said when they are 5 % off: about ln 3 / ln 1.05. */
static void test_heights_are_said_in_steps(void) {
    enum { COUNT = 401 };
    static iso_vec3 place[COUNT], normal[COUNT];
    for (int i = 0; i < COUNT; i++) {
        place[i] = vec3(10 + 0.25 * i, 10, 1 + 0.01 * i);
        normal[i] = vec3(0, 0, 1);
    }
    iso_paths layer = {0};
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, COUNT, 0.2);
    for (int i = 0; i < COUNT; i++)
        layer.frame[i].height = 1000 + 5 * i;
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    CHECK(read_back.heights >= 18 && read_back.heights <= 26);
    CHECK_EQUAL(1, read_back.widths);
    int bead = 0;
    for (int i = 0; i < read_back.count; i++) {
        const line_move *m = &read_back.move[i];
        double height = (1000 + 5 * bead) / 1e4;
        if (m->e > 0 && ++bead)
            CHECK(fabs(m->height - height) <= 0.0501 * m->height);
    }
    iso_paths_free(&layer);
}

static iso_paths two_lines(bool with_travel) {
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

/* Every byte of what moves: the first path is reached from nowhere, the second along its points,
 * with no lift but theirs. */
static void test_travel_follows_its_points(void) {
    iso_paths layer = two_lines(true);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.retract_lift = 0.4;
    o.wipe = 1;
    char *text = print_layers(&totals, &o, &layer, 1, "XYZAB");
    if (!CHECK(strstr(text, "G1 E-2 F2400\n"
                            "G1 Z1.4 F7800\n"
                            "G1 X10 Y10\n"
                            "G1 Z1\n"
                            "G1 E2 F2400\n"
                            ";TYPE:Perimeter\n"
                            ";WIDTH:0.45\n"
                            "G1 X20 Y10 Z7 E.39474 F3600\n"
                            "G1 E-2 F2400\n"
                            "G1 Z8 F7800\n"
                            "G1 X20 Y20 Z9\n"
                            "G1 X20 Y30 Z4\n"
                            "G1 Z3\n"
                            "G1 E2 F2400\n"
                            "G1 X10 Y30 E.33849 F3600\n"
                            "G1 E-2 F2400\n")))
        fputs(text, stderr);
    CHECK_NEAR(0.4 + 1 + sqrt(101) + sqrt(125) + 1, totals.travel_mm + 0, 1e-6);
    free(text);
    iso_paths_free(&layer);
}

/* Up by 1 mm, along by 1.5 mm and down again is no more than 2 mm along the layer. */
static void test_short_ways_dont_retract(void) {
    iso_vec3 up[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    iso_vec3 low[2] = {{10, 10, 1}, {20, 10, 7}}, high[2] = {{20, 11.5, 7}, {10, 11.5, 3}};
    iso_vec3 way[2] = {{20, 10, 8}, {20, 11.5, 8}};
    iso_paths layer = {0};
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, low, up, 2, 0.2);
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, high, up, 2, 0.2);
    add_travel(&layer, way, up, 2, 0.2);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    CHECK_EQUAL(2, totals.retractions); /* of the beginning and the end */
    o.retract_before_travel = 1.4;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    CHECK_EQUAL(3, totals.retractions);
    iso_paths_free(&layer);
}

/* Nobody knows a way: over all that is printed (7 mm), and straight down. */
static void test_unknown_ways_go_over_all(void) {
    iso_paths layer = two_lines(false);
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    char *text = print_layers(&totals, &o, &layer, 1, "XYZAB");
    CHECK(strstr(text, "G1 Z8 F7800\nG1 X20 Y30\nG1 Z3\n"));
    free(text);
    iso_paths_free(&layer);
}

/* A flat layer after one that isn't is reached over all of it; then flat travels are flat. */
static void test_flat_layers_after_curved_ones(void) {
    iso_paths layer[2] = {two_lines(true), {0}};
    add_square(&layer[1], 100000, 100000, 100000, ISO_ROLE_PERIMETER, 4500);
    add_square(&layer[1], 300000, 100000, 100000, ISO_ROLE_PERIMETER, 4500);
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    char *text = print_layers(&totals, &o, layer, 2, "XYZAB");
    CHECK(strstr(text, "G1 Z8 F7800\nG1 X10 Y10\nG1 Z.4\n"));
    CHECK(strstr(text, "G1 X30 Y10 F7800\n;") || strstr(text, "G1 X30 Y10 F7800\nG1 X40"));
    free(text);
    iso_paths_free(&layer[0]);
    iso_paths_free(&layer[1]);
}

/* ---- the watch ---- */

typedef struct watched {
    iso_gcode_move move[MOVES_MOST];
    int count, fail_at;
} watched;

static iso_status watch(void *payload, const iso_gcode_move *move) {
    watched *w = payload;
    if (w->count == w->fail_at)
        return iso_fail(ISO_OUTSIDE, "move %d hits", w->count);
    w->move[w->count++] = *move;
    return ISO_OK;
}

static watched seen;

/* Everything in the file from the first known place on, whatever the layer; each begins where the
 * one before ended. */
static void check_watched(const pose_machine *machine, double z_offset) {
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

static void test_watch_sees_the_file(void) {
    iso_paths layer[3] = {two_lines(true), {0}, two_lines(false)};
    add_square(&layer[1], 100000, 100000, 100000, ISO_ROLE_PERIMETER, 4500);
    add_square(&layer[1], 300000, 100000, 100000, ISO_ROLE_PERIMETER, 4500);
    layer[0].frame[0].normal = vec3(-0.6, 0, 0.8);
    layer[0].frame[0].height = 1500;
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.watch = watch;
    o.watch_payload = &seen;
    o.wipe = 1;
    o.retract_lift = 0.4;
    o.z_offset = 0.125;
    seen = (watched){.fail_at = -1};
    free(print_layers(&totals, &o, layer, 3, "XYZAB"));
    check_watched(NULL, o.z_offset);
    CHECK(vec3_distance(seen.move[1].from, vec3(10, 10, 1)) < 1e-9);
    CHECK(vec3_distance(seen.move[1].to, vec3(20, 10, 7)) < 1e-9);
    CHECK_NEAR(0.45, seen.move[1].width, 1e-9);
    CHECK_NEAR(0.15, seen.move[1].height, 1e-9);
    CHECK_NEAR(-0.6, seen.move[1].from_normal.x, 1e-12);
    CHECK_NEAR(0, seen.move[1].to_normal.x, 1e-12);
    CHECK_NEAR(0, seen.move[2].width, 0);
    int all = seen.count;
    for (int i = 0; i < all; i++) {
        seen = (watched){.fail_at = i};
        CHECK_STATUS(ISO_OUTSIDE, write_layers(&totals, &o, layer, 3));
        CHECK_EQUAL(i, seen.count);
        CHECK(access(SMALL_FILE, F_OK) != 0);
    }
    for (int i = 0; i < 3; i++)
        iso_paths_free(&layer[i]);
}

/* Arcs of a flat layer are told chord by chord. */
static void test_watch_sees_arcs(void) {
    enum { COUNT = 60 };
    iso_point at[COUNT];
    for (int i = 0; i < COUNT; i++)
        at[i] = (iso_point){iso_units(50 + 9 * cos(2 * pi * i / COUNT)),
                            iso_units(50 + 9 * sin(2 * pi * i / COUNT))};
    iso_paths layer = {0};
    iso_bead bead = iso_bead_of(4500, 2000);
    CHECK_OK(iso_paths_add(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER, .closed = 1}, at, COUNT,
                           bead.width, bead.area));
    iso_arena arena = {0};
    iso_arc *arc;
    iso_arc_options arcs = iso_arc_defaults();
    iso_gcode_layer_info info = {.z = 2000, .height = 2000, .paths = &layer};
    arcs.tolerance = 1000;
    CHECK_OK(iso_paths_find_arcs(&arc, &info.arc_count, &layer, &arcs, &arena));
    CHECK(info.arc_count > 0);
    info.arc = arc;
    iso_gcode_options o = bare();
    o.watch = watch;
    o.watch_payload = &seen;
    seen = (watched){.fail_at = -1};
    iso_output *output;
    iso_gcode_writer *writer;
    CHECK_OK(iso_output_open(&output, SMALL_FILE));
    CHECK_OK(iso_gcode_writer_new(&writer, output, &o));
    CHECK_OK(iso_gcode_begin(writer));
    CHECK_OK(iso_gcode_layer(writer, &info));
    iso_gcode_writer_free(writer);
    iso_output_abandon(output);
    CHECK_EQUAL(COUNT, seen.count);
    for (int i = 0; i < seen.count; i++) {
        int next = (i + 1) % COUNT;
        iso_vec3 to = {iso_mm(at[next].x), iso_mm(at[next].y), 0.2};
        CHECK(vec3_distance(seen.move[i].to, to) < 0.001);
        CHECK_NEAR(0.45, seen.move[i].width, 1e-12);
        CHECK_NEAR(0.2, seen.move[i].height, 1e-12);
    }
    iso_arena_free(&arena);
    iso_paths_free(&layer);
}

/* ---- machines that turn the part ---- */

static pose_machine mandrel(void) {
    return (pose_machine){.kinematics = ISO_KINEMATICS_ROTARY_A,
                          .pivot = {0, 100, 30},
                          .low = {-90, -360000},
                          .high = {90, 360000},
                          .fastest = {60, 180}};
}

static pose_machine table(iso_kinematics kinematics) {
    return (pose_machine){.kinematics = kinematics,
                          .pivot = {100, 100, 0},
                          .low = {-90, -360000},
                          .high = {90, 360000},
                          .fastest = {60, 180}};
}

/* `turns` around the mandrel at a radius, x from 20 mm on. */
static void add_coil(iso_paths *paths, const pose_machine *machine, double radius, double turns,
                     double pitch, int count) {
    static iso_vec3 place[2048], normal[2048];
    for (int i = 0; i < count; i++) {
        double t = 2 * pi * turns * i / (count - 1);
        normal[i] = vec3(0, sin(t), cos(t));
        place[i] = vec3_along(machine->pivot, radius, normal[i]);
        place[i].x = 20 + pitch * t / (2 * pi);
    }
    add_path(paths, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, count, 0.2);
}

/* A ring in 72 chords at a radius of 12 mm and 30 mm/s: each takes 24 sin(2.5 deg) / 30 s, and F
 * is one over its minutes. Filament moves by G94. */
static void test_inverse_time(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    add_coil(&layer, &machine, 12, 1, 0, 73);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.rotary_feed = ISO_FEED_INVERSE_TIME;
    o.flavour = ISO_FLAVOUR_REPRAPFIRMWARE;
    o.speed[ISO_ROLE_PERIMETER] = o.first_layer_speed[ISO_ROLE_PERIMETER] = 30;
    char *text = print_layers(&totals, &o, &layer, 1, "XYZQA");
    double seconds = 24 * sin(2.5 * pi / 180) / 30;
    int beads = 0;
    for (int i = 0; i < read_back.count; i++) {
        const line_move *m = &read_back.move[i];
        if (m->e <= 0)
            continue;
        CHECK(m->inverse);
        CHECK_NEAR(60 / seconds, m->f, 0.002 * 60 / seconds); /* 1 um of 2 mm, rounded down */
        CHECK_NEAR(5 * ++beads, m->to[4], 1e-3);
        CHECK_NEAR(42, m->to[2], 1e-3);
    }
    CHECK_EQUAL(72, beads);
    if (!CHECK_EQUAL(4, read_back.modes))
        fputs(text, stderr);
    CHECK(strstr(text, "\nG93\nG1 "));
    CHECK(strstr(text, "\nG94\nG1 E-2 F2400\n"));
    free(text);
    iso_paths_free(&layer);
}

/* What the tip does over the part, by the file alone: as fast as the role, unless an axis is too
 * slow; never off the path by more than the tolerance. */
static void check_tip(const pose_machine *machine, double speed, bool exact) {
    for (int i = 0; i < read_back.count; i++) {
        const line_move *m = &read_back.move[i];
        if (m->e <= 0)
            continue;
        double mm = vec3_distance(tip_of(m->from, machine), tip_of(m->to, machine));
        double seconds = seconds_of(m);
        CHECK(mm / seconds <= speed * 1.0001);
        CHECK(!exact || mm / seconds >= speed * 0.99);
        for (int k = 0; k < 2; k++)
            CHECK(fabs(m->to[3 + k] - m->from[3 + k]) / seconds <= machine->fastest[k] * 1.0001);
    }
}

/* At 3 mm a radian's 180 deg/s give but 9.4 mm/s: the mandrel is the slower one there. */
static void test_compensated_feed(void) {
    for (int slow = 0; slow < 2; slow++) {
        pose_machine machine = mandrel();
        iso_paths layer = {0};
        add_coil(&layer, &machine, slow ? 3 : 25, 3, 0.5, 3 * 72 + 1);
        iso_gcode_options o = plain();
        iso_gcode_totals totals;
        o.machine = &machine;
        free(print_layers(&totals, &o, &layer, 1, "XYZQA"));
        check_tip(&machine, 60, !slow);
        CHECK_EQUAL(0, read_back.modes);
        const line_move *m = &read_back.move[read_back.count / 2];
        if (slow)
            CHECK_NEAR(180, fabs(m->to[4] - m->from[4]) / seconds_of(m), 2);
        iso_paths_free(&layer);
    }
}

/* A zigzag over a dome of 20 mm on a tilting table, so coarse that the axes have to be led between
 * vertices, and over its top; and a way around to its other side. */
static void add_dome(iso_paths *paths, const pose_machine *machine, iso_vec3 *place) {
    static iso_vec3 normal[400];
    int count = 0;
    for (int row = -4; row <= 4; row++)
        for (int k = -10; k <= 10; k++) {
            double x = 1.2 * (row % 2 ? -k : k), y = 0.4 + row;
            normal[count] = vec3_unit(vec3(x, y, sqrt(400 - x * x - y * y)));
            place[count] = vec3_along(machine->pivot, 20, normal[count]);
            count++;
        }
    add_path(paths, &(iso_path){.role = ISO_ROLE_SOLID_INFILL}, place, normal, count, 0.2);
    place += count;
    for (int k = 0; k < 2; k++) {
        normal[k] = vec3_unit(vec3(-1, 0.1 * k, 0.5));
        place[k] = vec3_along(machine->pivot, 20, normal[k]);
    }
    add_path(paths, &(iso_path){.role = ISO_ROLE_SOLID_INFILL}, place, normal, 2, 0.2);
}

static double to_segment(iso_vec3 p, iso_vec3 a, iso_vec3 b) {
    iso_vec3 ab = vec3_minus(b, a);
    double t = vec3_dot(vec3_minus(p, a), ab) / vec3_dot(ab, ab);
    return vec3_distance(p, vec3_along(a, t < 0 ? 0 : t > 1 ? 1 : t, ab));
}

/* Each move of the axes, sampled: how far the tip is off the segment that is being drawn; and E
 * by how far it has come. */
static void check_tip_stays(const pose_machine *machine, const iso_vec3 *place, int count) {
    int segment = 0;
    double worst = 0, done = 0, area = iso_bead_of(4500, 2000).area * 1e-8;
    for (int i = 0; i < read_back.count && segment + 1 < count; i++) {
        const line_move *m = &read_back.move[i];
        if (m->e <= 0)
            continue;
        for (int k = 0; k <= 8; k++) {
            double at[5];
            for (int n = 0; n < 5; n++)
                at[n] = m->from[n] + k / 8. * (m->to[n] - m->from[n]);
            double off = to_segment(tip_of(at, machine), place[segment], place[segment + 1]);
            worst = off > worst ? off : worst;
        }
        done += m->e;
        if (vec3_distance(tip_of(m->to, machine), place[segment + 1]) > 0.002)
            continue;
        double mm = vec3_distance(place[segment], place[segment + 1]);
        CHECK_NEAR(mm * area / (pi / 4 * 1.75 * 1.75), done, 3e-5);
        done = 0;
        segment++;
    }
    CHECK_EQUAL(count - 1, segment);
    CHECK(worst < 0.03);  /* half the tolerance again: pieces aren't all of a length */
    CHECK(worst > 0.004); /* the test would see it */
}

static void test_tip_stays_on_its_path(void) {
    for (int k = ISO_KINEMATICS_TABLE_AC; k <= ISO_KINEMATICS_TABLE_BC; k++) {
        pose_machine machine = table((iso_kinematics)k);
        static iso_vec3 place[400];
        iso_paths layer = {0};
        add_dome(&layer, &machine, place);
        iso_gcode_options o = bare();
        iso_gcode_totals totals;
        o.machine = &machine;
        o.watch = watch;
        o.watch_payload = &seen;
        seen = (watched){.fail_at = -1};
        free(
            print_layers(&totals, &o, &layer, 1, k == ISO_KINEMATICS_TABLE_AC ? "XYZAC" : "XYZBC"));
        check_tip_stays(&machine, place, 189);
        check_tip(&machine, 20, false);
        check_watched(&machine, 0);
        iso_paths_free(&layer);
    }
}

/* To the other side of the dome the nozzle goes around it: all of the way is outside. */
static void test_large_turns_go_around(void) {
    pose_machine machine = table(ISO_KINEMATICS_TABLE_BC);
    static iso_vec3 place[400];
    iso_paths layer = {0};
    add_dome(&layer, &machine, place);
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.watch = watch;
    o.watch_payload = &seen;
    seen = (watched){.fail_at = -1};
    free(print_layers(&totals, &o, &layer, 1, "XYZBC"));
    int travels = 0;
    for (int i = 1; i < seen.count; i++) { /* the first comes down */
        if (seen.move[i].width > 0)
            continue;
        travels++;
        for (int k = 0; k <= 4; k++) {
            iso_vec3 at = vec3_between(seen.move[i].from, seen.move[i].to, k / 4.);
            CHECK(vec3_distance(at, machine.pivot) > 19.999);
        }
        CHECK(vec3_dot(seen.move[i].from_normal, seen.move[i].to_normal) > cos(40 * pi / 180));
    }
    CHECK(travels > 4);
    iso_paths_free(&layer);
}

/* With points to go by, too; and what is printed may reach further out than both ends. */
static void test_large_turns_clear_what_reaches_out(void) {
    pose_machine machine = table(ISO_KINEMATICS_TABLE_BC);
    iso_paths layer = {0};
    iso_vec3 east = {1, 0, 0.2}, west = {-1, 0, 0.2}, up = {0, 0, 1}, place[2], normal[2];
    east = vec3_unit(east);
    west = vec3_unit(west);
    for (int i = 0; i < 3; i++) {
        iso_vec3 n = i == 0 ? up : i == 1 ? east : west;
        for (int k = 0; k < 2; k++) {
            normal[k] = n;
            place[k] = vec3_along(machine.pivot, i == 0 ? 35 : 20, n);
            place[k].y += k;
        }
        add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, 2, 0.2);
        iso_vec3 above = vec3_along(place[0], 1, n);
        if (i > 0)
            add_travel(&layer, &above, normal, 1, 0.2);
    }
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.watch = watch;
    o.watch_payload = &seen;
    seen = (watched){.fail_at = -1};
    free(print_layers(&totals, &o, &layer, 1, "XYZBC"));
    double least = 1e9;
    for (int i = 1; i < seen.count; i++) {
        const iso_gcode_move *m = &seen.move[i];
        double turn = vec3_dot(m->from_normal, m->to_normal);
        iso_vec3 middle = vec3_between(m->from, m->to, 0.5);
        if (m->width > 0 || turn > cos(1 * pi / 180))
            continue;
        least = fmin(least, vec3_distance(middle, machine.pivot));
    }
    CHECK(least > 35 && least < 1e9);
    iso_paths_free(&layer);
}

/* Around a mandrel, points 40 degrees apart: up once, at the same height all the way, down once. */
static void test_travels_around_a_mandrel_stay_up(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    iso_vec3 way[6], normal[6];
    add_coil(&layer, &machine, 12, 1, 0, 73);
    add_coil(&layer, &machine, 12, 1, 0, 73);
    for (int i = 0; i < 73; i++) { /* begins at 200 degrees */
        double t = (200 + 5 * i) * pi / 180;
        layer.frame[73 + i].normal = vec3(0, sin(t), cos(t));
        layer.vertex[73 + i].at.y = iso_units(machine.pivot.y + 12 * sin(t));
        layer.vertex[73 + i].z = iso_units(machine.pivot.z + 12 * cos(t) - 0.2);
    }
    for (int i = 0; i < 6; i++) {
        normal[i] = vec3(0, sin(i * 40 * pi / 180), cos(i * 40 * pi / 180));
        way[i] = vec3_along(machine.pivot, 13, normal[i]);
        way[i].x = 20;
    }
    add_travel(&layer, way, normal, 6, 0.2);
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.watch = watch;
    o.watch_payload = &seen;
    seen = (watched){.fail_at = -1};
    char *text = print_layers(&totals, &o, &layer, 1, "XYZQA");
    CHECK(strstr(text, "\nG1 Z43 F720\nG1 A400 F10800\nG1 A440\nG1 A480\nG1 A520\nG1 A560\n"
                       "G1 Z42 F720\n"));
    for (int i = 1; i < seen.count; i++) {
        iso_vec3 at =
            vec3_minus(vec3_between(seen.move[i].from, seen.move[i].to, 0.5), machine.pivot);
        CHECK(seen.move[i].width > 0 || hypot(at.y, at.z) > 11.97);
    }
    free(text);
    iso_paths_free(&layer);
}

/* A tool is changed without a retraction: where the nozzle is then is said by G94. */
static void test_tools_change_on_machines_that_turn(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    add_coil(&layer, &machine, 12, 1, 3, 73);
    add_coil(&layer, &machine, 14, 1, 0, 73);
    layer.path[1].tool = 1;
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.rotary_feed = ISO_FEED_INVERSE_TIME;
    o.flavour = ISO_FLAVOUR_REPRAPFIRMWARE;
    o.tools = 2;
    char *text = print_layers(&totals, &o, &layer, 1, "XYZQA");
    if (!CHECK(strstr(text, "\nT1\nG94\nG1 Z45 F7800\nG1 X20 Y100\n")))
        fputs(text, stderr);
    CHECK(totals.time > 2 && totals.time < 20);
    free(text);
    iso_paths_free(&layer);
}

/* Without bounds of acceleration a print takes what F says, whichever way it is said. */
static void test_time_is_that_of_the_file(void) {
    double time[2];
    for (int inverse = 0; inverse < 2; inverse++) {
        pose_machine machine = table(ISO_KINEMATICS_TABLE_BC);
        static iso_vec3 place[400];
        iso_paths layer = {0};
        add_dome(&layer, &machine, place);
        iso_gcode_options o = bare();
        iso_gcode_totals totals;
        o.machine = &machine;
        o.flavour = ISO_FLAVOUR_REPRAPFIRMWARE;
        o.rotary_feed = inverse ? ISO_FEED_INVERSE_TIME : ISO_FEED_COMPENSATED;
        for (int i = 0; i < 4; i++)
            o.limits.acceleration[i] = 1e9;
        o.limits.extruding = o.limits.travel = o.limits.retracting = 1e9;
        o.limits.junction_deviation = 1e9;
        free(print_layers(&totals, &o, &layer, 1, "XYZBC"));
        /* the way from nowhere is in neither */
        double first = 0;
        for (int i = 1; i < 2; i++)
            first += seconds_of(&read_back.move[i]);
        CHECK_NEAR(read_back.seconds - first, totals.time, 0.003 * totals.time);
        time[inverse] = totals.time;
        o.limits.extruding = o.limits.travel = 1000;
        o.limits.junction_deviation = 0.013;
        free(print_layers(&totals, &o, &layer, 1, "XYZBC"));
        CHECK(totals.time > time[inverse] * 1.01);
        iso_paths_free(&layer);
    }
    CHECK_NEAR(time[0], time[1], 1e-3 * time[0]);
}

/* An offset of Z moves the machine, not the part. */
static void test_z_offset_is_the_machines(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    add_coil(&layer, &machine, 12, 355. / 360, 0, 72);
    layer.path[0].closed = 1;
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.z_offset = 0.25;
    free(print_layers(&totals, &o, &layer, 1, "XYZQA"));
    for (int i = 0; i < read_back.count; i++)
        if (read_back.move[i].e > 0)
            CHECK_NEAR(42.25, read_back.move[i].to[2], 1e-3);
    iso_paths_free(&layer);
}

/* A ring is closed: the mandrel goes on to 360 degrees, and the next ring begins there. */
static void test_closed_rings_go_on(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    for (int i = 0; i < 2; i++) {
        add_coil(&layer, &machine, 12, 350. / 360, 0, 36);
        layer.path[i].closed = 1;
    }
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    free(print_layers(&totals, &o, &layer, 1, "XYZQA"));
    CHECK_NEAR(720, read_back.move[read_back.count - 1].to[4], 1e-3);
    CHECK(read_back.move[read_back.count - 1].e > 0);
    CHECK_EQUAL(72, (int)(read_back.drawn * pi / 4 * 1.75 * 1.75 /
                              (iso_bead_of(4500, 2000).area * 1e-8 * 24 * sin(5 * pi / 180)) +
                          0.5));
    iso_paths_free(&layer);
}

static void test_flavours_that_cant(void) {
    pose_machine machine = mandrel();
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.flavour = ISO_FLAVOUR_MAKERWARE;
    CHECK_STATUS(ISO_BAD_CONFIG, write_layers(&totals, &o, NULL, 0));
    CHECK(strstr(iso_error_message(), "makerware has no axis A that turns the part; see docs"));
    o.flavour = ISO_FLAVOUR_MACH3;
    CHECK_STATUS(ISO_BAD_CONFIG, write_layers(&totals, &o, NULL, 0));
    CHECK(strstr(iso_error_message(), "A is its filament"));
    machine = table(ISO_KINEMATICS_TABLE_BC);
    CHECK_OK(write_layers(&totals, &o, NULL, 0));
    o.flavour = ISO_FLAVOUR_MARLIN2;
    o.rotary_feed = ISO_FEED_INVERSE_TIME;
    CHECK_STATUS(ISO_BAD_CONFIG, write_layers(&totals, &o, NULL, 0));
    CHECK(strstr(iso_error_message(), "marlin2 has no G93"));
    machine.kinematics = ISO_KINEMATICS_CARTESIAN;
    CHECK_OK(write_layers(&totals, &o, NULL, 0));
    unlink(SMALL_FILE);
}

/* Layers without poses on such a machine are a defect of the caller. */
static void test_poses_are_needed(void) {
    pose_machine machine = mandrel();
    iso_paths layer = two_lines(true);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.machine = &machine;
    CHECK_STATUS(ISO_BUG, write_file(&totals, &o, &layer, 1));
    iso_paths_free(&layer);
}

static void test_memory_runs_out(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    add_coil(&layer, &machine, 12, 1, 0, 37);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.machine = &machine;
    iso_status status = ISO_NO_MEMORY;
    int n = 0;
    for (; n < 100 && status != ISO_OK; n++) {
        iso_fail_allocation_after(n);
        status = write_layers(&totals, &o, &layer, 1);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
    }
    CHECK(n > 3 && status == ISO_OK);
    unlink(SMALL_FILE);
    iso_paths_free(&layer);
}

int main(void) {
    RUN(test_helix);
    RUN(test_flow_is_limited_by_the_section_in_space);
    RUN(test_heights_are_said_in_steps);
    RUN(test_travel_follows_its_points);
    RUN(test_short_ways_dont_retract);
    RUN(test_unknown_ways_go_over_all);
    RUN(test_flat_layers_after_curved_ones);
    RUN(test_watch_sees_the_file);
    RUN(test_watch_sees_arcs);
    RUN(test_inverse_time);
    RUN(test_compensated_feed);
    RUN(test_tip_stays_on_its_path);
    RUN(test_large_turns_go_around);
    RUN(test_large_turns_clear_what_reaches_out);
    RUN(test_travels_around_a_mandrel_stay_up);
    RUN(test_tools_change_on_machines_that_turn);
    RUN(test_time_is_that_of_the_file);
    RUN(test_z_offset_is_the_machines);
    RUN(test_closed_rings_go_on);
    RUN(test_flavours_that_cant);
    RUN(test_poses_are_needed);
    RUN(test_memory_runs_out);
    return check_verdict();
}
