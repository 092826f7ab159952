/* Triangles as a binary STL file. */
#ifndef ISO_MESH_STL_WRITE_H
#define ISO_MESH_STL_WRITE_H

#include <stdint.h>

#include <isoslice/status.h>

/* triangle[9 count], counter-clockwise from outside; `title` has up to 80 bytes. "-" is standard
 * output. */
iso_status stl_write(const char *path, const char *title, const float *triangle,
                     int64_t count) ISO_MUST_CHECK;

#endif
