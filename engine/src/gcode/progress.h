/* "M73 P R" lines: percent done and minutes left. They are written as the job goes along and filled
 * in at its end, when the whole time is known; so nothing has to be made twice or kept. */
#ifndef ISO_GCODE_PROGRESS_H
#define ISO_GCODE_PROGRESS_H

#include <stdint.h>

#include <isoslice/status.h>

#include "base/output.h"

enum { ISO_PROGRESS_INTERVAL = 60 /* s between marks, at least one a layer besides */ };

typedef struct iso_progress_point {
    int64_t offset; /* of its line in the output */
    double time;    /* s since the job began */
} iso_progress_point;

typedef struct iso_progress {
    int64_t count, capacity;
    iso_progress_point *point;
} iso_progress;

void iso_progress_free(iso_progress *progress);

iso_status iso_progress_mark(iso_progress *progress, int64_t offset, double time) ISO_MUST_CHECK;

/* A line of always the same size, padded with spaces; returns its end. */
char *iso_progress_put_line(char *to, int percent, int64_t minutes);

iso_status iso_progress_fill_in(iso_output *output, const iso_progress *progress,
                                double whole_time) ISO_MUST_CHECK;

#endif
