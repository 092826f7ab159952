/* Settings of objects: options turned into what they are made, placed and sliced with. */
#ifndef ISO_CONFIG_SETTINGS_OBJECTS_H
#define ISO_CONFIG_SETTINGS_OBJECTS_H

#include <isoslice/config.h>
#include <isoslice/object.h>
#include <isoslice/slice.h>

/* Models keep their places to each other unless objects are arranged, copied, split or printed one
 * by one. A grid takes them all as one. */
iso_object_options settings_of_objects(const iso_options *options);

/* Lengths in the file's own measure: what is scaled afterwards ends up as the user said, but for
 * scale_to_fit. */
iso_mesh_options settings_of_reading(const iso_options *options);

/* mm by which outlines may be printed larger than the model's, on all sides. */
double settings_of_growth(const iso_options *options);

/* Points into the options. */
iso_placing settings_of_placing(const iso_options *options);

/* For complete_objects. */
iso_clearance settings_of_clearance(const iso_options *options);

/* For adaptive_layers. */
iso_adaptive_options settings_of_adaptive(const iso_options *options);

/* Lists of the right length, heights in order; part of iso_options_check. */
iso_status settings_check_objects(const iso_options *options) ISO_MUST_CHECK;

#endif
