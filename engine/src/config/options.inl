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
 *     PATTERN  FLAVOUR              a word of the lists below
 *     TEXT  PLACE  POINTS  NUMBERS  min and max bound each coordinate or number
 */

#ifdef ISO_WORD /* ISO_WORD(kind, value, word) */
ISO_WORD(PATTERN, ISO_PATTERN_RECTILINEAR, "rectilinear")
ISO_WORD(PATTERN, ISO_PATTERN_GRID, "grid")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_MARLIN2, "marlin2")
ISO_WORD(FLAVOUR, ISO_FLAVOUR_MARLIN, "marlin")
#endif

#ifdef ISO_OPTION

ISO_OPTION(layer_height, NUMBER, "0.3", "mm", 0.01, 5, "Layers", "Height of a layer.")
ISO_OPTION(first_layer_height, RELATIVE, "0.35", "mm", 0.01, 5, "Layers",
           "Height of the first layer; in % of layer_height.")
ISO_OPTION(layer_heights, NUMBERS, "", "mm", 0.01, 5, "Layers",
           "Heights of the layers one by one from the bed up, for example 0.3,0.2,0.1; above the "
           "last one given layer_height goes on. Empty: first_layer_height, then layer_height.")
ISO_OPTION(gcode_resolution, NUMBER, "0.0125", "mm", 0, 1, "Layers",
           "How far a printed path may lie from the exact one, to leave out needless points.")
ISO_OPTION(z_offset, NUMBER, "0", "mm", -5, 5, "Layers",
           "Added to every Z of the output, against an end stop that is off.")

ISO_OPTION(perimeters, INTEGER, "3", "", 0, 1000, "Walls", "Number of walls on every layer.")
ISO_OPTION(external_perimeters_first, BOOL, "0", "", 0, 1, "Walls",
           "Print the walls from the outermost in, instead of from the innermost out.")

ISO_OPTION(fill_density, PERCENT, "20%", "%", 0, 100, "Infill",
           "Density of the infill; 100% fills solid.")
ISO_OPTION(fill_pattern, PATTERN, "rectilinear", "", 0, 0, "Infill",
           "Pattern of the infill. The grid is two crossing rectilinear passes of half the density "
           "each.")
ISO_OPTION(fill_angle, NUMBER, "45", "deg", 0, 360, "Infill",
           "Angle of the infill against the X axis; every layer turns it by 90 degrees.")
ISO_OPTION(infill_overlap, RELATIVE, "25%", "mm", 0, 5, "Infill",
           "How far the infill reaches into the walls to bond with them; in % of the width of "
           "inner walls.")
ISO_OPTION(top_solid_layers, INTEGER, "3", "", 0, 100000, "Infill",
           "Number of solid layers under every top surface.")
ISO_OPTION(bottom_solid_layers, INTEGER, "3", "", 0, 100000, "Infill",
           "Number of solid layers over every bottom surface.")

ISO_OPTION(skirts, INTEGER, "1", "", 0, 100, "Skirt",
           "Loops drawn around everything on the first layer; 0 for none.")
ISO_OPTION(skirt_distance, NUMBER, "6", "mm", 0, 100, "Skirt", "From the skirt to the part.")

ISO_OPTION(perimeter_speed, NUMBER, "60", "mm/s", 0.1, 1000, "Speed", "Speed of inner walls.")
ISO_OPTION(external_perimeter_speed, RELATIVE, "50%", "mm/s", 0.1, 1000, "Speed",
           "Speed of the outer walls; in % of perimeter_speed.")
ISO_OPTION(small_perimeter_speed, RELATIVE, "15", "mm/s", 0.1, 1000, "Speed",
           "Speed of walls no longer around than a circle of radius 6.5 mm; in % of "
           "perimeter_speed.")
