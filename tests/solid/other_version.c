/* A module of a version that will never be. */
#include "solid/module.h"

extern const module_header isoslice_module;
MODULE_TABLE const module_header isoslice_module = {12345};
