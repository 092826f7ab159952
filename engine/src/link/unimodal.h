/* Does every level cross every face of a surface in one line at most? (paper, 5) */
#ifndef ISO_LINK_UNIMODAL_H
#define ISO_LINK_UNIMODAL_H

#include <isoslice/field.h>
#include <isoslice/link.h>

/* `height`: the field at every dart's place. ISO_UNSLICEABLE names the first face of which that
 * isn't certain. The surface is in R^3. */
iso_status unimodal_check(const iso_double_link *surface, const iso_field *field,
                          const double *height, const double *level,
                          int32_t level_count) ISO_MUST_CHECK;

#endif
