/* The one list of options. From it come the struct, the defaults, the keys of configuration files,
 * the flags of the command line, the range checks, the manual and the block at the end of a G-code
 * file.
 *
 *     ISO_OPTION(key, kind, default, unit, min, max, category, help)
 *
 * Names, units and meaning are PrusaSlicer's wherever it has the key. The default is the text a
 * user would write. Kinds (config.h has their types):
 *
 *     BOOL  INTEGER  NUMBER  PERCENT
 *     RELATIVE                      in the unit, or in % of something that the help names
 *     PATTERN  FLAVOUR  SEAM ...     a word of the lists below
 *     TEXT  PLACE  POINTS  NUMBERS  min and max bound each coordinate or number
 */

#ifdef ISO_WORD /* ISO_WORD(kind, value, word) */
ISO_WORD(PATTERN, ISO_PATTERN_RECTILINEAR, "rectilinear")
ISO_WORD(PATTERN, ISO_PATTERN_ALIGNED, "alignedrectilinear")
ISO_WORD(PATTERN, ISO_PATTERN_MONOTONIC, "monotonic")
ISO_WORD(PATTERN, ISO_PATTERN_GRID, "grid")
ISO_WORD(PATTERN, ISO_PATTERN_TRIANGLES, "triangles")
ISO_WORD(PATTERN, ISO_PATTERN_STARS, "stars")
ISO_WORD(PATTERN, ISO_PATTERN_CUBIC, "cubic")
ISO_WORD(PATTERN, ISO_PATTERN_LINE, "line")
ISO_WORD(PATTERN, ISO_PATTERN_CONCENTRIC, "concentric")
ISO_WORD(PATTERN, ISO_PATTERN_HONEYCOMB, "honeycomb")
ISO_WORD(PATTERN, ISO_PATTERN_HONEYCOMB_3D, "3dhoneycomb")
ISO_WORD(PATTERN, ISO_PATTERN_GYROID, "gyroid")
ISO_WORD(PATTERN, ISO_PATTERN_HILBERT, "hilbertcurve")
ISO_WORD(PATTERN, ISO_PATTERN_ARCHIMEDEAN, "archimedeanchords")
ISO_WORD(PATTERN, ISO_PATTERN_OCTAGRAM, "octagramspiral")
ISO_WORD(PATTERN, ISO_PATTERN_MONOTONIC_LINES, "monotoniclines")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_GYROID_SHEET, "gyroid_sheet")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_GYROID_SOLID, "gyroid_solid")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_PRIMITIVE_SHEET, "primitive_sheet")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_PRIMITIVE_SOLID, "primitive_solid")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_DIAMOND_SHEET, "diamond_sheet")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_DIAMOND_SOLID, "diamond_solid")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_IWP_SHEET, "iwp_sheet")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_IWP_SOLID, "iwp_solid")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_NEOVIUS_SHEET, "neovius_sheet")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_NEOVIUS_SOLID, "neovius_solid")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_FISCHER_KOCH_SHEET, "fischer_koch_sheet")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_FISCHER_KOCH_SOLID, "fischer_koch_solid")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_BCC_STRUTS, "bcc_struts")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_FCC_STRUTS, "fcc_struts")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_OCTET_STRUTS, "octet_struts")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_KELVIN_STRUTS, "kelvin_struts")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_DIAMOND_STRUTS, "diamond_struts")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_FOAM_STRUTS, "foam_struts")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_FOAM_SHEET, "foam_sheet")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_BONE_SHEET, "bone_sheet")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_BONE_SOLID, "bone_solid")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_VOXEL_CUBIC, "voxel_cubic")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_VOXEL_RANDOM, "voxel_random")
ISO_WORD(PATTERN, ISO_PATTERN_LATTICE + ISO_LATTICE_VOXEL_FILE, "voxel_file")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_MARLIN2, "marlin2")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_MARLIN, "marlin")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_KLIPPER, "klipper")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_REPRAP, "reprap")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_REPRAPFIRMWARE, "reprapfirmware")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_REPETIER, "repetier")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_SMOOTHIE, "smoothie")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_TEACUP, "teacup")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_MACHINEKIT, "machinekit")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_MACH3, "mach3")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_SAILFISH, "sailfish")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_MAKERWARE, "makerware")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_NO_EXTRUSION, "no-extrusion")
ISO_WORD(SEAM, ISO_SEAM_RANDOM, "random")
ISO_WORD(SEAM, ISO_SEAM_NEAREST, "nearest")
ISO_WORD(SEAM, ISO_SEAM_ALIGNED, "aligned")
ISO_WORD(SEAM, ISO_SEAM_REAR, "rear")
ISO_WORD(BRIM, ISO_BRIM_NONE, "no_brim")
ISO_WORD(BRIM, ISO_BRIM_OUTER, "outer_only")
ISO_WORD(BRIM, ISO_BRIM_INNER, "inner_only")
ISO_WORD(BRIM, ISO_BRIM_BOTH, "outer_and_inner")
ISO_WORD(SHIELD, ISO_SHIELD_DISABLED, "disabled")
ISO_WORD(SHIELD, ISO_SHIELD_LIMITED, "limited")
ISO_WORD(SHIELD, ISO_SHIELD_ENABLED, "enabled")
ISO_WORD(FUZZY, ISO_FUZZY_NONE, "none")
ISO_WORD(FUZZY, ISO_FUZZY_EXTERNAL, "external")
ISO_WORD(FUZZY, ISO_FUZZY_ALL, "all")
ISO_WORD(IRONING, ISO_IRONING_TOP, "top")
ISO_WORD(IRONING, ISO_IRONING_TOPMOST, "topmost")
ISO_WORD(IRONING, ISO_IRONING_SOLID, "solid")
ISO_WORD(LIMITS, ISO_LIMITS_EMIT, "emit_to_gcode")
ISO_WORD(LIMITS, ISO_LIMITS_ESTIMATE, "time_estimate_only")
ISO_WORD(LIMITS, ISO_LIMITS_IGNORE, "ignore")
ISO_WORD(LABELS, ISO_LABELS_DISABLED, "disabled")
ISO_WORD(LABELS, ISO_LABELS_OCTOPRINT, "octoprint")
ISO_WORD(LABELS, ISO_LABELS_FIRMWARE, "firmware")
ISO_WORD(ARCS, ISO_ARCS_DISABLED, "disabled")
ISO_WORD(ARCS, ISO_ARCS_EMIT_CENTER, "emit_center")
ISO_WORD(CUT, ISO_CUT_BOTH, "both")
ISO_WORD(CUT, ISO_CUT_UPPER, "upper")
ISO_WORD(CUT, ISO_CUT_LOWER, "lower")
ISO_WORD(MIRROR, ISO_MIRROR_NONE, "none")
ISO_WORD(MIRROR, ISO_MIRROR_X, "x")
ISO_WORD(MIRROR, ISO_MIRROR_Y, "y")
ISO_WORD(MIRROR, ISO_MIRROR_Z, "z")
ISO_WORD(MAP, ISO_LATTICE_MAP_XYZ, "xyz")
ISO_WORD(MAP, ISO_LATTICE_MAP_CYLINDER, "cylinder")
ISO_WORD(MAP, ISO_LATTICE_MAP_SPHERE, "sphere")
ISO_WORD(MAP, ISO_LATTICE_MAP_SKIN, "skin")
ISO_WORD(MAP, ISO_LATTICE_MAP_SKIN_CYLINDER, "skin_cylinder")
ISO_WORD(CHECK, ISO_CHECK_OFF, "off")
ISO_WORD(CHECK, ISO_CHECK_AUTO, "auto")
ISO_WORD(CHECK, ISO_CHECK_FULL, "full")
ISO_WORD(REPAIR, ISO_REPAIR_MEND, "mend")
ISO_WORD(REPAIR, ISO_REPAIR_VOLUME, "volume")
ISO_WORD(KINEMATICS, ISO_KINEMATICS_CARTESIAN, "cartesian")
ISO_WORD(KINEMATICS, ISO_KINEMATICS_ROTARY_A, "rotary_a")
ISO_WORD(KINEMATICS, ISO_KINEMATICS_ROTARY_B, "rotary_b")
ISO_WORD(KINEMATICS, ISO_KINEMATICS_TABLE_AC, "table_ac")
ISO_WORD(KINEMATICS, ISO_KINEMATICS_TABLE_BC, "table_bc")
ISO_WORD(FEED, ISO_FEED_COMPENSATED, "compensated")
ISO_WORD(FEED, ISO_FEED_INVERSE_TIME, "inverse_time")
#endif

