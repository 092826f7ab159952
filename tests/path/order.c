#include "path/order.h"

#include <stdlib.h>

#include "check.h"

enum { PATH_STEP = 1000 /* widths name paths and segments: 1000 * path + segment */ };

static uint64_t seed;

static int32_t random_below(int32_t n) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (int32_t)((seed >> 33) % (uint64_t)n);
}

/* A layer by itself, with the usual options. */
static iso_status order_layer(iso_paths *out, const iso_paths *in, iso_point *at,
                              iso_arena *scratch) {
    iso_order_state state = {.position = *at};
    iso_order_options options = iso_order_defaults();
    iso_status status = iso_order_layer(out, in, &state, &options, scratch);
    *at = state.position;
    iso_order_state_free(&state);
    return status;
}

typedef struct shape {
    int paths, groups, ranks, span, longest;
} shape;

static void make_layer(iso_paths *paths, const shape *s) {
    iso_paths_clear(paths);
    for (int i = 0; i < s->paths; i++) {
        iso_point point[32];
        int count = 1 + random_below(s->longest);
        for (int k = 0; k < count; k++)
            point[k] = (iso_point){random_below(s->span) - s->span / 2, random_below(s->span)};
        iso_path like = {.role = ISO_ROLE_CUSTOM,
                         .closed = (uint8_t)random_below(2),
                         .object = random_below(2),
                         .group = random_below(s->groups) - 1,
                         .rank = random_below(s->ranks) - 1};
        CHECK_OK(iso_paths_add(paths, &like, point, count, 0, 0));
        for (int k = 0; k < count; k++) {
            iso_path_vertex *v = &paths->vertex[paths->path[i].first + k];
            v->width = PATH_STEP * i + k;
            v->area = 7 * v->width;
            v->z = k;
        }
    }
}

/* The same rule, written down as plainly as it can be. */
typedef struct choice {
    int64_t distance;
    int32_t path, vertex;
} choice;

static choice nearest_start(const iso_paths *in, const uint8_t *done, iso_point at, int object,
                            int any_group, int group) {
    choice best = {INT64_MAX, -1, -1};
    int32_t best_group = 0, best_object = 0;
    for (int32_t i = 0; i < in->count; i++) {
        const iso_path *p = &in->path[i];
        if (done[i] || (!any_group && (p->group != group || p->object != object)))
            continue;
        int lowest = 1;
        for (int32_t j = 0; j < in->count; j++)
            if (!done[j] && in->path[j].group == p->group && in->path[j].object == p->object)
                lowest &= in->path[j].rank >= p->rank;
        for (int32_t k = 0; lowest && k < p->count; k++) {
            if (!p->closed && k > 0 && k < p->count - 1)
                continue;
            iso_point v = in->vertex[p->first + k].at;
            int64_t dx = v.x - at.x, dy = v.y - at.y, d = dx * dx + dy * dy;
            int earlier =
                p->object != best_object ? p->object < best_object : p->group < best_group;
            if (d < best.distance || (any_group && d == best.distance && earlier)) {
                best = (choice){d, i, k};
                best_group = p->group;
                best_object = p->object;
            }
        }
    }
    return best;
}

static void check_against_plain_rule(const iso_paths *in, const iso_paths *out, iso_point at) {
    uint8_t *done = calloc((size_t)in->count + 1, 1);
    int group_open = 0, object = 0, group = 0;
    for (int32_t n = 0; n < out->count; n++) {
        choice c = {0};
        if (group_open)
            c = nearest_start(in, done, at, object, 0, group);
        if (!group_open || c.path < 0) {
            c = nearest_start(in, done, at, 0, 1, 0);
            object = in->path[c.path].object;
            group = in->path[c.path].group;
            group_open = 1;
            c = nearest_start(in, done, at, object, 0, group);
        }
        done[c.path] = 1;
        const iso_path *p = &in->path[c.path], *q = &out->path[n];
        iso_path_vertex start = out->vertex[q->first];
        iso_point expected = in->vertex[p->first + c.vertex].at;
        CHECK_EQUAL(c.path, start.width / PATH_STEP);
        CHECK(start.at.x == expected.x && start.at.y == expected.y);
        CHECK_EQUAL(c.vertex, start.z);
        at = p->closed ? expected : in->vertex[p->first + (c.vertex ? 0 : p->count - 1)].at;
    }
    free(done);
}

