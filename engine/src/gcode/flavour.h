/* What differs from firmware to firmware, as data. */
#ifndef ISO_GCODE_FLAVOUR_H
#define ISO_GCODE_FLAVOUR_H

#include <isoslice/gcode.h>

typedef struct iso_flavour_words {
    const char *name;                                  /* as the configuration has it */
    const char *nozzle, *nozzle_wait, *bed, *bed_wait; /* before the temperature */
    const char *fan, *fan_off;                         /* before 0 to 255 */
    const char *relative_e, *absolute_e;
    const char *reset_e;
    int progress; /* understands M73 */
} iso_flavour_words;

const iso_flavour_words *iso_flavour_get_words(iso_flavour flavour);

#endif
