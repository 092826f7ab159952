#include <isoslice/shell.h>

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"

static iso_planar_scratch *scratch;

enum { MM = ISO_UNITS_PER_MM };

/* ---- outlines ---- */

static void add_box(iso_region *region, double x0, double y0, double x1, double y1, int hole) {
    iso_point a = {iso_units(x0), iso_units(y0)}, c = {iso_units(x1), iso_units(y1)};
    iso_point box[2][4] = {{a, {c.x, a.y}, c, {a.x, c.y}}, {a, {a.x, c.y}, c, {c.x, a.y}}};
    CHECK_OK(iso_region_add(region, box[hole], 4));
    region->parent[region->count - 1] = hole ? 0 : -1;
}

static iso_region square(double half) {
    iso_region region = {0};
    add_box(&region, -half, -half, half, half, 0);
    return region;
}

static double area_of(const iso_region *region) {
    return (double)iso_region_double_area(region) / 2 / MM / MM;
}

/* ---- a place, by the tests' own means ---- */

/* Winding number of a point that lies on no edge. */
static int winding_at(const iso_region *region, double x, double y) {
    int winding = 0;
    for (int32_t c = 0; c < region->count; c++)
        for (int32_t i = region->first[c]; i < region->first[c + 1]; i++) {
            iso_point a = region->point[i];
            iso_point b = region->point[i + 1 < region->first[c + 1] ? i + 1 : region->first[c]];
            int up = a.y <= y && b.y > y, down = a.y > y && b.y <= y;
            double side = ((double)b.x - a.x) * (y - a.y) - ((double)b.y - a.y) * (x - a.x);
            winding += (up && side > 0) - (down && side < 0);
        }
    return winding;
}

static double distance_to(const iso_region *region, double x, double y) {
    double least = 1e18;
    for (int32_t c = 0; c < region->count; c++)
        for (int32_t i = region->first[c]; i < region->first[c + 1]; i++) {
            iso_point a = region->point[i];
            iso_point b = region->point[i + 1 < region->first[c + 1] ? i + 1 : region->first[c]];
            double ux = (double)b.x - a.x, uy = (double)b.y - a.y, vx = x - a.x, vy = y - a.y;
            double t = fmin(1, fmax(0, (ux * vx + uy * vy) / (ux * ux + uy * uy)));
            least = fmin(least, hypot(vx - t * ux, vy - t * uy));
        }
    return least;
}

/* The layers around the fill, nearest first; those beyond the last one are missing. */
typedef struct stack {
    const iso_region *const *above; /* [above_count], at most `top` */
    const iso_region *const *below; /* [below_count], at most `bottom` */
    int32_t above_count, below_count;
    int32_t top, bottom;   /* layers that the shells count */
    const iso_region *own; /* the layer's outline; NULL: its fill, no less */
} stack;

typedef struct place {
    int in_fill, next, above, below; /* held by the layer right above; by all of each side */
    double distance;                 /* to the nearest edge of all */
} place;

static place place_at(const iso_region *fill, const stack *around, double x, double y) {
    place p = {winding_at(fill, x, y) > 0, around->above_count > 0,
               around->above_count >= around->top, around->below_count >= around->bottom,
               distance_to(fill, x, y)};
    for (int32_t i = 0; i < around->above_count; i++) {
        int held = winding_at(around->above[i], x, y) > 0;
        p.next = p.next && (i > 0 || held);
        p.above = p.above && held;
        p.distance = fmin(p.distance, distance_to(around->above[i], x, y));
    }
    for (int32_t i = 0; i < around->below_count; i++) {
        p.below = p.below && winding_at(around->below[i], x, y) > 0;
        p.distance = fmin(p.distance, distance_to(around->below[i], x, y));
    }
    return p;
}

