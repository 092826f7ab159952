/* The rectilinear fill: what is drawn, where, how often, and how much of it. */
#include <isoslice/fill.h>

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "fill/cells.h"
#include "fill/hatch.h"
#include "fill/inside.h"
#include "fill/shapes.h"

static const double pi = 3.14159265358979323846;

static double bead_length(const iso_paths *paths, int i, int k) {
    const iso_path_vertex *vertex = paths->vertex + paths->path[i].first + k;
    return hypot(vertex[1].at.x - vertex[0].at.x, vertex[1].at.y - vertex[0].at.y);
}

static double drawn_volume(const iso_paths *paths) { /* units^3 */
    double volume = 0;
    for (int i = 0; i < paths->count; i++)
        for (int k = 0; k + 1 < paths->path[i].count; k++)
            volume += bead_length(paths, i, k) * paths->vertex[paths->path[i].first + k].area;
    return volume;
}

static double perimeter(const iso_region *region) {
    double length = 0;
    for (int i = 0; i < region->count; i++)
        for (int a = region->first[i + 1] - 1, b = region->first[i]; b < region->first[i + 1];
             a = b++)
            length += hypot(region->point[b].x - region->point[a].x,
                            region->point[b].y - region->point[a].y);
    return length;
}

/* A fill that shows everything: no straightening, nothing left out. */
static iso_fill_options bare_options(double spacing, double angle, int fit) {
    iso_fill_options options = iso_fill_defaults(iso_bead_of(4500, 2000), 1);
    options.spacing = spacing;
    options.angle = angle;
    options.fit = fit;
    options.link_max = (int32_t)(5 * spacing);
    options.margin = (int32_t)(spacing / 2);
    options.deviation = options.shortest = 0;
    return options;
}

typedef struct edge {
    iso_point a, b;
} edge;

static int compare_edges(const void *one, const void *other) {
    return memcmp(one, other, sizeof(edge));
}

static edge edge_of(iso_point a, iso_point b) {
    return memcmp(&a, &b, sizeof a) < 0 ? (edge){a, b} : (edge){b, a};
}

static int drawn_edges(edge *edges, const iso_paths *paths) {
    int count = 0;
    for (int i = 0; i < paths->count; i++)
        for (int k = 0; k + 1 < paths->path[i].count; k++)
            edges[count++] = edge_of(paths->vertex[paths->path[i].first + k].at,
                                     paths->vertex[paths->path[i].first + k + 1].at);
    qsort(edges, (size_t)count, sizeof *edges, compare_edges);
    return count;
}

/* Every segment of the hatch of this part is among the edges, and once. Marks them in `used`. */
static int missing_segments(const iso_hatch *hatch, const edge *edges, char *used, int count) {
    int missing = 0;
    for (int32_t c = 0; c < hatch->link.count; c += 2) {
        edge wanted = edge_of(hatch->crossing[c].at, hatch->crossing[c + 1].at);
        if (memcmp(&wanted.a, &wanted.b, sizeof wanted.a) == 0)
            continue;
        const edge *found = bsearch(&wanted, edges, (size_t)count, sizeof *edges, compare_edges);
        if (!found) {
            missing++;
            continue;
        }
        while (found > edges && compare_edges(found - 1, &wanted) == 0)
            found--; /* a tip may draw its line and its link on the same units */
        while (found < edges + count && used[found - edges] && compare_edges(found, &wanted) == 0)
            found++;
        if (found == edges + count || compare_edges(found, &wanted))
            missing++;
        else
            used[found - edges] = 1;
    }
    return missing;
}

/* Is an edge that is no segment a piece of the boundary, to a unit? Its ends and middle tell. */
static int is_on_boundary(const iso_region *region, const edge *drawn) {
    iso_region turned = {0}; /* not inside by winding: all contours the wrong way round */
    for (int i = 0; i < region->count; i++) {
        int from = region->first[i], count = region->first[i + 1] - from;
        iso_point *point = malloc((size_t)count * sizeof *point);
        for (int k = 0; k < count; k++)
            point[k] = region->point[from + count - 1 - k];
        add_points(&turned, point, count, -1);
        free(point);
    }
    int on = 1;
    for (int k = 0; k <= 4; k++)
        on &= is_inside(&turned, drawn->a.x + (drawn->b.x - drawn->a.x) * k / 4.0,
                        drawn->a.y + (drawn->b.y - drawn->a.y) * k / 4.0, 1);
    drop_region(&turned);
    return on;
}

