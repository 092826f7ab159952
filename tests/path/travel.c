#include "path/travel.h"

#include <math.h>

#include "check.h"

typedef struct layer {
    iso_paths in, out;
    iso_order_state state;
    iso_order_options options;
    iso_arena scratch;
} layer;

static void begin(layer *l) {
    *l = (layer){.options = iso_order_defaults()};
    l->options.retract_crossing_only = 1;
}

static void end(layer *l) {
    iso_paths_free(&l->in);
    iso_paths_free(&l->out);
    iso_order_state_free(&l->state);
    iso_arena_free(&l->scratch);
}

static iso_point mm(double x, double y) {
    return (iso_point){iso_units(x), iso_units(y)};
}

static void add(layer *l, iso_path like, const double (*at)[2], int count) {
    iso_point point[64];
    for (int i = 0; i < count; i++)
        point[i] = mm(at[i][0], at[i][1]);
    CHECK_OK(iso_paths_add(&l->in, &like, point, count, 4500, 1));
}

static void add_box(layer *l, iso_path like, const double box[4], int hole) {
    double p[4][2] = {{box[0], box[1]}, {box[2], box[1]}, {box[2], box[3]}, {box[0], box[3]}};
    double q[4][2] = {{box[0], box[1]}, {box[0], box[3]}, {box[2], box[3]}, {box[2], box[1]}};
    like.closed = 1;
    add(l, like, (const double(*)[2])(hole ? q : p), 4);
}

static void order(layer *l) {
    CHECK_OK(iso_order_layer(&l->out, &l->in, &l->state, &l->options, &l->scratch));
    CHECK_EQUAL(l->in.count, l->out.count);
}

static const iso_path external = {.role = ISO_ROLE_EXTERNAL_PERIMETER, .rank = 1};
static const iso_path inner = {.role = ISO_ROLE_PERIMETER, .rank = 0};
static const iso_path solid = {.role = ISO_ROLE_SOLID_INFILL, .rank = 2};
static const iso_path top = {.role = ISO_ROLE_TOP_SOLID_INFILL, .rank = 2};

static const iso_path *path_of(const layer *l, int role, int nth) {
    for (int32_t i = 0; i < l->out.count; i++)
        if (l->out.path[i].role == role && nth-- == 0)
            return &l->out.path[i];
    CHECK(nth < 0);
    return l->out.path;
}

/* Inside of a part no retraction, from one part to the next as ever. */
static void test_inside_and_across(void) {
    layer l;
    begin(&l);
    iso_path other = external, fill = solid;
    other.group = fill.group = 1;
    add_box(&l, external, (double[]){0, 0, 20, 20}, 0);
    add(&l, solid, (const double[][2]){{5, 15}, {15, 15}}, 2);
    add_box(&l, other, (double[]){30, 0, 50, 20}, 0);
    add(&l, fill, (const double[][2]){{35, 15}, {45, 15}}, 2);
    order(&l);
    CHECK_EQUAL(ISO_RETRACT_NOT, path_of(&l, ISO_ROLE_SOLID_INFILL, 0)->retract);
    CHECK_EQUAL(ISO_RETRACT_NOT, path_of(&l, ISO_ROLE_SOLID_INFILL, 1)->retract);
    CHECK_EQUAL(ISO_RETRACT_IF_LONG, path_of(&l, ISO_ROLE_EXTERNAL_PERIMETER, 1)->retract);
    l.options.retract_crossing_only = 0;
    order(&l);
    CHECK_EQUAL(ISO_RETRACT_IF_LONG, path_of(&l, ISO_ROLE_SOLID_INFILL, 0)->retract);
    end(&l);
}

/* Over a top surface that is printed already a drop would be seen. */
static void test_printed_top_is_crossed(void) {
    layer l;
    begin(&l);
    add_box(&l, external, (double[]){0, 0, 40, 20}, 0);
    add(&l, top, (const double[][2]){{1, 1}, {1, 19}, {8, 19}, {8, 1}, {12, 1}, {12, 19}}, 6);
    add(&l, top, (const double[][2]){{4, 4}, {4, 5}}, 2);
    order(&l);
    const iso_path *second = path_of(&l, ISO_ROLE_TOP_SOLID_INFILL, 1);
    CHECK_EQUAL(2, second->count);
    CHECK_EQUAL(ISO_RETRACT_IF_LONG, second->retract);
    end(&l);
}