/* Every bead of `in` is in `out` once, between the same two points, with its width and area. */
static void check_same_beads(const iso_paths *in, const iso_paths *out) {
    int32_t vertices = 0;
    uint8_t *seen = calloc((size_t)in->vertex_count + 1, 1);
    CHECK_EQUAL(in->count, out->count);
    for (int32_t n = 0; n < out->count; n++) {
        const iso_path *q = &out->path[n];
        const iso_path_vertex *v = out->vertex + q->first;
        const iso_path *p = &in->path[v[0].width / PATH_STEP];
        CHECK_EQUAL(vertices, q->first);
        CHECK(q->count == p->count && q->closed == p->closed && q->group == p->group &&
              q->rank == p->rank && q->object == p->object);
        for (int32_t k = 0; k < q->count; k++) {
            int32_t bead = v[k].width % PATH_STEP;
            CHECK_EQUAL(7 * v[k].width, v[k].area);
            seen[p->first + bead]++;
            if (!q->closed && k == q->count - 1)
                continue;
            int32_t from = v[k].z, to = v[(k + 1) % q->count].z, next = (bead + 1) % p->count;
            CHECK((from == bead && to == next) || (!q->closed && from == next && to == bead));
        }
        vertices += q->count;
    }
    CHECK_EQUAL(in->vertex_count, vertices);
    CHECK_EQUAL(in->vertex_count, out->vertex_count);
    for (int32_t i = 0; i < in->vertex_count; i++)
        CHECK_EQUAL(1, seen[i]);
    free(seen);
}

static void test_random_layers_follow_the_rule(void) {
    static const shape shapes[] = {
        {1, 1, 1, 1000, 5},      {12, 3, 3, 10, 4},  {60, 1, 1, 100000, 2}, {90, 8, 2, 12, 6},
        {150, 40, 3, 400000, 3}, {400, 1, 1, 25, 2}, {300, 1, 2, 1, 3}};
    iso_paths in = {0}, out = {0};
    iso_arena scratch = {0};
    for (int s = 0; s < 7; s++)
        for (int turn = 0; turn < (shapes[s].paths > 100 ? 3 : 20); turn++) {
            seed = (uint64_t)(100 * s + turn);
            make_layer(&in, &shapes[s]);
            iso_point start = {random_below(2000000) - 1000000, turn % 2 ? 0 : -900000}, at = start;
            CHECK_OK(order_layer(&out, &in, &at, &scratch));
            check_same_beads(&in, &out);
            check_against_plain_rule(&in, &out, start);
            if (out.count > 0) {
                const iso_path *last = &out.path[out.count - 1];
                iso_point end = out.vertex[last->first + (last->closed ? 0 : last->count - 1)].at;
                CHECK(at.x == end.x && at.y == end.y);
            }
        }
    iso_arena_free(&scratch);
    iso_paths_free(&in);
    iso_paths_free(&out);
}

/* All on one line: cells in one row, and points that fall into the same place. */
static void test_degenerate_spreads(void) {
    iso_paths in = {0}, out = {0};
    iso_arena scratch = {0};
    for (int along = 0; along < 2; along++) {
        iso_paths_clear(&in);
        for (int i = 0; i < 500; i++) {
            int32_t d = (i * 7919) % 500 * 30000 - 7000000;
            iso_point p[2] = {{along ? d : 5, along ? 5 : d},
                              {along ? d + 9 : 5, along ? 5 : d + 9}};
            iso_path like = {.role = ISO_ROLE_CUSTOM};
            CHECK_OK(iso_paths_add(&in, &like, p, 2, PATH_STEP * i, 7 * PATH_STEP * i));
            in.vertex[2 * i + 1].z = in.vertex[2 * i + 1].width += 1;
            in.vertex[2 * i + 1].z = 1;
            in.vertex[2 * i + 1].area += 7;
        }
        iso_point at = {-ISO_COORDINATE_MAX, ISO_COORDINATE_MAX};
        CHECK_OK(order_layer(&out, &in, &at, &scratch));
        check_same_beads(&in, &out);
        check_against_plain_rule(&in, &out, (iso_point){-ISO_COORDINATE_MAX, ISO_COORDINATE_MAX});
    }
    iso_arena_free(&scratch);
    iso_paths_free(&in);
    iso_paths_free(&out);
}

