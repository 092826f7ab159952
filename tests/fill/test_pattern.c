/* Every pattern: how much is drawn, where, and whether layers lie on each other. */
#include <isoslice/fill.h>

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "fill/inside.h"
#include "fill/shapes.h"

static const double pi = 3.14159265358979323846;
static const double densities[] = {0.1, 0.2, 0.4};

static const char *const name[ISO_PATTERN_COUNT] = {"rectilinear",    "alignedrectilinear",
                                                    "monotonic",      "grid",
                                                    "triangles",      "stars",
                                                    "cubic",          "line",
                                                    "concentric",     "honeycomb",
                                                    "3dhoneycomb",    "gyroid",
                                                    "hilbertcurve",   "archimedeanchords",
                                                    "octagramspiral", "monotoniclines"};

/* Only the pattern itself: no links, no anchors, nothing left out. */
static iso_fill_options bare(int pattern, double density, int layer) {
    iso_fill_options options = iso_fill_defaults(iso_bead_of(4500, 2000), density);
    options.pattern = pattern;
    options.layer = layer;
    options.z = 2000 * layer + 1000;
    options.angle = 17 + iso_fill_pattern_turn((iso_fill_pattern)pattern, layer);
    options.origin = (iso_point){123456, -98765};
    options.link_max = options.anchor = options.deviation = options.shortest = 0;
    return options;
}

static iso_fill_options linked(int pattern, double density, int layer) {
    iso_fill_options options = bare(pattern, density, layer);
    options.link_max = 500000;
    options.anchor = 27000;
    return options;
}

static void fill(iso_paths *paths, const iso_region *region, const iso_fill_options *options) {
    iso_paths_clear(paths);
    CHECK_OK(iso_fill(paths, region, options, NULL, NULL));
}

typedef struct line {
    iso_point a, b;
} line;

/* The straight pieces of all paths; free the result. */
static line *lines_of(const iso_paths *paths, int *count) {
    line *lines = malloc(((size_t)paths->vertex_count + 1) * sizeof *lines);
    *count = 0;
    for (int i = 0; i < paths->count; i++) {
        const iso_path *path = &paths->path[i];
        for (int k = 0; k + 1 < path->count + path->closed; k++)
            lines[(*count)++] = (line){paths->vertex[path->first + k].at,
                                       paths->vertex[path->first + (k + 1) % path->count].at};
    }
    return lines;
}

static double length_of(const line *l) {
    return hypot(l->b.x - l->a.x, l->b.y - l->a.y);
}

static double total_length(const iso_paths *paths) {
    int count;
    double length = 0;
    line *lines = lines_of(paths, &count);
    for (int i = 0; i < count; i++)
        length += length_of(&lines[i]);
    free(lines);
    return length;
}

static void make_square(iso_region *region) {
    static const double corner[4][2] = {{-50, -50}, {50, -50}, {50, 50}, {-50, 50}};
    add_contour(region, corner, 4, 0, -1);
}

static void make_round(iso_region *region) {
    add_circle(region, 10, 20, 50, 300, 0, -1);
}

static void make_ring(iso_region *region) {
    add_circle(region, 0, 0, 50, 200, 0, -1);
    add_circle(region, 0, 0, 30, 200, 0, 0);
}

static double outline(const iso_region *region) {
    double length = 0;
    for (int i = 0; i < region->count; i++)
        for (int a = region->first[i + 1] - 1, b = region->first[i]; b < region->first[i + 1];
             a = b++)
            length += length_of(&(line){region->point[a], region->point[b]});
    return length;
}

/* Mean over layers: gyroid and cubic draw more on some and less on others. Insets draw on the
 * region's own boundary and so stand for half a spacing beyond it. */
static void check_density(void (*make)(iso_region *), double tolerance) {
    enum { LAYERS = 24 };
    iso_region region = {0};
    iso_paths paths = {0};
    make(&region);
    for (int pattern = 0; pattern < ISO_PATTERN_COUNT; pattern++)
        for (int d = 0; d < 3; d++) {
            double area = region_area(&region), length = 0, rise = 1;
            iso_fill_options options = bare(pattern, densities[d], 0);
            if (pattern == ISO_PATTERN_CONCENTRIC)
                area += outline(&region) * options.spacing / 2;
            for (int layer = 0; layer < LAYERS; layer++) { /* over whole periods, nearly */
                options = bare(pattern, densities[d], layer);
                rise = 2 * pi * 0.391315 * options.spacing / LAYERS;
                if (pattern == ISO_PATTERN_GYROID)
                    options.z = (int32_t)(layer * rise);
                fill(&paths, &region, &options);
                length += total_length(&paths) / LAYERS;
            }
            double share = length * options.spacing / area;
            if (!CHECK(fabs(share - 1) <= tolerance))
                fprintf(stderr, "  %s at %g: %.4f of the volume\n", name[pattern], densities[d],
                        share);
        }
    iso_paths_free(&paths);
    drop_region(&region);
}

static void test_volume_is_the_density(void) {
    check_density(make_square, 0.015);
    check_density(make_round, 0.02);
    check_density(make_ring, 0.06);
}

static void test_stays_within_the_region(void) {
    iso_paths paths = {0};
    for (int pattern = 0; pattern < ISO_PATTERN_COUNT; pattern++)
        for (int s = 0; s < shape_count; s++) {
            iso_region region = {0};
            int count, outside = 0;
            shapes[s].make(&region, 12);
            iso_fill_options options = linked(pattern, 0.1, 2 + s);
            fill(&paths, &region, &options);
            line *lines = lines_of(&paths, &count);
            for (int i = 0; i < count; i++)
                for (int k = 0; k < 3; k++)
                    outside +=
                        !is_inside(&region, lines[i].a.x + k / 3.0 * (lines[i].b.x - lines[i].a.x),
                                   lines[i].a.y + k / 3.0 * (lines[i].b.y - lines[i].a.y), 1.5);
            if (!CHECK_EQUAL(0, outside))
                fprintf(stderr, "  %s in %s\n", name[pattern], shapes[s].name);
            CHECK(count > 0);
            free(lines);
            drop_region(&region);
        }
    iso_paths_free(&paths);
}

/* ---- the boundary ---- */

typedef struct stretch {
    int edge;
    double from, to;
} stretch;

static int by_place(const void *a, const void *b) {
    const stretch *s = a, *t = b;
    return s->edge != t->edge ? s->edge - t->edge : (s->from > t->from) - (s->from < t->from);
}

/* Where the line lies on the edge a-b, if it does. */
static int is_on_edge(stretch *s, const line *l, iso_point a, iso_point b) {
    double dx = b.x - a.x, dy = b.y - a.y, length = hypot(dx, dy), at[2];
    const iso_point *end[2] = {&l->a, &l->b};
    for (int k = 0; k < 2; k++) {
        double px = end[k]->x - a.x, py = end[k]->y - a.y;
        at[k] = (px * dx + py * dy) / length;
        if (fabs(px * dy - py * dx) > 1.5 * length || at[k] < -1.5 || at[k] > length + 1.5)
            return 0;
    }
    s->from = fmin(at[0], at[1]);
    s->to = fmax(at[0], at[1]);
    return s->to - s->from > 4;
}

/* Units of boundary that are drawn more than once. */
static double drawn_twice(const iso_region *region, const iso_paths *paths) {
    int count, found = 0;
    line *lines = lines_of(paths, &count);
    stretch *on = malloc(((size_t)count + 1) * sizeof *on);
    for (int i = 0; i < count; i++)
        for (int m = 0, edge = 0; m < region->count; m++)
            for (int a = region->first[m + 1] - 1, b = region->first[m]; b < region->first[m + 1];
                 a = b++, edge++) {
                on[found].edge = edge;
                if (found < count &&
                    is_on_edge(&on[found], &lines[i], region->point[a], region->point[b]))
                    found++;
            }
    qsort(on, (size_t)found, sizeof *on, by_place);
    double twice = 0, reach = 0;
    for (int i = 0; i < found; i++) {
        reach = i && on[i].edge == on[i - 1].edge ? fmax(reach, on[i - 1].to) : -1;
        if (reach > on[i].from + 4)
            twice += fmin(reach, on[i].to) - on[i].from;
    }
    free(on);
    free(lines);
    return twice;
}

static void test_no_boundary_is_drawn_twice(void) {
    iso_paths paths = {0};
    for (int pattern = ISO_PATTERN_GRID; pattern < ISO_PATTERN_COUNT; pattern++)
        for (int s = 0; s < shape_count; s++)
            for (int tight = 0; tight < 2; tight++) {
                iso_region region = {0};
                shapes[s].make(&region, 12);
                iso_fill_options options = linked(pattern, 0.15, s);
                if (tight)
                    options.link_max = options.anchor = 12000;
                fill(&paths, &region, &options);
                if (!CHECK_NEAR(0, drawn_twice(&region, &paths), 0.01))
                    fprintf(stderr, "  %s in %s\n", name[pattern], shapes[s].name);
                drop_region(&region);
            }
    iso_paths_free(&paths);
}