/* Draw a region and hold it against its hatch: each segment once, all else on the boundary. */
static void check_drawing(const iso_region *region, double spacing, double angle) {
    iso_arena scratch = {0};
    iso_paths paths = {0};
    iso_fill_options options = bare_options(spacing, angle, 0);
    CHECK_OK(iso_fill_rectilinear(&paths, region, &options, &scratch));
    edge *edges = malloc(((size_t)paths.vertex_count + 1) * sizeof *edges);
    int count = drawn_edges(edges, &paths);
    char *used = calloc((size_t)count + 1, 1);
    int32_t *member;
    iso_cut *room;
    CHECK_OK(ISO_PUSH(member, &scratch, region->count));
    CHECK_OK(ISO_PUSH(room, &scratch, region->first[region->count]));
    for (int32_t i = 0; i < region->count; i++)
        member[i] = i;
    iso_fill_part whole = {region, member, region->count};
    iso_sweep sweep = iso_sweep_of(angle);
    iso_hatch hatch;
    iso_sweep_repeat(&sweep, (int64_t)(spacing * 256) << 23, 0,
                     &(iso_extent){.low = -(1LL << 55), .high = 1LL << 55});
    CHECK_OK(iso_hatch_build(&hatch, &whole, &sweep, room, &scratch));
    CHECK_EQUAL(0, missing_segments(&hatch, edges, used, count));
    int stray = 0;
    for (int i = 0; i < count; i++)
        stray += !used[i] && !is_on_boundary(region, &edges[i]);
    CHECK_EQUAL(0, stray);
    free(used);
    free(edges);
    iso_paths_free(&paths);
    iso_arena_free(&scratch);
}

static void test_every_segment_once_links_on_the_boundary(void) {
    for (int i = 0; i < shape_count; i++)
        for (double angle = 0; angle < 180; angle += 22.5) {
            iso_region region = {0};
            shapes[i].make(&region, angle / 3);
            check_drawing(&region, 13000.25, angle);
            drop_region(&region);
        }
    static const double angles[] = {0, 45, 90, 60};
    for (unsigned seed = 0; seed < 60; seed++) {
        iso_region region = {0};
        cells grid = cells_random(seed + 1000, 40 + (int)(seed % 5) * 10);
        cells_region(&region, &grid, 40000, seed % 2 ? 20000 : 0);
        check_drawing(&region, seed % 3 ? 20000 : 13333.5, angles[seed % 4]);
        drop_region(&region);
    }
}

/* Nothing leaves the region: vertices and samples between them, with links cut short by up to the
 * deviation. */
static void test_beads_stay_inside(void) {
    for (int i = 0; i < shape_count; i++)
        for (int k = 0; k < 4; k++) {
            iso_region region = {0};
            iso_paths paths = {0};
            iso_arena scratch = {0};
            shapes[i].make(&region, 10 * k);
            iso_fill_options options = bare_options(16000, 37 * k, k % 2);
            options.deviation = k < 2 ? 0 : 100;
            options.margin = 0; /* nothing to fill beyond the boundary */
            CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
            int outside = 0;
            for (int p = 0; p < paths.count; p++)
                for (int v = 0; v + 1 < paths.path[p].count; v++) {
                    iso_point a = paths.vertex[paths.path[p].first + v].at;
                    iso_point b = paths.vertex[paths.path[p].first + v + 1].at;
                    for (int t = 0; t <= 5; t++)
                        outside += !is_inside(&region, a.x + (b.x - a.x) * t / 5.0,
                                              a.y + (b.y - a.y) * t / 5.0, options.deviation + 1);
                }
            CHECK_EQUAL(0, outside);
            iso_paths_free(&paths);
            iso_arena_free(&scratch);
            drop_region(&region);
        }
}

/* A solid fill of a region holds what the region, grown by half a spacing, does. Narrow teeth hold
 * a whole number of lines, hence the comb's tolerance. */
