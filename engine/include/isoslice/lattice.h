/* Porous structures: lattices whose density and cell vary in space.
 *
 * A lattice is a cell that repeats (cubic-link), a map from the part's x, y, z to the cell's u, v,
 * w, and a level: where the distance to the skeleton is at most that, there is material. Density is
 * a share of volume; any map that is smooth over a cell keeps it. Lengths are mm, in the part's own
 * frame: x and y from the middle of its box, z from its floor. */
#ifndef ISOSLICE_LATTICE_H
#define ISOSLICE_LATTICE_H

#include <isoslice/geometry.h>
#include <isoslice/status.h>

/* In the order of fill_pattern's words; sheets are walls of even thickness, solids fill one side.
 */
typedef enum iso_lattice_pattern {
    ISO_LATTICE_GYROID_SHEET,
    ISO_LATTICE_GYROID_SOLID,
    ISO_LATTICE_PRIMITIVE_SHEET, /* Schwarz P */
    ISO_LATTICE_PRIMITIVE_SOLID,
    ISO_LATTICE_DIAMOND_SHEET, /* Schwarz D */
    ISO_LATTICE_DIAMOND_SOLID,
    ISO_LATTICE_IWP_SHEET,
    ISO_LATTICE_IWP_SOLID,
    ISO_LATTICE_NEOVIUS_SHEET,
    ISO_LATTICE_NEOVIUS_SOLID,
    ISO_LATTICE_FISCHER_KOCH_SHEET, /* Fischer-Koch S */
    ISO_LATTICE_FISCHER_KOCH_SOLID,
    ISO_LATTICE_BCC_STRUTS,
    ISO_LATTICE_FCC_STRUTS,
    ISO_LATTICE_OCTET_STRUTS,
    ISO_LATTICE_KELVIN_STRUTS,
    ISO_LATTICE_DIAMOND_STRUTS,
    ISO_LATTICE_FOAM_STRUTS, /* edges of a Voronoi partition of seeded points */
    ISO_LATTICE_FOAM_SHEET,  /* its faces: closed pores */
    ISO_LATTICE_BONE_SHEET,  /* a random wave field, as trabecular bone */
    ISO_LATTICE_BONE_SOLID,
    ISO_LATTICE_VOXEL_CUBIC,  /* a cubic pore in each cell, open to its neighbours by bars */
    ISO_LATTICE_VOXEL_RANDOM, /* random voxels smoothed to a pore size */
    ISO_LATTICE_VOXEL_FILE,   /* a .vdb grid or a stack of pictures: lattice_file */
    ISO_LATTICE_COUNT
} iso_lattice_pattern;

/* What u, v, w are cells of. Lengths are divided by the size of a cell; where that depends on one
 * of x, y, z, r and skin alone, and the map has it, cells are counted along it: each is as long as
 * was asked. Arcs have a whole number of cells around, as many as fit at the mean radius of the
 * part's volume, so that nothing is torn; they are longer outside and shorter inside. */
typedef enum iso_lattice_map {
    ISO_LATTICE_MAP_XYZ,
    ISO_LATTICE_MAP_CYLINDER,      /* arc around the z axis, z, radius */
    ISO_LATTICE_MAP_SPHERE,        /* arcs of longitude and latitude around the middle of the box,
                                    * radius; cells get narrow at the poles */
    ISO_LATTICE_MAP_SKIN,          /* x, y, distance to the skin: for what is more level than steep;
                                    * on an upright wall two of them are the same */
    ISO_LATTICE_MAP_SKIN_CYLINDER, /* arc around the z axis, z, distance to the skin: for walls */
    ISO_LATTICE_MAP_COUNT
} iso_lattice_map;

/* Places where a lattice is void whatever its pattern: pieces that hold to nothing. A grid of
 * voxels in the part's frame, and runs of them. Borrowed while the lattice is in use. */
typedef struct iso_lattice_run {
    int32_t z, y, first, end; /* voxels; x from `first` to `end`, that one excluded */
} iso_lattice_run;

typedef struct iso_lattice_cut {
    iso_vec3 min; /* mm, middle of voxel 0 */
    double voxel; /* mm, edge */
    int64_t count;
    const iso_lattice_run *run; /* by z, then y, then first; none overlap */
} iso_lattice_cut;

/* Texts are expressions in x, y, z, skin (mm to the part's surface, inwards), r (mm from the z
 * axis) and grid (the value of lattice_grid at the point), or plain numbers; borrowed while in use.
 */
typedef struct iso_lattice_options {
    int32_t pattern;            /* iso_lattice_pattern */
    int32_t map;                /* iso_lattice_map */
    const char *cell;           /* mm, edge of a cell */
    const char *density;        /* percent */
    const char *material;       /* percent of the second of two materials; "" or NULL: one alone */
    uint64_t seed;              /* of what is random */
    double pore;                /* of VOXEL_RANDOM: cells across a usual pore, 0.05 to 1 */
    const char *file;           /* of VOXEL_FILE; else not looked at */
    const char *grid;           /* a .vdb file for the variable `grid`; "" is none */
    const iso_lattice_cut *cut; /* NULL: none */
    double skin_voxel;          /* mm; the distance to the skin is sampled so finely; 0: box/128 */
} iso_lattice_options;

/* gyroid_sheet, cells of 5 mm, 20 percent, x y z. */
ISO_API iso_lattice_options iso_lattice_defaults(void);

/* The pattern's word, as in fill_pattern: "gyroid_sheet"; NULL beyond the last. */
ISO_API const char *iso_lattice_name(int32_t pattern);

#endif
