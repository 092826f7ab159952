/* Fields: height functions F(x, y, z), whose level surfaces are the layers (paper, 5).
 *
 * Every field has a value, a gradient and a bound of both over a box. The bound is what makes
 * slicing by a curved field exact: over a face whose edges all rise or all fall for certain, a
 * level is one line (iso_slice_field). Lengths in mm. */
#ifndef ISOSLICE_FIELD_H
#define ISOSLICE_FIELD_H

#include <stdint.h>

#include <isoslice/geometry.h>
#include <isoslice/mesh.h>
#include <isoslice/status.h>

typedef enum iso_field_kind {
    ISO_FIELD_PLANE,      /* n . p, |n| = 1 */
    ISO_FIELD_CYLINDER,   /* distance from an axis */
    ISO_FIELD_CONE,       /* layers are cones around an upright axis, all at the same slope */
    ISO_FIELD_SPHERE,     /* distance from a point */
    ISO_FIELD_TORUS,      /* distance from a circle */
    ISO_FIELD_WAVE,       /* z and a sine of x and y */
    ISO_FIELD_FAN,        /* planes around an axis: radius times the angle */
    ISO_FIELD_EXPRESSION, /* of x, y, z */
    ISO_FIELD_DISTANCE,   /* signed, to a second surface: positive outside */
    ISO_FIELD_GEODESIC,   /* along the model's surface, from its lowest points: of that surface only
                           */
    ISO_FIELD_AUTO_TOP,   /* as the tops of the model lie (docs/curved-layers.md) */
    ISO_FIELD_FUNCTION,   /* of the caller's */
    ISO_FIELD_BLEND       /* flat layers that bend into another field's (iso_field_blend) */
} iso_field_kind;

typedef struct iso_field iso_field;

/* value in [low, high] and gradient, by component, in [gradient_low, gradient_high] everywhere in a
 * box, for certain. What isn't known is infinite; finite ends say that there is a value everywhere.
 * Gradients have in them all slopes next to a kink, and are infinite where the value jumps: between
 * two points of the box it changes by no more than they say. */
typedef struct iso_field_bound {
    double low, high;
    iso_vec3 gradient_low, gradient_high;
} iso_field_bound;

/* A field of the caller's: value[count] and, unless NULL, gradient[count] at count points. Both
 * must be functions of the point alone; calls come from several threads at once. */
typedef void iso_field_function(double *value, iso_vec3 *gradient, const iso_vec3 *at,
                                int64_t count, void *payload);
/* Its bound; NULL if all that is known is that it rises or falls by at most `steepest` a mm. */
typedef void iso_field_function_bound(iso_field_bound *bound, iso_vec3 low, iso_vec3 high,
                                      void *payload);

/* From a text, as a user writes it (docs/fields.md):
 *
 *     z   plane:nx,ny,nz   cone:SLOPE[,x,y]   sphere:x,y,z   cylinder:AXIS[,c,c]   torus:R[,x,y,z]
 *     wave:AMPLITUDE,LENGTH[,DIRECTION]   fan:AXIS,c,c,R   or an expression in x, y, z:
 *     z + 0.05*sqrt(x^2+y^2)
 *
 * Kinds that look at models or files are not for here (iso_field_open). ISO_BAD_CONFIG, saying
 * where and what was expected. */
ISO_API iso_status iso_field_new(iso_field **field, const char *text) ISO_MUST_CHECK;

ISO_API iso_status iso_field_from_function(iso_field **field, iso_field_function *function,
                                           iso_field_function_bound *bound, double steepest,
                                           void *payload) ISO_MUST_CHECK;

/* A planar base under curved layers: z up to `from`, field - offset from `to` on, and between
 * z + s (field - offset - z), where s goes from 0 to 1 without a kink. The smaller the difference,
 * the less the layers between are squeezed or spread; where they would have to fall back below the
 * base the blend doesn't rise with z, as those who use it then say. Takes `field` over, also on
 * failure. ISO_USAGE: to <= from. */
ISO_API iso_status iso_field_blend(iso_field **blended, iso_field *field, double offset,
                                   double from, double to) ISO_MUST_CHECK;

/* Any field, from a text: those above, and
 *
 *     distance:FILE.stl   distance:FILE.vdb   geodesic   auto-top
 *
 * which look at `mesh` ([count], the models of one object) or the file. `slope` is the steepest, in
 * degrees, that layers of auto-top may lie; `origin` is where a file's coordinates have the zero of
 * the models': what they were moved back by. A surface in a file must be closed. ISO_BAD_CONFIG,
 * ISO_UNREADABLE, ISO_UNSLICEABLE. */
ISO_API iso_status iso_field_open(iso_field **field, const char *text, const iso_mesh *mesh,
                                  int32_t count, double slope, iso_vec3 origin) ISO_MUST_CHECK;
ISO_API void iso_field_free(iso_field *field); /* NULL is allowed */

ISO_API iso_field_kind iso_field_kind_of(const iso_field *field);

/* Is it z, in whatever words? Then slices are planar. */
ISO_API int iso_field_is_z(const iso_field *field);

/* value[count], gradient[count] or NULL, at count points. Never fails; where a field has no value
 * it is NaN. A gradient never is, nor infinite: where there is none it is one of those beside, or
 * 0. No allocation; any number of threads at once. */
ISO_API void iso_field_evaluate(double *value, iso_vec3 *gradient, const iso_field *field,
                                const iso_vec3 *at, int64_t count);

/* Over the closed box from low to high. */
ISO_API void iso_field_bound_over(iso_field_bound *bound, const iso_field *field, iso_vec3 low,
                                  iso_vec3 high);

#endif
