/* Layers of ordered paths in, G-code out (docs/gcode.md).
 *
 *     iso_gcode_writer_new(&writer, output, &options)
 *     iso_gcode_begin(writer)
 *     iso_gcode_layer(writer, &layer)              once a layer, from the bed up
 *     iso_gcode_next_object(writer, object)        only between objects printed one by one
 *     iso_gcode_finish(&totals, writer, config, payload)
 *     iso_gcode_writer_free(writer)                always
 *
 * Nothing is committed: the output stays the caller's, who commits or abandons it. */
#ifndef ISO_GCODE_WRITER_H
#define ISO_GCODE_WRITER_H

#include <isoslice/arc.h>
#include <isoslice/gcode.h>
#include <isoslice/path.h>

#include "base/output.h"
#include "pose/pose.h"

typedef struct iso_gcode_writer iso_gcode_writer;

typedef struct iso_gcode_layer_info {
    int32_t index;          /* 0 on the bed */
    int32_t z, height;      /* units: its top, z_offset included, and how high it is */
    const iso_paths *paths; /* in printing order (iso_order_layer) */
    const iso_arc *arc;     /* [arc_count] of them (iso_paths_find_arcs) */
    int32_t arc_count;      /* 0 where layers aren't flat */
    const iso_pose *pose;   /* [vertices] by pose_paths; NULL unless the machine turns the part */
    const iso_pose *travel_pose; /* [travels] */
} iso_gcode_layer_info;

/* Writes the lines of the config block, each "; key = value\n". */
typedef iso_status iso_gcode_config_lines(iso_output *output, void *payload);

iso_status iso_gcode_writer_new(iso_gcode_writer **writer, iso_output *output,
                                const iso_gcode_options *options) ISO_MUST_CHECK;
void iso_gcode_writer_free(iso_gcode_writer *writer); /* NULL is allowed */

iso_status iso_gcode_begin(iso_gcode_writer *writer) ISO_MUST_CHECK;
iso_status iso_gcode_layer(iso_gcode_writer *writer,
                           const iso_gcode_layer_info *layer) ISO_MUST_CHECK;

/* What comes is another object, from its first layer (index 0) on: the nozzle rises above all that
 * was printed and comes down where the object begins. Events at heights came with the first one. */
iso_status iso_gcode_next_object(iso_gcode_writer *writer, int32_t object) ISO_MUST_CHECK;

/* `config` may be NULL: then there is no config block. */
iso_status iso_gcode_finish(iso_gcode_totals *totals, iso_gcode_writer *writer,
                            iso_gcode_config_lines *config, void *payload) ISO_MUST_CHECK;

#endif