/* Links and anchors are pieces of boundary no longer than they may be, and spare most travels. */
static void test_links_and_anchors(void) {
    iso_region region = {0};
    iso_paths alone = {0}, anchored = {0}, joined = {0};
    make_square(&region);
    for (int pattern = ISO_PATTERN_GRID; pattern < ISO_PATTERN_COUNT; pattern++) {
        if (pattern == ISO_PATTERN_CONCENTRIC || pattern == ISO_PATTERN_MONOTONIC_LINES)
            continue;
        iso_fill_options options = bare(pattern, 0.2, 3);
        fill(&alone, &region, &options);
        options.link_max = 6000; /* shorter than most arcs */
        options.anchor = 5000;
        fill(&anchored, &region, &options);
        options = linked(pattern, 0.2, 3);
        fill(&joined, &region, &options);
        CHECK(joined.count * 3 < alone.count);
        CHECK(anchored.count <= alone.count && anchored.count > joined.count);
        double more = total_length(&anchored) - total_length(&alone);
        CHECK(more > 0.3 * 5000 * alone.count && more < 6000.0 * 2 * alone.count);
        double links = total_length(&joined) - total_length(&alone);
        CHECK(links > 0.2 * outline(&region) && links < 0.75 * outline(&region));
    }
    iso_paths_free(&alone);
    iso_paths_free(&anchored);
    iso_paths_free(&joined);
    drop_region(&region);
}

/* ---- places ---- */

static double distance_to(const line *l, double x, double y) {
    double dx = l->b.x - l->a.x, dy = l->b.y - l->a.y, px = x - l->a.x, py = y - l->a.y;
    double square = dx * dx + dy * dy, t = square > 0 ? (px * dx + py * dy) / square : 0;
    t = fmax(0, fmin(1, t));
    return hypot(px - t * dx, py - t * dy);
}

/* What is drawn in a small region is also drawn in a larger one around it, elsewhere in the list of
 * parts, at the same place. */
static void test_pattern_keeps_its_place(void) {
    static const double small[4][2] = {{3, 1}, {21, 4}, {24, 19}, {6, 23}};
    for (int pattern = 0; pattern < ISO_PATTERN_COUNT; pattern++) {
        iso_region inner = {0}, outer = {0};
        iso_paths a = {0}, b = {0};
        int few, many, astray = 0;
        if (pattern == ISO_PATTERN_CONCENTRIC) /* follows the region */
            continue;
        add_contour(&inner, small, 4, 0, -1);
        make_square(&outer);
        iso_fill_options options = bare(pattern, 0.2, 5);
        fill(&a, &inner, &options);
        fill(&b, &outer, &options);
        line *part = lines_of(&a, &few), *whole = lines_of(&b, &many);
        for (int i = 0; i < few; i++) {
            double nearest = INFINITY;
            for (int k = 0; k < many; k++)
                nearest = fmin(nearest, distance_to(&whole[k], (part[i].a.x + part[i].b.x) / 2.0,
                                                    (part[i].a.y + part[i].b.y) / 2.0));
            astray += nearest > 3;
        }
        CHECK(few > 5);
        if (!CHECK_EQUAL(0, astray))
            fprintf(stderr, "  %s\n", name[pattern]);
        free(part);
        free(whole);
        iso_paths_free(&a);
        iso_paths_free(&b);
        drop_region(&inner);
        drop_region(&outer);
    }
}

typedef double wall_distance(double x, double y, double z, double spacing);

/* The middles of all pieces, in the pattern's frame, against a surface; in units. */
static void check_surface(int pattern, double turn, wall_distance *off, double tolerance) {
    iso_region region = {0};
    iso_paths paths = {0};
    make_square(&region);
    for (int layer = 0; layer < 60; layer += 7) {
        iso_fill_options options = bare(pattern, 0.2, layer);
        int count;
        double worst = 0, angle = (17 + turn) * pi / 180, c = cos(angle), s = sin(angle);
        fill(&paths, &region, &options);
        line *lines = lines_of(&paths, &count);
        for (int i = 0; i < count; i++)
            for (int k = 0; k <= 4; k++) {
                double x =
                    lines[i].a.x + k / 4.0 * (lines[i].b.x - lines[i].a.x) - options.origin.x;
                double y =
                    lines[i].a.y + k / 4.0 * (lines[i].b.y - lines[i].a.y) - options.origin.y;
                worst = fmax(worst, off(x * c + y * s, y * c - x * s, options.z, options.spacing));
            }
        if (!CHECK(worst <= tolerance))
            fprintf(stderr, "  %s, layer %d: %g units off\n", name[pattern], layer, worst);
        free(lines);
    }
    iso_paths_free(&paths);
    drop_region(&region);
}

