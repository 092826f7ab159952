/* Upright parts have the same outline layer after layer: its walls are drawn once, and copied for
 * the layers after. What is kept is a copy, so no layer waits for another, and copies are what
 * drawing anew would give. */
#ifndef ISO_REPEAT_H
#define ISO_REPEAT_H

#include <stdbool.h>

#include <isoslice/planar.h>
#include <isoslice/wall.h>

/* Zeroed to begin with. */
typedef struct iso_repeat {
    uint64_t last; /* of the outline asked for last: a layer is kept the second time it comes */
    bool kept;
    iso_wall_options wall;
    iso_region region, area;
    int32_t *group; /* [area.count] */
    int64_t group_capacity;
    iso_paths paths;
    iso_planar_counts cost; /* of drawing them */
} iso_repeat;

/* The walls of a layer, as layer.h has them, and what it cost to draw them. Copies count as much:
 * which thread draws what must not show in what a job reports. */
typedef struct iso_walled {
    iso_paths *paths;
    iso_region *area;
    int32_t **group;
    int64_t *group_capacity;
    iso_planar_counts cost;
} iso_walled;

/* Are the walls of this outline kept? */
bool repeat_has(const iso_repeat *repeat, const iso_region *region, const iso_wall_options *wall);

/* Copy what is kept into empty `to`. */
iso_status repeat_copy(iso_walled *to, const iso_repeat *repeat) ISO_MUST_CHECK;

/* Keep a copy if the outline is that of the last call. */
iso_status repeat_keep(iso_repeat *repeat, const iso_region *region, const iso_wall_options *wall,
                       const iso_walled *from) ISO_MUST_CHECK;

/* sum += sign * more */
void counts_add(iso_planar_counts *sum, const iso_planar_counts *more, int sign);

void repeat_free(iso_repeat *repeat);

#endif
