/* Warnings, from what files had that isn't ours to lines for the user. */
#ifndef ISO_CLI_WARNINGS_H
#define ISO_CLI_WARNINGS_H

#include <isoslice/config.h>
#include <isoslice/report.h>

iso_status iso_warnings_add(iso_report *report, const iso_config_notes *notes) ISO_MUST_CHECK;

/* To standard error, one line each, cut off where they get long; the report has all of it. */
void iso_warnings_print(const iso_report *report);

#endif