#ifdef ISO_OPTION

ISO_OPTION(inches, BOOL, "0", "", 0, 1, "Objects", "The model's numbers are inches, not mm.")
ISO_OPTION(scale, RELATIVE, "1", "", 0.0001, 100000, "Objects",
           "Factor on the size of the model, or percent of it.")
ISO_OPTION(
    scale_to_fit, NUMBERS, "", "mm", 0.001, 10000, "Objects",
    "Make the model as large as fits into this box, given as X,Y,Z. Empty: as large as it is.")
ISO_OPTION(rotate, NUMBER, "0", "deg", -360, 360, "Objects", "Turn the model about the Z axis.")
ISO_OPTION(rotate_x, NUMBER, "0", "deg", -360, 360, "Objects",
           "Turn the model about the X axis, before rotate.")
ISO_OPTION(rotate_y, NUMBER, "0", "deg", -360, 360, "Objects",
           "Turn the model about the Y axis, after rotate_x.")
ISO_OPTION(mirror, MIRROR, "none", "", 0, 0, "Objects", "Mirror the model along an axis.")
ISO_OPTION(cut, NUMBER, "0", "mm", 0, 10000, "Objects",
           "Cut the model at this height above its floor; 0 not at all.")
ISO_OPTION(cut_keep, CUT, "both", "", 0, 0, "Objects", "Which part of a cut model is printed.")
ISO_OPTION(
    check_solid, CHECK, "auto", "", 0, 0, "Objects",
    "Ask rays whether the slices' contours have material on the side they say: off, auto (models of several shells or that were mended), or full.")
ISO_OPTION(
    repair, REPAIR, "mend", "", 0, 0, "Objects",
    "What becomes of a model: mend mends its defects or refuses it, volume makes a new surface around what its triangles enclose.")
ISO_OPTION(repair_voxel, NUMBER, "0", "mm", 0, 100, "Objects",
           "Fineness of repair = volume; 0 is 1/300 of the model's largest extent.")
ISO_OPTION(
    sheet_thickness, NUMBER, "0", "mm", 0, 100, "Objects",
    "Give surfaces that stay open, sheets without an inside, this thickness; 0 refuses them.")
ISO_OPTION(
    ensure_on_bed, BOOL, "1", "", 0, 1, "Objects",
    "Set every object down on the bed. Else z stays as the file has it, and what is below the bed isn't printed.")
ISO_OPTION(split, BOOL, "0", "", 0, 1, "Objects",
           "Make every separate piece of a model an object of its own.")
ISO_OPTION(duplicate, INTEGER, "1", "", 1, 10000, "Objects",
           "Print so many copies of every object, arranged on the bed.")
ISO_OPTION(duplicate_grid, NUMBERS, "", "", 1, 1000, "Objects",
           "Print copies of every object in rows and columns, given as X,Y. Empty: none.")
ISO_OPTION(duplicate_distance, NUMBER, "6", "mm", 0, 1000, "Objects",
           "Distance between arranged objects.")
ISO_OPTION(
    arrange, BOOL, "0", "", 0, 1, "Objects",
    "Every model is an object of its own; find a place on the bed for each. Else models keep their places to each other.")
ISO_OPTION(dont_arrange, BOOL, "0", "", 0, 1, "Objects",
           "Leave objects where the model files have them on the bed, instead of centring or "
           "arranging them. Copies are arranged all the same.")
ISO_OPTION(complete_objects, BOOL, "0", "", 0, 1, "Objects",
           "Print one object after the other instead of all layer by layer.")
ISO_OPTION(
    extruder_clearance_radius, NUMBER, "20", "mm", 0.1, 1000, "Objects",
    "For complete_objects: radius around the nozzle in which the print head would hit what is printed.")
ISO_OPTION(
    extruder_clearance_height, NUMBER, "20", "mm", 0.1, 1000, "Objects",
    "For complete_objects: height above the nozzle at which the axes would hit what is printed.")