/* Each place of the fill lies in one of the three, the right one unless an edge is too near. */
static void check_places(const iso_shell *shell, const iso_region *fill, const stack *around,
                         const iso_shell_options *options, double half) {
    int32_t wrong[4] = {0}, looked_at = 0;
    double narrow = options->narrowest / 2 + 3, reach = 2.0 * (narrow + options->anchor) + 3;
    for (double x = -half + 0.0371; x < half; x += half / 31)
        for (double y = -half + 0.0293; y < half; y += half / 31) {
            double u = floor(x * MM) + 0.5, v = floor(y * MM) + 0.5;
            if (distance_to(&shell->top, u, v) < 3 || distance_to(&shell->solid, u, v) < 3)
                continue;
            place p = place_at(fill, around, u, v);
            if (p.distance < 3)
                continue;
            int top = winding_at(&shell->top, u, v), solid = winding_at(&shell->solid, u, v);
            int sparse = winding_at(&shell->sparse, u, v);
            int is_top = p.in_fill && around->top > 0 && !p.next;
            int shelled = p.in_fill && ((around->top > 0 && (!p.next || !p.above)) ||
                                        (around->bottom > 0 && !p.below));
            looked_at++;
            wrong[0] += top < 0 || solid < 0 || sparse < 0 || top + solid + sparse != p.in_fill;
            wrong[1] += is_top && p.distance > narrow && !top;
            wrong[2] += shelled && p.distance > narrow && sparse;
            wrong[3] += !shelled && p.distance > reach && (top || solid);
        }
    CHECK(looked_at > 100);
    for (int i = 0; i < 4; i++)
        CHECK_EQUAL(0, wrong[i]);
}

enum { LEVELS = 4, MOST = 8 };

/* Runs of layers, level by level, and the two that cover all of a side. */
typedef struct runs {
    iso_region run[LEVELS][MOST];
    iso_shell_side side;
} runs;

static void make_runs(runs *r, const iso_region *const *list, int32_t count, int32_t layers) {
    *r = (runs){.side = {.layers = layers, .missing = layers - count}};
    iso_region nothing = {0};
    for (int32_t i = 0; i < count; i++)
        CHECK_OK(iso_boolean(&r->run[0][i], ISO_UNION, list[i], &nothing, scratch));
    for (int32_t k = 1; k < LEVELS; k++)
        for (int32_t i = 0; i + (1 << k) <= count; i++)
            CHECK_OK(iso_shell_widen(&r->run[k][i], &r->run[k - 1][i],
                                     &r->run[k - 1][i + (1 << (k - 1))], scratch));
    int32_t level = iso_shell_level(layers), length = 1 << level;
    if (r->side.missing > 0 || layers == 0)
        return;
    r->side.cover[r->side.count++] = &r->run[level][0];
    if (length < layers)
        r->side.cover[r->side.count++] = &r->run[level][layers - length];
}

static void free_runs(runs *r) {
    for (int32_t k = 0; k < LEVELS; k++)
        for (int32_t i = 0; i < MOST; i++)
            iso_region_free(&r->run[k][i]);
}

/* Regions, disjoint by the kernel's word, and nothing lost but slivers along the cuts. */
static void check_parts(const iso_shell *shell, const iso_region *fill) {
    enum { PARTS = 5 };
    const iso_region *part[] = {&shell->top, &shell->solid, &shell->sparse, &shell->bridge,
                                &shell->lid};
    double sum = 0;
    iso_region common = {0};
    for (int i = 0; i < PARTS; i++) {
        CHECK_OK(iso_region_validate(part[i], scratch));
        sum += area_of(part[i]);
        CHECK_OK(iso_boolean(&common, ISO_DIFFERENCE, part[i], fill, scratch));
        CHECK_NEAR(0, area_of(&common), 0.02);
        for (int k = 0; k < i; k++) {
            CHECK_OK(iso_boolean(&common, ISO_INTERSECTION, part[i], part[k], scratch));
            CHECK_NEAR(0, area_of(&common), 0.02);
        }
    }
    CHECK_NEAR(area_of(fill), sum, 0.02);
    iso_region_free(&common);
}

static void split(iso_shell *shell, const iso_region *fill, const stack *around,
                  const iso_shell_options *options, double half) {
    runs above, below;
    make_runs(&above, around->above, around->above_count, around->top);
    make_runs(&below, around->below, around->below_count, around->bottom);
    iso_shell_neighbours neighbours = {.own = around->own ? around->own : fill,
                                       .next = around->above_count > 0 ? around->above[0] : NULL,
                                       .above = above.side,
                                       .below = below.side};
    CHECK_OK(iso_shell_split(shell, fill, &neighbours, options, scratch));
    free_runs(&above);
    free_runs(&below);
    check_parts(shell, fill);
    check_places(shell, fill, around, options, half);
}

/* ---- tests ---- */

static const iso_shell_options usual = {.narrowest = 4000, .anchor = 0};

