/* Settings: options turned into the stages' own. */
#ifndef ISO_CONFIG_SETTINGS_H
#define ISO_CONFIG_SETTINGS_H

#include <isoslice/config.h>
#include <isoslice/fill.h>
#include <isoslice/shell.h>
#include <isoslice/wall.h>

#include "config/texts.h"
#include "pose/pose.h"
#include "lattice/drain.h"

#include "path/order.h"
#include "wall/compensation.h"
#include "wall/fuzzy.h"

/* What a layer's paths are made with. */
typedef struct iso_layer_settings {
    int32_t thinning; /* units by which outlines may be thinned */
    iso_compensation compensation;
    iso_drains drains; /* of the layers in the skin; the options must outlive them */
    iso_wall_options wall;
    iso_fuzzy_options fuzzy;
    iso_gap_options gap; /* of what the fill leaves open; least 0: stays open */
    int32_t fill_inset;  /* units from the edge of a filled area to the middles of its lines */
    iso_shell_options shell;
    int32_t coarse; /* units by which the outlines that shells look at are thinned */
    iso_fill_options top, solid, bridge, lid;
    int32_t bridge_angle_given;    /* else each bridge has its own */
    int32_t lid_least;             /* units; see iso_shell_find_lids; 0: no lids */
    int32_t lid_anchor;            /* units */
    iso_overhang_options overhang; /* reach 0: none */
    int32_t irons;                 /* tops are passed over again; 2: all solid areas are */
    int32_t ironing_inset;         /* units */
    iso_fill_options ironing;
    int32_t has_sparse;        /* else the area within the shells stays empty */
    iso_fill_options sparse;   /* .z is not set */
    iso_fill_options together; /* of several layers at once; by settings_of_combination alone */
} iso_layer_settings;

static inline bool settings_have_lattice(const iso_options *options) {
    return options->fill_pattern >= ISO_PATTERN_LATTICE;
}
/* Percent of the sparse fill; where an expression says it for a lattice, half: neither none nor
 * all. */
static inline double settings_density(const iso_options *options) {
    bool graded = settings_have_lattice(options) && options->lattice_density[0] != 0;
    return graded ? 50 : options->fill_density;
}
/* The options, as the owner of the texts, must outlive the result. `percent` is room for a text. */
iso_lattice_options settings_of_lattice(const iso_options *options, char percent[32]);

/* `index` counts from 0; `height` in mm. */
void settings_of_layer(iso_layer_settings *settings, const iso_options *options, int32_t index,
                       double height);

/* Then, if sparse fill of layers is combined: `height` of all in mm, `turn` counts such groups. */
void settings_of_combination(iso_layer_settings *settings, const iso_options *options, int32_t turn,
                             double height);

/* How much of the print is solid around its tops and bottoms. At full density only what is seen
 * from above is told apart, and what is over air. */
iso_shell_depth settings_of_shells(const iso_options *options);

iso_order_options settings_of_order(const iso_options *options);

/* The texts, begun, and the options must outlive the result. NULL: no texts, not even of the start
 * and the end. */
iso_gcode_options settings_of_gcode(const iso_options *options, const iso_texts *texts,
                                    int64_t timestamp);

/* How the machine turns the part. ISO_BAD_CONFIG: a list of its options has too few numbers, or too
 * many. */
iso_status settings_of_machine(pose_machine *machine, const iso_options *options) ISO_MUST_CHECK;

#endif