static double off_gyroid(double x, double y, double z, double spacing) {
    double k = 1 / (0.391315 * spacing);
    x *= k, y *= k, z *= k;
    double f = sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x);
    double fx = cos(x) * cos(y) - sin(z) * sin(x), fy = cos(y) * cos(z) - sin(x) * sin(y);
    return fabs(f) / fmax(hypot(fx, fy), 0.1) / k;
}

/* Three families of planes at right angles to each other, all at the same angle to the vertical. */
static double off_cubes(double x, double y, double z, double spacing) {
    double nearest = INFINITY, apart = 3 * spacing * sqrt(2 / 3.0);
    for (int f = 0; f < 3; f++) {
        double to = pi / 2 + f * 2 * pi / 3;
        double along = sqrt(2 / 3.0) * (x * cos(to) + y * sin(to)) - z / sqrt(3);
        nearest = fmin(nearest, fabs(remainder(along, apart)));
    }
    return nearest;
}

/* Truncated octahedra are the Voronoi cells of the body-centred lattice: on a wall, two of its
 * points are nearest. */
static double off_octahedra(double x, double y, double z, double spacing) {
    double p = spacing * (1 + (sqrt(2) - 1) / 4), l = sqrt(2) * p, first = INFINITY;
    double second = INFINITY;
    int x0 = (int)lround(x / p), y0 = (int)lround(y / p), z0 = (int)lround(2 * z / l);
    for (int i = x0 - 2; i <= x0 + 2; i++)
        for (int j = y0 - 2; j <= y0 + 2; j++)
            for (int k = z0 - 3; k <= z0 + 3; k++) {
                double to = hypot(hypot(x - i * p, y - j * p), z - k * l / 2);
                if ((i + j + k) % 2 != 0)
                    continue;
                second = fmin(second, fmax(first, to));
                first = fmin(first, to);
            }
    return second - first;
}

static double off_spiral(double x, double y, double z, double spacing) {
    (void)z;
    if (hypot(x, y) < spacing) /* chords through the middle have no angle */
        return 0;
    return fabs(remainder(hypot(x, y) - atan2(y, x) / (2 * pi) * spacing, spacing));
}

/* On lines between the cells' middles, which lie on the half spacings. */
static double off_squares(double x, double y, double z, double spacing) {
    (void)z;
    return fmin(fabs(remainder(x - spacing / 2, spacing)),
                fabs(remainder(y - spacing / 2, spacing)));
}

static void test_surfaces(void) {
    check_surface(ISO_PATTERN_GYROID, -45, off_gyroid, 260);
    check_surface(ISO_PATTERN_CUBIC, 0, off_cubes, 3);
    check_surface(ISO_PATTERN_HONEYCOMB_3D, -45, off_octahedra, 3);
    check_surface(ISO_PATTERN_ARCHIMEDEAN, 0, off_spiral, 170);
    check_surface(ISO_PATTERN_HILBERT, 0, off_squares, 3);
}

/* ---- the rest ---- */

/* Of a solid fill by insets the volume is right, and nothing stays open wider than a bead. */
static void test_solid_insets(void) {
    static const double plate[4][2] = {{0, 0}, {30, 0}, {30, 7.3}, {0, 7.3}};
    iso_region region = {0};
    iso_paths paths = {0};
    add_contour(&region, plate, 4, 0, -1);
    iso_fill_options options = bare(ISO_PATTERN_CONCENTRIC, 1, 0);
    fill(&paths, &region, &options);
    double bead = options.spacing, volume = 0;
    for (int i = 0; i < paths.count; i++) {
        const iso_path *path = &paths.path[i];
        CHECK_EQUAL(1, path->closed);
        CHECK_EQUAL(i, path->rank);
        for (int k = 0; k < path->count; k++)
            volume += length_of(&(line){paths.vertex[path->first + k].at,
                                        paths.vertex[path->first + (k + 1) % path->count].at}) *
                      paths.vertex[path->first].area;
    }
    double full = region_area(&region) + outline(&region) * bead / 2 + bead * bead;
    CHECK_NEAR(1, volume / 2000 / full, 0.03);
    iso_paths_free(&paths);
    drop_region(&region);
}

