/* What becomes of places too narrow for the regular beads. */
#include "option_row.h"

/* A blade 0.5 mm thick, and a bar with a gap between its outermost walls. */
static void make_narrow(shape *s) {
    shape_box(s, 0, 0, 0, 12, 0.5, 2);
    shape_box(s, 0, 4, 0, 12, 5.1, 2);
}

/* One wider bead there and not back. */
static void thin_walls(const change *c) {
    double a = print_length(c->a, ISO_ROLE_EXTERNAL_PERIMETER, 3);
    double b = print_length(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 3);
    CHECK_NEAR(12 - 0.25, b - a + 2 * (12 - 0.45), 0.5);
    CHECK(print_filament(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 3) <
          print_filament(c->a, ISO_ROLE_EXTERNAL_PERIMETER, 3));
}

static void gap_fill_enabled(const change *c) {
    double spacing = 0.45 - 0.2 * (1 - 3.14159265 / 4), gap = 1.1 - 0.45 - spacing;
    double section = 3.14159265 * 1.75 * 1.75 / 4;
    double length = print_length(c->b, ISO_ROLE_GAP_FILL, 3);
    CHECK_NEAR(0, print_length(c->a, ISO_ROLE_GAP_FILL, -1), 0);
    CHECK_NEAR(12 - 0.45 - spacing - gap / 2, length, 0.3);
    CHECK_NEAR(gap * 0.2 * length / section, print_filament(c->b, ISO_ROLE_GAP_FILL, 3),
               0.02 * gap * 0.2 * length / section);
}

static void gap_fill_speed(const change *c) {
    int32_t seen = 0;
    for (int32_t i = 0; i < c->b->move_count; i++)
        if (move_chosen(&c->b->move[i], ISO_ROLE_GAP_FILL, 3)) {
            seen++;
            CHECK_NEAR(33 * 60, c->b->move[i].f, 0.5);
        }
    CHECK(seen > 0);
}

static void gap_fill_speed_none(const change *c) {
    CHECK(print_length(c->a, ISO_ROLE_GAP_FILL, -1) > 10);
    CHECK_NEAR(0, print_length(c->b, ISO_ROLE_GAP_FILL, -1), 0);
}

const option_row option_rows_walls[] = {
    {make_narrow, "thin_walls", "1", "thin_walls = 0\nskirts = 0", thin_walls},
    {make_narrow, "gap_fill_enabled", "1", "gap_fill_enabled = 0\nskirts = 0\nlayer_height = 0.2",
     gap_fill_enabled},
    {make_narrow, "gap_fill_speed", "33", STEADY "skirts = 0", gap_fill_speed},
    {make_narrow, "gap_fill_speed", "0", STEADY "skirts = 0", gap_fill_speed_none},
    {0},
};