/* Squares of half side 20, 15, 10, 5, seen from the lowest. */
static void test_stepped_pyramid(void) {
    iso_region step[] = {square(20), square(15), square(10), square(5)}, fill = square(18);
    const iso_region *above[] = {&step[1], &step[2], &step[3]};
    iso_shell shell = {0};
    for (int32_t top = 1; top <= 3; top++) {
        stack around = {.above = above, .above_count = top, .top = top};
        split(&shell, &fill, &around, &usual, 21);
        double last = 20 - 5.0 * top;
        CHECK_NEAR(36 * 36 - 30 * 30, area_of(&shell.top), 1e-3);
        CHECK_NEAR(30 * 30 - 4 * last * last, area_of(&shell.solid), 1e-3);
        CHECK_NEAR(4 * last * last, area_of(&shell.sparse), 1e-3);
    }
    iso_shell_free(&shell);
    for (int i = 0; i < 4; i++)
        iso_region_free(&step[i]);
    iso_region_free(&fill);
}

/* Upside down: the same steps are overhangs, solid but nowhere top. */
static void test_overhanging_steps(void) {
    iso_region step[] = {square(20), square(15), square(10), square(5)}, fill = square(18);
    const iso_region *below[] = {&step[1], &step[2], &step[3]};
    iso_shell shell = {0};
    for (int32_t bottom = 1; bottom <= 3; bottom++) {
        stack around = {.below = below, .below_count = bottom, .bottom = bottom};
        split(&shell, &fill, &around, &usual, 21);
        double last = 20 - 5.0 * bottom;
        CHECK_NEAR(0, area_of(&shell.top), 1e-9);
        CHECK_NEAR(36 * 36 - 4 * last * last, area_of(&shell.solid), 1e-3);
        CHECK_NEAR(4 * last * last, area_of(&shell.sparse), 1e-3);
    }
    iso_shell_free(&shell);
    for (int i = 0; i < 4; i++)
        iso_region_free(&step[i]);
    iso_region_free(&fill);
}

/* A roof steps back by 0.3 mm a layer on both slopes: strips of 0.3 mm are top, those of the next
 * two layers solid. */
static void test_roof(void) {
    iso_region step[4] = {{0}}, fill = {0};
    for (int i = 0; i < 4; i++)
        add_box(&step[i], -10 + 0.3 * i, -15, 10 - 0.3 * i, 15, 0);
    add_box(&fill, -10, -14, 10, 14, 0);
    const iso_region *above[] = {&step[1], &step[2], &step[3]};
    stack around = {.above = above, .above_count = 3, .top = 3};
    iso_shell_options options = {.narrowest = 2000};
    iso_shell shell = {0};
    split(&shell, &fill, &around, &options, 16);
    CHECK_NEAR(2 * 0.3 * 28, area_of(&shell.top), 1e-3);
    CHECK_NEAR(2 * 0.6 * 28, area_of(&shell.solid), 1e-3);
    CHECK_EQUAL(2, shell.top.count);
    CHECK_EQUAL(2, shell.solid.count);
    options.narrowest = 4000; /* 0.3 mm are too narrow for a top, 0.9 mm not for a solid strip */
    split(&shell, &fill, &around, &options, 16);
    CHECK_NEAR(0, area_of(&shell.top), 1e-9);
    CHECK_NEAR(2 * 0.9 * 28, area_of(&shell.solid), 1e-3);
    iso_shell_free(&shell);
    for (int i = 0; i < 4; i++)
        iso_region_free(&step[i]);
    iso_region_free(&fill);
}

/* Layer i of n of a cube with 3 solid layers on top and 2 at the bottom. */
static void test_cube(void) {
    enum { LAYERS = 9, TOP = 3, BOTTOM = 2 };
    iso_region outline = square(10), other = square(10), fill = square(9);
    iso_shell shell = {0};
    for (int32_t i = 0; i < LAYERS; i++) {
        const iso_region *above[TOP], *below[BOTTOM];
        stack around = {.above = above, .below = below, .top = TOP, .bottom = BOTTOM};
        for (; around.above_count < TOP && i + around.above_count + 1 < LAYERS;)
            above[around.above_count++] = i % 2 ? &outline : &other;
        for (; around.below_count < BOTTOM && i - around.below_count > 0;)
            below[around.below_count++] = i % 2 ? &other : &outline;
        split(&shell, &fill, &around, &usual, 11);
        int top = i == LAYERS - 1, solid = !top && (i >= LAYERS - TOP || i < BOTTOM);
        CHECK_NEAR(top ? 324 : 0, area_of(&shell.top), 1e-6);
        CHECK_NEAR(solid ? 324 : 0, area_of(&shell.solid), 1e-6);
        CHECK_NEAR(!top && !solid ? 324 : 0, area_of(&shell.sparse), 1e-6);
    }
    iso_shell_free(&shell);
    iso_region_free(&outline);
    iso_region_free(&other);
    iso_region_free(&fill);
}