/* Between the arms of a U the way leads through its foot, if it is allowed to. */
static void test_around_walls(void) {
    static const double u[][2] = {{0, 0},   {30, 0},  {30, 40}, {20, 40},
                                  {20, 10}, {10, 10}, {10, 40}, {0, 40}};
    static const double detour[] = {0, 45, 40};
    for (int turn = 0; turn < 4; turn++) {
        layer l;
        begin(&l);
        add(&l, (iso_path){.role = ISO_ROLE_EXTERNAL_PERIMETER, .closed = 1, .rank = 1}, u, 8);
        add(&l, solid, (const double[][2]){{5, 8}, {5, 35}}, 2);
        add(&l, solid, (const double[][2]){{25, 35}, {25, 36}}, 2);
        l.options.avoid_crossing = turn < 3;
        l.options.max_detour = turn < 3 ? detour[turn] * 1e4 : 0;
        order(&l);
        const iso_path *last = path_of(&l, ISO_ROLE_SOLID_INFILL, 1);
        /* 5,35 - 10,10 - 20,10 - 25,35 is 61 mm, 41 more than straight */
        int around = turn < 2;
        CHECK_EQUAL(around ? 2 : 0, last->travel_count);
        CHECK_EQUAL(around ? ISO_RETRACT_NOT : ISO_RETRACT_IF_LONG, last->retract);
        if (around) {
            const iso_point *way = l.out.travel + last->travel_first;
            iso_point a = mm(10, 10), b = mm(20, 10);
            int forth = way[0].x == a.x;
            CHECK(way[0].y == a.y && way[1].y == b.y);
            CHECK(way[0].x == (forth ? a.x : b.x) && way[1].x == (forth ? b.x : a.x));
        }
        end(&l);
    }
}

/* A short way around a corner is quicker than a retraction, and taken without being asked for. */
static void test_short_cut_around_a_corner(void) {
    static const double ell[][2] = {{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 20}, {0, 20}};
    layer l;
    begin(&l);
    iso_path wall = external;
    wall.closed = 1;
    add(&l, wall, ell, 6);
    add(&l, solid, (const double[][2]){{4, 2}, {4, 12}}, 2);
    add(&l, solid, (const double[][2]){{12, 7}, {18, 7}}, 2);
    l.state.position = mm(4, 2);
    order(&l);
    const iso_path *last = path_of(&l, ISO_ROLE_SOLID_INFILL, 1);
    if (CHECK_EQUAL(1, last->travel_count))
        CHECK(l.out.travel[last->travel_first].x == 80000);
    CHECK_EQUAL(ISO_RETRACT_NOT, last->retract);
    end(&l);
}

/* Along a ring a bend each 7.5 degrees hardly slows the nozzle down: quicker than a retraction,
 * where as many right angles would not be. */
static void test_gentle_bends_are_quick(void) {
    enum { POINTS = 48 };
    layer l;
    double hole[POINTS][2];
    begin(&l);
    add_box(&l, external, (double[]){-20, -20, 20, 20}, 0);
    for (int i = 0; i < POINTS; i++) {
        double w = -2 * 3.14159265358979323846 * i / POINTS;
        hole[i][0] = 10 * cos(w);
        hole[i][1] = 10 * sin(w);
    }
    iso_path wall = external;
    wall.closed = 1;
    add(&l, wall, (const double(*)[2])hole, POINTS);
    add(&l, solid, (const double[][2]){{10.5, -12}, {10.5, -3}}, 2);
    add(&l, solid, (const double[][2]){{3, 10.5}, {3, 18}}, 2);
    order(&l);
    const iso_path *last = path_of(&l, ISO_ROLE_SOLID_INFILL, 1);
    CHECK(last->travel_count >= 4);
    CHECK_EQUAL(ISO_RETRACT_NOT, last->retract);
    l.options.cost.junction_deviation = 0;
    order(&l);
    last = path_of(&l, ISO_ROLE_SOLID_INFILL, 1);
    CHECK_EQUAL(0, last->travel_count);
    CHECK_EQUAL(ISO_RETRACT_IF_LONG, last->retract);
    end(&l);
}

/* ---- walls ---- */

static void add_ring(layer *l) {
    add_box(l, inner, (double[]){1, 1, 39, 39}, 0);
    add_box(l, inner, (double[]){14, 14, 26, 26}, 1);
    add_box(l, external, (double[]){0.5, 0.5, 39.5, 39.5}, 0);
    add_box(l, external, (double[]){14.5, 14.5, 25.5, 25.5}, 1);
}

