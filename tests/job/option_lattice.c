/* Options of the lattices that fill_pattern knows. */
#include "option_row.h"
#include "solid/volume.h"

enum { SPARSE = ISO_ROLE_INTERNAL_INFILL };

#define SHEET "fill_pattern = gyroid_sheet\ninfill_anchor = 0\ninfill_anchor_max = 0\n"
#define OF(pattern) "fill_pattern = " pattern "\nfill_density = 40%\nlattice_cell = 4\n"

/* Two cells high. */
static void make_tall(shape *s) {
    shape_box(s, 0, 0, 0, 16, 16, 11.2);
}

static double filament(const print *p) {
    return print_filament(p, SPARSE, -1);
}

static double length(const print *p) {
    return print_length(p, SPARSE, -1);
}

static int same_sparse_places(const print *a, const print *b) {
    if (a->move_count != b->move_count)
        return 0;
    for (int32_t i = 0; i < a->move_count; i++)
        if (a->move[i].bx != b->move[i].bx || a->move[i].by != b->move[i].by)
            return 0;
    return 1;
}

/* Cells of 3 mm instead of 5 hold as much in walls that are as much longer as thinner. */
static void finer(const change *c) {
    CHECK_NEAR(1, filament(c->b) / filament(c->a), 0.1);
    CHECK_NEAR(5.0 / 3, length(c->b) / length(c->a), 0.25);
}

static void denser(const change *c) {
    CHECK_NEAR(2, filament(c->b) / filament(c->a), 0.1);
}

/* As much, elsewhere. */
static void elsewhere(const change *c) {
    CHECK_NEAR(1, filament(c->b) / filament(c->a), 0.25);
    CHECK(!same_sparse_places(c->a, c->b));
}

static void finer_pores(const change *c) {
    elsewhere(c);
    CHECK(print_runs(c->b, SPARSE, -1) > print_runs(c->a, SPARSE, -1));
}

/* ---- two materials ---- */

/* Of tool 1, within a box around the middle of the bed. */
static double share_between(const print *p, double low, double high) {
    iso_vec2 center = iso_options_center(&p->options);
    double of[2] = {0, 0};
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        double x = (m->ax + m->bx) / 2 - center.x;
        if (move_chosen(m, SPARSE, -1) && x > low && x < high)
            of[m->tool] += m->e;
    }
    return of[1] / (of[0] + of[1]);
}

static int tool_changes(const print *p) {
    int changes = 0;
    for (int32_t i = 1; i < p->move_count; i++)
        changes += p->move[i].layer >= 0 && p->move[i].tool != p->move[i - 1].tool;
    return changes;
}

/* One change a layer; walls, and all else but the lattice, are of the first. */
static void two_materials(const change *c) {
    int others = 0;
    for (int32_t i = 0; i < c->b->move_count; i++) {
        const print_move *m = &c->b->move[i];
        others += m->kind == MOVE_DRAW && m->tool != 0 && m->role != SPARSE;
    }
    CHECK_EQUAL(0, others);
    CHECK_EQUAL(0, tool_changes(c->a));
    CHECK(tool_changes(c->b) <= c->b->level_count && tool_changes(c->b) > 30);
    CHECK_EQUAL(c->b->report.print.tool_changes, tool_changes(c->b));
    CHECK_NEAR(1, filament(c->b) / filament(c->a), 0.002);
    CHECK(c->b->state.tool == c->b->move[c->b->move_count - 1].tool);
}

static void half_and_half(const change *c) {
    two_materials(c);
    CHECK_NEAR(0.5, share_between(c->b, -8, 8), 0.03);
}

static void more_on_the_right(const change *c) {
    two_materials(c);
    CHECK_NEAR(0.25, share_between(c->b, -6, -2), 0.07);
    CHECK_NEAR(0.75, share_between(c->b, 2, 6), 0.07);
}

/* At each change, with the numbers of the tools. */
static void toolchange_gcode(const change *c) {
    int changes = tool_changes(c->b), found = 0;
    CHECK(same_places(c->a, c->b));
    for (const char *at = c->b->text; (at = strstr(at, "\nM117 from ")); found++) {
        int from, to, named;
        double z;
        at++;
        CHECK_EQUAL(4, sscanf(at, "M117 from %d to %d at %lf\nT%d", &from, &to, &z, &named));
        CHECK(from == 1 - to && named == to && z > 0);
    }
    CHECK_EQUAL(changes, found);
}

/* It may take the tool by itself. */
static void tool_by_text(const change *c) {
    CHECK(same_places(c->a, c->b));
    CHECK_EQUAL(tool_changes(c->a), tool_changes(c->b));
    CHECK(!strstr(c->b->text, "T0 ; by text\nT") && strstr(c->b->text, "T0 ; by text\n"));
}

/* ---- files ---- */

static char cell_file[128], cell_base[512], grid_file[128], grid_base[512];

/* Of radius 6 or 4 in a box of 16. */
static void ball(float *value, iso_vec3 corner, double radius) {
    for (int k = 0; k < ISO_VOLUME_BLOCK * ISO_VOLUME_BLOCK * ISO_VOLUME_BLOCK; k++) {
        double x = corner.x + 0.5 * (k % 8) - 8, y = corner.y + 0.5 * (k / 8 % 8) - 8;
        double z = corner.z + 0.5 * (k / 64) - 8;
        value[k] = (float)(sqrt(x * x + y * y + z * z) - radius);
    }
}