/* One outline of three differs, in every place among the equal ones. */
static void test_one_outline_that_differs(void) {
    iso_region wide = square(10), same = square(10), less = square(6), fill = square(9);
    iso_shell shell = {0};
    for (int odd = 0; odd < 4; odd++)
        for (int side = 0; side < 2; side++) {
            const iso_region *list[4];
            for (int i = 0; i < 4; i++)
                list[i] = i == odd ? &less : i % 2 ? &wide : &same;
            stack around = {.above = list, .below = list};
            *(side ? &around.below_count : &around.above_count) = 4;
            *(side ? &around.bottom : &around.top) = 4;
            split(&shell, &fill, &around, &usual, 11);
            double top = side == 0 && odd == 0 ? 324 - 144 : 0;
            CHECK_NEAR(top, area_of(&shell.top), 1e-3);
            CHECK_NEAR(324 - 144 - top, area_of(&shell.solid), 1e-3);
            CHECK_NEAR(144, area_of(&shell.sparse), 1e-3);
            around.top += !side; /* and one is missing: nothing is covered */
            around.bottom += side;
            split(&shell, &fill, &around, &usual, 11);
            CHECK_NEAR(top, area_of(&shell.top), 1e-3);
            CHECK_NEAR(324 - top, area_of(&shell.solid), 1e-3);
            CHECK_NEAR(0, area_of(&shell.sparse), 1e-9);
        }
    iso_shell_free(&shell);
    iso_region_free(&wide);
    iso_region_free(&same);
    iso_region_free(&less);
    iso_region_free(&fill);
}

/* Holes above leave tops in their shape; an empty layer above leaves all of it. */
static void test_hole_above(void) {
    iso_region pierced = square(10), whole = square(10), empty = {0}, fill = square(9);
    add_box(&pierced, -3, -2, 4, 5, 1);
    const iso_region *above[] = {&pierced, &whole};
    stack around = {.above = above, .above_count = 2, .top = 2};
    iso_shell shell = {0};
    split(&shell, &fill, &around, &usual, 11);
    CHECK_NEAR(49, area_of(&shell.top), 1e-3);
    CHECK_NEAR(0, area_of(&shell.solid), 1e-3);
    CHECK_EQUAL(1, shell.top.count);
    above[0] = &whole;
    above[1] = &pierced;
    split(&shell, &fill, &around, &usual, 11);
    CHECK_NEAR(0, area_of(&shell.top), 1e-3);
    CHECK_NEAR(49, area_of(&shell.solid), 1e-3);
    above[0] = &empty;
    split(&shell, &fill, &around, &usual, 11);
    CHECK_NEAR(324, area_of(&shell.top), 1e-3);
    CHECK_NEAR(0, area_of(&shell.solid), 1e-9);
    iso_shell_free(&shell);
    iso_region_free(&pierced);
    iso_region_free(&whole);
    iso_region_free(&fill);
}

/* No shells, nothing split; nothing to fill, nothing left. */
static void test_none(void) {
    iso_region outline = square(10), fill = square(9), nothing = {0};
    const iso_region *list[] = {&outline};
    stack off = {0}, on = {list, list, 1, 1, 1, 1, &outline};
    iso_shell shell = {0};
    split(&shell, &fill, &off, &usual, 11);
    CHECK_NEAR(324, area_of(&shell.sparse), 1e-9);
    iso_shell_neighbours neighbours = {
        &outline, &outline, {1, 0, 1, {&outline}}, {1, 0, 1, {&outline}}, NULL};
    CHECK_OK(iso_shell_split(&shell, &nothing, &neighbours, &usual, scratch));
    CHECK(shell.top.count == 0 && shell.solid.count == 0 && shell.sparse.count == 0);
    on.above_count = on.below_count = 0;
    split(&shell, &fill, &on, &usual, 11);
    CHECK_NEAR(324, area_of(&shell.top), 1e-9);
    iso_shell_free(&shell);
    iso_region_free(&outline);
    iso_region_free(&fill);
}