static void test_volume(void) {
    iso_arena scratch = {0};
    for (int i = 0; i < shape_count; i++)
        for (double angle = 0; angle < 180; angle += 15) {
            iso_region region = {0};
            iso_paths paths = {0};
            shapes[i].make(&region, 0);
            iso_bead bead = iso_bead_of(4500, 2000);
            iso_fill_options options = iso_fill_defaults(bead, 1);
            options.angle = angle;
            CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
            double whole = region_area(&region) + perimeter(&region) * bead.spacing / 2;
            double tolerance = strcmp(shapes[i].name, "comb") ? 0.006 : 0.07;
            CHECK_NEAR(1, drawn_volume(&paths) / (whole * bead.height), tolerance);
            iso_paths_free(&paths);
            drop_region(&region);
        }
    iso_arena_free(&scratch);
}

/* Any strip from a few hundredths of a spacing to many spacings wide holds its volume: the lines'
 * number is whole, so their flow gives way. */
static void test_volume_of_strips_of_any_width(void) {
    iso_arena scratch = {0};
    iso_bead bead = iso_bead_of(4500, 2000);
    for (int height = 50; height < 40000; height += height / 7 + 13) {
        iso_point corner[4] = {{0, 0}, {2000000, 0}, {2000000, height}, {0, height}};
        iso_region region = {0};
        iso_paths paths = {0};
        add_points(&region, corner, 4, -1);
        iso_fill_options options = iso_fill_defaults(bead, 1);
        CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
        double whole = (2000000.0 + bead.spacing) * (height + bead.spacing);
        CHECK_EQUAL(1, paths.count);
        CHECK_NEAR(1, drawn_volume(&paths) / (whole * bead.height), 0.004);
        int width = paths.vertex[0].width;
        CHECK(width > 0.7 * bead.width && width < 1.55 * bead.width);
        iso_paths_free(&paths);
        drop_region(&region);
    }
    iso_arena_free(&scratch);
}

/* On which lines, with angle 0, paths lie whose links are left out. */
static int line_places(double *place, const iso_region *region, double spacing) {
    iso_arena scratch = {0};
    iso_paths paths = {0};
    iso_fill_options options = bare_options(spacing, 0, 1);
    options.link_max = 0;
    CHECK_OK(iso_fill_rectilinear(&paths, region, &options, &scratch));
    for (int i = 0; i < paths.count; i++)
        place[i] = paths.vertex[paths.path[i].first].at.y;
    int count = paths.count;
    iso_paths_free(&paths);
    iso_arena_free(&scratch);
    return count;
}

/* Fitted lines lie half a gap from the edge of what is to be full where it runs along them, and
 * half a gap within the region's corners and round ends. */
static void test_fitted_lines(void) {
    static const iso_point square[] = {{0, 7}, {99999, 7}, {99999, 90007}, {0, 90007}};
    static const iso_point tent[] = {{0, 0}, {200000, 0}, {100000, 90000}};
    static const iso_point drop[] = {{0, 0}, {-100000, 90000}, {-200000, 0}, {-100000, -1000}};
    double place[64];
    iso_region region = {0};
    add_points(&region, square, 4, -1);
    CHECK_EQUAL(10, line_places(place, &region, 9800)); /* 9.18 gaps */
    for (int i = 0; i < 10; i++)
        CHECK_NEAR(7 - 4900 + (i + 0.5) * 9980, place[i], 2.5);
    drop_region(&region);
    add_points(&region, tent, 3, -1);
    CHECK_EQUAL(10, line_places(place, &region, 9800));
    for (int i = 0; i < 10; i++)
        CHECK_NEAR(i * (90000 - 94900 / 20.0) / 9, place[i], 2.5);
    drop_region(&region);
    add_points(&region, drop, 4, -1);
    CHECK_EQUAL(9, line_places(place, &region, 9800)); /* 91000 high, 9.29 gaps */
    for (int i = 0; i < 9; i++)
        CHECK_NEAR(-1000 + (i + 0.5) * 91000 / 9, place[i], 2.5);
    drop_region(&region);
    add_circle(&region, 0, 0, 5, 1000, 0.18 / 2, -1);
    CHECK_EQUAL(10, line_places(place, &region, 9800));
    for (int i = 0; i < 10; i++)
        CHECK_NEAR(-50000 + (i + 0.5) * 10000, place[i], 2.5);
    drop_region(&region);
}

