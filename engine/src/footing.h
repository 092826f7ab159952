/* Footing: flat layers on the bed that bend into those of a field. */
#ifndef ISO_FOOTING_H
#define ISO_FOOTING_H

#include <isoslice/config.h>
#include <isoslice/object.h>
#include <isoslice/report.h>

/* Put the object's flat base under a field, as high as the options say, or as it takes for no layer
 * to get a third thinner or thicker where it bends. The field is taken over, also on failure: then
 * it is NULL. */
iso_status footing_blend(iso_field **field, iso_report *report, const iso_options *options,
                         const iso_object *object) ISO_MUST_CHECK;

#endif
