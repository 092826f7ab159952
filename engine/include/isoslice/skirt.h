/* Skirt and brim: loops around the parts on the bed, against a nozzle that isn't primed, draught,
 * and parts that come loose. */
#ifndef ISOSLICE_SKIRT_H
#define ISOSLICE_SKIRT_H

#include <stdbool.h>

#include <isoslice/path.h>
#include <isoslice/planar.h>
#include <isoslice/status.h>

typedef struct iso_skirt_options {
    int32_t loops;
    int32_t distance;  /* units to the middle of the innermost loop */
    double min_length; /* units of bead; as many loops more, outwards, as it takes */
    iso_bead bead;
} iso_skirt_options;

/* Append loops around all of `region`: its convex hull grown by `distance`, then by the bead's
 * spacing each. Printed from the outermost in: rank 0 is the outermost. */
ISO_API iso_status iso_skirt(iso_paths *paths, const iso_region *region,
                             const iso_skirt_options *options,
                             iso_planar_scratch *scratch) ISO_MUST_CHECK;

typedef struct iso_brim_options {
    int32_t loops;
    int32_t distance;  /* units from the outlines to the middle of the nearest loop */
    bool outer, inner; /* around the parts; in their holes, where other parts may stand */
    iso_bead bead;
    int32_t rank; /* of the loops furthest out, which are printed first */
} iso_brim_options;

/* Append loops along the outlines of `region`, which must be one (clean, with parents): the same
 * around parts that are near each other. Where two would meet there is none. */
ISO_API iso_status iso_brim(iso_paths *paths, const iso_region *region,
                            const iso_brim_options *options,
                            iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif
