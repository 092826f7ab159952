/* Lattices of two materials: which cell is of which, and what becomes of paths. */
#include "check.h"

#include <stdlib.h>

#include "base/memory.h"
#include "lattice/material.h"
#include "lattice/tools.h"
#include "part.h"

#define MM ISO_UNITS_PER_MM

static iso_mesh box; /* 30 by 30 by 20, its floor's middle at the origin */
static iso_arena arena;
static iso_planar_scratch *planar;

static uint64_t seed = 5;
static double random_share(void) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 33) / 2147483648.0;
}

static iso_lattice *make(const char *cell, const char *material, int32_t map) {
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = NULL;
    options.cell = cell;
    options.material = material;
    options.density = "30";
    options.map = map;
    CHECK_OK(lattice_new(&lattice, &options, &box, 1));
    return lattice;
}

static int tool_of(const iso_lattice *lattice, double x, double y, double z) {
    uint8_t tool = 9;
    iso_vec3 at = {x, y, z};
    lattice_tools(&tool, lattice, &at, 1);
    CHECK(tool < 2);
    return tool;
}

/* ---- thresholds ---- */

/* Each line of cells goes through all thresholds, and blocks of a few have them spread. */
static void test_thresholds(void) {
    for (int axis = 0; axis < 3; axis++) {
        char seen[512] = {0};
        int different = 0;
        for (int32_t i = -256; i < 256; i++) {
            int32_t at[3] = {17, -5, 8};
            at[axis] = i;
            double t = material_threshold(at[0], at[1], at[2]);
            CHECK(t > 0 && t < 1);
            int k = (int)floor(t * 512);
            different += !seen[k];
            seen[k] = 1;
        }
        CHECK_EQUAL(512, different);
    }
    double worst = 0;
    for (int n = 0; n < 3000; n++) {
        int32_t u = (int32_t)(1000 * random_share()) - 500, v = (int32_t)(1000 * random_share());
        int32_t w = (int32_t)(1000 * random_share()) - 700, below = 0;
        double share = random_share();
        for (int k = 0; k < 64; k++)
            below += material_threshold(u + k % 4, v + k / 4 % 4, w + k / 16) < share;
        worst = fmax(worst, fabs(below / 64.0 - share));
    }
    CHECK(worst < 0.07); /* chance alone: 0.25 */
}

/* ---- cells ---- */

/* All of a cell is of one material, and that of its middle. */
static void test_whole_cells(void) {
    iso_lattice *lattice = make("2.5", "50+3*x+y*(z-8)/4", ISO_LATTICE_MAP_XYZ);
    for (int n = 0; n < 4000; n++) {
        double c[3], p[3];
        for (int k = 0; k < 3; k++) {
            double cells = k == 2 ? 8 : 12;
            c[k] = floor(cells * random_share()) - (k == 2 ? 0 : 6);
            p[k] = 2.5 * (c[k] + 0.001 + 0.998 * random_share());
        }
        double x = 2.5 * (c[0] + 0.5), y = 2.5 * (c[1] + 0.5), z = 2.5 * (c[2] + 0.5);
        double share = (50 + 3 * x + y * (z - 8) / 4) / 100;
        int expected = share > material_threshold((int32_t)c[0], (int32_t)c[1], (int32_t)c[2]);
        CHECK_EQUAL(expected, tool_of(lattice, p[0], p[1], p[2]));
    }
    lattice_free(lattice);
}

/* Of random places in a box around a middle. */
static double measured(const iso_lattice *lattice, iso_vec3 middle, double side) {
    enum { PLACES = 2000 };
    static iso_vec3 at[PLACES];
    static uint8_t tool[PLACES];
    int second = 0;
    for (int i = 0; i < PLACES; i++)
        at[i] = (iso_vec3){middle.x + side * (random_share() - 0.5),
                           middle.y + side * (random_share() - 0.5),
                           middle.z + side * (random_share() - 0.5)};
    lattice_tools(tool, lattice, at, PLACES);
    for (int i = 0; i < PLACES; i++)
        second += tool[i];
    return (double)second / PLACES;
}