static double extent_of(const layer *l, int32_t i) {
    double low = 1e9, high = -1e9;
    for (int32_t k = 0; k < l->out.path[i].count; k++) {
        double x = iso_mm(l->out.vertex[l->out.path[i].first + k].at.x);
        low = fmin(low, x);
        high = fmax(high, x);
    }
    return high - low;
}

/* Each outline is finished before the next: one long travel for a ring's walls, not two. */
static void test_walls_by_outline(void) {
    for (int outer_first = 0; outer_first < 2; outer_first++)
        for (int seam = ISO_SEAM_RANDOM; seam <= ISO_SEAM_REAR; seam++) {
            layer l;
            begin(&l);
            l.options.seam = (iso_seam)seam;
            add_ring(&l);
            for (int32_t i = 0; outer_first && i < 4; i++)
                l.in.path[i].rank ^= 1;
            order(&l);
            int far = 0;
            for (int32_t i = 0; i + 1 < 4; i++) {
                iso_point a = l.out.vertex[l.out.path[i].first].at;
                iso_point b = l.out.vertex[l.out.path[i + 1].first].at;
                far += hypot((double)a.x - b.x, (double)a.y - b.y) > 0.75e4;
            }
            CHECK_EQUAL(1, far);
            for (int32_t i = 0; i < 4; i += 2) {
                int first_is_inner = l.out.path[i].role == ISO_ROLE_PERIMETER;
                CHECK_EQUAL(!outer_first, first_is_inner);
                CHECK_NEAR(1, fabs(extent_of(&l, i) - extent_of(&l, i + 1)), 1e-9);
            }
            end(&l);
        }
}

/* A wall between two outlines, as around a thin bridge of material, is printed before both. */
static void test_wall_beside_two(void) {
    layer l;
    begin(&l);
    add_box(&l, (iso_path){.role = ISO_ROLE_PERIMETER, .rank = 0}, (double[]){1, 1, 20, 3}, 0);
    add_box(&l, external, (double[]){0.5, 0.5, 21, 3.5}, 0);
    add_box(&l, external, (double[]){1.5, 3.4, 19, 9}, 1);
    order(&l);
    CHECK_EQUAL(ISO_ROLE_PERIMETER, l.out.path[0].role);
    end(&l);
}

static double seconds_of(const layer *l, const int32_t *order, int32_t count) {
    iso_point at = {0, 0};
    double sum = 0;
    for (int32_t k = 0; k < count; k++) {
        iso_point next = l->out.vertex[l->out.path[order[k]].first].at;
        sum += iso_travel_seconds(&l->options.cost, at, next);
        at = next;
    }
    return sum;
}

/* Towers anywhere: no dearer than if the nearest came next each time. */
static void test_many_islands(void) {
    enum { TOWERS = 120 };
    double saved = 0, all = 0;
    uint64_t seed = 1;
    for (int turn = 0; turn < 20; turn++) {
        layer l;
        int32_t as_is[TOWERS], nearest[TOWERS];
        begin(&l);
        l.options.seam = turn % 2 ? ISO_SEAM_REAR : ISO_SEAM_ALIGNED;
        for (int i = 0; i < TOWERS; i++) {
            iso_path wall = external;
            wall.group = i;
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            double x = (double)(seed >> 40 & 0xfff) / 20, y = (double)(seed >> 52) / 20;
            add_box(&l, wall, (double[]){x, y, x + 1, y + 1}, 0);
        }
        order(&l);
        iso_point at = {0, 0};
        uint8_t done[TOWERS] = {0};
        for (int k = 0; k < TOWERS; k++) {
            double least = INFINITY;
            as_is[k] = k;
            for (int32_t i = 0; i < TOWERS; i++) {
                iso_point p = l.out.vertex[l.out.path[i].first].at;
                double d = hypot((double)p.x - at.x, (double)p.y - at.y);
                if (!done[i] && d < least) {
                    least = d;
                    nearest[k] = i;
                }
            }
            done[nearest[k]] = 1;
            at = l.out.vertex[l.out.path[nearest[k]].first].at;
        }
        double before = seconds_of(&l, nearest, TOWERS), after = seconds_of(&l, as_is, TOWERS);
        CHECK(after <= before + 1e-9);
        saved += before - after;
        all += before;
        end(&l);
    }
    CHECK(saved > 0.02 * all);
}

