/* What configuration files say for keys that are no options of ours (iso_foreign in config.h). */
#ifndef ISO_CONFIG_FOREIGN_H
#define ISO_CONFIG_FOREIGN_H

#include <isoslice/config.h>

/* The later value wins. False if there is no room for it: what was there before is gone, too. */
bool iso_foreign_set(iso_foreign *foreign, const char *key, const char *value);
/* The value as the file has it, escapes and quotes included; NULL if there is none. */
const char *iso_foreign_get(const iso_foreign *foreign, const char *key);

/* Call print for each, in the order of their being set. A failure of print ends it. */
iso_status iso_foreign_print(const iso_foreign *foreign, iso_option_printer *print,
                             void *payload) ISO_MUST_CHECK;

#endif