static double travel_of(const iso_paths *paths, iso_point at) {
    double sum = 0;
    for (int32_t i = 0; i < paths->count; i++) {
        const iso_path *p = &paths->path[i];
        iso_point start = paths->vertex[p->first].at;
        sum += hypot(start.x - at.x, start.y - at.y);
        at = p->closed ? start : paths->vertex[p->first + p->count - 1].at;
    }
    return sum;
}

/* A solid square filled line by line: forth and back, without a detour. */
static void test_solid_fill_goes_forth_and_back(void) {
    enum { LINES = 20000 };
    iso_paths in = {0}, out = {0};
    iso_arena scratch = {0};
    for (int i = 0; i < LINES; i++) {
        int32_t y = (int32_t)((int64_t)i * 7919 % LINES) * 100;
        iso_point p[2] = {{0, y}, {2000000, y}};
        CHECK_OK(iso_paths_add(&in, &(iso_path){.role = ISO_ROLE_SOLID_INFILL}, p, 2, 1, 1));
    }
    iso_point at = {0, 0};
    CHECK_OK(order_layer(&out, &in, &at, &scratch));
    CHECK_EQUAL(LINES, out.count);
    CHECK_NEAR((LINES - 1) * 100.0, travel_of(&out, (iso_point){0, 0}), 0);
    CHECK(travel_of(&out, (iso_point){0, 0}) < travel_of(&in, (iso_point){0, 0}));
    iso_arena_free(&scratch);
    iso_paths_free(&in);
    iso_paths_free(&out);
}

static double length_of(const iso_paths *paths, const iso_path *p) {
    double sum = 0;
    for (int32_t k = 0; k < p->count - !p->closed; k++) {
        iso_point a = paths->vertex[p->first + k].at;
        iso_point b = paths->vertex[p->first + (k + 1) % p->count].at;
        sum += hypot((double)a.x - b.x, (double)a.y - b.y);
    }
    return sum;
}

/* Layers that no slicer makes: walls that cross, repeat points or enclose nothing, of all roles,
 * with all options. Whatever the order, each path is drawn once and as long as it was. */
static void test_anything_goes(void) {
    static const int32_t spans[] = {1, 4, 3000, 300000, 2 * ISO_COORDINATE_MAX};
    for (int turn = 0; turn < 400; turn++) {
        iso_paths in = {0}, out = {0};
        iso_arena scratch = {0};
        iso_order_state state = {0};
        iso_order_options options = iso_order_defaults();
        seed = (uint64_t)turn;
        int32_t span = spans[turn % 5], kinds = 1 + random_below(8);
        options.seam = (iso_seam)(turn / 5 % 4);
        options.infill_first = random_below(2);
        options.retract_crossing_only = random_below(3) > 0;
        options.avoid_crossing = random_below(2);
        options.cost.retract_before = turn % 3 ? 20000 : 0;
        for (int layer = 0; layer < 3; layer++) {
            iso_paths_clear(&in);
            for (int i = 0; i < 60; i++) {
                iso_point point[12];
                int count = 1 + random_below(12);
                for (int k = 0; k < count; k++)
                    point[k] =
                        (iso_point){random_below(span) - span / 2, random_below(span) - span / 2};
                iso_path like = {.role = (uint8_t)random_below(kinds),
                                 .closed = (uint8_t)random_below(2),
                                 .group = random_below(kinds),
                                 .rank = random_below(4)};
                CHECK_OK(iso_paths_add(&in, &like, point, count, i, 1));
            }
            CHECK_OK(iso_order_layer(&out, &in, &state, &options, &scratch));
            CHECK_EQUAL(in.count, out.count);
            int drawn[60] = {0};
            for (int32_t i = 0; i < out.count; i++) {
                const iso_path *p = &out.path[i];
                const iso_path *q = &in.path[out.vertex[p->first].width];
                drawn[out.vertex[p->first].width]++;
                CHECK(p->count == q->count || (p->closed && p->count == q->count + 1));
                CHECK_NEAR(length_of(&in, q), length_of(&out, p), 2);
                CHECK(p->travel_first + p->travel_count <= out.travel_count);
            }
            for (int i = 0; i < 60; i++)
                CHECK_EQUAL(1, drawn[i]);
        }
        iso_order_state_free(&state);
        iso_arena_free(&scratch);
        iso_paths_free(&in);
        iso_paths_free(&out);
    }
}

