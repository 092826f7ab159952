/* In which order a layer is printed. */
#include "checks.h"
#include "solids.h"

static int is_wall(const print_move *m) {
    return m->role == ISO_ROLE_EXTERNAL_PERIMETER || m->role == ISO_ROLE_PERIMETER;
}

/* Two parts: each is finished before the other is begun, walls before fill; the skirt is first. */
static void test_parts_one_by_one(void) {
    shape s = {0};
    print p;
    solid_two(&s);
    print_shape(&p, &s, "layer_height = 0.2");
    print_check(&p, &s);
    for (int32_t l = 0; l < p.level_count; l++) {
        int changes = 0, last = -1, filled[2] = {0}, late = 0, skirt_late = 0, begun = 0;
        for (int32_t i = p.level[l].first; i < p.level[l + 1].first; i++) {
            const print_move *m = &p.move[i];
            if (m->kind != MOVE_DRAW)
                continue;
            skirt_late += begun && m->role == ISO_ROLE_SKIRT;
            if (m->role == ISO_ROLE_SKIRT)
                continue;
            int part = m->bx > 101; /* boxes 90 .. 98 and 104 .. 110 */
            begun = 1;
            changes += last >= 0 && part != last;
            last = part;
            late += is_wall(m) && filled[part];
            filled[part] |= !is_wall(m);
        }
        int both = p.level[l].z - p.level[l].height / 2 < 5.03;
        CHECK_EQUAL(both, changes);
        CHECK_EQUAL(0, late);
        CHECK_EQUAL(0, skirt_late);
    }
    print_free(&p);
    shape_free(&s);
}

/* From the innermost wall out, or the other way round. */
static void test_walls_in_order(void) {
    for (int first = 0; first < 2; first++) {
        shape s = {0};
        print p;
        solid_small(&s);
        print_shape(&p, &s,
                    first ? "perimeters = 4\nexternal_perimeters_first = 1" : "perimeters = 4");
        print_check(&p, &s);
        for (int32_t l = 0; l < p.level_count; l++) {
            int wrong = 0;
            double last = first ? 0 : 1e9;
            for (int32_t i = p.level[l].first; i < p.level[l + 1].first; i++) {
                const print_move *m = &p.move[i];
                if (m->kind != MOVE_DRAW || !is_wall(m))
                    continue;
                double x = fabs((m->ax + m->bx) / 2 - 100), y = fabs((m->ay + m->by) / 2 - 100);
                double depth = 5 - fmax(x, y);
                wrong += first ? depth < last - 0.002 : depth > last + 0.002;
                last = depth;
            }
            CHECK_EQUAL(0, wrong);
        }
        print_free(&p);
        shape_free(&s);
    }
}

/* Loops end where they begin, whatever their start; nothing is drawn twice in place. */
static void test_walls_close(void) {
    for (int m = 0; m < SOLID_COUNT; m++) {
        shape s = {0};
        print p;
        int open = 0;
        all_solids[m].make(&s);
        print_shape(&p, &s,
                    "fill_density = 0\ntop_solid_layers = 0\nbottom_solid_layers = 0\n"
                    "overhangs = 0\nthin_walls = 0");
        print_check(&p, &s);
        for (int32_t i = 0; i < p.move_count;) {
            int32_t end = i + 1;
            while (end < p.move_count && p.move[end].kind == p.move[i].kind &&
                   p.move[end].run == p.move[i].run)
                end++;
            const print_move *a = &p.move[i], *b = &p.move[end - 1];
            int wall = a->role == ISO_ROLE_EXTERNAL_PERIMETER || a->role == ISO_ROLE_PERIMETER;
            open += a->kind == MOVE_DRAW && wall && (a->ax != b->bx || a->ay != b->by);
            i = end;
        }
        CHECK_EQUAL(0, open);
        print_free(&p);
        shape_free(&s);
    }
}

/* A job of many small parts travels a path through all of them, not a star. */
static void test_travel_is_short(void) {
    shape s = {0};
    print p;
    for (int i = 0; i < 36; i++) {
        int x = i * 7 % 36 % 6, y = i * 7 % 36 / 6;
        shape_box(&s, 12 * x, 12 * y, 0, 12 * x + 4, 12 * y + 4, 0.6);
    }
    print_shape(&p, &s, "fill_density = 100%\nskirts = 0");
    print_check(&p, &s);
    for (int32_t l = 1; l < p.level_count; l++) {
        double travel = 0;
        for (int32_t i = p.level[l].first; i < p.level[l + 1].first; i++)
            travel += p.move[i].kind == MOVE_TRAVEL ? move_length(&p.move[i]) : 0;
        CHECK(travel < 36 * 14 + 80);
    }
    print_free(&p);
    shape_free(&s);
}

/* A draft shield around objects that are printed one after the other is drawn once, as high as the
 * highest; the next object doesn't begin it again at the bed. */
static void test_shield_is_drawn_once(void) {
    shape s = {0};
    print p;
    double highest = 0;
    int32_t drawn = 0;
    shape_box(&s, 0, 0, 0, 8, 8, 3);
    print_shape(&p, &s,
                "duplicate = 2\ncomplete_objects = 1\ndraft_shield = enabled\n"
                "skirts = 1\nextruder_clearance_height = 50");
    CHECK_OK(p.status);
    CHECK_EQUAL(20, p.level_count);
    for (int32_t i = 0; i < p.level_count; i++)
        if (print_length(&p, ISO_ROLE_SKIRT, i) > 0) {
            CHECK(p.level[i].z > highest);
            highest = p.level[i].z;
            drawn++;
        }
    CHECK_EQUAL(10, drawn);
    print_free(&p);
    shape_free(&s);
}

int main(void) {
    RUN(test_parts_one_by_one);
    RUN(test_walls_in_order);
    RUN(test_walls_close);
    RUN(test_travel_is_short);
    RUN(test_shield_is_drawn_once);
    CHECK(print_folder_remove());
    return check_verdict();
}
