#include "config/settings.h"

#include <math.h>

#include "gcode/number.h"

/* A wall no longer around than a circle of this radius is a small one; the figure is PrusaSlicer's.
 */
#define SMALL_RADIUS 6.5
#define PI 3.14159265358979323846

/* No finer arcs than 2 um from the true one, whatever gcode_resolution says: each wall would draw a
 * hundred points around every point of the one before. */
enum { FINEST_ARC = 20 };

/* In spacings of solid lines: so much that the solid parts of a print are as large as
 * PrusaSlicer's, which grows narrow ones layer by layer. Bridges reach as far onto what carries
 * them, but not on solid layers, which their thick beads would overfill. */
enum { TOP_ANCHOR = 2, SHELL_ANCHOR = 5, BRIDGE_ANCHOR = 2, LID_ANCHOR = 2 };

enum { BRIDGE_GAP = 500 }; /* units between the threads of a bridge; the figure is PrusaSlicer's */

static iso_bead bead_of(const iso_options *options, iso_role role, bool first, double height) {
    return iso_bead_of(iso_units(iso_options_width(options, role, first, height)),
                       iso_units(height));
}

/* Of gcode_resolution, the part that outlines may use up; arcs of offsets take as much, and the
 * rest is for the rounding of both. */
static int32_t thinning(const iso_options *options) {
    return iso_units(0.4 * options->gcode_resolution);
}

static void set_walls(iso_layer_settings *s, const iso_options *options, bool first,
                      double height) {
    int32_t tolerance = thinning(options);
    s->thinning = tolerance;
    s->wall = (iso_wall_options){
        .count = options->perimeters,
        .external = bead_of(options, ISO_ROLE_EXTERNAL_PERIMETER, first, height),
        .inner = bead_of(options, ISO_ROLE_PERIMETER, first, height),
        .external_first = options->external_perimeters_first,
        .small_length = iso_units(2 * PI * SMALL_RADIUS),
        .arc_tolerance = tolerance > FINEST_ARC ? tolerance : FINEST_ARC,
    };
    if (options->thin_walls)
        s->wall.thin_least = iso_units(options->nozzle_diameter / 3);
    if (options->gap_fill_enabled && options->gap_fill_speed > 0)
        s->wall.gap_least = s->wall.inner.width / 5;
}

/* What is done to the outlines before the walls, and to the skin after. */
static void set_outline(iso_layer_settings *s, const iso_options *options, bool first) {
    s->compensation =
        (iso_compensation){.all = iso_units(options->xy_size_compensation),
                           .holes = iso_units(options->xy_hole_compensation),
                           .foot = first ? iso_units(options->elefant_foot_compensation) : 0,
                           .narrowest = s->wall.external.width};
    s->drains = (iso_drains){.count = options->lattice_drain.count / 2,
                             .at = options->lattice_drain.value,
                             .radius = options->lattice_drain_diameter / 2};
    s->fuzzy = (iso_fuzzy_options){.on = options->fuzzy_skin != ISO_FUZZY_NONE && !first,
                                   .holes = options->fuzzy_skin == ISO_FUZZY_ALL,
                                   .thickness = iso_units(options->fuzzy_skin_thickness),
                                   .distance = iso_units(options->fuzzy_skin_point_dist)};
}

static iso_fill_options fill_of(const iso_options *options, iso_role role, bool first,
                                double height, double density) {
    iso_fill_options fill = iso_fill_defaults(bead_of(options, role, first, height), density);
    fill.angle = options->fill_angle;
    fill.like.role = (uint8_t)role;
    fill.like.rank = options->perimeters;
    return fill;
}

/* Without walls there is nothing to bond with; and no fill reaches through the innermost of them.
 */
static int32_t overlap_of(const iso_layer_settings *s, const iso_options *options, bool first,
                          double height) {
    const iso_bead *innermost = s->wall.count == 1 ? &s->wall.external : &s->wall.inner;
    int32_t overlap = iso_units(iso_options_infill_overlap(options, first, height));
    if (s->wall.count == 0)
        return 0;
    return overlap < innermost->spacing ? overlap : innermost->spacing;
}

static void set_pattern(iso_fill_options *fill, int32_t pattern, int32_t index) {
    bool gives_way = fill->density >= 1 && !iso_fill_pattern_is_solid((iso_fill_pattern)pattern);
    fill->pattern = gives_way ? ISO_PATTERN_RECTILINEAR : pattern;
    fill->angle += iso_fill_pattern_turn((iso_fill_pattern)fill->pattern, index);
    fill->layer = index;
}

/* At full density lines are fitted to each part; sparse ones keep their place from layer to layer.
 */