/* A disc's chords: unlinked lines at the places asked for, each as long as it must be. */
static void test_lines_of_a_disc(void) {
    iso_arena scratch = {0};
    iso_region region = {0};
    add_circle(&region, 3, -2, 40, 20000, 0, -1);
    for (int k = 0; k < 24; k++) {
        double angle = 7.5 * k, s = sin(angle * pi / 180), c = cos(angle * pi / 180);
        iso_paths paths = {0};
        iso_fill_options options = bare_options(7777.75, angle, 0);
        options.phase = 1234.5;
        options.link_max = 0;
        CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
        double middle = -3e4 * s - 2e4 * c;
        CHECK_NEAR(80e4 / options.spacing, paths.count, 1);
        for (int i = 0; i < paths.count; i++) {
            const iso_path_vertex *end = paths.vertex + paths.path[i].first;
            CHECK_EQUAL(2, paths.path[i].count);
            double v = end[0].at.y * c - end[0].at.x * s;
            double line = (v - options.phase) / options.spacing;
            CHECK_NEAR(0, (line - round(line)) * options.spacing, 0.8);
            double exact = round(line) * options.spacing + options.phase - middle;
            double chord = 2 * sqrt(40e4 * 40e4 - exact * exact); /* steeper near the edge */
            CHECK_NEAR(chord, bead_length(&paths, i, 0), 2 + 2 * 80e4 / chord);
        }
        iso_paths_free(&paths);
    }
    drop_region(&region);
    iso_arena_free(&scratch);
}

/* With links of any length: no travel on a square, and few elsewhere. */
static void test_few_travels(void) {
    static const int most[] = {0, 1, 10, 7, 9, 1, 3};
    iso_arena scratch = {0};
    for (int i = 0; i < shape_count; i++)
        for (int angle = 0; angle < 60; angle += 30) {
            iso_region region = {0};
            iso_paths paths = {0};
            shapes[i].make(&region, 0);
            iso_fill_options options = bare_options(4500, angle, 1);
            options.link_max = 1000000;
            options.even = 1; /* lines as wide as what is left beside them need fewer */
            CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
            CHECK(paths.count - 1 <= most[i]);
            iso_paths_free(&paths);
            drop_region(&region);
        }
    iso_arena_free(&scratch);
}

typedef struct drawn_line {
    double from, to, level; /* along the line, across it */
} drawn_line;

/* Of a fill at angle 0 and spacing 13000: its lines in the order in which they are drawn. */
static int drawn_lines(drawn_line *line, const iso_paths *paths) {
    int count = 0;
    for (int i = 0; i < paths->count; i++)
        for (int k = 0; k + 1 < paths->path[i].count; k++) {
            const iso_path_vertex *v = paths->vertex + paths->path[i].first + k;
            double level = v[0].at.y / 13000.0; /* else it is a link */
            if (fabs(level - round(level)) > 0.0002 || abs(v[0].at.y - v[1].at.y) > 1 ||
                abs(v[0].at.x - v[1].at.x) < 3000)
                continue;
            line[count++] = (drawn_line){fmin(v[0].at.x, v[1].at.x), fmax(v[0].at.x, v[1].at.x),
                                         (v[0].at.y + v[1].at.y) / 2.0};
        }
    return count;
}

/* Monotonic: no line is drawn before its neighbour below. Neighbours overlap, and what is between
 * them is inside the region. */
