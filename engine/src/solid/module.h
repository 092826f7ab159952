/* Heavy libraries are modules, opened on first use and never closed: isoslice-solid.so has Embree,
 * isoslice-volume.so has OpenVDB and libpng. Each exports one table of functions with a version.
 * They are looked for in the folder that ISOSLICE_MODULES names, then beside the library or program
 * that this code is in, then in ../lib/isoslice and the folder they were to be installed to. */
#ifndef ISO_SOLID_MODULE_H
#define ISO_SOLID_MODULE_H

#include <isoslice/status.h>

typedef enum iso_module { ISO_MODULE_SOLID, ISO_MODULE_VOLUME, ISO_MODULE_COUNT } iso_module;

/* The module's table; NULL on failure. Thread-safe. ISO_BAD_CONFIG, naming what is to be installed:
 * there is none, it is of another version, or a library that it needs isn't there. */
iso_status module_open(const void **table, iso_module module) ISO_MUST_CHECK;

#endif