ISO_OPTION(infill_speed, NUMBER, "80", "mm/s", 0.1, 1000, "Speed", "Speed of sparse infill.")
ISO_OPTION(solid_infill_speed, RELATIVE, "20", "mm/s", 0.1, 1000, "Speed",
           "Speed of solid infill; in % of infill_speed.")
ISO_OPTION(top_solid_infill_speed, RELATIVE, "15", "mm/s", 0.1, 1000, "Speed",
           "Speed of the topmost solid layers; in % of solid_infill_speed.")
ISO_OPTION(gap_fill_speed, NUMBER, "20", "mm/s", 0, 1000, "Speed",
           "Speed of gap fill, of which there is none yet.")
ISO_OPTION(bridge_speed, NUMBER, "60", "mm/s", 0.1, 1000, "Speed",
           "Speed of bridges, which are not told apart from other paths yet.")
ISO_OPTION(first_layer_speed, RELATIVE, "30", "mm/s", 0.1, 1000, "Speed",
           "Speed of everything printed on the first layer; in % of the usual speed of each path.")
ISO_OPTION(travel_speed, NUMBER, "130", "mm/s", 1, 1000, "Speed",
           "Speed of moves that don't print.")
ISO_OPTION(travel_speed_z, NUMBER, "0", "mm/s", 0, 1000, "Speed",
           "Speed of moves straight up or down; 0 takes travel_speed.")

ISO_OPTION(extrusion_width, RELATIVE, "0", "mm", 0, 10, "Width",
           "Width of a bead where no width below says otherwise; in % of the layer's height; 0 "
           "takes 1.125 nozzle diameters (top infill: 1).")
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
           "Density of the filament, for the weight in footer and report; 0 unknown.")
ISO_OPTION(extrusion_multiplier, NUMBER, "1", "", 0.1, 10, "Filament",
           "Factor on the amount of every extrusion.")
ISO_OPTION(temperature, INTEGER, "200", "C", 0, 600, "Filament",
           "Temperature of the nozzle above the first layer; 0 leaves it alone.")
ISO_OPTION(first_layer_temperature, INTEGER, "200", "C", 0, 600, "Filament",
           "Temperature of the nozzle on the first layer; 0 leaves it alone.")
ISO_OPTION(bed_temperature, INTEGER, "0", "C", 0, 300, "Filament",
           "Temperature of the bed above the first layer; 0 leaves it alone.")
ISO_OPTION(first_layer_bed_temperature, INTEGER, "0", "C", 0, 300, "Filament",
           "Temperature of the bed on the first layer; 0 leaves it alone.")

ISO_OPTION(retract_length, NUMBER, "2", "mm", 0, 100, "Retraction",
           "Length of filament drawn back before a travel move; 0 never retracts.")
ISO_OPTION(retract_speed, NUMBER, "40", "mm/s", 0.1, 1000, "Retraction", "Speed of retraction.")
ISO_OPTION(deretract_speed, NUMBER, "0", "mm/s", 0, 1000, "Retraction",
           "Speed of pushing the filament forth again; 0 takes retract_speed.")
ISO_OPTION(retract_restart_extra, NUMBER, "0", "mm", -10, 10, "Retraction",
           "Length pushed out on top of what was drawn back.")
ISO_OPTION(retract_before_travel, NUMBER, "2", "mm", 0, 1000, "Retraction",
           "Shorter travel moves do without retraction.")
ISO_OPTION(retract_lift, NUMBER, "0", "mm", 0, 100, "Retraction",
           "How far the nozzle is lifted while it is retracted.")

ISO_OPTION(cooling, BOOL, "1", "", 0, 1, "Cooling",
           "Slow down and blow by the time a layer takes, with the options below.")
ISO_OPTION(slowdown_below_layer_time, INTEGER, "5", "s", 0, 1000, "Cooling",
           "A layer that takes less than this is slowed down until it takes as long.")
ISO_OPTION(min_print_speed, NUMBER, "10", "mm/s", 0.1, 1000, "Cooling",
           "Slowing down stops at this speed.")