ISO_OPTION(layer_height, NUMBER, "0.3", "mm", 0.01, 5, "Layers", "Height of a layer.")
ISO_OPTION(first_layer_height, RELATIVE, "0.35", "mm", 0.01, 5, "Layers",
           "Height of the first layer; in % of layer_height.")
ISO_OPTION(layer_heights, NUMBERS, "", "mm", 0.01, 5, "Layers",
           "Heights of the layers one by one from the bed up, for example 0.3,0.2,0.1; above the "
           "last one given layer_height goes on. Empty: first_layer_height, then layer_height.")
ISO_OPTION(
    adaptive_layers, BOOL, "0", "", 0, 1, "Layers",
    "Choose the height of every layer by the slope of the surface: between min_layer_height and max_layer_height, as thick as cusp_height allows.")
ISO_OPTION(cusp_height, NUMBER, "0.05", "mm", 0.001, 1, "Layers",
           "Largest distance between the steps of adaptive layers and the true surface.")
ISO_OPTION(min_layer_height, NUMBER, "0.07", "mm", 0.01, 5, "Layers",
           "Thinnest adaptive layer, and thinnest place of a curved one.")
ISO_OPTION(
    max_layer_height, NUMBER, "0", "mm", 0, 5, "Layers",
    "Thickest adaptive layer, and thickest place of a curved one; 0 takes 75% of nozzle_diameter, for curved ones up to 1.5 times layer_height.")

ISO_OPTION(
    field, TEXT, "", "", 0, 0, "Curved layers",
    "Height function whose level surfaces are the layers: plane:, cone:, sphere:, cylinder:, torus:, wave:, fan: or distance: with their numbers, auto-top, or an expression in x, y (from the part's middle) and z. Empty or z: flat layers.")
ISO_OPTION(
    field_flat_base, BOOL, "1", "", 0, 1, "Curved layers",
    "Layers begin flat on the bed and bend into curved ones; off: they are curved from the start, as they always are where the machine turns the part.")
ISO_OPTION(field_base, NUMBER, "0", "mm", 0, 10000, "Curved layers",
           "Height up to which layers stay flat before they begin to bend.")
ISO_OPTION(
    field_blend, NUMBER, "0", "mm", 0, 10000, "Curved layers",
    "Height over which flat layers bend into curved ones; 0: two and a half times as much as they bend, so that none gets a quarter thinner or half as thick again.")
ISO_OPTION(
    field_slope, NUMBER, "40", "deg", 0, 89, "Curved layers",
    "Steepest that a layer may lie where the nozzle always points down; steeper ones are refused, and less steep ones too where the nozzle's tip or side is in the way. Layers of auto-top keep to it.")
ISO_OPTION(field_tolerance, NUMBER, "0.01", "mm", 0.001, 1, "Curved layers",
           "How far lines may be off the curved layer they stand for.")
ISO_OPTION(
    check_clearance, BOOL, "1", "", 0, 1, "Curved layers",
    "Refuse a print with curved layers in which the tool would touch what is printed already.")
ISO_OPTION(clearance_tip, NUMBER, "0.8", "mm", 0.05, 10, "Curved layers",
           "Diameter of the nozzle's flat tip.")
ISO_OPTION(clearance_cone, NUMBER, "45", "deg", 1, 89, "Curved layers",
           "Angle between the nozzle's side and its axis.")
ISO_OPTION(clearance_cone_height, NUMBER, "6", "mm", 0.1, 1000, "Curved layers",
           "Height above the tip at which the heater block begins.")
ISO_OPTION(
    clearance_block, NUMBERS, "-10,-10,10,10", "mm", -1000, 1000, "Curved layers",
    "The heater block around the nozzle, seen from above: X,Y of one corner, X,Y of the opposite one; empty: there is none.")
ISO_OPTION(clearance_carriage_height, NUMBER, "20", "mm", 0.1, 1000, "Curved layers",
           "Height above the tip at which the carriage begins.")
ISO_OPTION(clearance_carriage, NUMBERS, "-30,-30,30,30", "mm", -1000, 1000, "Curved layers",
           "The carriage around the nozzle, as clearance_block; empty: there is none.")
ISO_OPTION(
    clearance_gantry_height, NUMBER, "40", "mm", 0, 10000, "Curved layers",
    "Height above the tip at which the machine begins, wherever the nozzle is; 0: nothing is in the way.")
ISO_OPTION(
    kinematics, KINEMATICS, "cartesian", "", 0, 0, "Curved layers",
    "How the machine turns the part: cartesian (not at all), rotary_a or rotary_b (a mandrel along X or Y), table_ac or table_bc (a table that tilts around X or Y and turns). The tool then stands square on the layer.")
ISO_OPTION(
    kinematics_pivot, NUMBERS, "", "mm", -10000, 10000, "Curved layers",
    "X,Y,Z on the bed that a table tilts and turns about, or a point of the mandrel's axis. Empty: the middle of the bed, at Z = 0.")
ISO_OPTION(tilt_limits, NUMBERS, "-90,90", "deg", -360, 360, "Curved layers",
           "How far a table may tilt: least,greatest.")
ISO_OPTION(turn_limits, NUMBERS, "-360000,360000", "deg", -1000000, 1000000, "Curved layers",
           "How far a table or mandrel may turn in all: least,greatest.")
ISO_OPTION(tilt_speed, NUMBER, "60", "deg/s", 0.01, 10000, "Curved layers",
           "Fastest that a table tilts.")
ISO_OPTION(turn_speed, NUMBER, "180", "deg/s", 0.01, 10000, "Curved layers",
           "Fastest that a table or mandrel turns.")
ISO_OPTION(
    rotary_feed, FEED, "compensated", "", 0, 0, "Curved layers",
    "How speed is told where the part turns: compensated (F counts X, Y, Z alone) or inverse_time (G93).")
ISO_OPTION(
    gcode_resolution, NUMBER, "0.0125", "mm", 0, 1, "Layers",
    "How far a printed path may lie from the exact one, to leave out needless points; 0 keeps all.")
ISO_OPTION(z_offset, NUMBER, "0", "mm", -5, 5, "Layers",
           "Added to every Z of the output, against an end stop that is off.")
