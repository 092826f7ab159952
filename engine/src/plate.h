/* The plate: models read from files and set on the bed, as objects and their copies. */
#ifndef ISO_PLATE_H
#define ISO_PLATE_H

#include <isoslice/config.h>
#include <isoslice/gcode.h>
#include <isoslice/object.h>
#include <isoslice/report.h>

#include "modifier.h"

typedef struct iso_plate {
    iso_objects objects;
    iso_instances instances; /* in printing order */
    iso_gcode_object *label; /* [instances.count] if the G-code is to have them */
    iso_vec2 *outline;       /* theirs */
    iso_modifiers modifiers; /* if any, there is one object; in its frame */
} iso_plate;

/* Read the files, note them in the report, and find the place of every copy. ISO_OUTSIDE: beyond
 * the bed or max_print_height, or no room. Free the plate in any case. */
iso_status plate_load(iso_plate *plate, iso_report *report, const iso_options *options,
                      const char *const *input, int32_t input_count) ISO_MUST_CHECK;
void plate_free(iso_plate *plate);

/* Is (x, y) in the bed's polygon, its edge included? */
bool plate_on_bed(const iso_points *bed, double x, double y);

#endif
