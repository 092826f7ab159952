/* The whole public interface of isoslice. */
#ifndef ISOSLICE_ISOSLICE_H
#define ISOSLICE_ISOSLICE_H

#include <isoslice/channel.h>
#include <isoslice/config.h>
#include <isoslice/field.h>
#include <isoslice/fill.h>
#include <isoslice/gcode.h>
#include <isoslice/geometry.h>
#include <isoslice/job.h>
#include <isoslice/lattice.h>
#include <isoslice/link.h>
#include <isoslice/mesh.h>
#include <isoslice/object.h>
#include <isoslice/path.h>
#include <isoslice/planar.h>
#include <isoslice/porous.h>
#include <isoslice/preview.h>
#include <isoslice/report.h>
#include <isoslice/shell.h>
#include <isoslice/skirt.h>
#include <isoslice/slice.h>
#include <isoslice/solid.h>
#include <isoslice/status.h>
#include <isoslice/version.h>
#include <isoslice/wall.h>

#endif