ISO_OPTION(xy_size_compensation, NUMBER, "0", "mm", -10, 10, "Layers",
           "Every outline is moved outwards by this; inwards if it is negative.")
ISO_OPTION(
    xy_hole_compensation, NUMBER, "0", "mm", -10, 10, "Layers",
    "Every hole is widened by this, on top of xy_size_compensation; narrowed if it is negative.")
ISO_OPTION(
    elefant_foot_compensation, NUMBER, "0", "mm", 0, 10, "Layers",
    "The outlines of the first layer are drawn in by this, against their being squeezed wider on the bed.")

ISO_OPTION(perimeters, INTEGER, "3", "", 0, 1000, "Walls",
           "Number of walls on every layer; 0 for none.")
ISO_OPTION(external_perimeters_first, BOOL, "0", "", 0, 1, "Walls",
           "Print the walls from the outermost in, instead of from the innermost out.")
ISO_OPTION(thin_walls, BOOL, "1", "", 0, 1, "Walls",
           "Places too narrow for two walls get a single one, as wide as they are.")
ISO_OPTION(gap_fill_enabled, BOOL, "1", "", 0, 1, "Walls",
           "Fill gaps between walls and in narrow solid areas with beads as wide as they are.")
ISO_OPTION(
    overhangs, BOOL, "1", "", 0, 1, "Walls",
    "Walls over air are printed as bridges: bridge_speed, bridge_flow_ratio, bridge_fan_speed.")
ISO_OPTION(
    seam_position, SEAM, "aligned", "", 0, 0, "Walls",
    "Where walls begin and end: anywhere, at a corner near the nozzle, in a line up the part, or at the back of the bed.")
ISO_OPTION(
    fuzzy_skin, FUZZY, "none", "", 0, 0, "Walls",
    "Which outermost walls are drawn with a random jitter, for a rough skin: none, those around the part, or those of holes as well.")
ISO_OPTION(fuzzy_skin_thickness, NUMBER, "0.3", "mm", 0, 10, "Walls",
           "How far the jitter of fuzzy_skin moves a point to either side.")
ISO_OPTION(fuzzy_skin_point_dist, NUMBER, "0.8", "mm", 0.05, 10, "Walls",
           "Mean distance between the points of fuzzy_skin.")
ISO_OPTION(
    spiral_vase, BOOL, "0", "", 0, 1, "Walls",
    "Print one wall that rises without a seam over the bottom layers: one wall, no infill, no top.")

ISO_OPTION(fill_density, PERCENT, "20%", "%", 0, 100, "Infill",
           "Density of the infill; 0% leaves the part hollow, 100% fills it solid.")
ISO_OPTION(
    fill_pattern, PATTERN, "rectilinear", "", 0, 0, "Infill",
    "Pattern of the sparse infill (docs/patterns.md). Patterns that can't fill solid give way "
    "to rectilinear at 100%.")
ISO_OPTION(
    modifiers, TEXT, "", "", 0, 0, "Infill",
    "Models in which the infill is another, one a line or split by ; as core.stl fill_density=60% fill_angle=0 (docs/patterns.md).")
ISO_OPTION(top_fill_pattern, PATTERN, "monotonic", "", 0, 0, "Infill",
           "Pattern of top surfaces: rectilinear, monotonic, monotoniclines, alignedrectilinear, "
           "concentric, hilbertcurve, archimedeanchords or octagramspiral.")
ISO_OPTION(bottom_fill_pattern, PATTERN, "monotonic", "", 0, 0, "Infill",
           "Pattern of bottom surfaces: as for top_fill_pattern.")
ISO_OPTION(fill_angle, NUMBER, "45", "deg", 0, 360, "Infill",
           "Angle of the infill against the X axis; patterns that cross from layer to layer turn "
           "on from there.")
ISO_OPTION(infill_overlap, RELATIVE, "25%", "mm", 0, 5, "Infill",
           "How far the infill reaches into the walls to bond with them; in % of the width of "
           "inner walls.")
ISO_OPTION(
    infill_anchor, RELATIVE, "600%", "mm", 0, 1000, "Infill",
    "Sparse lines that end alone are bent along the wall for this length; in % of infill_extrusion_width; 0 not at all.")
ISO_OPTION(
    infill_anchor_max, RELATIVE, "50", "mm", 0, 1000, "Infill",
    "Sparse lines are joined along the wall if that takes no longer than this; in % of infill_extrusion_width; 0 never joins.")
ISO_OPTION(infill_every_layers, INTEGER, "1", "", 1, 1000, "Infill",
           "Sparse infill of so many layers is printed at once, as thick as the nozzle allows.")
ISO_OPTION(infill_first, BOOL, "0", "", 0, 1, "Infill", "Print the infill before the walls.")
ISO_OPTION(
    lattice_cell, TEXT, "5", "mm", 0, 0, "Lattices",
    "Edge of a cell of fill_pattern's lattices: a number, or an expression in x, y, z, r, skin and grid (docs/lattices.md).")
ISO_OPTION(
    lattice_density, TEXT, "", "%", 0, 0, "Lattices",
    "Density of a lattice: a number, or an expression as for lattice_cell. Empty takes fill_density.")
ISO_OPTION(
    lattice_material, TEXT, "", "%", 0, 0, "Lattices",
    "Share of the second material, tool 1: a number, or an expression as for lattice_cell; cell by cell. Empty: one material.")
ISO_OPTION(
    lattice_map, MAP, "xyz", "", 0, 0, "Lattices",
    "Along what the cells lie: xyz; around the part's axis (cylinder), its middle (sphere); or along its surface (skin, skin_cylinder).")
ISO_OPTION(lattice_seed, INTEGER, "0", "", 0, 1000000, "Lattices",
           "Number that all that is random in a lattice comes from.")
ISO_OPTION(lattice_pore, NUMBER, "0.4", "", 0.05, 1, "Lattices",
           "Of voxel_random: size of its pores, in cells.")
ISO_OPTION(
    lattice_file, TEXT, "", "", 0, 0, "Lattices",
    "Of voxel_file: a .vdb grid, or a folder or pattern (slice%03d.png) of grey pictures, that one cell is filled with.")
ISO_OPTION(lattice_grid, TEXT, "", "", 0, 0, "Lattices",
           "A .vdb file whose value the expressions know as grid.")
