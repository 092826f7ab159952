/* Where names have their values from. Each finds the value of a key, or leaves kind NONE. */
#ifndef ISO_MACRO_NAMES_H
#define ISO_MACRO_NAMES_H

#include "macro/run.h"

iso_status names_of_job(iso_datum *value, iso_macro_run *run, const char *key) ISO_MUST_CHECK;
bool names_needs_job(const char *key); /* is it known of jobs alone? */
iso_status names_of_options(iso_datum *value, iso_macro_run *run, const char *key) ISO_MUST_CHECK;
/* options->foreign, then the table of defaults */
iso_status names_of_files(iso_datum *value, iso_macro_run *run, const char *key) ISO_MUST_CHECK;

#endif
