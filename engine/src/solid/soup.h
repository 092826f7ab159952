/* Triangles that need not fit together: how often they turn around a point is a real number, 1
 * inside a closed surface, 0 outside, in between where there are holes (Jacobson, Kavan and
 * Sorkine-Hornung, Robust Inside-Outside Segmentation using Generalized Winding Numbers, 2013). */
#ifndef ISO_SOLID_SOUP_H
#define ISO_SOLID_SOUP_H

#include <isoslice/geometry.h>
#include <isoslice/status.h>

typedef struct iso_soup iso_soup;

/* corner[3 count], counter-clockwise seen from outside; copied. ISO_UNSLICEABLE: more than 2^31. */
iso_status soup_new(iso_soup **soup, const iso_vec3 *corner, int64_t count) ISO_MUST_CHECK;
void soup_free(iso_soup *soup);

/* Within 0.1 of the truth; within 1e-9 of up to 8 triangles. Any number of
 * threads at once. */
void soup_winding(double *winding, const iso_soup *soup, const iso_vec3 *point, int64_t count);

/* Where it winds more than half; as volume_surface.inside takes it, `soup` being an iso_soup. */
iso_status soup_inside(void *soup, uint8_t *inside, const iso_vec3 *point,
                       int64_t count) ISO_MUST_CHECK;

#endif