static iso_status small_ball(void *payload, float *value, iso_vec3 corner) {
    (void)payload;
    ball(value, corner, 4);
    return ISO_OK;
}

static iso_status off_middle(void *payload, float *value, iso_vec3 corner) {
    (void)payload;
    corner.x -= 3;
    ball(value, corner, 4);
    return ISO_OK;
}

/* A mask that is on where x is above 0. */
static iso_status right_half(void *payload, float *value, iso_vec3 corner) {
    (void)payload;
    for (int k = 0; k < ISO_VOLUME_BLOCK * ISO_VOLUME_BLOCK * ISO_VOLUME_BLOCK; k++)
        value[k] = corner.x + 0.5 * (k % 8) > 0 ? -1 : 1;
    return ISO_OK;
}

static iso_status far_end(void *payload, float *value, iso_vec3 corner) {
    (void)payload;
    for (int k = 0; k < ISO_VOLUME_BLOCK * ISO_VOLUME_BLOCK * ISO_VOLUME_BLOCK; k++)
        value[k] = corner.x + 0.5 * (k % 8) > 11 ? -1 : 1;
    return ISO_OK;
}

static const char *write_grid(volume_fill *fill, iso_volume_kind kind, const char *name) {
    iso_volume_plan plan = {.min = {-12, -12, -12},
                            .max = {15.5, 15.5, 15.5},
                            .voxel = 0.5,
                            .kind = kind,
                            .name = "grid",
                            .fill = fill};
    iso_volume *volume;
    const char *path = print_path(name);
    if (!CHECK_OK(volume_build(&volume, &plan)))
        return path;
    CHECK_OK(volume_write(volume, path));
    volume_free(volume);
    return path;
}

static void make_with_cell(shape *s) {
    snprintf(cell_base, sizeof cell_base, "%slattice_file = %s", OF("voxel_file"),
             write_grid(off_middle, ISO_VOLUME_DISTANCE, "other.vdb"));
    snprintf(cell_file, sizeof cell_file, "%s",
             write_grid(small_ball, ISO_VOLUME_DISTANCE, "cell.vdb"));
    make_block(s);
}

static void make_with_grid(shape *s) {
    snprintf(grid_base, sizeof grid_base, SHEET "lattice_density = 20+40*grid\nlattice_grid = %s",
             write_grid(far_end, ISO_VOLUME_SOLID, "far.vdb"));
    snprintf(grid_file, sizeof grid_file, "%s",
             write_grid(right_half, ISO_VOLUME_SOLID, "right.vdb"));
    make_block(s);
}

static double filament_beside(const print *p, int right) {
    iso_vec2 center = iso_options_center(&p->options);
    double sum = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (move_chosen(&p->move[i], SPARSE, -1) && (p->move[i].bx > center.x) == right)
            sum += p->move[i].e;
    return sum;
}

/* A mask is 1 where it is on: there it's 60 percent instead of 20. */
static void denser_on_the_right(const change *c) {
    CHECK_NEAR(3, filament_beside(c->b, 1) / filament_beside(c->a, 1), 0.4);
    CHECK_NEAR(1, filament_beside(c->b, 0) / filament_beside(c->a, 0), 0.2);
}

const option_row option_rows_lattice[] = {
    {make_tall, "lattice_cell", "3", SHEET "lattice_density = 18", finer},
    {make_tall, "lattice_cell", "3", OF("bcc_struts") "lattice_cell = 5", elsewhere},
    {make_tall, "lattice_material", "50", SHEET "lattice_cell = 1.5", half_and_half},
    {make_tall, "lattice_material", "50+6.25*x", SHEET "lattice_cell = 1.5", more_on_the_right},
    {make_tall, "toolchange_gcode",
     "M117 from {previous_extruder} to {next_extruder} at {toolchange_z}",
     SHEET "lattice_material = 50", toolchange_gcode},
    {make_tall, "toolchange_gcode", "M117\\nT{next_extruder} ; by text\\nM117 done",
     SHEET "lattice_material = 50", tool_by_text},
    {make_tall, "lattice_density", "40", SHEET "fill_density = 20%", denser},
    {make_tall, "lattice_density", "20+20", SHEET "fill_density = 20%", denser},
    {make_tall, "lattice_density", "40", OF("kelvin_struts") "fill_density = 20%", denser},
    {make_block, "lattice_map", "cylinder", OF("gyroid_sheet"), elsewhere},
    {make_block, "lattice_map", "sphere", OF("diamond_sheet"), elsewhere},
    {make_block, "lattice_seed", "7", OF("foam_sheet"), elsewhere},
    {make_block, "lattice_seed", "7", OF("bone_sheet"), elsewhere},
    {make_block, "lattice_pore", "0.2", OF("voxel_random") "lattice_cell = 8", finer_pores},
    {make_with_cell, "lattice_file", cell_file, cell_base, elsewhere},
    {make_with_grid, "lattice_grid", grid_file, grid_base, denser_on_the_right},
    {0},
};