ISO_OPTION(lattice_skin, NUMBER, "0", "mm", 0, 100, "Lattices",
           "Of isoslice lattice: thickness of the solid skin around the lattice; 0 leaves it open.")
ISO_OPTION(
    lattice_drain, NUMBERS, "", "mm", -10000, 10000, "Lattices",
    "Holes through the bottom of a skinned lattice to let powder or resin out, as X,Y,X,Y... from the middle of the part.")
ISO_OPTION(lattice_drain_diameter, NUMBER, "3", "mm", 0.1, 100, "Lattices",
           "Diameter of the holes of lattice_drain.")
ISO_OPTION(lattice_open, BOOL, "0", "", 0, 1, "Lattices",
           "Of isoslice lattice: refuse a part with pores that no powder can leave (exit code 8).")
ISO_OPTION(top_solid_layers, INTEGER, "3", "", 0, 100000, "Solid layers, bridges, ironing",
           "Number of solid layers under every top surface; 0 for none.")
ISO_OPTION(bottom_solid_layers, INTEGER, "3", "", 0, 100000, "Solid layers, bridges, ironing",
           "Number of solid layers over every bottom surface; 0 for none.")
ISO_OPTION(top_solid_min_thickness, NUMBER, "0", "mm", 0, 1000, "Solid layers, bridges, ironing",
           "Least thickness under every top surface, whatever top_solid_layers says.")
ISO_OPTION(bottom_solid_min_thickness, NUMBER, "0", "mm", 0, 1000, "Solid layers, bridges, ironing",
           "Least thickness over every bottom surface, whatever bottom_solid_layers says.")
ISO_OPTION(
    ensure_vertical_shell_thickness, BOOL, "0", "", 0, 1, "Solid layers, bridges, ironing",
    "Add solid infill near sloping surfaces, so that the shell is as thick there as elsewhere.")
ISO_OPTION(solid_infill_every_layers, INTEGER, "0", "", 0, 100000, "Solid layers, bridges, ironing",
           "Every so many layers the whole layer is solid; 0 never.")
ISO_OPTION(solid_infill_below_area, NUMBER, "70", "mm2", 0, 1000000,
           "Solid layers, bridges, ironing",
           "Areas of sparse infill smaller than this become solid; 0 none.")
ISO_OPTION(bridge_angle, NUMBER, "0", "deg", 0, 360, "Solid layers, bridges, ironing",
           "Direction of all bridges; 0 finds the best for each; 180 is along the X axis.")
ISO_OPTION(bridge_flow_ratio, NUMBER, "1", "", 0.1, 2, "Solid layers, bridges, ironing",
           "Factor on the amount of material in bridges: less pulls them taut.")
ISO_OPTION(thick_bridges, BOOL, "1", "", 0, 1, "Solid layers, bridges, ironing",
           "Bridges are round threads as thick as the nozzle, else as thick as the layer.")
ISO_OPTION(ironing, BOOL, "0", "", 0, 1, "Solid layers, bridges, ironing",
           "Pass over top surfaces again with the hot nozzle to smooth them.")
ISO_OPTION(ironing_type, IRONING, "top", "", 0, 0, "Solid layers, bridges, ironing",
           "What is ironed: all top surfaces, the topmost one only, or all solid layers.")
ISO_OPTION(ironing_flowrate, PERCENT, "15%", "%", 0, 100, "Solid layers, bridges, ironing",
           "Amount of material while ironing; in % of a full layer.")
ISO_OPTION(ironing_spacing, NUMBER, "0.1", "mm", 0.01, 10, "Solid layers, bridges, ironing",
           "Distance between the lines of ironing.")

ISO_OPTION(skirts, INTEGER, "1", "", 0, 100, "Skirt and brim",
           "Loops drawn around everything on the first layer; 0 for none.")
ISO_OPTION(skirt_distance, NUMBER, "6", "mm", 0, 100, "Skirt and brim",
           "Distance of the skirt from the parts, or from their brim.")
ISO_OPTION(skirt_height, INTEGER, "1", "layers", 1, 100000, "Skirt and brim",
           "Number of layers on which the skirt is drawn.")
ISO_OPTION(
    min_skirt_length, NUMBER, "0", "mm", 0, 100000, "Skirt and brim",
    "As many loops of skirt as take this length of filament on the first layer; 0 as many as skirts says.")
ISO_OPTION(
    draft_shield, SHIELD, "disabled", "", 0, 0, "Skirt and brim",
    "A skirt as a wall against draught: none, as high as skirt_height, or as high as the print.")
ISO_OPTION(brim_width, NUMBER, "0", "mm", 0, 100, "Skirt and brim",
           "Width of the brim on the first layer; 0 for none.")
ISO_OPTION(brim_type, BRIM, "outer_only", "", 0, 0, "Skirt and brim",
           "On which side of the outlines the brim is: nowhere, outside, in holes, or both.")
ISO_OPTION(brim_separation, NUMBER, "0", "mm", 0, 10, "Skirt and brim",
           "Gap between the brim and the part.")

ISO_OPTION(
    perimeter_speed, NUMBER, "60", "mm/s", 0, 1000, "Speed and acceleration",
    "Speed of inner walls; 0, as for the other speeds of printing, is as fast as an even flow allows, by max_print_speed and max_volumetric_speed.")
ISO_OPTION(external_perimeter_speed, RELATIVE, "50%", "mm/s", 0, 1000, "Speed and acceleration",
           "Speed of the outer walls; in % of perimeter_speed.")
ISO_OPTION(small_perimeter_speed, RELATIVE, "15", "mm/s", 0, 1000, "Speed and acceleration",
           "Speed of walls no longer around than a circle of radius 6.5 mm; in % of "
           "perimeter_speed.")
ISO_OPTION(infill_speed, NUMBER, "80", "mm/s", 0, 1000, "Speed and acceleration",
           "Speed of sparse infill.")
ISO_OPTION(solid_infill_speed, RELATIVE, "20", "mm/s", 0, 1000, "Speed and acceleration",
           "Speed of solid infill; in % of infill_speed.")
ISO_OPTION(top_solid_infill_speed, RELATIVE, "15", "mm/s", 0, 1000, "Speed and acceleration",
           "Speed of the topmost solid layers; in % of solid_infill_speed.")