static void test_nothing_and_empty_paths(void) {
    iso_paths in = {0}, out = {0};
    iso_arena scratch = {0};
    iso_point at = {3, 4}, p = {5, 6};
    CHECK_OK(order_layer(&out, &in, &at, &scratch));
    CHECK(out.count == 0 && at.x == 3 && at.y == 4);
    CHECK_OK(iso_paths_add(&in, &(iso_path){0}, &p, 0, 1, 1));
    CHECK_OK(iso_paths_add(&in, &(iso_path){.closed = 1}, &p, 1, 1, 1));
    CHECK_OK(order_layer(&out, &in, &at, &scratch));
    CHECK(out.count == 1 && at.x == 5 && at.y == 6);
    iso_arena_free(&scratch);
    iso_paths_free(&in);
    iso_paths_free(&out);
}

static void test_without_memory(void) {
    iso_paths in = {0};
    seed = 5;
    make_layer(&in, &(shape){300, 6, 3, 100000, 20});
    for (int64_t n = 0;; n++) {
        iso_paths out = {0};
        iso_arena scratch = {0};
        iso_point at = {1, 2};
        iso_fail_allocation_after(n);
        iso_status status = order_layer(&out, &in, &at, &scratch);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK) {
            CHECK_EQUAL(ISO_NO_MEMORY, status);
            CHECK(out.count == 0 && at.x == 1 && at.y == 2);
        }
        iso_arena_free(&scratch);
        iso_paths_free(&out);
        if (status == ISO_OK) {
            CHECK(n >= 3);
            break;
        }
    }
    iso_paths_free(&in);
}

/* Chains among other fill stay whole, forwards or backwards, wherever their members begin. */
static void test_chains_stay_whole(void) {
    enum { CHAINS = 12, LINKS = 5, LOOSE = 20 };
    iso_paths in = {0}, out = {0};
    iso_arena arena = {0};
    iso_point at = {0, 0};
    seed = 5;
    for (int i = 0; i < CHAINS * LINKS + LOOSE; i++) {
        iso_point point[2];
        int chained = i < CHAINS * LINKS;
        for (int k = 0; k < 2; k++)
            point[k] = (iso_point){random_below(1000000), random_below(1000000)};
        iso_path like = {.role = ISO_ROLE_TOP_SOLID_INFILL,
                         .rank = chained ? i % LINKS : 0,
                         .follows = chained && i % LINKS > 0};
        CHECK_OK(iso_paths_add(&in, &like, point, 2, i, 1));
    }
    CHECK_OK(order_layer(&out, &in, &at, &arena));
    CHECK_EQUAL(in.count, out.count);
    for (int32_t i = 0; i < out.count; i++) {
        const iso_path_vertex *v = out.vertex + out.path[i].first;
        int32_t id = v->width, step = 0;
        if (id >= CHAINS * LINKS)
            continue;
        int32_t reversed = v->at.x != in.vertex[in.path[id].first].at.x;
        CHECK_EQUAL(reversed ? LINKS - 1 : 0, id % LINKS);
        for (step = 1; step < LINKS; step++) {
            const iso_path_vertex *w = out.vertex + out.path[i + step].first;
            CHECK_EQUAL(id + (reversed ? -step : step), w->width);
            CHECK_EQUAL(reversed, w->at.x != in.vertex[in.path[w->width].first].at.x);
        }
        i += LINKS - 1;
    }
    iso_paths_free(&in);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

int main(void) {
    RUN(test_random_layers_follow_the_rule);
    RUN(test_degenerate_spreads);
    RUN(test_solid_fill_goes_forth_and_back);
    RUN(test_anything_goes);
    RUN(test_chains_stay_whole);
    RUN(test_nothing_and_empty_paths);
    RUN(test_without_memory);
    return check_verdict();
}
