/* The flags of the program besides the options of a print, which are flags too.
 *
 *     ISO_FLAG(name, letter, argument, verbs, help)
 *
 * letter 0: it has none. argument "": it takes none. verbs: S slice, C contours, I info, P preview,
 * L lattice. */
ISO_FLAG(output, 'o', "FILE", S | C | P | L, "Where the result goes; - is standard output.")
ISO_FLAG(config, 'c', "FILE", S | C | L,
         "Read settings: an ini file, FILE:print:NAME of a bundle, or the end of a G-code file. "
         "May be given again; later files win. Also --load.")
ISO_FLAG(set, 's', "KEY=VALUE", S | C | L, "Set one option; wins over files. Flags win over both.")
ISO_FLAG(strict, 0, "", S | C | L, "Refuse settings that isoslice doesn't know instead of warning.")
ISO_FLAG(report, 0, "FILE", S | L,
         "Write what was found, done and used as JSON; - is standard output.")
ISO_FLAG(threads, 0, "N", S | L, "Work with N threads; 0, as usual, takes one a processor.")
ISO_FLAG(progress, 0, "", S | L, "Show progress; --no-progress doesn't. Usual on a terminal.")
ISO_FLAG(timestamp, 0, "", S | L, "Write the real date into the G-code, instead of a constant one.")
ISO_FLAG(
    voxel, 0, "MM", L,
    "Edge of the voxels that a lattice is counted and meshed by; 0, as usual, takes what its cells "
    "and walls ask for.")
ISO_FLAG(json, 0, "", I | L, "Print as JSON what is found.")
ISO_FLAG(layers, 0, "LIST", P, "Which layers to draw, as 1,20,-1; -1 is the last one.")
ISO_FLAG(columns, 0, "N", P, "Layers drawn in a row.")
ISO_FLAG(travels, 0, "", P, "Draw moves that don't print; --no-travels doesn't. Usual.")
ISO_FLAG(quiet, 'q', "", S | C | I | P | L, "Say nothing but errors.")
ISO_FLAG(list_options, 0, "", S | C | L,
         "List every option with its default, unit, range and meaning.")
ISO_FLAG(man, 0, "", S, "Print the manual page; isoslice --man | man -l - shows it.")
ISO_FLAG(version, 0, "", S | C | I | P | L, "Print the version.")
ISO_FLAG(help, 'h', "", S | C | I | P | L, "Print this help.")