static void set_fill(iso_layer_settings *s, const iso_options *options, int32_t index, bool first,
                     double height) {
    double density = settings_density(options) / 100;
    bool full = density >= 1;
    iso_role role = ISO_ROLE_INTERNAL_INFILL; /* even if it is full: its speed is that of infill */
    iso_bead solid = bead_of(options, ISO_ROLE_SOLID_INFILL, first, height);
    s->top = fill_of(options, ISO_ROLE_TOP_SOLID_INFILL, first, height, 1);
    s->solid = fill_of(options, ISO_ROLE_SOLID_INFILL, first, height, 1);
    set_pattern(&s->top, options->top_fill_pattern, index);
    set_pattern(&s->solid, first ? options->bottom_fill_pattern : ISO_PATTERN_RECTILINEAR, index);
    s->has_sparse = density > 0;
    if (s->has_sparse) {
        s->sparse = fill_of(options, role, first, height, density);
        set_pattern(&s->sparse, options->fill_pattern, index);
    }
    bool closes_pores = settings_have_lattice(options) && options->perimeters == 0;
    if (closes_pores) {
        s->sparse.link_max = s->sparse.anchor = 0;
    } else if (s->has_sparse && !full) {
        double width = iso_options_width(options, role, first, height);
        s->sparse.anchor = iso_units(iso_relative_of(options->infill_anchor, width));
        s->sparse.link_max = iso_units(iso_relative_of(options->infill_anchor_max, width));
    }
    s->fill_inset = solid.spacing / 2 - overlap_of(s, options, first, height);
    s->gap = iso_gap_defaults(&solid, s->wall.gap_least);
    s->gap.like.rank = options->perimeters;
    s->gap.shortest = 6; /* what lines leave open is narrow, and never wide enough to be seen */
}

/* Lines so close that the nozzle's face smooths what is there, with little of their own. */
static void set_ironing(iso_layer_settings *s, const iso_options *options, double height) {
    int32_t spacing = iso_units(options->ironing_spacing);
    s->irons = !options->ironing ? 0 : options->ironing_type == ISO_IRONING_SOLID ? 2 : 1;
    s->ironing_inset = iso_units(options->nozzle_diameter) / 2;
    s->ironing = s->top;
    s->ironing.pattern = ISO_PATTERN_RECTILINEAR;
    s->ironing.angle = s->top.angle + 45;
    s->ironing.spacing = spacing;
    s->ironing.fit = s->ironing.margin = 0;
    s->ironing.link_max = 5 * spacing;
    s->ironing.width = iso_units(options->nozzle_diameter);
    s->ironing.area =
        (int32_t)(spacing * height * ISO_UNITS_PER_MM * options->ironing_flowrate / 100);
    s->ironing.like.role = ISO_ROLE_IRONING;
}

/* Threads through the air are round, as thick as the nozzle, and lie a little apart; else they are
 * beads of the layer's height with some other flow. */
static iso_bead bridge_bead(const iso_options *options, iso_role role, bool first, double height) {
    iso_bead bead = bead_of(options, role, first, height);
    double ratio = options->bridge_flow_ratio;
    bead.area = (int32_t)(bead.area * ratio + 0.5);
    if (!options->thick_bridges)
        return bead;
    bead.width = bead.height = iso_units(options->nozzle_diameter * sqrt(ratio));
    bead.area = iso_bead_of(bead.width, bead.height).area;
    bead.spacing = bead.width + BRIDGE_GAP;
    return bead;
}

/* bridge_angle is a direction from 180 degrees on, as for PrusaSlicer: 0 is none. */
static void set_bridges(iso_layer_settings *s, const iso_options *options, bool first,
                        double height) {
    iso_bead bead = bridge_bead(options, ISO_ROLE_SOLID_INFILL, first, height);
    iso_bead wall = bridge_bead(options, ISO_ROLE_PERIMETER, first, height);
    s->bridge = iso_fill_defaults(bead, 1);
    s->bridge.even = 1;
    s->bridge.angle = s->solid.angle;
    s->bridge.like = s->solid.like;
    s->bridge.like.role = ISO_ROLE_BRIDGE_INFILL;
    s->lid = s->bridge;
    s->bridge_angle_given = options->bridge_angle > 0;
    if (s->bridge_angle_given)
        s->bridge.angle = options->bridge_angle;
    s->lid_least = settings_density(options) < 100 ? 2 * bead.width : 0;
    s->lid_anchor = LID_ANCHOR * bead.spacing;
    s->overhang = (iso_overhang_options){.reach = iso_units(options->nozzle_diameter) / 2,
                                         .shortest = wall.width,
                                         .width = wall.width,
                                         .area = wall.area};
    if (!options->overhangs)
        s->overhang.reach = 0;
}

/* Solid strips that are next to nothing are left to the walls above and below them, unless the
 * shell has to be as thick everywhere; others reach some lines into the sparse fill, so that lines
 * across them are long enough to hold. Between the fill and the outlines around it there is a wall,
 * wider than what those are thinned by. */
