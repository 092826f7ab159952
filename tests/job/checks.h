/* What every good print has to have. */
#ifndef TESTS_JOB_CHECKS_H
#define TESTS_JOB_CHECKS_H

#include "check.h"
#include "print.h"

static inline void check_machine(const print *p) {
    if (!CHECK_EQUAL(FIO_OK, p->verdict) || !CHECK_EQUAL(0, p->machine.fault_count) ||
        !CHECK_EQUAL(0, p->machine.warning_count))
        fprintf(stderr, "    %s\n", p->complaint);
    for (int i = 0; i < FIO_TOOLS_MOST; i++)
        CHECK(p->state.nozzle_target[i] == 0);
    CHECK(p->state.bed_target == 0);
    CHECK(p->state.fan == 0);
}

/* Of all tools. */
static inline double print_footer(const print *p, const char *text) {
    const char *at = strstr(p->text, text);
    char *end;
    if (!at)
        return -1;
    double sum = strtod(at + strlen(text), &end);
    while (*end == ',')
        sum += strtod(end + 1, &end);
    return sum;
}

static inline void check_totals(const print *p) {
    const iso_gcode_totals *t = &p->report.print;
    double drawn = 0, bead = 0, travel = 0;
    long moves = 0, retractions = 0;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind == MOVE_DRAW) {
            drawn += m->e;
            bead += move_length(m);
        } else if (m->kind == MOVE_TRAVEL && m->layer >= 0 && m->ax > -1e3) {
            travel += move_length(m);
        }
        retractions += m->kind == MOVE_FILAMENT && m->e < 0;
        moves += m->kind == MOVE_DRAW;
    }
    CHECK_NEAR(t->filament_mm, drawn, 2e-5);
    CHECK_NEAR(p->machine.extruded_along_paths, drawn, 1e-4 + 1e-7 * drawn);
    CHECK_NEAR(print_footer(p, "; filament used [mm] = "), drawn, 0.01001);
    double section = SHAPE_PI / 4 * p->options.filament_diameter * p->options.filament_diameter;
    CHECK_NEAR(t->filament_cm3, drawn * section / 1000, 1e-6 + 1e-9 * drawn);
    CHECK_NEAR(print_footer(p, "; filament used [cm3] = "), t->filament_cm3, 0.01001);
    CHECK_NEAR(t->filament_cm3 * p->options.filament_density, t->filament_g, 1e-9);
    CHECK_NEAR(t->bead_mm, bead, 1e-6 * bead + 1e-6);
    CHECK(t->travel_mm >= travel - 1e-3);
    CHECK(t->moves >= moves);
    CHECK_EQUAL(t->retractions, retractions);
    CHECK_EQUAL(t->bytes, p->size);
    CHECK_EQUAL(t->layers, p->level_count);
    CHECK_EQUAL(p->report.layer_count, p->level_count);
    CHECK(t->time > 0 && t->idle_time <= t->time);
}

/* Heights as asked for, tops their sums, each move at its layer's height. */
static inline void check_levels(const print *p) {
    double height[ISO_NUMBERS_MAX + 1], top = 0;
    int32_t count = iso_options_heights(height, &p->options);
    for (int32_t i = 0; i < p->level_count; i++) {
        double own = height[i < count ? i : count - 1];
        top += own;
        CHECK_NEAR(own, p->level[i].height, 1e-9);
        CHECK_NEAR(top, p->level[i].z, 5.1e-5);
    }
    if (!CHECK_NEAR(top, p->report.printed_height, 1e-9))
        return;
    int wrong = 0;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        wrong +=
            m->kind == MOVE_DRAW &&
            (m->az != m->bz || fabs(m->bz - p->options.z_offset - p->level[m->layer].z) > 0.00051);
    }
    CHECK_EQUAL(0, wrong);
}

/* Beads of walls stay within the model, the middles of all others as well. */
static inline void check_box(const print *p, const shape *s) {
    shape_box3 b = shape_bounds(s);
    iso_vec2 center = iso_options_center(&p->options);
    double half[2] = {(b.max[0] - b.min[0]) / 2, (b.max[1] - b.min[1]) / 2}, slack = 0.002;
    int outside = 0;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, -1, -1))
            continue;
        int wall = m->role == ISO_ROLE_EXTERNAL_PERIMETER || m->role == ISO_ROLE_PERIMETER;
        double inset = wall ? m->width / 2 - p->options.gcode_resolution : 0;
        outside += fabs(m->bx - center.x) > half[0] - inset + slack ||
                   fabs(m->by - center.y) > half[1] - inset + slack;
        if (outside == 1)
            fprintf(stderr, "    (%.3f, %.3f), %s, layer %d\n", m->bx, m->by,
                    m->role < 0 ? "?" : iso_role_name((iso_role)m->role), m->layer + 1);
    }
    CHECK_EQUAL(0, outside);
}

typedef struct place_faults {
    int outside, wall_off;
} place_faults;

/* The middle of a drawn piece lies within the section; the outermost wall half a bead inside. What
 * outlines and arcs may be off is allowed. */
static inline void check_place(place_faults *faults, const print *p, const print_move *m,
                               const double (*piece)[4], int64_t count) {
    double x = (m->ax + m->bx) / 2, y = (m->ay + m->by) / 2;
    double off = p->options.gcode_resolution + 0.002;
    double distance = section_distance(piece, count, x, y);
    faults->outside += section_winding(piece, count, x, y) <= 0 && distance > off;
    faults->wall_off +=
        m->role == ISO_ROLE_EXTERNAL_PERIMETER && fabs(distance - m->width / 2) > off;
}

/* Some hundred places of the print against the sections of the model. */
static inline void check_places(const print *p, const shape *s) {
    enum { PLACES = 600 };
    double(*piece)[4] = malloc((size_t)(s->count + 1) * sizeof *piece), top = 0;
    shape_box3 b = shape_bounds(s);
    iso_vec2 center = iso_options_center(&p->options);
    double dx = center.x - (b.min[0] + b.max[0]) / 2, dy = center.y - (b.min[1] + b.max[1]) / 2;
    place_faults faults = {0};
    int32_t step = p->move_count / PLACES + 1;
    for (int32_t l = 0; l < p->level_count; l++) {
        double height = p->level[l].height;
        int64_t count = shape_section(piece, s, b.min[2] + top + height / 2);
        top += height;
        for (int64_t i = 0; i < count; i++)
            piece[i][0] += dx, piece[i][2] += dx, piece[i][1] += dy, piece[i][3] += dy;
        for (int32_t i = p->level[l].first; i < p->level[l + 1].first; i++)
            if (i % step == 0 && move_chosen(&p->move[i], -1, -1))
                check_place(&faults, p, &p->move[i], (const double(*)[4])piece, count);
    }
    CHECK_EQUAL(0, faults.outside);
    CHECK_EQUAL(0, faults.wall_off);
    free(piece);
}

static inline void print_check(const print *p, const shape *s) {
    if (!CHECK_EQUAL(ISO_OK, p->status)) {
        fprintf(stderr, "    %s\n", p->message);
        return;
    }
    check_machine(p);
    check_totals(p);
    check_levels(p);
    check_box(p, s);
    check_places(p, s);
    double layered = shape_layered_volume(s, p);
    /* outlines may be thinned by 0.4 resolutions, docs/how-it-works.md, and are rounded */
    double edge = shape_surface(s) * (0.4 * p->options.gcode_resolution + 1e-4);
    CHECK_NEAR(layered, p->report.sliced_volume, edge);
}

#endif
