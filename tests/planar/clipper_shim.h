/* Clipper 6, a peer to measure the kernel against: never linked into the engine. */
#ifndef TESTS_PLANAR_CLIPPER_SHIM_H
#define TESTS_PLANAR_CLIPPER_SHIM_H

#include <isoslice/planar.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Contours in Clipper's own form, so that a benchmark does not time the conversion. */
typedef struct clipper_paths clipper_paths;

/* All return NULL if Clipper throws or memory is out. */
clipper_paths *clipper_from_region(const iso_region *region);
void clipper_free(clipper_paths *paths);

clipper_paths *clipper_clean(const clipper_paths *in, iso_fill_rule rule);
clipper_paths *clipper_boolean(iso_boolean_kind kind, const clipper_paths *a,
                               const clipper_paths *b);
clipper_paths *clipper_offset(const clipper_paths *in, const iso_offset_options *options);

double clipper_area(const clipper_paths *paths); /* units^2, holes subtract */
int64_t clipper_points(const clipper_paths *paths);
int32_t clipper_contours(const clipper_paths *paths);

#ifdef __cplusplus
}
#endif

#endif
