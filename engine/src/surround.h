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
} iso_surround;

/* `first` is what the first layer covers, `all` what all layers do; need not be clean. */
iso_status surround_make(iso_surround *surround, const iso_region *first, const iso_region *all,
                         const iso_options *options, iso_planar_scratch *scratch) ISO_MUST_CHECK;
void surround_free(iso_surround *surround);

/* The paths around a layer; NULL if there are none. `height` in mm. */
iso_status surround_layer(const iso_paths **paths, iso_surround *surround, int32_t index,
                          const iso_options *options, double height) ISO_MUST_CHECK;

#endif