ISO_OPTION(fan_always_on, BOOL, "0", "", 0, 1, "Cooling",
           "Blow at min_fan_speed at least, however long a layer takes.")
ISO_OPTION(fan_below_layer_time, INTEGER, "60", "s", 0, 1000, "Cooling",
           "The fan turns on a layer that takes less than this; the less, the faster.")
ISO_OPTION(min_fan_speed, INTEGER, "35", "%", 0, 100, "Cooling", "Slowest that the fan turns.")
ISO_OPTION(max_fan_speed, INTEGER, "100", "%", 0, 100, "Cooling",
           "Speed of the fan on layers that are slowed down.")
ISO_OPTION(disable_fan_first_layers, INTEGER, "3", "", 0, 1000, "Cooling",
           "On that many layers the fan stays off.")

ISO_OPTION(nozzle_diameter, NUMBER, "0.4", "mm", 0.05, 5, "Printer", "Diameter of the nozzle.")
ISO_OPTION(bed_shape, POINTS, "0x0,200x0,200x200,0x200", "mm", -1600, 1600, "Printer",
           "Corners of the bed, one after the other around it.")
ISO_OPTION(max_print_height, NUMBER, "200", "mm", 0.1, 10000, "Printer",
           "Highest that the nozzle may go.")
ISO_OPTION(center, PLACE, "", "mm", -1600, 1600, "Printer",
           "Where the middle of the print comes to lie, as X,Y. Empty: the middle of the bed.")
ISO_OPTION(gcode_flavor, FLAVOUR, "marlin2", "", 0, 0, "Printer", "Dialect of the G-code.")
ISO_OPTION(use_relative_e_distances, BOOL, "1", "", 0, 1, "Printer",
           "Extrusion counts from the move before (M83), not from the start (M82).")
ISO_OPTION(machine_max_acceleration_extruding, NUMBER, "1000", "mm/s2", 1, 100000, "Printer",
           "The firmware's acceleration of printing moves, for the estimate of time.")
ISO_OPTION(machine_max_acceleration_travel, NUMBER, "1000", "mm/s2", 1, 100000, "Printer",
           "The firmware's acceleration of travel moves, for the estimate of time.")
ISO_OPTION(machine_max_acceleration_retracting, NUMBER, "1000", "mm/s2", 1, 100000, "Printer",
           "The firmware's acceleration of retractions, for the estimate of time.")
ISO_OPTION(machine_max_feedrate_z, NUMBER, "12", "mm/s", 0.1, 1000, "Printer",
           "The firmware's highest speed of the Z axis, for the estimate of time.")
ISO_OPTION(machine_max_junction_deviation, NUMBER, "0.013", "mm", 0.001, 1, "Printer",
           "The firmware's junction deviation, for the estimate of time.")

ISO_OPTION(start_gcode, TEXT,
           "G28 ; home all axes\\n"
           "G1 Z5 F1200 ; lift the nozzle",
           "", 0, 0, "G-code",
           "What comes before the print. [key] stands for an option's value. Heating comes by "
           "itself if there is none in it.")
ISO_OPTION(end_gcode, TEXT,
           "M104 S0 ; nozzle off\\n"
           "M140 S0 ; bed off\\n"
           "M107 ; fan off\\n"
           "G28 X0 ; move out of the way\\n"
           "M84 ; motors off",
           "", 0, 0, "G-code", "What comes after the print. [key] stands for an option's value.")
ISO_OPTION(
    layer_gcode, TEXT, "", "", 0, 0, "G-code",
    "What comes at every layer, once the nozzle is at its height. [layer_num] counts from 0, "
    "[layer_z] is the layer's top in mm; [key] stands for an option's value.")
ISO_OPTION(remaining_times, BOOL, "1", "", 0, 1, "G-code",
           "Tell the printer how much is done and how long it will take still (M73).")

#endif