/* In 5 mm windows that cells of 1.25 mm fill. */
static void test_share_is_followed(void) {
    iso_lattice *lattice = make("1.25", "50+3*x", ISO_LATTICE_MAP_XYZ);
    double sum = 0, worst = 0;
    int count = 0;
    for (double x = -12.5; x < 15; x += 5)
        for (double y = -12.5; y < 15; y += 5)
            for (double z = 2.5; z < 20; z += 5, count++) {
                double off = measured(lattice, (iso_vec3){x, y, z}, 5) - (50 + 3 * x) / 100;
                sum += off;
                worst = fmax(worst, fabs(off));
            }
    CHECK_NEAR(0, sum / count, 0.005);
    CHECK(worst < 0.06);
    lattice_free(lattice);
}

/* Cells that aren't cubes have the share of their mean. */
static void test_bent_cells(void) {
    static const struct {
        const char *cell, *material;
        int32_t map;
    } of[] = {{"2", "30", ISO_LATTICE_MAP_CYLINDER},
              {"2", "30", ISO_LATTICE_MAP_SPHERE},
              {"1.5+z/20", "30", ISO_LATTICE_MAP_XYZ},
              {"1.5+r/20", "10+2*z", ISO_LATTICE_MAP_XYZ}};
    for (int k = 0; k < 4; k++) {
        iso_lattice *lattice = make(of[k].cell, of[k].material, of[k].map);
        CHECK_NEAR(0.3, measured(lattice, (iso_vec3){0, 0, 10}, 20), 0.035);
        lattice_free(lattice);
    }
    iso_lattice *lattice = make("2", "5*z", ISO_LATTICE_MAP_CYLINDER);
    CHECK_NEAR(0.25, measured(lattice, (iso_vec3){0, 0, 5}, 8), 0.06);
    CHECK_NEAR(0.75, measured(lattice, (iso_vec3){0, 0, 15}, 8), 0.06);
    lattice_free(lattice);
}

/* None and all; and without the option there is nothing. */
static void test_extremes(void) {
    static const char *const text[] = {"0", "-7", "100", "250", "0/0", ""};
    static const int expected[] = {0, 0, 1, 1, -1, -2};
    for (int k = 0; k < 6; k++) {
        iso_lattice_options options = iso_lattice_defaults();
        iso_lattice *lattice = NULL;
        options.material = text[k];
        iso_status status = lattice_new(&lattice, &options, &box, 1);
        CHECK_STATUS(expected[k] == -1 ? ISO_BAD_CONFIG : ISO_OK, status);
        if (status == ISO_OK) {
            CHECK((lattice_material(lattice) != NULL) == (expected[k] >= 0));
            for (int n = 0; n < 200; n++)
                CHECK_EQUAL(expected[k] > 0,
                            tool_of(lattice, 30 * random_share() - 15, 30 * random_share() - 15,
                                    20 * random_share()));
        }
        lattice_free(lattice);
    }
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = NULL;
    options.material = "50+q";
    CHECK_STATUS(ISO_BAD_CONFIG, lattice_new(&lattice, &options, &box, 1));
    CHECK(strstr(iso_error_message(), "lattice_material"));
}

/* The paper's n-cube-link: every equation holds, and each cell is solid for one material alone. */
static void test_link(void) {
    iso_lattice *lattice = make("2.5", "50+3*x", ISO_LATTICE_MAP_XYZ);
    const iso_material *material = lattice_material(lattice);
    iso_cube_link link;
    if (!CHECK_OK(material_link(&link, material)))
        return;
    CHECK_OK(iso_multilink_validate(&link.link));
    CHECK_EQUAL(ISO_KIND_CUBE_LINK, link.link.kind);
    CHECK_EQUAL(4, link.link.map_count);
    int32_t cells = link.link.size / 2, n0 = material->length[0], n1 = material->length[1];
    CHECK_EQUAL((int64_t)n0 * n1 * material->length[2], cells);
    for (int32_t a = 0; a < cells; a++) {
        int32_t first = iso_map_at(&link.link.projection[0], a);
        int32_t other = iso_map_at(&link.link.map[3], a); /* a step along the material axis */
        int32_t second = iso_map_at(&link.link.projection[0], other);
        double at[3] = {a % n0, a / n0 % n1, a / (n0 * n1)};
        for (int k = 0; k < 3; k++)
            at[k] = 2.5 * (at[k] + material->first[k] + 0.5);
        int tool = tool_of(lattice, at[0], at[1], at[2]);
        CHECK(first == (tool == 0 ? 1 : 0) && second == (tool == 1 ? 2 : 0));
    }
    iso_multilink_free(&link.link);
    lattice_free(lattice);
}

