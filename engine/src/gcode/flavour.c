#include "gcode/flavour.h"

#include <string.h>

static const iso_flavour_words words[ISO_FLAVOUR_COUNT] = {
    [ISO_FLAVOUR_MARLIN2] = {"marlin2", "M104 S", "M109 S", "M140 S", "M190 S", "M106 S", "M107",
                             "M83 ; relative E", "M82 ; absolute E", "G92 E0", 1},
    [ISO_FLAVOUR_MARLIN] = {"marlin", "M104 S", "M109 S", "M140 S", "M190 S", "M106 S", "M107",
                            "M83 ; relative E", "M82 ; absolute E", "G92 E0", 1},
};

const iso_flavour_words *iso_flavour_get_words(iso_flavour flavour) {
    return &words[(unsigned)flavour < ISO_FLAVOUR_COUNT ? flavour : ISO_FLAVOUR_MARLIN2];
}

iso_status iso_flavour_from_name(iso_flavour *flavour, const char *name) {
    for (int i = 0; i < ISO_FLAVOUR_COUNT; i++)
        if (strcmp(name, words[i].name) == 0) {
            *flavour = (iso_flavour)i;
            return ISO_OK;
        }
    return iso_fail(ISO_BAD_CONFIG, "gcode_flavor: \"%s\" is not known; use marlin2 or marlin",
                    name);
}