/* Fill before walls, a skirt before either, ironing last. */
static void test_phases(void) {
    for (int early = 0; early < 2; early++) {
        layer l;
        begin(&l);
        l.options.infill_first = early;
        add(&l, (iso_path){.role = ISO_ROLE_IRONING}, (const double[][2]){{5, 5}, {6, 5}}, 2);
        add(&l, (iso_path){.role = ISO_ROLE_GAP_FILL, .rank = 9},
            (const double[][2]){{1, 5}, {1, 9}}, 2);
        add(&l, solid, (const double[][2]){{2, 5}, {2, 9}}, 2);
        add_box(&l, external, (double[]){0, 0, 20, 20}, 0);
        add_box(&l, (iso_path){.role = ISO_ROLE_SKIRT, .group = -1, .object = -1},
                (double[]){-50, -50, 70, 70}, 0);
        order(&l);
        CHECK_EQUAL(ISO_ROLE_SKIRT, l.out.path[0].role);
        CHECK_EQUAL(ISO_ROLE_EXTERNAL_PERIMETER, l.out.path[early ? 3 : 1].role);
        CHECK_EQUAL(ISO_ROLE_IRONING, l.out.path[4].role);
        end(&l);
    }
}

/* Lines with a ring among them: a tour as without it, and the ring begins where it is met. */
static void test_few_rings_among_lines(void) {
    layer l;
    begin(&l);
    for (int i = 0; i < 9; i++) {
        double x = i * 7 % 9;
        add(&l, solid, (const double[][2]){{x, 0}, {x, 20}}, 2);
    }
    add_box(&l, solid, (double[]){9, 18, 11, 30}, 0);
    order(&l);
    CHECK(l.out.path[9].closed);
    iso_point at = l.out.vertex[l.out.path[9].first].at;
    CHECK(at.x == 90000 && at.y == 180000);
    for (int32_t i = 0; i < 9; i++)
        CHECK_EQUAL(10000 * i, l.out.vertex[l.out.path[i].first].at.x);
    end(&l);
}

/* A seam that is a new vertex: the loop is as long as before, and its beads keep what they had. */
static void test_seam_becomes_a_vertex(void) {
    layer l;
    begin(&l);
    l.options.seam = ISO_SEAM_RANDOM;
    add_box(&l, external, (double[]){0, 0, 20, 10}, 0);
    for (int i = 0; i < 4; i++)
        l.in.vertex[i] = (iso_path_vertex){
            .at = l.in.vertex[i].at, .width = 4000 + i, .area = 100 + i, .role = i % 2};
    order(&l);
    const iso_path *path = l.out.path;
    double length[4] = {0};
    CHECK_EQUAL(5, path->count);
    for (int32_t i = 0; i < path->count; i++) {
        const iso_path_vertex *v = &l.out.vertex[path->first + i];
        iso_point next = l.out.vertex[path->first + (i + 1) % path->count].at;
        int bead = v->width - 4000;
        CHECK(bead >= 0 && bead < 4 && v->area == 100 + bead && v->role == bead % 2);
        length[bead & 3] += hypot((double)next.x - v->at.x, (double)next.y - v->at.y);
    }
    for (int i = 0; i < 4; i++)
        CHECK_NEAR(i % 2 ? 100000 : 200000, length[i], 1);
    end(&l);
}

static void test_without_memory(void) {
    for (int64_t n = 0;; n++) {
        layer l;
        begin(&l);
        l.options.seam = ISO_SEAM_ALIGNED;
        l.options.avoid_crossing = 1;
        add_ring(&l);
        for (int i = 0; i < 30; i++)
            add(&l, solid, (const double[][2]){{2 + i, 3}, {2 + i, 37}}, 2);
        iso_fail_allocation_after(n);
        iso_status status = iso_order_layer(&l.out, &l.in, &l.state, &l.options, &l.scratch);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK) {
            CHECK_EQUAL(ISO_NO_MEMORY, status);
            CHECK_EQUAL(0, l.out.count);
        }
        end(&l);
        if (status == ISO_OK)
            break;
    }
}

int main(void) {
    RUN(test_inside_and_across);
    RUN(test_printed_top_is_crossed);
    RUN(test_around_walls);
    RUN(test_short_cut_around_a_corner);
    RUN(test_gentle_bends_are_quick);
    RUN(test_walls_by_outline);
    RUN(test_wall_beside_two);
    RUN(test_many_islands);
    RUN(test_phases);
    RUN(test_few_rings_among_lines);
    RUN(test_seam_becomes_a_vertex);
    RUN(test_without_memory);
    return check_verdict();
}
