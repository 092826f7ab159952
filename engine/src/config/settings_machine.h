/* Settings of the machine: options turned into the tool's shape. */
#ifndef ISO_CONFIG_SETTINGS_MACHINE_H
#define ISO_CONFIG_SETTINGS_MACHINE_H

#include <isoslice/config.h>

#include "clearance/clearance.h"

clearance_tool settings_of_tool(const iso_options *options);

/* Lists of the right length, limits in order; part of iso_options_check. */
iso_status settings_check_machine(const iso_options *options) ISO_MUST_CHECK;

#endif