ISO_OPTION(gap_fill_speed, NUMBER, "20", "mm/s", 0, 1000, "Speed and acceleration",
           "Speed of gap fill; 0 leaves gaps unfilled.")
ISO_OPTION(bridge_speed, NUMBER, "60", "mm/s", 0, 1000, "Speed and acceleration",
           "Speed of bridges, and of walls over air.")
ISO_OPTION(first_layer_speed, RELATIVE, "30", "mm/s", 0.1, 1000, "Speed and acceleration",
           "Speed of everything printed on the first layer; in % of the usual speed of each path.")
ISO_OPTION(ironing_speed, NUMBER, "15", "mm/s", 0.1, 1000, "Speed and acceleration",
           "Speed of ironing.")
ISO_OPTION(max_print_speed, NUMBER, "80", "mm/s", 1, 1000, "Speed and acceleration",
           "Highest speed of those that are given as 0, which are then chosen for an even flow.")
ISO_OPTION(max_volumetric_speed, NUMBER, "0", "mm3/s", 0, 1000, "Speed and acceleration",
           "Most that the extruder can melt: faster beads are slowed down to it; 0 for no limit.")
ISO_OPTION(
    default_acceleration, NUMBER, "0", "mm/s2", 0, 100000, "Speed and acceleration",
    "Acceleration of beads where none of those below says otherwise; 0 leaves it to the firmware, whatever those below say.")
ISO_OPTION(external_perimeter_acceleration, NUMBER, "0", "mm/s2", 0, 100000,
           "Speed and acceleration", "Acceleration of outer walls; 0 takes perimeter_acceleration.")
ISO_OPTION(perimeter_acceleration, NUMBER, "0", "mm/s2", 0, 100000, "Speed and acceleration",
           "Acceleration of walls; 0 takes default_acceleration.")
ISO_OPTION(infill_acceleration, NUMBER, "0", "mm/s2", 0, 100000, "Speed and acceleration",
           "Acceleration of infill; 0 takes default_acceleration.")
ISO_OPTION(solid_infill_acceleration, NUMBER, "0", "mm/s2", 0, 100000, "Speed and acceleration",
           "Acceleration of solid infill; 0 takes infill_acceleration.")
ISO_OPTION(top_solid_infill_acceleration, NUMBER, "0", "mm/s2", 0, 100000, "Speed and acceleration",
           "Acceleration of top surfaces; 0 takes solid_infill_acceleration.")
ISO_OPTION(
    bridge_acceleration, NUMBER, "0", "mm/s2", 0, 100000, "Speed and acceleration",
    "Acceleration of bridges and of walls over air; 0 takes solid_infill_acceleration and perimeter_acceleration.")
ISO_OPTION(
    first_layer_acceleration, NUMBER, "0", "mm/s2", 0, 100000, "Speed and acceleration",
    "Acceleration of everything printed on the first layer; 0 takes those of the other layers.")
ISO_OPTION(
    travel_acceleration, NUMBER, "0", "mm/s2", 0, 100000, "Speed and acceleration",
    "Acceleration of moves that don't print; 0 takes default_acceleration if the firmware has one acceleration for all moves, and else leaves it alone.")
ISO_OPTION(travel_speed, NUMBER, "130", "mm/s", 1, 1000, "Speed and acceleration",
           "Speed of moves that don't print.")
ISO_OPTION(travel_speed_z, NUMBER, "0", "mm/s", 0, 1000, "Speed and acceleration",
           "Speed of moves straight up or down; 0 takes travel_speed.")

ISO_OPTION(
    extrusion_width, RELATIVE, "0", "mm", 0, 10, "Width",
    "Width of a bead where no width below says otherwise; in % of the layer's height; 0 takes 1.125 nozzle diameters (top infill: 1).")
ISO_OPTION(first_layer_extrusion_width, RELATIVE, "200%", "mm", 0, 10, "Width",
           "Width of every bead on the first layer; in % of its height; 0 as on the other layers.")
ISO_OPTION(perimeter_extrusion_width, RELATIVE, "0", "mm", 0, 10, "Width",
           "Width of inner walls; in % of the layer's height; 0 takes extrusion_width.")
ISO_OPTION(external_perimeter_extrusion_width, RELATIVE, "0", "mm", 0, 10, "Width",
           "Width of outer walls; in % of the layer's height; 0 takes extrusion_width.")
ISO_OPTION(infill_extrusion_width, RELATIVE, "0", "mm", 0, 10, "Width",
           "Width of sparse infill; in % of the layer's height; 0 takes extrusion_width.")
ISO_OPTION(solid_infill_extrusion_width, RELATIVE, "0", "mm", 0, 10, "Width",
           "Width of solid infill; in % of the layer's height; 0 takes extrusion_width.")
ISO_OPTION(top_infill_extrusion_width, RELATIVE, "0", "mm", 0, 10, "Width",
           "Width of topmost solid layers; in % of the layer's height; 0 takes extrusion_width.")

ISO_OPTION(filament_diameter, NUMBER, "1.75", "mm", 0.5, 10, "Filament",
           "Diameter of the filament.")
ISO_OPTION(filament_density, NUMBER, "0", "g/cm3", 0, 30, "Filament",
           "Density of the filament, for the weight in footer and report; 0 if it is unknown.")
ISO_OPTION(filament_cost, NUMBER, "0", "per kg", 0, 1000000, "Filament",
           "Price of a kilogram of the filament, for the footer; 0 if it is unknown.")
ISO_OPTION(filament_max_volumetric_speed, NUMBER, "0", "mm3/s", 0, 1000, "Filament",
           "As max_volumetric_speed, for this filament: the lower one holds; 0 for no limit.")
ISO_OPTION(extrusion_multiplier, NUMBER, "1", "", 0.1, 10, "Filament",
           "Factor on the amount of every extrusion.")
ISO_OPTION(temperature, INTEGER, "200", "C", 0, 600, "Filament",
           "Temperature of the nozzle, or of both, above the first layer; 0 leaves it alone.")
ISO_OPTION(first_layer_temperature, INTEGER, "200", "C", 0, 600, "Filament",
           "Temperature of the nozzle, or of both, on the first layer; 0 leaves it alone.")
