/* The flags of the program besides the options of a print, which are flags too.
 *
 *     ISO_FLAG(name, letter, argument, verbs, help)
 *
 * letter 0: it has none. argument "": it takes none. verbs: S slice, C contours, I info, P preview,
 * L lattice, H channels. */
ISO_FLAG(output, 'o', "FILE", S | C | P | L | H, "Where the result goes; - is standard output.")
ISO_FLAG(config, 'c', "FILE", S | C | L,
         "Read settings: an ini file, FILE:print:NAME of a bundle, or the end of a G-code file. "
         "May be given again; later files win. Also --load.")
ISO_FLAG(set, 's', "KEY=VALUE", S | C | L, "Set one option; wins over files. Flags win over both.")
ISO_FLAG(strict, 0, "", S | C | L, "Refuse settings that isoslice doesn't know instead of warning.")
ISO_FLAG(report, 0, "FILE", S | L | H,
         "Write what was found, done and used as JSON; - is standard output.")
ISO_FLAG(threads, 0, "N", S | L, "Work with N threads; 0, as usual, takes one a processor.")
ISO_FLAG(progress, 0, "", S | L | H, "Show progress; --no-progress doesn't. Usual on a terminal.")
ISO_FLAG(timestamp, 0, "", S | L, "Write the real date into the G-code, instead of a constant one.")
ISO_FLAG(
    voxel, 0, "MM", L,
    "Edge of the voxels that a lattice is counted and meshed by; 0, as usual, takes what its cells "
    "and walls ask for.")
ISO_FLAG(pitch, 0, "MM", H,
         "Distance of the channels along the part's surface, 0.1 to 1000; usually 20.")
ISO_FLAG(depth, 0, "MM", H, "Distance of their middles from the surface, 0.1 to 1000; usually 10.")
ISO_FLAG(section, 0, "SHAPE", H,
         "Their section in mm: round:D, square:A, rect:AxB, oval:AxB with A along the part, or "
         "polygon:SIDES:D; sizes 0.1 to 1000. Usually round:8.")
ISO_FLAG(sides, 0, "N", H, "Sides of a round or oval section's polygon, 3 to 256; usually 32.")
ISO_FLAG(mode, 0, "MODE", H,
         "What the distance along the surface is: planar, a contour's mean, so that channels are "
         "level; pointwise, each point's own; geodesic, the shortest way on the triangles from the "
         "part's lowest points, over its top too. Usually planar.")
ISO_FLAG(start, 0, "MM", H,
         "Way from the part's lowest contour to the first channel, 0 to 1000; usually half the "
         "pitch.")
ISO_FLAG(levels, 0, "N", H,
         "Heights that the part is cut at, 2 to 10000; 0, as usual, takes 8 a pitch, 81 at least.")
ISO_FLAG(samples, 0, "N", H,
         "Points around a contour, 8 to 10000; 0, as usual, takes 10 a depth, 100 at least.")
ISO_FLAG(holes, 0, "", H, "Lead channels around within the part's upright holes too.")
ISO_FLAG(ports, 0, "HOW", H,
         "parallel: each channel has an inlet and an outlet; series: they are joined, with one of "
         "each; none: closed rings. Usually parallel.")
ISO_FLAG(side, 0, "SIDE", H,
         "Side of the mould that ports are on: front, back, left or right; usually front, -y.")
ISO_FLAG(margin, 0, "MM", H, "Mould around the part, 0 to 1000; usually what the channels ask for.")
ISO_FLAG(wall, 0, "MM", H,
         "Least mould between channels, to the part and to the outside, 0 to 1000; usually 2. Less "
         "is refused, exit code 8.")
ISO_FLAG(bend, 0, "MM", H,
         "Least radius of bends, 0 to 1000; usually 1.5 times the reach of the section from its "
         "middle. Less is refused, exit code 8.")
ISO_FLAG(write, 0, "WHAT", H,
         "What goes into an .stl: channels or mould. Usually the mould if the file's name has "
         "mould or mold in it, else the channels.")
ISO_FLAG(json, 0, "", I | L | H, "Print as JSON what is found.")
ISO_FLAG(view, 0, "ANGLES", C | P,
         "Where curved layers are seen from: degrees from x towards y, and above the ground, as "
         "-60,30. Layers of G-code are else seen from above.")
ISO_FLAG(layers, 0, "LIST", P, "Which layers to draw, as 1,20,-1; -1 is the last one.")
ISO_FLAG(columns, 0, "N", P, "Layers drawn in a row.")
ISO_FLAG(travels, 0, "", P, "Draw moves that don't print; --no-travels doesn't. Usual.")
ISO_FLAG(quiet, 'q', "", S | C | I | P | L | H, "Say nothing but errors.")
ISO_FLAG(list_options, 0, "", S | C | L,
         "List every option with its default, unit, range and meaning.")
ISO_FLAG(man, 0, "", S, "Print the manual page; isoslice --man | man -l - shows it.")
ISO_FLAG(version, 0, "", S | C | I | P | L | H, "Print the version.")
ISO_FLAG(help, 'h', "", S | C | I | P | L | H, "Print this help.")