/* A ledge is kept from the width `narrowest` on, and reaches in by `anchor`. */
static void test_narrow_strips_and_anchors(void) {
    iso_region fill = square(10);
    iso_shell shell = {0};
    for (int32_t ledge = 1000; ledge <= 8000; ledge += 1000)
        for (int32_t anchor = 0; anchor <= 9000; anchor += 3000) {
            iso_region above = {0};
            add_box(&above, -12, -12, 10 - ledge / 1e4, 12, 0);
            const iso_region *list[] = {&above};
            stack around = {.above = list, .above_count = 1, .top = 1};
            iso_shell_options options = {.narrowest = 4100, .top_anchor = anchor, .anchor = anchor};
            split(&shell, &fill, &around, &options, 11);
            double width = ledge > 4100 ? (ledge + anchor) / 1e4 : 0;
            CHECK_NEAR(20 * width, area_of(&shell.top), 5e-3);
            CHECK_NEAR(400 - 20 * width, area_of(&shell.sparse), 5e-3);
            iso_region_free(&above);
        }
    iso_shell_free(&shell);
    iso_region_free(&fill);
}

/* An anchor of the solid part never takes from the top. */
static void test_top_comes_first(void) {
    iso_region outline = square(10), fill = square(9), above = square(4);
    const iso_region *list[] = {&above, &above, &above};
    stack around = {.above = list, .above_count = 3, .top = 3};
    iso_shell_options options = {.narrowest = 4000, .top_anchor = 10000, .anchor = 10000};
    iso_shell shell = {0};
    split(&shell, &fill, &around, &options, 11);
    CHECK_NEAR(324 - 36, area_of(&shell.top), 1e-2);
    CHECK_NEAR(0, area_of(&shell.solid), 1e-2);
    CHECK_NEAR(36, area_of(&shell.sparse), 1e-2);
    iso_shell_free(&shell);
    iso_region_free(&outline);
    iso_region_free(&fill);
    iso_region_free(&above);
}

/* ---- bridges, lids and small parts ---- */

static void split_over(iso_shell *shell, const iso_region *fill, iso_shell_neighbours around,
                       const iso_shell_options *options) {
    CHECK_OK(iso_shell_split(shell, fill, &around, options, scratch));
    check_parts(shell, fill);
}

/* A roof over a pit: solid anyway, and a bridge that reaches onto the rim; the same at full
 * density, where no shells are told apart below. */
static void test_bridge_over_a_pit(void) {
    iso_region outline = square(10), rim = square(10), fill = square(9);
    add_box(&rim, -4, -4, 4, 4, 1);
    iso_shell_options options = {.narrowest = 4000, .bridge_least = 4000, .bridge_anchor = 5000};
    iso_shell shell = {0};
    for (int32_t bottom = 0; bottom < 3; bottom++)
        for (int32_t top = 0; top < 2; top++) {
            iso_shell_neighbours around = {.own = &outline,
                                           .above = {.layers = top, .missing = top},
                                           .below = {bottom, 0, bottom > 0, {&rim, NULL}},
                                           .beneath = &rim};
            split_over(&shell, &fill, around, &options);
            CHECK_NEAR(81, area_of(&shell.bridge), 1e-3);
            CHECK_NEAR(0, area_of(&shell.solid), 1e-3);
            CHECK_NEAR(top ? 324 - 81 : 0, area_of(&shell.top), 1e-3);
            CHECK_NEAR(top ? 0 : 324 - 81, area_of(&shell.sparse), 1e-3);
        }
    /* the layer above lies on the roof */
    iso_shell_neighbours higher = {
        .own = &outline, .below = {2, 0, 2, {&outline, &rim}}, .beneath = &outline};
    split_over(&shell, &fill, higher, &options);
    CHECK_EQUAL(0, shell.bridge.count);
    CHECK_NEAR(64, area_of(&shell.solid), 1e-3);
    options.bridge_least = 90000; /* more than the pit is wide */
    higher.below = (iso_shell_side){1, 0, 1, {&rim}};
    higher.beneath = &rim;
    split_over(&shell, &fill, higher, &options);
    CHECK_EQUAL(0, shell.bridge.count);
    CHECK_NEAR(64, area_of(&shell.solid), 1e-3);
    iso_shell_free(&shell);
    iso_region_free(&outline);
    iso_region_free(&rim);
    iso_region_free(&fill);
}