ISO_OPTION(bed_temperature, INTEGER, "0", "C", 0, 300, "Filament",
           "Temperature of the bed above the first layer; 0 leaves it alone.")
ISO_OPTION(first_layer_bed_temperature, INTEGER, "0", "C", 0, 300, "Filament",
           "Temperature of the bed on the first layer; 0 leaves it alone.")

ISO_OPTION(retract_length, NUMBER, "2", "mm", 0, 100, "Travel and retraction",
           "Length of filament drawn back before a travel move; 0 never retracts.")
ISO_OPTION(retract_speed, NUMBER, "40", "mm/s", 0.1, 1000, "Travel and retraction",
           "Speed of retraction.")
ISO_OPTION(deretract_speed, NUMBER, "0", "mm/s", 0, 1000, "Travel and retraction",
           "Speed of pushing the filament forth again; 0 takes retract_speed.")
ISO_OPTION(retract_restart_extra, NUMBER, "0", "mm", -10, 10, "Travel and retraction",
           "Length pushed out on top of what was drawn back; negative for less.")
ISO_OPTION(retract_before_travel, NUMBER, "2", "mm", 0, 1000, "Travel and retraction",
           "Shorter travel moves do without retraction.")
ISO_OPTION(retract_lift, NUMBER, "0", "mm", 0, 100, "Travel and retraction",
           "How far the nozzle is lifted while it is retracted; 0 not at all.")
ISO_OPTION(retract_lift_above, NUMBER, "0", "mm", 0, 10000, "Travel and retraction",
           "The nozzle is lifted from this height on only.")
ISO_OPTION(retract_lift_below, NUMBER, "0", "mm", 0, 10000, "Travel and retraction",
           "The nozzle is lifted up to this height only; 0 for no limit.")
ISO_OPTION(retract_layer_change, BOOL, "0", "", 0, 1, "Travel and retraction",
           "Draw the filament back whenever a layer is done.")
ISO_OPTION(wipe, BOOL, "0", "", 0, 1, "Travel and retraction",
           "Move back along the printed path while the filament is drawn back.")
ISO_OPTION(retract_before_wipe, PERCENT, "0%", "%", 0, 100, "Travel and retraction",
           "Share of retract_length that is drawn back before the wipe begins.")
ISO_OPTION(only_retract_when_crossing_perimeters, BOOL, "1", "", 0, 1, "Travel and retraction",
           "No retraction on travel moves inside the part, where nothing that drips is seen; they "
           "take a way around walls if that is quicker than a retraction.")
ISO_OPTION(avoid_crossing_perimeters, BOOL, "0", "", 0, 1, "Travel and retraction",
           "Lead travel moves around walls instead of across them.")
ISO_OPTION(avoid_crossing_perimeters_max_detour, RELATIVE, "0", "mm", 0, 10000,
           "Travel and retraction",
           "Longest detour around walls; in % of the straight way; 0 for no limit.")
ISO_OPTION(use_firmware_retraction, BOOL, "0", "", 0, 1, "Travel and retraction",
           "Leave retraction to the firmware, by G10 and G11.")

ISO_OPTION(cooling, BOOL, "1", "", 0, 1, "Cooling",
           "Slow down and blow by the time a layer takes, with the options below.")
ISO_OPTION(slowdown_below_layer_time, INTEGER, "5", "s", 0, 1000, "Cooling",
           "A layer that takes less than this is slowed down until it takes as long; 0 never.")
ISO_OPTION(min_print_speed, NUMBER, "10", "mm/s", 0.1, 1000, "Cooling",
           "Speed below which layers are not slowed down.")
ISO_OPTION(fan_always_on, BOOL, "0", "", 0, 1, "Cooling",
           "Blow at min_fan_speed at least, however long a layer takes.")
ISO_OPTION(
    fan_below_layer_time, INTEGER, "60", "s", 0, 1000, "Cooling",
    "The fan turns on a layer that takes less than this; the less, the faster. 0: on slowed layers alone.")
ISO_OPTION(min_fan_speed, INTEGER, "35", "%", 0, 100, "Cooling",
           "Slowest speed of the fan when it is on.")
ISO_OPTION(max_fan_speed, INTEGER, "100", "%", 0, 100, "Cooling",
           "Speed of the fan on layers that are slowed down.")
ISO_OPTION(disable_fan_first_layers, INTEGER, "3", "", 0, 1000, "Cooling",
           "Number of layers, the first ones, on which the fan stays off.")
ISO_OPTION(full_fan_speed_layer, INTEGER, "0", "", 0, 1000, "Cooling",
           "From disable_fan_first_layers to this layer the fan speeds up evenly; 0 at once.")
ISO_OPTION(bridge_fan_speed, INTEGER, "100", "%", 0, 100, "Cooling",
           "Speed of the fan on bridges and on walls over air.")

ISO_OPTION(nozzle_diameter, NUMBER, "0.4", "mm", 0.05, 5, "Printer", "Diameter of the nozzle.")
ISO_OPTION(bed_shape, POINTS, "0x0,200x0,200x200,0x200", "mm", -1600, 1600, "Printer",
           "Corners of the bed, one after the other around it.")
ISO_OPTION(max_print_height, NUMBER, "200", "mm", 0.1, 10000, "Printer",
           "Greatest height that the nozzle may go to.")
ISO_OPTION(center, PLACE, "", "mm", -1600, 1600, "Printer",
           "Where the middle of the print comes to lie, as X,Y. Empty: the middle of the bed.")
ISO_OPTION(gcode_flavor, FLAVOUR, "marlin2", "", 0, 0, "Printer", "Dialect of the G-code.")
ISO_OPTION(use_relative_e_distances, BOOL, "1", "", 0, 1, "Printer",
           "Extrusion is counted from the move before (M83), not from the start (M82).")
ISO_OPTION(use_volumetric_e, BOOL, "0", "", 0, 1, "Printer",
           "Extrusion is counted in mm3 instead of mm of filament.")
ISO_OPTION(
    machine_limits_usage, LIMITS, "time_estimate_only", "", 0, 0, "Printer",
    "What the limits below are for: told to the firmware at the start and for the estimate of time, for the estimate alone, or for nothing.")
ISO_OPTION(machine_max_acceleration_extruding, NUMBER, "1000", "mm/s2", 1, 100000, "Printer",
           "The firmware's highest acceleration of moves that print.")
