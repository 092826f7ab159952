/* Split edges until every face meets every level in one line at most, and lines are straight
 * enough. */
#ifndef ISO_SLICE_REFINE_H
#define ISO_SLICE_REFINE_H

#include "slice/refined.h"

/* `level`: [count], ascending strictly, one at least. */
iso_status refine(refined *r, const double *level, int32_t count,
                  const iso_field_slicing *options) ISO_MUST_CHECK;

#endif
