/* isoslice contours --field: contours in space. */
#ifndef ISO_CLI_SPACE_CONTOURS_H
#define ISO_CLI_SPACE_CONTOURS_H

#include <isoslice/object.h>

#include "arguments.h"

/* Cut the placed objects by the options' field, at the thicknesses that a print's layers have, from
 * its least value on each object on, and write them by the ending of `path`. */
iso_status iso_space_contours(const char *path, const iso_objects *objects,
                              const iso_instances *instances,
                              const iso_arguments *arguments) ISO_MUST_CHECK;

#endif