static void set_shell(iso_layer_settings *s, const iso_options *options, int32_t index, bool first,
                      double height) {
    bool full = settings_density(options) >= 100;
    int32_t spacing = bead_of(options, ISO_ROLE_SOLID_INFILL, first, height).spacing;
    int32_t every = options->solid_infill_every_layers;
    bool exact = options->ensure_vertical_shell_thickness;
    s->shell = (iso_shell_options){
        .narrowest = full    ? 2 * spacing
                     : exact ? spacing / 32
                             : spacing / 6,
        .top_anchor = full ? 0 : TOP_ANCHOR * spacing,
        .anchor = full ? 0 : SHELL_ANCHOR * spacing,
        .bridge_least = spacing,
        .bridge_anchor = (full ? BRIDGE_ANCHOR : SHELL_ANCHOR) * spacing,
        .whole = !full && settings_density(options) > 0 && every > 0 && index % every == 0,
    };
    s->coarse = full ? spacing / 2 : exact || options->perimeters == 0 ? spacing / 64 : spacing / 4;
    if (!full && settings_density(options) > 0)
        s->shell.sparse_least =
            (int64_t)(options->solid_infill_below_area * 2 * ISO_UNITS_PER_MM * ISO_UNITS_PER_MM);
}

iso_shell_depth settings_of_shells(const iso_options *options) {
    bool full = settings_density(options) >= 100;
    iso_shell_depth depth = {.top_layers = options->top_solid_layers,
                             .bottom_layers = options->bottom_solid_layers,
                             .top_thickness = options->top_solid_min_thickness,
                             .bottom_thickness = options->bottom_solid_min_thickness,
                             .bridges = options->bottom_solid_layers > 0};
    if (full) {
        depth.top_layers = depth.top_layers > 0;
        depth.bottom_layers = 0;
        depth.top_thickness = 0;
    }
    return depth;
}

void settings_of_layer(iso_layer_settings *s, const iso_options *options, int32_t index,
                       double height) {
    bool first = index == 0;
    set_walls(s, options, first, height);
    set_outline(s, options, first);
    set_fill(s, options, index, first, height);
    set_ironing(s, options, height);
    set_shell(s, options, index, first, height);
    set_bridges(s, options, first, height);
}

void settings_of_combination(iso_layer_settings *s, const iso_options *options, int32_t turn,
                             double height) {
    int32_t high = iso_units(height), width = s->sparse.width > high ? s->sparse.width : high;
    iso_fill_options *fill = &s->together;
    *fill = iso_fill_defaults(iso_bead_of(width, high), settings_density(options) / 100);
    fill->angle = options->fill_angle;
    fill->like = s->sparse.like;
    fill->anchor = s->sparse.anchor;
    fill->link_max = s->sparse.link_max;
    set_pattern(fill, options->fill_pattern, turn);
}

iso_lattice_options settings_of_lattice(const iso_options *options, char percent[32]) {
    /* not by printf, whose decimal point is the locale's */
    *iso_put_decimal(percent, (int64_t)(options->fill_density * 1e9 + 0.5), 9) = '\0';
    return (iso_lattice_options){.pattern = options->fill_pattern - ISO_PATTERN_LATTICE,
                                 .map = options->lattice_map,
                                 .cell = options->lattice_cell,
                                 .density = options->lattice_density[0] ? options->lattice_density
                                                                        : percent,
                                 .material = options->lattice_material,
                                 .seed = (uint64_t)options->lattice_seed,
                                 .pore = options->lattice_pore,
                                 .file = options->lattice_file,
                                 .grid = options->lattice_grid};
}

/* s to move the filament by `length`, from standing to standing. */
static double filament_seconds(double length, double speed, double acceleration) {
    double ramps = speed * speed / acceleration;
    return length < ramps ? 2 * sqrt(length / acceleration) : (length + ramps) / speed;
}

iso_order_options settings_of_order(const iso_options *options) {
    double acceleration = options->machine_max_acceleration_retracting;
    double back = options->retract_speed;
    double forth = options->deretract_speed > 0 ? options->deretract_speed : back;
    iso_order_options order = iso_order_defaults();
    order.seam = (iso_seam)options->seam_position;
    order.infill_first = options->infill_first;
    order.retract_crossing_only = options->only_retract_when_crossing_perimeters;
    order.avoid_crossing = options->avoid_crossing_perimeters;
    const iso_relative *detour = &options->avoid_crossing_perimeters_max_detour;
    *(detour->percent ? &order.max_detour_share : &order.max_detour) =
        detour->percent ? detour->value / 100 : detour->value * ISO_UNITS_PER_MM;
    order.cost = (iso_travel_cost){
        .speed = options->travel_speed * ISO_UNITS_PER_MM,
        .acceleration = options->machine_max_acceleration_travel * ISO_UNITS_PER_MM,
        .retraction = filament_seconds(options->retract_length, back, acceleration) +
                      filament_seconds(options->retract_length, forth, acceleration),
        .retract_before = options->retract_before_travel * ISO_UNITS_PER_MM,
        .junction_deviation = options->machine_max_junction_deviation * ISO_UNITS_PER_MM};
    return order;
}