static void test_monotonic_order(void) {
    iso_arena scratch = {0};
    for (unsigned seed = 0; seed < (unsigned)shape_count + 30; seed++) {
        iso_region region = {0};
        iso_paths paths = {0}, zigzag = {0};
        if (seed < (unsigned)shape_count) {
            shapes[seed].make(&region, 7 * seed);
        } else {
            cells grid = cells_random(seed, 30);
            cells_region(&region, &grid, 40000, 0);
        }
        iso_fill_options options = bare_options(13000, 0, 0);
        CHECK_OK(iso_fill_rectilinear(&zigzag, &region, &options, &scratch));
        options.monotonic = 1;
        CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
        drawn_line *line = malloc(((size_t)paths.vertex_count + 1) * sizeof *line);
        drawn_line *free_line = malloc(((size_t)zigzag.vertex_count + 1) * sizeof *line);
        int count = drawn_lines(line, &paths), wrong = 0;
        CHECK_EQUAL(drawn_lines(free_line, &zigzag), count);
        CHECK(paths.count >= zigzag.count);
        for (int i = 0; i < paths.count; i++) /* so that nobody puts them in another order */
            CHECK_EQUAL(i, paths.path[i].rank);
        for (int i = 0; i < count; i++)
            for (int k = i + 1; k < count; k++) {
                double from = fmax(line[i].from, line[k].from), to = fmin(line[i].to, line[k].to);
                double below = line[i].level - line[k].level, x = (from + to) / 2;
                if (fabs(below - 13000) > 3 || to - from < 2000)
                    continue; /* the later one is not right below */
                int joined = 1;
                for (int t = 0; t <= 8; t++)
                    joined &= is_inside(&region, x, line[k].level + below * t / 8, 0);
                wrong += joined;
            }
        CHECK_EQUAL(0, wrong);
        free(line);
        free(free_line);
        iso_paths_free(&paths);
        iso_paths_free(&zigzag);
        drop_region(&region);
    }
    iso_arena_free(&scratch);
}

static void test_links_are_no_longer_than_allowed(void) {
    iso_arena scratch = {0};
    iso_region region = {0};
    shapes[3].make(&region, 0);
    for (int link = 0; link < 40000; link += 4300) {
        iso_paths paths = {0};
        iso_fill_options options = bare_options(4500, 12, 0);
        options.link_max = link;
        options.like =
            (iso_path){.closed = 1, .role = 3, .tool = 2, .object = 5, .group = 6, .rank = 7};
        CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
        double c = cos(12 * pi / 180), s = sin(12 * pi / 180);
        for (int i = 0; i < paths.count; i++) {
            double since = 0; /* along the boundary: from where the line is left */
            for (int k = 0; k + 1 < paths.path[i].count; k++) {
                iso_point a = paths.vertex[paths.path[i].first + k].at;
                iso_point b = paths.vertex[paths.path[i].first + k + 1].at;
                double across = fabs((b.y - a.y) * c - (b.x - a.x) * s);
                since = across < 1.5 && bead_length(&paths, i, k) > 50
                            ? 0
                            : since + bead_length(&paths, i, k);
                CHECK(since <= link + 60);
            }
            const iso_path *path = &paths.path[i];
            CHECK(!path->closed && path->role == 3 && path->tool == 2 && path->object == 5 &&
                  path->group == 6 && path->rank == 7);
        }
        iso_paths_free(&paths);
    }
    drop_region(&region);
    iso_arena_free(&scratch);
}

/* Lines 5 mm apart that no link may join: each end runs on along the wall, and keeps a bead's width
 * from what comes the other way. */
static void test_anchors(void) {
    static const iso_point corner[] = {{0, 0}, {400000, 0}, {400000, 215000}, {0, 215000}};
    iso_arena scratch = {0};
    for (int anchor = 0; anchor <= 40000; anchor += 5000) {
        iso_region region = {0};
        iso_paths paths = {0};
        add_points(&region, corner, 4, -1);
        iso_fill_options options = bare_options(50000, 0, 0);
        options.phase = 7000;
        options.link_max = 30000;
        options.anchor = anchor;
        CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
        CHECK_EQUAL(5, paths.count);
        double hooks = 0, low[10], high[10];
        int left = 0;
        for (int i = 0; i < paths.count; i++)
            for (int k = 0; k + 1 < paths.path[i].count; k++) {
                iso_point a = paths.vertex[paths.path[i].first + k].at;
                iso_point b = paths.vertex[paths.path[i].first + k + 1].at;
                hooks += bead_length(&paths, i, k);
                if (a.x > 1 || b.x > 1)
                    continue;
                low[left] = fmin(a.y, b.y);
                high[left++] = fmax(a.y, b.y);
            }
        hooks -= 5 * 400000;
        if (anchor <= 20000)
            CHECK_NEAR(10 * anchor, hooks, 20);
        else
            CHECK(hooks > 10 * 20000 && hooks < 10 * fmin(anchor, 30000) + 20);
        for (int i = 0; i < left; i++)
            for (int k = 0; k < left; k++)
                CHECK(i == k || high[i] <= low[k] - 4490 || low[i] >= high[k] + 4490);
        iso_paths_free(&paths);
        drop_region(&region);
    }
    iso_arena_free(&scratch);
}