/* Each line is ranked after those on its right, and none is joined to another. */
static void test_monotonic_lines(void) {
    iso_region region = {0};
    iso_paths paths = {0};
    make_square(&region);
    iso_fill_options options = linked(ISO_PATTERN_MONOTONIC_LINES, 0.3, 1);
    fill(&paths, &region, &options);
    double c = cos(options.angle * pi / 180), s = sin(options.angle * pi / 180), before = -1e9;
    int wrong = 0;
    for (int i = 0; i < paths.count; i++) {
        const iso_path_vertex *v = &paths.vertex[paths.path[i].first];
        double left = v->at.y * c - v->at.x * s;
        wrong += left <= before || paths.path[i].count != 2 || paths.path[i].rank != i;
        before = left;
    }
    CHECK(paths.count > 70);
    CHECK_EQUAL(0, wrong);
    iso_paths_free(&paths);
    drop_region(&region);
}

static void test_same_bytes(void) {
    iso_region region = {0};
    iso_paths a = {0}, b = {0};
    iso_arena scratch = {0};
    iso_planar_scratch *planar;
    CHECK_OK(iso_planar_scratch_new(&planar));
    shapes[3].make(&region, 5);
    for (int pattern = 0; pattern < ISO_PATTERN_COUNT; pattern++) {
        iso_fill_options options = linked(pattern, 0.2, 4);
        fill(&a, &region, &options);
        iso_paths_clear(&b);
        CHECK_OK(iso_fill(&b, &region, &options, &scratch, planar));
        CHECK_EQUAL(a.count, b.count);
        CHECK_EQUAL(a.vertex_count, b.vertex_count);
        CHECK(memcmp(a.vertex, b.vertex, (size_t)a.vertex_count * sizeof *a.vertex) == 0);
    }
    iso_planar_scratch_free(planar);
    iso_arena_free(&scratch);
    iso_paths_free(&a);
    iso_paths_free(&b);
    drop_region(&region);
}

static void test_failing_allocations(void) {
    static const double corner[4][2] = {{0, 0}, {14, 0}, {14, 9}, {0, 9}};
    iso_region region = {0};
    add_contour(&region, corner, 4, 0, -1);
    for (int pattern = 0; pattern < ISO_PATTERN_COUNT; pattern++) {
        iso_status status = ISO_NO_MEMORY;
        iso_fill_options options = linked(pattern, 0.2, 1);
        for (int64_t n = 0; status != ISO_OK && n < 1000; n++) {
            iso_paths paths = {0};
            iso_fail_allocation_after(n);
            status = iso_fill(&paths, &region, &options, NULL, NULL);
            iso_fail_allocation_after(-1);
            CHECK(status == ISO_OK ? paths.count > 0 : status == ISO_NO_MEMORY && paths.count == 0);
            iso_paths_free(&paths);
        }
        CHECK_OK(status);
    }
    drop_region(&region);
}

static void test_refuses_nonsense(void) {
    iso_region region = {0};
    iso_paths paths = {0};
    iso_fill_options options = bare(ISO_PATTERN_COUNT, 0.2, 0);
    CHECK_OK(iso_fill(&paths, &(iso_region){0}, &(iso_fill_options){.spacing = 1000, .density = 1},
                      NULL, NULL));
    make_square(&region);
    CHECK_STATUS(ISO_USAGE, iso_fill(&paths, &region, &options, NULL, NULL));
    options = bare(ISO_PATTERN_GYROID, 0.2, 0);
    options.density = 0;
    CHECK_STATUS(ISO_USAGE, iso_fill(&paths, &region, &options, NULL, NULL));
    options = bare(ISO_PATTERN_GYROID, 0.2, 0);
    options.z = -1;
    CHECK_STATUS(ISO_USAGE, iso_fill(&paths, &region, &options, NULL, NULL));
    options = bare(ISO_PATTERN_GYROID, 0.2, 0);
    options.spacing = ISO_FILL_SPACING_MIN / 2 + 50; /* a hundred million turns */
    add_circle(&region, 0, 0, 800, 100, 0, -1);
    CHECK_STATUS(ISO_USAGE, iso_fill(&paths, &region, &options, NULL, NULL));
    CHECK(strstr(iso_error_message(), "too fine"));
    CHECK_EQUAL(0, paths.count);
    iso_paths_free(&paths);
    drop_region(&region);
}

int main(void) {
    RUN(test_volume_is_the_density);
    RUN(test_stays_within_the_region);
    RUN(test_no_boundary_is_drawn_twice);
    RUN(test_links_and_anchors);
    RUN(test_pattern_keeps_its_place);
    RUN(test_surfaces);
    RUN(test_solid_insets);
    RUN(test_monotonic_lines);
    RUN(test_same_bytes);
    RUN(test_failing_allocations);
    RUN(test_refuses_nonsense);
    return check_verdict();
}