/* ---- paths ---- */

static double volume_of(const iso_paths *paths, int tool) { /* units^3; tool -1: all */
    double sum = 0;
    for (int32_t p = 0; p < paths->count; p++) {
        const iso_path *path = &paths->path[p];
        const iso_path_vertex *v = paths->vertex + path->first;
        for (int32_t i = 0; i + !path->closed < path->count; i++) {
            const iso_path_vertex *to = &v[i + 1 < path->count ? i + 1 : 0];
            if (tool < 0 || path->tool == tool)
                sum += hypot(to->at.x - v[i].at.x, to->at.y - v[i].at.y) * v[i].area;
        }
    }
    return sum;
}

static double length_of(const iso_paths *paths, const iso_path *path) {
    const iso_path_vertex *v = paths->vertex + path->first;
    double sum = 0;
    for (int32_t i = 0; i + !path->closed < path->count; i++) {
        const iso_path_vertex *to = &v[i + 1 < path->count ? i + 1 : 0];
        sum += hypot(to->at.x - v[i].at.x, to->at.y - v[i].at.y);
    }
    return sum;
}

/* Wandering about in the part, widths changing; some closed, some short, some with doubled points.
 */
static void wander(iso_paths *paths, int count) {
    for (int n = 0; n < count; n++) {
        iso_point point[40];
        int32_t vertices = 2 + (int32_t)(38 * random_share());
        double reach = n % 3 ? 3 : 30;
        double x = 24 * random_share() - 12, y = 24 * random_share() - 12;
        for (int32_t i = 0; i < vertices; i++) {
            if (i == 0 || random_share() > 0.1) { /* else twice the same */
                x = fmin(14, fmax(-14, x + reach * (random_share() - 0.5)));
                y = fmin(14, fmax(-14, y + reach * (random_share() - 0.5)));
            }
            point[i] = (iso_point){iso_units(x), iso_units(y)};
        }
        iso_path like = {.role = ISO_ROLE_INTERNAL_INFILL, .closed = n % 4 == 1, .group = n};
        like.follows = n % 5 == 2;
        CHECK_OK(iso_paths_add(paths, &like, point, vertices, 4500, 1000));
        iso_path_vertex *v = paths->vertex + paths->vertex_count - vertices;
        for (int32_t i = 0; i < vertices; i++) {
            v[i].width = 3000 + (int32_t)(3000 * random_share());
            v[i].area = 500 + (int32_t)(1000 * random_share());
        }
    }
}

/* The pieces of a path run from its beginning to its end, one where the other ended, on tools in
 * turn; none is shorter than a bead is wide. */
static void check_pieces(const iso_paths *was, const iso_paths *is) {
    int32_t p = 0, cut = 0;
    for (int32_t w = 0; w < was->count; w++) {
        const iso_path *old = &was->path[w], *first = &is->path[p];
        const iso_path_vertex *from = was->vertex + old->first;
        double sum = 0;
        int32_t pieces = 0;
        iso_point end = {0, 0};
        for (; p < is->count && is->path[p].group == old->group; p++, pieces++) {
            const iso_path *path = &is->path[p];
            const iso_path_vertex *v = is->vertex + path->first;
            double length = length_of(is, path);
            CHECK(path->count >= 2 && path->role == old->role);
            CHECK(pieces == 0 || (v->at.x == end.x && v->at.y == end.y && !path->follows));
            CHECK(pieces == 0 || path->tool != is->path[p - 1].tool);
            CHECK(path == first || first->closed == 0);
            CHECK(length >= from->width * 0.99 || length_of(was, old) < 1.01 * from->width ||
                  pieces == 0);
            end = v[path->count - 1].at;
            sum += length;
        }
        CHECK(pieces > 0);
        CHECK_NEAR(length_of(was, old), sum, 3.0 * pieces + 1e-6 * sum);
        CHECK(!first->follows ||
              (old->follows && first > is->path && first[-1].tool == first->tool));
        if (pieces == 1) {
            CHECK_EQUAL(old->closed, first->closed);
            CHECK_EQUAL(old->count, first->count);
            continue;
        }
        cut++;
        iso_point begin = is->vertex[first->first].at, last = from[old->count - 1].at;
        if (old->closed)
            CHECK(begin.x == end.x && begin.y == end.y);
        else
            CHECK(begin.x == from->at.x && begin.y == from->at.y && end.x == last.x &&
                  end.y == last.y);
    }
    CHECK_EQUAL(is->count, p);
    CHECK(cut > was->count / 5);
}