/* The same contours, begun elsewhere, are the same region and give the same paths. */
static void test_starts_of_contours_do_not_matter(void) {
    iso_arena scratch = {0};
    for (unsigned seed = 0; seed < 40; seed++) {
        iso_region region = {0}, shifted = {0};
        iso_paths paths = {0}, again = {0};
        if (seed < 28) {
            cells grid = cells_random(seed, 60);
            cells_region(&region, &grid, 30000, 7000);
        } else {
            shapes[seed % shape_count].make(&region, seed);
        }
        for (int i = 0; i < region.count; i++) {
            int from = region.first[i], count = region.first[i + 1] - from;
            iso_point *point = malloc((size_t)count * sizeof *point);
            for (int k = 0; k < count; k++)
                point[k] = region.point[from + (k + 3 + (int)seed) % count];
            add_points(&shifted, point, count, region.parent[i]);
            free(point);
        }
        iso_fill_options options = bare_options(5000, seed * 15, seed % 2);
        CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
        CHECK_OK(iso_fill_rectilinear(&again, &shifted, &options, &scratch));
        CHECK_EQUAL(paths.vertex_count, again.vertex_count);
        CHECK_EQUAL(paths.count, again.count);
        CHECK(paths.vertex_count == again.vertex_count &&
              memcmp(paths.vertex, again.vertex,
                     (size_t)paths.vertex_count * sizeof *paths.vertex) == 0);
        iso_paths_free(&paths);
        iso_paths_free(&again);
        drop_region(&region);
        drop_region(&shifted);
    }
    iso_arena_free(&scratch);
}

/* All that a fill can be asked for at once, on regions that branch, pinch and have holes: beads
 * have a size, and middles stay within reach of the region. */
static void test_options_together(void) {
    iso_arena scratch = {0};
    for (unsigned seed = 0; seed < 160; seed++) {
        iso_region region = {0};
        iso_paths paths = {0};
        if (seed % 5) {
            cells grid = cells_random(seed + 77, 50);
            cells_region(&region, &grid, seed % 3 ? 9000 : 2500, seed % 2 ? 900 : 0);
        } else {
            shapes[seed / 5 % (unsigned)shape_count].make(&region, seed);
        }
        iso_fill_options options = bare_options(seed % 7 ? 4070 : 1900, seed * 11.25, seed % 4 > 0);
        options.margin = (int32_t)(options.spacing * (seed % 6) / 10) - 400;
        options.even = seed % 13 == 0;
        options.monotonic = seed % 3 == 1;
        options.anchor = seed % 4 == 0 || seed % 11 == 0 ? 9000 : 0;
        options.link_max = seed % 10 ? (int32_t)(seed % 9) * 3000 : 1000000;
        options.deviation = seed % 8 * 20;
        CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
        double reach = 2 * fmax(options.margin, 0) + options.deviation + 2;
        int outside = 0, sizeless = 0;
        for (int i = 0; i < paths.vertex_count; i++) {
            const iso_path_vertex *v = &paths.vertex[i];
            outside += !is_inside(&region, v->at.x, v->at.y, reach);
            sizeless += v->width < 100 || v->area < 100000;
        }
        CHECK_EQUAL(0, outside);
        CHECK_EQUAL(0, sizeless);
        iso_paths_free(&paths);
        drop_region(&region);
    }
    iso_arena_free(&scratch);
}

static void test_little_regions(void) {
    static const iso_point line[] = {{0, 0}, {5000, 0}}, speck[] = {{7, 7}, {8, 7}, {7, 8}};
    iso_arena scratch = {0};
    iso_region region = {0};
    iso_paths paths = {0};
    iso_fill_options options = iso_fill_defaults(iso_bead_of(4500, 2000), 1);
    CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
    add_points(&region, line, 2, -1);
    add_points(&region, line, 1, -1);
    add_points(&region, line, 0, -1);
    add_points(&region, speck, 3, -1);
    CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
    CHECK_EQUAL(0, paths.count); /* a speck is shorter than half a bead */
    options.fit = 0;
    CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
    CHECK_EQUAL(0, paths.count);
    options.fit = 1;
    options.shortest = 0;
    options.angle = 90;
    CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
    CHECK(paths.count <= 2);
    static const iso_point back[] = {{5000, 0}, {0, 0}}; /* up and down on one line: no area */
    add_points(&region, back, 2, -1);
    CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
    drop_region(&region);
    iso_paths_free(&paths);
    iso_arena_free(&scratch);
}

