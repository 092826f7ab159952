/* A lattice as a part of its own: what is within a model and within a lattice, with a skin if one
 * is asked for; how porous, how strong, how open it is; and as a mesh or a volume.
 *
 *     meshes -> iso_porous_new -> iso_porous_analyse -> iso_porous_write_stl, iso_porous_write_vdb
 *
 * Everything is known from distances: the part's, the lattice's, and what follows from both at any
 * point. Needs the modules isoslice-solid and isoslice-volume. */
#ifndef ISOSLICE_POROUS_H
#define ISOSLICE_POROUS_H

#include <isoslice/geometry.h>
#include <isoslice/lattice.h>
#include <isoslice/mesh.h>
#include <isoslice/status.h>

typedef struct iso_porous iso_porous;

typedef enum iso_porous_output {
    ISO_POROUS_FIGURES, /* nothing but what iso_porous_analyse tells */
    ISO_POROUS_STL,
    ISO_POROUS_VDB
} iso_porous_output;

typedef struct iso_porous_options {
    iso_lattice_options lattice;
    double skin;           /* mm of solid around the lattice; 0: none */
    const iso_vec2 *drain; /* [drain_count] holes through the skin's bottom, mm from the middle of
                            * the meshes' box; borrowed */
    int32_t drain_count;
    double drain_diameter;
    double voxel;    /* mm; 0: cell / 24 or a third of the thinnest wall, whichever is
                      * smaller, or what there is memory for */
    int32_t output;  /* iso_porous_output: what memory is needed for */
    int32_t threads; /* 0: one a processor */
    /* Called now and then on the calling thread, done from 0 to 1; may be NULL. */
    void (*progress)(void *payload, double done, const char *stage);
    void *payload;
} iso_porous_options;

/* Sizes are diameters of the largest spheres that fit around a point (Hildebrand and Ruegsegger
 * 1997), over points of the void or of the material. Volumes in mm^3. */
typedef struct iso_porous_figures {
    double voxel;          /* mm, edge, of what is counted */
    int64_t voxels;        /* looked at */
    double part_volume;    /* the whole part's */
    double volume;         /* of the material, pieces removed not counted */
    double core_volume;    /* the part's without its skin */
    double core_material;  /* the lattice's share of that */
    double asked_porosity; /* 0 to 1, of the core; below 0: an expression says it, not a number */
    double porosity;       /* of the core, measured */
    double part_porosity;  /* of the whole part */
    double surface;        /* mm^2, all of the material's */
    double pore_surface;   /* mm^2, within the part */
    double cells;          /* the part's volume in smallest cells */
    double cell;           /* mm, smallest */
    double detail;         /* mm between the points that the sizes below are found from; 0: the part
                            * is too small or too thin for them, and they are 0 as well */
    double pore_largest, pore_mean, pore_d10, pore_d50, pore_d90;
    double wall_smallest, wall_mean; /* of struts or walls where no border of the part cuts them */
    int64_t pieces;                  /* of the material, before any was removed */
    int64_t removed; /* pieces that hold to nothing: all but the largest of each body */
    double removed_volume;
    int64_t left;         /* of these, what is too large to be taken out in parts, and stays */
    int64_t closed_pores; /* voids from which no way leads out */
    double closed_volume;
} iso_porous_figures;

/* The meshes are one part and give the lattice its frame; they aren't needed afterwards. Statuses
 * of lattices; ISO_BAD_CONFIG: a module is missing; ISO_NO_MEMORY: the output would need too much
 * at the voxel asked for, and the message says which one wouldn't. */
ISO_API iso_status iso_porous_new(iso_porous **porous, const iso_mesh *mesh, int32_t count,
                                  const iso_porous_options *options) ISO_MUST_CHECK;
ISO_API void iso_porous_free(iso_porous *porous);

/* Count, measure, and find what is to be removed. In memory that doesn't grow with the height. */
ISO_API iso_status iso_porous_analyse(iso_porous_figures *figures,
                                      iso_porous *porous) ISO_MUST_CHECK;

/* What was found to hold to nothing, in the part's frame; valid until iso_porous_free. */
ISO_API void iso_porous_cut(iso_lattice_cut *cut, const iso_porous *porous);

/* The surface as a binary STL file, closed, in the meshes' coordinates; its triangles. What
 * iso_porous_analyse found to be loose isn't in it. Whole or not at all. */
ISO_API iso_status iso_porous_write_stl(int64_t *triangles, iso_porous *porous,
                                        const char *path) ISO_MUST_CHECK;

typedef enum iso_porous_kind { ISO_POROUS_DISTANCE, ISO_POROUS_MASK } iso_porous_kind;

/* As an OpenVDB grid called "lattice": distances, or where they need more than 1.5 GB, a mask. */
ISO_API iso_status iso_porous_write_vdb(iso_porous_kind *kind, iso_porous *porous,
                                        const char *path) ISO_MUST_CHECK;

#endif