ISO_OPTION(machine_max_acceleration_travel, NUMBER, "1000", "mm/s2", 1, 100000, "Printer",
           "The firmware's highest acceleration of moves that don't print.")
ISO_OPTION(machine_max_acceleration_retracting, NUMBER, "1000", "mm/s2", 1, 100000, "Printer",
           "The firmware's highest acceleration of retractions.")
ISO_OPTION(machine_max_feedrate_z, NUMBER, "12", "mm/s", 0.1, 1000, "Printer",
           "The firmware's highest speed of the Z axis.")
ISO_OPTION(machine_max_feedrate_x, NUMBER, "500", "mm/s", 0.1, 100000, "Printer",
           "The firmware's highest speed of the X axis.")
ISO_OPTION(machine_max_feedrate_y, NUMBER, "500", "mm/s", 0.1, 100000, "Printer",
           "The firmware's highest speed of the Y axis.")
ISO_OPTION(machine_max_feedrate_e, NUMBER, "120", "mm/s", 0.1, 100000, "Printer",
           "The firmware's highest speed of the E axis.")
ISO_OPTION(machine_max_acceleration_x, NUMBER, "9000", "mm/s2", 1, 1000000, "Printer",
           "The firmware's highest acceleration of the X axis.")
ISO_OPTION(machine_max_acceleration_y, NUMBER, "9000", "mm/s2", 1, 1000000, "Printer",
           "The firmware's highest acceleration of the Y axis.")
ISO_OPTION(machine_max_acceleration_z, NUMBER, "500", "mm/s2", 1, 1000000, "Printer",
           "The firmware's highest acceleration of the Z axis.")
ISO_OPTION(machine_max_acceleration_e, NUMBER, "10000", "mm/s2", 1, 1000000, "Printer",
           "The firmware's highest acceleration of the E axis.")
ISO_OPTION(
    machine_max_jerk_x, NUMBER, "10", "mm/s", 0, 1000, "Printer",
    "The firmware's jerk of the X axis. The estimate of time goes by it if gcode_flavor is marlin.")
ISO_OPTION(
    machine_max_jerk_y, NUMBER, "10", "mm/s", 0, 1000, "Printer",
    "The firmware's jerk of the Y axis. The estimate of time goes by it if gcode_flavor is marlin.")
ISO_OPTION(
    machine_max_jerk_z, NUMBER, "0.2", "mm/s", 0, 1000, "Printer",
    "The firmware's jerk of the Z axis. The estimate of time goes by it if gcode_flavor is marlin.")
ISO_OPTION(
    machine_max_jerk_e, NUMBER, "2.5", "mm/s", 0, 1000, "Printer",
    "The firmware's jerk of the E axis. The estimate of time goes by it if gcode_flavor is marlin.")
ISO_OPTION(
    machine_max_junction_deviation, NUMBER, "0.013", "mm", 0.001, 1, "Printer",
    "The firmware's junction deviation. The estimate of time goes by it unless gcode_flavor is marlin.")

ISO_OPTION(
    start_gcode, TEXT,
    "G28 ; home all axes\\n"
    "G1 Z5 F1200 ; lift the nozzle",
    "", 0, 0, "G-code",
    "What comes before the print, with macros (docs/macros.md). If nothing in it heats, nozzle and bed are heated around it.")
ISO_OPTION(end_gcode, TEXT,
           "M104 S0 ; nozzle off\\n"
           "M140 S0 ; bed off\\n"
           "M107 ; fan off\\n"
           "G28 X0 ; move out of the way\\n"
           "M84 ; motors off",
           "", 0, 0, "G-code", "What comes after the print, with macros.")
ISO_OPTION(
    layer_gcode, TEXT, "", "", 0, 0, "G-code",
    "What comes at every layer, once the nozzle is at its height, with macros: [layer_num] counts from 0, [layer_z] is the layer's top in mm.")
ISO_OPTION(before_layer_gcode, TEXT, "", "", 0, 0, "G-code",
           "What comes before the nozzle rises to a layer, with macros as in layer_gcode.")
ISO_OPTION(start_filament_gcode, TEXT, "", "", 0, 0, "G-code",
           "What comes after start_gcode, for the filament, with macros.")
ISO_OPTION(end_filament_gcode, TEXT, "", "", 0, 0, "G-code",
           "What comes before end_gcode, for the filament, with macros.")
ISO_OPTION(
    toolchange_gcode, TEXT, "", "", 0, 0, "G-code",
    "What comes before the nozzle is changed, with macros; previous_extruder and next_extruder are known. The command itself follows unless it is in here.")
ISO_OPTION(between_objects_gcode, TEXT, "", "", 0, 0, "G-code",
           "What comes between objects that are printed one by one, with macros.")
ISO_OPTION(colorprint_heights, NUMBERS, "", "mm", 0, 10000, "G-code",
           "Heights at which color_change_gcode changes the filament. Empty: none.")
ISO_OPTION(
    events, TEXT, "", "", 0, 0, "G-code",
    "What happens at which heights, one a line or split by ; as 5.2:color, 8:pause, 10:template, or 12.4:any G-code.")
ISO_OPTION(color_change_gcode, TEXT, "M600", "", 0, 0, "G-code",
           "What changes the filament, with macros.")
ISO_OPTION(pause_print_gcode, TEXT, "M601", "", 0, 0, "G-code",
           "What pauses the print, with macros.")
ISO_OPTION(template_custom_gcode, TEXT, "", "", 0, 0, "G-code",
           "What an event named template does, with macros.")
ISO_OPTION(gcode_comments, BOOL, "0", "", 0, 1, "G-code", "Say behind every move what it is for.")
ISO_OPTION(
    gcode_label_objects, LABELS, "disabled", "", 0, 0, "G-code",
    "Mark which object is being printed: not at all, in comments for OctoPrint, or by commands of the firmware, which can then leave one out.")
ISO_OPTION(arc_fitting, ARCS, "disabled", "", 0, 0, "G-code",
           "Draw round paths by arcs, G2 and G3, within gcode_resolution.")
ISO_OPTION(remaining_times, BOOL, "1", "", 0, 1, "G-code",
           "Tell the printer how much is done and how long it still takes (M73).")

#endif