/* A solid ring around a sparse middle, over sparse fill of some size. */
static void test_lids(void) {
    iso_region outline = square(10), step = square(5), fill = square(9);
    static const struct {
        double below, lid; /* half sides; 0: none */
    } cases[] = {{9, 9}, {7, 7.9}, {6.3, 7.2}, {5.5, 0}, {5, 0}, {3, 0}};
    iso_shell_options options = {.narrowest = 4000};
    iso_shell shell = {0};
    for (int i = 0; i < 6; i++) {
        iso_region below = square(cases[i].below);
        iso_shell_neighbours around = {
            .own = &outline, .next = &outline, .above = {2, 0, 2, {&outline, &step}}};
        split_over(&shell, &fill, around, &options);
        CHECK_NEAR(324 - 100, area_of(&shell.solid), 1e-3);
        CHECK_OK(iso_shell_find_lids(&shell, &below, 8000, 9000, scratch));
        check_parts(&shell, &fill);
        double lid = cases[i].lid > 0 ? 4 * cases[i].lid * cases[i].lid - 100 : 0;
        CHECK_NEAR(lid, area_of(&shell.lid), 0.02);
        CHECK_NEAR(324 - 100 - lid, area_of(&shell.solid), 0.02);
        CHECK_OK(iso_shell_find_lids(&shell, NULL, 8000, 9000, scratch));
        CHECK_EQUAL(0, shell.lid.count);
        iso_region_free(&below);
    }
    iso_shell_free(&shell);
    iso_region_free(&outline);
    iso_region_free(&step);
    iso_region_free(&fill);
}

static void test_small_sparse_parts_are_solid(void) {
    iso_region outline = square(10), step = square(2), fill = square(9), two = {0};
    add_box(&two, -9, -9, 1, 1, 0);
    add_box(&two, 3, 3, 7, 7, 0);
    iso_shell_options options = {.narrowest = 4000, .sparse_least = (int64_t)2 * 20 * MM * MM};
    iso_shell shell = {0};
    split_over(&shell, &two, (iso_shell_neighbours){.own = &outline}, &options);
    CHECK_NEAR(16, area_of(&shell.solid), 1e-6);
    CHECK_NEAR(100, area_of(&shell.sparse), 1e-6);
    /* an island within a solid ring becomes one with it */
    iso_shell_neighbours ring = {
        .own = &outline, .next = &outline, .above = {2, 0, 2, {&outline, &step}}};
    split_over(&shell, &fill, ring, &options);
    CHECK_EQUAL(1, shell.solid.count);
    CHECK_NEAR(324, area_of(&shell.solid), 1e-3);
    CHECK_EQUAL(0, shell.sparse.count);
    options.sparse_least = (int64_t)2 * 15 * MM * MM;
    split_over(&shell, &fill, ring, &options);
    CHECK_NEAR(16, area_of(&shell.sparse), 1e-3);
    /* nothing sparse at all */
    options.whole = 1;
    split_over(&shell, &two, (iso_shell_neighbours){.own = &outline}, &options);
    CHECK_NEAR(116, area_of(&shell.solid), 1e-6);
    CHECK_EQUAL(0, shell.sparse.count);
    ring.next = &step;
    ring.above = (iso_shell_side){1, 0, 1, {&step}};
    split_over(&shell, &fill, ring, &options);
    CHECK_NEAR(324 - 16, area_of(&shell.top), 1e-3);
    CHECK_NEAR(16, area_of(&shell.solid), 1e-3);
    iso_shell_free(&shell);
    iso_region_free(&outline);
    iso_region_free(&step);
    iso_region_free(&fill);
    iso_region_free(&two);
}

/* ---- random outlines ---- */

static uint64_t seed = 20;

static double random_between(double low, double high) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 33) / 2147483648.0;
}

/* Crossing boxes and triangles, some of them cut out, made one region. */
static iso_region random_region(void) {
    iso_region raw = {0}, region = {0};
    for (int i = 0; i < 6; i++) {
        iso_point corner[4];
        double x = random_between(-8, 8), y = random_between(-8, 8), r = random_between(2, 7);
        double turned = random_between(0, 6.28), step = i == 4 ? -1 : 1;
        int32_t corners = i % 2 ? 3 : 4;
        for (int32_t k = 0; k < corners; k++)
            corner[k] =
                (iso_point){iso_units(x + r * cos(turned + step * 6.2831853 * k / corners)),
                            iso_units(y + r * sin(turned + step * 6.2831853 * k / corners))};
        CHECK_OK(iso_region_add(&raw, corner, corners));
    }
    CHECK_OK(iso_region_clean(&region, &raw, ISO_FILL_POSITIVE, scratch));
    iso_region_free(&raw);
    return region;
}