static void test_refusals(void) {
    static const iso_point clockwise[] = {{0, 0}, {0, 90000}, {90000, 90000}, {90000, 0}};
    iso_arena scratch = {0};
    iso_region region = {0};
    iso_paths paths = {0};
    shapes[0].make(&region, 0);
    iso_fill_options good = iso_fill_defaults(iso_bead_of(4500, 2000), 0.2), options = good;
    CHECK_NEAR(5.0 * iso_bead_of(4500, 2000).spacing, good.spacing, 1e-9);
    CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, &scratch));
    int count = paths.count, vertices = paths.vertex_count;
    CHECK(count > 0);
    iso_paths_clear(&paths);
    CHECK_OK(iso_fill_rectilinear(&paths, &region, &options, NULL)); /* with scratch of its own */
    CHECK_EQUAL(count, paths.count);
    CHECK_EQUAL(vertices, paths.vertex_count);
    iso_filling_link link;
    CHECK_OK(iso_fill_to_link(&link, &region, &options, NULL));
    iso_multilink_free(&link.link);
    static const double spacings[] = {0, -1, 99, NAN, INFINITY, 1e9};
    for (int i = 0; i < 6; i++) {
        options.spacing = spacings[i];
        CHECK_STATUS(ISO_USAGE, iso_fill_rectilinear(&paths, &region, &options, &scratch));
    }
    options = good;
    options.angle = NAN;
    CHECK_STATUS(ISO_USAGE, iso_fill_rectilinear(&paths, &region, &options, &scratch));
    options = good;
    options.phase = -INFINITY;
    CHECK_STATUS(ISO_USAGE, iso_fill_rectilinear(&paths, &region, &options, &scratch));
    options = good;
    options.area = -1;
    CHECK_STATUS(ISO_USAGE, iso_fill_rectilinear(&paths, &region, &options, &scratch));
    add_points(&region, clockwise, 4, -1);
    CHECK_STATUS(ISO_USAGE, iso_fill_rectilinear(&paths, &region, &good, &scratch));
    CHECK(strstr(iso_error_message(), "contour 1"));
    CHECK_EQUAL(count, paths.count); /* the first contour's paths are gone again */
    CHECK_EQUAL(vertices, paths.vertex_count);
    drop_region(&region);
    iso_paths_free(&paths);
    iso_arena_free(&scratch);
}

static void test_failing_allocations(void) {
    iso_region region = {0};
    shapes[6].make(&region, 0);
    iso_fill_options options = iso_fill_defaults(iso_bead_of(4500, 2000), 1);
    int failed = 0;
    for (int n = 0; n < 100; n++) {
        iso_arena scratch = {0};
        iso_paths paths = {0};
        iso_fail_allocation_after(n);
        iso_status status = iso_fill_rectilinear(&paths, &region, &options, &scratch);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || (status == ISO_NO_MEMORY && paths.count == 0));
        iso_paths_free(&paths);
        iso_arena_free(&scratch);
        if (status == ISO_OK)
            break;
        failed++;
    }
    CHECK(failed > 3 && failed < 100);
    drop_region(&region);
}

int main(void) {
    RUN(test_every_segment_once_links_on_the_boundary);
    RUN(test_beads_stay_inside);
    RUN(test_volume);
    RUN(test_volume_of_strips_of_any_width);
    RUN(test_fitted_lines);
    RUN(test_lines_of_a_disc);
    RUN(test_few_travels);
    RUN(test_monotonic_order);
    RUN(test_links_are_no_longer_than_allowed);
    RUN(test_anchors);
    RUN(test_starts_of_contours_do_not_matter);
    RUN(test_options_together);
    RUN(test_little_regions);
    RUN(test_refusals);
    RUN(test_failing_allocations);
    return check_verdict();
}
