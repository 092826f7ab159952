/* Are the slices what rays say they should be?
 *
 * To the left and right of a contour, in the plane of its level, the winding number of the level's
 * contours must be that of the meshes in space: the one comes from how triangles hang together, the
 * other from rays and integers alone. What the numbers are tells more: material on both sides, and
 * the contour is buried where shells overlap; on neither, and it bounds nothing. Likewise for
 * shells, in front of and behind some of their triangles. */
#ifndef ISO_SOLID_CHECK_H
#define ISO_SOLID_CHECK_H

#include <stdbool.h>

#include <isoslice/config.h>
#include <isoslice/mesh.h>
#include <isoslice/report.h>
#include <isoslice/slice.h>

#include "base/parallel.h"

typedef struct solid_subject {
    const char *name;         /* of the object, for messages */
    const iso_mesh *mesh;     /* [count] as they were sliced */
    const iso_slices *slices; /* [count] */
    int32_t count;
    const iso_levels *levels;
    iso_check_solid mode;
} solid_subject;

/* In auto mode a single mesh of one shell that needed no mending, or several whose boxes are apart,
 * can't be other than its slices. */
bool solid_check_is_due(const iso_mesh *mesh, int32_t count, iso_check_solid mode);

/* Adds to report->solid. In full, every contour and triangle is looked at, and a wrong contour is
 * ISO_NOT_VERIFIED; ISO_BAD_CONFIG: the module isoslice-solid is missing. In auto, every third
 * level and some triangles of each shell that it meets, which needs no module; wrong contours give
 * the warning "contours-wrong". */
iso_status solid_check(iso_report *report, const solid_subject *subject,
                       iso_pool *pool) ISO_MUST_CHECK;

#endif