/* Islands lie in holes of others: a small ring goes, what it was around stays, in the ring without.
 */
static void test_what_is_within_small_sparse_parts(void) {
    iso_region outline = square(20), fill = square(20);
    add_box(&fill, -18, -18, 18, 18, 1);
    add_box(&fill, -12, -12, 12, 12, 0);
    add_box(&fill, -11, -11, 11, 11, 1);
    add_box(&fill, -6, -6, 6, 6, 0);
    add_box(&fill, 7, 7, 9, 9, 0);
    static const int32_t parent[] = {-1, 0, 1, 2, 3, 3};
    memcpy(fill.parent, parent, sizeof parent);
    CHECK_OK(iso_region_validate(&fill, scratch));
    iso_shell_options options = {.narrowest = 4000, .sparse_least = (int64_t)2 * 100 * MM * MM};
    iso_shell shell = {0};
    CHECK_OK(iso_shell_split(&shell, &fill, &(iso_shell_neighbours){.own = &outline}, &options,
                             scratch));
    CHECK_OK(iso_region_validate(&shell.sparse, scratch));
    CHECK_OK(iso_region_validate(&shell.solid, scratch));
    CHECK_NEAR(1600 - 1296 + 144, area_of(&shell.sparse), 1e-6);
    CHECK_NEAR(576 - 484 + 4, area_of(&shell.solid), 1e-6);
    CHECK_EQUAL(3, shell.sparse.count);
    CHECK_EQUAL(1, shell.sparse.parent[2]);
    iso_shell_free(&shell);
    iso_region_free(&outline);
    iso_region_free(&fill);
}

static void test_random_outlines(void) {
    for (int trial = 0; trial < 24; trial++) {
        iso_region outline[7], fill = {0};
        const iso_region *list[6];
        for (int i = 0; i < 7; i++)
            outline[i] = random_region();
        for (int i = 0; i < 6; i++)
            list[i] = &outline[i + 1];
        iso_offset_options inset = iso_offset_defaults(-6000);
        CHECK_OK(iso_offset(&fill, &outline[0], &inset, scratch));
        stack around = {.above = list, .below = list + 3};
        around.above_count = trial % 4;
        around.below_count = trial / 4 % 4;
        around.top = around.above_count + (trial % 5 == 0);
        around.bottom = around.below_count + (trial % 7 == 0);
        around.own = &outline[0];
        for (int i = 0; i < 6; i++)
            if (i % 3 == trial % 5) /* an upright wall among the others */
                list[i] = &outline[0];
        iso_shell_options options = {.narrowest = 1000 * (trial % 6),
                                     .top_anchor = 1000 * (trial % 3),
                                     .anchor = 2000 * (trial % 3)};
        iso_shell shell = {0};
        split(&shell, &fill, &around, &options, 16);
        options.bridge_least = 1500 * (trial % 4);
        options.bridge_anchor = 4000 * (trial % 2);
        options.sparse_least = (int64_t)2 * (trial % 3) * 10 * MM * MM;
        options.whole = trial % 8 == 7;
        iso_shell_neighbours over = {.own = &outline[0],
                                     .next = list[0],
                                     .above = {1, 0, 1, {list[0]}},
                                     .below = {1, 0, 1, {list[3]}},
                                     .beneath = list[3]};
        split_over(&shell, &fill, over, &options);
        CHECK_OK(iso_shell_find_lids(&shell, list[4], 1000 + 500 * (trial % 9), 3000, scratch));
        check_parts(&shell, &fill);
        iso_shell_free(&shell);
        iso_region_free(&fill);
        for (int i = 0; i < 7; i++)
            iso_region_free(&outline[i]);
    }
}

/* ---- runs ---- */

static void test_levels(void) {
    CHECK_EQUAL(0, iso_shell_level(0));
    CHECK_EQUAL(30, iso_shell_level(INT32_MAX));
    for (int32_t layers = 1; layers < 5000; layers++) {
        int32_t level = iso_shell_level(layers);
        CHECK(1 << level <= layers && layers < 2 << level);
    }
}

