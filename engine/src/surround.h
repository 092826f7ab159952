/* What is drawn around the parts: skirt, brim, draft shield. */
#ifndef ISO_SURROUND_H
#define ISO_SURROUND_H

#include <isoslice/config.h>
#include <isoslice/planar.h>

/* Zero-initialise. */
typedef struct iso_surround {
    iso_paths paths;     /* of the first layer: skirt, then brim */
    int32_t skirt_paths; /* how many of them are the skirt's, which goes up further */
    int32_t layers;      /* that have the skirt */
    iso_paths higher;    /* the skirt of a layer above */
    int32_t drawn, top;  /* layers of it so far, and how high they reach, in units */
} iso_surround;

/* `first` is what the first layer covers, `all` what all layers do; need not be clean. */
iso_status surround_make(iso_surround *surround, const iso_region *first, const iso_region *all,
                         const iso_options *options, iso_planar_scratch *scratch) ISO_MUST_CHECK;
void surround_free(iso_surround *surround);

/* The paths that are due at a step whose top is at `z`, `height` thick, both in units; NULL if
 * there are none. Steps of several objects may be nearer to each other than they are thick, or
 * begin at the bed again: what is around all of them grows by what is missing up to z, never twice.
 */
iso_status surround_step(const iso_paths **paths, iso_surround *surround, int32_t z, int32_t height,
                         const iso_options *options) ISO_MUST_CHECK;

#endif