/* Middles of long straight beads lie in cells of their path's tool. */
static double share_in_wrong_cells(const iso_paths *paths, const iso_lattice_slice *slice) {
    double wrong = 0, all = 0;
    for (int32_t p = 0; p < paths->count; p++)
        for (int32_t i = 0; i + !paths->path[p].closed < paths->path[p].count; i++) {
            const iso_path *path = &paths->path[p];
            iso_point a = paths->vertex[path->first + i].at;
            iso_point b = paths->vertex[path->first + (i + 1) % path->count].at;
            double length = hypot(b.x - a.x, b.y - a.y);
            for (double at = 100; at < length; at += 700) {
                double x = a.x + (b.x - a.x) * at / length - slice->shift.x;
                double y = a.y + (b.y - a.y) * at / length - slice->shift.y;
                wrong += tool_of(slice->lattice, x / MM, y / MM, slice->z) != path->tool;
                all++;
            }
        }
    return wrong / all;
}

static void test_paths_are_cut(void) {
    iso_lattice *lattice = make("2.5", "50+2*x", ISO_LATTICE_MAP_XYZ);
    iso_lattice_slice slice = {.lattice = lattice, .z = 7.2, .shift = {4321, -1234}};
    for (int before = 0; before < 2; before++) {
        iso_paths was = {0}, is = {0}, head = {0};
        wander(&was, 400);
        if (before)
            wander(&head, 7);
        CHECK_OK(iso_paths_append(&is, &head, (iso_point){0, 0}, 0));
        CHECK_OK(iso_paths_append(&is, &was, (iso_point){0, 0}, 0));
        CHECK_OK(tools_choose(&is, head.count, head.vertex_count, &slice, &arena));
        for (int32_t p = 0; p < head.count; p++)
            CHECK(is.path[p].first == head.path[p].first && is.path[p].tool == 0);
        if (before)
            CHECK(!memcmp(is.vertex, head.vertex, sizeof *is.vertex * (size_t)head.vertex_count));
        iso_paths tail = is;
        tail.path += head.count;
        tail.count -= head.count;
        check_pieces(&was, &tail);
        double volume = volume_of(&was, -1);
        CHECK_NEAR(volume, volume_of(&tail, -1), 1e-5 * volume);
        CHECK(share_in_wrong_cells(&tail, &slice) < 0.02); /* what is too short to be cut */
        CHECK(volume_of(&tail, 0) > 0.3 * volume && volume_of(&tail, 1) > 0.3 * volume);
        iso_paths_free(&was);
        iso_paths_free(&head);
        iso_paths_free(&is);
    }
    lattice_free(lattice);
}

static iso_fill_options fill_of(double width) {
    return iso_fill_defaults(iso_bead_of(iso_units(width), iso_units(0.2)), 0.3);
}

static void add_square(iso_region *region, double half) {
    int32_t h = iso_units(half);
    iso_point corner[4] = {{-h, -h}, {h, -h}, {h, h}, {-h, h}};
    CHECK_OK(iso_region_add(region, corner, 4));
    region->parent[0] = -1;
}

/* The same beads as without, and the second material's share of them. */
static void test_layers(void) {
    static const int32_t pattern[] = {ISO_LATTICE_GYROID_SHEET, ISO_LATTICE_OCTET_STRUTS,
                                      ISO_LATTICE_PRIMITIVE_SOLID, ISO_LATTICE_FOAM_SHEET};
    iso_region region = {0};
    add_square(&region, 8);
    for (int k = 0; k < 4; k++) {
        iso_lattice_options options = iso_lattice_defaults();
        iso_lattice *one = NULL, *two = NULL;
        iso_fill_options fill = fill_of(0.4);
        double all = 0, of[2] = {0, 0};
        options.pattern = pattern[k];
        options.cell = "2.5";
        options.density = "30";
        CHECK_OK(lattice_new(&one, &options, &box, 1));
        options.material = "40";
        CHECK_OK(lattice_new(&two, &options, &box, 1));
        fill.link_max = 5 * MM;
        for (double z = 0.6; z < 19; z += 2.9) {
            iso_paths plain = {0}, coloured = {0};
            iso_lattice_slice slice = {.lattice = one, .z = z};
            CHECK_OK(lattice_fill(&plain, &region, &slice, &fill, &arena, planar));
            slice.lattice = two;
            CHECK_OK(lattice_fill(&coloured, &region, &slice, &fill, &arena, planar));
            double volume = volume_of(&plain, -1);
            CHECK_NEAR(volume, volume_of(&coloured, -1), 1e-4 * volume);
            CHECK(volume_of(&plain, 1) == 0);
            all += volume;
            of[0] += volume_of(&coloured, 0);
            of[1] += volume_of(&coloured, 1);
            iso_paths_free(&plain);
            iso_paths_free(&coloured);
        }
        CHECK_NEAR(0.4, of[1] / all, 0.03);
        CHECK_NEAR(0.6, of[0] / all, 0.03);
        lattice_free(one);
        lattice_free(two);
    }
    iso_region_free(&region);
}

/* ---- memory ---- */

static void test_memory(void) {
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = NULL;
    options.material = "50";
    options.cell = "3+z/20";
    iso_status status = ISO_NO_MEMORY;
    for (int64_t n = 0; status == ISO_NO_MEMORY && n < 2000; n++) {
        iso_fail_allocation_after(n);
        status = lattice_new(&lattice, &options, &box, 1);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || lattice == NULL);
    }
    CHECK_OK(status);
    iso_paths was = {0};
    wander(&was, 40);
    iso_lattice_slice slice = {.lattice = lattice, .z = 7};
    status = ISO_NO_MEMORY;
    int64_t n = 0;
    for (; status == ISO_NO_MEMORY && n < 2000; n++) {
        iso_arena own = {0};
        iso_paths is = {0};
        CHECK_OK(iso_paths_append(&is, &was, (iso_point){0, 0}, 0));
        iso_fail_allocation_after(n);
        status = tools_choose(&is, 0, 0, &slice, &own);
        iso_fail_allocation_after(-1);
        iso_paths_free(&is);
        iso_arena_free(&own);
    }
    CHECK_OK(status);
    CHECK(n > 1);
    iso_paths_free(&was);
    lattice_free(lattice);
}

/* More cells than there is room for are refused, not counted wrong. */
static void test_too_many_cells(void) {
    iso_mesh large;
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = NULL;
    CHECK_OK(part_box(&large, (double[3]){300, 300, 300}, (double[3]){0, 0, 0}));
    options.cell = "0.5";
    options.material = "50";
    CHECK_STATUS(ISO_BAD_CONFIG, lattice_new(&lattice, &options, &large, 1));
    CHECK(strstr(iso_error_message(), "lattice_material"));
    iso_mesh_free(&large);
}

int main(void) {
    CHECK_OK(part_box(&box, (double[3]){30, 30, 20}, (double[3]){-15, -15, 0}));
    CHECK_OK(iso_planar_scratch_new(&planar));
    RUN(test_thresholds);
    RUN(test_whole_cells);
    RUN(test_share_is_followed);
    RUN(test_bent_cells);
    RUN(test_extremes);
    RUN(test_link);
    RUN(test_paths_are_cut);
    RUN(test_layers);
    RUN(test_memory);
    RUN(test_too_many_cells);
    iso_planar_scratch_free(planar);
    iso_arena_free(&arena);
    iso_mesh_free(&box);
    return check_verdict();
}
