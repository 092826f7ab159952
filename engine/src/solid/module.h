/* Heavy libraries are modules, opened on first use and never closed: isoslice-solid.so has Embree,
 * isoslice-volume.so has OpenVDB and libpng, isoslice-sparse.so CXSparse. Each exports one table of
 * functions with a version. They are looked for in the folder that ISOSLICE_MODULES names, then
 * beside the library or program that this code is in, then in ../lib/isoslice and the folder they
 * were to be installed to.
 *
 * A module is one file, *_shim.cpp where the library is C++, that includes this header and the one
 * of its table, and ends with
 *
 *     MODULE_TABLE const volume_table isoslice_module = {{MODULE_VERSION_VOLUME}, f, g};
 *
 * Nothing of the engine can be called in there, not even iso_fail(): functions of a table return
 * what went wrong, and let no exception out. */
#ifndef ISO_SOLID_MODULE_H
#define ISO_SOLID_MODULE_H

#include <stdint.h>

#include <isoslice/status.h>

typedef enum iso_module {
    ISO_MODULE_SOLID,
    ISO_MODULE_VOLUME,
    ISO_MODULE_SPARSE,
    ISO_MODULE_COUNT
} iso_module;

/* Raise by one with every change of a table. */
enum { MODULE_VERSION_SOLID = 2, MODULE_VERSION_VOLUME = 1, MODULE_VERSION_SPARSE = 1 };

/* First in every table. */
typedef struct module_header {
    int32_t version;
} module_header;

#ifdef __cplusplus
#define MODULE_TABLE extern "C" __attribute__((visibility("default")))
#else
#define MODULE_TABLE __attribute__((visibility("default")))

/* The module's table; NULL on failure. Thread-safe. ISO_BAD_CONFIG, naming what is to be installed:
 * there is none, it is of another version, or a library that it needs isn't there. */
iso_status module_open(const void **table, iso_module module) ISO_MUST_CHECK;
#endif

#endif