static int same_region(const iso_region *a, const iso_region *b) {
    return a->count == b->count &&
           memcmp(a->first, b->first, (size_t)(a->count + 1) * sizeof *a->first) == 0 &&
           memcmp(a->point, b->point, (size_t)a->first[a->count] * sizeof *a->point) == 0 &&
           memcmp(a->parent, b->parent, (size_t)a->count * sizeof *a->parent) == 0;
}

/* What two outlines share; of two like ones, the same to the point. */
static void test_widening(void) {
    iso_region shared = {0}, nothing = {0};
    for (int trial = 0; trial < 12; trial++) {
        iso_region a = random_region(), b = random_region();
        CHECK_OK(iso_shell_widen(&shared, &a, &b, scratch));
        CHECK_OK(iso_region_validate(&shared, scratch));
        int wrong = 0;
        for (double x = -15; x < 15; x += 0.717)
            for (double y = -15; y < 15; y += 0.693) {
                double u = floor(x * MM) + 0.5, v = floor(y * MM) + 0.5;
                int both = winding_at(&a, u, v) > 0 && winding_at(&b, u, v) > 0;
                wrong += winding_at(&shared, u, v) != both &&
                         fmin(distance_to(&a, u, v), distance_to(&b, u, v)) > 3;
            }
        CHECK_EQUAL(0, wrong);
        CHECK_OK(iso_shell_widen(&shared, &a, &a, scratch));
        CHECK(same_region(&a, &shared));
        CHECK_OK(iso_shell_widen(&shared, &a, &nothing, scratch));
        CHECK_EQUAL(0, shared.count);
        CHECK_OK(iso_shell_widen(&shared, &nothing, &nothing, scratch));
        CHECK_EQUAL(0, shared.count);
        iso_region_free(&a);
        iso_region_free(&b);
    }
    iso_region_free(&shared);
}

static void test_no_memory(void) {
    iso_region outline[] = {random_region(), random_region(), random_region()};
    iso_region fill = random_region();
    iso_shell_neighbours around = {&fill,
                                   &outline[0],
                                   {2, 0, 2, {&outline[1], &outline[0]}},
                                   {1, 0, 1, {&outline[2]}},
                                   &outline[2]};
    const iso_shell_options full = {.narrowest = 4000,
                                    .anchor = 3000,
                                    .bridge_least = 3000,
                                    .bridge_anchor = 3000,
                                    .sparse_least = (int64_t)2 * 50 * MM * MM};
    iso_status status = ISO_NO_MEMORY;
    int64_t n = 0;
    for (; status == ISO_NO_MEMORY && n < 2000; n++) {
        iso_shell shell = {0};
        iso_planar_scratch *own;
        CHECK_OK(iso_planar_scratch_new(&own));
        iso_fail_allocation_after(n);
        status = iso_shell_split(&shell, &fill, &around, &full, own);
        if (status == ISO_OK)
            status = iso_shell_find_lids(&shell, &outline[1], 4000, 3000, own);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK)
            CHECK(shell.lid.count == 0 && shell.solid.count == 0);
        /* the scratch is as good as new */
        iso_shell_free(&shell);
        CHECK_OK(iso_shell_split(&shell, &fill, &around, &usual, own));
        check_parts(&shell, &fill);
        iso_planar_scratch_free(own);
        iso_shell_free(&shell);
    }
    CHECK_STATUS(ISO_OK, status);
    CHECK(n > 20);
    for (int i = 0; i < 3; i++)
        iso_region_free(&outline[i]);
    iso_region_free(&fill);
}

int main(void) {
    CHECK_OK(iso_planar_scratch_new(&scratch));
    RUN(test_stepped_pyramid);
    RUN(test_overhanging_steps);
    RUN(test_roof);
    RUN(test_cube);
    RUN(test_one_outline_that_differs);
    RUN(test_hole_above);
    RUN(test_none);
    RUN(test_narrow_strips_and_anchors);
    RUN(test_top_comes_first);
    RUN(test_bridge_over_a_pit);
    RUN(test_lids);
    RUN(test_small_sparse_parts_are_solid);
    RUN(test_what_is_within_small_sparse_parts);
    RUN(test_random_outlines);
    RUN(test_levels);
    RUN(test_widening);
    RUN(test_no_memory);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}
